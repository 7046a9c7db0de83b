"""A frame of a camera over the bench: one picture, as an array of gray levels, row 0 at the top."""

from __future__ import annotations

from pico.backends.attempt import Failed
from pico.backends.measured import Reading
from pico.backends.sim.readings import Table
from pico.diagnostics import error
from pico.model.setup import Setup

FULL = 255
"""What a pixel reads that has all the light that it can tell."""


def measures(setup: Setup, component: str, measurable: str) -> bool:
    """Whether it is the frame of a camera that stands."""
    return component in setup.lab.cameras and component not in setup.lab.inventory and measurable == "frame"


def read(table: Table, component: str, measurable: str) -> Reading:
    """Return the picture, with its brightest pixel (`peak`) and its `mean`."""
    from pico.backends.sim.sight import picture

    frame = picture(table.setup, table.root, table.world, component)
    if frame.black:
        hint = "measure again; a camera that stays dark is told by `pico look`"
        raise Failed(error("dark", f"the frame of {component} is black", hint=hint, address=component))
    full = int((frame.gray >= FULL).sum())
    camera = table.setup.lab.cameras[component]
    return Reading(
        {"peak": float(frame.gray.max()), "mean": float(frame.gray.mean())},
        frame.gray,
        sigma={"peak": camera.noise},
        settings={"blur": camera.blur, "renderer": table.setup.lab.sim.renderer},
        saturated=f"{full} of {frame.gray.size} pixels read {FULL}" if full else "",
    )
