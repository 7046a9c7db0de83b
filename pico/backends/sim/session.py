"""The table while somebody has taken it: every operation in progress, and the time that passes for all of them."""

from __future__ import annotations

import asyncio
import math
import random
import time
from collections.abc import Callable, Generator, Mapping
from contextlib import suppress
from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pico.backends import checks, last_seen, ways
from pico.backends.attempt import Failed, attempt
from pico.backends.by_sight import BySight
from pico.backends.device import Began
from pico.backends.halting import sooner, way_out
from pico.backends.pushed import pushed, with_pushed
from pico.backends.ranging import MOST, Taken, in_vain, next_exposure, taken
from pico.backends.routines import asked_of
from pico.backends.sim.bodies import snapshot
from pico.backends.sim.checks import refused, shut
from pico.backends.sim.fault_effects import REST, Mishaps, driven_badly, on_the_way, strikes
from pico.backends.sim.faults import LASTING, Fault, Faults
from pico.backends.sim.kinematic import KinematicWorld
from pico.backends.sim.known import Exactly, Known
from pico.backends.sim.measuring import measured, require_simulated
from pico.backends.sim.mover import InProgress, WorldMover
from pico.backends.sim.person import steps as hands
from pico.backends.sim.plugins import plugged_in
from pico.backends.sim.readings import Table
from pico.backends.sim.senses import sensed
from pico.backends.sim.steering.axis import driven
from pico.backends.sim.steering.pace import STEP, Pace
from pico.backends.sim.store import save_world
from pico.backends.sim.stretching import stretched
from pico.backends.sim.timeline import Timeline
from pico.backends.sim.world import World
from pico.diagnostics import ExitCode, PicoError, error
from pico.model.observation import Observation, ObservedComponent, ObservedValue, doubtful, slot_at
from pico.model.operation import Operation, OperationResult
from pico.model.pose import Pose
from pico.model.quantities import Value
from pico.model.record import as_json
from pico.model.setpoint import home_seconds, set_seconds
from pico.model.setup import Setup
from pico.model.trace.event import Event, EventKind
from pico.model.trace.learned import Learned, work
from pico.motion.types import Blocked, Joints, Motion, MovePath, Stage
from pico.places.bench import BenchPlace
from pico.planning.routines import Routine, carried
from pico.teleop.frames import STEPS
from pico.twin.learned import read_learned, with_noise
from pico.twin.snapshot import Snapshot
from pico.vision.calibration_files import SIMULATED, known_arms

if TYPE_CHECKING:
    from pico.backends.sight import Look
    from pico.vision.frame import Frame, Region

PROGRESS = 0.25
"""Simulated seconds between two reports of an operation's progress, at least."""

WATCHED = 0.05
"""Simulated seconds between two looks at a run that is recorded, at most."""

SETTLING = 0.5
"""Simulated seconds in which a table comes to rest before something is measured."""

KEPT = 0.05
"""Seconds of wall time after which the world is stored again while something moves."""


