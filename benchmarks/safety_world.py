"""A bench of lasers at the wire in a process of its own, for `benchmarks/safety_chain.py`.

Makes a lab in a folder, starts an emulator of each of its devices with a simulated world behind, writes their addresses
into `devices.yaml` beside the lab, so that `pico --backend hardware` takes them for real, and obeys lines of JSON on
standard input, each answered by one: `["lit"]` (whether light leaves each laser, as the emulated devices have it),
`["watch"]` (note from now on when light ends), `["ended"]` (when it ended, by the wall [s]), `["pull", DEVICE, true]`,
`["freeze", BOX, true]` (its port takes everything and answers nothing), `["cut", BOX]`.

`laser` has a shutter and is switched, `bare` has no shutter; `second`, on a bench of three lasers, is as `laser`. All
are of class 2, so they need no arming.
"""

from __future__ import annotations

import json
import shutil
import sys
import threading
import time
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

import yaml  # noqa: E402

from pico.backends.emulated.bench import brought_up  # noqa: E402
from pico.backends.instruments import emulated  # noqa: E402
from pico.emulators import switches  # noqa: E402
from pico.manifest.load import load_folder  # noqa: E402
from pico.places.bench import BenchPlace  # noqa: E402


class Plain(yaml.SafeDumper):
    """Writes every value out: a manifest has no anchors."""

    def ignore_aliases(self, data: Any) -> bool:
        return True


def dumped(document: Any) -> str:
    """Return a document as YAML."""
    return str(yaml.dump(document, Dumper=Plain, sort_keys=False))


GOALS = {"bright": {"maximize": "camera.peak", "tunables": {"camera.exposure": [0.02, 20]},
                    "budget": {"measurements": 60, "seconds": 60}}}  # fmt: skip
"""What the camera in the beam can be optimized for."""
LIGHT, INPUTS = 4000, 4001
"""The ports of the box of lasers and shutters, and of that of safety inputs, as the lab has them."""
KINDS = {"door_box": "door", "lock": "interlock", "estop": "emergency_stop", "veil": "curtain"}
BENCHES = {"one arm": 1, "two arms": 2, "no arm": 0, "three lasers": 1}
"""How many arms each kind of bench has."""
MOUNTS = {"arm1": {"x": 480, "y": 760, "yaw": -90}, "arm2": {"x": 900, "y": 100, "yaw": 90}}


def laser_type(name: str, *, shutter: bool) -> str:
    """Return a component type: a laser of class 2 that lights at once, with or without a shutter."""
    document = yaml.safe_load((ROOT / "catalog" / "hene_laser.yaml").read_text())
    document["metadata"]["name"] = f"{name}_laser"
    document["parameters"]["power"]["value"] = 0.9
    document["parameters"]["laser_class"]["value"] = "2"
    document["tunables"]["emission"]["settle"] = 50
    if not shutter:
        del document["tunables"]["shutter"]
    return dumped(document)


def make_lab(folder: Path, watchdog: float | None, kind: str = "one arm") -> None:
    """Write the lab: as many arms as its `kind` has, two cameras over the table, one in the beam, two or three lasers,
    four safety inputs."""
    folder.mkdir(parents=True, exist_ok=True)
    lab = yaml.safe_load((ROOT / "labs" / "minimal" / "lab.yaml").read_text())
    lab["cameras"] = {name: {**lab["cameras"][name], "pixels": [1224, 1024]} for name in ("left", "right")}
    lab["policy"] = {"presence_ends": "2", "open_beam": True}
    lab["goals"] = GOALS
    arms = list(MOUNTS)[: BENCHES[kind]]
    lab["robots"] = {name: {"model": "xarm7", "mount": MOUNTS[name]} for name in arms}
    if not arms:
        del lab["robots"]
    lasers = {"laser": True, "bare": False} | ({"second": True} if kind == "three lasers" else {})
    lab["inventory"]["laser"]["type"] = "weak_laser"
    lab["inventory"]["bare"] = {"type": "bare_laser", "pose": {"x": 200, "y": 600, "yaw": 0}}
    if "second" in lasers:
        lab["inventory"]["second"] = {"type": "weak_laser", "pose": {"x": 200, "y": 200, "yaw": 0}}
    (folder / "lab.yaml").write_text(dumped(lab))
    (folder / "weak_laser.yaml").write_text(laser_type("weak", shutter=True))
    (folder / "bare_laser.yaml").write_text(laser_type("bare", shutter=False))
    (folder / "state").mkdir(exist_ok=True)
    shutil.copy(ROOT / "labs" / "minimal" / "state" / "table.yaml", folder / "state")
    state = yaml.safe_load((folder / "state" / "table.yaml").read_text())
    state["components"]["bare"] = {"emission": True}
    if "second" in lasers:
        state["components"]["second"] = {"emission": True, "shutter": "open"}
    (folder / "state" / "table.yaml").write_text(dumped(state))

    def box(port: int, name: str) -> dict[str, Any]:
        return {"host": "192.0.2.20", "port": port, "name": name}

    cams = {"left": 5001, "right": 5002, "camera": 5003}
    settings = {"settings": {"watchdog": watchdog}} if watchdog is not None else {}
    devices: dict[str, Any] = {
        **{n: {"driver": "frames.camera", "address": {"host": "192.0.2.10", "port": p}} for n, p in cams.items()},
        **{name: {"driver": "switches.input", "address": box(INPUTS, name)} for name in KINDS},
    }
    for number, name in enumerate(arms):
        address = {"host": f"192.0.2.{222 + number}"}
        devices[name] = {
            "driver": "xarm.arm", "address": address, "identity": {"serial": f"XI13050012345{6 + number}"},
            "settings": {"tool_z": 172},
        }  # fmt: skip
        devices[f"{name}_hand"] = {"driver": "xarm.gripper", "of": name, "address": dict(address)}
    for name, shuts in lasers.items():
        head = {"driver": "switches.laser", "of": name, "address": box(LIGHT, name)}
        devices[f"{name}_head"] = head if shuts else {**head, **settings}
        if shuts:
            at = box(LIGHT, f"{name}_shutter")
            devices[f"{name}_shutter"] = {"driver": "switches.shutter", "of": name, "address": at, **settings}
    document = {
        "apiVersion": "pico/v1", "kind": "Devices", "metadata": {"lab": "minimal"}, "devices": devices,
        "safety_inputs": {name: {"kind": kind, "device": name} for name, kind in KINDS.items()},
    }  # fmt: skip
    (folder / "devices.yaml").write_text(dumped(document))


