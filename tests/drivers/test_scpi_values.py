"""What a lab's file says of a number or a choice is judged at its line, and what comes back is never a wrong value."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Awaitable, Callable
from dataclasses import replace
from pathlib import Path
from runpy import run_path
from typing import Any

import pytest

from pico.diagnostics import PicoError
from pico.drivers.registry import Buses
from pico.drivers.scpi_values import position_of
from pico.emulators.behind import Alone
from pico.emulators.registry import EmulatedBench
from pico.manifest.load import load_files
from pico.model.catalog import Tunable
from pico.model.instruments.kind import name_at, value_at
from pico.model.instruments.kinds import kind_names, kind_of
from pico.model.wiring import DeviceEntry
from pico.resources import labs_dir

LAB = (labs_dir() / "shel" / "lab.yaml").read_text()
OWN = """inventory:
  wheel: {type: filter_wheel, pose: {x: 300, y: 600, yaw: 0}}
  pd: {type: photodiode, pose: {x: 900, y: 120, yaw: 0}}
"""
HEAD = "apiVersion: pico/v1\nkind: Devices\nmetadata: {lab: shel}\ndevices:\n"
WHEEL = """\
  motor:
    of: wheel
    driver: scpi.choice
    address: {visa: "TCPIP0::192.0.2.1::5025::SOCKET"}
    settings: {read: "POS?", set: "POS {}", positions: {1: at_1, 2: at_2}}
"""
VOLTS = """\
  volts:
    of: pd
    driver: scpi.number
    address: {visa: "TCPIP0::192.0.2.2::5025::SOCKET"}
    settings: {read: "MEAS:VOLT?", unit: mV, sigma: 2}
    map: {voltage: {property: value}}
