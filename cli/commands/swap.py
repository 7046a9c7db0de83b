"""The simulator, and the rest, 12: `pico swap`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from pico.diagnostics import ExitCode, PicoError, error

from ..arguments import Component, DryRun, Yes
from ..session import Session
from ..views import swap as view

if TYPE_CHECKING:
    from pico.model.quantities import Value


def swap(
    context: typer.Context,
    name: Component,
    serial: Annotated[str, typer.Option("--serial", metavar="SERIAL", help="Of the specimen that is in it now.")],
    kind: Annotated[str | None, typer.Option("--type", metavar="TYPE", help="Its type, where it is another.")] = None,
    focal_length: Annotated[
        str | None, typer.Option("--focal-length", metavar="LENGTH", help='As measured: "100.3 mm".')
    ] = None,
    parameter: Annotated[
        list[str] | None, typer.Option("--parameter", metavar="KEY=VALUE", help="Another one; may be given again.")
    ] = None,
    auto_approve: Yes = False,
    dry_run: DryRun = False,
) -> int:
    """Tell that a part has another specimen in its housing.

    The bench's own Lab and lab.yaml take it over; nothing moves. Goals whose light comes through it are stale from
    then on, until they are met again. Swap back the same way. Exit code 1 where somebody says no, 5 where the bench
    is in use.

    Examples:
      pico swap lx_100 --serial B7 --focal-length "100.3 mm"
    """
    from pico.bench import updating
    from pico.manifest.load import find_lab

    session = Session.of(context)
    root = find_lab(session.folder)
    given = _pairs([*(parameter or ()), *([f"focal_length={focal_length}"] if focal_length else [])])
    found = updating.swapped(root, name, serial, kind, given)
    if dry_run or found.same:
        session.show(view, found, done=False)
        return ExitCode.DONE
    session.require_answer(auto_approve)
    session.say(view.text(found, done=False))
    if not session.confirm(f"\nTake {serial} as the specimen in {name}?", auto_approve):
        session.say("Nothing was swapped.")
        return ExitCode.ERROR
    updating.swap(root, session.backend, found)
    if session.json:
        session.document(view.data(found, done=True))
    session.say("Swapped: `pico optimize` lists which goals are stale now. Swapping back undoes it.")
    return ExitCode.DONE


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
