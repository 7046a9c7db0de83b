"""Which parts could have done what a cause did, as far as the readings of a bench tell: found by letting the simulator
do it, with each kind of cause in sizes that are fitted. Nothing of PICO's diagnosis is asked."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from nights_causes import KINDS, Happening, Night, happen, unsure
from nights_table import Evening, Reading, off

CLOSE = 3.5
"""Sigma within which all readings must be for a part to look alike."""
TRIED = 3
"""So many kinds of causes are fitted, the likeliest first."""
_SIZES: dict[str, Sequence[float]] = {
    "power": (0.95, 0.8, 0.6, 0.4), "loss": (0.05, 0.2, 0.4, 0.6, 0.85, 0.97), 
    "gain": (0.03, 0.15, 0.5, 0.7, 0.9, 1.1, 1.3, 1.5),
    "angle": (1.0, 3.0, 7.0, 12.0), "tip": (0.1, 0.4, 1.0, 2.0), "tilt": (0.1, 0.4, 1.0, 2.0),
    "stage_y": (0.05, 0.15, 0.4), "stage_z": (0.05, 0.15, 0.4), "opening": (-1.0, -2.5, -4.5, -6.0),
    "left": (0.03, 0.1, 0.3), "up": (0.03, 0.1, 0.3), "yaw": (0.01, 0.04, 0.12), "pitch": (0.01, 0.04, 0.12),
    "dark": (20.0, 100.0, 400.0), "retardance": (0.02, 0.06, 0.15), "leak": (3e-4, 1e-3, 5e-3),
    "roll": (3.0, 8.0, 18.0),
}  # fmt: skip
_ONE_WAY = ("power", "loss", "gain", "opening", "dark", "leak")
_WAYS = {
    "laser points elsewhere": ("yaw", "pitch"), "fiber coupler turned": ("yaw", "pitch"),
    "lens settled": ("left", "up"), "detector displaced": ("left", "up"), "laser lost power": ("power",),
    "dirt on an optic": ("loss",), "rotation mount slipped": ("angle",), "iris closed": ("opening",),
    "detector gain": ("gain",), "detector warm": ("dark",), "wave plate of other retardance": ("retardance",),
    "polarizer leaks": ("leak",), "isolator turned": ("roll",),
}  # fmt: skip


def alike(bench: Evening, night: Night, one: Happening, parts: Sequence[str]) -> list[str]:
    """Return those of some parts, without that of a cause, which could have done what it did beside the others."""
    rest = [c for c in night.causes if c is not one]
    able = [p for p in parts if p != one.part and p not in {c.part for c in rest} and p in bench.setup.lab.inventory]
    if not able:
        return []
    whole = happen(bench, bench.world, night.causes)
    now, sure = bench.readings(whole), unsure(bench, whole, night.causes)
    without = bench.readings(happen(bench, bench.world, rest))
    return [p for p in able if any(_fits(bench, rest, now, sure, s) for s in _starts(bench, p, now, without))]


def _starts(
    bench: Evening, part: str, now: Mapping[str, Reading], without: Mapping[str, Reading]
) -> Iterator[Happening]:  # fmt: skip
    """Yield for each kind of cause that a part can have the size that comes nearest, the nearest kind first."""
    best: list[tuple[float, str, Happening]] = []
    for kind in KINDS:
        tries = [(_apart(_changes(bench, t), now, without), t) for t in _tries(bench, kind, part)]
        if tries:
            far, there = min(tries, key=lambda pair: pair[0])
            best.append((far, kind, there))
    for *_, there in sorted(best, key=lambda row: row[:2])[:TRIED]:
        yield there


def _tries(bench: Evening, kind: str, part: str) -> Iterator[Happening]:
    """Yield causes of a kind that a part can have, in some sizes."""
    known, about = KINDS[kind], bench.setup.type_of(part)
    if not known.may(about) or known.command not in ("slip", "upset"):
        return
    if kind == "lens swapped":
        for focal in (75, 100, 125, 150, 200):
            yield Happening(kind, part, "upset", {"focal_length": float(focal)})
        return
    ways = _WAYS.get(kind)
    if ways is None:  # one of several axes
        axes = ("tip", "tilt") if kind == "mirror mount slipped" else ("stage_y", "stage_z")
        for axis in (a for a in axes if a in about.tunables):
            yield from (Happening(kind, part, "slip", {axis: s * v}) for v in _SIZES[axis] for s in (1, -1))
    elif len(ways) == 2:
        for size in _SIZES[ways[0]]:
            turns = [math.pi * n / 4 for n in range(8)]
            yield from (
                Happening(kind, part, "upset", {ways[0]: size * math.cos(t), ways[1]: size * math.sin(t)})
                for t in turns
            )
    else:
        (way,) = ways
        for size in _SIZES[way]:
            yield from (
                Happening(kind, part, known.command, {way: s * size}) for s in ((1,) if way in _ONE_WAY else (1, -1))
            )


_made: dict[tuple[str, str], dict[str, float]] = {}


def _changes(bench: Evening, one: Happening) -> dict[str, float]:
    """Return what a cause alone does to each reading of the evening: the logarithm of the share, of places the
    difference."""
    key = (bench.lab, " ".join(one.words))
    if key not in _made:
        _made[key] = _ratio(bench.readings(happen(bench, bench.world, [one])), bench.readings(bench.world))
    return _made[key]


def _ratio(now: Mapping[str, Reading], then: Mapping[str, Reading]) -> dict[str, float]:
    found = {}
    for key in now.keys() & then.keys():
        a, b = now[key][0], then[key][0]
        found[key] = a - b if _place(key) else math.log(max(a, 2 * now[key][1]) / max(b, 2 * then[key][1]))
    return found


def _apart(made: Mapping[str, float], now: Mapping[str, Reading], without: Mapping[str, Reading]) -> float:
    """Return how far the changes that a cause makes alone are from those that happened [sigma, together]."""
    total = 0.0
    for key, change in _ratio(now, without).items():
        total += ((made.get(key, 10.0) - change) / _unit(key, now, {})) ** 2
    return math.sqrt(total)


def _fits(
    bench: Evening, rest: Sequence[Happening], now: Mapping[str, Reading], sure: Mapping[str, float], start: Happening
) -> bool:  # fmt: skip
    """Return whether a cause makes the readings what they are, in some size, with the hidden ones of the others in
    whatever sizes go with it."""
    import numpy as np

    from pico.diagnostics import PicoError

    every = [start, *(c for c in rest if not c.seen)]
    fixed = [c for c in rest if c.seen]
    free = [(n, k) for n, c in enumerate(every) for k, v in c.by.items() if not isinstance(v, str)]

    def at(size: Any) -> dict[str, Reading]:
        by = [dict(c.by) for c in every]
        for (n, k), v in zip(free, size, strict=True):
            by[n][k] = _OUTSIDE[k](float(v)) if k in _OUTSIDE else float(v)
        causes = [replace(c, by=b) for c, b in zip(every, by, strict=True)]
        return bench.readings(happen(bench, bench.world, [*fixed, *causes]))

    def left(size: Any) -> Any:
        there = at(size)
        change = _ratio(there, now)
        return np.array([change.get(key, 10.0) / _unit(key, now, sure) for key in now])

    def near(size: Any) -> bool:
        change = off(at(size), now, sure)
        return all(abs(change.get(key, math.inf)) < CLOSE for key in now)

    try:
        given = [float(every[n].by[k]) for n, k in free]
        size = np.array([_INSIDE[k](v) if k in _INSIDE else v for (_, k), v in zip(free, given, strict=True)])
        own = [max(abs(size[m]) for m, (other, _) in enumerate(free) if other == n) for n, _ in free]
        units, missing, damping = np.array([max(0.02 * v, 1e-5) for v in own]), left(size), 1e-3
        for _ in range(8):
            if near(size):
                return True
            slopes = np.array([left(size + u * e) - missing for u, e in zip(units, np.eye(len(size)), strict=True)]).T
            square = slopes.T @ slopes
            for _ in range(4):
                whole = square + damping * (np.trace(square) + 1e-12) * np.eye(len(size))
                there = size - units * np.linalg.solve(whole, slopes.T @ missing)
                rest_ = left(there)
                if rest_ @ rest_ < missing @ missing:
                    break
                damping *= 8
            else:
                return False
            if rest_ @ rest_ > 0.99 * (missing @ missing):
                return near(there)
            size, missing, damping = there, rest_, damping / 8
        return near(size)
    except (PicoError, ValueError, OverflowError, np.linalg.LinAlgError):
        return False


_LOGARITHMS = ("power", "gain", "leak", "focal_length")
_INSIDE = {"loss": lambda v: -math.log(1 - v), **dict.fromkeys(_LOGARITHMS, math.log)}
_OUTSIDE = {"loss": lambda v: 1 - math.exp(-max(0.0, v)), **dict.fromkeys(_LOGARITHMS, math.exp)}
"""Into the coordinates in which sizes are fitted, and out of them."""


def _unit(key: str, now: Mapping[str, Reading], sure: Mapping[str, float]) -> float:
    """Return what a change of a reading counts as one sigma, in its coordinate."""
    value, sigma = now[key]
    whole = math.hypot(math.sqrt(2) * sigma, sure.get(key, 0.0))
    return whole if _place(key) else whole / max(abs(value), 2 * sigma)


def _place(key: str) -> bool:
    return " x" in key or " y" in key or "mean" in key
