"""One operation at a time, 6: `pico measure`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..arguments import DryRun, Fidelity, LockTimeout, Yes
from ..session import Session
from ..views import measurement as view
from ..views import report as report_view


def measure(
    context: typer.Context,
    what: Annotated[str, typer.Argument(metavar="COMPONENT.MEASURABLE", help="With kernels: 'cam.image | centroid'.")],
    picture: Annotated[
        Path | None, typer.Option("--picture", metavar="PNG", help="Keep what the camera saw as a picture.")
    ] = None,
    dry_run: DryRun = False,
    fidelity: Fidelity = None,
    auto_approve: Yes = False,
    lock_timeout: LockTimeout = None,
) -> int:
    """Measure, and keep what was measured with the run.

    Arms park first, and what the measurable needs is set for it and set back. Kernels make numbers of pictures, each
    with one standard deviation: `pico catalog show beam_camera` lists what a camera has, any others go behind a `|`.
    What is saturated has no value; then the exit code is 1.

    Examples:
      pico measure cam.centroid
      pico measure cam.image --picture spot.png
      pico measure 'cam.image | background | mode_overlap(radius=450)'
    """
    from pico.diagnostics import ExitCode

    from ..runs.approving import measured

    session = Session.of(context)
    component, _, measurable = (word.strip() for word in what.partition("."))
    bench = session.bench(fidelity, None, writing=not dry_run)
    plan = bench.plans.single(component, "measure", {"measurable": measurable} if measurable else {})
    report = measured(session, bench, plan, auto_approve, dry_run)
    if isinstance(report, int):
        return report
    found = next(iter(report.measurements.values()), None)
    if report.exit_code or found is None:  # also where it was measured, and what was set for it not set back
        session.say(report_view.text(report))
        session.report(report.diagnostics)
    if found is None:
        return int(report.exit_code) or ExitCode.ERROR
    session.show(view, found, run=report.run, advice=bench.measurements.advice(found))
    session.draw(picture, found.address, lambda path: bench.measurements.picture(found, path))
    return int(report.exit_code) or (ExitCode.ERROR if found.unknown else ExitCode.DONE)
