"""`pico runs pictures`: what cameras saw in a run, and how its searches went, long afterwards."""

from __future__ import annotations

import base64
import json
import math
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from commanding import Brought, Pico

from pico.bench.bench import Bench
from pico.bench.picturing.kept import Curve
from pico.content.store import store_of
from pico.model.measurement import Measurement


def _looked(folder: Path) -> tuple[str, str, str]:
    """A picture, one with kernels, and a goal that is sought, in commits: the ids of the runs."""
    with Bench.open(folder, fidelity="kinematic") as bench:
        assert bench.apply("e1").reached
        found = [
            bench.apply(bench.plans.single("cam", "measure", {"measurable": what}))
            for what in ("image", "image | background | centroid")
        ]
        report, _ = bench.goals.optimize(bench.goals.plan(bench.goals.chosen(["ly_150_centred"])))
        ids = [one.run for one in (*found, report)]
        assert all(ids)
        return str(ids[0]), str(ids[1]), str(ids[2])


@pytest.fixture
def looked(brought: Brought) -> tuple[str, str, str]:
    found: tuple[str, str, str] = brought(_looked)
    return found


def documents(pico: Pico, *words: str) -> list[dict[str, Any]]:
    return [json.loads(line) for line in pico("--json", "runs", "pictures", *words).out.splitlines()]


def test_a_picture_of_a_run_is_small_and_marked_by_the_kernels_of_its_camera(
    looked: tuple[str, str, str], pico: Pico
) -> None:
    (one,) = documents(pico, looked[0], "--width", "160")
    assert one["schema"] == "pico.still/v1" and one["operation"] and one["width"] <= 160
    seen = cv2.imdecode(np.frombuffer(base64.b64decode(one["png"]), np.uint8), cv2.IMREAD_GRAYSCALE)
    assert seen.shape == (one["height"], one["width"]) and seen.max() > 100
    kept = pico("--json", "runs", "show", looked[0]).data["operations"]
    (array,) = (op["data"]["measurement"]["array"] for op in kept if op["data"].get("measurement"))
    assert one["sha256"] == array["sha256"] and one["width"] * one["by"] <= array["shape"][1]
    assert {"cross", "ellipse"} <= {mark["mark"] for mark in one["marks"]}
    cross = next(mark for mark in one["marks"] if mark["mark"] == "cross")
    assert seen[round(cross["y"]) - 2 : round(cross["y"]) + 3, round(cross["x"]) - 2 : round(cross["x"]) + 3].max() > 60


def test_kernels_by_which_it_was_measured_are_what_is_marked(looked: tuple[str, str, str], pico: Pico) -> None:
    (one,) = documents(pico, looked[1], "--of", "op1")
    assert [*one["values"]] == ["image | background | centroid"]
    (measured,) = [op for op in pico("--json", "runs", "show", looked[1]).data["operations"] if "numbers" in op]
    assert [(n["name"], n["unit"]) for n in measured["numbers"]] in ([], [("x", "um"), ("y", "um")])


def test_a_search_tells_each_measurement_and_the_best_so_far(looked: tuple[str, str, str], pico: Pico) -> None:
    (one,) = documents(pico, looked[2])
    assert (one["schema"], one["goal"], one["met"], one["aim"]) == ("pico.search/v1", "ly_150_centred", True, "reach")
    assert [(o["name"], o["unit"], o["target"], o["tolerance"]) for o in one["outputs"]] == [
        ("cam.centroid.x", "um", 0, 5), ("cam.centroid.y", "um", 0, 5),
    ]  # fmt: skip
    assert [(t["name"], t["unit"], t["range"]) for t in one["tunables"]] == [
        ("ly_150.stage_y", "mm", [-1.5, 1.5]), ("ly_150.stage_z", "mm", [-1.5, 1.5]),
    ]  # fmt: skip
    assert len(one["rows"]) == one["measurements"] >= 2
    for row in one["rows"]:
        off = [row["values"][f"cam.centroid.{axis}"] / 5 for axis in "xy"]
        assert row["merit"] == pytest.approx(math.hypot(*off))
    merits = [row["merit"] for row in one["rows"]]
    assert [row["best"] for row in one["rows"]] == [min(merits[: n + 1]) for n in range(len(merits))]
    assert merits[0] > one["enough"] == 1.0 > one["rows"][-1]["best"]


def test_they_are_listed_drawn_and_missed(looked: tuple[str, str, str], pico: Pico, shel: Path) -> None:
    listed = pico("runs", "pictures", looked[0]).out
    assert "cam.image" in listed and "uint16" in listed
    assert "of a search" in pico("runs", "pictures", looked[2]).out
    assert pico("runs", "pictures", looked[0], "--out", "seen").code == 0
    (path,) = (shel / "seen").iterdir()
    (one,) = documents(pico, looked[0])
    assert cv2.imread(str(path)).shape[1] // one["by"] == one["width"]
    assert pico("runs", "pictures", looked[2], "--out", "seen").code == 0
    none = pico("runs", "pictures", looked[0], "--of", "op99")
    assert none.code == 1 and "known: `op1`" in none.err
    store_of(shel).path(one["sha256"]).unlink()
    assert "not here: `pico data pull`" in pico("runs", "pictures", looked[0]).out
    gone = pico("runs", "pictures", looked[0], "--out", "again")
    assert gone.code == 1 and "`pico data pull` brings it" in gone.err
    (said,) = documents(pico, looked[0])
    assert said["diagnostics"][0]["code"] == "data-missing"


def test_a_run_that_kept_nothing_says_so(pico: Pico, shel: Path) -> None:
    with Bench.open(shel, fidelity="kinematic") as bench:
        bench.apply(bench.plans.single("p1", "set", {"angle": "5"}))
    none = pico("runs", "pictures")
    assert none.code == 1 and "kept no pictures" in none.err


def test_a_spectrum_is_a_curve_over_wavelengths_and_long_ones_keep_their_peaks() -> None:
    measured = Measurement(
        component="spec", measurable="spectrum", unit="count", settings={"first": 600.0, "step": 0.5}
    )  # fmt: skip
    counts = np.zeros(10_000)
    counts[7_001] = 900.0
    short, long = Curve(measured, counts[7_000:7_003]).data(0), Curve(measured, counts).data(0)
    assert short["points"] == [{"x": 600.0, "y": 0.0}, {"x": 600.5, "y": 900.0}, {"x": 601.0, "y": 0.0}]
    assert (short["x"]["unit"], short["y"]["unit"]) == ("nm", "count")
    assert len(long["points"]) <= 4096
    (peak,) = [p["x"] for p in long["points"] if p["y"] == 900.0]
    assert abs(peak - (600.0 + 0.5 * 7_001)) <= 3 * 0.5
