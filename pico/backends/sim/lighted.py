"""The light on the simulated table as it truly is: where parts really stand, with what the world does by itself."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from pico.backends.measured import Reading
from pico.backends.sim.cameras import lamps
from pico.backends.sim.readings import Table
from pico.backends.sim.world import WorldBody
from pico.geometry.seat import Seat
from pico.model.measurement import Condition
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.optics.unseen import SEEN, Unseen

_COUNTS = 1e-3
"""The share of the light on a detector from which that counts to which it is blind."""

if TYPE_CHECKING:
    from pico.optics.light import Arrival, Light


def detects(setup: Setup, component: str, measurable: str, what: str) -> bool:
    """Return whether a measurable of that name belongs to a detector of the inventory."""
    inside = component in setup.lab.inventory and measurable == what
    return inside and setup.type_of(component).optics.element == "detector"


def alone(arrivals: tuple[Arrival, ...]) -> str:
    """Return why nobody can say what an instrument makes of beams that interfere before it; empty where none do."""
    sources = [a.beam.source for a in arrivals]
    twice = next((source for source in sources if sources.count(source) > 1), "")
    return f"several beams of {twice} come there at once, and how they interfere in it is not modelled" if twice else ""


def uncertain(light: Light, component: str) -> Reading | None:
    """Return the reading of a detector to which light may come that was not followed to its end; None for any other."""
    why = light.unfollowed(component)
    return Reading(None, unknown=why, reason="cut-trace") if why else None


def sightless(light: Light, component: str) -> Reading | None:
    """Return the reading of a detector that is blind to light which comes to it; None for any other."""
    from pico.model.materials.ranges import sees_nothing

    arrivals, part = light.at(component), light.parts[component]
    total = sum(a.power for a in arrivals)
    for one in arrivals:
        if one.power > _COUNTS * total and (why := sees_nothing(part.kind, one.wavelength)):
            return Reading(
                None, unknown=f"{component} is blind to the light of {one.beam.source}: {why}", reason="wavelength"
            )
    return None


def unset(light: Light, component: str) -> Mapping[Condition, str]:
    """Return what is assured of the wavelength that a meter is set to: why it is not, with the factor; none of a
    detector that is not told one, or without light."""
    part, arrivals = light.parts[component], light.at(component)
    if "wavelength" not in part.kind.tunables or not arrivals:
        return {}
    from pico.optics.instruments import relative

    found = {a.wavelength: relative(part, a.wavelength) for a in arrivals}
    set_to = part.value("wavelength", "nm", next(iter(found)))
    wrong = [(of, by) for of, by in found.items() if abs(of - set_to) > part.kind.tunables["wavelength"].tolerance]
    said = [f"{component} is set to {set_to:g} nm, and the light has {of:g} nm: multiply by about {1 / by:.3g}"
            for of, by in wrong if by > 0]  # fmt: skip
    return {"wavelength": "; ".join(said)}


def light_on(table: Table) -> Light:
    """Return the light on the table now."""
    from pico.optics.light import light_of

    standing = _standing(table)
    unseen = {name: found for name, body in standing.items() if (found := unseen_of(table.setup, name, body))}
    return light_of(table.setup, *standing_on(table), unseen=unseen)


def standing_on(table: Table) -> tuple[dict[str, Pose], dict[str, Mapping[str, Any]]]:
    """Return where parts stand now and what they are truly set to, with what the world does to them."""
    from pico.optics.environment import in_the_world

    standing = _standing(table)
    poses = {n: b.pose for n, b in standing.items() if b.pose is not None}
    values = {n: b.true_values for n, b in standing.items()}
    return in_the_world(table.setup, poses, values, table.world.seed, table.world.clock)


def _standing(table: Table) -> dict[str, WorldBody]:
    parts = table.world.components.items()
    return {n: b for n, b in parts if n in table.setup.lab.inventory and b.presence == "seen"}


def unseen_of(setup: Setup, name: str, body: WorldBody) -> Unseen | None:
    """Return what no camera sees of a component, with how it sits and how far physics left it off the plane; None where
    it is as it is seen."""
    own, seat = body.unseen or SEEN, body.seat or Seat()
    if body.free is not None:
        w, x, y, z = body.free.quaternion
        pitch = math.degrees(math.asin(max(-1.0, min(1.0, 2 * (w * y - x * z)))))
        roll = math.degrees(math.atan2(2 * (y * z + w * x), 1 - 2 * (x * x + y * y)))
        seat = Seat(pitch=seat.pitch + pitch, roll=seat.roll + roll, height=seat.height + body.free.position[2])
    found = own if seat.level else own.sitting(seat, setup.type_of(name).frames.optical)
    return None if found == SEEN else found


def room_light(table: Table) -> float:
    """Return the light of the room's lamps on a bare sensor [nW/mm2]: of those that are on."""
    lit = (name for name, on in lamps(table.setup, table.world).items() if on)
    return sum(table.setup.type_of(name).number("stray_irradiance", "nW/mm^2") or 0.0 for name in lit)
