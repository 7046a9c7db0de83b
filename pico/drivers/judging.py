"""What a raw reply means: a number, a switch, an identity, a picture, or the reason why it is none.

Pure functions, one place for all drivers. A reply is accepted only if it has the form that the manual or the standard
gives, to the last character: what Python's own `float` or `int` would also take (`1_000`, `nan`, Unicode digits) is no
number on a wire. A number that is not a measurement (over-range, NaN, sentinels) never leaves this module as one.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from pico.base.reasons import REASONS, ReasonCode
from pico.diagnostics import PicoError, error
from pico.drivers.protocols import Identity
from pico.model.instruments.readout import Readout, unknown

if TYPE_CHECKING:
    import numpy as np

_NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]{1,3})?")
"""<NR1>, <NR2> or <NR3> of IEEE 488.2."""
_WHOLE = re.compile(r"[+-]?[0-9]{1,15}")
_NAN = re.compile(r"[+-]?NAN", re.IGNORECASE)
_INFINITY = re.compile(r"([+-]?)(?:INF(?:INITY)?|OVLD|OVERLOAD|OVERFLOW|OVER)", re.IGNORECASE)
_NEGATIVE = re.compile(r"NINF|UNDERFLOW|UNDER", re.IGNORECASE)
_LEAST_SENTINEL = 9.0e36
"""From here on a number stands for something else: SCPI-99 (volume 1, 7.2.1.4) says infinity by 9.9E37, minus infinity
by -9.9E37 and NaN by 9.91E37. Some vendors give other numbers of this size."""
_BEYOND: Mapping[str, ReasonCode] = {"+": "over-range", "-": "under-range"}
_SCPI_NAN = (9.905e37, 9.915e37)
_ERROR = re.compile(r'([+-]?[0-9]{1,5})(?:\s*,\s*(?:"(.*)"|([^"]*)))?', re.DOTALL)
_ON, _OFF = ("1", "ON"), ("0", "OFF")
_PIXELS = ("uint8", "uint16")


def number(raw: str, unit: str, *, limits: tuple[float, float] | None = None, failure: str = "") -> Readout:
    """Return the reply to a question for a number in `unit` (SCPI, <NRf>).

    `limits`: what the lab allows of the property, in `unit`. `failure`: the first entry of the error queue, '' if that
    was empty.
    """
    said = raw.strip(" \t\r\n")
    if failure:
        return unknown(unit, "instrument-error", raw, f"the error queue holds {failure[:80]}")
    code = _sentinel(said)
    if code is None and not _NUMBER.fullmatch(said):
        return unknown(unit, "garbled", raw, f"{said[:40]!r} is no number")
    if code is not None:
        return unknown(unit, code, raw, f"{REASONS[code]}: it replied {said[:40]}")
    return within(Readout(unit=unit, value=float(said), raw=raw), limits)


def _sentinel(said: str) -> ReasonCode | None:
    """Return what a reply says instead of a number; None if it says none of that."""
    sign = ""
    if _NAN.fullmatch(said):
        return "no-number"
    if found := _INFINITY.fullmatch(said):
        sign = found[1] or "+"
    elif _NEGATIVE.fullmatch(said):
        sign = "-"
    elif _NUMBER.fullmatch(said) and abs(float(said)) >= _LEAST_SENTINEL:
        if _SCPI_NAN[0] <= abs(float(said)) <= _SCPI_NAN[1]:
            return "no-number"
        sign = "-" if said.startswith("-") else "+"
    return _BEYOND.get(sign)


def within(found: Readout, limits: tuple[float, float] | None) -> Readout:
    """Return a readout, unknown if its number lies outside `limits`."""
    if limits is None or found.value is None or isinstance(found.value, str):
        return found
    low, high = limits
    if low <= found.value <= high:
        return found
    why = f"{found.value:g} {found.unit} is outside {low:g} to {high:g} {found.unit}, the limits of the device"
    return unknown(found.unit, "out-of-limits", found.raw, why)


def whole(raw: str) -> int:
    """Return a whole number, in decimal digits; raises ValueError for any other reply."""
    if not _WHOLE.fullmatch(raw):
        raise ValueError(f"{raw[:40]!r} is no whole number")
    return int(raw)


def hexadecimal(raw: str, digits: int, *, signed: bool = False) -> int:
    """Return a number of so many hexadecimal digits, as two's complement if `signed`; raises ValueError."""
    if not re.fullmatch(f"[0-9A-Fa-f]{{{digits}}}", raw):
        raise ValueError(f"{raw[:40]!r} is not {digits} hexadecimal digits")
    value = int(raw, 16)
    return value - (1 << 4 * digits) if signed and value >> 4 * digits - 1 else value


def switched(raw: str) -> bool:
    """Return a truth value as instruments give it: 1, 0, ON or OFF; raises ValueError for any other reply."""
    said = raw.strip(" \t\r\n").upper()
    if said not in _ON + _OFF:
        raise ValueError(f"{said[:40]!r} is none of 1, 0, ON and OFF")
    return said in _ON


def switch(raw: str, unit: str = "") -> Readout:
    """Return a truth value as a readout; unknown for a reply that is none."""
    try:
        return Readout(unit=unit, value=switched(raw), raw=raw)
    except ValueError as exc:
        return unknown(unit, "garbled", raw, str(exc))


def failure(raw: str) -> str:
    """Return the entry that a reply to `SYST:ERR?` holds, '' for an empty queue (error 0); raises ValueError for
    what is no such reply. `00` is none: its first digit may be the end of an earlier reply whose line was broken."""
    found = _ERROR.fullmatch(raw.strip(" \t\r\n"))
    if found is None or re.fullmatch("0[0-9]+", found[1]):
        raise ValueError(f"{raw[:40]!r} is no entry of an error queue")
    return "" if int(found[1]) == 0 else raw.strip()


