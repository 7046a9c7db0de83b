"""Where the beams of a state end, which should not be the table's edge or a housing, and which parts on the way are not
made for their wavelength."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from pico.diagnostics import Diagnostic, warning
from pico.model.materials.ranges import band, outside, unfit, unfit_band, wavelength_of
from pico.model.pose import Pose, short
from pico.model.setup import Setup
from pico.model.state import LabState, place_of
from pico.optics.axis import Axis, Meeting, Values, beams

SHUTS = ("emission", "shutter", "blades")
"""Tunables of sources, shutters and choppers that let no light out if they are off or closed."""


def closures(values: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    """Yield the tunables of a source or a shutter that let no light out, each with its value: `shutter`, `closed`."""
    for tunable in SHUTS:
        if (value := values.get(tunable)) is False or value == "closed":
            yield tunable, value


def stray_beams(setup: Setup, state: LabState, but: Collection[str] = ()) -> tuple[Diagnostic, ...]:
    """Return a warning for each beam of a laser that the state turns on, where it leaves the table or ends on a part
    that is no block: shutters count as open. `but`: not of these lasers."""
    poses = {name: place_of(setup, state, name)[1] for name in setup.lab.inventory}
    values = {name: part.values for name, part in state.components.items()}
    on = [
        axis
        for axis in beams(setup, poses, values)
        if values.get(axis.source, {}).get("emission") is True and axis.source not in but
    ]
    found = (one for axis in on for one in (*_of_axis(setup, axis), *out_of_range(setup, axis, values)))
    # two arms of an interferometer send back to one place
    return counted((*found, *_out_of_band(setup, poses, on, values)))


def _of_axis(setup: Setup, axis: Axis) -> Iterator[Diagnostic]:
    for end in axis.meetings:
        yield from stray(setup, axis.source, end)
    if axis.endless:
        text = f"the beam of {axis.source} goes round and round, and is not followed beyond {len(axis.legs)} stretches"
        yield warning("endless", text, hint="turn a mirror, or end it in a beam block", address=axis.source)


def counted(found: Iterable[Diagnostic]) -> tuple[Diagnostic, ...]:
    """Return each diagnostic once, with how many beams it is true of."""
    count = Counter(found)
    return tuple(one if n == 1 else replace(one, summary=f"{one.summary} ({n} beams)") for one, n in count.items())


def stray(setup: Setup, laser: str, end: Meeting) -> Iterator[Diagnostic]:
    """Yield a warning where what a beam of a laser meets is no place for it to end."""
    x, y, _ = (short(v) for v in end.at)
    hint = "end it in a beam block or on a detector"
    if end.event == "left":
        yield warning("beam", f"the beam of {laser} leaves the table at ({x}, {y})", hint=hint, address=laser)
    elif end.component == laser:
        if setup.ends_beams(laser):
            return
        text = f"the beam of {laser} comes back to it at ({x}, {y})"
        hint = f"turn what sends it back, or declare that its head takes it: `ends_beams: true` for {laser}"
        yield warning("beam", text, hint=hint, address=laser)
    elif end.event == "blocked" and setup.type_of(end.component).optics.element != "block":
        text = f"the beam of {laser} ends on the housing of {end.component} at ({x}, {y}), beside its aperture"
        yield warning("beam", text, hint=f"move {end.component} into the beam or out of it", address=end.component)


def out_of_range(setup: Setup, axis: Axis, values: Values) -> Iterator[Diagnostic]:
    """Yield a warning for each part that a beam comes to and whose numbers do not hold for it."""
    wavelength = wavelength_of(setup, axis.source, values.get(axis.source, {}))
    if wavelength is not None:
        for name in dict.fromkeys(m.component for m in axis.meetings if m.component not in ("", axis.source)):
            yield from unfit(setup.type_of(name), name, axis.source, wavelength)


def _out_of_band(setup: Setup, poses: Mapping[str, Pose], on: Sequence[Axis], values: Values) -> Iterator[Diagnostic]:
    """Yield a warning for each bandpass filter that passes nothing of the beams which come to it."""
    came: dict[str, dict[str, tuple[float, float]]] = {}
    for axis in on:
        wavelength = wavelength_of(setup, axis.source, values.get(axis.source, {}))
        if wavelength is None:
            continue
        for leg in axis.legs:
            for meeting in leg.met:
                if meeting.component and band(setup.type_of(meeting.component), 1.0) is not None:
                    yaw = math.radians(poses[meeting.component].yaw)
                    x, y = (end - start for end, start in zip(meeting.at[:2], leg.start[:2], strict=True))
                    far = math.dist(meeting.at, leg.start)
                    cosine = (x * math.cos(yaw) + y * math.sin(yaw)) / far if far else 1.0
                    came.setdefault(meeting.component, {})[axis.source] = (wavelength, cosine)
    for name, light in sorted(came.items()):
        yield from unfit_band(setup.type_of(name), name, light)


def doubts(setup: Setup, poses: Mapping[str, Pose], values: Values, detector: str) -> Sequence[str]:
    """Return which parts on the ways of light to a detector, itself included, are not made for it, in words. Sources
    that are known to be off do not count."""
    found: dict[str, None] = {}
    for axis in beams(setup, poses, values):
        wavelength = wavelength_of(setup, axis.source, values.get(axis.source, {}))
        if wavelength is None or values.get(axis.source, {}).get("emission") is False:
            continue
        for way in axis.ways(detector):
            for meeting in way:
                if meeting.component and (why := outside(setup.type_of(meeting.component), wavelength)):
                    found[f"{meeting.component} is {why}"] = None
    return tuple(found)
