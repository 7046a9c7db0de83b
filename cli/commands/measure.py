"""`pico measure`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..arguments import DryRun, Fidelity, LockTimeout, Yes
from ..session import Session
from ..views import measurement as view
from ..views import report as report_view

HEADING = "One operation at a time"
ORDER = 30


def measure(
    context: typer.Context,
    what: Annotated[
        list[str], typer.Argument(metavar="COMPONENT.MEASURABLE...", help="With kernels: 'cam.image | centroid'.")
    ],
    picture: Annotated[
        Path | None, typer.Option("--picture", metavar="PNG", help="Keep what the camera saw as a picture.")
    ] = None,
    image: Annotated[
        list[str] | None,
        typer.Option("--image", metavar="FILE", help="Measure a picture from disk by kernels; may be given again."),
    ] = None,
    at: Annotated[
        list[float] | None, typer.Option("--at", metavar="MM", help="Where along the beam each --image was taken.")
    ] = None,
    pixel_size: Annotated[
        float | None, typer.Option("--pixel-size", metavar="UM", min=1e-3, help="Of --image; without it px.")
    ] = None,
    black_level: Annotated[
        float | None, typer.Option("--black-level", metavar="COUNT", help="Of --image: what a dark pixel reads.")
    ] = None,
    full_scale: Annotated[
        float | None,
        typer.Option("--full-scale", metavar="COUNT", min=1.0, help="Of --image: what a full pixel reads."),
    ] = None,
    dry_run: DryRun = False,
    fidelity: Fidelity = None,
    auto_approve: Yes = False,
    lock_timeout: LockTimeout = None,
) -> int:
    """Measure, and keep what was measured with the run.

    Arms park first, and what the measurable needs is set for it and set back. Kernels make numbers of pictures, each
    with one standard deviation: `pico catalog show beam_camera` lists what a camera has, any others go behind a `|`.
    What is saturated has no value; then the exit code is 1. If a detector reads no light, what shuts it off is named.
    Several are measured in one run.

    With --image kernels measure pictures from disk (TIFF, PNG, PGM, NPY), without a bench; m2 after widths fits the
    beam propagation ratio to a series, with the places from --at or the names.

    Examples:
      pico measure cam.centroid
      pico measure cam.image --picture spot.png
      pico measure 'cam.image | background | mode_overlap(radius=450)'
      pico measure --image spot.png --pixel-size 5.2 d4sigma gaussian_fit
      pico measure --image 'z*.tif' --pixel-size 5 'd4sigma | m2(wavelength=633)'
    """
    from pico.diagnostics import ExitCode, PicoError, error

    from ..runs.approving import measured

    if image:
        from ..runs import pictures

        pictures.require_alone(picture, dry_run)
        return pictures.measured(Session.of(context), what, image, at or (), pixel_size, black_level, full_scale)
    if (
        unused := {"--at": at, "--pixel-size": pixel_size, "--black-level": black_level, "--full-scale": full_scale}
    ) and (given := [name for name, value in unused.items() if value not in (None, [])]):
        raise PicoError(error("usage", f"{given[0]} is of --image", hint="add --image FILE"))
    if picture is not None and len(what) > 1:
        raise PicoError(
            error("usage", "--picture is of one measurement", hint=f"`pico measure {what[0]} --picture PNG`")
        )
    session = Session.of(context)
    bench = session.bench(fidelity, None, writing=not dry_run)
    plan = bench.plans.to_measure(what)
    report = measured(session, bench, plan, auto_approve, dry_run)
    if isinstance(report, int):
        return report
    if report.exit_code or not report.measurements:  # also if it was measured, and what was set for it not set back
        session.say(report_view.text(report))
        session.report(report.diagnostics)

    def draw(path: Path) -> None:
        bench.measurements.picture(next(iter(report.measurements.values())), path)

    for found in report.measurements.values():
        dark = bench.measurements.darkness(found)
        advice = "" if dark else bench.measurements.advice(found)
        session.show(view, found, run=report.run, advice=advice, diagnostics=[dark] if dark else [])
        session.tell([dark] if dark else [])
        session.draw(picture, found.address, draw)
    unknown = any(found.unknown for found in report.measurements.values()) or not report.measurements
    return int(report.exit_code) or (ExitCode.ERROR if unknown else ExitCode.DONE)
