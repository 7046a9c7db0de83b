"""Changing a simulated table from outside, as no hand could."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from bench_at import bench_at

from pico.backends.sim.store import load_world, save_world
from pico.backends.sim.world import World, new_world
from pico.edge.lease import BenchLock
from pico.model.setup import Setup


def change_world(setup: Setup, root: Path, holder: str, change: Callable[[World], World]) -> None:
    """Change the simulated table with the bench locked meanwhile; raises PicoError (LOCKED) where somebody moves it."""
    with BenchLock(bench_at(root)).held(holder):
        save_world(bench_at(root), change(load_world(setup, bench_at(root))[0]))


def reset_world(setup: Setup, root: Path, holder: str) -> None:
    """Start the simulated table over: every part at home."""
    with BenchLock(bench_at(root)).held(holder):
        save_world(bench_at(root), new_world(setup))
