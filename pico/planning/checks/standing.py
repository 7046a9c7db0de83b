"""What stands on a table once a plan is done, and what a part may not reach into."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from pico.geometry import Grid, Shape, conflict, outline, overhang, placed, reaches
from pico.model.setup import Setup
from pico.planning.parts.movers import Mover, Place


@dataclass(frozen=True, slots=True)
class Standpoint:
    """Where something stands in the end, and how tall it is [mm]: a mover at its goal, or what stays."""

    name: str
    shape: Shape
    moves: bool
    height: float


@dataclass(frozen=True, slots=True)
class Standing:
    """Everything that stands on the table in the end, by name."""

    ends: Mapping[str, Standpoint]
    grid: Grid[str]

    def near(self, mover: Mover, shape: Shape, margin: float) -> list[Standpoint]:
        """Return what comes nearer than `margin` mm to a shape that a mover needs."""
        return [self.ends[name] for name in self.grid.conflicts(shape, margin) if name != mover.name]


def goal_shape(mover: Mover, place: Place) -> Shape:
    """Return the footprint of a mover at a place."""
    return placed(mover.geometry.footprint, place.pose)


def in_bounds(setup: Setup, mover: Mover, place: Place) -> bool:
    """Whether a part at a place is on the table, or beside it in a slot, and out of every keep-out."""
    shape = goal_shape(mover, place)
    on_table = setup.lab.beside_table(place.slot) or overhang(setup.lab.table, shape) <= 0
    return on_table and not forbidden(setup, mover, shape)


def forbidden(setup: Setup, mover: Mover, shape: Shape) -> list[str]:
    """Return the keep-outs that a part would reach into."""
    keep_out, height = setup.lab.keep_out, mover.geometry.height
    zones = sorted(keep_out)
    return [z for z in zones if reaches(keep_out[z], 0.0, height) and conflict(shape, outline(keep_out[z]))]
