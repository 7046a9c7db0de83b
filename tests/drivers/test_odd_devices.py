"""Devices that speak otherwise than most, at the wire: linear Elliptec, firmware that says that it rests, other line
ends, identities of one field to many, cameras that repeat a picture."""

from __future__ import annotations

import asyncio
import json
import zlib
from collections.abc import Awaitable, Callable, Iterator
from contextlib import contextmanager
from typing import Any

import pytest

from pico.diagnostics import PicoError
from pico.drivers.driven import Motorized
from pico.drivers.registry import Buses, driver
from pico.emulators.behind import Alone
from pico.emulators.elliptec import KINDS, Mount, MountBus
from pico.emulators.serving import Conversation, SerialServed, TcpServed
from pico.manifest.load import load_folder
from pico.model.instruments.conversions import conversion_of
from pico.model.wiring import DeviceEntry, Wired
from pico.resources import labs_dir


def asked(entry: DeviceEntry, ask: Callable[[Any], Awaitable[Any]]) -> Any:
    """Connect to a device and ask it; return what comes, or the diagnostic of what is raised."""

    async def go() -> Any:
        buses = Buses()
        try:
            one: Any = buses.opened("it", entry)
            await one.connect()
            return await ask(one)
        except PicoError as exc:
            assert exc.diagnostics[0].address == "it"
            return exc.diagnostics[0]
        finally:
            await buses.close()

    return asyncio.run(go())


# Elliptec


@contextmanager
def line(mount: Mount) -> Iterator[dict[str, str | int]]:
    served = SerialServed(MountBus({"2": mount}))
    try:
        yield {**served.address, "bus": "2"}
    finally:
        served.close()


class Restless(Mount):
    """One whose firmware answers `gs` by 0 while it moves, and is silent at the end."""

    def _told(self, name: str, hexadecimal: str, now: float) -> str:
        return "GS00" if name == "gs" else super()._told(name, hexadecimal, now)

    def ended(self) -> str:
        super().ended()
        return ""


@pytest.mark.parametrize(("model", "kind", "goal"), [
    ("ELL14", "elliptec.rotator", 170.0), ("ELL17", "elliptec.stage", 20.0), ("ELL20", "elliptec.stage", 55.0),
])  # fmt: skip
@pytest.mark.parametrize("made", [Mount, Restless])
def test_a_device_arrives_by_its_own_pulses_whatever_its_firmware_says_on_the_way(
    made: type[Mount], model: str, kind: str, goal: float
) -> None:
    behind = Alone({KINDS[model].moves: 0.0})
    with line(made("11400517", behind, KINDS[model])) as address:

        async def go(axis: Any) -> list[Any]:
            found = [await axis.position(), await axis.home()]
            return [*found, await axis.move_to(goal), await axis.position(), (await axis.connect()).model]

        found = asked(DeviceEntry(driver=kind, address=address, identity={"serial": "11400517"}), go)
    assert found[0] is None and found[1] == pytest.approx(0.0, abs=0.01)
    assert found[2:4] == [pytest.approx(goal, abs=0.1)] * 2 and found[4] == model
    assert behind.read(KINDS[model].moves) == pytest.approx(goal, abs=0.1)


@pytest.mark.parametrize(("model", "kind", "said"), [
    ("ELL17", "elliptec.rotator", "it is a linear stage (ELL17), and is wired as a rotation mount"),
    ("ELL14", "elliptec.stage", "it is a rotation mount (ELL14), and is wired as a linear stage"),
])  # fmt: skip
def test_a_linear_device_is_told_from_a_rotator_before_it_moves(model: str, kind: str, said: str) -> None:
    behind = Alone({KINDS[model].moves: 5.0})
    with line(Mount("11400517", behind, KINDS[model])) as address:
        found = asked(DeviceEntry(driver=kind, address=address), lambda axis: axis.move_to(10.0))
    assert (found.code, found.summary) == ("device-kind", said)
    assert "write `driver: elliptec." in found.hint and behind.read(KINDS[model].moves) == 5.0


