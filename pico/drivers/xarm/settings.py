"""What an xArm is told before it may move, from its `device:` entry, and whether it took all of it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from pico.diagnostics import Diagnostic, PicoError, error
from pico.model.instruments.declaration import Setting
from pico.model.wiring import DeviceEntry
from pico.motion.xarm7 import LIMITS

LEAST_SENSITIVITY = 3
"""Collision sensitivity, 0 (off) to 5: the vendor's usual value."""
FENCE = {"x": (-900.0, 900.0), "y": (-900.0, 900.0), "z": (-100.0, 1300.0)}
"""Where the tool may be where the lab says nothing: as far as the arm reaches [mm]."""
PROPERTIES: Mapping[str, str] = (
    dict.fromkeys("xyz", "mm")
    | {f"joint{n}": "deg" for n in range(1, 8)}
    | {"tool_speed": "mm/s", "joint_speed": "deg/s"}
)
"""What `limits` of an entry may name, with units; x, y, z are the tool's in the frame of the arm's base."""
_TOOLS = {"none": 0, "gripper": 1, "vacuum": 2}


@dataclass(frozen=True, slots=True)
class XArmSettings:
    """Joints in rad, lengths in mm, speeds in mm/s and rad/s, `load` in kg with its center of mass from the flange.

    `pace`: how many times faster than real the clock of an emulated arm runs.
    """

    sensitivity: int = LEAST_SENSITIVITY
    load: float = 0.0
    load_center: tuple[float, float, float] = (0.0, 0.0, 0.0)
    offset: tuple[float, ...] = (0.0,) * 6
    gravity: tuple[float, float, float] = (0.0, 0.0, -1.0)
    tool_model: int = 1
    tool_speed: float = 1000.0
    joint_speed: float = math.pi
    ranges: tuple[tuple[float, float], ...] = LIMITS
    fence: Mapping[str, tuple[float, float]] = field(default_factory=lambda: FENCE)
    set_points: bool = True
    pace: float = 1.0

    @property
    def boundary(self) -> list[int]:
        """The fence as the library takes it: greatest and least of each axis, whole mm, never wider than asked."""
        return [int(v) for axis in "xyz" for v in (math.floor(self.fence[axis][1]), math.ceil(self.fence[axis][0]))]


def settings(name: str, entry: DeviceEntry) -> XArmSettings:
    """Return the settings of an entry; raises PicoError with all that is wrong with them."""
    said: dict[str, Any] = {**{key: one.default for key, one in SETTINGS.items()}, **entry.settings}
    wrong = [f"`{key}` is no setting of an xArm" for key in said if key not in SETTINGS]
    wrong += [f"`{key}` {text}: {one.about}" for key, one in SETTINGS.items() if (text := one.complaint(said[key]))]
    if wrong:
        raise PicoError([error("device", f"{name}: {text}", address=name) for text in wrong])
    tool, follow = str(said["tool"]), str(said["follow"])
    numbers = {key: said[key] for key in _NUMBERS}
    n = {key: float(value or 0.0) for key, value in numbers.items()}
    limits = entry.limits
    return XArmSettings(
        sensitivity=int(n["sensitivity"]),
        load=n["load"],
        load_center=(n["load_x"], n["load_y"], n["load_z"]),
        offset=(
            n["tool_x"],
            n["tool_y"],
            n["tool_z"],
            *(math.radians(n[f"tool_{a}"]) for a in ("roll", "pitch", "yaw")),
        ),
        gravity=(n["gravity_x"], n["gravity_y"], n["gravity_z"]),
        tool_model=_TOOLS[tool],
        tool_speed=min(1000.0, limits.get("tool_speed", (0.0, 1000.0))[1]),
        joint_speed=math.radians(min(180.0, limits.get("joint_speed", (0.0, 180.0))[1])),
        ranges=tuple(_range(limits.get(f"joint{i}"), usual) for i, usual in enumerate(LIMITS, 1)),
        fence={axis: limits.get(axis, FENCE[axis]) for axis in "xyz"},
        set_points=follow == "set-points",
        pace=n["pace"],
    )


