"""Teleoperations at the edge: one operation to everybody else, many small steps of the device, each authorized by a
frame.

The journal holds it as one operation with its first and last values. Who steers is heard through `hear`, from anywhere;
that person's silence ends all motion (`pico.teleop.deadman`).
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import replace
from typing import Any, Protocol

from pico.backends.device import Began, Device
from pico.diagnostics import Diagnostic, error
from pico.edge.aligning import Stopping
from pico.model.observation import ObservedComponent
from pico.model.operation import Operation, OperationResult
from pico.model.pose import Pose
from pico.model.record import as_json
from pico.model.setup import Setup
from pico.model.trace.event import Event
from pico.teleop.frames import SILENCE, STEP_SECONDS, Answer, Frame, Phase, over
from pico.teleop.presses import Presses
from pico.teleop.steps import IN_PLANE, Jogged, jogged, moved, numbers

LOST = 5.0
"""Seconds without a word after which nobody is there who steers."""
POLL = 0.02
"""Seconds between two looks at whether somebody still steers, asked to stop, or fell silent."""
_LATE = 0.02
"""By so much a step may be over later than it should, where this computer has other things to do [s]: a frame that is
older than SILENCE leaves for it authorizes none, and the next one comes soon."""
_SURE = 2
"""So often in a row must the silence be found while an arm moves by itself: frames may wait for their turn here."""
_QUIET = SILENCE - (_SURE + 0.5) * POLL
"""Seconds of silence that are looked at twice, so that the arm is told to stop within SILENCE."""
REFUSED = frozenset({"blocked", "step", "range"})
"""Why a step is not made, where nothing moved and going on elsewhere is no matter."""


class Executing(Protocol):
    """What a teleoperation is one operation of."""

    async def execute(self, operation: Operation, key: str, began: Began) -> OperationResult:
        """See `pico.backends.device.Device`."""
        ...


class Teleoperating:
    """A device that knows teleoperations; what else there is it leaves to `inner`. `stopping`: whether somebody asked
    to stop, and how; `tell` hears of each step as progress; `clock`: of the edge [s]."""

    def __init__(
        self, setup: Setup, inner: Executing, device: Device, stopping: Callable[[], Stopping],
        tell: Callable[[Event], None], clock: Callable[[], float] = time.monotonic,
    ) -> None:  # fmt: skip
        self._setup, self._inner, self._device = setup, inner, device
        self._stopping, self._tell, self.clock = stopping, tell, clock
        self._steered: _Steered | None = None

    def hear(self, frame: Frame) -> Answer:
        """Take a frame, and say what becomes of it. It is over where nothing is steered."""
        if self._steered is None:
            return over(self.clock())
        return self._steered.hear(frame)

    async def execute(self, operation: Operation, key: str, began: Began) -> OperationResult:
        """Execute an operation; one that is no teleoperation by what is inside."""
        if operation.primitive != "teleoperate":
            return await self._inner.execute(operation, key, began)
        seen = await self._device.observe()
        before = seen.components.get(operation.component)
        began(before)
        steered = self._steered = _Steered(self, self._setup, self._device, operation, key, before)
        try:
            wrong = await steered.run()
        finally:
            self._steered = None
        seen = await self._device.observe()
        return OperationResult(
            key=key, outcome="failed" if wrong else "done", error=wrong, before=before,
            after=seen.components.get(operation.component), seconds=steered.seconds, ended=seen.time,
            data=steered.data(seen.components.get(operation.component)),
        )  # fmt: skip

    def stopped(self) -> Stopping:
        """Return whether somebody asked to stop, and how."""
        return self._stopping()

    def tell(self, event: Event) -> None:
        """Tell of a step."""
        self._tell(event)


class _Steered:
    """One teleoperation under way."""

    def __init__(
        self, edge: Teleoperating, setup: Setup, device: Device, operation: Operation, key: str,
        before: ObservedComponent | None,
    ) -> None:  # fmt: skip
        self.edge, self.device, self.operation, self.key = edge, device, operation, key
        self.address, self.robot = operation.component, operation.robot
        self.known: Mapping[str, Jogged] = jogged(setup, self.address, operation.arguments["what"]["tunables"])
        self.presses, self.ended = Presses(edge.clock()), False
        self.phase: Phase = "taking" if self.robot else "ready"
        self.values = _values(before, self.known)
        self.first = dict(self.values)
        self.pose = before.pose if before else None
        self.steps, self.missed, self.limit, self.seconds, self.done = 0, 0, "", 0.0, 0
        self.news = asyncio.Event()

    # heard

    def hear(self, frame: Frame) -> Answer:
        now = self.edge.clock()
        refused = self.presses.hear(frame, now)
        text: str = refused
        if not refused and frame.press and (text := self._senseless(frame)):
            self.presses.end("refused")
        self.ended |= frame.end and refused != "stale"
        self.news.set()
        return Answer(
            clock=now, refused=text, phase=self.phase, values=dict(self.values), steps=self.steps,
            missed=self.missed, limit=self.limit, stopped=self.presses.stopped,
        )  # fmt: skip

    def _senseless(self, frame: Frame) -> str:
        """Return why a step makes no sense; empty where it does."""
        one = self.known.get(frame.tunable)
        if one is None:
            return f"{frame.tunable[:40]} of {self.address} is not steered here"
        if not abs(frame.by) <= one.longest * (1 + 1e-9):  # also what is no number
            return f"one step of {frame.tunable} is at most {one.longest:g} {one.unit}".rstrip()
        return ""

    # done

    async def run(self) -> Diagnostic | None:
        """Steer until the person is done or gone, or somebody asks to stop; return what went wrong."""
        if not self.robot:  # a step of nothing: it answers, and what the device keeps is there from now on
            name, value = next(iter(self.values.items()))
            wrong = (await self._do("jog", {"tunable": name, "from": value, "to": value})).error
            if wrong:
                return wrong
        else:
            where = {"pose": as_json(self.pose)}
            yaw = {"grasp_yaw": self.operation.arguments.get("grasp_yaw", 0.0)}
            wrong = await self._watched("take", {"from": where, "to": where, **yaw})
            if wrong:
                return wrong
        self.phase = "ready"
        wrong = await self._steer()
        if wrong is None and self.robot:
            self.phase = "letting go"
            wrong = await self._watched("let_go", {"from": None, "to": {"pose": as_json(self.pose)}})
        self.phase = "over"
        return wrong

    async def _steer(self) -> Diagnostic | None:
        """Make the steps that frames authorize; return what ended it out of turn."""
        while not self.ended and self.edge.stopped() != "safely":
            now = self.edge.clock()
            if self.edge.stopped() == "now":
                return self._was_stopped()
            self.presses.listen(now)
            if self.presses.gate.silent(now) > LOST:
                return self._lost(f"nobody who steers was heard of for {LOST:g} s")
            frame = self.presses.gate.authorized(now, STEP_SECONDS + _LATE)
            if frame is None:
                await self._wait()
                continue
            self.presses.gate = self.presses.gate.taken()
            wrong = await self._step(frame)
            if wrong is not None:
                return wrong
        return None

    async def _wait(self) -> None:
        self.news.clear()
        with suppress(TimeoutError):
            await asyncio.wait_for(self.news.wait(), POLL)

    async def _step(self, frame: Frame) -> Diagnostic | None:
        """Make one step; return what went wrong, but for a step that was refused."""
        name, one = frame.tunable, self.known[frame.tunable]
        arguments: dict[str, Any]
        if self.robot:
            assert self.pose is not None  # it was taken from there
            goal = moved(self.pose, name, frame.by)
            arguments = {"from": {"pose": as_json(self.pose)}, "to": {"pose": as_json(goal)}}
        else:
            there = round(one.after(self.values[name], frame.by), 9)
            if there == self.values[name]:
                self._refuse(f"{name} ends at {there:g} {one.unit}".rstrip())
                return None
            arguments, goal = {"tunable": name, "from": self.values[name], "to": there}, None
        result = await self._do("jog", arguments)
        self.presses.moved(self.edge.clock())
        if result.outcome != "done":
            wrong = result.error or error("failed", f"{name} did not move", address=self.address)
            if wrong.code not in REFUSED:
                return wrong
            self._refuse(f"{name}: {wrong.summary}")
            return None
        self.steps, self.limit = self.steps + 1, ""
        self.pose = goal or self.pose
        self.values |= _plane(self.pose) if goal else {name: float(result.data["value"])}
        self._progress(result.ended)
        return None

    def _refuse(self, why: str) -> None:
        """Take note why a step is not made; that press is over, so that nobody runs into it again and again."""
        self.presses.end("refused")
        self.limit, self.missed = why, self.missed + 1

    async def _watched(self, primitive: str, arguments: Mapping[str, Any]) -> Diagnostic | None:
        """Do what takes longer than a step, as long as somebody is there who steers; return what went wrong."""
        doing = asyncio.create_task(self._do(primitive, arguments))
        silent = 0
        while not doing.done():
            await asyncio.wait([doing], timeout=POLL)
            silent = silent + 1 if self.presses.gate.silent(self.edge.clock()) > _QUIET else 0
            if silent >= _SURE and not doing.done():
                await self.device.stop()
                await doing
                return self._lost("nobody who steers was heard of while the arm moved")
        result = doing.result()
        return result.error if result.outcome != "done" else None

    async def _do(self, primitive: str, arguments: Mapping[str, Any]) -> OperationResult:
        """Have the device do one step, of which nobody else hears."""
        self.done += 1
        run, _, rest = self.key.partition("/")
        key = f"{run}~/{rest}.{self.done}"
        if self.edge.stopped() == "now":  # whatever was to come next: nothing moves any more
            return OperationResult(key=key, outcome="failed", error=self._was_stopped())
        operation = replace(
            self.operation, id=f"{self.operation.id}.{self.done}", primitive=primitive, arguments=arguments
        )
        result = await self.device.execute(operation, key, lambda _: None)
        self.seconds += result.seconds
        return result

    # told

    def _was_stopped(self) -> Diagnostic:
        return error("stopped", f"stopped by a person{self._in_hand()}", hint=self._hint, address=self.address)

    def _lost(self, why: str) -> Diagnostic:
        return error("lost", f"{why}{self._in_hand()}", hint=self._hint, address=self.address)

    def _in_hand(self) -> str:
        return f"; {self.robot} may still hold {self.address}" if self.robot else ", where it then stood"

    @property
    def _hint(self) -> str:
        again = f"`pico teleop {self.address}{'.pose' if self.robot else ''}` goes on"
        return f"`pico recover` sets it down; then {again}" if self.robot else again

    def _progress(self, time: float) -> None:
        data = {"phase": self.phase, "steps": self.steps, "values": dict(self.values)}
        self.edge.tell(Event(
            run=self.key.split("/", maxsplit=1)[0], seq=0, kind="operation_progress", time=time,
            operation=self.operation.id, component=self.address, data=data,
        ))  # fmt: skip

    def data(self, after: ObservedComponent | None) -> dict[str, Any]:
        """Return what the journal holds of it, by address, with what ended the presses of keys."""
        first, last = (
            {f"{self.address}.{name}": value for name, value in values.items()}
            for values in (self.first, _values(after, self.known) or self.values)
        )
        return {"first": first, "last": last, "steps": self.steps, "refused": self.missed, **self.presses.told()}


def _values(part: ObservedComponent | None, known: Mapping[str, Jogged]) -> dict[str, float]:
    """Return where what is jogged stands, as far as that is known."""
    if part is None:
        return {}
    if set(known) == set(IN_PLANE):
        return _plane(part.pose)
    values = {name: live.value for name, live in part.values.items() if live.status != "unknown"}
    return {name: value for name, value in numbers(values) if name in known}


def _plane(pose: Pose | None) -> dict[str, float]:
    return {"x": pose.x, "y": pose.y, "yaw": pose.yaw} if pose else {}
