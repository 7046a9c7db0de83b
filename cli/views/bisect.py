"""A bisection: what is tried, what came of it, and in the end the first bad configuration."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from pico.bench.bisecting.records import BisectionOutcome, Proposal
from pico.bench.bisecting.records import Tried as TriedRecord
from pico.bench.bisecting.search import Bisection
from pico.bench.bisecting.step import TrialStep as StepRecord
from pico.history.lab.folder import CommitEntry
from pico.model.record import as_json

from .diff import brief, lines
from .log import entry_data
from .style import count, listed, paint, seconds, shorten, wrap

SCHEMA = "pico.bisect/v1"
_STYLES = {"good": "green", "bad": "red", "skip": "yellow"}
_HOW = {"same": "no trial", "impossible": "can't be built", "unreadable": "can't be read"}


class Begun:
    """A bisection that begins or is taken up."""

    @staticmethod
    def text(search: Bisection) -> str:
        left = search.left()
        if left < 2:
            return _asked(search)
        trials = count(search.expected_trials(left), "configuration")
        ends = search.ends_to_measure()
        first = f", after {count(len(ends), 'end')}" if ends else ""
        return f"{_asked(search)}\n{count(left, 'commit')} may be the first bad one: about {trials} to try{first}."

    @staticmethod
    def data(search: Bisection) -> dict[str, Any]:
        return {"schema": SCHEMA, "kind": "begun", "task": as_json(search.task), "left": search.left()}


class Proposed:
    """What is tried next."""

    @staticmethod
    def text(search: Bisection, proposal: Proposal, name: str) -> str:
        where = f"the {proposal.end} end" if proposal.end in ("good", "bad") else ""
        where = where or f"{proposal.number} of about {proposal.about}"
        plan = proposal.plan
        what = f"{seconds(plan.makespan)}: {brief(plan.changes)}" if plan.operations else "the bench stands so already"
        return "\n".join(wrap(f"Next, {where}: {name} · {what}", ""))

    @staticmethod
    def data(search: Bisection, proposal: Proposal, name: str) -> dict[str, Any]:
        own = {k: getattr(proposal, k) for k in ("commit", "end", "number", "about", "left")}
        return {"schema": SCHEMA, "kind": "proposed", **own, "seconds": proposal.plan.makespan}


class TriedView:
    """One configuration that was judged."""

    @staticmethod
    def text(search: Bisection, tried: TriedRecord, proposal: Proposal | None = None) -> str:
        number = f"{proposal.number} of about {proposal.about}" if proposal else ""
        number = f"{tried.end} end" if tried.end in ("good", "bad") else number
        number = "fork" if tried.end == "fork" else number
        took = f"{tried.travel:.1f} + {tried.measure:g} s" if tried.by == "measured" else _HOW.get(tried.by, "")
        verdict = paint(_STYLES[tried.verdict], f"{tried.verdict:<4}")
        summary = search.summary(tried.commit)
        line = f"{number:<13} {paint('yellow', tried.commit[:7])} {shorten(summary, 32):<32} {took:>14}  {verdict}"
        return f"{line}  {tried.why}".rstrip()

    @staticmethod
    def data(search: Bisection, tried: TriedRecord, proposal: Proposal | None = None) -> dict[str, Any]:
        own = {"number": proposal.number, "about": proposal.about, "left": proposal.left} if proposal else {}
        return {"schema": SCHEMA, "kind": "tried", **own, **as_json(tried)}


class EndView:
    """What it came to."""

    @staticmethod
    def text(
        search: Bisection, outcome: BisectionOutcome, entry: CommitEntry | None, name_of: Callable[[str], str]
    ) -> str:
        said = _found(entry) if entry else _not_found(search, outcome, name_of)
        runs = [f"  run {run}" for run in outcome.runs]
        return "\n".join(
            ["", *said, *runs, "", *wrap(_cost(outcome), ""), *_skipped(outcome), *wrap(_where(search), "")]
        )

    @staticmethod
    def data(
        search: Bisection, outcome: BisectionOutcome, entry: CommitEntry | None, name_of: Callable[[str], str]
    ) -> dict[str, Any]:
        found = {"commit": entry_data(entry)} if entry else {}
        return {"schema": SCHEMA, "kind": "over", **as_json(outcome), **found, "git": outcome.said}


class StandingView:
    """Where a bisection stands."""

    @staticmethod
    def text(search: Bisection, outcome: BisectionOutcome, name_of: Callable[[str], str]) -> str:
        rows = [TriedView.text(search, tried) for tried in search.tried]
        if outcome.first_bad:
            last = f"{name_of(outcome.first_bad)} is the first bad commit. `pico bisect reset` ends the bisection."
        else:
            left, under = search.left(), search.git.pointed()
            last = f"{count(left, 'commit')} may still be the first bad one"
            last += f"; under trial: {name_of(under)}." if under else "."
            next_step = "`pico bisect continue` goes on."
            if not search.task.expect:
                next_step = (
                    "`pico bisect good`, `bad` or `skip` judges it; `pico bisect continue` brings the bench to it."
                )
            last = f"{last} {next_step}"
        return "\n".join([_asked(search), *rows, *wrap(last, "")])

    @staticmethod
    def data(search: Bisection, outcome: BisectionOutcome, name_of: Callable[[str], str]) -> dict[str, Any]:
        own = {"task": as_json(search.task), "tried": as_json(search.tried), "left": search.left()}
        return {
            "schema": SCHEMA,
            "kind": "status",
            **own,
            "under_trial": search.git.pointed(),
            "first_bad": outcome.first_bad,
        }


class StepView:
    """One trial of `pico bisect step`."""

    @staticmethod
    def text(found: StepRecord) -> str:
        return f"{paint('yellow', found.commit[:7])} {seconds(found.seconds)}  {found.verdict}  {found.why}"

    @staticmethod
    def data(found: StepRecord) -> dict[str, Any]:
        return {"schema": SCHEMA, "kind": "step", **as_json(found)}


def judge_it(name: str) -> str:
    """Return what a person has to do now."""
    return "\n".join(wrap(f"The bench stands as {name}. Look, then say `pico bisect good`, `bad` or `skip`.", ""))


def _asked(search: Bisection) -> str:
    """Return between what, by what, and how long that takes."""
    task = search.task
    by = " and ".join(f"`{one.that}`" for one in task.expect) or "what a person sees"
    ends = f"{_name(task.good_name, task.good)} (good) and {_name(task.bad_name, task.bad)} (bad)"
    return "\n".join(wrap(f"Between {ends}, by {by}, {task.measure:g} s a measurement.", ""))


def _found(entry: CommitEntry) -> list[str]:
    c = entry.commit
    name = c.short + (f" ({', '.join(c.refs)})" if c.refs else "")
    head = f'{paint("bold", name)} is the first bad commit: "{c.summary}", {c.author}, {c.time:%Y-%m-%d %H:%M}'
    changed = [f"  {entry.unreadable}"] if entry.unreadable else lines(entry.changes) or ["  no change on the table"]
    return [*wrap(head, ""), *changed]


def _not_found(search: Bisection, outcome: BisectionOutcome, name_of: Callable[[str], str]) -> list[str]:
    if outcome.mended:
        good = _name(search.task.good_name, search.task.good)
        text = f"{name_of(outcome.mended)}, the fork, is bad already: it was mended on the way to {good}."
        return wrap(f"{text} Name an ancestor of it as good to find what broke it.", "")
    names = [name_of(c) for c in outcome.suspects]
    text = (
        f"The first bad commit is one of {count(len(names), 'commit')}; the others could not be told: {listed(names)}"
    )
    return wrap(text, "")


def _cost(outcome: BisectionOutcome) -> str:
    text = f"{count(outcome.tried, 'configuration')} tried, {seconds(outcome.seconds)} at the bench"
    if outcome.halving is not None:
        text += f"; always taking the middle one would have taken about {seconds(outcome.halving)}"
    return text + "."


def _skipped(outcome: BisectionOutcome) -> list[str]:
    return [f"  skipped {t.commit[:7]}: {t.why}" for t in outcome.skipped]


def _where(search: Bisection) -> str:
    stands = next((t.commit for t in reversed(search.tried) if t.by in ("measured", "person")), None)
    where = f"The bench stands at {stands[:7]}; the files were not touched. " if stands else ""
    back = "`pico apply` brings it back to the manifest. " if stands else ""
    return f"{where}{back}`pico bisect log` tells what was judged; `pico bisect reset` ends the bisection."


def _name(called: str, commit: str) -> str:
    return called or commit[:7]
