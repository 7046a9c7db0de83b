"""`pico validate`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..session import Session
from ..terminal import waiting as slow
from ..views import validation as view

HEADING = "Manifests"
ORDER = 10

if TYPE_CHECKING:
    from collections.abc import Mapping

    from pico.diagnostics import Diagnostic
    from pico.manifest.load import Manifests
    from pico.model.calibration.results import AxisZero


def validate(
    context: typer.Context,
    files: Annotated[
        list[Path] | None, typer.Argument(metavar="FILE...", help="Check the labs that these files lie in.")
    ] = None,
) -> int:
    """Check the manifests.

    Also that everything has room where the state wants it, that an arm can grip what it is to move and reaches where
    it belongs, and that beams end where they may. All errors at once, each with its place. Does not ask the bench; asks
    Git what it keeps out of the folder, and what its merge kept.

    Examples:
      pico validate
    """
    from pico.diagnosis.claims import check_carried
    from pico.history.lab.missing_files import missing_files
    from pico.history.merge.checked import overlapping
    from pico.history.merge.doubts import doubts_in
    from pico.manifest.folders import check_files, check_folder
    from pico.optics.audit.labels import check_labels
    from pico.optics.audit.state import check_light
    from pico.optics.nominal.spans import check_spans
    from pico.planning.checks.bolted import check_bolted
    from pico.planning.checks.grips import check_grips, check_reach
    from pico.planning.checks.loads import check_loads
    from pico.planning.checks.set_points import check_set_points

    session = Session.of(context)
    asked = (
        lambda root, read: [
            *check_bolted(read.require()[0], read.source),
            *check_grips(read),
            *check_loads(read),
            *check_set_points(read, _axes(session, root, read)),
            *check_reach(read),
            *overlapping(read),
            *check_labels(read),
            *check_light(read),
            *check_spans(read),
            *check_carried(read),
            *doubts_in(root, read),
            *_waiting(session, root),
        ],
        missing_files,
    )
    where = session.folder
    with slow.waiting("Checking"):
        checked = check_files(where, files, *asked) if files else check_folder(where, *asked)
    session.tell(checked.diagnostics)
    session.show(view, checked)
    return checked.exit_code


def _axes(session: Session, root: Path, read: Manifests) -> Mapping[str, AxisZero]:
    """Return direction and zero of the axes of the bench that is meant, of `hardware` if that has no devices."""
    if not (setup := read.setup) or not setup.wiring:
        return {}
    from pico.backends.devices import HARDWARE, SIMULATOR
    from pico.places.bench import BenchPlace
    from pico.vision.calibration_files import accepted_axes

    place = session.place(root)
    has_devices = isinstance(place, BenchPlace) and place.name != SIMULATOR
    return accepted_axes(root, place.name if has_devices else HARDWARE)


def _waiting(session: Session, root: Path) -> tuple[Diagnostic, ...]:
    """Return what the files propose to the bench of this machine that is meant."""
    from pico.bench.updating import waiting
    from pico.places.bench import BenchPlace

    place = session.place(root)
    return waiting(place) if isinstance(place, BenchPlace) else ()
