"""Sizes of several causes bettered by the whole ray model from far away: after Levenberg and Marquardt, with a dark
reading taken as the bound that it is, and with residuals beyond FAR standard deviations squeezed to their logarithm.

A reading that ends at its noise only tells that there is no more light than that. So it counts only if the model gives
more, and the model is asked for the light below the noise, too, as the way back from the dark leads over it. Squeezed
residuals have more minima: a descent may end where some readings are met exactly and others are not.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np

from pico.diagnosis.explanations import Changed, Explanation, bound_odds, evaluate, trace_slopes
from pico.diagnosis.modelled import Modelled
from pico.diagnosis.weighing import prior_at

FAR = 5.0
"""Standard deviations from which a residual counts by its logarithm."""
DEEPEST = -40.0
"""The logarithm of the least share of light that is told from none."""
BY_NOISE = 3.0
"""Standard deviations of a reading from its bound up to which it is dark."""
ROUNDS, TRIES = 10, 5
GAIN = 0.05
"""By how much the sum of squares must shrink for another round."""


def refine(what: Changed, model: Modelled, one: Explanation) -> Explanation:
    """Return an explanation by the whole model at the sizes that a descent from its own leads to."""
    return Descent(what, model, one).end()


def residuals(what: Changed, lowest: Any, whole: Any, noise: Any) -> Any:
    """Return by how many standard deviations `noise` (n,) changes (..., n) differ from what changed, those of a dark
    reading only by how much brighter they are than its bound, the `lowest` (n,) change that it can show."""
    low = np.where(np.isfinite(lowest), lowest, 0.0)
    dark = np.isfinite(lowest) & (what.d < low + BY_NOISE * noise)
    return np.where(dark, np.maximum(0.0, whole - low), whole - what.d) / noise


def squeezed(off: Any) -> Any:
    """Return residuals of which those beyond FAR grow as their logarithm does."""
    size = np.maximum(np.abs(off), 1e-12)
    return np.where(size > FAR, np.sign(off) * FAR * (1 + np.log(size / FAR)), off)


class Descent:
    """The way of the sizes of an explanation's causes down to what they explain best."""

    def __init__(self, what: Changed, model: Modelled, one: Explanation) -> None:
        self._what, self._model, self._one = what, model, one
        self._responses = [what.responses[n] for n in one.numbers]
        self._ways = [way for r in self._responses for way in r.cause.ways]
        self._ends = np.cumsum([0, *(len(r.cause.ways) for r in self._responses)])
        self._noise = np.sqrt(np.diagonal(what.usual) + (what.exact * what.d) ** 2)
        self._unit = np.array([way.fault for way in self._ways])

    def end(self) -> Explanation:
        """Return the explanation at the end of the way."""
        size = np.concatenate([f.size for f in self._one.found]) if self._ways else np.zeros(0)
        if len(self._ways):
            size = self._descended(size)
        there = evaluate(self._what, self._model, self._one, self._split(size))
        return bound_odds(self._what, trace_slopes(self._what, self._model, there))

    def _descended(self, size: Any) -> Any:
        """Return the sizes (k,) at the end, from some."""
        off, damping, slope = self._off(size), 1e-2, None
        for _ in range(ROUNDS):
            fresh = slope is None
            slope = self._slope(size, off) if slope is None else slope
            square = slope.T @ slope
            for _ in range(TRIES):
                step = -np.linalg.solve(square + damping * np.diag(np.diagonal(square) + 1e-3), slope.T @ off)
                there = self._inside(size + step * self._unit)
                now = self._off(there)
                if now @ now < off @ off:
                    break
                damping = max(1e-2, 8 * damping)
            else:
                if fresh:
                    break
                slope, damping = None, 1e-2
                continue
            gain, share = off @ off - now @ now, (there - size) / self._unit
            if share @ share > 0:  # after Broyden; traced anew if the step gained little
                slope = slope + np.outer(now - off - slope @ share, share) / (share @ share)
            if gain < 0.3 * (off @ off):
                slope = None
            size, off, damping = there, now, damping / 8
            if gain < GAIN:
                break
        return size

    def _split(self, size: Any) -> list[Any]:
        return [size[a:b] for a, b in pairwise(self._ends)]

    def _inside(self, size: Any) -> Any:
        least = np.array([0.0 if way.one_sided else -np.inf for way in self._ways])
        return np.maximum(size, least)

    def _whole(self, size: Any) -> Any:
        """Return what the causes do together (n,), light below the noise of instruments told, too."""
        steps = [s for r, own in zip(self._responses, self._split(size), strict=True) for s in r.steps(own)]
        whole = self._model.read(steps) - self._model.base
        light = np.isfinite(self._model.lowest)
        whole = np.where(light, np.maximum(np.where(np.isnan(whole), DEEPEST, whole), DEEPEST), whole)
        return np.minimum(np.where(np.isfinite(whole), whole, 0.0), self._stopped())

    def _stopped(self) -> Any:
        """Return the changes (n,) that causes without a size make: no light where they stop it."""
        none = np.zeros(len(self._what.d))
        stops = [np.where(r.moved[0] < 0, DEEPEST, np.inf) for r in self._responses if not r.cause.ways]
        return np.min(stops, axis=0) if stops else none + np.inf

    def _off(self, size: Any) -> Any:
        own = residuals(self._what, self._model.lowest, self._whole(size), self._noise)
        prior = np.concatenate([prior_at(r.cause, z) for r, z in zip(self._responses, self._split(size), strict=True)])
        return np.concatenate([squeezed(own), size / prior])

    def _slope(self, size: Any, off: Any) -> Any:
        """Return the derivatives (n + k, k) of residuals by sizes, in units of a usual fault."""
        columns: list[Any] = []
        for n, way in enumerate(self._ways):
            by = way.step / 2 * (1.0 if size[n] >= 0 else -1.0)
            columns.append((self._off(size + by * np.eye(len(size))[n]) - off) / by * self._unit[n])
        return np.stack(columns, axis=1)
