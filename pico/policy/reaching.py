"""Which components the beam of a laser reaches, for rules and expectations: as the bench is observed."""

from __future__ import annotations

from collections.abc import Callable

from pico.model.observation import Observation
from pico.model.setup import Setup
from pico.optics.axis import axis_of


def reaching(setup: Setup, seen: Observation) -> Callable[[str, str], bool]:
    """Return `reaches(laser, component)`: whether the laser's beam would come to a component, its shutters open.

    Only what is seen stands in the way; tip and tilt of mirrors are those read back. The function raises ValueError, in
    words, for what is no laser or is not there, and where it is not seen.
    """
    poses = {
        n: c.pose for n, c in seen.components.items() if c.pose and c.presence == "seen" and n in setup.lab.inventory
    }

    values = seen.known_values

    def reaches(laser: str, component: str) -> bool:
        for name in (laser, component):
            if name not in setup.lab.inventory:
                raise ValueError(f"there is no component `{name}`")
            if name not in poses:
                raise ValueError(
                    f"{name} is {seen.components[name].presence if name in seen.components else 'missing'}"
                )
        if setup.type_of(laser).optics.element != "source":
            raise ValueError(f"{laser} is no source of light")
        return axis_of(setup, poses, laser, values).reaches(component)

    return reaches
