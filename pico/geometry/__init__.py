"""Footprints, finger clearance, slots and regions: which things on the table come too near to one another."""

from pico.geometry.fingers import finger_height, finger_zones
from pico.geometry.grid import Grid
from pico.geometry.shape import (
    CONTACT,
    Shape,
    conflict,
    disc,
    half_turn_symmetric,
    moved,
    placed,
    polygon,
    rectangle,
    separation,
)
from pico.geometry.table import capture_disc, fits, outline, overhang, reaches

__all__ = [
    "CONTACT",
    "Grid",
    "Shape",
    "capture_disc",
    "conflict",
    "disc",
    "finger_height",
    "finger_zones",
    "fits",
    "half_turn_symmetric",
    "moved",
    "outline",
    "overhang",
    "placed",
    "polygon",
    "reaches",
    "rectangle",
    "separation",
]
