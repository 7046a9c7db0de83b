"""A world whose lab changed: parts, robots and tunables that came, went or are of another type now."""

from __future__ import annotations

from dataclasses import replace

from pico.backends.sim.world import World, WorldBody, footprints, initial_values, new_body, parked, shapes_of
from pico.diagnostics import Diagnostic, warning
from pico.geometry.shape import placed, separation
from pico.model.address import called_now, renamed_keys, renaming_of
from pico.model.observation import UnknownObject
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.model.state import home_state, place_of


def reconcile(setup: Setup, world: World) -> tuple[World, tuple[Diagnostic, ...]]:
    """Return the world as the bench `setup` has it, and what had to change.

    A part that is new appears at home, or is missing where its home is taken. A part that the inventory lost stays
    where it stands, as an unknown object; where the inventory takes it up again, it is that part again.
    """
    found: list[Diagnostic] = []
    world = _renamed(setup, world, found)
    world = _without_lost(setup, world, found)
    world = replace(world, lab=setup.lab.name, shapes=shapes_of(setup))
    world = _with_new(setup, world, found)
    components = {name: _retyped(setup, name, world.components[name]) for name in setup.lab.inventory}
    robots = {name: world.robots.get(name) or parked(setup, name) for name in setup.lab.robots}
    cameras = {name: shift for name, shift in world.cameras.items() if name in setup.lab.cameras}
    return replace(world, components=components, robots=robots, cameras=cameras), tuple(found)


def stranger(name: str, marker: int | None) -> str:
    """Return the name under which a part that the inventory does not have is seen."""
    return f"unknown/{name if marker is None else marker}"


def _renamed(setup: Setup, world: World, found: list[Diagnostic]) -> World:
    """Return the world with parts under their present names that it knows by former ones (`formerly:`)."""
    names = {
        old: new for old, new in renaming_of(setup.lab).items()
        if old in world.components and new not in world.components
    }  # fmt: skip
    if not names:
        return world
    for old, new in sorted(names.items()):
        found.append(Diagnostic("note", "part-renamed", f"{old} is now called {new}", address=new))
    robots = {k: replace(r, holding=names.get(r.holding or "", r.holding)) for k, r in world.robots.items()}
    return replace(
        world,
        components=renamed_keys(names, world.components),
        robots=robots,
        stickers={called_now(names, key): marker for key, marker in world.stickers.items()},
        stuck=tuple(called_now(names, axis) for axis in world.stuck),
    )


def _without_lost(setup: Setup, world: World, found: list[Diagnostic]) -> World:
    lost = world.components.keys() - setup.lab.inventory.keys()
    unknown = dict(world.unknown)
    for name in sorted(lost):
        body = world.components[name]
        if body.pose is None:
            found.append(warning("part-gone", f"{name} is not in the inventory any more, nor on the table"))
            continue
        shape, key = world.shapes[body.type], stranger(name, body.marker)
        unknown[key] = UnknownObject(pose=body.pose, footprint=shape.footprint, height=shape.height)
        text = f"{name} is not in the inventory any more; it stays at {body.pose} as {key}, an obstacle"
        found.append(warning("part-gone", text, address=name))
    kept = {name: body for name, body in world.components.items() if name not in lost}
    robots = {k: replace(r, holding=None) if r.holding in lost else r for k, r in world.robots.items()}
    return replace(world, components=kept, unknown=unknown, robots=robots)


def _with_new(setup: Setup, world: World, found: list[Diagnostic]) -> World:
    homes = home_state(setup)
    for name in sorted(setup.lab.inventory.keys() - world.components.keys()):
        key = stranger(name, setup.lab.inventory[name].marker)
        known = world.unknown.get(key)
        if known:
            world = replace(world, unknown={k: v for k, v in world.unknown.items() if k != key})
            pose, text = known.pose, f"{name} is new in the inventory: {key} at {known.pose} is it"
        else:
            pose = place_of(setup, homes, name)[1]
            text = f"{name} is new in the inventory: the simulated table has it at its home {pose}"
        taken = _taken_by(setup, world, name, pose)
        if taken:
            text = f"{name} is new in the inventory, but {taken} stands at its home {pose}: it is missing"
        hint = f"free its home, then `pico sim nudge {name}` puts it there" if taken else ""
        found.append(warning("part-new", text, hint=hint, address=name))
        body = new_body(setup, name, None if taken else pose)
        world = replace(world, components={**world.components, name: body})
    return world


def _taken_by(setup: Setup, world: World, name: str, pose: Pose) -> str | None:
    shape = placed(setup.type_of(name).geometry.footprint, pose)
    return next((o for o, f, at in footprints(world) if separation(shape, placed(f, at)) < -1e-6), None)


def _retyped(setup: Setup, name: str, body: WorldBody) -> WorldBody:
    """Return the component with the type, marker and tunables that the inventory gives it now."""
    part, kind = setup.lab.inventory[name], setup.type_of(name)
    if body.type == part.type and body.marker == part.marker and body.values.keys() == kind.tunables.keys():
        return body
    values = {key: body.values.get(key, first) for key, first in initial_values(kind).items()}
    offsets = {key: by for key, by in body.offsets.items() if key in values}
    return replace(body, type=part.type, marker=part.marker, values=values, offsets=offsets)
