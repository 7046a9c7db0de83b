"""A mount or stage that comes to rest beside its goal, or a switch that is not as it was told, has failed.

At the other end is a stand-in for the vendor's link that says what the table has: no device, no port, no emulator.
"""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Awaitable, Callable
from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

import pytest

from pico.diagnostics import PicoError
from pico.drivers import elliptec, limits, scpi, switches, visa, zaber
from pico.drivers.bus import Bus
from pico.model.wiring import DeviceEntry

PULSES = 143360
"""Of one turn of an ELL14."""
INFO = "0E1140051720231701016800023000"
"""What an ELL14 says of itself after `IN`: model 0E, serial 11400517, 360 deg, 0x23000 pulses a turn."""


def asked(go: Callable[[Any], Awaitable[Any]], instrument: Any, bus: Bus[Any]) -> Any:
    """Connect and ask; return what comes, or the code of what is raised."""

    async def all_() -> Any:
        try:
            await instrument.connect()
            return await go(instrument)
        except PicoError as exc:
            assert exc.diagnostics[0].address == "it" and "it " in exc.diagnostics[0].summary
            return exc.diagnostics[0].code
        finally:
            await bus.close()

    return asyncio.run(all_())


# rotation mounts


@dataclass
class Serial:
    """A line to one mount. `stops`: where it comes to rest, off its goal [deg]; `status`: what it says instead."""

    off: float = 0.0
    status: int | None = None
    busy: int = 0
    """How often it says that it turns still; below 0 until it is stopped."""
    turning: bool = False
    jog: int = elliptec.HOMED
    at: float = 0.0
    sent: list[str] = field(default_factory=list)
    waiting: list[bytes] = field(default_factory=list)
    timeout: float = 0.0
    is_open: bool = True

    def reset_input_buffer(self) -> None:
        self.waiting.clear()

    def flush(self) -> None: ...

    def close(self) -> None:
        self.is_open = False

    def write(self, data: bytes) -> None:
        said = data.decode()
        address, command = said[0], said[1:]
        self.sent.append(command)
        name = command[:2]
        if name == "in":
            self.say(address, "IN" + INFO)
        elif name == "gj":
            self.say(address, f"GJ{self.jog:08X}")
        elif name in ("ma", "ho"):
            goal = int(command[2:], 16) if name == "ma" else 0
            self.at = (goal - (1 << 32 if goal >> 31 else 0)) * 360 / PULSES + self.off
            self.say("5", "PO00000000")  # another mount on the line
            self.turning = self.busy < 0
            for _ in range(self.busy):
                self.say(address, "GS09")
            if self.turning:
                return
            self.say(address, f"GS{self.status:02X}" if self.status is not None else self.position())
        elif name == "st":
            self.turning = False
            self.say(address, "GS00")
        elif name == "gp":
            self.say(address, self.position())
        else:
            self.say(address, "GS00")

    def position(self) -> str:
        return f"PO{round(self.at * PULSES / 360) & 0xFFFFFFFF:08X}"

    def say(self, address: str, words: str) -> None:
        self.waiting.append(f"{address}{words}\r\n".encode())

    def read_until(self, end: bytes) -> bytes:
        return self.waiting.pop(0) if self.waiting else b"2GS09\r\n" if self.turning else b""


def rotator(line: Serial, limits_: Any = None) -> tuple[elliptec.Rotator, Bus[Any]]:
    from ElliptecBus.elliptec_bus import ElliptecBus

    link = ElliptecBus("none", auto_connect=False)
    link._serial = line  # type: ignore[assignment]
    bus: Bus[Any] = Bus(lambda: link, lambda one: one.close())
    address: dict[str, str | int] = {"port": "none", "bus": "2"}
    entry = DeviceEntry(driver="elliptec.rotator", address=address, identity={"serial": "11400517"},
                        limits={"angle": limits_} if limits_ else {})  # fmt: skip
    return elliptec.Rotator("it", entry, bus), bus


def test_a_mount_may_be_a_tenth_of_a_degree_off() -> None:
    assert elliptec.REACHED == 0.1 and zaber._REACHED == 2.0


@pytest.mark.parametrize("goal", [0.0, 45.0, 170.0, 360.0])
@pytest.mark.parametrize("off", [-90.0, -1.0, -0.11, -0.09, 0.0, 0.09, 0.11, 1.0, 90.0])
def test_a_mount_that_comes_to_rest_beside_its_goal_has_missed_it_on_either_side(goal: float, off: float) -> None:
    line = Serial(off)
    found = asked(lambda axis: axis.move_to(goal), *rotator(line))
    assert found == (pytest.approx(goal + off, abs=0.01) if abs(off) < 0.1 else "device-missed")
    assert [c for c in line.sent if c.startswith("ma")] == [f"ma{round(goal * PULSES / 360):08X}"]


@pytest.mark.parametrize("status", [0, 1, 2, 3, 4, 5, 7, 8, 10, 11, 12, 13, 99])
@pytest.mark.parametrize("off", [0.0, -5.0])
def test_what_a_mount_says_went_wrong_is_told_and_that_it_is_well_is_asked_after(status: int, off: float) -> None:
    found = asked(lambda axis: axis.move_to(45.0), *rotator(Serial(off, status)))
    well = pytest.approx(45.0, abs=0.01) if off == 0.0 else "device-missed"
    assert found == (well if status == 0 else "device-fault")


