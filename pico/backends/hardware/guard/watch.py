"""The guard at work: a thread with a loop of its own that asks lasers, shutters and safety inputs, and ends light.

It needs no lease, and nothing that runs can keep it waiting: each device has a worker thread of its own
(`pico.drivers.bus`) through which runs and guard ask in turn, and closing goes before all that waits there. Each device
is closed on its own: one that is silent, an arm that does not stop or a disk that is slow keeps no other light on.
"""

from __future__ import annotations

import asyncio
import threading
import time
from collections.abc import Awaitable, Callable, Coroutine, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

from pico.backends.hardware.guard.aside import Aside
from pico.backends.hardware.guard.ending import Light, LightEnd, UnderWay, end_light
from pico.backends.hardware.guard.hearing import HELD, Hearing
from pico.backends.hardware.guard.verdict import LaserState, Trip, verdict
from pico.base.awake import Awake
from pico.diagnostics import PicoError
from pico.drivers.protocols import Arm, DeadMan, Laser, SafetyInput, Shutter
from pico.model.arming import LaserClass
from pico.model.wiring import SafetyEntry

EVERY = 0.08
"""Seconds between two questions to a device while light may be out; a device answers within milliseconds."""
IDLE = 0.15
"""Seconds between two questions to lasers and shutters while all are dark; safety inputs are not asked then."""
ASKING = 0.5
"""How long one question may take [s]; the next one is asked then."""
AGAIN = 0.5
"""Seconds after which light that could not be ended is tried again."""
HALTING = 2.5
"""How long an arm may take to stop [s]; nothing waits for it."""
WRITING = 6.0
"""How long what was done may take to be written when the guard ends [s]."""
FROZE = 1.0
"""A pause of EVERY that took so long is told: light was unwatched meanwhile [s]."""
A_DAY = 86400.0
"""A pause that is longer by the wall's clock is one that somebody set [s]."""


@dataclass(frozen=True, eq=False)
class Watched:
    """What a guard watches: `lights`, one a laser, as they stand now; `shutters` and `emissions`: all devices that can
    end light, by address; `inputs`: the safety inputs; `classes`: of each laser; `presence_ends`: see `verdict`;
    `arms`: those in motion now."""

    lights: Callable[[], tuple[Light, ...]]
    shutters: Mapping[str, Shutter]
    emissions: Mapping[str, Laser]
    inputs: Mapping[str, tuple[SafetyEntry, SafetyInput]]
    classes: Mapping[str, LaserClass]
    presence_ends: LaserClass | None = None
    arms: Callable[[], tuple[Arm, ...]] = tuple


class Told:
    """Who hears what a guard does, in a thread of its own that no closing waits for. By default nobody does."""

    def trips(self, trip: Trip) -> None:
        """Hear, in the guard's own thread and before anything is closed, that light ends; must return at once."""

    def slow(self, trip: Trip, ends: tuple[LightEnd, ...]) -> None:
        """Hear how each laser stands while a device has not answered yet that is to end its light."""

    def ended(self, trip: Trip, ends: tuple[LightEnd, ...]) -> None:
        """Hear what became of each laser."""

    def lit(self, lasers: tuple[str, ...]) -> None:
        """Hear which lasers may emit from now on; none if all are dark."""

    def froze(self, seconds: float, lasers: tuple[str, ...]) -> None:
        """Hear that this process stood still while lasers might emit."""


