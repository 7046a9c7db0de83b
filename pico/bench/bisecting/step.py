"""One trial for `git bisect run`: is the commit that git is at good?"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from pico.bench.bisecting.judging import impossible, require_known, verdict
from pico.bench.bisecting.search import TrialBench
from pico.diagnostics import PicoError
from pico.history.bisect.git_state import HEAD, GitBisect, Verdict
from pico.history.git import command as git
from pico.history.git.partial import require_fetched
from pico.history.lab.folder import LabFolder
from pico.model.address import renamed_expression, renaming_of
from pico.model.plan import Plan
from pico.model.record import record
from pico.model.state import Expectation
from pico.policy.expectations import require_expressions


@record
class TrialStep:
    """What became of a trial: the verdict on `commit`, and `why`. `seconds`: how long the bench took [s]."""

    commit: str
    verdict: Verdict
    why: str
    seconds: float = 0.0


def bisecting(folder: Path) -> bool:
    """Return whether git bisects in the working tree around a folder."""
    top = Path(git.answer(folder, ["rev-parse", "--show-toplevel"]).strip() or folder)
    return GitBisect.under_way(top) is not None


def under_trial(folder: LabFolder) -> str:
    """Return the commit that git wants to be told about, by id; where git checked it out, let the lab be the bench of
    the branch that the bisection started from, for a commit's own lab is as it was then. Raises PicoError."""
    repository = folder.history()
    running = GitBisect.under_way(repository.root)
    pointed = git.answer(repository.root, ["rev-parse", "--verify", "--quiet", HEAD]).strip()
    if running is not None and not pointed:
        folder.setup, _ = folder.historic(running.began_at())
    return pointed or repository.resolve("HEAD").id


def step(bench: TrialBench, expect: str, bring: Callable[[Plan], float]) -> TrialStep:
    """Bring the bench to the commit under trial and judge it by an expression.

    `bring`: runs a plan and returns its seconds; raises PicoError where the bench does not get there. Raises PicoError
    where nobody can say how the bench stands. What can't be built, is denied or can't be told is `skip`.
    """
    commit = under_trial(bench.folder)
    expect = renamed_expression(renaming_of(bench.setup.lab), expect)
    require_expressions(bench.setup, [expect])
    try:
        bench.folder.state_at(commit)
    except PicoError as exc:
        require_fetched(exc)
        return TrialStep(commit=commit, verdict="skip", why=f"can't be read: {exc.diagnostics[0].summary}")
    plan = bench.plan(commit, expecting=False)
    require_known(bench.setup, bench.observe(), plan)
    if why := impossible(plan):
        return TrialStep(commit=commit, verdict="skip", why=why)
    seconds = bring(plan)
    found, why = verdict(bench.setup, bench.observe(), (Expectation(that=expect),))
    return TrialStep(commit=commit, verdict=found, why=why, seconds=seconds)
