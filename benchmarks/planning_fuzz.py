"""Plans random rearrangements, has each plan checked: `python benchmarks/planning_fuzz.py --cases 1000`.

Prints refusals, what the independent checker or the exhaustive search found wrong, and a summary.
"""

from __future__ import annotations

import argparse
import statistics
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "tests"), str(ROOT / "tests" / "planning")]


def main() -> int:
    """Run the cases; the exit code is 1 where a plan was wrong or something solvable was refused."""
    from fuzzing import SMALL, Verdict, judge

    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cases", type=int, default=1000)
    parser.add_argument("--first", type=int, default=0, help="first seed")
    parser.add_argument("--least", type=int, default=5, help="least number of components")
    parser.add_argument("--most", type=int, default=30, help="greatest number of components")
    given = parser.parse_args()
    verdicts: list[Verdict] = []
    seconds = []
    for seed in range(given.first, given.first + given.cases):
        began = time.perf_counter()
        verdict = judge(seed, least=given.least, most=given.most)
        seconds.append(time.perf_counter() - began)
        verdicts.append(verdict)
        if verdict.refused and (verdict.components > SMALL or verdict.undecided):
            print(f"seed {seed}, {verdict.components} components, refused: {verdict.refused}", flush=True)
        for fault in verdict.wrong:
            print(f"seed {seed}, WRONG: {fault}", flush=True)
    small = [v for v in verdicts if v.components <= SMALL]
    large = [v for v in verdicts if v.components > SMALL]
    planned = [v for v in verdicts if not v.refused]
    print(f"{len(verdicts)} cases, {len(planned)} planned, {sum(v.moves for v in planned)} moves, "
          f"{sum(v.staged > 0 for v in planned)} with staging ({sum(v.staged for v in planned)} staged), "
          f"{sum(v.asides > 0 for v in planned)} with something right moved aside")  # fmt: skip
    proven, staged = [v for v in planned if v.fewest], [v for v in planned if v.staged]
    print(f"the fewest stagings, proven: {len(proven)} of {len(planned)} plans, "
          f"{sum(v.fewest for v in staged)} of the {len(staged)} with staging")  # fmt: skip
    print(f"up to {SMALL} components: {len(small)} cases, {sum(bool(v.refused) for v in small)} refused, "
          f"{sum(v.undecided for v in small)} of these undecided")  # fmt: skip
    refused = [v for v in large if v.refused]
    print(f"above: {len(large)} cases, {len(refused)} refused ({100 * len(refused) / max(1, len(large)):.1f} %), "
          f"{sum(v.proven for v in refused)} of these proven impossible unless something right moves")  # fmt: skip
    print(f"wrong: {sum(bool(v.wrong) for v in verdicts)}")
    print(f"seconds a case, checks included: median {statistics.median(seconds):.3f}, greatest {max(seconds):.2f}")
    return int(any(v.wrong for v in verdicts))


if __name__ == "__main__":
    sys.exit(main())
