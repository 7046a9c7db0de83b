"""A bench as a script has it: parts and tunables as objects, units and limits, statuses, results that are shown."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest

import pico
from pico.diagnostics import ExitCode
from pico.recipes.encoding import encoded
from pico.recipes.recipes import Recipes
from pico.runs.table import rows
from pico.scripting.bench import Bench
from pico.scripting.replaying import replay


@pytest.fixture
def bench(case_study: Path, tmp_path: Path) -> Iterator[Bench]:
    shutil.copytree(case_study, tmp_path / "shel")
    with pico.open(tmp_path / "shel", fidelity="kinematic") as opened:
        yield opened


@pytest.fixture
def lit(bench: Bench) -> Bench:
    """A bench with light on its camera."""
    bench.apply("C3")
    bench["laser"].emission = True
    bench["laser"].shutter = "open"
    bench.set({"p1.angle": 12, "p2.angle": 102})
    bench["cam"].do("auto_range")
    return bench


def test_tunables_are_read_and_set_with_units_and_limits(bench: Bench) -> None:
    angle = bench["p1"].angle
    bench["p1"].angle = 10.123456789
    assert (angle.value, angle.unit, angle.limits) == (10.123456789, "deg", (0.0, 360.0))
    bench["p1"].angle = "0.2 rad"
    assert angle.value == pytest.approx(11.4591559)
    angle.set(20).wait()
    assert bench["p1.angle"].value == 20.0
    with pytest.raises(pico.PicoError, match="is a length, not an angle"):
        angle.set("3 mm")
    with pytest.raises(pico.PicoError, match=r"goes from 0.02 to 1000 ms, not to 2000"):
        bench["cam"].exposure = "2 s"
    assert angle.value == 20.0


def test_what_there_is_not_is_said_with_what_there_is(bench: Bench) -> None:
    with pytest.raises(KeyError, match="shel has no `p3`"):
        bench["p3"]
    with pytest.raises(KeyError, match="did you mean `angle`"):
        bench["p1.angel"]
    with pytest.raises(AttributeError, match="did you mean `angle`"):
        bench["p1"].angel = 3
    assert not hasattr(bench["p1"], "angel") and "angle" in dir(bench["p1"])
    for address, words in {"cam.centroyd": "did you mean `centroid`", "cam.image | foo": "no kernel `foo`"}.items():
        with pytest.raises(pico.PicoError, match=words):
            bench.measure(address)
    with pytest.raises(pico.PicoError, match="what is to be measured"):
        bench.measure()
    with pytest.raises(pico.PicoError, match="takes no `z`"):
        bench["p1"].move(z=3)
    with pytest.raises(pico.PicoError, match="no slot `nowhere`"):
        bench.move({"p1": "nowhere"})
    with pytest.raises(pico.PicoError, match="p1 is no tunable"):
        bench.set({"p1": 3})


def test_what_makes_no_sense_is_refused_in_words_and_does_nothing(bench: Bench) -> None:
    p2 = bench["p2"]
    for ask, words in (
        (lambda: bench.set({}), "what is to be set"),
        (lambda: bench.set([1]), "what is to be set"),
        (lambda: bench.set({5: 3}), "not by 5"),
        (lambda: bench.move({}), "what is to be moved"),
        (lambda: bench.move({"p2": (520, 420, 0)}), "where to move p2"),
        (lambda: p2.move(x="abc"), "x of p2: `abc` is no"),
        (lambda: p2.move(x="2 deg"), "an angle, not a length"),
        (lambda: p2.move(x=float("nan")), "no finite number"),
        (lambda: p2.move("storage/b1", x=3), "not both"),
        (lambda: bench.measure(5), "what is to be measured"),
        (lambda: bench.plan(5), "5 is no revision"),
        (lambda: bench.apply(5), "5 is no revision"),
        (lambda: bench.pause(-3), "a pause of -3"),
        (lambda: bench.pause(float("nan")), "a pause of nan"),
        (lambda: bench.commit("hi", "capturing"), "did you mean|no commit mode"),
    ):  # fmt: skip
        with pytest.raises(pico.PicoError, match=words):
            ask()
    with pytest.raises(AttributeError, match="centroid of cam is measured"):
        bench["cam"].centroid = 4
    with pytest.raises(AttributeError, match="by `move`"):
        p2.pose = 4
    assert bench.edge.memory is None or not bench.edge.memory.runs()
    p2.move(x="52 cm", y=420)
    assert p2.pose is not None and p2.pose.x == pytest.approx(520, abs=0.5)
    child = os.fork()
    if not child:  # nothing of this bench goes on there, and what waits for it is told
        try:
            p2.move(x=530)
        except pico.PicoError as exc:
            os._exit(0 if exc.diagnostics[0].code == "forked" else 1)
        os._exit(2)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0


def test_parts_move_and_what_cannot_be_moves_nothing(bench: Bench) -> None:
    p2 = bench["p2"]
    assert p2.move(x=520, y=420, yaw=30).outcome == "done"
    assert p2.pose is not None and p2.slot is None
    assert (p2.pose.x, p2.pose.y, p2.pose.yaw) == pytest.approx((520, 420, 30), abs=0.5)
    p2.move(x=540)
    assert (p2.pose.x, p2.pose.yaw) == pytest.approx((540, 30), abs=0.5)
    with pytest.raises(pico.PicoError) as caught:
        bench["p2"].move(x=5000)
    assert caught.value.exit_code == ExitCode.IMPOSSIBLE and p2.pose.x == pytest.approx(540, abs=0.5)
    bench.move({"p2": "home"})
    assert p2.slot == "storage/b2"


def test_measurements_are_numbers_with_uncertainties_and_pictures(lit: Bench) -> None:
    spot = lit.measure("cam.centroid")
    assert spot.sigma["x"] > 0 and spot["x"] == spot.value["x"] and spot.unit == "um, um"
    image, again = lit.measure("cam.image", "cam.image | centroid")
    assert image.array.ndim == 2 and image._repr_png_().startswith(b"\x89PNG") and spot._repr_png_() is None
    assert again["x"] == pytest.approx(spot["x"], abs=10 * spot.sigma["x"] + 1)
    with pytest.raises(TypeError, match="is not one number"):
        float(spot)
    with pytest.raises(KeyError, match="it has x, y"):
        spot["z"]
    lit["laser"].shutter = "closed"
    with pytest.raises(pico.PicoError, match=r"cam.centroid has no value: there is no light"):
        lit.measure("cam.centroid")


def test_what_kernels_make_of_a_picture_stays_with_the_run(lit: Bench) -> None:
    chain = "cam.image | background | d4sigma"
    with lit.record("spots") as run:
        for angle in (102.1, 102):
            lit["p2"].angle = angle
            spot = lit.measure("cam.image|background|d4sigma")
    assert spot.measurement.address == chain and spot.array.ndim == 2
    assert run.table[f"{chain}.major"][-1] == spot["major"] and run.table[f"{chain}.major_sigma"][-1] > 0
    assert f"{chain}.angle" in run.table.to_csv() and chain in repr(spot)
    found, _ = lit.history.recorded_run()
    units = {n: u for n, (_, _, u) in rows(found.trace)[-1].measurement.numbers.items()}
    assert units == {"major": "um", "minor": "um", "angle": "deg", "ellipticity": "1"}
    plot = lit.table().plot(y=f"{chain}.angle")
    assert "angle [deg]" in str(plot) and len(plot.points.x) == 2
    assert "units" in {d["name"]: d for n, d in lit.documents() if n == "descriptor"}[
        "cam-image-background-d4sigma"]["data_keys"]["cam-image-background-d4sigma-major"]  # fmt: skip
    assert found.document.artifacts[0].name.endswith("-cam-image-background-d4sigma.npy")
    text = encoded("spots", "shel", [found])
    assert text.count(f"  - measure: {chain}\n") == 2
    (lit.root / "spots.yaml").write_text(text)
    assert Recipes(lit).check(str(lit.root / "spots.yaml"))[1] == ()
    assert [c.address for c in replay(lit, found).compared][:1] == [f"{chain}.major"]


def test_what_is_asked_for_meanwhile_comes_after_it(bench: Bench) -> None:
    heard: list[bool] = []
    first, second = bench["p1"].angle.set(50), bench["p2"].angle.set(60)
    second.add_callback(lambda status: heard.append(status.success))
    bench["p1"].angle = 70
    assert first.done and second.done and heard == [True]
    assert (bench["p1"].angle.value, bench["p2"].angle.value) == (70.0, 60.0)
    assert first.result.outcome == "done" and first.exception() is None and "done" in repr(first)


def test_a_status_tells_what_went_wrong(bench: Bench) -> None:
    status = bench.ask("move p1", lambda: bench["p1"].move(x=5000))
    with pytest.raises(pico.PicoError, match="cannot stand"):
        status.wait()
    assert status.done and not status.success and isinstance(status.exception(), pico.PicoError)


def test_results_show_themselves_shortly_and_in_a_notebook(lit: Bench) -> None:
    with lit.record("shown"):
        reading = lit.measure("cam.centroid")
    run, _ = lit.history.recorded_run()
    things = [lit, lit["p1"], lit.plan("e1"), lit.apply("C3"), lit.live(), reading, reading.measurement, run]
    for thing in things:
        assert 10 < len(repr(thing)) < 200 and "\n" not in repr(thing)
        html = thing._repr_html_()  # type: ignore[attr-defined]
        assert html.startswith("<div>") and html.count("<table") <= 1
    assert "p1" in lit.live()._repr_html_() and "cam.centroid" in run._repr_html_()


def test_what_the_services_return_shows_itself_in_a_line(lit: Bench) -> None:
    lit.apply("C3")
    lit.set({"p1.angle": 7})
    captured, status, drift = lit.capture(write=False), lit.status(), lit.drift.look()
    assert repr(captured) == "<to be captured: p1.angle into table.yaml>"
    assert "1 off" in repr(status) and repr(drift).endswith("p1.angle left it>")
    commit = lit.commit("p1 at 7", mode="capture")
    assert f"<commit {commit.commit[:7]} on " in repr(commit) and "'p1 at 7'; p1.angle; kinematic, sim>" in repr(commit)
    things = [captured, status, drift, commit, lit.status(), lit.capture(), lit.verify(), lit.drift.look(),
              lit.optimize("null", "p1", "cam"), lit.morning()]  # fmt: skip
    for thing in things:
        assert 10 < len(repr(thing)) < 250 and "\n" not in repr(thing) and "=" not in repr(thing), repr(thing)
    assert "all equal" in repr(things[4]) and "nothing differs" in repr(things[5])
    assert "7 deg" in commit._repr_html_() and "p1.angle" in status._repr_html_()


def test_names_are_exported_and_imported_only_when_they_are_asked_for() -> None:
    for name in pico.__all__:
        assert getattr(pico, name) is not None
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        _ = pico.nothing


def test_where_a_scan_begins_at_the_value_that_there_is_its_first_point_has_it_too(bench: Bench) -> None:
    bench["p1"].angle = 10
    with bench.record("scan"):
        for angle in (10, 20):
            bench["p1"].angle = angle
            bench.measure("hwp.angle")
    assert [row.tunables["p1.angle"] for row in rows(bench.history.recorded_run(None)[0].trace)] == [10, 20]


def test_steps_add_up_and_a_step_back_leads_back(bench: Bench) -> None:
    p1 = bench["p1"]
    p1.angle = 3
    p1.angle += 0.1
    p1.angle += 0.2
    assert p1.angle.value == 3.3
    p1.angle -= 0.3
    angle = p1.angle
    angle += 5
    assert angle.value == p1.angle.value == 8
    angle.step("-0.1 rad")
    assert p1.angle.value == pytest.approx(8 - 5.7296, abs=1e-3)
    p1.angle = 350
    p1.angle += 20  # a polarizer that has turned once more
    assert p1.angle.value == 10
    p1.angle = -10
    assert p1.angle.value == 350
    with pytest.raises(pico.PicoError, match="goes from 0 to 360 deg, not to 1010"):
        p1.angle.step(660)
    with pytest.raises(pico.PicoError, match="is no number"):
        bench["laser"].shutter.step(1)
