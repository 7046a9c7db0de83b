"""How much time at the bench `pico bisect` needs to find the commit that broke something, beside halving.

    python benchmarks/bisecting.py [--commits 128] [--seeds 10] [--measure 5] [--merges] [--scattered]
        [--suspicion 1] [--pairs 5]

Builds labs of about thirty parts with a random history (a commit moves or turns one to five parts, as a sub-assembly is
worked on; with --scattered parts from anywhere; with --merges branches that were worked on at the same time) and plants
a commit that breaks an expectation. `pico bisect run` then searches in the simulated bench, kinematic: it measures both
ends, plans, moves and measures for real. From the same place `git bisect` does, with `pico bisect step`, which always
takes the middle. The expectation speaks of one part, so that commits which moved it are suspected first; with
`--suspicion 1` all are alike, and only the costs are weighed. Prints a line a seed and the ratios of the simulated
seconds of the search, a measurement counted with --measure seconds; and how near the estimates
that the choice weighs are to real plans (--pairs). The exit code is 1 where a wrong commit is named.
"""

from __future__ import annotations

import argparse
import io
import json
import os
import random
import statistics
import subprocess
import sys
import tempfile
import time
from contextlib import redirect_stdout
from dataclasses import dataclass
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "tests" / "history")]
os.environ |= {"GIT_CONFIG_GLOBAL": os.devnull, "GIT_CONFIG_SYSTEM": os.devnull}

from bisecting_labs import EXPECT, Written, history  # noqa: E402
from pico_cli.main import main as pico  # noqa: E402

from pico.bench.bench import Bench  # noqa: E402
from pico.bench.bisecting import under_way  # noqa: E402
from pico.bench.bisecting.costs import PlanSeconds  # noqa: E402
from pico.bench.bisecting.step import step  # noqa: E402
from pico.history.bisect.git_state import GitBisect  # noqa: E402
from pico.model.plan import Plan  # noqa: E402


@dataclass(frozen=True)
class Found:
    """Which commit was named, in how many trials and seconds after the ends; how far plans were from the estimate."""

    commit: str | None
    trials: int
    seconds: float
    ends: float = 0.0
    reckoned: float = 0.0


def cheapest(lab: Written, measure: float, suspicion: float) -> Found:
    """Search with `pico bisect run`."""
    said = io.StringIO()
    words = [
        "-C",
        str(lab.root),
        "--json",
        "bisect",
        "run",
        "main",
        "good",
        "--auto-approve",
        "--fidelity",
        "kinematic",
    ]
    with redirect_stdout(said):
        pico([*words, "--measure-seconds", str(measure), "--suspicion", str(suspicion)])
    events: list[dict[str, Any]] = [json.loads(line) for line in said.getvalue().splitlines()]
    if events[-1].get("kind") != "over":
        print(f"  {events[-1]}")
        return Found(None, 0, 1.0)
    tried = [e for e in events if e["kind"] == "tried" and e["by"] == "measured"]
    seconds = [sum(e["travel"] + e["measure"] for e in tried if bool(e["end"]) == end) for end in (False, True)]
    over = events[-1]
    return Found(over.get("first_bad"), sum(not e["end"] for e in tried), *seconds, over.get("halving", 0.0) or 0.0)


def halved(lab: Written, measure: float) -> Found:
    """Search as `git bisect run pico bisect step` does, from the good end."""
    with Bench.open(lab.root, fidelity="kinematic") as bench:
        under_way(bench).git.reset()
        _stand(bench, "main")
        _stand(bench, "good")
        git = GitBisect.start(lab.root, lab.bad, lab.good)
        trials, total = 0, 0.0
        while len(git.suspects(git.ends())) > 1:
            found = step(bench, EXPECT, lambda plan: _run(bench, plan))
            trials, total = trials + 1, total + found.seconds + measure
            git.tell(found.verdict, [found.commit])
        first = git.suspects(git.ends())[0][0]
        git.reset()
    return Found(first, trials, total)


