"""The benches of a lab as tests name them: by its folder, the simulated one unless they say which."""

from __future__ import annotations

from pathlib import Path

from pico.places.bench import BenchPlace


def bench_at(root: Path, name: str = "sim") -> BenchPlace:
    """Return a bench of the lab in `root`."""
    return BenchPlace(root, name)
