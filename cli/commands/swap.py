"""`pico swap`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from pico.base import clock
from pico.diagnostics import ExitCode, PicoError, error

from ..arguments import Component, DryRun, Yes
from ..session import Session
from ..views import swap as view

HEADING = "The simulator, and the rest"
ORDER = 140

if TYPE_CHECKING:
    from pico.model.lab import Known
    from pico.model.quantities import Value

MOST = 100
"""Characters of a serial number."""


def swap(
    context: typer.Context,
    name: Component,
    serial: Annotated[str, typer.Option("--serial", metavar="SERIAL", help="Of the specimen that is in it now.")],
    kind: Annotated[str | None, typer.Option("--type", metavar="TYPE", help="Its type, where it is another.")] = None,
    focal_length: Annotated[
        str | None, typer.Option("--focal-length", metavar="LENGTH", help='As measured: "100.3 mm".')
    ] = None,
    retardance: Annotated[str | None, typer.Option("--retardance", metavar="WAVES", help="As measured: 0.498.")] = None,
    parameter: Annotated[
        list[str] | None, typer.Option("--parameter", metavar="KEY=VALUE", help="Another one; may be given again.")
    ] = None,
    sigma: Annotated[
        str | None, typer.Option("--sigma", metavar="VALUE", help="One standard deviation of what is given.")
    ] = None,
    measured: Annotated[
        str | None, typer.Option("--measured", metavar="DAY", help="When that was measured; today.")
    ] = None,
    valid_for: Annotated[
        str | None, typer.Option("--valid-for", metavar="TIME", help='How long it counts: "365 d".')
    ] = None,
    auto_approve: Yes = False,
    dry_run: DryRun = False,
) -> int:
    """Record that the optic in a mount was replaced.

    The bench's own Lab and lab.yaml take it over; nothing moves. Goals whose light comes through it are stale from
    then on, until they are met again. Swap back the same way. Exit code 1 where somebody says no, 5 where the bench
    is in use.

    Examples:
      pico swap lx_100 --serial B7 --focal-length "100.3 mm" --sigma "0.2 mm"
    """
    from pico.bench import updating
    from pico.manifest.load import find_lab

    session = Session.of(context)
    place = session.place(find_lab(session.folder))
    if len(serial) > MOST or not serial.isprintable():
        text = f"`{''.join(c if c.isprintable() else '?' for c in serial[:40])}` is no serial number"
        raise PicoError(error("usage", text, hint=f"what stands on the part, in one line of at most {MOST} characters"))
    own = {"focal_length": focal_length, "retardance": retardance}
    given = _pairs([*(parameter or ()), *(f"{key}={value}" for key, value in own.items() if value)])
    known = _known(given, sigma, measured, valid_for)
    found = updating.swapped(place, name, serial, kind, given, known)
    if dry_run or found.same:
        session.show(view, found, done=False)
        return ExitCode.DONE
    session.require_answer(auto_approve)
    session.say(view.text(found, done=False))
    if not session.confirm(f"\nTake {serial} as the specimen in {name}?", auto_approve):
        session.say("Nothing was swapped.")
        return ExitCode.ERROR
    updating.swap(place, found)
    if session.json:
        session.document(view.data(found, done=True))
    session.say("Swapped: `pico optimize` lists which goals are stale now. Swapping back undoes it.")
    return ExitCode.DONE


def _known(given: dict[str, Value], sigma: str | None, measured: str | None, valid_for: str | None) -> Known | None:
    """Return how well what is given is known, None where nobody says."""
    from pico.model.lab import Known

    said = [word for word in (sigma, measured, valid_for) if word]
    if said and (len(given) != 1 if sigma else not given):
        hint = 'such as `--focal-length "100.3 mm" --sigma "0.2 mm"`, one number with its sigma at a time'
        raise PicoError(error("usage", "--sigma, --measured and --valid-for say how a number was measured", hint=hint))
    today = clock.today()
    deviation = next(iter(_pairs([f"sigma={sigma}"]).values())) if sigma else None
    return Known(at=measured or today, sigma=deviation, valid_for=valid_for) if said else None


def _pairs(words: list[str]) -> dict[str, Value]:
    found: dict[str, Value] = {}
    for word in words:
        key, equals, value = word.partition("=")
        if not key or not equals or not value:
            raise PicoError(error("usage", f"`{word[:60]}` is not KEY=VALUE", hint='`--parameter "retardance=0.498"`'))
        try:
            found[key] = float(value)
        except ValueError:
            found[key] = value
    return found
