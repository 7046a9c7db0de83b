"""One attempt at an operation, as a device makes it: looked at before, done, stored, looked at again.

A generator, without clock or I/O of its own, so that a test can cut it anywhere.
"""

from __future__ import annotations

from collections.abc import Generator, Mapping
from typing import Any, Protocol

from pico.backends.device import Began
from pico.diagnostics import Diagnostic, PicoError
from pico.model.observation import ObservedComponent
from pico.model.operation import Operation, OperationResult, Outcome
from pico.plug_ins.faults import CODE, blamed

Progress = Generator[float, None, Mapping[str, Any]]
"""Something in progress: yields the seconds until it wants to be resumed, returns the data of its result."""


class Failed(Exception):
    """A motion that did not do what it should; `outcome` is `unknown` if nobody can tell what it did. `data`: of the
    result, such as what else it moved."""

    def __init__(
        self, diagnostic: Diagnostic, outcome: Outcome = "failed", data: Mapping[str, Any] | None = None
    ) -> None:
        self.diagnostic, self.outcome, self.data = diagnostic, outcome, data or {}
        super().__init__(diagnostic.summary)


class AttemptTable(Protocol):
    """What an attempt acts on."""

    @property
    def now(self) -> float:
        """The clock of the bench [s]."""
        ...

    def look(self, component: str) -> ObservedComponent | None:
        """Return a component as it is seen now."""
        ...

    def act(self, operation: Operation, key: str) -> Progress:
        """Do what the operation asks for; raises `Failed`."""
        ...

    def store(self) -> None:
        """Make durable what the table is like now; called before anyone hears of an end."""
        ...


def attempt(
    table: AttemptTable, operation: Operation, key: str, began: Began
) -> Generator[float, None, OperationResult]:
    """Do one operation and return its result; `began` is called before anything moves."""
    component = operation.component
    before, begun = table.look(component), table.now
    began(before)
    data: Mapping[str, Any] = {}
    failure: Failed | None = None
    try:
        data = yield from table.act(operation, key)
    except Failed as exc:
        failure, data = exc, exc.data
    except Exception as exc:
        failure = plug_in_failed(exc)
        if failure is None:
            raise
    table.store()
    return OperationResult(
        key=key,
        outcome=failure.outcome if failure else "done",
        error=failure.diagnostic if failure else None,
        before=before,
        after=table.look(component),
        seconds=table.now - begun,
        ended=table.now,
        data=data,
    )


def plug_in_failed(exc: Exception) -> Failed | None:
    """Return the failure of an operation that came to a mistake of a plug-in; None if an exception is none of that."""
    found = next((d for d in exc.diagnostics if d.code == CODE), None) if isinstance(exc, PicoError) else blamed(exc)
    return Failed(found) if found is not None else None
