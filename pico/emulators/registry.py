"""Emulators by name, from the entry points `pico.emulators`; and a whole bench of them, with the addresses swapped."""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import replace
from functools import cache
from importlib.metadata import EntryPoint
from types import MappingProxyType

from pico.diagnostics import Diagnostic, PicoError, did_you_mean, error, warning
from pico.emulators.behind import Behind, Emulator, Running
from pico.emulators.disturbance import Disturbed, Line, OnWire
from pico.model.instruments.emulation import Disturbance
from pico.model.wiring import DeviceEntry
from pico.plug_ins.calling import Interface, guarded, having, instance, loaded
from pico.plug_ins.faults import CODE
from pico.plug_ins.known import entries, own_module, plug_in

GROUP = "pico.emulators"
NOTHING: Mapping[str, Disturbance] = MappingProxyType({})


@cache
def known() -> Mapping[str, EntryPoint]:
    """Return the emulators that are installed, by name; imports none."""
    return entries(GROUP)


INTERFACE = Interface(GROUP, {"": instance(Emulator)})


def emulator(name: str) -> Emulator:
    """Return an emulator; raises PicoError for a name that there is not, and for a plug-in that is broken."""
    if name not in known():
        raise PicoError(error("emulator", f"there is no emulator `{name[:40]}`", hint=did_you_mean(name[:40], known())))
    found: Emulator = loaded(INTERFACE, known()[name])
    one = plug_in(GROUP, known()[name])
    return (
        found
        if own_module(one.module)
        else replace(found, started=guarded(one, found.started, having("address", "close"), what="started"))
    )


class EmulatedBench:
    """Emulators of a bench's devices, running; `entries` are the devices with the addresses that lead to them.
    `failed`: why others have none, by device: none is named, it is not installed, or it is broken."""

    def __init__(
        self, devices: Mapping[str, DeviceEntry], behind: Callable[[str, DeviceEntry], Behind],
        scenario: Mapping[str, Disturbance] = NOTHING, seed: int = 1,
    ) -> None:  # fmt: skip
        """Start one for each link; `scenario`: what goes wrong with devices, by name, drawn from `seed`. Whatever else
        an emulator of PICO raises ends those that run."""
        self._running: list[Running] = []
        self.entries: dict[str, DeviceEntry] = {}
        self.failed: dict[str, tuple[Diagnostic, ...]] = {}
        try:
            for name, together in self._links(devices).items():
                try:
                    started = emulator(name[0]).started({
                        n: (entry, _disturbed(behind(n, entry), scenario.get(n), f"{seed} {n}"))
                        for n, entry in together.items()
                    })  # fmt: skip
                except PicoError as exc:
                    if any(one.code != CODE for one in exc.diagnostics):
                        raise
                    self.failed |= dict.fromkeys(together, tuple(exc.diagnostics))
                    continue
                self._running.append(started)
                about = next((scenario[n] for n in together if n in scenario), None)
                if about and isinstance(started, OnWire):
                    drawn = random.Random(f"{seed} wire {next(iter(together))}")
                    started.line = Line(about, drawn, started.reboot)
                for n, entry in together.items():
                    who = {key: said for key, said in getattr(started, "identity", {}).items() if key in entry.identity}
                    address = {**entry.address, **started.address}
                    self.entries[n] = replace(entry, address=address, identity={**entry.identity, **who})
        except BaseException:
            self.close()
            raise

    def _links(self, devices: Mapping[str, DeviceEntry]) -> dict[tuple[str, ...], dict[str, DeviceEntry]]:
        """Return the devices by emulator and by what of their addresses is one link."""
        links: dict[tuple[str, ...], dict[str, DeviceEntry]] = {}
        for name, entry in devices.items():
            try:
                if not entry.emulator:
                    raise PicoError(no_emulator(name))
                bus = emulator(entry.emulator).bus
            except PicoError as exc:
                self.failed[name] = tuple(exc.diagnostics)
                continue
            parts = (str(entry.address.get(part, "")) for part in bus)
            links.setdefault((entry.emulator, *parts), {})[name] = entry
        return links

    def close(self) -> None:
        """End all of them."""
        for running in self._running:
            with suppress(Exception):
                running.close()
        self._running.clear()


def _disturbed(behind: Behind, about: Disturbance | None, seed: str) -> Behind:
    return Disturbed(behind, about, random.Random(seed)) if about else behind


def no_emulator(name: str) -> Diagnostic:
    """Return what is said of a device that is left out, for it has no emulator."""
    text = f"{name} has no emulator: it is left out, and all others are emulated"
    return warning("emulator", text, hint="name one by `emulator:` of the device", address=name)
