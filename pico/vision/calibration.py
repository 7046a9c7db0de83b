"""The calibration of a bench: its cameras and arms as measured, and how well. mm, deg, pixels."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from pico.base.formats import Document, Format
from pico.model.calibration.results import AxisZero, DarkLevel, Provenance
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
    """The cameras of a bench, and its arms, axes and detectors if these were measured, too."""

    cameras: Mapping[str, CameraModel]
    accuracy: Accuracy = field(default_factory=Accuracy)
    residuals: Mapping[str, float] = field(default_factory=dict)
    """What is left of what each camera saw, root mean square [pixels]."""
    made_at: str = ""
    """When it was changed last (ISO 8601, UTC)."""
    arms: Mapping[str, FoundArm] = field(default_factory=dict)
    axes: Mapping[str, AxisZero] = field(default_factory=dict)
    """Direction and zero of axes, by the address of the tunable."""
    dark: Mapping[str, DarkLevel] = field(default_factory=dict)
    """What detectors read without light, by the address of the measurable."""
    provenance: Mapping[str, Provenance] = field(default_factory=dict)
    """How each result came about, by step and subject: `intrinsics/left`, `axes/p1.angle`."""

    def placed(self, tools: Mapping[str, Array]) -> Calibration:
        """Return the calibration with the eyes of robots in the table's frame; `tools`: pose (4, 4) of each tool."""
        cameras = {
            name: camera.placed(tools[camera.robot]) if camera.robot and camera.robot in tools else camera
            for name, camera in self.cameras.items()
        }
        return replace(self, cameras=cameras)

    @property
    def digest(self) -> str:
        """The digest that plans record, see `digest_of`."""
        return digest_of(self.as_json())

    def as_json(self) -> dict[str, Any]:
        """Return schema `pico.calibration/v2`: cameras with lens, position [mm] and rotation vector [deg]; arms, axes
        and dark levels if there are any; how each came about."""
        found = {"arms": (self.arms, _six), "axes": (self.axes, _six), "dark": (self.dark, _nine)}
        also = {key: as_json(dict(sorted(of.items())), rounding) for key, (of, rounding) in found.items() if of}
        return {
            "schema": FORMAT.schema,
            "made_at": self.made_at,
            "accuracy": as_json(self.accuracy),
            "residuals": {name: round(value, 4) for name, value in sorted(self.residuals.items())},
            "cameras": {name: camera_as_json(camera) for name, camera in sorted(self.cameras.items())},
            **also,
            "provenance": as_json(dict(sorted(self.provenance.items())), _nine),
        }


def _with_provenance(document: Document) -> Document:
    """Lift version 1, which says nothing of where it came from: it counts as simulated."""
    at = {"bench": "sim", "evidence": "simulated", "at": document.get("made_at", "")}
    steps = [f"{step}/{name}" for name in document.get("cameras", {}) for step in ("intrinsics", "extrinsics")]
    steps += [f"arms/{name}" for name in document.get("arms", {})]
    return {**document, "schema": "pico.calibration/v2", "provenance": dict.fromkeys(sorted(steps), at)}


FORMAT = Format("pico.calibration", (_with_provenance,))
_DIGESTED = f"{FORMAT.name}/v1"
"""The schema that digests are of: the same numbers keep the digest that plans of before recorded."""
_ABOUT = ("made_at", "provenance")
"""What of a document says how it came about, and is no part of its digest."""


def digest_of(document: Mapping[str, Any]) -> str:
    """Return the digest that plans record of the document of a calibration: of what it says of cameras, arms, axes and
    detectors and how well these are known, not of when and how that was found."""
    kept = {key: value for key, value in document.items() if key not in _ABOUT}
    return digest({**kept, "schema": _DIGESTED} if "schema" in kept else kept)


def calibration_from_json(data: object) -> Calibration:
    """Return the calibration whose `as_json` gave `data`; raises ValueError, KeyError or TypeError for other data."""
    document = FORMAT.lifted(data)
    return Calibration(
        cameras={name: camera_from_json(name, camera) for name, camera in document["cameras"].items()},
        accuracy=Accuracy(**document["accuracy"]),
        residuals=document["residuals"],
        made_at=document["made_at"],
        arms={name: _arm(arm) for name, arm in document.get("arms", {}).items()},
        axes={name: AxisZero(**axis) for name, axis in document.get("axes", {}).items()},
        dark={name: DarkLevel(**level) for name, level in document.get("dark", {}).items()},
        provenance={name: Provenance(**how) for name, how in document["provenance"].items()},
    )


def camera_as_json(camera: CameraModel) -> dict[str, Any]:
    """Return a camera as calibrations have it: lens, position [mm] and rotation vector [deg]."""
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
        **({"fisheye": True} if camera.fisheye else {}),
    }


def _six(number: float) -> float:
    return round(number, 6)


def _nine(number: float) -> float:
    return float(f"{number:.9g}")


def _plain(numbers: Any) -> list[float]:
    return [_six(float(number)) for number in numbers]


def _arm(data: Mapping[str, Any]) -> FoundArm:
    offsets: Any = {key: tuple(float(v) for v in values) for key, values in data["offsets"].items()}
    return FoundArm(offsets=ArmOffsets(**offsets), position=data["position"], turn=data["turn"])


def camera_from_json(name: str, data: Mapping[str, Any]) -> CameraModel:
    """Return the camera whose `camera_as_json` gave `data`; raises KeyError, TypeError or ValueError."""
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
        data.get("fisheye", False),
    )
