"""Whether a plan still fits the bench: nothing that it stands on may have changed since."""

from __future__ import annotations

from pico.diagnostics import Diagnostic, ExitCode, PicoError, error
from pico.model.diff import diff_observed
from pico.model.lab import Setup
from pico.model.observation import Observation
from pico.model.plan import Plan
from pico.model.state import LabState, state_from_json


def require_fresh(setup: Setup, plan: Plan, seen: Observation) -> None:
    """Raise PicoError (exit code STALE), saying what changed, where the bench is not as the plan assumes.

    A tunable counts as changed beyond its tolerance: |observed - base| > tolerance.
    """
    if plan.lab.digest != setup.digest():
        reason = error(
            "stale", "the plan is stale: the lab or its component types were edited since", hint="plan again"
        )
        raise PicoError(reason, ExitCode.STALE)
    changed = _changed(setup, state_from_json(plan.lab.name, plan.base.state), seen)
    if changed:
        raise PicoError(changed, ExitCode.STALE)


def _changed(setup: Setup, base: LabState, seen: Observation) -> list[Diagnostic]:
    found = []
    for name in sorted(base.components):
        part = seen.components.get(name)
        if name in setup.lab.inventory and (part is None or part.presence != "seen"):
            what = part.presence if part else "missing"
            found.append(_stale(name, f"{name} is {what} now"))
    for change in diff_observed(setup, seen, base):
        if change.component in base.components and not change.tolerated:
            subject = change.component if change.tunable == "pose" else f"{change.component}.{change.tunable}"
            found.append(
                _stale(subject, f"{subject} changed: {_back(change.before)}, planned from {_back(change.after)}")
            )
    appeared = sorted(
        name for name in setup.lab.inventory
        if name not in base.components and name in seen.components and seen.components[name].presence == "seen"
    )  # fmt: skip
    return found + [_stale(name, f"{name} was not seen then and is now") for name in appeared]


def _back(value: object) -> str:
    if isinstance(value, dict) and "x" in value:
        return f"({value['x']:.5g}, {value['y']:.5g}, {value.get('yaw', 0):.4g}°)"
    return str(value)


def _stale(address: str, summary: str) -> Diagnostic:
    return error(
        "stale", f"the plan is stale: {summary}", address=address, hint="plan again; what moved it is not known"
    )
