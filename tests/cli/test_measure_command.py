"""`pico measure`: numbers of the beam with their uncertainties, dark frames, the exposure, the lamp of the room."""

from __future__ import annotations

import json
from pathlib import Path

import cv2
import numpy as np
import pytest
from commanding import Pico, edit


@pytest.fixture
def crossed(shel: Path, pico: Pico) -> Path:
    """The case study with nearly crossed polarizers, in a world that stands still."""
    edit(shel / "lab.yaml", "  seed: 1\n", "  seed: 1\n  environment: none\n")
    assert pico("apply", "e1", "--yes").code == 0
    return shel


def test_the_middle_of_the_spot_is_told_with_its_uncertainty_and_kept_with_the_run(crossed: Path, pico: Pico) -> None:
    found = pico("measure", "cam.centroid", "--json").data
    assert found["schema"] == "pico.measurement/v1" and found["unit"] == "um, um"
    assert found["kernel"] == "image | centroid" and "not saturated" in found["assured"]
    # the spin Hall shift of 150/125 mm at 30 deg with an angle of 1 deg, seen beyond the back focus
    assert found["value"]["y"] == pytest.approx(-58, abs=3) and 0 < found["sigma"]["y"] < 0.1
    said = pico("measure", "cam.centroid")
    assert said.code == 0 and "y  -5" in said.out and " ± 0.02" in said.out and "exposure 10 ms" in said.out
    assert "cam.centroid" in pico("runs", "show").out
    assert "Drew cam.image to spot.png" in pico("measure", "cam.image", "--picture", "spot.png").out
    assert "`pico measure cam.image` keeps one" in pico("measure", "cam.centroid", "--picture", "none.png").err
    drawn = cv2.imread(str(crossed / "spot.png"))
    assert drawn.shape == (2048, 2448, 3) and drawn.max() == 255
    middle = np.argwhere(drawn[:, :, 0] > 128).mean(axis=0)
    assert middle[0] == pytest.approx(1023.5 - found["value"]["y"] / 3.45, abs=10), "y is up"
    again = pico("measure", "cam.image | background | centroid", "--json").data
    assert again["value"]["y"] == pytest.approx(found["value"]["y"], abs=0.5)
    assert again["array"]["shape"] == [2048, 2448]


def test_what_is_saturated_has_no_value_and_the_exposure_is_found(crossed: Path, pico: Pico) -> None:
    pico("set", "cam", "exposure=200")
    answer = pico("measure", "cam.power")
    assert answer.code == 1 and "unknown" in answer.out and "pixels read 4095" in answer.out
    assert "ms, found in" in pico("do", "cam", "auto_range", "--yes").out
    exposure = pico("get", "cam.exposure", "--json").data["values"]["exposure"]["value"]
    assert 5 < exposure < 20
    taken = pico("runs", "show", "--json").data["operations"][0]["data"]
    assert taken["value"] == exposure and taken["frames"][0]["exposure"] == 200 and len(taken["frames"]) <= 8
    assert pico("measure", "cam.power", "--json").data["value"] > 0


def test_a_dark_frame_shuts_the_laser_and_opens_it_again(crossed: Path, pico: Pico) -> None:
    answer = pico("measure", "cam.dark", "--yes")
    assert "laser.shutter  open → closed" in answer.out and answer.code == 0
    assert pico("get", "laser.shutter", "--json").data["values"]["shutter"]["value"] == "open"
    pico("set", "laser", "shutter=closed", "--yes")
    no_light = pico("measure", "cam.centroid")
    assert no_light.code == 1 and "no light" in no_light.out
    in_vain = pico("do", "cam", "auto_range", "--yes")
    assert in_vain.code == 1 and "no light comes to cam: its picture stays dark up to 1000 ms" in in_vain.err
    assert pico("get", "cam.exposure", "--json").data["values"]["exposure"]["value"] == 10  # as it was


def test_several_are_measured_in_one_run_and_darkness_has_its_reason(crossed: Path, pico: Pico) -> None:
    answer = pico("measure", "laser.monitor", "p1.angle", "--json")
    one, two = (json.loads(line) for line in answer.out.splitlines())
    assert answer.code == 0 and one["run"] == two["run"] and (one["component"], two["value"]) == ("laser", 1)
    assert pico("measure", "laser.monitor", "p1.angle", "--picture", "x.png").code == 1
    pico("set", "laser", "shutter=closed", "--yes")
    dark = pico("measure", "cam.power")
    assert "no light reaches cam: laser.shutter is closed" in dark.err, dark
    assert pico("set", "laser", "emission=false", "--yes").code == 0
    (told,) = pico("measure", "cam.power", "--json").data["diagnostics"]
    assert "laser is switched off" in told["summary"] and "laser.shutter is closed" in told["summary"]


@pytest.mark.parametrize(
    ("what", "said"),
    [
        ("cam.image | centriod", "did you mean `centroid`?"),
        ("cam.power | centroid", "cam.power is no picture"),
        ("cam.center", "cam has no measurable `center`"),
        ("cam.image | mode_overlap", "`radius`"),
        ("p1", "what of p1 is to be measured?"),
        ("nobody.image", "there is no component `nobody`"),
        ("laser.power", "laser has no measurable `power`"),
    ],
)
def test_what_makes_no_sense_is_told(shel: Path, pico: Pico, what: str, said: str) -> None:
    answer = pico("measure", what)
    assert answer.code != 0 and said in answer.err and "Traceback" not in answer.err


