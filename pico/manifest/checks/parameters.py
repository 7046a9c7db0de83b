"""Whether parameters that light is computed from can be what they say: numbers in a unit, within what is possible."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

from pico.diagnostics import Diagnostic, SourceRange, did_you_mean, error
from pico.manifest.text.places import where
from pico.manifest.text.tree import Document
from pico.model.catalog import ComponentType
from pico.model.materials.glass import GLASSES
from pico.model.materials.response import SENSORS


@dataclass(frozen=True, slots=True)
class Bounds:
    """What a number may be, in a `unit`: from `least` to `most`, these included; not 0 where `zero` is false."""

    unit: str = ""
    least: float = -math.inf
    most: float = math.inf
    zero: bool = True

    def __str__(self) -> str:
        ends = f"from {self.least:g} to {self.most:g}" if self.least > -math.inf and self.most < math.inf else ""
        ends = ends or (f"{self.least:g} or more" if self.least > -math.inf else "other than 0")
        return f"{ends} {self.unit}".strip()


_SHARE, _LENGTH = Bounds("", 0, 1), Bounds("mm", 1e-3, 1e5)
_INDEX = Bounds("", 1e-3, 10)
NUMBERS: Mapping[str, Mapping[str, Bounds]] = {
    "source": {
        "wavelength": Bounds("nm", 10, 1e5), "power": Bounds("mW", 0, 1e9), "waist_radius": Bounds("mm", 1e-4, 1e3),
        "waist_position": Bounds("mm", -1e7, 1e7), "waist_radius_up": Bounds("mm", 1e-4, 1e3),
        "waist_position_up": Bounds("mm", -1e7, 1e7), "quality": Bounds("", 1, 1e4), "polarization": Bounds("deg"),
        "polarization_ratio": Bounds("", 1),
    },
    "lens": {
        "focal_length": Bounds("mm", zero=False), "radius_of_curvature": Bounds("mm", zero=False),
        "radius_of_curvature_back": Bounds("mm", zero=False), "center_thickness": Bounds("mm", 0, 1e3),
        "refractive_index": _INDEX, "transmission": _SHARE, "cylinder_axis": Bounds("deg"),
        "design_wavelength": Bounds("nm", 10, 1e5),
    },
    "mirror": {
        "reflectance": _SHARE, "transmittance": _SHARE, "retardance": Bounds("deg"), "refractive_index": _INDEX,
        "radius_of_curvature": Bounds("mm", zero=False),
        "extinction_coefficient": Bounds("", 0, 100),
    },
    "roof_mirror": {"reflectance": _SHARE},
    "retroreflector": {"reflectance": _SHARE},
    "plate_splitter": {
        "reflectance": _SHARE, "transmittance": _SHARE, "reflectance_below": _SHARE, "transmittance_below": _SHARE,
        "cut_on": Bounds("nm", 10, 1e5), "thickness": Bounds("mm", 0, 1e3), "refractive_index": _INDEX,
        "rear_reflectance": _SHARE,
    },
    "slit": {"width": Bounds("mm", 1e-4, 1e3), "angle": Bounds("deg")},
    "bandpass": {
        "center_wavelength": Bounds("nm", 10, 1e5), "bandwidth": Bounds("nm", 1e-6, 1e5), "transmission": _SHARE,
        "blocking": Bounds("", 0, 20), "effective_index": Bounds("", 1, 10), "thickness": Bounds("mm", 0, 1e3),
        "refractive_index": _INDEX,
    },
    "parabola": {"focal_length": Bounds("mm", 1, 1e5), "fold": Bounds("deg", -170, 170), "reflectance": _SHARE},
    "spatial_filter": {
        "focal_length": Bounds("mm", 0.1, 1e4), "focal_length_out": Bounds("mm", 0.1, 1e4),
        "pinhole": Bounds("um", 0.5, 1e4), "transmission": _SHARE,
    },
    "shutter": {"duty": _SHARE},
    "expander": {"magnification": Bounds("", 0.01, 100), "length": Bounds("mm", 0, 1e4), "transmission": _SHARE},
    "grating": {
        "lines": Bounds("1/mm", 0, 1e4), "efficiency_0": _SHARE, "efficiency_plus_1": _SHARE,
        "efficiency_minus_1": _SHARE,
    },
    "prism": {"edge": _LENGTH, "refractive_index": Bounds("", 1, 10), "transmission": _SHARE},
    "wollaston": {"divergence": Bounds("deg", 0, 60), "extinction": Bounds("", 1), "transmission": _SHARE},
    "isolator": {
        "transmission": _SHARE, "isolation": Bounds("dB", 0, 120), "output": Bounds("deg"),
        "design_wavelength": Bounds("nm", 300, 1e4),
    },
    "polarizer": {
        "extinction": Bounds("", 1), "transmission": _SHARE, "refractive_index": _INDEX,
        "thickness": Bounds("mm", 0, 1e3),
    },
    "waveplate": {
        "transmission": _SHARE, "design_wavelength": Bounds("nm", 10, 1e5), "thickness": Bounds("mm", 0, 1e3),
        "refractive_index": _INDEX,
    },
    "beam_splitter": {
        "reflectance": _SHARE, "transmittance": _SHARE, "extinction": Bounds("", 1), "fold": Bounds("deg"),
        "reflected_extinction": Bounds("", 1),
    },
    "filter": {
        "optical_density": Bounds("", 0, 20), "transmission": _SHARE,
        **{f"density_{n}": Bounds("", 0, 20) for n in range(1, 13)},
    },
    "detector": {
        "pixels_across": Bounds("pixel", 1, 2e4), "pixels_up": Bounds("pixel", 1, 2e4),
        "pixel_size": Bounds("um", 0.1, 1e4),
        "bit_depth": Bounds("bit", 1, 16), "full_well": Bounds("", 1), "read_noise": Bounds("", 0, 1e6),
        "dark_current": Bounds("", 0), "quantum_efficiency": Bounds("", 1e-6, 1), "filter_density": Bounds("", 0, 20),
        "black_level": Bounds("count", 0, 6e4), "responsivity": Bounds("A/W", 1e-6, 100),
        "transimpedance": Bounds("V/A", 1e-3), "saturation": Bounds("V", 1e-9), "least_power": Bounds("mW", 0),
        "greatest_power": Bounds("mW", 1e-12), "uncertainty": _SHARE, "active_diameter": _LENGTH,
        "separation": Bounds("mm", 0.1, 1e3), "rejection": Bounds("dB", 0, 120),
        "mode_radius": Bounds("mm", 1e-3, 100), "transmission": _SHARE, "electrons_per_count": Bounds("", 1e-6, 1e9),
        "resolution": Bounds("nm", 1e-6, 1e3), "design_wavelength": Bounds("nm", 10, 1e5),
        "channels": Bounds("", 2, 1e5), "sensitivity": Bounds("count/nJ", 1e-12),
    },
}  # fmt: skip
"""The numbers of a type that light is computed from, by its element."""
ANYWHERE: Mapping[str, Bounds] = {
    "clear_diameter": _LENGTH, "stray_irradiance": Bounds("nW/mm^2", 0), "face_reflectance": _SHARE,
    "damage_threshold": Bounds("mW/mm^2", 1e-9), "shortest": Bounds("nm", 10, 1e5), "longest": Bounds("nm", 10, 1e5),
}  # fmt: skip
"""Those of a type of any element."""
WORDS: Mapping[tuple[str, str], tuple[str, ...]] = {
    ("polarizer", "substrate"): ("film", "ar_glass", "glass"), ("polarizer", "rejected"): ("absorbed", "reflected"),
    ("lens", "form"): ("plano", "bi"), ("lens", "glass"): tuple(GLASSES), ("detector", "sensor"): SENSORS,
}  # fmt: skip


Places = Callable[[str], SourceRange | None]
"""Where a parameter is said."""


def check_parameters(document: Document, kind: ComponentType) -> Iterator[Diagnostic]:
    """Yield an error for each parameter of a type's element that can't be what it says."""
    yield from wrong_parameters(kind, lambda name: where(document, "parameters", name, "value"))
    aperture = kind.geometry.clear_aperture
    if aperture is not None and aperture.diameter <= 0:
        at = where(document, "geometry", "clear_aperture", "diameter")
        text = f"the clear aperture is {aperture.diameter:g} mm wide, which can't be"
        yield error("value", text, hint="expected above 0 mm", source=at)


def wrong_parameters(kind: ComponentType, at: Places) -> Iterator[Diagnostic]:
    """Yield an error for each parameter that can't be what it says; `at`: where it is said."""
    element = kind.optics.element
    for name, bounds in {**NUMBERS.get(element, {}), **ANYWHERE}.items():
        if name in kind.parameters:
            yield from _number(kind, name, bounds, at)
    for (of, name), words in WORDS.items():
        if of == element and name in kind.parameters and (given := kind.parameters[name].value) not in words:
            hint = did_you_mean(str(given)[:40], words) or f"one of: {', '.join(words)}"
            yield error("value", f"`{name}` is `{str(given)[:40]}`", hint=hint, source=at(name))
    black, bits = kind.number("black_level", "count"), kind.number("bit_depth", "bit")
    if element == "detector" and black and bits and 1 <= bits <= 16 and black >= 2**bits / 2:
        text = f"`black_level` is {black:g}, more than half of what {bits:g} bits hold"
        yield error("value", text, hint=f"expected below {2**bits / 2:g}", source=at("black_level"))
    least, greatest = kind.number("least_power", "mW"), kind.number("greatest_power", "mW")
    if element == "detector" and least and greatest and least >= greatest:
        text = f"`least_power` is {least:g} mW, and `greatest_power` {greatest:g} mW"
        yield error("value", text, hint="expected the least below the greatest", source=at("least_power"))
    if element == "lens" and "form" in kind.parameters:
        yield from _form(kind, at)
    polarizing = kind.parameters.get("polarizing")
    if element == "beam_splitter" and not (polarizing and polarizing.value):
        yield from _together(kind, ("reflectance", "transmittance"), at)
    if element == "grating":
        yield from _together(kind, ("efficiency_plus_1", "efficiency_minus_1", "efficiency_0"), at)
    if element == "plate_splitter":
        yield from _together(kind, ("reflectance", "transmittance"), at)
        yield from _together(kind, ("reflectance_below", "transmittance_below"), at)


