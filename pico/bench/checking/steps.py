"""A lab asked one question after the other; what can't be asked any more is skipped and says why."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from typing import TypeVar

from pico.bench.checking import questions, trial
from pico.bench.checking.candidate import Candidate, Origin, bench_changes, start
from pico.bench.checking.questions import Case, CheckRecipes
from pico.bench.checking.verdict import QUESTIONS, Check, LabChecked
from pico.history.lab.folder import between
from pico.model.plan import Plan

T = TypeVar("T")


def check_lab(candidate: Candidate, before: Origin, *, what: str, fidelity: str, folder: str = ".") -> LabChecked:
    """Return what becomes of a lab, called `what`, against its state before, in a simulated bench of its own. Raises
    nothing for what the manifests hold."""
    checks = (_timed(lambda: questions.valid(candidate)), _timed(lambda: questions.formatted(candidate)))
    found = LabChecked(
        lab=candidate.name, folder=folder, base=before.against, fidelity=fidelity, notes=before.notes, checks=checks
    )
    if not candidate.valid:
        return _with(found, *_skipped("the manifests are not valid", 2))
    setup, wanted = candidate.manifests.require()
    begin, notes = start(setup, before)
    known = (before.setup or setup, before.state or begin)
    found = replace(found, notes=notes, changes=between(known, (setup, wanted)), bench=bench_changes(setup, before))
    seen = trial.stood_as(setup, begin)
    return _physical(found, Case(candidate, setup, wanted, seen, before.against.commit, what, fidelity))


def with_recipes(
    found: LabChecked, candidate: Candidate, recipes: CheckRecipes, revision: Callable[[str], bool]
) -> LabChecked:
    """Return what became of a lab, with whether its recipes are right; a lab that can't be read has no bench for them.
    `revision`: whether there is one of a name."""
    if candidate.manifests.setup is None or not candidate.valid:
        return _with(found, Check(question="recipes", verdict="skipped", text="the manifests are not valid"))
    setup = candidate.manifests.setup
    return _with(found, _timed(lambda: questions.recipes(candidate, setup, recipes, revision)))


def _physical(found: LabChecked, case: Case) -> LabChecked:
    """Put the questions to a valid lab that are asked of the bench."""
    stands = _timed(lambda: questions.stands(case))
    feasible, plan = _timed_pair(lambda: _planned(case))
    found = replace(found, plan=plan)
    if stands.verdict == "failed":
        return _with(found, stands, *_skipped("not everything has room to stand", 3))
    if feasible.verdict == "failed":
        return _with(found, stands, feasible, *_skipped("no plan leads there", 4))
    holds, expected = _timed_pair(lambda: questions.expectations(case, plan))
    allowed, rules = _timed_pair(lambda: questions.policy(case, plan))
    return _with(replace(found, expectations=expected, rules=rules), stands, feasible, holds, allowed)


def _planned(case: Case) -> tuple[Check, Plan]:
    plan = case.plan(case.seen)
    return questions.feasible(plan), plan


def _with(found: LabChecked, *checks: Check) -> LabChecked:
    return replace(found, checks=(*found.checks, *checks))


def _skipped(why: str, first: int) -> tuple[Check, ...]:
    return tuple(Check(question=question, verdict="skipped", text=why) for question in QUESTIONS[first:])


def _timed(ask: Callable[[], Check]) -> Check:
    return _timed_pair(lambda: (ask(), None))[0]


def _timed_pair(ask: Callable[[], tuple[Check, T]]) -> tuple[Check, T]:
    """Return an answer with the seconds that it took, and what it brought along."""
    begun = time.monotonic()
    check, more = ask()
    return replace(check, seconds=round(time.monotonic() - begun, 3)), more
