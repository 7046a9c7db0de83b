"""A laser above class 2 comes on at a bench that a person has commissioned, and on no other one."""

from __future__ import annotations

import json
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from bench_at import bench_at

from pico.backends import sim
from pico.backends.device import Capabilities, Device
from pico.backends.hardware.report import write
from pico.bench.bench import Bench
from pico.diagnostics import Diagnostic, ExitCode, PicoError
from pico.edge import own_lab
from pico.edge.local import LocalEdge
from pico.history.examples.example import make_example
from pico.model.arming import Arming
from pico.model.commissioning import STEPS, Basis, Commissioning, StepResult
from pico.model.setup import Setup

NOON, EVENING = (f"2026-11-24T{hour}:00:00Z" for hour in ("12", "18"))
ARM = {"vendor": "UFACTORY", "model": "xArm7", "serial": "XI1", "firmware": "2.1.0"}
BASIS = Basis(wired="sha256:a", bench="sha256:b", identities={"arm1": ARM})


class Real:
    """The simulator, which says that it is a real bench."""

    basis_now = BASIS

    def __init__(self, inner: Device) -> None:
        self._inner = inner

    def __getattr__(self, name: str) -> Any:
        return getattr(self._inner, name)

    async def describe(self) -> Capabilities:
        return replace(await self._inner.describe(), name="hardware", evidence="hardware")

    async def basis(self) -> Basis:
        return self.basis_now


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    root = make_example("shel", tmp_path_factory.mktemp("commissioned") / "shel").root
    roles = "\n    roles: {laser_user: {people: [Ada Lovelace], laser_class: 3R, hours: 8}}"
    text = (root / "lab.yaml").read_text()
    line = next(line for line in text.splitlines() if line.startswith("  arming: {waived"))
    (root / "lab.yaml").write_text(text.replace(line, f"  arming:{roles}"))
    with Bench.open(root) as bench:
        bench.apply(bench.single("laser", "set", emission="true"))
    return root


@contextmanager
def at(made: Path, tmp_path: Path) -> Iterator[tuple[Bench, Real, Path]]:
    root = shutil.copytree(made, tmp_path / "shel")
    devices: list[Real] = []

    def opening(setup: Setup) -> Device:
        devices.append(Real(sim.opened(setup, bench_at(root), "kinematic", lambda: NOON)))
        return devices[-1]  # type: ignore[return-value]

    with Bench.open(root) as bench:
        bench.backend_name = "hardware"
        bench._edge = LocalEdge(bench.setup, bench_at(root), opening, own_lab.read(bench_at(root)), lambda: NOON)
        yield bench, devices[-1], root


def report(**changes: Any) -> Commissioning:
    passed = StepResult(outcome="passed", at=NOON, by="Ada Lovelace", told="found well")
    usual: dict[str, Any] = {"lab": "shel", "bench": "hardware", "basis": BASIS, "steps": dict.fromkeys(STEPS, passed)}
    return Commissioning(**(usual | changes))


def arming(laser_class: Any = "3R") -> Arming:
    return Arming(laser="laser", by="Ada Lovelace", role="laser_user", laser_class=laser_class, begins=NOON,
                  ends=EVENING, backend="hardware")  # fmt: skip


def refused(bench: Bench) -> Diagnostic:
    with pytest.raises(PicoError) as raised:
        bench.wait(bench.edge.arm(arming()))
    assert raised.value.exit_code == ExitCode.DENIED
    assert not bench.wait(bench.edge.armings())
    return raised.value.diagnostics[0]


def test_without_a_report_of_its_own_none_is_armed_above_class_2(made: Path, tmp_path: Path) -> None:
    with at(made, tmp_path) as (bench, _, root):
        told = refused(bench)
        assert "it was never commissioned" in told.summary and "`pico --backend hardware commission`" in told.hint
        bench.wait(bench.edge.arm(arming("2")))
        bench.wait(bench.edge.disarm("laser", "Ada Lovelace"))
        write(root, report(bench="emulated"))
        assert "never commissioned" in refused(bench).summary
        (root / "commissioning-emulated.json").rename(root / "commissioning.json")
        assert "is of the emulated bench" in refused(bench).summary
        (root / "commissioning.json").write_text(json.dumps({"schema": "pico.commissioning/v1", "lab": "shel"}))
        assert "commissioning.json is no report of a commissioning" in refused(bench).summary


