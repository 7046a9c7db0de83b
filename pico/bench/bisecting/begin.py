"""Beginning a bisection, and taking one up again where it was left."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

from pico.bench.bisecting.records import BisectionTask, Tried
from pico.bench.bisecting.search import Bisection, TrialBench
from pico.diagnostics import PicoError, error
from pico.history.bisect.git_state import GitBisect, require_order
from pico.model.address import renamed_expression, renaming_of
from pico.model.record import as_json
from pico.model.state import Expectation
from pico.policy.expectations import require_expressions

MEASURE = 5.0
"""How long a measurement takes where nobody says [s]."""


def begin(
    bench: TrialBench, bad: str, good: str, *, expect: str | None = None, from_bad: bool = False,
    measure: float = MEASURE, trust: bool = False, suspicion: float = 10.0,
) -> Bisection:  # fmt: skip
    """Begin to bisect between two revisions, or go on where the same one is under way. Nothing moves yet, and no file
    is touched.

    `expect`: the expression that must hold; without it a person judges, or with `from_bad` what the bad revision
    expects. `measure`: how long a measurement takes [s]. `trust`: the ends are not measured. `suspicion`: how many
    times likelier a commit is that changed what is spoken of; 1: all are alike. Raises PicoError for revisions between
    which nothing can be found, for an expression that makes no sense, and where another bisection is under way.
    """
    history = bench.folder.history()
    ends = history.resolve(bad).id, history.resolve(good).id
    wanted: tuple[Expectation, ...] = (_expectation(bench, expect),) if expect is not None else ()
    if from_bad and not wanted:
        wanted = bench.folder.state_at(bad).expect
        if not wanted:
            hint = "say what must hold: `--expect 'p2.pose.x < 530'`; or judge yourself: `pico bisect start`"
            raise PicoError(error("bisect", f"{bad} expects nothing", hint=hint))
    require_expressions(bench.setup, [one.that for one in wanted])
    running = _left(bench, ends)
    if running is not None and (running.task.expect == wanted or not wanted):
        own = running.task
        running.task = replace(own, measure=measure, suspicion=suspicion, trust=trust or own.trust)
        return running
    if running is not None and running.left() > 1:
        asked = " and ".join(f"`{one.that}`" for one in running.task.expect) or "what a person says"
        hint = "`pico bisect continue` goes on with it, `pico bisect reset` ends it"
        raise PicoError(error("bisect", f"the bisection under way asks for {asked}", hint=hint))
    require_order(history.root, *ends, (bad, good))
    task = BisectionTask(
        bad=ends[0], good=ends[1], bad_name=bad, good_name=good, expect=wanted, measure=measure, trust=trust,
        suspicion=suspicion,
    )  # fmt: skip
    if running is not None:
        running.git.reset()
    git = GitBisect.start(history.root, *ends)
    git.note({"task": as_json(task)})
    return Bisection(bench, git, task)


def under_way(bench: TrialBench, *, expect: str | None = None, measure: float | None = None) -> Bisection:
    """Return the bisection that was begun here, as it was left; raises PicoError where there is none.

    One that `git bisect start --no-checkout` began, or that was replayed, can be taken up, too, with what is expected.
    """
    git = _of_git(bench)
    if git is None:
        raise PicoError(error("bisect", "no bisection is under way", hint="`pico bisect start BAD GOOD`"))
    if not git.detached_from_files:
        hint = "`git bisect run pico bisect step -y --expect ...` goes on with it, `git bisect reset` ends it"
        raise PicoError(error("bisect", "git checks files out for the bisection under way", hint=hint))
    asked = None if expect is None else _expectation(bench, expect)
    if asked is not None:
        require_expressions(bench.setup, [asked.that])
    found = _task(git)
    ends = git.ends()
    if found is None:
        if ends.bad is None or not ends.good:
            raise PicoError(error("bisect", "git knows no bad and no good commit yet", hint="`git bisect bad COMMIT`"))
        found = BisectionTask(bad=ends.bad, good=ends.good[0], trust=True)
    found = replace(
        found,
        expect=found.expect if asked is None else (asked,),
        measure=found.measure if measure is None else measure,
    )  # fmt: skip
    tried = [t for note in git.notes() if "tried" in note and (t := _tried(note["tried"])) is not None]
    bisection = Bisection(bench, git, found, tried)
    bisection.settle()
    return bisection


def _expectation(bench: TrialBench, expect: str) -> Expectation:
    """Return what is expected, with each component by the name that it has now."""
    return Expectation(that=renamed_expression(renaming_of(bench.setup.lab), expect))


def _left(bench: TrialBench, ends: tuple[str, str]) -> Bisection | None:
    """Return the bisection between these ends where it is under way; raises PicoError for another one that is not
    over."""
    git = _of_git(bench)
    if git is None:
        return None
    found, judged = _task(git), git.ends()
    if found is not None and (found.bad, found.good) == ends and git.detached_from_files:
        return under_way(bench)
    if judged.bad is not None and judged.good and len(git.suspects(judged)) > 1:
        names = f"{judged.bad[:7]} (bad) and {judged.good[0][:7]} (good)"
        name = (found.bad_name, found.good_name) if found else ("", "")
        names = f"{name[0]} (bad) and {name[1]} (good)" if all(name) else names
        hint = "`pico bisect continue` goes on with it, `pico bisect reset` ends it"
        raise PicoError(error("bisect", f"another bisection is under way, between {names}", hint=hint))
    git.reset()
    return None


def _of_git(bench: TrialBench) -> GitBisect | None:
    root: Path = bench.folder.history().root
    return GitBisect.under_way(root)


def _task(git: GitBisect) -> BisectionTask | None:
    """Return what the bisection is about, as its log tells; None where PICO did not begin it."""
    for note in git.notes():
        try:
            data = dict(note["task"])
            expect = tuple(Expectation(**one) for one in data.pop("expect", ()))
            return BisectionTask(**data, expect=expect)
        except (KeyError, TypeError, ValueError):
            continue
    return None


def _tried(data: Any) -> Tried | None:
    try:
        return Tried(**data)
    except TypeError:
        return None
