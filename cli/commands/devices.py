"""`pico devices`: the instruments of a bench."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from pico.backends.devices import EMULATED, HARDWARE
from pico.diagnostics import Diagnostic, ExitCode

from ..arguments import group
from ..session import Session
from ..terminal.waiting import waiting
from ..views import device_properties as properties
from ..views import devices as view

if TYPE_CHECKING:
    from pico.edge.network.remotes import Place

HEADING = "The simulator, and the rest"
ORDER = 230

app = group(
    help="List the instruments of the bench, and ask whether they answer.",
    examples=(
        "pico devices",
        "pico devices check",
        "pico devices check p1 --emulate",
        "pico devices identify p1",
        "pico devices read meter",
    ),
    alone=True,
)

Names = Annotated[list[str] | None, typer.Argument(metavar="DEVICE", help="Which ones; without any, all.")]


@app.callback()
def main(context: typer.Context) -> None:
    if context.invoked_subcommand is None:
        list_(context)


@app.command("list")
def list_(context: typer.Context) -> None:
    """List the devices that the lab's files name; asks none. `pico devices` alone does the same.

    How far a driver was tried stands beside each: documented, emulated, against the vendor's firmware, on a device.

    Examples:
      pico devices list
    """
    from pico.backends.instruments import instruments, listed

    session = Session.of(context)
    session.show(view, listed(instruments(session.folder)))


@app.command()
def check(context: typer.Context, devices: Names = None) -> int:
    """Ask devices who they are and what they read, with --emulate emulators in their place. Nothing moves.

    Exit code 1 where one does not answer, or another one does than the lab names.

    Examples:
      pico devices check
      pico devices check p1 --emulate
    """
    return _asked(context, devices, whoever=False)


@app.command()
def identify(context: typer.Context, devices: Names = None) -> int:
    """Ask who answers at the addresses, whatever the lab says, and show what to write into `identity:`.

    Examples:
      pico devices identify p1
    """
    return _asked(context, devices, whoever=True)


@app.command()
def read(context: typer.Context, devices: Names = None) -> int:
    """Show what devices reply for each of their properties, the unit, and the value in the lab's unit. Nothing moves.

    A reply that is not a valid number is shown as unknown, with the reason. Exit code 1: a device does not answer.

    Examples:
      pico devices read meter
      pico devices read p1_mount --emulate --json
    """
    from pico.backends.instruments import asked, bench_of, named
    from pico.backends.properties import properties_of
    from pico.manifest.load import find_lab
    from pico.vision.calibration_files import accepted_axes

    session = Session.of(context)
    setup = bench_of(session.folder)
    root = find_lab(session.folder)
    place = session.place(root)
    with waiting("Asking the devices"):
        rows = asked(named(setup, devices or ()), emulate=place.name == EMULATED, properties=True)
    _tell_of_another(session, place)
    axes = accepted_axes(root, EMULATED if place.name == EMULATED else HARDWARE)
    session.show(properties, properties_of(setup, rows, axes))
    wrong = [d for row in rows if row.answer for d in row.answer.diagnostics]
    session.tell(wrong)
    return ExitCode.ERROR if any(one.severity == "error" for one in wrong) else ExitCode.DONE


def _asked(context: typer.Context, devices: list[str] | None, *, whoever: bool) -> int:
    from pico.backends.instruments import asked, instruments
    from pico.manifest.load import find_lab

    session = Session.of(context)
    entries = instruments(session.folder, devices or ())
    place = session.place(find_lab(session.folder))
    with waiting("Asking the devices"):
        rows = asked(entries, emulate=place.name == EMULATED, whoever=whoever)
    _tell_of_another(session, place)
    session.show(view, rows, identify=whoever)
    wrong = [d for row in rows if row.answer for d in row.answer.diagnostics]
    session.tell(wrong)
    return ExitCode.ERROR if any(one.severity == "error" for one in wrong) else ExitCode.DONE


def _tell_of_another(session: Session, place: Place) -> None:
    """Tell that another process has the devices of this bench, if one serves it."""
    from pico.edge.link import place as sockets
    from pico.places.bench import BenchPlace

    if not isinstance(place, BenchPlace) or sockets.find(place) is None:
        return
    text = "another process serves this bench, and has opened its devices"
    hint = "one that takes a single connection does not answer a second program; `pico status` shows what that process "
    hint += "reads"
    if place.name == EMULATED:
        text = "another process serves this bench: these are emulators of this command's own, not those of that process"
        hint = "`pico status` shows what that process reads"
    session.tell([Diagnostic("note", "served", text, hint=hint)])
