"""Light that is like another but for a part or two is what tracing it from its source would give."""

from __future__ import annotations

import pytest

from pico.manifest.load import load_folder
from pico.model.pose import Pose
from pico.optics.light import Light, light_of
from pico.optics.unseen import Unseen
from pico.resources import labs_dir

POSES = {"laser": Pose(120, 420), "hwp": Pose(222, 420), "p1": Pose(290, 420), "lx_125": Pose(395, 420),
         "p2": Pose(520, 420, 30), "ly_150": Pose(670, 420), "cam": Pose(1060, 420)}  # fmt: skip
VALUES = {"laser": {"emission": True, "shutter": "open"}, "hwp": {"angle": 22.75}, "p1": {"angle": 1.0},
          "p2": {"angle": 90.0}}  # fmt: skip


def told(light: Light) -> list[object]:
    """Return all that a light says of each crossing, its numbers exactly."""
    return [
        (c.component, c.event, c.power, c.onward, c.clipped, c.before, c.beam.at.tolist(), c.beam.curvature.tolist())
        for c in light.crossings
    ]


@pytest.mark.parametrize(
    ("changed", "values", "unseen"),
    [
        ("p1", {**VALUES, "p1": {"angle": 2.5}}, {}),
        ("lx_125", VALUES, {"lx_125": Unseen(up=0.2)}),
        ("lx_125", VALUES, {"lx_125": Unseen(left=40.0)}),
        ("laser", VALUES, {"laser": Unseen(yaw=0.3)}),
        ("cam", VALUES, {"cam": Unseen(loss=0.4)}),
    ],
)
def test_light_like_another_is_what_following_it_anew_gives(
    changed: str, values: dict[str, dict[str, object]], unseen: dict[str, Unseen]
) -> None:
    setup = load_folder(labs_dir() / "shel").require()[0]
    known = light_of(setup, POSES, VALUES)
    anew = light_of(setup, POSES, values, unseen=unseen)
    found = light_of(setup, POSES, values, unseen=unseen, like=known, changed={changed})
    assert told(found) == told(anew)
    assert [a.power for a in found.at("cam")] == [a.power for a in anew.at("cam")]
    first = next(n for n, c in enumerate(anew.crossings) if c.component == changed) if changed != "laser" else 0
    shared = [a is not None and a.beam is b.beam for a, b in zip(found.crossings, known.crossings, strict=False)]
    assert all(shared[:first]) and not any(shared[first + 1 :])  # nothing before it is worked out again
