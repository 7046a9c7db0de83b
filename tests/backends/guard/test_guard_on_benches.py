"""The guard on benches of other kinds, on emulators: two arms, none, three lasers."""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest

from pico.backends.device import LightGuarded
from pico.bench.bench import Bench

sys.path.append(str(Path(__file__).resolve().parents[3] / "benchmarks"))

from safety_world import BENCHES, make_lab

pytestmark = pytest.mark.skipif(not find_spec("xarm"), reason="the extra xarm")
BAR = 0.5
"""Within which light ends [s]."""


class Rig:
    """A bench whose emulators run in this process, with all lasers lit."""

    def __init__(self, bench: Bench) -> None:
        self.bench = bench
        self.device: Any = bench.edge.apparatus.device  # type: ignore[attr-defined]
        assert isinstance(self.device, LightGuarded)
        self.lasers = [n for n in ("laser", "bare", "second") if n in bench.setup.lab.inventory]
        for name in self.lasers:
            for tunable, value in (("emission", True), ("shutter", "open")):
                if tunable in bench.setup.type_of(name).tunables:
                    assert bench.apply(bench.single(name, "set", **{tunable: value})).outcome == "done"
        assert all(self.lit().values())

    def lit(self) -> dict[str, bool]:
        world = self.device.links.world
        emits = {name: world.value(name, "emission") is True for name in self.lasers}
        return {n: on and (n == "bare" or world.value(n, "shutter") == "open") for n, on in emits.items()}

    def pull(self, name: str) -> None:
        self.device.links.world.pull(name, True)

    def dark_after(self) -> float:
        began = time.monotonic()
        while any(self.lit().values()):
            assert time.monotonic() - began < 4.0, self.lit()
            time.sleep(0.005)
        return time.monotonic() - began


@contextmanager
def lit_bench(folder: Path, kind: str) -> Iterator[Rig]:
    make_lab(folder, None, kind)
    with Bench.open(folder, backend="emulated") as bench:
        yield Rig(bench)


@pytest.fixture(autouse=True)
def fast(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PICO_EMULATED_PACE", "10")


@pytest.mark.parametrize("kind", sorted(BENCHES.keys() - {"one arm"}))
def test_an_unsafe_input_ends_the_light_of_every_laser_on_a_bench_that_is_idle(tmp_path: Path, kind: str) -> None:
    with lit_bench(tmp_path, kind) as rig:
        rig.pull("door_box")
        assert rig.dark_after() < BAR
        said = " ".join(one.summary for one in rig.bench.observe().problems)
        assert "door_box (door) is not safe" in said and all(name in said for name in rig.lasers)


def test_presence_ends_it_without_any_arm(tmp_path: Path) -> None:
    with lit_bench(tmp_path, "no arm") as rig:
        rig.pull("veil")
        assert rig.dark_after() < BAR


def moving(rig: Rig) -> tuple[threading.Thread, list[Any]]:
    """Carry the lens in a thread, and return once it is on its way."""
    plan = rig.bench.single("lens", "move", x=660, y=420)
    events: list[Any] = []
    under_way = threading.Event()

    def carry() -> None:
        for event in rig.bench.run(plan):
            events.append(event)
            if event.kind == "operation_progress" and event.data.get("phase") == "lift":
                under_way.set()

    going = threading.Thread(target=carry)
    going.start()
    assert under_way.wait(30.0)
    return going, events


def test_an_emergency_stop_stops_the_arm_that_moves_and_the_other_one_stays(tmp_path: Path) -> None:
    with lit_bench(tmp_path, "two arms") as rig:
        going, events = moving(rig)
        world = rig.device.links.world
        rig.pull("estop")
        rig.dark_after()
        going.join(30.0)
        rest = {name: world.joints(name) for name in ("arm1", "arm2")}
        time.sleep(0.1)
        assert {name: world.joints(name) for name in rest} == rest
        assert world.holding("arm1") or world.holding("arm2"), "a hand keeps what it holds"
        assert "estop" in str([event.data for event in events])
