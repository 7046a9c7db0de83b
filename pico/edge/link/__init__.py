"""An edge in another process of this machine, reached through a Unix socket."""
