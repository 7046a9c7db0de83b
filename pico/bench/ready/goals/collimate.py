"""A beam that does not widen: as wide on a far camera as on a near one; or as small as can be on a camera that stands
in the focus of a lens, where the size of a spot is the divergence times the focal length."""

from __future__ import annotations

from pico.bench.ready.tuning import ALONG
from pico.model.goal import Goal
from pico.planning.asked import Asked, Ready

TAKES = "LENS CAMERA [CAMERA]: as wide far as near; or smallest in the focus of a lens before one"
LEAST = 2
_SHARE = 0.01
"""Of its width, by which a beam may be wider on one camera than on the other."""
_IN_FOCUS = 0.1
"""Of a focal length, by which a camera may be off the focus."""


def make(asked: Asked) -> Ready:
    """Return the goal of a lens that moves along the light, and the cameras behind it."""
    lens, *words = (asked.part(word) for word in asked.words)
    if not asked.has(lens, ALONG[0]):
        raise asked.refused(f"{lens} has no stage along the light", "`pico catalog show lens_xyz_stage`")
    cameras = [asked.camera(word, "width.major") for word in words[:2]]
    for camera in cameras:
        if not any(lens in way[:-1] for way in asked.ways(camera)):
            raise asked.refused(f"no light comes through {lens} to {camera}", "`pico beam` shows where beams run")
    tunables = asked.bounds(lens, ALONG[0])
    if len(cameras) == 1:
        _require_focus(asked, lens, cameras[0])
        return Ready(asked.name, Goal(tunables=tunables, minimize=f"{cameras[0]}.width.major"))
    near, far = cameras
    return Ready(asked.name, Goal(
        tunables=tunables, reach={f"{far}.width.major - {near}.width.major": 0.0}, tolerance=_near_enough(asked, near),
    ))  # fmt: skip


def _near_enough(asked: Asked, camera: str) -> float:
    """Return which difference of widths is no difference [um], by how wide the beam nominally is."""
    from pico.optics.light import light_of

    light = light_of(asked.setup, asked.poses, asked.values, lit=lambda _: True)
    return round(max((_SHARE * 2e3 * a.beam.widths[0] for a in light.at(camera)), default=10.0), 1)


def _require_focus(asked: Asked, lens: str, camera: str) -> None:
    """Raise PicoError where the camera does not stand in the focus of a lens: one spot tells nothing of divergence."""
    way = asked.way(camera)
    between = [n for n in way[way.index(lens) + 1 : -1] if n and asked.element(n) == "lens"]
    focal = asked.setup.type_of(between[-1]).number("focal_length", "mm") if between else None
    if not between or not focal or abs(_apart(asked, between[-1], camera) - focal) > _IN_FOCUS * focal:
        text = f"the spot on {camera} alone does not tell whether the beam widens"
        raise asked.refused(text, "name a second camera, further behind; or put this one into the focus of a lens")


def _apart(asked: Asked, one: str, other: str) -> float:
    """Return how far apart two parts are along the beam [mm]."""
    way = next(w for axis in asked.axes for w in axis.ways(other) if any(m.component == one for m in w))
    at = next(m.length for m in way if m.component == one)
    return abs(way[-1].length - at)
