"""Kills real `pico run` commands at random instants: `python benchmarks/recipe_kills.py --kills 100`.

The case study's `recipes/shel.yaml` (fewer tilts, for they are all alike; `--whole`: all of them) runs once undisturbed
in the kinematic twin. Then it is killed at a random instant, and `pico run --resume` goes on with it, to be killed in
turn, until it has come to its end (or with `--until` before a step); and anew in a new lab, until there were so many
kills. Each end is compared with the undisturbed one: where parts stand and what is set, commits, branches and tags, and
what was measured in which step, which the journal must have once and once only, as the recipe was told it. The exit
code is 1 where anything differs.
"""

from __future__ import annotations

import argparse
import math
import os
import random
import signal
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "benchmarks")]

from kills import forked, preload  # noqa: E402

FEW = ("-p", "tilts=[0, 30]", "-p", "again=[0]")
LONGEST = 8.0
"""Seconds of computing after which a command is killed at the latest: more than any one step takes. By the clock on the
wall a machine with much else to do would never come past the longest step."""
MM, DEG, ELSE = 0.5, 0.1, 1e-6
"""So far apart may poses [mm], angles [deg] and other numbers be: light is sought in noise, which is drawn anew."""


@dataclass(frozen=True)
class How:
    """How the recipe is run: options that make it shorter, `few` where it begins and `until` each time."""

    few: tuple[str, ...]
    until: tuple[str, ...]


@dataclass(frozen=True)
class Ended:
    """What a recipe left: numbers by what they are of, revisions by name, what its steps were told by path, and how
    often the journal has each of that."""

    numbers: Mapping[str, Any]
    revisions: Mapping[str, tuple[str, ...]]
    told: Mapping[str, Mapping[str, Any]]
    taken: Mapping[tuple[str, str], list[Any]]


def ended(folder: Path) -> Ended:
    """Read what the last run of a recipe left in a lab."""
    from pico.bench.bench import Bench
    from pico.places.bench import BenchPlace
    from pico.recipes.log import Log, logs

    with Bench.open(folder) as bench:
        seen, history, memory = bench.observe(), bench.folder.history(), bench.edge.memory
        numbers: dict[str, Any] = {f"{n}.{k}": v for n, own in seen.known_values.items() for k, v in own.items()}
        for name, part in seen.components.items():
            if part.pose is not None:
                numbers |= {f"{name}.pose.{axis}": getattr(part.pose, axis) for axis in ("x", "y", "yaw")}
        names = [n for n in history.handle.references if n.startswith(("refs/heads/", "refs/tags/"))]
        revisions = {n: tuple(c.summary for c in history.log([n])) for n in names}
        steps = Log.read(logs(BenchPlace(folder, "sim"))[0]).steps
        told = {path: step.told["measured"] for path, step in steps.items() if step.told and "measured" in step.told}
        taken: dict[tuple[str, str], list[Any]] = {}
        for record in memory.records() if memory else ():
            found = (record.data.get("data") or {}).get("measurement") if record.kind == "done" else None
            if found:
                path = record.key.split("/")[1].partition(".")[2].rpartition(":")[0]
                taken.setdefault((path, f"{found['component']}.{found['measurable']}"), []).append(found["value"])
    return Ended(numbers, revisions, told, taken)


def wrong(found: Ended, whole: Ended) -> Iterator[str]:
    """Yield how an end differs from that of a run that nobody disturbed."""
    for name in sorted(found.numbers.keys() | whole.numbers.keys()):
        a, b = found.numbers.get(name), whole.numbers.get(name)
        if not alike(name, a, b):
            yield f"{name} is {a}, not {b}"
    for name in sorted(found.revisions.keys() | whole.revisions.keys()):
        if found.revisions.get(name) != whole.revisions.get(name):
            yield f"{name} is {found.revisions.get(name)}, not {whole.revisions.get(name)}"
    for path in sorted(found.told.keys() ^ whole.told.keys()):
        yield f"step {path} was {'not ' if path in whole.told else ''}measured"
    wanted = {(path, address): one["value"] for path, told in found.told.items() for address, one in told.items()}
    for where in sorted(wanted.keys() | found.taken.keys()):
        values = found.taken.get(where, [])
        if values != [wanted.get(where)]:
            yield f"{where[1]} of step {where[0]} was told as {wanted.get(where)}, and the journal has {values}"


