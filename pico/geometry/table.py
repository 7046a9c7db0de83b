"""The edge of the table, keep-out volumes, and what a slot takes. mm."""

from __future__ import annotations

import math

from pico.geometry.shape import Shape, disc, rectangle
from pico.model.catalog import Footprint
from pico.model.lab import KeepOut, Slot, Table


def overhang(table: Table, shape: Shape) -> float:
    """Return how far `shape` sticks out over the edge of the table [mm]; zero or less where it lies on it."""
    xs = [x for x, _ in shape.vertices] or [shape.x - shape.radius, shape.x + shape.radius]
    ys = [y for _, y in shape.vertices] or [shape.y - shape.radius, shape.y + shape.radius]
    out = max(-min(xs), max(xs) - table.size[0], -min(ys), max(ys) - table.size[1])
    return math.inf if math.isnan(out) else out


def outline(keep_out: KeepOut) -> Shape:
    """Return the outline of a keep-out volume."""
    return rectangle(keep_out.area.x, keep_out.area.y)


def reaches(keep_out: KeepOut, lowest: float, highest: float) -> bool:
    """Return whether what fills the heights from `lowest` to `highest` above the table meets the volume's."""
    return keep_out.z[0] <= highest and keep_out.z[1] >= lowest


def capture_disc(slot: Slot) -> Shape:
    """Return the disc within which a part's origin counts as in the slot: no other footprint may meet it."""
    return disc(slot.x, slot.y, slot.capture)


def fits(slot: Slot, footprint: Footprint) -> bool:
    """Return whether the slot takes a part of this size."""
    return slot.fits is None or footprint.radius <= slot.fits
