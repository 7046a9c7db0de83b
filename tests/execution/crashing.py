"""Runs on a bench of plain data that is cut off at any point: before and after every record, at every step of a motion.

A seeded scheduler in virtual time drives the product's own executor, attempts, journal and recovery. The table is the
truth, and it alone judges: each actuation is checked when it begins, by what then is true and written.
"""

from __future__ import annotations

import random
import types
from collections.abc import Coroutine, Generator, Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from benches import shel

from pico.backends.attempt import Failed, Progress, attempt
from pico.backends.device import Began
from pico.diagnostics import PicoError, error
from pico.edge.attempts import Attempts
from pico.edge.recovery import open_questions, settle
from pico.execution.executor import Dispatch, Executor
from pico.execution.resume import renumbered
from pico.model.observation import Observation, ObservedComponent, ObservedRobot, ObservedValue, slot_at
from pico.model.operation import Operation, OperationResult, Reason
from pico.model.plan import Base, LabRef, Plan, Target
from pico.model.pose import Pose
from pico.model.record import as_json
from pico.model.setup import Setup
from pico.runs.journal import Journal

PARTS = ("p1", "p2", "lx_100", "lx_125", "ly_150")
TURNING = ("p1", "p2")
GLUED = "ly_150"
ARMS = ("arm1", "arm2")
TABLE = (Pose(420, 420), Pose(520, 420), Pose(620, 420), Pose(720, 420))
STEPS = 600
APPLIES = 3
"""How often a plan must be applied at most, once nothing is wrong any more, until the goal is reached."""


class Crash(BaseException):
    """The process is dead."""


class Violation(Exception):
    """An invariant does not hold."""


def setup_of_two_arms() -> Setup:
    setup, _ = shel("gantry")
    arm = setup.lab.robots["arm1"]
    parts = {name: part for name, part in setup.lab.inventory.items() if name in PARTS}
    return replace(setup, lab=replace(setup.lab, robots={"arm1": arm, "arm2": arm}, inventory=parts))


SETUP = setup_of_two_arms()
SLOTS = tuple(SETUP.lab.slots)


@dataclass
class Chaos:
    """Decides everything that is not decided; counts the points at which a crash may come."""

    random: random.Random
    left: int | None = None
    crashes: int = 0
    points: int = 0
    healed: bool = False

    def point(self) -> None:
        self.points += 1
        if self.left is not None:
            self.left -= 1
            if self.left <= 0:
                self.left = None
                self.crashes += 1
                raise Crash

    def fault(self, rate: float = 0.06) -> bool:
        return not self.healed and self.random.random() < rate


class CutJournal(Journal):
    """The product's journal, in memory; a crash may come before and after every record."""

    chaos: Chaos

    def _add(self, *args: Any) -> None:
        self.chaos.point()
        super()._add(*args)
        self.chaos.point()