def test_with_one_it_is_and_is_shut_when_something_else_answers_at_an_address(made: Path, tmp_path: Path) -> None:
    with at(made, tmp_path) as (bench, device, root):
        write(root, report())
        bench.wait(bench.edge.arm(arming()))
        assert bench.observe().licences["laser"].laser_class == "3R"  # type: ignore[index]
        assert bench.apply(bench.single("laser", "set", shutter="open")).outcome == "done"
        device.basis_now = replace(BASIS, identities={"arm1": {**ARM, "firmware": "2.2.0"}})
        told = bench.apply(bench.single("cam", "set", exposure="9")).diagnostics
        said = "the bench is not commissioned: the firmware of arm1 is 2.2.0, and was 2.1.0"
        assert any(d.summary.startswith("laser was shut") and said in d.summary for d in told), told
        assert bench.observe().components["laser"].values["shutter"].value == "closed"


class Guarded(Real):
    """A real bench whose light is guarded; `dead_men`: the lasers that a dead-man makes dark."""

    dead_men = frozenset[str]()

    disarm: Any = None

    def listen(self, heard: Any, disarm: Any) -> None:
        """Nothing ends light here but a test."""
        self.disarm = disarm

    def dark_by_itself(self) -> frozenset[str]:
        return self.dead_men

    async def end_light(self) -> Any:
        raise AssertionError("nobody asks for that")

    async def guarded(self) -> None:
        raise AssertionError("nobody asks for that")

    def guards(self) -> bool:
        return True

    def may_emit(self) -> bool:
        return False


def test_without_a_dead_man_none_is_armed_above_class_2_unless_an_interlock_is_wired_past_every_computer(
    made: Path, tmp_path: Path
) -> None:
    with at(made, tmp_path) as (bench, _, root):
        write(root, report())
        apparatus = bench.edge.apparatus  # type: ignore[union-attr]
        device = Guarded(apparatus.device._inner)  # type: ignore[attr-defined]
        apparatus.device = device  # type: ignore[assignment]
        wrong = refused(bench)
        assert wrong.code == "dead-man" and "nothing would end its light" in wrong.summary
        assert "interlock input of laser" in wrong.detail and "hard_wired_interlock: true" in wrong.hint
        device.dead_men = frozenset({"laser"})
        bench.lasers.keep(arming())
        assert bench.observe().licences["laser"].laser_class == "3R"  # type: ignore[index]
        device.dead_men = frozenset()
        bare = bench.observe().licences["laser"]  # type: ignore[index]
        assert bare.laser_class == "2" and "it has no dead-man" in (bare.withheld or "")
        lab = replace(bench.setup.lab, policy=replace(bench.setup.lab.policy, hard_wired_interlock=True))
        apparatus.setup = replace(bench.setup, lab=lab)
        assert bench.observe().licences["laser"].laser_class == "3R"  # type: ignore[index]


def test_after_a_stop_or_a_trip_nothing_lets_light_out_until_a_person_arms_again(made: Path, tmp_path: Path) -> None:
    with at(made, tmp_path) as (bench, _, root):
        write(root, report())
        apparatus = bench.edge.apparatus  # type: ignore[union-attr]
        device = Guarded(apparatus.device._inner)  # type: ignore[attr-defined]
        device.dead_men = frozenset({"laser"})
        apparatus._opening = lambda setup: device  # type: ignore[assignment]
        apparatus.become(bench.setup, {})
        for _ in range(2):
            bench.wait(bench.edge.arm(arming()))
            assert bench.observe().licences["laser"].laser_class == "3R"  # type: ignore[index]
            assert device.disarm("a stop") == ("laser",)
            assert "laser" not in (bench.observe().licences or {})
            with pytest.raises(PicoError, match="nobody has armed it"):
                bench.apply(bench.single("laser", "set", shutter="open"))
