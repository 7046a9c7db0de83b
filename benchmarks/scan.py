"""How long one look at the table by sight takes, and how well it sees: pictures drawn, markers read, parts placed.

    python benchmarks/scan.py [--lab labs/crowded] [--looks 5] [--errors] [--seed 1]

Every part stands at home. Times are CPU seconds of this process; errors are distances [mm] and yaw [deg] from where the
parts really stand. `--errors` injects 0.2 mm, 0.05 deg, 0.5 % focal length and 0.1 mm of marker height.
"""

from __future__ import annotations

import argparse
import asyncio
import os
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path

from pico.places.bench import BenchPlace

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # as the command has it
ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from pico.backends.sim.world import new_world  # noqa: E402
from pico.edge.local import embedded  # noqa: E402
from pico.manifest.load import load_folder  # noqa: E402
from pico.model.pose import angle_between  # noqa: E402
from pico.model.simulated import SimErrors  # noqa: E402

ERRORS = SimErrors(camera_position=0.2, camera_rotation=0.05, focal_length=0.005, marker_height=0.1)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--lab", type=Path, default=ROOT / "labs" / "crowded")
    parser.add_argument("--looks", type=int, default=5)
    parser.add_argument("--errors", action="store_true")
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    setup = load_folder(given.lab).require()[0]
    errors = ERRORS if given.errors else SimErrors()
    xy, yaw, missing, seconds = [], [], 0, []
    for number in range(given.looks):
        sim = replace(setup.lab.sim, seed=given.seed + number, errors=errors, observe="sight")
        here = replace(setup, lab=replace(setup.lab, sim=sim))
        with tempfile.TemporaryDirectory() as folder:
            begun = time.process_time()
            seen = asyncio.run(embedded(here, BenchPlace(Path(folder), "sim"), "kinematic").look()).observation
            seconds.append(time.process_time() - begun)
        for name, body in new_world(here).components.items():
            part = seen.components[name]
            if part.pose is None or body.pose is None:
                missing += 1
            elif part.how == "stereo":
                xy.append(part.pose.distance(body.pose))
                yaw.append(abs(angle_between(part.pose.yaw, body.pose.yaw)))
    print(f"{setup.lab.name}: {len(setup.lab.inventory)} parts, {given.looks} looks, errors {given.errors}")
    print(f"not found {missing}; off by {_spread(xy)} mm, {_spread(yaw)} deg (median, p95, most)")
    print(f"CPU seconds a look: {_spread(seconds, 2)}")


def _spread(values: list[float], digits: int = 3) -> str:
    values = sorted(values)
    return " / ".join(
        f"{values[min(len(values) - 1, int(share * len(values)))]:.{digits}f}" for share in (0.5, 0.95, 1)
    )


if __name__ == "__main__":
    main()