@dataclass
class Truth:
    """The table as it is, and what is checked of every actuation."""

    chaos: Chaos
    poses: dict[str, Pose]
    angles: dict[str, float | None]
    hands: dict[str, str | None] = field(default_factory=lambda: dict.fromkeys(ARMS))
    picked: dict[str, Pose] = field(default_factory=dict)
    glued: bool = False
    now: float = 0.0
    stuck: str | None = None
    active: dict[str, Operation] = field(default_factory=dict)
    begun: set[str] = field(default_factory=set)
    completed: set[tuple[str, str]] = field(default_factory=set)
    plan: str = ""
    may_start: bool = True

    # what the product sees

    def look(self, component: str) -> ObservedComponent:
        held = component in self.hands.values()
        values = {}
        if component in TURNING:
            angle = self.angles[component]
            known = ObservedValue(value=angle) if angle is not None else ObservedValue(value=0.0, status="unknown")
            values = {"angle": known}
        return ObservedComponent(presence="held" if held else "seen", pose=self.poses[component], values=values)

    def observe(self) -> Observation:
        robots = {arm: ObservedRobot(joints=(), holding=part) for arm, part in self.hands.items()}
        return Observation(backend="toy", person=False, components={n: self.look(n) for n in PARTS}, robots=robots)

    def store(self) -> None:
        """The table is what it is."""

    # what is true

    def holds(self, op: Operation) -> bool:
        """Whether what an operation is to bring about is so."""
        if op.primitive == "operator":
            return self.glued
        if op.primitive == "set":
            return self.angles[op.component] == op.arguments["to"]
        if op.primitive == "home":
            return self.angles[op.component] == 0.0
        to, pose = op.arguments["to"], self.poses[op.component]
        if op.component in self.hands.values():
            return False
        if to.get("slot"):
            return slot_at(SETUP, pose) == to["slot"]
        return pose.distance(Pose(**to["pose"])) <= 0.5

    def free(self, pose: Pose, component: str) -> bool:
        standing = [p for n, p in self.poses.items() if n != component and n not in self.hands.values()]
        return all(p.distance(pose) > 40 for p in standing)

    # what is done

    def act(self, op: Operation, key: str) -> Progress:
        self._check_beginning(op, key)
        self.active[key] = op
        try:
            data = yield from self._motion(op)
            self.completed.add((self.plan, key.split("/")[1]))
            return data
        finally:
            self.active.pop(key, None)

    def _check_beginning(self, op: Operation, key: str) -> None:
        kinds = [row[0] for row in self.sql("SELECT kind FROM records WHERE key = ? ORDER BY seq", key)]
        if kinds != ["intent", "started"]:
            raise Violation(f"I6: {key} moves with the records {kinds}")
        if key in self.begun:
            raise Violation(f"I4: {key} moves twice")
        self.begun.add(key)
        if self.holds(op):
            raise Violation(f"I4: {op.primitive} of {op.component} is done and done again")
        missing = [a for a in op.after if (self.plan, a) not in self.completed and op.primitive != "park"]
        if missing:
            raise Violation(f"I5: {op.id} moves before {missing}")
        busy = {r for other in self.active.values() for r in other.resources} & set(op.resources)
        if busy:
            raise Violation(f"I8: two operations move {busy}")
        if op.primitive == "operator" and self.asked(op):
            raise Violation("I7: done again while nobody has said whether it was done")

    def asked(self, op: Operation) -> bool:
        sql = (
            "SELECT count(*) FROM records s JOIN records i ON i.key = s.key AND i.kind = 'intent'"
            " WHERE s.kind = 'unknown' AND s.component = ? AND json_extract(i.data, '$.primitive') = 'operator'"
            " AND NOT EXISTS (SELECT 1 FROM records e WHERE e.key = s.key AND e.kind = 'resolved'"
            " AND json_extract(e.data, '$.by') = 'ann')"
        )
        return bool(self.sql(sql, op.component)[0][0])

    def sql(self, text: str, *values: Any) -> list[tuple[Any, ...]]:
        found: list[tuple[Any, ...]] = self.journal._db.execute(text, values).fetchall()
        return found

    journal: CutJournal = field(init=False)

    def _wait(self) -> float:
        self.chaos.point()
        return self.chaos.random.choice((0.1, 0.5, 1.0))

    def _motion(self, op: Operation) -> Progress:
        if op.primitive in ("move", "stow"):
            yield from self._move(op)
        elif op.primitive == "operator":
            yield from self._glue(op)
        elif op.primitive == "park":
            yield self._wait()
        else:
            yield from self._turn(op)
        return {}

    def _move(self, op: Operation) -> Generator[float, None, None]:
        name, arm, to = op.component, op.robot or "", Pose(**op.arguments["to"]["pose"])
        held = bool(op.arguments["from"].get("held"))
        if held != (self.hands[arm] == name) or (self.hands[arm] and not held):
            text = f"the hand of {arm} with {self.hands[arm]} is told to take {name}"
            raise Failed(error("hand-full", text))
        yield self._wait()
        if not held:
            if self.poses[name].distance(Pose(**op.arguments["from"]["pose"])) > 0.5 or name in self.hands.values():
                raise Failed(error("not-there", f"{name} is elsewhere"))
            if not self.free(to, name):
                raise Failed(error("blocked", f"the goal of {name} is taken"))
            if self.chaos.fault():
                raise Failed(error("missed-grasp", f"missed {name}"))
            self.hands[arm], self.picked[arm] = name, self.poses[name]
        yield self._wait()
        self.poses[name] = Pose(self.poses[name].x / 2 + to.x / 2, 900.0)
        yield self._wait()
        if held:
            self._check_put_back(arm, name, op)
        beside = Pose(to.x + 15, to.y + 1)
        miss = self.chaos.fault() and self.free(beside, name)
        self.poses[name], self.hands[arm] = (beside if miss else to), None
        yield self._wait()
        if miss:
            raise Failed(error("misplaced", f"{name} stands beside its goal"))

    def _check_put_back(self, arm: str, name: str, op: Operation) -> None:
        pick, to = self.picked[arm], Pose(**op.arguments["to"]["pose"])
        if self.free(pick, name) and to.distance(pick) > 0.5:
            raise Violation(f"{name} is put down at {to}, not where {arm} took it")

    def _turn(self, op: Operation) -> Generator[float, None, None]:
        name = op.component
        if self.chaos.fault():
            raise Failed(error("jammed", f"{name} is jammed"))
        if name == self.stuck and not self.chaos.healed:
            raise Failed(error("jammed", f"{name} is stuck"))
        self.angles[name] = None
        yield self._wait()
        lost = self.chaos.fault(0.03)
        self.angles[name] = 0.0 if op.primitive == "home" else float(op.arguments["to"])
        yield self._wait()
        if lost:  # it did what it should, and did not answer
            raise Failed(error("timeout", f"{name} does not answer"), "unknown")

    def _glue(self, op: Operation) -> Generator[float, None, None]:
        yield self._wait()
        self.glued = True
        yield self._wait()
        if self.chaos.fault(0.03):
            raise Failed(error("timeout", "nobody said that it was done"), "unknown")


