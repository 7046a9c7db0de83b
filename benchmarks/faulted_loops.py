"""Optimizations on which everything goes wrong: `python benchmarks/faulted_loops.py [--loops 1000] [--kills 150]`.

`--only 331` runs one loop of a seed again: where it begins and what goes wrong in it follow from both numbers alone.

Each loop runs `optimize` through the edge of a simulated bench, shipped ones and small ones of our own, with faults of
the device below it: axes that stop, stick for good, do not answer or are slow, frames that get lost, beams that are
lost for a while, detectors that are flooded; or it is interrupted by INT, TERM or HUP, or INT twice. `--kills`: of the
whole command by SIGKILL at random instants, half of them of the process that serves the bench; `pico resume` or
`pico undo` follows. Judged is the world itself, not its readings: each tunable within its bounds; what the light truly
is no worse, by two standard deviations of what was measured, than before, or an axis is named with its last reading;
exposures as they were. The exit code is 1 where anything is wrong.
"""

from __future__ import annotations

import argparse
import math
import os
import re
import signal
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from random import Random

from pico.places.bench import BenchPlace

QUICK = Path("/dev/shm")
"""Where files are kept in memory: nothing here asks what becomes of them without power."""
ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "benchmarks"), str(ROOT / "tests" / "edge"), str(ROOT / "tests" / "execution")]

from faulted_benches import OFTEN, SOUGHT, Sought, drawn, made  # noqa: E402

from pico.backends.sim.faults import Faults, save_faults  # noqa: E402
from pico.backends.sim.readings import Table  # noqa: E402
from pico.backends.sim.store import load_world, save_world  # noqa: E402
from pico.backends.sim.world import World  # noqa: E402
from pico.bench.bench import Bench  # noqa: E402
from pico.bench.goals import Optimized  # noqa: E402
from pico.model.setup import Setup  # noqa: E402
from pico.model.trace.event import Event  # noqa: E402

FAULTS: dict[str, dict[str, float]] = {
    "none": {}, "jam": {"jam": 0.15}, "timeout": {"timeout": 0.3}, "slow": {"slow": 0.3}, "stick": {"stick": 0.08},
    "frame": {"frame": 0.3}, "frames": {"frame": 0.7}, "beam": {"beam": 0.15}, "flood": {"flood": 0.2},
    "all": {"jam": 0.05, "timeout": 0.1, "frame": 0.1, "beam": 0.05, "flood": 0.05, "slow": 0.1, "stick": 0.01},
}  # fmt: skip
SIGNALS = {
    "INT": (signal.SIGINT,), "TERM": (signal.SIGTERM,), "HUP": (signal.SIGHUP,),
    "INT INT": (signal.SIGINT, signal.SIGINT),
}  # fmt: skip
NAMED = re.compile(r"(\w+\.\w+) does not go where it is sent; it last stood at (-?[\d.e+-]+)")


def truth(setup: Setup, root: Path, world: World, sought: Sought) -> float:
    """Return how far the light of a world is from a goal, with nothing in the way, at one moment."""
    return sought.true(Table(setup, BenchPlace(root, "sim"), replace(world, clock=0.0)))


def stands(world: World, sought: Sought) -> dict[str, float]:
    """Return where the tunables of a goal truly are."""
    found = {}
    for address in sought.bounds:
        component, _, tunable = address.partition(".")
        value = world.components[component].values[tunable].value
        assert isinstance(value, int | float)
        found[address] = float(value)
    return found


def others(world: World, sought: Sought) -> dict[str, object]:
    """Return what a goal does not tune: exposures, shutters, all else."""
    return {
        f"{name}.{tunable}": live.value
        for name, body in world.components.items()
        for tunable, live in body.values.items()
        if f"{name}.{tunable}" not in sought.bounds
    }


def sigma(found: Optimized) -> float:
    """Return a standard deviation of what was measured at the beginning and the end, together."""
    whole = 0.0
    for of in (found.first, found.last):
        whole += sum(v**2 for n, v in (of or {}).items() if n.endswith("_sigma"))
    return math.sqrt(whole)


