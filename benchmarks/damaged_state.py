"""Damage of the files below `.pico`: `python benchmarks/damaged_state.py [--tries 1000] [--seed N]`.

In each try one file of a lab is damaged that has been in use: a bit or a byte of it changes, it is cut off, emptied or
deleted, or a page is zeroed. Each kind of file is as likely. Then a command is called, then `pico doctor`; if the
command ends otherwise than in the undamaged lab, what its hint says is done literally, and the command is called again.

It is a violation if PICO fails or hangs; if a part or an axis ends anywhere but where the undamaged lab ends, or where
it stood if the command was refused; if a look or a command of another bench moves anything; if a damaged request to
stop stops less than a sound one, or light comes out that would not; if a refusal does not name the file or the run, or
its hint does not lead on; if a damaged record is passed over in silence although the answer differs; if damage of a
cache refuses. Where things stand is read without PICO. `--only K` repeats a try.

`--plant NAME` first plants a fault in PICO that must be found (`--plant all`: each in turn). The exit code is 1 after a
violation, or if a planted fault was not found.
"""

from __future__ import annotations

import argparse
import gc
import os
import re
import sys
import tempfile
from collections import Counter, defaultdict
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from random import Random, randrange

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "benchmarks")]

from damaged_state_damage import DELETED  # noqa: E402
from damaged_state_lab import build_labs  # noqa: E402
from damaged_state_plants import PLANTS  # noqa: E402
from damaged_state_trial import Result, Tries  # noqa: E402

ATTEMPTS = 40
"""In so many tries a planted fault must be found."""


def run_tries(tries: Tries, ks: list[int], seed: int) -> Iterator[tuple[int, Result]]:
    """Run tries by their numbers; what each does depends on its number and the seed alone."""
    for k in ks:
        draw = Random(f"{seed}/{k}")
        result = Result(tries.draw(draw, tries.kinds()), "no damage")
        while result.outcome == "no damage":
            result = tries.run(tries.draw(draw, tries.kinds()), draw)
        yield k, result


def group_of(violation: str) -> str:
    """Return a violation without what differs between occurrences."""
    text = re.sub(r"\d{8}T\d{6}Z-[0-9a-f]{6}", "RUN", violation)
    return re.sub(r"\d+(\.\d+)?", "#", text)[:110]


def report(tries: Tries, ks: list[int], seed: int, verbose: bool) -> bool:
    """Run tries and print what they find; return whether there was a violation."""
    outcomes: dict[str, Counter[str]] = defaultdict(Counter)
    groups: Counter[str] = Counter()
    seconds = 0.0
    for n, (k, result) in enumerate(run_tries(tries, ks, seed), 1):
        case = result.case
        outcomes[case.kind][result.outcome] += 1
        seconds += result.seconds
        new = {group_of(one) for one in result.violations} - groups.keys()
        if new or (verbose and len(ks) < 20):
            print(f"--seed {seed} --only {k}: {case.how}: {case.path} ({case.lab}); `pico {case.command}`")
            for one in result.violations:
                print(f"  !! {one}")
            if verbose:
                print("\n".join(f"  {line}" for line in result.transcript))
            sys.stdout.flush()
        groups.update(map(group_of, result.violations))
        if n % 100 == 0:
            print(f"  {n} of {len(ks)}, {groups.total()} violations, {seconds / n:.2f} CPU s a try", flush=True)
    columns = ("harmless", "other", "deleted", "refused and mended", "refused and lost")
    print(f"{'file':38}" + "".join(f"{name:>20}" for name in columns))
    for kind, count in sorted(outcomes.items()):
        print(f"{kind:38}" + "".join(f"{count[name]:20}" for name in columns))
    for group, number in groups.most_common():
        print(f"violation, {number} times: {group}")
    print(f"{len(ks)} tries, {groups.total()} violations, {seconds:.0f} CPU s in commands")
    return bool(groups)


def find_plant(tries: Tries, name: str, seed: int) -> bool:
    """Plant a fault, try files that it may concern until it is found; return whether it was."""
    plant = PLANTS[name]
    tries.plant = plant.plant
    for k in range(ATTEMPTS):
        draw = Random(f"{seed}/{name}/{k}")
        kinds = [kind for kind in tries.kinds() if re.search(plant.kinds, kind)]
        case = tries.draw(draw, kinds, plant.commands)
        if case.how == DELETED:  # what is lost then is lost without a fault, too
            continue
        result = tries.run(case, draw)
        found = [one for one in result.violations if re.search(plant.pattern, one)]
        if found:
            print(f"  {name}: found in try {k} ({case.how}: {case.path}): {found[0][:160]}", flush=True)
            return True
    print(f"  {name}: not found in {ATTEMPTS} tries", flush=True)
    return False


@contextmanager
def made_labs(*, light: bool) -> Iterator[Tries]:
    """Load what commands need, and make the labs."""
    from cli.warm import load

    stdout = os.dup(1)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)  # it runs a few commands
    load()
    sys.stdout.flush()
    os.dup2(stdout, 1)
    gc.collect()
    gc.freeze()
    with tempfile.TemporaryDirectory(prefix="damaged-state-") as scratch:
        yield Tries(build_labs(Path(scratch), light=light))


def main() -> int:
    """Run the command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tries", type=int, default=1000)
    parser.add_argument("--seed", type=int)
    parser.add_argument("--only", type=int, nargs="+", metavar="K", help="run only these tries")
    parser.add_argument("--short-day", action="store_true", help="labs without searches, mornings, emulated devices")
    parser.add_argument("--verbose", action="store_true", help="print the transcript of each new violation")
    parser.add_argument("--plant", default="", metavar="NAME", help=f"all, or one of {', '.join(PLANTS)}")
    given = parser.parse_args()
    seed = randrange(10**6) if given.seed is None else given.seed
    ks = given.only or list(range(given.tries))
    print(f"seed {seed}", flush=True)
    with made_labs(light=not given.short_day) as tries:
        if not given.plant:
            return 1 if report(tries, ks, seed, given.verbose) else 0
        names = list(PLANTS) if given.plant == "all" else [given.plant]
        return 1 if [name for name in names if not find_plant(tries, name, seed)] else 0


if __name__ == "__main__":
    sys.exit(main())
