"""The facade: a `Bench`, which command line, scripts and server use; `pico.open(path)` gives that of scripts.

What it does its services do, one a noun; beside them it has the few verbs that scripts need most.
"""

from __future__ import annotations

import signal
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pico.bench.opened import Opened
from pico.model.diff import Change
from pico.model.plan import Plan
from pico.model.state import LabState

if TYPE_CHECKING:
    from pico.bench.cameras import Cameras
    from pico.bench.commits import CommitMode, Commits
    from pico.bench.goals import Goals, Optimized
    from pico.bench.lasers import Lasers
    from pico.bench.learning.learn import Twins
    from pico.bench.light import Lights
    from pico.bench.measurements import Measurements
    from pico.bench.mornings import Morning, Mornings
    from pico.bench.moves import Moves
    from pico.bench.pictures import Pictures
    from pico.bench.placing import Placing
    from pico.bench.plans import Plans
    from pico.bench.recovery import Recovery
    from pico.bench.running.execution import Execution
    from pico.bench.teleoperation import Teleoperation
    from pico.bench.updating import BenchLab
    from pico.bench.watching import Watch
    from pico.diagnostics import Diagnostic
    from pico.history.log import Log
    from pico.model.comparing.status import Status
    from pico.model.trace.expectation import Verified
    from pico.model.trace.report import Captured, Committed, RunReport


