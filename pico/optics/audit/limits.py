"""How much light is how dangerous: the classes of lasers by power and wavelength.

Accessible emission limits of continuous beams that are looked into for longer than 10 s (ultraviolet: 30000 s), from a
small source, after tables 3 to 8 of IEC 60825-1:2014. The standard itself was not at hand, see below. If a
photochemical and a thermal limit hold, or sources differ, the lower one counts. w: wavelength [nm].

| w [nm] | class 1 | class 3R | class 3B |
|---|---|---|---|
| 180 to 302.5 | 0.79 nW (30 J/m2 through 1 mm in 30000 s) | none | 1.5 mW |
| 302.5 to 315 | 0.026 nW x C2, C2 = 10^(0.2 (w - 295)), 7.9 uW at most | 5 x class 1 | 50 uW x C2, 500 mW at most |
| 315 to 400 | 7.9 uW | 5 x class 1 | 500 mW |
| 400 to 500 | 0.039 mW x C3, C3 = 10^(0.02 (w - 450)), 1 or more; 0.39 mW at most | 5 mW | 500 mW |
| 500 to 700 | 0.39 mW | 5 mW | 500 mW |
| 700 to 1050 | 0.39 mW x C4, C4 = 10^(0.002 (w - 700)) | 5 x class 1 | 500 mW |
| 1050 to 1400 | 1.95 mW x C7; C7 = 1 to 1150, 10^(0.018 (w - 1150)) to 1200, then 8 | 5 x class 1 | 500 mW |
| 1400 to 10600 | 10 mW; beyond 4000 9.6 mW (1000 W/m2 through 3.5 mm) | 5 x class 1 | 500 mW |

Sources that the numbers were compared with:
- A public transcription of tables 3 and 9 of IEC 60825-1:2014 (`IEC_AEL_TABLES` of a laser safety calculator): all of
  class 1 and the coefficients. Two of its numbers differ: C7 from 1200 nm on is 8 + 10^(0.04 (w - 1250)), which is
  higher, so 8 counts; and C7 below is 10^(0.0018 (w - 1150)), which leaves a step at 1200 nm and is taken for a
  misprint.
- Directive 2006/25/EC, annex II, as the French labor code has it (annexe II, tables 2.4 and 2.5): its coefficients
  CA, CB and CC are C4, C3 and C7, with 0.018 in the exponent and 8 from 1200 to 1400 nm.
- Pages on EN 60825-1:2014 (online.flipbuilder.com/rbhw/egvu, 105 and 107; manualshive.com, LPS simplex, 8): 0.039 mW
  as the lowest of class 1 in visible light, 1, 5 and 500 mW for classes 2, 3R and 3B, five times class 1 for 3R of
  invisible light, and class 3R from 302.5 nm on only. Editions with a limit of 3R below that give a higher one, so
  none counts.
- 500 mW for class 3B from 315 to 400 nm fits the 0.125 J in 0.25 s of the transcription. For 1.5 mW and 50 uW x C2
  below no source was found: they are to be checked against a copy of the standard.

Class 2, from 400 to 700 nm alone, ends at 1 mW: nobody blinks at what they do not see. Pulses, extended sources and
other wavelengths are not in it: there no limit is known here, any laser counts as class 4, and any branch of it as
dangerous.
"""

from __future__ import annotations

from pico.model.arming import CLASSES, LaserClass, within

VISIBLE, KNOWN = (400.0, 700.0), (180.0, 10600.0)
"""Wavelengths that an eye turns away from, and those for which a limit is known here [nm]."""
EDGES = (302.5, 315.0, 400.0, 450.0, 500.0, 700.0, 1050.0, 1150.0, 1200.0, 1400.0, 4000.0)
"""Wavelengths at which the limits change their law: of a range the most dangerous one is one of these, or an end."""
_CLASS_1, _CLASS_2, _VISIBLE_3R, _CLASS_3B = 0.39, 1.0, 5.0, 500.0  # mW
_ULTRAVIOLET = 30 * 7.85e-7 / 3e4 * 1e3
"""30 J/m2 through an aperture of 1 mm in 30000 s [mW]."""
_NEAR_ULTRAVIOLET = 7.9e-3  # mW
_ROUNDING = 1e-9


def class_1(wavelength: float) -> float | None:
    """Return the limit of class 1 [mW] at a wavelength in vacuum [nm]; None where none is known here."""
    if not KNOWN[0] <= wavelength <= KNOWN[1]:
        return None
    if wavelength < VISIBLE[0]:
        return _in_ultraviolet(wavelength)
    if wavelength < 500.0:
        return min(_CLASS_1, 0.1 * _CLASS_1 * 10 ** (0.02 * max(0.0, wavelength - 450.0)))
    if wavelength <= 1050.0:
        return _CLASS_1 * 10 ** (0.002 * max(0.0, wavelength - VISIBLE[1]))
    if wavelength <= 1400.0:
        return 5 * _CLASS_1 * (8.0 if wavelength >= 1200 else 10 ** (0.018 * max(0.0, wavelength - 1150.0)))
    return 10.0 if wavelength <= 4000.0 else 9.6


def _in_ultraviolet(wavelength: float) -> float:
    if wavelength <= 302.5:
        return _ULTRAVIOLET
    if wavelength <= 315.0:
        return min(_NEAR_ULTRAVIOLET, _ULTRAVIOLET / 30 * 10 ** (0.2 * (wavelength - 295.0)))
    return _NEAR_ULTRAVIOLET


def class_3b(wavelength: float) -> float:
    """Return the limit of class 3B [mW] at a wavelength in vacuum [nm]."""
    if wavelength <= 302.5:
        return 1.5
    return min(_CLASS_3B, 0.05 * 10 ** (0.2 * (wavelength - 295.0))) if wavelength <= 315.0 else _CLASS_3B


def _class_3r(first: float, wavelength: float) -> float:
    """Return the limit of class 3R [mW] beside that of class 1; the same if there is no class 3R."""
    if VISIBLE[0] <= wavelength <= VISIBLE[1]:
        return _VISIBLE_3R
    return 5 * first if wavelength > EDGES[0] else first


def class_of(power: float, wavelength: float) -> LaserClass:
    """Return the class of a continuous laser of a power [mW] at a wavelength in vacuum [nm]; 4 where no limit is
    known."""
    first = class_1(wavelength)
    if first is None:
        return "4"
    visible = VISIBLE[0] <= wavelength <= VISIBLE[1]
    limits = (
        first, _CLASS_2 if visible else first, _class_3r(first, wavelength), class_3b(wavelength),
    )  # fmt: skip
    within = (name for name, limit in zip(CLASSES, limits, strict=False) if power <= limit * (1 + _ROUNDING))
    return next(within, "4")


def above_class_2(name: LaserClass) -> bool:
    """Whether a laser of a class harms before anybody can blink."""
    return not within(name, "2")
