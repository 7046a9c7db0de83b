"""Runs that go wrong or are cut short, and what the journal costs: `python benchmarks/runs.py --faults 200
--interrupts 200 --pairs 100 --journal 2000 --scheduler 3`.

`--faults`: runs on the simulated bench of the case study with a fault in 5 % of the primitives; each must end at its
goal or in a true report. `--interrupts`: Ctrl-C at random instants of whole `pico apply` commands, while they plan and
while they move; wall and CPU seconds until they ended. `--pairs`: two `pico apply` at once; exactly one may move.
`--journal`: operations with and without records. `--scheduler`: trials of 200 operations of 0.1 s on 10 resources,
beside the ideal 2.0 s. Both on the disk of this repository, or in TMPDIR.
"""

from __future__ import annotations

import argparse
import asyncio
import os
import random
import signal
import statistics
import sys
import tempfile
import time
from collections import Counter
from contextlib import suppress
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "benchmarks"), str(ROOT / "tests" / "execution")]


def faulty(runs: int, rate: float) -> int:
    """Apply with faults; return how many reports were not true."""
    from kills import REVISIONS

    from pico.bench.bench import Bench, new_lab

    draw, count = random.Random(1), Counter[str]()
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary) / "shel"
        new_lab(folder, "shel")
        bench = Bench.open(folder)
        number = 0
        while sum(count[k] for k in ("done", "failed", "interrupted")) < runs:
            number += 1
            bench.sim.faults([f"all={rate}", f"seed={number}"])
            goal = draw.choice(REVISIONS)
            before = bench.observe()
            plan = bench.plan(goal)
            if not plan.operations:
                continue
            report = bench.apply(plan)
            after = bench.observe()
            count[report.outcome] += 1
            lies = list(untrue(bench, plan, report, before, after))
            count["untrue"] += bool(lies)
            for lie in lies:
                print(f"run {number} to {goal}: {lie}", flush=True)
            for name, part in after.components.items():
                if part.presence in ("toppled", "missing"):
                    count["set upright by hand"] += 1
                    if part.presence == "toppled":
                        bench.sim.remove(name)
                    bench.sim.faults(["off"])
                    bench.sim.nudge(name)
        bench.close()
    print(f"faults in {100 * rate:g} % of the primitives: " + ", ".join(f"{n} {k}" for k, n in sorted(count.items())))
    return count["untrue"]


def untrue(bench: Any, plan: Any, report: Any, before: Any, after: Any) -> Any:
    """Yield what a report does not say, or says though it is not so."""
    goal = plan.target.revision
    if int(report.exit_code) == 0 and bench.plan(goal).operations:
        yield "it says that the goal is reached"
    if int(report.exit_code) != 0 and not (report.remaining or report.absent or report.diagnostics):
        yield "it fails and does not say why"
    said = {d.address.split(".")[0] for d in report.diagnostics}
    for name, part in after.components.items():
        if part.presence != "seen" and name not in report.absent:
            yield f"{name} is {part.presence}, and the report does not say so"
        fell = part.presence in ("toppled", "missing") and before.components[name].presence == "seen"
        if fell and name not in said:
            yield f"{name} fell, and nothing says that it was dropped"
    held = {robot.holding for robot in after.robots.values() if robot.holding}
    if held != set(report.held.values()):
        yield f"hands hold {held}, the report says {report.held}"


