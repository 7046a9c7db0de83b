"""Who may move a bench that is enrolled with a coordinator: the lease that this granted, as the edge's gate has it.

`Granting` stands in place of the bench's own counting of tokens. A call of the coordinator is made within `acting`; all
that it starts carries its lease with it. What is done outside of any is the edge's own: it shuts and parks, with the
token that it fenced for, and needs no lease for that.
"""

from __future__ import annotations

import json
import math
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import replace
from pathlib import Path
from typing import Any

from pico.control import gate as gating
from pico.control.gate import Command, Gate, Record, Refused
from pico.diagnostics import Diagnostic, ExitCode, PicoError, error
from pico.edge.network.kept_gate import KeptGate, answer_of

Answer = Mapping[str, Any]
_ACTING: ContextVar[int | None] = ContextVar("acting", default=None)


@contextmanager
def acting(token: int) -> Iterator[None]:
    """Do something under a lease: this, and every task that is begun within it."""
    before = _ACTING.set(token)
    try:
        yield
    finally:
        _ACTING.reset(before)


class Granting:
    """The gate of one bench, and what it keeps. `clock`: monotonic [s]."""

    def __init__(self, path: Path, first: int, clock: Callable[[], float] = time.monotonic) -> None:
        """`first`: the highest token that the bench gave out itself. Raises PicoError where nothing can be kept."""
        self._kept, self.clock = KeptGate(path), clock
        self.gate = gating.restarted(self._kept.memory(first))
        self.live = False
        """Whether a lease held since the bench was last left safely."""

    # what the lock of the bench asks

    def token(self) -> int:
        """Return the token under which the bench is taken now; raises PicoError (exit code LOCKED) where the lease is
        over."""
        token = _ACTING.get()
        if token is None:
            return self.gate.memory.fenced
        if not self.gate.may_move(token, self.clock()):
            raise PicoError(over(token), ExitCode.LOCKED)
        return token

    def require(self, *, under_way: bool = False) -> None:
        """Raise PicoError (exit code INTERRUPTED) where nothing may begin to move now. `under_way`: it is a step of
        what began before, which may have a budget beyond its lease."""
        token, now = _ACTING.get(), self.clock()
        if token is None or self.gate.may_move(token, now):
            return
        if not (under_way and gating.alone(self.gate, token, now)):
            raise PicoError(over(token), ExitCode.INTERRUPTED)

    # what the coordinator says

    def heard(self, token: int, left: float, asked: float) -> None:
        """Hear which token counts and how long still, asked for at `asked` by the edge's clock."""
        self.gate = gating.heard(self.gate, token, left, asked)
        self.live |= self.gate.may_move(self.gate.memory.fenced, self.clock())

    def fence(self) -> bool:
        """Fence for the token that is pending, durably, now that nothing moves; return whether one was."""
        after = gating.fenced(self.gate)
        if after is self.gate:
            return False
        self._kept.fence(after.memory.fenced)
        self.gate, self.live = after, False
        return True

    def judged(self, command: Command) -> tuple[bool, Answer | None, Refused | None]:
        """Judge a command: whether it is taken on, which is written then; else its answer where it was one before, or
        why it is refused for now."""
        verdict = gating.judged(self.gate, command, self.clock())
        if verdict.take:
            after = gating.started(self.gate, command)
            self._write(after, command.key)
            return True, None, None
        known = verdict.known
        if known is not None and verdict.refused is None:
            return False, answer_of(known), None
        if verdict.refused in ("stale", "nolease", "gap") or known is not None:
            return False, None, verdict.refused
        return False, self._settled(command, verdict.refused), verdict.refused

    def _settled(self, command: Command, refused: Refused | None) -> Answer:
        """Refuse a command for good: that is its end, too, and the next one has the next number."""
        text = f"{command.key[:80]} is refused: {refused}"
        answer = _failure(error("lease", text, hint="`pico status` shows what goes on"), ExitCode.LOCKED)
        if refused == "conflict" or command.seq != self.gate.memory.taken + 1:
            return answer
        record = Record(command, "done", json.dumps(answer))
        self._kept.write(record)
        self.gate = replace(self.gate, memory=self.gate.memory.with_record(record))
        return answer

    def ended(self, key: str, answer: Answer, *, durable: bool = True) -> None:
        """Write what a command is answered, before anybody hears of it. Not `durable`: it outlives this process, and
        after a power failure is found out again (`pico.edge.network.settling`)."""
        self._write(gating.ended(self.gate, key, "done", json.dumps(answer)), key, durable=durable)

    def declared(self, seconds: float) -> None:
        """Let what runs go on for so long beyond its lease, where the coordinator is away [s]."""
        self.gate = gating.declared(self.gate, seconds)

    def _write(self, after: Gate, key: str, *, durable: bool = True) -> None:
        self._kept.write(after.memory.records[key], durable=durable)
        self.gate = after

    @property
    def lapsed(self) -> bool:
        """Whether a lease that held is over, and nobody took the bench to its safe end since."""
        now = self.clock()
        token = self.gate.memory.fenced
        return self.live and not self.gate.may_move(token, now) and not gating.alone(self.gate, token, now)

    @property
    def withdrawn(self) -> bool:
        """Whether the coordinator said that nobody has the bench any more."""
        return self.gate.deadline == -math.inf

    def close(self) -> None:
        """Let go of what is kept."""
        self._kept.close()


def over(token: int) -> Diagnostic:
    """Return that a lease is over."""
    hint = "`pico lease show` says who has the bench; plan again"
    return error("lease", f"the lease {token} is over: nothing more is started under it", hint=hint)


def _failure(found: Diagnostic, code: ExitCode) -> Answer:
    from pico.edge.link import wire

    return wire.failure(PicoError(found, code))
