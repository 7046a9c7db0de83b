"""What a plan is to lead to: a state of the bench, or operations that somebody asked for."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

from pico.diagnostics import Diagnostic
from pico.model.diff import Change
from pico.model.operation import Operation, Reason
from pico.model.plan import Target
from pico.model.state import LabState
from pico.planning.checks.target import Source, no_source

Preference = Literal["fewest-moves", "shortest-time"]


@dataclass(frozen=True, slots=True)
class PlanGoal:
    """What a plan is to lead to. A goal of light, which an optimization seeks, is `pico.model.goal.Goal`.

    `wanted`: the state of the bench then. `target`: what the plan says of that; its state is written by whoever seals
    it. `exact`: move what differs within tolerance, too. `prefer`: fewest moves first and then time, or time first.
    `targets`: plan for these components and tunables (`p2`, `p1.angle`) only, and what must make way for them;
    `exclude`: leave these as they are. `source` tells where in the manifests an address such as `p2.pose` is written.
    `alone`: the component that somebody asked to move, for which nothing else moves.

    `operations`: these are asked for, whatever else differs from `wanted`; with the `changes` that they make, and
    `notes`, what is to be said of them.
    """

    wanted: LabState
    target: Target = field(default_factory=Target)
    exact: bool = False
    prefer: Preference = "fewest-moves"
    targets: tuple[str, ...] = ()
    exclude: tuple[str, ...] = ()
    source: Source = no_source
    alone: str = ""
    operations: tuple[Operation, ...] | None = None
    changes: tuple[Change, ...] = ()
    notes: tuple[Diagnostic, ...] = ()

    @property
    def reason(self) -> Reason | None:
        """Why its operations are there, where not for what each of them does."""
        return Reason(kind="asked") if self.alone else None
