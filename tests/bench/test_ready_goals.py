"""Ready-made goals, each on a small bench: reached by the traced truth, not by their own reading; refusals."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest
import yaml
from bench_at import bench_at

import pico
from pico.backends.sim.lighted import unseen_of
from pico.backends.sim.store import load_world
from pico.bench.bench import Bench
from pico.diagnostics import PicoError
from pico.optics.light import Light, light_of
from pico.optics.nominal.arms import meeting
from pico.optics.offsets import Place, offset

HEAD = """\
apiVersion: pico/v1
kind: Lab
metadata: {name: small}
table: {size: [1500, 900], beam_height: 70}
robots: {arm1: {model: xarm7, mount: {x: 750, y: 850, yaw: -90}}}
sim: {fidelity: kinematic, seed: 3, environment: none}
policy: {enclosed: true, arming: {waived: [kinematic]}}
inventory:
  laser: {type: hene_laser_expanded, pose: {x: 120, y: 260, yaw: 0}}
  weak: {type: neutral_density_filter, pose: {x: 260, y: 260, yaw: 0}}
"""
TWO_MIRRORS = """\
  m1: {type: mirror_tip_tilt, pose: {x: 400, y: 260, yaw: -45}}
  m2: {type: mirror_tip_tilt, pose: {x: 400, y: 440, yaw: 135}}
"""


def bench(folder: Path, parts: str, **tunables: Mapping[str, Any]) -> Bench:
    """Open a bench with parts and the laser on; others as given."""
    (folder / "lab.yaml").write_text(HEAD + parts)
    lines = [f"  {name}: {{{', '.join(f'{k}: {v}' for k, v in own.items())}}}" for name, own in tunables.items()]
    (folder / "table.yaml").write_text(
        "apiVersion: pico/v1\nkind: LabState\nmetadata: {lab: small}\ncomponents:\n"
        "  laser: {emission: true, shutter: open}\n" + "\n".join(lines) + "\n"
    )
    opened = pico.open(folder)
    assert opened.apply().outcome == "done"
    return opened


def truth(opened: Bench, folder: Path) -> Light:
    """The light as it truly is, irises and shutters open."""
    world = load_world(opened.setup, bench_at(folder))[0]
    standing = {n: b for n, b in world.components.items() if b.pose is not None}
    unseen = {n: one for n, b in standing.items() if (one := unseen_of(opened.setup, n, b))}
    values = {
        n: {k: v for k, v in b.true_values.items() if k not in ("opening", "shutter")} for n, b in standing.items()
    }
    return light_of(opened.setup, {n: b.pose for n, b in standing.items() if b.pose}, values, unseen=unseen)


def beside(light: Light, component: str, *by: str) -> float:
    """How far a beam passes beside the middle of a component [mm]."""
    found = offset(light, Place(component, by=frozenset(by)))
    return float(abs(found[:2]).max()) if found is not None else float("inf")


def refused(opened: Bench, *words: str) -> str:
    with pytest.raises(PicoError) as caught:
        opened.goals.chosen(words)
    found = caught.value.diagnostics[0]
    return f"{found.summary} {found.hint}"


def test_a_beam_is_walked_through_two_irises_that_were_dark(tmp_path: Path) -> None:
    parts = (
        TWO_MIRRORS
        + """\
  near: {type: iris, pose: {x: 560, y: 440, yaw: 0}}
  far: {type: iris, pose: {x: 1000, y: 440, yaw: 0}}
  meter: {type: power_meter, pose: {x: 1200, y: 440, yaw: 0}}
"""
    )
    off = {"m1": {"tip": 2.1, "tilt": -0.9}, "m2": {"tip": -1.2, "tilt": 0.8}}
    with bench(
        tmp_path, parts, near={"opening": 11.5}, far={"opening": 11.5}, meter={"wavelength": 632.8}, **off
    ) as it:
        found = it.optimize("through", "near", "far")
        light = truth(it, tmp_path)
        assert found.met, found
        assert max(beside(light, "near"), beside(light, "far")) < 0.2
        assert it.observe().known_values["near"]["opening"] == pytest.approx(11.5, abs=0.1)
        assert "it takes two irises" in refused(it, "through", "near", "meter")
        assert "no beam comes through" in refused(it, "through", "near", "near")


@pytest.mark.parametrize("goal", ["peak", "null"])
def test_the_scale_error_of_a_meter_is_no_noise_between_its_readings(tmp_path: Path, goal: str) -> None:
    parts = """\
  p1: {type: linear_polarizer, pose: {x: 520, y: 260, yaw: 0}}
  meter: {type: power_meter, pose: {x: 800, y: 260, yaw: 0}}
