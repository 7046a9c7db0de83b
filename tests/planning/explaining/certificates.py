"""Whether a certificate is one: its constraints alone make a lab impossible, without any one of them it is possible.

Knows the rules of the independent checker and what a constraint means, nothing of the planner: all orders are looked
at, with nobody on the table but those that it names and what stays.
"""

from __future__ import annotations

import heapq
from collections.abc import Collection, Iterator

from brute_labs import Lab, Undecided
from random_labs import Case

from pico.model.plan import Blocking

LIMIT = 300_000
Places = tuple[int, ...]


class Eased:
    """A lab in which `who` move, `still` stay, nobody else is, and only some constraints count. The last place of each
    is in the air, for those that need no storage."""

    def __init__(self, lab: Lab, who: tuple[int, ...], still: tuple[int, ...], kept: Collection[Blocking]) -> None:
        self.lab, self.who, self.still, self.kept = lab, who, still, kept
        self.there = sum(lab.bit(i, 0) for i in still)
        self.air = {i: len(lab.spots[i]) for i in who}

    def has(self, kind: str, i: int, j: int | None = None) -> bool:
        names = self.lab.names
        return any(c.kind == kind and c.of == names[i] and c.by == ("" if j is None else names[j]) for c in self.kept)

    def owner(self, bit: int) -> int:
        n = bit.bit_length() - 1
        return max(j for j, first in enumerate(self.lab._first) if first <= n)

    def counted(self, mask: int, i: int, taken: int, kind: str, p: int) -> bool:
        """Whether something that is there keeps `i` from `p` by a constraint that counts."""
        stored = p and p not in self.lab.goals[i]
        hit = mask & (taken | self.there)
        while hit:
            low = hit & -hit
            hit ^= low
            j = self.owner(low)
            if low & self.there:
                if stored or (self.has("stays", i) if kind == "bodies" else self.has("fingers", i, j)):
                    return True
            elif self.has(kind, i, j) or (kind == "bodies" and self.has(kind, j, i)):
                return True
        return False

    def stands(self, i: int, p: int, taken: int) -> bool:
        if p == self.air[i]:
            return not self.has("storage", i)
        mask = self.lab.stand(i, p)
        if mask is None and (p not in self.lab.goals[i] or self.has("stays", i)):
            return False
        return not self.counted(self.lab.around(i, p), i, taken, "bodies", p)

    def moves(self, state: Places) -> Iterator[tuple[int, int]]:
        lab = self.lab
        taken = sum(lab.bit(i, p) for i, p in zip(self.who, state, strict=True) if p != self.air[i])
        for n, i in enumerate(self.who):
            if not lab.by_arm[i] and state[n] in lab.goals[i]:
                continue
            held = range(len(lab.holds(i, 0)))
            now = self.free(i, state[n], taken)
            for p in range(1, self.air[i] + 1):
                if p != state[n] and self.stands(i, p, taken):
                    then = self.free(i, p, taken)
                    if any(now[k] and then[k] and self.goes(n, k, state, p) for k in held):
                        yield n, p

    def goes(self, n: int, hold: int, state: Places, p: int) -> bool:
        """Whether a component gets to a spot in a hold, where its path counts, and everybody is home then only if the
        arm can park after it. Raises Undecided after many questions."""
        i = self.who[n]
        if not self.lab.paths or not self.has("path", i) or self.air[i] in (p, state[n]) or not self.lab.by_arm[i]:
            return True
        there = {j: q for j, q in zip(self.who, state, strict=True) if q != self.air[j]} | dict.fromkeys(self.still, 0)
        parks = not self.left((*state[:n], p, *state[n + 1 :]))
        return self.lab.goes(i, there, p, hold, parks)

    def free(self, i: int, p: int, taken: int) -> list[bool]:
        """Return for each hold whether the fingers have room."""
        if p == self.air[i]:
            return [True] * len(self.lab.holds(i, 0))
        far = self.has("reach", i) or (p and p not in self.lab.goals[i])
        return [
            not (far and hold == -1) and not self.counted(mask, i, taken, "fingers", p)
            for hold, mask in zip(self.lab.holds(i, p), self.lab.rooms(i, p), strict=True)
        ]  # fmt: skip

    def possible(self) -> bool:
        """Whether all get home. Raises Undecided."""
        start: Places = (0,) * len(self.who)
        seen, heap = {start}, [(self.left(start), start)]
        while heap:
            left, state = heapq.heappop(heap)
            if not left:
                return True
            for n, p in self.moves(state):
                after = (*state[:n], p, *state[n + 1 :])
                if after not in seen:
                    seen.add(after)
                    heapq.heappush(heap, (self.left(after), after))
            if len(seen) > LIMIT:
                raise Undecided
        return False

    def left(self, state: Places) -> int:
        return sum(p not in self.lab.goals[i] for i, p in zip(self.who, state, strict=True))


def faults(of: Case | Lab, blocking: Collection[Blocking]) -> list[str]:
    """Return what is wrong with a certificate: nothing where it holds for what is right moved aside, or kept."""
    lab = of if isinstance(of, Lab) else Lab(of)
    found: list[str] = []
    for asides in (True, False):
        still = tuple(i for i in range(len(lab.names)) if lab.right(i) and not (asides and _may_make_room(lab, i)))
        found = _faults(lab, still, blocking)
        if not found:
            break
    return found


def _may_make_room(lab: Lab, i: int) -> bool:
    return lab.by_arm[i] and lab.setup.lab.inventory[lab.names[i]].stage != "never"


def _faults(lab: Lab, still: tuple[int, ...], blocking: Collection[Blocking]) -> list[str]:
    named = {name for c in blocking for name in (c.of, c.by)}
    who = tuple(i for i, name in enumerate(lab.names) if name in named and i not in still)
    if Eased(lab, who, still, blocking).possible():
        return ["these constraints do not make it impossible"]
    return [
        f"it is impossible without {c.kind} {c.of} {c.by}, too" for c in blocking
        if not Eased(lab, who, still, [k for k in blocking if k != c]).possible()
    ]  # fmt: skip
