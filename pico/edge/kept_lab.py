"""The Lab that the bench of one edge goes by: kept from the first time that the bench is taken, changed by adopting."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from pico.diagnostics import Diagnostic, ExitCode, PicoError, error
from pico.edge import own_lab
from pico.edge.lease import user
from pico.edge.protocol import OwnLab
from pico.places.bench import BenchPlace

_FIRST = Diagnostic(
    "note",
    "bench-lab",
    "the bench keeps its own copy of lab.yaml and of your component types from now on",
    hint="later edits of them take effect after `pico bench update`",
)


class KeptLab:
    """What the bench at `place` keeps. `lab`: what the edge was opened with, None on trial, where nothing is
    kept."""

    def __init__(self, place: BenchPlace, lab: OwnLab | None, clock: Callable[[], str]) -> None:
        self.lab = lab
        self._place, self._clock = place, clock
        self._told: tuple[Diagnostic, ...] = ()

    def keep(self, lab: OwnLab, holder: str) -> None:
        """Keep a Lab from now on, by this user, for `holder`; raises PicoError."""
        self.lab = replace(lab, by=f"{user()}: {holder}", at=self._clock())
        own_lab.write(self._place, self.lab)

    def require(self, holder: str) -> None:
        """Let the bench keep the Lab that this edge was opened with, where it keeps none yet; raises PicoError (exit
        code STALE) where it keeps another one by now."""
        if self.lab is None:
            return
        kept = own_lab.read(self._place)
        if kept is None:
            self.keep(self.lab, holder)
            self._told = (_FIRST,)
        elif kept.files != self.lab.files:
            text = "the bench's own Lab was changed since this command read it"
            raise PicoError(error("stale", text, hint="call it again: it plans anew"), ExitCode.STALE)
        elif not own_lab.is_sealed(self._place):  # the lab became a repository since
            own_lab.write(self._place, kept)

    def told(self) -> tuple[Diagnostic, ...]:
        """Return, once, what who takes the bench is told of it."""
        told, self._told = self._told, ()
        return told
