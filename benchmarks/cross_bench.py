"""Sequences of commands over four benches of one lab: `python benchmarks/cross_bench.py [--sequences 200] [--seed N]`.

The lab has a simulated bench, an emulated one, a `hardware` bench wired to emulators that PICO did not start, and a
remote one behind a coordinator; every fifth lab has a robot. A sequence is 8 to 30 commands (plan, apply, set, undo,
resume, commit, `bench use`, git, kills in the middle of an apply, ...) in up to three worktrees, with flags, with
PICO_BENCH, or with neither. Some commands are hints that the previous one printed, run literally. A small model,
independent of PICO, knows which bench each command means: its flags, else PICO_BENCH, else what `bench use` chose in
its worktree, else the simulator.

All four benches are compared before and after each command: bytes at the sockets of the `hardware` devices, files of
each bench's folder, rows of its journal. It is a violation if a bench changes that the command did not mean, if a look
changes anything, if a command uses or names a run of another bench, if a hint means another bench, or if a commit holds
runs of a bench other than the one that it was made for. `--only K` repeats a sequence; the moment of a kill differs.

`--plant NAME` first plants a fault in PICO that must be found (`--plant all`: each in turn). The exit code is 1 after a
violation, or if a planted fault was not found.
"""

from __future__ import annotations

import argparse
import os
import re
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterable
from dataclasses import replace
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from random import Random, randrange

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), *(str(ROOT / name) for name in ("benchmarks", "tests", "tests/edge"))]

from cross_bench_labs import FAR, benches, end_with_parent  # noqa: E402
from cross_bench_oracle import RUN  # noqa: E402
from cross_bench_plants import PLANTS  # noqa: E402
from cross_bench_trial import Options, Trial  # noqa: E402

Result = tuple[int, list[str], str, Counter[str]]
"""The number of a sequence, its violations, its transcript, and its counts."""


def run_sequence(k: int, options: Options) -> Result:
    """Run one sequence in a folder of its own."""
    kind = "arm" if k % 5 == 4 else "plain"
    with tempfile.TemporaryDirectory(prefix="cross-bench-") as scratch, benches(Path(scratch), kind) as at:
        trial = Trial(at, Random(f"{options.seed}/{k}"), kind == "arm", options)
        violations = [one.replace(scratch, "") for one in trial.run()]
        transcript = "\n".join(f"    {line.replace(scratch, '')}" for line in trial.transcript)
        return k, violations, transcript, trial.count


def run_sequences(ks: list[int], options: Options, jobs: int) -> Iterable[Result]:
    """Run sequences, `jobs` at a time."""
    if jobs == 1:
        yield from map(partial(run_sequence, options=options), ks)
        return
    with get_context("fork").Pool(jobs) as pool:
        yield from pool.imap_unordered(partial(run_sequence, options=options), ks)


def kind_of(violation: str) -> str:
    """Return a violation without what differs between occurrences."""
    return re.sub(r"[0-9a-f]{4,}|\d+(\.\d+)?|tree\d|main", "#", RUN.sub("RUN", violation))[:70]


def report(ks: list[int], options: Options, jobs: int) -> bool:
    """Run sequences and print what they find, the transcript for each new kind of violation; return whether there was
    one."""
    count: Counter[str] = Counter()
    kinds: Counter[str] = Counter()
    began = time.monotonic()
    for n, (k, violations, transcript, counted) in enumerate(run_sequences(ks, options, jobs), 1):
        count.update(counted)
        if {kind_of(one) for one in violations} - kinds.keys():
            print(f"violations in sequence {k} (--seed {options.seed} --only {k}):\n{transcript}", flush=True)
        kinds.update(map(kind_of, violations))
        seconds = time.monotonic() - began
        print(f"  {n} of {len(ks)} sequences, {seconds:.0f} s, {kinds.total()} violations", flush=True)
    for what, number in sorted(count.items()):
        print(f"  {number:5}  {what}")
    for kind, number in kinds.most_common():
        print(f"  violation, {number} times: {kind}")
    return bool(kinds)


def find_plant(ks: list[int], options: Options) -> bool:
    """Run sequences with a planted fault until it is found; return whether it was."""
    others: set[str] = set()
    for k in ks:
        _, violations, _, _ = run_sequence(k, options)
        found = [one for one in violations if re.search(PLANTS[options.plant].pattern, one)]
        if found:
            print(f"  {options.plant}: found in sequence {k}: {found[0][:200]}", flush=True)
            return True
        others |= {kind_of(one) for one in violations}
    print(f"  {options.plant}: not found; other violations: {', '.join(sorted(others)) or 'none'}", flush=True)
    return False


def main() -> int:
    """Run the command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sequences", type=int, default=200)
    parser.add_argument("--seed", type=int)
    parser.add_argument("--only", type=int, nargs="+", metavar="K", help="run only these sequences")
    parser.add_argument("--jobs", type=int, default=1, help="sequences that run at the same time")
    parser.add_argument("--no-hints", action="store_true", help="do not judge which bench a hint means")
    parser.add_argument("--verbose", action="store_true", help="print each command")
    parser.add_argument("--plant", default="", metavar="NAME", help=f"all, or one of {', '.join(PLANTS)}")
    given = parser.parse_args()
    seed = randrange(10**6) if given.seed is None else given.seed
    _load()
    ks = given.only or list(range(given.sequences))
    print(f"seed {seed}, {len(ks)} sequences", flush=True)
    options = Options(seed, given.plant, given.verbose, not given.no_hints)
    if not given.plant:
        return 1 if report(ks, options, given.jobs) else 0
    names = list(PLANTS) if given.plant == "all" else [given.plant]
    hints = {name: options.hints or name == "bare-hints" for name in names}
    missed = [name for name in names if not find_plant(ks, replace(options, plant=name, hints=hints[name]))]
    return 1 if missed else 0


def _load() -> None:
    """Import what commands need, so that each can be forked from this process."""
    import relaying

    from cli.warm import load

    relaying.BENCH = FAR
    os.environ["PICO_TOKEN"] = relaying.TOKEN
    os.register_at_fork(after_in_child=end_with_parent)
    stdout = os.dup(1)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)  # it runs a few commands
    load()
    for name in ("pyvisa", "pyvisa_py", "sqlalchemy", "uvicorn", "pico.server.app"):
        __import__(name)  # not zaber_motion: threads of its runtime would not survive a fork
    sys.stdout.flush()
    os.dup2(stdout, 1)


if __name__ == "__main__":
    sys.exit(main())
