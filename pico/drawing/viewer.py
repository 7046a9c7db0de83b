"""MuJoCo's own viewer on the bench, where there is a display: to look around, nothing moves by it."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable, Mapping
from typing import Any

from pico.diagnostics import PicoError, error
from pico.drawing.picture import pose_model, posed_model
from pico.model.setup import Setup
from pico.motion.types import Joints
from pico.twin.placement import Placement

Scene = tuple[Mapping[str, Placement], Mapping[str, Joints]]
LOOK = 0.5
"""Seconds between two looks at the bench."""
_HINT = "`pico render` draws the bench without a display"


def require_display() -> None:
    """Raise PicoError where no window can be opened."""
    if sys.platform == "linux" and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        text = "there is no display to open MuJoCo's viewer on: neither DISPLAY nor WAYLAND_DISPLAY is set"
        raise PicoError(error("no-display", text, hint=_HINT))
    if sys.platform == "darwin" and not os.environ.get("MJPYTHON_BIN"):
        text = "on macOS MuJoCo's viewer runs under its own Python only"
        raise PicoError(error("no-display", text, hint=f"start pico by it: `mjpython $(which pico) sim view`; {_HINT}"))


def view(setup: Setup, now: Callable[[], Scene]) -> None:
    """Open the viewer and follow the bench, as `now` gives it, until the window is closed; raises PicoError."""
    require_display()
    places, joints = now()
    model, data = posed_model(setup, places, joints)
    handle = _opened(model, data)
    try:
        while handle.is_running():
            found, joints = now()
            known = {name: place for name, place in found.items() if name in places}
            with handle.lock():
                pose_model(setup, model, data, known, joints)
            handle.sync()
            time.sleep(LOOK)
    finally:
        handle.close()


def _opened(model: Any, data: Any) -> Any:
    import warnings

    try:
        import glfw
        import mujoco.viewer

        with warnings.catch_warnings():
            warnings.simplefilter("error")  # else MuJoCo ends the whole process where no window can be opened
            if not glfw.init():
                raise RuntimeError("GLFW can't be initialized")
        return mujoco.viewer.launch_passive(model, data)
    except Exception as exc:  # GLFW and GL libraries fail in ways of their own
        reason = " ".join(str(exc).split())[:200]
        raise PicoError(error("no-display", f"MuJoCo's viewer does not open: {reason}", hint=_HINT)) from exc