"""
    with bench(tmp_path, parts, p1={"angle": 25}, meter={"wavelength": 632.8}) as it:
        found = it.optimize(goal, "p1", "meter")
        assert found.met and found.last is not None, found
        assert found.measurements <= 12
        share = it.setup.type_of("meter").number("uncertainty", "") or 0.0
        power, sigma = found.last["objective"], found.last["objective_sigma"]
        assert sigma > 0.4 * share * abs(power)  # what is shown keeps the calibration
        read = it.measure("meter.power")
        read = it.measure("meter.power").measurement
        assert read.noise is not None and isinstance(read.sigma, float) and read.noise <= read.sigma


def test_a_mirror_sends_light_back_through_the_iris(tmp_path: Path) -> None:
    parts = """\
  split: {type: beam_splitter_50_50, pose: {x: 420, y: 260, yaw: 0}}
  stop: {type: beam_block, pose: {x: 420, y: 500, yaw: 90}}
  meter: {type: power_meter, pose: {x: 420, y: 140, yaw: -90}}
  iris: {type: iris, pose: {x: 560, y: 260, yaw: 0}}
  back: {type: mirror_tip_tilt, pose: {x: 1100, y: 260, yaw: 0}}
"""
    with bench(
        tmp_path, parts, iris={"opening": 11.5}, back={"tip": 0.9, "tilt": -0.7}, meter={"wavelength": 632.8}
    ) as it:
        found = it.optimize("retro_reflect", "back")
        assert found.met, found
        assert beside(truth(it, tmp_path), "iris", "back") < 0.25
        assert "has no motors for tip and tilt" in refused(it, "retro_reflect", "split")


def test_light_is_brought_through_the_pinhole_of_a_spatial_filter(tmp_path: Path) -> None:
    parts = """\
  filter: {type: spatial_filter, pose: {x: 450, y: 260, yaw: 0}}
  meter: {type: power_meter, pose: {x: 700, y: 260, yaw: 0}}
"""
    with bench(tmp_path, parts, filter={"pinhole_y": 30, "pinhole_z": -25}, meter={"wavelength": 632.8}) as it:
        found = it.optimize("spatial_filter", "filter")
        assert found.met, found
        assert beside(truth(it, tmp_path), "filter") < 0.003


def test_a_beam_is_collimated_by_two_cameras(tmp_path: Path) -> None:
    parts = """\
  first: {type: plano_convex_60, pose: {x: 360, y: 260, yaw: 0}}
  lens: {type: lens_xyz_stage, pose: {x: 520, y: 260, yaw: 0}}
  split: {type: beam_splitter_50_50, pose: {x: 640, y: 260, yaw: 0}}
  near: {type: beam_camera, parameters: {filter_density: 3}, pose: {x: 640, y: 360, yaw: 90}}
  far: {type: beam_camera, parameters: {filter_density: 3}, pose: {x: 1300, y: 260, yaw: 0}}
