"""Versions."""

from __future__ import annotations

import platform
import subprocess
from importlib.metadata import PackageNotFoundError
from importlib.metadata import version as installed

STANDS_ON = ("mujoco", "numpy", "pygit2", "pydantic", "PyYAML", "ruckig", "typer")


def versions() -> dict[str, str | None]:
    """Return the versions of PICO and of what it stands on, None where it is not installed."""
    from pico.version import __version__

    own = {"pico": __version__, "python": platform.python_version(), "git": _git()}
    system = {"system": f"{platform.system()} {platform.machine()}"}
    return own | {name: _installed(name) for name in STANDS_ON} | system


def _installed(name: str) -> str | None:
    try:
        return installed(name)
    except PackageNotFoundError:
        return None


def _git() -> str | None:
    try:
        done = subprocess.run(["git", "--version"], capture_output=True, text=True, check=False, encoding="utf-8")
    except OSError:
        return None
    return done.stdout.removeprefix("git version ").strip() or None