def interrupts(count_: int, fidelity: str) -> int:
    """Press Ctrl-C; return how many did not end well."""
    from kills import REVISIONS, forked, preload

    from pico.bench.bench import Bench, new_lab

    preload()
    draw, count = random.Random(2), Counter[str]()
    walls, spent = [], []
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary) / "shel"
        new_lab(folder, "shel")
        while count["pressed"] < count_:
            goal = draw.choice(REVISIONS)
            child = forked(folder, "apply", goal, "--auto-approve", "--fidelity", fidelity)
            if draw.random() < 0.7:  # the others while it loads, looks and plans
                until_it_moves(folder, child)
            time.sleep(draw.uniform(0.0, 0.5 if fidelity == "kinematic" else 5.0))
            before = cpu(child)
            pressed = time.monotonic()
            with suppress(ProcessLookupError):
                os.kill(child, signal.SIGINT)
            _, status, usage = os.wait4(child, 0)
            code = os.waitstatus_to_exitcode(status)
            if code == 0:
                count["ended before"] += 1
                continue
            count["pressed"] += 1
            count["before anything moved"] += "Interrupted" not in (folder / "out.txt").read_text()
            walls.append(time.monotonic() - pressed)
            spent.append(usage.ru_utime + usage.ru_stime - before)
            with Bench.open(folder) as bench:
                left = bench.observe().robots["arm1"].holding
                count["held"] += left is not None
                bad = code != 130 or left is not None
                bad |= bench.apply(goal).outcome != "done" or bool(bench.plan(goal).operations)
            count["not well"] += bad
            if bad:
                print(
                    f"{goal}: exit code {code}, holding {left}: {(folder / 'out.txt').read_text()[-300:]}", flush=True
                )
    said = ", ".join(f"{n} {k}" for k, n in sorted(count.items()))
    print(
        f"Ctrl-C ({fidelity}): {said}; to the end of the process {statistics.median(walls):.2f} s wall (median), "
        f"{max(walls):.2f} s (greatest); {statistics.median(spent):.2f} and {max(spent):.2f} CPU s", flush=True,
    )  # fmt: skip
    return count["not well"]


def until_it_moves(folder: Path, process: int) -> None:
    """Wait until a process has taken the bench, or is over."""
    while not (folder / ".pico/benches/sim" / "holder.json").exists() and cpu(process) < 60:
        if os.waitid(os.P_PID, process, os.WEXITED | os.WNOHANG | os.WNOWAIT) is not None:
            return
        time.sleep(0.002)


def cpu(process: int) -> float:
    """Return the CPU seconds that a process has spent."""
    try:
        fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return 0.0
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def pairs(trials: int) -> int:
    """Start two commands at once; return in how many trials not exactly one moved."""
    from kills import forked

    from pico.backends.sim.session import WorldSession
    from pico.bench.bench import new_lab
    from pico.runs.journal import Journal

    tell = WorldSession._tell

    def slowly(self: WorldSession, *rest: Any) -> None:
        time.sleep(0.03)
        tell(self, *rest)

    WorldSession._tell = slowly  # type: ignore[method-assign]
    wrong = 0
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary) / "shel"
        new_lab(folder, "shel")
        for number in range(trials):
            goal = ("E1-3", "C1")[number % 2]
            words = ("apply", goal, "--auto-approve")
            both = [forked(folder, *words, out=f"out{n}.txt") for n in range(2)]
            codes = [os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) for child in both]
            texts = [(folder / f"out{n}.txt").read_text() for n in range(2)]
            journal = Journal(folder / ".pico/benches/sim" / "journal.sqlite")
            runs = len(journal.runs())
            journal.close()
            names = [f"process {both[1 - n]}" in texts[n] for n in range(2) if codes[n] == 5]
            if sorted(codes) != [0, 5] or names != [True] or runs != number + 1:
                wrong += 1
                print(
                    f"trial {number}: exit codes {codes}, {runs} runs: {texts[0][-200:]} {texts[1][-200:]}", flush=True
                )
    WorldSession._tell = tell  # type: ignore[method-assign]
    print(f"two at once: {trials} trials, {wrong} in which not exactly one moved and the other named it", flush=True)
    return wrong


def journal_cost(operations: int) -> None:
    """Print what the records of an operation cost, beside the same walk without them."""
    from crashing import Chaos, CutJournal, Toy
    from killing import Table

    from pico.edge.attempts import Attempts
    from pico.model.operation import Operation, Reason
    from pico.model.pose import Pose
    from pico.runs.journal import Journal

    class Unwritten(CutJournal):
        """A journal that writes nothing."""

        def intend(self, *_: Any) -> None:
            return None

        started = ended = intend  # type: ignore[assignment]

    class Still(Table):
        """A table on which nothing takes any time."""

        def act(self, op: Operation, key: str) -> Any:
            yield 0.0
            return {}

        def store(self) -> None:
            return None

    def seconds(journal: Journal) -> list[float]:
        chaos = Chaos(random.Random(1), healed=True)
        table = Still(chaos, {"p1": Pose(0, 0)}, {"p1": 0.0, "p2": 0.0})
        attempts, found = Attempts(journal, Toy(table), 1), []
        for n in range(operations):
            op = Operation(
                id=f"op{n}", primitive="set", component="p1", arguments={"tunable": "angle", "to": n % 90},
                reason=Reason(kind="changed"),
            )  # fmt: skip
            began = time.perf_counter()
            attempts.known(op, f"r/op{n}/1")
            work = attempts.perform(op, f"r/op{n}/1")
            with suppress(StopIteration):
                while True:
                    work.send(None)
            found.append(time.perf_counter() - began)
        return found

    with tempfile.TemporaryDirectory(dir=os.environ.get("TMPDIR", ROOT)) as folder:
        written = seconds(Journal(Path(folder) / "journal.sqlite"))
        unwritten = seconds(Unwritten(Path(":memory:")))
    cost = statistics.median(written) - statistics.median(unwritten)
    more, less = 1000 * statistics.median(written), 1000 * statistics.median(unwritten)
    print(
        f"journal: {1000 * cost:.2f} ms a primitive (median of {operations}: {more:.2f} with, {less:.3f} without), "
        f"95th percentile {1000 * statistics.quantiles(written, n=20)[-1]:.2f} ms; on this disk", flush=True,
    )  # fmt: skip


