"""The graph of a plan while it is walked: what may start, what is under way, what became of the rest."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Literal

from pico.diagnostics import PicoError, did_you_mean, error
from pico.model.operation import Operation, Outcome

MEASURES = frozenset({"measure", "optimize", "survey", "verify"})
Status = Literal["waiting", "running", "done", "failed", "unknown", "skipped"]


class Graph:
    """Operations and their status. An operation may start when what it comes after is done, and every earlier one in
    the plan that needs one of its resources is over: each resource takes its operations in the plan's order.

    A robot parks and a shutter closes when what comes before is over, done or not: neither does an arm stay in the beam
    nor the beam open because something failed. What was set only to measure is set back likewise, once it was set, and
    when nothing else is begun any more."""

    def __init__(self, operations: Sequence[Operation]) -> None:
        """Raises PicoError where an operation comes after itself or after one that the plan does not have."""
        self.operations = ordered(operations)
        self.backs = set_back(self.operations)
        self.status: dict[str, Status] = {op.id: "waiting" for op in self.operations}

    def ready(self) -> list[Operation]:
        """Return what may start now, in the plan's order."""
        found: list[Operation] = []
        taken: set[str] = set()
        for op in self.operations:
            status = self.status[op.id]
            if status not in ("waiting", "running"):
                continue
            free = taken.isdisjoint(op.resources)
            if status == "waiting" and free and self._may_follow(op):
                found.append(op)
            taken.update(op.resources)
        return found

    def tidying(self) -> list[Operation]:
        """Return what may be set back now, where nothing else is begun any more: it was set only to measure."""
        under_way = [op for op in self.operations if self.status[op.id] == "running"]
        taken = {resource for op in under_way for resource in op.resources}
        return [
            op for op in self.operations
            if self.status[op.id] == "waiting" and self._owed(op) and taken.isdisjoint(op.resources)
            and all(self.status[a] != "running" for a in op.after)
        ]  # fmt: skip

    def _owed(self, op: Operation) -> bool:
        """Whether an operation sets back what was set."""
        return any(self.status[a] == "done" for a in self.backs.get(op.id, ()))

    def _may_follow(self, op: Operation) -> bool:
        if op.makes_safe or self._owed(op):
            return all(self.status[a] not in ("waiting", "running") for a in op.after)
        return all(self.status[a] == "done" for a in op.after)

    def start(self, op: Operation) -> None:
        """Mark an operation as under way."""
        self.status[op.id] = "running"

    def put_back(self, op: Operation) -> None:
        """Mark an operation as not begun after all."""
        self.status[op.id] = "waiting"

    def finish(self, op: Operation, outcome: Outcome) -> list[Operation]:
        """Mark an operation as over; return those that can't happen any more, which are skipped, in order."""
        self.status[op.id] = outcome
        if outcome == "done":
            return []
        lost, skipped = {op.id}, []
        for other in self.operations:
            waits = self.status[other.id] == "waiting" and not (other.makes_safe or self._owed(other))
            if waits and not lost.isdisjoint(other.after):
                lost.add(other.id)
                skipped.append(other)
                self.status[other.id] = "skipped"
        return skipped

    def waiting(self) -> list[Operation]:
        """Return what has not started, in the plan's order."""
        return [op for op in self.operations if self.status[op.id] == "waiting"]


def set_back(operations: Sequence[Operation]) -> Mapping[str, tuple[str, ...]]:
    """Return the operations that set back what others set only to measure, by id, each with the ids of those others. A
    shutter that opens is none of them: nobody is to be surprised by a beam."""
    found: dict[str, tuple[str, ...]] = {}
    sets: dict[str, list[Operation]] = {}
    measures = {op.id for op in operations if op.primitive in MEASURES}
    for op in operations:
        if op.primitive != "set" or op.reason.kind != "interlock":
            continue
        before = sets.setdefault(op.address, [])
        back = bool(before) and before[0].arguments.get("from") == op.arguments["to"]
        if back and not measures.isdisjoint(op.after) and (op.makes_safe or op.arguments["tunable"] != "shutter"):
            found[op.id] = tuple(one.id for one in before)
            before.clear()
        else:
            before.append(op)
    return found


def ordered(operations: Sequence[Operation]) -> tuple[Operation, ...]:
    """Return the operations with each behind all that it comes after, else in the order given.

    Raises PicoError where that can't be: the plan is then no plan.
    """
    known = {op.id for op in operations}
    if len(known) < len(operations):
        raise PicoError(error("bad-plan", "two operations of the plan have the same id", hint="plan again"))
    for op in operations:
        for id in op.after:
            if id not in known:
                hint = did_you_mean(id, known)
                raise PicoError(error("bad-plan", f"{op.id} comes after {id}, which the plan does not have", hint=hint))
    placed: dict[str, Operation] = {}
    left = list(operations)
    while left:
        kept = []
        for op in left:
            if all(a in placed for a in op.after):
                placed[op.id] = op
            else:
                kept.append(op)
        if len(kept) == len(left):
            ring = ", ".join(op.id for op in kept)
            raise PicoError(
                error("bad-plan", f"operations of the plan wait for one another: {ring}", hint="plan again")
            )
        left = kept
    return tuple(placed.values())
