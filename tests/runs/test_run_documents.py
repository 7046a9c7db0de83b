"""A run as files: what is written is read, and what is damaged is said by name, whatever it is."""

from __future__ import annotations

import gzip
import hashlib
import json
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from run_documents import DOCUMENTS, EVENTS, run_document

from pico.diagnostics import Diagnostic
from pico.model.trace.run import Run, TraceEvent
from pico.runs.files import INLINE, intact, read_runs, run_files, run_folder
from pico.runs.reading import read_events
from pico.runs.trace import artifacts

FOLDER = "runs/2026/11/20261121T101155Z-af9bba"


def events(number: int, text: str = "x") -> list[TraceEvent]:
    return [TraceEvent(t=i / 8, seq=i + 1, kind="done", data={"text": text}) for i in range(number)]


@given(DOCUMENTS, EVENTS, EVENTS)
@settings(max_examples=60, deadline=None)
def test_what_is_written_is_read(document: Run, trace: list[TraceEvent], measured: list[TraceEvent]) -> None:
    wrong: list[Diagnostic] = []
    files = run_files(document, trace, measured)
    (read,) = read_runs(files, wrong)
    assert wrong == []
    assert run_files(read, trace, measured) == files
    assert (read.id, read.changes, read.tally) == (document.id, document.changes, document.tally)
    assert intact(read, files)
    folder = run_folder(read)
    assert read_events("t", files[f"{folder}/trace.jsonl"], wrong) == tuple(trace)
    assert read_events("m", files[f"{folder}/measurements.jsonl"], wrong) == tuple(measured)
    assert wrong == []


def test_files_are_canonical_lines_in_the_folder_of_their_month() -> None:
    files = run_files(run_document(), events(2))
    assert sorted(files) == [f"{FOLDER}/{name}" for name in ("measurements.jsonl", "run.json", "trace.jsonl")]
    for path, data in files.items():
        assert b"\r" not in data
        for line in data.decode().splitlines():
            assert line == json.dumps(json.loads(line), sort_keys=True, separators=(",", ":"), ensure_ascii=False), path
    assert files[f"{FOLDER}/trace.jsonl"].count(b"\n") == 2


def test_the_hashes_are_those_of_the_files_beside() -> None:
    files = run_files(run_document(), events(3))
    told = json.loads(files[f"{FOLDER}/run.json"])["files"]
    assert set(told) == {"trace.jsonl", "measurements.jsonl"}
    for name, said in told.items():
        data = files[f"{FOLDER}/{name}"]
        assert said == {"sha256": hashlib.sha256(data).hexdigest(), "size": len(data)}


def test_what_is_too_big_for_a_commit_is_kept_packed_elsewhere() -> None:
    kept: list[bytes] = []
    trace = events(2000, "y" * 40)
    files = run_files(run_document(), trace, keep=kept.append)
    assert f"{FOLDER}/trace.jsonl" not in files
    assert all(len(data) <= INLINE for data in files.values())
    (read,) = read_runs(files)
    assert intact(read, files)
    (artifact,) = read.artifacts
    assert (artifact.name, artifact.size) == ("trace.jsonl.gz", len(kept[0]))
    assert artifact.sha256 == hashlib.sha256(kept[0]).hexdigest()
    assert read_events("t", gzip.decompress(kept[0])) == tuple(trace)
    assert run_files(run_document(), trace, keep=kept.append) == files  # the same bytes again


@pytest.mark.parametrize("name", ["trace.jsonl", "measurements.jsonl"])
def test_a_file_that_was_changed_or_taken_away_is_named(name: str) -> None:
    files = run_files(run_document(), events(2), events(1))
    (read,) = read_runs(files)
    for changed in (files | {f"{FOLDER}/{name}": b"{}\n"}, {p: d for p, d in files.items() if not p.endswith(name)}):
        wrong: list[Diagnostic] = []
        assert not intact(read, changed, wrong)
        (found,) = wrong
        assert f"{FOLDER}/{name}" in found.summary


