"""What a real bench does about light: which safety inputs count for what, what closes, what stops short of a goal."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from bench_at import bench_at
from laser_lab import bench, carry, observed, search, set_to, with_type

from pico.backends.attempt import Failed
from pico.backends.hardware import guarding
from pico.backends.hardware.guard.verdict import Cause, Trip
from pico.backends.hardware.guarding import concerned, require_safe, tripped, until_tripped
from pico.backends.hardware.instruments import Instruments
from pico.backends.hardware.session import HardwareSession
from pico.backends.hardware.setting import driven
from pico.backends.hardware.settings import Settings
from pico.diagnostics import ExitCode, PicoError, error
from pico.drivers.driven import UNKNOWN, Emitting, Exposed, Lit, Motorized, Shut
from pico.drivers.protocols import SafetyState
from pico.model.catalog import Axis as AxisOf
from pico.model.catalog import Tunable
from pico.model.instruments.conversion import conversion
from pico.model.observation import ObservedValue
from pico.model.operation import Operation, OperationResult, Reason
from pico.model.setup import Setup
from pico.model.wiring import SafetyEntry, Wired

SETUP = bench()
KINDS = ("door", "curtain", "emergency_stop", "key", "interlock", "shutter", "presence")
ARM, LIGHT = {"door", "curtain", "emergency_stop"}, {"door", "emergency_stop", "key", "interlock"}


def park(robot: str | None = "arm1") -> Operation:
    return Operation(id="p", primitive="park", component="arm1", robot=robot, reason=Reason(kind="parked"))


@pytest.mark.parametrize(("operation", "arm", "light"), [
    (carry("holder", 700, 300), True, False), (park(), True, False), (park(None), True, False),
    (set_to("laser", "shutter", "open"), False, True), (set_to("laser", "shutter", "closed"), False, False),
    (set_to("laser", "emission", True), False, True), (set_to("laser", "emission", False), False, False),
    (set_to("laser", "power", 3.0), False, True), (set_to("gate", "shutter", "open"), False, True),
    (set_to("cam", "exposure", 3.0), False, False), (search({"laser.power": (1, 2)}), False, True),
    (search({"cam.exposure": (1, 2)}), False, False),
    (replace(set_to("laser", "shutter", "open"), robot="arm1"), True, True),
    (Operation(id="m", primitive="measure", component="cam", reason=Reason(kind="asked")), False, False),
])  # fmt: skip
def test_arms_ask_doors_and_curtains_and_light_asks_doors_and_interlocks(
    operation: Operation, arm: bool, light: bool
) -> None:
    assert concerned(SETUP, operation) == (ARM if arm else set()) | (LIGHT if light else set())


class Input:
    """A safety input that tells what it is told to, or fails."""

    def __init__(self, safe: bool | None = True, age: float = 0.0, fails: BaseException | None = None) -> None:
        self.state, self.fails, self.asked = SafetyState(safe=safe, age=age), fails, 0

    async def read(self) -> SafetyState:
        self.asked += 1
        if self.fails:
            raise self.fails
        return self.state


def inputs(one: Input, kind: Any = "door", heartbeat: float = 0.5) -> Any:
    return {"it": (SafetyEntry(kind=kind, device="box", heartbeat=heartbeat), one)}


@pytest.mark.parametrize("safe", [True, False, None])
@pytest.mark.parametrize("age", [0.0, 0.5, 0.51, float("inf")])
@pytest.mark.parametrize("fails", [False, True])
@pytest.mark.parametrize("heartbeat", [0.5, 2.0])
def test_only_what_was_heard_to_be_safe_just_now_is_safe(
    safe: bool | None, age: float, fails: bool, heartbeat: float
) -> None:
    one = Input(safe, age, PicoError(error("device-lost", "its cable is out")) if fails else None)
    found = asyncio.run(tripped(inputs(one, heartbeat=heartbeat), {"door"}))
    fine = not fails and safe is True and age <= heartbeat
    assert (found is None) is fine
    if found is not None:
        why = ("can't be read: its cable is out" if fails else "is not known to be safe" if safe is None
               else "is not safe" if not safe else f"was last heard {age:.1f} s ago")  # fmt: skip
        assert (found.code, found.severity, found.address, found.summary) == (
            "unsafe", "error", "it", f"it (door) {why}"
        )  # fmt: skip
        with pytest.raises(Failed, match="door"):
            asyncio.run(require_safe(inputs(one, heartbeat=heartbeat), {"door"}))
    else:
        asyncio.run(require_safe(inputs(one, heartbeat=heartbeat), {"door"}))


@pytest.mark.parametrize("kind", ["door", "curtain", "emergency_stop", "key", "interlock"])
@pytest.mark.parametrize("asked", [ARM, LIGHT, set()])
def test_only_inputs_of_the_kinds_that_count_are_asked(kind: str, asked: set[Any]) -> None:
    one = Input(False)
    assert (asyncio.run(tripped(inputs(one, kind), asked)) is not None) is (kind in asked) is bool(one.asked)


def test_a_fault_of_the_program_is_no_safe_input_and_every_input_counts() -> None:
    with pytest.raises(ZeroDivisionError):
        asyncio.run(tripped(inputs(Input(fails=ZeroDivisionError())), {"door"}))
    both = {
        "a": (SafetyEntry(kind="door", device="x"), Input()),
        "b": (SafetyEntry(kind="key", device="y"), Input(False)),
    }
    found = asyncio.run(tripped(both, {"door", "key"}))  # type: ignore[arg-type]
    assert found is not None and found.address == "b" and "b (key)" in found.summary
    assert asyncio.run(tripped({}, {"door"})) is None


def test_inputs_are_asked_again_and_again_until_one_trips(monkeypatch: pytest.MonkeyPatch) -> None:
    assert guarding.EVERY <= 0.1
    monkeypatch.setattr(guarding, "EVERY", 0.0)
    one = Input()

    async def later() -> Any:
        waiting = asyncio.create_task(until_tripped(inputs(one), frozenset({"door"})))
        while one.asked < 4 and not waiting.done():
            await asyncio.sleep(0)
        assert not waiting.done()
        one.state = SafetyState(safe=False, age=0.0)
        return await asyncio.wait_for(waiting, 5)

    assert asyncio.run(later()).address == "it"


# what sets and reads a tunable


class Device:
    """Every instrument at once: does what it is told, off by so much, and tells what it knows."""

    def __init__(self, is_: Any = None, off: float = 0.0, answers: Any = ...) -> None:
        self.is_, self.off, self.answers, self.told = is_, off, answers, list[Any]()

    def _now(self, wanted: Any) -> Any:
        self.told.append(wanted)
        self.is_ = wanted if self.answers is ... else self.answers
        return self.is_

    async def open(self, wanted: bool) -> Any:
        return self._now(wanted)

    async def emit(self, on: bool) -> Any:
        return self._now(on)

    async def shine(self, on: bool) -> Any:
        return self._now(on)

    async def move_to(self, position: float) -> float:
        self.told.append(position)
        self.is_ = position + self.off
        return self.is_

    async def home(self) -> float:
        self.told.append("home")
        self.is_ = 0.0
        return 0.0

    async def is_open(self) -> Any:
        return self.is_

    async def emitting(self) -> Any:
        return self.is_

    async def position(self) -> Any:
        return self.is_

    async def stop(self) -> None:
        self.told.append("stop")


@pytest.mark.parametrize(("reads", "value"), [(True, "open"), (False, "closed"), (None, None)])
def test_a_shutter_is_what_its_sensor_says(reads: Any, value: Any) -> None:
    found = asyncio.run(Shut(Device(reads)).read())  # type: ignore[arg-type]
    assert (found.value, found.status) == (value, "unknown" if reads is None else "known")


@pytest.mark.parametrize(("wanted", "told"), [("open", True), ("closed", False), ("ajar", False), (True, False),
                                              (None, False)])  # fmt: skip
@pytest.mark.parametrize("answers", [..., True, False])
def test_a_shutter_opens_only_for_the_word_and_tells_what_it_is_then(wanted: Any, told: bool, answers: Any) -> None:
    device = Device(answers=answers)
    became = asyncio.run(Shut(device).set(wanted))  # type: ignore[arg-type]
    assert device.told == [told] and became == ("open" if (told if answers is ... else answers) else "closed")


@pytest.mark.parametrize("reads", [True, False, None])
def test_a_laser_is_what_it_reports(reads: Any) -> None:
    found = asyncio.run(Emitting(Device(reads)).read())  # type: ignore[arg-type]
    assert (found.value, found.status) == (reads, "unknown" if reads is None else "known")


@pytest.mark.parametrize(("wanted", "told"), [(True, True), (False, False), (1, False), ("on", False), (None, False)])
@pytest.mark.parametrize("answers", [..., True, False])
def test_a_laser_emits_only_where_that_is_true(wanted: Any, told: bool, answers: Any) -> None:
    device = Device(answers=answers)
    assert asyncio.run(Emitting(device).set(wanted)) is (told if answers is ... else answers)  # type: ignore[arg-type]
    assert device.told == [told]


@pytest.mark.parametrize(("wanted", "told"), [(True, True), (False, False), (1, False), ("on", False)])
def test_a_lamp_is_as_it_was_told_last_and_unknown_at_first(tmp_path: Path, wanted: Any, told: bool) -> None:
    device = Device()
    lamp = Lit(device, Settings(bench_at(tmp_path, "hardware")), "room.illumination")  # type: ignore[arg-type]
    assert asyncio.run(lamp.read()).status == "unknown"
    assert asyncio.run(lamp.set(wanted)) is told and device.told == [told]
    again = Lit(device, Settings(bench_at(tmp_path, "hardware")), "room.illumination")  # type: ignore[arg-type]
    assert asyncio.run(again.read()).value is told
    Settings(bench_at(tmp_path, "hardware")).put("room.illumination", "dim")
    assert asyncio.run(again.read()).status == "unknown"


def test_an_axis_is_read_and_set_in_the_units_of_the_lab() -> None:
    axis = Device(None)
    one = Motorized(axis, conversion(Wired(property="angle", scale=2.0, offset=10.0), "deg", "deg"))  # type: ignore[arg-type]
    assert asyncio.run(one.read()).status == "unknown"
    assert asyncio.run(one.set(50.0)) == 50.0 and axis.told == [20.0]
    assert asyncio.run(one.read()).value == 50.0 and asyncio.run(one.home()) == 10.0


@pytest.mark.parametrize("first", [None, 3.0, 0.0])
def test_a_setting_of_a_camera_is_what_it_was_set_to_last_and_unknown_at_first(
    tmp_path: Path, first: float | None
) -> None:
    one = Exposed(Device(), Settings(bench_at(tmp_path, "hardware")), "cam.exposure", first)  # type: ignore[arg-type]
    assert asyncio.run(one.read()) == (UNKNOWN if first is None else ObservedValue(value=first))
    assert asyncio.run(one.set(5.0)) == 5.0 and asyncio.run(one.read()).value == 5.0


@pytest.mark.parametrize("one", [Shut, Emitting])
def test_only_axes_have_a_home_and_move(one: Any, tmp_path: Path) -> None:
    settings = Settings(bench_at(tmp_path, "hardware"))
    others = (one(Device()), Lit(Device(), settings, "a"), Exposed(Device(), settings, "b"))  # type: ignore[arg-type]
    for other in others:
        with pytest.raises(PicoError, match="no axis"):
            asyncio.run(other.home())
        assert not other.moves
    assert Motorized(Device(), conversion(Wired(property="angle"), "deg", "deg")).moves  # type: ignore[arg-type]


# what stops short of its goal


def turning(tolerance: float = 0.5, period: float | None = None, homed: bool = False) -> Setup:
    """The bench with an axis of its holder, 0 to 360 deg."""
    axis = AxisOf(kind="homed", speed=10.0) if homed else None
    kind = Tunable(
        unit="deg", range=(0.0, 360.0), tolerance=tolerance, mover="motor", period=period, settle=40.0, axis=axis
    )
    return with_type(SETUP, "holder", tunables={"angle": kind})


def drive(setup: Setup, device: Device, operation: Operation) -> tuple[Mapping[str, Any], list[float]]:
    paused = list[float]()

    async def pause(seconds: float) -> None:
        paused.append(seconds)

    wired = Instruments(tunables={"holder.angle": Motorized(device, conversion(Wired(property="angle"), "deg", "deg"))})  # type: ignore[arg-type]
    return asyncio.run(driven(setup, wired, operation, pause)), paused


@pytest.mark.parametrize("tolerance", [0.0, 0.5])
@pytest.mark.parametrize("off", [-90.0, -0.75, -0.5, -0.25, 0.0, 0.25, 0.5, 0.75, 90.0, 360.0])
@pytest.mark.parametrize("period", [None, 360.0])
def test_a_mount_that_comes_to_rest_beside_its_goal_has_failed_on_either_side(
    tolerance: float, off: float, period: float | None
) -> None:
    apart = abs(off) if period is None else min(abs(off) % 360, 360 - abs(off) % 360)
    device = Device(3.0, off=off)
    asked = set_to("holder", "angle", 128.0)
    if apart <= tolerance:
        found, paused = drive(turning(tolerance, period), device, asked)
        assert found == {"value": 128.0 + off} and paused == [0.04]
    else:
        with pytest.raises(Failed, match=rf"it reads {128.0 + off}, not 128.0 deg") as caught:
            drive(turning(tolerance, period), device, asked)
        assert caught.value.diagnostic.code == "not-reached" and "op1, set of holder.angle" in str(caught.value)
    assert device.told == [128.0]


@pytest.mark.parametrize("homed", [True, False])
@pytest.mark.parametrize("reads", [None, 3.0])
def test_an_axis_that_must_be_homed_is_where_nobody_knows_where_it_is(homed: bool, reads: float | None) -> None:
    device = Device(reads)
    drive(turning(homed=homed), device, set_to("holder", "angle", 20.0))
    assert device.told == (["home", 20.0] if homed and reads is None else [20.0])
    device = Device(reads)
    home = set_to("holder", "angle", None, primitive="home")
    assert drive(turning(homed=homed), device, home)[0] == {"value": 0.0} and device.told == ["home"]


@pytest.mark.parametrize("to", [-1.0, 361.0, "far", None, True])
def test_nothing_is_driven_beyond_its_range_or_without_a_device(to: Any) -> None:
    device = Device(3.0)
    with pytest.raises(Failed):
        drive(turning(), device, set_to("holder", "angle", to))
    with pytest.raises(Failed):
        drive(turning(), device, set_to("holder", "height", 3.0))
    assert device.told == []
    with pytest.raises(Failed, match=r"no device of this bench sets holder\.angle"):
        asyncio.run(driven(turning(), Instruments(), set_to("holder", "angle", 3.0), lambda s: asyncio.sleep(0)))


# what a session lets out, and what it closes


class Known:
    corrections = 0

    def seen(self) -> Any:
        return observed()


def session(
    door: Input | None = None, kind: Any = "interlock", require: Any = lambda: None, setup: Setup = SETUP,
    told: list[Any] | None = None,
) -> tuple[HardwareSession, dict[str, Device]]:  # fmt: skip
    devices = {name: Device(False) for name in ("laser.shutter", "laser.emission", "gate.shutter", "second.shutter")}
    wired = Instruments(tunables={
        address: (Shut if address.endswith("shutter") else Emitting)(one)  # type: ignore[arg-type]
        for address, one in devices.items()
    })  # fmt: skip
    if door is not None:
        wired.inputs["door"] = SafetyEntry(kind=kind, device="box"), door  # type: ignore[assignment]

    async def none(*_: Any) -> Any:
        return None

    made = HardwareSession(
        setup, wired, Known(), motion=None, arms={}, tell=told.append if told is not None else lambda event: None,
        now=lambda: 5.0, pause=none,  # type: ignore[arg-type]
        measure=none, image=none, keep=lambda *_: None, require=require,
    )  # fmt: skip
    return made, devices


def executed(one: HardwareSession, operation: Operation) -> OperationResult:
    return asyncio.run(one.execute(operation, f"run/{operation.id}/1", lambda before: None))


@pytest.mark.parametrize("kind", ["door", "curtain", "emergency_stop", "key", "interlock"])
@pytest.mark.parametrize("safe", [True, False, None])
@pytest.mark.parametrize("to", ["open", "closed"])
def test_no_light_is_let_out_where_an_input_is_not_safe_and_a_shutter_always_closes(
    kind: str, safe: bool | None, to: str
) -> None:
    one, devices = session(Input(safe), kind)
    result = executed(one, set_to("laser", "shutter", to))
    refused = to == "open" and kind != "curtain" and not safe
    assert (result.outcome, result.error.code if result.error else None) == (
        ("failed", "unsafe") if refused else ("done", None)
    )
    assert devices["laser.shutter"].told == ([] if refused else [to == "open"])


def test_every_shutter_closes_once_an_input_trips_and_nothing_is_done_then(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(guarding, "EVERY", 0.0)
    door = Input()
    one, devices = session(door)
    devices["laser.emission"].is_ = False

    switched = list[bool]()

    async def slow(wanted: bool) -> bool:
        door.state = SafetyState(safe=False, age=0.0)
        for _ in range(50):
            await asyncio.sleep(0)
        switched.append(wanted)
        return wanted

    monkeypatch.setattr(devices["laser.emission"], "emit", slow)

    async def both() -> tuple[OperationResult, str]:
        first = await one.execute(set_to("laser", "emission", True), "run/op1/1", lambda before: None)
        with pytest.raises(PicoError) as caught:
            await one.execute(set_to("laser", "shutter", "closed", "op2"), "run/op2/1", lambda before: None)
        return first, caught.value.diagnostics[0].code

    result, code = asyncio.run(both())
    assert code == "stopped" and result.outcome == "done", "it had been let out before"
    assert {n: d.told for n, d in devices.items() if n.endswith("shutter")} == {
        "laser.shutter": [False, False], "gate.shutter": [False, False], "second.shutter": [False, False]
    }  # fmt: skip
    assert switched[0] and not any(switched[1:]) and len(switched) > 1, "what came on meanwhile goes off again"


def test_a_stop_ends_all_light_though_one_shutter_fails() -> None:
    one, devices = session()

    async def broken(wanted: bool) -> bool:
        raise PicoError(error("device-lost", "its cable is out"))

    devices["laser.shutter"].open = broken  # type: ignore[method-assign]
    asyncio.run(one.stop())
    assert [devices[n].told for n in ("gate.shutter", "second.shutter", "laser.emission")] == [[False]] * 3
    with pytest.raises(PicoError) as caught:
        executed(one, set_to("laser", "shutter", "open"))
    assert caught.value.exit_code == ExitCode.INTERRUPTED and caught.value.diagnostics[0].code == "stopped"
    assert devices["laser.shutter"].told == []


def test_nothing_is_set_once_the_lease_is_over() -> None:
    def over() -> None:
        raise PicoError(error("locked", "the lease is over"))

    one, devices = session(require=over)
    result = executed(one, set_to("laser", "shutter", "open"))
    assert result.outcome == "failed" and devices["laser.shutter"].told == []


def test_what_begins_is_told_before_anything_is_done_and_how_it_ended_with_what_was_seen() -> None:
    events, heard = list[Any](), list[Any]()
    one, devices = session(told=events)

    def began(before: Any) -> None:
        heard.append((before, list(devices["laser.shutter"].told), len(events)))

    result = asyncio.run(one.execute(set_to("laser", "shutter", "open"), "run/op1/1", began))
    assert heard == [(observed().components["laser"], [], 0)] and devices["laser.shutter"].told == [True]
    assert [(e.kind, e.run, e.operation, e.component) for e in events] == [
        ("operation_started", "run", "op1", "laser")
    ]  # fmt: skip
    assert (result.key, result.outcome, result.seconds, result.ended) == ("run/op1/1", "done", 0.0, 5.0)
    assert result.before == result.after == observed().components["laser"] and result.data == {"value": "open"}


def test_what_was_stopped_before_it_began_to_move_does_nothing() -> None:
    one, devices = session()

    def began(before: Any) -> None:
        one._stopped = True

    result = asyncio.run(one.execute(set_to("laser", "shutter", "open"), "run/op1/1", began))
    assert result.error is not None and result.error.code == "stopped" and devices["laser.shutter"].told == []


@pytest.mark.parametrize("fails", [True, False])
def test_what_fails_is_told_by_its_device_unless_an_input_ended_it(
    fails: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(guarding, "EVERY", 0.0)
    door = Input()
    one, devices = session(door)

    async def broken(wanted: bool) -> bool:
        if fails:
            door.state = SafetyState(safe=False, age=0.0)
            for _ in range(50):
                await asyncio.sleep(0)
        raise PicoError(error("device-lost", "its cable is out"))

    monkeypatch.setattr(devices["laser.emission"], "emit", broken)
    result = executed(one, set_to("laser", "emission", True))
    assert result.outcome == "failed" and result.error is not None
    assert result.error.code == ("unsafe" if fails else "device-lost")


def test_inputs_are_watched_while_light_is_let_out_and_not_after(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(guarding, "EVERY", 0.0)
    door = Input()
    one, _ = session(door)

    async def go() -> tuple[int, int]:
        await one.execute(set_to("laser", "emission", True), "run/op1/1", lambda before: None)
        await asyncio.sleep(0)
        asked = door.asked
        for _ in range(20):
            await asyncio.sleep(0)
        return asked, door.asked

    before, after = asyncio.run(go())
    assert before == after >= 1


def test_light_is_not_let_out_by_what_waited_while_a_stop_came() -> None:
    one, devices = session()
    looks, stops, began = one._seen, list[asyncio.Task[Any]](), list[Any]()

    async def stopped_meanwhile() -> Any:
        if began and not stops:
            stops.append(asyncio.create_task(one.stop()))  # it ends once this operation has ended
            await asyncio.sleep(0)
        return await looks()

    one._seen = stopped_meanwhile  # type: ignore[method-assign]

    async def go() -> Any:
        result = await one.execute(set_to("laser", "emission", True), "run/op1/1", began.append)
        await asyncio.gather(*stops)
        return result

    result = asyncio.run(asyncio.wait_for(go(), 30))
    assert stops and result.outcome != "done" and result.error is not None
    assert True not in devices["laser.emission"].told


def test_a_stop_waits_for_what_is_under_way_and_then_ends_light() -> None:
    kinds = SETUP.type_of("cam").tunables
    cap = Tunable(datatype="choice", choices=("open", "closed"), mover="electronics")
    setup = with_type(with_type(SETUP, "cam", tunables={**kinds, "cap": cap}), "gate", tunables={
        "shutter": Tunable(datatype="choice", choices=("open", "shut"), mover="electronics")
    })  # fmt: skip
    one, devices = session(setup=setup)
    devices["cam.cap"] = Device()
    one._bench.tunables["cam.cap"] = Shut(devices["cam.cap"])  # type: ignore[arg-type]
    order, beginning = list[str](), asyncio.Event()

    async def slow(on: bool) -> bool:
        beginning.set()
        for _ in range(20):
            await asyncio.sleep(0)
        order.append("emitted" if on else "off")
        return on

    async def closes(wanted: bool) -> bool:
        order.append("closed" if not wanted else "opened")
        return wanted

    devices["laser.emission"].emit = slow  # type: ignore[method-assign]
    devices["laser.shutter"].open = closes  # type: ignore[method-assign]

    async def started() -> None:
        task = asyncio.create_task(one.execute(set_to("laser", "emission", True), "run/op1/1", lambda before: None))
        await beginning.wait()  # the laser is being switched on
        await one.stop()
        await task

    asyncio.run(started())
    assert order[0] == "emitted" and sorted(order[1:]) == ["closed", "off"]
    assert devices["cam.cap"].told == [] == devices["gate.shutter"].told and devices["second.shutter"].told == [False]


# what the guard ends beside a run


def trip(*, stops_arms: bool = False) -> Trip:
    cause = Cause(name="lock", kind="interlock", why="is not safe")
    return Trip(causes=(cause,), lasers=("laser",), stops_arms=stops_arms)


@pytest.mark.parametrize("stops_arms", [True, False])
def test_what_is_measured_while_the_guard_ends_light_is_no_measurement_and_nothing_more_begins(
    stops_arms: bool,
) -> None:
    one, devices = session()
    measure = Operation(id="m", primitive="measure", component="cam", reason=Reason(kind="asked"))
    measuring, ended = asyncio.Event(), asyncio.Event()

    async def slow(*_: Any) -> Any:
        measuring.set()
        await ended.wait()
        return {}

    one._measured = slow

    async def go() -> tuple[OperationResult, Any]:
        task = asyncio.create_task(one.execute(measure, "run/m/1", lambda before: None))
        await measuring.wait()
        await one.trip(trip(stops_arms=stops_arms))
        ended.set()
        result = await task
        with pytest.raises(PicoError) as caught:
            await one.execute(set_to("laser", "shutter", "open"), "run/op2/1", lambda before: None)
        return result, caught.value

    result, refused = asyncio.run(go())
    assert result.outcome == "failed" and result.error is not None
    assert result.error.summary == "the guard ended light: lock (interlock) is not safe"
    assert refused.diagnostics[0] == result.error and refused.exit_code == ExitCode.INTERRUPTED
    assert devices["laser.shutter"].told == []


@pytest.mark.parametrize("stops_arms", [True, False])
def test_an_arm_on_its_way_stops_if_the_cause_concerns_arms_and_else_comes_to_its_safe_end(stops_arms: bool) -> None:
    one, _ = session()
    stopped = list[str]()

    async def stops() -> None:
        stopped.append("stop")

    one._bench.arms["arm1"] = SimpleNamespace(stop=stops)  # type: ignore[assignment]
    one._ways["arm1"] = SimpleNamespace()  # type: ignore[assignment]
    asyncio.run(one.trip(trip(stops_arms=stops_arms)))
    assert stopped == (["stop"] if stops_arms else []) and one._halting and one._stopped is stops_arms
    assert one.moving() == (one._bench.arms["arm1"],)


def test_a_trip_in_a_run_ends_the_light_of_a_laser_without_a_shutter(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(guarding, "EVERY", 0.0)
    door, kept = Input(), list[str]()
    one, devices = session(door, "door")
    bare = Device(True)
    one._bench.tunables["bare.emission"] = Emitting(bare)  # type: ignore[arg-type]

    async def keep(why: str) -> None:
        kept.append(why)

    one._darken = keep

    async def slow(wanted: bool) -> bool:
        door.state = SafetyState(safe=False, age=0.0)
        for _ in range(50):
            await asyncio.sleep(0)
        return wanted

    devices["laser.emission"].emit = slow  # type: ignore[method-assign]
    executed(one, set_to("laser", "emission", True))
    assert bare.told[0] is False and not bare.is_ and kept == ["door (door) is not safe"]
