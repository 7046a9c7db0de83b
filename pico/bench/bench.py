"""The facade: `pico.open(path)` gives a `Bench`, which command line, scripts and server use. Composes everything else.

`AsyncBench` is the thing itself; `Bench` is its synchronous face over one private thread with an event loop.
"""

from __future__ import annotations

import signal
from collections.abc import Collection, Generator, Iterator, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from pico.backends.devices import SIMULATOR
from pico.bench.async_bench import AsyncBench, CommitMode
from pico.bench.running.attending import attend
from pico.bench.running.blocking import Execution, LoopThread
from pico.diagnostics import Diagnostic
from pico.history.reader import Reader
from pico.model.diff import Change
from pico.model.observation import Observation
from pico.model.plan import Plan

if TYPE_CHECKING:
    from pico.backends.sight import Look
    from pico.backends.world import World
    from pico.bench.bisecting import Bisection
    from pico.bench.drift import Drifted
    from pico.bench.importing import Imported
    from pico.bench.publishing import Published
    from pico.bench.updating import Proposal
    from pico.bench.watching import Told
    from pico.drawing.film.film import Caption
    from pico.drawing.picture import Image, View
    from pico.drawing.ruler import Measured
    from pico.history.data.lab import LabData
    from pico.history.git.commit import Commit
    from pico.history.merge.commits import MergeMade
    from pico.history.restoring.selected import SelectedParts
    from pico.history.restoring.stash import Stash
    from pico.history.restoring.transplant import Transplanted
    from pico.history.runs.comparing import Comparison
    from pico.model.expectation import Verified
    from pico.model.measurement import Measurement
    from pico.model.report import Captured, Committed, PartRow, RunReport
    from pico.model.run import Run
    from pico.model.status import Status
    from pico.planning.explaining.explain import Explanation
    from pico.planning.request import Preference
    from pico.runs.document import RecordedRun
    from pico.twin.snapshot import Recording
    from pico.vision.calibration import Calibration

__all__ = ["AsyncBench", "Bench", "CommitMode", "new_lab"]