class Bench(Opened):
    """One bench with its services. Open it with `pico.open`; every call blocks until it is done."""

    @cached_property
    def plans(self) -> Plans:
        """Plans, and what they rest on."""
        from pico.bench.plans import Plans

        return Plans(self)

    @cached_property
    def moves(self) -> Moves:
        """Runs of plans, and films of them."""
        from pico.bench.moves import Moves

        return Moves(self)

    @cached_property
    def recovery(self) -> Recovery:
        """What to do after a run that was cut short."""
        from pico.bench.recovery import Recovery

        return Recovery(self)

    @cached_property
    def measurements(self) -> Measurements:
        """What the bench shows now, and whether that is as expected."""
        from pico.bench.measurements import Measurements

        return Measurements(self)

    @cached_property
    def goals(self) -> Goals:
        """What light is to be brought to, and how."""
        from pico.bench.goals import Goals

        return Goals(self)

    @cached_property
    def placing(self) -> Placing:
        """Parts that the arm brings to the light."""
        from pico.bench.placing import Placing

        return Placing(self)

    @cached_property
    def lasers(self) -> Lasers:
        """What lets lasers emit."""
        from pico.bench.lasers import Lasers

        return Lasers(self)

    @cached_property
    def mornings(self) -> Mornings:
        """What light has done overnight, and which part that tells of."""
        from pico.bench.mornings import Mornings

        return Mornings(self)

    @cached_property
    def pictures(self) -> Pictures:
        """Pictures, sheets and rulers."""
        from pico.bench.pictures import Pictures

        return Pictures(self)

    @cached_property
    def light(self) -> Lights:
        """Where beams run, and what they are like."""
        from pico.bench.light import Lights

        return Lights(self)

    @cached_property
    def cameras(self) -> Cameras:
        """The cameras over the table."""
        from pico.bench.cameras import Cameras

        return Cameras(self)

    @cached_property
    def twin(self) -> Twins:
        """The simulated bench, and what it learns from runs of the real one."""
        from pico.bench.learning.learn import Twins

        return Twins(self.folder, self.history, self.fidelity)

    @cached_property
    def drift(self) -> Watch:
        """Committed, desired and live side by side, and where the bench leaves HEAD."""
        from pico.bench.watching import Watch

        return Watch(self)

    @cached_property
    def commits(self) -> Commits:
        """Capturing and committing what stands on the bench."""
        from pico.bench.commits import Commits

        return Commits(self)

    @cached_property
    def lab(self) -> BenchLab:
        """The Lab that the bench keeps as its own, against that of the working tree."""
        from pico.bench.updating import BenchLab

        return BenchLab(self)

    # what scripts need most

    def plan(self, revision: str | None = None, **options: Any) -> Plan:
        """Return the plan to a revision, or to the manifest; see `Plans.plan`."""
        return self.plans.plan(revision, **options)

    def single(self, component: str, primitive: str, **arguments: object) -> Plan:
        """Return the plan of one operation: `single("p1", "set", angle=3)`, `single("p2", "move", x=500)` or
        `slot="storage/a4"`, `single("p1", "measure", measurable="angle")`; see `Plans.single`."""
        from pico.bench.plans import written

        return self.plans.single(component, primitive, {key: written(value) for key, value in arguments.items()})

    def run(self, plan: Plan, **options: Any) -> Execution:
        """Return the run of a plan: iterate over it for its events; see `Moves.run`."""
        return self.moves.run(plan, **options)

    def apply(self, what: Plan | str | None = None) -> RunReport:
        """Run a plan, or the plan to a revision (the manifest for None); see `Moves.apply`."""
        return self.moves.apply(what)

    def optimize(self, *goal: str, algorithm: str | None = None) -> Optimized:
        """Bring light to a goal, `optimize("centred")` or `optimize("center", "ly_150", "cam")`, and return what became
        of it; see `Goals`. Raises PicoError for what makes no sense, and where it can't be begun. A signal ends it at
        the best point before it does what it would have done."""
        came: list[int] = []
        _, found = self.goals.optimize(self.goals.plan(self.goals.chosen(goal, algorithm=algorithm)), came=came)
        if came:
            signal.raise_signal(came[0])
        return found

    def teleop(self, component: str, tunable: str | None = None) -> Teleoperation:
        """Return what steers a component, while it is entered: `with bench.teleop("p2", "pose") as jog:
        jog.step("x", 0.5)`; see `pico.bench.teleoperation`. Raises PicoError for what nobody can steer."""
        from pico.bench.teleoperation import Teleoperation

        return Teleoperation(self, self.plans.to_steer(component, tunable))

    def morning(self, *, accept: bool = False) -> Morning:
        """Read what a morning reads, with the arms still, and return what it tells; see `Mornings`. `accept`: it is the
        reference from now on. Raises PicoError where nothing can be read. A signal ends it, with all set back, before
        it does what it would have done."""
        came: list[int] = []
        found = self.mornings.read(self.mornings.survey(accept=accept), came=came)[1]
        if came:
            signal.raise_signal(came[0])
        return found

    def status(self) -> Status:
        """Return committed, desired and live side by side."""
        return self.drift.status()

    def verify(self, revision: str | None = None, *, measure: bool = False) -> Verified:
        """Return how the bench stands against a revision, or the manifest; see `Measurements.verify`. `measure`: with
        its goals, its expectations and its light measured. Raises PicoError."""
        if not measure:
            return self.measurements.verify(revision)
        found = self.measurements.to_verify(revision)
        report = self.apply(found.plan) if found.plan.operations else None
        return self.measurements.verify(revision, found.told, report)

    def capture(self, *only: str, write: bool = True) -> Captured:
        """Write what the bench shows otherwise than the manifest into the manifest; see `Commits.capture`."""
        return self.commits.capture(*only, write=write)

    def commit(self, message: str | None = None, mode: CommitMode = "strict", **options: Any) -> Committed:
        """Capture and commit the manifests; see `Commits.commit`."""
        return self.commits.commit(message, mode, **options)

    def state_at(self, revision: str) -> LabState:
        """Return the state that a revision holds; raises PicoError."""
        return self.folder.state_at(revision)

    def diff(self, a: str | None = None, b: str | None = None) -> tuple[Change, ...]:
        """Return what differs from revision `a` (HEAD) to `b` (the working tree), exactly; raises PicoError."""
        return self.folder.diff(a, b)

    def log(self, *revisions: str, **options: Any) -> Log:
        """Return the commits that changed the lab, newest first; see `LabHistory.log`."""
        return self.history.log(*revisions, **options)


def new_lab(folder: Path, example: str | None = None) -> tuple[Diagnostic, ...]:
    """Make a lab in `folder`: a skeleton to edit, or an example with its history; raises PicoError.

    Returns what is worth knowing: an example is a repository of its own, also inside another one.
    """
    from pico.history.examples.example import init_empty, make_example, nested

    if example is None:
        init_empty(folder)
        return ()
    around = nested(folder)
    make_example(example, folder)
    return around