def test_a_stage_drives_as_far_as_it_says_itself() -> None:
    with line(Mount("1", Alone({"position": 0.0}), KINDS["ELL17"])) as address:
        found = asked(DeviceEntry(driver="elliptec.stage", address=address), lambda axis: axis.move_to(28.5))
    assert found.code == "device-limit" and "0 to 28 mm" in found.summary


def test_a_failure_is_told_once() -> None:
    behind = Alone({"angle": 0.0, "stuck": 20.0})
    with line(Mount("1", behind)) as address:

        async def go(axis: Any) -> Any:
            await axis.home()
            with pytest.raises(PicoError, match="mechanical time out"):
                await axis.move_to(40.0)
            behind.write("stuck", None)
            return await axis.position(), await axis.move_to(10.0)

        found = asked(DeviceEntry(driver="elliptec.rotator", address=address), go)
    assert found == (pytest.approx(20.0, abs=0.1), pytest.approx(10.0, abs=0.1))


def test_a_polarizer_whose_axis_is_not_at_its_mounts_zero_is_set_by_whole_turns() -> None:
    setup = load_folder(labs_dir() / "shel").setup
    assert setup is not None
    behind = Alone({"angle": 0.0})
    with line(Mount("1", behind)) as address:
        entry = DeviceEntry(driver="elliptec.rotator", address=address, of="p1")

        async def go(axis: Any) -> Any:
            await axis.home()
            made = conversion_of(
                setup, driver(entry.driver), entry, "p1", "angle", Wired(property="angle", offset=12.5)
            )
            tunable = Motorized(axis, made)
            return await tunable.set(5.0), behind.read("angle"), (await tunable.read()).value

        found = asked(entry, go)
    assert found == (pytest.approx(5.0, abs=0.01), pytest.approx(352.5, abs=0.01), pytest.approx(5.0, abs=0.01))


# SCPI


class Scripted:
    """A device that answers lines by a table, with line ends of its own."""

    def __init__(self, replies: dict[str, str], ends: str = "\n") -> None:
        self.replies, self.ends, self.rest, self.heard_lines = replies, ends, "", list[str]()

    def heard(self, data: bytes) -> bytes:
        *lines, self.rest = (self.rest + data.decode("latin-1")).split(self.ends)
        self.heard_lines += lines
        return b"".join(f"{self.replies[one]}{self.ends}".encode("latin-1") for one in lines if one in self.replies)

    def due(self) -> bytes:
        return b""


@contextmanager
def scripted(conversation: Conversation, *, serial: bool = False) -> Iterator[dict[str, str | int]]:
    served = SerialServed(conversation) if serial else TcpServed(lambda: conversation)
    where = f"ASRL{served.address['port']}::INSTR" if serial else f"TCPIP0::127.0.0.1::{served.address['port']}::SOCKET"
    try:
        yield {"visa": where}
    finally:
        served.close()


METER = {"*IDN?": "Acme,M1,S42,1.2", "MEAS:POW?": "1.2E-3", "SYST:ERR?": '0,"No error"', "SENS:CORR:WAV?": "633"}


@pytest.mark.parametrize(("reply", "identity", "known"), [
    ("Acme,M1,S42,1.2", {"serial": "S42", "vendor": "Acme"}, True),
    ("Acme Laser 500", {"model": "Acme Laser 500"}, True),
    ("Acme,M1", {"vendor": "Acme", "model": "M1"}, True), ("Acme,M1,S42", {"serial": "S42"}, True),
    ("Acme,M1,S42,1.2,opt 7,cal 3", {"serial": "S42", "firmware": "1.2,opt 7,cal 3"}, True), ("Acme,M1,S42", {}, True),
    ("Acme Laser 500", {"model": "Acme Laser 501"}, False), ("Acme,M1", {"serial": "S42"}, False),
])  # fmt: skip
def test_an_identity_of_any_number_of_fields_is_compared_with_what_the_lab_says(
    reply: str, identity: Any, known: bool
) -> None:
    with scripted(Scripted({**METER, "*IDN?": reply})) as address:
        found = asked(DeviceEntry(driver="scpi.meter", address=address, identity=identity), lambda one: one.power())
    assert found.value == 0.0012 if known else found.code == "device-identity"


