"""Mornings that count as good, kept beside the bench: what later ones are compared with."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pico.diagnosis.quantities import Got, Quantity
from pico.diagnostics import PicoError, error
from pico.disk import write_whole
from pico.edge.network.remotes import Place
from pico.model.diff import value_distance
from pico.model.pose import Pose, angle_between
from pico.model.record import Format, as_json
from pico.model.setup import Setup

if TYPE_CHECKING:
    from pico.diagnosis.nominal import Nominal

FORMAT = Format("pico.mornings")
MOST = 20
"""References that are kept."""
_PASSING = ("exposure", "illumination")
"""Tunables that a morning sets as it wants them."""


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
    from pydantic import TypeAdapter, ValidationError

    path = _path(place)
    try:
        data = FORMAT.lifted(json.loads(path.read_text(encoding="utf-8")))
        return tuple(TypeAdapter(tuple[Reference, ...]).validate_python(data["references"]))
    except FileNotFoundError:
        return ()
    except (OSError, ValueError, KeyError, TypeError, ValidationError) as exc:
        text = f"{path} cannot be read: {str(exc).splitlines()[0]}"
        hint = "move it elsewhere; the next morning is then the first"
        raise PicoError(error("morning", text, hint=hint)) from exc


def keep(place: Place, reference: Reference) -> None:
    """Keep a reference beside the others, the oldest of which goes where there are too many; raises PicoError where it
    can't be written."""
    kept = [*references_in(place), reference][-MOST:]
    data = json.dumps({"schema": FORMAT.schema, "references": as_json(tuple(kept))}, sort_keys=True).encode()
    what = "the reference of mornings cannot be kept"
    write_whole(_path(place), data, what=what, code="morning", folders=True)


def reference_for(place: Place, nominal: Nominal) -> tuple[Reference | None, str]:
    """Return the last reference that was taken with the bench as it stands; else why there is none."""
    kept = references_in(place)
    for one in reversed(kept):
        if not _differs(one, nominal):
            return one, ""
    if not kept:
        return None, "no morning was recorded before"
    return None, f"the bench stands otherwise than on {kept[-1].at[:16]}: {_differs(kept[-1], nominal)}"


def _path(place: Place) -> Path:
    return place.folder / "mornings.json"


def _differs(one: Reference, nominal: Nominal) -> str:
    """Return what of a bench is not as it was for a reference, in words; empty where all is."""
    for name in sorted({*one.poses, *nominal.poses}):
        if name not in one.poses or name not in nominal.poses:
            return f"{name} {'is not there' if name in one.poses else 'is there'}"
        then, now = one.poses[name], nominal.poses[name]
        tolerance = nominal.setup.type_of(name).pose.tolerance
        if then.distance(now) > tolerance.position or abs(angle_between(then.yaw, now.yaw)) > tolerance.yaw:
            return f"{name} stood at {then}, and now at {now}"
        if said := _set_otherwise(nominal.setup, name, one.values.get(name, {}), nominal.values.get(name, {})):
            return said
    return ""


def _set_otherwise(setup: Setup, name: str, then: Mapping[str, Any], now: Mapping[str, Any]) -> str:
    for tunable, about in setup.type_of(name).tunables.items():
        before, live = then.get(tunable), now.get(tunable)
        if tunable in _PASSING or before == live:
            continue
        if before is None or live is None or value_distance(about, live, before) > about.tolerance:
            return f"{name}.{tunable} was {before}, and is {live}"
    return ""
