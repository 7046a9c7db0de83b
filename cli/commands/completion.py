"""`pico completion`."""

from __future__ import annotations

from typing import Annotated

import typer

from pico.diagnostics import PicoError, did_you_mean, error

from ..session import Session

SHELLS = ("bash", "zsh", "fish")
HOW = {
    "bash": "echo 'eval \"$(pico completion bash)\"' >> ~/.bashrc",
    "zsh": "echo 'eval \"$(pico completion zsh)\"' >> ~/.zshrc",
    "fish": "pico completion fish > ~/.config/fish/completions/pico.fish",
}


def completion(
    context: typer.Context, shell: Annotated[str, typer.Argument(metavar="bash|zsh|fish", help="Your shell.")]
) -> int:
    """Print the completion script of a shell."""
    from typer.completion import get_completion_script

    if shell not in SHELLS:
        raise PicoError(error("usage", f"no completion for `{shell}`", hint=did_you_mean(shell, SHELLS)))
    script = get_completion_script(prog_name="pico", complete_var="_PICO_COMPLETE", shell=shell)
    Session.of(context).say(f"# {HOW[shell]}\n{script}")
    return 0