"""


def wrong(text: str) -> list[tuple[str, str]]:
    files = {"lab.yaml": LAB.replace("inventory:\n", OWN, 1).encode(), "devices.yaml": (HEAD + text).encode()}
    return [(str(d.source), f"{d.summary} ({d.hint})") for d in load_files(files).diagnostics if d.code != "no-state"]


def test_a_choice_and_a_number_fit_the_parts_of_the_catalog() -> None:
    assert wrong(WHEEL + VOLTS) == []


@pytest.mark.parametrize(("written", "instead", "at", "said"), [
    ("2: at_2", "2: at_22", 9, "`at_22` is no value of wheel.position (did you mean `at_2`"),
    ("POS {}", "POS", 9, "`POS` has not one `{}`"),
    ("{1: at_1, 2: at_2}", "{1: at_1}", 9, "`positions` are two different names at least"),
    ("{1: at_1, 2: at_2}", "open", 9, "`positions` is a mapping, not `open`"),
    ("positions", "position", 9, "has no setting `position` (did you mean `positions`?"),
    ("unit: mV", "unit: mW", 10, "pd.voltage is in V"),
    ("unit: mV", "unit: vollt", 9, "the unit of `value`"),
    ("property: value", "property: volts", 10, "has no property `volts` (it has `value`)"),
    ("sigma: 2", "sigma: {x: 2}", 9, "`x` is not read, and has a `sigma`"),
    ("scpi.choice", "scpi.number", 7, "has no setting `positions`"),
])  # fmt: skip
def test_what_does_not_fit_is_told_at_its_line(written: str, instead: str, at: int, said: str) -> None:
    text = WHEEL if written in WHEEL else VOLTS
    found = wrong(text.replace(written, instead, 1))
    assert any(said in one for _, one in found), found
    if len(found) == 1:
        assert found[0][0].startswith(f"devices.yaml:{at}:"), found


def test_a_tunable_that_is_only_read_and_a_number_set_without_limits_are_refused() -> None:
    ((_, said),) = wrong(WHEEL.replace('set: "POS {}", ', "") + "    map: {position: {property: position}}\n")
    assert "wheel.position is set, and `position` of motor is only read" in said
    ((_, said),) = wrong(VOLTS.replace("unit:", 'set: "VOLT {}", unit:'))
    assert "`value` is set, and has no limits" in said


@pytest.mark.parametrize(("raw", "value", "reason"), [
    ("1", "open", None), (" 2\r\n", "nd1", None), ("+1", "open", None), ("2.0E0", "nd1", None), ("-1", None, "moving"),
    ("", None, "garbled"), ("3", None, "garbled"), ("11", None, "garbled"), ("1 2", None, "garbled"),
    ("9.91E37", None, "garbled"), ("nan", None, "garbled"), ("1_0", None, "garbled"), ("OPEN", None, "garbled"),
])  # fmt: skip
def test_a_reply_is_a_position_or_unknown_with_the_reason(raw: str, value: str | None, reason: str | None) -> None:
    found = position_of(raw, {"1": "open", "2": "nd1"}, -1)
    assert (found.value, found.unknown) == (value, reason)


def test_positions_are_values_of_a_tunable_of_any_datatype() -> None:
    for datatype, name, value in (("choice", "nd1", "nd1"), ("bool", "on", True), ("float", "10", 10.0)):
        tunable = Tunable(datatype=datatype, choices=("nd1",) if datatype == "choice" else ())  # type: ignore[arg-type]
        assert value_at(tunable, name) == value and name_at(["off", "20", name], value) == name
    assert value_at(Tunable(datatype="float"), "open") is None and name_at(["open"], None) is None


def test_each_kind_is_one_file_and_another_name_is_answered_by_those_that_there_are() -> None:
    assert len(kind_names()) == 12 and all(kind_of(name).name == name for name in kind_names())
    with pytest.raises(PicoError, match=r"there is no kind of instrument `lock-in`.*number"):
        kind_of("lock-in")


def asked(entry: DeviceEntry, behind: Alone, go: Callable[[Any], Awaitable[Any]]) -> Any:
    bench, buses = EmulatedBench({"it": entry}, lambda name, one: behind), Buses()

    async def connected() -> Any:
        one: Any = buses.opened("it", bench.entries["it"])
        await one.connect()
        try:
            return await go(one)
        finally:
            await buses.close()

    try:
        return asyncio.run(connected())
    finally:
        bench.close()


CHOICE = DeviceEntry(
    driver="scpi.choice", emulator="scpi.values", address={"visa": ""},
    settings={"read": "POS?", "set": "POS {}", "positions": {"1": "open", "2": "nd1"}, "moving": "-1", "seconds": 0.8},
)  # fmt: skip


def test_between_two_positions_it_is_unknown_and_what_does_not_arrive_is_told() -> None:
    async def go(one: Any) -> Any:
        moving = asyncio.create_task(one.move_to("nd1"))
        await asyncio.sleep(0.15)
        between = await one.position()
        return between.unknown, await moving, (await one.position()).value

    slow = Alone({"position": "open"}, clock=lambda: time.monotonic() / 4)
    assert asked(replace(CHOICE, settings={**CHOICE.settings, "seconds": 20}), slow, go) == ("moving", "nd1", "nd1")
    with pytest.raises(PicoError, match=r"was to move to nd1 within 0.8 s, and is at open"):
        asked(CHOICE, Alone({"position": "open", "stuck": True}), lambda one: one.move_to("nd1"))


def test_a_lock_in_is_several_numbers_of_one_device_which_need_not_say_who_it_is() -> None:
    entry = DeviceEntry(
        driver="scpi.number", emulator="scpi.values", address={"visa": ""},
        settings={"read": {"x": "OUTP? 1", "theta": "OUTP? 4"}, "unit": {"x": "V", "theta": "deg"}, "identify": "",
                  "sigma": {"x": 1e-6}, "error_queue": False},
    )  # fmt: skip
    found = asked(entry, Alone({"x": 2e-3}), lambda one: one.readouts())
    assert (found["x"].value, found["x"].unit, found["x"].sigma) == (0.002, "V", 1e-6)
    assert (found["theta"].unknown, found["theta"].unit) == ("no-number", "deg")


def test_the_page_of_kinds_is_as_the_registry_has_it() -> None:
    root = Path(__file__).resolve().parents[2]
    made = run_path(str(root / ".ci" / "instrument_kinds.py"))
    assert (root / "docs/reference/instrument-kinds.md").read_text() == made["page"](), "run `make docs`"


def test_closing_one_link_leaves_those_of_other_devices_open() -> None:
    first = replace(CHOICE, address={"visa": "one"}, settings={**CHOICE.settings})
    behind, buses = Alone({"position": "open"}), Buses()
    bench = EmulatedBench({"a": first, "b": replace(first, address={"visa": "two"})}, lambda name, one: behind)

    async def go() -> Any:
        one, other = (buses.opened(name, bench.entries[name]) for name in ("a", "b"))
        await asyncio.gather(one.connect(), other.connect())
        await one.close()
        found: Any = other
        try:
            return (await found.position()).value
        finally:
            await buses.close()

    try:
        assert asyncio.run(go()) == "open"
    finally:
        bench.close()


def test_what_lets_light_out_is_no_choice() -> None:
    text = WHEEL.replace("of: wheel", "of: laser").replace("{1: at_1, 2: at_2}", "{0: closed, 1: open}")
    ((_, said),) = wrong(text + "    map: {shutter: {property: position}}\n")
    assert "laser.shutter lets light out, and the guard of light can't end it through a choice" in said