def alike(name: str, a: Any, b: Any) -> bool:
    """Return whether a number is what it was without a kill."""
    if not isinstance(a, int | float) or not isinstance(b, int | float) or isinstance(a, bool):
        return bool(a == b)
    if name.endswith(("angle", "yaw")):
        return abs(math.remainder(a - b, 360.0)) <= DEG
    return abs(a - b) <= (MM if ".pose." in name or "stage" in name else max(ELSE, 0.3 * abs(b)))


def command(folder: Path, *words: str, kill_after: float = 0.0) -> int | None:
    """Run a command of PICO in a process of its own; return its exit code, None where it was killed."""
    child = forked(folder, *words)
    while True:
        over, status = os.waitpid(child, os.WNOHANG)
        if over:
            return None if os.WIFSIGNALED(status) else os.WEXITSTATUS(status)
        if kill_after and computed(child) >= kill_after:
            os.kill(child, signal.SIGKILL)
        time.sleep(0.005)


def computed(process: int) -> float:
    """Return the seconds that a process has computed."""
    fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def begin(folder: Path, how: How, *until: str) -> int | None:
    """Run the recipe in a new lab; return its exit code."""
    from pico.history.examples.example import make_example

    make_example("shel", folder)
    return command(folder, "run", "recipes/shel.yaml", "--seed", "1", "-y", *how.few, *(until or how.until))


def kill(folder: Path, how: How, draw: random.Random, most: int, whole: Ended) -> Counter[str]:
    """Kill one run of the recipe up to `most` times, from its first step on, and compare what it came to."""
    count, words = Counter[str](), ("run", "--resume", "-y", *how.until)
    if (code := begin(folder, how, "--until", "1")) == 0:
        code = None
    while code is None:
        after = draw.uniform(0.1, LONGEST) if count["kills"] < most else 0.0
        code = command(folder, *words, kill_after=after)
        count["kills"] += code is None
    said = (
        [*wrong(ended(folder), whole)]
        if code == 0
        else [f"exit code {code}: {(folder / 'out.txt').read_text()[-900:]}"]
    )
    for line in said:
        print(f"after {count['kills']} kills: {line}", flush=True)
    return count + Counter(ends=1, wrong=bool(said))


def main() -> int:
    """Kill."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--kills", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1, help="of the instants")
    parser.add_argument("--whole", action="store_true", help="with all tilts of the recipe")
    parser.add_argument("--until", help="a step before which it ends")
    given = parser.parse_args()
    how = How(() if given.whole else FEW, ("--until", given.until) if given.until else ())
    draw, count, began = random.Random(given.seed), Counter[str](), time.monotonic()
    preload()
    with tempfile.TemporaryDirectory() as temporary:
        code = begin(Path(temporary) / "undisturbed", how)
        if code != 0:
            print((Path(temporary) / "undisturbed" / "out.txt").read_text()[-900:])
            return 1
        whole = ended(Path(temporary) / "undisturbed")
        print(f"undisturbed: {len(whole.told)} steps measured, {time.monotonic() - began:.0f} s", flush=True)
        last = Counter(kills=1)
        while count["kills"] < given.kills and (last["kills"] or not last["wrong"]):
            folder = Path(temporary) / f"shel{count['ends']}"
            last = kill(folder, how, draw, given.kills - count["kills"], whole)
            count += last
            print(f"{count['kills']} kills, {count['ends']} ends, {count['wrong']} wrong", flush=True)
    print(
        f"pico run (kinematic): {count['kills']} kills in {count['ends']} runs of shel.yaml that came to their end, "
        f"{count['wrong']} not as undisturbed; {time.monotonic() - began:.0f} s"
    )
    return 1 if count["wrong"] else 0


if __name__ == "__main__":
    sys.exit(main())
