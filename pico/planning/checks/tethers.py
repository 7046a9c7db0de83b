"""Where a state puts a part farther than its cable reaches, or winds the cable too far."""

from __future__ import annotations

from collections.abc import Sequence

from pico.diagnostics import Diagnostic, error
from pico.geometry.tethers import tether_fault
from pico.model.setup import Setup
from pico.planning.checks.target import Source, located, no_source
from pico.planning.parts.movers import Mover


def check_tethers(setup: Setup, movers: Sequence[Mover], source: Source = no_source) -> list[Diagnostic]:
    """Return an error for each mover whose cable keeps it from every place where it would be right."""
    found = []
    for mover in movers:
        faults = [tether_fault(setup, mover.name, mover.places[goal].pose) for goal in mover.goals]
        if faults and all(text for text, _, _ in faults):
            text, _, hint = faults[0]
            where = f"{mover.goal.pose} ({mover.goal.slot})" if mover.goal.slot else str(mover.goal.pose)
            found.append(error(
                "impossible", f"{mover.name} cannot stand at {where}: {text}", hint=hint,
                address=f"{mover.name}.pose", source=located(source, mover),
            ))  # fmt: skip
    return found
