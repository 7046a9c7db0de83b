"""Where light is lost on its way: everything behind that place is in the dark, and what other light comes to is not."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from pico.diagnosis.causes import Cause
from pico.diagnosis.nominal import Nominal
from pico.diagnosis.quantities import Quantity

NO_LIGHT, STOPS = "no light", "stops the light"
"""What has befallen a source, and any other part."""
DARK = ".dark"


def losses(nominal: Nominal, parts: Sequence[str]) -> Iterator[Cause]:
    """Yield that each of some parts keeps all light back; of a source also that only its shutter does."""
    for name in parts:
        if nominal.setup.type_of(name).optics.element == "source":
            yield Cause(name, NO_LIGHT, ())
        yield Cause(name, STOPS, ())


def stopped(nominal: Nominal, wanted: Sequence[Quantity], cause: Cause) -> Any:
    """Return which quantities (n,) read no light where a part keeps all light back."""
    return np.array([_stopped(nominal, one, cause) for one in wanted])


def _stopped(nominal: Nominal, one: Quantity, cause: Cause) -> bool:
    address = one.shots[0].address
    if address.endswith(DARK):
        return False
    if address.endswith(".monitor"):
        return cause.kind == NO_LIGHT and address.partition(".")[0] == cause.part
    return nominal.all_pass(cause.part, address.partition(".")[0])
