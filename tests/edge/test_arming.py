"""The edge itself keeps light in: whoever asks, until when a person let it out, and whatever lies in its files."""

from __future__ import annotations

import asyncio
import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from bench_at import bench_at
from serving import served

from pico.bench.bench import Bench
from pico.diagnostics import ExitCode, PicoError
from pico.edge import aligning, armings, own_lab
from pico.edge.contract import Edge
from pico.edge.link import server
from pico.edge.local import custody, embedded
from pico.edge.protocol import Lease
from pico.history.examples.example import make_example
from pico.model.arming import Arming
from pico.model.operation import Operation, Reason
from pico.model.plan import Plan
from pico.planning.checks.emission import lets_out

OPENED = {"tunable": "shutter", "from": "closed", "to": "open"}
NOON, LATER, EVENING = (f"2026-11-24T{hour}:00:00Z" for hour in ("12", "13", "18"))


class Clock:
    def __init__(self) -> None:
        self.now = NOON

    def __call__(self) -> str:
        return self.now


@pytest.fixture(scope="session")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    root = make_example("shel", tmp_path_factory.mktemp("arming") / "shel").root
    text = (root / "lab.yaml").read_text()
    line = next(line for line in text.splitlines() if line.startswith("  arming: {waived"))
    roles = "  arming: {roles: {laser_user: {people: [Ada Lovelace], laser_class: 3R, hours: 8}}}"
    (root / "lab.yaml").write_text(text.replace(line, roles))
    with Bench.open(root) as bench:
        bench.apply()
        bench.apply(bench.single("laser", "set", emission="true"))
    return root


@pytest.fixture
def lab(made: Path, tmp_path: Path) -> Path:
    shutil.copytree(made, tmp_path / "shel")
    return tmp_path / "shel"


@contextmanager
def at(lab: Path, clock: Clock) -> Iterator[Bench]:
    """A bench whose edge has a clock of the test's own."""
    with Bench.open(lab) as bench:
        bench._edge = embedded(bench.setup, bench_at(lab), "kinematic", own_lab.read(bench_at(lab)), clock)
        yield bench


def arming(**changes: Any) -> Arming:
    usual: dict[str, Any] = {
        "laser": "laser", "by": "Ada Lovelace", "role": "laser_user", "laser_class": "3R", "begins": NOON,
        "ends": EVENING, "backend": "sim",
    }  # fmt: skip
    return Arming(**(usual | changes))


def setting(to: Any = "open", tunable: str = "shutter") -> Operation:
    return Operation(id="op1", primitive="set", component="laser", reason=Reason(kind="asked"), seconds=0.05,
                     arguments={"tunable": tunable, "from": None, "to": to}, resources=("laser",))  # fmt: skip


def by_hand(bench: Bench, *operations: Operation) -> Plan:
    """A plan that somebody made by hand, with the laser in it."""
    plan = bench.single("p1", "set", angle="4")
    return replace(plan, operations=(*plan.operations, *operations), policy=(), diagnostics=()).sealed()


def shutter(bench: Bench) -> Any:
    return bench.observe().components["laser"].values["shutter"].value


def denied(act: Callable[[], Any]) -> str:
    with pytest.raises(PicoError) as raised:
        act()
    assert raised.value.exit_code == ExitCode.DENIED
    return raised.value.diagnostics[0].summary


@pytest.mark.parametrize("behind", [False, True], ids=["in this process", "behind a socket"])
def test_a_plan_made_by_hand_gets_no_light_out_of_a_laser_that_nobody_armed(lab: Path, behind: bool) -> None:
    def attack() -> None:
        with Bench.open(lab) as bench:
            asked = {"text": "open it", "tunable": "shutter", "to": "open"}
            for operation in (
                setting(),
                replace(setting(), primitive="scan"),
                replace(setting(), primitive="home"),
                replace(setting(), primitive="operator", arguments=asked),
            ):
                plan = by_hand(bench, replace(operation, id="op9"))
                with pytest.raises(PicoError) as raised:
                    bench.apply(plan)
                assert raised.value.exit_code in (ExitCode.DENIED, ExitCode.ERROR), operation
            assert "laser (class 3R) stays shut" in denied(
                lambda: bench.apply(by_hand(bench, replace(setting(), id="x")))
            )
            assert shutter(bench) == "closed"

    if behind:
        with served(lab):
            attack()
    else:
        attack()