def identity(raw: str) -> Identity:
    """Return who a reply to `*IDN?` names. Raises ValueError for what is no identity.

    IEEE 488.2 asks for four fields: vendor, model, serial number, firmware. Vendors give one to many: one is the model,
    two are vendor and model, three lack the firmware, and what follows the fourth belongs to the firmware.
    """
    said = raw.strip(" \t\r\n")
    if len(said) >= 2 and said[0] == said[-1] == '"':
        said = said[1:-1]
    fields = [one.strip() for one in said.split(",")]
    if not said.isprintable() or not any(one.isalpha() for one in said) or _sentinel(said) or _NUMBER.fullmatch(said):
        raise ValueError(f"{raw[:60]!r} is no identity")
    if len(fields) == 1:
        return Identity(vendor="", model=fields[0], serial="")
    vendor, model, *rest = fields
    return Identity(vendor=vendor, model=model, serial=rest[0] if rest else "", firmware=",".join(rest[1:]))


ROUNDED = 0.5
"""How far the wavelength that a meter reads back may be from what was set [nm]."""


def same_wavelength(found: object, wanted: float) -> bool:
    """Whether a wavelength [nm] that was read back is the one that was set, as meters round it."""
    return isinstance(found, int | float) and not isinstance(found, bool) and abs(found - wanted) <= ROUNDED


def picture(said: Mapping[str, Any], data: bytes) -> np.ndarray:
    """Return the picture (rows, columns) or (rows, columns, 3), uint8 or uint16, that came with what was `said` of it;
    raises PicoError for pixels of another type, for a shape that is none, and for too few or too many bytes."""
    import numpy as np

    kind, shape = said.get("dtype"), said.get("shape")
    if kind not in _PIXELS:
        raise _no_picture(f"its pixels are of type {_shown(kind)}, not {' or '.join(_PIXELS)}")
    sizes = shape if isinstance(shape, list) else []
    if len(sizes) not in (2, 3) or not all(type(n) is int and n > 0 for n in sizes) or sizes[2:] not in ([], [3]):
        raise _no_picture(f"its shape is {_shown(shape)}, not [rows, columns] or [rows, columns, 3]")
    wanted = np.dtype(kind).itemsize
    for size in sizes:
        wanted *= size
    if len(data) != wanted:
        raise _no_picture(f"it came with {len(data)} bytes, and {sizes} pixels of {kind} are {wanted}")
    return np.frombuffer(data, kind).reshape(sizes)


def pixels(name: str, taken: object, columns: int | None = None, rows: int | None = None) -> np.ndarray:
    """Return a copy of a picture that a vendor's library gave. Raises PicoError, for camera `name`, for pixels of
    another type than uint8 or uint16, and for a size that is not `columns` by `rows`."""
    import numpy as np

    found = np.asarray(taken)
    kind, shape = str(found.dtype), list(found.shape)
    if kind not in _PIXELS:
        raise _of(name, _no_pixels(f"its pixels are of type {kind}, not {' or '.join(_PIXELS)}"))
    if len(shape) not in (2, 3) or 0 in shape or shape[2:] not in ([], [3]):
        raise _of(name, _no_pixels(f"its shape is {shape}, not [rows, columns] or [rows, columns, 3]"))
    if columns is not None and rows is not None and shape[:2] != [rows, columns]:
        raise _of(name, _no_pixels(f"it has {shape[1]} x {shape[0]} pixels, and the camera sends {columns} x {rows}"))
    return found.copy()


class Counted:
    """The numbers of the pictures of a stream, as a vendor's library gives them. They begin anew once they have come to
    the end of their range."""

    ANEW = 1000
    """A number that is smaller by more than this belongs to a count that began anew."""

    def __init__(self) -> None:
        self.last = -1

    def require_newer(self, name: str, number: object) -> None:
        """Raise PicoError, for camera `name`, for the picture that was sent last or one shortly before, and for a
        number that is none. The next is compared with this one: a wrong number does not spoil all that follow.
        """
        last = self.last
        if type(number) is int and number >= 0:
            self.last = number
            if number < last - self.ANEW:
                return
        counted(name, number if number is not None else -1, last)


def _of(name: str, wrong: PicoError) -> PicoError:
    return PicoError([replace(one, address=name) for one in wrong.diagnostics])


def _no_pixels(why: str) -> PicoError:
    return PicoError(error("device-reply", f"what the camera sent is no picture: {why}", hint="check its pixel format"))


def counted(name: str, number: object, last: int) -> int:
    """Return the number of a picture; `last` (that of the one before it, -1 for none) if its camera does not count.
    Raises PicoError, for camera `name`, for a picture that was sent before, and for a number that is none."""
    if number is None:
        return last
    if type(number) is not int or number < 0:
        text = f"{name} numbers a picture by {_shown(number)}"
        raise PicoError(error("device-reply", text, hint="a `number` counts on from 0", address=name))
    if number <= last:
        text = f"{name} sent an earlier picture again: number {number} after {last}"
        raise PicoError(error("stale", text, hint="restart the camera, or the program that serves it", address=name))
    return number


def _shown(value: object) -> str:
    return "missing" if value is None else repr(value)[:40]


def _no_picture(why: str) -> PicoError:
    hint = "the protocol of the server is described in pico/drivers/frames.py"
    return PicoError(error("device-reply", f"the camera's answer is no picture: {why}", hint=hint))
