"""What a run does next, as a state machine: no I/O, no clock, no randomness. The walk drives it, and so do tests."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from pico.execution.graph import Graph
from pico.model.operation import Operation, OperationResult
from pico.model.record import as_json

ATTEMPTS = 3
"""How often an operation is tried at most: once, and twice again where that is safe."""
PLACED_BESIDE = frozenset({"misplaced", "dropped", "missed-grasp"})
"""Failures of a move after which the part may be taken from where it stands."""
ENDING = frozenset({"stopped", "put-back", "lost"})
"""Failures after which nothing more is started, not even an arm that would only park: somebody asked for that, or
nobody watches any more who steered."""
NO_ANSWER = frozenset({"timeout", "jammed"})
"""Failures of a set-point or an axis after which it may be asked for again: its target is absolute."""


@dataclass(frozen=True, slots=True)
class Dispatch:
    """An attempt to be started: `operation` as this attempt wants it, under `key`."""

    id: str
    operation: Operation
    attempt: int
    run: str

    @property
    def key(self) -> str:
        """`run id/operation id/attempt`."""
        return f"{self.run}/{self.id}/{self.attempt}"


@dataclass(frozen=True, slots=True)
class After:
    """What follows the end of an attempt: another one, or the operations that can't happen any more."""

    again: Dispatch | None = None
    skipped: tuple[Operation, ...] = ()


@dataclass
class Executor:
    """One run of a plan's operations. `stop_on_error`: a failure lets nothing more start, not even beside it."""

    operations: Sequence[Operation]
    run: str
    stop_on_error: bool = False
    graph: Graph = field(init=False)
    interrupted: bool = field(default=False, init=False)
    broken: bool = field(default=False, init=False)
    _refused: set[str] = field(default_factory=set, init=False)

    def __post_init__(self) -> None:
        self.graph = Graph(self.operations)

    def due(self) -> list[Dispatch]:
        """Return what is to be started now, which then counts as under way; once it is interrupted only what sets back
        what was set to measure."""
        if self.broken:
            return []
        ready = self.graph.tidying() if self.interrupted else self.graph.ready()
        found = [Dispatch(op.id, op, 1, self.run) for op in ready if op.id not in self._refused]
        for dispatch in found:
            self.graph.start(dispatch.operation)
        return found

    def interrupt(self) -> None:
        """Start nothing more but to set back; what is under way goes on to its safe end."""
        self.interrupted = True

    def give_up(self) -> None:
        """Start nothing more at all: nothing can be done in order."""
        self.interrupted = True
        self._refused.update(self.graph.status)

    def refused(self, dispatch: Dispatch) -> None:
        """Take note that the bench would not begin this: it is halted."""
        self.interrupted = True
        self._refused.add(dispatch.id)
        self.graph.put_back(dispatch.operation)

    def over(self, dispatch: Dispatch, result: OperationResult) -> After:
        """Take note of the end of an attempt, and return what follows from it."""
        if result.error is not None and result.error.code in ENDING:
            self.interrupted = True
        goes_on = not self.interrupted or dispatch.id in self.graph.backs
        if goes_on and (again := None if self.broken else retried(dispatch, result)):
            return After(again=again)
        if result.outcome != "done" and self.stop_on_error:
            self.broken = True
        return After(skipped=tuple(self.graph.finish(dispatch.operation, result.outcome)))

    @property
    def idle(self) -> bool:
        """Whether nothing is under way."""
        return "running" not in self.graph.status.values()


def retried(dispatch: Dispatch, result: OperationResult) -> Dispatch | None:
    """Return the next attempt at what failed, or None where there are enough or it is not safe.

    A move is tried again only where the part was seen standing afterwards, from where it then stood; a set-point only
    where its bench did not answer or an axis jammed, for its target is absolute. A part that somebody else must touch
    first, and an outcome that nobody knows, never are.
    """
    if result.error is None or result.outcome != "failed" or dispatch.attempt >= ATTEMPTS:
        return None
    op, code = dispatch.operation, result.error.code
    if op.kind.carries and code in PLACED_BESIDE and not op.arguments.get("irreversible"):
        if result.after is None or result.after.presence != "seen" or result.after.pose is None:
            return None
        start = {"pose": as_json(result.after.pose)}
        op = replace(op, arguments={**op.arguments, "from": start})
        return replace(dispatch, operation=op, attempt=dispatch.attempt + 1)
    if op.kind.drives and code in NO_ANSWER:
        return replace(dispatch, attempt=dispatch.attempt + 1)
    return None
