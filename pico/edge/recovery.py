"""After a crash: what became of the operations that began, told by what stands on the table; nothing is replayed."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from contextlib import closing, suppress
from pathlib import Path
from typing import Any

from pico.backends.devices import EMULATED, SIMULATOR
from pico.base.state_files import JOURNAL, WORLD
from pico.diagnostics import Diagnostic, PicoError, error, warning
from pico.model.diff import deviation, value_distance
from pico.model.observation import Observation, ObservedComponent
from pico.model.operation import Operation, Outcome
from pico.model.pose import Pose
from pico.model.record import record
from pico.model.setup import Setup
from pico.places.bench import BenchPlace
from pico.runs.journal import Journal, Unsettled

BY_OBSERVATION = "observation"


@record
class SettledOperation:
    """How an operation ended of which nobody knew it, as far as an observation tells; `unknown`: a person must say."""

    key: str
    operation: Operation
    outcome: Outcome


def settle(setup: Setup, journal: Journal, seen: Observation, token: int) -> tuple[SettledOperation, ...]:
    """Find out by the observation, and record, how every operation ended that began and has no end.

    Returns them in the order in which they began. Raises PicoError where the journal can't be written.
    """
    found = []
    for open in journal.unsettled():
        outcome = verdict(setup, open.operation, seen)
        if outcome != "unknown" or not open.ended:
            journal.resolve(open.key, outcome, BY_OBSERVATION, seen.components.get(open.operation.component), token)
        found.append(SettledOperation(key=open.key, operation=open.operation, outcome=outcome))
    return tuple(found)


def verdict(setup: Setup, operation: Operation, seen: Observation) -> Outcome:
    """Return what an observation says of an operation that began: `done`, `failed` (it is not as it should have become,
    so that it may be done again), or `unknown`, where looking does not tell."""
    if not repeatable(operation):
        return "unknown"
    if operation.kind.changes == "nothing":
        return "failed"
    part = seen.components.get(operation.component)
    if part is None or part.presence == "missing":
        return "unknown"
    if operation.primitive == "teleoperate":  # it has no goal: it ended where it stands
        return "done" if part.presence == "seen" and _left(operation, part) else "failed"
    if operation.kind.carries:
        there = part.presence == "seen" and part.pose is not None and arrived(setup, operation, part.pose)
        return "done" if there else "failed"
    return "done" if _has_value(setup, operation, seen) else "failed"


def _left(operation: Operation, part: ObservedComponent) -> bool:
    """Return whether what a person steered is not where that began any more."""
    begun = operation.arguments["from"]
    if "pose" in begun:
        return part.pose != Pose(**begun["pose"])
    live = {f"{operation.component}.{name}": known.value for name, known in part.values.items()}
    return any(live.get(address) != value for address, value in begun.items())


def repeatable(operation: Operation) -> bool:
    """Return whether an operation may be done again where an observation shows that it is not done: its target is
    absolute. What a person does, and what can't be undone (glue), never is."""
    return operation.kind.repeatable and not operation.arguments.get("irreversible")


def arrived(setup: Setup, operation: Operation, pose: Pose) -> bool:
    """Return whether `pose` is the goal of a move: in its slot, or within the tolerance of the component."""
    to = operation.arguments["to"]
    return deviation(setup, operation.component, pose, to.get("slot"), Pose(**to["pose"])) != "off"


def _has_value(setup: Setup, operation: Operation, seen: Observation) -> bool:
    tunable = str(operation.arguments.get("tunable"))
    kind = setup.type_of(operation.component).tunables.get(tunable)
    live = seen.components[operation.component].values.get(tunable)
    if kind is None or live is None or live.status != "known" or live.value is None:
        return False
    home = kind.axis.home if kind.axis else 0.0
    goal = home if operation.primitive == "home" else operation.arguments.get("to")
    if goal is None:  # found on the way
        return False
    return value_distance(kind, live.value, goal) <= max(kind.tolerance, 1e-9)


def open_questions(unsettled: Sequence[Unsettled]) -> list[Diagnostic]:
    """Return an error for each operation that only a person can tell the end of."""
    found = []
    for open in unsettled:
        op = open.operation
        if repeatable(op):
            continue
        what = op.arguments.get("text") or f"{op.primitive} of {op.component}"
        hint = f"look; then `pico recover --done {open.key}` or `pico recover --not-done {open.key}`"
        text = f"nobody knows whether this was done before the last run ended: {what}"
        found.append(error("unknown-outcome", text, hint=hint, address=op.component))
    return found


def require_unmoved(path: Path) -> None:
    """Raise PicoError where the journal at `path`, if it can be read, has a simulated run in which anything was done:
    for the simulated table is not there any more."""
    if _was_moved(path, SIMULATOR):
        text = f"{WORLD.path(path.parent)} is gone, and the journal has runs that moved this simulated table"
        hint = "`pico sim reset` starts the simulated table over, with every part at home"
        raise PicoError(error("world-file", text, hint=hint))


def lost_table(place: BenchPlace) -> Diagnostic | None:
    """Return that the table of a simulated or an emulated bench is gone that its journal has runs of; None if it is
    there. That of an emulated bench begins anew by itself, for its cameras and arms tell where everything is."""
    path = WORLD.path(place.folder)
    if place.name not in (SIMULATOR, EMULATED) or os.path.lexists(path):
        return None
    try:
        require_unmoved(JOURNAL.path(place.folder))
    except PicoError as exc:
        return exc.diagnostics[0]
    if place.name == SIMULATOR or not _was_moved(JOURNAL.path(place.folder), EMULATED):
        return None
    text = f"{path} is gone, and the journal has runs that moved this emulated table: it begins anew"
    hint = "every part stands at its home of lab.yaml, arms are parked, and tunables are at their initial values"
    return warning("world-file", text, hint=f"{hint}; `pico status` shows what differs")


def _was_moved(path: Path, backend: str) -> bool:
    if not path.exists():
        return False
    with suppress(PicoError), closing(Journal(path, looking=True)) as journal:
        runs = (run for run in journal.moving() if _is_of(journal.about(run)[0], backend))
        return any(record.kind == "done" for run in runs for record in journal.records(run=run))
    return False  # looking must not fail because of the journal


def _is_of(about: tuple[Mapping[str, Any], ...], backend: str) -> bool:
    return all(begun.get("environment", {}).get("backend", SIMULATOR) == backend for begun in about)
