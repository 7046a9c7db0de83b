"""Devices for the contract: an entry of each driver, what stands behind its emulator, what reads and what moves it."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from pico.diagnostics import PicoError, error
from pico.model.wiring import DeviceEntry


@dataclass(frozen=True)
class Case:
    """A driver under contract. `reads` is asked again and again, and is `is_` what it reads; `moves` moves to another
    place, and what is `moved` then is behind it; `beyond` asks for what its limits don't allow."""

    entry: DeviceEntry
    at_first: dict[str, Any]
    reads: Callable[[Any], Awaitable[Any]]
    is_: Any
    begins: Callable[[Any], Awaitable[Any]] | None = None
    moves: Callable[[Any], Awaitable[Any]] | None = None
    moved: tuple[str, Any] = ("", None)
    beyond: Callable[[Any], Awaitable[Any]] | None = None
    stuck: float | None = None
    other: Any = None
    """Another value of the same, that the world may come to have meanwhile."""
    tells: bool = True
    """Whether it raises where it can't read; a safety input reads unsafe instead."""
    silent: bool = False
    """Whether it tells nothing of itself, so that `reads` switches it off instead."""


async def _power(meter: Any) -> float:
    found = await meter.power()
    if found.unknown:
        raise PicoError(error(found.unknown, found.why, address="it"))
    return float(found.value)


async def _volts(number: Any) -> float:
    return float(_known(await number.number("value")))


async def _set(number: Any, value: float) -> float:
    return float(_known(await number.set_number("value", value)))


async def _position(choice: Any) -> str:
    return str(_known(await choice.position()))


def _known(found: Any) -> Any:
    if found.unknown:
        raise PicoError(error(found.unknown, found.why, address="it"))
    return found.value


async def _safe(safety: Any) -> bool | None:
    found: bool | None = (await safety.read()).safe
    return found


async def _sum(camera: Any) -> int:
    return int((await camera.grab()).sum())


def _bright(pixels: int) -> Any:
    return np.full((4, 6), pixels, np.uint8)


def _box(driver: str) -> DeviceEntry:
    address: dict[str, str | int] = {"host": "", "port": 0, "name": "s1"}
    return DeviceEntry(driver=driver, emulator="switches", address=address, identity={"serial": "7"})