@pytest.mark.parametrize("busy", [1, 3])
@pytest.mark.parametrize("off", [0.0, 3.0])
def test_a_mount_is_waited_for_while_it_is_busy(busy: int, off: float) -> None:
    found = asked(lambda axis: axis.move_to(45.0), *rotator(Serial(off, busy=busy)))
    assert found == (pytest.approx(45.0, abs=0.01) if off == 0.0 else "device-missed")


def test_a_mount_that_never_comes_to_rest_is_stopped_and_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(elliptec, "LONGEST", 0.05)
    line = Serial(busy=-1)
    assert asked(lambda axis: axis.move_to(45.0), *rotator(line)) == "device-late"
    assert "st" in line.sent


@pytest.mark.parametrize(("allowed", "goal", "goes"), [
    (None, 0.0, True), (None, 360.0, True), (None, 361.0, False), (None, -1.0, False), ((10.0, 90.0), 10.0, True),
    ((10.0, 90.0), 90.0, True), ((10.0, 90.0), 9.99, False), ((10.0, 90.0), 91.0, False),
    (None, float("nan"), False), (None, float("inf"), False),
])  # fmt: skip
def test_a_mount_turns_within_its_limits_only(allowed: Any, goal: float, goes: bool) -> None:
    line = Serial()
    found = asked(lambda axis: axis.move_to(goal), *rotator(line, allowed))
    assert found == (pytest.approx(goal, abs=0.01) if goes else "device-limit")
    assert bool([c for c in line.sent if c.startswith("ma")]) is goes


