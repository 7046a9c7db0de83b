"""`pico calibrate`."""

from __future__ import annotations

import typer

from ..session import Session
from ..views import calibration as view


def calibrate(context: typer.Context) -> int:
    """Find out where the cameras are and how their lenses draw.

    From pictures of the calibration board and of the datums; takes about half a minute. Writes calibration.json into
    the lab's folder. Nothing on the table moves.
    """
    from pico.cameras.calibrating import calibrate as calibrated
    from pico.vision.calibration import FILE, write_calibration

    session = Session.of(context)
    bench = session.bench(writing=True)
    session.say("Taking pictures of the calibration board (about half a minute) ...")
    found = calibrated(bench.setup, bench.sim.true_cameras(), bench.setup.lab.sim.seed)
    write_calibration(bench.root, found)
    session.show(view, found, shown=FILE)
    return 0
