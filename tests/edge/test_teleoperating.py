"""A teleoperation at the edge: one operation in the journal, bounded steps, refusals, ends in and out of turn."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from pico.bench.bench import Bench
from pico.bench.teleoperation import Teleoperation
from pico.diagnostics import ExitCode, PicoError
from pico.edge.recovery import verdict
from pico.edge.teleoperating import LOST, Teleoperating
from pico.history.examples.example import make_example
from pico.model.operation import Operation, touched_by
from pico.model.pose import Pose
from pico.teleop.frames import Frame


@pytest.fixture(scope="module")
def example(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return make_example("shel", tmp_path_factory.mktemp("teleop") / "shel").root


@pytest.fixture
def bench(example: Path, tmp_path: Path) -> Iterator[Bench]:
    """A new bench whose world runs as fast as the machine can."""
    shutil.copytree(example, tmp_path / "shel")
    with Bench.open(tmp_path / "shel", fidelity="kinematic") as found:
        yield found


def unpaced(bench: Bench, component: str, tunable: str | None = None) -> Teleoperation:
    jog = bench.teleop(component, tunable)
    bench.edge.device.pace.factor = None  # type: ignore[attr-defined]
    return jog


def steered(bench: Bench) -> list[Any]:
    """Return the records of teleoperations, and of whatever else is about the part."""
    assert bench.edge.memory is not None
    return [r for r in bench.edge.memory.records() if r.component in ("p2", "ly_150")]


def test_a_motor_goes_step_by_step_and_the_journal_has_one_operation(bench: Bench) -> None:
    with unpaced(bench, "p2") as jog:
        assert jog.step("angle", 3.0) and jog.step("angle", 30.0) and jog.step("angle", -1.0)
        assert jog.values == {"angle": 32.0}
    assert [r.kind for r in steered(bench)] == ["intent", "started", "done"]
    data = steered(bench)[-1].data["data"]
    assert data["first"] == {"p2.angle": 0.0} and data["last"] == {"p2.angle": 32.0}
    assert bench.observe().components["p2"].values["angle"].value == 32.0
    assert jog.report.outcome == "done" and jog.report.exit_code == 0


def test_a_range_ends_and_nothing_leaves_it(bench: Bench) -> None:
    with unpaced(bench, "ly_150", "stage_y") as jog:
        assert not jog.step("stage_y", 5.0)
        assert jog.values == {"stage_y": 2.0} and jog.limit == "stage_y ends at 2 mm"
        assert jog.step("stage_y", -0.1)


def test_a_part_in_hand_goes_to_where_it_would_come_too_near_and_stands_where_it_was_left(bench: Bench) -> None:
    bench.sim.nudge("p2", dx=62.0, dy=22.0)
    with unpaced(bench, "p2", "pose") as jog:
        assert jog.step("x", 3.0) and jog.step("yaw", -1.0)
        assert bench.observe().robots["arm1"].holding == "p2"
        assert not jog.step("y", 20.0)
        assert jog.limit.startswith("y: p2 is ") and "before lx_125" in jog.limit
        there = jog.values
    part = bench.observe().components["p2"]
    assert part.presence == "seen" and part.pose is not None
    assert (part.pose.x, part.pose.y, part.pose.yaw) == pytest.approx((there["x"], there["y"], there["yaw"]))
    lens = bench.observe().components["lx_125"].pose
    assert lens is not None and part.pose.y + 30 < lens.y - 30  # their bases
    assert [r.kind for r in steered(bench)] == ["intent", "started", "done"]
    assert bench.setup.lab.robots["arm1"].is_parked(bench.observe().robots["arm1"].joints)


def test_what_was_steered_is_captured_and_undone_as_ever(bench: Bench) -> None:
    before = bench.observe().components["p2"].pose
    with unpaced(bench, "p2", "pose") as jog:
        assert touched_by("p2", jog.operation.arguments) == (("p2", "pose"),)
        jog.step("x", 5.0)
    bench.capture()
    captured, live = bench.state.components["p2"].pose, bench.observe().components["p2"].pose
    assert captured is not None and live is not None and captured.distance(live) < 1e-3
    bench.apply(bench.recovery.undo_plan())
    assert bench.observe().components["p2"].pose == before
    with pytest.raises(PicoError) as caught:
        bench.recovery.resume_plan()
    assert caught.value.diagnostics[0].code == "nothing-to-resume"


@pytest.mark.parametrize(
    ("frame", "said"),
    [
        (Frame(seq=10, press=7, tunable="nonsense", by=0.1), "nonsense of p2 is not steered here"),
        (Frame(seq=10, press=7, tunable="angle", by=float("nan")), "one step of angle is at most"),
        (Frame(seq=10, press=7, tunable="angle", by=1e9), "one step of angle is at most"),
        (Frame(seq=10, press=7, tunable="angle", by=1.0, seen=-1e9), "late"),
        (Frame(seq=-1, press=7, tunable="angle", by=1.0), "stale"),
    ],
)
def test_nonsense_moves_nothing(bench: Bench, frame: Frame, said: str) -> None:
    with unpaced(bench, "p2") as jog:
        seen = frame.seen or jog.answer.clock
        given = Frame(seq=frame.seq + jog._seq, seen=seen, press=frame.press, tunable=frame.tunable, by=frame.by)
        if frame.seq < 0:
            given = Frame(seq=1, seen=seen, press=7, tunable="angle", by=1.0)
        answer = bench.wait(bench.edge.jog(jog.run.id, given))
        assert answer.refused.startswith(said)
        jog._seq += 20
        assert jog.hear().steps == 0 and jog.values == {"angle": 0.0}


def test_stopped_now_it_holds_what_it_holds_and_recover_sets_it_down(bench: Bench) -> None:
    jog = unpaced(bench, "p2", "pose")
    with jog:
        jog.step("x", 5.0)
        bench.wait(bench.edge.stop())
    assert bench.observe().robots["arm1"].holding == "p2"
    assert steered(bench)[-1].kind == "failed" and steered(bench)[-1].data["error"]["code"] == "stopped"
    assert jog.report.exit_code == ExitCode.INTERRUPTED
    bench.apply(bench.recovery.recover_plan())
    assert bench.observe().components["p2"].presence == "seen"


def test_stopped_safely_it_sets_the_part_down(bench: Bench) -> None:
    with unpaced(bench, "p2", "pose") as jog:
        jog.step("x", 5.0)
        bench.wait(bench.edge.halt())
        jog.settle(end=True)
    part = bench.observe().components["p2"]
    assert part.presence == "seen" and part.pose is not None and part.pose.x == pytest.approx(205.0)
    assert bench.observe().robots["arm1"].holding is None


class Clock:
    """A clock that somebody else turns."""

    def __init__(self) -> None:
        self.now = 0.0

    def __call__(self) -> float:
        return self.now


def with_clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    clock, make = Clock(), Teleoperating.__init__

    def made(self: Teleoperating, *args: Any) -> None:
        make(self, *args[:5], clock)

    monkeypatch.setattr(Teleoperating, "__init__", made)
    return clock


def test_who_is_silent_for_long_is_gone_and_the_part_stays_in_the_hand(
    bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    clock = with_clock(monkeypatch)
    with unpaced(bench, "p2", "pose") as jog:
        clock.now += LOST + 0.1
        while not jog.over:
            jog._news()
    end = steered(bench)[-1]
    assert end.kind == "failed" and end.data["error"]["code"] == "lost"
    assert bench.observe().robots["arm1"].holding == "p2"


def test_a_press_that_was_silent_is_over_until_it_is_pressed_again(
    bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    clock = with_clock(monkeypatch)
    with unpaced(bench, "p2") as jog:
        press = jog.press()
        assert jog.hear(tunable="angle", by=1.0, press=press).refused == ""
        while jog.hear().steps == 0:
            pass
        clock.now += 0.3
        jog.hear()
        assert jog.hear(tunable="angle", by=1.0, press=press).refused == "lapsed"
        assert jog.answer.stopped == "silent"
        assert jog.step("angle", 1.0) and jog.values == {"angle": 2.0}
        jog.hear(release=True)
        assert jog.answer.stopped == "released"
    data = steered(bench)[-1].data["data"]
    assert data["presses"] == {"silent": 1, "released": 1} and data["after"] < 0.3


def _operation(**arguments: Any) -> Operation:
    from pico.model.operation import Reason

    return Operation(
        id="op1", primitive="teleoperate", component="p2", arguments=arguments, reason=Reason(kind="asked")
    )


def _at_once(_: Any) -> None: ...


@pytest.mark.parametrize(("nudged", "outcome"), [(0.0, "failed"), (3.0, "done")])
def test_one_that_was_killed_ended_where_it_stands(bench: Bench, nudged: float, outcome: str) -> None:
    begun = bench.observe().components["p2"].pose
    assert begun is not None
    bench.sim.nudge("p2", dx=nudged)
    pose = {"x": begun.x, "y": begun.y, "yaw": begun.yaw}
    operation = _operation(what={"tunables": {"p2.pose": None}}, **{"from": {"pose": pose}})
    assert verdict(bench.setup, operation, bench.observe()) == outcome
    assert Pose(**pose) == begun


def test_what_nobody_can_steer_is_told(bench: Bench) -> None:
    ask: Callable[[str, str | None], Any] = bench.teleop
    for component, tunable, said in [
        ("p9", None, "no component"), ("p2", "angel", "no tunable"), ("laser", "shutter", "is not steered"),
        ("cam", "pose", "no arm can move cam"),
    ]:  # fmt: skip
        with pytest.raises(PicoError) as caught:
            ask(component, tunable)
        assert said in caught.value.diagnostics[0].summary