def scheduler(trials: int) -> None:
    """Print how much longer than the ideal 200 operations of 0.1 s on 10 resources take, journal included."""
    from benches import run
    from crashing import SETUP, Chaos
    from killing import DIGEST, InstantDevice, KilledJournal, Table, instant, lay_out

    from pico.model.observation import live_state
    from pico.model.operation import Operation, OperationResult, Reason
    from pico.model.plan import Base, LabRef, Plan, Target

    operations = tuple(
        Operation(
            id=f"op{n}", primitive="set", component="p1", resources=(f"motor/{n % 10}",), seconds=0.1,
            after=(f"op{n - 10}",) if n >= 10 and n % 3 == 0 else (), arguments={"tunable": "angle", "to": n},
            reason=Reason(kind="changed"),
        )
        for n in range(200)
    )  # fmt: skip

    class Slow(InstantDevice):
        """Each operation takes 0.1 s."""

        async def execute(self, operation: Operation, key: str, began: Any) -> OperationResult:
            began(None)
            await asyncio.sleep(0.1)
            return OperationResult(key=key, outcome="done")

    async def once() -> tuple[float, float]:
        with tempfile.TemporaryDirectory(dir=os.environ.get("TMPDIR", ROOT)) as folder:
            root = Path(folder)
            lay_out(root, 1)
            table = Table.load(root / "table.json", Chaos(random.Random(1), healed=True))
            journal = KilledJournal(root / "journal.sqlite")
            bench = instant(root, table, journal)
            bench.apparatus.device = Slow(table)  # type: ignore[assignment]
            state = live_state(SETUP, table.observe()).as_json()
            plan = Plan(
                lab=LabRef(name="toy", digest=DIGEST), backend="toy", fidelity="toy", base=Base(state=state),
                target=Target(), operations=operations,
            ).sealed()  # fmt: skip
            began, spent = 0.0, time.process_time()
            async for event in run(plan, bench, run_id="r"):
                began = began or (time.perf_counter() if event.kind == "run_started" else 0.0)
            return time.perf_counter() - began, time.process_time() - spent

    found = [asyncio.run(once()) for _ in range(trials)]
    best = min(wall for wall, _ in found)
    print(
        f"scheduler: 200 operations, 10 resources: {best:.2f} s ({100 * (best / 2.0 - 1):.1f} % over the ideal 2.00 s; "
        f"best of {trials}), {min(c for _, c in found):.2f} CPU s", flush=True,
    )  # fmt: skip


def main() -> int:
    """Do what is asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--faults", type=int, default=0)
    parser.add_argument("--rate", type=float, default=0.05)
    parser.add_argument("--interrupts", type=int, default=0)
    parser.add_argument("--fidelity", default="kinematic")
    parser.add_argument("--pairs", type=int, default=0)
    parser.add_argument("--journal", type=int, default=0)
    parser.add_argument("--scheduler", type=int, default=0)
    given = parser.parse_args()
    wrong = faulty(given.faults, given.rate) if given.faults else 0
    wrong += interrupts(given.interrupts, given.fidelity) if given.interrupts else 0
    wrong += pairs(given.pairs) if given.pairs else 0
    if given.journal:
        journal_cost(given.journal)
    if given.scheduler:
        scheduler(given.scheduler)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
