"""Physical moves by sight alone: how far from their goals parts really stand, and whether what is said of them is true.

    python benchmarks/by_sight.py [--moves 500] [--seeds 20] [--lab labs/shel] [--errors] [--lost 0.1] [--first 1]
                                  [--arms calibrated|never] [--light]

Each seed is a bench of its own: its cameras are wrong by 0.2 mm, 0.05 deg, 0.5 % of focal length and 0.1 mm of marker
height (`--errors`), and lose a share of their frames (`--lost`). Its arms are off by 2 mm and 0.3 deg in their mount,
0.1 deg in each joint and 0.5 mm in their tool, their encoders by 0.01 deg (`--arms`), and the bench is calibrated first
(80 s each), or never. Every second bench is then in bad light (`--light`): a quarter of what there should be, pictures
out of focus by 1.5 pixels, ten spots of scattered laser light, five reflections of lamps in each camera, in turn.
Random components go one after the other to random poses within reach. All that reaches planning and execution are
frames, joints and the distance between the pads: what the simulation knows besides is poisoned while it moves, so that
asking for it would stop this benchmark.

The truth is read afterwards. `silent`: a part that stands more than 0.5 mm off its goal and was said to be right, and
known well enough to tell. `covered`: errors within two of the standard deviations that were said of them. Exit code 1
where anything was silent.
"""

from __future__ import annotations

import argparse
import asyncio
import os
import random
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from pico.places.bench import BenchPlace

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # as the command has it
ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "tests")]

from oracles.poison import poisoned  # noqa: E402

from pico.backends.checks import standing  # noqa: E402
from pico.backends.sim.device import SimDevice  # noqa: E402
from pico.backends.sim.store import load_world  # noqa: E402
from pico.cameras.calibrating import calibrate  # noqa: E402
from pico.cameras.errors import true_cameras  # noqa: E402
from pico.manifest.load import load_folder  # noqa: E402
from pico.model.observation import Observation, doubtful  # noqa: E402
from pico.model.operation import Operation, Reason  # noqa: E402
from pico.model.pose import Pose, angle_between  # noqa: E402
from pico.model.record import as_json  # noqa: E402
from pico.model.setup import Setup  # noqa: E402
from pico.model.simulated import ArmErrors, BadLight, SimErrors  # noqa: E402
from pico.motion.arms import ArmMotion  # noqa: E402
from pico.motion.types import Blocked  # noqa: E402
from pico.vision.calibration_files import write_calibration  # noqa: E402

APART = 100.0
"""Least distance of a goal from any other part's origin [mm]."""
SILENT = 0.5
"""What must not happen without a word [mm]."""


@dataclass(frozen=True)
class Done:
    """One move: what was said of it, whether it was said to be known too badly to tell that it is right, how far
    the part really is from its goal [mm, deg], from where it was said to be in standard deviations, the seconds
    predicted and simulated, and the CPU seconds that it took here."""

    said: str
    unsure: bool
    how: str
    off: float
    turned: float
    sigmas: float
    predicted: float
    simulated: float
    cpu: float


LIGHT = (BadLight(dim=0.25), BadLight(defocus=1.5), BadLight(scatter=10), BadLight(glare=5))
ARM = ArmErrors(mount_position=2.0, mount_rotation=0.3, joint_zero=0.1, tool_position=0.5, encoder_noise=0.01)


def bench(lab: Path, seed: int, errors: bool, lost: float, arms: bool = False) -> Setup:
    """Return a bench that is looked at by sight."""
    wrong = SimErrors(lost_frames=lost, arm=ARM if arms else None)
    if errors:
        wrong = replace(wrong, camera_position=0.2, camera_rotation=0.05, focal_length=0.005, marker_height=0.1)
    setup = load_folder(lab).require()[0]
    sim = replace(setup.lab.sim, seed=seed, observe="sight", sight="pixels", errors=wrong)
    return replace(setup, lab=replace(setup.lab, sim=sim))


def lit(setup: Setup, light: BadLight) -> Setup:
    """Return a bench in bad light."""
    sim = setup.lab.sim
    return replace(setup, lab=replace(setup.lab, sim=replace(sim, errors=replace(sim.errors, light=light))))


def draw(setup: Setup, motion: ArmMotion, seen: Observation, rnd: random.Random) -> tuple[Operation, float] | None:
    """Return a move that has a path on the bench as it was seen, and the seconds that it should take."""
    robot = next(iter(setup.lab.robots))
    names = [n for n, part in sorted(seen.components.items()) if setup.movable(n) and part.presence == "seen"]
    width, depth = setup.lab.table.size
    for _ in range(2000):
        name = rnd.choice(names)
        start, grasp = seen.components[name].pose, setup.type_of(name).geometry.grasp
        goal = Pose(rnd.uniform(60, width - 60), rnd.uniform(60, depth - 60), rnd.uniform(-180, 180))
        others = [p.pose for n, p in seen.components.items() if n != name and p.pose]
        if start is None or grasp is None or any(goal.distance(pose) < APART for pose in others):
            continue
        yaw = rnd.choice(grasp.yaws)
        path = motion.move(robot, name, start, goal, yaw, standing(setup, seen), seen.robots[robot].joints)
        if not isinstance(path, Blocked):
            said = {"from": {"pose": as_json(start)}, "to": {"pose": as_json(goal)}, "grasp_yaw": yaw}
            operation = Operation(
                id=f"op{rnd.randrange(10**9)}", primitive="move", component=name, robot=robot, arguments=said,
                reason=Reason(kind="asked"),
            )  # fmt: skip
            return operation, path.seconds
    return None


