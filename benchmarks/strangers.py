"""Things on the table that nobody identified, and swapped markers: are they seen, and is room kept for them?

    python benchmarks/strangers.py [--things 100] [--swaps 20] [--labs labs/shel labs/crowded] [--seed 1]

Each thing is alone on a bench whose cameras are wrong by 0.2 mm, 0.05 deg, 0.5 % of focal length and 0.1 mm of marker
height: a box or a disc without a marker, 15 to 80 mm wide and 15 to 140 mm high, or a part on its side, anywhere on the
table where a camera sees it. It is avoided where every point of its outline from above lies within an obstacle of the
observation. What a bench without such things is said to have besides counts as a false alarm. Then the markers of two
parts are swapped between two looks. Exit code 1 where a thing is not avoided, a swap not told, or an alarm was false.
"""

from __future__ import annotations

import argparse
import asyncio
import math
import os
import random
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from pico.places.bench import BenchPlace

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # as the command has it
ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "benchmarks")]

import numpy as np  # noqa: E402
from by_sight import bench  # noqa: E402

from pico.backends.occlusion import Occluders  # noqa: E402
from pico.backends.sim.device import SimDevice  # noqa: E402
from pico.backends.sim.store import save_world  # noqa: E402
from pico.backends.sim.world import FreePose, World, new_world  # noqa: E402
from pico.geometry.mass import bodies_of  # noqa: E402
from pico.model.catalog import Footprint  # noqa: E402
from pico.model.observation import Observation, UnknownObject  # noqa: E402
from pico.model.pose import Pose  # noqa: E402
from pico.model.setup import Setup  # noqa: E402
from pico.vision.nominal import camera_models  # noqa: E402

WITHIN = 2.0
"""What of an outline may lie outside of its obstacle: less than any path keeps away from those [mm]."""


def look(setup: Setup, root: Path, world: World) -> Observation:
    """Return what a bench by sight says of a world."""
    save_world(BenchPlace(root, "sim"), world)
    return asyncio.run(SimDevice(setup, BenchPlace(root, "sim"), clock=lambda: "2026-11-23T00:00:00Z").observe())


def free_place(setup: Setup, world: World, rnd: random.Random, reach: float) -> Pose:
    """Return a place for a thing that reaches so far [mm], clear of everything, that a camera sees."""
    parts = {n: b.pose for n, b in world.components.items() if b.pose}
    joints = {n: r.joints for n, r in world.robots.items()}
    hidden = Occluders(setup, parts, joints, camera_models(setup))
    marked = next(n for n in setup.lab.inventory if setup.lab.inventory[n].marker is not None)
    width, depth = setup.lab.table.size
    while True:
        pose = Pose(rnd.uniform(reach, width - reach), rnd.uniform(reach, depth - reach), rnd.uniform(-180, 180))
        clear = all(
            pose.distance(at) > reach + setup.type_of(n).geometry.footprint.radius + 15 for n, at in parts.items()
        )
        datums = all(math.dist((pose.x, pose.y), (d.x, d.y)) > reach + 30 for d in setup.lab.datums.values())
        if clear and datums and hidden.hides(marked, pose) is None:
            return pose


def planted(setup: Setup, rnd: random.Random) -> tuple[World, np.ndarray, str]:
    """Return a world with one thing that carries no marker, its outline from above (n, 2) [mm], and what it is."""
    world = new_world(setup)
    if rnd.random() < 0.4:
        name = rnd.choice([n for n in sorted(world.components) if setup.movable(n)])
        here = world.with_body(name, presence="missing", pose=None)
        geometry = setup.type_of(name).geometry
        pose = free_place(setup, here, rnd, geometry.height)
        c, half = math.sqrt(0.5), math.radians(pose.yaw) / 2
        turn = (c * math.cos(half), c * math.cos(half), c * math.sin(half), c * math.sin(half))
        free = FreePose(position=(pose.x, pose.y, geometry.footprint.radius), quaternion=turn)
        lying = here.with_body(name, presence="toppled", pose=pose, free=free)
        return lying, _lying(bodies_of(geometry), pose), f"{name} on its side"
    size, height = rnd.uniform(15, 80), rnd.uniform(15, 140)
    other = rnd.uniform(15, 80)
    footprint = Footprint(disc=round(size / 2, 1)) if rnd.random() < 0.5 else Footprint(box=(size, other))
    pose = free_place(setup, world, rnd, footprint.radius)
    thing = UnknownObject(pose=pose, footprint=footprint, height=height)
    return (
        replace(world, unknown={"unknown/cup": thing}),
        _outline(footprint, pose),
        f"{footprint} {height:.0f} mm high",
    )


