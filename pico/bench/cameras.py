"""Looking at a bench through its cameras: where everything is, in numbers and as a picture."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from pico.bench.lasers import person_of
from pico.bench.opened import Opened
from pico.diagnostics import Diagnostic, PicoError, error
from pico.model.calibration.results import Provenance
from pico.model.request import require_component

if TYPE_CHECKING:
    from pico.backends.sight import Look
    from pico.drawing.picture import Image
    from pico.vision.calibration import Calibration


class Cameras:
    """The cameras over one bench."""

    def __init__(self, opened: Opened) -> None:
        self.opened = opened

    def scan(self) -> Look:
        """Return what the cameras over the table see, also what is wrong with them; raises PicoError where there are
        none. Observes by sight, whether or not the lab otherwise observes exactly."""
        return self.opened.wait(self.opened.edge.look())

    def picture(self, look: Look, *, out: Path | None = None, component: str | None = None) -> Image:
        """Return the picture (height, width, 3) of a camera over the table with names and outlines drawn in.

        `component`: only the part of the picture around it, large. `out`: write it there, too, as PNG. Raises
        PicoError.
        """
        from pico.drawing.camera_picture import annotated
        from pico.drawing.picture import write_png

        setup = self.opened.setup
        if component is not None:
            require_component(setup, component)
        image = annotated(setup, look.frames, look.calibration.cameras, look.observation, look.sighting, component)
        if out is not None:
            write_png(image, out)
        return image

    def calibrate(self) -> Calibration:
        """Find out where the cameras are and how the arms are built, from pictures of the board and the datums and from
        encoders, and write that into the lab's folder. Takes about half a minute. Raises PicoError."""
        from pico.cameras.calibrating import calibrate
        from pico.vision.calibration_files import SIMULATED, write_calibration

        setup, sim = self.opened.setup, self.opened.sim
        self._require_empty_hands()
        found = calibrate(setup, sim.true_cameras(), setup.lab.sim.seed, sim.true_arms())
        found = replace(found, provenance=self._simulated(found))
        write_calibration(self.opened.root, SIMULATED, found)
        return found

    def _simulated(self, found: Calibration) -> dict[str, Provenance]:
        """Return how each result came about: in the simulator."""
        by = person_of(self.opened) or ""
        from pico.vision.calibration_files import results_of

        known = {step: Provenance(bench="sim", evidence="simulated", at=found.made_at, by=by, procedure="simulated/1")
                 for step in results_of(found)}  # fmt: skip
        left = {name: round(value, 4) for name, value in found.residuals.items()}
        seen = ("intrinsics", "extrinsics", "hands")
        return {step: replace(how, residual=left.get(step.partition("/")[2]), unit="px")
                if step.partition("/")[0] in seen else how for step, how in known.items()}  # fmt: skip

    def _require_empty_hands(self) -> None:
        exact = self.opened.setup.lab.sim.observe == "exact"
        seen = self.opened.observe() if exact else self.scan().observation  # which cameras that moved do not end
        for name, robot in sorted(seen.robots.items()):
            if robot.holding:
                text, hint = (
                    f"{name} holds {robot.holding}: a calibration needs its hand",
                    "`pico recover` sets it down",
                )
                raise PicoError(error("hand-full", text, hint=hint, address=name))


def problems_of(look: Look, component: str) -> list[Diagnostic]:
    """Return what is wrong with what a look says of a component, or with all of it."""
    found = look.observation.problems
    return [p for p in found if p.address in (component, "") or component in p.summary.split(":")[0]]
