"""`pico plan` on a crowded table of 1,000 components of which 50 move: seconds and peak memory of the whole command.

    python benchmarks/scale.py [--components 1000] [--moves 50] [--density 0.3] [--seeds 3] [--check]
    python benchmarks/scale.py --variants discs --components 200 300 --density 0.4 [--seeds 3] [--check]

The table is as large as makes the footprints fill `--density` of it (the sum of their areas over the table's). A gantry
reaches all of it and the storage beside it; once with a gripper that has no fingers (`none`), once with one whose
fingers need room (`two`), for goals that can be gripped beside what stays, and once (`tight`) for goals chosen without
regard to fingers, where some of what is right must make room. Components stand anywhere, at any yaw. Goals are free of
what stays and of one another; every other one lies near where another mover stands, so that components are in one
another's way. `discs` is the classical problem: equal discs without margins, all of which move, from one random
arrangement to another. Each command is a process of its own, and so are its wall and CPU seconds and its peak resident
memory; on a machine that others use the CPU seconds tell what a free one would take. `--check`: have each plan walked
by the tests' independent checker.
"""

from __future__ import annotations

import argparse
import math
import os
import random
import subprocess
import sys
import sysconfig
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product
from pathlib import Path

from pico.places.bench import BenchPlace

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "tests"), str(ROOT / "tests" / "planning")]

from disc_labs import random_places  # noqa: E402

from pico.backends.sim.store import load_world, save_world  # noqa: E402
from pico.bench.bench import Bench  # noqa: E402
from pico.geometry import Grid, Shape, finger_height, finger_zones, placed  # noqa: E402
from pico.manifest.catalog import packaged_type  # noqa: E402
from pico.model.catalog import ComponentType, Footprint, Geometry, Grasp  # noqa: E402
from pico.model.lab import Margins  # noqa: E402
from pico.model.plan import Plan, plan_from_json  # noqa: E402
from pico.model.pose import Pose  # noqa: E402
from pico.model.robot import Gripper  # noqa: E402

TYPES = ("plano_convex_100", "linear_polarizer", "iris", "beam_block", "power_meter", "mirror_tip_tilt")
SECONDS, MEMORY = 5.0, 500.0
"""What the command may take at 1,000 components [s, MiB]."""
DISCS = {200: 4.0, 300: 8.0}
"""The same for so many discs [s]."""
DISC = ComponentType(
    name="disc", title="Disc", geometry=Geometry(
        footprint=Footprint(disc=40.0), height=100, mass=0.3, grasp=Grasp(height=90, width=30, yaws=(0.0,))
    ),
)  # fmt: skip
DISC_FILE = """apiVersion: pico/v1
kind: ComponentType
metadata: {name: disc, title: Disc}
primitives: [move, stow]
geometry:
  footprint: {disc: 40}
  height: 100
  mass: 0.3
  bodies: [{name: post, shape: cylinder, size: [30, 100], at: [0, 0, 50]}]
  grasp: {height: 90, width: 30, yaws: [0]}
"""
HIGH = 400.0
"""Height at which the gantry carries: over everything that stands here [mm]."""
FILE, RACK = 25, 100.0
"""Components a file, and the pitch of the storage beside the table [mm]."""
NEAR = 60.0
"""How far from where another mover stands every other goal is looked for, along x and y [mm]."""
MARGIN = max(Margins().body, Margins().fingers) + 0.01


@dataclass(frozen=True)
class Arrangement:
    """What stands where on a square table [mm], and where those that move are to stand."""

    kinds: dict[str, ComponentType]
    starts: dict[str, Pose]
    goals: dict[str, Pose]
    side: float


def area(footprint: Footprint) -> float:
    """Return the area of a footprint [mm2]."""
    if footprint.disc is not None:
        return math.pi * footprint.disc**2
    corners = footprint.vertices
    return sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(corners, (*corners[1:], corners[0]), strict=True)) / 2


