"""Mornings that count as good, kept beside the bench: what later ones are compared with."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from pico.base.state_files import MORNINGS
from pico.diagnosis.quantities import Got, Quantity
from pico.edge.network.remotes import Place
from pico.model.diff import Change, describe_move, describe_value, value_distance
from pico.model.pose import Pose, angle_between
from pico.model.record import as_json

if TYPE_CHECKING:
    from pico.diagnosis.nominal import Nominal

MOST = 20
"""References that are kept."""
_PASSING = ("illumination",)
"""Tunables that no reading depends on."""


@dataclass(frozen=True)
class Reference:
    """A morning that counts as good: `at` by the wall, its `run`; how the bench stood, what was read."""

    at: str
    run: str
    poses: Mapping[str, Pose]
    values: Mapping[str, Mapping[str, Any]]
    quantities: tuple[Quantity, ...]
    got: tuple[Got | None, ...]


def references_in(place: Place) -> tuple[Reference, ...]:
    """Return the references that a bench has, the oldest first; raises PicoError where they
    can't be read."""
    return MORNINGS.read(MORNINGS.path(place.folder), _references) or ()


def _references(data: Mapping[str, Any]) -> tuple[Reference, ...]:
    from pydantic import TypeAdapter

    return tuple(TypeAdapter(tuple[Reference, ...]).validate_python(data["references"]))


def keep(place: Place, reference: Reference) -> None:
    """Keep a reference beside the others, the oldest of which goes where there are too many; raises PicoError where it
    can't be written."""
    kept = [*references_in(place), reference][-MOST:]
    what = "the reference of mornings cannot be kept"
    MORNINGS.write(MORNINGS.path(place.folder), {"references": as_json(tuple(kept))}, what=what)


def reference_for(place: Place, nominal: Nominal) -> tuple[Reference | None, tuple[Change, ...]]:
    """Return the last reference that was taken with the bench as it stands; else the last of those from which it
    differs least, and how it differs. None where none is kept."""
    best: tuple[Reference | None, tuple[Change, ...]] = (None, ())
    for one in reversed(references_in(place)):
        differs = differences(one, nominal)
        if best[0] is None or len(differs) < len(best[1]):
            best = one, differs
    return best


def differences(one: Reference, nominal: Nominal) -> tuple[Change, ...]:
    """Return what of a bench stands or is set otherwise than for a reference, beyond tolerance. A part that one of the
    two has not seen has no pose there."""
    return tuple(found for name in sorted({*one.poses, *nominal.poses}) for found in _of_part(one, nominal, name))


def _of_part(one: Reference, nominal: Nominal, name: str) -> Iterator[Change]:
    then, now = one.poses.get(name), nominal.poses.get(name)
    if then is None or now is None:
        text = f"is not seen; it stood at {then}" if now is None else f"stands at {now}; it was not seen"
        yield Change(component=name, tunable="pose", before=as_json(then), after=as_json(now), text=text)
        return
    kind = nominal.setup.type_of(name)
    tolerance, turned = kind.pose.tolerance, abs(angle_between(then.yaw, now.yaw))
    if then.distance(now) > tolerance.position or turned > tolerance.yaw:
        text = f"{describe_move(None, then, None, now)}: it stood at {then} and stands at {now}"
        yield Change(component=name, tunable="pose", before=as_json(then), after=as_json(now), text=text)
    for tunable, about in kind.tunables.items():
        before, live = one.values.get(name, {}).get(tunable), nominal.values.get(name, {}).get(tunable)
        if tunable in _PASSING or before == live:
            continue
        if before is None or live is None or value_distance(about, live, before) > about.tolerance:
            text = f"{tunable} was set {describe_value(about, before, live)}"
            yield Change(component=name, tunable=tunable, before=before, after=live, text=text)
