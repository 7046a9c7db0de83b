"""What the steps of a commissioning stand on: the bench in this process, who answers for it, and what a step finds."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol

from pico.backends.hardware.device import HardwareDevice
from pico.bench.bench import Bench
from pico.diagnostics import PicoError, error
from pico.edge.local import LocalEdge
from pico.model.record import record

REPEATS = 30
"""How often a part of each type is picked and placed where nobody says how often."""
HOURS = 12.0
"""How long drift is looked for where nobody says how long [h]."""


class Asking(Protocol):
    """The person who walks through a commissioning."""

    def say(self, text: str) -> None:
        """Tell what goes on, or what is to be done now."""
        ...

    def confirm(self, question: str, *, by_person: bool = False) -> bool:
        """Ask, and return whether the answer is yes; `by_person`: on a real bench nobody but a person may answer.
        Raises PicoError where nobody can be asked."""
        ...


class Declined(PicoError):
    """Somebody said no: nothing is written down of the step."""


def shortened(has: float, usual: float, unit: str) -> str:
    """Return that a step was made shorter than usual; empty where it was not."""
    return f" (shortened: {has:g} {unit} instead of {usual:g})" if has < usual else ""


@record
class Found:
    """What a step found, in words and in numbers; `begun`: it goes on another time."""

    told: str
    data: Mapping[str, Any] = field(default_factory=dict)
    begun: bool = False


NO_ARM = Found(told="this bench has no arm")


@dataclass(frozen=True)
class AtBench:
    """A bench that is walked through. `keep`: keeps what a step has found so far; `before`: what it had found when it
    was left off, empty for nothing."""

    bench: Bench
    edge: LocalEdge
    device: HardwareDevice
    asks: Asking
    keep: Callable[[Found], None]
    before: Mapping[str, Any]
    repeats: int = REPEATS
    hours: float = HOURS

    def require(self, question: str, *, by_person: bool = False) -> None:
        """Raise Declined unless the answer is yes."""
        if not self.asks.confirm(question, by_person=by_person):
            raise Declined(error("declined", "nothing was done, and nothing is written down of this step"))

    def require_hand_on_stop(self, doing: str) -> None:
        """Raise Declined unless a person says that a hand is on the hard-wired stop."""
        self.require(f"{doing}. Is nobody in reach, and a hand on the hard-wired stop?", by_person=True)