def _unit_of(key: str) -> str:
    if key == "load":
        return "kg"
    if key.startswith(("load_", "tool_")):
        return "deg" if key.rpartition("_")[2] in ("roll", "pitch", "yaw") else "mm"
    return ""


_NUMBERS: Mapping[str, float] = (
    {"sensitivity": LEAST_SENSITIVITY, "load": 0.0, "pace": 1.0}
    | {f"{what}_{axis}": 0.0 for what in ("load", "tool") for axis in "xyz"}
    | {f"tool_{angle}": 0.0 for angle in ("roll", "pitch", "yaw")}
    | {"gravity_x": 0.0, "gravity_y": 0.0, "gravity_z": -1.0}
)


SETTINGS: Mapping[str, Setting] = {
    **{
        key: Setting(default=default, unit=_unit_of(key), about=f"`{key}` as the control box takes it")
        for key, default in _NUMBERS.items()
    },
    "sensitivity": Setting(
        default=LEAST_SENSITIVITY,
        range=(LEAST_SENSITIVITY, 5),
        kind=int,
        about="of the collision detection: with less an arm does not notice what it hits",
    ),
    "pace": Setting(
        default=1.0, range=(0.01, 100), about="how many times faster than real the clock of an emulated arm is"
    ),
    "tool": Setting(
        kind=str, default="gripper", choices=tuple(_TOOLS), about="the shape of the tool, for self-collision"
    ),
    "follow": Setting(
        kind=str,
        default="set-points",
        choices=("set-points", "moves"),
        about="by set-points of PICO, or moves of the box",
    ),
}
"""What `settings` of an arm may say."""


def _range(asked: tuple[float, float] | None, usual: tuple[float, float]) -> tuple[float, float]:
    if asked is None:
        return usual
    return max(usual[0], math.radians(asked[0])), min(usual[1], math.radians(asked[1]))


def differing(name: str, wanted: XArmSettings, arm: Any) -> list[Diagnostic]:
    """Return what the box reports otherwise than it was told. `arm`: the library's, after a report since."""
    load, center = arm.tcp_load
    collisions = arm.self_collision_params
    pairs: list[tuple[str, Any, Any]] = [
        ("gravity direction", wanted.gravity, arm.gravity_direction),
        ("load", (wanted.load, *wanted.load_center), (load, *center)),
        ("tool offset", wanted.offset, arm.tcp_offset),
        ("collision sensitivity", (wanted.sensitivity,), (arm.collision_sensitivity,)),
        ("self-collision detection and tool", (1, wanted.tool_model), collisions[:2]),
        ("greatest speed of the tool", (wanted.tool_speed,), (arm.reduced_max_tcp_speed,)),
        ("greatest speed of the joints", (wanted.joint_speed,), (arm.reduced_max_joint_speed,)),
        ("fence", wanted.boundary, arm.reduced_tcp_boundary),
        ("fence and reduced mode", (True, True), (arm.is_fence_mode, arm.is_reduced_mode)),
    ]
    found = [
        error(
            "arm-setting", f"{name} did not take its {what}: it reports {_shown(has)}, not {_shown(told)}",
            hint="is another program connected to it, or a safety setting locked?", address=name,
        )
        for what, told, has in pairs
        if len(told) != len(has) or any(abs(a - b) > 1e-2 + 1e-3 * abs(a) for a, b in zip(told, has, strict=True))
    ]  # fmt: skip
    for number, ((low, high), (least, most)) in enumerate(zip(wanted.ranges, arm.reduced_joint_limits, strict=True), 1):
        if least < low - 1e-3 or most > high + 1e-3:  # the library narrows them to the arm's generation
            text = f"{name} did not take its range of joint {number}: it reports {_shown((least, most))} rad"
            found.append(error("arm-setting", text, address=name))
    return found


def _shown(values: Any) -> str:
    return ", ".join(f"{float(v):g}" for v in values)
