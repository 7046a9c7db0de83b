"""Where the open fingers of a gripper need room beside a component, when they pick or place it. mm and deg."""

from __future__ import annotations

from pico.geometry.shape import Shape, polygon
from pico.model.catalog import Grasp
from pico.model.pose import Pose, wrap
from pico.model.robot import Gripper


def finger_zones(grasp: Grasp, gripper: Gripper, yaw: float, pose: Pose) -> tuple[Shape, ...]:
    """Return the rectangles that the two fingers sweep while they open or close on a component standing at `pose`.

    Each reaches from the grip surface outward by opening and thickness, `breadth` wide. `yaw` is the direction in
    which the jaws close, in the component's frame [deg]. None for a gripper without fingers.
    """
    fingers = gripper.fingers
    if fingers == "none":
        return ()
    near = grasp.width / 2
    far, half = near + fingers.opening + fingers.thickness, fingers.breadth / 2
    jaws = Pose(pose.x, pose.y, wrap(pose.yaw + yaw))
    right = tuple(jaws.apply(x, y) for x, y in ((near, -half), (far, -half), (far, half), (near, half)))
    left = tuple(jaws.apply(-x, -y) for x, y in ((near, -half), (far, -half), (far, half), (near, half)))
    return polygon(right), polygon(left)


def finger_height(grasp: Grasp, gripper: Gripper) -> float:
    """Return how low the finger tips come above the table [mm]; what is no taller is not in their way."""
    return grasp.height - (0.0 if gripper.fingers == "none" else gripper.fingers.tip)
