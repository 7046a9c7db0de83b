"""A plan as its judges see it, for whoever plans. What the model of light said before is kept: of the beam audit in
`.pico/audit.json`, of claims that tolerances do not carry in `.pico/claims.json`, by a digest of what it is about.

They may be deleted at any time; one that is damaged answers nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from pico.base.state_file import StateFile
from pico.base.state_files import AUDIT, CLAIMS
from pico.bench.opened import Opened
from pico.diagnostics import PicoError
from pico.model.observation import Observation
from pico.model.plan import Plan
from pico.model.record import as_json
from pico.model.state import LabState
from pico.places.lab import FOLDER
from pico.policy.goals import GoalRecord
from pico.policy.judging.case import PlanCase

if TYPE_CHECKING:
    from pico.model.calibration.results import AxisZero

if TYPE_CHECKING:
    from pico.planning.alignment import Alignment

T = TypeVar("T")
VERSION = 1
"""Of the files; one of another version answers nothing."""
MOST = 64
"""So many verdicts are kept, the newest."""


def case_of(opened: Opened, plan: Plan, seen: Observation) -> PlanCase:
    """Return a plan as its judges see it, with what this bench knows beside it."""

    def recall(kind: str, key: str, read: Callable[[Any], T], find: Callable[[], T] | None) -> T | None:
        return _kept({"audit": AUDIT, "claims": CLAIMS}[kind], opened.root, key, read, find)

    def stand(state: LabState) -> Sequence[Alignment]:
        from pico.bench.aligned import standing

        return standing(opened, seen, state, wanted=True)

    def axes() -> Mapping[str, AxisZero]:
        from pico.vision.calibration_files import accepted_axes

        return accepted_axes(opened.root, plan.backend)

    setup = opened.setup
    limited = plan.operations and any(part.dose_budget for part in setup.lab.inventory.values())
    doses = opened.wait(opened.edge.doses()) if limited else ()
    goals = GoalRecord(opened.folder.state_now, stand)
    return PlanCase(setup, plan, seen, doses=doses, goals=goals, recall=recall, axes=axes)


def _kept(file: StateFile, root: Path, key: str, read: Callable[[Any], T], find: Callable[[], T] | None) -> T | None:
    """Return what is kept under a key in a file; if nothing is, find and keep it, or None."""
    path = file.path(root / FOLDER)
    known = file.read(path, lambda document: _known(document, path.stem)) or {}
    if key in known:
        try:
            return read(known[key])
        except (KeyError, TypeError, ValueError):
            pass
    if find is None:
        return None
    found = find()
    kept = {**dict(list(known.items())[-MOST + 1 :]), key: as_json(found)}
    with suppress(OSError, PicoError):  # a folder that can't be written to keeps nothing
        path.parent.mkdir(exist_ok=True)
        file.write(path, {"version": VERSION, path.stem: kept}, durable=False)  # it may be lost at any time
    return found


def _known(document: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    return dict(document[name]) if document["version"] == VERSION else {}
