"""The exact search put to work on one stretch of a long order after the other."""

from __future__ import annotations

from collections import abc

from pico.staging.sequencing.problem import Tour

LENGTH, STEP = 20, 7
"""Operations in a stretch, and how far the next one begins behind it."""
STEPS = 3_000_000
"""Additions spent on one stretch."""


def rearranged(tour: Tour, order: abc.Sequence[int], sweeps: int) -> tuple[int, ...]:
    """Return `order`, which must keep the precedence, with each stretch in its cheapest order, as far as the
    search for it ends; never dearer. It is gone through so many times, while it becomes cheaper."""
    line = [tour.count, *order, tour.count]
    length = min(LENGTH, tour.count)
    known: dict[tuple[int, ...], list[int]] = {}
    for _ in range(sweeps):
        before = tuple(line)
        for first in [*range(1, tour.count - length + 1, STEP), tour.count - length + 1]:
            at = slice(first - 1, first + length + 1)
            if tuple(line[at]) not in known:
                inner = _cheaper(tour, line, first, first + length)
                known[tuple(line[at])] = known[line[first - 1], *inner, line[first + length]] = inner
            line[first : first + length] = known[tuple(line[at])]
        if tuple(line) == before:
            break
    return tuple(line[1:-1])


def _cheaper(tour: Tour, line: abc.Sequence[int], first: int, last: int) -> list[int]:
    from pico.staging.sequencing.exact import improved

    inner = stretch(tour, line, first, last)
    _, order = improved(inner, tuple(range(inner.count)), STEPS)
    return [line[first + k] for k in order]


def stretch(tour: Tour, line: abc.Sequence[int], first: int, last: int) -> Tour:
    """Return the problem of ordering only what is at places `first` to `last` - 1 of a line, between its neighbors."""
    inside = line[first:last]

    def mask(outer: int) -> int:
        return sum(1 << n for n, k in enumerate(inside) if outer >> k & 1)

    rows = [(*(tour.arcs[i][j] for j in inside), tour.arcs[i][line[last]]) for i in inside]
    start = (*(tour.arcs[line[first - 1]][j] for j in inside), 0.0)
    before, after = (tuple(mask(masks[k]) for k in inside) for masks in (tour.before, tour.after))
    return Tour((*rows, start), before, after)
