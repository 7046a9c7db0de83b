"""The scene of a bench as data: arms whose links come to where MuJoCo has them, light, and what is told of changes."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pico.backends.sim.bodies import body_placement
from pico.backends.sim.world import World, new_world, observe
from pico.drawing.scene.frames import Frame, decoded, encoded
from pico.drawing.scene.rays import color_of
from pico.drawing.scene.scene import numbered, scene
from pico.edge.live import telling
from pico.manifest.load import load_folder
from pico.model.catalog import Footprint
from pico.model.observation import ObservedValue, UnknownObject
from pico.model.pose import Pose
from pico.model.robot import Mount, Robot
from pico.model.setup import Setup
from pico.motion.arm import attach_arm
from pico.motion.xarm7 import LIMITS
from pico.resources import labs_dir
from pico.twin.moment import Moment, moment_of

GOLDEN = Path(__file__).parent.parent / "server" / "frames.json"


@cache
def lab(name: str) -> Setup:
    return load_folder(labs_dir() / name).require()[0]


@pytest.fixture(scope="module")
def shel() -> Setup:
    return lab("shel")


def moment(setup: Setup, world: World) -> Moment:
    places = {name: body_placement(setup, world, name) for name in world.components}
    return Moment(observe(world, "sim", ""), {n: p for n, p in places.items() if p is not None}, world.openings)


def whole(setup: Setup, world: World) -> dict[str, Any]:
    now = moment(setup, world)
    return scene(setup, now, numbered(setup, now))


def matrix(origin: Any, quaternion: Any) -> Any:
    found, turned = np.eye(4), np.zeros(9)
    mujoco.mju_quat2Mat(turned, np.array(quaternion, float))
    found[:3, :3], found[:3, 3] = turned.reshape(3, 3), origin
    return found


def driven(link: dict[str, Any], value: float) -> Any:
    """Return what the drive of a link does at a value, as a page is to do it."""
    axis = np.array(link["axis"], float)
    if link["kind"] == "slides":
        return matrix(axis * link["factor"] * value, (1, 0, 0, 0))
    return matrix((0, 0, 0), (math.cos(value / 2), *(math.sin(value / 2) * axis)))


def placed(arm: dict[str, Any]) -> dict[str, Any]:
    """Return where the links of an arm are, as a page works it out."""
    mount, frames = arm["mount"], list[Any]()
    half = math.radians(mount["yaw"]) / 2
    base = matrix((mount["x"], mount["y"], mount["z"]), (math.cos(half), 0, 0, math.sin(half)))
    for link in arm["links"]:
        drive = link["drive"]
        own = matrix(link["origin"], link["quaternion"])
        if drive is not None:
            own = own @ driven(link, arm["width"] if drive == "width" else arm["joints"][drive])
        frames.append((base if link["parent"] is None else frames[link["parent"]]) @ own)
    return {link["name"]: frame for link, frame in zip(arm["links"], frames, strict=True)}


@given(st.tuples(*(st.floats(low, high) for low, high in LIMITS)), st.floats(0, 80))
def test_a_page_that_turns_the_joints_has_the_links_where_they_are(joints: tuple[float, ...], width: float) -> None:
    setup = lab("two_arms")
    world = new_world(setup)
    name = sorted(setup.lab.robots)[1]
    world = replace(
        world, robots={**world.robots, name: replace(world.robots[name], joints=joints)}, openings={name: width}
    )
    arm = whole(setup, world)["arms"][1]
    spec = mujoco.MjSpec()
    attach_arm(spec, name, setup.lab.robots[name])
    model = spec.compile()
    data = mujoco.MjData(model)
    for number, angle in enumerate(joints, 1):
        data.joint(f"{name}/joint{number}").qpos[0] = angle
    for finger in ("left", "right"):
        data.joint(f"{name}/{finger}_slide").qpos[0] = width / 2000
    mujoco.mj_kinematics(model, data)
    for link, frame in placed(arm).items():
        body = data.body(f"{name}/{link}")
        assert np.allclose(frame[:3, 3], 1000 * body.xpos, atol=1e-6), link
        assert np.allclose(frame[:3, :3], body.xmat.reshape(3, 3), atol=1e-9), link


def test_a_gantry_stands_over_its_tool() -> None:
    setup = lab("minimal")
    robot = Robot(model="gantry", mount=Mount(x=100, y=50))
    setup = replace(setup, lab=replace(setup.lab, robots={"g": robot}))
    world = new_world(setup)
    name = sorted(setup.lab.robots)[0]
    world = replace(world, robots={name: replace(world.robots[name], joints=(0.3, 0.2, 0.25, 0.5))})
    arm = whole(setup, world)["arms"][0]
    tip = placed(arm)["gripper"] @ np.array((0, 0, arm["tool"], 1.0))
    assert np.allclose(tip[:3], (300, 200, 250)) and arm["reach"] is None


def test_the_light_goes_on_where_it_came_to_and_shines_once_the_laser_does(shel: Setup) -> None:
    world = new_world(shel)
    dark = whole(shel, world)["beams"]
    for tunable, value in (("emission", True), ("shutter", "open")):
        world = world.with_value("laser", tunable, ObservedValue(value=value))
    lit = whole(shel, world)["beams"]
    assert dark and {beam["lit"] for beam in dark} == {False} and {beam["lit"] for beam in lit} == {True}
    assert [beam["end"] for beam in dark] == [beam["end"] for beam in lit]
    for beam in lit[1:]:
        assert math.dist(beam["start"], lit[beam["before"]]["end"]) < 15, "an element is no longer than that"
        assert 0 < beam["power"] <= lit[beam["before"]]["onward"] * 1.001
    assert lit[0]["power"] == pytest.approx(shel.type_of("laser").number("power", "mW"), rel=1e-3)


def test_colours_are_those_of_lasers_that_one_knows() -> None:
    red, green, blue = color_of(632.8), color_of(532.0), color_of(450.0)
    assert red[0] > 0.9 > red[1] + 0.6 and green[1] > 0.9 and blue[2] > 0.9 > blue[1] + 0.6
    assert color_of(1064.0)[0] > color_of(1064.0)[2] and color_of(200.0) == color_of(380.0)


def test_a_scene_says_what_stands_on_the_table_and_is_json(shel: Setup) -> None:
    world = new_world(shel)
    block = UnknownObject(pose=Pose(500, 300, 15), footprint=Footprint(box=(40, 20)), height=30)
    world = replace(world.with_body("p1", presence="missing", pose=None), unknown={"unknown/7": block})
    found = json.loads(json.dumps(whole(shel, world), allow_nan=False))
    parts = {part["name"]: part for part in found["components"]}
    assert [part["index"] for part in found["components"]] == list(range(len(parts)))
    assert parts["p1"]["state"] == "lost" and parts["p1"]["position"] is None
    assert parts["laser"]["tunables"]["emission"]["datatype"] == "bool"
    assert parts["unknown/7"]["bodies"][0]["size"] == [40, 20, 30] and parts["unknown/7"]["pose"]["yaw"] == 15
    nx, ny = found["table"]["holes"]["count"]
    holes, (width, depth) = shel.lab.table.holes, shel.lab.table.size
    assert width - holes.pitch < holes.first[0] + (nx - 1) * holes.pitch <= width and ny > 3 and depth > 0
    inner, outer = found["arms"][0]["reach"]
    assert 0 < inner < 300 < outer < 900


def test_what_is_told_is_what_changed(shel: Setup) -> None:
    world = new_world(shel)
    told, first = telling.begun(shel, moment(shel, world), 5)
    assert first["scene"]["epoch"] == 5
    still, poses = telling.moved(told, moment(shel, world))
    assert (
        poses["moved"]["arms"] == poses["moved"]["bodies"] == [] and telling.stood(still, moment(shel, world))[1] == []
    )
    pose = world.components["p1"].pose
    assert pose is not None
    pushed = world.with_body("p1", pose=Pose(pose.x + 3, pose.y, pose.yaw))
    told, poses = telling.moved(told, moment(shel, pushed))
    ((index, x, *_),) = poses["moved"]["bodies"]
    assert told.names[index] == "p1" and x == pytest.approx(pose.x + 3)
    told, light = telling.relit(told, moment(shel, pushed))
    assert light[0]["told"] == "beams" and light[0]["rev"] == 1 and telling.relit(told, moment(shel, pushed))[1] == []
    turned = pushed.with_value("p1", "angle", ObservedValue(value=33.0))
    told, parts = telling.stood(told, moment(shel, turned))
    assert [(p["told"], p["rev"], p["data"]["name"]) for p in parts] == [("component", 2, "p1")]
    assert parts[0]["data"]["values"]["angle"]["value"] == 33.0
    block = UnknownObject(pose=Pose(500, 300, 15), footprint=Footprint(disc=20), height=30)
    told, parts = telling.stood(told, moment(shel, replace(turned, unknown={"unknown/7": block})))
    assert parts[0]["data"]["index"] == len(shel.lab.inventory) and parts[0]["data"]["bodies"]
    _, parts = telling.stood(told, moment(shel, turned))
    assert parts[0]["data"]["state"] == "lost"


def test_a_bench_at_another_speed_is_drawn_alike(shel: Setup) -> None:
    assert telling.drawn_alike(shel, shel.at_speed(0.2))
    assert not telling.drawn_alike(shel, lab("two_arms"))


def test_an_observation_alone_places_what_it_saw(shel: Setup) -> None:
    world = new_world(shel)
    assert moment_of(observe(world, "sim", "")).places == moment(shel, world).places


def test_frames_are_the_bytes_that_were_agreed_on() -> None:
    cases = json.loads(GOLDEN.read_text())
    assert len(cases) == 5 and cases[0]["hex"] == "01" + "01000000" + "00000000" + "00" * 8 + "00" + "0000"
    for case in cases:
        frame = Frame(
            case["epoch"], case["rev"], case["time"],
            {n: (tuple(joints), width) for n, joints, width in case["arms"]},
            {n: (x, y, z, w, i, j, k) for n, x, y, z, w, i, j, k in case["bodies"]},
        )  # fmt: skip
        assert encoded(frame).hex() == case["hex"], case["name"]
        back = decoded(bytes.fromhex(case["hex"]))
        assert (back.epoch, back.rev, back.time) == (frame.epoch, frame.rev, frame.time)
        assert {n: arm[0] for n, arm in back.arms.items()} == {
            n: pytest.approx(arm[0], rel=1e-6) for n, arm in frame.arms.items()
        }
        assert dict(back.bodies) == {n: pytest.approx(body, rel=1e-6) for n, body in frame.bodies.items()}


@given(st.binary(max_size=60), st.integers(0, 4))
def test_other_bytes_are_no_frame(junk: bytes, number: int) -> None:
    whole = bytes.fromhex(json.loads(GOLDEN.read_text())[number]["hex"])
    for broken in (whole[:-1], whole + b"\0", b"\2" + whole[1:], whole[: len(junk) % len(whole)]):
        with pytest.raises(ValueError, match="no frame"):
            decoded(broken)


def test_segments_are_in_the_order_of_the_light(shel: Setup) -> None:
    beams = whole(shel, new_world(shel))["beams"]
    assert all(b["before"] is None or b["before"] < n for n, b in enumerate(beams))
    assert [a["source"] <= b["source"] for a, b in pairwise(beams)]
