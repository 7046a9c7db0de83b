"""What of a component light finds otherwise than its pose, its tunables and its type say, and no camera over the bench
sees: the simulated world has such changes, and who asks what a reading tells supposes them."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

from pico.model.catalog import ComponentType, with_parameters
from pico.model.record import record

if TYPE_CHECKING:
    from pico.geometry.seat import Seat
    from pico.model.pose import Pose
    from pico.model.setup import Setup

Vector = tuple[float, float, float]


@record
class Unseen:
    """One component's. `ahead`, `left`, `up`: how far it is displaced along its own axes [mm]; `roll`, `pitch`, `yaw`:
    how far it is turned about them, right-handed, where its optical frame is [deg].

    `loss`: the share of the light that dirt on it stops. `leak`: of a polarizer, the share of what it should stop that
    passes besides. `gain`: of a detector, what it reads for the light that there is, as a factor. `dark`: what it reads
    besides without light, of a camera in electrons a pixel and second, else in the unit of its reading.

    `power`: of a laser, the factor by which its power differs. `focal`: of a lens, the factor by which its focal length
    differs; `retardance`: of a wave plate, by how many wavelengths its retardance differs. `optic`: the component type
    whose optic stands in its mount; empty if it is its own.
    """

    ahead: float = 0.0
    left: float = 0.0
    up: float = 0.0
    roll: float = 0.0
    pitch: float = 0.0
    yaw: float = 0.0
    loss: float = 0.0
    leak: float = 0.0
    gain: float = 1.0
    dark: float = 0.0
    power: float = 1.0
    focal: float = 1.0
    retardance: float = 0.0
    optic: str = ""

    @property
    def displaced(self) -> bool:
        """Whether it stands otherwise than its pose says."""
        return any((self.ahead, self.left, self.up, self.roll, self.pitch, self.yaw))

    def sitting(self, seat: Seat, about: Vector) -> Unseen:
        """Return the same of a component that sits so: it leans about its foot, by which what is above that, such as
        its optical frame at `about` [mm], is displaced."""
        turned = Unseen(roll=seat.roll, pitch=seat.pitch).turn(about)
        return replace(
            self, ahead=self.ahead + turned[0] - about[0], left=self.left + turned[1] - about[1],
            up=self.up + turned[2] - about[2] + seat.height, roll=self.roll + seat.roll, pitch=self.pitch + seat.pitch,
        )  # fmt: skip

    def place(self, pose: Pose, at: Vector, about: Vector) -> Vector:
        """Return where a point of a component that is at `pose` is on the table [mm]; `at` and what it is turned
        `about` are in the component's frame."""
        turned = self.turn((at[0] - about[0], at[1] - about[1], at[2] - about[2]))
        x, y = pose.apply(about[0] + turned[0] + self.ahead, about[1] + turned[1] + self.left)
        return x, y, about[2] + turned[2] + self.up

    def point(self, pose: Pose, way: Vector) -> Vector:
        """Return where a direction of a component that is at `pose` points on the table."""
        (x, y, z), c, s = self.turn(way), math.cos(math.radians(pose.yaw)), math.sin(math.radians(pose.yaw))
        return c * x - s * y, s * x + c * y, z

    def turn(self, way: Vector) -> Vector:
        """Return a direction in the component's frame as it is turned: by roll, then pitch, then yaw."""
        x, y, z = way
        for first, second, angle in ((1, 2, self.roll), (2, 0, self.pitch), (0, 1, self.yaw)):
            c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
            at = [x, y, z]
            at[first], at[second] = c * at[first] - s * at[second], s * at[first] + c * at[second]
            x, y, z = at
        return x, y, z


SEEN = Unseen()
"""A component that is as it is seen."""


_OF_THE_MOUNT = ("clear_diameter", "diameter")
"""Parameters that stay those of the mount when its optic is swapped."""


def as_it_is(setup: Setup, name: str, unseen: Unseen) -> ComponentType:
    """Return the type of a component with the parameters that its optic truly has; raises KeyError for a component that
    the inventory does not have, and for an optic that the catalog does not."""
    kind = setup.type_of(name)
    if not unseen.optic and unseen.focal == 1.0 and not unseen.retardance:
        return kind
    if unseen.optic:
        mount = {k: v for k, v in kind.parameters.items() if k in _OF_THE_MOUNT}
        kind = replace(kind, parameters={**setup.catalog[unseen.optic].parameters, **mount})
    if unseen.focal != 1.0 and (focal := kind.number("focal_length", "mm")):
        kind = with_parameters(kind, {"focal_length": f"{focal * unseen.focal!r} mm"})
    if unseen.retardance and (waves := kind.number("retardance", "")) is not None:
        kind = with_parameters(kind, {"retardance": waves + unseen.retardance})
    return kind
