"""How a commit came to a leaf's value: by which run, by hand, as an edit that was never realized."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Literal

from pico.history.blame.follow import Address
from pico.history.git.commit import Commit
from pico.history.messages.trailers import EVIDENCE, HAND, LAB, values
from pico.model.record import as_json, record
from pico.model.trace.run import Run


@record
class How:
    """How a leaf got its value.

    `run`: the run `id` changed it on the bench, started by `cause` (`apply`, `single`, `recipe`, `optimizer`, ...),
    where it was a recipe's in `step` of `recipe`. `hand`: captured from the bench, where no operation had left it so.
    `edited`: written into the manifest, and no run that the commit brings along had to change the bench for it.
    `planned`: edited, and the commit says that it was not realized. `merge`: no side of a merge
    had this value. `commit`: the commit does not say (it was made by git, or before runs were kept). `edit`: not
    committed yet.
    """

    kind: Literal["run", "hand", "edited", "planned", "merge", "commit", "edit"]
    run: str | None = None
    cause: str | None = None
    recipe: str | None = None
    step: str | None = None
    evidence: str | None = None


@dataclass(frozen=True, slots=True)
class RunBrief:
    """What blame needs to know of a run: the leaves that it changed, each with what it left (`left`), and those that
    changed after it."""

    how: How
    order: tuple[str, int, str]
    changes: tuple[Address, ...] = ()
    left: tuple[Any, ...] = ()
    afterwards: tuple[Address, ...] = ()

    def brought(self, at: Address, value: Any) -> bool:
        """Return whether a leaf that it changed was left at about a value: as exactly as parts are placed and seen."""
        left = self.left[self.changes.index(at)]
        return left is None or value is None or _about(left, value)

    def as_list(self) -> list[Any]:
        """Return it as JSON data, for `brief_from`."""
        h = self.how
        return [[h.run, h.cause, h.recipe, h.step, h.evidence], self.order, self.changes, self.left, self.afterwards]


def brief_from(data: list[Any]) -> RunBrief:
    """Return what `RunBrief.as_list` gave; raises ValueError or TypeError for anything else."""
    (run, cause, recipe, step, evidence), (at, number, name), made, left, after = data
    how = How(kind="run", run=run, cause=cause, recipe=recipe, step=step, evidence=evidence)
    addresses = [tuple((c, t) for c, t in found) for found in (made, after)]
    return RunBrief(how, (at, number, name), addresses[0], tuple(left), addresses[1])


def brief_of(document: Run) -> RunBrief:
    """Return what blame needs to know of a run."""
    cause = document.cause
    how = How(
        kind="run",
        run=document.id,
        cause=cause.kind or None,
        recipe=cause.recipe,
        step=cause.step,
        evidence=document.evidence,
    )
    made, after = (tuple((c.component, c.tunable) for c in found) for found in (document.changes, document.afterwards))
    return RunBrief(how, document.order, made, tuple(as_json(c.after) for c in document.changes), after)


def _about(a: Any, b: Any) -> bool:
    """Return whether two values of a leaf are one, but for what placing and seeing scatter (2 mm, 2 deg, a hundredth);
    of a slot and a pose nobody can tell here."""
    if isinstance(a, dict) and isinstance(b, dict):
        return all(math.isclose(a.get(k, 0.0), b.get(k, 0.0), abs_tol=2.0) for k in {*a, *b})
    numbers = [v for v in (a, b) if isinstance(v, int | float) and not isinstance(v, bool)]
    if len(numbers) == 2:
        return math.isclose(*numbers, rel_tol=0.01, abs_tol=0.2)
    return isinstance(a, dict) != isinstance(b, dict) or a == b


def how(commit: Commit, runs: Sequence[RunBrief], at: Address, value: Any = None, former: Sequence[str] = ()) -> How:
    """Return how `commit`, which brought `runs` along, came to the leaf `at` that it changed to `value`. `former`: the
    names that its component may have had then.

    A run counts only where it left about that value: a rebase or cherry-pick takes runs along to another one.
    """
    evidence, told = _said(commit.message)
    called = (at, *((name, at[1]) for name in former))
    named = [(run, one) for run in runs for one in called if one in run.changes]
    changing, then = max(named, key=lambda found: found[0].order, default=(None, at))
    counts = changing is not None and then not in changing.afterwards and evidence != "planned"
    if changing is not None and counts and changing.brought(then, value):
        return changing.how
    if len(commit.parents) > 1:
        return How(kind="merge", evidence=evidence)
    if evidence == "planned":
        return How(kind="planned", evidence=evidence)
    if counts:
        return How(kind="edited", evidence=evidence)
    said = values(commit.message, HAND)
    if said and not {".".join(one) for one in called} & set(said[-1].split(", ")):
        return How(kind="edited", evidence=evidence)
    return How(kind="hand" if said or runs or told else "commit", evidence=evidence)


@lru_cache(maxsize=1 << 14)
def _said(message: str) -> tuple[str | None, bool]:
    """Return the evidence that a commit names, and whether it is one that would carry the runs that there were."""
    evidence = values(message, EVIDENCE)
    return (evidence[-1] if evidence else None, bool(evidence and values(message, LAB)))
