"""Faults that are planted in the kernels, one at a time, for `beam_pictures.py` to catch."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import Any
from unittest.mock import patch

from pico.kernels.frame import Frame
from pico.kernels.kernel import Result

_MODULES = ("spot", "start", "gaussian", "background", "moments", "ellipse", "stripes", "beside", "defects", "frame")
_STANDARD = ("centroid", "d4sigma", "gaussian_fit")
Patches = list[Any]


def _everywhere(name: str, make: Callable[[Any], Any]) -> Patches:
    """Patches of a function under each name by which the kernels call it; raises LookupError if it is gone."""
    modules = [f"pico.kernels.{m}" for m in _MODULES] + [f"pico.kernels.standard.{m}" for m in _STANDARD]
    found = []
    for path in modules:
        try:
            module = importlib.import_module(path)
        except ImportError:
            continue
        if callable(one := getattr(module, name, None)):
            found.append(patch.object(module, name, make(one)))
    if not found:
        raise LookupError(f"no module of the kernels has `{name}`, which the plant alters: mend the plant")
    return found


def _kernels(alter: Callable[[Any], Any], given: Callable[[Frame], Frame] = lambda frame: frame) -> Patches:
    """Patches of what kernels are given and return."""
    found = []
    for name in _STANDARD:
        module = importlib.import_module(f"pico.kernels.standard.{name}")
        apply = module.apply
        found.append(patch.object(module, "apply", lambda f, p, apply=apply: alter(apply(given(f), p))))
    return found


def _same(result: Any) -> Any:
    return result


def _sigmas(factor: float) -> Callable[[], Patches]:
    return lambda: _kernels(lambda r: replace(r, sigma={n: s * factor for n, s in r.sigma.items()}))


def _no_background() -> Patches:
    def bare(plane: Any) -> Any:
        return lambda *a, **k: replace(plane(*a, **k), level=0.0, slopes=(0.0, 0.0))

    return _everywhere("plane", bare)


def _no_slope() -> Patches:
    def flat(plane: Any) -> Any:
        return lambda *a, **k: replace(plane(*a, **k), slopes=(0.0, 0.0))

    return _everywhere("plane", flat)


def _saturation_ignored() -> Patches:
    return _everywhere("full_pixels", lambda _: lambda pixels, full_scale: (0, float(pixels.max())))


def _stuck_counted() -> Patches:
    if not hasattr(Frame, "defects"):
        raise LookupError("frames have no `defects`, which the plant empties: mend the plant")
    import numpy as np

    none = np.empty(0, np.intp), np.empty(0, np.intp)
    return [
        patch.object(Frame, "defects", none),
        *_everywhere("full_pixels", lambda _: lambda p, s: (0, float(p.max()))),
    ]


def _edge_ignored() -> Patches:
    import numpy as np

    unaware = patch("pico.kernels.cut.change", lambda *a, **k: np.zeros(6))
    return [*_everywhere("leaving", lambda _: lambda *a, **k: ""), unaware]


def _at(factor: float, shift: float) -> Callable[[], Patches]:
    def moved(frame: Frame, column: float, row: float) -> tuple[float, float]:
        h, w = frame.pixels.shape
        size = frame.pixel_size
        return (column + shift - (w - 1) / 2) * size, factor * ((h - 1) / 2 - row) * size

    return lambda: [patch.object(Frame, "at", moved)]


def _axes(alter: Callable[[Any], Any]) -> Callable[[], Patches]:
    return lambda: _everywhere("ellipse", lambda ellipse: lambda *a, **k: alter(ellipse(*a, **k)))


def _wider(axes: Any) -> Any:
    return replace(axes, values=axes.values * [1.02, 1.02, 1.0])


def _mirrored(axes: Any) -> Any:
    return replace(axes, values=axes.values * [1.0, 1.0, -1.0])


def _given(**changes: float) -> Callable[[], Patches]:
    return lambda: _kernels(_same, lambda frame: replace(frame, **changes))


def _unknown(text: str) -> Callable[[Any], Any]:
    return lambda result: Result(unknown=text) if result.unknown else result


def _timid(result: Any) -> Any:
    """Unknown as soon as a width or a place is not known to a thousandth."""
    sure = all(s < 1e-3 * abs(result.value[n]) for n, s in result.sigma.items() if n in ("major", "minor"))
    return result if sure else Result(unknown="too much noise")


PLANTS: dict[str, Callable[[], Patches]] = {
    "no-background": _no_background,
    "no-slope-of-the-background": _no_slope,
    "sigma-halved": _sigmas(0.5),
    "sigma-0.7": _sigmas(0.7),
    "saturation-ignored": _saturation_ignored,
    "stuck-pixels-counted": _stuck_counted,
    "stripes-ignored": lambda: _everywhere("stripes", lambda _: lambda *a, **k: None),
    "edge-ignored": _edge_ignored,
    "half-a-pixel-off": _at(1.0, 0.5),
    "up-is-down": _at(-1.0, 0.0),
    "2-percent-wider": _axes(_wider),
    "angle-mirrored": _axes(_mirrored),
    "shot-noise-forgotten": _given(electrons_per_count=1e6),
    "wrong-reason": lambda: _kernels(_unknown("the kernel ended")),
    "dark-as-reason": lambda: _kernels(_unknown("there is no light above the background")),
    "unknown-at-once": lambda: _kernels(_timid),
}


@contextmanager
def plant(name: str) -> Iterator[None]:
    """Plant a fault for the time being; raises LookupError if what it alters is gone."""
    patches = PLANTS[name]()
    for one in patches:
        one.start()
    try:
        yield
    finally:
        for one in reversed(patches):
            one.stop()
