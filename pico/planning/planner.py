"""From the bench as it was seen to what is wanted: a plan, made in passes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from pico.model.observation import Observation, live_state
from pico.model.operation import Operation
from pico.model.plan import Base, LabRef, Plan, Staging
from pico.model.setup import Setup
from pico.motion.types import Motion
from pico.planning.checks.interlocks import policy_rules
from pico.planning.passes.checking import asked_checked, beams_checked, operations_checked
from pico.planning.passes.comparison import compared
from pico.planning.passes.draft import Draft, Pass, made, where_possible
from pico.planning.passes.goal import PlanGoal
from pico.planning.passes.hands import arms_parked, hands_emptied, hands_first
from pico.planning.passes.interlocks import interlocked
from pico.planning.passes.light import light_last, light_told, light_withheld
from pico.planning.passes.moves import moves_ordered
from pico.planning.passes.narrowing import narrowed
from pico.planning.passes.schedule import least_makespan, makespan, scheduled
from pico.planning.passes.values import values_set
from pico.planning.teleoperating import kept_dark

TO_A_STATE: tuple[Pass, ...] = (
    hands_emptied, compared, moves_ordered, light_withheld, values_set,
    where_possible(hands_first, arms_parked, light_last, light_told, interlocked, scheduled, operations_checked),
    narrowed, beams_checked,
)  # fmt: skip
"""What makes a plan that brings the bench to a state, in order."""
OF_OPERATIONS: tuple[Pass, ...] = (light_told, interlocked, kept_dark, scheduled, asked_checked)
"""What makes a plan of operations that somebody asked for."""


@dataclass(frozen=True)
class Planner:
    """Plans for one bench as it was `seen`, to be run on a `backend` in a `fidelity`; `commit`: what is checked out.

    Without `motion` reach and paths are left out, and times are nominal.

        planner = Planner(setup, ArmMotion(setup), seen)
        planner.plan(PlanGoal(wanted))
        planner.plan(set_values(planner, "p1", {"angle": 30.0}))
    """

    setup: Setup
    motion: Motion | None
    seen: Observation
    backend: str = "sim"
    fidelity: str = "kinematic"
    commit: str | None = None
    timed: Callable[[Sequence[Operation]], tuple[Operation, ...]] = tuple
    """Gives operations the seconds that they take on this bench."""

    def plan(self, goal: PlanGoal) -> Plan:
        """Return the plan that leads to a goal, in an order that never collides.

        Raises nothing for an impossible state: the plan is then `errored`, holds no operation, and its diagnostics say
        what is in the way. Raises PicoError for a target that the lab does not have.
        """
        draft = Draft(self.setup, self.motion, self.seen, goal, timed=self.timed)
        if goal.operations is None:
            return self._sealed(made(draft, TO_A_STATE))
        asked = replace(draft, operations=goal.operations, changes=goal.changes, diagnostics=goal.notes)
        return self._sealed(made(asked, OF_OPERATIONS))

    def _sealed(self, draft: Draft) -> Plan:
        setup, operations, goal = self.setup, draft.operations, draft.goal
        live = live_state(setup, self.seen).as_json()
        return Plan(
            lab=LabRef(name=setup.lab.name, digest=setup.digest()), backend=self.backend, fidelity=self.fidelity,
            base=Base(commit=self.commit, observed_at=self.seen.observed_at, state=live),
            target=replace(goal.target, state=goal.wanted.as_json()), changes=draft.changes, operations=operations,
            staging=Staging() if draft.errored else draft.staging, makespan=makespan(operations),
            bound=least_makespan(operations, draft.bound), policy=policy_rules(setup, draft.seen, operations),
            blocking=draft.blocking, diagnostics=draft.diagnostics,
        ).sealed()  # fmt: skip
