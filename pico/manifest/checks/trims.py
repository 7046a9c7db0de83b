"""Whether a trim takes in what placing a component scatters along its axis: else light cannot be brought back in it."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from functools import partial

from pico.diagnostics import Diagnostic, Severity, SourceRange
from pico.geometry.seat import PlacementError, placed_on, scatter
from pico.manifest.text.places import where
from pico.manifest.text.tree import Document
from pico.model.catalog import ComponentType
from pico.model.setup import Setup

SIGMAS = 3.0
"""How many standard deviations of placement a trim takes in."""


def check_trims(document: Document, kind: ComponentType) -> Iterator[Diagnostic]:
    """Yield the trims of a type that are too narrow. What was written before seats had a pitch is only warned of."""
    severity: Severity = "warning" if kind.repeatability.pitch is None else "error"
    one, places = scatter(kind.repeatability, kind.seating), partial(where, document, "tunables")
    yield from _narrow(kind, kind.name, one, tuple(kind.tunables), lambda t: places(t, "restore", "trim"), severity)


def check_own_trims(document: Document, setup: Setup) -> Iterator[Diagnostic]:
    """Yield the trims that parts of a lab have of their own and that are too narrow."""
    for name, part in setup.lab.inventory.items():
        if part.restore and part.type in setup.catalog:
            kind = setup.type_of(name)
            one = scatter(kind.repeatability, setup.seating_of(name))
            yield from _narrow(kind, name, one, tuple(part.restore), partial(_of_part, document, name), "error")


def _of_part(document: Document, name: str, tunable: str) -> SourceRange:
    return where(document, "inventory", name, "restore", tunable, "trim")


def _narrow(
    kind: ComponentType, name: str, one: PlacementError, tunables: tuple[str, ...],
    places: Callable[[str], SourceRange], severity: Severity,
) -> Iterator[Diagnostic]:  # fmt: skip
    for tunable in tunables:
        restore, unit = kind.tunables[tunable].restore, kind.tunables[tunable].unit
        sigma = placed_on(kind, tunable, one)
        if restore.kind != "align" or restore.trim is None or sigma is None or restore.trim >= SIGMAS * sigma:
            continue
        least = math.ceil(SIGMAS * sigma * 100) / 100
        yield Diagnostic(
            severity, "trim", f"the trim of `{tunable}`, {restore.trim:g} {unit}, is narrower than {name} is placed",
            detail=f"placing it scatters by {sigma:.3g} {unit} that way, one standard deviation",
            hint=f"expected {least:g} {unit} or more, three of them, or a better seating", source=places(tunable),
        )  # fmt: skip
