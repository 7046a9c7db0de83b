"""What really happens behind the wires of an emulated bench: what its world goes through, what its devices are told,
and the proxies on its wires at which things go wrong."""

from __future__ import annotations

import re
import threading
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from proxy import Faults, Proxy

from pico.backends.emulated import bench as emulated
from pico.backends.emulated.world import EmulatedWorld
from pico.emulators.registry import EmulatedBench
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.model.wiring import DeviceEntry
from pico.motion.types import Joints
from pico.places.bench import BenchPlace

MOVES = {
    "elliptec.rotator": re.compile(rb"(?P<at>[0-9A-F])(?:ho|m[ar])"),
    "zaber.stage": re.compile(rb"/0?(?P<at>\d+) \d+ \d+ (?:home|move)"),
    "switches": re.compile(rb"set (?P<at>\w+) [01]"),
}
"""What the words of each protocol are that let a device do something, and to which it says so."""


@dataclass(frozen=True)
class Told:
    """What happened: `took`, `let go` (of a component), `moved` (a robot), `told` (a device), `began`, `ended` (a key
    of the journal). `now`: of the wall [s]."""

    now: float
    what: str
    name: str
    data: Any = None


class Log:
    """All that happened, in the order in which it did; written by many threads."""

    def __init__(self) -> None:
        self.told: list[Told] = []
        self._lock = threading.Lock()

    def add(self, what: str, name: str, data: Any = None) -> None:
        """Take note of something."""
        with self._lock:
            self.told.append(Told(time.monotonic(), what, name, data))


class Watched(EmulatedWorld):
    """A world that tells the log what its hands do."""

    log: Log

    def moved(self, robot: str, joints: Joints) -> None:
        super().moved(robot, joints)
        self.log.add("moved", robot)

    def _take(self, robot: str, joints: Joints, name: str) -> None:
        self.log.add("took", name, self._world.components[name].pose)
        super()._take(robot, joints, name)

    def _let_go(self, robot: str, joints: Joints, name: str) -> None:
        super()._let_go(robot, joints, name)
        body = self._world.components[name]
        self.log.add("let go", name, (body.presence, body.pose))


class Hears(list[bytes]):
    """What a proxy passes on to a device, and the log hears: who of those on the wire is told to move."""

    def __init__(self, log: Log, devices: Mapping[str, str], words: re.Pattern[bytes] | None) -> None:
        """`devices`: by what their wire calls them."""
        self._log, self._devices, self._words = log, devices, words

    def append(self, data: bytes) -> None:
        """Hear."""
        for found in self._words.finditer(data) if self._words else ():
            at = found["at"].decode()
            self._log.add("told", self._devices.get(at, at), found[0].decode())


class Wires:
    """The proxies on the wires of a bench, by the devices on each, and the emulated arms."""

    def __init__(self, log: Log) -> None:
        self.log = log
        self.world: Any = None
        self.proxies: dict[tuple[str, ...], Proxy] = {}
        self.arms: list[Any] = []
        """The emulators of arms, which have no proxy: the vendor's library takes reports from fixed ports only."""

    def tap(self) -> None:
        """Have each emulated bench that is opened from now on lead through proxies, with a world that is watched."""
        brought_up = emulated.brought_up
        Watched.log = self.log

        def tapped(setup: Setup, place: BenchPlace, entries: dict[str, DeviceEntry]) -> tuple[Any, EmulatedBench]:
            world, bench = brought_up(setup, place, entries)
            self.world, self.arms = world, [one for one in bench._running if hasattr(one, "joints")]
            self.proxies = {}
            links: dict[str, list[str]] = {}
            for name, entry in bench.entries.items():
                if not entry.driver.startswith(("xarm", "basler")):
                    where = [str(entry.address.get(k, "")) for k in ("host", "port", "visa")]
                    links.setdefault(" ".join(where), []).append(name)
            for names in links.values():
                first = bench.entries[names[0]]
                faults = Faults()
                said = first.driver if first.driver in MOVES else first.driver.split(".")[0]
                at = {str(bench.entries[n].address.get(k)): n for n in names for k in ("bus", "device", "name")}
                faults.heard = Hears(self.log, at, MOVES.get(said))
                proxy = self.proxies[tuple(names)] = Proxy(dict(first.address), faults)
                for name in names:
                    entry = bench.entries[name]
                    bench.entries[name] = replace(entry, address={**entry.address, **proxy.address})
            return world, bench

        emulated.EmulatedWorld = Watched  # type: ignore[misc]
        emulated.brought_up = tapped

    def close(self) -> None:
        """End the proxies."""
        for proxy in self.proxies.values():
            proxy.close()
        self.proxies = {}


class Lateness:
    """How late this machine was with a thread that only sleeps."""

    def __init__(self) -> None:
        self.worst = 0.0
        threading.Thread(target=self._beat, daemon=True).start()

    def _beat(self) -> None:
        while True:
            before = time.monotonic()
            time.sleep(0.05)
            self.worst = max(self.worst, time.monotonic() - before - 0.05)

    def take(self) -> float:
        """Return how late it was since this was asked last [s]."""
        found, self.worst = self.worst, 0.0
        return found


def journalled(log: Log) -> None:
    """Have the log hear of every operation that the journal has begun or ended."""
    from pico.runs.journal import Journal

    def told(method: Callable[..., Any], what: str, key: Callable[..., Any]) -> Callable[..., Any]:
        def told_too(self: Journal, *given: Any) -> Any:
            if what == "began":
                log.add(what, *key(self, *given))
            found = method(self, *given)
            if what == "ended":
                log.add(what, *key(self, *given))
            return found

        return told_too

    Journal.started = told(Journal.started, "began", lambda j, key, *_: (key, j.records(key=key)[0].data))  # type: ignore[method-assign]
    Journal.ended = told(Journal.ended, "ended", lambda j, result, *_: (result.key, result))  # type: ignore[method-assign]


def stands(world: Any) -> dict[str, tuple[str, Pose | None]]:
    """Return how and where the components truly are."""
    return {name: (body.presence, body.pose) for name, body in world.world().components.items()}
