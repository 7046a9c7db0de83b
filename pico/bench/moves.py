"""Moving the bench: a plan is run, somebody attends it, and a film of it can be written."""

from __future__ import annotations

import signal
from collections.abc import Generator, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pico.bench.opened import Opened
from pico.bench.plans import Plans
from pico.diagnostics import PicoError, error
from pico.edge.network.opening import line_of
from pico.model.plan import Plan

if TYPE_CHECKING:
    from pico.bench.running.execution import Execution
    from pico.drawing.film.film import Caption
    from pico.model.trace.report import RunReport
    from pico.runs.memory import Memory
    from pico.twin.snapshot import Recording


class Moves:
    """Runs of plans on one bench."""

    def __init__(self, opened: Opened) -> None:
        self.opened = opened

    def run(self, plan: Plan, **options: Any) -> Execution:
        """Return the run of a plan: iterate over it for its events, then read its `report`.

        `options`: `recording`, which gets what a film of the run shows, see `film`; `resumes`: the run that goes on
        under its id; `stop_on_error`: the first failure lets nothing more start.
        """
        from pico.bench.running.execution import Execution
        from pico.edge.running import new_run_id

        opened = self.opened
        opened.suit(plan)
        named = partial(self._goal_now, plan)
        options = {"wait": opened.lock_timeout, "speed": opened.speed, **options}
        if opened.recording is not None:
            options |= {"within": opened.recording, "run_id": new_run_id()}
        return Execution(plan, opened.edge_for(plan.operations), opened.thread, named, **options)

    def leave(self, plan: Plan, **options: Any) -> str:
        """Have a plan run by the process that serves the bench, and leave it to that; return the run's id. Raises
        PicoError where this process is the bench, and as `run` does."""
        return self.left(plan, **options).leave()

    def left(self, plan: Plan, **options: Any) -> Execution:
        """Return the run of a plan that is to be left to the process that serves the bench; raises PicoError where this
        process is the bench."""
        if line_of(self.opened.place) is None:
            text = "this process is the bench: what it runs ends with it"
            hint = "`pico edge` in another terminal serves it, or `--bench LAB/BENCH` means one that is"
            raise PicoError(error("detach", text, hint=hint))
        return self.run(plan, **options)

    def follow(self, word: str | None = None) -> Execution:
        """Return a run that the bench has under way, or had lately, whose id begins or ends with `word` (None: the one
        that goes on): iterate over it for its events, then read its `report`. It goes on whoever looks on. Raises
        PicoError where there is none."""
        from pico.bench.running.execution import Execution
        from pico.model.plan import plan_from_json

        memory = self.opened.edge.memory
        run = self._meant(memory, word)
        document = memory.document(run) if memory else None
        if document is None:
            raise PicoError(error("no-run", f"nothing is known of how run {run} began", hint="`pico runs`"))
        plan = plan_from_json(document)
        return Execution(plan, self.opened.edge, self.opened.thread, run_id=run, follows=True)

    def _meant(self, memory: Memory | None, word: str | None) -> str:
        if word is None:
            going = self.opened.wait(self.opened.edge.unended())
            if going is None:
                hint = "`pico runs` lists those that are over"
                raise PicoError(error("no-run", "no run goes on", hint=hint))
            return going
        known = [run.run for run in memory.runs()] if memory else []
        found = [run for run in known if run.startswith(word) or run.endswith(word)]
        if len(found) != 1:
            text = (
                f"{len(found)} runs are called {word[:40]}" if found else f"there is no run {word[:40]} on this bench"
            )
            raise PicoError(error("no-run", text, hint="`pico runs` lists them"))
        return found[0]

    def apply(self, what: Plan | str | None = None) -> RunReport:
        """Run a plan, or plan to a revision (the manifest for None) and run that; return what became of it.

        In the main thread Ctrl-C, SIGTERM and SIGHUP halt the run at a safe waypoint (see `attending.interrupts`)
        before they do what they would have done.
        """
        from pico.bench.running.attending import attend

        run = self.run(what if isinstance(what, Plan) else Plans(self.opened).plan(what))
        came = attend(run)
        if came:
            signal.raise_signal(came[0])
        return run.report

    def _goal_now(self, plan: Plan) -> str:
        """Return what a plan leads to as a person calls it, and that it is not that any more where it was edited since
        or a name in Git leads elsewhere."""
        target, folder = plan.target, self.opened.folder
        if target.revision:
            try:
                same = folder.history().resolve(target.revision).id == target.commit
            except PicoError:
                same = False
            return target.name if same else f"{target.name} as it was when it was planned ({str(target.commit)[:7]})"
        state = None if target.title else folder.state_now()
        if target.title or (state and state.as_json() == dict(target.state)):
            return target.name
        return f"{target.name} as it was when it was planned; it was edited since"

    def film(
        self, recording: Recording, out: Path, *, captions: Sequence[Caption] = (), fps: float = 12.0
    ) -> Generator[tuple[int, int], None, None]:
        """Write a film of a run to `out`, .mp4 or .gif, in simulated time, `fps` pictures a second.

        Yields (pictures done, of how many); ended early, the film is what was done until then. Raises PicoError.
        """
        from pico.drawing.film.film import write_film

        return write_film(self.opened.setup, recording.snapshots, out, captions=captions, fps=fps)
