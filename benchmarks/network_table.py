"""The emulated table of a lab on the network, with the controllers of its devices, in a process of its own; and the log
of what these controllers did, which no other process writes.

The log has a JSON object a line, times by the wall's clock [s]: `{"moves": DEVICE, "since", "until"}` for each time
that something went from rest to rest, `{"fingers": ROBOT, "at", "takes", "pose", "drops", "toppled"}` for what a hand
took and let go of.
"""

from __future__ import annotations

import json
import pickle
import threading
import time
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

REST = 0.15
"""What did not move for so long has come to rest [s]."""
STILL = 1e-7
"""A joint that turns by less does not move [rad]."""


@dataclass
class Clock:
    """The clock of the emulated table, as another process reads it: both go by the machine's monotonic one."""

    began: float
    since: float
    pace: float

    def now(self) -> float:
        return self.since + (time.monotonic() - self.began) * self.pace

    def store(self) -> None:
        """It is kept by the process that has it."""


@dataclass
class Entries:
    """The devices with the addresses that lead to their emulators."""

    entries: dict[str, Any]

    def close(self) -> None:
        """They are another process's."""


class Log:
    """What controllers did, written to a file as soon as it is over."""

    def __init__(self, path: Path) -> None:
        self._file, self._lock = path.open("a"), threading.Lock()
        self._moving: dict[str, list[float]] = {}

    def moves(self, device: str) -> None:
        """Hear that a device is elsewhere than just before."""
        now = time.time()
        with self._lock:
            self._ends(now)
            self._moving.setdefault(device, [now, now])[1] = now

    def says(self, **what: Any) -> None:
        """Write something that took no time."""
        with self._lock:
            print(json.dumps({**what, "at": time.time()}), file=self._file, flush=True)

    def ends(self) -> None:
        """Write what came to rest since."""
        with self._lock:
            self._ends(time.time())

    def _ends(self, now: float) -> None:
        for device, (since, until) in list(self._moving.items()):
            if now - until > REST:
                del self._moving[device]
                print(json.dumps({"moves": device, "since": since, "until": until}), file=self._file, flush=True)


def table(root: Path, note: Path, log: Path) -> None:
    """Have the emulated table in this process, kept in `root`, and write what leads there."""
    from pico.backends.emulated import bench
    from pico.backends.instruments import emulated
    from pico.edge import own_lab
    from pico.places.bench import BenchPlace

    lab = own_lab.proposed(root)
    assert lab is not None
    setup, kept = own_lab.setup_of(lab), Log(log)
    devices = dict(setup.wiring.devices) if setup.wiring else {}
    bench.EmulatedWorld = _logged(kept)  # type: ignore[misc]
    world, running = bench.brought_up(setup, BenchPlace(root, "emulated"), emulated(devices))
    clock = Clock(time.monotonic(), world.now(), world.pace)
    partial = note.with_suffix(".part")
    partial.write_bytes(pickle.dumps((clock, running.entries)))
    partial.replace(note)
    while True:
        time.sleep(0.1)
        kept.ends()
        world.store()


def _logged(log: Log) -> type:
    """Return the world behind emulated devices, which tells a log what they do to it."""
    from pico.backends.emulated.world import EmulatedWorld
    from pico.model.quantities import Value
    from pico.motion.types import Joints

    class Logged(EmulatedWorld):
        def moved(self, robot: str, joints: Joints) -> None:
            if max(abs(a - b) for a, b in zip(self.joints(robot), joints, strict=True)) > STILL:
                log.moves(robot)
            super().moved(robot, joints)

        def set_value(self, component: str, tunable: str, value: Value) -> None:
            if self.value(component, tunable) != value:
                log.moves(f"{component}.{tunable}={value}" if isinstance(value, str) else f"{component}.{tunable}")
            super().set_value(component, tunable, value)

        def fingers(self, robot: str, joints: Joints, wanted: float, now: float) -> float:
            before = self.world().robots[robot].holding
            found = super().fingers(robot, joints, wanted, now)
            after = self.world()
            holding = after.robots[robot].holding
            if holding != before:
                part = after.components[holding or before or ""]
                log.says(
                    fingers=robot, takes=holding, drops=before, toppled=part.presence == "toppled",
                    pose=part.pose and asdict(part.pose), wanted=wanted,
                )  # fmt: skip
            return found

    return Logged
