"""A bench of stand-ins for instruments: what is moved, in which order, and what is said where one of them fails."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from bench_at import bench_at
from emulated_lab import wired_lab

from pico.backends import ways
from pico.backends.by_sight import BySight
from pico.backends.hardware.instruments import Instruments
from pico.backends.hardware.session import HardwareSession
from pico.backends.hardware.settings import Settings
from pico.backends.hardware.walking import Way
from pico.backends.last_seen import Taken
from pico.diagnostics import ExitCode, PicoError, error
from pico.drivers.driven import Motorized, Shut
from pico.drivers.protocols import ArmState, Grip, SafetyState
from pico.model import primitive
from pico.model.instruments.conversion import conversion
from pico.model.observation import Observation, ObservedComponent, ObservedRobot, ObservedValue
from pico.model.operation import Operation, OperationResult, Reason
from pico.model.pose import Pose
from pico.model.primitive import Primitive
from pico.model.quantities import Value
from pico.model.record import as_json
from pico.model.setup import Setup
from pico.model.wiring import SafetyEntry, Wired
from pico.motion.arms import ArmMotion
from pico.motion.kinematics import tool_of
from pico.motion.types import Blocked, MovePath, Segment, Waypoint
from pico.planning import routines
from pico.planning.routines import Routine
from pico.twin.arms import TwinArm

SLOT, GOAL = "storage/a3", Pose(395, 420, 0)
ASKED = Reason(kind="asked")


class Bench:
    """Everything that is told to instruments, in order; and the table as cameras would see it."""

    def __init__(self, setup: Setup) -> None:
        self.setup, self.said = setup, list[str]()
        self.joints = setup.lab.robots["arm1"].park_joints
        self.width, self.holding = 84.0, False
        self.at = setup.lab.slots[SLOT].pose
        self.fails: dict[int, str] = {}
        """By the number of a leg, what the arm says there."""
        self.legs, self.stopped, self.halted = 0, False, False
        self.misses, self.lost = False, ""
        self.loads = list[tuple[int, float]]()
        """What the arm was told that its hand carries [kg], after how many legs."""
        self.under_way = asyncio.Event()
        self.slow = False

    # the arm

    async def follow(self, times: np.ndarray, joints: np.ndarray, *, doing: str = "") -> ArmState:
        self.legs += 1
        self.said.append(f"follow {doing}")
        self.under_way.set()
        if self.legs in self.fails:
            raise PicoError(error("arm-fault", self.fails[self.legs], address="arm1"))
        for _ in range(100 if self.slow else 1):
            await asyncio.sleep(0.001)
            if self.stopped or self.halted:
                self.halted = False
                raise PicoError(error("device-stopped", "arm1 was stopped", address="arm1"))
        self.joints = tuple(float(q) for q in joints[-1])
        self.seconds = float(times[-1])
        return await self.state()

    async def state(self) -> ArmState:
        return ArmState(joints=self.joints, age=0.0, moving=False, enabled=True, lost=self.lost)

    async def carry(self, mass: float, center: tuple[float, float, float]) -> None:
        self.loads.append((self.legs, mass))

    async def halt(self) -> None:
        self.said.append("halt")
        self.halted = True

    async def stop(self) -> None:
        self.said.append("stop")
        self.stopped = True

    # the gripper

    async def move_to(self, width: float, *, force: float | None = None) -> Grip:
        self.said.append(f"fingers {width:g}")
        grasp = self.setup.type_of("lx_125").geometry.grasp
        assert grasp is not None
        tool = tool_of(self.setup.lab.robots["arm1"], self.joints)
        if width < grasp.width and tool.distance(self.at) < 1 and not self.misses:
            self.holding = True
        elif width > grasp.width and self.holding:
            self.holding, self.at = False, tool
        self.width = max(width, grasp.width) if self.holding else width
        return await self.grip()

    async def grip(self) -> Grip:
        return Grip(width=self.width, holds=self.holding)

    # the cameras

    def seen(self, taken: Mapping[str, Taken]) -> Observation:
        parts = {"lx_125": ObservedComponent(pose=self.at, how="stereo"),
                 "laser": ObservedComponent(values={"shutter": ObservedValue(value="closed")}),
                 "p1": ObservedComponent(pose=Pose(110, 220, 0), how="stereo")}  # fmt: skip
        robot = ObservedRobot(joints=self.joints, holding="lx_125" if self.holding else None, opening=self.width)
        if self.holding:
            pose = tool_of(self.setup.lab.robots["arm1"], self.joints)
            parts["lx_125"] = ObservedComponent(presence="held", pose=pose, how="gripper")
        return Observation(backend="hardware", components=parts, robots={"arm1": robot})


class Known(BySight):
    """What is known of the bench, without any pictures."""

    def __init__(self, bench: Bench) -> None:
        self.bench = bench

    def seen(self) -> Observation:
        return self.bench.seen({})

    def survey(self, component: str) -> Pose | None:
        return self.seen().components[component].pose

    def takes(self, component: str, path: Any) -> None:
        """Nothing is kept."""

    def lets_go(self, component: str, path: Any, now: float) -> None:
        self.bench.said.append(f"lets go of {component}")

    def confirm(self, component: str, near: Pose) -> ObservedComponent:
        return self.seen().components[component]

    def find(self, component: str) -> ObservedComponent:
        return self.seen().components[component]


class Axis:
    """An axis that may come to rest elsewhere."""

    def __init__(self, at: float | None = 0.0, off: float = 0.0) -> None:
        self.at, self.off, self.told = at, off, list[str]()

    async def position(self) -> float | None:
        return self.at

    async def move_to(self, position: float) -> float:
        self.told.append(f"to {position:g}")
        self.at = position + self.off
        return self.at

    async def home(self) -> float:
        self.told.append("home")
        self.at = 0.0
        return self.at

    async def stop(self) -> None:
        self.told.append("stop")


class Shutter:
    def __init__(self) -> None:
        self.told = list[bool]()

    async def open(self, wanted: bool) -> bool:
        self.told.append(wanted)
        return wanted

    async def is_open(self) -> bool | None:
        return False


@pytest.fixture
def setup(tmp_path: Path) -> Setup:
    return wired_lab(tmp_path)


class Curtain:
    """A curtain that somebody may come through, once so many legs were gone."""

    def __init__(self, bench: Bench, *, safe: bool | None = True, age: float = 0.0, until: int = 99) -> None:
        self.bench, self.safe, self.age, self.until = bench, safe, age, until

    async def read(self) -> SafetyState:
        return SafetyState(safe=self.safe and self.bench.legs < self.until, age=self.age)


def session(
    bench: Bench, axis: Axis | None = None, untried: frozenset[str] = frozenset(), curtain: Curtain | None = None,
    keep: Callable[[str, Value | None], None] = lambda *_: None, require: Callable[[], None] = lambda: None,
    known: Known | None = None,
) -> HardwareSession:  # fmt: skip
    instruments = Instruments()
    if curtain is not None:
        instruments.inputs["curtain"] = SafetyEntry(kind="curtain", device="box"), curtain  # type: ignore[assignment]
    instruments.arms["arm1"] = instruments.grippers["arm1"] = bench  # type: ignore[assignment]
    shutter = bench.shutter = Shutter()  # type: ignore[attr-defined]
    instruments.tunables["laser.shutter"] = Shut(shutter)  # type: ignore[arg-type]
    if axis is not None:
        instruments.tunables["p1.angle"] = Motorized(axis, conversion(Wired(property="angle"), "deg", "deg"))  # type: ignore[arg-type]

    async def none(*_: Any) -> Any:
        return None

    arms = {"arm1": TwinArm(bench.setup.lab.robots["arm1"])}
    return HardwareSession(
        bench.setup, instruments, known or Known(bench), motion=ArmMotion(bench.setup), arms=arms,
        tell=lambda event: None,
        now=lambda: 0.0, pause=none, measure=none, image=none, keep=keep, untried=untried,
        require=require,
    )  # fmt: skip


def move() -> Operation:
    start = {"pose": as_json(Pose(290, 310, 0)), "slot": SLOT}
    arguments = {"from": start, "to": {"pose": as_json(GOAL)}, "grasp_yaw": 0.0}
    return Operation(id="op3", primitive="move", component="lx_125", robot="arm1", arguments=arguments, reason=ASKED)


def setting(value: float, primitive: str = "set") -> Operation:
    arguments = {"tunable": "angle", "to": value}
    return Operation(id="op1", primitive=primitive, component="p1", arguments=arguments, reason=ASKED)


def executed(one: HardwareSession, operation: Operation) -> OperationResult:
    return asyncio.run(one.execute(operation, f"run/{operation.id}/1", lambda before: None))


def test_a_part_is_picked_carried_and_put_down_and_seen_where_it_should_be(setup: Setup) -> None:
    bench = Bench(setup)
    result = executed(session(bench), move())
    assert (result.outcome, result.error) == ("done", None)
    assert bench.at.distance(GOAL) < 1e-6 and result.data["error_mm"] < 1e-6
    words = [said.partition(" ")[0] for said in bench.said]
    grip = next(i for i, said in enumerate(bench.said) if said == "fingers 30")
    assert words[grip - 1] == "follow" and words[grip + 1 : grip + 4] == ["follow"] * 3
    assert bench.said.count("follow op3: move lx_125") == bench.legs == 6
    let_go = bench.said.index("lets go of lx_125")
    assert bench.said[let_go + 1] == "fingers 54" and let_go > grip, "that is kept while it still holds it"
    assert bench.loads == [(2, setup.type_of("lx_125").geometry.mass), (5, 0.0)], "from the grip to the release"


class Noting(Known):
    """Notes what is asked of it, and sees the shutter of the laser as it is told."""

    def __init__(self, bench: Bench, shutter: ObservedValue | None = None) -> None:
        super().__init__(bench)
        self.shutter, self.asked = shutter, list[tuple[str, str, int]]()

    def seen(self) -> Observation:
        seen = super().seen()
        if self.shutter is None:
            return seen
        laser = replace(seen.components["laser"], values={"shutter": self.shutter})
        return replace(seen, components={**seen.components, "laser": laser})

    def survey(self, component: str) -> Pose | None:
        self.asked.append(("survey", component, self.bench.legs))
        return super().survey(component)

    def takes(self, component: str, path: Any) -> None:
        self.asked.append(("takes", component, self.bench.legs))


@pytest.mark.parametrize("allowed", [True, False])
@pytest.mark.parametrize(("value", "status"), [
    ("open", "known"), ("closed", "known"), ("closed", "commanded"), (None, "unknown"), ("ajar", "known"),
])  # fmt: skip
def test_no_arm_carries_in_a_beam_whose_shutter_was_not_read_back_closed(
    setup: Setup, allowed: bool, value: Any, status: Any
) -> None:
    setup = replace(setup, lab=replace(setup.lab, policy=replace(setup.lab.policy, open_beam=allowed)))
    bench = Bench(setup)
    result = executed(session(bench, known=Noting(bench, ObservedValue(value=value, status=status))), move())
    dark = value == "closed" and status == "known"
    if allowed or dark:
        assert result.outcome == "done" and bench.legs == 6
    else:
        assert result.error is not None and result.error.code == "open-beam" and result.error.address == "laser"
        assert bench.said == [] and bench.legs == 0


@pytest.mark.parametrize("held", [True, False])
def test_a_part_is_looked_at_right_before_it_is_picked_and_kept_as_taken_before_the_arm_moves(
    setup: Setup, held: bool
) -> None:
    bench, operation = Bench(setup), move()
    if held:
        bench.holding, bench.width = True, 34.0
        start = {**operation.arguments["from"], "held": True}
        operation = replace(operation, arguments={**operation.arguments, "from": start})
    known = Noting(bench)
    executed(session(bench, known=known), operation)
    assert known.asked == ([] if held else [("survey", "lx_125", 0)]) + [("takes", "lx_125", 0)]


def test_where_no_way_is_found_nothing_moves_and_what_is_in_the_way_is_told(
    setup: Setup, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(ways, "carrying", lambda *_: (Pose(290, 310, 0), Blocked("reach", "p1 stands in the way")))
    bench = Bench(setup)
    known = Noting(bench)
    result = executed(session(bench, known=known), move())
    assert result.outcome == "failed" and result.error is not None
    assert result.error.address == "lx_125" and bench.said == []
    assert known.asked == [("survey", "lx_125", 0)], "it is not kept as taken"


def test_an_arm_that_was_lost_moves_nothing_before_it_is_got_ready_again(setup: Setup) -> None:
    bench = Bench(setup)
    bench.lost = "the control box reported nothing for 0.8 s"
    result = executed(session(bench), move())
    assert result.outcome == "failed" and result.error is not None
    assert result.error.summary.startswith("op3, move of lx_125, failed: arm1 was lost, for the control box reported")
    assert bench.said == [], "not even its fingers"


def test_a_tool_is_used_as_a_plug_in_says_and_what_that_commands_is_unknown_meanwhile(
    setup: Setup, monkeypatch: pytest.MonkeyPatch
) -> None:
    over = Waypoint(Pose(110, 220, 0), 146.0, 60.0)
    asked = Primitive(name="turn", by="arm", changes="anything")
    monkeypatch.setattr(primitive, "plugged_in", lambda: {"turn": asked})
    routine = Routine(tool="lx_125", points=(over,), commands={"angle": 30.0})
    monkeypatch.setattr(routines, "plugged_in", lambda: {"turn": lambda *_: routine})
    bench, kept = Bench(setup), list[tuple[str, Any]]()
    home = bench.at

    def keep(address: str, value: Value | None) -> None:
        kept.append((address, value if bench.legs else "nothing yet" if value is None else value))

    turn = Operation(id="op1", primitive="turn", component="p1", robot="arm1", reason=ASKED)
    result = executed(session(bench, keep=keep), turn)
    assert (result.outcome, result.error) == ("done", None)
    assert kept == [("p1.angle", "nothing yet"), ("p1.angle", 30.0)]
    assert not bench.holding and bench.at.distance(home) < 1e-6 and bench.said.count("fingers 30") == 1
    kept.clear()
    bench.legs, bench.fails = 0, {5: "arm1 reports C31, a collision"}
    assert executed(session(bench, keep=keep), turn).outcome == "failed"
    assert kept == [("p1.angle", "nothing yet")], "nobody knows how far it was turned"


def test_fingers_that_close_on_nothing_have_missed_and_the_arm_withdraws(setup: Setup) -> None:
    bench = Bench(setup)
    bench.misses = True
    result = executed(session(bench), move())
    assert result.outcome == "failed" and result.error is not None
    assert result.error.code == "missed-grasp" and "arm1 missed lx_125" in result.error.summary
    assert "it stands at" in result.error.summary
    assert setup.lab.robots["arm1"].is_parked(bench.joints)


def test_a_part_that_is_lost_on_the_way_is_told_as_dropped(setup: Setup) -> None:
    bench = Bench(setup)

    async def grip() -> Grip:
        if bench.legs >= 4:  # in the transit
            bench.holding, bench.width = False, 10.0
        return Grip(width=bench.width, holds=bench.holding)

    bench.grip = grip  # type: ignore[method-assign]
    result = executed(session(bench), move())
    assert result.error is not None and result.error.code == "dropped"


def test_a_part_that_fell_is_looked_for_and_so_is_what_it_pushed(setup: Setup) -> None:
    bench = Bench(setup)

    class Fell(Known):
        """The part fell between its places, beside another one."""

        def seen(self) -> Observation:
            seen = super().seen()
            there = seen.components["p1"]
            assert there.pose is not None
            by = 3.0 if bench.legs >= 4 else 0.0
            shoved = replace(there, pose=Pose(there.pose.x + by, there.pose.y, there.pose.yaw))
            return replace(seen, components={**seen.components, "p1": shoved})

        def confirm(self, component: str, near: Pose) -> ObservedComponent:
            return ObservedComponent(pose=near, how="placed")  # hidden by the arm, which proves nothing

        def find(self, component: str) -> ObservedComponent:
            assert setup.lab.robots["arm1"].is_parked(bench.joints), "the arm would hide it"
            return self.seen().components[component]

    async def grip() -> Grip:
        if bench.legs >= 4 and bench.holding:  # in the transit
            bench.holding, bench.width, bench.at = False, 10.0, Pose(350.0, 360.0, 2.0)
        return Grip(width=bench.width, holds=bench.holding)

    bench.grip = grip  # type: ignore[method-assign]
    result = executed(session(bench, known=Fell(bench)), move())
    assert result.error is not None and result.after is not None
    assert "it stands at (350, 360, 2°); it moved p1 by 3.0 mm" in result.error.summary
    assert result.after.pose == Pose(350.0, 360.0, 2.0) and set(result.data["pushed"]) == {"p1"}


@pytest.mark.parametrize(("leg", "name"), [(1, "approach"), (2, "descend"), (3, "lift"), (4, "transit"), (5, "lower")])
def test_a_fault_of_the_arm_is_told_with_component_operation_and_leg(setup: Setup, leg: int, name: str) -> None:
    bench = Bench(setup)
    bench.fails[leg] = "arm1 reports C31, a collision"
    result = executed(session(bench), move())
    assert result.outcome == "failed" and result.error is not None
    assert result.error.summary == f"op3, move of lx_125, failed ({name}): arm1 reports C31, a collision"
    assert (result.error.code, result.error.address) == ("arm-fault", "lx_125")
    assert bench.legs == leg, "nothing moves after a fault"


def test_nothing_moves_after_a_stop_and_the_shutter_closes(setup: Setup) -> None:
    bench = Bench(setup)
    bench.slow = True

    async def stopped() -> tuple[OperationResult, int]:
        one = session(bench)
        going = asyncio.create_task(one.execute(move(), "run/op3/1", lambda before: None))
        await bench.under_way.wait()
        await one.stop()
        legs = bench.legs
        with pytest.raises(PicoError, match="stopped"):
            await one.execute(replace(move(), id="op4"), "run/op4/1", lambda before: None)
        return await going, legs

    result, legs = asyncio.run(stopped())
    assert result.error is not None and result.error.code == "stopped"
    assert bench.legs == legs == 1 and "stop" in bench.said
    assert not [said for said in bench.said[bench.said.index("stop") :] if said.startswith(("follow", "fingers"))]
    assert bench.shutter.told == [False]  # type: ignore[attr-defined]


def test_an_arm_that_is_halted_before_it_gripped_leaves_the_part_and_parks(setup: Setup) -> None:
    bench = Bench(setup)
    bench.slow = True

    async def halted() -> OperationResult:
        one = session(bench)
        going = asyncio.create_task(one.execute(move(), "run/op3/1", lambda before: None))
        await bench.under_way.wait()
        await one.halt()
        return await going

    result = asyncio.run(halted())
    assert result.error is not None and result.error.code == "put-back"
    assert "left where it stands" in result.error.summary
    assert setup.lab.robots["arm1"].is_parked(bench.joints) and not bench.holding


@pytest.mark.parametrize(
    ("legs", "ends"), [(0, "left"), (1, "left"), (2, "left"), (3, "put back"), (4, "goal"), (5, "goal")]
)
def test_what_goes_on_when_its_lease_is_over_comes_to_its_safe_end_though_nobody_halts_it(
    setup: Setup, legs: int, ends: str
) -> None:
    """As an edge that was frozen meanwhile: nothing more is gripped, and what is in the hand is set down."""
    bench = Bench(setup)

    def require() -> None:
        if bench.legs >= legs:
            raise PicoError(error("lease", "the lease 1 is over"))

    result, home = executed(session(bench, require=require), move()), setup.lab.slots[SLOT].pose
    assert not bench.holding and ("fingers 30" in bench.said) is (ends != "left")
    if ends == "goal":
        assert result.outcome == "done" and bench.at.distance(GOAL) < 1e-6
    else:
        assert result.error is not None and result.error.code == "put-back" and bench.at.distance(home) < 1e-6
        assert ends != "left" or setup.lab.robots["arm1"].is_parked(bench.joints)


def test_no_axis_begins_to_turn_when_its_lease_is_over(setup: Setup) -> None:
    bench, axis = Bench(setup), Axis()

    def require() -> None:
        raise PicoError(error("lease", "the lease 1 is over"))

    result = executed(session(bench, axis, require=require), setting(30.0))
    assert result.outcome == "failed" and result.error is not None and "lease 1 is over" in str(result.error)
    assert not axis.told


@pytest.mark.parametrize(("leg", "ends"), [(3, "put back"), (5, "goal")])
def test_a_part_in_the_hand_of_an_arm_that_is_halted_goes_wherever_is_nearer(setup: Setup, leg: int, ends: str) -> None:
    bench = Bench(setup)
    bench.slow = True

    async def halted() -> OperationResult:
        one = session(bench)
        going = asyncio.create_task(one.execute(move(), "run/op3/1", lambda before: None))
        while bench.legs < leg:
            await asyncio.sleep(0.001)
        await one.halt()
        return await going

    result, home = asyncio.run(halted()), setup.lab.slots[SLOT].pose
    assert not bench.holding and "halt" not in bench.said, "a part in the hand is not stopped over the table"
    if ends == "goal":
        assert result.outcome == "done" and bench.at.distance(GOAL) < 1e-6
    else:
        assert result.error is not None and result.error.code == "put-back" and SLOT in result.error.summary
        assert bench.at.distance(home) < 1e-6


@pytest.mark.parametrize(
    ("safe", "age", "why"),
    [(False, 0.0, "is not safe"), (None, 0.0, "is not known to be safe"), (True, 2.0, "was last heard 2.0 s ago")],
)
def test_no_arm_moves_while_a_curtain_is_not_known_to_be_safe(
    setup: Setup, safe: bool | None, age: float, why: str
) -> None:
    bench = Bench(setup)
    result = executed(session(bench, curtain=Curtain(bench, safe=safe, age=age)), move())
    assert result.error is not None and result.error.code == "unsafe"
    assert result.error.summary == f"curtain (curtain) {why}" and bench.legs == 0
    axis = Axis()
    set_ = executed(session(bench, axis, curtain=Curtain(bench, safe=safe, age=age)), setting(5.0))
    assert set_.outcome == "done", "a mount harms nobody"


def test_all_stops_and_is_shut_where_somebody_comes_through_the_curtain(setup: Setup) -> None:
    bench = Bench(setup)
    bench.slow = True
    one = session(bench, curtain=Curtain(bench, until=3))

    async def twice() -> tuple[OperationResult, OperationResult | str]:
        first = await one.execute(move(), "run/op3/1", lambda before: None)
        try:
            return first, await one.execute(replace(move(), id="op4"), "run/op4/1", lambda before: None)
        except PicoError as exc:
            return first, str(exc)

    first, second = asyncio.run(twice())
    assert first.error is not None and first.error.summary == "curtain (curtain) is not safe"
    assert bench.legs == 3 and bench.said[-1] == "stop" and "stopped" in str(second)
    assert bench.holding and bench.shutter.told == [False]  # type: ignore[attr-defined]


def test_an_arm_whose_driver_was_never_tried_makes_one_slow_motion_at_a_time(setup: Setup) -> None:
    quick, bench = Bench(setup), Bench(setup)
    executed(session(quick), move())
    one = session(bench, untried=frozenset({"arm1"}))

    async def twice() -> tuple[OperationResult, PicoError]:
        first = await one.execute(move(), "run/op3/1", lambda before: None)
        park = Operation(id="op4", primitive="park", component="arm1", robot="arm1", reason=ASKED)
        with pytest.raises(PicoError) as second:
            await one.execute(park, "run/op4/1", lambda before: pytest.fail("it is not begun"))
        return first, second.value

    first, second = asyncio.run(twice())
    assert first.outcome == "done" and bench.seconds == pytest.approx(20 * quick.seconds)
    assert second.diagnostics[0].code == "first-motion" and second.exit_code == ExitCode.INTERRUPTED


def test_an_axis_is_homed_first_where_nobody_knows_where_it_is_and_read_back(setup: Setup) -> None:
    axis = Axis(None)
    result = executed(session(Bench(setup), axis), setting(45.0))
    assert (result.outcome, result.data, axis.told) == ("done", {"value": 45.0}, ["home", "to 45"])


def test_an_axis_that_reads_elsewhere_has_failed_by_component_and_operation(setup: Setup) -> None:
    result = executed(session(Bench(setup), Axis(off=3.0)), setting(45.0))
    assert result.error is not None
    assert result.error.summary == "op1, set of p1.angle, failed: it reads 48.0, not 45.0 deg"
    refused = executed(session(Bench(setup), Axis()), setting(500.0))
    assert refused.error is not None and refused.error.code == "range"
    unwired = executed(session(Bench(setup)), setting(45.0))
    assert unwired.error is not None and unwired.error.code == "no-device"


def test_what_cameras_were_told_is_kept_where_the_bench_is(tmp_path: Path) -> None:
    assert Settings(bench_at(tmp_path, "hardware")).get("cam.exposure", 0.02) == 0.02
    Settings(bench_at(tmp_path, "hardware")).put("cam.exposure", 5.0)
    assert Settings(bench_at(tmp_path, "hardware")).get("cam.exposure", 0.02) == 5.0
    assert Settings(bench_at(tmp_path, "emulated")).get("cam.exposure", 0.02) == 0.02


def test_a_leg_that_ends_where_it_begins_is_not_gone(setup: Setup) -> None:
    """A hand that was left just where the lift ends, as after a fault, must still get rid of what it holds."""
    bench = Bench(setup)
    park = setup.lab.robots["arm1"].park_joints
    path = MovePath("arm1", "lx_125", (Segment("lift", (0.0, 0.0), (park, park), 84.0),))

    async def asked(stage: object) -> None:
        """Nothing is asked."""

    way = Way(setup, move(), path, bench, None, TwinArm(setup.lab.robots["arm1"]), asked)  # type: ignore[arg-type]
    asyncio.run(way.walk())
    assert bench.legs == 0