def compared(lab: Written, count: int, seed: int) -> list[tuple[float, float]]:
    """Return what is reckoned to get from where the bench stands to some commits, and what plans take [s]."""
    with Bench.open(lab.root, fidelity="kinematic") as bench:
        seen, clock = bench.observe(), PlanSeconds(bench.setup)
        some = random.Random(seed).sample(lab.commits, min(count, len(lab.commits)))
        return [(clock.to(seen, bench.state_at(c)), bench.plan(c).makespan) for c in some]


def _stand(bench: Bench, revision: str) -> None:
    plan = bench.plan(revision)
    if plan.operations:
        _run(bench, plan)


def _run(bench: Bench, plan: Plan) -> float:
    report = bench.apply(plan)
    if report.outcome != "done" or report.remaining:
        sys.exit(f"the bench did not get to {plan.target.name}: {report}")
    return report.seconds


def main() -> int:
    """Run all seeds and return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--commits", type=int, default=128)
    parser.add_argument("--first", type=int, default=0, help="first seed")
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--measure", type=float, default=5.0, help="seconds a measurement")
    parser.add_argument("--pairs", type=int, default=5, help="plans a seed that the estimate is compared with")
    parser.add_argument("--suspicion", type=float, default=10.0, help="as of `pico bisect run`; 1: all commits alike")
    parser.add_argument("--merges", action="store_true", help="with branches and merges")
    parser.add_argument("--scattered", action="store_true", help="commits move parts from anywhere")
    given = parser.parse_args()
    print(" seed commits planted trials   lab s  halving: trials   lab s  ratio  with ends  reckoned  CPU s")
    wrong, pairs, estimates = 0, [], list[tuple[float, float]]()
    for seed in range(given.first, given.first + given.seeds):
        began = time.process_time()
        with tempfile.TemporaryDirectory() as folder:
            lab = history(Path(folder), seed, given.commits, merges=given.merges, scattered=given.scattered)
            with Bench.open(lab.root, fidelity="kinematic") as bench:
                _stand(bench, "main")
            ours = cheapest(lab, given.measure, given.suspicion)
            gits = halved(lab, given.measure)
            estimates += compared(lab, given.pairs, seed)
        cpu = time.process_time() - began
        missed = [f.commit for f in (ours, gits) if f.commit != lab.first_bad]
        wrong += bool(missed)
        pairs.append((ours, gits))
        whole = (ours.seconds + ours.ends) / (gits.seconds + ours.ends)
        planted, reckoned = lab.commits.index(lab.first_bad) + 1, (ours.reckoned - ours.ends) / gits.seconds
        print(
            f"{seed:5} {len(lab.commits):7} {planted:7} {ours.trials:6} {ours.seconds:7.1f} {gits.trials:16} "
            f"{gits.seconds:7.1f} {ours.seconds / gits.seconds:6.2f} {whole:10.2f} {reckoned:9.2f} {cpu:6.1f}"
            f"{'  WRONG' if missed else ''}",
            flush=True,
        )
    ratios = [o.seconds / g.seconds for o, g in pairs]
    mine, git = (sum(found[k].seconds for found in pairs) for k in (0, 1))
    both = sum(o.ends for o, _ in pairs)
    print(
        f"{given.seeds} searches, {wrong} wrong; of the lab time of halving: {mine / git:.3f} in all "
        f"({mine:.0f} of {git:.0f} s), mean {statistics.mean(ratios):.3f}, median {statistics.median(ratios):.3f}, "
        f"worst {max(ratios):.3f}; with the measurement of both ends {(mine + both) / (git + both):.3f}"
    )
    if len(estimates) > 1:
        about, real = zip(*estimates, strict=True)
        print(
            f"{len(estimates)} estimates beside real plans: {sum(about) / sum(real):.3f} of their seconds, "
            f"correlation {statistics.correlation(about, real):.4f}"
        )
    return 1 if wrong else 0


if __name__ == "__main__":
    subprocess.run(["git", "--version"], check=True, stdout=subprocess.DEVNULL)
    sys.exit(main())