def _together(kind: ComponentType, names: tuple[str, ...], at: Places) -> Iterator[Diagnostic]:
    shares = sum(kind.number(name, "") or 0.0 for name in names)
    if shares > 1 + 1e-9:
        text = f"{' and '.join(f'`{n}`' for n in names)} are {shares:g} together: more light leaves than comes"
        yield error("value", text, hint="1 or less together", source=at(names[0]))


def _number(kind: ComponentType, name: str, bounds: Bounds, at: Places) -> Iterator[Diagnostic]:
    value, given = kind.number(name, bounds.unit), kind.parameters[name]
    if value is None:
        text = f"`{name}` is `{str(given.value)[:40]}`" + (f" in {given.unit}" if given.unit else "")
        yield error("value", text, hint=f"expected a number [{bounds.unit or '1'}], {bounds}", source=at(name))
    elif not bounds.least <= value <= bounds.most or (value == 0 and not bounds.zero):
        text = f"`{name}` is {value:g} {bounds.unit}".rstrip()
        yield error("value", f"{text}, which can't be", hint=f"expected {bounds}", source=at(name))


def _form(kind: ComponentType, at: Places) -> Iterator[Diagnostic]:
    """A lens with a form has the radii that its focal length asks for."""
    for name in ("radius_of_curvature", "radius_of_curvature_back"):
        if name in kind.parameters:
            text = f"`{name}` is given, and `form` has it follow from `focal_length`"
            yield error("value", text, hint="leave one of them out", source=at(name))
    focal, thickness = kind.number("focal_length", "mm"), kind.number("center_thickness", "mm")
    index, wide = kind.number("refractive_index", ""), kind.number("clear_diameter", "mm") or 0.0
    if focal and thickness and index and index > 1:
        sides = 1 if kind.parameters["form"].value == "plano" else 2
        least = max(thickness / index, wide / 2 / (sides * (index - 1)))
        if abs(focal) <= least and (focal > 0 or abs(focal) * sides * (index - 1) <= wide / 2):
            text = f"no lens {wide:g} mm wide and {thickness:g} mm thick has a focal length of {focal:g} mm"
            yield error(
                "value", text, hint=f"expected beyond {least:.3g} mm, or a narrower lens", source=at("focal_length")
            )
