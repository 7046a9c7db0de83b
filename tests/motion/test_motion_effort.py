"""How much work moves of an arm take, kept as text: see `kept`. Counts of what costs, never seconds."""

from __future__ import annotations

import math
import random
import sys
from pathlib import Path

from benchtop import DISC, PART, TALL, WIDE, bench, stands

sys.path.append(str(Path(__file__).resolve().parent.parent))

from effort import counting, line
from kept import differs

from pico.model.pose import Pose
from pico.motion.arms import ArmMotion

COUNTED = {
    "motion/scene.py": ("Scene.look", "Scene.arrange", "Scene.hold", "Scene._assess", "Scene._compile"),
    "motion/paths.py": ("swing", "route", "travel", "postures", "_refine", "_detours"),
    "motion/moves.py": ("Move._way", "Move._vertical"),
    "motion/kinematics.py": ("column_of", "fk"),
    "motion/recheck.py": ("Recheck._segment", "Recheck._with_things", "Recheck._hulls"),
    "motion/sweep.py": ("Leg.near", "Leg.measure"),
    "motion/reach.py": ("check_grip", "check_reach"),
    "motion/timing.py": ("straight", "vertical", "swing_seconds"),
    "motion/arms.py": ("ArmMotion._scene", "ArmMotion._stability", "ArmMotion._near"),
    "motion/stability.py": ("_outline",),
}
"""The functions whose calls are counted, by file."""


def test_moves_take_as_much_work_as_they_took() -> None:
    motion, rng, lines = ArmMotion(bench()), random.Random(7), []
    for number in range(16):
        poses: list[Pose] = []
        while len(poses) < 7 + number % 3:
            pose = Pose(rng.uniform(120, 840), rng.uniform(120, 520), rng.uniform(-180, 180))
            if all(pose.distance(p) > 92 for p in poses) and math.hypot(pose.x - 480, pose.y - 760) > 260:
                poses.append(pose)
        kinds = (TALL, PART, DISC, WIDE, PART, TALL, DISC)
        standing = stands(at={f"t{i}": (kind, p) for i, (kind, p) in enumerate(zip(kinds, poses[2:], strict=False))})
        with counting(COUNTED) as calls:
            answer = motion.move("arm1", "a", poses[0], poses[1], 90.0 * (number % 2), standing)
            motion.travel("arm1", poses[0], poses[1], 0.0, 90.0)
        lines.append(line(f"{number}, {type(answer).__name__}", calls))
    assert not differs("effort_of_moves.txt", "\n".join(lines) + "\n")