def _outline(footprint: Footprint, pose: Pose) -> np.ndarray:
    if footprint.box:
        x, y = footprint.box[0] / 2, footprint.box[1] / 2
        own = np.array([(-x, -y), (x, -y), (x, y), (-x, y)])
    else:
        angles = np.linspace(0, 2 * math.pi, 24)
        own = (footprint.disc or 0.0) * np.column_stack((np.cos(angles), np.sin(angles)))
    return _placed(own, pose)


def _placed(own: np.ndarray, pose: Pose) -> np.ndarray:
    c, s = math.cos(math.radians(pose.yaw)), math.sin(math.radians(pose.yaw))
    return own @ np.array([(c, s), (-s, c)]) + (pose.x, pose.y)


def _lying(bodies, pose: Pose) -> np.ndarray:  # type: ignore[no-untyped-def]
    """The corners of a part that was turned by a quarter about its own x, seen from above."""
    points = []
    for body in bodies:
        half = (body.size[0] / 2, body.size[1] / 2, body.size[2] / 2) if body.shape == "box" else (
            body.size[0] / 2, body.size[0] / 2, body.size[1] / 2)  # fmt: skip
        if body.shape == "cylinder" and body.axis != "z":
            half = (max(half),) * 3
        points += [(body.at[0] + x * half[0], -(body.at[2] + z * half[2])) for x in (-1, 1) for z in (-1, 1)]
    return _placed(np.array(points), pose)


def avoided(setup: Setup, seen: Observation, outline: np.ndarray) -> bool:
    """Return whether every point of an outline lies within something that is known to be in the way."""
    discs = [(t.pose.x, t.pose.y, t.footprint.radius) for t in seen.unknown.values()]
    discs += [
        (p.pose.x, p.pose.y, setup.type_of(n).geometry.height)
        for n, p in seen.components.items() if p.presence == "toppled" and p.pose
    ]  # fmt: skip
    return all(any(math.dist(point, (x, y)) < r + WITHIN for x, y, r in discs) for point in outline)


def swapped(setup: Setup, rnd: random.Random, root: Path) -> bool:
    """Return whether it is told that two parts carry one another's marker since the last look."""
    world = new_world(setup)
    look(setup, root, world)
    a, b = rnd.sample([n for n in sorted(world.components) if setup.movable(n)], 2)
    stuck = {a: world.components[b].marker, b: world.components[a].marker}
    seen = look(setup, root, replace(world, stickers=stuck))
    return {a, b} <= {p.address for p in seen.problems if p.code in ("marker-swapped", "marker-height")}


def _each(labs: list[Path], count: int, seed: int) -> Iterator[tuple[int, Setup]]:
    for number in range(count):
        yield number, bench(labs[number % len(labs)], seed + number, True, 0.0)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--things", type=int, default=100)
    parser.add_argument("--swaps", type=int, default=20)
    parser.add_argument("--labs", type=Path, nargs="+", default=[ROOT / "labs" / "shel", ROOT / "labs" / "crowded"])
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    kept = told = false = 0
    radii, cpu = [], time.process_time()
    for number, setup in _each(given.labs, given.things, given.seed):
        with tempfile.TemporaryDirectory() as folder:
            world, outline, what = planted(setup, random.Random(given.seed + number))
            seen = look(setup, Path(folder), world)
            kept += (well := avoided(setup, seen, outline))
            radii += [t.footprint.radius for t in seen.unknown.values()]
            if not well:
                print(f"not avoided: {what} at {outline.mean(axis=0).round()} of {setup.lab.name}: {seen.unknown}")
            near = [t for t in seen.unknown.values() if math.dist((t.pose.x, t.pose.y), outline.mean(axis=0)) < 150]
            false += len(seen.unknown) - len(near)
            if len(near) < len(seen.unknown):
                print(f"false alarm: {setup.lab.name} with {what} at {outline.mean(axis=0).round()}: {seen.unknown}")
    for number, setup in _each(given.labs, given.swaps, given.seed):
        with tempfile.TemporaryDirectory() as folder:
            told += swapped(setup, random.Random(given.seed + number), Path(folder))
    print(f"avoided {kept} of {given.things}, false alarms {false}; swapped markers told {told} of {given.swaps}")
    print(f"obstacles reach {np.median(radii or [0]):.0f} mm (median), CPU seconds {time.process_time() - cpu:.0f}")
    return int(kept < given.things or told < given.swaps or false > 0)


if __name__ == "__main__":
    sys.exit(main())
