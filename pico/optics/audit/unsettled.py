"""What nobody knows of a bench and light depends on: the audit takes each value that it may have.

What may be flipped into a beam or out of it is taken both ways. A polarizer or wave plate at an angle that nobody knows
is taken at each of `ANGLES`: any port of a splitter behind it then has at some of them at least 0.96 of the light that
it can have. A shutter that nobody knows counts as open, an iris as wide open, a wheel of filters as without one.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping
from dataclasses import replace
from itertools import product
from typing import Any

from pico.model.setup import Setup
from pico.optics.audit.findings import Finding
from pico.optics.axis import Values

ANGLES = tuple(11.25 * step for step in range(16))
"""Of a plate whose angle nobody knows [deg]: half a turn, since a half-wave plate turns polarization twice as far."""
MOST = 128
"""Combinations that are all tried; of more each is tried alone, and all at once."""
_TURNED = ("polarizer", "waveplate")


Taken = Mapping[str, Mapping[str, Any]]
"""What tunables are taken to be that nobody knows, by component."""


def unsettled(setup: Setup, standing: Collection[str], values: Values) -> Iterator[tuple[Values, Taken]]:
    """Yield the tunables of what is standing on the table, and which of them are taken to be so, with each value of
    those that are not known; once, as they are, where all are known."""
    choices = [(n, key, possible) for n in sorted(standing) for key, possible in _unknown(setup, n, values.get(n, {}))]
    count = math.prod(len(possible) for _, _, possible in choices)
    each = [possible for _, _, possible in choices]
    for combination in product(*each) if count <= MOST else _apart(each):
        taken: dict[str, dict[str, Any]] = {}
        for (name, key, _), value in zip(choices, combination, strict=True):
            taken.setdefault(name, {})[key] = value
        yield {**values, **{name: {**values.get(name, {}), **own} for name, own in taken.items()}}, taken


def told_with(finding: Finding, taken: Taken) -> Finding:
    """Return a finding that says what was taken to be so of the parts on its way."""
    passed = [name for name in (*finding.way, finding.component) if name in taken]
    words = [f"nobody knows {n}.{key}: here it is {value}" for n in passed for key, value in taken[n].items()]
    return replace(finding, hint="; ".join([*words, finding.hint])) if words else finding


def _unknown(setup: Setup, name: str, own: Mapping[str, Any]) -> Iterator[tuple[str, tuple[Any, ...]]]:
    """Yield the tunables of a part that nobody knows, with the values that they are taken at."""
    kind = setup.type_of(name)
    flips = kind.tunables.get("flipped")
    if flips is not None and own.get("flipped") not in flips.choices:
        yield "flipped", flips.choices
    angle = own.get("angle")
    known = isinstance(angle, int | float) and not isinstance(angle, bool)
    if kind.optics.element in _TURNED and "angle" in kind.tunables and not known:
        yield "angle", ANGLES


def _apart(taken: list[tuple[Any, ...]]) -> Iterator[tuple[Any, ...]]:
    """Yield combinations in which each value occurs: all the first, each other alone, and all in step."""
    first = tuple(values[0] for values in taken)
    yield first
    for number, values in enumerate(taken):
        yield from ((*first[:number], value, *first[number + 1 :]) for value in values[1:])
    for step in range(1, max(map(len, taken))):
        yield tuple(values[step % len(values)] for values in taken)