def moves(setup: Setup, root: Path, count: int, seed: int) -> Iterator[Done]:
    """Yield the moves as they are made."""
    device = SimDevice(setup, BenchPlace(root, "sim"), "physics", clock=lambda: "2026-11-23T00:00:00Z")
    rnd, motion = random.Random(seed), ArmMotion(setup)
    with poisoned():
        seen = asyncio.run(device.observe())
        asyncio.run(device.take(1, lambda event: None))
    for number in range(count):
        found = draw(setup, motion, seen, rnd)
        if found is None:
            return
        operation, predicted = found
        cpu = time.process_time()
        with poisoned():
            result = asyncio.run(device.execute(operation, f"r/{number}/1", lambda before: None))
            cpu = time.process_time() - cpu
            assert device._session is not None
            seen = device._session._known.seen()
        body, said = load_world(setup, BenchPlace(root, "sim"))[0].components[operation.component], result.after
        goal = Pose(**operation.arguments["to"]["pose"])
        if body.pose is None or said is None or said.pose is None:
            yield Done(_said(result), False, "", 999.0, 999.0, 0.0, predicted, result.seconds, cpu)
            continue
        sigma = max(said.uncertainty.position, 1e-9)
        off, turned = body.pose.distance(goal), abs(angle_between(goal.yaw, body.pose.yaw))
        unsure = doubtful(setup, operation.component, said)
        yield Done(_said(result), unsure, said.how, off, turned, body.pose.distance(said.pose) / sigma, predicted,
                   result.seconds, cpu)  # fmt: skip


def _said(result) -> str:  # type: ignore[no-untyped-def]
    return result.error.summary if result.error else ""


def spread(values: list[float]) -> str:
    """Return median, 95th percentile and greatest of `values`."""
    ordered = sorted(values) or [0.0]
    return " / ".join(f"{ordered[min(len(ordered) - 1, int(s * len(ordered)))]:.3f}" for s in (0.5, 0.95, 1))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--moves", type=int, default=500)
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--lab", type=Path, default=ROOT / "labs" / "shel")
    parser.add_argument("--errors", action="store_true")
    parser.add_argument("--arms", choices=("calibrated", "never"))
    parser.add_argument("--light", action="store_true")
    parser.add_argument("--lost", type=float, default=0.0)
    given = parser.parse_args()
    done: list[Done] = []
    each = -(-given.moves // given.seeds)
    for seed in range(given.first, given.first + given.seeds):
        setup = bench(given.lab, seed, given.errors, given.lost, given.arms is not None)
        with tempfile.TemporaryDirectory() as folder:
            if given.arms == "calibrated":
                true = true_cameras(setup, setup.lab.sim.errors, seed)
                write_calibration(Path(folder), "sim", calibrate(setup, true, seed))
            if given.light and seed % 2 == 0:
                setup = lit(setup, LIGHT[seed // 2 % len(LIGHT)])
            made = list(moves(setup, Path(folder), min(each, given.moves - len(done)), seed))
            for d in made:
                where = as_json(setup.lab.sim.errors.light) if setup.lab.sim.errors.light else ""
                print(
                    f"{seed} {where} off {d.off:.3f} {d.turned:.3f} sigmas {d.sigmas:.2f} {d.how} {d.said}", flush=True
                )
            done += made
    good = [d for d in done if not d.said]
    for d in done:
        if d.said:
            print(f"told: {d.said}")
    silent = [d for d in good if d.off > SILENT and not d.unsure]
    ways = {how: sum(d.how == how for d in good) for how in sorted({d.how for d in good})}
    print(f"{len(done)} moves, {len(good)} said to be right, silent {len(silent)}; seen {ways}")
    print(f"{sum(d.unsure for d in good)} of these known less exactly than they must stand")
    print(f"off by {spread([d.off for d in good])} mm, {spread([d.turned for d in good])} deg (median, p95, most)")
    print(f"covered {sum(d.sigmas <= 2 for d in good) / max(1, len(good)):.1%} by two standard deviations")
    print(f"executed over predicted {spread([d.simulated / d.predicted for d in good])}")
    print(f"CPU seconds a move {spread([d.cpu for d in done])}")
    return int(bool(silent))


if __name__ == "__main__":
    sys.exit(main())
