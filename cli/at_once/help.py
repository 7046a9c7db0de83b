"""The top-level help, answered before anything heavy is imported: what the files of the commands say of them."""

from __future__ import annotations

from ..commands import summary
from ..names import SELDOM

MORE = "More, for what is set up once or asked for seldom: `pico help all`."
LAST = """\
What moves something or lets light out asks first, unless told --yes (or -y).
Every command takes -C DIR (work as if started there), --json, --debug (show
tracebacks), --backend sim|hardware, --emulate. `pico help COMMAND` explains it."""


def help_text(*, every: bool = False) -> str:
    """Return what `pico --help` prints; with `every` command what `pico help all` does."""
    lines = ["Version control for the optical table. Start: pico init --example shel bench", ""]
    for title, commands in summary().items():
        shown = {name: line for name, line in commands.items() if every or name not in SELDOM}
        lines += [f"{title}:", *(f"  {name:<11} {line}" for name, line in shown.items()), ""]
    return "\n".join([*lines, *([] if every else [MORE]), LAST])
