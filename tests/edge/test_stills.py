"""Small pictures for who watches: marked with what kernels say, kept nowhere, and never taken while a run goes on."""

from __future__ import annotations

import asyncio
import base64
from collections.abc import Iterator
from typing import Any

import cv2
import numpy as np
import pytest

from pico.backends.measured import Reading
from pico.bench.bench import Bench
from pico.diagnostics import ExitCode, PicoError
from pico.edge.link.stills import EVERY, Stills, still
from pico.edge.protocol import Holder
from pico.history.examples.example import make_example


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Bench]:
    root = make_example("shel", tmp_path_factory.mktemp("stills") / "shel").root
    with Bench.open(root, fidelity="kinematic") as found:
        yield found


def held_for(what: str) -> Holder:
    return Holder(token=1, user="ann", pid=1, since="", what=what)


def spot(x: float, y: float, widths: tuple[float, float]) -> np.ndarray[Any, Any]:
    rows, columns = np.mgrid[0:1024, 0:1280]
    return np.round(64 + 3000 * np.exp(-2 * (((columns - x) / widths[0]) ** 2 + ((rows - y) / widths[1]) ** 2)))


SETTINGS = {"pixel_size": 2.0, "black_level": 64.0, "full_scale": 4095.0, "read_noise": 2.0, "exposure": 1.0}
ROWS = {"centroid": "image | centroid", "width": "image | d4sigma", "fit": "image | gaussian_fit"}


def test_what_kernels_say_is_marked_where_the_spot_is() -> None:
    reading = Reading(None, spot(801, 301, (120, 60)), settings=SETTINGS, saturated="")
    found = still("cam", "image", reading, ROWS)
    picture = cv2.imdecode(np.frombuffer(base64.b64decode(found["png"]), np.uint8), cv2.IMREAD_UNCHANGED)
    assert picture.shape == (found["height"], found["width"]) == (512, 640) and found["by"] == 2
    assert picture.max() == 255 and picture[10, 10] == 0
    assert np.unravel_index(picture.argmax(), picture.shape) == pytest.approx((150, 400), abs=2)
    by = {(one["of"], one["mark"]): one for one in found["marks"]}
    cross, box = by["centroid", "cross"], by["centroid", "box"]
    assert (cross["x"], cross["y"]) == pytest.approx((400.75, 150.75), abs=0.1)
    assert box["x"] < cross["x"] - 60 and box["x"] + box["width"] > cross["x"] + 60
    for name in ("width", "fit"):
        one = by[name, "ellipse"]
        assert (one["x"], one["y"], one["major"], one["minor"]) == pytest.approx((400.75, 150.75, 60, 30), rel=0.03)
        assert one["angle"] == pytest.approx(0, abs=1)
    value = found["values"]["centroid"]
    assert value["unit"] == "um, um" and value["value"]["x"] == pytest.approx((801 - 639.5) * 2, abs=0.5)
    assert 0 < value["sigma"]["x"] < 1


def test_without_light_there_is_a_picture_and_the_reason() -> None:
    reading = Reading(None, np.full((64, 64), 64.0), settings=SETTINGS, saturated="")
    found = still("cam", "image", reading, {"centroid": "image | centroid"})
    assert found["marks"] == [] and "no light" in found["values"]["centroid"]["unknown"]


def test_one_is_taken_for_all_who_ask_and_none_while_a_run_goes_on(
    bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    now, taken, holder = [0.0], list[str](), list[Holder | None]([None])

    async def snap(component: str, measurable: str) -> Reading:
        taken.append(f"{component}.{measurable}")
        return Reading(None, np.full((64, 64), 64.0), settings=SETTINGS, saturated="")

    async def held() -> Holder | None:
        return holder[0]

    monkeypatch.setattr(bench.edge.device, "snap", snap, raising=False)  # type: ignore[attr-defined]
    monkeypatch.setattr(bench.edge, "holder", held)
    stills = Stills(bench.edge, lambda: now[0])  # type: ignore[arg-type]

    async def three() -> list[dict[str, Any]]:
        return await asyncio.gather(*(stills.of("cam", "image", ["centroid"]) for _ in range(3)))

    assert [one["age"] for one in asyncio.run(three())] == [0.0] * 3 and len(taken) == 1
    now[0] += EVERY + 0.01
    holder[0] = held_for("pico apply e1")
    found = asyncio.run(Stills.of(stills, "cam", "image", ["centroid"]))
    assert (found["age"], found["waits"], len(taken)) == (0.21, "pico apply e1 goes on", 1)
    with pytest.raises(PicoError) as caught:
        asyncio.run(stills.of("cam", "image", []))
    assert caught.value.exit_code == ExitCode.LOCKED
    holder[0] = held_for("pico teleop p2")
    assert asyncio.run(stills.of("cam", "image", ["centroid"]))["age"] == 0.0 and len(taken) == 2


def test_a_camera_of_the_table_is_seen_and_nothing_is_kept(bench: Bench) -> None:
    stills, before = Stills(bench.edge), sorted(bench.root.rglob("*"))  # type: ignore[arg-type]
    found = bench.wait(stills.of("cam", "image", ["centroid", "image | peak"]))
    assert found["width"] == 612 and set(found["values"]) == {"centroid", "image | peak"}
    assert sorted(bench.root.rglob("*")) == before
    for nonsense in ("pose", "image | nonsense", "nothing"):
        with pytest.raises(PicoError):
            bench.wait(stills.of("cam", "image", [nonsense]))