class Bench(Reader):
    """The synchronous face of `AsyncBench`: same methods, same results, no `await`. Open it with `pico.open`."""

    def __init__(self, bench: AsyncBench) -> None:
        self._bench, self.folder = bench, bench.folder
        self._thread = LoopThread()

    @classmethod
    def open(
        cls,
        path: str | Path = ".",
        *,
        backend: str = SIMULATOR,
        fidelity: str | None = None,
        speed: float | None = None,
    ) -> Bench:
        """Open the lab that `path` lies in; see `AsyncBench.open`."""
        return cls(AsyncBench.open(path, backend=backend, fidelity=fidelity, speed=speed))

    def close(self) -> None:
        """Let go of the backend and end the private thread; one left busy by Ctrl-C is not waited for."""
        if self._thread.started:
            if not self._thread.left_busy:
                self._thread.wait(self._bench.close())
            self._thread.close()

    def __enter__(self) -> Bench:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def sim(self) -> World:
        """The simulated world, to be changed as a hand would."""
        return self._bench.sim

    def wait_until_free(self, seconds: float) -> None:
        """Wait until nobody moves the bench; raises PicoError (exit code LOCKED) where that takes longer."""
        self._thread.wait(self._bench.wait_until_free(seconds))

    def observe(self) -> Observation:
        """Look, and return what was seen."""
        return self._thread.wait(self._bench.observe())

    def scan(self) -> Look:
        """Look at the table through its cameras; see `pico.bench.looking.scan`."""
        from pico.bench import looking

        return self._thread.wait(looking.scan(self._bench))

    def import_parts(self, types: Sequence[str] = (), *, write: bool = True) -> Imported:
        """Take what stands on the table and is not in the inventory into it; see `pico.bench.importing`."""
        from pico.bench import importing

        wanted = importing.read_types(types)
        parts = importing.importable(self._bench, self.scan(), wanted)
        found = importing.take_in(self._bench, parts, write=write)
        if found.parts and write:
            self.adopt()
        return found

    def calibrate(self) -> Calibration:
        """Find out where the cameras are, and write it; see `pico.bench.looking.calibrate`."""
        from pico.bench import looking

        return looking.calibrate(self._bench)

    def scan_picture(self, look: Look, *, out: Path | None = None, component: str | None = None) -> Image:
        """Return a camera's picture of a scan, with names drawn in; see `pico.bench.looking.picture`."""
        from pico.bench import looking

        return looking.picture(self._bench, look, out, component)

    def plan(
        self,
        revision: str | None = None,
        *,
        exact: bool = False,
        prefer: Preference = "fewest-moves",
        targets: Collection[str] = (),
        exclude: Collection[str] = (),
        expecting: bool = True,
    ) -> Plan:
        """Return the plan to a revision, or to the manifest; see `AsyncBench.plan`."""
        options: dict[str, Any] = {"prefer": prefer, "targets": targets, "exclude": exclude, "expecting": expecting}
        return self._thread.wait(self._bench.plan(revision, exact=exact, **options))

    def plan_of(self, word: str | None, *, folder: Path = Path(), **options: Any) -> Plan:
        """Return the saved plan that `word` names, or the plan to the revision that it names."""
        return self._thread.wait(self._bench.plan_of(word, folder=folder, **options))

    def require_fresh(self, plan: Plan) -> None:
        """Raise PicoError (exit code STALE) where a saved plan does not fit any more; see `pico.bench.saved_plans`."""
        from pico.bench import saved_plans

        self._thread.wait(saved_plans.require_fresh(self._bench, plan))

    def refreshed(self, plan: Plan) -> Plan:
        """Return a new plan to the goal of a saved one; see `pico.bench.saved_plans`."""
        from pico.bench import saved_plans

        return self._thread.wait(saved_plans.refreshed(self._bench, plan))

    def proposal(self) -> Proposal:
        """Return what the working tree would have the bench be; see `pico.bench.updating`."""
        from pico.bench import updating

        return updating.proposal(self.root)

    def adopt(self) -> None:
        """Let the bench adopt what the working tree proposes; see `pico.bench.updating`."""
        from pico.bench import updating

        self.folder.adopt(self._thread.wait(updating.adopt(self._bench.edge, self.root)))

    def explain(self, plan: Plan, component: str | None = None) -> Explanation:
        """Return why a plan is as it is; see `AsyncBench.explain`."""
        return self._bench.explain(plan, component)

    def parts_at(self, revision: str, names: Sequence[str]) -> SelectedParts:
        """Return what the manifests must say for parts of a state to be as in a revision; see `restoring.checked`."""
        from pico.history.restoring import checked

        return checked.select_parts(self.folder, revision, names)

    def checkout_plan(self, revision: str | SelectedParts, *, exact: bool = False) -> Plan:
        """Return the plan to a revision, or to a part of one, that is about to be checked out."""
        return self._thread.wait(self._bench.checkout_plan(revision, exact=exact))

    def checkout_files(self, revision: str | SelectedParts) -> None:
        """Check a revision, or a part of one, out. Moves nothing; see `AsyncBench.checkout_files`."""
        self._bench.checkout_files(revision)

    def single(self, component: str, primitive: str, arguments: Mapping[str, str] | None = None) -> Plan:
        """Return the plan of one primitive; see `AsyncBench.single`."""
        return self._thread.wait(self._bench.single(component, primitive, arguments))

    def place(self, component: str, *, after: str, distance: float) -> Plan:
        """Return the plan that places a component `distance` mm after another along its beam."""
        return self._thread.wait(self._bench.place(component, after=after, distance=distance))

    def runs(self, revision: str | None = None, **options: Any) -> tuple[tuple[Run, Commit | None], ...]:
        """Return the runs that commits carry, and those that none has yet; see `runs.listing.list_runs`."""
        from pico.history.runs.listing import list_runs

        return list_runs(self.folder, revision, **options)

    def recorded_run(self, word: str | None = None) -> tuple[RecordedRun, Commit | None]:
        """Return a run by the beginning of its id, the last one for None; see `pico.history.runs.loading.load_run`."""
        from pico.history.runs.loading import load_run

        return load_run(self.folder, word)

    def compare_runs(self, a: str, b: str) -> Comparison:
        """Return two runs side by side; see `pico.history.runs.comparing`."""
        from pico.history.runs.comparing import compare_runs

        return compare_runs(self.setup, self.recorded_run(a)[0], self.recorded_run(b)[0])

    def run(self, plan: Plan, **options: Any) -> Execution:
        """Return the run of a plan: iterate over it for its events. `options`: see `AsyncBench.run`."""
        return Execution(self._bench.run(plan, **options), self._thread)

    def resume_plan(self) -> tuple[Plan, str]:
        """Return the plan to the goal of the last run, and its id; see `pico.bench.resuming`."""
        from pico.bench import resuming

        return self._thread.wait(resuming.resume_plan(self._bench))

    def undo_plan(self) -> Plan:
        """Return the plan back to before the last run; see `pico.bench.resuming`."""
        from pico.bench import resuming

        return self._thread.wait(resuming.undo_plan(self._bench))

    def recover_plan(self) -> Plan:
        """Return the plan that sets down what hands still hold; see `pico.bench.resuming`."""
        from pico.bench import resuming

        return self._thread.wait(resuming.recover_plan(self._bench))

    def settle(self) -> None:
        """Record what became of operations that a killed run had begun; see `pico.bench.resuming`."""
        from pico.bench import resuming

        self._thread.wait(resuming.settle(self._bench))

    def open_questions(self) -> list[Diagnostic]:
        """Return what only a person can tell of the last runs."""
        from pico.bench import resuming

        return resuming.open_questions(self._bench)

    def answer(self, key: str, *, done: bool) -> None:
        """Record what a person says of an operation that only a person can tell the end of; raises PicoError."""
        from pico.bench import resuming

        self._thread.wait(resuming.answer(self._bench, key, "done" if done else "failed"))

    def film(
        self, recording: Recording, out: Path, *, captions: Sequence[Caption] = (), fps: float = 12.0
    ) -> Generator[tuple[int, int], None, None]:
        """Write a film of a run to `out`; see `AsyncBench.film`."""
        return self._bench.film(recording, out, captions=captions, fps=fps)

    def apply(self, what: Plan | str | None = None) -> RunReport:
        """Run a plan, or plan to a revision (the manifest for None) and run that; return what became of it.

        In the main thread Ctrl-C, SIGTERM and SIGHUP halt the run at a safe waypoint (see `attending.interrupts`)
        before they do what they would have done.
        """
        run = self.run(what if isinstance(what, Plan) else self.plan(what))
        came = attend(run)
        if came:
            signal.raise_signal(came[0])
        return run.report

    def status(self) -> Status:
        """Return committed, desired and live side by side."""
        return self._thread.wait(self._bench.status())

    def drift(self) -> tuple[Change, ...]:
        """Return where the bench as observed differs from HEAD."""
        return self._thread.wait(self._bench.drift())

    def look(self) -> Drifted:
        """Return where the bench has left HEAD, by how much, how surely and who did it; see `pico.bench.drift`."""
        from pico.bench import drift

        return self._thread.wait(drift.look(self._bench))

    def heal(self, found: Drifted) -> RunReport | None:
        """Bring back what drifted, where the lab's policy allows it; see `pico.bench.drift`."""
        from pico.bench import drift

        plan = self._thread.wait(drift.heal_plan(self._bench, found))
        return self.apply(plan) if plan else None

    def watch(self, *, interval: float = 10.0, looks: int | None = None, heal: bool = False) -> Iterator[Told]:
        """Look again and again, `interval` s apart, and `heal` where the lab's policy allows it; see `watching`."""
        from pico.bench import drift
        from pico.bench.watching import watch

        if heal:
            drift.require_heal(self.setup)
        return watch(self.look, self.heal if heal else None, interval, looks)

    def to_measure(self, revision: str | None = None) -> Plan:
        """Return the plan that measures what expectations speak of; see `AsyncBench.to_measure`."""
        return self._thread.wait(self._bench.to_measure(revision))

    def verify(
        self, revision: str | None = None, measurements: Mapping[str, Measurement] = MappingProxyType({})
    ) -> Verified:
        """Return how the bench stands against a revision, or the manifest, and its expectations."""
        return self._thread.wait(self._bench.verify(revision, measurements))

    def expected(self, plan: Plan) -> Verified:
        """Return what became of the expectations of a plan's goal, which the bench has reached already."""
        return self._thread.wait(self._bench.expected(plan))

    def parts(self, *, free: bool = False) -> tuple[PartRow, ...]:
        """Return the inventory with where each part is."""
        return self._thread.wait(self._bench.parts(free=free))

    def read(self, component: str, tunable: str | None = None) -> dict[str, dict[str, Any]]:
        """Return the tunables of a component as observed."""
        return self._thread.wait(self._bench.read(component, tunable))

    def capture(self, *only: str, write: bool = True) -> Captured:
        """Write what the bench shows otherwise than the manifest into the manifest; see `AsyncBench.capture`."""
        return self._thread.wait(self._bench.capture(*only, write=write))

    def commit(self, message: str | None = None, mode: CommitMode = "strict", **options: Any) -> Committed:
        """Capture and commit the manifests; see `AsyncBench.commit`."""
        return self._thread.wait(self._bench.commit(message, mode, **options))

    def draft(self, mode: CommitMode = "strict", **options: Any) -> str:
        """Return the message that `commit` writes where nobody says why."""
        return self._thread.wait(self._bench.draft(mode, **options))

    def bisect(self, bad: str, good: str, **options: Any) -> Bisection:
        """Begin to search for the commit that broke something; see `pico.bench.bisecting.begin`."""
        from pico.bench import bisecting

        return bisecting.begin(self, bad, good, **options)

    def bisection(self, **options: Any) -> Bisection:
        """Return the bisection under way; see `pico.bench.bisecting.under_way`."""
        from pico.bench import bisecting

        return bisecting.under_way(self, **options)

    def merge(self, revision: str, message: str = "") -> MergeMade:
        """Merge a revision into what is checked out, where the result can stand on the table; see `merge.checked`."""
        from pico.history.merge.checked import merge

        return merge(self.folder, revision, message)

    @property
    def data(self) -> LabData:
        """The large data of the lab's runs: what is needed, here and where copies are kept; see `history.data.lab`."""
        from pico.history.data.lab import LabData

        return LabData(self.folder.history())

    def publish(self, revision: str = "HEAD", out: Path | None = None, **options: Any) -> Published:
        """Write a revision with its runs and pictures as an RO-Crate; see `pico.bench.publishing.publish`."""
        from pico.bench.publishing import publish

        return publish(self.folder, revision, out, **options)

    def revert(
        self, revision: str, message: str = "", *, mainline: int | None = None, commit: bool = True
    ) -> Transplanted:
        """Take back what a revision changed, in the manifests; see `pico.history.restoring.checked`."""
        from pico.history.restoring import checked

        return checked.revert(self.folder, revision, message=message, mainline=mainline, commit=commit)

    def cherry_pick(
        self, revisions: Sequence[str], *, mainline: int | None = None, commit: bool = True
    ) -> tuple[Transplanted, ...]:
        """Do once more what revisions changed, in the manifests; see `pico.history.restoring.checked`."""
        from pico.history.restoring import checked

        return checked.cherry_pick(self.folder, revisions, mainline=mainline, commit=commit)

    @property
    def stash(self) -> Stash:
        """The stash of the repository: edits of the manifests that are shelved; see `pico.history.restoring.stash`."""
        from pico.history.restoring.stash import Stash

        return Stash(self.folder)

    def render(
        self,
        revision: str | None = None,
        *,
        manifest: bool = False,
        view: View = "perspective",
        plan: bool | Plan = False,
        size: tuple[int, int] = (960, 720),
        out: Path | None = None,
    ) -> Image:
        """Return a picture (height, width, 3) of the bench; see `AsyncBench.render`."""
        return self._thread.wait(
            self._bench.render(revision, manifest=manifest, view=view, plan=plan, size=size, out=out)
        )

    def render_diff(self, a: str | None = None, b: str | None = None, *, out: Path | None = None) -> Image:
        """Return a picture of how state `a` becomes `b`; see `AsyncBench.render_diff`."""
        return self._bench.render_diff(a, b, out=out)

    def sheet(self, revision: str | None = None, *, manifest: bool = False) -> str:
        """Return a drawing as SVG with its parts list; see `AsyncBench.sheet`."""
        return self._thread.wait(self._bench.sheet(revision, manifest=manifest))

    def ruler(self, a: str, b: str) -> Measured:
        """Return how far two things on the bench are from each other; see `AsyncBench.ruler`."""
        return self._thread.wait(self._bench.ruler(a, b))

    def view(self) -> None:
        """Open MuJoCo's own viewer on the bench; see `AsyncBench.view`."""
        self._thread.wait(self._bench.view())

    def render_ruler(self, measured: Measured, *, out: Path | None = None) -> Image:
        """Return a picture of what `ruler` found; see `AsyncBench.render_ruler`."""
        return self._thread.wait(self._bench.render_ruler(measured, out=out))


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
