"""The files of the runs of a bench that no commit has yet.

Which runs: those that began to move something, are over, and that no commit has yet which a branch or tag reaches. So
a run is carried by the commit of the state that it led to, or by the next one where that failed or was thrown away.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from pathlib import Path

from pico.base import clock
from pico.diagnostics import Diagnostic, PicoError
from pico.edge.network.opening import holder_of, remembered
from pico.edge.network.remotes import Far
from pico.history.lab.folder import LabFolder
from pico.history.runs.committed import find_runs, read_place
from pico.history.runs.proof import Standings
from pico.model.comparing.drift import drift_of
from pico.model.observation import Observation, live_state
from pico.model.state import LabState
from pico.model.trace.expectation import Standing
from pico.model.trace.run import FOLD, TRIALS, GoalStood, Run
from pico.places.bench import BenchPlace
from pico.runs.document import RecordedRun, recorded
from pico.runs.files import DOCUMENT, MEASUREMENTS, TRACE, Keep, run_files, run_folder
from pico.runs.folding import fold
from pico.runs.journal import RunRecord
from pico.runs.states import changes

MOST_OF_OTHERS = 50
"""How many runs that others began at a bench are shown, the last ones."""


def pending(
    folder: LabFolder, seen: Observation | None = None, state: LabState | None = None,
    goals: Mapping[str, GoalStood] | None = None,
) -> dict[str, bytes]:  # fmt: skip
    """Return the files of the runs that the next commit takes, by path relative to the lab; raises PicoError.

    Single operations that came one after the other are folded into one. Trials of a search stay where they are.

    `seen`: the bench as it is, which makes the `state` that is to be committed (None: that of the manifests) the one to
    which the last run led, where it stands so (see `Run.state_after`), and `goals` how those then stand. What is too
    big for a commit goes to the content store of the repository. What a commit that failed left of them in the working
    tree goes.
    """
    runs = unrecorded(folder)
    if isinstance(folder.place, Far):
        from pico.edge.network.arrays import bring
        from pico.edge.network.line import line_to

        bring(
            folder.place,
            line_to(folder.place),
            [one.sha256 for run in runs for one in run.document.artifacts if one.shape],
        )
    here = [i for i, run in enumerate(runs) if seen and is_awaited(run.document) and _of(run.document, seen)]
    if here and seen is not None:  # what moved a simulated bench says nothing of a real one, and the other way around
        runs[here[-1]] = _committed(folder, runs[here[-1]], seen, state or folder.state, goals)
    files: dict[str, bytes] = {}
    for run in fold(folder.setup, runs):
        if is_awaited(run.document):
            files |= run_files(run.document, run.trace, run.measurements, keep=_keep(folder))
    _clear(folder.root, runs, files)
    return files


def awaited(folder: LabFolder) -> bool:
    """Return whether the next commit has a run to take; raises PicoError."""
    return any(is_awaited(run.document) for run in unrecorded(folder))


def is_awaited(document: Run) -> bool:
    """Return whether a run that no commit has is for the next one: trials lead to no state that anybody wants, and
    stay in the journal of their bench."""
    return document.cause.kind not in TRIALS


def _of(document: Run, seen: Observation) -> bool:
    return document.environment.get("backend") in (None, seen.backend)


def unrecorded(folder: LabFolder, diagnostics: list[Diagnostic] | None = None) -> list[RecordedRun]:
    """Return the runs of this bench that no commit has yet, in the order in which they began.

    A journal that can't be read raises PicoError; where there are `diagnostics`, that is appended to them, and there
    are no runs: looking must not fail for it.
    """
    try:
        return _unrecorded(folder)
    except PicoError as exc:
        if diagnostics is None:
            raise
        diagnostics += exc.diagnostics
        return []


def of_others(folder: LabFolder, word: str = "", diagnostics: list[Diagnostic] | None = None) -> list[RecordedRun]:
    """Return the runs that others began at a bench that is shared, and that no commit here has, in the order in which
    they began: the last `MOST_OF_OTHERS`, of those whose id begins or ends with `word`; no commit of this checkout
    takes them. What can't be read raises PicoError, or is appended to `diagnostics`."""

    def those(folder: LabFolder, runs: Iterable[RunRecord]) -> Iterable[RunRecord]:
        every = list(runs)
        own = {run.run for run in _own(folder, every)}
        left = [r for r in every if r.run not in own and (r.run.startswith(word) or r.run.endswith(word))]
        return left[-MOST_OF_OTHERS:]

    try:
        return _unrecorded(folder, those)
    except PicoError as exc:
        if diagnostics is None:
            raise
        diagnostics += exc.diagnostics
        return []


