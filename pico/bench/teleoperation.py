"""Steering a component by hand: the client's end of a teleoperation, of which the edge holds the other.

While it is entered somebody must be heard of at least every `pico.teleop.frames.SILENCE` seconds: `hear` and `step` do
so.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TYPE_CHECKING

from pico.bench.moves import Moves
from pico.bench.opened import Opened
from pico.diagnostics import ExitCode, PicoError, error
from pico.edge.protocol import STEERING
from pico.model.operation import Operation
from pico.model.plan import Plan
from pico.model.trace.event import Event
from pico.teleop.frames import SILENCE, Answer, Frame
from pico.teleop.steps import Jogged, jogged

if TYPE_CHECKING:
    from types import TracebackType

    from pico.bench.running.execution import Execution
    from pico.model.trace.report import RunReport

BEAT = 0.05
"""Seconds between two frames of who only says that it is there."""
TRIES = 3
"""So often a step is asked for again that came too late."""


class Teleoperation:
    """One teleoperation: entered, it takes the bench, and a part in hand where an arm is to hold it; left, it sets that
    down. `first`, `values`: where what is steered stood, and stands; `limit`: why the last
    step was not made; `report` once it is over."""

    def __init__(self, opened: Opened, plan: Plan) -> None:
        self.plan, self.setup = plan, opened.setup
        self.operation: Operation = next(op for op in plan.operations if op.primitive == "teleoperate")
        self.known: dict[str, Jogged] = jogged(
            self.setup, self.operation.component, self.operation.arguments["what"]["tunables"]
        )
        self.answer = Answer(clock=0.0, phase="over")
        self.first: dict[str, float] = {}
        self._opened, self._seq, self._press = opened, 0, 0
        self._run: Execution | None = None
        self.events: list[Event] = []
        self.ready = False

    @property
    def run(self) -> Execution:
        """The run of it; raises RuntimeError before it is entered."""
        if self._run is None:
            raise RuntimeError("it did not begin: enter it with `with`")
        return self._run

    @property
    def values(self) -> dict[str, float]:
        """Where what is steered stands: by tunable, or x, y [mm] and yaw [deg] of a part in hand."""
        return dict(self.answer.values)

    @property
    def limit(self) -> str:
        """Why the last step was not made; empty where it was."""
        return self.answer.limit

    @property
    def over(self) -> bool:
        """Whether nothing is steered any more."""
        return self.run.over

    @property
    def report(self) -> RunReport:
        """What became of the run; raises RuntimeError before it is over."""
        return self.run.report

    def begin(self) -> None:
        """Take the bench; returns at once: go on with `hear` until it is `ready`."""
        self._run = Moves(self._opened).run(self.plan, holder=f"{STEERING} {self.operation.component}")
        self._run.begin()

    def leave(self, told: Callable[[], object] = lambda: None) -> None:
        """Have the process that serves the bench begin it, and leave it to who says frames to its run: somebody must be
        heard of from then on, and `told` is called just before. Raises PicoError where this process is the bench, and
        where it can't be begun."""
        self._run = Moves(self._opened).left(self.plan, holder=f"{STEERING} {self.operation.component}")
        told()
        self._run.leave()

    def hear(self, *, tunable: str = "", by: float = 0.0, press: int = 0, release: bool = False, end: bool = False) -> (
        Answer
    ):  # fmt: skip
        """Say that somebody is there, and what is wanted: see `pico.teleop.frames.Frame`; return the answer. Raises
        PicoError where the run can't be begun, or was cut short."""
        self._news()
        if self.over or not self._started:
            return self.answer
        self._seq += 1
        frame = Frame(
            seq=self._seq, seen=self.answer.clock, press=press, tunable=tunable, by=by, release=release, end=end
        )
        self.answer = self._opened.wait(self._opened.edge.jog(self.run.id, frame))
        self.ready = self.answer.phase == "ready"
        self.first = self.first or dict(self.answer.values)
        return self.answer

    def press(self) -> int:
        """Return the number of a new press of a key."""
        self._press += 1
        return self._press

    def step(self, tunable: str, by: float) -> bool:
        """Change a tunable by so much [its unit], in as many steps as that takes; return whether all were made, else
        `limit` says why. Raises PicoError for what makes no sense, and where the teleoperation ended."""
        one = self.known.get(tunable)
        if one is None:
            hint = f"what is steered: {', '.join(self.known)}"
            raise PicoError(error("usage", f"{tunable[:40]} is not steered here", hint=hint))
        if not abs(by) < 1e6:
            raise PicoError(error("usage", f"{by} is no step"))
        whole, sign = divmod(abs(by), one.longest), 1.0 if by > 0 else -1.0
        parts = [one.longest] * int(whole[0]) + ([whole[1]] if whole[1] > 1e-12 else [])
        return all(self._one(tunable, sign * part) for part in parts)

    def _one(self, tunable: str, by: float) -> bool:
        for _ in range(TRIES):
            done, missed = self.answer.steps, self.answer.missed
            answer = self.hear(tunable=tunable, by=by, press=self.press())
            asked = time.monotonic()
            while not answer.refused and time.monotonic() - asked < 2 * SILENCE:
                if answer.steps > done or answer.missed > missed:
                    return answer.steps > done
                time.sleep(BEAT / 25)
                answer = self.hear()
                self._require_going()
            if answer.refused not in ("", "late", "lapsed", "stale"):
                raise PicoError(error("step", answer.refused, address=self.operation.component))
            self.hear()
        return False

    def _require_going(self) -> None:
        if self.over:
            wrong = [event.data["diagnostic"] for event in self.events if event.kind == "operation_failed"]
            text = wrong[-1]["summary"] if wrong else "the teleoperation is over"
            raise PicoError(error("over", str(text), address=self.operation.component), ExitCode.INTERRUPTED)

    def _news(self) -> None:
        self.events += self.run.news()

    @property
    def _started(self) -> bool:
        return any(event.kind == "run_started" for event in self.events)

    def settle(self, *, end: bool = False) -> None:
        """Be there until it is `ready`, or (`end`) until it is over; raises PicoError where it can't be begun."""
        while not self.over and (end or not self.ready):
            self.hear(end=end)
            time.sleep(BEAT / 5)

    def __enter__(self) -> Teleoperation:
        self.begin()
        try:
            self.settle()
            self._require_going()
        except BaseException:
            self.settle(end=True)
            raise
        return self

    def __exit__(
        self, kind: type[BaseException] | None, exc: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.settle(end=True)
