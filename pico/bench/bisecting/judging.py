"""Whether a configuration is good: expectations against the bench as observed; and what keeps one from being tried."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any

from pico.bench.bisecting.records import Tried
from pico.diagnostics import Diagnostic, ExitCode, PicoError, error
from pico.history.bisect.git_state import Verdict
from pico.model.observation import Observation
from pico.model.plan import Plan
from pico.model.setup import Setup
from pico.model.state import Expectation, LabState
from pico.model.vocabulary import measured_in, shown, spoken_of, values_of
from pico.policy.expectations import check_expectations

UNSURE = frozenset({"missing", "toppled", "held", "uncertain", "hand-full"})
"""Diagnostics of a plan that are about the bench as it stands, not about where it should go."""


def verdict(setup: Setup, seen: Observation, expect: Sequence[Expectation]) -> tuple[Verdict, str]:
    """Return what the bench as observed is, and the values that decided.

    Bad where an expectation fails; `skip` where none fails and one can't be told; else good.
    """
    found = check_expectations(setup, seen, expect)
    failed = [one for one in found if one.holds is False]
    unknown = [one for one in found if one.holds is None]
    if failed:
        return "bad", "; ".join(one.why or f"`{one.that}` fails" for one in failed)
    if unknown:
        return "skip", f"can't be told: {unknown[0].why or unknown[0].that}"
    values, _ = values_of(setup, seen, spoken_of(setup, (one.that for one in expect)))
    said = [shown(one.that, values) or f"`{one.that}` holds" for one in expect]
    return "good", "; ".join(dict.fromkeys(said))


def not_as_called(setup: Setup, seen: Observation, state: LabState | None, tried: Tried, name: str) -> Diagnostic:
    """Return what to say where an end, called `name`, is not what it was called: `tried.end`."""
    from pico.model.comparing.drift import drift_of

    off = [c for c in drift_of(setup, seen, state) if not c.tolerated] if state else []
    differs = "; ".join(f"{c.component}.{c.tunable} {c.text}" for c in off[:4])
    same = "the bench stands as that commit says" if state else ""
    hints = {
        "good": "so the cause is not in the history: something else on the bench has changed since. `pico drift`, "
        "`pico verify`; or name an older good commit",
        "bad": "so there is nothing to be found: check the expectation, or name another bad commit",
    }
    if tried.verdict == "skip":
        hints = dict.fromkeys(hints, "choose an expectation that the bench can tell now")
    is_now = "can't be told" if tried.verdict == "skip" else f"is {tried.verdict}"
    return error(
        "not-as-called", f"{name} was called {tried.end} and {is_now} now: {tried.why}",
        detail=f"the bench differs from it: {differs}" if differs else same,
        hint=hints[tried.end],
    )  # fmt: skip


def decisive(setup: Setup, expect: Sequence[Expectation]) -> frozenset[str]:
    """Return the components whose poses and set-points decide; none where something measured does, for that may depend
    on everything."""
    texts = [one.that for one in expect]
    return frozenset() if measured_in(setup, texts) else frozenset(spoken_of(setup, texts))


def require_known(setup: Setup, seen: Observation, plan: Plan) -> None:
    """Raise PicoError where nobody can say how the bench stands, or (exit code DENIED) where somebody is at the table
    and nothing may move: that is no matter of one configuration."""
    speaking = {rule.name for rule in setup.lab.policy.rules if re.search(r"\bhuman_present\b", rule.that)}
    for rule in _denying(plan):
        if rule.get("rule") in speaking:
            text = f"the policy of this lab denies it: {rule.get('rule')}: {rule.get('text')}"
            raise PicoError(error("denied", text), ExitCode.DENIED)
    found = [d for d in plan.diagnostics if d.code in UNSURE]
    found += [p for p in seen.problems if p.severity == "error" and p not in found]
    if found or plan.absent:
        absent = [error("missing", f"{name} is not seen where it could stand") for name in plan.absent if not found]
        raise PicoError([*(_as_error(d) for d in found), *absent])


def _as_error(d: Diagnostic) -> Diagnostic:
    return error(d.code, d.summary, detail=d.detail, hint=d.hint, address=d.address)


def impossible(plan: Plan) -> str:
    """Return why the bench can't be brought to a configuration, or must not; empty where it can."""
    for d in plan.diagnostics:
        if d.severity == "error":
            return d.summary
    for rule in _denying(plan):
        return f"denied by the lab's policy: {rule.get('rule')}: {rule.get('text')}"
    by_hand = [op for op in plan.operations if op.kind.by_hand]
    return f"{by_hand[0].component} needs a person" if by_hand else ""


def _denying(plan: Plan) -> list[Mapping[str, Any]]:
    return [rule for rule in plan.policy if not rule.get("holds") and rule.get("level") == "mandatory"]
