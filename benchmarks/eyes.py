"""How well and how fast the simulated cameras see, without injected error: the noise floor of the eyes.

    python benchmarks/eyes.py [--scenes 10] [--lab labs/shel] [--renderer raycast egl] [--seed 1]

Each scene has up to eight marked components at random poses on the table, the arm parked. `overhead` is what the
cameras over the table make of it together; `hand, 20 cm` is the eye in the hand, the tool upright above a component
so that its plate is 200 mm from the lens. Both are read by `pico.vision` with the cameras exactly calibrated and the
plates known to be level and as high as their type says; sensor noise and blur are the lab's. Errors are distances in
x and y [mm] and in yaw [deg]. The renderer `egl` is left out where the machine has no EGL.
"""

from __future__ import annotations

import argparse
import math
import random
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "tests")]

from oracles.inverse import ik  # noqa: E402
from oracles.localize import localize  # noqa: E402

from pico.cameras.simulated import Eyes, tool_pose  # noqa: E402
from pico.diagnostics import PicoError  # noqa: E402
from pico.drawing.picture import posed_model  # noqa: E402
from pico.manifest.load import load_folder  # noqa: E402
from pico.model.pose import Pose, angle_between  # noqa: E402
from pico.model.setup import Setup  # noqa: E402
from pico.model.simulated import SimErrors  # noqa: E402
from pico.motion.types import Joints  # noqa: E402
from pico.twin.placement import upright  # noqa: E402
from pico.vision.calibration import Accuracy, Calibration  # noqa: E402
from pico.vision.nominal import camera_models  # noqa: E402

APART, EDGE, BACK = 95.0, 60.0, 560.0  # mm, between components, from the table's edges, and no farther back than this
LENS = 200.0
"""Distance of the plate from the lens of the eye in the hand [mm]."""
EXACT = Accuracy(position=0.0, yaw=0.0, height=0.001, pixels=0.1, upright=0.001)
"""What the vision is told of a bench without errors: plates are level and at the height of their type."""


@dataclass
class Row:
    """Errors in x and y [mm] and yaw [deg], components not seen, and CPU seconds of each picture and of its reading."""

    xy: list[float] = field(default_factory=list)
    yaw: list[float] = field(default_factory=list)
    unseen: int = 0
    drawing: list[float] = field(default_factory=list)
    reading: list[float] = field(default_factory=list)

    def add(self, true: Pose, seen: Pose | None) -> None:
        """Count one component."""
        if seen is None:
            self.unseen += 1
            return
        self.xy.append(true.distance(seen))
        self.yaw.append(abs(angle_between(true.yaw, seen.yaw)))

    def text(self, name: str) -> str:
        """Return the row of the table."""
        xy, yaw = (" / ".join(f"{_share(v, q):.4f}" for q in (0.5, 0.95, 1.0)) for v in (self.xy, self.yaw))
        cpu = f"{1000 * _mean(self.drawing):6.0f} {1000 * _mean(self.reading):7.0f}"
        return f"{name:22} {len(self.xy):4} {self.unseen:6}   {xy}   {yaw}   {cpu}"


def _share(values: list[float], share: float) -> float:
    return sorted(values)[math.ceil(share * len(values)) - 1] if values else math.nan


def _mean(values: list[float]) -> float:
    return sum(values) / len(values) if values else math.nan


def scatter(setup: Setup, dice: random.Random, names: list[str]) -> dict[str, Pose]:
    """Return random poses, no two nearer than `APART`, on the part of the table that the parked arm leaves free."""
    width, depth = setup.lab.table.size
    found: dict[str, Pose] = {}
    for name in names:
        for _ in range(200):
            y = dice.uniform(EDGE, min(BACK, depth - EDGE))
            pose = Pose(dice.uniform(EDGE, width - EDGE), y, dice.uniform(-180, 180))
            if all(pose.distance(other) > APART for other in found.values()):
                found[name] = pose
                break
    return found


def scenes(setup: Setup, count: int, seed: int) -> Iterator[dict[str, Pose]]:
    """Yield scenes of up to eight components that carry markers and may move."""
    dice = random.Random(seed)
    marked = [n for n, part in setup.lab.inventory.items() if part.marker is not None and setup.movable(n)]
    for _ in range(count):
        yield scatter(setup, dice, dice.sample(marked, min(8, len(marked))))


