"""A measurement as data, `pico.measurement/v1`: what was measured, how, and what was assured while it was."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import field, fields
from types import MappingProxyType
from typing import Any, Literal, get_args

from pico.base.formats import Format
from pico.base.reasons import ReasonCode
from pico.model.quantities import Value
from pico.model.record import record
from pico.model.shown.html import number, table

FORMAT = Format("pico.measurement")

Condition = Literal["settled", "arm parked", "shutter", "illumination", "not saturated", "wavelength", "in range"]
"""What may be assured of a measurement; `shutter` and `illumination` where the measurable declares what it needs,
`wavelength` of a meter that is told the wavelength of the light, `in range` of light for whose wavelength all parts on
its way to the detector are made."""
CONDITIONS: tuple[Condition, ...] = get_args(Condition)
_LATER: frozenset[Condition] = frozenset({"wavelength", "in range"})
"""Conditions that earlier records do not have, and a simulated meter need not: that only one of two measurements has
them does not keep these from being compared."""
PEEKED = "it was only peeked at, without the lease"


@record
class ArrayRef:
    """An array in the content store: the SHA-256 of its file (.npy, 64 digits), the bytes of that, shape and dtype."""

    sha256: str
    size: int
    shape: tuple[int, ...]
    dtype: str


@record
class Measurement:
    """One measurement of a `measurable` of a component, or of a camera over the bench.

    `value`: a number, a word, numbers by name (of a pose, of an image), or None; `array`: where there is more than
    goes into a line. `unit`; where numbers by name have several, in their order. `unknown`: why there is no value,
    though it was measured, and `reason`: the same as a code. `sigma`: one standard deviation, as the value; `noise`:
    the part of it that differs between readings of the same instrument, which does not hold what they have in common
    (the calibration of a meter); None: all of it. `settings`: what it depends on, such as exposure, gain and
    background. `time` on the bench's clock [s], `at` by the wall, UTC. `kernel` and its version: what made the value of
    what a device gave.
    `assured`: what was seen to hold; `not_assured`: what was not, and why. `remark`: what was left out of it, such as
    the defective pixels of a camera; empty if nothing was.
    """

    schema: str = FORMAT.schema
    component: str
    measurable: str
    value: Value | Mapping[str, Value] | None = None
    array: ArrayRef | None = None
    unit: str = ""
    unknown: str | None = None
    reason: ReasonCode | None = None
    sigma: float | Mapping[str, float] | None = None
    noise: float | Mapping[str, float] | None = None
    settings: Mapping[str, Value] = field(default_factory=dict)
    time: float = 0.0
    at: str = ""
    kernel: str | None = None
    kernel_version: str | None = None
    assured: tuple[Condition, ...] = ()
    not_assured: Mapping[Condition, str] = field(default_factory=dict)
    remark: str = ""

    @property
    def address(self) -> str:
        """`cam.image`."""
        return f"{self.component}.{self.measurable}"

    @property
    def numbers(self) -> Mapping[str, tuple[float, float | None, str]]:
        """Each number with its sigma (None where nobody tells) and unit, by its name; by `` where there is only one."""
        from pico.kernels.measured import in_order

        values = in_order(self.kernel, self.value) if isinstance(self.value, Mapping) else {"": self.value}
        units = self.unit.split(", ") if isinstance(self.value, Mapping) else [self.unit]
        each = units if len(units) == len(values) else [self.unit] * len(values)
        sigmas = self.sigma if isinstance(self.sigma, Mapping) else {"": self.sigma}
        return {
            name: (float(value), sigmas.get(name), unit)
            for (name, value), unit in zip(values.items(), each, strict=True)
            if isinstance(value, int | float) and not isinstance(value, bool)
        }

    @property
    def said(self) -> str:
        """What was measured, in a line: `x 1.2 ± 0.1 um, y 3.4 ± 0.1 um`."""
        if self.unknown:
            return f"unknown: {self.unknown}"
        told = [f"{name} {number(v, s)} {unit}".strip() for name, (v, s, unit) in self.numbers.items()]
        if self.array is not None:
            told.append(f"{' x '.join(map(str, self.array.shape))} {self.array.dtype}")
        return ", ".join(told) or number(self.value)

    def __repr__(self) -> str:
        return f"<{self.address}: {self.said}>"

    def _repr_html_(self) -> str:
        rows = [(name, number(v, s), unit) for name, (v, s, unit) in self.numbers.items()]
        settings = ", ".join(f"{name} {number(value)}" for name, value in self.settings.items())
        below = "; ".join(words for words in (settings, self.doubt and f"not assured: {self.doubt}") if words)
        return table(repr(self)[1:-1], ("", "value", "unit"), rows, below)

    @property
    def doubt(self) -> str:
        """What was not assured, and why: `shutter: laser is open`; empty where all was."""
        return "; ".join(f"{condition}: {why}" for condition, why in self.not_assured.items())


def incomparable(a: Measurement, b: Measurement, within: Mapping[str, float] = MappingProxyType({})) -> tuple[str, ...]:
    """Return why two measurements must not be compared, a reason each; none where they may.

    They must be of the same thing, in the same unit, by the same kernel, with the same settings, and the same must
    have been assured of both: what was not is never compared as if it were. `within`: by how much a setting may differ,
    in its unit, and is the same nevertheless.
    """
    return tuple(_differing(a, b, within))


def _same(one: Value | None, other: Value | None, within: float) -> bool:
    """Whether two settings are the same; documents hold numbers rounded to a millionth."""
    numbers = all(isinstance(v, int | float) and not isinstance(v, bool) for v in (one, other))
    if not numbers:
        return one == other
    return abs(float(one or 0) - float(other or 0)) <= max(within, 2e-6, 1e-6 * abs(float(one or 0)))


def _differing(a: Measurement, b: Measurement, within: Mapping[str, float]) -> Iterator[str]:
    if a.address != b.address:
        yield f"one is of {a.address}, the other of {b.address}"
    for name in ("unit", "kernel", "kernel_version"):
        one, other = getattr(a, name), getattr(b, name)
        if one != other:
            yield f"{name.replace('_', ' ')}: {one or 'none'}, then {other or 'none'}"
    for name in sorted(a.settings.keys() | b.settings.keys()):
        one, other = a.settings.get(name), b.settings.get(name)
        if not _same(one, other, within.get(name, 0.0)):
            yield f"{name}: {_said(one)}, then {_said(other)}"
    for which, measured in (("first", a), ("second", b)):
        for condition, why in measured.not_assured.items():
            yield f"not assured of the {which}: {condition} ({why})"
    for condition in (one for one in CONDITIONS if one not in _LATER):
        if (condition in a.assured) != (condition in b.assured) and condition not in {*a.not_assured, *b.not_assured}:
            yield f"assured of the {'first' if condition in a.assured else 'second'} only: {condition}"


def _said(value: Value | None) -> str:
    return "none" if value is None else f"{value:g}" if isinstance(value, float) else str(value)


def measurement_from_json(data: Any) -> Measurement:
    """Return the measurement whose `as_json` gave `data`, in this version of the format or an older one; keys that this
    version does not know are passed over. Raises ValueError where it is none."""
    from pydantic import TypeAdapter, ValidationError

    content = FORMAT.lifted(data)
    known = {f.name for f in fields(Measurement)}
    try:
        found: Measurement = TypeAdapter(Measurement).validate_python({k: v for k, v in content.items() if k in known})
    except ValidationError as exc:
        first = exc.errors()[0]
        raise ValueError(f"no measurement: {'.'.join(str(word) for word in first['loc'])}: {first['msg']}") from None
    return found


def number_of(measurement: Measurement, name: str) -> float | None:
    """Return a number that was measured: the measurable itself, or one by `name` (`x`, or `centroid.x`) of those
    that it has; else None."""
    name = name.rpartition(".")[2]
    value = measurement.value.get(name) if isinstance(measurement.value, Mapping) else measurement.value
    if isinstance(measurement.value, Mapping) or name == measurement.measurable:
        return float(value) if isinstance(value, int | float) and not isinstance(value, bool) else None
    return None


SURE = 3.0
"""Standard deviations from which two numbers differ."""


@record
class Restood:
    """A part that was put down again, where cameras saw it both times: how far it stands from where it stood, `ahead`
    and to its `left` [mm] and `turned` counterclockwise [deg]; one standard deviation of each by `position` and `yaw`;
    and what that makes of a number, `by` so much in its unit."""

    component: str
    ahead: float
    left: float
    turned: float
    position: float
    yaw: float
    by: float = 0.0


@record
class Compared:
    """A number by address (`cam.fit.x`) `before` and `now`, in `unit`; None where there is none. `sigma`: one standard
    deviation of their difference, with what the placement of parts makes of it. A power is compared as a share of what
    the `reference` of its laser told both times; `now` is then what it would be at the laser's power of before. `why`:
    why the two must not be compared; empty where they may be.

    `expected`: what it is to be now, by how parts that were put down again (`restood`) are seen to stand; None where
    that is as before. `sigma` is then of what it is beside that."""

    address: str
    before: float | None = None
    now: float | None = None
    unit: str = ""
    sigma: float = 0.0
    reference: str = ""
    why: str = ""
    expected: float | None = None
    restood: tuple[Restood, ...] | None = None

    @property
    def wanted(self) -> float | None:
        """What it is to be now."""
        return self.before if self.expected is None else self.expected

    @property
    def differs(self) -> bool:
        """Whether it is another now than it is to be, by more than can be chance."""
        known = self.wanted is not None and self.now is not None and not self.why
        return known and abs((self.now or 0.0) - (self.wanted or 0.0)) > SURE * self.sigma

    @property
    def share(self) -> float | None:
        """What it is of what it was."""
        return self.now / self.before if self.before and self.now is not None and not self.why else None
