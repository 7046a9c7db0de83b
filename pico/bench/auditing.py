"""A plan as its judges see it, for whoever plans. What the model of light said before is kept: of the beam audit in
`.pico/audit.json`, of claims that tolerances do not carry in `.pico/claims.json`, by a digest of what it is about.

They may be deleted at any time; one that is damaged answers nothing.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from pico.bench.opened import Opened
from pico.disk import write_whole
from pico.model.observation import Observation
from pico.model.plan import Plan
from pico.model.record import as_json
from pico.model.state import LabState
from pico.policy.goals import GoalRecord
from pico.policy.judging.case import PlanCase

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
        return _kept(opened.root / ".pico" / f"{kind}.json", key, read, find)

    def stand(state: LabState) -> Sequence[Alignment]:
        from pico.bench.aligned import standing

        return standing(opened, seen, state, wanted=True)

    setup = opened.setup
    limited = plan.operations and any(part.dose_budget for part in setup.lab.inventory.values())
    doses = opened.wait(opened.edge.doses()) if limited else ()
    goals = GoalRecord(opened.folder.state_now, stand)
    return PlanCase(setup, plan, seen, doses=doses, goals=goals, recall=recall)


def _kept(path: Path, key: str, read: Callable[[Any], T], find: Callable[[], T] | None) -> T | None:
    """Return what is kept under a key in a file; where nothing is, find and keep it, or None."""
    known = _read(path)
    if key in known:
        try:
            return read(known[key])
        except (KeyError, TypeError, ValueError):
            pass
    if find is None:
        return None
    found = find()
    kept = {**dict(list(known.items())[-MOST + 1 :]), key: as_json(found)}
    _write(path, {"version": VERSION, path.stem: kept})
    return found


def _read(path: Path) -> Mapping[str, Any]:
    try:
        content = json.loads(path.read_bytes())
        return dict(content[path.stem]) if content["version"] == VERSION else {}
    except (OSError, ValueError, KeyError, TypeError):
        return {}


def _write(path: Path, content: Mapping[str, Any]) -> None:
    from pico.diagnostics import PicoError

    try:
        path.parent.mkdir(exist_ok=True)
        write_whole(path, json.dumps(content).encode(), durable=False)  # it may be lost at any time
    except (OSError, PicoError):
        pass  # a folder that can't be written keeps nothing
