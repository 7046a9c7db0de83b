"""A run, `pico.run/v1`: what led from one state of a bench to the next, and how far that is proven."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import field
from typing import Any, Literal

from pico.base.formats import Format
from pico.model.diff import Change
from pico.model.plan import LabRef
from pico.model.record import record
from pico.model.trace.expectation import Expected

FORMAT = Format("pico.run")

Evidence = Literal["planned", "kinematic", "physics", "emulated", "hardware"]
RunOutcome = Literal["done", "failed", "interrupted"]
"""How a run ended that came to its end."""
RunEnd = Literal["done", "failed", "interrupted", "killed"]

STRENGTH: Mapping[str, int] = {"planned": 0, "kinematic": 1, "physics": 2, "emulated": 3, "hardware": 4}
"""How much an evidence counts; only `hardware` says something of a real table."""
SHARED = (
    "schema", "lab", "parent", "cause", "evidence", "seed", "operator", "calibration", "environment", "versions",
    "bench",
)  # fmt: skip
"""What runs have in common that are folded into one."""
FOLD = "-fold"
"""What the name of a run ends with that others are folded into; it begins with the first of them."""
TRIALS = ("bisect",)
"""Causes of runs that only try something: no commit takes them."""
OPERATION_ENDS = ("done", "failed", "unknown", "skipped")
"""How an operation of a run ends; what did not begin is skipped."""


@record
class Cause:
    """Why a run was started.

    `kind`: `apply`, `checkout`, `single`, `undo`, `redo`, `recover`, `resume`, `heal`, `bisect`, `recipe`, `optimizer`,
    `teleoperation`, `recording` (of a script), or empty where the journal did not keep it. `of`: the run that it undoes
    or goes on with. `recipe`, `step`: which.
    """

    kind: str = ""
    of: str | None = None
    recipe: str | None = None
    step: str | None = None


@record
class FileRef:
    """A file beside the document: the SHA-256 of its bytes (64 digits), and how many they are."""

    sha256: str
    size: int


@record
class Artifact:
    """Data of a run that is too big for a commit, in the content store under `sha256` (64 digits) with `size` bytes.

    `name` as it would have in the run's folder, where `.gz` says that it is packed. `component` and `seq`: whose it is,
    and the event of the trace that it belongs to. `shape`, `dtype` of an array.
    """

    name: str
    sha256: str
    size: int
    media_type: str = "application/octet-stream"
    component: str | None = None
    seq: int | None = None
    shape: tuple[int, ...] | None = None
    dtype: str | None = None


@record
class Seen:
    """The bench as it was observed when a run was over: when, the digest of that state, and how surely: `looked` false
    where nobody looked any more (the process was killed) and it is what the operations themselves saw."""

    at: str
    state: str
    looked: bool = True


@record
class GoalStood:
    """How a goal stood: `aligned`, `stale`, `lost` or `never measured`, and `why` where it is not aligned; `at` by the
    wall, and `last`, what was measured then, by address, with one standard deviation as `<number>_sigma`."""

    status: Literal["aligned", "stale", "lost", "never measured"]
    why: str = ""
    at: str = ""
    last: Mapping[str, float] | None = None


@record
class Run:
    """One run.

    `parent`: the commit that was checked out when it was planned. `state_before`: the digest of the live state that it
    started from. `state_after`: the digest of the state that it led to, exactly as manifests hold that: of the state
    committed with it where the bench was seen to stand so, within its tolerances, when the commit was made; else of
    its goal, where it was reached; else of what was observed. `observed` is the observed state in any case, which has
    every digit of the noise. `goal` in words, `goal_commit` where it was a revision's. `number` counts the runs of its
    bench, so that those of one second have an order.

    `seconds`: the time in which something moved, on the bench's clock. `tally` counts operations by how they ended.
    `resumed`: how often the run was taken up again until then; a document whose id ends with `-r1` has what came after
    the first time, when a commit had the rest already. `changes`: what the run changed on the bench, `tolerated` where
    by less than the tolerance; `afterwards`: what has changed since then, beyond it, when the commit was made: by hand,
    or by itself. `unmet`: goals that were sought, or measured, and not met. `goals`: how those stood whose light came
    by, and set-points that light finds, when the commit was made; of the last run that it brings. `files`: those beside
    this one. `planned` evidence never occurs: a run ran.

    `bench`: the bench that it was on: `sim`, `emulated`, `hardware`, or LAB/BENCH of a coordinator.

    `folded`: what this run was put together from when it was committed, in the order in which it ran: of each the
    document, without what all of them have in common (`SHARED`). `pico.runs.folding` gives each back as it was.
    """

    schema: str = FORMAT.schema
    id: str
    number: int = 0
    lab: LabRef
    parent: str | None = None
    state_before: str
    state_after: str
    observed: Seen | None = None
    plan: str
    goal: str = ""
    goal_commit: str | None = None
    cause: Cause = Cause()
    evidence: Evidence
    seed: int | None = None
    operator: str = ""
    calibration: str | None = None
    environment: Mapping[str, str] = field(default_factory=dict)
    versions: Mapping[str, str] = field(default_factory=dict)
    started_at: str
    ended_at: str = ""
    outcome: RunEnd
    seconds: float = 0.0
    tally: Mapping[str, int] = field(default_factory=dict)
    resumed: int = 0
    expectations: tuple[Expected, ...] = ()
    changes: tuple[Change, ...] = ()
    afterwards: tuple[Change, ...] = ()
    files: Mapping[str, FileRef] = field(default_factory=dict)
    artifacts: tuple[Artifact, ...] = ()
    folded: tuple[Mapping[str, Any], ...] = ()
    unmet: tuple[str, ...] | None = None
    goals: Mapping[str, GoalStood] | None = None
    bench: str | None = None

    @property
    def order(self) -> tuple[str, int, str]:
        """What runs are sorted by: when they started."""
        return self.started_at, self.number, self.id


@record
class TraceEvent:
    """One line of `trace.jsonl` or `measurements.jsonl`.

    `t`: seconds on the bench's clock since the first operation began; `at`: the wall time, UTC; `seq` counts from 1.
    `kind` of a trace: `intent` (`data`: the operation), `started` (the component as observed before), `done`, `failed`
    and `unknown` (`outcome`, `seconds`, the component `after`), `resolved` (how an unknown one ended, and who said so);
    `operation` and `attempt` say of what; `run` of which of the runs that are folded into one, whose own `t` and `seq`
    these are. What ended an operation is one transition or measurement: `before` and `after` are the digests of the
    states from which it led and to which, `actor` is who had it done. Of measurements: `measurement` (`data`: a
    `pico.measurement`), `expectation`, `observation` (a component as observed after the run).
    """

    t: float
    at: str = ""
    seq: int
    kind: str
    operation: str | None = None
    attempt: int | None = None
    component: str | None = None
    data: Mapping[str, Any] = field(default_factory=dict)
    run: str | None = None
    before: str | None = None
    after: str | None = None
    actor: str | None = None


def tally(ends: Iterable[str]) -> dict[str, int]:
    """Return how many operations ended how, by OPERATION_ENDS; one that has not ended yet counts as skipped."""
    found = Counter(end if end in OPERATION_ENDS else "skipped" for end in ends)
    return {end: found[end] for end in OPERATION_ENDS}
