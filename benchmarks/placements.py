"""How parts come to sit that the simulated arm puts down: measured errors beside those that the catalog says.

    python benchmarks/placements.py [--moves 100] [--lab labs/shel] [--sight pixels] [--seed 1]

Random parts are moved to random places, along the paths that the planner finds, in both fidelities: in `kinematic`
with `sim: errors: {seat: 1}` (without it a part stands exactly at its goal, upright), in `physics` as it is. Printed
are mean and standard deviation of x, y [mm] and yaw [deg] from the goal, and of the pitch, roll [deg] and height [mm]
of the seat, which no camera sees; `catalog`: the standard deviation that `pico.geometry.seat.drawn` draws from.
"""

from __future__ import annotations

import argparse
import statistics
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from pick_and_place import ROOT, Run, Seeing, pixels

from pico.backends.sim.kinematic import KinematicWorld
from pico.backends.sim.world import World
from pico.geometry.seat import PlacementError, Seat, scatter_of
from pico.manifest.load import load_folder
from pico.model.operation import Operation
from pico.model.pose import Pose, angle_between
from pico.model.setup import Setup
from pico.model.simulated import SimErrors
from pico.twin.sight import Exact

AXES = ("x", "y", "yaw", "pitch", "roll", "height")


def measured(run: Run, count: int) -> Iterator[tuple[str, PlacementError]]:
    """Yield the parts that were put down, each with how far off it truly is."""
    for _ in range(count):
        run.world = run.physics.world(run.world)
        drawn = run.draw()
        if drawn is None:
            return
        operation = Operation(id="op1", primitive="move", robot=run.robot, **drawn[0])
        trial = run._run(operation, drawn[1])
        if trial.failure:
            print(f"failed: {trial.failure}")
            continue
        name = operation.component
        yield name, _off(run.physics.world(run.world), name, Pose(**operation.arguments["to"]["pose"]))


def _off(world: World, name: str, goal: Pose) -> PlacementError:
    body = world.components[name]
    seat = body.seat or Seat()
    assert body.pose is not None
    dx, dy, turned = body.pose.x - goal.x, body.pose.y - goal.y, angle_between(goal.yaw, body.pose.yaw)
    return PlacementError(dx, dy, turned, seat.pitch, seat.roll, seat.height)


def report(setup: Setup, title: str, found: list[tuple[str, PlacementError]]) -> None:
    """Print a table of the axes."""
    print(f"\n{title}: {len(found)} placements")
    print(f"{'':8}{'mean':>9}{'sd':>9}{'largest':>9}{'catalog':>9}")
    for axis in AXES if len(found) > 1 else ():
        values = [getattr(error, axis) for _, error in found]
        said = statistics.fmean(getattr(scatter_of(setup, name), axis) for name, _ in found)
        largest = max(map(abs, values))
        sd = statistics.stdev(values)
        print(f"{axis:8}{statistics.fmean(values):9.4f}{sd:9.4f}{largest:9.4f}{said:9.4f}")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--moves", type=int, default=100)
    parser.add_argument("--lab", type=Path, default=ROOT / "labs" / "shel")
    parser.add_argument("--sight", choices=("pixels", "exact", "none"), default="pixels")
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    setup = load_folder(given.lab).require()[0]
    setup = replace(setup, lab=replace(setup.lab, sim=replace(setup.lab.sim, seed=given.seed)))
    asked = replace(setup, lab=replace(setup.lab, sim=replace(setup.lab.sim, errors=SimErrors(seat=1.0))))
    run = Run(asked, given.seed)
    run.physics = KinematicWorld(asked, run.world)  # type: ignore[assignment]
    report(asked, "kinematic, seat: 1", list(measured(run, given.moves)))
    seeing: dict[str, Seeing] = {"pixels": pixels(setup, given.seed), "exact": Exact, "none": None}
    run = Run(setup, given.seed, sight=seeing[given.sight])
    report(setup, f"physics, sight: {given.sight}", list(measured(run, given.moves)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
