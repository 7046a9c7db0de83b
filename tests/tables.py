"""Changing a simulated table from outside, as no hand could."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from pico.backends.sim.store import load_world, save_world
from pico.backends.sim.world import World, new_world
from pico.edge.lease import BenchLock
from pico.model.setup import Setup
from pico.places.bench import BenchPlace


def change_world(setup: Setup, root: Path, holder: str, change: Callable[[World], World]) -> None:
    """Change the simulated table with the bench locked meanwhile; raises PicoError (LOCKED) where somebody moves it."""
    with BenchLock(BenchPlace(root, "sim")).held(holder):
        save_world(BenchPlace(root, "sim"), change(load_world(setup, BenchPlace(root, "sim"))[0]))


def reset_world(setup: Setup, root: Path, holder: str) -> None:
    """Start the simulated table over: every part at home."""
    with BenchLock(BenchPlace(root, "sim")).held(holder):
        save_world(BenchPlace(root, "sim"), new_world(setup))
