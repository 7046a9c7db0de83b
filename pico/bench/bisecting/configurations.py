"""The commits between good and bad as configurations of one bench: which of them are one to it, and how far apart."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field

from pico.bench.bisecting.costs import Leaves, PlanSeconds, leaves
from pico.diagnostics import PicoError
from pico.history.bisect.choice import NextCommit, Suspects, choices, halfway
from pico.history.git.partial import require_fetched
from pico.history.lab.folder import LabFolder
from pico.model.observation import Observation
from pico.model.setup import Setup
from pico.model.state import LabState

READ = 256
"""So many commits are read at most for one choice, spread over all; the next choice is among fewer."""
Lineage = Sequence[tuple[str, tuple[str, ...]]]
"""Commits, parents first, each with its parents."""


@dataclass
class Configurations:
    """The configurations of commits on a bench; each is read once."""

    folder: LabFolder
    setup: Setup
    unreadable: dict[str, str] = field(default_factory=dict)
    _states: dict[str, LabState] = field(default_factory=dict)
    _leaves: dict[str, Leaves] = field(default_factory=dict)
    _known: dict[Leaves, Leaves] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.clock = PlanSeconds(self.setup)

    def state(self, commit: str) -> LabState | None:
        """Return the state of a commit on this bench; None, with the reason in `unreadable`, where there is none."""
        if commit in self.unreadable:
            return None
        if commit not in self._states:
            try:
                self._states[commit] = self.folder.state_at(commit)
            except PicoError as exc:
                require_fetched(exc)
                self.unreadable[commit] = exc.diagnostics[0].summary
                return None
        return self._states[commit]

    def leaves(self, commit: str) -> Leaves | None:
        """Return the leaves of a commit's state: equal for commits that are one to this bench."""
        if commit not in self._leaves:
            state = self.state(commit)
            if state is None:
                return None
            fresh = leaves(self.setup, state)
            self._leaves[commit] = self._known.setdefault(fresh, fresh)
        return self._leaves[commit]

    def seconds(self, a: str, b: str) -> float:
        """Return about how long the bench needs from one readable commit to another [s]."""
        first, then = self.leaves(a), self.leaves(b)
        return self.clock.between(first, then) if first and then and first is not then else 0.0

    def read(self, lineage: Lineage, skipped: Collection[str] = ()) -> list[str]:
        """Return the commits that are read for a choice among these: the last, and at most READ spread over all that
        were not skipped."""
        names = [commit for commit, _ in lineage if commit not in skipped]
        step = max(1, -(-len(names) // READ))
        return [c for n, c in enumerate(names) if (len(names) - 1 - n) % step == 0]

    def thinned(self, lineage: Lineage, skipped: Collection[str]) -> Lineage:
        """Return the commits among which to choose: of a long line of history those that are read, each standing for
        all between it and the one before; else all."""
        known = {commit for commit, _ in lineage}
        within = [[p for p in before if p in known] for _, before in lineage]
        line = all(own == ([lineage[n - 1][0]] if n else []) for n, own in enumerate(within))
        if len(lineage) <= READ or not line:
            return lineage
        names = self.read(lineage, skipped)
        return [(commit, (names[n - 1],) if n else ()) for n, commit in enumerate(names)]

    def suspects(
        self, lineage: Lineage, skipped: frozenset[str], spoken: Collection[str] = (), suspicion: float = 1.0
    ) -> Suspects:
        """Return the commits as the choice sees them. One that changed nothing on this bench can't be the first bad
        one, and is not worth a trial; one that changed a component that is `spoken` of is `suspicion` times as likely
        to be it as others."""
        number = {commit: n for n, (commit, _) in enumerate(lineage)}
        parents = [[number[p] for p in before if p in number] for _, before in lineage]
        looked = set(self.read(lineage, skipped))
        weight, testable = [], set[int]()
        for n, (commit, before) in enumerate(lineage):
            same = commit in looked and self._as_a_parent(commit, before, looked)
            likely = not spoken or not self._as_a_parent(commit, before, looked, spoken)
            weight.append(0.0 if same else 1.0 if likely else 1.0 / suspicion)
            if commit in looked and not same and commit not in skipped and self.leaves(commit):
                testable.add(n)
        testable.discard(len(lineage) - 1)
        tried = frozenset(number[c] for c in skipped if c in number)
        return Suspects(parents, weight, frozenset(testable), tried)

    def _as_a_parent(
        self, commit: str, parents: Sequence[str], looked: set[str], names: Collection[str] = ()
    ) -> bool:  # fmt: skip
        """Return whether a commit is as one of its parents, as far as they were looked at; `names`: in these parts."""
        own = self.leaves(commit) if commit in looked else None
        if own is None:
            return False
        others = [self.leaves(p) for p in parents if p in looked or p in self._leaves]
        if not names:
            return any(other is own for other in others)
        return any(_of(other, names) == _of(own, names) for other in others if other is not None)

    def ranked(self, lineage: Lineage, suspects: Suspects, seen: Observation, measure: float) -> list[NextCommit]:
        """Return what to try next from the bench as it stands, the best first."""
        names = [commit for commit, _ in lineage]
        goals = {n: self.clock.to(seen, state) for n in suspects.testable if (state := self.state(names[n]))}
        return choices(suspects, goals.__getitem__, lambda a, b: self.seconds(names[a], names[b]), measure)

    def halved(self, lineage: Lineage, first_bad: str, start: str, measure: float) -> float | None:
        """Return how long halving would have taken about from `start` to find `first_bad` [s]; None where not all
        commits can be read."""
        number = {commit: n for n, (commit, _) in enumerate(lineage)}
        if len(lineage) > READ or first_bad not in number or any(self.leaves(c) is None for c in (start, *number)):
            return None
        bits = self.suspects(lineage, frozenset()).ancestors()
        rest, at, total = list(lineage), start, 0.0
        while len(rest) > 1:
            suspects = self.suspects(rest, frozenset())
            middle = halfway(suspects)
            if middle is None:
                break
            trial = rest[middle][0]
            total += self.seconds(at, trial) + measure
            at, before = trial, bits[number[trial]]
            bad = bool(before >> number[first_bad] & 1)
            rest = [entry for entry in rest if bool(before >> number[entry[0]] & 1) == bad]
        return total


def _of(whole: Leaves, names: Collection[str]) -> list[object]:
    return [leaf for leaf in whole if leaf[0] in names]


def alike(configurations: Configurations, judged: Mapping[str, str], commit: str) -> str | None:
    """Return a judged commit that is the same configuration as another one."""
    own = configurations.leaves(commit)
    return next((c for c in judged if own is not None and configurations.leaves(c) is own), None)
