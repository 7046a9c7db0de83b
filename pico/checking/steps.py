"""The questions that are put to a lab, one after the other; what can't be asked any more is skipped and says why."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import replace

from pico.backends.sim.world import World
from pico.checking import trial
from pico.checking.candidate import Candidate, Origin, bench_changes, start
from pico.checking.verdict import QUESTIONS, Check, LabChecked
from pico.diagnostics import Diagnostic, PicoError, SourceRange, error, warning
from pico.history.folder import between
from pico.manifest.places import find, where
from pico.merging import overlapping
from pico.model.expectation import Expected
from pico.model.lab import Setup
from pico.model.plan import Plan
from pico.model.state import LabState

Answered = tuple[Check, LabChecked]


def check_lab(candidate: Candidate, before: Origin, *, what: str, fidelity: str, folder: str = ".") -> LabChecked:
    """Return what becomes of a lab: against its state before, in a simulated bench of its own. Raises nothing for what
    the manifests hold."""
    found = LabChecked(
        lab=candidate.name, folder=folder, base=before.against, fidelity=fidelity, notes=before.notes
    )  # fmt: skip
    valid = _timed(lambda: _valid(candidate))
    formatted = _timed(lambda: _formatted(candidate))
    if valid.verdict == "failed":
        return replace(found, checks=(valid, formatted, *_skipped("the manifests are not valid", 2)))
    return _Judge(candidate, before, what, replace(found, checks=(valid, formatted))).judged()


class _Judge:
    """Puts the physical questions to a valid lab."""

    def __init__(self, candidate: Candidate, before: Origin, what: str, found: LabChecked) -> None:
        self.candidate, self.before, self.what, self.found = candidate, before, what, found
        self.setup, self.wanted = candidate.manifests.require()

    def judged(self) -> LabChecked:
        self.begin, notes = start(self.setup, self.before)
        before = (self.before.setup or self.setup, self.before.state or self.begin)
        self.found = replace(
            self.found,
            notes=notes,
            changes=between(before, (self.setup, self.wanted)),
            bench=bench_changes(self.setup, self.before),
        )
        stands = _timed(self._stands)
        self.world = trial.world_of(self.setup, self.begin)
        feasible = _timed(self._feasible)
        if stands.verdict == "failed":
            return self._with(stands, *_skipped("not everything has room to stand", 3))
        if feasible.verdict == "failed":
            return self._with(stands, feasible, *_skipped("no plan leads there", 4))
        policy = _timed(self._policy)
        return self._with(stands, feasible, _timed(self._expectations), policy)

    def _with(self, *checks: Check) -> LabChecked:
        return replace(self.found, checks=(*self.found.checks, *checks))

    def _stands(self) -> Check:
        found = overlapping(self.candidate.manifests)
        if found:
            return Check(question="stands", verdict="failed", text=_first(found), diagnostics=found)
        return Check(question="stands", verdict="passed", text=f"{len(self.setup.lab.inventory)} parts")

    def _feasible(self) -> Check:
        plan = self._plan(self.world)
        self.found = replace(self.found, plan=plan)
        wrong = tuple(d for d in plan.diagnostics if d.severity == "error")
        if wrong:
            return Check(question="feasible", verdict="failed", text=_first(wrong), diagnostics=plan.diagnostics)
        text = f"{len(plan.operations)} operations, {plan.makespan:.1f} s" if plan.operations else "nothing moves"
        return Check(question="feasible", verdict="passed", text=text, diagnostics=plan.diagnostics)

    def _plan(self, world: World) -> Plan:
        return trial.plan_from(
            self.setup, world, self.wanted, base=self.before.against.commit, name=self.what,
            fidelity=self.found.fidelity, source=self.candidate.manifests.source,
        )  # fmt: skip

    def _policy(self) -> Check:
        rules = self.setup.lab.policy.rules
        plan = self.found.plan
        if not rules or plan is None or not plan.operations:
            text = "nothing moves" if rules else "the lab has no rules"
            return Check(question="policy", verdict="passed", text=text)
        from pico.policy.rules import verdicts

        judged = verdicts(self.setup, plan, trial.seen_in(self.world))
        self.found = replace(self.found, rules=judged)
        broken = tuple(_rule(rule) for rule in judged if not rule["holds"])
        denied = any(d.severity == "error" for d in broken)
        text = f"{len(judged) - len(broken)} of {len(judged)} rules hold"
        return Check(
            question="policy", verdict="failed" if denied else "advised" if broken else "passed", text=text,
            diagnostics=broken,
        )  # fmt: skip

    def _expectations(self) -> Check:
        assert self.found.plan is not None
        plan, world = self.found.plan, self.world
        if hands := trial.by_hand(plan):
            world = trial.after_hands(world, hands)
            plan = self._plan(world)
            if plan.errored or trial.by_hand(plan):
                names = ", ".join(sorted({op.component for op in hands}))
                text = f"a person must move {names} on the way, which the simulator can't"
                return Check(question="expectations", verdict="skipped", text=text)
        try:
            problems, expected = self._tried(world, plan)
        except PicoError as exc:
            problems, expected = tuple(exc.diagnostics), ()
        self.found = replace(self.found, expectations=expected)
        how = [f"applied in the simulator ({self.found.fidelity})"] if plan.operations else []
        how += ["with the steps by hand done"] if hands else []
        return _judged(problems, expected, ", ".join(how) or "nothing moves", self._places(len(expected)))

    def _places(self, number: int) -> list[SourceRange | None]:
        """Return where the expectations are written, one after the other."""
        states = self.candidate.manifests.documents.get("LabState", ())
        found = [where(d, "expect", n, "that") for d in states for n in range(number) if find(d, "expect", n)]
        return [*found] if len(found) == number else [None] * number

    def _tried(self, world: World, plan: Plan) -> tuple[tuple[Diagnostic, ...], tuple[Expected, ...]]:
        """Return what went wrong in the simulator, and what became of the expectations."""
        if not plan.operations:
            return (), _expected(self.setup, self.wanted, world)
        report = trial.run(self.setup, world, plan, fidelity=self.found.fidelity, lab=self.candidate.root)
        if report.outcome == "done" and not report.remaining and not report.absent:
            return (), report.expectations
        told = [f"{c.component} {c.text}" for c in report.remaining] or [f"{n} is not there" for n in report.absent]
        text = f"the simulator did not get there: {report.failed} of {len(plan.operations)} operations failed"
        return (*report.diagnostics, error("not-reached", text, detail="still to do: " + ", ".join(told))), ()


def _expected(setup: Setup, wanted: LabState, world: World) -> tuple[Expected, ...]:
    from pico.policy.expectations import check_expectations

    return check_expectations(setup, trial.seen_in(world), wanted.expect)


def _judged(
    problems: tuple[Diagnostic, ...], expected: tuple[Expected, ...], how: str, places: Sequence[SourceRange | None]
) -> Check:  # fmt: skip
    if problems:
        text = _first([d for d in problems if d.code == "not-reached"] or problems)
        return Check(question="expectations", verdict="failed", broken=True, text=text, diagnostics=problems)
    said = f"{sum(e.holds is True for e in expected)} of {len(expected)} hold" if expected else "nothing is expected"
    failing = tuple(_failure(e, at) for e, at in zip(expected, places, strict=True) if not e.holds)
    return Check(
        question="expectations", verdict="failed" if failing else "passed", text=f"{said}; {how}", diagnostics=failing
    )


def _failure(one: Expected, at: SourceRange | None) -> Diagnostic:
    verb = "fails" if one.holds is False else "can't be told, which is a failure"
    text = f"the expectation `{one.that}` {verb}{f': {one.message}' if one.message else ''}"
    return error("expectation", text, detail=one.why, source=at)


def _rule(rule: object) -> Diagnostic:
    assert isinstance(rule, dict)
    text = f"the policy of this lab {'denies it' if rule['level'] == 'mandatory' else 'advises against it'}"
    found = f"{text}: {rule['rule']}: {rule['text']}"
    return error("denied", found) if rule["level"] == "mandatory" else warning("advised", found)


def _valid(candidate: Candidate) -> Check:
    found = candidate.manifests.diagnostics
    if not candidate.valid:
        return Check(question="valid", verdict="failed", text=_first(found), diagnostics=found)
    return Check(question="valid", verdict="passed", text=f"{len(candidate.files)} files", diagnostics=found)


def _formatted(candidate: Candidate) -> Check:
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


def _skipped(why: str, first: int) -> tuple[Check, ...]:
    return tuple(Check(question=question, verdict="skipped", text=why) for question in QUESTIONS[first:])


def _first(found: tuple[Diagnostic, ...] | list[Diagnostic]) -> str:
    wrong = [d.summary for d in found if d.severity == "error"]
    return wrong[0] + (f", and {len(wrong) - 1} more" if len(wrong) > 1 else "")


def _timed(ask: Callable[[], Check]) -> Check:
    begun = time.monotonic()
    return replace(ask(), seconds=round(time.monotonic() - begun, 3))
