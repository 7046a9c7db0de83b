"""What only the simulation knows, poisoned: whoever asks for it while a bench works by sight is found out.

The world itself may be stored, and cameras may look at it; nothing else may know where a part is, what a hand holds or
whether a part moves.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import Any
from unittest.mock import patch

from pico.backends.sim import known, session, sight
from pico.backends.sim.physics import PhysicsWorld
from pico.backends.sim.senses import sensed
from pico.backends.sim.world import World
from pico.model.pose import Pose
from pico.twin.physics import Twin


class Poisoned(AssertionError):
    """Somebody asked for what a bench does not tell."""


@contextmanager
def poisoned() -> Iterator[None]:
    """Let every way to the truth fail, but for what stores the world."""
    storing: list[bool] = []

    def only_stored(name: str) -> Any:
        true = getattr(Twin, name)

        def asked(self: Twin, *rest: Any) -> Any:
            if not storing:
                raise Poisoned(name)
            return true(self, *rest)

        return asked

    stored = PhysicsWorld.world

    def world(self: PhysicsWorld, before: World) -> World:
        storing.append(True)
        try:
            return stored(self, before)
        finally:
            storing.pop()

    def refuse(*_: Any, **__: Any) -> Any:
        raise Poisoned("observe")

    def blindly(setup: Any, world: World, *rest: Any) -> Any:
        return sensed(setup, without_truth(world), *rest)

    with (
        patch.object(Twin, "placement", only_stored("placement")),
        patch.object(Twin, "gripped", only_stored("gripped")),
        patch.object(PhysicsWorld, "world", world),
        patch.object(PhysicsWorld, "carried", refuse),
        patch.object(known, "observe", refuse),
        patch.object(sight, "observe", refuse),
        patch.object(session, "sensed", blindly),
        patch.object(sight, "sensed", blindly),
    ):
        yield


def without_truth(world: World) -> World:
    """Return the world with every pose wrong; fingers that tell how far they are apart hold something else."""
    components = {n: replace(body, presence="seen", pose=Pose(-1e4, -1e4), free=None)
                  for n, body in world.components.items()}  # fmt: skip
    robots = {n: replace(r, holding=None) if n in world.openings else r for n, r in world.robots.items()}
    return replace(world, components=components, robots=robots, unknown={})
