"""A run that is open: what it is to do is asked of it step by step, while its client has the bench."""

from __future__ import annotations

import time
from collections import Counter
from dataclasses import dataclass, field
from typing import Any

from pico.backends.device import Capabilities
from pico.diagnostics import Diagnostic, error
from pico.model.observation import Observation
from pico.model.plan import Plan
from pico.model.trace.event import Event
from pico.model.trace.report import RunReport
from pico.model.trace.run import OPERATION_ENDS, RunOutcome


@dataclass
class OpenRun:
    """An open run of a `plan` without operations: how many `steps` it has begun, and how their operations ended."""

    id: str
    plan: Plan
    steps: int = 0
    seconds: float = 0.0
    tally: Counter[str] = field(default_factory=Counter)
    since: float = field(default_factory=time.monotonic)

    def step(self, plan: Plan) -> Plan:
        """Return the plan of the next step, with ids that no other step has: `op1` of the third is `3.op1`."""
        self.steps += 1
        return plan.with_ids(f"{self.steps}.")

    def count(self, finished: Event) -> None:
        """Add what became of a step, as its last event tells."""
        self.seconds += float(finished.data.get("seconds", 0.0))
        self.tally.update({end: int(finished.data.get(end, 0)) for end in OPERATION_ENDS})

    def counts(self) -> dict[str, Any]:
        """Return how its operations ended, and the seconds in which something moved."""
        return {end: self.tally[end] for end in OPERATION_ENDS} | {"seconds": self.seconds}

    def report(self, outcome: RunOutcome, seen: Observation, able: Capabilities) -> RunReport:
        """Return what became of it, with the bench as it is `seen` afterwards."""
        return RunReport(
            run=self.id, goal=self.plan.target.name, outcome=outcome, **self.counts(),
            clock="simulated" if able.simulated else "on the bench", wall=time.monotonic() - self.since,
            evidence=able.evidence, whole=False,
            held={name: robot.holding for name, robot in sorted(seen.robots.items()) if robot.holding},
        )  # fmt: skip


def not_open(run: str) -> Diagnostic:
    """Return what is wrong where a run is not open any more."""
    return error("run", f"run {run} is not open any more", hint="somebody stopped it (`pico runs show`): record anew")
