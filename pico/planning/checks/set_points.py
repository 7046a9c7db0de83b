"""Set-points through the map of their device, before anything moves: each must have an equivalent within its limits."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

from pico.diagnostics import Diagnostic, PicoError, error
from pico.manifest.checks.devices import declaration
from pico.manifest.load import Manifests
from pico.manifest.text.places import find, where
from pico.model.calibration.results import AxisZero
from pico.model.instruments.conversion import Conversion
from pico.model.instruments.conversions import conversion_of
from pico.model.instruments.mapping import mapped
from pico.model.operation import Operation
from pico.model.quantities import Value
from pico.model.setup import Setup
from pico.planning.checks.target import Source, no_source

SET_POINT = "set-point"
_NONE: Mapping[str, AxisZero] = MappingProxyType({})


@dataclass(frozen=True)
class Axis:
    """A tunable that a device sets: the device's name in the wiring, and what becomes of a number on the way there."""

    address: str
    device: str
    property: str
    conversion: Conversion


def axes_of(setup: Setup, calibrated: Mapping[str, AxisZero] = _NONE) -> dict[str, Axis]:
    """Return by address the tunables that the wired devices set and whose limits are known; those of drivers that are
    not installed are left out. `calibrated`: direction and zero of axes, by address, as what is sent has them."""
    found: dict[str, Axis] = {}
    for device, entry in setup.wiring.devices.items() if setup.wiring else ():
        component, about = entry.of or device, declaration(entry.driver)[0]
        if about is None or component not in setup.lab.inventory:
            continue
        tunables = setup.type_of(component).tunables
        try:
            for name, wired in mapped(setup, about, entry, component).items():
                if name in tunables:
                    made = conversion_of(setup, about, entry, component, name, wired, calibrated)
                    if made.limits is not None:
                        found[f"{component}.{name}"] = Axis(f"{component}.{name}", device, wired.property, made)
        except (PicoError, KeyError, ValueError):
            continue  # what is wrong with the entry is told of its file
    return found


def check_set_points(read: Manifests, calibrated: Mapping[str, AxisZero] = _NONE) -> Iterator[Diagnostic]:
    """Yield an error for each value of the state that its device can't be told, and for each axis whose device reaches
    nothing of its range; `calibrated` as in `axes_of`."""
    setup, state = read.require()
    for address, axis in sorted(axes_of(setup, calibrated).items()):
        component, _, tunable = address.partition(".")
        span = setup.type_of(component).tunables[tunable].range
        if span is not None and not _reaches_any(axis, span):
            yield _beyond_all(read, axis, span)
        elif component in state.components:
            value = state.components[component].values.get(tunable)
            if value is not None and (wrong := _refusal(axis, value, read.source)):
                yield wrong


def refused(
    setup: Setup, operations: Sequence[Operation], source: Source = no_source,
    calibrated: Mapping[str, AxisZero] = _NONE,
) -> Iterator[Diagnostic]:  # fmt: skip
    """Yield an error for each set-point of a plan that its device can't be told; `calibrated` as in `axes_of`."""
    axes = axes_of(setup, calibrated) if any(op.primitive == "set" for op in operations) else {}
    for op in operations:
        axis = axes.get(f"{op.component}.{op.arguments.get('tunable')}") if op.primitive == "set" else None
        if axis is not None and (wrong := _refusal(axis, op.arguments["to"], source)):
            yield wrong


def _refusal(axis: Axis, value: Value, source: Source) -> Diagnostic | None:
    made = axis.conversion
    if isinstance(value, bool | str) or made.limits is None or made.reaches(float(value)):
        return None
    low, high = made.limits
    told = made.wired.to_device(float(value), made.unit)
    turn = ", and no whole turn of it lies within" if made.period or made.own in ("deg", "rad") else ""
    return error(
        SET_POINT,
        f"{axis.device} can't set {axis.address} to {value:g} {made.unit}: that is {axis.property} {told:g} "
        f"{made.own}, and its limits are {low:g} to {high:g} {made.own}{turn}",
        hint=f"another value; or correct `scale`, `offset` or `limits` of {axis.device} in the devices file",
        source=source(axis.address), address=axis.address,
    )  # fmt: skip


def _reaches_any(axis: Axis, span: tuple[float, float]) -> bool:
    """Return whether the device reaches any number of a range: as a map is monotonic, an end of the range lies within
    the limits, or an end of the limits within the range; of an angle by whole turns."""
    made, (low, high) = axis.conversion, span
    assert made.limits is not None
    return made.reaches(low) or made.reaches(high) or any(low <= made.to_lab(end) <= high for end in made.limits)


def _beyond_all(read: Manifests, axis: Axis, span: tuple[float, float]) -> Diagnostic:
    made = axis.conversion
    assert made.limits is not None
    first, last = sorted(made.wired.to_device(end, made.unit) for end in span)
    name = axis.address.partition(".")[2]
    at = None
    for document in read.documents.get("Devices", ()):
        if find(document, "devices", axis.device):
            named = find(document, "devices", axis.device, "map", name) is not None
            at = where(document, "devices", axis.device, *(("map", name) if named else ()))
    return error(
        SET_POINT,
        f"{axis.device} reaches no value of {axis.address}: {span[0]:g} to {span[1]:g} {made.unit} is {axis.property} "
        f"{first:g} to {last:g} {made.own}, and its limits are {made.limits[0]:g} to {made.limits[1]:g} {made.own}",
        hint=f"correct `scale`, `offset` or `unit` of its map, or the limits of {axis.device}", source=at,
        address=axis.address,
    )  # fmt: skip
