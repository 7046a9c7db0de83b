"""How much light is how dangerous: the classes of lasers by power and wavelength.

Accessible emission limits of continuous beams that are looked into for longer than 10 s, from a small source, after
IEC 60825-1 (to be checked against a copy of the standard by whoever owns one):

| class | 400 to 700 nm | 700 to 1050 nm |
|---|---|---|
| 1 | 0.39 mW | 0.39 mW x C4, C4 = 10^(0.002 (wavelength in nm - 700)) |
| 2 | 1 mW | there is none: nobody blinks at what they do not see |
| 3R | 5 mW | five times class 1 |
| 3B | 500 mW | 500 mW |

Pulses, extended sources and other wavelengths are not in it: there no limit is known here, any laser counts as class 4,
and any branch of it as dangerous.
"""

from __future__ import annotations

from pico.model.arming import CLASSES, LaserClass, within

VISIBLE, KNOWN = (400.0, 700.0), (400.0, 1050.0)
"""Wavelengths that an eye turns away from, and those for which a limit is known here [nm]."""
_CLASS_1, _CLASS_2, _VISIBLE_3R, _CLASS_3B = 0.39, 1.0, 5.0, 500.0  # mW
_ROUNDING = 1e-9


def class_1(wavelength: float) -> float | None:
    """Return the limit of class 1 [mW] at a wavelength in vacuum [nm]; None where none is known here."""
    if not KNOWN[0] <= wavelength <= KNOWN[1]:
        return None
    return _CLASS_1 * 10 ** (0.002 * max(0.0, wavelength - VISIBLE[1]))


def class_of(power: float, wavelength: float) -> LaserClass:
    """Return the class of a continuous laser of a power [mW] at a wavelength in vacuum [nm]; 4 where no limit is
    known."""
    first = class_1(wavelength)
    if first is None:
        return "4"
    visible = wavelength <= VISIBLE[1]
    limits = (first, _CLASS_2 if visible else first, _VISIBLE_3R if visible else 5 * first, _CLASS_3B)
    within = (name for name, limit in zip(CLASSES, limits, strict=False) if power <= limit * (1 + _ROUNDING))
    return next(within, "4")


def above_class_2(name: LaserClass) -> bool:
    """Whether a laser of a class harms before anybody can blink."""
    return not within(name, "2")
