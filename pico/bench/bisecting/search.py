"""`pico bisect`: which configuration broke an expectation. Git keeps the bisection; this chooses what to try next."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Protocol

from pico.bench.bisecting.configurations import Configurations, Lineage, alike
from pico.bench.bisecting.judging import decisive, impossible, not_as_called, require_known, verdict
from pico.bench.bisecting.records import BisectionOutcome, BisectionTask, End, Proposal, Tried
from pico.diagnostics import ExitCode, PicoError, error
from pico.history.bisect.choice import NextCommit
from pico.history.bisect.git_state import Ends, GitBisect, Verdict
from pico.history.lab.folder import LabFolder
from pico.model.observation import Observation
from pico.model.plan import Plan
from pico.model.record import as_json
from pico.model.setup import Setup

PLANNED = 3
"""So many of the best choices are really planned, before one of them is taken."""


class TrialBench(Protocol):
    """What a bench does for a bisection."""

    @property
    def setup(self) -> Setup: ...

    @property
    def root(self) -> Path: ...

    folder: LabFolder

    def observe(self) -> Observation: ...

    def plan(self, revision: str | None = None, *, expecting: bool = True) -> Plan: ...


class Bisection:
    """A bisection under way: `propose`, bring the bench there, then `judge` (an expectation) or `told` (a person).

    `tried`: everything that was judged so far, also what needed no trial.
    """

    def __init__(self, bench: TrialBench, git: GitBisect, task: BisectionTask, tried: Sequence[Tried] = ()) -> None:
        self.bench, self.git, self.task = bench, git, task
        self.tried = list(tried)
        self.mended: str | None = None
        self.said = ""
        self._configurations = Configurations(bench.folder, bench.setup)
        self._spoken = decisive(bench.setup, task.expect)

    def propose(self) -> Proposal | None:
        """Return what to try next, None where the search is over: see `outcome`.

        What needs no trial is judged first. Raises PicoError where nobody can say how the bench stands, and where an
        end that must be measured can't be built (exit code IMPOSSIBLE).
        """
        ends = self.git.ends()
        if pending := self.ends_to_measure():
            return self._end(pending)
        for fork in self.git.unproven(ends) if self.mended is None else ():
            if found := self._fork(fork):
                return found
        while self.mended is None:
            ends = self.git.ends()
            lineage = self.git.suspects(ends)
            if len(lineage) < 2:
                return None
            if self._without_trial(ends, lineage):
                continue
            shown = self._configurations.thinned(lineage, ends.skipped)
            suspects = self._configurations.suspects(shown, ends.skipped, self._spoken, self.task.suspicion)
            if not suspects.testable:
                return None
            seen = self.bench.observe()
            ranked = self._configurations.ranked(shown, suspects, seen, self.task.measure)
            best = self._planned(ranked[:PLANNED], [commit for commit, _ in shown], seen)
            if best is not None:
                return self._proposal(*best, left=len(lineage))
        return None

    def judge(self, proposal: Proposal, seconds: float = 0.0) -> Tried:
        """Look at the bench, which has been brought to a proposal in `seconds`, and tell git what it is.

        Raises PicoError where an end is not as it was called: what is wrong is not in the history then, and the
        bisection is over.
        """
        seen = self.bench.observe()
        found, why = verdict(self.bench.setup, seen, self.task.expect)
        tried = Tried(
            commit=proposal.commit, verdict=found, why=why, end=proposal.end, travel=seconds,
            measure=self.task.measure, estimate=proposal.plan.makespan,
        )  # fmt: skip
        if proposal.end in ("good", "bad") and found != proposal.end:
            self.git.reset()
            state = self._configurations.state(tried.commit)
            raise PicoError(not_as_called(self.bench.setup, seen, state, tried, self._called(tried.end)))
        self._tell(tried)
        return tried

    def told(self, found: Verdict, commit: str | None = None) -> Tried:
        """Take a person's word for the configuration that is under trial, or for another commit.

        Raises PicoError where the search is over, and where the bench was not brought to what is under trial.
        """
        if self.left() < 2:
            raise PicoError(error("bisect", "the bisection is over", hint="`pico bisect reset` ends it"))
        name = commit or self.git.pointed()
        built = [note["commit"] for note in self.git.notes() if note.get("built")]
        if commit is None and (name is None or name != (built or [None])[-1]):
            text = f"the bench was not brought to {name[:7] if name else 'any configuration'} yet"
            hint = "`pico bisect continue` does; or name the commit that you mean"
            raise PicoError(error("bisect", text, hint=hint))
        end: End = "fork" if name in self.git.unproven(self.git.ends()) else ""
        tried = Tried(
            commit=str(name), verdict=found, by="person", why="as told", end=end, measure=self.task.measure
        )  # fmt: skip
        self._tell(tried)
        return tried

    def spent(self, commit: str, seconds: float, *, built: bool) -> None:
        """Take note of what the bench took to get to a configuration [s], or only near it, without a verdict."""
        self.git.note({"spent": round(seconds, 3), "commit": commit, "built": built})

    def settle(self) -> None:
        """Tell git the verdicts that were written down and not told, because the process was killed in between."""
        ends = self.git.ends()
        told = {*ends.good, *ends.skipped, *([ends.bad] if ends.bad else [])}
        suspects = {commit for commit, _ in self.git.suspects(ends)}
        for tried in self.tried:
            if tried.end in ("good", "bad") or tried.commit in told:
                continue
            if tried.commit in suspects or tried.end == "fork":
                self.said = self.git.tell(tried.verdict, [tried.commit])
        forks = [t for t in self.tried if t.end == "fork" and t.verdict == "bad"]
        self.mended = forks[-1].commit if forks else None

    def outcome(self) -> BisectionOutcome:
        """Return what it came to, so far."""
        ends = self.git.ends()
        lineage = self.git.suspects(ends)
        names = tuple(commit for commit, _ in lineage)
        found = names[0] if len(names) == 1 and self.mended is None else None
        trials = [t for t in self.tried if t.by in ("measured", "person")]
        return BisectionOutcome(
            first_bad=found, suspects=() if found else names, mended=self.mended, said=self.said,
            tried=len(trials), seconds=sum(t.seconds for t in trials) + self._spent(),
            halving=self._halving(found) if found else None, runs=self._runs(found) if found else (),
            skipped=tuple(t for t in self.tried if t.verdict == "skip"),
        )  # fmt: skip

    def expected_trials(self, left: int) -> int:
        """Return how many trials about `left` suspects take."""
        return math.ceil(math.log2(left)) if left > 1 else 0

    def left(self) -> int:
        """Return how many commits may still be the first bad one."""
        return len(self.git.suspects(self.git.ends()))

    def summary(self, commit: str) -> str:
        """Return the first line of a commit's message."""
        return self.bench.folder.history().resolve(commit).summary

    def _runs(self, commit: str) -> tuple[str, ...]:
        from pico.history.runs.committed import runs_added

        folder = self.bench.folder
        return tuple(run.id for run in runs_added(folder.history(), commit, folder.root))

    def _spent(self) -> float:
        return sum(float(note["spent"]) for note in self.git.notes() if isinstance(note.get("spent"), int | float))

    def ends_to_measure(self) -> list[End]:
        """Return the ends that are still to be measured, the good one first."""
        known = {t.end for t in self.tried}
        wanted: tuple[End, ...] = () if self.task.trust or not self.task.expect else ("good", "bad")
        return [end for end in wanted if end not in known]

    def _end(self, pending: Sequence[End]) -> Proposal:
        """Return the nearer of the ends that are to be measured."""
        seen = self.bench.observe()
        commits = {end: self.task.good if end == "good" else self.task.bad for end in pending}
        states = {end: self._configurations.state(commit) for end, commit in commits.items()}
        for end, state in states.items():
            if state is None:
                name, why = self._called(end), self._configurations.unreadable[commits[end]]
                raise PicoError(error("bisect", f"the {end} end, {name}, can't be read: {why}", hint="name another"))
        clock = self._configurations.clock
        nearest = min(pending, key=lambda end: clock.to(seen, states[end]))  # type: ignore[arg-type]
        plan = self._known_plan(commits[nearest], seen)
        if why := impossible(plan):
            raise PicoError(
                error("bisect", f"the {nearest} end, {self._called(nearest)}, can't be built now: {why}",
                      hint="name another commit, or take the ends on trust: --trust"),
                ExitCode.IMPOSSIBLE,
            )  # fmt: skip
        return Proposal(commit=commits[nearest], plan=plan, end=nearest, left=len(self.git.suspects(self.git.ends())))

    def _fork(self, commit: str) -> Proposal | None:
        """Return the fork of a good branch to be tried; None where it can't be, and was skipped: git goes on, too."""
        if self._configurations.state(commit) is None:
            why = self._configurations.unreadable[commit]
            self._tell(Tried(commit=commit, verdict="skip", why=why, by="unreadable", end="fork"))
            return None
        plan = self._known_plan(commit, self.bench.observe())
        if why := impossible(plan):
            self._tell(Tried(commit=commit, verdict="skip", why=why, by="impossible", end="fork"))
            return None
        return self._proposal(commit, plan, left=self.left(), end="fork")

    def _proposal(self, commit: str, plan: Plan, left: int, end: End = "") -> Proposal:
        self.git.point(commit)
        number = sum(t.by in ("measured", "person") and t.end not in ("good", "bad") for t in self.tried) + 1
        about = number + max(self.expected_trials(left) - (end == ""), 0)
        return Proposal(commit=commit, plan=plan, end=end, number=number, about=about, left=left)

    def _without_trial(self, ends: Ends, lineage: Lineage) -> bool:
        """Judge what can be judged without the bench, as much as one word to git says; return whether there was any."""
        looked = self._configurations.read(lineage, ends.skipped)
        bare = [c for c in looked[:-1] if self._configurations.state(c) is None]
        for commit in bare:
            why = self._configurations.unreadable[commit]
            self._tell(Tried(commit=commit, verdict="skip", why=why, by="unreadable"))
        if bare:
            return True
        judged: dict[str, Verdict] = dict.fromkeys(ends.good, "good")
        judged.update(dict.fromkeys(ends.skipped, "skip"))
        if ends.bad is not None:
            judged[ends.bad] = "bad"
        same = [
            (commit, twin) for commit in looked[:-1]
            if (twin := alike(self._configurations, judged, commit)) is not None
        ]  # fmt: skip
        if not same:
            return False
        bad = [pair for pair in same if judged[pair[1]] == "bad"]
        commit, twin = bad[0] if bad else same[-1]  # of good ones the last, of bad ones the first says most
        self._tell(Tried(commit=commit, verdict=judged[twin], why=f"the same configuration as {twin[:7]}", by="same"))
        return True

    def _planned(
        self, ranked: Sequence[NextCommit], names: Sequence[str], seen: Observation
    ) -> tuple[str, Plan] | None:  # fmt: skip
        """Return the best of some choices by their plans; None where one of them can't be built and was skipped."""
        plans = []
        for choice in ranked:
            commit = names[choice.index]
            plan = self._known_plan(commit, seen)
            if why := impossible(plan):
                self._tell(Tried(commit=commit, verdict="skip", why=why, by="impossible"))
                return None
            plans.append((choice.score(plan.makespan), commit, plan))
        _, commit, plan = min(plans, key=lambda one: one[0])
        return commit, plan

    def _known_plan(self, commit: str, seen: Observation) -> Plan:
        plan = self.bench.plan(commit, expecting=False)
        require_known(self.bench.setup, seen, plan)
        return plan

    def _tell(self, tried: Tried) -> None:
        """Write a verdict down, then tell git: a verdict that was written and not told is told when this is taken up
        again."""
        self.git.note({"tried": as_json(tried)})
        self.tried.append(tried)
        if tried.end in ("good", "bad"):
            return
        self.said = self.git.tell(tried.verdict, [tried.commit])
        if tried.end == "fork" and tried.verdict == "bad":
            self.mended = tried.commit

    def _called(self, end: End) -> str:
        task = self.task
        return (task.good_name or task.good[:7]) if end == "good" else (task.bad_name or task.bad[:7])

    def _halving(self, first_bad: str) -> float | None:
        """Return what halving would have taken about, in proportion to what these trials were reckoned to take [s]."""
        task, trials = self.task, [t for t in self.tried if t.by in ("measured", "person")]
        ends = [t for t in trials if t.end in ("good", "bad")]
        own = [t for t in trials if t.end not in ("good", "bad")]
        start = ends[-1].commit if ends else task.bad
        whole = self.git.suspects(Ends(task.bad, (task.good,), frozenset()))
        seconds = self._configurations.halved(whole, first_bad, start, task.measure)
        return None if seconds is None or not own else seconds + sum(t.seconds for t in ends)