@pytest.mark.parametrize(("jog", "reads"), [(elliptec.HOMED, 12.0), (PULSES // 8, None), (0, None)])
def test_a_mount_that_was_not_homed_since_it_has_power_does_not_know_its_angle(jog: int, reads: float | None) -> None:
    found = asked(lambda axis: axis.position(), *rotator(Serial(jog=jog, at=12.0)))
    assert found == (None if reads is None else pytest.approx(reads, abs=0.01))


def test_homing_is_kept_in_the_mount() -> None:
    line = Serial(jog=0)
    assert asked(lambda axis: axis.home(), *rotator(line)) == 0.0
    assert [c for c in line.sent if c[:2] in ("ho", "sj")] == ["ho0", f"sj{elliptec.HOMED:08X}"]


@pytest.mark.parametrize("angle", [-3.0, 0.0, 350.0])
def test_an_angle_below_zero_is_read_as_such(angle: float) -> None:
    assert asked(lambda axis: axis.position(), *rotator(Serial(at=angle))) == pytest.approx(angle, abs=0.01)


def test_a_mount_that_is_stopped_goes_nowhere_any_more() -> None:
    line = Serial(busy=-1)
    axis, bus = rotator(line)

    async def go() -> str:
        await axis.connect()
        moving = asyncio.create_task(axis.move_to(45.0))
        while not any(c.startswith("ma") for c in line.sent) and not moving.done():
            await asyncio.sleep(0)
        await axis.stop()
        with pytest.raises(PicoError) as caught:
            await moving
        await bus.close()
        return caught.value.diagnostics[0].code

    assert asyncio.run(go()) == "device-stopped" and "st" in line.sent


@pytest.mark.parametrize("before", [
    [], ["5PO00001000"], ["2GS00"], ["2GS09"], ["2GJ00000001"], ["2PO0000"], ["nonsense"], [""],
    ["5GS02", "5PO00001000"],
])  # fmt: skip
@pytest.mark.parametrize("split", [0, 1, 4])
def test_only_a_whole_answer_of_this_mount_to_this_question_is_its_angle(
    before: list[str], split: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    line = Serial(at=12.0)
    axis, bus = rotator(line)

    def said(self: Serial, address: str, words: str) -> None:
        if words.startswith("PO"):
            self.waiting += [f"{one}\r\n".encode() for one in before]
        whole = f"{address}{words}\r\n".encode()
        self.waiting += [whole[:split], whole[split:]] if split and words.startswith("PO") else [whole]

    monkeypatch.setattr(Serial, "say", said)

    async def go(one: Any) -> Any:
        line.waiting[:] = [b"2GJ00000000\r\n", b"2PO00002000\r\n"]  # what came before the question
        return await one.position()

    assert asked(go, axis, bus) == pytest.approx(12.0, abs=0.01)


@pytest.mark.parametrize("answer", ["2GS02", "2GS0A", None])
def test_a_mount_that_answers_by_a_fault_or_not_at_all_has_no_angle(
    answer: str | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(elliptec, "_REPLY", 60.0 if answer else 0.02)
    monkeypatch.setattr(Serial, "position", lambda self: answer[1:] if answer else "XX")
    found = asked(lambda axis: axis.position(), *rotator(Serial(at=12.0)))
    assert found == ("device-fault" if answer else "device-lost")


def test_what_was_heard_before_a_move_is_not_where_it_ends() -> None:
    line = Serial()
    axis, bus = rotator(line)

    async def go(one: Any) -> Any:
        line.waiting[:] = [b"2PO00002000\r\n"]
        return await one.move_to(45.0)

    assert asked(go, axis, bus) == pytest.approx(45.0, abs=0.01)


def test_a_closed_line_is_told_and_the_last_who_lets_go_closes_it() -> None:
    from ElliptecBus.elliptec_bus import ElliptecBus

    link = ElliptecBus("none", auto_connect=False)
    with pytest.raises(ConnectionError, match="closed"):
        elliptec._line_of(link)
    line = Serial()
    first, bus = rotator(line)
    entry = DeviceEntry(driver="elliptec.rotator", address={"port": "none", "bus": "2"})
    second = elliptec.Rotator("it", entry, bus)

    async def go() -> list[bool]:
        await first.connect()
        await second.connect()
        found = []
        for one in (first, second):
            await one.close()
            found.append(line.is_open)
        return found

    assert asyncio.run(go()) == [True, False]


# stages


@dataclass
class Chain:
    """A link to a stage that comes to rest so many counts off, says a warning, and is busy for some questions."""

    off: float = 0.0
    warning: str = "--"
    busy: int = 0
    at: float = 0.0
    creeps: bool = False
    """Whether it gets on by a count from one question to the next."""
    listed: str = ""
    """What it answers to `warnings`; by default the warning alone."""
    clears: bool = False
    """Whether a warning is gone once it was cleared."""
    sent: list[str] = field(default_factory=list)
    checked: dict[str, bool] = field(default_factory=dict)

    def generic_command(self, command: str, device: int, axis: int, check: bool, timeout: int) -> Any:
        self.sent.append(f"{device} {axis} {command}")
        self.checked[command] = check
        told = {"get system.serial": "12345", "get deviceid": "50081", "get version": "7.1"}.get(command)
        if told is not None:
            return SimpleNamespace(data=told, status="IDLE", warning_flag="--")
        if command.startswith("move abs"):
            self.at = float(command.split()[2]) + self.off
        elif command == "home":
            self.at = self.off
        elif command == "get pos" and self.busy:
            self.busy -= 1
            self.at += self.creeps
            return SimpleNamespace(data=str(self.at), status="BUSY", warning_flag="--")
        moving = command.startswith("move") or command == "home"
        if command == "warnings":
            listed = self.listed or f"01 {self.warning}"
            return SimpleNamespace(data=listed, status="IDLE", warning_flag=self.warning)
        if command == "warnings clear" and self.clears:
            self.warning = "--"
        flag = "--" if moving or command == "warnings clear" else self.warning
        return SimpleNamespace(data=str(self.at), status="IDLE", warning_flag=flag)

    def close(self) -> None: ...


def stage(chain: Chain, counts: float = 1000.0, allowed: Any = None) -> tuple[zaber.Stage, Bus[Any]]:
    bus: Bus[Any] = Bus(lambda: chain, lambda one: one.close())
    entry = DeviceEntry(driver="zaber.stage", address={"port": "none", "device": 3, "axis": 2},
                        identity={"serial": "12345"}, settings={"counts_per_unit": counts},
                        limits={"position": allowed} if allowed else {})  # fmt: skip
    return zaber.Stage("it", entry, bus), bus


@pytest.mark.parametrize("goal", [0.0, 40.0])
@pytest.mark.parametrize("counts", [1000.0, -1000.0, 20.0])
@pytest.mark.parametrize("off", [-5000.0, -2.1, -1.9, -1.0, 0.0, 1.0, 1.9, 2.1, 5000.0])
def test_a_stage_that_comes_to_rest_beside_its_goal_has_missed_it_on_either_side(
    goal: float, counts: float, off: float
) -> None:
    chain = Chain(off)
    found = asked(lambda axis: axis.move_to(goal), *stage(chain, counts))
    assert found == (pytest.approx(goal + off / counts) if abs(off) <= 2 else "device-missed")
    assert f"3 2 move abs {round(goal * counts)}" in chain.sent


@pytest.mark.parametrize("flag", [*sorted(zaber._FAULTS), "--", "WV", "WT", "NU", "NR"])
def test_what_a_stage_says_went_wrong_is_told_and_cleared(flag: str) -> None:
    chain = Chain(warning=flag)
    fault = flag in zaber._FAULTS
    assert asked(lambda axis: axis.move_to(4.0), *stage(chain)) == ("device-fault" if fault else 4.0)
    assert ("3 2 warnings clear" in chain.sent) is fault
    reads = asked(lambda axis: axis.position(), *stage(Chain(warning=flag, at=4000.0)))
    assert reads == ("device-fault" if fault else 4.0)


@pytest.mark.parametrize(("flag", "listed"), [("WR", "01 WR"), ("WH", "01 WH"), ("WV", "02 WV WR"), ("NC", "02 NC WR")])
def test_a_stage_that_was_not_homed_is_not_driven_but_home(flag: str, listed: str) -> None:
    chain = Chain(warning=flag, listed=listed)
    assert asked(lambda axis: axis.move_to(4.0), *stage(chain)) == "device-unhomed"
    assert not any("move" in sent for sent in chain.sent)
    assert asked(lambda axis: axis.position(), *stage(Chain(warning=flag, listed=listed, at=4000.0))) is None
    if not flag.startswith("N"):
        assert asked(lambda axis: axis.home(), *stage(Chain(warning=flag, listed=listed))) == 0.0


@pytest.mark.parametrize("flag", ["NI", "NC"])
def test_a_motion_that_another_one_interrupts_is_told(flag: str) -> None:
    assert asked(lambda axis: axis.move_to(4.0), *stage(Chain(warning=flag))) == "device-fault"


def test_a_note_of_an_earlier_motion_is_cleared_before_the_next() -> None:
    chain = Chain(warning="NI", clears=True)
    assert asked(lambda axis: axis.move_to(4.0), *stage(chain)) == 4.0
    assert chain.sent.index("3 2 warnings clear") < chain.sent.index("3 2 move abs 4000")


@pytest.mark.parametrize("data", ["nan", "inf", "1_0", "", "NA", "\u0661", "12 13"])
def test_a_position_that_is_no_number_is_told(data: str, monkeypatch: pytest.MonkeyPatch) -> None:
    chain = Chain()
    axis, bus = stage(chain)
    usual = chain.generic_command
    said = SimpleNamespace(data=data, status="IDLE", warning_flag="--")
    chain.generic_command = lambda c, *rest: said if c == "get pos" else usual(c, *rest)  # type: ignore[method-assign]
    assert asked(lambda one: one.position(), axis, bus) == "device-reply"


def test_a_stage_is_waited_for_while_it_is_busy_and_homes_to_its_zero(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(zaber, "_POLL", 0.0)
    chain = Chain(3.0, busy=4)
    assert asked(lambda axis: axis.move_to(4.0), *stage(chain)) == "device-missed" and chain.busy == 0
    chain = Chain(busy=3, at=9.0)
    assert asked(lambda axis: axis.home(), *stage(chain)) == 0.0 and chain.busy == 0 and "3 2 home" in chain.sent


def test_a_stage_that_says_it_moves_and_does_not_is_stopped_and_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(zaber, "_POLL", 0.0)
    monkeypatch.setattr(zaber, "LONGEST", 0.02)
    chain = Chain(busy=10**9)
    assert asked(lambda axis: axis.move_to(4.0), *stage(chain)) == "device-late" and "3 2 stop" in chain.sent


def test_a_stage_that_gets_on_is_waited_for_however_slow_it_is(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(zaber, "_POLL", 0.0)
    monkeypatch.setattr(zaber, "LONGEST", 0.0)
    chain = Chain(busy=21, creeps=True, off=-20.0)  # the first question comes before it moves
    assert asked(lambda axis: axis.move_to(4.0), *stage(chain)) == 4.0 and "3 2 stop" not in chain.sent


def test_a_stage_is_asked_by_its_numbers_and_a_refused_command_is_an_error() -> None:
    chain = Chain(warning="FS")
    asked(lambda axis: axis.move_to(4.0), *stage(chain))
    assert chain.checked.pop("warnings clear") is False and all(chain.checked.values())
    assert {"3 0 get system.serial", "3 0 get deviceid", "3 0 get version", "3 2 get pos"} <= set(chain.sent)
    bus: Bus[Any] = Bus(lambda: alone, lambda one: one.close())
    alone = Chain()
    entry = DeviceEntry(driver="zaber.stage", address={"port": "x"}, settings={"counts_per_unit": 1.0})
    assert asked(lambda axis: axis.position(), zaber.Stage("it", entry, bus), bus) == 0.0
    assert "1 1 get pos" in alone.sent and "1 0 get deviceid" in alone.sent


def test_a_stage_that_is_stopped_has_not_arrived_though_it_rests_there(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(zaber, "_POLL", 0.0)
    chain = Chain(busy=10**9)
    axis, bus = stage(chain)

    async def go() -> str:
        await axis.connect()
        moving = asyncio.create_task(axis.move_to(4.0))
        while not any("move abs" in c for c in chain.sent) and not moving.done():
            await asyncio.sleep(0)
        await axis.stop()
        chain.busy = 0
        with pytest.raises(PicoError) as caught:
            await moving
        await bus.close()
        return caught.value.diagnostics[0].code

    assert asyncio.run(go()) == "device-stopped" and "3 2 stop" in chain.sent


@pytest.mark.parametrize("host", ["10.0.0.7", ""])
def test_a_link_to_stages_checks_what_is_said_over_it(host: str, monkeypatch: pytest.MonkeyPatch) -> None:
    from zaber_motion.ascii import Connection

    made, opened = SimpleNamespace(), list[tuple[Any, ...]]()
    for name in ("open_tcp", "open_serial_port"):
        monkeypatch.setattr(Connection, name, lambda *given, name=name: (opened.append((name, *given)), made)[1])
    link = zaber.opened(DeviceEntry(driver="zaber.stage", address={"host": host, "port": "77"}))
    assert link is made and made.checksum_enabled is True and made.default_request_timeout == zaber.REPLY
    assert opened == [("open_tcp", "10.0.0.7", 77) if host else ("open_serial_port", "77")]


@pytest.mark.parametrize(("allowed", "goal", "goes"), [
    (None, 1e6, True), ((0.0, 50.0), 50.0, True), ((0.0, 50.0), 50.1, False), ((0.0, 50.0), -0.1, False),
    ((0.0, 50.0), float("nan"), False),
])  # fmt: skip
def test_a_stage_drives_within_its_limits_only(allowed: Any, goal: float, goes: bool) -> None:
    chain = Chain()
    found = asked(lambda axis: axis.move_to(goal), *stage(chain, allowed=allowed))
    assert found == (goal if goes else "device-limit") and any("move" in c for c in chain.sent) is goes


@pytest.mark.parametrize("counts", [None, 0, "many"])
def test_a_stage_of_unknown_counts_is_not_driven(counts: Any) -> None:
    entry = DeviceEntry(driver="zaber.stage", address={"port": "x"}, settings={"counts_per_unit": counts} if counts
                        is not None else {})  # fmt: skip
    with pytest.raises(PicoError, match="does not say how many counts"):
        zaber.Stage("it", entry, Bus(lambda: None, lambda one: None))


@pytest.mark.parametrize("value", [-0.1, 0.0, 5.0, 10.0, 10.1, float("nan"), float("inf"), float("-inf")])
def test_a_value_is_within_its_limits_with_both_ends(value: float) -> None:
    if 0.0 <= value <= 10.0:
        limits.require_within("it", "angle", value, (0.0, 10.0), "deg")
    else:
        with pytest.raises(PicoError, match="its limits are 0 to 10 deg") as caught:
            limits.require_within("it", "angle", value, (0.0, 10.0), "deg")
        assert caught.value.diagnostics[0].code == "device-limit"


@pytest.mark.parametrize("kind", [zaber.Stage, scpi.Laser, switches.SwitchedLaser])
def test_who_lets_go_of_a_link_alone_closes_it(kind: Any) -> None:
    closed = list[Any]()
    link: Any = {zaber.Stage: Chain, scpi.Laser: Spoken, switches.SwitchedLaser: Box}[kind]()
    bus: Bus[Any] = Bus(lambda: link, closed.append)
    address: dict[str, str | int] = {"visa": "x", "channel": 3, "relay": 7, "host": "x", "port": 1, "name": "s1"}
    one = kind("it", DeviceEntry(driver="d", address=address, settings={"counts_per_unit": 1.0}), bus)

    async def go() -> None:
        await one.connect()
        assert closed == []
        await one.close()

    asyncio.run(go())
    assert closed and all(one is link for one in closed)


# what is on or off


@dataclass
class Spoken:
    """A VISA link. `closed`: what the contact reads, one after the other; the last one stays."""

    emits: list[str] = field(default_factory=lambda: ["0"])
    closed: list[str] = field(default_factory=lambda: ["1"])
    counts: bool = True
    sent: list[str] = field(default_factory=list)
    count: int = 0
    asked: list[str] = field(default_factory=list)

    def tell(self, command: str) -> None:
        self.sent.append(command)

    def told(self, command: str) -> None:
        self.sent.append(command)

    def ask(self, question: str) -> str:
        if question == "*IDN?":
            return "Acme,M1,S42,1.2"
        self.asked.append(f"{question} after {len(self.sent)}")
        said = self.emits if question == "OUTP?" else self.closed
        found = said.pop(0) if len(said) > 1 else said[0]
        if question == "OUTP?":
            return found
        assert question == "INP? (@3)"
        self.count += int(self.counts)
        return f"{found},{self.count}"


def spoken(kind: Any, link: Spoken) -> tuple[Any, Bus[Any]]:
    bus: Bus[Any] = Bus(lambda: link, lambda one: None)
    address: dict[str, str | int] = {"visa": "none", "channel": 3, "relay": 7}
    return kind("it", DeviceEntry(driver="scpi", address=address, identity={"serial": "S42"}), bus), bus


@pytest.mark.parametrize("on", [True, False])
@pytest.mark.parametrize("reads", ["0", "1", "2", ""])
def test_a_laser_is_as_it_was_told_by_what_it_reads_back(on: bool, reads: str) -> None:
    link = Spoken(emits=[reads])
    found = asked(lambda laser: laser.emit(on), *spoken(scpi.Laser, link))
    known = {"0": False, "1": True}.get(reads)
    assert found == ("device-lost" if known is None else on if known is on else "device-read-back")
    assert link.sent == [f"OUTP {'ON' if on else 'OFF'}"]
    reading = asked(lambda laser: laser.emitting(), *spoken(scpi.Laser, Spoken(emits=[reads])))
    assert reading == ("device-lost" if known is None else known)


@pytest.mark.parametrize("wanted", [True, False])
@pytest.mark.parametrize("contact", [["1"], ["0"], ["1", "0"], ["0", "1"], ["0", "0", "1"], ["1", "1", "0"], ["x"]])
def test_a_shutter_is_as_it_was_told_by_its_own_contact_which_is_closed_while_it_is(
    wanted: bool, contact: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(scpi.time, "sleep", lambda seconds: None)
    ticks = iter(range(10**6))
    monkeypatch.setattr(scpi, "time", SimpleNamespace(sleep=lambda s: None, monotonic=lambda: next(ticks) * 0.1))
    link = Spoken(closed=list(contact))
    found = asked(lambda shutter: shutter.open(wanted), *spoken(scpi.Shutter, link))
    there = ("0" if wanted else "1") in contact
    assert found == ("device-lost" if contact == ["x"] else wanted if there else "device-read-back")
    assert link.sent == [f"OUTP {'ON' if wanted else 'OFF'},(@7)"]


@pytest.mark.parametrize(("contact", "open_"), [("1", False), ("0", True), ("", "device-lost")])
def test_a_shutter_reads_open_while_its_contact_is(contact: str, open_: Any) -> None:
    assert asked(lambda one: one.is_open(), *spoken(scpi.Shutter, Spoken(closed=[contact]))) == open_


def test_a_stop_comes_before_all_that_waits() -> None:
    link, free = Spoken(), threading.Event()
    one, bus = spoken(scpi.Laser, link)

    async def go() -> None:
        await one.connect()
        waiting = [asyncio.create_task(bus.ask("it", "wait", lambda _: free.wait()))]
        waiting += [asyncio.create_task(one.emitting()) for _ in range(3)]
        for _ in range(3):
            await asyncio.sleep(0)
        waiting.append(asyncio.create_task(one.stop()))
        await asyncio.sleep(0)
        free.set()
        await asyncio.gather(*waiting)
        await bus.close()

    asyncio.run(go())
    assert link.sent == ["OUTP OFF"] and link.asked == ["OUTP? after 1"] * 3


@pytest.mark.parametrize(
    ("key", "value"), [("serial", "S43"), ("model", "M2"), ("vendor", "Bcme"), ("firmware", "1.3")]
)
def test_another_device_than_the_lab_names_is_told_nothing(key: Any, value: str) -> None:
    link = Spoken()
    bus: Bus[Any] = Bus(lambda: link, lambda one: None)
    for identity, code in (({key: value}, "device-identity"), ({}, None)):
        laser = scpi.Laser("it", DeviceEntry(driver="scpi", address={"visa": "x"}, identity=identity), bus)

        async def go(laser: Any = laser) -> Any:
            try:
                return (await laser.connect()).serial, await laser.emit(False)
            except PicoError as exc:
                return exc.diagnostics[0].code
            finally:
                await bus.close()

        assert asyncio.run(go()) == (code or ("S42", False))
        assert link.sent == ([] if code else ["OUTP OFF"])


@pytest.mark.parametrize("kind", [scpi.Laser, scpi.Shutter])
def test_a_stop_that_does_not_come_through_is_told_of_its_device(kind: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(self: Spoken, command: str) -> None:
        raise OSError("no such device")

    monkeypatch.setattr(Spoken, "tell", broken)
    assert asked(lambda one: one.stop(), *spoken(kind, Spoken())) == "device-lost"


@pytest.mark.parametrize(("wavelength", "reads", "code"), [
    (None, 500.0, None), (632.8, 632.8, None), (632.8, 633.2, None), (632.8, 633.5, None), (632.8, 1550.0, None),
    (399.0, 399.0, "device-limit"), (701.0, 701.0, "device-limit"),
])  # fmt: skip
def test_a_meter_is_set_to_a_wavelength_and_says_which_it_reads_back(
    wavelength: float | None, reads: float, code: str | None
) -> None:
    link = Metered({"SENS:CORR:WAV?": f"{reads:.3f}"})
    found = asked(lambda meter: meter.power(wavelength=wavelength), *meter(link, {"wavelength": (400.0, 700.0)}))
    assert link.sent == ([] if wavelength is None or code == "device-limit" else [f"SENS:CORR:WAV {wavelength:.3f}"])
    if code:
        assert found == code
        return
    assert (found.value, found.unit) == (0.0012, "W")
    assert found.settings == ({} if wavelength is None else {"wavelength": reads})


@pytest.mark.parametrize(("replies", "code"), [
    ({"MEAS:POW?": "9.9E37"}, "over-range"), ({"MEAS:POW?": "9.91E37"}, "no-number"),
    ({"MEAS:POW?": "NAN"}, "no-number"),
    ({"MEAS:POW?": "-9.9E+37"}, "under-range"), ({"MEAS:POW?": "0.0012 W"}, "garbled"), ({"MEAS:POW?": ""}, "garbled"),
    ({"SYST:ERR?": '-230,"Data corrupt"'}, "instrument-error"), ({"SYST:ERR?": "what"}, "garbled"),
    ({"SENS:CORR:WAV?": "9.91E37"}, "wavelength"), ({"MEAS:POW?": "0.3"}, "out-of-limits"),
    ({"SENS:POW:UNIT?": "DBM"}, "garbled"), ({"SENS:POW:UNIT?": "mW"}, "garbled"), ({"SENS:POW:UNIT?": ""}, "garbled"),
])  # fmt: skip
def test_a_reply_that_is_no_reading_is_unknown_with_its_reason(replies: dict[str, str], code: str) -> None:
    found = asked(lambda one: one.power(wavelength=633.0), *meter(Metered(replies), {"power": (0.0, 0.2)}))
    assert (found.value, found.unknown) == (None, code), found


def test_an_error_of_a_refused_wavelength_is_no_error_of_the_reading() -> None:
    link = Metered({"SENS:CORR:WAV?": "1100.0"}, errors=['-222,"Data out of range"'])
    found = asked(lambda one: one.power(wavelength=1550.0), *meter(link))
    assert (found.value, found.settings) == (0.0012, {"wavelength": 1100.0})


def test_a_plain_meter_is_not_asked_what_it_does_not_know() -> None:
    link = Metered()
    found = asked(
        lambda one: one.power(wavelength=1550.0),
        *meter(link, settings={"wavelength": False, "power_unit": False, "error_queue": False}),
    )
    assert (found.value, found.settings, link.sent, link.asked[1:]) == (0.0012, {}, [], ["MEAS:POW?"])


@pytest.mark.parametrize(("said", "unknown"), [
    ("-3.01", "under-range"), ("-2E-4", "under-range"), ("-1E-9", None), ("0", None),
])  # fmt: skip
def test_a_negative_power_beyond_noise_is_unknown(said: str, unknown: str | None) -> None:
    found = asked(lambda one: one.power(), *meter(Metered({"MEAS:POW?": said}), settings={"power_unit": False}))
    assert found.unknown == unknown and found.value == (None if unknown else float(said))


@dataclass
class Metered:
    """A VISA link to a meter, with some other replies than usual, and what its error queue holds."""

    replies: dict[str, str] = field(default_factory=dict)
    errors: list[str] = field(default_factory=list)
    sent: list[str] = field(default_factory=list)
    asked: list[str] = field(default_factory=list)

    def tell(self, command: str) -> None:
        self.sent.append(command)

    def ask(self, question: str) -> str:
        self.asked.append(question)
        if question == "SYST:ERR?" and self.errors:
            return self.errors.pop(0)
        usual = {"MEAS:POW?": "1.2E-3", "SYST:ERR?": '0,"No error"', "SENS:CORR:WAV?": "633.0", "SENS:POW:UNIT?": "W"}
        usual["*IDN?"] = "Acme,M1,S42,1.2"
        reply = self.replies.get(question, usual[question])
        if question == "SYST:ERR?":
            self.replies.pop(question, None)
        return reply

    def ask_if_known(self, question: str) -> str:
        return self.ask(question)

    def failure(self, *, after_reply: bool = False) -> str:
        return visa.queue_of(self.ask)


def meter(link: Metered, limits: Any = None, settings: Any = None) -> tuple[scpi.PowerMeter, Bus[Any]]:
    bus: Bus[Any] = Bus(lambda: link, lambda one: None)
    entry = DeviceEntry(driver="scpi.meter", address={"visa": "x"}, limits=limits or {}, settings=settings or {})
    return scpi.PowerMeter("it", entry, bus), bus


@pytest.mark.parametrize(("kind", "off"), [(scpi.Laser, "OUTP OFF"), (scpi.Shutter, "OUTP OFF,(@7)")])
def test_a_stop_puts_light_out(kind: Any, off: str) -> None:
    link = Spoken()
    asked(lambda one: one.stop(), *spoken(kind, link))
    assert link.sent == [off]


@pytest.mark.parametrize(("kind", "ask"), [
    (scpi.Laser, lambda one, on: one.emit(on)), (scpi.Shutter, lambda one, on: one.open(on)),
])  # fmt: skip
@pytest.mark.parametrize("on", [True, False])
def test_light_that_was_asked_for_before_a_stop_does_not_come_after_it_but_darkness_does(
    kind: Any, ask: Any, on: bool
) -> None:
    link = Spoken(emits=["1" if on else "0"], closed=["0" if on else "1"])
    one, bus = spoken(kind, link)
    free = threading.Event()

    async def go() -> Any:
        await one.connect()
        ahead = asyncio.create_task(bus.ask("it", "wait", lambda _: free.wait()))
        asking = asyncio.create_task(ask(one, on))
        for _ in range(3):
            await asyncio.sleep(0)  # both are in the queue of the bus
        stopping = asyncio.create_task(one.stop())
        await asyncio.sleep(0)
        free.set()
        await ahead
        await stopping
        try:
            return await asking
        except PicoError as exc:
            return exc.diagnostics[0].code
        finally:
            await bus.close()

    found = asyncio.run(go())
    assert found == ("device-stopped" if on else False)
    assert len(link.sent) == (1 if on else 2) and all("OFF" in said for said in link.sent)


@pytest.mark.parametrize("reads", ["1", "0", "x", ""])
@pytest.mark.parametrize("counts", [True, False])
def test_a_contact_is_safe_where_a_fresh_answer_says_that_it_is_closed(reads: str, counts: bool) -> None:
    link = Spoken(closed=[reads], counts=counts, count=5)

    async def twice(one: Any) -> Any:
        first, second = await one.read(), await one.read()
        return [(first.safe, first.age < 60), (second.safe, second.age < 60)]

    one, bus = spoken(scpi.SafetyInput, link)
    first, second = asked(twice, one, bus)
    known = {"1": True, "0": False}.get(reads)
    assert first == (known, known is not None)
    assert second[0] is (known if counts else None), "an answer that comes twice is none"


def test_a_contact_that_was_never_heard_is_infinitely_old() -> None:
    one, bus = spoken(scpi.SafetyInput, Spoken(closed=["x"]))
    state = asked(lambda it: it.read(), one, bus)
    assert state.safe is None and state.age == float("inf")


@pytest.mark.parametrize("on", [True, False])
def test_a_lamp_is_told_by_its_relay(on: bool) -> None:
    link = Spoken()
    assert asked(lambda lamp: lamp.shine(on), *spoken(scpi.Lamp, link)) is on
    assert link.sent == [f"OUTP {'ON' if on else 'OFF'},(@7)"]


@dataclass
class Box:
    """A box of switches: what `set` answers, and what the sensor reads, one after the other; the last one stays."""

    sets: bool | None = True
    reads: list[bool | None] = field(default_factory=lambda: [True])
    sent: list[str] = field(default_factory=list)

    def ask(self, words: str) -> str:
        return "vendor=Acme model=M1 serial=7 firmware=2"

    def state(self, words: str) -> bool | None:
        self.sent.append(words)
        if words.startswith("set"):
            return self.sets
        return self.reads.pop(0) if len(self.reads) > 1 else self.reads[0]


def boxed(kind: Any, box: Box) -> tuple[Any, Bus[Any]]:
    bus: Bus[Any] = Bus(lambda: box, lambda one: None)
    address: dict[str, str | int] = {"host": "none", "port": 1, "name": "s1"}
    return kind("it", DeviceEntry(driver="switches", address=address, identity={"serial": "7"}), bus), bus


@pytest.mark.parametrize("wanted", [True, False])
@pytest.mark.parametrize("reads", [[True], [False], [None], [True, False], [False, True], [None, False], [None, True]])
def test_a_shutter_of_a_box_is_what_its_sensor_says_and_as_not_wanted_where_that_is_unknown(
    wanted: bool, reads: list[bool | None], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(switches, "_TRAVEL", 60.0 if wanted in reads else 0.03)
    box = Box(reads=list(reads))
    found = asked(lambda one: one.open(wanted), *boxed(switches.SwitchedShutter, box))
    last = wanted if wanted in reads else reads[-1]
    assert found is (bool(last) if last is not None else not wanted)
    assert box.sent[0] == f"set s1 {int(wanted)}" and set(box.sent[1:]) == {"read s1.sensor"}


@pytest.mark.parametrize("on", [True, False])
@pytest.mark.parametrize("answers", [True, False, None])
def test_lasers_and_lamps_of_a_box_tell_what_it_answers_and_inputs_what_it_reads(
    on: bool, answers: bool | None
) -> None:
    for kind, ask in ((switches.SwitchedLaser, "emit"), (switches.SwitchedLamp, "shine")):
        box = Box(sets=answers)
        unknown = not on if ask == "emit" else False  # a laser of which nothing is known is not proven dark
        wanted = unknown if answers is None else answers
        assert asked(lambda one, ask=ask: getattr(one, ask)(on), *boxed(kind, box)) is wanted
        assert box.sent == [f"set s1 {int(on)}"]
    reads = Box(reads=[answers])
    assert asked(lambda one: one.emitting(), *boxed(switches.SwitchedLaser, reads)) is answers
    assert reads.sent == ["read s1"]
    state = asked(lambda one: one.read(), *boxed(switches.SwitchedInput, Box(reads=[answers])))
    assert (state.safe, state.age) == (answers, 0.0)


class Socket:
    """A connection to a box that answers as the table has it."""

    def __init__(self, answers: Callable[[str, str], bytes]) -> None:
        self.answers, self.said, self.waiting = answers, list[bytes](), b""

    def sendall(self, data: bytes) -> None:
        self.said.append(data)
        number, _, words = data.decode().strip().partition(" ")
        self.waiting = self.answers(number, words)

    def makefile(self, mode: str) -> Socket:
        return self

    def readline(self, most: int) -> bytes:
        return self.waiting[:most]

    def close(self) -> None: ...


@pytest.mark.parametrize(("answer", "state"), [
    (b"%s 1\n", True), (b"%s 0\n", False), (b"%s ?\n", None), (b"%s 2\n", ValueError), (b"%s\n", ValueError),
    (b"9%s 1\n", ValueError), (b"1\n", ValueError), (b"", ValueError), (b"%s 1", ValueError), (b"%s on\n", ValueError),
    (b"\xff\n", ValueError),
])  # fmt: skip
def test_only_a_whole_answer_to_this_question_is_a_state(
    answer: bytes, state: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    made = Socket(lambda number, words: answer.replace(b"%s", number.encode()))
    monkeypatch.setattr(switches.socket, "create_connection", lambda *_, **__: made)
    link = switches.SwitchLink("none", 1)
    for n in (1, 2):
        if state is ValueError:
            with pytest.raises(ValueError, match=r"it (answers|hung up)"):
                link.state("read s1")
        else:
            assert link.state("read s1") is state
        assert made.said[-1] == f"{n} read s1\n".encode()
