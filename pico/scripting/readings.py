"""What was measured, with its picture; and a measurable that is measured again and again."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pico.base.clock import epoch
from pico.model.measurement import Measurement
from pico.scripting.protocol import Scripted

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from pico.scripting.status import Status

SHOWN = 800
"""So many pixels is a picture wide in a notebook at most; `array` has them all."""


class Reading:
    """One thing that was measured: its numbers with their uncertainties, and its array.

    >>> spot = bench.measure("cam.centroid")
    >>> spot["x"], spot.sigma["x"], spot.unit
    (12.3, 0.04, 'um, um')
    """

    def __init__(self, bench: Scripted, measurement: Measurement) -> None:
        self._bench, self.measurement = bench, measurement

    def __repr__(self) -> str:
        return repr(self.measurement)

    @property
    def value(self) -> Any:
        """A number, a word, numbers by name, or None."""
        return self.measurement.value

    @property
    def sigma(self) -> Any:
        """One standard deviation, as the value; None where nobody tells."""
        return self.measurement.sigma

    @property
    def unit(self) -> str:
        """The unit; where numbers by name have several, in their order."""
        return self.measurement.unit

    @property
    def array(self) -> NDArray[Any]:
        """What does not go into a line, such as a picture (height, width) [count]; raises PicoError where there is
        none, or it is not here."""
        from pico.content.arrays import load_array
        from pico.content.store import store_of
        from pico.diagnostics import PicoError, error

        address = self.measurement.address
        if self.measurement.array is None:
            raise PicoError(error("array", f"{address} has no array", address=address))
        found: NDArray[np.generic] = load_array(store_of(self._bench.root), self.measurement.array)
        return found

    def __getitem__(self, number: str) -> float:
        """Return one of its numbers by name: `reading["x"]`; raises KeyError."""
        known = self.measurement.numbers
        if number not in known:
            raise KeyError(f"{self.measurement.address} has no `{number}`; it has {', '.join(known) or 'no numbers'}")
        return known[number][0]

    def __float__(self) -> float:
        """Return its only number; raises TypeError where it has none, or several."""
        known = self.measurement.numbers
        if set(known) != {""}:
            raise TypeError(f"{self!r} is not one number; it has {', '.join(known) or 'none'}")
        return known[""][0]

    def _repr_html_(self) -> str:
        return self.measurement._repr_html_()

    def _repr_png_(self) -> bytes | None:
        """Return its picture, brightest white, black level black; None where it is none."""
        if self.measurement.array is None or len(self.measurement.array.shape) != 2:
            return None
        from pico.bench.picturing.kept import as_picture
        from pico.drawing.picture import png

        image = as_picture(self.array, self.measurement)
        every = -(-image.shape[1] // SHOWN)
        return png(image[::every, ::every])


class Measurable:
    """`bench["cam"].centroid`, or `bench["cam.centroid"]`; Readable and Triggerable for bluesky, inheriting nothing.

    >>> bench["cam"].centroid.measure()["x"]
    12.3
    """

    def __init__(self, bench: Scripted, address: str) -> None:
        """`address`: with kernels it is measured by these (`cam.image | centroid`)."""
        self._bench, self.address = bench, address
        self.component, _, self.measurable = (word.strip() for word in address.partition("."))
        self.name = f"{self.component}-{self.measurable.replace(' | ', '-').replace('.', '_')}"
        """Its name in documents, whose keys have no dots."""
        self._last: Reading | None = None

    def __repr__(self) -> str:
        return f"<{self.address}: {self._last.measurement.said if self._last else 'not measured yet'}>"

    @property
    def parent(self) -> Any:
        """The part that it is of; None of a camera over the bench."""
        known = self.component in self._bench.setup.lab.inventory
        return self._bench[self.component] if known else None

    def measure(self) -> Reading:
        """Measure it, recorded in a run, and return what was measured; raises PicoError where it has no value."""
        self._last = self._bench.measure(self.address)
        return self._last

    def trigger(self) -> Status[Reading]:
        """Have it measured, and return at once with the status of that; `read` then tells what was measured."""
        return self._bench.ask(f"measure {self.address}", self.measure)

    def read(self) -> dict[str, dict[str, Any]]:
        """Return the numbers that were measured last (now, where it was not yet), each with its `_sigma`."""
        found = self._reading().measurement
        at = epoch(found.at)
        read: dict[str, dict[str, Any]] = {}
        for key, (value, sigma, _) in self._keys(found).items():
            read[key] = {"value": value, "timestamp": at}
            read[f"{key}_sigma"] = {"value": sigma if sigma is not None else float("nan"), "timestamp": at}
        return read or {self.name: {"value": found.value, "timestamp": at}}

    def describe(self) -> dict[str, dict[str, Any]]:
        """Return what `read` gives: where it is from, its type and unit."""
        found = self._reading().measurement
        described: dict[str, dict[str, Any]] = {}
        for key, (_, _, unit) in self._keys(found).items():
            own = {
                "source": f"pico:{self.address}",
                "dtype": "number",
                "shape": [],
                **({"units": unit} if unit else {}),
            }
            described |= {key: own, f"{key}_sigma": dict(own)}
        return described or {self.name: {"source": f"pico:{self.address}", "dtype": "string", "shape": []}}

    @property
    def hints(self) -> dict[str, Any]:
        """What a plot shows of it."""
        return {"fields": [key for key in self.describe() if not key.endswith("_sigma")]}

    def _reading(self) -> Reading:
        return self._last or self.measure()

    def _keys(self, found: Measurement) -> dict[str, tuple[float, float | None, str]]:
        return {f"{self.name}-{number}" if number else self.name: told for number, told in found.numbers.items()}