class Loops:
    """Loops on the benches of SOUGHT, one after the other, each lab made once."""

    def __init__(self, place: Path, seed: int) -> None:
        self.place, self.seed = place, seed
        self.benches: dict[str, tuple[Bench, World]] = {}
        self.count: Counter[str] = Counter()

    def bench(self, lab: str) -> tuple[Bench, World]:
        """Return a lab's bench, and its world as it was placed."""
        if lab not in self.benches:
            bench = Bench.open(made(lab, self.place), fidelity="kinematic")
            self.benches[lab] = bench, load_world(bench.setup, BenchPlace(bench.folder.root, "sim"))[0]
        return self.benches[lab]

    def one(self, number: int, name: str, kind: str) -> Iterator[str]:
        """Run a loop with faults or a signal of a kind; yield what is wrong with its end."""
        sought, draw = SOUGHT[name], Random(f"{self.seed}/{number}")
        bench, placed = self.bench(sought.lab)
        root, setup = bench.folder.root, bench.setup
        before = drawn(setup, placed, sought, draw)
        save_world(BenchPlace(root, "sim"), before, durable=False)
        save_faults(BenchPlace(root, "sim"), Faults(rates=FAULTS.get(kind, {}), seed=draw.randrange(10**6)))
        with (root / ".pico/benches/sim" / "lock").open("r+b") as lock:  # by the tokens counted there faults are drawn
            lock.write(b"%-31d\n" % (1000 * (number + 1)))
        algorithm = draw.choice(sought.algorithms)
        chosen = bench.goals.chosen([name], algorithm=algorithm)
        send, at = list(SIGNALS.get(kind, ())), draw.randint(1, 15)

        def show(event: Event) -> None:
            if send and event.kind == "operation_progress" and event.data.get("measured") == at:
                while send:  # going back to the last good point is told with the same number
                    os.kill(os.getpid(), send.pop(0))

        try:
            _, found = bench.goals.optimize(bench.goals.plan(chosen), show)
        except Exception as exc:
            yield f"it raised {exc!r}: {getattr(exc, 'diagnostics', '')}"
            return
        after, _ = load_world(setup, BenchPlace(root, "sim"))
        self.count["met" if found.met else "not met"] += 1
        yield from self.judged(sought, kind, setup, root, (before, after), found)

    def judged(
        self, sought: Sought, kind: str, setup: Setup, root: Path, worlds: tuple[World, World], found: Optimized
    ) -> Iterator[str]:
        """Yield what is wrong with how a loop ended."""
        before, after = worlds
        yield from outside(setup, after, sought)
        if kind == "INT INT":  # what is on its way stays there, shutters close, exposures are as they are
            self.count["stopped at once"] += 1
            return
        if changed := {k: (v, others(after, sought)[k]) for k, v in others(before, sought).items()
                       if others(after, sought)[k] != v}:  # fmt: skip
            yield f"left otherwise: {changed}"
        if named := NAMED.search(found.why):
            self.count["axis named"] += 1
            yield from unnamed(sought, named, stands(before, sought), after)
            return
        if after.stuck:
            yield f"{after.stuck} is stuck, and it says: {found.why}"
        first, last = (truth(setup, root, w, sought) for w in worlds)
        if not last <= first + 2 * sigma(found) + 1e-9:
            yield f"worse: {first:.6g}, now {last:.6g}, sigma {sigma(found):.3g}; met {found.met}, {found.why}"


def outside(setup: Setup, world: World, sought: Sought) -> Iterator[str]:
    """Yield tunables that are not within their bounds; an angle that comes round within them never is."""
    for address, value in stands(world, sought).items():
        low, high = sought.bounds[address]
        component, _, tunable = address.partition(".")
        period = setup.type_of(component).tunables[tunable].period
        if not (low - 1e-9 <= value <= high + 1e-9 or (period and period <= high - low)):
            yield f"{address} is at {value:g}, outside {low:g} to {high:g}"


def unnamed(sought: Sought, named: re.Match[str], first: dict[str, float], after: World) -> Iterator[str]:
    """Yield what is wrong with the axis that is named: its reading, or where the others are."""
    axis, reading = named[1], float(named[2])
    low, high = sought.bounds.get(axis, (math.nan, math.nan))
    if not low <= reading <= high:
        yield f"names {axis} at {reading:g}"
    for address, value in stands(after, sought).items():
        known = after.components[address.partition(".")[0]].values[address.partition(".")[2]].status == "known"
        if address != axis and known and abs(value - first[address]) > 1e-9:
            yield f"{axis} failed, and {address} is left at {value:g}, not at {first[address]:g}"


def killed(folder: Path, pid: int, draw: Random, sought: Sought) -> bool:
    """Kill a process (an optimization, or who serves it) a while after the optimization began; return whether it was
    killed before that ended."""
    until, mark = time.monotonic() + 60.0, folder / ".pico/benches/sim" / "run"
    while not mark.exists() and time.monotonic() < until:
        time.sleep(0.002)
    time.sleep(draw.uniform(0.0, 1.5))
    going = mark.exists()
    os.kill(pid, signal.SIGKILL)
    return going


