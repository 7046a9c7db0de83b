"""Setting a tunable of a real bench, homing its axis, and finding the exposure of a camera."""

from __future__ import annotations

import math
from collections.abc import Awaitable, Callable, Mapping
from dataclasses import asdict
from typing import Any

from pico.backends import checks
from pico.backends.attempt import Failed
from pico.backends.hardware.failing import failed
from pico.backends.hardware.instruments import Instruments
from pico.backends.measured import Reading
from pico.backends.ranging import MOST, Taken, first_exposure, in_vain, next_exposure, taken
from pico.diagnostics import PicoError, error
from pico.model.diff import value_distance
from pico.model.instruments.kind import Driven
from pico.model.operation import Operation
from pico.model.record import as_json
from pico.model.setup import Setup


async def driven(
    setup: Setup, bench: Instruments, operation: Operation, pause: Callable[[float], Awaitable[None]]
) -> Mapping[str, Any]:  # fmt: skip
    """Drive a tunable to a value, or its axis to its home, read it back, and let it settle; raises Failed, or
    PicoError for what its device says."""
    name, (tunable, kind) = operation.component, checks.setpoint(setup, operation)
    one = _device(bench, f"{name}.{tunable}")
    if operation.primitive == "home":
        goal = value = await one.home()  # the device's zero, whatever the lab calls that
    else:
        goal = checks.require_value(name, tunable, kind, operation.arguments.get("to"))
        if kind.axis and kind.axis.kind == "homed" and (await one.read()).status == "unknown":
            await one.home()
        value = await one.set(goal)
    if value_distance(kind, value, goal) > max(kind.tolerance, 1e-9):
        text = f"it reads {value}, not {goal} {kind.unit}".rstrip()
        raise failed(operation, PicoError(error("not-reached", text, hint="plan again")))
    await pause(kind.settle / 1000)
    return {"value": value}


async def ranged(
    setup: Setup, bench: Instruments, operation: Operation, image: Callable[[str], Awaitable[Reading]],
    tell: Callable[[Mapping[str, Any]], None],
) -> Mapping[str, Any]:  # fmt: skip
    """Take frames, and expose each as the one before tells, until one is neither saturated nor dark; `tell` hears of
    each. Raises Failed where none is, or PicoError for what the camera says."""
    name, (tunable, kind) = operation.component, checks.setpoint(setup, operation)
    one = _device(bench, f"{name}.{tunable}")
    if name not in bench.sensors:
        raise Failed(error("no-device", f"no device of this bench takes pictures with {name}", address=name))
    frames, limits = list[Taken](), kind.range or (0.0, math.inf)
    while len(frames) < MOST:
        exposure = (await one.read()).value
        if not isinstance(exposure, int | float):  # it was never set, so that no picture could be taken
            exposure = await one.set(first_exposure(limits))
        found = await image(name)
        assert found.array is not None  # it is a picture
        black, full = (float(found.settings[k] or 0.0) for k in ("black_level", "full_scale"))
        frames.append(taken(float(exposure), found.array, black, full))
        tell({"fraction": len(frames) / MOST, "phase": "exposing"})
        wanted = next_exposure(frames[-1], limits)
        if wanted is None:
            break
        await one.set(wanted)
    if (why := in_vain(name, frames)) is not None:
        if why.code == "dark":  # nothing was found out: as it was
            await one.set(frames[0].exposure)
        raise Failed(why)
    return {"value": frames[-1].exposure, "frames": [as_json(asdict(frame)) for frame in frames]}


def _device(bench: Instruments, address: str) -> Driven:
    one = bench.tunables.get(address)
    if one is None:
        raise Failed(error("no-device", f"no device of this bench sets {address}", address=address))
    return one
