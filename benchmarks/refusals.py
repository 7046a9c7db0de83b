"""Plans random labs with tall parts and narrow slots, and has each plan and refusal judged by brute force:
`python benchmarks/refusals.py --labs 1000 --seed 0`.

A refusal is wrong where brute force finds moves that the arms can make, its reason false where the certificate does not
make the lab impossible, or more than is needed. Prints what was wrong, and a summary.
"""

from __future__ import annotations

import argparse
import sys
import traceback
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PLANNING = ROOT / "tests" / "planning"
sys.path[:0] = [str(ROOT), str(ROOT / "tests"), str(PLANNING), str(PLANNING / "explaining")]


def main() -> int:
    """Judge the labs; the exit code is 1 where anything was wrong."""
    from tall_labs import judge

    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--labs", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=0, help="first seed")
    given = parser.parse_args()
    counts, slowest, wrong = Counter[str](), 0.0, 0
    for seed in range(given.seed, given.seed + given.labs):
        try:
            found = judge(seed)
        except Exception:
            traceback.print_exc()
            counts["tracebacks"] += 1
            wrong += 1
            continue
        counts[f"{found.robots}, {'refused' if found.refused else 'planned'}"] += 1
        counts.update(f"undecided: {what}" for what in found.undecided)
        slowest = max(slowest, found.seconds if found.refused else 0.0)
        wrong += bool(found.wrong)
        for fault in found.wrong:
            print(f"seed {seed}, {found.robots}, WRONG: {fault}", flush=True)
        if found.seconds > 10:
            print(f"seed {seed}, {found.robots}: {found.seconds:.1f} s, {found.refused}", flush=True)
    print(f"{given.labs} labs: " + "; ".join(f"{what} {count}" for what, count in sorted(counts.items())))
    print(f"wrong: {wrong}; slowest refusal {slowest:.2f} s of CPU")
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