@dataclass(frozen=True)
class Goal:
    """What the run should lead to."""

    poses: Mapping[str, tuple[Pose, str | None]]
    angles: Mapping[str, float]
    glue: bool


def plan_for(truth: Truth, journal: Journal, goal: Goal, chaos: Chaos) -> Plan:
    """Return a plan from what is seen and journalled: hands first, then moves in an order that works, with stagings."""
    seen = truth.observe()
    operations: list[Operation] = []
    at = {n: part.pose for n, part in seen.components.items() if part.pose}
    last: dict[str, str] = {}  # by component and by place: the operation that comes before

    def add(
        primitive: Any, name: str, arguments: dict[str, Any], robot: str | None, after: set[str], *more: str
    ) -> str:
        id = f"op{len(operations) + 1}"
        resources = (*((robot,) if robot else ()), name, *more)
        operations.append(Operation(
            id=id, primitive=primitive, component=name, arguments=arguments, robot=robot, resources=resources,
            after=tuple(sorted(after)), reason=Reason(kind="changed"), seconds=1.0,
        ))  # fmt: skip
        return id

    hands = set()
    held = {robot.holding for robot in seen.robots.values() if robot.holding}
    for arm, robot in seen.robots.items():
        if robot.holding:
            others = [p for n, p in at.items() if n not in held]
            pick = journal.last_pick(arm)
            spots = [Pose(**pick.arguments["from"]["pose"])] if pick and pick.component == robot.holding else []
            spots += [s.pose for s in SETUP.lab.slots.values()]
            spot = next(s for s in spots if all(s.distance(o) > 40 for o in others))
            start = {"pose": as_json(at[robot.holding]), "held": True}
            to = {"pose": as_json(spot)}
            at[robot.holding] = spot
            held.discard(robot.holding)
            hands.add(add("move", robot.holding, {"from": start, "to": to}, arm, set(hands)))
    waiting = [n for n in PARTS if not _is_there(at[n], goal.poses[n])]
    while waiting:
        ready = [n for n in waiting if _clear(at, n, goal.poses[n][0])]
        name = chaos.random.choice(ready or waiting)
        to, slot = goal.poses[name] if ready else _staging(at, goal, name)
        places = [o for place, o in last.items() if "@" in place and _near(place, to)]
        after = hands | {last[name]} if name in last else hands | set()
        start = {"pose": as_json(at[name])}
        left = f"@{at[name].x},{at[name].y}"
        arguments = {"from": start, "to": {"pose": as_json(to)} | ({"slot": slot} if slot else {})}
        last[name] = last[left] = add("move", name, arguments, chaos.random.choice(ARMS), after | set(places))
        at[name] = to
        if ready:
            waiting.remove(name)
    for name, angle in goal.angles.items():
        value = seen.components[name].values["angle"]
        after = hands | ({last[name]} if name in last else set())
        if value.status == "unknown":
            after = {add("home", name, {"tunable": "angle"}, None, after, f"motor/{name}")}
        if (value.status == "unknown" and angle) or (value.status == "known" and value.value != angle):
            add("set", name, {"tunable": "angle", "to": angle}, None, after, f"motor/{name}")
    if goal.glue and not _glued(truth):
        after = hands | ({last[GLUED]} if GLUED in last else set())
        add("operator", GLUED, {"text": f"glue {GLUED}"}, None, after)
    return Plan(
        lab=LabRef(name="toy", digest=""), backend="toy", fidelity="toy", base=Base(), target=Target(),
        operations=tuple(operations),
    ).sealed()  # fmt: skip