def test_nor_does_an_operation_without_a_plan(lab: Path) -> None:
    with Bench.open(lab) as bench:

        async def bare(edge: Edge) -> Any:
            lease = await edge.acquire("somebody")
            result = await edge.execute(setting(), "r/op1/1", lease)
            await edge.release(lease)
            return result

        result = bench.wait(bare(bench.edge))
        assert result.outcome == "failed" and result.error.code == "unarmed"
        assert shutter(bench) == "closed"


def test_an_arming_counts_until_its_end_and_then_who_has_the_bench_shuts_the_laser(lab: Path) -> None:
    clock = Clock()
    with at(lab, clock) as bench:
        bench.wait(bench.edge.arm(arming()))
        assert bench.apply(bench.single("laser", "set", shutter="open")).outcome == "done"
        clock.now = LATER
        bench.apply(bench.single("cam", "set", exposure="8"))
        assert shutter(bench) == "open"
        clock.now = EVENING
        assert not bench.observe().licences
        report = bench.apply(bench.single("cam", "set", exposure="9"))
        assert any("laser was shut: the arming by Ada Lovelace ended" in d.summary for d in report.diagnostics)
        assert shutter(bench) == "closed" and not armings.kept(bench_at(lab))
        assert bench.single("laser", "set", shutter="open").exit_code == ExitCode.DENIED


