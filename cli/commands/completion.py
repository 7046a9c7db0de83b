"""`pico completion`."""

from __future__ import annotations

from typing import Annotated

import typer

from pico.diagnostics import PicoError, did_you_mean, error

from ..complete import HOW, SCRIPTS
from ..session import Session


def completion(
    context: typer.Context, shell: Annotated[str, typer.Argument(metavar="bash|zsh|fish", help="Your shell.")]
) -> int:
    """Print the completion script of a shell; its first line says how to install it."""
    if shell not in SCRIPTS:
        raise PicoError(error("usage", f"no completion for `{shell}`", hint=did_you_mean(shell, SCRIPTS)))
    session = Session.of(context)
    if session.json:
        session.document({"schema": "pico.completion/v1", "shell": shell, "script": SCRIPTS[shell]})
    session.say(f"# {HOW[shell]}\n{SCRIPTS[shell]}")
    return 0
