"""What blocks an arm, said to a person."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from pico.model.pose import Pose
from pico.motion.scene import Hit
from pico.motion.types import Blocked, SegmentName


@dataclass(frozen=True, slots=True)
class Errand:
    """What an arm was asked: to move `component` from `start` to `goal`, or (None) to park."""

    robot: str
    component: str | None = None
    start: Pose | None = None
    goal: Pose | None = None

    def doing(self, segment: SegmentName) -> str:
        """Return what the arm does in `segment`, as the end of a sentence."""
        c, a, b = self.component, self.start, self.goal
        return {
            "approach": f"on its way to {c} at {a}",
            "descend": f"going down to {c} at {a}",
            "grip": f"closing on {c} at {a}",
            "lift": f"lifting {c} at {a}",
            "transit": f"carrying {c} from {a} to {b}",
            "lower": f"setting {c} down at {b}",
            "release": f"letting go of {c} at {b}",
            "retreat": f"leaving {c} at {b}",
            "park": "on its way to its park pose",
        }[segment]


def blocked(errand: Errand, segment: SegmentName, hit: Hit) -> Blocked:
    """Return the answer that says what is hit, by what, how deep and when."""
    obstacle = {
        "keep_out": f"the keep-out zone {hit.obstacle}",
        "table": "the table",
        "self": f"its own {hit.obstacle.partition(' ')[2]}",
    }.get(hit.kind, hit.obstacle)
    what = _subject(errand, hit.part)
    if hit.gap < 0:
        does = f"would hit {obstacle} by {-hit.gap:.1f} mm"
    else:
        does = f"would come within {hit.gap:.1f} mm of {obstacle} ({hit.gap + hit.missing:.4g} mm are kept)"
    kind: Literal["keep_out", "collision"] = "keep_out" if hit.kind == "keep_out" else "collision"
    name = errand.robot if hit.kind == "self" else hit.obstacle
    by = -hit.gap if hit.gap < 0 else hit.missing
    text = f"{what} {does}, {errand.doing(segment)}"
    return Blocked(kind, text, segment, name, round(by, 3), _help(errand, segment, hit))


_YAW = "another grasp yaw (`grasp.yaws` of its type)"


def _help(errand: Errand, segment: SegmentName, hit: Hit) -> str:
    """What might let the arm pass: each is worth a try, none is promised."""
    if hit.kind == "self":
        return f"choose a place farther from {errand.robot}'s base, or {_YAW}"
    if hit.kind == "table":
        return f"let {errand.component} be grasped higher" if errand.component else "raise the arm by hand first"
    if hit.obstacle == errand.component:
        return "use a grasp yaw (`grasp.yaws` of its type) at which the jaws close on parallel faces"
    away = f"make the zone {hit.obstacle} smaller" if hit.kind == "keep_out" else f"move {hit.obstacle} away first"
    moving = errand.component and segment not in ("descend", "grip", "lift")
    other = "another place or slot" if moving else ""
    if hit.part in ("finger", "gripper", "held") and errand.component and segment not in ("approach", "park"):
        other = f"{_YAW} or {other}" if other else _YAW
    return f"{away}, or choose {other}" if other else away


def _subject(errand: Errand, part: str) -> str:
    if part == "held":
        return f"{errand.component} in the hand of {errand.robot}"
    if part == "finger":
        return f"a finger of {errand.robot}"
    return f"{part.replace('link', 'link ')} of {errand.robot}"
