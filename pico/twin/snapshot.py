"""What a film sees: where everything is at one moment, and in between two of them."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from pico.motion.types import Joints
from pico.twin.placement import Placement, Quaternion


@dataclass(frozen=True, slots=True)
class Snapshot:
    """The bench at `time` [s]: components by name, joints of each robot [rad], and the sources that give no light."""

    time: float
    places: Mapping[str, Placement] = field(default_factory=dict)
    joints: Mapping[str, Joints] = field(default_factory=dict)
    dark: frozenset[str] = frozenset()


class Recording:
    """The snapshots of a run, in the order of time."""

    def __init__(self) -> None:
        self.snapshots: list[Snapshot] = []

    def look(self, snapshot: Snapshot) -> None:
        """Take another one; of two at the same time the later one holds."""
        if self.snapshots and self.snapshots[-1].time == snapshot.time:
            self.snapshots.pop()
        self.snapshots.append(snapshot)


def at(snapshots: Sequence[Snapshot], time: float) -> Snapshot:
    """Return the bench at `time` [s], straight between the snapshots before and after it; the first or last one beyond
    them. What only one of the two knows is as the earlier one has it."""
    i = bisect_right(snapshots, time, key=lambda s: s.time)
    if i == 0 or i == len(snapshots):
        return snapshots[max(0, i - 1)]
    a, b = snapshots[i - 1], snapshots[i]
    share = (time - a.time) / (b.time - a.time)
    places = {n: _place(p, b.places[n], share) if n in b.places else p for n, p in a.places.items()}
    joints = {n: _mix(j, b.joints[n], share) if n in b.joints else j for n, j in a.joints.items()}
    return Snapshot(time, places, joints, a.dark)


def _place(a: Placement, b: Placement, share: float) -> Placement:
    if a == b:
        return a
    return Placement(_triple(_mix(a.position, b.position, share)), _turned(a.quaternion, b.quaternion, share))


def _mix(a: Sequence[float], b: Sequence[float], share: float) -> tuple[float, ...]:
    return tuple(p + share * (q - p) for p, q in zip(a, b, strict=True))


def _triple(values: tuple[float, ...]) -> tuple[float, float, float]:
    x, y, z = values
    return x, y, z


def _turned(a: Quaternion, b: Quaternion, share: float) -> Quaternion:
    """The orientation between two that lie close together: their normalized mean, the short way round."""
    sign = 1.0 if sum(p * q for p, q in zip(a, b, strict=True)) >= 0 else -1.0
    w, x, y, z = _mix(a, tuple(sign * q for q in b), share)
    length = math.sqrt(w * w + x * x + y * y + z * z)
    return w / length, x / length, y / length, z / length
