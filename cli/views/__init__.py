"""What people and programs read: each view has `text(...)` for a screen and `data(...)` for `--json`."""
