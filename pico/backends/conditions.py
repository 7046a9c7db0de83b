"""What is assured of a measurement: read back when it is taken, whatever a plan did before. For every device."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from pico.model.catalog import Measurable
from pico.model.measurement import Condition
from pico.model.observation import Observation
from pico.model.setup import Setup
from pico.planning.checks.interlocks import CLOSED
from pico.planning.measuring import needed

WANTED: tuple[Condition, ...] = ("shutter", "illumination")
"""What a measurable may need of the bench, and not of its own component: that is a setting."""


def conditions(
    setup: Setup, seen: Observation, component: str, measurable: Measurable, busy: Sequence[str] = ()
) -> Mapping[Condition, str]:
    """Return what counts for a measurable on the bench as it is, each with why it is not assured; empty where it is.

    `busy`: the operations that are under way beside the measurement.
    """
    found: dict[Condition, str] = {"settled": f"{', '.join(busy)} was under way" if busy else ""}
    found["arm parked"] = ", ".join(_standing_out(setup, seen))
    if component in setup.lab.inventory and setup.type_of(component).optics.element == "detector":
        found["in range"] = ", ".join(_out_of_range(setup, seen, component))
    for condition in WANTED:
        if condition in measurable.needs and (condition != "illumination" or _lamps(setup)):
            found[condition] = ", ".join(_unmet(setup, seen, component, measurable, condition))
    return found


def _out_of_range(setup: Setup, seen: Observation, component: str) -> Sequence[str]:
    """Return which parts on the way of light to a detector are not made for its wavelength, in words."""
    from pico.optics.ends import doubts

    parts = seen.components.items()
    poses = {n: p.pose for n, p in parts if p.pose is not None and n in setup.lab.inventory and p.presence == "seen"}
    return doubts(setup, poses, seen.known_values, component) if component in poses else ()


def _without_shutter(setup: Setup, seen: Observation) -> Iterator[str]:
    """Yield the sources that stand on the bench, have no shutter, and are not known to be off."""
    for name in sorted(setup.lab.inventory):
        kind, part = setup.type_of(name), seen.components.get(name)
        if kind.optics.element != "source" or "shutter" in kind.tunables or part is None or part.presence == "missing":
            continue
        if seen.known_values.get(name, {}).get("emission") is not False:
            yield f"{name} has no shutter and is not known to be off"


def _lamps(setup: Setup) -> bool:
    """Return whether anything lights the room that could be switched: what nobody can switch is as it is."""
    return any("illumination" in setup.type_of(name).tunables for name in setup.lab.inventory)


def _standing_out(setup: Setup, seen: Observation) -> Iterator[str]:
    for name, robot in sorted(seen.robots.items()):
        if robot.holding:
            yield f"{name} holds {robot.holding}"
        elif name in setup.lab.robots and not setup.lab.robots[name].is_parked(robot.joints):
            yield f"{name} is not at its park pose"


def _unmet(
    setup: Setup, seen: Observation, component: str, measurable: Measurable, condition: Condition
) -> Iterator[str]:
    wants = [need for need in needed(setup, seen, component, measurable) if need.tunable == condition]
    if not wants:
        yield f"no part of this bench has `{condition}`"
    if condition == "shutter" and measurable.needs[condition] == CLOSED:
        yield from _without_shutter(setup, seen)
    for need in wants:
        if need.live is None:
            yield f"nobody knows {need.address}"
        elif need.live != need.value:
            yield f"{need.address} is {need.live}, not {need.value}"
