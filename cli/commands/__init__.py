"""One file a command. Only the one that is asked for is imported: it brings its views along, and they the model."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module

import typer

from ..scope import Scoped
from ..summary import COMMANDS

SINGLE = ("do", "move", "rotate", "place", "stow", "set", "get", "home")
GROUPS = ("bisect", "catalog", "data", "git", "runs", "sim")
SCOPED = ("plan", "apply", "checkout", "diff", "log")  # these take names after `--`
LOOSE = {"ignore_unknown_options": True}  # -30 is then a number, not an option, and git gets its own


def register(app: typer.Typer, asked: str | None) -> None:
    """Add every command to `app`: the one asked for in full, of the others name and first line."""
    for name in COMMANDS:
        if name in GROUPS:
            app.add_typer(import_module(f".{name}", __name__).app if name == asked else _empty(name), name=name)
        elif name == asked:
            settings = LOOSE if name in ("do", "log", "move", "rotate", "set", "push", "pull") else None
            kind = Scoped if name in SCOPED else None
            app.command(name, cls=kind, context_settings=settings)(_function(name))
        else:
            app.command(name, help=COMMANDS[name])(_nothing)


def _function(name: str) -> Callable[..., int]:
    name = f"{name}_" if name in ("import", "set") else name  # words of Python
    name = name.replace("-", "_")
    module = import_module(".single" if name.rstrip("_") in SINGLE and name != "get" else f".{name}", __name__)
    function: Callable[..., int] = getattr(module, name)
    return function


def _empty(name: str) -> typer.Typer:
    group = typer.Typer(help=COMMANDS[name])
    group.callback()(_nothing)
    return group


def _nothing() -> None:
    pass
