"""What parts, tunables and measurables ask of the bench that they are of."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

from pico.model.observation import Observation
from pico.model.quantities import Value
from pico.model.setup import Setup
from pico.model.trace.report import RunReport
from pico.scripting.status import Status

if TYPE_CHECKING:
    T = TypeVar("T")


class Scripted(Protocol):
    """See `pico.scripting.bench.Bench`."""

    @property
    def setup(self) -> Setup: ...

    @property
    def root(self) -> Path: ...

    def __getitem__(self, address: str) -> Any: ...

    def seen(self) -> Observation: ...

    def set(self, values: Mapping[str, Value]) -> RunReport: ...

    def move(self, places: Mapping[str, str | Mapping[str, float]]) -> RunReport: ...

    def do(self, component: str, primitive: str, **arguments: Value) -> RunReport: ...

    def measure(self, what: str, /) -> Any: ...

    def ask(self, what: str, work: Callable[[], T]) -> Status[T]: ...

    def halt(self) -> None: ...
