"""Runs as others read them: event-model documents, CSV, pandas; and bluesky, which drives the twin."""

from __future__ import annotations

import csv
import io
import json
import shutil
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from commanding import Pico

import pico as library
from pico.runs import table
from pico.scripting.bench import Bench


@pytest.fixture
def bench(case_study: Path, tmp_path: Path) -> Iterator[Bench]:
    shutil.copytree(case_study, tmp_path / "shel")
    with library.open(tmp_path / "shel", fidelity="kinematic") as opened:
        yield opened


def scanned(bench: Bench) -> str:
    """Turn a polarizer, read it, and return the id of the run."""
    with bench.record("scan") as run:
        for angle in (10, 20, 30):
            bench["p1"].angle = angle
            bench.measure("p1.angle", "p2.angle")
        bench["p1"].move(x=300, y=420, yaw=5)
        bench.measure("p1.angle")
    return run.id


def validated(documents: list[tuple[str, dict[str, object]]]) -> None:
    model = pytest.importorskip("event_model", reason="the extra `bluesky` is not installed")
    for name, document in documents:
        model.schema_validators[model.DocumentNames[name]].validate(document)


def test_documents_of_a_run_are_what_the_event_model_wants(bench: Bench) -> None:
    run = scanned(bench)
    found = list(bench.documents(run))
    validated(found)
    start = found[0][1]
    head = bench.folder.head()
    assert head is not None and (start["pico_commit"], start["pico_run"]) == (head.commit, run)
    assert str(start["pico_plan"]).startswith("sha256:") and found[-1][1]["exit_status"] == "success"
    streams = {d["name"]: d for name, d in found if name == "descriptor"}
    assert set(streams) == {"transitions", "p1-angle", "p2-angle"}
    assert streams["p1-angle"]["data_keys"]["p1-angle"]["units"] == "deg"
    by_stream = {d["uid"]: n for n, d in streams.items()}
    events = [(by_stream[d["descriptor"]], d) for name, d in found if name == "event"]
    assert [d["data"]["p1-angle"] for n, d in events if n == "p1-angle"] == [10.0, 20.0, 30.0, 30.0]
    counts = {n: sum(s == n for s, _ in events) for n in streams}
    assert counts == found[-1][1]["num_events"]
    assert found == list(bench.documents(run))


def test_failed_and_interrupted_runs_have_valid_documents_too(bench: Bench) -> None:
    with pytest.raises(ZeroDivisionError), bench.record("bad"):
        bench["p1"].angle = 10
        raise ZeroDivisionError
    found = list(bench.documents())
    validated(found)
    assert found[-1][1]["exit_status"] == "fail"
    bench.apply("e1")
    validated(list(bench.documents()))


def test_measurements_are_a_table_beside_what_the_run_changed(bench: Bench) -> None:
    table = bench.table(scanned(bench))
    assert len(table) == 7 and table["p1.angle"] == [10.0, 10.0, 20.0, 20.0, 30.0, 30.0, 30.0]
    assert table["p1.pose.x"][-1] == pytest.approx(300, abs=0.5) and table["t"] == sorted(table["t"])
    read = list(csv.DictReader(io.StringIO(table.to_csv())))
    assert [row["measured"] for row in read][:2] == ["p1.angle", "p2.angle"] and float(read[2]["p1.angle"]) == 20.0
    with pytest.raises(KeyError, match="there are seq, t, at"):
        table["nothing"]
    assert "<table" in table._repr_html_() and "7 measurements" in repr(table)


def test_a_table_is_a_frame_of_pandas(bench: Bench) -> None:
    pytest.importorskip("pandas", reason="the extra `pandas` is not installed")
    frame = bench.table(scanned(bench)).to_pandas()
    assert frame[frame.measured == "p1.angle"]["p1.angle"].tolist() == [10.0, 20.0, 30.0, 30.0]


