"""What readings are expected to be where parts were seen to stand, or to be set, otherwise than for a reference."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from pico.diagnosis.causes import Way
from pico.diagnosis.darkness import DARK
from pico.diagnosis.modelled import Modelled
from pico.diagnosis.nominal import QUIET, Nominal
from pico.diagnosis.quantities import Quantity
from pico.model.diff import Change

if TYPE_CHECKING:
    from pico.bench.drifting.references import Reference
    from pico.model.observation import Observation

SEEN = (0.02, 0.01)
"""How surely a part that was moved is known to stand where it was seen, at best [mm, deg]."""
UNSURE: Mapping[str, float] = {"share": 0.5, "depth": 0.5, "null": 2.0, "peak": 2.0}
"""The sigma of what is expected above which a reading is not compared, by its law; of a place PLACE [um]."""
PLACE = 300.0
FAINT = -7.0
"""The logarithm of the share of its light below which a reading is expected to be dark."""


@dataclass(frozen=True)
class Expected:
    """By how much a quantity is expected to have `shift`ed; `why` it is not compared, empty where it is."""

    shift: float = 0.0
    why: str = ""


def as_known(nominal: Nominal, reference: Reference, moved: Sequence[Change]) -> tuple[Nominal, Nominal]:
    """Return the bench of a reference, and the same with what has changed beyond tolerance as it is now."""
    then = Nominal(nominal.setup, reference.poses, reference.values)
    poses, values = dict(reference.poses), {n: dict(own) for n, own in reference.values.items()}
    for one in moved:
        if one.tunable != "pose":
            values.setdefault(one.component, {})[one.tunable] = one.after
        elif one.component in nominal.poses:
            poses[one.component] = nominal.poses[one.component]
            values.setdefault(one.component, dict(nominal.values.get(one.component, {})))
        else:
            poses.pop(one.component, None)
    return then, Nominal(nominal.setup, poses, values)


def unsure(seen: Observation, nominal: Nominal, moved: Sequence[Change]) -> tuple[tuple[str, Way], ...]:
    """Return the ways in which parts that were moved may stand otherwise than they were seen, by their usual sizes."""
    found = []
    for name in dict.fromkeys(one.component for one in moved if one.tunable == "pose"):
        if name not in nominal.poses:
            continue
        near, seat = seen.components[name].uncertainty, nominal.setup.type_of(name).repeatability
        place, yaw = max(SEEN[0], near.position), max(SEEN[1], near.yaw)
        sizes = {"left": place, "ahead": place, "yaw": yaw}
        sizes |= {"up": seat.height or 0.0, "pitch": seat.pitch or 0.0, "roll": seat.roll or 0.0}
        for what, size in sizes.items():
            if size > 0:
                found.append((name, Way(what, "", size, 10 * size, size)))
    return tuple(found)


def expected(
    then: Nominal, now: Nominal, quantities: Sequence[Quantity], moved: Sequence[Change],
    ways: Sequence[tuple[str, Way]],
) -> tuple[Expected, ...]:  # fmt: skip
    """Return for each quantity what is expected of it; that of one which does not depend on what was `moved` is as it
    was. `ways`: see `unsure`."""
    if not moved:
        return tuple(Expected() for _ in quantities)
    parts = list(dict.fromkeys(one.component for one in moved if one.tunable not in QUIET))
    depends = {n: [p for p in parts if _depends(then, q, p) or _depends(now, q, p)] for n, q in enumerate(quantities)}
    behind = [n for n in depends if depends[n]]
    model = Modelled(now, tuple(quantities[n] for n in behind), np.full(len(behind), -math.inf))
    spread = sum(
        ((w.usual * s) ** 2 for (_, w), s in zip(ways, model.slopes(ways).values(), strict=True)), np.zeros(len(behind))
    )
    found = dict(zip(behind, _each(then, model, np.sqrt(spread), [depends[n] for n in behind]), strict=True))
    return tuple(found.get(n, Expected()) for n in range(len(quantities)))


def _each(then: Nominal, model: Modelled, sigmas: Any, why: Sequence[Sequence[str]]) -> Iterator[Expected]:
    for one, value, sigma, parts in zip(model.wanted, model.base, sigmas, why, strict=True):
        before, who = then.quantity(one), " and ".join(parts)
        if before is None:
            yield Expected(why="the ray model expected no light there then")
        elif not math.isfinite(value) or (one.law == "share" and value - before.value < FAINT):
            yield Expected(why=f"no light is expected there since {who} changed")
        elif not sigma < UNSURE.get(one.law, PLACE):
            yield Expected(why=f"behind {who}, whose place is not known well enough to tell what is expected")
        else:
            yield Expected(float(value - before.value))


def _depends(nominal: Nominal, wanted: Quantity, part: str) -> bool:
    if wanted.shots[0].address.endswith((DARK, ".monitor")):
        return False
    return any(nominal.matters(shot, part) for shot in wanted.shots)
