"""Power meters, which are told the wavelength of the light."""

from __future__ import annotations

from pico.drivers.driven import Powered, Tuned
from pico.drivers.protocols import PowerMeter
from pico.model.instruments.kind import Driven, InstrumentKind, Point
from pico.model.instruments.readout import shown


async def _reads(meter: PowerMeter) -> str:
    return shown(await meter.power())


def _drives(point: Point) -> Driven | None:
    return Tuned(point.instrument, point.conversion) if point.property == "wavelength" else None


KIND = InstrumentKind(
    name="power meter", about="a power meter, which is told the wavelength of the light", protocol=PowerMeter,
    reads=_reads, usual={"power": "power"}, by_name=True, datatypes=("float",), drives=_drives,
    measures=lambda point: Powered(point.instrument),
)  # fmt: skip
