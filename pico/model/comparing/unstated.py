"""A setting that was made on a bench and that no state names."""

from __future__ import annotations

from pico.model.quantities import Value
from pico.model.record import record


@record
class Unstated:
    """A tunable by its `address`, with its live value in `unit`."""

    address: str
    value: Value
    unit: str = ""
