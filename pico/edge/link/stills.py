"""Small pictures of what cameras see now, for who watches: with what kernels say of each, marked on it. None is kept,
and none is taken while a run could be disturbed."""

from __future__ import annotations

import asyncio
import base64
import time
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from pico.diagnostics import ExitCode, PicoError, error
from pico.edge.protocol import STEERING

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from pico.backends.measured import Reading
    from pico.edge.local import LocalEdge
    from pico.kernels.frame import Frame

EVERY = 0.2
"""Seconds between two pictures of a camera: who asks more often gets the last one again."""
WIDEST = 640
"""Pixels across a picture at most: several of the camera's make one of it."""
MANY = 8
"""How many rows of kernels are made of a picture at most."""


class Stills:
    """Pictures of the cameras of a bench, one taken at a time, whoever asks."""

    def __init__(self, edge: LocalEdge, clock: Callable[[], float] = time.monotonic) -> None:
        self._edge, self._clock = edge, clock
        self._last: dict[tuple[str, ...], tuple[float, dict[str, Any]]] = {}
        self._turn = asyncio.Lock()

    async def of(self, component: str, measurable: str, kernels: Sequence[str]) -> dict[str, Any]:
        """Return what a camera sees (`pico.still/v1`, see `still`), with what each of some `kernels` makes of it:
        measurables of the camera, or kernels in a row (`image | peak`). `age` [s]; `waits`: why there is no newer one.

        Raises PicoError where there is no picture, also (exit code LOCKED) where a run goes on and none was taken
        before it."""
        if len(kernels) > MANY:
            raise PicoError(error("limit", f"{MANY} kernels are made of a picture at most"))
        key = (component, measurable, *kernels)
        async with self._turn:
            taken, last = self._last.get(key, (0.0, None))
            if last is None or self._clock() - taken >= EVERY:
                waits = await self._waits()
                if waits and last is None:
                    raise PicoError(error("busy", f"no picture of {component}: {waits}"), ExitCode.LOCKED)
                if waits and last is not None:
                    return {**last, "age": round(self._clock() - taken, 3), "waits": waits}
                began = self._clock()
                reading = await self._edge.device.snap(component, measurable)
                rows = {name: self._row(component, measurable, name) for name in kernels}
                last = await asyncio.to_thread(still, component, measurable, reading, rows)
                self._last = {k: v for k, v in self._last.items() if k[:2] != key[:2]}  # one a camera is remembered
                taken, self._last[key] = began, (began, last)
            return {**last, "age": round(self._clock() - taken, 3), "waits": ""}

    async def _waits(self) -> str:
        """Return what goes on at the bench that a picture could disturb; empty where nothing does."""
        holder = await self._edge.holder()
        return "" if holder is None or holder.what.startswith(STEERING) else f"{holder.what} goes on"

    def _row(self, component: str, measurable: str, name: str) -> str:
        """Return the kernels that a name means; raises PicoError where they are not made of this picture."""
        from pico.kernels.pipeline import parsed, require_numbers

        kernel = self._edge.setup.measurable_of(component, name).kernel
        if kernel is None or parsed(kernel).source != measurable:
            raise PicoError(error("kernel", f"{component}.{name} is not made of {measurable}", address=component))
        require_numbers(parsed(kernel))
        return kernel


def still(
    component: str, measurable: str, reading: Reading, rows: Mapping[str, str], wide: int = WIDEST
) -> dict[str, Any]:
    """Return schema `pico.still/v1`: the picture as `png` (base64, grey: black is the black level, white the brightest
    pixel), its `width` and `height`, how many pixels of the camera are one of it (`by`), the camera's `settings`, what
    is `saturated`; the `values` of kernels by name: `value`, `sigma`, `unit`, `unknown`; and `marks` in pixels of the
    picture, which is `wide` pixels across at most. Raises PicoError where nothing was seen."""
    from pico.kernels.measured import computed, frame_of
    from pico.kernels.pipeline import parsed

    if reading.array is None or reading.array.ndim != 2:
        raise PicoError(error("picture", f"{component}.{measurable} gives no picture", address=component))
    picture, by = _grey(reading.array, float(str(reading.settings.get("black_level", 0.0))), wide)
    values, marks = {}, list[dict[str, Any]]()
    frame = frame_of(reading.array, reading.settings) if rows else None
    for name, row in rows.items():
        pipeline = parsed(row)
        found = computed(pipeline, reading.array, reading.settings)
        values[name] = {
            "value": found.value, "sigma": found.sigma, "unit": found.unit, "unknown": found.unknown, "kernel": row,
        }  # fmt: skip
        if isinstance(found.value, Mapping) and frame is not None:
            marks += [one | {"of": name} for one in _marks(pipeline.steps[-1].name, found.value, frame, by)]
    height, width = picture.shape
    return {
        "schema": "pico.still/v1", "component": component, "measurable": measurable, "png": _png(picture),
        "width": width, "height": height, "by": by, "settings": dict(reading.settings),
        "saturated": reading.saturated or "", "values": values, "marks": marks,
    }  # fmt: skip


def _grey(counts: NDArray[Any], black: float, wide: int) -> tuple[NDArray[Any], int]:
    """Return a frame [count] as a small grey picture, and how many of its pixels across are one of that."""
    import cv2
    import numpy as np

    by = -(-counts.shape[1] // wide)
    size = (counts.shape[1] // by, counts.shape[0] // by)
    small = cv2.resize(counts.astype(np.float32), size, interpolation=cv2.INTER_AREA) - black
    return np.clip(255 * small / max(1.0, float(small.max())), 0, 255).astype(np.uint8), by


def _png(picture: NDArray[Any]) -> str:
    import cv2

    return base64.b64encode(cv2.imencode(".png", picture)[1].tobytes()).decode()


def _marks(kernel: str, found: Mapping[str, Any], frame: Frame, by: int) -> list[dict[str, Any]]:
    """Return what the numbers of a kernel are on the picture: a `cross`, the `box` that was integrated over, an
    `ellipse` by its half axes and its angle, clockwise on the picture [deg]."""
    from pico.kernels.spot import spot

    height, width = frame.pixels.shape

    def pixel(column: float, row: float) -> dict[str, float]:
        return {"x": round((column + 0.5) / by, 2), "y": round((row + 0.5) / by, 2)}

    def place(x: float, y: float) -> dict[str, float]:
        return pixel((width - 1) / 2 + x / frame.pixel_size, (height - 1) / 2 - y / frame.pixel_size)

    def axes() -> dict[str, float]:
        scale = 2 * frame.pixel_size * by
        return {"major": found["major"] / scale, "minor": found["minor"] / scale, "angle": -found["angle"]}

    beam = spot(frame, iterated=kernel == "d4sigma") if kernel in ("centroid", "d4sigma") else ""
    if kernel == "centroid" and not isinstance(beam, str):
        top, bottom, left, right = beam.box
        box = {"x": left / by, "y": top / by, "width": (right - left) / by, "height": (bottom - top) / by}
        return [{"mark": "box", **box}, {"mark": "cross", **place(found["x"], found["y"])}]
    if kernel == "d4sigma" and not isinstance(beam, str):
        return [{"mark": "ellipse", **pixel(float(beam.moments[0]), float(beam.moments[1])), **axes()}]
    if {"x", "y", "major", "minor", "angle"} <= found.keys():
        return [{"mark": "ellipse", **place(found["x"], found["y"]), **axes()}]
    return []
