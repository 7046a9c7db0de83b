"""What can be asked of the memory of a bench: the reading side of its journal."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from typing import Any, Protocol

from pico.runs.journal import JournalRecord, RunRecord, Success, Unsettled


class Memory(Protocol):
    """Every method raises PicoError where the journal can't be read."""

    def runs(self) -> tuple[RunRecord, ...]:
        """Return the runs in the order in which they began."""
        ...

    def last(self) -> RunRecord | None:
        """Return the run that began last, None where none did."""
        ...

    def moving(self) -> frozenset[str]:
        """Return the runs that began at least one operation."""
        ...

    def document(self, run: str) -> str | None:
        """Return the plan that a run began with, as JSON; None where it was not kept."""
        ...

    def about(self, run: str) -> tuple[tuple[Mapping[str, Any], ...], Mapping[str, Any] | None]:
        """Return what was recorded of a run each time that it was begun, and how the bench was observed afterwards."""
        ...

    def records(self, *, run: str | None = None, key: str | None = None) -> tuple[JournalRecord, ...]:
        """Return the records of a run, of a key, or all, in the order in which they were written."""
        ...

    def successes(self, components: Collection[str]) -> Iterator[Success]:
        """Yield the operations on some components that succeeded, the last one first."""
        ...

    def unsettled(self) -> tuple[Unsettled, ...]:
        """Return the operations that began and of which nobody knows how they ended, in the order of their start."""
        ...