def eyes_over(setup: Setup, poses: dict[str, Pose], joints: dict[str, Joints], renderer: str, seed: int) -> Eyes:
    """Return the cameras of a scene, without injected errors."""
    model, data = posed_model(setup, {n: upright(p) for n, p in poses.items()}, joints)
    import mujoco

    mujoco.mj_forward(model, data)
    return Eyes(setup, model, data, errors=SimErrors(), seed=seed, renderer=renderer)


def look(eyes: Eyes, names: list[str], calibration: Calibration, row: Row) -> dict[str, Pose]:
    """Return where the components stand that the cameras `names` see together."""
    begun = time.process_time()
    frames = [eyes.frame(name) for name in names]
    drawn = time.process_time()
    seen = localize(eyes.setup, frames, calibration)
    row.drawing.append((drawn - begun) / len(frames))
    row.reading.append((time.process_time() - drawn) / len(frames))
    return {name: one.pose for name, one in seen.components.items()}


def overhead(setup: Setup, count: int, renderer: str, seed: int) -> Row:
    """Return what the cameras over the table see."""
    row, calibration = Row(), Calibration(camera_models(setup), EXACT)
    names = [n for n, c in setup.lab.cameras.items() if c.robot is None]
    for number, poses in enumerate(scenes(setup, count, seed)):
        seen = look(eyes_over(setup, poses, {}, renderer, seed + number), names, calibration, row)
        for name, pose in poses.items():
            row.add(pose, seen.get(name))
    return row


def hovering(setup: Setup, robot: str, camera: str, component: str, pose: Pose, yaw: float) -> Joints | None:
    """Return the joints that hold the tool upright over a component, its plate `LENS` from the camera; None out of
    reach."""
    plate = setup.type_of(component).geometry.marker
    assert plate is not None
    x, y, z = setup.lab.cameras[camera].position
    below = z + math.sqrt(LENS**2 - x**2 - y**2)  # of the plate under the tool's point
    postures = ik(setup.lab.robots[robot], pose.x, pose.y, plate.at[2] + below, yaw)
    return postures[0] if postures else None


def in_hand(setup: Setup, count: int, renderer: str, seed: int) -> Row:
    """Return what the eye in the hand sees of components below it."""
    row, dice = Row(), random.Random(seed + 1)
    camera = next(n for n, c in setup.lab.cameras.items() if c.robot is not None)
    robot = setup.lab.cameras[camera].robot
    assert robot is not None
    for number, poses in enumerate(scenes(setup, count, seed)):
        for name, pose in poses.items():
            joints = hovering(setup, robot, camera, name, pose, pose.yaw + dice.choice((0.0, 90.0)))
            if joints is None:
                continue
            eyes = eyes_over(setup, {name: pose}, {robot: joints}, renderer, seed + number)
            tool = tool_pose(eyes.model, eyes.data, robot)
            calibration = Calibration(camera_models(setup), EXACT).placed({robot: tool})
            row.add(pose, look(eyes, [camera], calibration, row).get(name))
    return row


def main() -> int:
    """Print the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--scenes", type=int, default=10)
    parser.add_argument("--lab", type=Path, default=ROOT / "labs" / "shel")
    parser.add_argument("--renderer", nargs="+", choices=("raycast", "egl"), default=["raycast", "egl"])
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    setup, _ = load_folder(given.lab).require()
    setup = replace(setup, lab=replace(setup.lab, sim=replace(setup.lab.sim, errors=SimErrors())))
    pixels = " x ".join(str(n) for n in next(iter(setup.lab.cameras.values())).pixels)
    print(f"{setup.lab.name}, seed {given.seed}, {given.scenes} scenes, overhead cameras of {pixels} pixels")
    print(f"{'':22} {'seen':>4} {'unseen':>6}   {'xy [mm] median/p95/max':24}   {'yaw [deg]':24}   CPU ms draw  read")
    for renderer in given.renderer:
        try:
            rows = [("overhead", overhead(setup, given.scenes, renderer, given.seed))]
            rows.append(("hand, 20 cm", in_hand(setup, given.scenes, renderer, given.seed)))
        except PicoError as missing:
            print(f"{renderer}: left out, {missing.diagnostics[0].summary}")
            continue
        for name, row in rows:
            print(row.text(f"{renderer} {name}"), flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
