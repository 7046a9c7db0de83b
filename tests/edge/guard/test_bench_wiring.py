"""How a real bench is wired is no part of the Lab that it keeps: the files say it, at each start of an edge."""

from __future__ import annotations

import asyncio
import shutil
from pathlib import Path

import pytest
from laser_lab import set_to

from pico.backends.device import Began
from pico.bench.bench import Bench
from pico.diagnostics import PicoError
from pico.edge import own_lab
from pico.edge.link.server import edge_of
from pico.history.examples.example import make_example
from pico.model.arming import Arming
from pico.model.commissioning import basis_of
from pico.model.operation import Operation, OperationResult
from pico.places.bench import BenchPlace

DEVICES = Path(__file__).resolve().parents[3] / "examples" / "devices.yaml"
NOON = "2026-11-24T12:00:00Z"
ADDED = """
  added_box:
    driver: switches.input
    address: {host: 192.0.2.77, port: 4000, name: door}
"""


@pytest.fixture
def place(tmp_path: Path) -> BenchPlace:
    """A real bench that has adopted its Lab, with the instruments of then."""
    root = make_example("shel", tmp_path / "shel").root
    shutil.copy(DEVICES, root)
    at = BenchPlace(root, "hardware")
    own_lab.write(at, own_lab.proposed(root))
    return at


class Done:
    """Executes anything."""

    async def execute(self, operation: Operation, key: str, began: Began) -> OperationResult:
        return OperationResult(key=key, outcome="done")


def add_input(place: BenchPlace) -> None:
    path = place.root / "devices.yaml"
    text = path.read_text().replace("\ndevices:\n", f"\ndevices:{ADDED}", 1)
    path.write_text(
        text.replace("\nsafety_inputs:\n", "\nsafety_inputs:\n  added: {kind: door, device: added_box}\n", 1)
    )


def test_an_edge_asks_an_input_that_was_added_since_the_lab_was_adopted(place: BenchPlace) -> None:
    before = edge_of(place).setup
    add_input(place)
    own = edge_of(place).apparatus
    assert own.setup.wiring is not None and "added" in own.setup.wiring.safety_inputs
    assert "added" in own.device.links.about().inputs  # type: ignore[attr-defined]
    assert own.wiring.refusal() is None
    assert basis_of(own.device.setup, {}).wired != basis_of(before, {}).wired, "the commissioning notices it"  # type: ignore[attr-defined]


def test_commands_go_by_the_wiring_of_the_files_while_another_lab_is_proposed(place: BenchPlace) -> None:
    add_input(place)
    path = place.root / "lab.yaml"
    path.write_text(
        path.read_text() + "keep_out:\n  pillar: {area: {x: [500, 540], y: [400, 440]}, reason: a pillar}\n"
    )
    with Bench.open(place.root, bench=place) as bench:
        assert not bench.setup.lab.keep_out and bench.setup.wiring is not None
        assert "added" in bench.setup.wiring.safety_inputs


def test_an_edge_that_is_older_than_its_wiring_lets_no_light_out(place: BenchPlace) -> None:
    edge = edge_of(place)
    own = edge.apparatus
    assert own.wiring.refusal() is None
    before = (place.root / "devices.yaml").read_bytes()
    (place.root / "devices.yaml").write_bytes(before + b"# a remark\n")
    assert own.wiring.refusal() is None
    add_input(place)
    why = own.wiring.refusal()
    for operation, outcome in (
        (set_to("laser", "shutter", "open"), "failed"), (set_to("laser", "emission", True), "failed"),
        (set_to("laser", "shutter", "closed"), "done"),
    ):  # fmt: skip
        guarded = edge.licensing.guard(Done(), lambda: False)
        assert asyncio.run(guarded.execute(operation, "k/1", lambda _: None)).outcome == outcome
    arming = Arming(laser="laser", by="Ada", role="", laser_class="3R", begins=NOON, ends=NOON, backend="hardware")
    with pytest.raises(PicoError, match="no light is let out"):
        asyncio.run(edge.licensing.arm(arming))
    assert why is not None and "no light is let out" in why.summary and "`pico stop --now`" in why.hint
    (place.root / "devices.yaml").unlink()
    assert own.wiring.refusal() is not None and edge_of(place).apparatus.wiring.refusal() is not None
    (place.root / "devices.yaml").write_bytes(before)
    assert own.wiring.refusal() is None


def test_a_wrong_devices_file_keeps_light_in_and_the_devices_that_end_it(place: BenchPlace) -> None:
    path = place.root / "devices.yaml"
    path.write_text(path.read_text().replace("switches.laser", "switches.lasr"))
    own = edge_of(place).apparatus
    assert own.wiring.refusal() is not None and own.setup.wiring is not None
    assert "laser.emission" in own.device.links.lights().emissions  # type: ignore[attr-defined]