def test_a_bench_that_is_served_shuts_the_laser_when_the_arming_ends_though_nobody_works(
    lab: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    clock = Clock()
    with at(lab, clock) as bench:
        bench.wait(bench.edge.arm(arming()))
        assert bench.apply(bench.single("laser", "set", shutter="open")).outcome == "done"
        assert not bench.edge.licensing.arming_over()
        clock.now = EVENING

        async def minded() -> None:
            monkeypatch.setattr(server, "MINDS", 0.0)
            minding = asyncio.create_task(server._mind(bench.edge))
            while armings.kept(bench_at(lab)):
                await asyncio.sleep(0)
            minding.cancel()

        bench.wait(minded())
        assert shutter(bench) == "closed"


def test_a_clock_that_is_set_back_to_before_an_arming_began_shuts_what_it_opened(lab: Path) -> None:
    clock = Clock()
    with at(lab, clock) as bench:
        bench.wait(bench.edge.arm(arming()))
        assert bench.apply(bench.single("laser", "set", shutter="open")).outcome == "done"
        clock.now = NOON.replace("T12", "T10")
        report = bench.apply(bench.single("cam", "set", exposure="9"))
        assert shutter(bench) == "closed"
        assert any("laser was shut: it is of class 3R" in d.summary for d in report.diagnostics)


def test_a_clock_that_is_set_back_does_not_bring_back_an_arming_whose_end_was_seen(lab: Path) -> None:
    clock = Clock()
    with at(lab, clock) as bench:
        bench.wait(bench.edge.arm(arming()))
        assert bench.observe().licences
        clock.now = EVENING
        assert not bench.observe().licences
    clock.now = LATER
    with at(lab, clock) as bench:
        assert not bench.observe().licences, "nobody had the bench meanwhile, who would have tidied it up"
        assert bench.single("laser", "set", shutter="open").exit_code == ExitCode.DENIED
        bench.wait(bench.edge.arm(arming(begins=LATER)))
        assert bench.observe().licences


@pytest.mark.parametrize(
    ("tunable", "to"), [("emission", "closed"), ("emission", 0), ("shutter", 0), ("shutter", False), ("shutter", "")]
)
def test_what_a_device_may_take_for_light_lets_it_out(lab: Path, tunable: str, to: Any) -> None:
    with Bench.open(lab) as bench:
        assert lets_out(bench.setup, setting(to, tunable))
        assert not lets_out(bench.setup, setting("closed")) and not lets_out(bench.setup, setting(False, "emission"))


def test_it_survives_the_death_of_the_process_and_begins_when_it_says(lab: Path) -> None:
    clock = Clock()
    with at(lab, clock) as bench:
        bench.wait(bench.edge.arm(arming(begins=LATER, unattended=True)))
        assert not bench.observe().licences
    clock.now = LATER
    with at(lab, clock) as bench:
        licence = (bench.observe().licences or {})["laser"]
        assert (licence.by, licence.unattended, licence.ends) == ("Ada Lovelace", True, EVENING)


def test_one_client_disarms_while_the_bench_is_anothers(lab: Path) -> None:
    clock = Clock()
    with at(lab, clock) as one, at(lab, clock) as two:
        one.wait(one.edge.arm(arming()))
        one.apply(one.single("laser", "set", shutter="open"))
        lease: Lease = one.wait(one.edge.acquire("one"))
        assert two.wait(two.edge.disarm("laser", "Grace Hopper"))
        assert shutter(two) == "closed"
        one.wait(one.edge.release(lease))


def test_two_who_write_at_once_do_not_bring_back_what_the_other_took_away(lab: Path) -> None:
    armings.keep(bench_at(lab), arming())
    armings.keep(bench_at(lab), arming(laser="other"))
    armings.forget(bench_at(lab), "laser")
    assert [one.laser for one in armings.kept(bench_at(lab))] == ["other"]


@pytest.mark.parametrize(
    "changes",
    [
        {"by": "Charles Babbage"}, {"by": ""}, {"role": "chief"}, {"laser_class": "4"}, {"ends": NOON},
        {"ends": "2026-11-25T12:00:00Z"}, {"begins": EVENING},
        {"begins": "2027-11-24T12:00:00Z", "ends": "2027-11-24T13:00:00Z"},
    ],
)  # fmt: skip
def test_an_arming_that_the_policy_does_not_allow_is_refused_by_the_edge(lab: Path, changes: dict[str, Any]) -> None:
    with at(lab, Clock()) as bench:
        denied(lambda: bench.wait(bench.edge.arm(arming(**changes))))
        assert not armings.kept(bench_at(lab))


def test_an_arming_is_for_its_class_and_its_backend(lab: Path) -> None:
    with at(lab, Clock()) as bench:
        bench.wait(bench.edge.arm(arming(laser_class="2")))
        assert "for class 2 only" in bench.single("laser", "set", shutter="open").diagnostics[0].summary
        armings.keep(bench_at(lab), arming(backend="hardware"))
        assert not bench.observe().licences


def test_who_leaves_the_role_arms_nothing_any_more(lab: Path) -> None:
    from pico.policy.arming import over

    with Bench.open(lab) as bench:
        policy = bench.setup.lab.policy
        assert policy.arming is not None
        roles = {"laser_user": replace(policy.arming.roles["laser_user"], people=("Grace Hopper",))}
        changed = replace(policy, arming=replace(policy.arming, roles=roles))
        setup = replace(bench.setup, lab=replace(bench.setup.lab, policy=changed))
        assert not over(bench.setup, arming(), NOON) and "no laser_user" in over(setup, arming(), NOON)


@pytest.mark.parametrize(
    ("goal", "after"),
    [
        (("null", "p2", "cam"), 2),
        (("null", "p2", "cam"), 4),
        (("center", "ly_150", "cam"), 2),
        (("peak", "p2", "cam"), 2),
        (("peak", "p2", "cam"), 4),
    ],
)
def test_an_optimization_during_which_an_arming_ends_is_left_where_light_was_and_says_so(
    lab: Path, monkeypatch: pytest.MonkeyPatch, goal: tuple[str, ...], after: int
) -> None:
    monkeypatch.setattr(custody, "LOOKS", 1)
    monkeypatch.setattr(custody, "OBEYS", 0.0)
    clock, told = Clock(), aligning.Aligning._progress

    def progress(self: Any, run: Any, ask: Any, reading: Any) -> None:
        told(self, run, ask, reading)
        clock.now = EVENING if run.measured >= after else clock.now

    monkeypatch.setattr(aligning.Aligning, "_progress", progress)
    with at(lab, clock) as bench:
        bench.apply("e1")
        bench.wait(bench.edge.arm(arming()))
        assert bench.apply(bench.single("laser", "set", shutter="open")).outcome == "done"
        before = bench.observe().known_values
        report, found = bench.goals.optimize(bench.goals.plan(bench.goals.chosen(goal)))
        assert shutter(bench) == "closed" and bench.observe().known_values["cam"] == before["cam"]
        if found.met:  # it was quicker
            return
        assert any("laser was shut: the arming by Ada Lovelace ended" in d.summary for d in report.diagnostics)
        assert bench.observe().known_values[goal[1]] == before[goal[1]]
        dark = found.last or {"objective": 0.0, "objective_sigma": 1.0}  # no light is a number with a sigma
        assert abs(dark["objective"]) <= 4 * dark["objective_sigma"]
