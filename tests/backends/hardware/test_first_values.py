"""What is known of settings that a device does not tell, before they are set: nothing on hardware, `initial` of the
type on an emulated bench, and never the lower end of a range."""

from __future__ import annotations

import asyncio
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from pico.backends.attempt import Failed
from pico.backends.hardware.instruments import Instruments, add
from pico.backends.hardware.measuring import Readers
from pico.backends.hardware.setting import ranged
from pico.backends.hardware.settings import Settings
from pico.backends.measured import Reading
from pico.drivers.registry import driver
from pico.manifest.load import load_folder
from pico.model.operation import Operation, Reason
from pico.model.setup import Setup
from pico.model.wiring import DeviceEntry
from pico.places.bench import BenchPlace
from pico.resources import labs_dir

ENTRY = DeviceEntry(driver="frames.camera", of="camera", address={"host": "127.0.0.1", "port": 1})
RANGE = (0.02, 1000.0)


class Lit:
    """A camera in a beam: a share of full scale that grows with the exposure [ms]."""

    def __init__(self) -> None:
        self.exposures: list[float | None] = []

    async def grab(self, *, exposure: float | None = None, gain: float | None = None) -> Any:
        self.exposures.append(exposure)
        spot = np.zeros((64, 64))
        spot[28:36, 28:36] = min(4000.0, 40.0 * (exposure or 0.0))
        return (spot + 64).astype(np.uint16)


def bench(root: Path, name: str, initial: float | None = None) -> tuple[Setup, Instruments, Lit]:
    """A bench of `minimal` with a camera whose exposure has an `initial`, or none."""
    setup, _ = load_folder(labs_dir() / "minimal").require()
    kind = setup.type_of("camera")
    first = replace(kind, tunables={"exposure": replace(kind.tunables["exposure"], initial=initial, range=RANGE)})
    setup = replace(setup, catalog={**setup.catalog, kind.name: first})
    found, camera = Instruments(), Lit()
    add(setup, found, "camera", ENTRY, driver("frames.camera"), camera, Settings(BenchPlace(root, name)))
    return setup, found, camera


@pytest.mark.parametrize(
    ("name", "initial", "value"),
    [("hardware", None, None), ("hardware", 3.0, None), ("emulated", None, None), ("emulated", 3.0, 3.0)],
)
def test_the_exposure_of_a_camera_is_unknown_until_it_is_set(
    tmp_path: Path, name: str, initial: float | None, value: float | None
) -> None:
    _, found, _ = bench(tmp_path, name, initial)
    one = found.tunables["camera.exposure"]
    live = asyncio.run(one.read())
    assert (live.value, live.status) == (value, "unknown" if value is None else "known")
    asyncio.run(one.set(7.0))
    assert asyncio.run(bench(tmp_path, name, initial)[1].tunables["camera.exposure"].read()).value == 7.0


def test_no_picture_is_taken_with_an_exposure_that_was_never_set(tmp_path: Path) -> None:
    setup, found, camera = bench(tmp_path, "hardware")
    readers = Readers(setup, tmp_path, found)
    with pytest.raises(Failed) as refused:
        asyncio.run(readers.read("camera", "image"))
    said = refused.value.diagnostic
    assert "camera.exposure is unknown: it was never set" in said.summary and camera.exposures == []
    assert said.hint == "`pico set camera exposure=...`, or `pico do camera auto_range`"
    asyncio.run(found.tunables["camera.exposure"].set(10.0))
    assert asyncio.run(readers.read("camera", "image")).settings["exposure"] == 10.0


def test_auto_range_finds_an_exposure_where_none_was_set(tmp_path: Path) -> None:
    setup, found, camera = bench(tmp_path, "hardware")
    readers = Readers(setup, tmp_path, found)
    asked = Operation(
        id="a",
        primitive="auto_range",
        component="camera",
        arguments={"tunable": "exposure"},
        reason=Reason(kind="asked"),
    )  # fmt: skip

    async def image(component: str) -> Reading:
        return await readers.image(component)

    done = asyncio.run(ranged(setup, found, asked, image, lambda _: None))
    assert camera.exposures[0] not in (RANGE[0], None) and len(camera.exposures) <= 4
    live = asyncio.run(found.tunables["camera.exposure"].read())
    assert live.value == done["value"] == camera.exposures[-1] and 45 < float(done["value"]) < 90
