"""The top-level help, answered before anything heavy is imported: what the files of the commands say of them."""

from __future__ import annotations

from ..commands import summary

OPTIONS = {
    "-C DIR": "Work as if started in DIR.",
    "--json": "Answer with JSON.",
    "--debug": "Show the traceback of an internal error.",
    "--backend NAME": "What executes operations: sim (default) or hardware.",
    "--version": "Show the version.",
    "--help": "Show this, or the help of a command.",
}


def help_text() -> str:
    """Return what `pico --help` prints."""
    lines = ["Usage: pico [OPTIONS] COMMAND [ARGS]...", "", "Version control for the optical table.", ""]
    for title, commands in summary().items():
        lines += [f"{title}:", *(f"  {name:<11} {line}" for name, line in commands.items()), ""]
    lines += ["Options, before or after the command:"]
    lines += [f"  {option:<15} {line}" for option, line in OPTIONS.items()]
    return "\n".join(
        [*lines, "", "Start with `pico init --example shel bench`. Help of a command: `pico COMMAND --help`."]
    )