def _glued(truth: Truth) -> bool:
    """What the journal says of the step that no camera sees."""
    sql = (
        "SELECT count(*) FROM records WHERE component = ? AND (kind = 'done' AND"
        " key IN (SELECT key FROM records WHERE kind = 'intent' AND json_extract(data, '$.primitive') = 'operator')"
        " OR kind = 'resolved' AND json_extract(data, '$.outcome') = 'done' AND json_extract(data, '$.by') = 'ann')"
    )
    return bool(truth.sql(sql, GLUED)[0][0])


def _near(place: str, pose: Pose) -> bool:
    x, y = (float(v) for v in place[1:].split(","))
    return pose.distance(Pose(x, y)) < 41


def _is_there(pose: Pose, goal: tuple[Pose, str | None]) -> bool:
    return slot_at(SETUP, pose) == goal[1] if goal[1] else pose.distance(goal[0]) <= 0.5


def _clear(at: Mapping[str, Pose], name: str, to: Pose) -> bool:
    return all(p.distance(to) > 40 for n, p in at.items() if n != name)


def _staging(at: Mapping[str, Pose], goal: Goal, name: str) -> tuple[Pose, str | None]:
    wanted = {slot for _, slot in goal.poses.values()}
    slot = next(s for s in SLOTS if s not in wanted and _clear(at, name, SETUP.lab.slots[s].pose))
    return SETUP.lab.slots[slot].pose, slot


