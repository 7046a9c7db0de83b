"""Quantities: bare numbers in a declared unit; a string with a unit is converted, a wrong dimension is an error."""

from __future__ import annotations

import math
import re
from functools import cache
from typing import Annotated, Any

from pico.diagnostics import did_you_mean

# Units that manifests use most, with the factor to the first of their dimension: no import of pint for these.
_FACTORS: dict[str, tuple[str, float]] = {
    "mm": ("length", 1.0),
    "cm": ("length", 10.0),
    "m": ("length", 1000.0),
    "um": ("length", 1e-3),
    "µm": ("length", 1e-3),
    "μm": ("length", 1e-3),
    "nm": ("length", 1e-6),
    "deg": ("angle", 1.0),
    "°": ("angle", 1.0),
    "mrad": ("angle", 0.057295779513082320),
    "rad": ("angle", 57.295779513082320),
    "ms": ("time", 1.0),
    "us": ("time", 1e-3),
    "s": ("time", 1e3),
    "mW": ("power", 1.0),
    "uW": ("power", 1e-3),
    "nW": ("power", 1e-6),
    "W": ("power", 1e3),
    "kg": ("mass", 1.0),
    "g": ("mass", 1e-3),
    "MHz": ("frequency", 1.0),
    "Hz": ("frequency", 1e-6),
    "kHz": ("frequency", 1e-3),
    "GHz": ("frequency", 1e3),
    "THz": ("frequency", 1e6),
}
_DIMENSIONS = {
    "[length]": "length",
    "[time]": "time",
    "1 / [time]": "frequency",
    "[mass]": "mass",
    "[mass] * [length] ** 2 / [time] ** 3": "power",
}
_OTHERS = frozenset({"%", "A", "A/W", "V", "V/A", "bit", "count", "dB", "mW/mm^2", "pixel"})
"""Units besides that component types have: known without an import of pint."""
# What may follow a number: units with one exponent each. Anything else never reaches pint, which evaluates powers.
_UNIT = re.compile(
    r"(?:1/)?[A-Za-zµμΩ°%]+(?:(?:\*\*|\^)?-?\d)?(?:\s?[*/·\s]\s?[A-Za-zµμΩ°%]+(?:(?:\*\*|\^)?-?\d)?){0,4}"
)
_QUANTITY = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(\S.*?)?\s*")


class QuantityError(ValueError):
    """A text that is no quantity of the unit asked for; `str()` and `hint` are fit for a user."""

    hint = ""


class DimensionError(QuantityError):
    """A quantity of another dimension than asked for: `have`, `want` as `dimension` names them."""

    def __init__(self, message: str, have: str, want: str) -> None:
        super().__init__(message)
        self.have, self.want = have, want


@cache
def _registry() -> Any:
    import pint

    return pint.UnitRegistry()


def dimension(unit: str) -> str:
    """Return `length`, `angle`, `time`, `power`, `mass`, or pint's dimensionality of `unit`.

    Raises QuantityError for a unit that nobody knows.
    """
    if unit in _FACTORS:
        return _FACTORS[unit][0]
    if not unit:
        return "number"
    try:
        dimensionality = str(_registry().Unit(unit).dimensionality)
    except Exception as exc:  # pint raises a dozen kinds
        raise QuantityError(f"`{unit}` is not a unit") from exc
    if dimensionality == "dimensionless" and any(word in unit for word in ("deg", "rad", "arc", "turn")):
        return "angle"
    return _DIMENSIONS.get(dimensionality, dimensionality)


def require_unit(unit: str) -> None:
    """Raise QuantityError for a unit that nobody knows, with one that may be meant as its hint."""
    try:
        if unit not in _OTHERS:
            dimension(unit)
    except QuantityError as exc:
        exc.hint = did_you_mean(unit[:40], _FACTORS.keys() | _OTHERS) or "expected a unit, such as `mm` or `deg`"
        raise


def convert(value: Any, unit: str) -> Any:
    """Return `value` in `unit`: numbers unchanged, strings such as "1.2 cm" converted; other types unchanged.

    Raises QuantityError for a string without a number, an unknown unit or a wrong dimension.
    """
    if not isinstance(value, str):
        return value
    match = _QUANTITY.fullmatch(value)
    if not match:
        raise QuantityError(f"`{value}` is not a quantity; expected {example(unit)}")
    number, given = float(match[1]), match[2]
    if math.isinf(number):
        raise QuantityError(f"`{value[:40]}` is too large; expected {example(unit)}")
    if given is None:
        raise QuantityError(f'"{value}" is a string; write the number without quotes, or with a unit, {example(unit)}')
    if given == unit:
        return number
    if given in _FACTORS and unit in _FACTORS and _FACTORS[given][0] == _FACTORS[unit][0]:
        return number * _FACTORS[given][1] / _FACTORS[unit][1]
    if re.fullmatch(r",\d+", given):
        raise QuantityError(f"`{value}` has a comma; decimals are written with a point, `{value.replace(',', '.')}`")
    if "=" in given:
        raise QuantityError(f"`{value[:40]}` is a value and a second setting; set one component at a time")
    if len(given) > 40 or not _UNIT.fullmatch(given):
        raise QuantityError(f"`{given[:40]}` is not a unit; expected {example(unit)}")
    have, want = dimension(given), dimension(unit)
    if have != want:
        raise DimensionError(f"`{value}` is {_a(have)}, not {_a(want)}; expected {example(unit)}", have, want)
    return float(_registry().Quantity(number, given).to(unit).magnitude)


def _a(noun: str) -> str:
    return f"{'an' if noun[:1] in 'aeiou' else 'a'} {noun}"


def example(unit: str) -> str:
    """Return how a value in `unit` may be written, for a hint."""
    return f"a number in {unit}, for example `2` or `2 {unit}`" if unit else "a number without a unit"


class Unit:
    """Marks a number in a record with its unit; pydantic, where it reads the record, converts strings with units."""

    __slots__ = ("unit",)

    def __init__(self, unit: str) -> None:
        self.unit = unit

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> Any:
        from pydantic_core import core_schema

        def number(value: Any) -> Any:
            if isinstance(value, bool):
                raise QuantityError(f"a truth value is no quantity; expected {example(self.unit)}")
            return convert(value, self.unit)

        return core_schema.no_info_before_validator_function(number, handler(source))

    def __get_pydantic_json_schema__(self, schema: Any, handler: Any) -> dict[str, Any]:
        return {
            "anyOf": [{"type": "number"}, {"type": "string", "pattern": r"^\s*[-+]?[0-9.]+(?:[eE][-+]?[0-9]+)?\s*\S+"}],
            "description": f"in {self.unit}",
        }


Length = Annotated[float, Unit("mm")]
Angle = Annotated[float, Unit("deg")]
Milliseconds = Annotated[float, Unit("ms")]
Mass = Annotated[float, Unit("kg")]

Value = float | bool | str
"""The value of a tunable other than the pose, in the unit that its type declares."""
