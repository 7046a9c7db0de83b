"""Between which values a plan drives the angles of mirrors, by motors or by hand, while light may be on: for the beam
audit up to class 3R."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from pico.model.arming import within
from pico.model.observation import Observation
from pico.model.operation import searched_by
from pico.model.plan import Plan
from pico.model.quantities import QuantityError, convert
from pico.model.setup import Setup
from pico.optics.audit.findings import ORDINARY, Spans
from pico.optics.audit.lasers import laser_class
from pico.optics.axis import Values
from pico.planning.checks.emission import SEARCHING
from pico.policy.beams import open_beams

FINE, MOST_STEPS = 3.5, 80
"""The step between two trials of a mirror [mrad], by which its beam goes on by 7 mm, the width of a pupil, at 1 m; and
how many steps there are at most."""
ANGLES = ("tip", "tilt")
"""Tunables by which a mirror turns a beam."""


def driven_in_light(
    setup: Setup, plan: Plan, seen: Observation, values: Values, lasers: Sequence[str]
) -> tuple[Spans, frozenset[str]]:
    """Return between which values a plan drives angles of mirrors while a laser up to class 3R may be open, each with
    the value before; and those lasers. A laser above that is judged over full ranges anyway."""
    found: dict[str, dict[str, tuple[float, float]]] = {}
    ordinary = [n for n in lasers if within(laser_class(setup, n, values.get(n, {}))[0], ORDINARY)]
    if not ordinary:
        return {}, frozenset()
    opened, steered = open_beams(setup, plan.operations, seen, ordinary), set[str]()

    def widen(component: str, tunable: str, *numbers: object) -> None:
        known = [float(n) for n in numbers if isinstance(n, int | float) and not isinstance(n, bool)]
        whole = setup.type_of(component).tunables[tunable].range
        if whole is None:  # counts as turned all round anyway
            return
        ends = known if len(known) == len(numbers) else [*known, *whole]
        own = found.setdefault(component, {})
        own[tunable] = min(*ends, *own.get(tunable, ends)), max(*ends, *own.get(tunable, ends))

    for op in plan.operations:
        kinds = setup.type_of(op.component).tunables if op.component in setup.lab.inventory else {}
        tunable = str(op.arguments.get("tunable"))
        lit = opened.get(op.id)
        if op.primitive == "home" and lit:
            steered |= set(lit) if any(one in kinds for one in ANGLES) else set()
            for one in (t for t in ANGLES if t in kinds):
                widen(op.component, one, None)
        elif op.primitive in ("set", "operator") and lit and tunable in ANGLES and tunable in kinds:
            live = seen.components[op.component].values.get(tunable) if op.component in seen.components else None
            widen(
                op.component, tunable, op.arguments.get("to"), live.value if live and live.status == "known" else None
            )
            steered |= set(lit)
    for component, tunable, bounds in searched_in(setup, plan):
        if tunable in ANGLES:
            widen(component, tunable, *bounds)
    return found, frozenset(steered)


def fine_steps(setup: Setup, component: str, tunable: str, low: float, high: float) -> int:
    """Return in how many steps a mirror is turned on trial from `low` to `high`, in the unit of the tunable, so that
    its beam steps over no gap between housings into which an eye would look (FINE)."""
    unit = setup.type_of(component).tunables[tunable].unit
    try:
        span = float(convert(f"{high - low!r} {unit}", "mrad"))
    except QuantityError:
        return MOST_STEPS
    return min(MOST_STEPS, math.ceil(abs(span) / FINE))


def searched_in(setup: Setup, plan: Plan) -> Iterator[tuple[str, str, tuple[float, float]]]:
    """Yield the tunables that a plan scans or searches, by component and name, with the range that it does so over."""
    for op in plan.operations:
        if op.primitive in SEARCHING:
            for address, bounds in searched_by(op.arguments).items():
                component, _, tunable = address.partition(".")
                known = component in setup.lab.inventory
                kind = setup.type_of(component).tunables.get(tunable) if known else None
                if (bounds := bounds or (kind.range if kind and tunable in ANGLES else None)) is not None:
                    yield component, tunable, bounds
            continue
        tunable = str(op.arguments.get("tunable"))
        kind = setup.type_of(op.component).tunables.get(tunable) if op.component in setup.lab.inventory else None
        if op.primitive == "scan" and kind is not None and kind.range is not None:
            yield op.component, tunable, kind.range