def test_the_lamp_is_off_while_a_beam_is_measured_and_on_while_an_arm_works(shel: Path, pico: Pico) -> None:
    edit(shel / "lab.yaml", "inventory:\n", "inventory:\n  lamp: {type: room_lamp, pose: {x: 1120, y: 800, yaw: 0}}\n")
    edit(
        shel / "state/table.yaml", "components:\n",
        "components:\n  lamp: {pose: {x: 1120, y: 800, yaw: 0}, illumination: false}\n",
    )  # fmt: skip
    steps = [(op["component"], op["primitive"]) for op in pico("plan", "--json").data["operations"]]
    last = max(n for n, step in enumerate(steps) if step[1] in ("move", "park"))
    assert steps.index(("lamp", "set")) > last
    assert pico("apply", "--yes").code == 0
    pico("set", "lamp", "illumination=true")
    pico("set", "hwp", "angle=2", "--yes"), pico("set", "cam", "exposure=0.2")
    planned = pico("measure", "cam.centroid", "--dry-run", "--json").data["operations"]
    assert [(op["component"], op["arguments"].get("to")) for op in planned] == [
        ("lamp", False), ("cam", None), ("lamp", True),
    ]  # fmt: skip
    ranged = pico("do", "cam", "auto_range", "--dry-run", "--json").data["operations"]
    assert [op["component"] for op in ranged] == ["lamp", "cam", "lamp"]
    dark = pico("measure", "cam.power", "--json").data
    assert "illumination" in dark["assured"]
    lit = pico("get", "cam.image", "--json").data["values"]["image"]["value"]
    pico("set", "lamp", "illumination=false")
    assert lit["mean"] > pico("get", "cam.image", "--json").data["values"]["image"]["value"]["mean"] + 100
    # the way back: the lamp is turned on before the arm moves, and off again after it
    assert pico("move", "p2", "x=530", "--yes").code == 0
    steps = [(op["component"], op["arguments"].get("to")) for op in pico("plan", "--json").data["operations"]]
    lamp = [n for n, step in enumerate(steps) if step[0] == "lamp"]
    assert [steps[n][1] for n in lamp] == [True, False]
    assert lamp[0] < next(n for n, step in enumerate(steps) if step[0] == "p2") < lamp[1]


def test_light_that_no_exposure_shows_is_told(shel: Path, pico: Pico) -> None:
    for words in ("emission=true", "shutter=open"):
        assert pico("set", "laser", words, "--yes").code == 0
    assert pico("set", "cam", "exposure=1", "--yes").code == 0
    answer = pico("do", "cam", "auto_range", "--yes")  # nothing but hwp stands in the beam
    assert answer.code == 1 and "cam is saturated even at 0.02 ms, its shortest exposure" in answer.err
    assert "weaken the beam" in answer.err and "the exposure stays there, it was" in answer.err
    bright = pico("measure", "cam.centroid")
    assert "auto_range" not in bright.out + bright.err and "weaken the beam" in bright.out + bright.err, bright


def test_a_photodiode_that_can_tell_no_more_has_no_value(shel: Path, pico: Pico) -> None:
    edit(shel / "lab.yaml", "inventory:\n", "inventory:\n  pd: {type: photodiode, marker: 20, home: storage/c3}\n")
    edit(
        shel / "state/table.yaml", "components:\n", "components:\n  pd: {pose: {x: 780, y: 420, yaw: 0}, gain: 70 dB}\n"
    )
    assert pico("apply", "--yes").code == 0
    answer = pico("measure", "pd.voltage")
    assert answer.code == 1 and "saturated: 10 V is all that it can tell" in " ".join(answer.out.split())
    assert "gain 70 dB," in " ".join(answer.out.split())


@pytest.mark.parametrize(
    ("kind", "measurable", "low", "high", "dark"),
    [
        ("spectrometer", "wavelength", 632.7, 632.9, None),
        ("spectrometer", "linewidth", 1.1, 1.4, None),
        ("fiber_coupler", "power", 0.5, 2.0, 0.0),
        ("balanced_detector", "voltage", 3.0, 9.0, 0.0),
    ],
)
def test_other_instruments_measure_the_beam_too(
    shel: Path, pico: Pico, kind: str, measurable: str, low: float, high: float, dark: float | None
) -> None:
    edit(shel / "lab.yaml", "  seed: 1\n", "  seed: 1\n  environment: none\n")
    edit(
        shel / "lab.yaml", "type: beam_camera\n    pose: {x: 1060, y: 420", f"type: {kind}\n    pose: {{x: 1060, y: 410"
    )
    if kind != "balanced_detector":  # of which the left diode stands in the beam
        edit(shel / "lab.yaml", "{x: 1060, y: 410", "{x: 1060, y: 420")
    table = shel / "state" / "table.yaml"
    before, _, after = table.read_text().partition("  cam:\n")
    rest = "\n".join(after.splitlines()[next(n for n, li in enumerate(after.splitlines()) if li[:4] != "    ") :])
    own = "  cam:\n    exposure: 10\n" if kind == "spectrometer" else ""
    table.write_text(f"{before}{own}{rest}\n")
    assert pico("set", "p1.angle", "0", "-y").code == 0
    if kind == "spectrometer":
        assert pico("set", "cam.exposure", "1", "-y").code == 0
    assert pico("set", "laser.emission", "true", "-y").code == 0
    found = pico("measure", f"cam.{measurable}", "--json")
    assert ("value" not in found.data) is (dark is None)
    assert dark is None or abs(found.data["value"]) < 5 * found.data["sigma"]
    assert pico("set", "laser.shutter", "open", "-y").code == 0
    found = pico("measure", f"cam.{measurable}", "--json")
    assert low < found.data["value"] < high and found.data["sigma"] > 0
