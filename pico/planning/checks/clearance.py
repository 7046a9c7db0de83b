"""Whether beams stay clear of what a plan moves: what it would put into a beam, or a beam onto."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from pico.diagnostics import Diagnostic
from pico.model.diff import Change
from pico.model.observation import Observation
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.model.state import LabState, place_of

_OWN = {"beam", "clipped"}  # what `pico.optics.beam_table` tells of where beams go; not how strong they are


def beams_in_the_way(
    setup: Setup, seen: Observation, wanted: LabState, changes: Sequence[Change]
) -> tuple[Diagnostic, ...]:
    """Return a warning for each beam that would end on a housing, leave the table, come back to its laser or be clipped
    once the changes are made, and does not so now: where its laser is off or shut, it does nothing yet.

    The lasers that count are those that then shine. Where none does, nothing is traced, nor imported for it.
    """
    now = {n: c.pose for n, c in seen.components.items() if c.pose is not None and n in setup.lab.inventory}
    changed = {c.component for c in changes if c.tunable == "pose"}
    then = now | {n: place_of(setup, wanted, n)[1] for n in changed}
    values = _merged(seen.known_values, {n: part.values for n, part in wanted.components.items()})
    lit = {n for n in then if setup.type_of(n).optics.element == "source" and _shines(values.get(n, {}))}
    if not lit:
        return ()
    already = {n for n in lit if n in now and _shines(seen.known_values.get(n, {}))}
    before = {(d.code, d.address) for d in _told(setup, now, seen.known_values, already)} if already else set()
    return tuple(d for d in _told(setup, then, values, lit) if (d.code, d.address) not in before)


def _told(
    setup: Setup, poses: Mapping[str, Pose], values: Mapping[str, Mapping[str, Any]], lit: set[str]
) -> tuple[Diagnostic, ...]:
    from pico.optics.beam_table import troubles
    from pico.optics.light import light_of

    light = light_of(setup, poses, values, lit=lambda name: name in lit)
    return tuple(d for d in troubles(setup, light) if d.code in _OWN)


def _shines(values: Mapping[str, Any]) -> bool:
    return values.get("emission") is True and values.get("shutter", "open") == "open"


def _merged(
    seen: Mapping[str, Mapping[str, Any]], wanted: Mapping[str, Mapping[str, Any]]
) -> dict[str, dict[str, Any]]:
    return {name: {**seen.get(name, {}), **wanted.get(name, {})} for name in {*seen, *wanted}}
