"""Leaves manifests out of a lab in every way that we know, and counts what goes home in silence.

    python benchmarks/omissions.py [--cases 1000] [--first 0]

Half of the cases are in the working tree (sparse checkout in patterns, cones and sparse indexes, files that git takes
for unchanged, other extensions and other case, links, pointers of Git LFS, permissions, submodules), half at a
revision; a third combines two or three ways. A case is silent where the state that is read lacks a part that was
committed, or where no error names the file or its folder. As many cases leave nothing out, or delete a file on purpose:
what is refused there, or not told in a note, is needless. Permissions bind only who is not root: as root these cases
run in a process of nobody's. Deterministic by seed; exits with 1 where anything is silent or needless.
"""

from __future__ import annotations

import argparse
import random
import sys
import tempfile
from collections import Counter
from collections.abc import Mapping
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "tests" / "history")]

from omission_cases import (  # noqa: E402
    AT_REVISION,
    DELETING,
    IN_FOLDER,
    UNITS,
    WORKING,
    Box,
    Kind,
    Outcome,
    at_revision,
    in_folder,
    read_lab,
)


def main() -> int:
    """Run the cases, print a line for each way, and return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cases", type=int, default=1000)
    parser.add_argument("--first", type=int, default=0, help="seed of the first case")
    options = parser.parse_args()
    cases, silent, needless = Counter[str](), Counter[str](), 0
    with tempfile.TemporaryDirectory() as folder:
        Path(folder).chmod(0o755)
        box = Box(Path(folder).resolve())
        if not box.binds:
            print("permissions are left out: nobody but root may enter the temporary folder")
        for seed in range(options.first, options.first + options.cases):
            found = omitted(box, seed)
            for word in found.what.split(" and "):
                cases[word] += 1
                silent[word] += bool(found.silent)
            if found.silent:
                said = [d.summary for d in found.said]
                print(f"seed {seed}: {found.what}: nothing names {', '.join(found.silent)}: {said}")
        for seed in range(options.cases):
            needless += bool(wrong := troubled(box, seed))
            if wrong:
                print(f"seed {seed}: {wrong}")
    for word, number in sorted(cases.items()):
        print(f"{word:34}{number:6} cases{silent[word]:5} silent")
    print(f"{options.cases} omissions, {silent.total()} silent; {options.cases} without one, {needless} needless")
    return 1 if silent.total() or needless else 0


def omitted(box: Box, seed: int) -> Outcome:
    """Return what came of a random omission."""
    rng = random.Random(f"omission {seed}")
    if rng.random() < 0.5:
        return in_folder(
            box, seed, _ways(rng, {n: kind for n, kind in IN_FOLDER.items() if box.binds or not kind.bound})
        )
    found = at_revision(box, seed, ways := _ways(rng, AT_REVISION))
    return Outcome(" and ".join(f"{way}, at a revision" for way in ways), found.units, found.state, found.said)


def _ways(rng: random.Random, kinds: Mapping[str, Kind]) -> tuple[str, ...]:
    first = rng.choice([*kinds])
    alike = [name for name, kind in kinds.items() if kind.modules == kinds[first].modules and name != first]
    more = min(rng.choice([0, 0, 0, 0, 1, 2]), len(alike))
    return (first, *rng.sample(alike, more))


def troubled(box: Box, seed: int) -> str:
    """Return what is wrong where nothing is left out, or a file is deleted on purpose; empty for nothing."""
    rng = random.Random(f"work {seed}")
    box.begin(modules=False)
    works = rng.sample(WORKING, rng.randint(1, len(WORKING)))
    for work in works:
        work(box)
    gone = rng.random() < 0.4 and UNITS[1] in box.git("ls-files", UNITS[1])
    (rng.choice(DELETING) if gone else (lambda _: None))(box)
    found = read_lab(box.lab)
    names = " and ".join(work.__name__.strip("_") for work in works)
    if found.state != {"p0", "p1", "p2", "p3"} - ({"p1"} if gone else set()):
        return f"{names}: {found.state}, {found.said}"
    return f"{names}: {found.said}" if [d.severity for d in found.said] != ["note"] * gone else ""


if __name__ == "__main__":
    sys.exit(main())
