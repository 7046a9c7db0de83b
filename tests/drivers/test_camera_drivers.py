"""Cameras through the vendors' libraries, which emulate them: pictures of ours come out as they went in."""

from __future__ import annotations

import asyncio
from dataclasses import replace

import numpy as np
import pytest

from pico.diagnostics import PicoError
from pico.drivers import registry
from pico.drivers.driver import Driver
from pico.drivers.registry import Buses, known
from pico.emulators.behind import Alone
from pico.emulators.registry import EmulatedBench
from pico.model.wiring import DeviceEntry


def picture(seed: int, bits: int = 8) -> np.ndarray:
    kind = np.uint8 if bits == 8 else np.uint16
    return np.random.default_rng(seed).integers(0, 2**bits, (120, 160), kind)


ENTRY = DeviceEntry(driver="basler.camera", emulator="basler", address={"serial": "40012345"},
                    identity={"serial": "40012345"}, limits={"exposure": (0.1, 50)})  # fmt: skip


def test_a_basler_camera_shows_what_is_behind_it_when_it_is_asked_and_in_its_size() -> None:
    behind = Alone({"frame": picture(1)})
    bench = EmulatedBench({"cam": ENTRY}, lambda name, entry: behind)
    buses = Buses()
    camera = buses.opened("cam", bench.entries["cam"])

    async def go() -> None:
        assert (await camera.connect()).serial == bench.entries["cam"].address["serial"]
        for seed in (1, 2, 3):
            behind.write("frame", picture(seed))
            assert np.array_equal(await camera.grab(exposure=1.0), picture(seed))  # type: ignore[attr-defined]
        with pytest.raises(PicoError) as beyond:
            await camera.grab(exposure=60.0)  # type: ignore[attr-defined]
        assert beyond.value.diagnostics[0].code == "device-limit"
        await buses.close()
        assert np.array_equal(await camera.grab(), picture(3)), "it is opened again"  # type: ignore[attr-defined]
        await buses.close()

    try:
        asyncio.run(go())
    finally:
        bench.close()


def test_another_camera_than_the_lab_names_is_refused() -> None:
    bench = EmulatedBench({"cam": ENTRY}, lambda name, entry: Alone())
    buses = Buses()
    camera = buses.opened("cam", replace(bench.entries["cam"], identity={"serial": "40012345"}))
    try:
        with pytest.raises(PicoError) as other:
            asyncio.run(camera.connect())
        assert other.value.diagnostics[0].code == "device-identity"
    finally:
        asyncio.run(buses.close())
        bench.close()


def test_a_camera_that_is_not_there_is_told() -> None:
    camera = Buses().opened("cam", replace(ENTRY, address={"serial": "nobody"}))
    with pytest.raises(PicoError) as lost:
        asyncio.run(camera.connect())
    assert lost.value.diagnostics[0].code == "device-lost" and lost.value.diagnostics[0].address == "cam"


DEPTH = DeviceEntry(driver="realsense.camera", emulator="realsense", address={"serial": "123456"},
                    identity={"serial": "123456"}, limits={"exposure": (0.1, 50)})  # fmt: skip


def realsense() -> None:
    """Skip where the vendor's library is not there; it wants a library of the system itself."""
    if "realsense.camera" not in known():
        pytest.skip("the extra realsense")
    try:
        import pyrealsense2  # noqa: F401
    except ImportError as exc:
        pytest.skip(str(exc))


def test_a_realsense_camera_shows_and_measures_what_is_in_front_of_it() -> None:
    realsense()
    far = np.linspace(300, 900, 120 * 160).reshape(120, 160).round()
    far[5, 7] = np.nan
    behind = Alone({"frame": picture(1), "depth": far})
    bench = EmulatedBench({"cam": DEPTH}, lambda name, entry: behind)
    buses = Buses()
    camera = buses.opened("cam", bench.entries["cam"])

    async def go() -> None:
        assert (await camera.connect()).serial == "123456"
        for seed in (1, 2, 3):
            behind.write("frame", picture(seed))
            assert np.array_equal(await camera.grab(), picture(seed))  # type: ignore[attr-defined]
        found = await camera.depth()  # type: ignore[attr-defined]
        assert np.allclose(found, far, atol=1e-3, equal_nan=True)
        with pytest.raises(PicoError) as beyond:
            await camera.grab(exposure=60.0)  # type: ignore[attr-defined]
        assert beyond.value.diagnostics[0].code == "device-limit"
        with pytest.raises(PicoError, match="cam has no exposure that can be set"):
            await camera.grab(exposure=5.0)  # type: ignore[attr-defined]
        await buses.close()
        assert np.array_equal(await camera.grab(), picture(3)), "it is opened again"  # type: ignore[attr-defined]
        await buses.close()

    try:
        asyncio.run(go())
    finally:
        bench.close()


def test_a_realsense_camera_that_is_not_there_is_told() -> None:
    realsense()
    camera = Buses().opened("cam", replace(DEPTH, address={"serial": "nobody"}))
    with pytest.raises(PicoError) as lost:
        asyncio.run(camera.connect())
    assert lost.value.diagnostics[0].code == "device-lost" and lost.value.diagnostics[0].address == "cam"


def test_a_library_that_lacks_another_one_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    def load() -> None:
        raise ImportError("libusb-1.0.so.0: cannot open shared object file")

    def made(*_: object) -> object:
        raise AssertionError("nothing is made")

    lacking = Driver(kind="camera", made=made, opened=made, closed=made, address={"serial": ""}, bus=("serial",),  # type: ignore[arg-type]
                     needs=("json", "some"), load=load)  # fmt: skip
    monkeypatch.setattr(registry, "driver", lambda name: lacking)
    with pytest.raises(PicoError) as said:
        Buses().opened("cam", DeviceEntry(driver="some.camera", address={"serial": "1"}))
    (one,) = said.value.diagnostics
    assert (one.code, one.address) == ("missing-extra", "cam") and "libusb-1.0.so.0" in one.summary
