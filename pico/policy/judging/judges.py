"""The judges of a plan in their order, each with what it asks; the rules of a lab come last, as they may speak of all
that the others say.

Whoever plans asks all of them, and the plan says what they find. An edge asks again before anything moves, and its word
counts: of those that can refuse a plan, the first that does so keeps it from being run.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from pico.diagnostics import Diagnostic, ExitCode, PicoError, warning
from pico.model.plan import Plan
from pico.model.record import digest
from pico.policy.judging.case import Judgment, PlanCase

CLAIMS = 1
"""The version of what is said of claims; findings of another one are not believed."""


def _errors(case: PlanCase) -> Judgment:
    """What is wrong with the plan by its own word."""
    wrong = tuple(one for one in case.plan.diagnostics if one.severity == "error")
    return Judgment(denials=wrong, exit_code=case.plan.exit_code)


def _lab(case: PlanCase) -> Judgment:
    """Whether the plan was made for the lab that the bench has."""
    if case.able is None or case.plan.lab.digest == case.able.lab_digest:
        return Judgment()
    from pico.policy.freshness import lab_edited

    return Judgment(denials=(lab_edited(),), exit_code=ExitCode.STALE)


def _capability(case: PlanCase) -> Judgment:
    """Whether the bench can do what the plan asks."""
    if case.able is None:
        return Judgment()
    from pico.policy.capability import incapacities

    return Judgment(denials=tuple(incapacities(case.plan, case.able)), exit_code=ExitCode.ERROR)


def _set_points(case: PlanCase) -> Judgment:
    """Whether the bench's devices can be told the set-points of the plan, through their maps."""
    if case.plan.backend == "sim":
        return Judgment()
    from pico.planning.checks.set_points import refused

    wrong = tuple(refused(case.setup, case.plan.operations, calibrated=case.axes()))
    return Judgment(diagnostics=wrong, exit_code=ExitCode.IMPOSSIBLE)


def _freshness(case: PlanCase) -> Judgment:
    """Whether the bench is as the plan assumes."""
    from pico.policy.freshness import staleness

    return Judgment(denials=tuple(staleness(case.setup, case.plan, case.seen)), exit_code=ExitCode.STALE)


def _expectations(case: PlanCase) -> Judgment:
    """Whether what is expected of the bench afterwards makes sense; of a plan for some components that is not asked."""
    target = case.plan.target
    if not target.expect or target.scope:
        return Judgment()
    from pico.policy.expectations import expression_faults

    wrong = expression_faults(case.setup, [one.that for one in target.expect])
    return Judgment(diagnostics=tuple(wrong), exit_code=ExitCode.ERROR)


def _licenses(case: PlanCase) -> Judgment:
    """Whether somebody lets the light out that the plan lets out."""
    from pico.planning.checks.emission import refused

    return Judgment(diagnostics=tuple(refused(case.setup, case.seen, case.plan.operations)))


def _beams(case: PlanCase) -> Judgment:
    """Where the light goes, and what an arm carries through it: the beam audit."""
    from pico.policy.audit import told_of

    found = told_of(case.plan, *case.light)
    return Judgment(diagnostics=found, replaces=frozenset(("beam", one.address) for one in found))


def _claims(case: PlanCase) -> Judgment:
    """Whether the tolerances of the target carry the claims of the lab."""
    setup, plan = case.setup, case.plan
    if not setup.lab.claims or plan.asked or plan.target.title:
        return Judgment()

    def find() -> tuple[Diagnostic, ...]:
        from pico.diagnosis.claims import uncarried

        return tuple(one for _, one in uncarried(setup, plan.target_state, plan.target.revision))

    def read(known: Any) -> tuple[Diagnostic, ...]:
        return tuple(warning("claim", one["summary"], detail=one["detail"], hint=one["hint"]) for one in known)

    key = digest([CLAIMS, setup.digest(), plan.target.state, plan.target.revision])
    return Judgment(diagnostics=case.recall("claims", key, read, find if plan.operations else None) or ())


def _dose(case: PlanCase) -> Judgment:
    """Whether a sample would have more light than it may."""
    if not case.plan.operations:
        return Judgment()
    from pico.policy.dose import refused

    return Judgment(diagnostics=tuple(refused(case.setup, case.seen, case.doses, case.plan.operations)))


def _goals(case: PlanCase) -> Judgment:
    """Which set-points light has yet to find, and which goals the plan leaves to be aligned again."""
    if case.goals is None:
        return Judgment()
    from pico.policy.goals import judge_goals

    told, lost = judge_goals(case.setup, case.plan, case.seen, case.goals)
    return Judgment(diagnostics=told, spoils=lost if told or lost else None)


def _rules(case: PlanCase) -> Judgment:
    """Whether the rules of the lab hold; a plan that does nothing needs no leave."""
    if not case.setup.lab.policy.rules or not case.plan.operations:
        return Judgment()
    from pico.policy.rules import denials, verdicts

    found = verdicts(case.setup, case.plan, case.seen, lambda: case.light[0])
    return Judgment(rules=found, denials=denials(found))


@dataclass(frozen=True)
class Judge:
    """One of the judges of a plan."""

    name: str
    judge: Callable[[PlanCase], Judgment]
    # Whether it can keep a plan from being run; one that only advises is not asked at the edge.
    refuses: bool = True
    # Whether it needs the bench as it is now; the others are asked before an edge takes the bench, too.
    looks: bool = True


JUDGES: tuple[Judge, ...] = (
    Judge("errors", _errors, looks=False),
    Judge("lab", _lab, looks=False),
    Judge("capability", _capability, looks=False),
    Judge("set-points", _set_points, looks=False),
    Judge("freshness", _freshness),
    Judge("expectations", _expectations),
    Judge("licenses", _licenses),
    Judge("beams", _beams),
    Judge("claims", _claims, refuses=False),
    Judge("dose", _dose),
    Judge("goals", _goals, refuses=False),
    Judge("rules", _rules),
)
"""All that judge a plan. To add one, add it here: client and edge have no list of their own."""


def judge_plan(case: PlanCase) -> Plan:
    """Return the plan with what its judges say of it, sealed anew if that is anything."""
    judged = case
    for one in JUDGES:
        judged = judged.with_judgment(one.judge(judged))
    return judged.plan if judged is case else judged.plan.sealed()


def refusal_of(case: PlanCase) -> PicoError | None:
    """Return all that the first judge says which refuses a plan, None if all let it pass.

    Without the present state of the bench only those are asked who don't need it. Exit codes: IMPOSSIBLE for a plan
    with errors (DENIED if all are about light or dose), STALE for a bench or a lab that changed since, DENIED by light,
    dose and rules, else ERROR.
    """
    for one in JUDGES:
        if not one.refuses or (one.looks and case.present is None):
            continue
        judgment = one.judge(case)
        if judgment.refusals:
            return PicoError(judgment.refusals, judgment.exit_code)
    return None


def require_permitted(case: PlanCase) -> None:
    """Raise PicoError if a judge refuses a plan, as `refusal_of` says."""
    if (why := refusal_of(case)) is not None:
        raise why


def judgment_of(name: str, case: PlanCase) -> Judgment:
    """Return what one of the judges says of a plan, by its name: for who asks about that alone."""
    return next(one for one in JUDGES if one.name == name).judge(case)
