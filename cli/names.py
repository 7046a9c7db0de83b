"""Names of the top level that no command answers to: those of before, and those kept for what comes.

docs/decisions/0014-command-table.md has the table. A command file of a reserved name takes over by being there.
"""

from __future__ import annotations

MOVED = {
    "explain": "pico plan --explain",
    "graph": "pico plan --graph",
    "watch": "pico drift --watch",
    "bisect-step": "pico bisect step",
    "find": "pico look COMPONENT",
    "scan": "pico look",
    "markers": "pico calibrate markers",
    "rotate": "pico move COMPONENT yaw=DEGREES",
    "place": "pico move COMPONENT after=OTHER distance=MM",
    "stow": "pico move COMPONENT home",
    "home": "pico do COMPONENT home",
    "parts": "pico catalog parts",
    "publish": "pico runs export",
    "version": "pico doctor",
}
RESERVED = {
    "mcp": "assistants that speak the Model Context Protocol",
}

SELDOM = {
    "fmt", "import", "calibrate", "ruler", "data", "git", "bench", "doctor", "completion", "cherry-pick", "blame",
    "redo", "stash", "swap", "budget", "devices", "edge",
    "check", "commission", "serve", "remote", "login", "lease", "token",
}  # fmt: skip
"""Commands that are set up once or asked for seldom: `pico help all` lists them, too."""

MOVING = {
    "apply", "bisect", "bisect continue", "bisect good", "bisect bad", "bisect run", "bisect skip", "bisect start",
    "bisect step", "calibrate", "calibrate steps", "checkout", "commission", "do", "laser", "laser arm", "move",
    "optimize", "recover", "redo", "resume", "run", "runs replay", "set", "teleop", "undo",
}  # fmt: skip
"""Commands that move something or let light out: never offered for a word that is misspelt, for who takes the offer
without reading moves the bench. What is meant is read in the list of commands."""


def moves(command: str) -> bool:
    """Return whether a command (`pico runs replay`) moves something or lets light out."""
    return command.removeprefix("pico ") in MOVING


def instead(name: str) -> str:
    """Return what is said to who types such a name, in one line; empty for any other."""
    if name in MOVED:
        return f"`pico {name}` is now `{MOVED[name]}`"
    if name in RESERVED:
        return f"`pico {name}` is reserved for {RESERVED[name]}; this version can't do it yet"
    return ""
