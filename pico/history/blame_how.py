"""How a commit came to a leaf's value: by which run, by hand, as an edit that was never realized."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from pico.history.blame import Address
from pico.history.commit import Commit
from pico.history.trailers import EVIDENCE, LAB, values
from pico.model.record import record
from pico.model.run import RunDocument


@record
class How:
    """How a leaf got its value.

    `run`: the run `id` changed it on the bench, started by `cause` (`apply`, `single`, `recipe`, `optimizer`, ...),
    where it was a recipe's in `step` of `recipe`. `hand`: captured from the bench, where no recorded run had changed
    it. `planned`: the manifest was edited, and the commit says that it was not realized. `merge`: no side of a merge
    had this value. `commit`: the commit does not say (it was made by git, or before runs were kept). `edit`: not
    committed yet.
    """

    kind: Literal["run", "hand", "planned", "merge", "commit", "edit"]
    run: str | None = None
    cause: str | None = None
    recipe: str | None = None
    step: str | None = None
    evidence: str | None = None


@dataclass(frozen=True, slots=True)
class RunBrief:
    """What blame needs to know of a run: the leaves that it changed, and those that changed after it."""

    how: How
    started_at: str
    changes: tuple[Address, ...] = ()
    afterwards: tuple[Address, ...] = ()

    def dumps(self) -> str:
        """Return it as JSON, for `brief_from`."""
        h = self.how
        said = [h.run, h.cause, h.recipe, h.step, h.evidence]
        return json.dumps([said, self.started_at, self.changes, self.afterwards], separators=(",", ":"))


def brief_from(text: str) -> RunBrief | None:
    """Return what `RunBrief.dumps` wrote, None for the `null` of a run that can't be read; raises ValueError."""
    data = json.loads(text)
    if data is None:
        return None
    (run, cause, recipe, step, evidence), started_at, *changes = data
    how = How(kind="run", run=run, cause=cause, recipe=recipe, step=step, evidence=evidence)
    made, after = (tuple((component, tunable) for component, tunable in found) for found in changes)
    return RunBrief(how, started_at, made, after)


def brief_of(document: RunDocument) -> RunBrief:
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
    return RunBrief(how, document.started_at, made, after)


def how(commit: Commit, runs: Sequence[RunBrief], at: Address) -> How:
    """Return how `commit`, which brought `runs` along, came to the leaf `at` that it changed."""
    evidence = (values(commit.message, EVIDENCE) or ("",))[-1]
    changing = max((r for r in runs if at in r.changes), key=lambda run: run.started_at, default=None)
    if changing is not None and at not in changing.afterwards and evidence != "planned":
        return changing.how
    if evidence == "planned":
        return How(kind="merge" if len(commit.parents) > 1 else "planned", evidence=evidence)
    if len(commit.parents) > 1:
        return How(kind="merge", evidence=evidence or None)
    recorded = bool(runs) or bool(evidence and values(commit.message, LAB))
    return How(kind="hand" if recorded else "commit", evidence=evidence or None)
