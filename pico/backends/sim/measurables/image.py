"""A frame of a beam camera: the light on its sensor, in counts, row 0 at the top."""

from __future__ import annotations

from pico.backends.attempt import Failed
from pico.backends.measured import Reading
from pico.backends.sim.lighted import detects, light_on, room_light, sightless, uncertain
from pico.backends.sim.readings import Table
from pico.diagnostics import error
from pico.model.setup import Setup

SPECK = 1e-6
"""The share of the light on a camera below which the shape of a beam does not matter: where it interferes with the rest
it makes a change of twice the square root of that, 0.2 %."""


def measures(setup: Setup, component: str, measurable: str) -> bool:
    """Whether it is the image of a camera whose type says what its sensor is."""
    found = any(detects(setup, component, measurable, what) for what in ("image", "dark"))
    return found and setup.type_of(component).number("pixel_size", "um") is not None


def read(table: Table, component: str, measurable: str) -> Reading:
    """Return the frame, with its brightest pixel (`peak`) and its `mean` [counts]."""
    from pico.kernels.frame import saturated
    from pico.optics.beam_table import decibel
    from pico.optics.instruments import camera_frame, sensor_of
    from pico.optics.light import out_of_step

    light = light_on(table)
    arrivals, part = light.at(component), light.parts.get(component)
    if part is None:
        raise Failed(error("missing", f"{component} does not stand on the table", address=component))
    if none := uncertain(light, component) or sightless(light, component):
        return none
    dim = SPECK * sum(a.power for a in arrivals)
    if unknown := next((a.beam for a in arrivals if a.beam.unknown and a.power > dim), None):
        text = f"what {component} would see of {unknown.source} is not known: {unknown.unknown}"
        raise Failed(error("unknown-light", text, hint="`pico beam` shows where", address=component))
    if why := out_of_step(tuple(a for a in arrivals if a.power > dim)):
        hint = "put as much glass into each arm"
        raise Failed(
            error("unknown-light", f"what {component} would see is not known: {why}", hint=hint, address=component)
        )
    counts = camera_frame(
        arrivals, part, stray=room_light(table), errors=table.setup.lab.sim.errors.sensor, seed=table.world.seed,
        number=round(table.world.clock * 1000),
    )  # fmt: skip
    sensor = sensor_of(part)
    gain = decibel(part.values)
    return Reading(
        {"peak": float(counts.max()), "mean": float(counts.mean())},
        counts,
        settings={
            "exposure": part.value("exposure", "ms", 1.0), "gain": gain, "pixel_size": sensor.pitch,
            "full_scale": sensor.full_scale, "black_level": sensor.black, "read_noise": sensor.read_noise,
            "electrons_per_count": sensor.electrons_per_count(gain),
        },
        saturated=saturated(counts, sensor.full_scale),
    )  # fmt: skip
