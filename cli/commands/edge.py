"""`pico edge`."""

from __future__ import annotations

import asyncio
import os
import signal
import threading
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..arguments import Fidelity, group
from ..session import Session
from ..terminal.waiting import waiting
from ..views import edge as view

HEADING = "The simulator, and the rest"
ORDER = 150

if TYPE_CHECKING:
    from pico.edge.local import LocalEdge
    from pico.edge.network.enrolment import Enrolment
    from pico.model.wiring import DeviceEntry

Url = Annotated[str, typer.Argument(metavar="URL", help="The coordinator's address.")]
Code = Annotated[str, typer.Option("--code", metavar="CODE", help="A code that an admin of the coordinator made.")]
WithInput = Annotated[bool, typer.Option("--with-input", hidden=True, help="End with standard input, as on SIGTERM.")]
Pin = Annotated[str, typer.Option("--pin", metavar="SHA256", help="The coordinator's certificate, if it is its own.")]

app = group(
    help="Serve the bench to other commands, until Ctrl-C or SIGTERM."
    "\n\n"
    "Runs then go on whoever listens. With --backend hardware every device is connected first, with --emulate an "
    "emulator of each is started; commands say the same --backend and --emulate. What moves when it is ended comes to "
    "a safe end. A bench that is enrolled with a coordinator connects to it. Exit code 5: somebody else serves it.",
    examples=(
        "pico edge",
        "pico edge --backend hardware --emulate",
        "pico edge enrol https://lab.example.org --code CODE",
    ),
    alone=True,
)


@app.callback()
def main(context: typer.Context, fidelity: Fidelity = None, with_input: WithInput = False) -> None:
    if context.invoked_subcommand is not None:
        return
    from pico.edge.link.server import edge_of
    from pico.edge.network.enrolment import read_enrolment
    from pico.manifest.load import find_lab

    session = Session.of(context)
    root = find_lab(session.folder)
    if with_input:
        threading.Thread(target=_end_with_input, daemon=True).start()
    place = session.here(root)  # which also puts back what a killed `pico gui` left
    asyncio.run(_serve(session, edge_of(place, fidelity), read_enrolment(place)))


@app.command()
def enrol(context: typer.Context, url: Url, code: Code, pin: Pin = "") -> None:
    """Enrol the bench with a coordinator, which alone grants it from then on.

    An admin of the coordinator makes the code: `pico token enrol LAB/BENCH`. `pico edge` then connects to it.

    Examples:
      pico edge enrol https://lab.example.org --code pico_edge_...
    """
    from pico.edge.network.enrolment import enrol
    from pico.manifest.load import find_lab

    session = Session.of(context)
    found = enrol(session.here(find_lab(session.folder)), url, code, pin)
    session.say(f"The bench is enrolled as {found.bench} at {found.url}; `pico edge` connects it.")


@app.command()
def withdraw(context: typer.Context) -> None:
    """Let the bench be granted by itself again, and connect to no coordinator.

    Examples:
      pico edge withdraw
    """
    from pico.edge.network.enrolment import withdraw
    from pico.manifest.load import find_lab

    session = Session.of(context)
    withdraw(session.here(find_lab(session.folder)))
    session.say("The bench is enrolled with no coordinator any more.")


async def _serve(session: Session, edge: LocalEdge, enrolment: Enrolment | None) -> None:
    from pico.edge.link import place
    from pico.edge.link.server import serve

    beside: Any = None
    try:
        if enrolment is not None:
            from pico.edge.network.uplink import Uplink

            beside = Uplink(edge, enrolment, session.say).run
        with waiting("Connecting to the devices"):
            devices = await _reached(edge)
        able = await edge.describe()
        shown = (edge.setup.lab.name, able, place.make(edge.place), devices)
        await serve(edge, lambda: session.show(view, *shown), beside)
    finally:
        await edge.close()
    session.say(f"{edge.setup.lab.name} is served no more.")


def _end_with_input() -> None:
    while os.read(0, 4096):
        pass
    os.kill(os.getpid(), signal.SIGTERM)


async def _reached(edge: LocalEdge) -> dict[str, DeviceEntry]:
    """Connect to the devices of a bench that has any, and return where they were reached."""
    from pico.backends.hardware.device import HardwareDevice

    return await edge.device.links.reached() if isinstance(edge.device, HardwareDevice) else {}