def test_without_pandas_its_extra_is_named(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(library.PicoError) as caught:
        bench.table(scanned(bench)).to_pandas()
    assert "pico-lab[pandas]" in caught.value.diagnostics[0].hint


def test_a_run_is_exported_by_the_command(bench: Bench, pico: Pico) -> None:
    run = scanned(bench)
    answer = pico("-C", str(bench.root), "runs", "export", "--as", "csv")
    assert answer.code == 0 and answer.out.splitlines()[0].startswith("seq,t,at,measured,p1.angle")
    assert pico("-C", str(bench.root), "runs", "export", "--as", "csv", "--out", "-").out == answer.out
    crate = pico("-C", str(bench.root), "runs", "export", "--out", "-")
    assert crate.code != 0 and "name a folder or a file.zip" in crate.err and not (bench.root / "-").exists()
    words = ("runs", "export", "--as", "documents", "--run", run, "--out", "d.jsonl")
    assert pico("-C", str(bench.root), *words).code == 0
    assert pico("-C", str(bench.root), "runs", "export", "e1", "--as", "csv").code == 1
    lines = [json.loads(line) for line in (bench.root / "d.jsonl").read_text().splitlines()]
    assert lines == [[name, document] for name, document in bench.documents(run)]


def test_what_was_measured_is_plotted_for_people_and_as_a_picture(bench: Bench, pico: Pico, tmp_path: Path) -> None:
    with bench.record("scan"):
        for angle in (10, 20, 30):
            bench["p1"].angle = angle
            bench.set({"p2.angle": 2 * angle})
            bench.measure("p2.angle")
    plot = bench.table().plot(x="p1.angle", y="p2.angle")
    assert (plot.points.x, plot.points.y) == ((10.0, 20.0, 30.0), (20.0, 40.0, 60.0))
    assert str(plot).count("•") == 3 and "p1.angle [deg]" in str(plot) and "p2.angle [deg]" in str(plot)
    assert plot._repr_png_().startswith(b"\x89PNG") and "3 points" in repr(plot)
    words = ("-C", str(bench.root), "runs", "plot", "--x", "p1.angle", "--y", "p2.angle")
    answer = pico(*words, "--picture", str(tmp_path / "scan.png"))
    assert answer.code == 0 and answer.out.count("•") == 3 and (tmp_path / "scan.png").stat().st_size > 2000
    assert [p["y"] for p in json.loads(pico("--json", *words).out)["points"]] == [20.0, 40.0, 60.0]
    wrong = pico("-C", str(bench.root), "runs", "plot", "--y", "p2.angel")
    assert wrong.code == 1 and "did you mean" in wrong.err
    bench.apply("C3")
    assert pico("-C", str(bench.root), "runs", "plot").code == 1


def test_without_being_told_a_plot_shows_what_was_read_first_against_what_was_scanned(bench: Bench) -> None:
    bench.apply("C3")
    with bench.record("scan") as run:
        bench["p1"].move(x=300, y=420, yaw=5)
        for angle in (10, 20, 30):
            bench.set({"p2.angle": angle})
            bench.measure("laser.monitor", "p1.pose", "hwp.angle")
            bench.set({"hwp.angle": 2 * angle})
    plot = run.table.plot()
    assert (plot.points.x_name, plot.points.y_name) == ("hwp.angle", "laser.monitor"), "what changed first"
    assert plot.points.x == (22.75, 20.0, 40.0)  # first as its first change found it
    assert table.scanned(bench.history.recorded_run()[0].trace) == ("hwp.angle", "p2.angle")
    with bench.record("still") as run:
        bench.measure("p1.pose", "laser.monitor")
        bench.measure("p1.pose", "laser.monitor")
    assert (run.table.plot().points.x_name, run.table.plot().points.y_name) == ("t", "p1.pose.x")


@pytest.mark.parametrize("points", [[(1, 1)], [(1, 2), (1, 2)], [(-1e-9, 0), (1e-9, 1e12)], [(0, -5), (3, -5)]])
def test_a_plot_has_room_for_any_points(points: list[tuple[float, float]]) -> None:
    from pico.drawing.plots import scatter
    from pico.drawing.plots.axes import ticks

    found = scatter.Points(*zip(*points, strict=True), (None,) * len(points), "x", "y")  # type: ignore[arg-type]
    assert scatter.picture("t", found).shape == (480, 800, 3)
    lines = scatter.text("t", found).splitlines()
    assert all(len(line) <= scatter.WIDTH for line in lines)
    (low, high), _ = found.limits()
    assert all(low <= tick <= high for tick in ticks(low, high))


@pytest.mark.slow
def test_bluesky_scans_the_twin_in_one_recorded_run(bench: Bench) -> None:
    bluesky = pytest.importorskip("bluesky", reason="the extra `bluesky` is not installed")
    from bluesky import plan_stubs, plans, protocols

    for thing in (bench["p1"].angle, bench["cam"].centroid, bench["p1"]):
        assert isinstance(thing, protocols.Readable)
    assert isinstance(bench["p1"].angle, protocols.Movable) and isinstance(bench["p1"].angle, protocols.Locatable)
    assert isinstance(bench["cam"].centroid, protocols.Triggerable)
    bench.apply("C3")
    bench["laser"].shutter = "open"
    bench.set({"p1.angle": 14, "p2.angle": 102})
    bench["cam"].do("auto_range")
    heard: list[tuple[str, dict[str, object]]] = []
    engine = bluesky.RunEngine({}, context_managers=[])
    engine.subscribe(lambda name, document: heard.append((name, document)))
    with bench.record("scan") as run:
        engine(plans.scan([bench["cam"].centroid], bench["p1"].angle, 13, 14, 3), **bench.metadata())
        engine(plan_stubs.mv(bench["p1"].angle, 20, bench["p2"].angle, 30))
    assert run.report.outcome == "done"
    validated(heard)
    start = heard[0][1]
    found, _ = bench.history.recorded_run(run.id)
    assert (start["pico_run"], start["pico_plan"]) == (run.id, found.document.plan)
    assert start["pico_commit"] == found.document.parent
    events = [document["data"] for name, document in heard if name == "event"]
    assert [event["p1-angle"] for event in events] == [13.0, 13.5, 14.0]  # type: ignore[index]
    assert [row["cam.centroid.x"] for row in run.table] == [e["cam-centroid-x"] for e in events]  # type: ignore[index]
    assert (bench["p1"].angle.value, bench["p2"].angle.value) == (20.0, 30.0)
