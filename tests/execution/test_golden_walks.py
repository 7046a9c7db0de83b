"""What runs do, kept as text: see `kept`. Random graphs of operations that fail, are tried again, interrupted, put back
and stopped; then plans on the simulated bench on which things go wrong."""

from __future__ import annotations

import asyncio
import random
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from benches import plan_to, run, shel, sim

sys.path.append(str(Path(__file__).resolve().parent.parent))

from kept import differs

from pico.diagnostics import error
from pico.execution.executor import Dispatch, Executor
from pico.model.observation import ObservedComponent
from pico.model.operation import Operation, OperationResult, Reason
from pico.model.plan import Plan
from pico.model.pose import Pose
from pico.model.trace.event import Event

CODES = ("timeout", "jammed", "dropped", "misplaced", "blocked", "stopped", "put-back")


def operations(rng: random.Random) -> list[Operation]:
    """Up to nine operations, each after some of those before it, that share an arm and two parts; in any order."""
    found = []
    for n in range(rng.randint(3, 9)):
        primitive = rng.choice(("move", "move", "stow", "set", "set", "home", "park", "operator"))
        arguments = {"irreversible": True} if rng.random() < 0.1 else {}
        found.append(Operation(
            id=f"op{n}", primitive=primitive, component=f"p{n % 3}", arguments=arguments,
            after=tuple(f"op{e}" for e in range(n) if rng.random() < 0.25),
            resources=tuple(r for r in ("arm", f"p{n % 3}") if rng.random() < 0.6), reason=Reason(kind="changed"),
        ))  # fmt: skip
    rng.shuffle(found)
    return found


def ended(rng: random.Random, dispatch: Dispatch, smooth: float) -> OperationResult:
    if rng.random() < smooth:
        return OperationResult(key=dispatch.key, outcome="done")
    code = rng.choice(CODES)
    stands = ObservedComponent(pose=Pose(rng.randrange(9), 1, 2), presence=rng.choice(("seen", "seen", "toppled")))
    return OperationResult(
        key=dispatch.key, outcome=rng.choice(("failed", "failed", "failed", "unknown")),
        error=error(code, code) if rng.random() < 0.9 else None, after=rng.choice((stands, stands, None)),
    )  # fmt: skip


def walked(seed: int) -> Iterator[str]:
    rng = random.Random(seed)
    executor = Executor(operations(rng), "r", stop_on_error=seed % 4 == 0)
    yield f"  order {' '.join(o.id for o in executor.graph.operations)}"
    running, smooth = [], rng.choice((0.5, 0.8))
    while True:
        due = executor.due()
        yield f"  due {' '.join(d.key for d in due)}"
        for dispatch in due:
            if rng.random() < 0.05:
                executor.refused(dispatch)
                yield f"  refused {dispatch.key}"
            else:
                running.append(dispatch)
        if not running:
            break
        over = running.pop(rng.randrange(len(running)))
        if rng.random() < 0.04:
            executor.interrupt()
            yield "  interrupted"
        result = ended(rng, over, smooth)
        then = executor.over(over, result)
        code = result.error.code if result.error else "no word"
        again = f"again {then.again.key} {then.again.operation.arguments}" if then.again else ""
        skipped = " ".join(o.id for o in then.skipped)
        yield f"  {over.key} {over.operation.primitive} {result.outcome} {code}: {again} skips {skipped}"
        running += [then.again] if then.again else []
    yield f"  idle {executor.idle}, interrupted {executor.interrupted}, broken {executor.broken}"
    yield f"  {' '.join(executor.graph.status.values())}, waiting {' '.join(o.id for o in executor.graph.waiting())}"


def test_walks_of_random_graphs_are_the_ones_kept() -> None:
    lines = [line for seed in range(60) for line in (f"seed {seed}", *walked(seed))]
    assert not differs("walks.txt", "\n".join(lines) + "\n")


SETUP, C3 = shel("gantry")


def happened(events: list[Event]) -> Iterator[str]:
    for event in (e for e in events if e.kind != "operation_progress"):
        data = {k: v for k, v in event.data.items() if k not in ("plan", "diagnostic")}
        code = event.data.get("diagnostic", {}).get("code", "")
        yield f"  {event.seq} {event.time:.3f} {event.kind} {event.operation} {event.component} {code} {data}"


def faulty(seed: int, folder: Path, planned: list[Plan]) -> Iterator[str]:
    """The events of one run on a bench on which much goes wrong, now and then stopped or ended by the first failure,
    and what its journal says in the end."""
    settings = replace(SETUP.lab.sim, seed=seed, faults={"all": 0.15})
    rough = replace(SETUP, lab=replace(SETUP.lab, sim=settings))
    bench = sim(rough, folder)
    events: list[Event] = []

    def cancelled() -> bool:
        return seed % 3 == 2 and sum(e.kind == "operation_done" for e in events) >= 2

    async def go() -> None:
        if not planned:
            planned.append(await plan_to(sim(SETUP, folder / "plan"), C3))
        more = {"stop_on_error": seed % 3 == 1, "cancelled": cancelled}
        plan = replace(planned[0], lab=replace(planned[0].lab, digest=rough.digest())).sealed()
        async for event in run(plan, bench, run_id="r1", **more):
            events.append(event)

    asyncio.run(go())
    yield from happened(events)


def test_runs_on_a_bench_where_much_goes_wrong_are_the_ones_kept(tmp_path: Path) -> None:
    planned: list[Plan] = []
    lines = [
        line for seed in range(6) for line in (f"seed {seed}", *faulty(seed, tmp_path / str(seed), planned))
    ]  # fmt: skip
    assert not differs("runs.txt", "\n".join(lines) + "\n", 1e-6)
