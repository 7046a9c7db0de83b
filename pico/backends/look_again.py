"""One part looked at again, in the small regions of the pictures where it should be: before it is picked, and after it
was put down. For every backend."""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from pico.model.observation import ObservedComponent
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.vision.calibration import Calibration
from pico.vision.close import plate_pose, region_about
from pico.vision.frame import exposed
from pico.vision.localize import recognize
from pico.vision.rigid import upright

if TYPE_CHECKING:
    from pico.vision.frame import Frame, Region

Take = Callable[[str, "Region"], "Frame"]
"""Takes a picture with a camera, of a region of its sensor."""


def look_again(
    setup: Setup, name: str, near: Pose, take: Take, cameras: Calibration, held: Collection[str] = ()
) -> ObservedComponent | None:
    """Return a part as the cameras over the table see it about `near`; None where none of them sees it upright there.

    `cameras`: put right by their datums. A picture that is black is taken again; one that stays so does not count, and
    what the others leave uncertain is said.
    """
    from pico.vision.markers import detect

    number, plate = setup.lab.inventory[name].marker, setup.type_of(name).geometry.marker
    if number is None or plate is None:
        return None
    at, pictures = upright(near, 0.0) @ plate_pose(plate), []
    for camera in cameras.cameras.values():
        region = region_about(camera, at, plate.size) if camera.robot is None else None
        if region is not None:
            frame = exposed(partial(take, camera.name, region))
            pictures += [] if frame.black else [detect(frame)]
    shown = [replace(p, markers=tuple(m for m in p.markers if m.number == number), fragments=()) for p in pictures]
    seen = recognize(setup, shown, cameras, held).components.get(name)
    return None if seen is None else ObservedComponent(pose=seen.pose, uncertainty=seen.uncertainty, how=seen.how)