@pytest.mark.parametrize(("reply", "emits"), [("1", True), ("ON", True), ("0", False), ("OFF", False), ("off", False)])
def test_a_laser_may_say_on_or_1(reply: str, emits: bool) -> None:
    with scripted(Scripted({**METER, "OUTP?": reply})) as address:
        assert asked(DeviceEntry(driver="scpi.laser", address=address), lambda one: one.emitting()) is emits


def test_a_serial_line_has_its_speed_and_line_ends_from_the_lab() -> None:
    device = Scripted(METER, ends="\r")
    settings = {
        "baud_rate": 115200,
        "read_termination": "\r",
        "write_termination": "\r",
        "stop_bits": 2,
        "timeout": 2,
    }
    with scripted(device, serial=True) as address:
        entry = DeviceEntry(driver="scpi.meter", address=address, settings=settings)
        assert [*driver("scpi.meter").complaints(entry)] == []

        async def go(one: Any) -> Any:
            link = one._line._known[0].resource
            return (await one.power()).value, link.baud_rate, link.stop_bits.name, link.timeout

        found = asked(entry, go)
    assert found == (0.0012, 115200, "two", 2000)


def test_a_meter_that_averages_is_waited_for_as_long_as_the_lab_says() -> None:
    class Slow(Scripted):
        waits = 0

        def heard(self, data: bytes) -> bytes:
            said = super().heard(data)
            if b"MEAS" in data:
                self.waits = 300  # 1.5 s of turns of the server
                return b""
            return said

        def due(self) -> bytes:
            self.waits -= 1
            return b"2.5E-3\n" if self.waits == 0 else b""

    with scripted(Slow(METER)) as address:
        entry = DeviceEntry(driver="scpi.meter", address=address, settings={"timeout": 4.0})
        assert asked(entry, lambda one: one.power()).value == 0.0025


@pytest.mark.parametrize("backend", ["none.yaml@sim"])
def test_another_backend_than_pyvisas_own_is_asked_for_by_its_name(backend: str) -> None:
    entry = DeviceEntry(driver="scpi.meter", address={"visa": "ASRL1::INSTR"}, settings={"backend": backend})
    found = asked(entry, lambda one: one.power())
    assert found.code == "device-lost" and "sim" in found.summary


# cameras


class Server:
    """A server of frames that answers `grab` by what it is given, in turn."""

    def __init__(self, *answers: dict[str, Any]) -> None:
        self.answers, self.rest = list(answers), b""

    def heard(self, data: bytes) -> bytes:
        *lines, self.rest = (self.rest + data).split(b"\n")
        return b"".join(self.answer(json.loads(one)) for one in lines)

    def due(self) -> bytes:
        return b""

    def answer(self, request: dict[str, Any]) -> bytes:
        if request["do"] == "identify":
            return json.dumps({"id": request["id"], "serial": "7"}).encode() + b"\n"
        usual = {"id": request["id"], "shape": [2, 2], "dtype": "uint8", "bytes": 4, "crc32": zlib.crc32(b"abcd")}
        said = {**usual, **(self.answers.pop(0) if len(self.answers) > 1 else self.answers[0])}
        return json.dumps({k: v for k, v in said.items() if v is not None}).encode() + b"\nabcd"


@pytest.mark.parametrize(("answer", "said"), [
    ({"dtype": "float32", "shape": [1, 1]}, "its pixels are of type 'float32', not uint8 or uint16"),
    ({"dtype": None}, "its pixels are of type missing"), ({"shape": None}, "its shape is missing"),
    ({"shape": [2, 3]}, "it came with 4 bytes, and [2, 3] pixels of uint8 are 6"), ({"shape": "2x2"}, "its shape is"),
    ({"shape": [4, 1, 1]}, "its shape is [4, 1, 1]"), ({"dtype": ["uint8"]}, "its pixels are of type"),
])  # fmt: skip
def test_a_picture_that_is_none_is_told_in_words(answer: dict[str, Any], said: str) -> None:
    served = TcpServed(lambda: Server(answer))
    try:
        found = asked(DeviceEntry(driver="frames.camera", address=served.address), lambda camera: camera.grab())
    finally:
        served.close()
    assert found.code == "device-reply" and said in found.summary and "camera's answer is no picture" in found.summary


