"""Whether the state of a commit was ever on a bench, judged by what the commit holds and by the runs in history.

Trailers are copied by `git cherry-pick`, go with `git merge --squash`, and anybody can write them: they count only
where the digest that they say is that of the commit's own state. A run counts wherever it is in history, for it says
itself to which state it led.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

from pico.diagnostics import Diagnostic, PicoError
from pico.history.git.cache import Cache
from pico.history.git.commit import Commit
from pico.history.lab.folder import LabFolder
from pico.history.messages import trailers
from pico.history.runs.committed import CACHE, RunPlace, files_at, places_in_history, read_carried, runs_added
from pico.model.address import renamed_state, renaming_of
from pico.model.trace.expectation import Standing, Verdict
from pico.model.trace.run import STRENGTH, Run
from pico.runs.files import intact
from pico.runs.reading import members
from pico.version import __version__


@dataclass(frozen=True)
class CommitClaim:
    """What a commit holds and says: the digest of its state, the runs that it added, its message, how many parents."""

    commit: str
    state: str
    message: str = ""
    added: tuple[str, ...] = ()
    parents: int = 1
    carries: bool = False


@dataclass
class Standings:
    """The standings of the commits of one lab. The history is looked through once, when the first one is asked for.

    `own`: runs of this bench that no commit has yet.
    """

    folder: LabFolder
    own: Sequence[Run] = ()
    diagnostics: list[Diagnostic] = field(default_factory=list)
    _cache: Cache | None = None

    @cached_property
    def runs(self) -> Mapping[str, Sequence[Run]]:
        """The runs by the digest of the state that they led to, the strongest evidence first, then the latest."""
        carried = read_carried(self.folder.history(), self._places.values(), self.diagnostics)
        found: dict[str, list[Run]] = {}
        for run in sorted((*carried, *self.own), key=lambda r: (STRENGTH[r.evidence], r.ended_at), reverse=True):
            for state in {run.state_after, *(str(one.get("state_after")) for one in run.folded)}:
                found.setdefault(state, []).append(run)
        return found

    @cached_property
    def _places(self) -> Mapping[str, RunPlace]:
        """Where commits have runs, by id."""
        return places_in_history(self.folder.history(), self.folder.root)

    def at_a_glance(self, commit: Commit, added: Sequence[Run]) -> Standing | None:
        """Return the standing of a commit of which the runs that it `added` are known, for a list of many; None where
        nothing claims, and nothing proves, that its state was ever on a bench."""
        claimed = any(trailers.values(commit.message, key) for key in (trailers.EVIDENCE, trailers.RUN))
        if not (claimed or added or self.runs):
            return None
        found = self.of(commit)
        return found if claimed or added or found.verdict != "planned" else None

    def _state(self, commit: Commit) -> str:
        """Return the digest of the state of a commit; what was found once is remembered, for this bench (a commit may
        not say itself of which it is)."""
        if self._cache is None:
            self._cache = Cache(self.folder.history().common / CACHE)
        key = f"{self._bench} {commit.id}"
        known = self._cache.get(key)
        if known is None:
            known = self.folder.historic(commit.id)[1].digest()
            self._cache.put(key, known)
            self._cache.flush()
        return known

    def _as_called(self, commit: Commit, state: str) -> str:
        """Return the digest under which runs or the commit know its state: `state`, or that of the state by the other
        names that parts have now or had before."""
        names = renaming_of(self.folder.setup.lab)
        told = trailers.values(commit.message, trailers.STATE)
        if not names or state in self.runs:
            return state
        if self._cache is None:
            self._cache = Cache(self.folder.history().common / CACHE)
        key = f"{self._bench} {commit.id} names"
        known = self._cache.get(key)
        if known is None:
            own, before = self.folder.historic(commit.id)[1], {new: old for old, new in names.items()}
            known = " ".join(renamed_state(way, own).digest() for way in (names, before))
            self._cache.put(key, known)
            self._cache.flush()
        return next((one for one in known.split() if one in self.runs or one in told), state)

    @cached_property
    def _bench(self) -> str:
        return f"{__version__} {self.folder.history().relative(self.folder.root)} {self.folder.setup.digest()}"

    def of(self, commit: Commit, state: str | None = None) -> Standing:
        """Return the standing of a commit; `state`: the digest of its state, where that is known already."""
        try:
            state = self._as_called(commit, state or self._state(commit))
        except PicoError as exc:
            return Standing(verdict="unknown", commit=commit.id, why=exc.diagnostics[0].summary)
        wrong: list[Diagnostic] = []
        for run in self.runs.get(state, ()):
            place = self._places.get(run.id)
            if place is None or intact(run, files_at(self.folder.history(), place), wrong):
                led = _leading(run, state)
                return Standing(
                    verdict="verified", commit=commit.id, state=state, evidence=led.evidence, run=led.id,
                    at=led.ended_at, carried=place.commit if place else None, bench=led.bench,
                    why=f"the run {led.id} {_led(led)} exactly this state", diagnostics=tuple(wrong),
                )  # fmt: skip
        if wrong:
            why = f"the run {self.runs[state][0].id} led to it, but its files are damaged: they prove nothing"
            return Standing(verdict="inherited", commit=commit.id, state=state, why=why, diagnostics=tuple(wrong))
        added = runs_added(self.folder.history(), commit, self.folder.root, wrong)
        carries = len(commit.parents) > 1 and bool(self.runs)
        claim = CommitClaim(commit.id, state, commit.message, tuple(d.id for d in added), len(commit.parents), carries)
        return unproven(claim, tuple(wrong))


def _leading(run: Run, state: str) -> Run:
    """Return the one of the runs that are folded into one, or that itself, that led to a state."""
    return next((one for one in members(run) if run.state_after != state == one.state_after), run)


def _led(run: Run) -> str:
    """Return that a run led to a state, or that it came to its end there before it had done all."""
    return "led to" if run.outcome == "done" else f"({run.outcome}) left"


def unproven(claim: CommitClaim, diagnostics: tuple[Diagnostic, ...] = ()) -> Standing:
    """Return the standing of a commit to whose state no run led."""

    benches = trailers.values(claim.message, trailers.BENCH)

    def judged(verdict: Verdict, why: str, evidence: str | None = None) -> Standing:
        return Standing(
            verdict=verdict, commit=claim.commit, state=claim.state, evidence=evidence, why=why,
            bench=benches[-1] if evidence and benches else None, diagnostics=diagnostics,
        )  # fmt: skip

    told = trailers.values(claim.message, trailers.STATE)
    evidence = next(iter(trailers.values(claim.message, trailers.EVIDENCE)), "planned")
    named = trailers.values(claim.message, trailers.RUN)
    seen = STRENGTH.get(evidence, 0) > 0
    if seen and claim.state in told and not named:
        return judged("verified", "it was taken from the bench as it stood; no run led there", evidence)
    if claim.added:
        names = f"the run {claim.added[0]}" if len(claim.added) == 1 else f"{len(claim.added)} runs"
        return judged("inherited", f"{names} that came with it led to another state")
    if claim.state in told and named:
        return judged("inherited", f"the run {named[-1][:40]} that its message names is not there, or damaged")
    if seen or named:
        return judged("inherited", "its message speaks of another state: it was copied or edited")
    if claim.parents > 1 and claim.carries:
        return judged(
            "inherited", "a merge: its sides may have been on a bench, no commit has a run of the two together yet"
        )
    return judged("planned", "no run in this history led to it")
