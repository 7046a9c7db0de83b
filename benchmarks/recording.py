"""What a setting costs in one recorded run, beside one that is a run of its own: `python benchmarks/recording.py
--settings 50`.

CPU milliseconds of the whole process for each setting of p1.angle on the kinematic bench of the case study, its
settings planned, checked and journalled; seconds by the wall, for they wait for the disk. Then the same run as a
document: how long it takes to be read.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import pico
from pico.bench.bench import new_lab
from pico.scripting.bench import Bench


def each(settings: int, setting: Callable[[float], object]) -> str:
    """Return what each of some settings took."""
    setting(5.0)
    cpu, wall = time.process_time(), time.monotonic()
    for n in range(settings):
        setting(10.0 + n % 7)
    cpu, wall = time.process_time() - cpu, time.monotonic() - wall
    return f"{1e3 * cpu / settings:6.1f} ms CPU, {1e3 * wall / settings:6.1f} ms by the wall"


def main() -> int:
    """Print the figures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--settings", type=int, default=50)
    settings = parser.parse_args().settings

    def setting(bench: Bench) -> Callable[[float], object]:
        return lambda angle: setattr(bench["p1"], "angle", angle)

    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary) / "shel"
        new_lab(folder, "shel")
        with pico.open(folder, fidelity="kinematic") as bench:
            with bench.record("scan"):
                print(f"{settings} settings in one recorded run, each: {each(settings, setting(bench))}")
            began = time.process_time()
            run, _ = bench.history.recorded_run()
            cpu = 1e3 * (time.process_time() - began)
            print(f"its trace of {len(run.trace)} lines is read in {cpu:.0f} ms CPU")
            print(f"{settings} settings as runs of their own, each: {each(settings, setting(bench))}")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
