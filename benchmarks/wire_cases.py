"""The drivers that `benchmarks/wire_replies.py` asks, each with its emulator, its question and its grammar."""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import wire_cameras as cameras
import wire_grammars as grammar
import wire_xarm as xarm
from wire_grammars import Allowed

from pico.model.wiring import DeviceEntry

WHO = {"vendor": "Acme", "model": "M1", "serial": "S42", "firmware": "1.2"}
UNKNOWN = object()
"""What a driver says that does not know."""


@dataclass(frozen=True)
class Case:
    """A driver: its entry, what its emulator has at first, the `question` whose reply is replaced, how it is read, a
    new value for the world behind it, and what the grammar says of a reply (bytes, the true reply, the value)."""

    entry: DeviceEntry
    at_first: dict[str, Any]
    question: Callable[[bytes], bool]
    read: Callable[[Any], Any]
    draw: Callable[[random.Random], tuple[str, Any]]
    says: Callable[[bytes, bytes, Any], Allowed]
    forms: Callable[[bytes, random.Random], bytes] = lambda reply, _: reply
    """Another form of a valid reply that the grammar allows."""
    others: tuple[bytes, ...] = ()
    first: Callable[[Any], Any] | None = None
    """What is done once before it is read, such as homing."""
    odd: Callable[[bytes, random.Random], bytes] | None = None
    """Something else than a valid reply, made of one."""
    wire: Callable[[Any, Any], Any] | None = None
    """How its wire is tapped, if not by `wire`."""


async def _number(found: Any) -> Any:
    value = getattr(found, "value", found)
    return UNKNOWN if value is None else value


async def _meter(meter: Any) -> Any:
    return await _number(await meter.power())


async def _axis(axis: Any) -> Any:
    return await _number(await axis.position())


async def _safety(one: Any) -> Any:
    found = (await one.read()).safe
    return UNKNOWN if found is None else found


def _power(draw: random.Random) -> tuple[str, Any]:
    return "power", draw.choice([0.0, -1e-9, 10 ** draw.uniform(-9, 0), draw.uniform(0, 1)])


def _truth(what: str) -> Callable[[random.Random], tuple[str, Any]]:
    return lambda draw: (what, draw.random() < 0.5)


def _frame(draw: random.Random) -> tuple[str, Any]:
    shape = draw.choice([(4, 6), (3, 2, 3), (1, 1)])
    size = int(np.prod(shape))
    kind = draw.choice([np.uint8, np.uint16])
    return "frame", np.array([draw.randrange(256) for _ in range(size)], kind).reshape(shape)


def _gray(kind: str = "uint8") -> Any:
    return np.zeros((cameras.ROWS, cameras.COLUMNS), kind)


def _grays(*kinds: str) -> Callable[[random.Random], tuple[str, Any]]:
    what = "depth" if "depth" in kinds else "gray"

    def drawn(draw: random.Random) -> tuple[str, Any]:
        kind = draw.choice([one for one in kinds if one != "depth"])
        size = cameras.ROWS * cameras.COLUMNS
        return what, np.array([draw.randrange(256) for _ in range(size)], kind).reshape(cameras.ROWS, cameras.COLUMNS)

    return drawn


def _asks(word: bytes) -> Callable[[bytes], bool]:
    return lambda data: word in data


def _box(driver: str) -> DeviceEntry:
    return DeviceEntry(driver=driver, emulator="switches", address={"host": "", "port": 0, "name": "s1"})


def _visa(driver: str, stands_in: str, **address: int) -> DeviceEntry:
    return DeviceEntry(driver=driver, emulator=stands_in, address={"visa": "", **address}, identity=WHO)


def _elliptec(driver: str, model: str, **settings: Any) -> DeviceEntry:
    address: dict[str, str | int] = {"port": "", "bus": "2"}
    return DeviceEntry(
        driver=driver, emulator="elliptec", address=address, identity={"serial": "11400517", "model": model},
        settings=settings,
    )  # fmt: skip


def _values(driver: str, **settings: Any) -> DeviceEntry:
    return DeviceEntry(driver=driver, emulator="scpi.values", address={"visa": ""}, identity=WHO, settings=settings)


async def _number_of(asked: Any) -> Any:
    return await _number(await asked)


def _temperature(draw: random.Random) -> tuple[str, Any]:
    return "value", draw.choice([0.0, -1e-9, draw.uniform(-300, 300), 10 ** draw.uniform(-12, 12)])


def _named(draw: random.Random) -> tuple[str, Any]:
    return "position", draw.choice(list(NAMES.values()))


