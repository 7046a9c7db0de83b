"""How a commit came to a leaf's value: by which run, by hand, as an edit that was never realized."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Literal

from pico.history.blame.follow import Address
from pico.history.git.commit import Commit
from pico.history.messages.trailers import EVIDENCE, HAND, LAB, values
from pico.model.record import record
from pico.model.run import Run


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
    """What blame needs to know of a run: the leaves that it changed, and those that changed after it."""

    how: How
    order: tuple[str, int, str]
    changes: tuple[Address, ...] = ()
    afterwards: tuple[Address, ...] = ()

    def as_list(self) -> list[Any]:
        """Return it as JSON data, for `brief_from`."""
        h = self.how
        return [[h.run, h.cause, h.recipe, h.step, h.evidence], self.order, self.changes, self.afterwards]


def brief_from(data: list[Any]) -> RunBrief:
    """Return what `RunBrief.as_list` gave; raises ValueError or TypeError for anything else."""
    (run, cause, recipe, step, evidence), (at, number, name), made, after = data
    how = How(kind="run", run=run, cause=cause, recipe=recipe, step=step, evidence=evidence)
    return RunBrief(how, (at, number, name), tuple((c, t) for c, t in made), tuple((c, t) for c, t in after))


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
    return RunBrief(how, document.order, made, after)


def how(commit: Commit, runs: Sequence[RunBrief], at: Address) -> How:
    """Return how `commit`, which brought `runs` along, came to the leaf `at` that it changed."""
    evidence, told = _said(commit.message)
    changing = max((r for r in runs if at in r.changes), key=lambda run: run.order, default=None)
    if changing is not None and at not in changing.afterwards and evidence != "planned":
        return changing.how
    if len(commit.parents) > 1:
        return How(kind="merge", evidence=evidence)
    if evidence == "planned":
        return How(kind="planned", evidence=evidence)
    said = values(commit.message, HAND)
    if said and ".".join(at) not in said[-1].split(", "):
        return How(kind="edited", evidence=evidence)
    return How(kind="hand" if said or runs or told else "commit", evidence=evidence)


@lru_cache(maxsize=1 << 14)
def _said(message: str) -> tuple[str | None, bool]:
    """Return the evidence that a commit names, and whether it is one that would carry the runs that there were."""
    evidence = values(message, EVIDENCE)
    return (evidence[-1] if evidence else None, bool(evidence and values(message, LAB)))
