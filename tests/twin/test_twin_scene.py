"""The scene holds the bench as the lab and the catalog describe it, and it stands still."""

from __future__ import annotations

from dataclasses import replace

import mujoco
import pytest
from physical import bench

from pico.geometry.mass import bodies_of, masses
from pico.model.body import Body
from pico.model.catalog import Footprint, Geometry
from pico.model.pose import Pose
from pico.model.robot import Mount, Robot
from pico.model.setup import Setup
from pico.model.state import home_state, place_of
from pico.twin.physics import Twin
from pico.twin.placement import Placement, placement_of, upright
from pico.twin.scene import SceneBody, build_scene


def things(setup: Setup) -> dict[str, SceneBody]:
    homes = home_state(setup)
    return {
        name: SceneBody(setup.type_of(name).geometry, upright(place_of(setup, homes, name)[1]), setup.movable(name))
        for name in setup.lab.inventory
    }


@pytest.mark.parametrize("lab", ["shel", "minimal", "crowded"])
def test_components_are_bodies_of_their_mass_where_they_stand(lab: str) -> None:
    setup = bench(lab)
    model = build_scene(setup, things(setup)).compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    for name in setup.lab.inventory:
        pose = place_of(setup, home_state(setup), name)[1]
        found = placement_of(data.body(name).xpos, data.body(name).xquat).pose
        assert found.distance(pose) < 1e-6
        assert model.body(name).mass[0] == pytest.approx(setup.type_of(name).geometry.mass)


@pytest.mark.parametrize("lab", ["shel", "crowded"])
def test_parts_stand_still_also_when_they_are_kept_awake(lab: str) -> None:
    setup = bench(lab)
    joints = {name: tuple(q * 3.141592653589793 / 180 for q in r.park) for name, r in setup.lab.robots.items()}
    twin = Twin(setup, things(setup), joints)
    twin.model.opt.enableflags &= ~int(mujoco.mjtEnableBit.mjENBL_SLEEP)
    before = {name: twin.placement(name) for name in setup.lab.inventory}
    twin.advance(2.0)
    for name, was in before.items():
        now = twin.placement(name)
        assert now.pose.distance(was.pose) < 0.01, name
        assert abs(now.position[2] - was.position[2]) < 1e-5, name
        assert now.tilt < 0.01, name


def test_the_weight_is_low() -> None:
    geometry = bench().type_of("p1").geometry
    shapes = bodies_of(geometry)
    parts = masses(geometry, shapes)
    assert sum(parts) == pytest.approx(geometry.mass)
    assert sum(m * s.at[2] for m, s in zip(parts, shapes, strict=True)) / geometry.mass < 0.4 * geometry.height


@pytest.mark.parametrize(
    ("footprint", "shape"),
    [
        (Footprint(disc=20.0), Body(name="body", shape="cylinder", size=(40.0, 90.0), at=(0, 0, 45.0))),
        (Footprint(box=(30.0, 50.0)), Body(name="body", shape="box", size=(30.0, 50.0, 90.0), at=(0, 0, 45.0))),
        (
            Footprint(polygon=((0.0, 0.0), (30.0, 0.0), (0.0, 20.0))),
            Body(name="body", shape="box", size=(30.0, 20.0, 90.0), at=(15.0, 10.0, 45.0)),
        ),
    ],
)
def test_a_type_without_bodies_fills_its_footprint(footprint: Footprint, shape: Body) -> None:
    found = bodies_of(Geometry(footprint=footprint, height=90.0, mass=0.3))
    assert [replace(body, color=shape.color) for body in found] == [shape]


@pytest.mark.parametrize(("axis", "direction"), [("x", (1, 0, 0)), ("y", (0, 1, 0)), ("z", (0, 0, 1))])
def test_cylinders_lie_along_their_axis(axis: str, direction: tuple[int, int, int]) -> None:
    setup = bench("minimal")
    body = Body(name="tube", shape="cylinder", size=(10.0, 40.0), at=(0, 0, 20.0), axis=axis)
    geometry = Geometry(footprint=Footprint(disc=20.0), height=40.0, mass=0.1, bodies=(body,))
    model = build_scene(setup, {"tube": SceneBody(geometry, upright(Pose(600, 200)))}).compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    along = data.geom("tube/tube").xmat.reshape(3, 3)[:, 2]
    assert abs(along @ direction) == pytest.approx(1.0)


def test_several_arms_stand_at_their_mounts() -> None:
    setup = bench()
    second = Robot(mount=Mount(x=900, y=60, yaw=90))
    both = replace(setup, lab=replace(setup.lab, robots={**setup.lab.robots, "arm2": second}))
    model = build_scene(both, {}).compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    assert data.body("arm2/base").xpos[:2] == pytest.approx((0.9, 0.06))
    assert data.body("arm1/base").xpos[:2] == pytest.approx((0.48, 0.76))


def test_a_placement_knows_pose_and_tilt() -> None:
    pose = Pose(100.0, 200.0, -75.0)
    assert upright(pose).pose.distance(pose) < 1e-9
    assert upright(pose).pose.yaw == pytest.approx(-75.0)
    assert upright(pose).tilt == pytest.approx(0.0, abs=1e-5)
    assert Placement((0, 0, 0), (0.5**0.5, 0.5**0.5, 0, 0)).tilt == pytest.approx(90.0)