class Kills:
    """Commands of PICO, or the process that serves their bench, killed by SIGKILL while they optimize."""

    def __init__(self, place: Path, seed: int) -> None:
        self.place, self.draw, self.count = place, Random(seed), Counter[str]()
        self.labs: dict[str, tuple[Path, Setup, World]] = {}

    def lab(self, lab: str) -> tuple[Path, Setup, World]:
        """Return the folder of a lab, its setup, and its world as it was placed."""
        if lab not in self.labs:
            folder = made(lab, self.place)
            with Bench.open(folder, fidelity="kinematic") as bench:
                self.labs[lab] = folder, bench.setup, load_world(bench.setup, BenchPlace(folder, "sim"))[0]
        return self.labs[lab]

    def one(self, name: str, served: bool) -> Iterator[str]:
        """Kill one, and go on from there; yield what is wrong."""
        from kills import command, forked
        from serving import served as serving

        sought = SOUGHT[name]
        folder, setup, placed = self.lab(sought.lab)
        before = drawn(setup, placed, sought, self.draw)
        save_world(BenchPlace(folder, "sim"), before, durable=False)
        save_faults(BenchPlace(folder, "sim"), Faults())
        (folder / ".pico/benches/sim" / "run").unlink(
            missing_ok=True
        )  # of one that was killed before it had set anything
        words = ("optimize", name, "--yes", "--algorithm", self.draw.choice(sought.algorithms))
        if served:
            try:
                with serving(folder) as server:
                    client = forked(folder, *words)
                    going = killed(folder, server, self.draw, sought)
                    os.waitpid(client, 0)
            except ProcessLookupError:
                pass  # it is what was killed
        else:
            client = forked(folder, *words)
            going = killed(folder, client, self.draw, sought)
            os.waitpid(client, 0)
        if not going:
            self.count["ended first"] += 1
            return
        self.count["server killed" if served else "command killed"] += 1
        left, _ = load_world(setup, BenchPlace(folder, "sim"))
        yield from outside(setup, left, sought)
        way = self.draw.choice(("resume", "undo"))
        code = command(folder, way, "--yes")
        after, _ = load_world(setup, BenchPlace(folder, "sim"))
        yield from outside(setup, after, sought)
        wanted, found = others(before, sought), others(after, sought)
        if changed := {k: (v, found[k]) for k, v in wanted.items() if found[k] != v}:
            yield f"{way} ({code}) left otherwise: {changed}; {(folder / 'out.txt').read_text()[-300:]}"
        first, last = (truth(setup, folder, w, sought) for w in (before, after))
        self.count[f"{way} {code}"] += 1
        if way == "undo":
            away = {n: v for n, v in stands(after, sought).items() if abs(v - stands(before, sought)[n]) > 1e-6}
            if away or code != 0:
                yield f"undo ({code}) left {away}; {(folder / 'out.txt').read_text()[-300:]}"
        elif (
            code == 1
            and "does it anew" in (folder / "out.txt").read_text()
            and stands(left, sought) == stands(before, sought)
        ):  # killed before it had begun its operation: nothing was set, and that is said
            self.count["killed before it began"] += 1
        elif code not in (0, 6) or last > first * (1.02 if first > 0 else 0.98) + 1e-3:
            yield f"resume ({code}): {first:.6g}, now {last:.6g}; {(folder / 'out.txt').read_text()[-300:]}"


def kill(place: Path, kills: int, seed: int) -> int:
    """Kill optimizations so often; return how many times something was wrong."""
    from kills import preload

    preload()
    wrong, began, bench = 0, time.monotonic(), Kills(place, seed)
    names = [name for name in SOUGHT if SOUGHT[name].lab in ("camera", "fiber", "crossed")]
    number = 0
    while bench.count["command killed"] + bench.count["server killed"] < kills:
        name = names[number % len(names)]
        for text in bench.one(name, number % 2 == 1):
            wrong += 1
            print(f"kill {number}, {name}: {text}", flush=True)
        number += 1
    told = ", ".join(f"{n} {what}" for what, n in sorted(bench.count.items()))
    print(f"kills in {time.monotonic() - began:.0f} s: {told}; {wrong} wrong")
    return wrong


def main() -> int:
    """Run loops, then kill."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--loops", type=int, default=1000)
    parser.add_argument("--kills", type=int, default=150)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help="the number of the first loop, to run them in parts")
    parser.add_argument("--only", type=int, nargs="+", help="the loops of these numbers alone, and nothing is killed")
    parser.add_argument("--goals", nargs="*", default=list(SOUGHT), help="only these of the goals")
    parser.add_argument("--kinds", nargs="*", default=[*FAULTS, *SIGNALS], help="only these faults and signals")
    given = parser.parse_args()
    began, wrong = time.monotonic(), 0
    names = [name for name in given.goals for _ in range(OFTEN[name])]
    Random(given.seed).shuffle(names)
    with tempfile.TemporaryDirectory(dir=QUICK if QUICK.is_dir() else None) as temporary:
        if given.kills and given.only is None:
            wrong += kill(Path(temporary) / "killed", given.kills, given.seed)
            began = time.monotonic()
        loops = Loops(Path(temporary), given.seed)
        numbers = sorted(given.only or range(given.first, given.first + given.loops))
        for number in numbers:
            name = names[number % len(names)]
            kind = given.kinds[(number + number // len(names)) % len(given.kinds)]
            loops.count[f"with {kind}"] += 1
            for text in loops.one(number, name, kind):
                wrong += 1
                print(f"loop {number}, {name}, {kind}: {text}", flush=True)
    took = time.monotonic() - began
    told = ", ".join(f"{n} {what}" for what, n in sorted(loops.count.items()))
    print(f"{len(numbers)} loops in {took:.0f} s: {told}; {wrong} wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
