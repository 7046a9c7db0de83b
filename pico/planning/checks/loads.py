"""Parts that are heavier than any arm of the lab carries: told of the files, before any plan. kg."""

from __future__ import annotations

from collections.abc import Iterator

from pico.diagnostics import Diagnostic, error
from pico.manifest.load import Manifests
from pico.model.setup import Setup
from pico.planning.checks.target import Source, no_source

PAYLOAD = "payload"


def check_loads(read: Manifests) -> Iterator[Diagnostic]:
    """Yield an error for each part that an arm is to move and that no arm carries."""
    setup, _ = read.require()
    for name in sorted(setup.lab.inventory):
        if setup.movable(name) and (found := overload(setup, name, read.source)):
            yield found


def overload(setup: Setup, name: str, source: Source = no_source) -> Diagnostic | None:
    """Return an error for a part that is too heavy for each arm of the lab; None if one carries it, or there is no
    arm."""
    mass = setup.type_of(name).geometry.mass
    reasons = {arm: robot.too_heavy(mass) for arm, robot in sorted(setup.lab.robots.items())}
    if not reasons or not all(reasons.values()):
        return None
    hint = f"correct its mass (`inventory: {{{name}: {{mass: ...}}}}`), or have a person move it: `seating: bolted`"
    if any("friction" in why for why in reasons.values()):
        hint += "; or state what your gripper does: `gripper: {force: ..., friction: ...}`"
    return error(
        PAYLOAD, f"{name} weighs {mass:.3g} kg, and no arm of the lab carries that",
        detail="\n".join(f"{arm}: {why}" for arm, why in reasons.items()), hint=hint,
        source=source(f"inventory.{name}"), address=name,
    )  # fmt: skip