WHO = {"vendor": "Acme", "model": "M1", "serial": "S42", "firmware": "1.2"}
CASES = {
    "elliptec.rotator": Case(
        DeviceEntry(driver="elliptec.rotator", emulator="elliptec", address={"port": "", "bus": "2"},
                    identity={"serial": "11400517"}, limits={"angle": (0, 180)}),
        {"angle": 0.0}, lambda axis: axis.position(), 0.0, begins=lambda axis: axis.home(),
        moves=lambda axis: axis.move_to(170.0), moved=("angle", 170.0), beyond=lambda axis: axis.move_to(181.0),
        stuck=80.0, other=30.0),
    "elliptec.stage": Case(
        DeviceEntry(driver="elliptec.stage", emulator="elliptec", address={"port": "", "bus": "3"},
                    identity={"serial": "11700042", "model": "ELL20"}, limits={"position": (0, 58)}),
        {"position": 0.0}, lambda axis: axis.position(), 0.0, begins=lambda axis: axis.home(),
        moves=lambda axis: axis.move_to(55.0), moved=("position", 55.0), beyond=lambda axis: axis.move_to(58.5),
        stuck=10.0, other=5.0),
    "zaber.stage": Case(
        DeviceEntry(driver="zaber.stage", emulator="zaber", address={"host": "", "port": "0", "device": 1},
                    identity={"serial": "12345"}, limits={"position": (0, 50)},
                    settings={"counts_per_unit": 20997.375, "emulated_speed": 60.0}),
        {"position": 0.0}, lambda axis: axis.position(), 0.0, begins=lambda axis: axis.home(),
        moves=lambda axis: axis.move_to(40.0), moved=("position", 40.0), beyond=lambda axis: axis.move_to(51.0),
        stuck=20.0, other=10.0),
    "scpi.meter": Case(
        DeviceEntry(driver="scpi.meter", emulator="scpi.meter", address={"visa": ""}, identity=WHO,
                    limits={"wavelength": (400, 700)}),
        {"power": 0.0012}, _power, 0.0012, other=0.0034, beyond=lambda meter: meter.power(wavelength=900.0)),
    "pymeasure.pm100": Case(
        DeviceEntry(driver="pymeasure.pm100", emulator="scpi.meter", address={"visa": ""}, identity=WHO,
                    limits={"wavelength": (400, 700)}),
        {"power": 0.0012}, _power, 0.0012, other=0.0034, beyond=lambda meter: meter.power(wavelength=900.0)),
    "scpi.number": Case(
        DeviceEntry(driver="scpi.number", emulator="scpi.values", address={"visa": ""}, identity=WHO,
                    limits={"value": (-10, 10)},
                    settings={"read": "MEAS:VOLT?", "set": "VOLT {}", "unit": "V", "sigma": 0.001}),
        {"value": 1.5}, _volts, 1.5, other=2.5, moves=lambda number: _set(number, 4.0),
        moved=("value", 4.0), beyond=lambda number: number.set_number("value", 11.0)),
    "scpi.choice": Case(
        DeviceEntry(driver="scpi.choice", emulator="scpi.values", address={"visa": ""}, identity=WHO,
                    settings={"read": "POS?", "set": "POS {}", "positions": {"1": "open", "2": "nd1", "3": "nd2"}}),
        {"position": "open"}, _position, "open", other="nd1", moves=lambda choice: choice.move_to("nd2"),
        moved=("position", "nd2"), beyond=lambda choice: choice.move_to("nd9")),
    "elliptec.slider": Case(
        DeviceEntry(driver="elliptec.slider", emulator="elliptec", address={"port": "", "bus": "4"},
                    identity={"serial": "10900042", "model": "ELL9"},
                    settings={"positions": {"1": "open", "2": "nd1", "3": "nd2"}}),
        {"position": "open"}, _position, "open", other="nd1", moves=lambda choice: choice.move_to("nd2"),
        moved=("position", "nd2"), beyond=lambda choice: choice.move_to("nd9")),
    "scpi.laser": Case(
        DeviceEntry(driver="scpi.laser", emulator="scpi.laser", address={"visa": ""}, identity=WHO),
        {"emission": False}, lambda laser: laser.emitting(), False, other=True,
        moves=lambda laser: laser.emit(True), moved=("emission", True)),
    "scpi.shutter": Case(
        DeviceEntry(driver="scpi.shutter", emulator="scpi.contacts", address={"visa": "", "channel": 3, "relay": 1},
                    identity=WHO),
        {"open": False}, lambda shutter: shutter.is_open(), False, other=True,
        moves=lambda shutter: shutter.open(True), moved=("open", True)),
    "scpi.safety": Case(
        DeviceEntry(driver="scpi.safety", emulator="scpi.contacts", address={"visa": "", "channel": 4}, identity=WHO),
        {"contact": True}, _safe, True, other=False, tells=False),
    "switches.laser": Case(
        _box("switches.laser"), {"emission": False}, lambda laser: laser.emitting(), False, other=True,
        moves=lambda laser: laser.emit(True), moved=("emission", True)),
    "switches.shutter": Case(
        _box("switches.shutter"), {"open": False}, lambda shutter: shutter.is_open(), False, other=True,
        moves=lambda shutter: shutter.open(True), moved=("open", True)),
    "switches.input": Case(_box("switches.input"), {"safe": True}, _safe, True, other=False),
    "scpi.lamp": Case(
        DeviceEntry(driver="scpi.lamp", emulator="scpi.contacts", address={"visa": "", "relay": 2}, identity=WHO),
        {"on": False}, lambda lamp: lamp.shine(False), False, other=False, moves=lambda lamp: lamp.shine(True),
        moved=("on", True), silent=True),
    "switches.lamp": Case(
        _box("switches.lamp"), {"on": False}, lambda lamp: lamp.shine(False), False, other=False,
        moves=lambda lamp: lamp.shine(True), moved=("on", True), silent=True),
    "frames.camera": Case(
        DeviceEntry(driver="frames.camera", emulator="frames", address={"host": "", "port": 0},
                    identity={"serial": "7"}),
        {"frame": _bright(3)}, _sum, 72, other=_bright(5)),
}  # fmt: skip
