"""Processes that die at any point and a network that loses, doubles, delays and cuts, in virtual time."""

from __future__ import annotations

import heapq
import random
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any


class Violation(Exception):
    """An invariant does not hold."""


class Crash(BaseException):
    """The process is dead."""


@dataclass
class Sim:
    """The clock, what is to happen, and the dice."""

    random: random.Random
    now: float = 0.0
    healed: bool = False
    crashes: int = 0
    cuts: int = 0
    points: int = 0
    left: int = 0
    """Points until somebody crashes, 0 for nobody."""
    _heap: list[tuple[float, int, Callable[[], None]]] = field(default_factory=list)
    _count: int = 0

    def after(self, seconds: float, what: Callable[[], None]) -> None:
        self._count += 1
        heapq.heappush(self._heap, (self.now + seconds, self._count, what))

    def run(self, until: float, over: Callable[[], bool]) -> None:
        while self._heap and self._heap[0][0] <= until and not over():
            self.now, _, what = heapq.heappop(self._heap)
            what()

    def chance(self, rate: float) -> bool:
        return not self.healed and self.random.random() < rate

    def point(self) -> None:
        """A place between two steps at which a process may die."""
        self.points += 1
        if self.left:
            self.left -= 1
            if not self.left and not self.healed:
                self.crashes += 1
                raise Crash


@dataclass
class Network:
    """Links by the names of their ends."""

    sim: Sim
    cut: dict[frozenset[str], float] = field(default_factory=dict)

    def send(self, a: str, b: str, deliver: Callable[[], None]) -> None:
        sim, draw = self.sim, self.sim.random
        if not sim.healed and (self.cut.get(frozenset((a, b)), 0.0) > sim.now or draw.random() < 0.05):
            return
        for _ in range(2 if sim.chance(0.05) else 1):
            late = draw.uniform(0, 14) if sim.chance(0.04) else draw.uniform(0.001, 0.02)
            sim.after(late, deliver)


@dataclass
class Process:
    """Something that can die, and comes back after a while without what it had in memory."""

    sim: Sim
    name: str
    net: Network
    life: int = 0
    down: bool = False

    def guarded(self, what: Callable[..., None], *given: Any) -> Callable[[], None]:
        """Return a call for this life of the process alone."""
        life = self.life

        def call() -> None:
            if self.down or life != self.life:
                return
            try:
                what(*given)
            except Crash:
                self.die()

        return call

    def arriving(self, what: Callable[..., None], *given: Any) -> Callable[[], None]:
        """Return a call that reaches whoever lives under that name when it comes."""

        def call() -> None:
            if not self.down:
                self.guarded(what, *given)()

        return call

    def die(self) -> None:
        self.down = True
        self.life += 1
        self.sim.after(self.sim.random.choice((0.2, 2.0, 12.0)), self._rise)

    def _rise(self) -> None:
        self.down = False
        self.guarded(self.begin)()

    def begin(self) -> None:
        raise NotImplementedError

    def every(self, seconds: float, what: Callable[[], None]) -> None:
        def again() -> None:
            what()
            self.sim.after(seconds, self.guarded(again))

        self.guarded(again)()