class Board:
    """A square table on which things are put at random, kept apart by what a plan keeps."""

    def __init__(self, rng: random.Random, side: float, gripper: Gripper) -> None:
        self.rng, self.side, self.gripper = rng, side, gripper
        self.standing, self.heights = Grid[str](80.0), dict[str, float]()
        self.gone: set[str] = set()

    def put(self, key: str, kind: ComponentType, pose: Pose) -> None:
        self.standing.add(key, placed(kind.geometry.footprint, pose))
        self.heights[key] = kind.geometry.height

    def free(self, shape: Shape, above: float = -1.0) -> bool:
        """Whether nothing that stands here, taller than `above`, comes near a shape."""
        near = self.standing.conflicts(shape, MARGIN)
        return not any(self.heights[n] > above for n in near if n not in self.gone)

    def gripped(self, key: str, kind: ComponentType, pose: Pose) -> bool:
        """Whether the fingers have room around a component beside what stands here, in one hold at least."""
        grasp = kind.geometry.grasp
        assert grasp is not None
        lowest = finger_height(grasp, self.gripper)
        own, self.gone = self.gone, self.gone | {key}
        rooms = (finger_zones(grasp, self.gripper, yaw, pose) for yaw in grasp.yaws)
        found = any(all(self.free(zone, lowest) for zone in room) for room in rooms)
        self.gone = own
        return found

    def place(self, kind: ComponentType, near: Sequence[Pose] = (), grip: bool = False) -> Pose:
        """Return a random free place, near one of `near` if there are any."""
        edge = kind.geometry.footprint.radius
        while True:
            x, y = (self.rng.uniform(edge, self.side - edge) for _ in "xy")
            if near:
                other = self.rng.choice(near)
                x, y = (v + self.rng.uniform(-NEAR, NEAR) for v in (other.x, other.y))
                x, y = (min(max(v, edge), self.side - edge) for v in (x, y))
            pose = Pose(round(x, 2), round(y, 2), round(self.rng.uniform(-180, 180), 1))
            if self.free(placed(kind.geometry.footprint, pose)) and (not grip or self.gripped("", kind, pose)):
                return pose


VARIANTS = {"none": Gripper(fingers="none"), "two": Gripper(), "tight": Gripper(), "discs": Gripper(fingers="none")}


def discs(count: int, density: float, seed: int) -> Arrangement:
    """Return equal discs that all move."""
    side, rng = math.ceil(math.sqrt(count * area(DISC.geometry.footprint) / density)), random.Random(seed)
    names = [f"d{i:03}" for i in range(count)]
    starts, goals = (
        dict(
            zip(names, (Pose(round(x, 3), round(y, 3)) for x, y in random_places(rng, count, 40.01, side)), strict=True)
        )
        for _ in range(2)
    )
    return Arrangement(dict.fromkeys(names, DISC), starts, goals, side)


def arrangement(count: int, moves: int, density: float, variant: str, seed: int) -> Arrangement:
    """Return random places for `count` components, and goals for `moves` of them."""
    if variant == "discs":
        return discs(count, density, seed)
    rng, gripper = random.Random(seed), Gripper(fingers="none") if variant == "tight" else VARIANTS[variant]
    kinds = {f"c{i:04}": packaged_type(rng.choice(TYPES)) for i in range(count)}
    side = math.ceil(math.sqrt(sum(area(k.geometry.footprint) for k in kinds.values()) / density))
    board = Board(rng, side, gripper)
    starts = {}
    for name, kind in kinds.items():
        starts[name] = board.place(kind)
        board.put(name, kind, starts[name])
    board.gone.update(rng.sample(sorted(kinds), moves))
    while bad := [n for n in sorted(board.gone) if not board.gripped(n, kinds[n], starts[n])]:
        board.gone.symmetric_difference_update((bad[0], rng.choice([n for n in kinds if n not in board.gone])))
    goals = dict[str, Pose]()
    for k, name in enumerate(sorted(board.gone)):
        others = [starts[m] for m in sorted(board.gone) if m != name] if k % 2 else []
        goals[name] = board.place(kinds[name], others, grip=True)
        board.put(f"{name} goal", kinds[name], goals[name])
    return Arrangement(kinds, starts, goals, side)


