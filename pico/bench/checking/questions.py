"""The questions that are put to a lab, each a function that answers it with a check."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from pico.bench.checking import trial
from pico.bench.checking.candidate import Candidate
from pico.bench.checking.verdict import Check, Verdict
from pico.diagnostics import Diagnostic, PicoError, SourceRange, error, warning
from pico.history.merge.checked import overlapping
from pico.manifest.files import shown_path
from pico.manifest.text.places import find, where
from pico.model.diff import Change
from pico.model.observation import Observation
from pico.model.plan import Plan
from pico.model.setup import Setup
from pico.model.state import LabState
from pico.model.trace.expectation import Expected

CheckRecipes = Callable[
    [Setup, str, Mapping[str, bytes], Callable[[str], bool]], tuple[tuple[str, ...], tuple[Diagnostic, ...]]
]
"""Reads the recipes of a lab: of its bench, its folder, its files by path, and whether there is a revision of a name
returns the names of the recipes and what is wrong with them."""


@dataclass(frozen=True)
class Case:
    """A valid lab on trial: the bench, the state that is wanted and what it is called, and the simulated bench as
    it stands before, which is that of commit `base`."""

    candidate: Candidate
    setup: Setup
    wanted: LabState
    seen: Observation
    base: str | None
    what: str
    fidelity: str

    def plan(self, seen: Observation) -> Plan:
        """Return the plan from a bench to the state wanted."""
        source = self.candidate.manifests.source
        return trial.plan_from(
            self.setup, seen, self.wanted, base=self.base, name=self.what, fidelity=self.fidelity, source=source
        )


def valid(candidate: Candidate) -> Check:
    """Return whether there is no error in the manifests."""
    found = candidate.manifests.diagnostics
    if not candidate.valid:
        return Check(question="valid", verdict="failed", text=first(found), diagnostics=found)
    return Check(question="valid", verdict="passed", text=f"{len(candidate.files)} files", diagnostics=found)


def formatted(candidate: Candidate) -> Check:
    """Return whether `pico fmt` would leave the manifests as they are."""
    from pico.manifest.fmt import format_text

    changed, unreadable = [], 0
    for path, data in sorted(candidate.files.items()):
        try:
            text = data.decode()
            if b"apiVersion" in data and format_text(text, path) != text:
                changed.append(path)
        except (PicoError, UnicodeDecodeError):
            unreadable += 1
    if changed:
        return Check(question="formatted", verdict="advised", text=f"`pico fmt` would change {', '.join(changed)}")
    if unreadable:
        return Check(question="formatted", verdict="skipped", text="not every file can be read")
    return Check(question="formatted", verdict="passed")


def stands(case: Case) -> Check:
    """Return whether everything has room where the state wants it."""
    found = overlapping(case.candidate.manifests)
    if found:
        return Check(question="stands", verdict="failed", text=first(found), diagnostics=found)
    return Check(question="stands", verdict="passed", text=f"{len(case.setup.lab.inventory)} parts")


def feasible(plan: Plan) -> Check:
    """Return whether there is a plan."""
    if plan.errored:
        text = first(plan.diagnostics)
        return Check(question="feasible", verdict="failed", text=text, diagnostics=plan.diagnostics)
    number = len(plan.operations)
    noun = "operation" if number == 1 else "operations"
    text = f"{number} {noun}, {plan.makespan:.1f} s" if number else "nothing moves"
    return Check(question="feasible", verdict="passed", text=text, diagnostics=plan.diagnostics)


def policy(case: Case, plan: Plan) -> tuple[Check, tuple[Mapping[str, Any], ...]]:
    """Return whether the rules of the lab hold of a plan, and the beam audit; and what became of each rule."""
    from pico.policy.judging.case import PlanCase
    from pico.policy.judging.judges import judgment_of

    rules = case.setup.lab.policy.rules if plan.operations else ()
    before_judges = PlanCase(case.setup, plan, case.seen)
    judged = judgment_of("rules", before_judges).rules or ()
    broken = tuple(_broken(rule) for rule in judged if not rule["holds"])
    light = judgment_of("beams", before_judges).diagnostics if plan.operations else ()
    none = "nothing moves" if case.setup.lab.policy.rules else "the lab has no rules"
    text = f"{len(judged) - len(broken)} of {len(judged)} rules hold" if rules else none
    denied = any(d.severity == "error" for d in (*broken, *light))
    return Check(
        question="policy",
        verdict="failed" if denied else "advised" if broken or light else "passed",
        text=f"{text}; the beam audit finds {len(light)}" if light else text,
        diagnostics=(*broken, *light),
    ), judged


def recipes(
    candidate: Candidate, setup: Setup, read: CheckRecipes, revision: Callable[[str], bool]
) -> Check:  # fmt: skip
    """Return whether the recipes of a lab can be run on its bench, as far as that is known before they run."""
    names, found = read(setup, shown_path(candidate.root), candidate.files, revision)
    failed = any(d.severity == "error" for d in found)
    text = first(found) if failed else f"{len(names)} {'recipe' if len(names) == 1 else 'recipes'}" if names else "none"
    return Check(question="recipes", verdict="failed" if failed else "passed", text=text, diagnostics=found)


def _broken(rule: Mapping[str, Any]) -> Diagnostic:
    said = f"{rule['rule']}: {rule['text']}"
    if rule["level"] == "mandatory":
        return error("denied", f"the policy of this lab denies it: {said}")
    return warning("advised", f"the policy of this lab advises against it: {said}")


def expectations(case: Case, plan: Plan) -> tuple[Check, tuple[Expected, ...]]:
    """Run a plan in the simulator; return whether it got there and the expectations hold then, and each of them."""
    seen, hands = case.seen, trial.by_hand(plan)
    if hands:
        seen = trial.after_hands(seen, hands)
        plan = case.plan(seen)
        if plan.errored or trial.by_hand(plan):
            names = ", ".join(sorted({op.component for op in hands}))
            text = f"a person must move {names} on the way, which the simulator can't"
            return Check(question="expectations", verdict="skipped", text=text), ()
    try:
        problems, expected = _tried(case, seen, plan)
    except PicoError as exc:
        problems, expected = tuple(exc.diagnostics), ()
    if problems:
        text = first([d for d in problems if d.code == "not-reached"] or problems)
        return Check(question="expectations", verdict="failed", broken=True, text=text, diagnostics=problems), ()
    how = [f"applied in the simulator ({case.fidelity})"] if plan.operations else []
    how += ["with the steps by hand done"] if hands else []
    return _judged(expected, ", ".join(how) or "nothing moves", _places(case, len(expected))), expected


def _tried(case: Case, seen: Observation, plan: Plan) -> tuple[tuple[Diagnostic, ...], tuple[Expected, ...]]:
    """Return what went wrong in the simulator, and what became of the expectations."""
    if not plan.operations:
        from pico.policy.expectations import check_expectations

        return (), check_expectations(case.setup, seen, case.wanted.expect)
    report = trial.run(case.setup, seen, plan, fidelity=case.fidelity, lab=case.candidate.root)
    if report.outcome == "done" and not report.remaining and not report.absent:
        return (), report.expectations
    told = [f"{_name(c)} {c.text}" for c in report.remaining] or [f"{n} is not there" for n in report.absent]
    text = f"the simulator did not get there: {report.failed} of {len(plan.operations)} operations failed"
    return (*report.diagnostics, error("not-reached", text, detail="still to do: " + ", ".join(told))), ()


def _name(change: Change) -> str:
    return change.component if change.tunable == "pose" else f"{change.component}.{change.tunable}"


def _judged(expected: tuple[Expected, ...], how: str, places: Sequence[SourceRange | None]) -> Check:
    said = f"{sum(e.holds is True for e in expected)} of {len(expected)} hold" if expected else "nothing is expected"
    doubtful = sum(not e.assured for e in expected)
    said += f", {doubtful} not assured" if doubtful else ""
    failing = tuple(_failure(e, at) for e, at in zip(expected, places, strict=True) if e.failed)
    verdict: Verdict = "failed" if failing else "passed"
    return Check(question="expectations", verdict=verdict, text=f"{said}; {how}", diagnostics=failing)


def _places(case: Case, number: int) -> list[SourceRange | None]:
    """Return where the expectations are written, one after the other."""
    states = case.candidate.manifests.documents.get("LabState", ())
    found = [where(d, "expect", n, "that") for d in states for n in range(number) if find(d, "expect", n)]
    return [*found] if len(found) == number else [None] * number


def _failure(one: Expected, at: SourceRange | None) -> Diagnostic:
    verb = "fails" if one.holds is False else "can't be told, which is a failure"
    text = f"the expectation `{one.that}` {verb}{f': {one.message}' if one.message else ''}"
    return error("expectation", text, detail=one.why, source=at)


def first(found: Sequence[Diagnostic]) -> str:
    """Return the first error in a line, and how many more there are."""
    wrong = [d.summary for d in found if d.severity == "error"] or [d.summary for d in found]
    return wrong[0] + (f", and {len(wrong) - 1} more" if len(wrong) > 1 else "")