def altered(**fields: Any) -> bytes:
    content = json.loads(run_files(run_document())[f"{FOLDER}/run.json"])
    return json.dumps(content | fields).encode()


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (b"", "damaged"),
        (b"\xff\xfe", "damaged"),
        (b"[" * 100_000, "damaged"),
        (b'{"schema": "pico.run/v1"}', "damaged"),
        (b"version https://git-lfs.github.com/spec/v1\n", "damaged"),
        (b"<<<<<<< ours\n", "damaged"),
        (b" " * (1 << 21), "damaged"),
        (b"[]", "no pico.run/v1"),
        (b'{"schema": "pico.run/v2"}', "of a newer PICO (pico.run/v2"),
        (altered(id="another"), "damaged"),
        (altered(state_after="sha256:0"), "damaged"),
        (altered(started_at="yesterday"), "damaged"),
        (altered(evidence="certain"), "damaged"),
        (altered(files={"x": {"sha256": "../../etc", "size": 1}}), "damaged"),
        (altered(seconds=float("nan")), "damaged"),
    ],
)
def test_a_damaged_document_is_said_by_name(data: bytes, said: str) -> None:
    wrong: list[Diagnostic] = []
    good = run_files(run_document(id="20261121T101156Z-000000"))
    assert [d.id for d in read_runs({f"{FOLDER}/run.json": data, **good}, wrong)] == ["20261121T101156Z-000000"]
    (found,) = wrong
    assert found.summary.startswith(f"{FOLDER}/run.json is ")
    assert said in found.summary


def test_what_a_newer_pico_adds_is_passed_over() -> None:
    (read,) = read_runs({f"{FOLDER}/run.json": altered(weather="fine")})
    assert read.id == "20261121T101155Z-af9bba"


@given(DOCUMENTS, st.integers(0, 10**6), st.binary(max_size=4), st.integers(0, 8))
@settings(max_examples=100, deadline=None)
def test_whatever_happens_to_the_bytes_nothing_is_raised(document: Run, at: int, put: bytes, gone: int) -> None:
    files = run_files(document)
    path = f"{run_folder(document)}/run.json"
    place = at % len(files[path])
    damaged = files[path][:place] + put + files[path][place + gone :]
    wrong: list[Diagnostic] = []
    assert len(read_runs({**files, path: damaged}, wrong)) + len(wrong) == 1


@given(st.binary(max_size=200))
@settings(max_examples=100, deadline=None)
def test_lines_that_are_no_events_are_passed_over_and_the_first_is_named(data: bytes) -> None:
    good = b'{"kind":"done","seq":1,"t":0.5}\n'
    wrong: list[Diagnostic] = []
    found = read_events("runs/x/trace.jsonl", good + b"nonsense\n" + data + b"\n" + good, wrong)
    assert [found[0], found[-1]] == [TraceEvent(t=0.5, seq=1, kind="done")] * 2
    (said,) = wrong
    assert "runs/x/trace.jsonl, line 2" in said.summary


def test_other_files_below_runs_are_none_of_ours() -> None:
    files = {"runs/notes.md": b"x", f"{FOLDER}/preview/a.png": b"x", "runs/2026/run.json": b"x", "state/run.json": b"x"}
    wrong: list[Diagnostic] = []
    assert read_runs(files, wrong) == ()
    assert wrong == []


def test_what_was_tried_for_goals_that_came_first_goes_with_the_run_as_well() -> None:
    def points(name: str) -> dict[str, Any]:
        return {"sha256": hashlib.sha256(name.encode()).hexdigest(), "size": 8, "shape": [1, 1], "dtype": "float64"}

    stages = [{"goal": "light found", "points": points("a")}, {"goal": "dark"}]
    data = {"goal": "centred", "points": points("b"), "stages": stages}
    ended = TraceEvent(t=1.0, seq=3, kind="done", operation="op4", component="ly_150", data={"data": data})
    found = artifacts([ended])
    assert [one.name for one in found] == ["op4-ly_150-light-found.points.npy", "op4-ly_150-points.npy"]
    assert [one.sha256 for one in found] == [points("a")["sha256"], points("b")["sha256"]]
