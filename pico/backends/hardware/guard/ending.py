"""Ending light: every shutter closes and emission is switched off, all at once, and what each laser then reads."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Iterable, Mapping
from dataclasses import dataclass, field
from functools import partial

from pico.diagnostics import PicoError
from pico.drivers.protocols import Laser, Shutter
from pico.model.record import record

PATIENCE = 2.5
"""How long one device may take to end its light [s]; the others do not wait for it."""
SOON = 0.6
"""After how long a device that did not answer is told of, though it may answer still [s]."""


@dataclass(frozen=True, eq=False)
class Light:
    """A laser with the devices that end its light. `emission`: the address and the device that switch it, if one does.
    `shutters`: those that close its beam, by address."""

    laser: str
    emission: tuple[str, Laser] | None = None
    shutters: Mapping[str, Shutter] = field(default_factory=dict)


@record
class Closing:
    """What became of one device that was to end light: its `address`, whether it reads dark now, and what is `wrong`
    with it, '' for nothing."""

    address: str
    dark: bool
    wrong: str = ""


@record
class LightEnd:
    """How the light of one laser was ended: by which devices, and whether it is proven dark now."""

    laser: str
    closings: tuple[Closing, ...]

    @property
    def is_dark(self) -> bool:
        """Whether it is proven that no light leaves it."""
        return any(one.dark for one in self.closings)

    @property
    def wrong(self) -> str:
        """What could not be closed, in words."""
        return "; ".join(f"{one.address}: {one.wrong}" for one in self.closings if one.wrong)


UnderWay = dict[str, asyncio.Task[Closing]]
"""The devices that are being closed now, by address."""


async def end_light(
    lights: Iterable[Light],
    slow: Callable[[tuple[LightEnd, ...]], object] | None = None,
    under_way: UnderWay | None = None,
) -> tuple[LightEnd, ...]:
    """Close the shutters of these lasers and switch off their emission, at once, and return what became of each; waits
    for no device longer than PATIENCE. `slow`: is given the state of all after SOON if a device did not answer by then.
    `under_way`: what others are closing, too: a device there is not closed a second time.
    """
    under_way = {} if under_way is None else under_way
    jobs = [(light.laser, _begun(light, under_way)) for light in lights]
    tasks = [task for _, closings in jobs for task in closings.values()]
    _, late = await asyncio.wait(tasks, timeout=SOON) if tasks else (None, None)
    if late and slow is not None:
        slow(_ends(jobs))
    if late:
        await asyncio.wait(late)
    return _ends(jobs)


def _begun(light: Light, under_way: UnderWay) -> UnderWay:
    ways: dict[str, Callable[[bool], Awaitable[bool]]] = {a: one.open for a, one in light.shutters.items()}
    if light.emission is not None:
        address, laser = light.emission
        ways[address] = laser.emit
    for address, way in ways.items():
        if address not in under_way:
            task = under_way[address] = asyncio.create_task(_closed(address, way))
            task.add_done_callback(partial(_over, under_way, address))
    return {address: under_way[address] for address in ways}


def _over(under_way: UnderWay, address: str, _: object) -> None:
    under_way.pop(address, None)


def _ends(jobs: Iterable[tuple[str, Mapping[str, asyncio.Task[Closing]]]]) -> tuple[LightEnd, ...]:
    waits = f"it has not answered for {SOON:g} s"
    return tuple(
        LightEnd(
            laser=laser,
            closings=tuple(
                task.result() if task.done() else Closing(address=address, dark=False, wrong=waits)
                for address, task in closings.items()
            ),
        )
        for laser, closings in jobs
    )


async def _closed(address: str, way: Callable[[bool], Awaitable[bool]]) -> Closing:
    try:
        on = await asyncio.wait_for(way(False), PATIENCE)
    except TimeoutError:
        return Closing(address=address, dark=False, wrong=f"it did not answer within {PATIENCE:g} s")
    except PicoError as exc:
        return Closing(address=address, dark=False, wrong=exc.diagnostics[0].summary)
    except Exception as exc:  # a fault of a driver must not keep the others from being told
        return Closing(address=address, dark=False, wrong=f"its driver failed: {exc}")
    wrong = "it still reads open" if address.endswith(".shutter") else "it still reads on"
    return Closing(address=address, dark=not on, wrong=wrong if on else "")
