"""Where a beam goes, against an independent reference and by cases that anyone can check with a pencil."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from layouts import KINDS, layout, reference

from pico.drawing.beams import beam_paths
from pico.drawing.ruler import measure
from pico.manifest.catalog import load_catalog
from pico.model.lab import Lab, Part, Table
from pico.model.observation import Observation, ObservedComponent
from pico.model.operation import Operation, Reason
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.model.state import ComponentState, LabState
from pico.optics.axis import LEGS, axis_of
from pico.optics.ends import stray_beams
from pico.planning.checks.beams import shutter_of
from pico.policy.reaching import reaching

TYPES = {
    "source": "hene_laser", "mirror": "mirror_tip_tilt", "beam_splitter": "beam_splitter_50_50",
    "lens": "plano_convex_100", "detector": "beam_camera", "block": "beam_block", "shutter": "shutter",
}  # fmt: skip

SENSOR = 27.0
"""How far behind its aperture a camera has its sensor, to which the ruler measures [mm]."""


@pytest.fixture(scope="module")
def names() -> dict[str, list[str]]:
    return {kind: [f"{kind}{n}" for n in range(1 if kind == "source" else 8)] for kind in ("source", "shutter", *KINDS)}


@pytest.fixture(scope="module")
def setup(names: dict[str, list[str]]) -> Setup:
    parts = {name: Part(type=TYPES[kind], home="none") for kind, every in names.items() for name in every}
    return Setup(
        lab=Lab(name="light", table=Table(size=(2400, 1200)), robots={}, inventory=parts), catalog=load_catalog()
    )


@pytest.mark.parametrize("count", [100, pytest.param(1000, marks=pytest.mark.slow)])
def test_random_layouts_give_what_an_independent_reference_gives(
    setup: Setup, names: dict[str, list[str]], count: int
) -> None:
    bent = divided = 0
    for seed in range(count):
        poses = layout(setup, names, seed)
        axis = axis_of(setup, poses, "source0")
        wanted = list(reference(setup, poses, LEGS))
        assert len(axis.legs) == len(wanted), seed
        for leg, stretch in zip(axis.legs, wanted, strict=True):
            last = leg.met[-1]
            assert (last.component, last.event) == (stretch.name, stretch.event), seed
            assert abs(complex(*last.at[:2]) - stretch.end) < 1e-6, seed
            assert last.length == pytest.approx(stretch.length), seed
            bent += last.event == "reflected"
            divided += last.event == "divided"
    assert bent > count / 2 and divided > count / 4, "the layouts are too easy to mean anything"


def test_a_beam_goes_round_two_mirrors_to_a_camera(setup: Setup) -> None:
    poses = {
        "source0": Pose(100, 300), "lens0": Pose(300, 300), "mirror0": Pose(600, 300, -45),
        "mirror1": Pose(600, 700, 135), "detector0": Pose(1000, 700),
    }  # fmt: skip
    axis = axis_of(setup, poses, "source0")
    assert [(m.component, m.event) for m in axis.meetings] == [
        ("lens0", "passed"), ("mirror0", "reflected"), ("mirror1", "reflected"), ("detector0", "detected"),
    ]  # fmt: skip
    (way,) = axis.ways("detector0")
    out = poses["source0"].x + setup.type_of("source0").frames.optical[0]
    assert way[-1].length == pytest.approx(600 - out + 400 + 400 - 27)
    assert axis.reaches("detector0") and not axis.reaches("block0")


def test_both_arms_of_a_splitter_are_followed_and_come_back_to_it(setup: Setup) -> None:
    poses = {
        "source0": Pose(100, 600), "beam_splitter0": Pose(600, 600), "mirror0": Pose(600, 800, 90),
        "mirror1": Pose(850, 600, 0), "detector0": Pose(600, 200, -90),
    }  # fmt: skip
    ways = axis_of(setup, poses, "source0").ways("detector0")
    assert len(ways) == 2, "light of both arms of a Michelson interferometer comes to the camera"
    assert abs(ways[0][-1].length - ways[1][-1].length) == pytest.approx(2 * (250 - 200))


def test_tip_and_tilt_turn_the_beam_by_twice_as_much(setup: Setup) -> None:
    poses = {"source0": Pose(100, 300), "mirror0": Pose(1500, 300, -45)}

    def end(**values: float) -> tuple[float, float, float]:
        return axis_of(setup, poses, "source0", {"mirror0": values}).legs[-1].end

    x, y, z = end()
    assert (x, y, z) == pytest.approx((1500, 1200, 70))
    assert end(tip=10)[0] == pytest.approx(1500 - 900 * math.tan(0.02))
    assert end(tilt=10)[2] == pytest.approx(70 + 900 * math.tan(0.02) / math.sqrt(2), rel=1e-3)
    low = axis_of(setup, poses, "source0", {"mirror0": {"tilt": -70}}).legs[-1]
    assert low.met[-1].event == "left" and low.end[2] == pytest.approx(0) and low.end[1] < 1200


@pytest.mark.parametrize(
    ("pose", "event"),
    [
        (Pose(600, 300), "passed"),
        (Pose(600, 306), "passed"),
        (Pose(600, 307), "blocked"),
        (Pose(600, 300, 90), "blocked"),
        (Pose(600, 300, 20), "passed"),
    ],
)
def test_what_passes_and_what_stands_in_the_way(setup: Setup, pose: Pose, event: str) -> None:
    met = axis_of(setup, {"source0": Pose(100, 300), "shutter0": pose}, "source0").meetings
    assert (met[0].component, met[0].event) == ("shutter0", event)


def test_the_back_of_a_mirror_and_a_block_end_the_beam(setup: Setup) -> None:
    for name, yaw in (("mirror0", 180), ("block0", 0)):
        axis = axis_of(setup, {"source0": Pose(100, 300), name: Pose(600, 300, yaw)}, "source0")
        assert [m.event for m in axis.meetings] == ["blocked"] and not axis.reaches(name)


def test_a_detector_sees_light_from_its_face_only(setup: Setup) -> None:
    for yaw, event in ((0, "detected"), (180, "blocked"), (30, "detected"), (120, "blocked")):
        turned = math.radians(yaw)
        at = Pose(900 + 27 * math.cos(turned), 300 + 27 * math.sin(turned), yaw)
        axis = axis_of(setup, {"source0": Pose(100, 300), "detector0": at}, "source0")
        assert axis.meetings[0].event == event, yaw


@pytest.mark.parametrize(("opening", "event"), [(1.0, "blocked"), (5.9, "blocked"), (6.1, "passed"), (11.5, "passed")])
def test_an_iris_is_as_open_as_it_is_set(setup: Setup, opening: float, event: str) -> None:
    poses = {"source0": Pose(100, 300), "iris": Pose(500, 303)}
    parts = {**setup.lab.inventory, "iris": Part(type="iris", home="none")}
    with_iris = replace(setup, lab=replace(setup.lab, inventory=parts))
    axis = axis_of(with_iris, poses, "source0", {"iris": {"opening": opening}})
    assert axis.meetings[0].event == event


def test_the_ruler_and_pictures_know_how_mirrors_are_tipped(setup: Setup) -> None:
    poses = {"source0": Pose(100, 300), "mirror0": Pose(700, 300, -43), "detector0": Pose(700, 600, 90)}
    straight = {"mirror0": {"tip": -math.radians(2) * 1000}}
    assert measure(setup, poses, {}, "source0", "detector0").ways == ()
    (way,) = measure(setup, poses, {}, "source0", "detector0", straight).ways
    assert way.length == pytest.approx(600 - 60 + 300, abs=1)
    assert beam_paths(setup, poses, straight)[-1][2] == pytest.approx((700, 573, 70), abs=0.1)
    for dark in ({"emission": False}, {"shutter": "closed"}):
        assert beam_paths(setup, poses, {"source0": dark}) == []


def test_light_that_comes_back_ends_at_the_laser(setup: Setup) -> None:
    axis = axis_of(setup, {"source0": Pose(500, 300), "mirror0": Pose(900, 300)}, "source0")
    assert [(m.component, m.event) for m in axis.meetings] == [("mirror0", "reflected"), ("source0", "blocked")]


def test_a_beam_that_goes_round_for_ever_is_followed_no_further_than_that(setup: Setup) -> None:
    poses = {"source0": Pose(500, 300), "beam_splitter0": Pose(900, 300, 0), "mirror0": Pose(1200, 300)}
    poses |= {"beam_splitter1": Pose(750, 300), "mirror1": Pose(900, 500, 90), "mirror2": Pose(900, 100, -90)}
    axis = axis_of(setup, poses, "source0")
    assert axis.endless and len(axis.legs) == LEGS


def test_picture_planner_policy_and_ruler_tell_the_same(setup: Setup) -> None:
    poses = {
        "source0": Pose(100, 300), "shutter0": Pose(250, 300), "mirror0": Pose(600, 300, -45),
        "mirror1": Pose(600, 700, 135), "detector0": Pose(1000, 700), "detector1": Pose(1000, 300),
    }  # fmt: skip
    axis = axis_of(setup, poses, "source0")
    assert beam_paths(setup, poses) == [("source0", leg.start, leg.end) for leg in axis.legs]
    seen = Observation(backend="sim", components={n: ObservedComponent(pose=pose) for n, pose in poses.items()})
    assert shutter_of(setup, seen, (), "source0") == axis.meetings[0].component == "shutter0"
    reaches = reaching(setup, seen)
    assert {n: reaches("source0", n) for n in poses if n != "source0"} == {
        n: axis.reaches(n) for n in poses if n != "source0"
    }
    assert reaches("source0", "detector0") and not reaches("source0", "detector1")
    for name in ("shutter0", "mirror1", "detector0"):
        (way,) = measure(setup, poses, {}, name, "source0").ways
        behind = SENSOR if name == "detector0" else 0.0
        assert way.length == axis.ways(name)[0][-1].length + behind
    for wrong, said in ((("mirror0", "detector0"), "no source"), (("source0", "cam"), "no component")):
        with pytest.raises(ValueError, match=said):
            reaches(*wrong)


def test_a_shutter_does_not_count_where_anything_is_put_before_it_on_its_way(setup: Setup) -> None:
    poses = {"source0": Pose(100, 300), "shutter0": Pose(500, 300), "lens0": Pose(300, 600)}
    seen = Observation(backend="sim", components={n: ObservedComponent(pose=pose) for n, pose in poses.items()})

    def put(*goals: Pose) -> list[Operation]:
        to = ({"pose": {"x": pose.x, "y": pose.y, "yaw": pose.yaw}} for pose in goals)
        why = Reason(kind="changed")
        return [
            Operation(id=f"o{n}", primitive="move", component="lens0", arguments={"from": {}, "to": end}, reason=why)
            for n, end in enumerate(to)
        ]

    aside, before, behind = Pose(300, 800), Pose(300, 300), Pose(700, 300)
    assert shutter_of(setup, seen, put(aside, behind), "source0") == "shutter0"
    assert shutter_of(setup, seen, put(before, aside), "source0") is None


def test_the_ruler_tells_the_difference_of_two_arms(setup: Setup) -> None:
    poses = {
        "source0": Pose(100, 600), "beam_splitter0": Pose(600, 600), "mirror0": Pose(600, 800, 90),
        "mirror1": Pose(850, 600, 0), "detector0": Pose(600, 200, -90),
    }  # fmt: skip
    short, long = measure(setup, poses, {}, "source0", "detector0").ways
    assert long.length - short.length == pytest.approx(100)
    assert (short.over, long.over) == (
        ("beam_splitter0", "mirror0", "beam_splitter0"), ("beam_splitter0", "mirror1", "beam_splitter0"),
    )  # fmt: skip
    (way,) = measure(setup, poses, {}, "mirror0", "detector0").ways
    assert way.length == pytest.approx(200 + 400)


@pytest.mark.parametrize(
    ("poses", "said"),
    [
        ({"block0": Pose(900, 300)}, []),
        ({"detector0": Pose(900, 300)}, []),
        ({}, ["the beam of source0 leaves the table at (2400, 300)"]),
        ({"mirror0": Pose(900, 300)}, ["the beam of source0 comes back to it at (160, 300)"]),
        ({"lens0": Pose(900, 320)}, ["the beam of source0 ends on the housing of lens0 at (870, 300)"]),
    ],
)
def test_a_beam_that_nothing_ends_is_told(setup: Setup, poses: dict[str, Pose], said: list[str]) -> None:
    at = {"source0": Pose(100, 300), **poses}
    lab = replace(setup.lab, inventory={name: setup.lab.inventory[name] for name in at})
    state = LabState(
        lab="light",
        components={
            n: ComponentState(pose=p, values={"emission": True} if n == "source0" else {}) for n, p in at.items()
        },
    )
    found = stray_beams(replace(setup, lab=lab), state)
    assert [d.summary.partition(", beside")[0] for d in found] == said


def test_a_laser_that_the_state_does_not_name_throws_no_beam(setup: Setup) -> None:
    lab = replace(setup.lab, inventory={"source0": Part(type=TYPES["source"], pose=Pose(100, 300))})
    assert stray_beams(replace(setup, lab=lab), LabState(lab="light", components={})) == ()


@pytest.mark.parametrize(("unit", "value"), [("mm", 2.0), ("um", 2000.0), ("cm", 0.2), ("deg", 2.0)])
def test_a_stage_moves_an_optic_in_whatever_unit_it_is_declared(unit: str, value: float) -> None:
    from dataclasses import replace

    from pico.manifest.catalog import load_catalog
    from pico.optics.axis import optic_of

    kind = load_catalog()["lens_xyz_stage"]
    tunables = {**kind.tunables, "stage_y": replace(kind.tunables["stage_y"], unit=unit)}
    center = optic_of(replace(kind, tunables=tunables), "l", Pose(0, 0), {"stage_y": value}).center
    assert center == pytest.approx((0, 0.0 if unit == "deg" else 2.0, 70))


@pytest.mark.parametrize(("unit", "value"), [("mrad", 10.0), ("urad", 1e4), ("deg", 0.01 * 180 / 3.141592653589793)])
def test_a_mirror_tips_in_whatever_unit_it_is_declared(unit: str, value: float) -> None:
    from dataclasses import replace

    from pico.manifest.catalog import load_catalog
    from pico.optics.axis import optic_of

    kind = load_catalog()["mirror_tip_tilt"]
    tunables = {**kind.tunables, "tip": replace(kind.tunables["tip"], unit=unit)}
    normal = optic_of(replace(kind, tunables=tunables), "m", Pose(0, 0), {"tip": value}).normal
    assert normal[:2] == pytest.approx((-math.cos(0.01), -math.sin(0.01)))


def test_a_head_that_is_declared_to_end_beams_is_no_bad_end_and_two_arms_are_one_warning(setup: Setup) -> None:
    at = {"source0": Pose(100, 600), "beam_splitter0": Pose(600, 600), "mirror0": Pose(600, 800, 90),
          "mirror1": Pose(850, 600, 0), "detector0": Pose(600, 200, -90)}  # fmt: skip
    parts = {n: ComponentState(pose=p, values={"emission": True} if n == "source0" else {}) for n, p in at.items()}
    state, own = LabState(lab="light", components=parts), {name: setup.lab.inventory[name] for name in at}
    back = [d.summary for d in stray_beams(replace(setup, lab=replace(setup.lab, inventory=own)), state)]
    assert back == ["the beam of source0 comes back to it at (160, 600) (2 beams)"]
    own["source0"] = replace(own["source0"], ends_beams=True)
    assert stray_beams(replace(setup, lab=replace(setup.lab, inventory=own)), state) == ()