def write_lab(folder: Path, found: Arrangement, gripper: Gripper) -> None:
    """Write the lab with everything where it is to stand, commit it, and let the simulated table be as it was before
    the move. Each component has its own place in a rack to the right of the table."""
    rows = int(found.side // RACK)
    fingers = "{fingers: none}" if gripper.fingers == "none" else "{}"
    rack = ((found.side + RACK * (i // rows + 1), RACK * (i % rows + 0.5)) for i in range(len(found.kinds)))
    lab = [
        "apiVersion: pico/v1\nkind: Lab\nmetadata: {name: large}",
        f"table: {{size: [{found.side}, {found.side}], beam_height: 70}}",
        f"robots: {{arm1: {{model: gantry, mount: {{x: 0, y: 0}}, transit_height: {HIGH}, gripper: {fingers}}}}}",
        *(["margins: {body: 0, fingers: 0}"] if DISC in found.kinds.values() else []),
        "slots:",
        *(f"  rack/s{i}: {{x: {x}, y: {y}}}" for i, (x, y) in enumerate(rack)),
        "inventory:",
        *(f"  {n}:\n    type: {k.name}\n    home: rack/s{i}"
          for i, (n, k) in enumerate(found.kinds.items())),
    ]  # fmt: skip
    (folder / "lab.yaml").write_text("\n".join(lab) + "\n")
    if DISC in found.kinds.values():
        (folder / "disc.yaml").write_text(DISC_FILE)
    (folder / "state").mkdir()
    names = list(found.kinds)
    for first in range(0, len(names), FILE):
        lines = ["apiVersion: pico/v1\nkind: LabState\nmetadata: {lab: large}\ncomponents:"]
        for name in names[first : first + FILE]:
            at = found.goals.get(name, found.starts[name])
            lines.append(f"  {name}:\n    pose:\n      x: {at.x}\n      y: {at.y}\n      yaw: {at.yaw}")
        (folder / "state" / f"group{first // FILE:03}.yaml").write_text("\n".join(lines) + "\n")
    git = ["git", "-c", "user.name=bench", "-c", "user.email=bench@localhost"]
    for arguments in (["init", "-q"], ["add", "."], ["commit", "-qm", "a large bench"]):
        subprocess.run([*git, *arguments], cwd=folder, check=True)
    with Bench.open(folder) as bench:
        world, _ = load_world(bench.setup, BenchPlace(folder, "sim"))
        bodies = {n: replace(b, pose=found.starts[n]) for n, b in world.components.items()}
        save_world(BenchPlace(folder, "sim"), replace(world, components=bodies))


@dataclass(frozen=True)
class Run:
    """A plan, and the wall and CPU seconds and the peak resident memory [MiB] that the command took."""

    plan: Plan
    wall: float
    cpu: float
    memory: float


def run(folder: Path) -> Run:
    """Run `pico plan` in a lab."""
    command = [str(Path(sysconfig.get_path("scripts")) / "pico"), "plan", "--out", "the.plan"]
    began = time.perf_counter()
    with Path(os.devnull).open("wb") as null:
        child = subprocess.Popen(command, cwd=folder, stdout=null)
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
    wall = time.perf_counter() - began
    if child.returncode:
        sys.exit(f"`pico plan` ended with {child.returncode}")
    plan = plan_from_json((folder / "the.plan").read_bytes())
    per_mib = 1024 if sys.platform != "darwin" else 1024**2
    return Run(plan, wall, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / per_mib)


def faults(folder: Path, plan: Plan) -> list[str]:
    """Return what the independent checker finds wrong with a plan."""
    from checker import check

    with Bench.open(folder) as bench:
        return check(bench.setup, bench.observe(), bench.state, plan, extensions=1)


def main() -> int:
    """Print a line a lab; the exit code is 1 where one was refused or has a fault, 3 where one only took too much."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--components", type=int, nargs="+", default=[1000])
    parser.add_argument("--moves", type=int, default=50)
    parser.add_argument("--density", type=float, default=0.3)
    parser.add_argument("--first", type=int, default=0, help="first seed")
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("--variants", nargs="+", choices=VARIANTS, default=["none", "two", "tight"])
    parser.add_argument("--check", action="store_true", help="let the tests' checker walk each plan")
    given = parser.parse_args()
    print(f"{'fingers':>8} {'seed':>5} {'density':>8} {'moves':>6} {'asides':>7} {'staged':>7} {'proven':>7} "
          f"{'wall s':>7} {'CPU s':>7} {'MiB':>6}")  # fmt: skip
    missed = faulty = 0
    for count in given.components:
        for seed, variant in product(range(given.first, given.first + given.seeds), given.variants):
            gripper = VARIANTS[variant]
            found = arrangement(count, given.moves, given.density, variant, seed)
            filled = sum(area(k.geometry.footprint) for k in found.kinds.values()) / found.side**2
            with tempfile.TemporaryDirectory() as name:
                write_lab(Path(name), found, gripper)
                took = run(Path(name))
                wrong = faults(Path(name), took.plan) if given.check else []
            moves = [o.component for o in took.plan.operations if o.primitive in ("move", "stow")]
            asides = len(set(moves) - found.goals.keys())
            most = DISCS.get(count, SECONDS) if variant == "discs" else SECONDS
            late = min(took.wall, took.cpu) > most or took.memory > MEMORY
            missed, faulty = missed + late, faulty + bool(wrong)
            print(f"{variant:>8} {seed:5} {filled:8.3f} {len(moves):6} {asides:7} {took.plan.staging.count:7} "
                  f"{'yes' if took.plan.staging.proven else 'no':>7} {took.wall:7.2f} {took.cpu:7.2f} "
                  f"{took.memory:6.0f}{'  missed' if late else ''}", flush=True)  # fmt: skip
            for fault in wrong:
                print(f"  wrong: {fault}")
    return 1 if faulty else 3 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
