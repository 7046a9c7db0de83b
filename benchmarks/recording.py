"""What a setting costs in one recorded run, beside one that is a run of its own, and what a kill leaves of it:
`python benchmarks/recording.py --settings 50 --kills 20`.

CPU milliseconds of the whole process for each setting of p1.angle on the kinematic bench of the case study, its
settings planned, checked and journalled; seconds by the wall, for they wait for the disk. Then the same run as a
document: how long it takes to be read.

`--kills`: scripts that set, measure and move in one recorded run, each killed (`kill -9`) at a random instant. What a
script was told that it had done must be in the trace as done, once; the run must be told as killed; after `pico
recover` the bench must stand as the last setting that began or the one before it (or say that nobody knows, where that
was cut short), and go on.
"""

from __future__ import annotations

import argparse
import random
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import pico
from pico.bench.bench import new_lab
from pico.scripting.bench import Bench


def each(settings: int, setting: Callable[[float], object]) -> str:
    """Return what each of some settings took."""
    setting(5.0)
    cpu, wall = time.process_time(), time.monotonic()
    for n in range(settings):
        setting(10.0 + n % 7)
    cpu, wall = time.process_time() - cpu, time.monotonic() - wall
    return f"{1e3 * cpu / settings:6.1f} ms CPU, {1e3 * wall / settings:6.1f} ms by the wall"


SCRIPT = """
import sys, pico
with pico.open(sys.argv[1], fidelity="kinematic") as bench, bench.record("killed"):
    print("begun", flush=True)
    for n in range(10_000):
        bench["p1"].angle = 1 + n % 300
        print("set", 1 + n % 300, flush=True)
        bench.measure("p1.angle")
        print("measured", flush=True)
        if n % 20 == 10:
            bench["p2"].move(x=510 + (10 * int(sys.argv[2]) + n // 20) % 20, y=420)  # never where it stands
            print("moved", flush=True)
"""


def killed(folder: Path, seed: int) -> str:
    """Kill a script at a random instant, and return what is not true of what it leaves; empty where all is."""
    with subprocess.Popen(
        [sys.executable, "-c", SCRIPT, str(folder), str(seed)], stdout=subprocess.PIPE, text=True
    ) as script:
        assert script.stdout is not None
        script.stdout.readline()
        time.sleep(random.Random(seed).uniform(0.0, 1.5))
        script.send_signal(signal.SIGKILL)
        told = script.stdout.read().splitlines()
    with pico.open(folder, fidelity="kinematic") as bench:
        try:
            plan = bench.recovery.recover_plan()
            if plan.operations:
                bench.apply(plan)
            else:
                bench.recovery.settle()
            found = untrue(bench, told)
            bench["p1"].angle = 0.5
        except pico.PicoError as exc:
            found = str(exc)
    if found:
        print(f"kill {seed}: {found}", flush=True)
    return found


def untrue(bench: Bench, told: list[str]) -> str:
    """Return what is not true of the run that a killed script left, which had told of what it had done."""
    memory = bench.edge.memory
    assert memory is not None
    run = next(run for run in reversed(memory.runs()) if run.holder == "recording killed")
    ended = [r for r in memory.records(run=run.run) if r.kind in ("done", "resolved")]
    asked = {r.key: r.data for r in memory.records(run=run.run) if r.kind == "intent"}
    if run.outcome is not None:
        return f"it is told as {run.outcome}"
    if memory.unsettled():
        return "something is unsettled"
    for word, primitive in (("set", "set"), ("measured", "measure"), ("moved", "move")):
        ops = [asked[r.key] for r in ended if asked[r.key]["primitive"] == primitive]
        done = [op for op in ops if op["component"] != "laser"]
        said = sum(line.startswith(word) for line in told)
        if not said <= len(done) <= said + 1:
            return f"{said} were told as {word}, and {len(done)} are in the trace"
    sets = {k: a["arguments"] for k, a in asked.items() if a["primitive"] == "set" and a["component"] == "p1"}
    if not sets:
        return ""
    last, live = list(sets)[-1], bench["p1"].angle.value
    cut = not any(r.key == last and r.kind == "done" for r in ended)
    allowed = (sets[last]["to"], sets[last]["from"], None) if cut else (sets[last]["to"],)
    return "" if live in allowed else f"p1 stands at {live}, and was last set to {sets[last]['to']}, cut short: {cut}"


def main() -> int:
    """Print the figures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--settings", type=int, default=50)
    parser.add_argument("--kills", type=int, default=20)
    given = parser.parse_args()
    settings = given.settings

    def setting(bench: Bench) -> Callable[[float], object]:
        return lambda angle: setattr(bench["p1"], "angle", angle)

    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary) / "shel"
        new_lab(folder, "shel")
        with pico.open(folder, fidelity="kinematic") as bench:
            with bench.record("scan"):
                print(f"{settings} settings in one recorded run, each: {each(settings, setting(bench))}")
            began = time.process_time()
            run, _ = bench.history.recorded_run()
            cpu = 1e3 * (time.process_time() - began)
            print(f"its trace of {len(run.trace)} lines is read in {cpu:.0f} ms CPU")
            print(f"{settings} settings as runs of their own, each: {each(settings, setting(bench))}")
        wrong = [told for n in range(given.kills) if (told := killed(folder, n))]
    print(f"{given.kills} scripts killed: {len(wrong)} untrue")
    return 1 if wrong else 0


if __name__ == "__main__":
    raise SystemExit(main())