def test_a_picture_that_was_sent_before_is_none() -> None:
    served = TcpServed(lambda: Server({"number": 3}, {"number": 4}, {"number": 4}, {"number": 5}, {"number": 1.5}, {}))

    async def go(camera: Any) -> list[Any]:
        found = []
        for _ in range(6):
            try:
                found.append(int((await camera.grab()).sum()))
            except PicoError as exc:
                found.append(exc.diagnostics[0].code)
        return found

    try:
        found = asked(DeviceEntry(driver="frames.camera", address=served.address), go)
    finally:
        served.close()
    whole = sum(b"abcd")
    assert found == [whole, whole, "stale", whole, "device-reply", whole]


@pytest.mark.parametrize("kind", ["scpi.safety", "scpi.shutter"])
def test_an_earlier_answer_of_a_contact_is_none(kind: str) -> None:
    replies = {**METER, "INP? (@4)": "1,7"}
    with scripted(Scripted(replies)) as address:

        async def go(one: Any) -> list[Any]:
            found: list[Any] = []
            for said in ("1,7", "1,7", "1,6", "1,7", "0,8"):
                replies["INP? (@4)"] = said
                found.append((await one.read()).safe if kind == "scpi.safety" else await one.is_open())
            return found

        closed = asked(DeviceEntry(driver=kind, address={**address, "channel": 4, "relay": 1}), go)
    wanted = [True, None, None, True, False]
    assert closed == (wanted if kind == "scpi.safety" else [None if c is None else not c for c in wanted])


class Unit(Scripted):
    """A meter that was set to dBm, and can be set to W; one that does not know the question, if it is `plain`."""

    def __init__(self, plain: bool) -> None:
        self._plain = plain
        known = {**METER, "SYST:SENSOR:IDN?": "S130C,SN 1104,,1,1,33"}
        super().__init__({**known, **({} if plain else {"SENS:POW:UNIT?": "DBM", "MEAS:POW?": "7.918125E-01"})})

    def heard(self, data: bytes) -> bytes:
        if b"SENS:POW:UNIT W" in data and not self._plain:
            self.replies.update({"SENS:POW:UNIT?": "W", "MEAS:POW?": "1.2E-3"})
        return super().heard(data)


@pytest.mark.parametrize("driver", ["scpi.meter", "pymeasure.pm100"])
@pytest.mark.parametrize("plain", [False, True])
def test_a_power_is_in_watts_whatever_the_meter_was_set_to(driver: str, plain: bool) -> None:
    with scripted(Unit(plain)) as address:
        found = asked(DeviceEntry(driver=driver, address=address), lambda one: one.power())
    assert (found.value, found.unit) == (0.0012, "W"), found


@pytest.mark.parametrize(("reply", "value"), [
    ("0.0012\n0", None), ("1.0E-1\n0", None), ("0.0012\n394", None), ("0.0012", 0.0012), ("0.0012\n", 0.0012),
    ("0.0012\n\r", 0.0012),
])  # fmt: skip
def test_a_number_whose_line_was_broken_is_none(reply: str, value: float | None) -> None:
    class Broken(Scripted):
        def heard(self, data: bytes) -> bytes:
            said = super().heard(data)
            return said.removesuffix(b"\n") if value is None and b"POW" in data else said

    with scripted(Broken({**METER, "MEAS:POW?": reply})) as address:
        found = asked(DeviceEntry(driver="scpi.meter", address=address), lambda one: one.power())
    assert found.value == value and found.unknown in ((None,) if value else ("garbled", "instrument-error"))
