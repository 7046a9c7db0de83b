"""One attempt at an operation, from its first record to its last: the order of records and motion that all rests on.

Intent before anything, `started` before motion, the end before anyone hears of it. Generators, without clock or I/O of
their own, so that every backend runs them and a test can cut them anywhere.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Mapping
from typing import TYPE_CHECKING, Any, Protocol

from pico.diagnostics import Diagnostic
from pico.model.observation import ObservedComponent
from pico.model.operation import Operation, OperationResult, Outcome

if TYPE_CHECKING:
    from pico.runs.journal import Journal

Progress = Generator[float, None, Mapping[str, Any]]
"""Something in progress: yields the seconds until it wants to be resumed, returns the data of its result."""


class Failed(Exception):
    """A motion that did not do what it should; `outcome` is `unknown` where nobody can tell what it did."""

    def __init__(self, diagnostic: Diagnostic, outcome: Outcome = "failed") -> None:
        self.diagnostic, self.outcome = diagnostic, outcome
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
        """Make durable what the table is like now; called before an end is recorded."""
        ...


class Attempts:
    """Executes operations on a table, each key once. `token` is that of the lease; `tell` hears of each start."""

    def __init__(
        self,
        journal: Journal,
        table: AttemptTable,
        token: int,
        tell: Callable[[Operation, str], None] = lambda *_: None,
    ) -> None:
        """Raises PicoError (exit code LOCKED) where somebody took the bench since this token was given."""
        self._journal, self._table, self._token, self._tell = journal, table, token, tell
        journal.fence(token)

    def known(self, operation: Operation, key: str) -> OperationResult | None:
        """Record the intent and return None, or return what became of this key before; then nothing must move."""
        return self._journal.intend(key, operation, self._token)

    def perform(self, operation: Operation, key: str) -> Generator[float, None, OperationResult]:
        """Do one operation whose intent is recorded, and return its result, which then is in the journal."""
        table, component = self._table, operation.component
        before, begun = table.look(component), table.now
        self._journal.started(key, before, self._token)
        self._tell(operation, key)
        data: Mapping[str, Any] = {}
        failure: Failed | None = None
        try:
            data = yield from table.act(operation, key)
        except Failed as exc:
            failure = exc
        table.store()
        result = OperationResult(
            key=key,
            outcome=failure.outcome if failure else "done",
            error=failure.diagnostic if failure else None,
            before=before,
            after=table.look(component),
            seconds=table.now - begun,
            ended=table.now,
            data=data,
        )
        self._journal.ended(result, self._token)
        return result
