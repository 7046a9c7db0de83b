"""A plan in the making, as one pass hands it to the next."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import reduce

from pico.diagnostics import Diagnostic
from pico.model.arming import LaserClass
from pico.model.diff import Change
from pico.model.observation import Observation
from pico.model.operation import Operation
from pico.model.plan import Blocking, Staging
from pico.model.setup import Setup
from pico.motion.types import Motion
from pico.planning.parts.selection import EVERYTHING, Selection
from pico.planning.passes.goal import PlanGoal


@dataclass(frozen=True, slots=True)
class Draft:
    """A plan in the making: the bench as it is `seen`, how its arms move (None: nobody asks), the `goal`, and what was
    found so far.

    `seen`: with empty hands, once they are emptied. `only`: what is asked for. `changes`: what differs. `withheld`:
    requests for light that are not met, by component and tunable, each with the lasers that stay shut for it.
    `operations`: in the order in which they were found, each with an id of its own, and `after` those that it waits
    for. `staging`, `bound`, `blocking`: as of `Plan`; `bound` is what the arms need in any order [s].
    """

    setup: Setup
    motion: Motion | None
    seen: Observation
    goal: PlanGoal
    only: Selection = EVERYTHING
    changes: tuple[Change, ...] = ()
    withheld: Mapping[tuple[str, str], Mapping[str, LaserClass]] = field(default_factory=dict)
    operations: tuple[Operation, ...] = ()
    staging: Staging = field(default_factory=Staging)
    bound: float | None = None
    blocking: tuple[Blocking, ...] | None = None
    diagnostics: tuple[Diagnostic, ...] = ()
    timed: Callable[[Sequence[Operation]], tuple[Operation, ...]] = tuple
    """Gives operations the seconds that they take on the bench; those of paths and speeds alone as they are."""

    @property
    def errored(self) -> bool:
        """Whether something is impossible."""
        return any(d.severity == "error" for d in self.diagnostics)

    @property
    def moving(self) -> tuple[str, ...]:
        """The components that stand elsewhere than they should."""
        return tuple(c.component for c in self.changes if c.tunable == "pose" and not c.tolerated)

    @property
    def robots(self) -> tuple[str, ...]:
        """The robots whose gripper is free."""
        hands = self.seen.robots
        return tuple(n for n in sorted(self.setup.lab.robots) if n not in hands or hands[n].holding is None)

    def told(self, *found: Diagnostic) -> Draft:
        """Return the plan with more that is said of it."""
        return replace(self, diagnostics=(*self.diagnostics, *found))


Pass = Callable[[Draft], Draft]
"""One step in the making of a plan."""


def made(draft: Draft, passes: tuple[Pass, ...]) -> Draft:
    """Return a plan after passes, one after the other."""
    return reduce(lambda found, one: one(found), passes, draft)


def where_possible(*passes: Pass) -> Pass:
    """Return these passes as one; where something is impossible already there are no operations, and they are left
    out."""
    return lambda draft: replace(draft, operations=()) if draft.errored else made(draft, passes)
