"""What is captured is what stands: after a capture nothing is to be moved, and nothing is captured again."""

from __future__ import annotations

from dataclasses import replace

from hypothesis import given, settings
from hypothesis import strategies as st

from examples import examples
from pico.backends.sim.world import new_world, observe
from pico.manifest.capture import capture
from pico.manifest.load import load_files
from pico.model.observation import Observation, ObservedValue, live_state, slot_at
from pico.model.plan import Plan
from pico.model.pose import Pose
from pico.model.state import LabState
from pico.planning import PlanGoal, Planner
from pico.resources import labs_dir

LAB = {"lab.yaml": (labs_dir() / "shel" / "lab.yaml").read_bytes()}
HEAD = "apiVersion: pico/v1\nkind: LabState\nmetadata: {lab: shel}\ncomponents:"
SETUP, _ = load_files({**LAB, "table.yaml": f"{HEAD} {{}}\n".encode()}).require()
PARTS = [name for name in sorted(SETUP.lab.inventory) if SETUP.movable(name)]
SLOTS = sorted(SETUP.lab.slots)
HOMES = {name: SETUP.lab.inventory[name].home for name in PARTS}
FREE = HOMES | dict(zip(PARTS, sorted(SETUP.lab.slots.keys() - set(HOMES.values())), strict=False))
CAPTURE = 10.0

OFF = st.floats(-1.1 * CAPTURE, 1.1 * CAPTURE)
YAW = st.one_of(st.sampled_from([0.0, 45.0, 90.0, 180.0, -180.0, 179.999]), st.floats(-180, 180))
NUDGE = st.one_of(st.just(0.0), st.floats(-0.8, 0.8), st.floats(-15, 15))
TURN = st.one_of(st.just(0.0), st.floats(-0.8, 0.8), st.sampled_from([360.0, -360.0]), YAW)


@st.composite
def poses(draw: st.DrawFn) -> Pose:
    slot = SETUP.lab.slots[draw(st.sampled_from(SLOTS))]
    return Pose(round(slot.x + draw(OFF), 3), round(slot.y + draw(OFF), 3), round(draw(YAW), 3))


@st.composite
def said(draw: st.DrawFn, name: str) -> Pose | str | None:
    """Draw how a manifest says where a part is: by a slot, by a pose, or (it belongs home) not at all."""
    return draw(st.one_of(st.none(), st.sampled_from([HOMES[name], FREE[name]]), poses()))


def manifest(places: dict[str, Pose | str | None]) -> bytes:
    lines = [HEAD if any(places.values()) else f"{HEAD} {{}}"]
    for name, place in places.items():
        if isinstance(place, Pose):
            lines += [f"  {name}:", f"    pose: {{x: {place.x!r}, y: {place.y!r}, yaw: {place.yaw!r}}}"]
        elif place is not None:
            lines += [f"  {name}:", f"    slot: {place}"]
    return "\n".join([*lines, ""]).encode()


def planned(seen: Observation, wanted: LabState) -> Plan:
    return Planner(SETUP, None, seen).plan(PlanGoal(wanted))


@settings(deadline=None, max_examples=examples(30))
@given(st.data())
def test_after_a_capture_nothing_is_to_be_moved_and_the_form_is_kept(data: st.DataObject) -> None:
    places = {name: data.draw(said(name)) for name in PARTS}
    before = {"table.yaml": manifest(places)}
    wanted = load_files(before, setup=SETUP).require()[1]
    world = new_world(SETUP)
    for name, place in places.items():
        start = place or HOMES[name] or ""
        at = start if isinstance(start, Pose) else SETUP.lab.slots[start].pose
        live = Pose(at.x + data.draw(NUDGE), at.y + data.draw(NUDGE), at.yaw + data.draw(TURN))
        world = world.with_body(name, pose=live)
    angle = ObservedValue(value=data.draw(st.floats(*SETUP.type_of("p1").tunables["angle"].range or ())))
    seen = observe(world.with_value("p1", "angle", angle), "sim", "")

    after = {**before, **capture(before, SETUP, wanted, live_state(SETUP, seen))}
    now = load_files(after, setup=SETUP).require()[1]

    assert planned(seen, now).reached
    assert capture(after, SETUP, now, live_state(SETUP, seen)) == {}
    assert after == before or not planned(seen, wanted).reached
    for name in PARTS:
        live, was, is_now = seen.components[name].pose, wanted.components.get(name), now.components.get(name)
        assert live is not None
        if was and was.pose:
            assert is_now is not None and is_now.pose is not None
        elif slot_at(SETUP, live):
            assert is_now is None or is_now.slot is not None
        else:
            assert is_now is not None and is_now.pose is not None


def test_a_nudge_inside_a_slot_is_captured_where_the_manifest_has_a_pose() -> None:
    before = {"table.yaml": manifest({"p2": Pose(200, 215, 90)})}
    wanted = load_files(before, setup=SETUP).require()[1]
    seen = observe(new_world(SETUP).with_body("p2", pose=Pose(204, 215, 90)), "sim", "")
    assert not planned(seen, wanted).reached
    written = capture(before, SETUP, wanted, live_state(SETUP, seen))
    assert written == {"table.yaml": before["table.yaml"].replace(b"x: 200", b"x: 204")}


def test_what_is_coarser_than_its_tolerance_is_captured_as_it_is() -> None:
    kind = SETUP.type_of("p2")
    coarse = replace(kind.pose.resolution, position=5.0)
    types = {**SETUP.catalog, kind.name: replace(kind, pose=replace(kind.pose, resolution=coarse))}
    setup = replace(SETUP, catalog=types)
    before = {"table.yaml": manifest({"p2": Pose(600, 300, 0)})}
    wanted = load_files(before, setup=setup).require()[1]
    seen = observe(new_world(setup).with_body("p2", pose=Pose(612.2, 300, 0.3)), "sim", "")
    written = capture(before, setup, wanted, live_state(setup, seen))
    assert b"x: 612.2," in written["table.yaml"]
