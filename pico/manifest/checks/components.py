"""Whether a component type makes sense in itself: names, tunables, tolerances, sizes."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

from pico.diagnostics import Diagnostic, did_you_mean, error, warning
from pico.manifest.checks import elements
from pico.manifest.checks.kernels import check_kernels
from pico.manifest.checks.needs import check_needs
from pico.manifest.checks.parameters import check_parameters
from pico.manifest.checks.spectra import check_lines
from pico.manifest.checks.trims import check_trims
from pico.manifest.text.names import check_names, check_own_name
from pico.manifest.text.places import where, where_key
from pico.manifest.text.tree import Document
from pico.model.body import Body
from pico.model.catalog import ComponentType, Footprint, Tunable
from pico.model.primitive import OWN, faults, known, plugged_in
from pico.model.setpoint import refusal

OBSERVATION_POSITION = 0.02
"""One standard deviation of an observed position [mm], until a calibration gives one."""
OBSERVATION_YAW = 0.02
"""One standard deviation of an observed yaw [deg], until a calibration gives one."""
_RESERVED = ("pose", "slot")
_OVERHANG = 1.0  # mm that a housing may reach beyond its footprint: rounded corners, screws


def check_type(document: Document, kind: ComponentType) -> list[Diagnostic]:
    """Return what is wrong with a component type, each at its place in the document."""
    found = check_own_name(document)
    found += [d for part in ("parameters", "tunables", "measurables") for d in check_names(document, part)]
    for name, tunable in kind.tunables.items():
        found += _tunable(document, name, tunable)
        found += _request(document, kind, name)
    if kind.pose.mover == "arm" and kind.seating != "bolted" and kind.geometry.grasp:
        found += _tolerances(document, kind)
    found += _sizes(document, kind)
    found += _primitives(document, kind)
    found += _element(document, kind.optics.element)
    found += check_kernels(document, kind)
    found += check_needs(document, kind)
    found += check_parameters(document, kind)
    found += check_lines(document, kind)
    found += check_trims(document, kind)
    return found


def _element(document: Document, name: str) -> Iterator[Diagnostic]:
    if name not in (names := elements.known()):
        hint = did_you_mean(name[:40], names) or f"known: {', '.join(names)}; plug-ins bring more"
        text = f"there is no optical element `{name[:40]}`"
        yield error("unknown-element", text, hint=hint, source=where(document, "optics", "element"))


def _primitives(document: Document, kind: ComponentType) -> Iterator[Diagnostic]:
    for number, name in enumerate(kind.primitives):
        if name in OWN or name in plugged_in():
            continue
        if name in (wrong := faults()):  # what does not need it goes on; who asks for it is refused
            yield replace(wrong[name], severity="warning")
        else:
            hint = did_you_mean(name[:40], known()) or f"known: {', '.join(known())}; plug-ins bring more"
            at = where(document, "primitives", number)
            yield error("unknown-primitive", f"there is no primitive `{name[:40]}`", hint=hint, source=at)
    settable = [name for name, tunable in kind.tunables.items() if tunable.mover in ("motor", "electronics")]
    if settable and "set" not in kind.primitives:
        text = f"`{settable[0]}` of {kind.name} can be set, and its `primitives` do not say so: `pico set` refuses it"
        hint = f"expected `primitives: [{', '.join([*kind.primitives, 'set'])}]`"
        yield warning("unset", text, hint=hint, source=where_key(document, "primitives"))


def _tunable(document: Document, name: str, tunable: Tunable) -> Iterator[Diagnostic]:
    at = where_key(document, "tunables", name)
    if name in _RESERVED:
        hint = "the pose is declared under `pose:`; give this tunable another name"
        yield error("name", f"a tunable can't be called `{name}`", hint=hint, source=at)
    if tunable.datatype == "choice" and len(tunable.choices) < 2:
        hint = "expected `choices:` a list of two words or more"
        yield error("value", f"tunable `{name}` is a choice without choices", hint=hint, source=at)
    if tunable.range is not None and tunable.range[0] >= tunable.range[1]:
        hint = "expected [least, greatest]"
        source = where(document, "tunables", name, "range")
        yield error("value", f"the range of `{name}` is empty", hint=hint, source=source)
    why = "" if tunable.initial is None else refusal(tunable, tunable.initial)
    if why:
        source = where(document, "tunables", name, "initial")
        hint = "the value after power-up, as a state would give it"
        yield error("value", f"tunable `{name}` {why}", hint=hint, source=source)
    for key, value in (
        ("tolerance", tunable.tolerance),
        ("resolution", tunable.resolution),
        ("period", tunable.period),
    ):
        if value is not None and (value < 0 or (key == "period" and value == 0)):
            source = where(document, "tunables", name, key)
            yield error("value", f"the {key} of `{name}` is {value:g}", hint="expected above zero", source=source)


def _request(document: Document, kind: ComponentType, name: str) -> Iterator[Diagnostic]:
    if kind.tunables[name].restore.kind == "request" and kind.optics.element not in ("source", "shutter"):
        text = f"`{name}` can't be a request: only what lets light out is, of a source or a shutter"
        hint = "expected `restore: {kind: setpoint}`, `align` or `none`"
        yield error("restore", text, hint=hint, source=where(document, "tunables", name, "restore"))


def _tolerances(document: Document, kind: ComponentType) -> Iterator[Diagnostic]:
    tolerance, repeats = kind.pose.tolerance, kind.repeatability
    pairs = (
        ("position", tolerance.position, repeats.position, OBSERVATION_POSITION, "mm"),
        ("yaw", tolerance.yaw, repeats.yaw, OBSERVATION_YAW, "deg"),
    )
    for key, allowed, placement, observation, unit in pairs:
        least = 2 * math.hypot(placement, observation)
        if allowed < least:
            yield error(
                "tolerance",
                f"a {key} tolerance of {allowed:g} {unit} is finer than {kind.name} can be placed",
                detail=f"placed to {placement:g} {unit}, seen to {observation:g} {unit}, one standard deviation each",
                hint=f"expected {math.ceil(least * 1000) / 1000:g} {unit} or more, or a better seating",
                source=where(document, "pose", "tolerance", key),
            )


def _sizes(document: Document, kind: ComponentType) -> Iterator[Diagnostic]:
    geometry = kind.geometry
    for key, value in (("height", geometry.height), ("mass", geometry.mass)):
        if value <= 0:
            hint = "expected a number above zero"
            yield error(
                "value", f"the {key} of {kind.name} is {value:g}", hint=hint, source=where(document, "geometry", key)
            )
    if geometry.grasp and not 0 < geometry.grasp.height <= geometry.height:
        hint = f"expected above 0 and at most the height of the component, {geometry.height:g} mm"
        source = where(document, "geometry", "grasp", "height")
        yield error(
            "value", f"{kind.name} is grasped at {geometry.grasp.height:g} mm, where it isn't", hint=hint, source=source
        )
    if geometry.grasp and not geometry.grasp.yaws:
        hint = "expected a list of angles in deg, such as [0, 90]"
        source = where(document, "geometry", "grasp", "yaws")
        yield error("value", f"{kind.name} has a grasp without yaws", hint=hint, source=source)
    for i, body in enumerate(geometry.bodies):
        beyond = _beyond(geometry.footprint, body)
        if beyond > _OVERHANG:
            source = where(document, "geometry", "bodies", i, "name")
            hint = "make the footprint larger: collisions are judged by it"
            yield error(
                "footprint", f"`{body.name}` reaches {beyond:.3g} mm beyond the footprint", hint=hint, source=source
            )


def _beyond(footprint: Footprint, body: Body) -> float:
    """How far a body reaches out of the footprint [mm]; a cylinder counts as a box unless it stands upright."""
    if body.shape == "cylinder" and body.axis == "z":
        return max(_outside(footprint, body.at[0], body.at[1]) + body.size[0] / 2, -math.inf)
    if body.shape == "box":
        length, breadth = body.size[0], body.size[1]
    else:
        length, breadth = (body.size[1], body.size[0]) if body.axis == "x" else (body.size[0], body.size[1])
    c, s = math.cos(math.radians(body.yaw)), math.sin(math.radians(body.yaw))
    corners = [(i * length / 2, j * breadth / 2) for i in (-1, 1) for j in (-1, 1)]
    return max(_outside(footprint, body.at[0] + c * x - s * y, body.at[1] + s * x + c * y) for x, y in corners)


def _outside(footprint: Footprint, x: float, y: float) -> float:
    """How far (x, y) lies outside of the nearest edge that it is beyond [mm]; negative inside."""
    if footprint.disc is not None:
        return math.hypot(x, y) - footprint.disc
    corners = footprint.vertices
    worst = -math.inf
    for (ax, ay), (bx, by) in zip(corners, corners[1:] + corners[:1], strict=True):
        edge = math.hypot(bx - ax, by - ay)
        worst = max(worst, ((x - ax) * (by - ay) - (y - ay) * (bx - ax)) / edge)
    return worst
