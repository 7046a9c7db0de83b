"""MuJoCo, imported for the first time. Nothing of PICO needs OpenGL, but MuJoCo looks for it where the environment
names a way to it (`MUJOCO_GL`), and fails with whatever error its search ends in."""

from __future__ import annotations

import os

from pico.diagnostics import Diagnostic, PicoError, error

_PACKAGES = {"egl": "libegl1 and libgl1-mesa-dri", "osmesa": "libosmesa6"}
"""Debian packages that bring what a value of `MUJOCO_GL` needs."""


def require_mujoco() -> None:
    """Import MuJoCo; call it before the first model is built. Raises PicoError where `MUJOCO_GL` keeps it from it."""
    try:
        import mujoco  # noqa: F401
    except Exception as exc:  # OpenGL's own errors: AttributeError where a library is missing
        asked = os.environ.get("MUJOCO_GL", "")
        if not asked or (isinstance(exc, ImportError) and "mujoco" in str(exc.name or "")):
            raise
        raise PicoError(no_gl(asked)) from exc


def no_gl(asked: str) -> Diagnostic:
    """Return the diagnostic of an environment that asks for OpenGL in a way that this machine does not have."""
    packages = _PACKAGES.get(asked.lower())
    text = f"MUJOCO_GL is `{asked}`, and this machine has no OpenGL of that kind"
    other = f", or install it (Debian: {packages})" if packages else ""
    hint = f"`unset MUJOCO_GL`: PICO draws without OpenGL{other}"
    return error("no-opengl", text, hint=hint)
