"""What steps do things by: the bench, and the run of the recipe that they belong to."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from pico.diagnostics import ExitCode, PicoError, error
from pico.model.trace.question import Answer, Question
from pico.scripting.outcome import require_done, require_possible

if TYPE_CHECKING:
    from pico.bench.bench import Bench
    from pico.bench.teleoperation import Teleoperation
    from pico.model.measurement import Measurement
    from pico.model.plan import Plan
    from pico.model.trace.event import Event
    from pico.recipes.one_run import OneRun


def _deaf(_: object) -> None:
    return None


def nobody(question: Question) -> Answer:
    """Answer a question where nobody is there; raises PicoError."""
    raise alone(question.text)


def alone(what: str) -> PicoError:
    """Return that nobody is there to do something."""
    hint = "run it at a terminal; or give the step `unattended: skip`"
    return PicoError(error("unattended", f"nobody is there to be asked: {what}", hint=hint))


def nobody_steers(jog: Teleoperation) -> None:
    """Refuse to steer where nobody is there; raises PicoError."""
    raise alone(f"steer {jog.operation.component}")


@dataclass
class Doing:
    """One recipe under way on a bench.

    `recipe`, `step`: what runs are recorded as caused by; `one`: the open run that the step is done in, None where it
    has runs of its own. `begin` is told the id of each run before it begins;
    `begun`: runs that this step began before it was cut short, as it was where it is done `again`. `head`: the commit
    checked out when it first began. `attended`: a person is there, to whom `ask` puts questions, and who can `steer`;
    `show` hears events, `say` what a signal leads to. `unattended`: nobody is there, and the recipe is held to what it
    states of that: `allow` is asked about each plan before it is run, `watch` after every `every` seconds of waiting.
    """

    bench: Bench
    recipe: str = ""
    step: str = ""
    one: OneRun | None = None
    begun: Sequence[str] = ()
    again: bool = False
    attended: bool = False
    head: str | None = None
    begin: Callable[[str], None] = _deaf
    ask: Callable[[Question], Answer] = nobody
    steer: Callable[[Teleoperation], object] = nobody_steers
    show: Callable[[Event], None] = _deaf
    say: Callable[[str], None] = _deaf
    unattended: bool = False
    allow: Callable[[Plan], None] = _deaf
    watch: Callable[[], None] = lambda: None
    every: float = math.inf

    def run(self, plan: Plan) -> Mapping[str, Measurement]:
        """Run a plan, and return what was measured in it; raises PicoError where it can't be run, or fails.

        A plan that only measures and was carried out before the recipe was cut short is not run again.
        """
        from pico.bench.running.attending import attend
        from pico.edge.protocol import RECIPE
        from pico.edge.running import new_run_id
        from pico.recipes.taken_up import measured_before

        if self.one is not None:
            plan = plan.with_ids(f"{self.step}:")
        plan = plan.for_recipe(self.recipe, self.step)
        if not require_possible(plan).operations:
            return {}
        if (before := measured_before(self.bench, self.begun, self.step, plan)) is not None:
            return before
        self.allow(plan)
        run_id = self.one.begin() if self.one is not None else new_run_id()
        self.begin(run_id)
        run = self.bench.moves.run(plan, holder=f"{RECIPE} {self.recipe}", run_id=run_id)
        came = attend(run, self.show, self.say)
        report = run.report
        if came or report.exit_code == ExitCode.INTERRUPTED:
            why = [found for found in report.diagnostics if found.severity != "note"]
            raise PicoError([error("interrupted", f"interrupted at step {self.step}"), *why], ExitCode.INTERRUPTED)
        return require_done(report).measurements

    def pause(self, seconds: float) -> None:
        """Let time pass on the bench's clock [s]: a simulated one passes at once. Raises PicoError (exit code DENIED)
        where a sample would have too much light by then."""
        from pico.policy.dose import over

        doses = self.bench.wait(self.bench.edge.doses()) if seconds > 0 else ()
        given = [(one, math.inf if one.unknown else one.power * seconds) for one in doses]
        if wrong := [found for one, mj in given if mj > 0 for found in over(one, mj, seconds, one.unknown or "")]:
            raise PicoError(wrong, ExitCode.DENIED)
        while seconds > 0:
            part = min(seconds, self.every)
            if self.bench.wait(self.bench.edge.describe()).simulated:
                self.bench.sim.wait(part)
            else:
                time.sleep(part)
            seconds -= part
            if seconds > 0:
                self.watch()
