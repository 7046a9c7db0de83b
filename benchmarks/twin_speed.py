"""How fast the twin is: moves with 30 components in physics and kinematics, and a table of 100 in real time.

    python benchmarks/twin_speed.py [--moves 20] [--seed 1]

Printed are CPU and wall seconds of each move, without and with finding its path, which is what takes the time in the
kinematic world, and simulated seconds a second of the machine. The 30 are those of labs/crowded, the 100 stand in rows
100 mm apart.
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import replace
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "benchmarks")]

from pick_and_place import Run, spread  # noqa: E402

from pico.backends.sim.kinematic import KinematicWorld  # noqa: E402
from pico.backends.sim.world import new_world  # noqa: E402
from pico.manifest.load import load_folder  # noqa: E402
from pico.model.lab import Part  # noqa: E402
from pico.model.pose import Pose  # noqa: E402
from pico.model.setup import Setup  # noqa: E402


class Kinematic(Run):
    """Moves in the kinematic world, which follow their paths exactly."""

    def __post_init__(self) -> None:
        super().__post_init__()
        self.physics = KinematicWorld(self.setup, new_world(self.setup))


def rows(setup: Setup, count: int) -> Setup:
    """Return the bench with `count` lenses in rows on a table that is large enough, and one arm."""
    name = next(iter(setup.lab.robots))
    across = 14
    places = [Pose(70 + 100 * (n % across), 70 + 100 * (n // across), 0) for n in range(count)]
    kind = "plano_convex_100"
    slots = {f"row/{n}": _slot(setup, place) for n, place in enumerate(places)}
    parts = {f"lens_{n}": Part(type=kind, home=f"row/{n}") for n in range(count)}
    robot = replace(setup.lab.robots[name], mount=replace(setup.lab.robots[name].mount, x=700, y=1000))
    table = replace(setup.lab.table, size=(1400.0, 1100.0))
    lab = replace(
        setup.lab, table=table, slots=slots, regions={}, inventory=parts, robots={name: robot}, cameras={}, datums={}
    )
    return replace(setup, lab=lab)


def _slot(setup: Setup, place: Pose) -> object:
    return replace(next(iter(setup.lab.slots.values())), x=place.x, y=place.y, yaw=place.yaw)


def report(name: str, run: Run, count: int) -> None:
    """Print the figures of a run."""
    done = list(run.trials(count))
    for trial in done:
        if trial.failure:
            print(f"failed: {trial.failure}")
    cpu, wall, paths = [t.cpu for t in done], [t.wall for t in done], [t.cpu + t.path for t in done]
    simulated, lost = sum(t.simulated for t in done), sum(bool(t.failure) for t in done)
    columns = "  ".join(f"{spread(values):22s}" for values in (cpu, wall, paths))
    print(f"{name:26s} {len(done):3d} {lost:4d}  {columns}  x{simulated / sum(cpu):.0f} / x{simulated / sum(wall):.0f}")


def main() -> int:
    """Run the moves and print the figures."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--moves", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    crowded = load_folder(ROOT / "labs" / "crowded").require()[0]
    heads = ("CPU [s] a move", "wall [s] a move", "CPU, path included")
    print(
        f"{'median / p95 / max':26s} moves lost " + "  ".join(f"{h:22s}" for h in heads) + "  real time by CPU / wall"
    )
    report("30 components, physics", Run(crowded, given.seed, apart=82.0), given.moves)
    report("30 components, kinematic", Kinematic(crowded, given.seed, apart=82.0), given.moves)
    report("100 components, physics", Run(rows(crowded, 100), given.seed, apart=82.0), given.moves)
    return 0


if __name__ == "__main__":
    sys.exit(main())
