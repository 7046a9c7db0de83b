"""Whether the tests bite: plants one mutant at a time in a copy of the tree, and runs the fast tests that execute it.

    python benchmarks/mutants.py --seed 1 --count 200 --map map.json
    python benchmarks/mutants.py --seed 1 --count 4 --rooms policy --tests tests/policy
    python benchmarks/mutants.py --by-hand
    python benchmarks/mutants.py --safety --map safety.json
    python benchmarks/mutants.py --safety --module policy/dose leases

A seed draws the mutants from all that `mutating.py` can make of the rooms, each as likely as any other. First the tests
are run once to see which lines each of them executes (minutes; `--map` keeps that in a file, and only tests that have
changed since are run again). Then each mutant meets those that execute its line, the cheapest first and those of its
own room before others, up to so many CPU seconds, until one fails. `--by-hand` plants the mutants of
`mutants_by_hand.py` instead, and runs the tests that each names. `--safety` plants every mutant of the modules that
decide about light and motion (`mutants_safety.py`; `--module` takes some of them) and runs the quick tests of the
module's own package; what survives meets other quick tests, which is told apart.

Prints the survivors as differences as they are found, and a table by room; a mutant that can't be told from the
original counts as a survivor. The exit code is 3 where more than 15 % survive, 1 where one of those made by hand does.
With `--safety` mutants that are listed in `mutants_accepted.json` are not planted, and 3 says that the quick tests of
the own packages kill less than 95 % of the others.
"""

from __future__ import annotations

import argparse
import difflib
import hashlib
import json
import os
import queue
import random
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import threading
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

from mutants_by_hand import BY_HAND
from mutants_safety import SAFETY, accepted, belongs, chosen, key_of, table_of
from mutating import Mutant, is_python, mutants, planted

ROOT = Path(__file__).resolve().parent.parent
ROOMS = {
    "planning": ("planning", "staging"),
    "execution": ("execution",),
    "policy": ("policy",),
    "merge": ("merge",),
    "motion": ("motion",),
    "vision": ("vision",),
}
"""The rooms, and the names of the folders under `pico/` that are theirs."""
NEAR = {"merge": ("history",)}
"""Test folders of a room that have another name."""
BAR = 0.15
KILLED = 0.95
"""The share of the mutants of the safety group that the quick tests of their own packages have to kill."""
PROCESSES = 2
SECONDS, ALL = 20.0, 90.0

Tests = dict[str, dict[str, Any]]
"""For each test, by pytest's name, its CPU `seconds` and the `lines` that it executes, by file."""


@dataclass(frozen=True)
class Verdict:
    """What became of a mutant: killed, survived or timed out; `by` which test, of how many; in how many CPU seconds."""

    mutant: Mutant
    outcome: str
    by: str
    tests: int
    cpu: float = 0.0


def room_of(file: str) -> str | None:
    """Return the room that a file of `pico/` belongs to."""
    parts = Path(file).parts[1:]
    return next((room for room, names in ROOMS.items() if any(name in parts for name in names)), None)


def sources(rooms: Iterable[str]) -> dict[str, str]:
    """Return the text of each module of some rooms."""
    files = (file.relative_to(ROOT).as_posix() for file in sorted((ROOT / "pico").rglob("*.py")))
    return {file: (ROOT / file).read_text() for file in files if room_of(file) in rooms}


def drawn(texts: dict[str, str], seed: int, count: int) -> list[Mutant]:
    """Return so many mutants of some modules, the same for the same seed and text."""
    every = [mutant for file, text in texts.items() for mutant in mutants(file, text)]
    random.Random(seed).shuffle(every)
    good = (mutant for mutant in every if is_python(mutant.apply(texts[mutant.file])))
    return [mutant for mutant, _ in zip(good, range(count), strict=False)]


