"""The journal of one bench as its edge has it: one connection that writes, one for each thread that only looks."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pico.base.plain_files import read_text
from pico.base.state_files import JOURNAL, RUN_MARK
from pico.places.bench import BenchPlace
from pico.runs.storage.change_count import ChangeCount

if TYPE_CHECKING:
    from pico.model.trace.run import RunOutcome
    from pico.runs.journal import Journal


class Remembering:
    """What the bench at `place` remembers of its runs, and which of them has begun and not ended."""

    def __init__(self, place: BenchPlace, clock: Callable[[], str]) -> None:
        self._place, self._clock = place, clock
        self._journal: Journal | None = None
        self._memories: dict[int, Journal] = {}

    @property
    def path(self) -> Path:
        """The file of the journal."""
        return JOURNAL.path(self._place.folder)

    @property
    def journal(self) -> Journal:
        """The journal, opened when it is first needed; raises PicoError."""
        if self._journal is None:
            from pico.runs.journal import Journal

            self._journal = Journal(self.path, self._clock)
        return self._journal

    @property
    def memory(self) -> Journal | None:
        """The journal, to be read from any disk; None where there was none yet. Each thread has a connection of its
        own: the loop of the edge reads, too."""
        here = threading.get_ident()
        if here not in self._memories and self._is_expected:
            from pico.runs.journal import Journal

            self._memories[here] = Journal(self.path, self._clock, looking=True)
        return self._memories.get(here)

    @property
    def _is_expected(self) -> bool:
        """Whether there is a journal, or what lies beside it says that there was one."""
        return self.path.exists() or self.unended() is not None or ChangeCount(self.path).least() > 0

    @property
    def _mark(self) -> Path:
        return RUN_MARK.path(self._place.folder)

    def unended(self) -> str | None:
        """Return the run that has begun and not ended, None for none; its id stands beside the journal meanwhile."""
        with suppress(OSError, UnicodeError):
            return read_text(self._mark, "ascii").strip() or None
        return None

    def begun(self, run: str) -> None:
        """Write beside the journal that a run has begun, which the journal has."""
        RUN_MARK.put(self._mark, f"{run}\n".encode(), durable=False)

    def end(self, run: str, outcome: RunOutcome, tally: Mapping[str, Any]) -> None:
        """Write down how a run ended; raises PicoError."""
        self.journal.end_run(run, outcome, tally)
        with suppress(OSError):
            self._mark.unlink(missing_ok=True)

    def close(self) -> None:
        """Let go of the journal."""
        if self._journal is not None:
            self._journal.close()
            self._journal = None
        while self._memories:
            self._memories.popitem()[1].close()
