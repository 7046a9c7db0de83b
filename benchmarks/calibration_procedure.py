"""What the calibration of a bench with devices finds of what was injected into the emulated one.

    python benchmarks/calibration_procedure.py [--seeds 20] [--shots 20] [--pixels 2448] [--arms] [--placements 20]

Each seed is a bench of labs/shel with examples/devices.yaml: cameras displaced by 3 mm and turned by 1 deg, focal
lengths wrong by 0.5 % and k1 by 0.01, the zero of one mount wrong by 12.5 deg, another mount reversed. `pico calibrate`
does the steps intrinsics, extrinsics, axes and dark over the drivers and emulators, with a simulated person who holds
the board and reads the scales. With `--arms` also the step arms (minutes a seed): mount off by 2 mm and 0.3 deg, joints
by 0.1 deg, tool by 1 mm; then how far the tool is from where it should be, over the workspace. With `--placements`
(and `--arms`) parts then go one after the other to random poses, as `pico move` plans and runs it on that bench, which
sees them through the cameras as they were calibrated; parts scatter as their types say when they are put down. The
truth is read from the world afterwards.

Printed: by quantity the real scatter, the stated sigma, the farthest in sigmas, and the ratio of sigma and scatter with
the 95 % confidence interval that so many values leave it. Ends with 1 if a value is more than 4 sigmas off or a mount's
direction is wrong, and with 10 seeds or more if not 90 to 99 % of all values are within 2 sigmas, or if a sigma is more
than 1.5 times the real scatter and that is not by chance (1.5 lies below the interval); or if of all placements more
than 5 % stand more than 0.3 mm off their goal.
"""

from __future__ import annotations

import argparse
import os
import random
import shutil
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "benchmarks")]

from calibration import missed  # noqa: E402

from pico.backends.emulated.bench import PACE  # noqa: E402
from pico.backends.sim.store import load_world  # noqa: E402
from pico.bench.bench import Bench  # noqa: E402
from pico.bench.calibrating.walk import CalibrationWalk  # noqa: E402
from pico.cameras.errors import true_cameras  # noqa: E402
from pico.diagnostics import PicoError  # noqa: E402
from pico.model.calibration.steps import CalibrationStep  # noqa: E402
from pico.model.pose import Pose  # noqa: E402
from pico.model.setup import Setup  # noqa: E402
from pico.places.bench import BenchPlace  # noqa: E402
from pico.twin.arms import arms_of  # noqa: E402
from pico.vision.calibration_files import read_calibration  # noqa: E402
from pico.vision.lens import lens  # noqa: E402
from pico.vision.rigid import rotation_vector  # noqa: E402

ERRORS = """  errors:
    camera_position: 3 mm
    camera_rotation: 1 deg
    focal_length: 0.005
    distortion: 0.01
    seat: 1
    devices: {p1.angle: {zero: 12.5}, p2.angle: {reversed: true}}
"""
AXES = {"hwp.angle": (1, 0.0), "p1.angle": (1, 12.5), "p2.angle": (-1, 0.0)}
ARM = "    arm: {mount_position: 2 mm, mount_rotation: 0.3 deg, joint_zero: 0.1 deg, tool_position: 1 mm}\n"
STEPS: tuple[CalibrationStep, ...] = ("intrinsics", "extrinsics", "axes", "dark")
TRIES = 4
"""How often a calibration is called again that ended because the arm was lost."""
PLACED = 0.3
"""What 95 % of all placements must hold [mm]."""
APART = 100.0
"""Least distance of a goal from any other part [mm]."""
LARGEST = 1.5
"""By how many times the scatter a sigma may be larger."""
LENS = ("fx_px", "fy_px", "cx_px", "cy_px", "k1", "k2", "p1", "p2", "k3")
POSE = ("x_mm", "y_mm", "z_mm", "turn_x_deg", "turn_y_deg", "turn_z_deg")


class Quiet:
    """A person who says yes."""

    def say(self, text: str) -> None:
        """Say nothing."""

    def confirm(self, question: str, *, by_person: bool = False) -> bool:
        """Say yes."""
        return True


