"""The noise of a camera's sensor: photo-electrons as they are counted, and what pixels read that have caught none.

Numbers are looked up where they can be: one distribution after the other is too slow for frames of millions of pixels.
Nothing is lost by that: where a look-up is too coarse to tell, the number is sought in the distribution itself, and
electrons between the means that are looked up are strewn one by one.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache, lru_cache

import numpy as np
from numpy.typing import NDArray

Electrons = NDArray[np.float32]

NORMAL = 40.0
"""From this mean on, Poisson counts are drawn as x^2 - 1/8, x normal about sqrt(mean - 1/8) with variance 1/4: mean and
variance are exact (Anscombe's transform turned round), and the skewness is half as much again as Poisson's."""
STEP = 1 / 8
"""Means below `NORMAL` are looked up in steps of so many electrons."""
_SHARED = 65535


@dataclass(frozen=True, eq=False)
class Lookup:
    """Distributions of whole numbers. `numbers` (kinds * size): each is cut into `size` cells of equal probability, a
    power of 2 up to 65536, and each cell has its number, or `_SHARED` where that may be one of several; these are
    sought in `cumulated` (kinds, width): the probabilities of at most `first`, `first` + 1, ..."""

    numbers: NDArray[np.uint16]
    cumulated: NDArray[np.float64]
    size: int
    first: int

    def draw(self, kinds: NDArray[np.intp] | int, count: int, draw: np.random.Generator) -> NDArray[np.uint16]:
        """Return `count` numbers, each of its kind."""
        bits = draw.bit_generator.random_raw(-(-count // 4)).view(np.uint16)[:count]
        cells = np.add(bits >> (17 - self.size.bit_length()), np.multiply(kinds, self.size), dtype=np.intp)
        found: NDArray[np.uint16] = self.numbers.take(cells)
        shared = np.flatnonzero(found == _SHARED)
        kind, cell = np.divmod(cells[shared], self.size)
        below = (cell + draw.random(len(shared))) / self.size
        found[shared] = self.first + (self.cumulated[kind] <= below[:, None]).sum(axis=1)
        return found


def lookup(cumulated: NDArray[np.float64], size: int, first: int = 0) -> Lookup:
    """Return what draws from the distributions with these probabilities (kinds, width) of at most `first`, `first` + 1,
    ..., the last of them 1."""
    kinds = len(cumulated)
    cell = np.minimum(cumulated * size, size - 1).astype(np.intp) + size * np.arange(kinds)[:, None]
    within = np.bincount(cell.ravel(), minlength=kinds * size).reshape(kinds, size)
    below = first + within.cumsum(axis=1) - within
    return Lookup(np.where(within, _SHARED, below).astype(np.uint16).ravel(), cumulated, size, first)


@cache
def _poisson() -> Lookup:
    """Return Poisson's distributions of the means 0, `STEP`, 2 `STEP`, ... below `NORMAL`."""
    mean, number = np.arange(0, NORMAL, STEP)[:, None], np.arange(128)
    log = np.array([math.lgamma(n + 1) for n in number])
    chance = np.exp(number * np.log(np.maximum(mean, 1e-300)) - mean - log)
    cumulated = np.minimum(chance.cumsum(axis=1), 1.0)
    cumulated[:, -1] = 1.0
    return lookup(cumulated, 4096)


@lru_cache(maxsize=16)
def unlit(noise: float, black: float, full_scale: int) -> Lookup:
    """Return the counts of a pixel without electrons: `black`, with read `noise` of one standard deviation [counts]."""
    reach = 9 * noise + 1
    first, last = (round(min(max(black + away, 0), full_scale)) for away in (-reach, reach))
    up_to = (np.arange(first, last + 1) + 0.5 - black) / max(noise, 1e-9) / math.sqrt(2)
    cumulated = np.array([[(1 + math.erf(x)) / 2 for x in up_to]])
    cumulated[:, -1] = 1.0
    return lookup(cumulated, 65536, first)


def shot(mean: Electrons, draw: np.random.Generator) -> Electrons:
    """Return photo-electrons drawn for their mean, of any shape; Poisson: exactly where they are few, see `NORMAL`."""
    flat = mean.ravel()
    found = np.zeros(flat.shape, dtype=np.float32)
    many, few = np.flatnonzero(flat >= NORMAL), np.flatnonzero((flat >= STEP) & (flat < NORMAL))
    found[many] = _many(flat[many], draw)
    found[few] = _poisson().draw((flat[few] * np.float32(1 / STEP)).astype(np.intp), len(few), draw)
    np.add.at(found, _strewn(flat, draw), np.float32(1))
    return found.reshape(mean.shape)


def _many(mean: Electrons, draw: np.random.Generator) -> Electrons:
    root: Electrons = np.sqrt(mean - np.float32(1 / 8))
    root += np.float32(0.5) * draw.standard_normal(len(mean), dtype=np.float32)
    root *= root
    root -= np.float32(1 / 8)
    return root


def _strewn(mean: Electrons, draw: np.random.Generator) -> NDArray[np.intp]:
    """Return where electrons fall, one for one, of what each mean has above a step that is looked up: as many as would
    fall were it `most` everywhere, of which each stays by its share in that."""
    most = min(STEP, float(mean.max(initial=0.0)))
    at = draw.integers(0, len(mean), draw.poisson(most * len(mean)), dtype=np.uint32).astype(np.intp)
    there = mean[at]
    above = np.where(there < NORMAL, there % np.float32(STEP), np.float32(0))
    return at[draw.random(len(at), dtype=np.float32) * np.float32(most) < above]