NAMES = {"1": "open", "2": "nd1", "3": "nd2", "4": "nd3"}
ODD = (b"9.9E37\n", b"-9.90000E+37\n", b"9.91E37\n", b"NAN\n", b"inf\n", b"OVLD\n", b"\n", b'-113,"Undefined header"\n')
BAD = (b"\n", b"what?\n", b"1", b"? 1\n", b"999 1\n", b"1 1 1\n")
CASES: dict[str, Case] = {
    "scpi.meter": Case(
        _visa("scpi.meter", "scpi.meter"), {}, _asks(b"MEAS:POW?"), _meter, _power, grammar.scpi_number,
        grammar.other_number, ODD),
    "pymeasure.pm100": Case(
        _visa("pymeasure.pm100", "scpi.meter"), {}, _asks(b"POW"), _meter, _power, grammar.scpi_number,
        grammar.other_number, ODD),
    "scpi.number": Case(
        _values("scpi.number", read="MEAS:TEMP?", unit="degC"), {}, _asks(b"MEAS:TEMP?"),
        lambda one: _number_of(one.number("value")), _temperature, grammar.scpi_number, grammar.other_number, ODD),
    "scpi.choice": Case(
        _values("scpi.choice", read="FILT?", set="FILT {}", positions=NAMES, moving="MOV"), {"position": "open"},
        _asks(b"FILT?"), lambda one: _number_of(one.position()), _named, grammar.scpi_choice(NAMES),
        grammar.other_choice, (b"MOV\n", b"5\n", b"0\n", b"1.5\n", b"open\n", *ODD)),
    "scpi.laser": Case(
        _visa("scpi.laser", "scpi.laser"), {}, _asks(b"OUTP?"), lambda one: one.emitting(), _truth("emission"),
        grammar.scpi_switch, grammar.other_switch, ODD),
    "scpi.safety": Case(
        _visa("scpi.safety", "scpi.contacts", channel=4), {}, _asks(b"INP?"), _safety, _truth("contact"),
        grammar.contact, others=(b"1\n", b"1,1\n", b"1,0\n", b",\n", *ODD)),
    "scpi.shutter": Case(
        _visa("scpi.shutter", "scpi.contacts", channel=3, relay=1), {}, _asks(b"INP?"), lambda one: one.is_open(),
        _truth("open"), grammar.contact_of_shut, others=(b"1\n", b"1,1\n", b"0,0\n", *ODD)),
    "switches.input": Case(_box("switches.input"), {}, _asks(b"read"), _safety, _truth("safe"),
                           grammar.switch_of_input,
                           others=BAD),
    "switches.shutter": Case(_box("switches.shutter"), {}, _asks(b"read"), lambda one: one.is_open(), _truth("open"),
                             grammar.switch, others=BAD),
    "switches.laser": Case(_box("switches.laser"), {}, _asks(b"read"), lambda one: one.emitting(), _truth("emission"),
                           grammar.switch, others=BAD),
    "elliptec.rotator": Case(
        _elliptec("elliptec.rotator", "ELL14"), {"angle": 0.0}, _asks(b"2gp"), _axis,
        lambda draw: ("angle", draw.uniform(0, 359)), grammar.elliptec(360.0 / 143360),
        others=(b"2GS09\r\n", b"2GS02\r\n", b"3PO00001000\r\n", b"2PO0000\r\n", b"\r\n", b"2PO"),
        first=lambda axis: axis.home()),
    "elliptec.stage": Case(
        _elliptec("elliptec.stage", "ELL20"), {"position": 0.0}, _asks(b"2gp"), _axis,
        lambda draw: ("position", draw.uniform(0, 59)), grammar.elliptec(1 / 1024.0),
        others=(b"2GS09\r\n", b"3PO00001000\r\n", b"2PO0000\r\n", b"2GJ00000400\r\n"),
        first=lambda axis: axis.home()),
    "elliptec.slider": Case(
        _elliptec("elliptec.slider", "ELL9", positions=NAMES), {"position": "open"}, _asks(b"2gp"),
        lambda one: _number_of(one.position()), _named, grammar.slider(NAMES, travel=96), grammar.other_slider,
        (b"2GS09\r\n", b"3PO00000020\r\n", b"2PO0020\r\n", b"2PO00000010\r\n", b"2PO\r\n", b"2GJ00000020\r\n")),
    "zaber.stage": Case(
        DeviceEntry(driver="zaber.stage", emulator="zaber", address={"host": "", "port": "0", "device": 1},
                    identity={"serial": "12345"}, limits={"position": (0, 50)},
                    settings={"counts_per_unit": 20997.375, "emulated_speed": 1000.0}),
        {"position": 0.0, "homed": True}, _asks(b"get pos"), _axis,
        lambda draw: ("position", draw.uniform(0, 50)), grammar.zaber(20997.375), grammar.other_zaber,
        (b"@01 0 00 RJ IDLE -- BADCOMMAND\r\n", b"@02 1 00 OK IDLE -- 5\r\n", b"\r\n", b"!01 1 IDLE --\r\n")),
    "frames.camera": Case(
        DeviceEntry(driver="frames.camera", emulator="frames", address={"host": "", "port": 0},
                    identity={"serial": "7"}),
        {"frame": np.zeros((2, 2), np.uint8)}, _asks(b"grab"), lambda one: one.grab(), _frame, grammar.frame,
        others=(b"null\n", b"[]\n", b"{}\n", b"\n", b'{"id": 1e999}\n', b"{" * 5000 + b"\n")),
}  # fmt: skip
ROBOT: dict[str, Case] = {
    "xarm.arm-joints": Case(
        xarm.ARM, {}, xarm.asks(xarm.JOINTS), xarm.joints, xarm.posture, xarm.joints_of, xarm.other_joints,
        odd=xarm.odd(*xarm.ODD_JOINTS), wire=xarm.wire),
    "xarm.arm-state": Case(
        xarm.ARM, {}, xarm.asks(xarm.STATE), xarm.moving, lambda draw: ("state", draw.choice([2, 4])), xarm.moving_of,
        xarm.with_warning, odd=xarm.odd(*xarm.ODD_STATE), wire=xarm.wire),
    "xarm.arm-fault": Case(
        xarm.ARM, {}, xarm.asks(xarm.FAULT), xarm.fault, lambda draw: ("fault", draw.choice([0, 0, 22, 31])),
        xarm.fault_of, xarm.with_warning, odd=xarm.odd(*xarm.ODD_STATE), wire=xarm.wire),
    "xarm.arm-report": Case(
        xarm.ARM, {}, lambda asked: asked == b"report30002", xarm.enabled, lambda draw: ("", None), xarm.enabled_of,
        xarm.other_motors, odd=xarm.odd(*xarm.ODD_REPORT), wire=xarm.wire, first=lambda arm: arm.ready()),
    "xarm.gripper-position": Case(
        xarm.GRIPPER, {}, xarm.asks(xarm.RTU, bytes([8, 3, 0x07, 0x02])), xarm.width, xarm.position, xarm.width_of,
        xarm.with_warning, odd=xarm.ill_modbus, wire=xarm.wire),
    "xarm.gripper-status": Case(
        xarm.GRIPPER, {}, xarm.asks(xarm.RTU, bytes([8, 3, 0, 0])), xarm.holds, xarm.position, xarm.holds_of,
        xarm.with_warning, odd=xarm.ill_modbus, wire=xarm.wire),
    "xarm.gripper-fault": Case(
        xarm.GRIPPER, {}, xarm.asks(xarm.RTU, bytes([8, 3, 0, 0x0F])), xarm.claw_fault,
        lambda draw: ("claw fault", draw.choice([0, 0, 9, 14])), xarm.claw_fault_of, xarm.with_warning,
        odd=xarm.ill_modbus, wire=xarm.wire),
}  # fmt: skip
CAMERAS: dict[str, Case] = {
    "basler.camera": Case(
        cameras.BASLER, {"gray": _gray()}, _asks(b"gray"), lambda one: one.grab(), _grays("uint8", "uint16"),
        cameras.gray("uint8", "uint16"), odd=cameras.odd, wire=cameras.wire("pypylon.pylon", cameras.pylon)),
    "realsense.camera": Case(
        cameras.DEPTH, {"gray": _gray()}, _asks(b"gray"), lambda one: one.grab(), _grays("uint8"),
        cameras.gray("uint8"), odd=cameras.odd, wire=cameras.wire("pyrealsense2", cameras.realsense)),
    "realsense.camera-depth": Case(
        cameras.DEPTH, {"depth": _gray("uint16")}, _asks(b"depth"), lambda one: one.depth(), _grays("uint16", "depth"),
        cameras.depth, odd=cameras.odd, wire=cameras.wire("pyrealsense2", cameras.realsense)),
}  # fmt: skip
CASES |= ROBOT | CAMERAS
