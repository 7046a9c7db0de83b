"""PICO: version control for the optical table."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

if TYPE_CHECKING:
    from pathlib import Path

    from pico.scripting.bench import Bench


def open(path: str | Path = ".", **options: Any) -> Bench:
    """Open the laboratory in folder `path` (or any folder below it) and return its bench.

    Options are those of `pico.bench.bench.Bench.open` (`backend`, `fidelity`).
    Raises `pico.diagnostics.PicoError` where the folder holds no laboratory or its manifests are wrong.
    """
    from pico.scripting.bench import Bench

    return Bench.open(path, **options)
