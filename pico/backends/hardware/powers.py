"""What a power meter's readout means for the lab: in its unit, with the wavelength of the light judged."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

from pico.backends.measured import Reading
from pico.drivers.judging import same_wavelength
from pico.model.calibration.results import DarkLevel
from pico.model.catalog import Tunable
from pico.model.instruments.conversion import Conversion
from pico.model.instruments.readout import Readout, unknown
from pico.model.materials.response import blind, ratio
from pico.model.pose import Pose
from pico.model.quantities import Value
from pico.model.setup import Setup
from pico.optics.axis import beams


@dataclass(frozen=True)
class Color:
    """The wavelength [nm] of the light at a meter; None if it is unknown, for the reason `why`."""

    wavelength: float | None = None
    why: str = ""


Values = Mapping[str, Mapping[str, Value]]


def color_at(setup: Setup, values: Values, poses: Mapping[str, Pose], component: str) -> Color:
    """Return the wavelength of the light that reaches a component.

    `values`: the tunables that are known, by component. `poses`: where parts were seen last. The sources that reach it
    count, those known to be off left out; if none is known to reach it, all sources of the lab count, which is enough
    if they have one wavelength.
    """
    names = [name for name in sorted(setup.lab.inventory) if _may_emit(setup, values, name)]
    sources = {name: _wavelength(setup, values, name) for name in names}
    known = {name: pose for name, pose in poses.items() if name in setup.lab.inventory}
    if component in known:
        here = {axis.source for axis in beams(setup, known, values) if axis.reaches(component)}
        sources = {name: of for name, of in sources.items() if name in here} or sources
    if not sources:
        return Color(why=f"no source that may emit is known to reach {component}")
    if None in sources.values():
        name = next(name for name, of in sources.items() if of is None)
        return Color(why=f"{name} has no single wavelength")
    found = sorted({of for of in sources.values() if of is not None})
    if found[-1] - found[0] > 1e-3:
        said = ", ".join(f"{name} {of:g} nm" for name, of in sources.items())
        return Color(why=f"light of several wavelengths may reach it ({said})")
    return Color(found[0])


def _may_emit(setup: Setup, values: Values, name: str) -> bool:
    if setup.type_of(name).optics.element != "source":
        return False
    return values.get(name, {}).get("emission") is not False


def _wavelength(setup: Setup, values: Values, name: str) -> float | None:
    said = values.get(name, {}).get("wavelength")
    if isinstance(said, int | float) and not isinstance(said, bool):
        return float(said)
    return setup.type_of(name).number("wavelength", "nm")


def power_reading(
    readout: Readout, color: Color, conversion: Conversion, responds: Tunable | None = None, sensor: str = ""
) -> Reading:
    """Return what a meter's readout is in the lab's unit. `responds`: the tunable of the meter's type that tells for
    which wavelengths it is calibrated; `sensor`: the material of its detector."""
    found, doubt = corrected(readout, color, responds, sensor)
    reading = read_as(found, conversion)
    return reading if reading.unknown else replace(reading, saturated="", conditions={"wavelength": doubt})


def without_dark(reading: Reading, dark: DarkLevel) -> Reading:
    """Return a reading of a meter less what it reads without light, with the uncertainty of both."""
    if not isinstance(reading.value, int | float) or isinstance(reading.value, bool):
        return reading
    sigma = math.hypot(reading.sigma, dark.sigma) if isinstance(reading.sigma, int | float) else reading.sigma
    return replace(reading, value=reading.value - dark.level, sigma=sigma)


def read_as(readout: Readout, conversion: Conversion) -> Reading:
    """Return what a readout is in the lab's unit, with its sigma; a name or a truth value as it is."""
    if readout.unknown is not None:
        return Reading(None, unknown=readout.why, reason=readout.unknown)
    if isinstance(readout.value, str | bool) or readout.value is None:
        return Reading(readout.value)
    sigma = None if readout.sigma is None else conversion.spread(readout.sigma)
    return Reading(conversion.to_lab(float(readout.value)), sigma=sigma)


def corrected(readout: Readout, color: Color, responds: Tunable | None, sensor: str = "") -> tuple[Readout, str]:
    """Return a readout, unknown if its detector is blind or its error by the wavelength can't be bounded; and what is
    not assured of the wavelength, with the factor, '' if the meter reads back the wavelength of the light."""
    at = readout.settings.get("wavelength")
    if readout.unknown is not None:
        return readout, ""
    if color.wavelength is None:
        return readout, f"the wavelength of the light is unknown: {color.why}"
    if sensor and blind(sensor, color.wavelength):
        why = f"the detector is blind to the light: {sensor} sees nothing at {color.wavelength:g} nm"
        return _unknown(readout, why), ""
    if not isinstance(at, int | float) or isinstance(at, bool):
        return readout, f"the meter can't be set to the {color.wavelength:g} nm of the light"
    return _elsewhere(readout, float(at), color.wavelength, responds, sensor)


def _elsewhere(
    readout: Readout, at: float, wavelength: float, responds: Tunable | None, sensor: str
) -> tuple[Readout, str]:
    """The same of a meter that is set `at` one wavelength, in light of another [nm]."""
    if same_wavelength(at, wavelength):
        return readout, ""
    said = f"the meter reads back {at:g} nm, and the light has {wavelength:g} nm"
    spans = responds.range if responds is not None else None
    if spans is None or not all(spans[0] <= one <= spans[1] for one in (at, wavelength)):
        return _unknown(readout, said), ""
    by, head = ratio(sensor, wavelength, at), f"a head of {sensor}" if sensor else "equal quantum efficiency"
    return (readout, f"{said}: multiply by about {1 / by:.3g}, for {head}") if by else (_unknown(readout, said), "")


def _unknown(readout: Readout, why: str) -> Readout:
    return replace(unknown(readout.unit, "wavelength", readout.raw, why), settings=readout.settings)
