"""Looking at a bench through its cameras: where everything is, in numbers and as a picture."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from pico.diagnostics import Diagnostic
from pico.model.request import require_component

if TYPE_CHECKING:
    from pico.backends.sight import Look
    from pico.bench.async_bench import AsyncBench
    from pico.drawing.picture import Image
    from pico.vision.calibration import Calibration


async def scan(bench: AsyncBench) -> Look:
    """Return what the cameras over the table see, also what is wrong with them; raises PicoError where there are none.

    Observes by sight, whether or not the lab otherwise observes exactly.
    """
    return await bench.edge.look()


def picture(bench: AsyncBench, look: Look, out: Path | None = None, component: str | None = None) -> Image:
    """Return the picture (height, width, 3) of a camera over the table with names and outlines drawn in.

    `component`: only the part of the picture around it, large. `out`: write it there, too, as PNG. Raises PicoError.
    """
    from pico.drawing.camera_picture import annotated
    from pico.drawing.picture import write_png

    if component is not None:
        require_component(bench.setup, component)
    image = annotated(bench.setup, look.frames, look.calibration.cameras, look.observation, look.sighting, component)
    if out is not None:
        write_png(image, out)
    return image


def problems_of(look: Look, component: str) -> list[Diagnostic]:
    """Return what is wrong with what a look says of a component, or with all of it."""
    found = look.observation.problems
    return [p for p in found if p.address in (component, "") or component in p.summary.split(":")[0]]


def calibrate(bench: AsyncBench) -> Calibration:
    """Find out where the cameras are, from pictures of the board and the datums, and write that into the lab's folder.

    Moves nothing, and takes about half a minute. Raises PicoError.
    """
    from pico.cameras.calibrating import calibrate
    from pico.vision.calibration import write_calibration

    found = calibrate(bench.setup, bench.sim.true_cameras(), bench.setup.lab.sim.seed)
    write_calibration(bench.root, found)
    return found