class Workers:
    """Processes with the tests loaded, each in a copy of the tree of its own."""

    def __init__(self, folder: Path, tests: Sequence[str]) -> None:
        self.all = [self._started(folder / str(n), tests) for n in range(PROCESSES)]
        self.names: list[str] = [json.loads(_line(worker))["tests"] for worker in self.all].pop()

    @staticmethod
    def _started(folder: Path, tests: Sequence[str]) -> subprocess.Popen[str]:
        copy = folder / "tree"
        listed = subprocess.run(
            ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
            cwd=ROOT, capture_output=True, text=True, check=True,
        ).stdout  # fmt: skip
        for name in filter(None, listed.split("\0")):
            if (ROOT / name).is_file():
                (copy / name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy2(ROOT / name, copy / name)
        env = os.environ | {
            "PYTHONPATH": f"{copy}{os.pathsep}{copy / 'benchmarks'}",
            "PYTHONDONTWRITEBYTECODE": "1",
            "CI": "1",
        }
        env |= {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "TMPDIR": str(folder)}
        command = [sys.executable, "-c", "from mutant_worker import main; main()", *tests]
        return subprocess.Popen(
            command, cwd=copy, env=env, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )  # fmt: skip

    def answers(self, jobs: Sequence[dict[str, Any]]) -> Iterator[tuple[int, dict[str, Any]]]:
        """Yield the answer to each job with its number, as they come."""
        waiting: queue.SimpleQueue[int] = queue.SimpleQueue()
        done: queue.SimpleQueue[tuple[int, dict[str, Any]] | Exception] = queue.SimpleQueue()
        for number in range(len(jobs)):
            waiting.put(number)

        def work(worker: subprocess.Popen[str]) -> None:
            assert worker.stdin
            try:
                while True:
                    number = waiting.get_nowait()
                    worker.stdin.write(json.dumps(jobs[number]) + "\n")
                    worker.stdin.flush()
                    done.put((number, json.loads(_line(worker))))
            except queue.Empty:
                return
            except Exception as exc:
                done.put(exc)

        for worker in self.all:
            threading.Thread(target=work, args=(worker,), daemon=True).start()
        for _ in jobs:
            answer = done.get()
            if isinstance(answer, Exception):
                raise answer
            yield answer

    def end(self) -> None:
        for worker in self.all:
            assert worker.stdin
            worker.stdin.close()
            worker.wait()


def _line(worker: subprocess.Popen[str]) -> str:
    assert worker.stdout
    line = worker.stdout.readline()
    while line and not line.startswith("{"):
        line = worker.stdout.readline()
    if not line:
        raise SystemExit("a worker ended; run its tests by hand in the tree as it is")
    return line


@contextmanager
def running(tests: Sequence[str]) -> Iterator[Workers]:
    """Have workers for some test files or folders."""
    with tempfile.TemporaryDirectory() as folder:
        workers = Workers(Path(folder), tests)
        try:
            yield workers
        finally:
            workers.end()


def mapped(workers: Workers, texts: dict[str, str], kept: Path | None) -> Tests:
    """Return what each test executes of some modules, from the file where it was kept as far as it still holds."""
    known = json.loads(kept.read_text()) if kept and kept.exists() else {}
    now = {file: _digest(ROOT / file) for file in sorted({name.partition("::")[0] for name in workers.names})}
    files = sorted(texts)
    fresh = {f: k for f, k in known.items() if now.get(f) == k["digest"]}
    jobs = [{"file": file, "files": files} for file in now if file not in fresh]
    jobs.sort(key=lambda job: -(ROOT / str(job["file"])).stat().st_size)
    modules = {file: hashlib.sha256(text.encode()).hexdigest() for file, text in texts.items()}
    for n, (number, answer) in enumerate(workers.answers(jobs), 1):
        file = str(jobs[number]["file"])
        fresh[file] = {"digest": now[file], "modules": modules, "tests": answer["tests"]}
        print(f"\r{n} of {len(jobs)} test files mapped", end="", file=sys.stderr, flush=True)
    if kept:
        kept.write_text(json.dumps(fresh))
    return {
        name: {
            **test,
            "changed": {m for m, digest in modules.items() if entry["modules"].get(m, digest) != digest},
            "unknown": modules.keys() - entry["modules"].keys(),
        }
        for entry in fresh.values()
        for name, test in entry["tests"].items()
    }


def _digest(file: Path) -> str:
    return hashlib.sha256(file.read_bytes()).hexdigest()


def _near(file: str) -> tuple[str, ...]:
    """Return the test folders of the room that a module belongs to."""
    room = room_of(file) or ""
    return tuple(f"tests/{name}/" for name in (*ROOMS[room], *NEAR.get(room, ())))


class Matching:
    """Which tests execute a line. Where a module has changed since a test was mapped, it executes all or none of it;
    where the module is new, all that are near execute it. `near`: where the tests of a module's own room begin, by
    file."""

    def __init__(
        self, tests: Tests, texts: dict[str, str], near: Callable[[str], tuple[str, ...]] = _near
    ) -> None:  # fmt: skip
        self.tests, self.texts, self.near = tests, texts, near
        self.at: defaultdict[tuple[str, int], set[str]] = defaultdict(set)
        self.of: defaultdict[str, set[str]] = defaultdict(set)
        self.any: defaultdict[str, set[str]] = defaultdict(set)
        for name, test in tests.items():
            for file, lines in test["lines"].items():
                self.any[file].add(name)
                if file in test["changed"]:
                    self.of[file].add(name)
                for line in lines:
                    self.at[file, line].add(name)
            for file in test["unknown"]:
                if name.startswith(near(file)):
                    self.of[file].add(name)

    def __call__(self, mutant: Mutant, budget: float) -> tuple[list[str], float]:
        """Return the tests that a mutant meets, in order, and their CPU seconds."""
        found = self._of_function(mutant) if mutant.function else self._beside(mutant)
        near = self.near(mutant.file)

        def cost(name: str) -> tuple[float, str]:
            return (0.02 + float(self.tests[name]["seconds"])) * (1 if name.startswith(near) else 3), name

        chosen, seconds = [], 0.0
        for name in sorted(found, key=cost):
            seconds += 0.02 + self.tests[name]["seconds"]
            if seconds > budget and chosen:
                break
            chosen.append(name)
        return chosen, seconds

    def _of_function(self, mutant: Mutant) -> set[str]:
        lines = range(mutant.first, mutant.line + 1)
        return self.of[mutant.file].union(*(self.at[mutant.file, line] for line in lines))

    def _beside(self, mutant: Mutant) -> set[str]:
        """Return the tests that may notice another constant: a test that only reads it executes no line."""
        executing = self._of_name(mutant.name) or self.any[mutant.file]
        files = {name.partition("::")[0] for name in executing}
        return executing | {name for name in self.tests if name.partition("::")[0] in files}

    def _of_name(self, name: str) -> set[str]:
        word = re.compile(rf"\b{re.escape(name)}\b")
        found: set[str] = set()
        for file, text in self.texts.items():
            for number, line in enumerate(text.splitlines(), 1):
                if name and word.search(line):
                    found |= self.at[file, number] | self.of[file]
        return found


def judged(
    workers: Workers, made: Sequence[Mutant], tests: Sequence[tuple[list[str], float]], texts: Mapping[str, str]
) -> list[Verdict]:
    """Return what became of each mutant that some tests met."""
    verdicts: dict[int, Verdict] = {}
    met = [n for n, (names, _) in enumerate(tests) if names]
    jobs = [{"mutant": asdict(made[n]), "tests": tests[n][0], "seconds": tests[n][1]} for n in met]
    for done, (number, answer) in enumerate(workers.answers(jobs), 1):
        n = met[number]
        verdicts[n] = Verdict(
            made[n], answer["outcome"], answer.get("by", ""), len(tests[n][0]), answer.get("cpu", 0.0)
        )  # fmt: skip
        if verdicts[n].outcome != "killed" and made[n].wrong != made[n].right:
            print("\n" + shown(verdicts[n], texts[made[n].file]), flush=True)
        print(f"\r{done} of {len(jobs)} mutants judged", end="", file=sys.stderr, flush=True)
    for n in (n for n in range(len(made)) if n not in verdicts):
        verdicts[n] = Verdict(made[n], "survived", "", 0)
        print("\n" + shown(verdicts[n], texts[made[n].file]), flush=True)
    return [verdicts[n] for n in range(len(made))]


def table(verdicts: Sequence[Verdict]) -> str:
    """Return a line a room: made, killed, survived, timed out."""
    columns = ("made", "killed", "survived", "timed out")
    counts = Counter((room_of(v.mutant.file), what) for v in verdicts for what in ("made", v.outcome))
    rooms = [room for room in ROOMS if counts[room, "made"]]
    rows = [(room, *(counts[room, column] for column in columns)) for room in rooms]
    rows.append(("all", *(sum(row[n] for row in rows) for n in range(1, 5))))
    lines = [f"{'room':<10}" + "".join(f"{c:>11}" for c in columns) + f"{'survive':>9}"]
    for name, *numbers in rows:
        lines.append(f"{name:<10}" + "".join(f"{n:>11}" for n in numbers) + f"{numbers[2] / (numbers[0] or 1):>8.1%}")
    return "\n".join(lines)


def shown(verdict: Verdict, text: str) -> str:
    """Return a survivor as a difference."""
    mutant = verdict.mutant
    lines = difflib.unified_diff(text.splitlines(), mutant.apply(text).splitlines(), n=0, lineterm="")
    changed = "\n".join(line for line in list(lines)[2:] if not line.startswith("@@"))
    met = f"{verdict.tests} tests" if verdict.tests else "no test executes it"
    return f"{mutant.file}:{mutant.line} ({mutant.kind}; {verdict.outcome}, {met})\n{changed}"


def sampled(given: argparse.Namespace) -> list[Verdict]:
    """Judge a sample of mutants."""
    texts = sources(given.rooms)
    made = drawn(texts, given.seed, given.count)
    with running(given.tests) as workers:
        matching = Matching(mapped(workers, texts, given.map), texts)
        return judged(workers, made, [matching(mutant, given.seconds or SECONDS) for mutant in made], texts)


def safety(words: Sequence[str], kept: Path | None, seconds: float, own_only: bool = False) -> int:
    """Plant every mutant of the safety group, or of the modules whose path contains a word, and print what became of
    them. Return the exit code: 3 if the quick tests of the own packages kill less than `KILLED` of them."""
    files, known = chosen(words), accepted()
    texts = {file: (ROOT / file).read_text() for file in files}
    every = [m for file in files for m in mutants(file, texts[file]) if belongs(m) and is_python(m.apply(texts[file]))]
    made = [m for m in every if key_of(m, texts[m.file]) not in known]
    folders = sorted(
        {folder for file in files for folder in (*SAFETY[file].own, *(() if own_only else SAFETY[file].others))}
    )
    with running(folders) as workers:
        tests = mapped(workers, texts, kept)

        def met(file: str, among: tuple[str, ...]) -> Matching:
            inside = tuple(f"{folder}/" for folder in among)
            return Matching({n: t for n, t in tests.items() if n.startswith(inside)}, texts, lambda _: inside)

        def all_judged(these: Sequence[Mutant], which: Callable[[str], tuple[str, ...]]) -> list[Verdict]:
            matching = {file: met(file, which(file)) for file in files}
            return judged(workers, these, [matching[m.file](m, seconds) for m in these], texts)

        own = all_judged(made, lambda file: SAFETY[file].own)
        left = [v.mutant for v in own if v.outcome == "survived" and SAFETY[v.mutant.file].others and not own_only]
        print("\n\nWhat the own package leaves, by other quick tests:", flush=True) if left else None
        others = all_judged(left, lambda file: SAFETY[file].others)
    killed_elsewhere = Counter(v.mutant.file for v in others if v.outcome != "survived")
    print("\n" + table_of(own, killed_elsewhere, Counter(m.file for m in every)))
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    print(f"{used.ru_utime + used.ru_stime:.0f} CPU seconds in all")
    survived = sum(v.outcome == "survived" for v in own)
    return 3 if survived > (1 - KILLED) * len(own) else 0


def by_hand(only: str) -> list[Verdict]:
    """Judge the mutants made by hand, each by the tests that it names."""
    texts = sources(ROOMS) | {
        f.relative_to(ROOT).as_posix(): f.read_text() for f in sorted((ROOT / "pico").rglob("*.py"))
    }
    chosen = [one for one in BY_HAND if only in one.means]
    made = []
    for one in chosen:
        where = [file for file, text in texts.items() if one.right in text]
        if len(where) != 1 or texts[where[0]].count(one.right) != 1:
            raise SystemExit(f"`{one.right}` stands in {', '.join(where) or 'no file'}, not once: {one.means}")
        made.append(planted(where[0], texts[where[0]], one.right, one.wrong))
    named = {one.tests: _named(one.tests) for one in chosen}
    with running(sorted({name.partition("::")[0] for name in named.values()})) as workers:
        tests = [[name for name in workers.names if _is_of(name, named[one.tests])] for one in chosen]
        as_it_is = judged(
            workers, [replace(m, wrong=m.right) for m in made], [(names, SECONDS) for names in tests], texts
        )
        if failed := [v.by for v in as_it_is if v.outcome != "survived"]:
            raise SystemExit(f"without any mutant these do not pass: {', '.join(failed)}")
        return judged(workers, made, [(names, SECONDS) for names in tests], texts)


def _named(tests: str) -> str:
    """Return a test file, or one test of it, by its path from the root of the tree."""
    name, two_dots, test = tests.partition("::")
    found = sorted((ROOT / "tests").rglob(name))
    if len(found) != 1:
        raise SystemExit(f"there are {len(found)} test files {name}")
    return f"{found[0].relative_to(ROOT).as_posix()}{two_dots}{test}"


def _is_of(name: str, tests: str) -> bool:
    """Return whether a test, with its parameters, is the one that is named, or in the file that is named."""
    return tests in (name.partition("[")[0], name.partition("::")[0])


def main() -> int:
    """Make mutants, judge them and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--rooms", nargs="+", choices=sorted(ROOMS), default=list(ROOMS))
    parser.add_argument("--tests", nargs="+", default=["tests"], help="test files and folders to choose from")
    parser.add_argument("--map", type=Path, help="a file that keeps which test executes what")
    parser.add_argument(
        "--seconds",
        type=float,
        help=f"CPU seconds of tests that a mutant meets at most: {SECONDS:g}, {ALL:g} with --safety",
    )
    parser.add_argument("--by-hand", action="store_true", help="the mutants made by hand")
    parser.add_argument("--only", default="", help="of those made by hand, those that mean this")
    parser.add_argument("--safety", action="store_true", help="every mutant of what decides about light and motion")
    parser.add_argument("--module", nargs="+", default=[], help="of those, the modules whose path contains a word")
    parser.add_argument("--own", action="store_true", help="only the quick tests of the own packages")
    given = parser.parse_args()
    if given.safety:
        return safety(given.module, given.map, given.seconds or ALL, given.own)
    verdicts = by_hand(given.only) if given.by_hand else sampled(given)
    print(file=sys.stderr)
    if given.by_hand:
        for one, verdict in zip([one for one in BY_HAND if given.only in one.means], verdicts, strict=True):
            print(f"{verdict.outcome:<10} {one.means}: {verdict.by.rpartition('::')[2]}")
    else:
        print(table(verdicts))
    survived = sum(v.outcome == "survived" for v in verdicts)
    if given.by_hand:
        return 1 if survived else 0
    return 3 if survived > BAR * len(verdicts) else 0


if __name__ == "__main__":
    sys.exit(main())
