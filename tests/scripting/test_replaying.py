"""A run that is done again on the bench as it is."""

from __future__ import annotations

import json
import shutil
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from commanding import Pico

import pico as library
from pico.model.trace.run import TraceEvent
from pico.scripting.bench import Bench
from pico.scripting.replaying import replay


@pytest.fixture
def bench(case_study: Path, tmp_path: Path) -> Iterator[Bench]:
    shutil.copytree(case_study, tmp_path / "shel")
    with library.open(tmp_path / "shel", fidelity="kinematic") as opened:
        yield opened


def recorded(bench: Bench) -> str:
    with bench.record("scan") as run:
        bench["p2"].move(x=520, y=420, yaw=10)
        for angle in (10, 20):
            bench["p1"].angle = angle
            bench.measure("p1.angle")
    return run.id


def test_what_a_run_did_is_done_again_and_leads_to_the_same(bench: Bench) -> None:
    run = recorded(bench)
    before = bench.live()
    bench.set({"p1.angle": 50})
    bench.move({"p2": "home"})
    found, _ = bench.history.recorded_run(run)
    made = replay(bench, found)
    assert made.report.outcome == "done" and made.of == run
    assert [(one.then, one.now) for one in made.compared] == [(10.0, 10.0), (20.0, 20.0)]
    assert bench["p1"].angle.value == 20.0
    pose, was = bench["p2"].pose, before.components["p2"].pose
    assert pose is not None and was is not None and pose.distance(was) < 0.5
    again, _ = bench.history.recorded_run()
    assert (again.document.cause.kind, again.document.cause.of) == ("recording", run)


def test_what_only_a_search_did_is_refused_before_anything_moves(bench: Bench) -> None:
    recorded(bench)
    found, _ = bench.history.recorded_run()
    sought = {"primitive": "optimize", "arguments": {"goal": "dark"}, "reason": {"kind": "asked"}}
    search = [
        TraceEvent(t=99.0, seq=900 + n, kind=kind, operation="9.op1", attempt=1, component="p1", data=data)
        for n, (kind, data) in enumerate((("intent", sought), ("started", {}), ("done", {"seconds": 1.0})))
    ]
    before = bench.live()
    with pytest.raises(library.PicoError, match=r"optimize of dark .* can't be done again"):
        replay(bench, replace(found, trace=(*found.trace, *search)))
    with pytest.raises(library.PicoError, match="did nothing that could be done again"):
        replay(bench, replace(found, trace=()))
    assert bench.live() == before


def test_the_command_asks_and_sets_the_numbers_side_by_side(bench: Bench, pico: Pico) -> None:
    run = recorded(bench)
    bench.close()
    refused = pico("-C", str(bench.root), "runs", "replay", run)
    assert refused.code == 1 and "nobody can be asked here" in refused.err
    answer = pico("-C", str(bench.root), "runs", "replay", run, "-y")
    assert answer.code == 0 and "set p1.angle → 20" in answer.out and "p1.angle" in answer.out.split("then")[1]
    told = json.loads(pico("-C", str(bench.root), "--json", "runs", "replay", run, "-y").out.splitlines()[-1])
    assert (told["schema"], told["of"], told["report"]["outcome"]) == ("pico.replayed/v1", run, "done")
