"""A picture of one component, as it stands on a table."""

from __future__ import annotations

from itertools import product
from typing import TYPE_CHECKING

from pico.drawing.picture import carried, center_of, placed, posed_model
from pico.model.catalog import ComponentType
from pico.model.lab import Lab, Part, Table
from pico.model.pose import Pose
from pico.model.setup import Setup

if TYPE_CHECKING:
    from pico.drawing.picture import Image

_NAME = "it"
_TABLE = (6000.0, 6000.0)
"""So large that its edges are out of the picture [mm]."""
_POSE = Pose(3000, 2000, 40)
_ROOM = 1.15
"""By how much more than the component the picture shows."""


def portrait(kind: ComponentType, width: int = 320, height: int = 280) -> Image:
    """Return a picture (height, width, 3), sRGB, of a component of a type: obliquely from the front."""
    import numpy as np

    from pico.drawing.perspective import Stage, photograph
    from pico.drawing.standpoint import standpoint
    from pico.twin.surfaces import surfaces

    lab = Lab(name="portrait", table=Table(size=_TABLE), robots={}, inventory={_NAME: Part(type=kind.name, pose=_POSE)})
    setup = carried(Setup(lab=lab, catalog={kind.name: kind}), {})
    places = placed({_NAME: _POSE})
    model, data = posed_model(setup, places, {})
    reach, top = _ROOM * kind.geometry.footprint.radius, _ROOM * kind.geometry.height
    corners = product((_POSE.x - reach, _POSE.x + reach), (_POSE.y - reach, _POSE.y + reach), (0.0, top))
    view = standpoint(model, data, places, np.array([*corners]) / 1000, width, height)
    return photograph(Stage(model, data, surfaces(setup, model, places), (), center_of(setup)), view)
