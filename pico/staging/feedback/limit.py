"""How much work a search may do: counted, never timed."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Limit:
    """How much work is allowed: integer programs solved and their branch-and-bound nodes. Counts, not seconds, so that
    the same problem always gets the same answer."""

    solves: int = 200
    nodes: int = 1_000

    def work(self) -> WorkLeft:
        """Return a fresh account of the programs and nodes allowed."""
        return WorkLeft(self.solves, self.nodes)


@dataclass(slots=True)
class WorkLeft:
    """What is left of the work allowed: programs solved and branch-and-bound nodes, never seconds, so that the same
    problem always gets the same answer."""

    solves: int
    nodes: int

    @property
    def spent(self) -> bool:
        return self.solves <= 0 or self.nodes <= 0
