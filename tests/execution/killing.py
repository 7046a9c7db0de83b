"""Processes that run the product's executor and journal on an instant bench, and are killed for real.

The table is a file: what has been written into it when the process dies is what has happened. The next process looks,
settles, plans and goes on.
"""

from __future__ import annotations

import asyncio
import json
import os
import random
import signal
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from benches import run
from crashing import PARTS, SETUP, SLOTS, TURNING, Chaos, CutJournal, Goal, Truth, Violation, _is_there, plan_for

from pico.backends.attempt import attempt
from pico.backends.device import Began, Capabilities
from pico.diagnostics import PicoError
from pico.edge.local import LocalEdge
from pico.model.observation import Observation, live_state
from pico.model.operation import Operation, OperationResult
from pico.model.plan import Base, LabRef, Plan
from pico.model.pose import Pose
from pico.model.record import as_json
from pico.model.trace.event import Event
from pico.places.bench import BenchPlace
from pico.runs.journal import Journal

DIGEST = SETUP.digest()
WRONG = 3


class KilledJournal(CutJournal):
    """A journal whose process may be killed just before or just after a record: `at` counts both."""

    at: int = 0

    def _add(self, *args: Any) -> None:
        self._point()
        Journal._add(self, *args)
        self._point()

    def _point(self) -> None:
        self.at -= 1
        if self.at == 0:
            os.kill(os.getpid(), signal.SIGKILL)


@dataclass
class Table(Truth):
    """The table in a file, replaced as a whole with each step of a motion."""

    path: Path = Path()

    def _wait(self) -> float:
        self.save()
        return 0.0

    def save(self) -> None:
        content = {
            "poses": as_json(self.poses), "angles": self.angles, "hands": self.hands, "picked": as_json(self.picked),
            "begun": sorted(self.begun),
        }  # fmt: skip
        fresh = self.path.with_suffix(".tmp")
        fresh.write_text(json.dumps(content))
        fresh.replace(self.path)

    @classmethod
    def load(cls, path: Path, chaos: Chaos) -> Table:
        data = json.loads(path.read_text())
        poses = {n: Pose(**p) for n, p in data["poses"].items()}
        table = cls(chaos, poses, data["angles"], hands=data["hands"], begun=set(data["begun"]), path=path)
        table.picked = {n: Pose(**p) for n, p in data["picked"].items()}
        return table

    def store(self) -> None:
        self.save()


@dataclass
class InstantDevice:
    """A device that takes no time."""

    table: Table

    async def describe(self) -> Capabilities:
        able = frozenset({"move", "set", "home"})
        return Capabilities(
            name="toy", fidelity="toy", evidence="none", lab_digest=DIGEST, primitives=able, robots=("arm1", "arm2")
        )  # fmt: skip

    async def observe(self) -> Observation:
        return self.table.observe()

    async def take(self, token: int, tell: Callable[[Event], None], require: Callable[[], None]) -> None:
        """Nobody else has the file."""

    async def execute(self, operation: Operation, key: str, began: Began) -> OperationResult:
        work = attempt(self.table, operation, key, began)
        while True:
            try:
                next(work)
            except StopIteration as stop:
                result: OperationResult = stop.value
                return result
            await asyncio.sleep(0)

    async def leave(self) -> None:
        """Nothing takes any time."""

    halt = stop = leave

    def watch(self, look: object) -> None:
        """Nobody films it."""

    async def close(self) -> None: ...

    def kept(self) -> bool:
        return True


def instant(root: Path, table: Table, journal: KilledJournal) -> LocalEdge:
    """Return the edge of an instant device, with the journal that kills."""
    edge = LocalEdge(SETUP, BenchPlace(root, "sim"), lambda _: InstantDevice(table))  # type: ignore[arg-type]
    edge.apparatus.journals._journal = journal
    return edge


def goal_of(seed: int) -> Goal:
    draw = random.Random(seed)
    slots = draw.sample(SLOTS, len(PARTS))
    places = {n: (SETUP.lab.slots[s].pose, s) for n, s in zip(PARTS, slots, strict=True)}
    return Goal(places, {n: draw.choice((0.0, 10.0, 45.0)) for n in TURNING}, glue=False)


