"""Versions."""

from __future__ import annotations

import platform
import subprocess
from importlib.metadata import PackageNotFoundError
from importlib.metadata import version as installed
from typing import Any

from .style import columns

STANDS_ON = ("mujoco", "numpy", "pygit2", "pydantic", "PyYAML", "ruckig", "typer")


def text() -> str:
    """Return a line a component."""
    return "\n".join(columns([[name, found or "not installed"] for name, found in data()["versions"].items()]))


def data() -> dict[str, Any]:
    """Return schema `pico.version/v1`: `versions` by name."""
    from pico import __version__

    own = {"pico": __version__, "python": platform.python_version(), "git": _git()}
    system = {"system": f"{platform.system()} {platform.machine()}"}
    return {"schema": "pico.version/v1", "versions": own | {name: _installed(name) for name in STANDS_ON} | system}


def _installed(name: str) -> str | None:
    try:
        return installed(name)
    except PackageNotFoundError:
        return None


def _git() -> str | None:
    try:
        done = subprocess.run(["git", "--version"], capture_output=True, text=True, check=False)
    except OSError:
        return None
    return done.stdout.removeprefix("git version ").strip() or None
