"""What is to be ordered: components that leave and arrive, ways to move them, which event must come before which."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass
from typing import Literal

What = Literal["leaves", "arrives"]
Part = Literal["direct", "pick", "place"]
"""What an option is for: a move straight to the goal, or the first or second half of a staged one."""


@dataclass(frozen=True, slots=True)
class PartEvent:
    """A component, by index, leaves where it stands or arrives where it belongs."""

    component: int
    what: What


def leaves(component: int) -> PartEvent:
    return PartEvent(component, "leaves")


def arrives(component: int) -> PartEvent:
    return PartEvent(component, "arrives")


@dataclass(frozen=True, slots=True)
class Arc:
    """`before` must happen before `after`. `goals`: only if each of these components (index) ends at this one of its
    goals, where a component has several. `kind` is handed back in certificates."""

    before: PartEvent
    after: PartEvent
    kind: str = ""
    goals: tuple[tuple[int, int], ...] = ()


@dataclass(frozen=True, slots=True)
class Option:
    """One way to pick, to place, or (`direct`) to do both in one, and the arcs that hold if it is chosen. `goal`: at
    which of its goals the component then ends; of no meaning for a pick."""

    name: Hashable
    arcs: tuple[Arc, ...] = ()
    goal: int = 0


@dataclass(frozen=True, slots=True)
class Component:
    """One component. Directly, it leaves and arrives at once in one of the `direct` options; staged, it is picked in
    one of `pick` and later placed in one of `place`, which costs `weight` (above 0). Where either is empty it is never
    staged."""

    direct: tuple[Option, ...]
    pick: tuple[Option, ...] = ()
    place: tuple[Option, ...] = ()
    weight: float = 1.0

    @property
    def may_be_staged(self) -> bool:
        return bool(self.pick and self.place)


@dataclass(frozen=True, slots=True)
class StagingProblem:
    """Components, and arcs that hold however these are moved."""

    components: tuple[Component, ...]
    arcs: tuple[Arc, ...] = ()


Link = tuple[int, What, int, What, str]
"""Component and event that come before component and event, and why: the kind of an arc, or `same move` where a direct
move leaves and arrives at once, `same part` for leaving before arriving, `no way` where a component has no option."""
Cycle = tuple[Link, ...]


@dataclass(frozen=True, slots=True)
class Choice:
    """How a component is moved: indices of the options taken. Direct: `direct`; staged: `pick` and `place`."""

    direct: int | None = None
    pick: int | None = None
    place: int | None = None

    @property
    def staged(self) -> bool:
        return self.direct is None


@dataclass(frozen=True, slots=True)
class StagingAnswer:
    """The answer: which components are staged, how each is moved, an order of the events, and what no answer can go
    below.

    `order` holds both events of every component; those of a direct move are neighbors in it. Without an answer
    `options` is None and `weight` infinite; where that is proven, every choice of options and stagings closes one of
    `cycles`, none of which can be left out.
    """

    staged: tuple[int, ...]
    options: tuple[Choice, ...] | None
    order: tuple[PartEvent, ...]
    weight: float
    lower_bound: float
    proven: bool
    cycles: tuple[Cycle, ...] = ()

    @property
    def count(self) -> int:
        return len(self.staged)

    @property
    def cycle(self) -> Cycle:
        """The shortest cycle of the certificate; alone where one ring is impossible by itself."""
        return min(self.cycles, key=len, default=())
