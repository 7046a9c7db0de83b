"""What is proven of a refusal: the constraints that no order keeps, or why nobody knows them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import reduce
from itertools import chain
from operator import and_

from pico.model.plan import Blocking
from pico.model.setup import Setup
from pico.motion.types import Motion
from pico.planning.explaining.certificate import Certificate, certified
from pico.planning.ordering.conflicts import Conflicts, sum_of
from pico.planning.ordering.solve import PATH_ROUNDS, Refusal
from pico.planning.parts.movers import Mover, Obstacle


@dataclass(frozen=True, slots=True)
class Proof:
    """What is enough to make a refused problem impossible where what is right stays (`own`), and where most of it may
    be moved aside (`widest`; None where nothing could be). `ended`: the limit that ends a search without proof."""

    own: Certificate
    widest: Certificate | None
    ended: str

    @property
    def blocking(self) -> tuple[Blocking, ...] | None:
        """The constraints that no order keeps."""
        return (self.widest.blocking if self.widest else None) or self.own.blocking

    @property
    def doubt(self) -> str:
        """What is not proven of a refusal, and why; empty where all of it is."""
        if not self.own.proven:
            return f"this is no proof that there is no order: the search ended at its limit of {self.ended}"
        if self.blocking is None:
            return "there is no order, but which constraints are enough was not found within the limit of the search"
        if self.widest and not self.widest.proven:
            return "whether there is one that moves aside what is right was not found within the limit of the search"
        return ""


def proof(refused: Refusal) -> Proof:
    """Return what proves a refusal, as far as that is proven within the limit of the search."""
    ended = "storage slots" if refused.table.more_slots else "configurations"
    ended = f"{PATH_ROUNDS} blocked paths" if refused.paths_ended else ended
    return Proof(_certified(refused), _certified(refused.widest) if refused.widest else None, ended)


def _certified(refused: Refusal) -> Certificate:
    found = certified(refused.table, refused.core or (() if refused.proven else stuck_of(refused)))
    if refused.table.more_slots and (found.blocking is None or any(c.kind == "storage" for c in found.blocking)):
        return Certificate(False)  # nobody looked at all the slots
    return replace(found, proven=found.proven or refused.proven)


def standing_proof(
    setup: Setup, movers: Sequence[Mover], obstacles: Sequence[Obstacle], motion: Motion | None
) -> tuple[Blocking, ...] | None:
    """Return which constraints keep movers from standing at their goals, where a state can't be: one or two of them."""
    table = Conflicts(setup, movers, obstacles, motion, on_table=False)
    alone = ((i,) for i, m in enumerate(movers) if not any(table.ways(i, 0, g) for g in m.goals))
    found = (certified(table, who) for who in chain(alone, _apart(table)))
    return next((c.blocking for c in found if c.blocking), None)


def _apart(table: Conflicts) -> Iterator[tuple[int, int]]:
    """Yield the pairs of movers that can't both stand at their goals."""
    goals = [sum_of(table.bit(i, g) for g in m.goals) for i, m in enumerate(table.movers)]
    for i, mover in enumerate(table.movers):
        common = reduce(and_, (table.near_body(i, g) for g in mover.goals))
        yield from ((i, j) for j in sorted({j for j, _ in table.at(common)}) if j > i and not goals[j] & ~common)


def stuck_of(refused: Refusal) -> list[int]:
    """Return the movers that are proven not to get home together, or those that the search did not bring home."""
    movers = refused.table.movers
    return list(refused.core) or [i for i, m in enumerate(movers) if refused.closest[i] not in m.finished]
