"""Saved plans: applied only where nothing that they stand on has changed since, or made anew for the same goal."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from pico.diagnostics import Diagnostic, ExitCode, PicoError
from pico.execution.stale import edited, stale
from pico.model.diff import diff_states
from pico.model.plan import Plan
from pico.model.state import state_from_json

if TYPE_CHECKING:
    from pico.bench.async_bench import AsyncBench


async def require_fresh(bench: AsyncBench, plan: Plan) -> None:
    """Look, and raise PicoError (exit code STALE) where the bench, the commit, the goal, the lab or the calibration is
    not what a saved plan was made from, naming each with what changed and by how much."""
    from pico.execution.checks import require_current

    found = [*_lab(bench, plan), *_commit(bench, plan), *_goal(bench, plan), *_calibration(bench, plan)]
    if plan.lab.digest == bench.setup.digest():
        try:
            require_current(bench.setup, plan, await bench.observe())
        except PicoError as exc:
            found += exc.diagnostics
    if found:
        raise PicoError(found, ExitCode.STALE)


async def refreshed(bench: AsyncBench, plan: Plan) -> Plan:
    """Return a new plan from the bench as it stands to the goal of a saved one, for the same components."""
    return await bench.plan(
        plan.target.revision, targets=plan.target.only or (), exclude=plan.target.exclude or ()
    )  # fmt: skip


def _lab(bench: AsyncBench, plan: Plan) -> Iterator[Diagnostic]:
    if plan.lab.digest != bench.setup.digest():
        words = _edited(bench, plan)
        what = f": {', '.join(words)}" if words else ""
        yield stale("", f"the lab or its component types were edited since{what}")


def _edited(bench: AsyncBench, plan: Plan) -> list[str]:
    """Return what is different in the lab, where its commit still knows how it was."""
    try:
        then, _ = bench.folder.historic(plan.base.commit or "")
    except PicoError:
        return []
    if then.digest() != plan.lab.digest:
        return []
    return edited(then, bench.setup)


def _commit(bench: AsyncBench, plan: Plan) -> Iterator[Diagnostic]:
    head = bench.folder.head()
    now = head.commit if head else None
    if now != plan.base.commit:
        yield stale("", f"HEAD is {_short(now)} now, and was {_short(plan.base.commit)}")


def _goal(bench: AsyncBench, plan: Plan) -> Iterator[Diagnostic]:
    """What the plan leads to: another commit under the same name, or a manifest that was edited."""
    name = plan.target.revision
    try:
        now = bench.folder.history().resolve(name).id if name else None
        wanted = bench.state if name is None and plan.target.title is None else None
    except PicoError as exc:
        yield stale("", f"its goal can't be read any more: {exc}")
        return
    if name and now != plan.target.commit:
        yield stale("", f"{name} is {_short(now)} now, and was {_short(plan.target.commit)}")
    if wanted is None or wanted.as_json() == dict(plan.target.state):
        return
    for change in diff_states(bench.setup, state_from_json(plan.lab.name, plan.target.state), wanted):
        address = change.component if change.tunable == "pose" else f"{change.component}.{change.tunable}"
        yield stale(address, f"the manifest was edited since: {address} {change.text}")


def _calibration(bench: AsyncBench, plan: Plan) -> Iterator[Diagnostic]:
    from pico.vision.calibration import calibration_digest

    now = calibration_digest(bench.root)
    if now != plan.calibration:
        yield stale("", f"the calibration of the cameras is {_short(now)} now, and was {_short(plan.calibration)}")


def _short(name: Any) -> str:
    return str(name).removeprefix("sha256:")[:10] if name else "none"
