"""Random labs with two states each, dense enough that rings, swaps and fingers matter. mm and deg."""

from __future__ import annotations

import math
import random
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from checker import base, fingers

from pico.model.catalog import Axis, ComponentType, Footprint, Geometry, Grasp, SeatingKind, Tunable
from pico.model.lab import Lab, Margins, Part, Slot, Table
from pico.model.observation import Observation, ObservedComponent, ObservedValue
from pico.model.pose import Pose
from pico.model.robot import Mount, Robot
from pico.model.setup import Setup
from pico.model.state import ComponentState, LabState, place_of

PITCH = 110.0
"""Distance of storage slots: two of the largest parts stand side by side at any yaw."""


@dataclass(frozen=True)
class Case:
    """A bench as it is, and a state that it should come to."""

    setup: Setup
    seen: Observation
    wanted: LabState


def random_case(seed: int, *, least: int = 5, most: int = 30) -> Case:
    """Return the case that belongs to a seed, of `least` to `most` components."""
    rng = random.Random(seed)
    count = rng.randint(least, most)
    kinds = {f"type_{i}": _type(rng, f"type_{i}") for i in range(rng.randint(2, 6))}
    parts = {f"c{i:02}": _part(rng, sorted(kinds)) for i in range(count)}
    stored = rng.randint(0, count // 3)
    spare = rng.randint(1, 3) if count <= 7 else rng.randint(2, 6)
    density, margin = rng.choice((0.2, 0.3, 0.4)), rng.choice((0.0, 2.0))
    by_arm = rng.random() < (0.6 if count <= 7 else 0.95)  # both states leave room to grip each part where it stands
    while True:
        setup = _setup(rng, kinds, parts, stored + spare, density, margin)
        first = _arrangement(rng, setup, {}, stored, by_arm)
        second = first and _arrangement(rng, setup, first.components, rng.randint(0, stored), by_arm)
        if first and second:
            return Case(setup, observe(setup, first, rng), second)
        density *= 0.95  # too full: a larger table


def _type(rng: random.Random, name: str) -> ComponentType:
    height = rng.choice((60.0, 100.0, 140.0))
    yaws = rng.choice(((0.0, 90.0), (0.0, 90.0), (0.0,), (90.0,), (0.0, 45.0, 90.0)))
    grasp = Grasp(height=height - rng.choice((10.0, 30.0)), width=rng.choice((20.0, 30.0, 44.0)), yaws=yaws)
    geometry = Geometry(footprint=_footprint(rng), height=height, mass=0.3, grasp=grasp)
    axis = Axis(kind="homed", speed=30.0)
    turning = {"angle": Tunable(unit="deg", period=360.0, tolerance=0.1, mover="motor", axis=axis)}
    return ComponentType(name=name, title=name, tunables=turning if rng.random() < 0.4 else {}, geometry=geometry)


def _footprint(rng: random.Random) -> Footprint:
    kind = rng.random()
    if kind < 0.15:
        return Footprint(disc=rng.uniform(20, 34))
    if kind < 0.3:
        n, r = rng.choice((3, 5, 6)), rng.uniform(28, 38)
        angles = [2 * math.pi * i / n for i in range(n)]
        return Footprint(polygon=tuple((r * math.cos(a), r * math.sin(a)) for a in angles))
    return Footprint(box=(rng.uniform(35, 90), rng.uniform(35, 60)))


def _part(rng: random.Random, kinds: list[str]) -> Part:
    seating: SeatingKind | None = "bolted" if rng.random() < 0.05 else None
    stage = rng.choice(("allowed",) * 8 + ("avoid", "never"))
    return Part(type=rng.choice(kinds), home="s00", seating=seating, stage=stage)


def _setup(
    rng: random.Random, kinds: Mapping[str, ComponentType], parts: Mapping[str, Part], slots: int, density: float,
    margin: float,
) -> Setup:  # fmt: skip
    """Return a lab whose free table is filled to `density` by all parts, with storage in rows behind it."""
    footprints = [kinds[p.type].geometry.footprint for p in parts.values()]
    area = sum(base(f, Pose(0, 0)).core.area + math.pi * (f.disc or 0.0) ** 2 for f in footprints)
    depth = max(160.0, math.sqrt(area / density / 1.5))
    width = max(2 * PITCH, 1.5 * depth)
    columns = int(width // PITCH)
    storage = {
        f"s{i:02}": Slot(
            x=PITCH * (i % columns + 0.5), y=depth + PITCH * (i // columns + 0.5),
            yaw=rng.choice((0.0, 0.0, 90.0, 30.0)), fits=rng.choice((None, None, 45.0)),
        )
        for i in range(slots)
    }  # fmt: skip
    behind = depth + PITCH * math.ceil(slots / columns)
    lab = Lab(
        name="random", table=Table(size=(width, behind)), slots=storage, inventory=parts,
        robots={"arm1": Robot(mount=Mount(x=width / 2, y=behind))}, margins=Margins(body=margin, fingers=margin),
    )  # fmt: skip
    return Setup(lab=lab, catalog=kinds)


def _arrangement(
    rng: random.Random, setup: Setup, before: Mapping[str, ComponentState], stored: int, by_arm: bool
) -> LabState | None:
    """Return a state free of overlap, `stored` parts in slots; many parts take the place of another, or shift a bit
    into one another's room. None where no room was found."""
    names = list(setup.lab.inventory)
    rng.shuffle(names)
    share = rng.choice((0.0, 0.3, 0.6))
    names.sort(key=lambda n: not _stays(rng, setup, n, before, share))
    chosen: dict[str, ComponentState] = {}

    def free(name: str, spot: ComponentState) -> bool:
        return _free(setup, name, spot, chosen) and (not by_arm or grippable(setup, {**chosen, name: spot}, name))

    for name in names:
        if name in before and _stays(rng, setup, name, before, share) and free(name, before[name]):
            chosen[name] = _with_value(rng, setup, name, before[name])
            continue
        spots = _candidates(rng, setup, name, before, stored > sum(s.slot is not None for s in chosen.values()))
        spot = next((s for s in spots if free(name, s)), None)
        if spot is None:
            return None
        chosen[name] = _with_value(rng, setup, name, spot)
    return LabState(lab=setup.lab.name, components=chosen)


def _stays(rng: random.Random, setup: Setup, name: str, before: Mapping[str, ComponentState], share: float) -> bool:
    bolted = setup.seating_of(name) == "bolted" and rng.random() < 0.9
    return name in before and (bolted or rng.random() < share)


def _with_value(rng: random.Random, setup: Setup, name: str, place: ComponentState) -> ComponentState:
    values = {t: float(rng.randint(0, 12) * 30) for t in setup.type_of(name).tunables}
    return ComponentState(slot=place.slot, pose=place.pose, values=values)


def _candidates(
    rng: random.Random, setup: Setup, name: str, before: Mapping[str, ComponentState], store: bool
) -> Iterator[ComponentState]:
    width, depth = setup.lab.table.size[0], min(s.y for s in setup.lab.slots.values()) - PITCH / 2
    bolted = setup.seating_of(name) == "bolted"
    others = [s.pose for s in before.values() if s.pose]
    if store and not bolted:
        yield from (ComponentState(slot=s) for s in rng.sample(sorted(setup.lab.slots), len(setup.lab.slots)))
    for n in range(150):
        yaw = rng.choice((0.0, 0.0, 90.0, 180.0, 30.0, rng.uniform(-180, 180)))
        old = before[name].pose if name in before else None
        if others and n < 8:
            place = rng.choice(others)
            yield ComponentState(pose=Pose(place.x, place.y, rng.choice((place.yaw, yaw))))
        elif old and n < 16:
            yield ComponentState(
                pose=Pose(old.x + rng.gauss(0, 30), old.y + rng.gauss(0, 30), rng.choice((old.yaw, yaw)))
            )
        else:
            yield ComponentState(pose=Pose(rng.uniform(20, width - 20), rng.uniform(20, depth - 20), yaw))


def _pose(setup: Setup, state: ComponentState) -> Pose:
    return state.pose or setup.lab.slots[state.slot or ""].pose


def _free(setup: Setup, name: str, spot: ComponentState, chosen: Mapping[str, ComponentState]) -> bool:
    footprint, pose, margin = setup.type_of(name).geometry.footprint, _pose(setup, spot), setup.lab.margins.body
    shape = base(footprint, pose)
    x0, y0, x1, y1 = shape.core.bounds
    width, depth = setup.lab.table.size
    if min(x0, y0) < shape.radius or x1 > width - shape.radius or y1 > depth - shape.radius:
        return False
    if spot.slot and (setup.lab.slots[spot.slot].fits or math.inf) < footprint.radius:
        return False
    for other, state in chosen.items():
        place, stands = _pose(setup, state), setup.type_of(other).geometry.footprint
        if place.distance(pose) > footprint.radius + stands.radius + margin:
            continue
        if shape.gap(base(stands, place)) <= margin + 1e-3:
            return False
    return True


def grippable(setup: Setup, states: Mapping[str, ComponentState], new: str) -> bool:
    """Whether the fingers have room around `new`, and still have around each part near it, at one yaw at least."""
    poses = {n: _pose(setup, s) for n, s in states.items()}
    near = [n for n in poses if poses[n].distance(poses[new]) < 130]
    for name in near:
        geometry = setup.type_of(name).geometry
        assert geometry.grasp is not None
        neighbors = [
            base(setup.type_of(n).geometry.footprint, p)
            for n, p in poses.items()
            if n != name and p.distance(poses[name]) < 130
            and setup.type_of(n).geometry.height > geometry.grasp.height - 10.0
        ]  # fmt: skip
        rooms = (
            fingers(geometry, setup.lab.robots["arm1"].gripper, yaw, poses[name])[0] for yaw in geometry.grasp.yaws
        )
        if not any(all(z.gap(b) > setup.lab.margins.fingers + 1e-3 for z in room for b in neighbors) for room in rooms):
            return False
    return True


def observe(setup: Setup, state: LabState, rng: random.Random) -> Observation:
    """Return the bench as it is seen in a state; now and then nobody knows where a motor stands."""
    components = {}
    for name in setup.lab.inventory:
        values = {
            tunable: ObservedValue(value=v) if rng.random() < 0.9 else ObservedValue(value=None, status="unknown")
            for tunable, v in state.components[name].values.items()
        }
        components[name] = ObservedComponent(pose=place_of(setup, state, name)[1], values=values)
    return Observation(backend="sim", components=components)
