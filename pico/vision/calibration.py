"""The calibration of a bench: its cameras and arms as measured, and how well. mm, deg, pixels."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pico.base.formats import Format
from pico.diagnostics import PicoError, error
from pico.disk import write_whole
from pico.model.record import as_json, digest, record
from pico.vision.arm import ArmOffsets, FoundArm
from pico.vision.camera import CameraModel
from pico.vision.rigid import motion, rotation, rotation_vector

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
    """The cameras of a bench, and its arms where these were measured, too. `residuals`: root mean square of each step
    [pixels]; `made_at`: when it was made."""

    cameras: Mapping[str, CameraModel]
    accuracy: Accuracy = field(default_factory=Accuracy)
    residuals: Mapping[str, float] = field(default_factory=dict)
    made_at: str = ""
    arms: Mapping[str, FoundArm] = field(default_factory=dict)

    def placed(self, tools: Mapping[str, Array]) -> Calibration:
        """Return the calibration with the eyes of robots in the table's frame; `tools`: pose (4, 4) of each tool."""
        cameras = {
            name: camera.placed(tools[camera.robot]) if camera.robot and camera.robot in tools else camera
            for name, camera in self.cameras.items()
        }
        return replace(self, cameras=cameras)

    @property
    def digest(self) -> str:
        """The digest that plans record: of the cameras and of how well they are known, not of when it was made."""
        return digest({key: value for key, value in self.as_json().items() if key != "made_at"})

    def as_json(self) -> dict[str, Any]:
        """Return schema `pico.calibration/v1`: cameras with lens, position [mm] and rotation vector [deg]; arms where
        there are any."""
        arms = {"arms": as_json(dict(sorted(self.arms.items())), _six)} if self.arms else {}
        return {
            "schema": FORMAT.schema,
            "made_at": self.made_at,
            "accuracy": as_json(self.accuracy),
            "residuals": {name: round(value, 4) for name, value in sorted(self.residuals.items())},
            "cameras": {name: _camera_json(camera) for name, camera in sorted(self.cameras.items())},
            **arms,
        }


FORMAT = Format("pico.calibration")
FILE = "calibration.json"
"""In the folder of a lab, so that Git keeps what the bench's cameras were when."""


def write_calibration(folder: Path, calibration: Calibration) -> Path:
    """Write the calibration into the folder of a lab, and return the file."""
    path = folder / FILE
    write_whole(path, (json.dumps(calibration.as_json(), indent=2) + "\n").encode())
    return path


def read_calibration(folder: Path) -> Calibration | None:
    """Return the calibration in the folder of a lab, or None; raises PicoError where the file is something else."""
    path = folder / FILE
    if not path.exists():
        return None
    try:
        return calibration_from_json(json.loads(path.read_text(encoding="utf-8")))
    except (ValueError, KeyError, TypeError) as exc:
        hint = "make it again with `pico calibrate`"
        raise PicoError(error("calibration-file", f"{path} is no calibration: {exc}", hint=hint)) from exc


def calibration_from_json(data: object) -> Calibration:
    """Return the calibration whose `as_json` gave `data`; raises ValueError, KeyError or TypeError for other data."""
    document = FORMAT.lifted(data)
    return Calibration(
        cameras={name: _camera(name, camera) for name, camera in document["cameras"].items()},
        accuracy=Accuracy(**document["accuracy"]),
        residuals=document["residuals"],
        made_at=document["made_at"],
        arms={name: _arm(arm) for name, arm in document.get("arms", {}).items()},
    )


def known_arms(folder: Path) -> dict[str, ArmOffsets]:
    """Return how the arms are off by the calibration in the folder of a lab, none where there is no such file."""
    found = read_calibration(folder)
    return {name: arm.offsets for name, arm in found.arms.items()} if found else {}


def calibration_digest(folder: Path) -> str | None:
    """Return the digest of the calibration in the folder of a lab, or None; reads no more than the file."""
    try:
        data = json.loads((folder / FILE).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    return digest({key: value for key, value in data.items() if key != "made_at"}) if isinstance(data, dict) else None


def made_at(folder: Path) -> str:
    """Return when the calibration in the folder of a lab was made, empty for none; reads no more than the file."""
    try:
        data = json.loads((folder / FILE).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return ""
    return str(data.get("made_at", "")) if isinstance(data, dict) else ""


def _camera_json(camera: CameraModel) -> dict[str, Any]:
    import numpy as np

    k = camera.matrix
    return {
        "robot": camera.robot,
        "depth": camera.depth,
        "pixels": list(camera.pixels),
        "focal": _plain((k[0, 0], k[1, 1])),
        "principal": _plain((k[0, 2], k[1, 2])),
        "distortion": _plain(camera.distortion),
        "position": _plain(camera.pose[:3, 3]),
        "rotation": _plain(np.degrees(rotation_vector(camera.pose[:3, :3]))),
    }


def _six(number: float) -> float:
    return round(number, 6)


def _plain(numbers: Any) -> list[float]:
    return [_six(float(number)) for number in numbers]


def _arm(data: Mapping[str, Any]) -> FoundArm:
    offsets: Any = {key: tuple(float(v) for v in values) for key, values in data["offsets"].items()}
    return FoundArm(offsets=ArmOffsets(**offsets), position=data["position"], turn=data["turn"])


def _camera(name: str, data: Mapping[str, Any]) -> CameraModel:
    import numpy as np

    (fx, fy), (cx, cy) = data["focal"], data["principal"]
    width, height = data["pixels"]
    return CameraModel(
        name,
        (int(width), int(height)),
        np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1.0]]),
        np.array(data["distortion"], np.float64),
        motion(rotation(np.radians(data["rotation"])), np.array(data["position"], np.float64)),
        data["robot"],
        data["depth"],
    )
