"""Saved plans: what has changed since of all that they stand on."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from pico.diagnostics import Diagnostic, PicoError, error
from pico.model.diff import diff_states
from pico.model.plan import Plan
from pico.policy.freshness import edited, stale, staleness

if TYPE_CHECKING:
    from pico.bench.opened import Opened
    from pico.model.observation import Observation


def changed_since(opened: Opened, plan: Plan, seen: Observation) -> list[Diagnostic]:
    """Return what is not as it was when a plan was made and saved: bench, commit, goal, lab or calibration, each with
    what changed and by how much."""
    if other := _of_another(opened, plan):
        return [other]
    found = [*_lab(opened, plan), *_commit(opened, plan), *_goal(opened, plan), *_calibration(opened, plan)]
    if plan.lab.digest == opened.setup.digest():
        found += staleness(opened.setup, plan, seen)
    return found


def _of_another(opened: Opened, plan: Plan) -> Diagnostic | None:
    """Return that a plan was made for another bench, None if it was not."""
    far = opened.far
    here = far.name if far is not None and not far.local else opened.backend_name
    made_for = plan.bench or plan.backend
    if made_for == here:
        return None
    text = f"this plan was made for the bench `{made_for}`, and this command means `{here}`"
    return error(
        "other-bench", text, hint=f"`--bench {made_for}` applies it there; `pico plan` makes one for this bench"
    )


def _lab(opened: Opened, plan: Plan) -> Iterator[Diagnostic]:
    if plan.lab.digest != opened.setup.digest():
        words = _edited(opened, plan)
        what = f": {', '.join(words)}" if words else ""
        yield stale("", f"the lab or its component types were edited since{what}")


def _edited(opened: Opened, plan: Plan) -> list[str]:
    """Return what is different in the lab, where its commit still knows how it was."""
    try:
        then, _ = opened.folder.historic(plan.base.commit or "")
    except PicoError:
        return []
    if then.digest() != plan.lab.digest:
        return []
    return edited(then, opened.setup)


def _commit(opened: Opened, plan: Plan) -> Iterator[Diagnostic]:
    head = opened.folder.head()
    now = head.commit if head else None
    if now != plan.base.commit:
        yield stale("", f"HEAD is {_short(now)} now, and was {_short(plan.base.commit)}")


def _goal(opened: Opened, plan: Plan) -> Iterator[Diagnostic]:
    """What the plan leads to: another commit under the same name, or a manifest that was edited."""
    name = plan.target.revision
    try:
        now = opened.folder.history().resolve(name).id if name else None
        wanted = opened.state if name is None and plan.target.title is None else None
    except PicoError as exc:
        yield stale("", f"its goal can't be read any more: {exc}")
        return
    if name and now != plan.target.commit:
        yield stale("", f"{name} is {_short(now)} now, and was {_short(plan.target.commit)}")
    if wanted is None or wanted.as_json() == dict(plan.target.state):
        return
    for change in diff_states(opened.setup, plan.target_state, wanted):
        address = change.component if change.tunable == "pose" else f"{change.component}.{change.tunable}"
        yield stale(address, f"the manifest was edited since: {address} {change.text}")


def _calibration(opened: Opened, plan: Plan) -> Iterator[Diagnostic]:
    from pico.vision.calibration_files import calibration_digest

    now = calibration_digest(opened.root, opened.backend_name)
    if now != plan.calibration:
        yield stale("", f"the calibration of the cameras is {_short(now)} now, and was {_short(plan.calibration)}")


def _short(name: Any) -> str:
    return str(name).removeprefix("sha256:")[:10] if name else "none"
