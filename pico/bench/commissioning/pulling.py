"""The step in which each safety input is pulled once: PICO must notice, refuse, and notice again that all is well."""

from __future__ import annotations

import asyncio
import time

from pico.backends.hardware.guarding import tripped
from pico.bench.commissioning.standing import AtBench, Found
from pico.diagnostics import Diagnostic, PicoError, error
from pico.model.commissioning import CODE
from pico.model.wiring import SafetyKind

PATIENCE = 120.0
"""Seconds of wall time that a person has for it."""
LOOKS = 0.05
ACTS: dict[SafetyKind, str] = {
    "door": "open the door", "curtain": "step into the curtain", "emergency_stop": "press the emergency stop",
    "key": "turn the key off", "interlock": "open the interlock", "shutter": "unplug the shutter's sensor",
}  # fmt: skip


def safety_inputs(at: AtBench) -> Found:
    """Each safety input is pulled, told as unsafe, put back, and told as safe. Raises PicoError."""
    inputs = at.bench.wait(at.device.links.instruments()).inputs
    if not inputs:
        text = "the lab's files name no safety input: nothing tells PICO of a door, an interlock or a stop"
        raise PicoError(error(CODE, text, hint="`safety_inputs:` of a file of kind Devices"))
    found = {}
    for name, (entry, _) in sorted(inputs.items()):
        if (wrong := at.bench.wait(_tripped(at, name))) is not None:
            raise PicoError(wrong)
        _pulled(at, name, True)
        began = time.monotonic()
        told = at.bench.wait(_until(at, name, tripped_wanted=True))
        if told is None:
            raise PicoError(error(CODE, f"{name} was to be pulled, and still reads as safe", address=name))
        found[name] = {"kind": entry.kind, "told": told.summary, "seconds": round(time.monotonic() - began, 2)}
        _pulled(at, name, False)
        if (wrong := at.bench.wait(_until(at, name, tripped_wanted=False))) is not None:
            raise PicoError(wrong)
    return Found(told=f"pulled, told and put back: {', '.join(found)}", data={"inputs": found})


def _pulled(at: AtBench, name: str, pulled: bool) -> None:
    """Have an input pulled, or put back: by a person, or behind its emulator."""
    entry = at.bench.wait(at.device.links.instruments()).inputs[name][0]
    world = at.device.links.world
    if world is not None:
        world.pull(entry.device, pulled)
        return
    act = ACTS[entry.kind]
    at.asks.say(f"  {name}: {act} now." if pulled else f"  {name}: it is told. Put it back as it was.")


async def _tripped(at: AtBench, name: str) -> Diagnostic | None:
    inputs = (await at.device.links.instruments()).inputs
    return await tripped({name: inputs[name]}, {inputs[name][0].kind})


async def _until(at: AtBench, name: str, *, tripped_wanted: bool) -> Diagnostic | None:
    """Return what is told of an input as soon as that is as wanted; what is told at last after so long."""
    ends = time.monotonic() + PATIENCE
    while True:
        told = await _tripped(at, name)
        if (told is not None) == tripped_wanted or time.monotonic() > ends:
            return told
        await asyncio.sleep(LOOKS)
