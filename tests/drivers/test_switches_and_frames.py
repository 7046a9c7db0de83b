"""Boxes of switches and servers of frames: each driver over TCP to its emulator, and what becomes of a bad one."""

from __future__ import annotations

import asyncio
import socket
import threading
import zlib
from collections.abc import Callable, Coroutine, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
import pytest

from pico.diagnostics import PicoError
from pico.drivers.frames import FrameLink
from pico.drivers.registry import Buses
from pico.emulators.behind import Alone
from pico.emulators.registry import EmulatedBench
from pico.model.wiring import DeviceEntry


def entry(driver: str, name: str = "", serial: str = "7") -> DeviceEntry:
    address: dict[str, str | int] = {"host": "192.168.1.20", "port": 4000}
    identity: Any = {"serial": serial}
    if name:
        address["name"] = name
    emulator = driver.partition(".")[0]
    return DeviceEntry(driver=driver, address=address, identity=identity, emulator=emulator)


def asked(bench: EmulatedBench, name: str, ask: Callable[[Any], Coroutine[Any, Any, Any]], **changed: Any) -> Any:
    async def go() -> Any:
        buses = Buses()
        try:
            one: Any = buses.opened(name, bench.entries[name])
            await one.connect()
            return await asyncio.wait_for(ask(one), 10)
        finally:
            await buses.close()

    return asyncio.run(go())


@contextmanager
def emulated(devices: dict[str, DeviceEntry], behind: Alone) -> Iterator[EmulatedBench]:
    bench = EmulatedBench(devices, lambda name, entry: behind)
    try:
        yield bench
    finally:
        bench.close()


def test_a_shutter_is_what_its_sensor_says() -> None:
    behind = Alone({"open": False})
    with emulated({"shutter": entry("switches.shutter", "shutter")}, behind) as bench:
        assert asked(bench, "shutter", lambda one: one.is_open()) is False
        assert asked(bench, "shutter", lambda one: one.open(True)) is True
        assert behind.read("open") is True


def test_a_shutter_that_does_not_move_is_told_as_it_is() -> None:
    class Jammed(Alone):
        def write(self, what: str, value: Any) -> None:
            """Nothing moves it."""

    with emulated({"shutter": entry("switches.shutter", "shutter")}, Jammed({"open": True})) as bench:
        assert asked(bench, "shutter", lambda one: one.open(False)) is True


def test_an_input_of_which_nothing_is_known_is_not_safe() -> None:
    with emulated({"curtain": entry("switches.input", "curtain")}, Alone()) as bench:
        assert asked(bench, "curtain", lambda one: one.read()).safe is None
    with emulated({"curtain": entry("switches.input", "curtain")}, Alone({"safe": True})) as bench:
        assert asked(bench, "curtain", lambda one: one.read()).safe is True


def test_lasers_and_lamps_of_one_box_share_its_link() -> None:
    devices = {"laser": entry("switches.laser", "laser"), "lamp": entry("switches.lamp", "lamp")}
    behind = Alone({"emission": False})
    with emulated(devices, behind) as bench:
        assert bench.entries["laser"].address["port"] == bench.entries["lamp"].address["port"]
        assert asked(bench, "laser", lambda one: one.emit(True)) is True
        assert asked(bench, "laser", lambda one: one.emitting()) is True
        assert asked(bench, "lamp", lambda one: one.shine(True)) is True


def test_another_box_than_the_labs_is_told_as_such() -> None:
    with emulated({"shutter": entry("switches.shutter", "shutter")}, Alone({"open": False})) as bench:
        said = bench.entries["shutter"]
        wrong = DeviceEntry(driver=said.driver, address=said.address, identity={"serial": "8"})
        bench.entries["shutter"] = wrong
        with pytest.raises(PicoError, match="another device than shutter answers"):
            asked(bench, "shutter", lambda one: one.is_open())


@pytest.mark.parametrize("kind", ["uint8", "uint16"])
def test_a_frame_comes_as_it_was_taken(kind: str) -> None:
    frame = (np.arange(48 * 64).reshape(48, 64) % 251).astype(kind)
    behind = Alone({"frame": frame})
    with emulated({"left": entry("frames.camera")}, behind) as bench:
        found = asked(bench, "left", lambda one: one.grab(exposure=2.5, gain=3.0))
        assert found.dtype == frame.dtype and np.array_equal(found, frame)
        assert (behind.read("exposure"), behind.read("gain")) == (2.5, 3.0)


def test_a_camera_without_a_picture_says_so() -> None:
    with emulated({"left": entry("frames.camera")}, Alone()) as bench, pytest.raises(PicoError, match="no picture"):
        asked(bench, "left", lambda one: one.grab())


def test_a_frame_that_came_otherwise_than_it_was_sent_is_none() -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:

        def serve() -> None:
            link, _ = server.accept()
            with link:
                link.recv(1000)
                crc = zlib.crc32(b"abcd")
                link.sendall(b'{"id": 1, "shape": [2, 2], "dtype": "uint8", "bytes": 4, "crc32": %d}\nabcE' % crc)

        thread = threading.Thread(target=serve)
        thread.start()
        link = FrameLink("127.0.0.1", server.getsockname()[1])
        with pytest.raises(ValueError, match="otherwise than it was sent"):
            link.ask(do="grab")
        link.close()
        thread.join(5)


@pytest.mark.parametrize(
    ("driver", "answers"),
    [
        ("frames.camera", [b'{"bytes": 100}\n' + b"x" * 40, b"nonsense\n", b'{"bytes": -1}\n', b""]),
        ("switches.shutter", [b"maybe\n", b"serial=7", b"\xff\xfe\n", b""]),
    ],
)
def test_what_is_no_answer_is_a_diagnostic_and_no_picture(driver: str, answers: list[bytes]) -> None:
    for answer in answers:
        with socket.create_server(("127.0.0.1", 0)) as server:
            server.settimeout(5)

            def serve(server: socket.socket = server, answer: bytes = answer) -> None:
                link, _ = server.accept()
                with link:
                    link.recv(1000)
                    link.sendall(answer)

            thread = threading.Thread(target=serve)
            thread.start()
            where: dict[str, str | int] = {"host": "127.0.0.1", "port": server.getsockname()[1]}
            named = {"name": "shutter"} if driver == "switches.shutter" else {}
            one = DeviceEntry(driver=driver, address={**where, **named}, identity={"serial": "7"})

            async def connect(one: DeviceEntry = one) -> None:
                buses = Buses()
                try:
                    await buses.opened("it", one).connect()
                finally:
                    await buses.close()

            with pytest.raises(PicoError) as caught:
                asyncio.run(connect())
            assert caught.value.diagnostics[0].address == "it"
            thread.join(5)
