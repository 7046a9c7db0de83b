"""What the model of light says of a bench: the beam audit, and claims that tolerances do not carry. What it said before
is kept: `.pico/audit.json`, `.pico/claims.json`, by a digest of lab, types and state.

They may be deleted at any time; one that is damaged answers nothing.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from pico.bench.opened import Opened
from pico.diagnostics import Diagnostic, warning
from pico.disk import write_whole
from pico.model.observation import Observation
from pico.model.plan import Plan
from pico.model.record import as_json, digest
from pico.model.state import state_from_json
from pico.optics.audit.findings import Audit, audit_from_json

if TYPE_CHECKING:
    from pico.model.setup import Setup
    from pico.policy.audit import Lit

T = TypeVar("T")
VERSION = 1
"""Of the rules of the audit; a verdict by others is not believed."""
MOST = 64
"""So many verdicts are kept, the newest."""


def with_audit(opened: Opened, plan: Plan, seen: Observation) -> Plan:
    """Return a plan with what the beam audit says of it, sealed anew where that is anything. One that does nothing is
    told what is known already: nothing is traced for it."""
    from pico.policy.audit import told_of

    audit, lit = audit_plan(opened, plan, seen)
    found = told_of(plan, audit, lit)
    told = {d.address for d in found}
    rest = tuple(
        d for d in plan.diagnostics if d.code != "beam" or d.address not in told
    )  # the same, without a verdict
    return replace(plan, diagnostics=(*rest, *found)).sealed() if found else plan


def audit_plan(opened: Opened, plan: Plan, seen: Observation) -> tuple[Audit, Lit]:
    """Return the verdict on the light of a plan, and the bench that it is about; kept, so that it is found once."""
    from pico.policy.audit import audit_of

    def judged(setup: Setup, lit: Lit) -> Audit | None:
        return known_or_found(opened.root, setup, lit, find=bool(plan.operations))

    return audit_of(opened.setup, plan, seen, judged)


def known_or_found(root: Path, setup: Setup, lit: Lit, *, find: bool) -> Audit | None:
    """Return the verdict that is kept of a bench with light on it; where there is none, find and keep it, or None."""
    from pico.policy.audit import judge

    path = root / ".pico" / "audit.json"
    return _kept(path, _key(setup, lit), audit_from_json, (lambda: judge(setup, lit)) if find else None)


def with_claims(opened: Opened, plan: Plan) -> Plan:
    """Return a plan to a state, sealed anew, with the claims of the lab that the tolerances of that state do not carry
    as warnings. One that does nothing is told what is known already."""
    setup = opened.setup
    if not setup.lab.claims or plan.asked or plan.target.title:
        return plan

    def find() -> tuple[Diagnostic, ...]:
        from pico.diagnosis.claims import uncarried

        state = state_from_json(plan.lab.name, plan.target.state)
        return tuple(one for _, one in uncarried(setup, state, plan.target.revision))

    def read(kept: Any) -> tuple[Diagnostic, ...]:
        return tuple(warning("claim", one["summary"], detail=one["detail"], hint=one["hint"]) for one in kept)

    path, key = (
        opened.root / ".pico" / "claims.json",
        digest([VERSION, setup.digest(), plan.target.state, plan.target.revision]),
    )
    found = _kept(path, key, read, find if plan.operations else None)
    return replace(plan, diagnostics=(*plan.diagnostics, *found)).sealed() if found else plan


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


def _key(setup: Setup, lit: Lit) -> str:
    return digest([VERSION, setup.digest(), lit.poses, lit.values, lit.lasers])


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