def lay_out(root: Path, seed: int) -> None:
    """Make a table in `root`."""
    draw, path = random.Random(seed), root / "table.json"
    slots = draw.sample(SLOTS, len(PARTS))
    poses = {n: SETUP.lab.slots[s].pose for n, s in zip(PARTS, slots, strict=True)}
    Table(Chaos(draw), poses, dict.fromkeys(TURNING, 0.0), path=path).save()


def apply(root: Path, seed: int, kill_at: int = 0) -> int:
    """One command of one process: look, settle, plan, run; twice, for the first run may only empty hands."""
    chaos = Chaos(random.Random(time.monotonic_ns()), healed=True)
    journal = KilledJournal(root / "journal.sqlite")
    journal.chaos, journal.at = chaos, kill_at
    table = Table.load(root / "table.json", chaos)
    table.journal = journal
    unwritten = table.begun - {r[0] for r in table.sql("SELECT key FROM records WHERE kind = 'started'")}
    if unwritten:
        raise Violation(f"lost: {unwritten} moved and are not in the journal")
    bench = instant(root, table, journal)
    for _ in range(3):
        base = Base(state=live_state(SETUP, table.observe()).as_json())
        plan = replace(plan_for(table, journal, goal_of(seed), chaos), lab=LabRef(name="toy", digest=DIGEST), base=base)
        if not plan.operations:
            asyncio.run(_settled(bench, table))
            break
        asyncio.run(_run(bench, table, plan.sealed()))
    goal = goal_of(seed)
    reached = all(_is_there(table.poses[n], goal.poses[n]) for n in PARTS) and table.angles == goal.angles
    return 0 if reached and not journal.unsettled() else WRONG


async def _settled(bench: LocalEdge, table: Table) -> None:
    await bench.release(await bench.acquire("test"))
    _check(bench, table)


def _check(bench: LocalEdge, table: Table) -> None:
    for found in bench.custody.settled:
        if (found.outcome == "done") != table.holds(found.operation):
            raise Violation(f"{found.key} is settled as {found.outcome}")


async def _run(bench: LocalEdge, table: Table, plan: Plan) -> None:
    table.plan, table.completed = plan.digest, set()
    id = f"r{time.monotonic_ns()}"
    async for event in run(plan, bench, run_id=id):
        if event.kind == "run_started":
            _check(bench, table)
        if event.kind in ("operation_failed", "operation_unknown"):
            raise Violation(f"{event.operation} failed: {event.data}")


def in_a_process(root: Path, seed: int, *, kill_at: int = 0, kill_after: float = 0.0) -> int | None:
    """Fork, apply there, kill it `kill_after` seconds later where that is given; return its exit code or None."""
    child = os.fork()
    if child == 0:
        try:
            code = apply(root, seed, kill_at)
        except (Violation, PicoError, LookupError, AssertionError, ValueError, TypeError) as exc:
            (root / "wrong.txt").open("a").write(f"seed {seed}: {type(exc).__name__}: {exc}\n")
            code = WRONG
        sys.stdout.flush()
        os._exit(code)
    if kill_after:
        time.sleep(kill_after)
        os.kill(child, signal.SIGKILL)
    _, status = os.waitpid(child, 0)
    return None if os.WIFSIGNALED(status) else os.WEXITSTATUS(status)


@dataclass
class Score:
    kills: int = 0
    ended: int = 0
    checked: int = 0
    wrong: int = 0


def kill_many(root: Path, first: int, kills: int, each: int = 8) -> Score:
    """Kill processes until there were `kills`; after every `each` of them one is left alone and must reach its goal."""
    score, draw, seed = Score(), random.Random(first), first
    lay_out(root, first)
    while score.kills < kills:
        seed += 1
        for _ in range(each):
            around = draw.random() < 0.5
            kill = {"kill_at": draw.randint(1, 36)} if around else {"kill_after": draw.uniform(0.001, 0.035)}
            code = in_a_process(root, seed, **kill)  # type: ignore[arg-type]
            score.kills += code is None
            score.ended += code == 0
            score.wrong += code == WRONG
        code = in_a_process(root, seed)
        score.checked += 1
        score.wrong += code != 0
    return score
