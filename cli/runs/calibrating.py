"""The person who calibrates a bench: holds the board, reads scales, at a terminal beside the table."""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from pico.backends.devices import EMULATED
from pico.diagnostics import PicoError, error
from pico.model.quantities import convert

from ..session import Session
from ..terminal.output import write

if TYPE_CHECKING:
    from pico.vision.charuco import Board


@dataclass(frozen=True)
class Person:
    """Who sits at the terminal."""

    session: Session
    auto_approve: bool
    name: str
    """The device of the bench."""
    step: float = 0.5
    """To how much scales are read [deg]."""

    def say(self, text: str) -> None:
        """Tell what goes on."""
        self.session.say(text)

    def confirm(self, question: str, *, by_person: bool = False) -> bool:
        """Ask; `--yes` answers no question of a real bench that only a person can."""
        return self.session.confirm(question, self.auto_approve, by_person=by_person and self.name != EMULATED)

    def show(self, pose: Any, board: Board, text: str) -> bool:
        """Ask for the board, and return whether it is held there now."""
        return self._held(text)

    def away(self) -> None:
        """Ask for nothing: what the next step needs, it asks itself."""

    def give(self, robot: str, board: Board, text: str) -> bool:
        """Ask for the board in the hand of a robot, and return whether it is there."""
        return self._held(text)

    def lay(self, pose: Any, board: Board, text: str) -> bool:
        """Ask for the board on the table, and return whether it lies there."""
        return self._held(text)

    def _held(self, text: str) -> bool:
        if sys.stdin is None or not sys.stdin.isatty():
            hint = "a person holds the board, at a terminal beside the table; on the emulated bench `--hands simulated`"
            raise PicoError(error("usage", f"nobody can be asked here: {text}", hint=hint))
        return self.session.confirm(f"{text}. Is it there?", False)

    def read(self, address: str, unit: str, text: str) -> float:
        """Ask for what a scale shows, until it is a number."""
        if sys.stdin is None or not sys.stdin.isatty():
            hint = "a person reads the scale, at a terminal beside the table; on the emulated bench `--hands simulated`"
            raise PicoError(error("usage", f"nobody can be asked here: {text}", hint=hint))
        while True:
            write(sys.stdout, f"{text} [{unit}] ", end="")
            try:
                said = input().strip()
            except (EOFError, OSError) as exc:
                raise PicoError(error("declined", "the calibration was left off; call it again to go on")) from exc
            try:
                found = float(convert(said, unit) if any(c.isalpha() for c in said) else said)
            except (ValueError, PicoError):
                found = math.nan
            if math.isfinite(found):
                return found
            write(sys.stdout, f"{said[:40]!r} is no number")
