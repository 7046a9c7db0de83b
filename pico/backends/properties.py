"""What devices read of their properties: the reply as it came, the number in the device's unit, and what it is in the
lab's."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType

from pico.backends.instruments import InstrumentRow
from pico.base.reasons import ReasonCode
from pico.drivers.registry import driver
from pico.model.calibration.results import AxisZero
from pico.model.instruments.conversion import Conversion
from pico.model.instruments.conversions import conversion_of
from pico.model.instruments.mapping import mapped
from pico.model.instruments.readout import Readout
from pico.model.quantities import Value
from pico.model.record import record
from pico.model.setup import Setup


@record
class PropertyRow:
    """What a device reads of one property. `raw`: its reply; `value` in `unit`, or `unknown` and `why`. `address`: the
    tunable or measurable that it is, '' for none, with `lab_value` in `lab_unit`."""

    device: str
    property: str
    raw: str = ""
    value: Value | None = None
    unit: str = ""
    unknown: ReasonCode | None = None
    why: str = ""
    address: str = ""
    lab_value: Value | None = None
    lab_unit: str = ""


def properties_of(
    setup: Setup, rows: Sequence[InstrumentRow], axes: Mapping[str, AxisZero] = MappingProxyType({})
) -> list[PropertyRow]:
    """Return a row a property of the devices that answered, and one more for each further name that the lab has for it;
    one of a device that only says in words what it reads has that as its reply. `axes` as in `conversion_of`."""
    there = (found for found in rows if found.answer is not None and found.answer.identity)
    return [row for found in there for row in _of(setup, found, axes)]


def _of(setup: Setup, row: InstrumentRow, axes: Mapping[str, AxisZero]) -> Iterator[PropertyRow]:
    assert row.answer is not None
    if not row.answer.readouts and row.answer.reads:
        yield PropertyRow(device=row.name, property=row.kind, raw=row.answer.reads)
    for name, readout in row.answer.readouts.items():
        yield from _names(setup, row, name, readout, axes)


def _names(
    setup: Setup, row: InstrumentRow, name: str, readout: Readout, axes: Mapping[str, AxisZero]
) -> Iterator[PropertyRow]:
    plain = PropertyRow(
        device=row.name, property=name, raw=readout.raw.strip(), value=readout.value, unit=readout.unit,
        unknown=readout.unknown, why=readout.why,
    )  # fmt: skip
    about, entry = driver(row.driver), (setup.wiring.devices if setup.wiring else {})[row.name]
    if row.of not in setup.lab.inventory:
        yield plain
        return
    wired = {key: one for key, one in mapped(setup, about, entry, row.of).items() if one.property == name}
    for key, one in wired.items():
        made = conversion_of(setup, about, entry, row.of, key, one, axes)
        yield replace(
            plain, address=f"{row.of}.{key}", lab_value=_in_lab(about.kind, readout, made), lab_unit=made.unit
        )
    if not wired:
        yield plain


def _in_lab(kind: str, readout: Readout, conversion: Conversion) -> Value | None:
    if kind == "shutter" and isinstance(readout.value, bool):
        return "open" if readout.value else "closed"
    number = readout.number
    return readout.value if number is None or isinstance(readout.value, bool) else conversion.to_lab(number)