"""
    with bench(
        tmp_path, parts, lens={"stage_x": -3, "stage_y": 0, "stage_z": 0}, near={"exposure": 1}, far={"exposure": 1}
    ) as it:
        found = it.optimize("collimate", "lens", "near", "far")
        light = truth(it, tmp_path)
        wide = [light.at(camera)[0].beam.widths[0] for camera in ("near", "far")]
        assert found.met and wide[0] == pytest.approx(wide[1], rel=0.015)
        assert found.algorithm == "centroid_newton"  # a difference of widths is no width: no parabola
        assert "does not tell whether the beam widens" in refused(it, "collimate", "lens", "near")


def test_a_fibre_takes_what_two_mirrors_and_a_focus_bring(tmp_path: Path) -> None:
    parts = TWO_MIRRORS + "  coupler: {type: fiber_coupler, pose: {x: 800, y: 440, yaw: 0}}\n"
    off = {"m1": {"tip": 0.6, "tilt": -0.5}, "m2": {"tip": 0.5, "tilt": 0.6}}
    with bench(tmp_path, parts, **off) as it:
        found = it.optimize("fiber", "coupler")
        assert found.met and beside(truth(it, tmp_path), "coupler") < 0.1, found
        assert "more must be said" in refused(it, "fiber")


INTERFEROMETER = Path(__file__).parents[2] / "labs" / "mach_zehnder"


def two_arms(folder: Path, *shutters: str) -> Bench:
    """Open the Mach-Zehnder example, its parts put down, with shutters in its arms, a far camera at its other port."""
    lab = yaml.safe_load((INTERFEROMETER / "lab.yaml").read_text())
    table = yaml.safe_load((INTERFEROMETER / "state" / "table.yaml").read_text())
    parts, own = lab["inventory"], table["components"]
    for name in own.keys() & parts.keys():
        if "pose" in own[name]:
            parts[name] = {"type": parts[name]["type"], "pose": own[name].pop("pose")}
    for name in ("meter", "stop"):
        del parts[name], own[name]
    places = {"over": {"x": 560, "y": 320, "yaw": 0}, "up": {"x": 320, "y": 420, "yaw": 90}}
    parts |= {name: {"type": "shutter", "pose": places[name]} for name in shutters}
    parts["far"] = {"type": "beam_camera", "pose": {"x": 470, "y": 150, "yaw": -90}}
    own |= {"far": {"exposure": 1}, **{name: {"shutter": "open"} for name in shutters}}
    own["m2"] |= {"tip": 0.4, "tilt": -0.3}
    own["m3"] |= {"tip": -0.3, "tilt": 0.2}
    lab["sim"]["environment"] = "none"
    (folder / "lab.yaml").write_text(yaml.safe_dump(lab))
    (folder / "table.yaml").write_text(yaml.safe_dump(table))
    opened = pico.open(folder)
    assert opened.apply().outcome == "done"
    return opened


def apart(light: Light, camera: str) -> float:
    """How far apart the two beams on a camera are [mm]."""
    one, other = (a.beam.at for a in light.at(camera))
    return float(abs(one - other).max())


@pytest.mark.slow
def test_two_arms_of_an_interferometer_are_brought_one_on_the_other(tmp_path: Path) -> None:
    with two_arms(tmp_path, "over", "up") as it:
        assert min(apart(truth(it, tmp_path), camera) for camera in ("cam", "far")) > 0.3
        found = it.optimize("overlap", "cam", "far")
        assert found.met, found
        assert max(apart(truth(it, tmp_path), camera) for camera in ("cam", "far")) < 0.01


def test_arms_that_nothing_can_stop_are_not_told_apart(tmp_path: Path) -> None:
    with two_arms(tmp_path, "over") as it:
        assert "a shutter in each arm" in refused(it, "overlap", "cam", "far")


def white_light(folder: Path, lamp: str = "white_light_source", tip: float = 1.0) -> Bench:
    """Open the Mach-Zehnder example with another source and a small camera, put down with errors of its seats, an arm
    0.2 mm too short."""
    lab = yaml.safe_load((INTERFEROMETER / "lab.yaml").read_text())
    table = yaml.safe_load((INTERFEROMETER / "state" / "table.yaml").read_text())
    parts, own = lab["inventory"], table["components"]
    parts["laser"]["type"] = lamp
    parts["cam"]["parameters"] = {"pixels_across": 640, "pixels_up": 512, "pixel_size": 13}
    own["m3"]["tip"] = tip
    own["delay"] = {"stage_x": 4.9}
    lab["sim"] = {"fidelity": "kinematic", "seed": 3, "errors": {"seat": 0.3}}
    (folder / "lab.yaml").write_text(yaml.safe_dump(lab))
    (folder / "table.yaml").write_text(yaml.safe_dump(table))
    opened = pico.open(folder)
    assert opened.apply().outcome == "done"
    return opened


@pytest.mark.slow
def test_arms_are_made_as_long_as_one_another_in_white_light(tmp_path: Path) -> None:
    """Where cameras see a mirror 10 um from where it truly is, fringes are 10 widths away, and dark to both sides."""
    with white_light(tmp_path) as it:
        it.sim.upset("m2", ahead=0.01)
        begun = meeting(truth(it, tmp_path), "cam")
        assert begun and abs(begun.delay) > 0.2 and begun.length < 0.003
        found = it.optimize("zero_delay", "delay", "cam")
        assert found.met and found.first is None, found
        ended = meeting(truth(it, tmp_path), "cam")
        assert ended and abs(ended.delay) < 3e-4, ended
        assert found.last and found.last["cam.fringes.visibility"] == pytest.approx(ended.contrast, rel=0.15)
        assert 6 < found.measurements < 60


def test_arms_are_not_compared_where_fringes_would_not_tell(tmp_path: Path) -> None:
    with white_light(tmp_path, "hene_laser") as it:
        assert "of a single frequency" in refused(it, "zero_delay", "delay", "cam")
        assert "makes one arm longer" in refused(it, "zero_delay", "m1.piezo", "cam")


def test_arms_that_do_not_overlap_show_no_fringes(tmp_path: Path) -> None:
    with white_light(tmp_path, tip=2.0) as it:
        it.apply(it.single("m2", "set", tip=-2.0))
        assert "`overlap`" in refused(it, "zero_delay", "delay", "cam")


def test_what_light_found_is_taken_back_exactly(tmp_path: Path) -> None:
    """A hundredth of a milliradian is nothing to the axis of a mirror, and something to light."""
    with bench(tmp_path, TWO_MIRRORS, m2={"tip": 0.258, "tilt": 0.1}) as it:
        it.apply(it.single("m2", "set", tip=0.269))
        assert it.apply(it.recovery.undo_plan()).outcome == "done"
        assert it.observe().known_values["m2"] == {"tip": 0.258, "tilt": 0.1}


@pytest.mark.parametrize(("old", "new"), [("centre", "center"), ("fibre", "fiber")])
def test_the_words_of_earlier_versions_mean_the_goals_of_today(tmp_path: Path, old: str, new: str) -> None:
    opened = bench(tmp_path, TWO_MIRRORS)
    said = []
    for word in (old, new):
        with pytest.raises(PicoError) as refused:
            opened.optimize(word, "m9")
        said.append(str(refused.value))
    assert said[0] == said[1] and old not in said[0]
