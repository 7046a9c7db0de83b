"""Two boxes of switches at the wire: one with lasers and shutters, one with safety inputs; and the guard over them."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from bench_at import bench_at
from laser_lab import bench

from pico.backends.hardware.instruments import Instruments, wired
from pico.backends.hardware.lights import Lights
from pico.backends.hardware.settings import Settings
from pico.drivers.registry import Buses
from pico.emulators.behind import Alone
from pico.emulators.switches import DeadMen, Switches, WatchedBox
from pico.model.setup import Setup
from pico.model.wiring import DeviceEntry, SafetyEntry, Wiring
from pico.places.bench import BenchPlace

LIGHTS = {"laser_shutter": ("laser", "shutter"), "laser_head": ("laser", "laser"), "bare_head": ("bare", "laser")}
INPUTS = {"door_box": "door", "estop": "emergency_stop", "lock": "interlock", "key": "key", "veil": "curtain"}
PROPERTY = {"shutter": "open", "laser": "emission", "input": "safe"}


class Box:
    """A box of switches; one that is `frozen` answers no more, though its port still takes what is sent."""

    def __init__(self, names: dict[str, tuple[str, Any]]) -> None:
        self.behind = {name: Alone({PROPERTY[kind]: first}) for name, (kind, first) in names.items()}
        known = {name: (PROPERTY[kind], self.behind[name]) for name, (kind, _) in names.items()}
        box = self
        dead_men = DeadMen(known)
        self.frozen = self.forgets_dead_men = False

        class Heard:
            """A conversation that stands still while the box is frozen."""

            def __init__(self) -> None:
                self.link, self.waits = Switches("1", known, dead_men), b""

            def heard(self, data: bytes) -> bytes:
                self.waits += data.replace(b"keep", b"hold") if box.forgets_dead_men else data
                return self.due()

            def due(self) -> bytes:
                if box.frozen:
                    return b""
                said, self.waits = self.waits, b""
                return self.link.heard(said) if said else b""

        self.served = WatchedBox(Heard, dead_men)

    def is_(self, name: str) -> Any:
        return next(iter(self.behind[name]._values.values()))

    def put(self, name: str, value: Any) -> None:
        for key in self.behind[name]._values:
            self.behind[name].write(key, value)


@dataclass
class Rig:
    """A bench of lasers at the wire with its guard."""

    setup: Setup
    place: BenchPlace
    lights: Lights
    lasers: Box
    inputs: Box

    def lit(self) -> dict[str, bool]:
        """Whether light leaves each laser, measured at the emulated devices."""
        with_shutter = bool(self.lasers.is_("laser_head")) and bool(self.lasers.is_("laser_shutter"))
        return {"laser": with_shutter, "bare": bool(self.lasers.is_("bare_head"))}

    def ends_within(self, seconds: float, *names: str) -> float:
        """Return after how long [s] the light of these lasers has ended; fails after `seconds`."""
        began = time.monotonic()
        while any(self.lit()[name] for name in names or ("laser", "bare")):
            assert time.monotonic() - began < seconds, f"still lit after {seconds} s: {self.lit()}"
            time.sleep(0.005)
        return time.monotonic() - began

    def stays_lit(self, seconds: float = 0.5, *names: str) -> bool:
        """Return whether these lasers, or all, emit after a while [s]."""
        time.sleep(seconds)
        return all(self.lit()[name] for name in names or ("laser", "bare"))


def entry(box: Box, kind: str, name: str, of: str | None = None, **settings: Any) -> DeviceEntry:
    address = {**box.served.address, "name": name}
    return DeviceEntry(driver=f"switches.{kind}", address=address, of=of, settings=settings)


@contextmanager
def guarded(
    root: Path, *, watch: bool = True, watchdog: float | None = None, head_watchdog: float | None = None,
    **policy: Any,
) -> Iterator[Rig]:  # fmt: skip
    """Yield a bench whose lasers emit, with its guard at work unless told otherwise."""
    lasers = Box({name: (kind, True) for name, (_, kind) in LIGHTS.items()})
    inputs = Box(dict.fromkeys(INPUTS, ("input", True)))
    more = {"watchdog": watchdog} if watchdog is not None else {}
    head = {"watchdog": head_watchdog} if head_watchdog is not None else {}
    own = {"shutter": more, "laser": head}
    devices = {
        name: entry(lasers, kind, name, of, **(own[kind] if of == "laser" else {}))
        for name, (of, kind) in LIGHTS.items()
    }
    devices |= {name: entry(inputs, "input", name) for name in INPUTS}
    safety = {name: SafetyEntry(kind=kind, device=name) for name, kind in INPUTS.items()}  # type: ignore[arg-type]
    setup = replace(bench(**policy), wiring=Wiring(lab="minimal", devices=devices, safety_inputs=safety))
    place, buses = bench_at(root, "hardware"), Buses()
    place.folder.mkdir(parents=True, exist_ok=True)
    made: Instruments = wired(setup, devices, buses, Settings(place))
    lights = Lights(setup, place, made)

    async def let_go() -> None:
        for one in made.all.values():
            await one.close()
        await buses.close()

    try:
        if watch:
            asyncio.run(made.connect())
            lights.watch()
            until(lambda: lights.guard is not None and lights.guard.lit == ("bare", "laser"))
        yield Rig(setup, place, lights, lasers, inputs)
    finally:
        lights.close()
        asyncio.run(let_go())
        lasers.served.close()
        inputs.served.close()


def until(true: Callable[[], bool], seconds: float = 5.0) -> None:
    """Wait until something is true."""
    began = time.monotonic()
    while not true():
        assert time.monotonic() - began < seconds
        time.sleep(0.005)
