"""Faults by seed and rate: each kind does what its name says, is said, and is got over."""

from __future__ import annotations

import asyncio
from dataclasses import replace
from pathlib import Path

import pytest
from bench_at import bench_at
from benches import apply, execute, plan_to, shel, sim
from results import RunResult
from tables import change_world

from pico.backends.sim.faults import KINDS, Faults, parse, save_faults
from pico.backends.sim.hand import nudge, power_cycle, remove
from pico.backends.sim.store import load_world
from pico.diagnostics import PicoError
from pico.model.diff import diff_observed
from pico.model.plan import Plan

SETUP, C3 = shel("gantry")


def run_with(root: Path, kind: str, rate: float = 1.0, seed: int = 1) -> tuple[Plan, RunResult]:
    save_faults(bench_at(root), Faults(rates={kind: rate}, seed=seed))
    planned, result, _ = apply(sim(SETUP, root), C3, "r1")
    return planned, result


def told(result: RunResult, kinds: set[str]) -> set[str]:
    return {r.data["diagnostic"]["code"] for r in result.operations.values() if r.outcome in kinds}


def got_over(root: Path) -> None:
    """Without faults the next applies reach the goal; what fell over a hand puts upright."""
    save_faults(bench_at(root), Faults())
    for number in range(3):
        bench = sim(SETUP, root)
        for name, part in asyncio.run(bench.observe()).components.items():
            if part.presence in ("toppled", "missing"):
                change_world(SETUP, root, "test", lambda w, n=name: nudge(SETUP, remove_(w, n), n))
        planned = asyncio.run(plan_to(bench, C3))
        if not planned.operations:
            return
        asyncio.run(execute(bench, planned, f"again{number}"))
    assert diff_observed(SETUP, asyncio.run(sim(SETUP, root).observe()), C3) == ()


def remove_(world, name):  # type: ignore[no-untyped-def]
    return world if world.components[name].presence == "missing" else remove(SETUP, world, name)


@pytest.mark.parametrize(
    ("kind", "outcomes", "codes"),
    [
        ("drop", {"failed"}, {"dropped"}),
        ("slip", {"failed"}, {"misplaced"}),
        ("jam", {"failed"}, {"jammed"}),
        ("camera", {"unknown"}, {"unseen"}),
        ("timeout", {"failed"}, {"timeout"}),
        ("reading", set(), set()),
        ("slow", set(), set()),
    ],
)
def test_each_fault_is_said_and_got_over(tmp_path: Path, kind: str, outcomes: set[str], codes: set[str]) -> None:
    found: set[str] = set()
    for seed in range(4):
        root = tmp_path / str(seed)
        planned, result = run_with(root, kind, seed=seed)
        found |= told(result, {"failed", "unknown"}) - {"hand-full"}
        assert {r.outcome for r in result.operations.values()} <= {"done", "failed", "unknown", "skipped"}
        assert result.done + result.failed + result.unknown + result.skipped == len(planned.operations)
        assert result.outcome == ("done" if result.done == len(planned.operations) else "failed")
        got_over(root)
    assert codes <= found
    assert bool(found) == bool(codes) or kind in ("slip", "camera")


def test_the_same_seed_has_the_same_faults_and_another_has_others(tmp_path: Path) -> None:
    told_ = []
    for name, seed in (("a", 1), ("b", 1), ("c", 2), ("d", 3)):
        _, result = run_with(tmp_path / name, "all", 0.6, seed)
        told_.append([(k, r.outcome) for k, r in result.operations.items()])
    assert told_[0] == told_[1]
    assert told_[2] != told_[0] or told_[3] != told_[0]


def test_no_rate_no_fault_and_nonsense_is_refused() -> None:
    assert Faults().of("move", "1/op1/1") is None
    assert parse(["drop=0.05", "seed=3"], 1) == Faults(rates={"drop": 0.05}, seed=3)
    assert parse(["off"], 1) == Faults()
    for words, text in ((["drip=1"], "drop"), (["drop=2"], "share"), (["drop=x"], "share")):
        with pytest.raises(PicoError) as caught:
            parse(words, 1)
        assert text in caught.value.diagnostics[0].hint


def test_a_rate_is_a_share_of_the_operations() -> None:
    faults = Faults(rates={"all": 0.05})
    hits = [faults.of("move", f"1/op{n}/1") for n in range(4000)]
    assert 140 < sum(f is not None for f in hits) < 260
    assert {f.kind for f in hits if f} == {kind for kind, primitives in KINDS.items() if "move" in primitives}


def test_after_a_power_failure_axes_are_homed_first_and_the_shutter_is_closed(tmp_path: Path) -> None:
    apply(sim(SETUP, tmp_path), C3, "r1")
    change_world(SETUP, tmp_path, "test", lambda w: power_cycle(SETUP, w))
    world, _ = load_world(SETUP, bench_at(tmp_path))
    assert world.components["p1"].values["angle"].status == "unknown"
    assert world.components["laser"].values["shutter"].value == "closed"
    planned = asyncio.run(plan_to(sim(SETUP, tmp_path), C3))
    steps = [(op.primitive, op.component) for op in planned.operations]
    assert steps.index(("home", "p1")) < steps.index(("set", "p1"))
    assert asyncio.run(execute(sim(SETUP, tmp_path), planned, "r2"))[0].outcome == "done"


def test_the_lab_can_say_the_faults(tmp_path: Path) -> None:
    rough = replace(SETUP, lab=replace(SETUP.lab, sim=replace(SETUP.lab.sim, faults={"drop": 1.0})))
    _, result, _ = apply(sim(rough, tmp_path), C3, "r1")
    assert told(result, {"failed"}) >= {"dropped"}
    with pytest.raises(ValueError, match="share from 0 to 1"):
        replace(SETUP.lab.sim, faults={"drop": 5.0})


def test_what_slipped_is_told_as_tried_again_and_what_stops_everything_leaves_the_rest(tmp_path: Path) -> None:
    from benches import run

    save_faults(bench_at(tmp_path), Faults(rates={"slip": 1.0}))
    bench = sim(SETUP, tmp_path)

    async def go():  # type: ignore[no-untyped-def]
        planned = await plan_to(bench, C3)
        events = run(planned, bench, run_id="r1", stop_on_error=True)
        return [e async for e in events]

    events = asyncio.run(go())
    again = [e.data["attempt"] for e in events if e.kind == "operation_retried"]
    assert again[:2] == [2, 3]
    stopped = [e for e in events if e.kind == "operation_skipped" and e.data.get("stopped")]
    assert stopped
    begun_after = [e.kind for e in events[[e.kind for e in events].index("operation_failed") :]]
    assert "operation_started" not in begun_after
