"""The calibration of a bench: its cameras as measured, and how well. mm, deg, pixels."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from pico.model.record import record
from pico.vision.camera import CameraModel

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]


@record
class Accuracy:
    """How well a calibration holds, one standard deviation each.

    `position`, `yaw`: what it adds to a pose on the table [mm, deg]; `height`: of a marker above the table [mm];
    `pixels`: how far a point that all cameras see may be off in their pictures [pixels]; `upright`: how well a part
    that stands stands upright [deg].
    """

    position: float = 0.05
    yaw: float = 0.02
    height: float = 0.2
    pixels: float = 0.3
    upright: float = 0.2


@dataclass(frozen=True, eq=False)
class Calibration:
    """The cameras of a bench. `residuals`: root mean square of each step [pixels]; `made_at`: when it was made."""

    cameras: Mapping[str, CameraModel]
    accuracy: Accuracy = field(default_factory=Accuracy)
    residuals: Mapping[str, float] = field(default_factory=dict)
    made_at: str = ""

    def placed(self, tools: Mapping[str, Array]) -> Calibration:
        """Return the calibration with the eyes of robots in the table's frame; `tools`: pose (4, 4) of each tool."""
        cameras = {
            name: camera.placed(tools[camera.robot]) if camera.robot and camera.robot in tools else camera
            for name, camera in self.cameras.items()
        }
        return replace(self, cameras=cameras)
