"""Cuts runs off at any point, in virtual time: `python benchmarks/crash_points.py --crashes 100000`.

The product's executor, attempts, journal and recovery under a seeded scheduler; see tests/execution/crashing.py. Prints
each violation of an invariant with its seed, and the counts; the exit code is 1 where there is one.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "tests" / "execution")]


def main() -> int:
    """Run histories until there are as many crashes as asked for."""
    from crashing import histories

    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--crashes", type=int, default=100_000)
    parser.add_argument("--first", type=int, default=0, help="first seed")
    given = parser.parse_args()
    crashes = points = violations = count = 0
    began = time.process_time()
    for seed, found in histories(given.first, given.crashes):
        count += 1
        if isinstance(found, Exception):
            violations += 1
            print(f"seed {seed}: {type(found).__name__}: {found}", flush=True)
            continue
        crashes, points = crashes + found.crashes, points + found.points
        if crashes >= given.crashes:
            break
        if count % 1000 == 0:
            print(f"{count} histories, {crashes} crashes, {violations} violations", flush=True)
    spent = time.process_time() - began
    print(
        f"{count} histories, {crashes} crashes at {points} possible points, {spent:.0f} CPU s: {violations} violations"
    )
    return 1 if violations else 0


if __name__ == "__main__":
    sys.exit(main())
