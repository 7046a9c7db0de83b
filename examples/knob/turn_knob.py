"""A primitive of a lab's own: an arm takes the key, lowers it onto the knob of a mount, turns it, and puts it back."""

from __future__ import annotations

from pico.model.observation import Observation
from pico.model.operation import Operation
from pico.model.primitive import Primitive
from pico.model.setup import Setup
from pico.motion.types import Waypoint
from pico.planning.routines import Routine

KEY, ABOVE = "knob_key", 136.0
"""The part that is the tool; how far above the table its foot is while its socket is on the knob [mm]."""
AWAY = f"distance(it, {KEY}) > 70"

TURN_KNOB = Primitive(
    name="turn_knob", by="arm", changes="anything", arguments={"by": "deg"}, seconds=30.0,
    counted=("turn of a knob", "turns of knobs"), requires=(AWAY, "abs(args.by) <= 300"), ensures=(AWAY,),
)  # fmt: skip


def routine(setup: Setup, seen: Observation, operation: Operation) -> Routine:
    """Return what the arm does. Nobody reads the knob: it is as far around as it was told, since it was new."""
    mount, by = seen.components[operation.component], float(operation.arguments["by"])
    assert mount.pose is not None  # it is seen, or nothing would be asked of it
    before = mount.values.get("knob")
    turned = float(before.value) if before is not None and isinstance(before.value, int | float) else 0.0
    return Routine(tool=KEY, points=(Waypoint(mount.pose, ABOVE, by),), commands={"knob": turned + by})