def lab(folder: Path, seed: int, pixels: int) -> Path:
    """Write the lab of one seed, and return its folder."""
    root = Path(shutil.copytree(ROOT / "labs" / "shel", folder / f"lab{seed}"))
    shutil.copy(ROOT / "examples" / "devices.yaml", root)
    text = (root / "lab.yaml").read_text()
    assert "  seed: 1\n" in text and "pixels: [2448, 2048]" in text
    text = text.replace("  seed: 1\n", f"  seed: {seed}\n{ERRORS}{ARM}", 1)
    text = text.replace("pixels: [2448, 2048]", f"pixels: [{pixels}, {round(pixels * 2048 / 2448)}]")
    (root / "lab.yaml").write_text(text)
    return root


def calibrated(root: Path, seed: int, shots: int, arms: bool) -> tuple[dict[str, tuple[float, float]], bool]:
    """Calibrate the bench of a lab, and return how far each number is off with its sigma, and whether directions are
    right."""
    wanted: tuple[CalibrationStep, ...] = (*STEPS, "arms") if arms else STEPS
    for tries in range(TRIES):
        bench = Bench.open(root, backend="emulated")
        try:
            walk = CalibrationWalk(bench, Quiet(), None, shots=shots)
            for _ in walk.walk(wanted if tries == 0 else [step for step in walk.todo() if step in wanted]):
                pass
            setup = bench.setup
            break
        except PicoError as exc:  # on a loaded machine the emulated arm may be lost: a person would call it again
            if exc.diagnostics[0].code != "device-lost" or tries == TRIES - 1:
                raise
        finally:
            bench.close()
    known = read_calibration(root, "emulated")
    assert known is not None
    found: dict[str, tuple[float, float]] = {}
    for name, true in true_cameras(setup, setup.lab.sim.errors, seed).items():
        if true.robot is not None:
            continue
        camera = known.cameras[name]
        turn = np.degrees(rotation_vector(camera.pose[:3, :3] @ true.pose[:3, :3].T))
        of_lens, of_pose = (known.provenance[f"{step}/{name}"].uncertainty for step in ("intrinsics", "extrinsics"))
        off = np.concatenate([lens(camera) - lens(true), camera.pose[:3, 3] - true.pose[:3, 3], turn])
        sigmas = [*(of_lens[key] for key in LENS), *(of_pose[key] for key in POSE)]
        found |= {f"{name} {key}": (float(a), b) for key, a, b in zip((*LENS, *POSE), off, sigmas, strict=True)}
    right = True
    for address, (direction, zero) in AXES.items():
        axis = known.axes[address]
        right &= axis.direction == direction
        found[address] = (axis.zero - zero + 90) % 180 - 90, axis.sigma
    if arms:
        off = np.array(missed(arms_of(setup, seed)["arm1"], known.arms["arm1"].offsets, np.random.default_rng(seed)))
        said = known.arms["arm1"]
        mm, deg = np.percentile(off, 95, axis=0)
        each_mm, each_deg = np.sqrt(np.mean(off**2, axis=0) / 3)  # in each direction
        found |= {"tool_mm": (float(each_mm), said.position), "tool_deg": (float(each_deg), said.turn)}
        stated = f"said {said.position:.3f} mm, {said.turn:.3f} deg (one sigma each way)"
        print(f"  seed {seed}: tool off by {mm:.3f} mm, {deg:.3f} deg at p95; {stated}")
    level = known.dark["cam.image"]
    found["cam.image"] = level.level - unlit(setup, root, "cam"), level.sigma
    return found, right


def unlit(setup: Setup, root: Path, name: str) -> float:
    """Return what a camera in the beam truly reads without light [count], at the exposure and gain that it has."""
    kind, values = setup.type_of(name), load_world(setup, BenchPlace(root, "emulated"))[0].components[name].values
    gain = float(values["gain"].value or 0.0) if "gain" in values else 0.0
    black, full = kind.number("black_level", "count") or 0.0, 2 ** (kind.number("bit_depth", "bit") or 12) - 1
    per_count = (kind.number("full_well", "") or 1e4) / (full - black) / 10 ** (gain / 20)
    exposed = float(values["exposure"].value or 0.0) * 1e-3
    return black + (kind.number("dark_current", "") or 0.0) * exposed / per_count


