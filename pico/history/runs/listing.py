"""The runs that there are: those that commits carry, and those of this bench that none has yet."""

from __future__ import annotations

from collections.abc import Sequence

from pico.diagnostics import Diagnostic, PicoError, did_you_mean, error
from pico.history.git.commit import Commit
from pico.history.lab.folder import LabFolder
from pico.history.repository.ranges import read_range
from pico.history.repository.repository import Repository
from pico.history.runs.committed import RunPlace, places_in_history, read_carried
from pico.history.runs.uncommitted import unrecorded
from pico.model.trace.run import Run
from pico.runs.reading import members


def list_runs(
    folder: LabFolder,
    revision: str | None = None,
    *,
    every: bool = False,
    components: Sequence[str] = (),
    diagnostics: list[Diagnostic] | None = None,
) -> tuple[tuple[Run, Commit | None], ...]:
    """Return the runs in the history of a revision (HEAD), of a range `A..B`, or of `every` branch and tag, each with
    the oldest commit that carries it; None where no commit has it yet.

    The newest comes first. Unless a revision is named, those that this bench alone knows yet count, too. `components`:
    only what changed one of these, or of these tunables (`p1.angle`). Damaged files are warnings in `diagnostics`.
    Raises PicoError for what there is not.
    """
    own = [] if revision else [run.document for run in unrecorded(folder, diagnostics)]
    places = _places(folder, revision, every)
    carried = read_carried(folder.history(), places.values(), diagnostics) if places else ()
    found = [*carried, *(run for run in own if run.id not in places)]
    if components:
        kept = {run.id for name in components for run in _of_component(folder, name, found)}
        found = [run for run in found if run.id in kept]
    found.sort(key=lambda run: run.order, reverse=True)
    names = {run.id: places[run.id].commit for run in found if run.id in places}
    commits = folder.history().commits(set(names.values())) if names else {}
    return tuple((run, commits[names[run.id]] if run.id in names else None) for run in found)


def _places(folder: LabFolder, revision: str | None, every: bool) -> dict[str, RunPlace]:
    if every and revision:
        hint = "leave out one of them"
        raise PicoError(error("usage", "--all is every branch and tag, and a revision is one", hint=hint))
    repository = folder.history() if revision else folder.repository
    if repository is None:
        return {}
    tips, hidden = (None, ()) if every else _span(repository, revision)
    return places_in_history(repository, folder.root, tips, hidden=hidden)


def _span(repository: Repository, revision: str | None) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return the commits whose history is meant, and those whose history is not."""
    span = read_range(revision) if revision else None
    if span is None:
        known = revision or repository.head().commit
        return ((repository.resolve(known).id,) if known else ()), ()
    if span.sign == "...":
        hint = f"`{span.a}..{span.b}`: what the second has and the first has not"
        raise PicoError(error("range", "runs are listed of `A..B`", hint=hint))
    a, b = (repository.resolve(name or "HEAD").id for name in (span.a, span.b))
    return (b,), (a,)


def _of_component(folder: LabFolder, component: str, runs: list[Run]) -> list[Run]:
    """Return the runs that changed a component or a tunable; raises PicoError for one that there is not."""
    found = [
        run
        for run in runs
        if any(
            component in (c.component, f"{c.component}.{c.tunable}")
            for one in (run, *members(run))
            for c in one.changes
        )
    ]
    if not found and component.partition(".")[0] not in folder.setup.lab.inventory:
        hint = did_you_mean(component, folder.setup.lab.inventory)
        raise PicoError(error("unknown-component", f"there is no component `{component}`", hint=hint))
    return found
