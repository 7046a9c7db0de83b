"""`pico completion`."""

from __future__ import annotations

from typing import Annotated, Literal

import typer

from ..at_once.complete import HOW, SCRIPTS
from ..session import Session

HEADING = "The simulator, and the rest"
ORDER = 130


def completion(
    context: typer.Context,
    shell: Annotated[Literal["bash", "zsh", "fish"], typer.Argument(metavar="bash|zsh|fish", help="Your shell.")],
) -> None:
    """Print a shell's completion script; it says how to install it.

    Examples:
      pico completion bash
    """
    session = Session.of(context)
    if session.json:
        session.document({"schema": "pico.completion/v1", "shell": shell, "script": SCRIPTS[shell]})
    session.say(f"# {HOW[shell]}\n{SCRIPTS[shell]}")
