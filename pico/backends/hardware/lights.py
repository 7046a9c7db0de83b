"""The lasers of a real bench with the devices that end their light, and the guard that watches them."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import replace

from pico.backends.hardware.guard import note as notes
from pico.backends.hardware.guard.aside import Aside
from pico.backends.hardware.guard.ending import Light, LightEnd, end_light
from pico.backends.hardware.guard.note import Ended, Frozen, Note
from pico.backends.hardware.guard.verdict import LIGHT, PRESENCE, Trip
from pico.backends.hardware.guard.watch import WRITING, Guard, Told, Watched
from pico.backends.hardware.instruments import Instruments
from pico.base import clock
from pico.diagnostics import PicoError
from pico.drivers.driven import Emitting, Shut, word
from pico.drivers.protocols import Arm, DeadMan, Laser, Shutter
from pico.model.quantities import Value
from pico.model.setup import Setup
from pico.optics.audit.lasers import laser_class
from pico.places.bench import BenchPlace


def lasers_of(setup: Setup) -> tuple[str, ...]:
    """Return the lasers of a bench, by name."""
    return tuple(n for n in sorted(setup.lab.inventory) if setup.type_of(n).optics.element == "source")


class Lights(Told):
    """What ends light on the bench at `place`, through `bench`'s devices, connected or not. Each method may be called
    from any thread."""

    def __init__(self, setup: Setup, place: BenchPlace, bench: Instruments) -> None:
        self._setup, self._place, self._bench = setup, place, bench
        tunables = bench.tunables
        self.emissions: dict[str, Laser] = {a: t.instrument for a, t in tunables.items() if isinstance(t, Emitting)}
        self.shutters: dict[str, Shutter] = {a: t.instrument for a, t in tunables.items() if isinstance(t, Shut)}
        self.gates: Mapping[str, str] = {}
        """The shutter on the table that stands in the beam of a laser, as the bench was seen last."""
        self.listening: Callable[[Ended, Trip | None], None] | None = None
        """Who writes the journal; called in a thread of its own, for a journal that is locked keeps nothing waiting."""
        self.disarming: Callable[[str], tuple[str, ...]] | None = None
        """Who ends what arms lasers above class 2, on behalf of whom it is told, and returns of which."""
        self.session: Callable[[Trip], None] | None = None
        """Who has the bench: it hears of a trip before anything is closed."""
        self.moving: Callable[[], tuple[Arm, ...]] = tuple
        self._lock = threading.Lock()
        self._guard: Guard | None = None
        self._outcomes: dict[str, object] = {}  # by laser: what was told of it, since light was let out
        self._journal = Aside("pico guard journal")
        self._over = False  # whether light was ended because this process ends, and is off
        self._dark = False  # whether all lasers were dark: what is let out then is let out anew

    def lights(self) -> tuple[Light, ...]:
        """Return each laser with the devices that end its light; a laser that none ends is left out."""
        found = []
        for name in lasers_of(self._setup):
            emission = self.emissions.get(f"{name}.emission")
            own = [f"{name}.shutter", f"{self.gates.get(name, '')}.shutter"]
            shutters = {address: self.shutters[address] for address in own if address in self.shutters}
            if emission is not None or shutters:
                found.append(Light(name, (f"{name}.emission", emission) if emission else None, shutters))
        return tuple(found)

    @property
    def guard(self) -> Guard | None:
        """The guard at work, None if the bench has no laser that a device could shut."""
        return self._guard

    @property
    def is_dark(self) -> bool:
        """Whether all lasers are proven dark that a device could make dark."""
        return not self.lights() or (self._guard is not None and self._guard.is_dark)

    def values(self) -> dict[str, Value]:
        """Return what lasers and shutters read, by address, as the guard heard it last."""
        heard = self._guard.heard() if self._guard is not None else {}
        return {a: word(on) if a in self.shutters else on for a, on in heard.items()}

    def watch(self) -> None:
        """Start the guard, once the devices are connected; a bench without lasers needs none."""
        lights = self.lights()
        if not lights or self._guard is not None:
            return
        with self._lock, suppress(PicoError):  # a note that can't be written must not keep the guard from its work
            before = notes.read(self._place)
            if before.killed is not None:  # told until light is let out anew
                notes.write(self._place, before)
        watched = Watched(
            lights=self.lights, shutters=self.shutters, emissions=self.emissions, inputs=self._bench.inputs,
            classes={light.laser: laser_class(self._setup, light.laser, {})[0] for light in lights},
            presence_ends=self._setup.lab.policy.presence_ends, arms=self._moving,
        )  # fmt: skip
        self._guard = Guard(watched, self)
        self._guard.start()

    def _moving(self) -> tuple[Arm, ...]:
        return self.moving()

    def close(self) -> None:
        """End the guard. That it watched a laser that may still emit is told by who comes next, unless another process
        guards it by then."""
        guard, self._guard = self._guard, None
        if guard is not None:
            guard.close()
            self._journal.finish(WRITING)
            if guard.is_dark or self._over:
                self._kept(lambda note: replace(note, watch=None))

    async def end(self, why: str, by: str, *, disarms: bool = True) -> Ended:
        """End all light now, because of `why`; return what became of each laser, and keep that. `disarms`: what arms
        lasers above class 2 ends with it."""

        def now(ends: tuple[LightEnd, ...]) -> Ended:
            known = {one.laser for one in ends}
            before = notes.read(self._place)  # it may name a laser that was since removed from the files
            watched = {name for one in (before.killed, before.watch) if one is not None for name in one.lasers}
            names = sorted({*lasers_of(self._setup), *watched} - known)
            loose = (LightEnd(laser=name, closings=()) for name in names)
            return Ended(at=clock.now(), why=why, by=by, ends=(*(one for one in ends if one.laser), *loose))

        disarming = asyncio.create_task(asyncio.to_thread(self._disarmed, by, disarms))
        ends = await end_light((*self.lights(), *self._loose()), lambda ends: self._note(now(ends)))
        ended = replace(now(ends), disarmed=await disarming)
        self._over = by == notes.EDGE_END and all(one.is_dark for one in ended.ends)
        if ended.ends:
            await asyncio.to_thread(self._tell, ended, None)
            await asyncio.to_thread(self._journal.finish, WRITING)
            if (said := notes.read(self._place).ended) is not None:  # a stop that is given again says it again
                ended = replace(ended, disarmed=tuple(sorted({*ended.disarmed, *said.disarmed})))
        return ended

    def _disarmed(self, by: str, disarms: bool) -> tuple[str, ...]:
        return self.disarming(by) if disarms and self.disarming is not None else ()

    def _note(self, ended: Ended) -> None:
        self._kept(lambda note: notes.with_ended(note, ended))

    def _tell(self, ended: Ended, trip: Trip | None) -> None:
        self._note(ended)
        if (heard := self.listening) is not None:
            self._journal.do(lambda: heard(ended, trip))

    async def tripped(self, why: str) -> None:
        """Keep that an operation ended light because of `why`, if a laser was lit."""
        if self._guard is not None and self._guard.lit:
            inputs = self._bench.inputs.items()
            curtain = any(entry.kind in PRESENCE and why.startswith(f"{name} (") for name, (entry, _) in inputs)
            await self.end(why, notes.GUARDED, disarms=not curtain)

    def _loose(self) -> tuple[Light, ...]:
        used = {address for light in self.lights() for address in light.shutters}
        rest = {address: one for address, one in self.shutters.items() if address not in used}
        return (Light("", None, rest),) if rest else ()

    # what the guard tells

    def trips(self, trip: Trip) -> None:
        if self.session is not None:
            self.session(trip)

    def slow(self, trip: Trip, ends: tuple[LightEnd, ...]) -> None:
        if not {end.laser for end in ends} <= self._outcomes.keys():  # else it is told that it could not be ended
            self._note(self._of(trip, ends))

    def ended(self, trip: Trip, ends: tuple[LightEnd, ...]) -> None:
        causes = [cause.name for cause in trip.causes]
        outcomes = {end.laser: (end.is_dark, causes) for end in ends}
        known = {name: self._outcomes.get(name) for name in outcomes}
        if outcomes == known and not all(end.is_dark for end in ends):
            return  # it was tried again, in vain: that is told already
        self._outcomes |= outcomes
        self._tell(self._of(trip, ends), trip)

    def _of(self, trip: Trip, ends: tuple[LightEnd, ...]) -> Ended:
        """Return what is told of a trip. One by a door, an emergency stop, a key or an interlock ends armings."""
        disarmed = self._disarmed(notes.GUARDED, any(cause.kind in LIGHT for cause in trip.causes))
        return Ended(at=clock.now(), why=trip.said, ends=ends, disarmed=disarmed)

    def lit(self, lasers: tuple[str, ...]) -> None:
        if lasers and self._dark:
            self._outcomes.clear()

        def changed(note: Note) -> Note:
            if not lasers:
                return replace(note, watch=None)
            itself = tuple(light.laser for light in self.lights() if light.laser in lasers and closes_itself(light))
            watch = notes.watching(lasers, itself)
            return Note(watch=watch) if self._dark else replace(note, watch=watch)

        self._kept(changed)
        self._dark = not lasers

    def froze(self, seconds: float, lasers: tuple[str, ...]) -> None:
        self._kept(lambda note: replace(note, frozen=Frozen(until=clock.now(), seconds=seconds, lasers=lasers)))

    def _kept(self, change: Callable[[Note], Note]) -> None:
        with self._lock, suppress(PicoError):  # a full disk keeps no light on; the note says then that it is full
            before = notes.read(self._place)
            if (after := change(before)) != before or notes.is_unwritten(self._place):
                notes.write(self._place, after)


def closes_itself(light: Light) -> bool:
    """Return whether a dead-man ends the light of a laser once nothing refreshes it."""
    devices = (*light.shutters.values(), *((light.emission[1],) if light.emission else ()))
    return any(isinstance(one, DeadMan) and one.dead_man is not None for one in devices)
