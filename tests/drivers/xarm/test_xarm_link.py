"""How an xArm7 is found: by nobody else's socket, within a deadline, by its serial number; and what it leaves alone."""

from __future__ import annotations

import builtins
import os
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from xarm_rig import SERIAL, Rig, rigged

from pico.diagnostics import PicoError
from pico.drivers.xarm import library
from pico.drivers.xarm.settings import settings
from pico.emulators.xarm.server import XArmEmulator
from pico.model.wiring import DeviceEntry


@contextmanager
def listening(family: int, address: Any) -> Iterator[socket.socket]:
    with socket.socket(family) as listener:
        listener.bind(address)
        listener.listen()
        listener.settimeout(0.0)
        yield listener


@pytest.mark.skipif(not hasattr(socket, "AF_UNIX"), reason="no Unix sockets here")
def test_a_socket_in_the_temporary_directory_is_not_taken_for_the_arm(rig: Rig) -> None:
    path = Path(f"/tmp/xarmcontroller_uds_{rig.emulator.address['port']}")  # where the vendor's library looks
    with listening(socket.AF_UNIX, str(path)) as hijacker:
        try:
            fresh = rigged(rig.emulator, rig.loop)
            assert rig.do(fresh.arm.connect()).serial == SERIAL
            with pytest.raises(BlockingIOError):
                hijacker.accept()
            rig.do(fresh.arm.close())
        finally:
            path.unlink()


def test_one_that_listens_and_says_nothing_is_given_up(rig: Rig, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(library, "OPENING", 0.2)
    with listening(socket.AF_INET, ("127.0.0.1", 0)) as silent:
        lost = rigged(rig.emulator, rig.loop)
        entry = DeviceEntry(driver="xarm.arm", address={"host": "127.0.0.1", "port": silent.getsockname()[1]})
        monkeypatch.setattr(lost.bus, "_opened", lambda: _opened(entry))
        with pytest.raises(PicoError, match=r"no control box answers at 127\.0\.0\.1"):
            rig.do(lost.arm.connect())
        rig.do(lost.arm.close())


def _opened(entry: DeviceEntry) -> Any:
    from pico.drivers.xarm.arm import DRIVER

    return DRIVER.opened(entry)


def test_another_arm_at_the_address_is_not_spoken_to(rig: Rig) -> None:
    other = XArmEmulator(joints=(0.0,) * 7, serial="XI130500000002", pace=10.0)
    other.start()
    wrong = rigged(other, rig.loop)
    with pytest.raises(PicoError, match=f"its serial is `XI130500000002`, the lab's is `{SERIAL}`"):
        rig.do(wrong.arm.connect())
    with pytest.raises(PicoError, match="another device"):
        rig.do(wrong.arm.ready())
    assert not {11, 12, 19, 29} & set(other.box.requested), "it was told something"
    rig.do(wrong.arm.close())
    other.close()


@pytest.mark.parametrize(("serial", "axes", "word"), [("XIABCD", 7, "makes no sense"), (SERIAL, 6, "has 6 joints")])
def test_what_is_no_xarm7_is_told_as_such(rig: Rig, serial: str, axes: int, word: str) -> None:
    other = XArmEmulator(joints=(0.0,) * 7, serial=serial, pace=10.0)
    other.box.axes = axes
    other.start()
    wrong = rigged(other, rig.loop)
    with pytest.raises(PicoError, match=word):
        rig.do(wrong.arm.connect())
    rig.do(wrong.arm.close())
    other.close()


def test_the_library_prints_nothing_and_leaves_the_processs_sockets_alone(
    rig: Rig, capfd: pytest.CaptureFixture[str]
) -> None:
    fresh = rigged(rig.emulator, rig.loop)
    rig.do(fresh.arm.connect())
    rig.emulator.fault(24)
    rig.do(fresh.arm.recover())
    rig.do(fresh.arm.close())
    assert socket.getdefaulttimeout() is None
    assert capfd.readouterr() == ("", "")
    rig.do(rig.arm.ready())


def test_importing_it_prints_nothing_and_takes_no_others_output() -> None:
    """In a process of its own; while two threads import it, a third one's words come through."""
    code = """
import sys, threading
from pico.drivers.xarm.library import library
going = [threading.Thread(target=library) for _ in range(2)]
[thread.start() for thread in going]
words = 0
while any(thread.is_alive() for thread in going):
    print("heard")
    words += 1
    going[0].join(0.01)
print("heard")
print(words + 1, file=sys.stderr)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines() == ["heard"] * int(done.stderr)


def test_a_bench_that_is_opened_prints_nothing_and_leaves_nothing_in_a_home(tmp_path: Path) -> None:
    code = """
from pico.drivers.registry import Buses
from pico.model.wiring import DeviceEntry
Buses().opened("arm1", DeviceEntry(driver="xarm.arm", address={"host": "127.0.0.1"}))
"""
    run = [sys.executable, "-c", code]
    done = subprocess.run(run, capture_output=True, text=True, check=True, env={**os.environ, "HOME": str(tmp_path)})
    assert (done.stdout, done.stderr, list(tmp_path.iterdir())) == ("", "", [])


def test_without_the_vendors_library_its_extra_is_named(rig: Rig, monkeypatch: pytest.MonkeyPatch) -> None:
    real = builtins.__import__

    def without(name: str, *rest: Any, **more: Any) -> Any:
        if name.startswith("xarm"):
            raise ImportError("No module named 'xarm'")
        return real(name, *rest, **more)

    library._library.cache_clear()
    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(PicoError, match=r"arm1 needs the vendor's library.*pico-lab\[xarm\]"):
        rig.do(rigged(rig.emulator, rig.loop).arm.connect())


@pytest.mark.parametrize(
    ("said", "word"),
    [
        ({"sensitivity": 0}, "does not notice what it hits"),
        ({"sensitivity": "high"}, "is a whole number"),
        ({"speed": 3}, "`speed` is no setting"),
        ({"tool": "hammer"}, "`tool` is one of"),
        ({"follow": "me"}, "set-points, moves"),
    ],
)
def test_settings_that_make_no_sense_are_told(said: dict[str, Any], word: str) -> None:
    with pytest.raises(PicoError, match=word):
        settings("arm1", DeviceEntry(driver="xarm.arm", settings=said))


def test_limits_of_the_lab_become_the_boxs() -> None:
    entry = DeviceEntry(
        driver="xarm.arm",
        limits={"x": (100.5, 600.2), "joint2": (-90.0, 300.0), "tool_speed": (0.0, 250.0), "joint_speed": (0.0, 400.0)},
    )
    found = settings("arm1", entry)
    assert found.boundary == [600, 101, 900, -900, 1300, -100]
    assert found.ranges[1] == pytest.approx((-1.5708, 2.0944), abs=1e-3)
    assert (found.tool_speed, found.joint_speed) == (250.0, pytest.approx(3.14159, abs=1e-4))