class Guard:
    """Guards the lasers of one bench from `start` to `close`."""

    def __init__(self, watched: Watched, told: Told, clock: Callable[[], float] = time.monotonic) -> None:
        self._watched, self._told, self._wall, self._clock = watched, told, clock, Awake(clock, HELD).now
        self._hearing = Hearing(since=self._clock())
        self._loop: asyncio.AbstractEventLoop | None = None
        self._closing: asyncio.Event | None = None
        self._thread = threading.Thread(target=lambda: asyncio.run(self._run()), daemon=True, name="pico guard")
        self._begun = threading.Event()
        self._lit: tuple[str, ...] = ()
        self._judged = False
        self._closings: UnderWay = {}
        self._halts: dict[int, asyncio.Task[None]] = {}
        self._acts = set[asyncio.Task[None]]()
        self._tries: dict[str, tuple[float, frozenset[str]]] = {}  # by laser: when it was tried last, for which causes
        self._aside = Aside("pico guard tells")

    def start(self) -> None:
        """Begin to watch."""
        self._thread.start()
        self._begun.wait()

    def close(self) -> None:
        """Watch no more; what is being closed comes to its end."""
        if self._loop is not None and self._closing is not None and self._thread.is_alive():
            with suppress(RuntimeError):  # it has ended meanwhile
                self._loop.call_soon_threadsafe(self._closing.set)
            self._thread.join(5.0)
        self._aside.finish(WRITING)

    @property
    def lit(self) -> tuple[str, ...]:
        """The lasers that may emit, as far as was heard last."""
        return self._lit

    def heard(self) -> dict[str, bool]:
        """Return what lasers and shutters said last, by address: whether each emits, or is open; none if unknown."""
        own = self._watched
        known = {address: self._hearing.heard.get(address) for address in (*own.emissions, *own.shutters)}
        return {a: one.value for a, one in known.items() if one is not None and isinstance(one.value, bool)}

    @property
    def is_dark(self) -> bool:
        """Whether every laser was heard to be dark."""
        return self._judged and not self._lit

    async def _run(self) -> None:
        self._loop, self._closing = asyncio.get_running_loop(), asyncio.Event()
        self._begun.set()
        own = self._watched
        jobs: list[Coroutine[Any, Any, None]] = [self._tick()]
        jobs += [self._ask(address, one.emitting) for address, one in own.emissions.items()]
        jobs += [self._ask(address, one.is_open) for address, one in own.shutters.items()]
        jobs += [self._ask(name, one.read, when_lit=True) for name, (_, one) in own.inputs.items()]
        devices = {**own.emissions, **own.shutters}
        jobs += [self._refresh(address, one) for address, one in devices.items() if isinstance(one, DeadMan)]
        tasks = [asyncio.create_task(job) for job in jobs]
        await self._closing.wait()
        for task in tasks:
            task.cancel()
        if left := [*self._acts, *self._halts.values()]:
            await asyncio.wait(left)

    # asking

    async def _ask(self, name: str, ask: Callable[[], Awaitable[Any]], *, when_lit: bool = False) -> None:
        """Ask one device again and again, and judge after each answer."""
        while True:
            if when_lit and not self._lit:
                await asyncio.sleep(EVERY / 4)
                continue
            try:
                found = await asyncio.wait_for(ask(), ASKING)
            except (PicoError, TimeoutError) as exc:
                self._hearing.failed(name, exc)
            except Exception as exc:  # a fault of a driver must not end the guard
                self._hearing.failed(name, exc)
            else:
                self._hearing.answered(name, found, self._clock())
            self._judge()
            await asyncio.sleep(EVERY if self._lit else IDLE)

    async def _refresh(self, address: str, one: DeadMan) -> None:
        """Keep the dead-man of a device from closing it while it may be on or open, whether or not light leaves the
        laser: a head warms up and settles behind its closed shutter. What is being closed is not kept."""
        while True:
            if (within := one.dead_man) is None:
                return
            known = self._hearing.heard.get(address)
            if address not in self._closings and (known is None or known.value is not False):
                with suppress(PicoError, TimeoutError, Exception):  # if it is not heard, it closes: as it should
                    await asyncio.wait_for(one.refresh(), ASKING)
            await asyncio.sleep(min(within / 4, EVERY * 2))

    async def _tick(self) -> None:
        """Notice that this process itself stood still while light might be out, by the clock that stands still with it
        or by the wall's, and judge though no device answers."""
        last = self._wall(), time.time()
        while True:
            await asyncio.sleep(EVERY)
            now = self._wall(), time.time()
            pause = max(one - other for one, other in zip(now, last, strict=True))
            if self._lit and FROZE < pause < A_DAY:
                self._aside.do(partial(self._told.froze, pause, self._lit))
            last = now
            self._judge()

    # judging and acting

    def _states(self, now: float) -> dict[str, LaserState]:
        own, found = self._watched, {}
        for light in own.lights():
            emission = light.emission[0] if light.emission else None
            found[light.laser] = self._hearing.laser(emission, light.shutters, own.classes[light.laser], now)
        return found

    def _judge(self) -> None:
        now, own = self._clock(), self._watched
        if not all(address in self._hearing.heard for address in (*own.emissions, *own.shutters)):
            return  # not every device was asked once
        lasers = self._states(now)
        lit = tuple(sorted(name for name, state in lasers.items() if not state.is_dark))
        if lit != self._lit or not self._judged:
            if not self._lit:
                self._hearing.since = now  # safety inputs are asked from now on
            self._lit, self._judged = lit, True
            self._aside.do(partial(self._told.lit, lit))
        inputs = {name: self._hearing.input(name, entry, now) for name, (entry, _) in own.inputs.items()}
        trip = verdict(inputs, lasers, own.presence_ends)
        if trip is None or not (due := self._due(trip, now)):
            return
        self._tries |= {name: (now, _names(trip)) for name in due}
        act = asyncio.create_task(self._act(replace(trip, lasers=due)))
        self._acts.add(act)
        act.add_done_callback(self._acts.discard)

    def _due(self, trip: Trip, now: float) -> tuple[str, ...]:
        """Return the lasers of a trip to which its causes are new, and those that have a device that is not being
        closed, if they were not tried just now."""
        causes, due = _names(trip), []
        devices = {
            light.laser: {*light.shutters, *((light.emission[0],) if light.emission else ())}
            for light in self._watched.lights()
        }
        for name in trip.lasers:
            at, known = self._tries.get(name, (float("-inf"), frozenset()))
            if known != causes or (now - at >= AGAIN and devices[name] - self._closings.keys()):
                due.append(name)
        return tuple(due)

    async def _act(self, trip: Trip) -> None:
        """End the light of the lasers of a trip, stop arms that it stops, and tell it."""
        with suppress(Exception):  # whatever becomes of who hears it, light ends
            self._told.trips(trip)
        if trip.stops_arms:
            self._halt()
        own = self._watched
        used = {address for light in own.lights() for address in light.shutters}
        spare = {a: one for a, one in own.shutters.items() if a not in used}
        ends = await end_light(
            [*(light for light in own.lights() if light.laser in trip.lasers), Light("", None, spare)],
            lambda now: self._aside.do(partial(self._told.slow, trip, _named(now))), self._closings,
        )  # fmt: skip
        now = self._clock()
        for closing in (closing for end in ends for closing in end.closings if closing.dark):
            self._hearing.answered(closing.address, False, now)
        self._aside.do(partial(self._told.ended, trip, _named(ends)))

    def _halt(self) -> None:
        """Have the arms in motion stop; nothing waits for them."""
        for arm in self._watched.arms():
            key = id(arm)
            if key not in self._halts:
                task = self._halts[key] = asyncio.create_task(_stopped(arm))
                task.add_done_callback(lambda _, key=key: self._halts.pop(key, None))  # type: ignore[misc]


def _named(ends: tuple[LightEnd, ...]) -> tuple[LightEnd, ...]:
    return tuple(end for end in ends if end.laser)


def _names(trip: Trip) -> frozenset[str]:
    return frozenset(cause.name for cause in trip.causes)


async def _stopped(arm: Arm) -> None:
    with suppress(Exception):  # the session says what became of it
        await asyncio.wait_for(arm.stop(), HALTING)
