"""Bolted parts that the lab has where another one is: nobody moves them, so that no plan comes upon it."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

from pico.diagnostics import Diagnostic, warning
from pico.model.setup import Setup
from pico.planning.checks.contacts import bases
from pico.planning.checks.target import Source, no_source


def check_bolted(setup: Setup, source: Source = no_source) -> Iterator[Diagnostic]:
    """Yield a warning for each two bolted parts whose footprints overlap; such that only stand close are well."""
    fixed = sorted((name, part.pose) for name, part in setup.lab.inventory.items() if part.pose)
    for (a, at), (b, other) in combinations(fixed, 2):
        found = bases(setup, a, at, b, other)
        if found and found.overlap > 0:
            yield warning(
                "overlap", f"{a} is bolted at {at} and {b} at {other}: {found.text}", address=f"{b}.pose",
                hint="one of the poses is wrong, or a footprint is larger than the part", source=source(f"{b}.pose.x"),
            )  # fmt: skip
