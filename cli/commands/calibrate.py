"""The simulator, and the rest, 7: `pico calibrate`."""

from __future__ import annotations

import typer

from ..session import Session
from ..views import calibration as view


def calibrate(context: typer.Context) -> None:
    """Find out where the cameras are and how their lenses draw.

    From pictures of the calibration board and of the datums; takes about half a minute. Writes calibration.json into
    the lab's folder. Nothing on the table moves.
    """
    from pico.vision.calibration import FILE

    session = Session.of(context)
    bench = session.bench(writing=True)
    session.say("Taking pictures of the calibration board (about half a minute) ...")
    session.show(view, bench.cameras.calibrate(), shown=FILE)
