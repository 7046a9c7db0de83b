"""What is needed, here and there; and bringing what lacks from the one to the other."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

from pico.content.store import Store
from pico.diagnostics import Diagnostic, PicoError, error
from pico.history.data.needs import Need, Needs
from pico.history.data.pieces import Heard
from pico.history.data.places import CopyPlace
from pico.model.record import record

Shared = Callable[[float], None]
"""Is told which share of the bytes is through, 0 to 1."""

_ELSEWHERE = "another clone may have an intact copy: `pico data push` there"


@record
class Holdings:
    """What the runs need (`needs`), and which of it is here and there. `place` and `there` are None where no place is
    configured; `spare`: objects here that no run of any ref needs, with their bytes."""

    needs: Needs
    here: frozenset[str]
    place: str | None
    there: frozenset[str] | None
    spare: tuple[tuple[str, int], ...]

    @property
    def unsent(self) -> tuple[Need, ...]:
        """What is here and not there."""
        return tuple(n for n in self.needs.values() if n.sha256 in self.here and n.sha256 not in (self.there or ()))

    @property
    def absent(self) -> tuple[Need, ...]:
        """What is not here."""
        return tuple(n for n in self.needs.values() if n.sha256 not in self.here)

    @property
    def lost(self) -> tuple[Need, ...]:
        """What is neither here nor there, as far as anybody looked."""
        return tuple(n for n in self.absent if n.sha256 not in (self.there or ()))


@record
class Moved:
    """Objects that were copied to or from `place`; what is neither here nor there (`lost`); what went wrong with single
    objects."""

    place: str
    objects: tuple[Need, ...]
    lost: tuple[Need, ...]
    diagnostics: tuple[Diagnostic, ...]


def holdings(store: Store, place: CopyPlace | None, needs: Needs) -> Holdings:
    """Return what is where; raises PicoError where the store or the place can't be read."""
    here = frozenset(store.all())
    return Holdings(
        needs=needs,
        here=frozenset(needs) & here,
        place=place.name if place else None,
        there=place.present(needs) if place else None,
        spare=tuple((name, store.size(name)) for name in sorted(here - set(needs))),
    )


def push(store: Store, place: CopyPlace, needs: Needs, shared: Shared) -> Moved:
    """Copy to `place` what is needed, here and not there. What is damaged here is told, and the others go.

    Raises PicoError where the place can't be written.
    """
    found = holdings(store, place, needs)
    return _move(found, found.unsent, lambda n, heard: place.send(n, store, heard), shared)


def pull(store: Store, place: CopyPlace, needs: Needs, shared: Shared) -> Moved:
    """Copy from `place` what is needed and not here; else as `push`."""
    found = holdings(store, place, needs)
    there = [n for n in found.absent if n.sha256 in (found.there or ())]
    return _move(found, there, lambda n, heard: place.fetch(n, store, heard), shared)


@dataclass
class _Progress:
    total: int
    shared: Shared
    through: int = field(default=0)

    def heard(self, size: int) -> None:
        self.through += size
        self.shared(self.through / max(self.total, 1))


def _move(found: Holdings, wanted: Iterable[Need], copy: Callable[[str, Heard], None], shared: Shared) -> Moved:
    wanted = tuple(wanted)
    progress = _Progress(sum(n.size for n in wanted), shared)
    moved, wrong = [], []
    for need in wanted:
        try:
            copy(need.sha256, progress.heard)
            moved.append(need)
        except PicoError as exc:
            if exc.diagnostics[0].code not in ("data-damaged", "data-missing"):
                raise
            wrong += [error(d.code, d.summary, detail=needed_by(need), hint=_ELSEWHERE) for d in exc.diagnostics]
    return Moved(place=str(found.place), objects=tuple(moved), lost=found.lost, diagnostics=tuple(wrong))


def needed_by(need: Need) -> str:
    """Return `trace.jsonl.gz of run A, run B and 3 others`."""
    runs = ", ".join(need.runs[:2])
    more = f" and {len(need.runs) - 2} others" if len(need.runs) > 2 else ""
    return f"it is {need.name} of {runs}{more}"
