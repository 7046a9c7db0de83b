"""What `pico calibrate` found."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from pico.vision.arm import FoundArm
    from pico.vision.calibration import Calibration
    from pico.vision.camera import CameraModel


def text(calibration: Calibration, *, shown: str) -> str:
    """Return a line for each camera and each arm, and where it was written."""
    lines = [_line(camera, calibration.residuals[name]) for name, camera in calibration.cameras.items()]
    lines += [_arm(name, arm) for name, arm in calibration.arms.items()]
    sure = f"A position on the table is known to {calibration.accuracy.position:.3f} mm (one sigma)."
    return "\n".join([*lines, sure, f"Wrote {shown}, {calibration.digest[:19]}. Commit it with the lab."])


def _line(camera: CameraModel, residual: float) -> str:
    x, y, z = camera.pose[:3, 3]
    where = f"on {camera.robot}'s hand at" if camera.robot else "at"
    focal = f"focal length {camera.matrix[0, 0]:.1f} px"
    return f"  {camera.name:<10} {where} ({x:.2f}, {y:.2f}, {z:.2f}) mm, {focal}, residual {residual:.3f} px"


def _arm(name: str, arm: FoundArm) -> str:
    offsets = arm.offsets
    mount, turn, tool = (math.hypot(*v) for v in (offsets.shift, offsets.turn, offsets.tool))
    zeros = max(abs(zero) for zero in offsets.zeros)
    off = f"mount off by {mount:.2f} mm, {turn:.2f}°, joints by {zeros:.2f}°, tool by {tool:.2f} mm"
    return f"  {name:<10} {off}; its tool is known to {arm.position:.2f} mm, {arm.turn:.2f}° (one sigma)"


def data(calibration: Calibration, **_: Any) -> dict[str, Any]:
    """Return schema `pico.calibration/v2`, with its `digest`."""
    return {**calibration.as_json(), "digest": calibration.digest}
