"""What was read of a measurable becomes a measurement, with what was assured while it was read. For every backend."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pico.backends.conditions import conditions
from pico.base.reasons import ReasonCode
from pico.content.arrays import keep_array
from pico.content.store import store_of
from pico.model.catalog import Measurable
from pico.model.measurement import PEEKED, Condition, Measurement
from pico.model.observation import Observation
from pico.model.quantities import Value
from pico.model.setup import Setup

if TYPE_CHECKING:
    from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class Reading:
    """What was read: see `pico.model.measurement.Measurement`. `array`: what is too large for a line. `saturated`: how
    much of it was, in words, empty for nothing; None where that means nothing. `unit`: where the
    measurable says none. `unknown`: why there is no value; `reason`: the same as a code. `conditions`: what else
    is assured of it, each with why it is not; '' where it is. `remark`: what was left out of it, in words."""

    value: Value | Mapping[str, Value] | None
    array: NDArray[Any] | None = None
    sigma: float | Mapping[str, float] | None = None
    noise: float | Mapping[str, float] | None = None
    settings: Mapping[str, Value] = field(default_factory=dict)
    kernel: str | None = None
    kernel_version: str | None = None
    saturated: str | None = None
    unit: str = ""
    unknown: str = ""
    reason: ReasonCode | None = None
    conditions: Mapping[Condition, str] = field(default_factory=dict)
    remark: str = ""


def measurement(
    setup: Setup, root: Path, seen: Observation, known: Measurable, reading: Reading, component: str, name: str,
    busy: Sequence[str] | None, at: str,
) -> Measurement:  # fmt: skip
    """Return what was measured of `component` on the bench as it is `seen`; an array goes to the content store.

    `busy`: the operations under way beside it; None where it is only peeked at. `at`: now, as ISO 8601. Raises
    PicoError where an array can't be kept.
    """
    said: dict[Condition, str] = {**conditions(setup, seen, component, known, busy or ())}
    if reading.saturated is not None:
        said["not saturated"] = reading.saturated
    said |= reading.conditions
    if busy is None:
        said = dict.fromkeys(said, PEEKED)
    own = {n: v for n, v in seen.known_values.get(component, {}).items() if n != name}
    return Measurement(
        component=component,
        measurable=name,
        value=reading.value,
        array=None if reading.array is None else keep_array(store_of(root), reading.array),
        unit=known.unit or reading.unit,
        sigma=reading.sigma,
        noise=reading.noise,
        unknown=reading.unknown or None,
        reason=_reason(reading),
        settings={**own, **reading.settings},
        time=seen.time,
        at=at,
        kernel=reading.kernel,
        kernel_version=reading.kernel_version,
        assured=tuple(condition for condition, why in said.items() if not why),
        not_assured={condition: why for condition, why in said.items() if why},
        remark=reading.remark,
    )


def _reason(reading: Reading) -> ReasonCode | None:
    """Return the code of why there is no value; None where there is one."""
    if not reading.unknown:
        return None
    return reading.reason or ("saturated" if reading.saturated else "not-computed")
