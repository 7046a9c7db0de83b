"""The classical rearrangement problem as a lab: equal discs on a square table, a gantry without fingers that sets down
anywhere, no margin, and a slot beside the table for each disc. mm.

There a disc is in the way of another strictly below two radii; on our tables touching counts as well. The two are the
same problem where no pair of places touches, which `disc_case` asks for.
"""

from __future__ import annotations

import math
import random
from collections.abc import Sequence

from random_labs import Case

from pico.model.catalog import ComponentType, Footprint, Geometry, Grasp
from pico.model.lab import Lab, Margins, Part, Slot, Table
from pico.model.observation import Observation, ObservedComponent
from pico.model.pose import Pose
from pico.model.robot import Gripper, Mount, Robot
from pico.model.setup import Setup
from pico.model.state import ComponentState, LabState

Places = Sequence[Sequence[float]]

APART = 1e-6
"""How far from touching every two places must be [mm]."""


def disc_case(radius: float, side: float, starts: Places, goals: Places) -> Case:
    """Return the lab, seen with the discs at `starts`, and the state with them at `goals`; raises ValueError where a
    disc at one of the places would just touch another."""
    for a in (*starts, *goals):
        for b in (*starts, *goals):
            if a is not b and abs(math.dist(a, b) - 2 * radius) < APART:
                raise ValueError(f"discs at {a} and {b} would touch")
    names = [f"d{i:03}" for i in range(len(starts))]
    geometry = Geometry(
        footprint=Footprint(disc=radius), height=100, mass=0.3, grasp=Grasp(height=90, width=30, yaws=(0.0,))
    )
    pitch = 2 * radius + 20
    lab = Lab(
        name="discs", table=Table(size=(side, side)), margins=Margins(body=0, fingers=0),
        slots={f"s{i:03}": Slot(x=side + pitch, y=pitch * i) for i in range(len(names))},
        robots={"arm1": Robot(model="gantry", mount=Mount(x=0, y=0), gripper=Gripper(fingers="none"))},
        inventory={n: Part(type="disc", home=f"s{i:03}") for i, n in enumerate(names)},
    )  # fmt: skip
    seen = {n: ObservedComponent(pose=Pose(x, y)) for n, (x, y) in zip(names, starts, strict=True)}
    wanted = {n: ComponentState(pose=Pose(x, y)) for n, (x, y) in zip(names, goals, strict=True)}
    setup = Setup(lab=lab, catalog={"disc": ComponentType(name="disc", title="Disc", geometry=geometry)})
    return Case(setup, Observation(backend="sim", components=seen), LabState(lab="discs", components=wanted))


def random_places(rng: random.Random, count: int, radius: float, side: float) -> list[tuple[float, float]]:
    """Return random places for discs that don't overlap, on a table that has room for them."""
    while True:
        found: list[tuple[float, float]] = []
        for _ in range(500 * count):
            x, y = rng.uniform(radius, side - radius), rng.uniform(radius, side - radius)
            if all(math.dist((x, y), other) > 2 * radius + APART for other in found):
                found.append((x, y))
            if len(found) == count:
                return found


def waits(radius: float, starts: Places, goals: Places) -> list[list[int]]:
    """Return for each disc those that can't arrive before it has left."""
    every = range(len(starts))
    return [[i for i in every if i != j and math.dist(starts[j], goals[i]) < 2 * radius] for j in every]
