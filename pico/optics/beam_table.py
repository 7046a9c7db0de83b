"""The path of each beam as a table, and what is wrong with it: missed, clipped, sent back, too strong to be seen."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from pico.diagnostics import Diagnostic, warning
from pico.model.materials.glass import DESIGN
from pico.model.materials.ranges import unfit, unfit_band
from pico.model.materials.response import BLIND, quantum_efficiency
from pico.model.observation import slot_at
from pico.model.pose import short
from pico.model.setup import Setup
from pico.optics.axis import Meeting
from pico.optics.beam import Beam, moments
from pico.optics.ends import closures, counted, stray
from pico.optics.following import Crossing
from pico.optics.gaussian import front
from pico.optics.geometry import Event
from pico.optics.light import Light, irradiance, out_of_step
from pico.optics.part import Part

CLIPPED = 0.01
"""The share of a beam that an edge may stop before anybody is told."""
_SIDES = ("pixels_across", "pixels_up")
_NEARBY = 100.0  # mm: a beam that passes further off has nothing to do with a detector
_FLAT = 1e-7  # 1/mm: a wavefront flatter than this is called flat


@dataclass(frozen=True)
class BeamRow:
    """A beam where it comes to a component.

    `number`: of this row, `before`: of the one that it comes from. `length`: geometrical, from the source [mm].
    `radii`: 1/e^2, the larger first [mm], with the direction `axis` of that [deg]; `front`: of the wavefront [mm],
    above 0 where it diverges, None where it is flat. `power` before and `onward` after it [mW]; `clipped`: the share
    that its edge stops. `angle` of the polarization from level, counter-clockwise looking into the beam [deg], its
    `ellipticity` S3/S0 (+1 turns counter-clockwise looking into the beam) and `degree`. `offset`: of the beam from the
    middle of the component, to the left of and above it [mm]; `incidence` on its plane [deg]. `unknown`: why its spot
    is not known. `sigma`: one standard deviation of both radii and of the power by what was measured of parts,
    None where nobody says.
    """

    source: str
    number: int
    before: int | None
    component: str
    element: str
    event: Event
    at: tuple[float, float, float]
    length: float
    radii: tuple[float, float]
    axis: float
    front: tuple[float | None, float | None]
    power: float
    onward: float
    clipped: float
    angle: float
    ellipticity: float
    degree: float
    offset: tuple[float, float]
    incidence: float
    unknown: str
    ghost: bool
    sigma: tuple[float, float, float] | None = None


def rows(light: Light, sigmas: Mapping[int, tuple[float, float, float]] | None = None) -> tuple[BeamRow, ...]:
    """Return a row for each place that a beam comes to; `sigmas`: of `pico.optics.nominal.specimens`, by its number."""
    known = sigmas or {}
    found = (_row(light, number, crossing) for number, crossing in enumerate(light.crossings))
    return tuple(replace(row, sigma=known[row.number]) if row.number in known else row for row in found)


def _row(light: Light, number: int, crossing: Crossing) -> BeamRow:
    beam, part = crossing.beam, light.parts.get(crossing.component)
    wide, narrow, axis = beam.widths
    s0, s1, s2, s3 = beam.stokes
    x, y, z = beam.at.tolist()
    one, two = (None if abs(c) < _FLAT else 1 / c for c in front(beam.curvature))
    return BeamRow(
        source=beam.source, number=number, before=crossing.before, component=crossing.component,
        element=part.kind.optics.element if part else "", event=crossing.event, at=(x, y, z), length=beam.length,
        radii=(wide, narrow), axis=math.degrees(axis), front=(one, two), power=crossing.power, onward=crossing.onward,
        clipped=crossing.clipped, angle=math.degrees(0.5 * math.atan2(s2, s1)), ellipticity=s3 / s0 if s0 else 0.0,
        degree=math.sqrt(s1**2 + s2**2 + s3**2) / s0 if s0 else 0.0, offset=_offset(beam, part),
        incidence=_incidence(beam, part), unknown=beam.unknown, ghost=beam.ghost,
    )  # fmt: skip


def _offset(beam: Beam, part: Part | None) -> tuple[float, float]:
    if part is None:
        return 0.0, 0.0
    middle = part.origin if part.kind.optics.element == "detector" else part.center
    left, up = beam.frame @ (beam.at - middle) + moments(beam)[1]
    return float(left), float(up)


def _incidence(beam: Beam, part: Part | None) -> float:
    if part is None or part.optic.center is None:
        return 0.0
    return math.degrees(math.acos(min(1.0, abs(float(beam.along @ np.array(part.optic.normal))))))


def troubles(setup: Setup, light: Light) -> tuple[Diagnostic, ...]:
    """Return a warning for each thing that is wrong with the light; how often, if several beams do the same."""
    return counted(_troubles(setup, light))


def _troubles(setup: Setup, light: Light) -> Iterator[Diagnostic]:
    for crossing in light.crossings:
        name, beam = crossing.component, crossing.beam
        x, y, z = beam.at.tolist()
        if not beam.ghost and not _is_closed(light.parts.get(name)):
            yield from stray(setup, beam.source, Meeting(name, crossing.event, (x, y, z), beam.length))
        if crossing.clipped > CLIPPED and crossing.event != "blocked":
            left, up = _offset(beam, light.parts[name])
            text = f"{name} stops {_two(100 * crossing.clipped)} % of the beam of {beam.source}, of radius"
            text, opening = f"{text} {beam.widths[0]:.3g} mm", light.parts[name].values.get("opening")
            if math.hypot(left, up) > 0.05:
                text = f"{text}, which comes {_beside(left, up)} its middle"
            hint = "move it into the beam, or take a wider one"
            if opening is not None:
                text = f"{text}: it is open by {short(float(opening))} mm"
                hint = f"open it: `pico set {name} opening=...`"
            yield warning("clipped", text, hint=hint, address=name)
    for name in sorted({c.component for c in light.crossings if c.event == "detected"}):
        yield from _too_strong(light, light.parts[name])
        if why := out_of_step(light.at(name)):
            text, hint = f"nobody can say how beams interfere on {name}", "put as much glass into each arm"
            yield warning("unknown-light", f"{text}: {why}", hint=hint, address=name)
    lit = {c.component for c in light.crossings if c.event == "detected"}
    for name, part in sorted(light.parts.items()):
        if part.kind.optics.element == "detector" and name not in lit and light.crossings and _stands(setup, part):
            text, near = f"no light comes to {name}", _passing(light, part)
            hint = "move it into a beam, or a beam onto it"
            yield warning("dark", f"{text}: {near}" if near else text, hint=hint, address=name)
    yield from _unfit(light)
    for source, reached in light.cut.items():
        count = sum(c.beam.source == source for c in light.crossings)
        detectors = sorted(n for n in reached if light.parts[n].kind.optics.element == "detector")
        text = f"the beam of {source} goes round and round, and is not followed beyond {count} stretches"
        text += f": what {', '.join(detectors)} would read is unknown" if detectors else ""
        yield warning("endless", text, hint="turn a mirror, or end it in a beam block", address=source)


def _is_closed(part: Part | None) -> bool:
    """Whether a beam ends on a shutter or chopper as it is to: one that is closed."""
    return part is not None and part.optic.element == "shutter" and any(closures(part.values))


def _unfit(light: Light) -> Iterator[Diagnostic]:
    """Yield a warning for each part that is not made for the light which comes to it."""
    came: dict[str, dict[str, tuple[float, float]]] = {}
    for c in light.crossings:
        if c.component and not c.beam.ghost and c.component != c.beam.source:
            cosine = float(c.beam.along @ light.parts[c.component].axes[0])
            came.setdefault(c.component, {})[c.beam.source] = (c.beam.wavelength * 1e6, cosine)
    for name, coming in came.items():
        for source, (wavelength, _) in coming.items():
            yield from unfit(light.parts[name].kind, name, source, wavelength)
        yield from unfit_band(light.parts[name].kind, name, coming)


def _passing(light: Light, part: Part) -> str:
    """Return how the nearest beam passes a detector, in words; empty where none crosses its plane nearby."""
    normal, left, up = part.axes
    found: list[tuple[float, str]] = []
    for crossing in light.crossings:
        if crossing.beam.ghost:
            continue
        source = light.parts[crossing.beam.source].origin
        start = source if crossing.before is None else light.crossings[crossing.before].beam.at
        end = crossing.beam.at
        first, last = (float((at - part.center) @ normal) for at in (start, end))
        if first * last < 0:
            passes = start + (end - start) * first / (first - last) - part.center
            aside = float(passes @ left), float(passes @ up)
            away = math.hypot(*aside)
            found.append((away, f"the beam of {crossing.beam.source} passes {_beside(*aside)} its aperture"))
    nearest = min(found, default=(math.inf, ""))
    return nearest[1] if nearest[0] < _NEARBY else ""


def _stands(setup: Setup, part: Part) -> bool:
    """Whether a part stands on the table, and not in a slot, where it is put away."""
    wide, deep = setup.lab.table.size
    if slot_at(setup, part.pose):
        return False
    return 0 <= part.pose.x <= wide and 0 <= part.pose.y <= deep


def _beside(left: float, up: float) -> str:
    """Return `40 mm above`, `12 mm to the left of`, or both."""
    across = f"{short(abs(left))} mm to the {'left' if left > 0 else 'right'} of"
    high = f"{short(abs(up))} mm {'above' if up > 0 else 'below'}"
    return " and ".join(text for text, size in ((across, left), (high, up)) if abs(size) > 0.05) or "through"


def _too_strong(light: Light, part: Part) -> Iterator[Diagnostic]:
    found = exposed(light, part)
    if found and found.times == 0 and (arrivals := light.at(part.name)):
        text = f"the beam of {arrivals[0].beam.source} comes {_beside(*arrivals[0].center)} the sensor of {part.name}"
        yield warning("dark", f"{text}, and misses it", hint="move it into the beam", address=part.name)
    elif found and (past := _past_the_sensor(light.at(part.name), part)):
        yield warning("dark", past, hint="move it into the beam", address=part.name)
    if found and found.times > 1:
        text = f"{part.name} is saturated {_two(found.times)} times over{found.at}"
        yield warning("saturated", text, hint=found.hint, address=part.name)


def _past_the_sensor(arrivals: tuple[Any, ...], part: Part) -> str:
    """Return that the middle of the strongest beam falls beside the sensor of a camera, though some of it is seen."""
    half = [part.number(n, "pixel", math.inf) * part.number("pixel_size", "um", 1.0) * 5e-4 for n in _SIDES]
    main = max(arrivals, key=lambda a: a.power, default=None)
    if main is None or all(abs(at) <= end for at, end in zip(main.center, half, strict=True)):
        return ""
    text = f"the middle of the beam of {main.beam.source} comes {_beside(*main.center)} that of {part.name}"
    return f"{text}, beside its sensor of {2 * half[0]:.3g} x {2 * half[1]:.3g} mm"


@dataclass(frozen=True)
class Exposed:
    """How strong the light on a detector is, in `times` of what it can tell; at which setting; what would be right."""

    times: float
    at: str
    hint: str


def exposed(light: Light, part: Part) -> Exposed | None:
    """Return how strong the light on a detector is; None where its type does not say what it can tell.

    A camera's brightest pixel against its full well, a meter's power against `greatest_power`, a photodiode's voltage
    against `saturation` [V].
    """
    arrivals = light.at(part.name)
    power = sum(a.power for a in arrivals)
    if (well := part.kind.number("full_well", "")) is not None:
        exposure = part.value("exposure", "ms", 1.0)
        times = _brightest(arrivals, part) * (part.number("pixel_size", "um", 1.0) * 1e-3) ** 2 * exposure
        wavelength = arrivals[0].wavelength
        times *= electrons(wavelength, efficiency(part, wavelength)) / well
        least = (part.kind.tunables["exposure"].range or (0.0, 0.0))[0] if "exposure" in part.kind.tunables else 0.0
        enough = exposure / times if times else exposure
        hint = f"expose for {_two(enough)} ms, or weaken the beam with a filter"
        if enough < least:
            hint = f"its shortest exposure is {least:g} ms: weaken the beam with a filter"
            hint = f"{hint}, by {_two(least / enough)} or more"
        return Exposed(times, f" at {exposure:g} ms", hint)
    if (greatest := part.kind.number("greatest_power", "mW")) is not None:
        return Exposed(power / greatest, f" by {power:.3g} mW", "weaken the beam with a filter")
    if (volts := part.kind.number("saturation", "V")) is not None:
        gain = 10 ** (decibel(part.values) / 20)
        signal = power * 1e-3 * part.number("responsivity", "A/W", 1.0) * part.number("transimpedance", "V/A", 1.0)
        return Exposed(signal * gain / volts, f" by {power:.3g} mW", "lower its gain, or weaken the beam with a filter")
    return None


def _two(number: float) -> str:
    """Return a number with two digits that count, never as a power of ten."""
    return f"{float(f'{number:.2g}'):.10g}"


def efficiency(part: Part, wavelength: float) -> float:
    """Return how many photo-electrons a detector gives for a photon of a wavelength [nm], its filter included: its
    `quantum_efficiency` is that at `design_wavelength`, from which its material's curve leads."""
    sensor, design = part.word("sensor", ""), part.number("design_wavelength", "nm", DESIGN)
    by = quantum_efficiency(sensor, wavelength) / max(quantum_efficiency(sensor, design), BLIND)
    return min(1.0, part.number("quantum_efficiency", "", 1.0) * by) * 10 ** -part.number("filter_density", "", 0.0)


