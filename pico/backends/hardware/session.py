"""The bench while somebody has taken it: every operation in progress, and how all of them end when it is stopped."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Coroutine, Iterator, Mapping
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING, Any, TypeVar

from pico.backends import checks, ways
from pico.backends.attempt import Failed, plug_in_failed
from pico.backends.by_sight import BySight
from pico.backends.device import Began
from pico.backends.halting import sooner, way_out
from pico.backends.hardware.failing import failed
from pico.backends.hardware.guard.verdict import Trip
from pico.backends.hardware.guarding import concerned, require_known_arms, require_safe, until_tripped
from pico.backends.hardware.instruments import Instruments
from pico.backends.hardware.rehearsing import rehearse
from pico.backends.hardware.setting import driven, ranged
from pico.backends.hardware.walking import FIRST_SPEED, Way, speed_of
from pico.backends.measured import Reading
from pico.backends.pushed import pushed, with_pushed
from pico.backends.routines import asked_of
from pico.diagnostics import Diagnostic, ExitCode, PicoError, error
from pico.drivers.protocols import Arm, MotionTested
from pico.model.commissioning import ONE_MOTION
from pico.model.instruments.kind import Driven
from pico.model.observation import Observation, ObservedComponent, slot_at
from pico.model.operation import Operation, OperationResult, Reason
from pico.model.pose import Pose
from pico.model.quantities import Value
from pico.model.record import as_json
from pico.model.setup import Setup
from pico.model.trace.event import Event, EventKind
from pico.motion.types import Blocked, Motion, MovePath, Stage
from pico.planning.checks.emission import lets_out
from pico.planning.routines import carried
from pico.twin.arms import TwinArm

if TYPE_CHECKING:
    from pico.model.measurement import Measurement

T = TypeVar("T")
Measuring = Callable[[str, str, list[str]], Awaitable["Measurement"]]
"""Measures a measurable of a component, with the operations that are under way beside it."""


class HardwareSession:
    """Executes operations. `known`: what is known of the bench, asked in threads; `arms`: as calibration knows them;
    `now`: the bench's clock [s]; `keep`: keeps what was commanded and nobody reads, None where nobody knows it any
    more; `untried`: robots whose motion test did not pass on their device; `most`: the greatest speed of tools [mm/s],
    where a person may be near; `require`: see `pico.backends.device.Device.take`; `darken` ends light beside that, and
    keeps why."""

    def __init__(
        self, setup: Setup, bench: Instruments, known: BySight, *, motion: Motion, arms: Mapping[str, TwinArm],
        tell: Callable[[Event], None], now: Callable[[], float], pause: Callable[[float], Awaitable[None]],
        measure: Measuring, image: Callable[[str], Awaitable[Reading]], keep: Callable[[str, Value | None], None],
        untried: frozenset[str] = frozenset(),
        most: float | None = None, require: Callable[[], None] = lambda: None,
        darken: Callable[[str], Awaitable[object]] | None = None,
    ) -> None:  # fmt: skip
        self._setup, self._bench, self._known, self._motion, self._arms = setup, bench, known, motion, arms
        self._tell_all, self._now, self._pause, self._measured, self._image = tell, now, pause, measure, image
        self._keep, self._untried, self._moved, self._most = keep, untried, set[str](), most
        self._require_lease, self._darken = require, darken
        self._zones, self._looking = ways.Zones(setup), asyncio.Lock()
        self._under_way: dict[str, asyncio.Task[OperationResult]] = {}
        self._ways: dict[str, Way] = {}
        self._halting = self._stopped = False
        self._tripped: Diagnostic | None = None
        self._light_ended: Diagnostic | None = None
        self._told = 0

    async def execute(self, operation: Operation, key: str, began: Began) -> OperationResult:
        """Execute an operation; cancelling the wait does not cancel the motion.

        Raises PicoError (exit code INTERRUPTED) where it was stopped before it began.
        """
        if self._stopped or self._light_ended:
            raise PicoError(self._light_ended or checks.STOPPED, ExitCode.INTERRUPTED)
        if operation.robot in self._moved & self._untried:
            raise PicoError(one_motion(operation.robot or ""), ExitCode.INTERRUPTED)
        task = self._under_way[key] = asyncio.create_task(self._attempt(operation, key, began))
        task.add_done_callback(lambda _: self._under_way.pop(key, None))
        return await asyncio.shield(task)

    async def _attempt(self, operation: Operation, key: str, began: Began) -> OperationResult:
        before, begun = await self._look(operation.component), self._now()
        began(before)
        self._tell(
            "operation_started", operation, key, {"primitive": operation.primitive, "seconds": operation.seconds}
        )
        data: Mapping[str, Any] = {}
        failure: Failed | None = None
        try:
            self._require_running()
            require_known_arms(self._setup, self._bench, operation)
            data = await self._guarded(operation, lambda: self._act(operation, key))
            if self._light_ended and operation.primitive in ("measure", "auto_range"):
                raise Failed(self._light_ended)  # it may have been measured in the dark
        except Failed as exc:
            failure, data = self._ended() if self._stopped else exc, exc.data
        except PicoError as exc:
            failure = self._ended() if self._stopped else failed(operation, exc)
        except Exception as exc:
            failure = plug_in_failed(exc)
            if failure is None:
                raise
        return OperationResult(
            key=key, outcome=failure.outcome if failure else "done", error=failure.diagnostic if failure else None,
            before=before, after=await self._look(operation.component), seconds=self._now() - begun, ended=self._now(),
            data=data,
        )  # fmt: skip

    async def _guarded(self, operation: Operation, act: Callable[[], Coroutine[Any, Any, T]]) -> T:
        """Do what an operation asks for while the safety inputs that concern it are safe; all stops where one is not
        any more."""
        inputs, kinds = self._bench.inputs, concerned(self._setup, operation)
        if not any(entry.kind in kinds for entry, _ in inputs.values()):
            return await act()
        await require_safe(inputs, kinds)
        acting = asyncio.ensure_future(act())
        watching = asyncio.create_task(until_tripped(inputs, kinds))
        try:
            await asyncio.wait([acting, watching], return_when=asyncio.FIRST_COMPLETED)
            if not acting.done() and watching.done():
                self._tripped = watching.result()
                darken = [] if self._darken is None else [self._darken(self._tripped.summary)]
                await asyncio.gather(self._halt_all(), self._shut(), *darken)
                try:
                    return await acting
                finally:
                    if lets_out(self._setup, operation):  # it may have done so after all was closed
                        await self._shut()
            return await acting
        finally:
            watching.cancel()

    async def walk(self, path: MovePath, speed: float) -> None:
        """Have an arm go along a path that no plan has, with its tool at `speed` [mm/s] at most, for a person who tries
        it out; with all that is kept to for an operation. Raises Failed."""
        operation = Operation(
            id="commission", primitive="park", component=path.robot, robot=path.robot, resources=(path.robot,),
            reason=Reason(kind="asked"),
        )  # fmt: skip
        self._require_running()
        try:
            await self._guarded(operation, lambda: self._walked(operation, "commission/commission/1", path, speed))
        except Failed as exc:
            raise (self._ended() if self._stopped else exc) from exc
        except asyncio.CancelledError:  # nobody waits for it any more
            await self._halt_all()
            raise

    async def try_motion(self, robot: str) -> Mapping[str, float]:
        """Have the driver of an arm do its own motion test, with all that is kept to for an operation; return what it
        measured. Raises Failed, and PicoError for what is not as it should be."""
        arm = self._bench.arms[robot]
        if not isinstance(arm, MotionTested):
            raise Failed(error("motion-test", f"the driver of {robot} has no motion test", address=robot))
        operation = Operation(
            id="commission", primitive="park", component=robot, robot=robot, resources=(robot,),
            reason=Reason(kind="asked"),
        )  # fmt: skip
        self._require_running()
        return await self._guarded(operation, arm.motion_test)

    def carried(self) -> dict[str, str]:
        """Return what arms that are on their way carry, by robot."""
        return {robot: way.part for robot, way in self._ways.items() if way.carries}

    async def idle(self) -> None:
        """Wait until nothing is under way."""
        while self._under_way:
            await asyncio.wait(list(self._under_way.values()))

    async def halt(self) -> None:
        """Bring everything under way to its safe end: a part in a hand goes to its goal or back, whichever is sooner;
        an arm that has not gripped yet leaves its part and parks."""
        self._halting = True
        for robot, way in list(self._ways.items()):
            if way.stage.segment in ("approach", "descend") and not way.carries:
                with suppress(PicoError):  # what it comes to then is told by who follows
                    await self._bench.arms[robot].halt()
        await self.idle()

    async def stop(self) -> None:
        """Stop everything under way: arms come to rest, hands hold what they hold, light ends. Nothing moves again
        until the bench is taken anew."""
        await self._halt_all()
        await self.idle()
        await self._shut()

    async def _shut(self) -> None:
        """Close every shutter and switch off every laser, all at once; whoever looks next reads back what became of
        each."""
        await asyncio.gather(*(self._dark(one, value) for one, value in self._gates()))

    async def _dark(self, one: Driven, value: Value) -> None:
        with suppress(PicoError):
            await one.set(value)

    def _gates(self) -> Iterator[tuple[Driven, Value]]:
        """Yield what lets light out, each with the value at which it does not."""
        for address, one in self._bench.tunables.items():
            name, _, tunable = address.partition(".")
            kind = self._setup.type_of(name)
            own = kind.tunables.get(tunable)
            if tunable == "shutter" and own and "closed" in own.choices:
                yield one, "closed"
            elif tunable == "emission" and kind.optics.element == "source":
                yield one, False

    def moving(self) -> tuple[Arm, ...]:
        """Return the arms that are on their way."""
        return tuple(self._bench.arms[robot] for robot in self._ways)

    async def trip(self, trip: Trip) -> None:
        """Hear that the guard ends light: what is under way fails for that, and nothing more begins until the bench is
        taken anew. Arms stop if the cause concerns them, else they come to their safe end."""
        self._tripped = self._light_ended = error(
            "unsafe", f"the guard ended light: {trip.said}", hint="look what it is, then begin anew"
        )
        if trip.stops_arms or not self._ways:
            await self._halt_all()
        else:
            self._halting = True

    async def _halt_all(self) -> None:
        """Stop all that moves; what is under way fails."""
        self._halting = self._stopped = True
        await self._bench.stop()

    # what is known

    async def _look(self, component: str) -> ObservedComponent | None:
        with suppress(Failed, PicoError):
            return (await self._seen()).components.get(component)
        return None

    async def _seen(self) -> Observation:
        return await self._asked(self._known.seen)

    async def _asked(self, ask: Callable[..., T], *args: Any) -> T:
        """Ask what is known, in a thread: who stops the bench is heard meanwhile."""
        async with self._looking:
            return await asyncio.to_thread(ask, *args)

    # doing

    def _act(self, operation: Operation, key: str) -> Coroutine[Any, Any, Mapping[str, Any]]:
        own = {"move": self._move, "stow": self._move, "park": self._park, "set": self._set, "home": self._set,
               "measure": self._measure, "auto_range": self._auto_range}  # fmt: skip
        return own.get(operation.primitive, self._plugged_in)(operation, key)

    async def _plugged_in(self, operation: Operation, key: str) -> Mapping[str, Any]:
        """Use a tool as a plug-in's routine says, once that went well in the twin; what the routine commands nobody
        reads: it is kept, and unknown while the arm is at it."""
        routine = asked_of(self._setup, await self._seen(), operation)
        if routine is None:
            return await self._refused(operation, key)
        tool, told = routine.tool, [f"{operation.component}.{tunable}" for tunable in routine.commands]
        await self._asked(self._known.survey, tool)
        seen = await self._seen()
        start, paths = await asyncio.to_thread(ways.using, self._setup, self._motion, seen, operation, routine)
        checks.require_dark(self._setup, seen, operation)
        meant = carried(operation, tool, start)
        await asyncio.to_thread(rehearse, self._setup, seen, meant, tool, paths)
        await self._asked(self._known.takes, tool, paths[0])
        for address in told:
            self._keep(address, None)
        for path in paths:
            await self._gone(meant, key, path, start)
        checks.require_back(self._setup, tool, await self._asked(self._known.confirm, tool, start), start)
        for address, value in zip(told, routine.commands.values(), strict=True):
            self._keep(address, value)
        return {}

    async def _refused(self, operation: Operation, key: str) -> Mapping[str, Any]:
        text = f"the bench cannot {operation.primitive} {operation.component}"
        raise Failed(error("capability", text, address=operation.component))

    async def _measure(self, operation: Operation, key: str) -> Mapping[str, Any]:
        busy = sorted(other.split("/")[1] for other in self._under_way if other != key)
        found = await self._measured(operation.component, str(operation.arguments.get("measurable")), busy)
        return {"measurement": as_json(found)}

    async def _auto_range(self, operation: Operation, key: str) -> Mapping[str, Any]:
        def told(data: Mapping[str, Any]) -> None:
            self._require_running()
            self._tell("operation_progress", operation, key, data)

        return await ranged(self._setup, self._bench, operation, self._image, told)

    async def _move(self, operation: Operation, key: str) -> Mapping[str, Any]:
        """Pick and place on the table as it is now, and again where the part then does not stand as it should."""
        name = operation.component
        planned, goal, slot = checks.places(operation)
        stood: list[Pose] = []
        for left in reversed(range(1 + self._known.corrections)):
            await self._carried(operation, key, planned)
            part = await self._asked(self._known.confirm, name, goal)
            if part.how == "placed":  # the arm itself hides it
                await self._withdraw(operation)
                part = await self._asked(self._known.confirm, name, goal)
            if part.presence != "seen" or part.pose is None:
                break
            wrong = checks.misplaced(self._setup, name, part.pose, goal, slot)
            if wrong is None:
                return checks.off(part.pose, goal, stood)
            if not left:
                raise Failed(wrong)
            stood.append(part.pose)
            planned = part.pose
            operation = replace(operation, arguments={**operation.arguments, "from": {"pose": as_json(planned)}})
        raise checks.not_standing(name, part.presence)

    async def _carried(self, operation: Operation, key: str, planned: Pose) -> None:
        """Pick and place once: looked at just before, on a path found anew from where arm and component are."""
        name, goal = operation.component, checks.places(operation)[1]
        if not checks.in_hand(operation):
            await self._asked(self._known.survey, name)
        seen = await self._seen()
        find = ways.carrying
        start, path = await asyncio.to_thread(find, self._setup, self._motion, seen, operation, planned, goal)
        if isinstance(path, Blocked):
            raise checks.blocked(name, path)
        checks.require_dark(self._setup, seen, operation)
        await self._asked(self._known.takes, name, path)
        await self._gone(operation, key, path, start)

    async def _gone(self, operation: Operation, key: str, path: MovePath, start: Pose) -> None:
        """Have an arm go along a path with what it took at `start`, or is to take there; says what became of that."""
        name, before = operation.component, await self._seen()
        try:
            await self._walked(operation, key, path)
        except _Back as way:
            self._moved.discard(way.path.robot)  # it goes back with what it holds, whatever was tried of it
            await self._walked(operation, key, way.path)
            raise Failed(checks.put_back(name, slot_at(self._setup, start) or str(start))) from way
        except Failed as exc:
            if self._stopped or exc.diagnostic.code not in (*checks.LOST, "put-back"):
                raise
            await self._withdraw(operation)
            if exc.diagnostic.code == "put-back":
                raise
            part = await self._asked(self._known.find, name)
            said = Failed(checks.found_again(exc.diagnostic, name, part), exc.outcome, exc.data)
            raise with_pushed(said, before, pushed(self._setup, before, await self._seen(), name)) from exc

    async def _park(self, operation: Operation, key: str) -> Mapping[str, Any]:
        robot = operation.robot or operation.component
        if robot not in self._bench.arms:
            raise Failed(error("bad-plan", f"the bench has no robot {robot}"))
        seen = await self._seen()
        checks.require_empty(seen, robot)
        path = await asyncio.to_thread(ways.parking, self._setup, self._motion, seen, robot)
        if isinstance(path, Blocked):
            raise checks.blocked(robot, path)
        await self._walked(operation, key, path)
        return {}

    async def _walked(self, operation: Operation, key: str, path: MovePath, speed: float | None = None) -> None:
        """Have an arm go along a path, with what it shares kept free; ends sooner where it is halted."""
        robot = path.robot
        self._require_one_step(robot)

        async def asked(stage: Stage) -> None:
            self._require_running()
            data = {"phase": stage.segment, "fraction": path.gone(stage) / path.seconds if path.seconds else 1.0}
            self._tell("operation_progress", operation, key, data)
            if self._halting or self._lease_over():
                await self._leave(operation, path, stage)
            if stage.segment == "release":
                await self._asked(self._known.lets_go, path.component or operation.component, path, self._now())

        way = self._way(operation, path, asked, speed)
        await self._require_kept(robot)
        with self._zones.held(operation, path):
            self._ways[robot] = way
            try:
                await way.walk()
            except Failed as exc:
                if self._stopped or not self._halting or way.stage.segment not in ("approach", "descend"):
                    raise
                raise Failed(checks.left(operation.component)) from exc
            finally:
                del self._ways[robot]

    def _way(
        self, operation: Operation, path: MovePath, asked: Callable[[Stage], Awaitable[None]],
        speed: float | None = None,
    ) -> Way:  # fmt: skip
        robot = path.robot
        fastest = self._setup.lab.robots[robot].fastest if speed is None else speed_of(self._setup, path)
        most = FIRST_SPEED if robot in self._untried else self._most or fastest
        slow = max(1.0, fastest / min(most, speed or most))
        arm, gripper = self._bench.arms[robot], self._bench.grippers.get(robot)
        return Way(self._setup, operation, path, arm, gripper, self._arms[robot], asked, slow)

    async def _leave(self, operation: Operation, path: MovePath, stage: Stage) -> None:
        """Let a way that is halted go on, or end it before a leg: raises Failed where the part is left where it stands,
        _Back where it is brought back sooner than to its goal."""
        found = way_out(path, stage)
        if found in ("leaves_it", "undecided"):  # its fingers are still open
            raise Failed(checks.left(operation.component))
        if found == "may_turn_back":
            start, seen = checks.places(operation)[0], await self._seen()
            back = await asyncio.to_thread(ways.back, self._setup, self._motion, seen, operation, start)
            if back is not None and sooner(path, stage, back):
                raise _Back(back)

    def _require_one_step(self, robot: str) -> None:
        """Raise Failed for a second motion in one go of an arm whose motion test did not pass."""
        if robot in self._untried and robot in self._moved:
            raise Failed(one_motion(robot))
        self._moved.add(robot)

    async def _require_kept(self, robot: str) -> None:
        """Raise PicoError for an arm that was lost since it was got ready: not even its fingers move before it is
        again."""
        if lost := (await self._bench.arms[robot].state()).lost:
            text = f"{robot} was lost, for {lost}: it does not move before it is got ready again"
            raise PicoError(
                error("device-lost", text, hint="look at the arm; the next run gets it ready", address=robot)
            )

    async def _withdraw(self, operation: Operation) -> None:
        """Bring an arm with an empty hand to its park pose, where there is a way; who looks next sees where it is."""
        with suppress(Failed):
            seen = await self._seen()
            path = await asyncio.to_thread(ways.parking, self._setup, self._motion, seen, operation.robot or "")
            if not isinstance(path, Blocked):
                await self._way(operation, path, self._unless_stopped).walk()

    async def _unless_stopped(self, stage: Stage) -> None:
        self._require_running()

    def _lease_over(self) -> bool:
        """Whether the lease is over: from then on as where it is halted."""
        try:
            self._require_lease()
        except PicoError:
            self._halting = True
        return self._halting

    def _require_running(self) -> None:
        if self._stopped:
            raise self._ended()

    def _ended(self) -> Failed:
        """Why everything was stopped."""
        return Failed(self._tripped or checks.STOPPED)

    async def _set(self, operation: Operation, key: str) -> Mapping[str, Any]:
        checks.standing_pose(await self._seen(), operation.component)
        self._require_lease()
        self._require_running()  # a stop may have come while cameras looked: it shuts what lets light out only once
        return await driven(self._setup, self._bench, operation, self._pause)

    def _tell(self, kind: EventKind, operation: Operation, key: str, data: Mapping[str, Any]) -> None:
        self._told += 1
        event = Event(
            run=key.split("/", maxsplit=1)[0], seq=self._told, kind=kind, time=self._now(), operation=operation.id,
            component=operation.component, data=data,
        )  # fmt: skip
        self._tell_all(event)


def one_motion(robot: str) -> Diagnostic:
    """Return that an arm makes one motion a command, and what lifts that."""
    text = f"the motion test of {robot} did not pass on this device: it makes one motion a command, at 50 mm/s"
    hint = "keep a hand on the stop; `pico commission --only motion` runs the test, then plans run whole"
    return error(ONE_MOTION, text, hint=hint, address=robot)


class _Back(Exception):
    """A part is brought back along `path`, for that is nearer than its goal."""

    def __init__(self, path: MovePath) -> None:
        self.path = path
        super().__init__()
