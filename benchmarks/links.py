"""Kills clients of a bench that another process serves: `python benchmarks/links.py --kills 200`.

Each time `pico apply` runs over the link and is killed with SIGKILL while its run goes on. The run must end by itself,
done; another client must find it, hear every event since the last one that the dead client told, and commit the run.
Prints the counts; the exit code is 1 where anything is wrong.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import os
import random
import signal
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

from pico.places.bench import BenchPlace

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "benchmarks"), str(ROOT / "tests" / "edge")]

from kills import forked, preload  # noqa: E402

GOALS = ("E1-3", "C1", "E3-2", "E2-1")
PATIENCE = 60.0
"""So long a client may take to begin its run [s]."""


def told(folder: Path) -> list[int]:
    """Return the numbers of the events that a client has told, whole lines only."""
    lines = (folder / "out.txt").read_text().split("\n")[:-1]
    return [event["seq"] for line in lines if line.startswith("{") and "seq" in (event := json.loads(line))]


def killed_at(folder: Path, goal: str, events: int) -> bool:
    """Apply over the link, and kill the client once it has told so many events; return whether it was."""
    child = forked(folder, "apply", goal, "--auto-approve", "--json")
    until = time.monotonic() + PATIENCE
    while os.waitpid(child, os.WNOHANG) == (0, 0):
        if len(told(folder)) >= events or time.monotonic() > until:
            os.kill(child, signal.SIGKILL)
            os.waitpid(child, 0)
            return True
    return False


async def attached(folder: Path, since: int) -> tuple[str, bool, list[str]]:
    """Attach to the last run; return its id, whether it still went on, and what is wrong."""
    from pico.edge.link import place
    from pico.edge.link.client import RemoteEdge
    from pico.edge.link.line import SocketLine

    path = place.find(BenchPlace(folder, "sim"))
    assert path is not None
    edge = RemoteEdge(SocketLine(path))
    going = await edge.holder() is not None
    assert edge.memory is not None
    run = edge.memory.runs()[-1].run
    events = [event async for event in edge.events(run, since)]
    wrong = []
    if [event.seq for event in events] != list(range(since + 1, since + len(events) + 1)):
        wrong.append("events are missing")
    report = await edge.report(run)
    if report.outcome != "done" or not report.reached:
        wrong.append(f"it ended {report.outcome}")
    ended = events[-1].kind == "run_finished" if events else since > 0
    if not ended:
        wrong.append("its end is not told")
    return run, going, wrong


def committed(folder: Path, run: str) -> list[str]:
    """Commit the bench, and return what is wrong with that."""
    from pico.bench.bench import Bench

    with Bench.open(folder) as bench:
        done = bench.commit(f"after {run}", "capture")
        if run not in done.runs:
            return [f"the commit carries {done.runs}"]
        document = bench.history.recorded_run(run)[0].document
        return (
            [] if document.outcome == "done" and document.evidence != "planned" else [f"carried as {document.outcome}"]
        )


def main() -> int:
    """Kill until there were as many as asked for, while their run went on."""
    from serving import served

    from pico.history.examples.example import make_example

    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--fidelity", default="kinematic")
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    preload()
    draw, count, began = random.Random(given.seed), Counter[str](), time.monotonic()
    with tempfile.TemporaryDirectory() as temporary:
        folder = make_example("shel", Path(temporary) / "shel").root
        with served(folder, given.fidelity):
            while count["killed while it ran"] < given.kills:
                goal = GOALS[sum(count.values()) % len(GOALS)]
                if not killed_at(folder, goal, draw.randint(1, 60)):
                    count["ended first"] += 1
                    if not told(folder):
                        print((folder / "out.txt").read_text())
                        return 1
                    continue
                run, going, wrong = asyncio.run(attached(folder, max(told(folder), default=0)))
                wrong += committed(folder, run)
                count["killed while it ran" if going else "killed after its end"] += 1
                count["wrong"] += bool(wrong)
                if wrong:
                    print(f"run {run} to {goal}: {'; '.join(wrong)}", flush=True)
    told_counts = ", ".join(f"{n} {what}" for what, n in sorted(count.items()))
    print(f"links ({given.fidelity}): {told_counts}; {count['wrong']} wrong; {time.monotonic() - began:.0f} s")
    return 1 if count["wrong"] else 0


if __name__ == "__main__":
    sys.exit(main())