@dataclass
class History:
    """One history: a table, a goal, crashes, and in the end the goal."""

    seed: int
    crashes: int = 4
    steps: int = 0

    def __post_init__(self) -> None:
        self.chaos = Chaos(random.Random(self.seed))
        draw = self.chaos.random
        slots = draw.sample(SLOTS, len(PARTS))
        self.truth = Truth(
            self.chaos, {n: SETUP.lab.slots[s].pose for n, s in zip(PARTS, slots, strict=True)},
            {n: draw.choice((0.0, 30.0)) for n in TURNING},
        )  # fmt: skip
        self.truth.stuck = draw.choice((*TURNING, None, None))
        goals = draw.sample(slots, len(PARTS)) if draw.random() < 0.5 else draw.sample(SLOTS, len(PARTS))
        places: dict[str, tuple[Pose, str | None]] = {
            n: (SETUP.lab.slots[s].pose, s) for n, s in zip(PARTS, goals, strict=True)
        }
        places |= {n: (p, None) for n, p in zip(draw.sample(PARTS, 2), draw.sample(TABLE, 2), strict=True)}
        angles = {n: draw.choice((0.0, 10.0, 45.0)) for n in TURNING}
        self.goal = Goal(places, angles, draw.random() < 0.5)
        self.journal = CutJournal(Path(":memory:"), clock=lambda: f"{draw.choice((0, 5, 9))}")  # clocks are set back
        self.journal.chaos = self.chaos
        self.truth.journal = self.journal
        self.token, self.applies = 0, 0
        self.run_id = ""
        self.late: list[tuple[Attempts, Dispatch]] = []

    def live(self) -> Chaos:
        """Live through it; raises Violation."""
        healthy = 0
        while True:
            self.applies += 1
            if self.chaos.healed:
                healthy += 1
            if healthy > APPLIES:
                raise Violation("I10: the goal is not reached, however often it is applied")
            self.chaos.healed = self.chaos.crashes >= self.crashes or self.applies > 5 * self.crashes
            calm = self.chaos.healed or self.chaos.random.random() < 0.2
            self.chaos.left = None if calm else self.chaos.random.randint(1, 90)
            try:
                if self._apply() and self.chaos.healed:
                    break
            except Crash:
                self.truth.active.clear()
        self.chaos.left = None
        self._check_end()
        return self.chaos

    def _apply(self) -> bool:
        """One command: recover, plan, run. Returns whether the goal is reached."""
        self.token += 1
        attempts = Attempts(self.journal, Toy(self.truth), self.token)
        self._late(attempts)
        for found in settle(SETUP, self.journal, self.truth.observe(), self.token):
            if found.outcome == "done" and not self.truth.holds(found.operation):
                raise Violation(f"{found.key} is said to be done, and is not")
            if found.outcome == "failed" and self.truth.holds(found.operation) and found.operation.primitive != "park":
                raise Violation(f"{found.key} is said not to be done, and is")
        self.chaos.point()
        for open in self.journal.unsettled():
            if not open_questions([open]):
                raise Violation(f"I7: {open.key} is open after an observation")
            self.journal.resolve(open.key, "done" if self.truth.glued else "failed", "ann", None, self.token)
        plan = plan_for(self.truth, self.journal, self.goal, self.chaos)
        if not plan.operations:
            return True
        again = bool(self.run_id) and self.chaos.random.random() < 0.5
        if again:
            plan = renumbered(plan, self.journal.resume_run(self.run_id))
        else:
            self.run_id = f"run{self.token}"
            self.journal.begin_run(self.run_id, plan.digest, "ann")
        self._walk(plan, attempts)
        return False

    def _late(self, attempts: Attempts) -> None:
        """Commands of a process that is thought dead, and the same commands once more to the new one, move nothing."""
        for old, dispatch in self.late:
            try:
                old.known(dispatch.operation, f"{dispatch.run}/{dispatch.id}.late/1")
                raise Violation(f"I1: a late command {dispatch.key} is taken")
            except PicoError:
                pass
            self._again(attempts, dispatch)
        self.late = []

    def _again(self, attempts: Attempts, dispatch: Dispatch) -> None:
        known = [r[0] for r in self.truth.sql("SELECT kind FROM records WHERE key = ?", dispatch.key)]
        if "started" not in known:
            return
        result = attempts.known(dispatch.operation, dispatch.key)
        if result is None:
            raise Violation(f"I4: {dispatch.key} may move once more")
        other = replace(dispatch.operation, arguments={"to": "elsewhere"})
        try:
            attempts.known(other, dispatch.key)
        except PicoError:
            return
        raise Violation(f"{dispatch.key} is taken with other content")

    def _walk(self, plan: Plan, attempts: Attempts) -> None:
        draw, truth = self.chaos.random, self.truth
        truth.plan, truth.may_start, truth.completed = plan.digest, True, set()
        executor = Executor(plan.operations, self.run_id, stop_on_error=draw.random() < 0.2)
        under_way: dict[str, tuple[Dispatch, Coroutine[float, None, OperationResult], float]] = {}
        press = draw.randint(1, 400) if not self.chaos.healed and draw.random() < 0.5 else 0
        try:
            while True:
                self.chaos.point()
                for dispatch in executor.due():
                    self._begin(dispatch, attempts, under_way)
                if not under_way:
                    break
                self.steps += 1
                if self.steps > STEPS * (1 + self.applies):
                    raise Violation("I10: the run does not end")
                press -= 1
                if press == 0:
                    executor.interrupt()
                    truth.may_start = False
                self._step(executor, attempts, under_way)
        except Crash:
            for _, work, _ in under_way.values():
                work.close()
            if under_way and draw.random() < 0.5:
                self.late = [(attempts, entry[0]) for entry in under_way.values()]
            raise
        self._check_run(executor)

    def _begin(self, dispatch: Dispatch, attempts: Attempts, under_way: dict[str, Any]) -> None:
        if not self.truth.may_start:
            raise Violation(f"{dispatch.key} is dispatched after the run was interrupted or failed for good")
        known = attempts.known(dispatch.operation, dispatch.key)
        work = attempts.perform(dispatch.operation, dispatch.key) if known is None else at_once(known)
        under_way[dispatch.key] = (dispatch, work, self.truth.now)

    def _step(self, executor: Executor, attempts: Attempts, under_way: dict[str, Any]) -> None:
        draw, truth = self.chaos.random, self.truth
        first = min(due for _, _, due in under_way.values())
        key = draw.choice([k for k, (_, _, due) in under_way.items() if due <= first + 0.5])
        dispatch, work, due = under_way[key]
        truth.now = max(truth.now, due)
        try:
            under_way[key] = (dispatch, work, truth.now + work.send(None))
            return
        except StopIteration as stop:
            result: OperationResult = stop.value
        del under_way[key]
        self._check_result(dispatch, result)
        self.chaos.point()
        after = executor.over(dispatch, result)
        if draw.random() < 0.1:
            self._again(attempts, dispatch)
        if result.outcome != "done" and after.again is None and executor.stop_on_error:
            truth.may_start = False
        if after.again is not None:
            self._begin(after.again, attempts, under_way)

    def _check_result(self, dispatch: Dispatch, result: OperationResult) -> None:
        ends = [r[0] for r in self.truth.sql("SELECT kind FROM records WHERE key = ? AND phase = 2", dispatch.key)]
        if ends != [result.outcome]:
            raise Violation(f"I6: {dispatch.key} is told as {result.outcome}, written as {ends}")
        op, primitive = dispatch.operation, dispatch.operation.primitive
        if primitive != "park" and result.outcome == "done" and not self.truth.holds(op):
            raise Violation(f"{dispatch.key} is told as done, and is not")

    def _check_run(self, executor: Executor) -> None:
        left = executor.graph.waiting()
        if left and not (executor.interrupted or executor.broken):
            raise Violation(f"the run ends and nobody decided on {[op.id for op in left]}")
        if executor.broken and not executor.stop_on_error:
            raise Violation("siblings of a failure do not finish")

    def _check_end(self) -> None:
        wrong = [n for n in PARTS if not _is_there(self.truth.poses[n], self.goal.poses[n])]
        wrong += [n for n, angle in self.goal.angles.items() if self.truth.angles[n] != angle]
        if wrong or any(self.truth.hands.values()) or (self.goal.glue and not self.truth.glued):
            raise Violation(f"the goal is said to be reached, and {wrong} are not there")


@types.coroutine
def stepped(work: Generator[float, None, OperationResult]) -> Generator[float, None, OperationResult]:
    """Let who drives a coroutine resume what it waits for: it gets the seconds until then."""
    return (yield from work)


async def at_once(result: OperationResult) -> OperationResult:
    def now() -> Generator[float, None, OperationResult]:
        yield 0.0
        return result

    return await stepped(now())


@dataclass(frozen=True)
class Toy:
    """The truth as a device; it stands still until who drives it resumes it."""

    truth: Truth

    async def execute(self, operation: Operation, key: str, began: Began) -> OperationResult:
        return await stepped(attempt(self.truth, operation, key, began))


def histories(first: int, count: int) -> Iterator[tuple[int, Chaos | Exception]]:
    """Yield the seed of each history, and its chaos once it is over or why it is wrong."""
    for seed in range(first, first + count):
        try:
            yield seed, History(seed).live()
        except (Violation, PicoError, LookupError, TypeError, ValueError, AttributeError, AssertionError) as exc:
            yield seed, exc
