"""A recipe while it runs: a line for each step that is over, in the tree of its loops."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from pico.recipes.recipe import Act

from . import measured
from .recipe import line
from .style import paint

if TYPE_CHECKING:
    from pico.model.setup import Setup
    from pico.recipes.walking import Entered


class Lines:
    """Turns what happens into lines that stay."""

    def __init__(self, setup: Setup) -> None:
        self.setup, self.last = setup, ""

    def entered(self, entered: Entered) -> str:
        """Return the line of a step that begins; of one that acts it comes when that is over."""
        self.last = line(entered)
        return "" if isinstance(entered.step, Act) else self.last

    def ended(self, path: str, told: Mapping[str, Any], before: bool) -> str:
        """Return the line of a step that is over, with what it measured."""
        if path.endswith("?"):
            return ""
        mark = paint("dim", "=") if before else paint("green", "✓")
        said = "  ".join(measured.line(m) for m in told.get("measured", {}).values()) or (
            str(told[""]) if "" in told else ""
        )
        return f"{mark} {self.last.lstrip() if not self.last.startswith('  ') else self.last[2:]}  {said}".rstrip()


def data(entered: Entered) -> dict[str, Any]:
    """Return schema `pico.recipe_event/v1` of a step that begins: `path`, `title`, `turn` of a loop, its `values`."""
    turn = {"turn": entered.turn[0], "turns": entered.turn[1]} if entered.turn else {}
    return {
        "schema": "pico.recipe_event/v1", "event": "step", "path": entered.path, "title": entered.said,
        "values": dict(entered.values), **turn,
    }  # fmt: skip


def told(path: str, result: Mapping[str, Any], before: bool) -> dict[str, Any]:
    """Return schema `pico.recipe_event/v1` of a step that is over: `path`, its `result`, whether that was `before`."""
    return {
        "schema": "pico.recipe_event/v1", "event": "done", "path": path, "result": dict(result), "before": before,
    }  # fmt: skip
