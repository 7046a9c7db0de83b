"""What an edge lets through to its bench: commands of the lease that it fenced for, in order, each once, in time.

Pure: the edge's own monotonic clock is passed in [s], and what must be durable before anything else happens is the
caller's to write, in the order that each function says. `Memory` is all that survives the edge.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

from pico.teleop.deadman import Gate as DeadMan
from pico.teleop.frames import Frame

RATE = 0.996
"""The share that the edge takes of the time that a lease is said to hold: two clocks run 0.2 % apart at most."""
REACHES = 0.2
"""How long what was let begin may take to reach its device on a busy machine: the lease is over so much earlier [s]."""
OFFLINE = 60.0
"""The longest that a job may go on by itself, cut off from the coordinator, whatever it declares [s]."""

STEERING = "steering"
"""What runs while a step of a teleoperation does."""

Phase = Literal["started", "done", "failed", "unknown"]
Refused = Literal["stale", "gap", "busy", "nolease", "conflict", "unknown", "stopped"]


@dataclass(frozen=True, slots=True)
class Command:
    """One operation: of the lease `token` the `seq`-th, under a `key` (run, operation, attempt) and with the digest of
    its content."""

    token: int
    seq: int
    key: str
    digest: str

    @property
    def run(self) -> str:
        return self.key.partition("/")[0]


@dataclass(frozen=True, slots=True)
class Record:
    """What the edge knows of a command that it took on."""

    command: Command
    phase: Phase
    result: str = ""


@dataclass(frozen=True, slots=True)
class Memory:
    """What an edge keeps for good: the highest token that it fenced for, and its records by key."""

    fenced: int = 0
    taken: int = 0
    """How many commands of that lease were taken on."""
    stopped: frozenset[str] = frozenset()
    """The runs of that lease of which a command failed: nothing more of them is done."""
    records: Mapping[str, Record] = field(default_factory=dict)

    @property
    def unsettled(self) -> tuple[str, ...]:
        """The keys that began and whose end nobody knows."""
        return tuple(k for k, record in self.records.items() if record.phase in ("started", "unknown"))

    def with_record(self, record: Record) -> Memory:
        """Return the memory with a record in place of the one of its key; later ones are of the lease fenced for."""
        command, memory = record.command, self
        if command.token == self.fenced:
            memory = replace(memory, taken=max(self.taken, command.seq))
            if record.phase == "failed":
                memory = replace(memory, stopped=self.stopped | {command.run})
        return replace(memory, records={**self.records, command.key: record})

    def fence(self, token: int) -> Memory:
        """Return the memory once it is fenced for a later lease."""
        return replace(self, fenced=token, taken=0, stopped=frozenset())


@dataclass(frozen=True, slots=True)
class Verdict:
    """What becomes of a command: it is taken on (`take`), refused, or was known: then its record."""

    take: bool = False
    refused: Refused | None = None
    known: Record | None = None


@dataclass(frozen=True, slots=True)
class Gate:
    """An edge while it runs. `pending`: the token that it drains for, 0 for none; `deadline`: when the lease that it
    fenced for is over, by its own clock; `running`: the key that moves now; `budget`: how much longer than that a
    declared job may go on by itself [s]."""

    memory: Memory = field(default_factory=Memory)
    pending: int = 0
    deadline: float = -math.inf
    running: str = ""
    budget: float = 0.0
    steering: DeadMan = field(default_factory=DeadMan)

    def may_move(self, token: int, now: float) -> bool:
        """Whether the lease `token` is the one fenced for, and holds now."""
        return token == self.memory.fenced and not self.pending and now <= self.deadline


def heard(gate: Gate, token: int, left: float, asked: float) -> Gate:
    """Hear from the coordinator which token counts and how long still, 0 where nobody has the bench; `asked`: when the
    edge asked for that, from which the time counts, however long the answer took."""
    if token > max(gate.memory.fenced, gate.pending):
        return replace(gate, pending=token, steering=gate.steering.closed())
    if token != gate.memory.fenced or gate.pending:
        return gate
    return replace(gate, deadline=max(gate.deadline, asked + left * RATE - REACHES) if left > 0 else -math.inf)


def fenced(gate: Gate) -> Gate:
    """Fence for the token that is pending: called once nothing moves, and written before the coordinator is told.
    The lease holds from the next answer of the coordinator on."""
    if gate.running or not gate.pending:
        return gate
    memory = gate.memory.fence(gate.pending)
    return replace(gate, memory=memory, pending=0, deadline=-math.inf, budget=0.0)


def judged(gate: Gate, command: Command, now: float) -> Verdict:
    """Judge a command. What is known is answered from its record and never done again; one that is to be taken on is
    written as started, then asked of `begins`, then moves."""
    known = gate.memory.records.get(command.key)
    if known is not None:
        return _recalled(gate, command, known)
    refused: Refused | None = None
    if command.token < gate.memory.fenced:
        refused = "stale"
    elif not gate.may_move(command.token, now):
        refused = "nolease"
    elif command.seq != gate.memory.taken + 1:
        refused = "gap"
    elif command.run in gate.memory.stopped:
        refused = "stopped"
    elif gate.running:
        refused = "busy"
    elif gate.memory.unsettled:
        refused = "unknown"
    return Verdict(take=refused is None, refused=refused)


def _recalled(gate: Gate, command: Command, known: Record) -> Verdict:
    if known.command.digest != command.digest:
        return Verdict(refused="conflict")
    if gate.running == command.key:
        return Verdict(refused="busy", known=known)
    return Verdict(refused="unknown" if known.phase in ("started", "unknown") else None, known=known)


def started(gate: Gate, command: Command) -> Gate:
    """Take a command on; the memory is written before anything moves."""
    return replace(gate, memory=gate.memory.with_record(Record(command, "started")), running=command.key)


def begins(gate: Gate, now: float, *, offline: bool = False) -> bool:
    """Whether what was taken on still may begin, asked once it is written and right before it moves. `offline`: it is
    under way already, as a job of several steps, and asks for the next one."""
    token = gate.memory.records[gate.running].command.token
    return gate.may_move(token, now) or (offline and alone(gate, token, now))


def ended(gate: Gate, key: str, phase: Phase, result: str = "") -> Gate:
    """End what was running, or settle what began before the edge did; written before anybody hears of it."""
    record = gate.memory.records[key]
    memory = gate.memory.with_record(replace(record, phase=phase, result=result))
    return replace(gate, memory=memory, running="" if gate.running == key else gate.running)


def declared(gate: Gate, seconds: float) -> Gate:
    """Let the job that runs go on for so long beyond the lease if the edge is cut off, at most OFFLINE."""
    return replace(gate, budget=min(max(0.0, seconds), OFFLINE))


def alone(gate: Gate, token: int, now: float) -> bool:
    """Whether a declared job of this lease may go on although that is over: its budget lasts, and the coordinator has
    not said that nobody, or somebody else, has the bench."""
    return token == gate.memory.fenced and not gate.pending and now <= gate.deadline + gate.budget


def to_park(gate: Gate, now: float) -> bool:
    """Whether the bench is to be parked and its shutters closed: no lease holds, nor a budget beyond it."""
    return not gate.running and now > gate.deadline and not alone(gate, gate.memory.fenced, now)


def steered(gate: Gate, token: int, frame: Frame, now: float) -> tuple[Gate, str]:
    """Hear a frame of a teleoperation; return why it authorizes nothing: `nolease` or what the dead-man says."""
    if not gate.may_move(token, now):
        return replace(gate, steering=gate.steering.closed()), "nolease"
    steering, refused = gate.steering.hear(frame, now)
    return replace(gate, steering=steering), refused


def stepping(gate: Gate, now: float, seconds: float) -> tuple[Gate, Frame | None]:
    """Return the frame that authorizes a step of a teleoperation which takes so long, and the gate once it moves."""
    frame = None if gate.running else gate.steering.authorized(now, seconds)
    if frame is None or not gate.may_move(gate.memory.fenced, now):
        return gate, None
    return replace(gate, steering=gate.steering.taken(), running=STEERING), frame


def stepped(gate: Gate) -> Gate:
    """Return the gate once that step is over."""
    return replace(gate, running="") if gate.running == STEERING else gate


def restarted(memory: Memory) -> Gate:
    """Return the gate of an edge that begins again: it has no lease until the coordinator says so, and what was cut
    short is settled by looking, or by a person."""
    return Gate(memory)
