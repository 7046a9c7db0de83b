"""A device is added by one file with its entry point: planned for, moved, recorded, never taken for the simulator."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from commanding import Pico

TRAY = '''
import json
import math
from pico.backends.device import Capabilities
from pico.model.observation import Observation, ObservedComponent, ObservedRobot, ObservedValue
from pico.model.operation import OperationResult
from pico.model.pose import Pose
from pico.model.state import home_state, place_of


class Tray:
    """Parts on a tray that somebody carries about: whatever it is told is so at once, and kept in a file."""

    def __init__(self, setup, root, fidelity):
        self.fidelity = fidelity
        self.setup, self.path = setup, root / "tray.json"

    def _load(self):
        if self.path.exists():
            return json.loads(self.path.read_text())
        homes = home_state(self.setup)
        return {n: {"pose": place_of(self.setup, homes, n)[1], "values": {}} for n in self.setup.lab.inventory}

    async def describe(self):
        return Capabilities(name="tray", fidelity=self.fidelity, evidence="emulated", lab_digest=self.setup.digest(),
                            primitives=frozenset({"move", "stow", "set", "home", "park"}), robots=("arm1",))

    async def observe(self):
        parts = {}
        for name, part in self._load().items():
            pose = part["pose"] if isinstance(part["pose"], Pose) else Pose(**part["pose"])
            kinds = self.setup.type_of(name).tunables
            values = {t: ObservedValue(value=part["values"].get(t), status="known" if t in part["values"]
                                       else "unknown") for t in kinds}
            parts[name] = ObservedComponent(presence="seen", pose=pose, values=values)
        arm = ObservedRobot(joints=tuple(math.radians(a) for a in self.setup.lab.robots["arm1"].park))
        return Observation(backend="tray", components=parts, robots={"arm1": arm}, person=False)

    async def execute(self, operation, key, began):
        before = (await self.observe()).components.get(operation.component)
        began(before)
        seen = {n: {"pose": vars_of(p.pose), "values": {k: v.value for k, v in p.values.items() if v.value is not None}}
                for n, p in (await self.observe()).components.items()}
        if operation.primitive in ("move", "stow"):
            seen[operation.component]["pose"] = dict(operation.arguments["to"]["pose"])
        elif operation.primitive in ("set", "home"):
            tunable = operation.arguments["tunable"]
            seen[operation.component]["values"][tunable] = operation.arguments.get("to", 0.0)
        self.path.write_text(json.dumps(seen))
        after = (await self.observe()).components.get(operation.component)
        return OperationResult(key=key, outcome="done", before=before, after=after)

    async def take(self, token, tell, require): ...
    async def leave(self): ...
    async def close(self): ...
    async def halt(self): ...
    async def stop(self): ...
    def watch(self, look): ...
    def kept(self): return True


def vars_of(pose):
    return {"x": pose.x, "y": pose.y, "yaw": pose.yaw}


def opened(setup, place, fidelity, clock):
    return Tray(setup, place.root, fidelity)
'''


@pytest.fixture
def tray(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    about = tmp_path / "site" / "tray-1.0.dist-info"
    about.mkdir(parents=True)
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: tray\nVersion: 1.0\n")
    (about / "entry_points.txt").write_text("[pico.devices]\ntray = tray:opened\n")
    (tmp_path / "site" / "tray.py").write_text(TRAY)
    monkeypatch.syspath_prepend(tmp_path / "site")
    yield


def simulated(pico: Pico) -> dict[str, Any]:
    found: dict[str, Any] = pico("status", "--json").data
    return {key: value for key, value in found.items() if key != "observed_at"}


def test_a_plug_in_brings_a_device(tray: None, shel: Path, pico: Pico) -> None:
    before = simulated(pico)
    answer = pico("apply", "e1", "--auto-approve", "--backend", "tray")
    assert answer.code == 0, answer
    assert pico("plan", "e1", "--detailed-exitcode", "--backend", "tray").code == 0
    assert simulated(pico) == before  # the simulated table is another one
    (run,) = pico("runs", "list", "--all", "--json", "--backend", "tray").data["runs"]
    assert (run["document"]["evidence"], run["document"]["bench"]) == ("emulated", "tray")


def test_a_device_that_there_is_not_is_told_with_those_that_there_are(shel: Path, pico: Pico) -> None:
    answer = pico("status", "--backend", "simm")
    assert answer.code == 1
    assert "there is no backend `simm`" in answer.err and "sim" in answer.err.split("help")[1]
