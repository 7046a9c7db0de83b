"""The scene of a bench as its edge tells it, kept as it is now: what who comes later begins with."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from pico.drawing.scene.frames import Arm, Body, Frame, encoded

Document = dict[str, Any]


class Shown:
    """A scene and what moved since; `events` counts what was told of it."""

    def __init__(self, scene: Document) -> None:
        self._scene, self.epoch, self.rev, self.time = scene, int(scene["epoch"]), int(scene["rev"]), scene["time"]
        self._arms: dict[int, Arm] = {}
        self._bodies: dict[int, Body] = {}
        for arm in scene["arms"]:
            if arm["known"]:
                self._arms[arm["index"]] = (tuple(arm["joints"]), arm["width"])
        self._parts: dict[int, Document] = {}
        for part in scene["components"]:
            self._stands(part)

    def moved(self, said: Mapping[str, Any]) -> bytes:
        """Take in what moved, and return the frame that says so; all of it where nothing did."""
        arms: dict[int, Arm] = {n: (tuple(joints), width) for n, joints, width in said["arms"]}
        bodies: dict[int, Body] = {n: (x, y, z, w, i, j, k) for n, x, y, z, w, i, j, k in said["bodies"]}
        self._arms |= arms
        self._bodies |= bodies
        self.time = said["time"]
        return encoded(Frame(self.epoch, self.rev, self.time, arms, bodies)) if arms or bodies else self.whole()

    def whole(self) -> bytes:
        """Return the frame that says where everything is."""
        return encoded(Frame(self.epoch, self.rev, self.time, self._arms, self._bodies))

    def told(self, kind: str, rev: int, data: Mapping[str, Any]) -> None:
        """Take in what changed otherwise."""
        self.rev = rev
        if kind == "beams":
            self._scene["beams"] = data["beams"]
        elif kind == "guard":
            self._scene["guard"] = data["notices"]
        elif kind == "component":
            self._stands(data)

    def scene(self) -> Document:
        """Return the whole scene as it is now."""
        arms = [self._arm(arm) for arm in self._scene["arms"]]
        parts = [self._part(index) for index in sorted(self._parts)]
        return {**self._scene, "rev": self.rev, "time": self.time, "arms": arms, "components": parts}

    def _stands(self, part: Mapping[str, Any]) -> None:
        index = part["index"]
        self._parts[index] = {**self._parts.get(index, {}), **part}
        if part["position"] is not None:
            x, y, z = part["position"]
            w, i, j, k = part["quaternion"]
            self._bodies[index] = (x, y, z, w, i, j, k)
        else:
            self._bodies.pop(index, None)

    def _arm(self, arm: Document) -> Document:
        if arm["index"] not in self._arms:
            return arm
        joints, width = self._arms[arm["index"]]
        held = [part["name"] for part in self._parts.values() if part.get("held_by") == arm["name"]]
        return {**arm, "joints": list(joints), "width": width, "holding": held[0] if held else None}

    def _part(self, index: int) -> Document:
        part = self._parts[index]
        if index not in self._bodies:
            return part
        x, y, z, w, i, j, k = self._bodies[index]
        yaw = math.degrees(math.atan2(2 * (w * k + i * j), 1 - 2 * (j * j + k * k)))
        return {
            **part,
            "position": [x, y, z],
            "quaternion": [w, i, j, k],
            "pose": {"x": x, "y": y, "yaw": round(yaw, 4)},
        }
