"""How the simulated bench of a lab behaves: its fidelity, its sight, and what is wrong with it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from typing import Literal

from pico.model.quantities import Angle, Length
from pico.model.record import record


@record
class ArmErrors:
    """What is wrong with the simulated arms, and not known to what plans with them.

    The base of each is displaced by `mount_position` [mm] in a random direction and turned by `mount_rotation` [deg]
    about a random axis; the zero of each joint is wrong by `joint_zero` [deg], up or down; the tool is displaced on its
    flange by `tool_position` [mm] in a random direction. `encoder_noise`: sigma of a joint that is read once [deg].
    `backlash`: the play of each joint [deg]: it follows its motor only once that has turned so far.
    """

    mount_position: Length = 0.0
    mount_rotation: Angle = 0.0
    joint_zero: Angle = 0.0
    tool_position: Length = 0.0
    encoder_noise: Angle = 0.0
    backlash: Angle = 0.0


@record
class BadLight:
    """Light in which the simulated cameras see badly. `dim`: share of the light that there should be. `defocus`: sigma
    by which pictures are blurred besides [pixels]. `scatter`, `glare`: how many spots of scattered laser light there
    are on the table, speckled and up to saturation, and how many reflections of lamps in each camera's picture."""

    dim: float = 1.0
    defocus: float = 0.0
    scatter: int = 0
    glare: int = 0


@record
class SensorErrors:
    """What is wrong with the sensors of simulated beam cameras. `non_uniformity`: how pixels respond, one standard
    deviation; `hot_pixels`: the share of them that fill by themselves; `fringes`: of the cover glass, their amplitude;
    `flicker`: of the light from frame to frame, one standard deviation. Cameras have about 0.01, 1e-5, 0.03, 0.01."""

    non_uniformity: float = 0.0
    hot_pixels: float = 0.0
    fringes: float = 0.0
    flicker: float = 0.0

    def __post_init__(self) -> None:
        for name in ("non_uniformity", "hot_pixels", "fringes", "flicker"):
            if not 0 <= getattr(self, name) <= 1:
                raise ValueError(f"`{name}` is a share from 0 to 1, not {getattr(self, name):g}")


@record
class Environment:
    """What the simulated world does by itself, by the bench's clock, and nobody who plans or looks knows.

    `temperature`: how far it drifts about its mean [degC], one standard deviation over a day. `pointing`: how far the
    beam of a laser walks each way over hours [mrad]; `warm_up`: from where it comes to its way in the first quarter of
    an hour of a bench [mrad]; `power`: by which share of it the power walks. `vibration`: how
    far mirrors move along their normal [nm], one standard deviation at 10 to 100 Hz.
    """

    temperature: float = 0.3
    pointing: float = 0.003
    warm_up: float = 0.02
    power: float = 0.005
    vibration: float = 5.0

    def __post_init__(self) -> None:
        for name in ("temperature", "pointing", "warm_up", "power", "vibration"):
            most = 0.5 if name == "power" else 1000.0
            if not 0 <= getattr(self, name) <= most:
                raise ValueError(f"`{name}` is from 0 to {most:g}, not {getattr(self, name):g}")


@record
class DeviceError:
    """What is wrong with an emulated device, and not known to what reads it: the value of a tunable is what the lab's
    `map` makes of the device's number, `reversed` or not, plus `zero`; a meter reads `dark` without light. Both are in
    the unit of the tunable or measurable."""

    zero: float = 0.0
    reversed: bool = False
    dark: float = 0.0


@record
class SimErrors:
    """What is wrong with the simulated cameras, markers and arms, and not known to what looks through them.

    Each camera is displaced by `camera_position` [mm] in a random direction, turned by `camera_rotation` [deg] about a
    random axis, its focal length is wrong by the share `focal_length` and k1 of its lens by `distortion`, up or down.
    `marker_height`: sigma by which a marker lies above or below where its type says [mm]. `lost_frames`: share of
    pictures that come out black.
    `noise`: factor on the sensors' noise. `seat`: how far off a part comes to sit that is put down, as a multiple of
    its type's repeatability; where it is left out 1 in physics, and 0 (exactly) in kinematic fidelity. `arm`: what is
    wrong with arms, `light`: with the light, `sensor`: with the sensors of beam cameras, `devices`: with emulated
    devices, by the address of what they set or read (`p1.angle`); nothing where they are left out.
    """

    camera_position: Length = 0.0
    camera_rotation: Angle = 0.0
    focal_length: float = 0.0
    distortion: float | None = None
    marker_height: Length = 0.0
    lost_frames: float = 0.0
    noise: float = 1.0
    seat: float | None = None
    arm: ArmErrors | None = None
    light: BadLight | None = None
    sensor: SensorErrors | None = None
    devices: Mapping[str, DeviceError] | None = None

    def __post_init__(self) -> None:
        if self.seat is not None and not 0 <= self.seat <= 10:
            raise ValueError(f"`seat` is a multiple of the repeatability, from 0 to 10, not {self.seat:g}")


@record
class SimSettings:
    """How the simulated bench behaves where a command does not say. `pad_friction`: sliding friction coefficient of the
    finger pads on a part. `renderer`: what draws the cameras' pictures; `egl` needs OpenGL. `errors`: what is wrong
    with cameras and arms. `sight`: by what the physical world corrects a part in the hand before it is put down: the
    truth (but where the table is looked at by sight), the pictures of the eye in the hand, or nothing; with `pixels` a
    physical run knows only what its cameras saw, of the table, too. `faults`: what goes wrong how often, as
    a share of the operations that it can befall: `drop`, `slip`, `jam`, `camera`, `timeout`, `reading`, `slow`, `all`.
    `observe`: how the table is looked at, exactly or through the cameras. `environment`: what the world does by itself,
    as worlds do where it is left out; `none`: nothing."""

    fidelity: Literal["kinematic", "physics"] = "kinematic"
    seed: int = 1
    pad_friction: float = 1.0
    renderer: Literal["raycast", "egl"] = "raycast"
    errors: SimErrors = SimErrors()
    sight: Literal["exact", "pixels", "none"] = "exact"
    observe: Literal["exact", "sight"] = "exact"
    environment: Environment | Literal["none"] | None = None
    faults: Mapping[Literal["drop", "slip", "jam", "camera", "timeout", "reading", "slow", "all"], float] = field(
        default_factory=dict
    )

    @property
    def hand_sight(self) -> Literal["exact", "pixels", "none"]:
        """By what a part in the hand is seen in the physical world."""
        return "pixels" if self.observe == "sight" and self.sight == "exact" else self.sight

    def runs_by_sight(self, fidelity: str) -> bool:
        """Return whether a run at a fidelity knows only what its cameras, joints and pads tell."""
        return self.observe == "sight" or (fidelity == "physics" and self.hand_sight == "pixels")

    def __post_init__(self) -> None:
        for name, rate in self.faults.items():
            if not 0 <= rate <= 1:
                raise ValueError(f"the rate of `{name}` in `faults` is a share from 0 to 1, not {rate:g}")
