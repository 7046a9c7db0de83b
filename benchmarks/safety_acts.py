"""Brings a bench into a state and keeps it there, in a process of its own, for `benchmarks/safety_chain.py`. Says a
line once it is there."""

from __future__ import annotations

import itertools
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from pico.bench.bench import Bench  # noqa: E402
from pico.diagnostics import PicoError  # noqa: E402
from pico.model.plan import Plan  # noqa: E402
from pico.model.trace.unattended import Terms  # noqa: E402

PLACES = ((660, 420), (660, 300))
"""Where the lens is carried to and fro [mm]."""


class Act:
    """One state of one bench."""

    def __init__(self, bench: Bench) -> None:
        self.bench, self._said = bench, False

    def there(self) -> None:
        """Say that the state is reached, once."""
        if not self._said:
            self._said = True
            print("there", flush=True)

    def run(self, plan: Plan, kind: str = "operation_started") -> None:
        """Run a plan; the state is reached with the first event of this kind."""
        for event in self.bench.run(plan):
            if event.kind == kind:
                self.there()

    def measuring(self) -> None:
        """Take pictures with the camera in the beam, one after the other."""
        while True:
            self.run(self.bench.single("camera", "measure", measurable="image"))

    def moving(self) -> None:
        """Carry the lens to and fro."""
        for x, y in itertools.cycle(PLACES):
            self.run(self.bench.single("lens", "move", x=x, y=y), "operation_progress")

    def optimizing(self) -> None:
        """Seek the exposure at which the camera is brightest, again and again."""
        list(self.bench.run(self.bench.single("camera", "set", exposure=1.0)))
        while True:
            goals = self.bench.goals
            self.run(goals.plan(goals.chosen(("bright",))), "operation_progress")

    def unattended(self) -> None:
        """Measure unattended, under the terms of a recipe."""
        terms = Terms(
            recipe="night@20261124T230000Z-abcdef", laser_class="2", until="2099-01-01T00:00:00Z", every=600.0
        )
        self.bench.wait(self.bench.edge.hold(terms))
        self.measuring()


def refuses_teleoperation(lab: Path, backend: str) -> bool:
    """Return whether a bench refuses the plan of a teleoperation, made in the simulator, and has begun no run of it."""
    with Bench.open(lab, backend="sim", fidelity="kinematic") as simulated:
        plan = simulated.teleop("lens", "pose").plan
    with Bench.open(lab, backend=backend) as bench:
        able, before = bench.wait(bench.edge.describe()), _runs(bench)
        try:
            bench.apply(replace(plan, backend=able.name, fidelity=able.fidelity).sealed())
        except PicoError as exc:
            refused = [one.summary for one in exc.diagnostics if one.code == "capability"]
            return _runs(bench) == before and any("cannot teleoperate lens" in text for text in refused)
    return False


def _runs(bench: Bench) -> int:
    memory = bench.edge.memory
    return len(memory.runs()) if memory is not None else 0


def main(lab: str, state: str, backend: str = "hardware") -> None:
    """Keep a bench in a state until something ends that, or this process; without a `backend` the one that is chosen in
    the checkout."""
    with Bench.open(Path(lab), backend=backend or None) as bench:
        act: Callable[[], None] = getattr(Act(bench), state)
        try:
            act()
        except PicoError as exc:
            print(exc, file=sys.stderr)
