"""The simulator, and the rest, 13: `pico edge`."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import typer

from ..arguments import Fidelity
from ..session import Session
from ..terminal.waiting import waiting
from ..views import edge as view

if TYPE_CHECKING:
    from pico.edge.local import LocalEdge
    from pico.model.wiring import DeviceEntry


def edge(context: typer.Context, fidelity: Fidelity = None) -> None:
    """Serve the bench to other commands, until Ctrl-C or SIGTERM.

    Runs then go on whoever listens. With --backend hardware every device is connected first, with --emulate an
    emulator of each is started; commands say the same --backend and --emulate. What moves when it is ended comes to a
    safe end. Exit code 5: somebody else serves it.

    Examples:
      pico edge
      pico edge --backend hardware --emulate
    """
    from pico.edge.link.server import edge_of
    from pico.manifest.load import find_lab

    session = Session.of(context)
    asyncio.run(_serve(session, edge_of(find_lab(session.folder), session.backend, fidelity)))


async def _serve(session: Session, edge: LocalEdge) -> None:
    from pico.edge.link import place
    from pico.edge.link.server import serve

    try:
        with waiting("Connecting to the devices"):
            devices = await _reached(edge)
        able = await edge.describe()
        await serve(edge, lambda: session.show(view, edge.setup.lab.name, able, place.make(edge.root), devices))
    finally:
        await edge.close()
    session.say(f"{edge.setup.lab.name} is served no more.")


async def _reached(edge: LocalEdge) -> dict[str, DeviceEntry]:
    """Connect to the devices of a bench that has any, and return where they were reached."""
    from pico.backends.hardware.device import HardwareDevice

    return await edge.device.links.reached() if isinstance(edge.device, HardwareDevice) else {}
