"""Parts on a cable: how far it reaches, and how far it is wound. Lengths in mm, angles in deg.

How far a part was turned in all is not kept anywhere: it is read from how the part stands. That is right as long as no
part is ever wound by half a turn from its neutral yaw, so no cable is, also where its `yaw_limit` is larger.
"""

from __future__ import annotations

import math

from pico.model.lab import Part
from pico.model.pose import Pose, short, wrap
from pico.model.setup import Setup

MOST = 175.0
"""What a cable is wound at most [deg]: half a turn, less what keeps a small error of a yaw from reading as another."""
NEUTRAL = "tether_yaw"
"""The key of a part's `calibration` that holds its neutral yaw [deg]."""


def neutral_yaw(setup: Setup, part: Part) -> float:
    """Return the yaw at which a part's cable is not wound [deg]: its calibration's `tether_yaw`, else that of its home
    or fixed pose."""
    if NEUTRAL in part.calibration:
        return part.calibration[NEUTRAL]
    return setup.lab.slots[part.home].yaw if part.home else part.pose.yaw if part.pose else 0.0


def wound(setup: Setup, component: str, yaw: float) -> float:
    """Return how far the cable of a component that stands at `yaw` is wound [deg], counter-clockwise positive."""
    return wrap(yaw - neutral_yaw(setup, setup.lab.inventory[component]))


def turn_between(setup: Setup, component: str, start: Pose, goal: Pose) -> float | None:
    """Return by how much a component on a cable must turn from `start` to `goal` [deg]: through its neutral yaw, never
    the other way around, which would wind the cable by another turn. None without a cable."""
    if setup.lab.inventory[component].tether is None:
        return None
    return wound(setup, component, goal.yaw) - wound(setup, component, start.yaw)


def tether_fault(setup: Setup, component: str, pose: Pose) -> tuple[str, float, str]:
    """Return why the cable of `component` keeps it from standing at `pose`, by how much [mm or deg], and what would
    help; the text is empty where nothing does."""
    tether = setup.lab.inventory[component].tether
    if tether is None:
        return "", 0.0, ""
    away = math.hypot(pose.x - tether.anchor[0], pose.y - tether.anchor[1])
    anchor = f"({short(tether.anchor[0])}, {short(tether.anchor[1])})"
    if away > tether.length:
        text = f"its cable is {short(tether.length)} mm long, and {anchor}, where it is anchored, is {away:.0f} mm away"
        return text, away - tether.length, f"place it {away - tether.length:.0f} mm nearer to {anchor}"
    turned, most = wound(setup, component, pose.yaw), min(tether.yaw_limit, MOST)
    if abs(turned) > most + 1e-9:
        neutral = short(wrap(pose.yaw - turned))
        text = f"its cable would be wound by {short(abs(turned))}°, and takes {short(most)}° either way of {neutral}°"
        return text, abs(turned) - most, f"turn it back by {short(abs(turned) - most)}° or more"
    return "", 0.0, ""