def placements(root: Path, seed: int, count: int) -> list[float]:
    """Have parts go to random poses on the calibrated bench of a lab; return how far off each really stands [mm]."""
    rnd, off = random.Random(seed), list[float]()
    bench = Bench.open(root, backend="emulated")
    try:
        setup = bench.setup
        (width, depth), place = setup.lab.table.size, BenchPlace(root, "emulated")
        while len(off) < count:
            bodies = load_world(setup, place)[0].components
            name = rnd.choice(sorted(n for n, b in bodies.items() if setup.movable(n) and b.presence == "seen"))
            goal = Pose(rnd.uniform(60, width - 60), rnd.uniform(60, depth - 60), rnd.uniform(-180, 180))
            if any(b.pose and goal.distance(b.pose) < APART for n, b in bodies.items() if n != name):
                continue
            said = {"x": f"{goal.x:.4f}", "y": f"{goal.y:.4f}", "yaw": f"{goal.yaw:.4f}"}
            plan = bench.plans.single(name, "move", said)
            if plan.errored or not plan.operations:  # out of reach, or no way there
                continue
            bench.apply(plan)
            stands = load_world(setup, place)[0].components[name].pose
            off.append(stands.distance(Pose(*(float(v) for v in said.values()))) if stands else np.inf)
    finally:
        bench.close()
    return off


def chances(count: int) -> tuple[float, float]:
    """Return the 95 % confidence interval of a ratio of sigma and scatter that is 1 by `count` values: of the root of
    chi square by its degrees of freedom (E. B. Wilson, M. M. Hilferty, PNAS 17, 684 (1931))."""
    share = 2 / (9 * count)
    low, high = (max(0.0, 1 - share + z * share**0.5) ** 1.5 for z in (-1.96, 1.96))
    return low, high


def main() -> None:
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("--seeds", type=int, default=20)
    words.add_argument("--shots", type=int, default=20)
    words.add_argument("--pixels", type=int, default=2448)
    words.add_argument("--arms", action="store_true")
    words.add_argument("--placements", type=int, default=0)
    asked = words.parse_args()
    os.environ[PACE] = "6" if asked.arms else "20"
    start, rows, right = time.process_time(), dict[str, list[tuple[float, float]]](), True
    stand: list[float] = []
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(1, asked.seeds + 1):
            root = lab(Path(folder), seed, asked.pixels)
            found, directions = calibrated(root, seed, asked.shots, asked.arms)
            right &= directions
            pull = max(abs(off / sigma) for off, sigma in found.values())
            print(f"  seed {seed}: farthest {pull:.1f} sigmas, {time.process_time() - start:.0f} s so far", flush=True)
            stand += placements(root, seed, asked.placements) if asked.arms and asked.placements else []
            for name, one in found.items():
                rows.setdefault(name.replace("left ", "camera ").replace("right ", "camera "), []).append(one)
    print(f"{asked.seeds} seeds, {asked.shots} pictures of the board; real scatter, stated sigma (median), farthest")
    pulls, ratios, too_large = [], [], []
    for name, values in rows.items():
        off, sigmas = np.array(values).T
        scatter, stated, pull = float(np.sqrt(np.mean(off**2))), float(np.median(sigmas)), np.abs(off / sigmas)
        pulls += list(pull)
        ratio, (low, high) = stated / scatter if scatter else np.inf, chances(len(values))
        ratios.append(ratio)
        too_large += [name] if ratio * low > LARGEST else []
        print(f"  {name:<18} {scatter:10.3g} {stated:10.3g}   {pull.max():.1f} sigmas, sigma / scatter {ratio:.2f} "
              f"({ratio * low:.2f} to {ratio * high:.2f})")  # fmt: skip
    within, middle = float(np.mean(np.array(pulls) < 2)), float(np.median(ratios))
    print(f"within 2 sigmas: {within:.1%}; farthest {max(pulls):.1f}; sigma / scatter {middle:.2f} (median)")
    print(f"directions of mounts {'right' if right else 'WRONG'}; {time.process_time() - start:.0f} s of one core")
    if too_large:
        print(f"sigmas more than {LARGEST} times the scatter: {', '.join(too_large)}")
    if stand:
        p50, p95 = np.percentile(stand, (50, 95))
        print(f"{len(stand)} placements: {p50:.3f} mm (median), {p95:.3f} mm (p95), {max(stand):.3f} mm (farthest)")
        right &= bool(p95 <= PLACED)
    good = right and max(pulls) <= 4 and (asked.seeds < 10 or (0.9 <= within <= 0.99 and not too_large))
    sys.exit(not good)


if __name__ == "__main__":
    main()
