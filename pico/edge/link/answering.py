"""What an edge answers to calls, whatever link they came over."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from dataclasses import dataclass, field
from typing import Any

from pico.content.store import store_of
from pico.diagnostics import PicoError, error
from pico.edge.link import wire
from pico.edge.link.pictures import Arrays, look_as_json, packed
from pico.edge.link.stills import Stills
from pico.edge.live.following import follow
from pico.edge.local import LocalEdge
from pico.edge.protocol import Lease
from pico.model.record import as_json
from pico.plug_ins.faults import blamed
from pico.vision.calibration import Calibration


@dataclass
class Taken:
    """What calls took for a client, which it lets go of by being gone: leases, and unattended runs that it holds."""

    leases: list[Lease] = field(default_factory=list)
    runs: list[str] = field(default_factory=list)

    async def let_go(self, edge: LocalEdge) -> None:
        """Give back what was taken."""
        for lease in self.leases:
            await edge.release(lease)
        for run in self.runs:
            await edge.alone.gone(run)


class Answering:
    """Answers calls to `edge`."""

    def __init__(self, edge: LocalEdge) -> None:
        self.edge = edge
        self._arrays: Arrays = {}
        self._stills = Stills(edge)

    async def answers(self, name: str, arguments: list[Any], taken: Taken) -> AsyncIterator[dict[str, Any]]:
        """Yield the documents that answer a call; what it takes is added to `taken`."""
        try:
            if name in wire.STREAMS:
                stream = follow(self.edge) if name == "live" else self.edge.events(*arguments)
                async for item in stream:
                    yield {"next": as_json(item)}
                yield {"value": None}
                return
            found = await self._called(name, arguments)
            if isinstance(found, Lease):
                taken.leases.append(found)
            if name == "hold":
                taken.runs.append(arguments[0].recipe)
            yield {"value": as_json(found)}
        except PicoError as exc:
            yield wire.failure(exc)
        except Exception as exc:  # the others must go on
            yield wire.failure(
                PicoError(blamed(exc) or error("internal", f"the edge failed: {type(exc).__name__}: {exc}"))
            )

    async def _called(self, name: str, arguments: list[Any]) -> Any:
        if name == "look":
            return await self._look()
        if name == "picture":
            return await self._stills.of(*arguments)
        if name == "array":
            return self._array(*arguments)
        owner, _, method = name.partition(".")
        if owner == "memory":
            return await asyncio.to_thread(self._remembered, method, arguments)
        if owner == "world":
            return await asyncio.to_thread(self._simulated, method, arguments)
        return await getattr(self.edge, name)(*arguments)

    async def _look(self) -> dict[str, Any]:
        document, self._arrays = look_as_json(await self.edge.look())
        return document

    def _array(self, name: str) -> str:
        """Return a picture of the last look, or what a run kept that a commit has no room for."""
        return packed(self._arrays[name] if name in self._arrays else store_of(self.edge.place.root).get(name))

    def _remembered(self, method: str, arguments: list[Any]) -> Any:
        memory = self.edge.memory
        if not method or memory is None:
            return memory is not None
        if method == "records":
            return memory.records(run=arguments[0], key=arguments[1])
        found = getattr(memory, method)(*arguments)
        return tuple(found) if method == "successes" else found

    def _simulated(self, method: str, arguments: list[Any]) -> Any:
        world = self.edge.world
        if not method:
            return None
        if method == "nudge":
            name, dx, dy, dyaw = arguments
            return world.nudge(name, dx=dx, dy=dy, dyaw=dyaw)
        if method == "bump":
            return world.bump(arguments[0], shift=arguments[1], turn=arguments[2])
        if method == "upset":
            return world.upset(arguments[0], **arguments[1])
        if method == "true_cameras":
            return Calibration(cameras=world.true_cameras()).as_json()
        return getattr(world, method)(*arguments)