def electrons(wavelength: float, efficiency: float) -> float:
    """Return the photo-electrons of one mW for one ms, at a wavelength [nm]: efficiency / (h c / wavelength)."""
    planck, light = 6.62607015e-34, 299792458.0
    return efficiency * 1e-6 * wavelength * 1e-9 / (planck * light)


def _brightest(arrivals: tuple[Any, ...], part: Part) -> float:
    """Return the greatest irradiance [mW/mm2] on a camera's sensor, looked for around the brightest beam."""
    bright = max(arrivals, key=lambda a: a.power / (a.beam.widths[0] * a.beam.widths[1]))
    (y, z), reach = bright.center, 2 * bright.beam.widths[0]
    line = np.linspace(-reach, reach, 81)
    half = [part.number(n, "pixel", math.inf) * part.number("pixel_size", "um", 1.0) * 5e-4 for n in _SIDES]
    across, up = (at[np.abs(at) <= end] for at, end in zip((y + line, z + line), half, strict=True))
    return float(irradiance(arrivals, across, up).max()) if len(across) and len(up) else 0.0


def decibel(values: Mapping[str, Any]) -> float:
    word = str(values.get("gain", "0 dB")).split()
    try:
        return float(word[0])
    except (ValueError, IndexError):
        return 0.0
