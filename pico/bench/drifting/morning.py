"""What a morning is going to read, and what it found."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from pico.diagnosis.quantities import Quantity, Shot
from pico.model.diff import Change

if TYPE_CHECKING:
    from pico.bench.drifting.references import Reference
    from pico.diagnosis.choosing import Chosen
    from pico.diagnosis.grouping import Suspect
    from pico.diagnosis.nominal import Nominal
    from pico.model.observation import Observation
    from pico.model.plan import Plan


@dataclass(frozen=True)
class Read:
    """One quantity of a morning: `then` and `now` in its coordinate (a logarithm for a share, see `law`), one standard
    deviation of what was read now, and the `change` in those of what is usual from day to day, beside what is
    `expected` of it because parts stand elsewhere; `left`: what the causes leave of that change, in its standard
    deviations, None if it takes no part in finding them. `unknown`: why it could not be read, or not be compared.
    `unit`: of the number itself, of a share too."""

    name: str
    law: str
    unit: str
    then: float | None
    now: float | None
    sigma: float | None
    change: float | None = None
    unknown: str = ""
    expected: float | None = None
    left: float | None = None


@dataclass(frozen=True)
class Moved:
    """What stands or is set otherwise than for the reference. `by_hand`: no operation did it; `repair`: how it comes
    back."""

    change: Change
    by_hand: bool
    repair: str = ""

    @property
    def address(self) -> str:
        """`p2`, or `p1.angle`."""
        own = self.change
        return own.component if own.tunable == "pose" else f"{own.component}.{own.tunable}"


@dataclass(frozen=True)
class Morning:
    """What a morning found, in a `run` that took `seconds` of the bench. `reference`: when what it is compared with was
    read, empty where there was nothing, and its `age` [s]. `moved`: what stands or is set otherwise than then.
    `causes`: each other thing that happened, as the suspects of which one did it, the likeliest first; `repairs` of
    them, in words, in their order. `suspects`: all suspects by probability. `blind`: parts of which no reading that
    could be compared tells. `unexplained`: readings of whose change the causes leave so much that something else must
    have happened. `unusual`: whether something happened; `repair`: of the first thing. `accepted`: it is the
    reference from now on. `set_back`: whether all that was set for it is known to stand where it stood."""

    run: str
    at: str
    seconds: float
    reference: str = ""
    age: float = 0.0
    readings: tuple[Read, ...] = ()
    moved: tuple[Moved, ...] = ()
    causes: tuple[tuple[Suspect, ...], ...] = ()
    repairs: tuple[str, ...] = ()
    suspects: tuple[Suspect, ...] = ()
    blind: tuple[str, ...] = ()
    unexplained: tuple[str, ...] = ()
    unusual: bool = False
    repair: str = ""
    lacks: tuple[str, ...] = ()
    cut_short: bool = False
    accepted: bool = False
    set_back: bool = True

    def __repr__(self) -> str:
        causes = "; ".join(f"{group[0].part}: {group[0].kind}" for group in self.causes if group)
        said = causes or ("something unusual" if self.unusual else "nothing unusual")
        against = f"since {self.reference}: {said}" if self.reference else "no reference yet"
        return f"<morning of {self.at}, {len(self.readings)} readings; {against}>"


@dataclass(frozen=True, eq=False)
class Survey:
    """What a morning is going to read: `quantities` of `shots` and of frames in the `dark`, by the `plan`. `moved`:
    what stands or is set otherwise than for the `reference`; `then`: the bench of that, `nominal`: as it is known now,
    `seen`. `accept`: it is to be the reference from now on."""

    plan: Plan
    nominal: Nominal
    chosen: Chosen
    quantities: tuple[Quantity, ...]
    shots: tuple[Shot, ...]
    dark: tuple[str, ...]
    seen: Observation
    then: Nominal
    reference: Reference | None = None
    moved: tuple[Change, ...] = ()
    accept: bool = False
