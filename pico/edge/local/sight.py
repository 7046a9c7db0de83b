"""What an edge sees of its bench: observations, pictures and readings; nothing of that moves anything."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING

from pico.backends.device import Capabilities, Clearable, Device, Shown
from pico.diagnostics import PicoError
from pico.edge.local.apparatus import Apparatus
from pico.model.instruments.fault import DeviceFault
from pico.model.measurement import Measurement
from pico.model.observation import Observation

if TYPE_CHECKING:
    from pico.backends.sight import Look
    from pico.twin.moment import Moment


class Sight:
    """Looks at one bench, and adds what the journal knows of parts in hands and what lets lasers emit."""

    def __init__(self, apparatus: Apparatus) -> None:
        self._apparatus = apparatus
        self._able: tuple[Device, Capabilities] | None = None
        self._last: Observation | None = None

    async def observe(self) -> Observation:
        """Look, and return what was seen; raises PicoError if nothing can be seen."""
        self._apparatus.require_kept()
        self._last = await self._with_licences(self._with_hands(await self._apparatus.device.observe()))
        return self._last

    async def moment(self) -> Moment:
        """Return the bench as it is now, as far as that is known without looking; raises PicoError."""
        from pico.twin.moment import moment_of

        device = self._apparatus.device
        if isinstance(device, Shown):
            return await device.moment()
        return moment_of(self._last or Observation(backend=(await self._apparatus.describe()).name))

    async def look(self) -> Look:
        """Look through the cameras and return what they see; raises PicoError if there are none."""
        self._apparatus.require_kept()
        found = await self._apparatus.device.look()
        return replace(found, observation=await self._with_licences(self._with_hands(found.observation)))

    async def peek(self, component: str, measurable: str) -> Measurement:
        """Acquire a measurable as the bench is, without lease; raises PicoError."""
        self._apparatus.require_kept()
        return await self._apparatus.device.peek(component, measurable)

    async def faults(self) -> tuple[DeviceFault, ...]:
        """Return the faults that devices keep; raises PicoError for links that are lost."""
        device = self._apparatus.device
        return await device.faults() if isinstance(device, Clearable) else ()

    def _with_hands(self, seen: Observation) -> Observation:
        """Return the observation with what the journal knows of the parts in the hands: where they were picked."""
        if not any(robot.holding or robot.opening is not None for robot in seen.robots.values()):
            return seen
        from pico.edge.grip import with_picks

        with suppress(PicoError):  # looking must not fail because of the journal
            memory = self._apparatus.journals.memory
            return with_picks(self._apparatus.setup, memory, seen) if memory else seen
        return seen

    async def _with_licences(self, seen: Observation) -> Observation:
        from pico.edge.emission import with_licences

        own = self._apparatus
        if self._able is None or self._able[0] is not own.device:
            self._able = own.device, await own.device.describe()
        from pico.edge.guard.table_lock import notice

        seen = replace(seen, problems=(*seen.problems, *notice(own.place)))
        return await with_licences(own.setup, own.place, self._able[1], own.device, own.now(), seen)