class WorldSession:
    """Executes operations on `world`. `motion` finds paths; `tell` hears of starts and progress; `look` looks at the
    table by sight: then nothing is known of it but what that tells. Without it, everything is."""

    def __init__(
        self,
        setup: Setup,
        place: BenchPlace,
        world: World,
        *,
        fidelity: str,
        token: int,
        motion: Motion,
        tell: Callable[[Event], None],
        clock: Callable[[], str],
        faults: Faults | None = None,
        look: Callable[[], Look] | None = None,
        pace: Pace | None = None,
    ) -> None:
        """`pace`: with which time passes while a person steers."""
        self._setup, self._place, self._world = setup, place, world
        self._pace = pace or Pace()
        self._motion, self._tell_all, self._clock = motion, tell, clock
        self._mover, self._began_at = new_mover(setup, place.root, world, fidelity), world.clock
        self._learned = read_learned(place.root) or Learned()
        self._time: Timeline[OperationResult] = Timeline(world.clock, self._mover.advance)
        self._told, self._halting, self._kept = 0, False, 0.0
        self._known: Known = self._by_sight(look) if look else Exactly(self.world)
        self._zones = ways.Zones(setup)
        self._mishaps = Mishaps(setup, faults or Faults(), token, self._mover, self.world)

    def _by_sight(self, look: Callable[[], Look]) -> BySight:
        def felt(taken: Mapping[str, last_seen.Taken]) -> Observation:
            return sensed(self._setup, self.world(), taken, "sim", "")

        def take(camera: str, region: Region) -> Frame:
            return self._mover.eyes(self.world()).frame(camera, region)

        return BySight(self._setup, self._place, felt, look, take, self._mover.left)

    def watch(self, look: Callable[[Snapshot], None]) -> None:
        """Let `look` see the table now, and at least every WATCHED simulated seconds while something moves."""
        if isinstance(self._mover, KinematicWorld):
            self._mover.step = WATCHED
        self._time.look = lambda: look(snapshot(self._setup, self.world()))
        self._time.look()

    def world(self) -> World:
        """Return the table as it is at this moment."""
        if self._time.now == self._began_at:  # a mover may find what a hand holds only once time passes
            return self._world
        return replace(self._mover.world(self._world), clock=self._time.now)

    async def execute(self, operation: Operation, key: str, began: Began) -> OperationResult:
        """Execute an operation; cancelling the wait does not cancel the motion.

        Raises PicoError (exit code INTERRUPTED) where it was stopped before it began.
        """

        def begins(before: ObservedComponent | None) -> None:
            began(before)
            data = {"primitive": operation.primitive, "seconds": operation.seconds}
            self._tell("operation_started", operation, key, data)

        if operation.primitive in STEPS:
            self._keep_pace()
        try:
            return await asyncio.shield(self._time.start(key, attempt(self, operation, key, begins)))
        except Failed as exc:
            raise PicoError(exc.diagnostic, ExitCode.INTERRUPTED) from exc

    def _keep_pace(self) -> None:
        """Let the world keep pace with the wall from now on, where a person steers: seen often enough to be stopped."""
        if isinstance(self._mover, KinematicWorld):
            self._mover.step = STEP
        if self._time.pace is not None and not self._time.under_way:  # time passed while nothing moved
            self._time.now = self._pace.moment(self._time.now)
        self._pace.begin(self._time.now)
        self._time.pace = self._pace

    async def idle(self) -> None:
        """Wait until nothing is under way."""
        await self._time.idle()

    async def halt(self) -> None:
        """Bring everything under way to its safe end: a part in a hand goes to its goal or back, whichever is sooner;
        an arm that has not gripped yet leaves its part and parks."""
        self._halting = True
        await self._time.idle()

    async def stop(self) -> None:
        """Stop everything under way: arms come to rest, hands hold what they hold, shutters close."""
        self._halting = True
        self._time.interrupt(Failed(checks.STOPPED))
        await self._time.idle()
        dark = shut(self._setup, self._world)
        if dark is not self._world:
            self._world = dark
            self.store()

    # the table that attempts act on

    @property
    def now(self) -> float:
        """Simulated time [s]."""
        return self._time.now

    def look(self, component: str) -> ObservedComponent | None:
        """Return a component as it is; None where no camera saw it."""
        if component in self._mishaps.unseen:
            self._mishaps.unseen.remove(component)
            return None
        try:
            return self._known.seen().components.get(component)
        except Failed:
            return None

    def store(self) -> None:
        """Store the world durably."""
        self._world = self.world()
        save_world(self._place, self._world)

    def act(self, operation: Operation, key: str) -> InProgress:
        own = {"move": self._move, "stow": self._move, "park": self._park, "set": self._set, "home": self._set,
               "measure": self._measure, "auto_range": self._auto_range,
               "operator": self._by_hand, "take": self._take, "jog": self._jog, "let_go": self._let_go}  # fmt: skip
        doing = own.get(operation.primitive, self._plugged_in)(operation, key)
        if operation.primitive in STEPS:
            return (yield from doing)
        kind = work(self._setup, operation.primitive, operation.component, operation.robot, operation.arguments)
        return (yield from stretched(doing, self._learned.time(kind)))

    def _measure(self, operation: Operation, key: str) -> InProgress:
        """Wait until the table has settled, and measure it as it then is."""
        name = str(operation.arguments.get("measurable"))
        require_simulated(self._setup, operation.component, name)
        yield SETTLING
        busy = sorted(other.split("/")[1] for other in self._time.under_way if other != key)
        light = self._mishaps.shone(self.world(), self._mishaps.of(operation, key))
        found = measured(
            self._setup, self._place, self.world(), operation.component, name, busy, self._clock(), light=light
        )
        return {"measurement": as_json(found)}

    def _auto_range(self, operation: Operation, key: str) -> InProgress:
        """Take frames, and expose each as the one before tells, until one is neither saturated nor dark."""
        name, (tunable, kind) = operation.component, checks.setpoint(self._setup, operation)
        _, measurer = require_simulated(self._setup, name, "image")
        limits, frames, fault = kind.range or (0.0, math.inf), list[Taken](), self._mishaps.of(operation, key)
        while len(frames) < MOST:
            live = self._world.components[name].values[tunable].value
            exposure = live if isinstance(live, int | float) else limits[0]
            yield SETTLING + exposure * 1e-3
            light = self._mishaps.shone(self.world(), fault if not frames else None)
            found = measurer.read(Table(self._setup, self._place, light), name, "image")
            assert found.array is not None
            black, full = (float(found.settings[k]) for k in ("black_level", "full_scale"))
            frames.append(taken(exposure, found.array, black, full))
            self._tell("operation_progress", operation, key, {"fraction": len(frames) / MOST, "phase": "exposing"})
            wanted = next_exposure(frames[-1], limits)
            if wanted is None:
                break
            yield set_seconds(kind, exposure, wanted)
            self._world = self._world.with_value(name, tunable, ObservedValue(value=wanted))
        why = in_vain(name, frames)
        if why is not None:
            if why.code == "dark":  # nothing was found out: as it was
                self._world = self._world.with_value(name, tunable, ObservedValue(value=frames[0].exposure))
            raise Failed(why)
        return {"value": frames[-1].exposure, "frames": [as_json(asdict(frame)) for frame in frames]}

    def _plugged_in(self, operation: Operation, key: str) -> InProgress:
        """Do what a plug-in brought, in the time that the plan reckons with, or that its arm takes."""
        does, routine = plugged_in().get(operation.primitive), asked_of(self._setup, self._known.seen(), operation)
        if does is None and routine is None:
            raise refused(operation)
        if routine is None:
            yield operation.seconds
        else:
            yield from self._used(operation, key, routine)
            for tunable, value in routine.commands.items():
                told = ObservedValue(value=value, status="commanded")
                self._world = self._world.with_value(operation.component, tunable, told)
        self._world = does(self._world, operation) if does else self._world
        return {}

    def _used(self, operation: Operation, key: str, routine: Routine) -> InProgress:
        """Use a tool, which then stands where it stood."""
        tool = routine.tool
        stands = self._known.survey(tool)
        start, ways_ = ways.using(self._setup, self._motion, self._known.seen(), operation, routine)
        checks.require_dark(self._setup, self._known.seen(), operation)
        meant = carried(operation, tool, start)
        self._known.takes(tool, ways_[0])
        for path in ways_:
            with self._zones.held(operation, path):
                walk = self._mover.move(meant, path, stands) if path.hands_over else self._mover.park(path)
                yield from self._reported(meant, key, path, walk)
        checks.require_back(self._setup, tool, self._known.confirm(tool, start), start)
        return {}

    def _move(self, operation: Operation, key: str) -> InProgress:
        """Pick and place on the table as it is now, and again where the part then does not stand as it should."""
        name, fault = operation.component, self._mishaps.of(operation, key)
        planned, goal, slot = checks.places(operation)
        stood: list[Pose] = []
        for left in reversed(range(1 + self._known.corrections)):
            data = yield from self._carried(operation, key, planned, fault)
            self._mishaps.slipped(name, fault)
            part = self._known.confirm(name, goal)
            if part.how == "in hand" and doubtful(self._setup, name, part):  # the arm itself is in doubt
                yield from self._withdraw(operation.robot or "")
                part = self._known.confirm(name, goal)
            if part.presence != "seen" or part.pose is None:
                break
            there = yield from self._mishaps.looked_at(name, part.pose, fault)
            wrong = checks.misplaced(self._setup, name, there, goal, slot)
            if wrong is None:
                return {**checks.off(there, goal, stood), **data}
            if not left:
                raise Failed(wrong)
            stood.append(there)
            planned, fault = there, None
            operation = replace(operation, arguments={**operation.arguments, "from": {"pose": as_json(there)}})
        raise checks.not_standing(name, part.presence)

    def _carried(self, operation: Operation, key: str, planned: Pose, fault: Fault | None) -> InProgress:
        """Pick and place once: the path is found anew, from where arm and component are."""
        name = operation.component
        stands = None if checks.in_hand(operation) else self._known.survey(name)
        goal = checks.places(operation)[1]
        start, path = ways.carrying(self._setup, self._motion, self._known.seen(), operation, planned, goal)
        if isinstance(path, Blocked):
            raise checks.blocked(name, path)
        checks.require_dark(self._setup, self._known.seen(), operation)
        actual = replace(operation, arguments={**operation.arguments, "from": {"pose": as_json(start)}})
        self._known.takes(name, path)
        before = self._known.seen()
        try:
            with self._zones.held(operation, path):
                return (yield from self._reported(actual, key, path, self._mover.move(actual, path, stands), fault))
        except Failed as exc:
            lost = exc.diagnostic.code in checks.LOST
            if lost and self._known.corrections and not self._halting:  # what is known exactly needs no look
                with suppress(Failed):  # cameras then see what the arm hides
                    yield from self._withdraw(path.robot)
            try:
                part = self._known.find(name) if lost else self._known.confirm(name, start)
                others = pushed(self._setup, before, self._known.seen(), name)
            except Failed:  # nothing can be seen, which is not what went wrong first
                raise exc from None
            if not lost:
                raise
            said = checks.found_again(exc.diagnostic, name, part, f" (here `pico sim nudge {name}`)")
            raise with_pushed(Failed(said, exc.outcome, exc.data), before, others) from exc

    def _take(self, operation: Operation, key: str) -> InProgress:
        """Take a part in hand where it stands, a hair above its place."""
        name, robot = operation.component, operation.robot or ""
        seen = self._known.seen()
        start = checks.require_ready(self._setup, seen, operation, checks.places(operation)[0])
        stands, yaw = self._known.survey(name), float(operation.arguments.get("grasp_yaw", 0.0))
        path = self._motion.take(
            robot, name, start, yaw, checks.standing(self._setup, seen), seen.robots[robot].joints,
            self._elsewhere(robot),
        )  # fmt: skip
        return (yield from self._steered(operation, key, path, start, stands))

    def _jog(self, operation: Operation, key: str) -> InProgress:
        """Make one step: of a part in a hand to a pose, of a tunable to a value."""
        if operation.robot is None:
            return (yield from self._driven(operation))
        held, goal = self._held(operation), checks.places(operation)[1]
        seen, robot = self._known.seen(), operation.robot
        path = self._motion.shift(
            robot, operation.component, held, goal, checks.standing(self._setup, seen), seen.robots[robot].joints,
            self._elsewhere(robot),
        )  # fmt: skip
        return (yield from self._steered(operation, key, path, goal))

    def _let_go(self, operation: Operation, key: str) -> InProgress:
        """Set a part down that a hand holds, where it is."""
        name, robot, held = operation.component, operation.robot or "", self._held(operation)
        seen = self._known.seen()
        path = self._motion.let_go(
            robot, name, held, checks.standing(self._setup, seen), seen.robots[robot].joints, self._elsewhere(robot)
        )
        data = yield from self._steered(operation, key, path, held)
        part = self._known.confirm(name, held)
        if part.presence != "seen" or part.pose is None:
            raise checks.not_standing(name, part.presence)
        return {**data, "pose": as_json(part.pose)}

    def _held(self, operation: Operation) -> Pose:
        """Return where a part is in the hand of the robot of an operation, as far as anybody knows."""
        return checks.require_held(self._setup, self._known.seen(), operation)

    def _steered(
        self, operation: Operation, key: str, path: MovePath | Blocked, goal: Pose, stands: Pose | None = None
    ) -> InProgress:
        """Walk a way that a person steers; the beam is shut, and no other arm is there."""
        if isinstance(path, Blocked):
            raise Failed(error("blocked", path.text, hint=path.help, address=operation.component))
        checks.require_dark(self._setup, self._known.seen(), operation)
        ends = {"from": {"pose": as_json(goal)}, "to": {"pose": as_json(goal)}}
        if any(segment.name == "grip" for segment in path.segments):
            self._known.takes(operation.component, path)
        meant = replace(operation, arguments={**operation.arguments, **ends})
        with self._zones.held(operation, path):
            return (yield from self._reported(meant, key, path, self._mover.move(meant, path, stands)))

    def _driven(self, operation: Operation) -> InProgress:
        """Drive an axis by one step, read back on the way: where it is stopped, it is known where it stands."""
        name, (tunable, kind) = operation.component, checks.setpoint(self._setup, operation)
        checks.standing_pose(self._known.seen(), name)
        live = self._world.components[name].values[tunable]
        goal = checks.require_value(name, tunable, kind, operation.arguments.get("to"))
        if not isinstance(live.value, int | float) or live.status == "unknown" or not isinstance(goal, int | float):
            raise Failed(error("unknown", f"nobody knows where {name}.{tunable} stands", address=name))
        for seconds, value in driven(f"{name}.{tunable}", kind, float(live.value), float(goal)):
            yield seconds
            self._world = self._world.with_value(name, tunable, replace(live, value=value))
        return {"value": goal}

    def _by_hand(self, operation: Operation, key: str) -> InProgress:
        """Let the simulated person put a part where it goes, or set a tunable."""
        name, draw = operation.component, random.Random(f"{self._world.seed} {key}")
        checks.standing_pose(self._known.seen(), name)
        yield operation.seconds
        if "tunable" in operation.arguments:
            tunable, kind = checks.setpoint(self._setup, operation)
            goal = checks.require_value(name, tunable, kind, operation.arguments.get("to"))
            live = self._world.components[name].values[tunable]
            value = hands.turn(kind, None if live.status == "unknown" else live.value, goal, draw)
            self._world = self._world.with_value(name, tunable, ObservedValue(value=value))
            return {"value": value, "by": "hand"}
        _, goal_pose, slot = checks.places(operation)
        pose = hands.put(goal_pose, self._setup.type_of(name).pose.tolerance, draw)
        self._mover.put(name, pose)
        self.store()
        part = self._known.confirm(name, goal_pose)
        if part.presence != "seen" or part.pose is None:
            raise checks.not_standing(name, part.presence)
        if wrong := checks.misplaced(self._setup, name, part.pose, goal_pose, slot):
            raise Failed(wrong)
        return {**checks.off(part.pose, goal_pose), "by": "hand"}

    def _park(self, operation: Operation, key: str) -> InProgress:
        robot = operation.robot or operation.component
        if robot not in self._setup.lab.robots:
            raise Failed(error("bad-plan", f"the bench has no robot {robot}"))
        seen = self._known.seen()
        checks.require_empty(seen, robot)
        path = ways.parking(self._setup, self._motion, seen, robot)
        if isinstance(path, Blocked):
            raise checks.blocked(robot, path)
        with self._zones.held(operation, path):
            return (yield from self._reported(operation, key, path, self._mover.park(path)))

    def _elsewhere(self, robot: str) -> dict[str, Joints]:
        """Return the joints of the other arms as they are now."""
        return {name: other.joints for name, other in self.world().robots.items() if name != robot}

    def _set(self, operation: Operation, key: str) -> InProgress:
        """Drive a tunable to a value, or its axis to its home; while it moves nobody knows its value."""
        name, (tunable, kind) = operation.component, checks.setpoint(self._setup, operation)
        checks.standing_pose(self._known.seen(), name)
        live, fault = self._world.components[name].values[tunable], self._mishaps.of(operation, key)
        before = None if live.status == "unknown" else live.value
        if operation.primitive == "home":
            goal: Value = kind.axis.home if kind.axis else 0.0
            seconds = home_seconds(kind, before)
        else:
            goal = checks.require_value(name, tunable, kind, operation.arguments.get("to"))
            seconds = set_seconds(kind, before, goal)
            if before is None and kind.axis and kind.axis.kind == "homed":  # it must be homed first
                seconds = home_seconds(kind, None) + set_seconds(kind, kind.axis.home, goal)
        address = f"{name}.{tunable}"
        stuck = address in self._world.stuck
        self._world = self._world.with_value(name, tunable, on_the_way(kind, live, goal, None if stuck else fault))
        if fault is not None and fault.kind in LASTING and kind.axis and not stuck:
            self._world = replace(self._world, stuck=(*self._world.stuck, address))
        self._keep()
        yield from driven_badly(fault, address, seconds, stuck)
        yield seconds
        self._world = self._world.with_value(name, tunable, ObservedValue(value=goal))
        return {"value": goal}

    def _reported(
        self, operation: Operation, key: str, path: MovePath, work: InProgress, fault: Fault | None = None
    ) -> InProgress:
        """Pass an operation on, and say how far it is at most every PROGRESS seconds."""
        told, decided, phase = self._time.now, False, ""
        try:
            wait = next(work)
            while True:
                stage = self._mover.stage(path.robot)
                if self._time.now - told >= PROGRESS:
                    told = self._time.now
                    self._tell("operation_progress", operation, key, self._progress(path, stage))
                if fault is not None and strikes(fault, stage):
                    struck, fault = fault, None
                    yield from self._mishaps.strike(
                        struck, path.robot, operation.component, lambda: self._drop_work(work)
                    )
                if self._halting and not decided:
                    decided = yield from self._way_out(operation, path, stage, work)
                phase, before = stage.segment, phase
                if phase == "release" and before != phase:
                    self._known.lets_go(path.component or operation.component, path, self._time.now)
                if (before in ("grip", "release") and phase != before) or time.monotonic() - self._kept > KEPT:
                    self._keep()
                try:
                    yield wait
                except Failed as exc:
                    decided = True  # it comes to rest where it is
                    wait = work.throw(exc)
                else:
                    wait = next(work)
        except StopIteration as stop:
            data: dict[str, Any] = stop.value
            return data

    def _way_out(
        self, operation: Operation, path: MovePath, stage: Stage, work: InProgress
    ) -> Generator[float, None, bool]:
        """End a move that is halted sooner than at its goal where that can be; return whether it is decided.

        Raises Failed once the part is back, or left where it stands, and the arm at a safe waypoint.
        """
        way = way_out(path, stage)
        if way in ("goes_on", "undecided"):
            return way == "goes_on"
        if way == "leaves_it":
            self._drop_work(work)
            yield REST
            yield from self._withdraw(path.robot)
            raise Failed(checks.left(operation.component))
        start, _, _ = checks.places(operation)
        back = self._back(operation, start)
        if back is None or not sooner(path, stage, back):
            return True
        self._drop_work(work)
        yield REST
        back = self._back(operation, start) or back  # the arm went on a little until it came to rest
        there = {**operation.arguments, "to": {"pose": as_json(start)}}
        yield from self._mover.move(replace(operation, arguments=there), back)
        where = slot_at(self._setup, start) or str(start)
        raise Failed(checks.put_back(operation.component, where))

    def _back(self, operation: Operation, start: Pose) -> MovePath | None:
        return ways.back(self._setup, self._motion, self._known.seen(), operation, start)

    def _drop_work(self, work: InProgress) -> None:
        """Let an arm stop where it is, in the middle of what it does."""
        try:
            while True:
                work.throw(Failed(checks.STOPPED))
        except (Failed, StopIteration):
            pass

    def _withdraw(self, robot: str) -> Generator[float, None, None]:
        """Bring an arm with an empty hand to its park pose, where there is a way."""
        path = ways.parking(self._setup, self._motion, self._known.seen(), robot)
        if not isinstance(path, Blocked):
            yield from self._mover.park(path)

    def _keep(self) -> None:
        """Store the world as it is in the middle of a motion: what a killed process leaves behind is then true."""
        self._kept = time.monotonic()
        with suppress(PicoError):  # the end of the operation will say so
            save_world(self._place, self.world(), durable=False)

    def _progress(self, path: MovePath, stage: Stage) -> dict[str, Any]:
        seen = self._known.seen()
        held = seen.robots[path.robot].holding
        pose = seen.components[held].pose if held else None
        found = {"phase": stage.segment, "fraction": path.gone(stage) / path.seconds if path.seconds else 1.0}
        return found | ({"pose": as_json(pose)} if pose else {})

    def _tell(self, kind: EventKind, operation: Operation, key: str, data: Mapping[str, Any]) -> None:
        self._told += 1
        event = Event(
            run=key.split("/", maxsplit=1)[0], seq=self._told, kind=kind, time=self._time.now, operation=operation.id,
            component=operation.component, data=data,
        )  # fmt: skip
        self._tell_all(event)


def new_mover(setup: Setup, root: Path, world: World, fidelity: str) -> WorldMover:
    """Return what moves the bodies of `world` of the lab in `root` at a fidelity: `kinematic` or `physics`."""
    known, learned = known_arms(root, SIMULATED), read_learned(root)
    setup = with_noise(setup, learned)
    if fidelity == "kinematic":
        return KinematicWorld(setup, world, known, learned)
    from pico.backends.sim.physics import PhysicsWorld, seeing

    return PhysicsWorld(setup, world, sight=seeing(setup, world, root), known=known, learned=learned)