class World:
    """The emulators of a lab, and the world behind them."""

    def __init__(self, folder: Path) -> None:
        setup, _ = load_folder(folder).require()
        assert setup.wiring is not None
        self.behind, self.bench = brought_up(
            setup, BenchPlace(folder, "emulated"), emulated(dict(setup.wiring.devices))
        )
        document = yaml.safe_load((folder / "devices.yaml").read_text())
        for name, said in document["devices"].items():
            entry = self.bench.entries[name]
            said["address"], said["identity"] = dict(entry.address), dict(entry.identity)
            said["settings"] = dict(entry.settings)
        (folder / "devices.yaml").write_text(dumped(document))
        ports = {name: int(self.bench.entries[name].address["port"]) for name in ("laser_head", "door_box")}
        self.ports = {"light": ports["laser_head"], "inputs": ports["door_box"]}
        self.frozen = set[str]()
        self.ended_at: dict[str, float] = {}
        self._watching = False
        threading.Thread(target=self._note, daemon=True).start()

    def lit(self) -> dict[str, bool]:
        """Return whether light leaves each laser."""
        known = self.behind.setup.lab.inventory
        emits = {
            name: self.behind.value(name, "emission") is True for name in ("laser", "bare", "second") if name in known
        }
        opens = {name: name == "bare" or self.behind.value(name, "shutter") == "open" for name in emits}
        return {name: on and opens[name] for name, on in emits.items()}

    def _note(self) -> None:
        while True:
            time.sleep(0.002)
            if self._watching:
                now = time.time()
                for name, lit in self.lit().items():
                    if lit:
                        self.ended_at.pop(name, None)
                    else:
                        self.ended_at.setdefault(name, now)

    def obey(self, what: str, *words: Any) -> Any:
        """Do what a line says, and return its answer."""
        if what == "lit":
            return self.lit()
        if what == "watch":
            self.ended_at.clear()
            self._watching = True
        elif what == "ended":
            return dict(self.ended_at)
        elif what == "pull":
            self.behind.pull(*words)
        elif what == "freeze":
            (self.frozen.add if words[1] else self.frozen.discard)(words[0])
        elif what == "cut":
            for running in self.bench._running:
                if running.address.get("port") == self.ports[words[0]]:
                    running.close()
        return time.time()


def main(folder: str, watchdog: str = "", kind: str = "one arm") -> None:
    """Serve the bench until standard input ends."""
    make_lab(Path(folder), float(watchdog) if watchdog else None, kind)
    world = World(Path(folder))
    heard = switches.Switches.heard

    def frozen(self: Any, data: bytes) -> bytes:
        box = "light" if "laser" in self._switches else "inputs"
        return b"" if box in world.frozen else heard(self, data)

    switches.Switches.heard = frozen  # type: ignore[method-assign]
    print(json.dumps("ready"), flush=True)
    for line in sys.stdin:
        print(json.dumps(world.obey(*json.loads(line))), flush=True)
