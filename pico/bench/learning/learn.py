"""The twin of a bench, and what it learns from runs: `pico calibrate twin`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from datetime import datetime
from typing import TYPE_CHECKING

from pico.base import clock
from pico.diagnostics import Diagnostic, PicoError, error
from pico.history.lab.folder import LabFolder
from pico.history.lab_history import LabHistory
from pico.model.trace.run import STRENGTH, Run
from pico.twin.learned import read_learned, write_learned

if TYPE_CHECKING:
    from pico.model.trace.learned import Learned
    from pico.runs.document import RecordedRun
    from pico.runs.learning import Lesson, Row
    from pico.runs.lessons import Lessons


class Twins:
    """The twin of one bench."""

    def __init__(self, folder: LabFolder, history: LabHistory, fidelity: str) -> None:
        self.folder, self.history, self.fidelity = folder, history, fidelity

    def learn(self, *runs: str, since: str | None = None, write: bool = True) -> Lesson:
        """Let the twin learn how parts scatter, how long operations take and how cameras see from recorded runs, and
        write that into the lab's folder unless told not to.

        `runs`: the beginning or end of ids, or ranges `A..B` of revisions; without any, all of the bench itself, and
        those of emulated devices where there are none. `since`: only those begun then or later (ISO 8601). Raises
        PicoError where there are none, or nothing can be read.
        """
        from pico.runs.learning import learn, looks_of
        from pico.runs.lessons import lessons

        setup, root, wrong = self.folder.setup, self.folder.root, list[Diagnostic]()
        chosen = self._chosen(runs, since, wrong)
        recorded = self._loaded(chosen, wrong)
        told, had = lessons(setup, recorded), read_learned(root)
        found = learn(setup, told, had, 0.0 if self.fidelity == "kinematic" else 1.0)
        weakest = min((run.evidence for run in chosen), key=lambda one: STRENGTH[one])
        learned = replace(
            found.learned, made_at=clock.now(), evidence=weakest,
            runs=tuple(sorted(run.id for run in chosen)), looks=looks_of(told),
        )  # fmt: skip
        learned, rows = self._looked(told, learned, had)
        if write:
            write_learned(root, learned)
        return replace(
            found, learned=learned, rows=(*found.rows, *rows), diagnostics=(*wrong, *found.diagnostics), written=write
        )

    def _looked(self, told: Lessons, learned: Learned, had: Learned | None) -> tuple[Learned, tuple[Row, ...]]:
        """Return what was learned with how noisy cameras are, and what was learned before where looks tell nothing."""
        from pico.bench.learning.looks import noise_of
        from pico.runs.learning import Row

        setup, root, looks = self.folder.setup, self.folder.root, learned.looks
        before = had.noise if had else None
        own = setup.lab.sim.errors.noise if before is None else before
        stood = {name: pose for name, pose in told.stood.items() if told.looked.get(name)}
        found = noise_of(setup, root, stood, looks, own) if looks and stood else None
        if looks is None or found is None:
            return replace(learned, noise=before), ()
        pairs = zip((looks.position, looks.yaw), found.before, found.after, ("mm", "deg"), strict=True)
        rows = tuple(
            Row(what=f"a look, {'position' if unit == 'mm' else 'yaw'}", unit=unit, count=one.count, before=was,
                measured=one.value, sigma=one.sigma, after=now)
            for one, was, now, unit in pairs if one is not None
        )  # fmt: skip
        position, yaw = looks.position, looks.yaw
        looks = replace(
            looks, position=position and replace(position, before=found.before[0]),
            yaw=yaw and replace(yaw, before=found.before[1]),
        )  # fmt: skip
        return replace(learned, looks=looks, noise=found.noise), rows

    def _chosen(self, words: Sequence[str], since: str | None, wrong: list[Diagnostic]) -> tuple[Run, ...]:
        """Return the documents of the runs that are meant, each once, the oldest first."""
        history, begin = self.history, _moment(since) if since else None
        found: dict[str, Run] = {}
        every = [run for run, _ in history.runs(every=True, diagnostics=wrong)]
        known = {run.id: run for run in every}
        for word in words:
            if ".." in word:
                found |= {run.id: run for run, _ in history.runs(word, diagnostics=wrong)}
            else:
                run = known.get(word) or history.recorded_run(word)[0].document
                found[run.id] = run
        if not words:
            best = next((e for e in ("hardware", "emulated") if any(run.evidence == e for run in every)), None)
            found = {run.id: run for run in every if run.evidence == best}
        kept = [run for run in found.values() if begin is None or _moment(run.started_at) >= begin]
        if not kept:
            what = "no run of the bench itself" if not words else "none of these runs"
            text = f"the twin has nothing to learn from: there is {what}{f' since {since}' if since else ''}"
            hint = "`pico apply --backend hardware` makes some; those of the simulator count where they are named"
            raise PicoError(error("no-run", text, hint=hint))
        return tuple(sorted(kept, key=lambda run: run.order))

    def _loaded(self, chosen: Sequence[Run], wrong: list[Diagnostic]) -> tuple[RecordedRun, ...]:
        from pico.history.runs.loading import load_runs

        return load_runs(self.folder, [run.id for run in chosen], wrong)


def _moment(text: str) -> datetime:
    try:
        return clock.parse_utc(text)
    except ValueError:
        hint = "as `2026-11-20` or `2026-11-20T08:00`, UTC"
        raise PicoError(error("usage", f"`{text[:40]}` is no day and no time", hint=hint)) from None
