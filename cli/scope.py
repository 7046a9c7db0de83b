"""What a command is about, after `--` as in git: `pico plan e1 -- p2 p1.angle`."""

from __future__ import annotations

from typing import Any

import typer
from typer.core import TyperCommand

_KEY = "pico.scope"


class Scoped(TyperCommand):
    """A command that takes names after `--`, apart from its other arguments; see `scope_of`."""

    names = "COMPONENT[.TUNABLE]..."

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Parse what stands before `--`, and keep what stands after it."""
        at = args.index("--") if "--" in args else len(args)
        ctx.meta[_KEY] = tuple(args[at + 1 :])
        try:
            return super().parse_args(ctx, args[:at])
        except Exception as exc:
            if "extra argument" in str(getattr(exc, "message", "")):
                exc.message = f"{exc.message.rstrip('.')}: components go after `--`"  # type: ignore[attr-defined]
            raise

    def collect_usage_pieces(self, ctx: Any) -> list[str]:
        """Return the words of the usage line."""
        return [*super().collect_usage_pieces(ctx), f"[-- {self.names}]"]


def scope_of(context: typer.Context) -> tuple[str, ...]:
    """Return the names that were given after `--`."""
    found: tuple[str, ...] = context.meta.get(_KEY, ())
    return found
