"""One tunable of a part: read, checked and set; Movable and Readable for bluesky, inheriting nothing."""

from __future__ import annotations

from typing import Any, Self

from pico.base.clock import epoch
from pico.bench.plans import written
from pico.model.catalog import Tunable as Kind
from pico.model.quantities import Value
from pico.model.setpoint import read_value
from pico.model.trace.report import RunReport
from pico.scripting.protocol import Scripted
from pico.scripting.status import Status

_DTYPES = {"float": "number", "bool": "boolean", "choice": "string"}


class Tunable:
    """`bench["p1"].angle`, or `bench["p1.angle"]`.

    >>> angle = bench["p1"].angle
    >>> angle.set("0.2 rad").wait()
    >>> angle.value, angle.unit, angle.limits
    (11.459155902616466, 'deg', None)
    >>> bench["p1"].angle += 5     # from where it is
    """

    def __init__(self, bench: Scripted, component: str, tunable: str) -> None:
        self._bench, self.component, self.tunable = bench, component, tunable
        self.address = f"{component}.{tunable}"
        self.name = f"{component}-{tunable}"
        """Its name in documents, whose keys have no dots."""

    def __repr__(self) -> str:
        value, unit = self.value, self.unit
        return f"<{self.address}: {'unknown' if value is None else value}{f' {unit}' if unit else ''}>"

    @property
    def parent(self) -> Any:
        """The part that it is of."""
        return self._bench[self.component]

    @property
    def kind(self) -> Kind:
        """How it is declared: datatype, unit, range, tolerance, mover."""
        return self._bench.setup.type_of(self.component).tunables[self.tunable]

    @property
    def unit(self) -> str:
        """The unit of its numbers, empty for none."""
        return self.kind.unit

    @property
    def limits(self) -> tuple[float, float] | None:
        """The least and the greatest number that it goes to, in its unit; None for no bounds."""
        return self.kind.range

    @property
    def value(self) -> Value | None:
        """Its value as it was read back just now, in its unit; None where nobody knows it."""
        return self._bench.seen().known_values.get(self.component, {}).get(self.tunable)

    def checked(self, value: Value) -> Value:
        """Return a value as it would be set: a number in its unit, or of a text with another one. Raises PicoError for
        what is out of range, of another unit or of another kind."""
        return read_value(self.component, self.tunable, self.kind, written(value))

    def step(self, by: float | str) -> RunReport:
        """Set it a step from its present value, a number in its unit or a text (`"2 mrad"`): steps add up, and the
        opposite step leads back. Raises PicoError if it is out of range, unknown, or no number."""
        text = written(by).strip()
        text = f"-={text[1:]}" if text.startswith("-") else f"+={text.removeprefix('+')}"
        value = read_value(self.component, self.tunable, self.kind, text, self.value)
        return self._bench.set({self.address: value})

    def __iadd__(self, by: float | str) -> Self:
        """`bench["p1"].angle += 5`: `step(5)`; blocks until it is there."""
        self.step(by)
        return self

    def __isub__(self, by: float) -> Self:
        """`bench["p1"].angle -= 5`: `step(-5)`."""
        self.step(-by)
        return self

    def set(self, value: Value) -> Status[RunReport]:
        """Have it set, a number in its unit or a text (`"0.2 rad"`), and return at once with the status of that; raises
        PicoError for a value that makes no sense. What is asked for before it is over comes after it."""
        checked = self.checked(value)
        return self._bench.ask(f"set {self.address} {value}", lambda: self._bench.set({self.address: checked}))

    # as bluesky and ophyd have it

    def check_value(self, value: Value) -> None:
        """Raise PicoError for a value that it can't have."""
        self.checked(value)

    def read(self) -> dict[str, dict[str, Any]]:
        """Return its value with the time at which that was seen [s since 1970]."""
        seen = self._bench.seen()
        value = seen.known_values.get(self.component, {}).get(self.tunable)
        return {self.name: {"value": value, "timestamp": epoch(seen.observed_at)}}

    def describe(self) -> dict[str, dict[str, Any]]:
        """Return what `read` gives: where it is from, its type, unit and limits."""
        kind = self.kind
        key: dict[str, Any] = {"source": f"pico:{self.address}", "dtype": _DTYPES[kind.datatype], "shape": []}
        if kind.unit:
            key["units"] = kind.unit
        if kind.range:
            key["limits"] = {"control": {"low": kind.range[0], "high": kind.range[1]}}
        return {self.name: key}

    def locate(self) -> dict[str, Any]:
        """Return where it was sent last (as it stands, for a bench remembers no more) and where it is."""
        value = self.value
        return {"setpoint": value, "readback": value}

    def stop(self, *, success: bool = True) -> None:
        """Bring what was asked for and is not over to its safe end; nothing where nothing is under way."""
        self._bench.halt()

    @property
    def hints(self) -> dict[str, Any]:
        """What a plot shows of it."""
        return {"fields": [self.name]}