def _unrecorded(
    folder: LabFolder, those: Callable[[LabFolder, Iterable[RunRecord]], Iterable[RunRecord]] | None = None
) -> list[RecordedRun]:  # fmt: skip
    place = folder.place
    if place is None or (isinstance(place, BenchPlace) and place.folder.resolve() != place.own.resolve()):
        return []  # they are carried by what is committed in the worktree that has the bench
    with remembered(place) as memory:
        if memory is None:
            return []
        moving = memory.moving()
        over = [
            run for run in (those or _own)(folder, memory.runs()) if run.run in moving and not _goes_on(folder, run)
        ]
        carried = _carried(folder, over)
        fresh = ((run, part) for run in over if (part := carried.get(run.run, -1) + 1) <= run.resumed)
        found = (recorded(folder.setup, memory, run, part) for run, part in fresh)
        return [replace(one, document=replace(one.document, bench=place.title)) for one in found if one is not None]


def standing_of(folder: LabFolder, revision: str | None = None) -> Standing | None:
    """Return the standing of a revision, HEAD where None, with what this bench alone knows yet; None where there is no
    commit. Raises PicoError for an unknown revision."""
    head = folder.head()
    if revision is None and (head is None or head.commit is None):
        return None
    wrong: list[Diagnostic] = []
    own = [run.document for run in unrecorded(folder, wrong)]
    found = Standings(folder, own, wrong).of(folder.history().resolve(revision or "HEAD"))
    return replace(found, diagnostics=(*wrong, *found.diagnostics))


def _carried(folder: LabFolder, runs: list[RunRecord]) -> dict[str, int]:
    """Return the runs that commits have, each with how often it had been taken up again by then."""
    if folder.repository is None:
        return {}
    of = {name: run for run in runs for name in _names(run)}
    places = find_runs(folder.repository, folder.root, {name: _seconds(run.started_at) for name, run in of.items()})
    found: dict[str, int] = {}
    for name, place in places.items():
        run = of[name]
        document = read_place(folder.repository, place) if run.resumed else None
        resumed = document.resumed if isinstance(document, Run) else run.resumed
        found[run.run] = max(found.get(run.run, 0), resumed)
    return found


def _names(run: RunRecord) -> list[str]:
    """Return what the documents of a run may be called: once it was carried, what came later has names of its own."""
    return [run.run, *(f"{run.run}-r{n}" for n in range(1, run.resumed + 1))]


def _committed(
    folder: LabFolder, run: RecordedRun, seen: Observation, state: LabState, goals: Mapping[str, GoalStood] | None
) -> RecordedRun:
    """Return the last run, as leading to the `state` that is committed, where the bench stands so."""
    live, after = live_state(folder.setup, seen), run.after
    assert after is not None  # of a journal
    since = changes(folder.setup, after, live, after.components.keys() | live.components.keys())
    document = replace(run.document, afterwards=tuple(c for c in since if not c.tolerated), goals=goals)
    if not any(not c.tolerated for c in drift_of(folder.setup, seen, state)):
        document = replace(document, state_after=state.digest())
    return replace(run, document=document)


def _keep(folder: LabFolder) -> Keep | None:
    """Return what takes large data: the store that all worktrees of the repository share."""
    from pico.content.store import store_in

    return store_in(folder.repository.common).put if folder.repository else None


def _own(folder: LabFolder, runs: Iterable[RunRecord]) -> Iterable[RunRecord]:
    """Return the runs that this checkout is to carry: on a bench that it shares with others those that it began. That
    which `pico gui` serves is its own, whatever the address was at which it did so."""
    if not isinstance(folder.place, Far) or folder.place.local:
        return runs
    from pico.edge.network.session import runs_begun

    begun = frozenset(runs_begun(folder.place.folder))
    return [run for run in runs if run.run in begun]


def _goes_on(folder: LabFolder, run: RunRecord) -> bool:
    return run.finished_at is None and folder.place is not None and holder_of(folder.place) is not None


def _seconds(moment: str) -> float:
    try:
        return clock.epoch(moment)
    except ValueError:
        return 0.0


def _clear(root: Path, runs: Iterable[RecordedRun], files: Mapping[str, bytes]) -> None:
    """Take away what a commit that failed left of runs that no commit has; they may now have led to another state, or
    be folded otherwise."""
    for run in runs:
        for suffix in ("", FOLD):
            for name in (DOCUMENT, TRACE, MEASUREMENTS):
                path = f"{run_folder(run.document)}{suffix}/{name}"
                left = root / path
                if left.is_file() and not left.is_symlink() and left.read_bytes() != files.get(path):
                    left.unlink()
