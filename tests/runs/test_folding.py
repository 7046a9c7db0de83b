"""Runs that are folded into one come back as they were, whatever ran between them."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from run_documents import run_document

from pico.diagnostics import Diagnostic
from pico.history.lab.folder import LabFolder
from pico.model.setup import Setup
from pico.model.state import LabState
from pico.model.trace.run import Cause, Run, Seen, TraceEvent
from pico.runs import folding
from pico.runs.document import RecordedRun
from pico.runs.files import FOLDED, MEASUREMENTS, TRACE, numbered, run_files, run_folder
from pico.runs.folding import fold, folded_ids, unfolded
from pico.runs.operations import operations
from pico.runs.reading import read_document, read_events

A = "sha256:" + "a" * 64
SET = ("single", "pico apply", "done")
DONE = st.sampled_from([SET, SET, SET, ("single", "python", "done"), ("single", "pico apply", "failed")])
KINDS = DONE | st.sampled_from([("apply", "pico apply", "done"), ("bisect", "pico apply", "done")])
SEEN = st.fixed_dictionaries({"p1": st.integers(0, 2), "p2": st.integers(0, 1)})


@pytest.fixture(scope="module")
def setup(case_study: Path) -> Setup:
    return LabFolder(case_study).setup


def ran(number: int, kind: tuple[str, str, str], seen: dict[str, int], steps: int = 1, **fields: Any) -> RecordedRun:
    """Return a run of `steps` operations after which `seen` was observed, by component."""
    cause, holder, outcome = kind
    at = f"2026-11-21T10:{number // 60:02}:{number % 60:02}Z"
    trace = numbered(
        [
            TraceEvent(t=i / 4, at=at, seq=0, kind=word, operation=f"op{i}", attempt=1, component="p1", data={"n": i})
            for i in range(steps)
            for word in ("intent", "started", "done")
        ]
    )
    measured = [TraceEvent(t=0.0, at=at, seq=0, kind="measurement", component="p1", data={"number": number})]
    parts = (
        TraceEvent(t=trace[-1].t, at=at, seq=0, kind="observation", component=name, data={"angle": value})
        for name, value in sorted(seen.items())
    )
    document = run_document(
        id=f"{at.replace('-', '').replace(':', '')}-{number:06x}", number=number, started_at=at, ended_at=at,
        outcome=outcome, cause=Cause(kind=cause), observed=Seen(at=at, state=A), goal=f"set {number % 4}",
        tally={"done": steps, "failed": 0, "unknown": 0, "skipped": 0}, **fields,
    )  # fmt: skip
    state = LabState(lab="shel")
    return RecordedRun(
        document=document, before=state, after=state, trace=trace, measurements=numbered([*measured, *parts]),
        holder=holder,
    )  # fmt: skip


def written(run: RecordedRun) -> dict[str, bytes]:
    return run_files(run.document, run.trace, run.measurements)


def read_back(files: dict[str, bytes], whole: Run) -> RecordedRun:
    folder = run_folder(whole)
    document = read_document("run.json", files[f"{folder}/run.json"], whole.id)
    assert isinstance(document, Run)
    trace, measured = (read_events(name, files[f"{folder}/{name}"]) for name in (TRACE, MEASUREMENTS))
    return RecordedRun(document=document, trace=trace, measurements=measured)


@given(st.lists(st.tuples(KINDS, SEEN, st.integers(1, 3)), max_size=14))
@settings(max_examples=60, deadline=None)
def test_every_run_comes_back_in_its_order_with_its_digests_and_operations(
    setup: Setup, drawn: list[tuple[tuple[str, str, str], dict[str, int], int]]
) -> None:
    runs = [ran(n, *one) for n, one in enumerate(drawn)]
    found = fold(setup, runs)
    back: list[RecordedRun] = []
    for run in found:
        read = read_back(written(run), run.document)
        back += unfolded(read) or [read]
        if run.document.folded:
            assert folded_ids(written(run)[f"{run_folder(run.document)}/run.json"]) == tuple(
                one.document.id for one in unfolded(read)
            )
            assert sum(run.document.tally.values()) == len(operations(run.trace))
    assert [run.document.id for run in back] == [run.document.id for run in runs]
    assert [written(run) for run in back] == [written(run) for run in runs]
    assert [operations(run.trace) for run in back] == [operations(run.trace) for run in runs]
    assert not any(run.diagnostics for run in back)
    for one, other in pairwise(found):  # nothing that could be folded is left
        last, first = ((unfolded(run) or [run])[i].document for run, i in ((one, -1), (other, 0)))
        kinds = [drawn[document.number][0] for document in (last, first)]
        assert kinds[0] != kinds[1] or kinds[0][0] != "single" or kinds[0][2] != "done"


def test_what_is_too_much_for_a_commit_is_folded_in_pieces(setup: Setup, monkeypatch: pytest.MonkeyPatch) -> None:
    runs = [ran(n, SET, {"p1": n}) for n in range(9)]
    monkeypatch.setattr(folding, "MOST", 4)
    assert [len(run.document.folded) for run in fold(setup, runs)] == [4, 4, 0]
    large = [replace(run, trace=(replace(run.trace[0], data={"x": "x" * (FOLDED // 2)}),)) for run in runs[:3]]
    assert [run.document.id for run in fold(setup, large)] == [run.document.id for run in large]


def test_runs_of_another_bench_evidence_or_commit_are_not_folded(setup: Setup) -> None:
    first = ran(0, SET, {"p1": 1})
    for other in (
        ran(1, SET, {"p1": 1}, parent="c" * 40),
        ran(1, SET, {"p1": 1}, evidence="physics"),
        ran(1, SET, {"p1": 1}, environment={"backend": "bench"}),
        ran(1, SET, {"p1": 1}, resumed=1),
        ran(1, SET, {"p1": 1, "p2": 1}),
    ):
        assert fold(setup, [first, other]) == (first, other)


def test_a_run_in_a_fold_that_somebody_changed_is_named(setup: Setup) -> None:
    (whole,) = fold(setup, [ran(n, SET, {"p1": n}) for n in range(3)])
    files = written(whole)
    path = f"{run_folder(whole.document)}/{TRACE}"
    files[path] = files[path].replace(b'"n":0', b'"n":1', 1)
    first, *others = unfolded(read_back(files, whole.document))
    assert [d.summary for d in first.diagnostics] == [
        f"trace.jsonl of {whole.document.id} does not hold what {first.document.id} did"
    ]
    assert not any(run.diagnostics for run in others)


@pytest.mark.parametrize(
    "told", [lambda f: [], lambda f: [{}], lambda f: [f[0], f[0], f[2]], lambda f: [f[0] | {"seconds": "nan"}, *f[1:]]]
)
def test_a_fold_that_does_not_tell_each_of_its_runs_is_damaged(setup: Setup, told: Callable[[Any], Any]) -> None:
    (whole,) = fold(setup, [ran(n, SET, {"p1": n}) for n in range(3)])
    path = f"{run_folder(whole.document)}/run.json"
    content = json.loads(written(whole)[path])
    assert not isinstance(read_document(path, json.dumps(content).encode(), whole.document.id), Diagnostic)
    content["folded"] = told(content["folded"])
    found = read_document(path, json.dumps(content).encode(), whole.document.id)
    assert isinstance(found, Diagnostic) and "each of the runs that are folded" in found.summary + found.detail
