"""How much light falls on samples, as the tracer has it, and what would give one more than its budget: pure functions.

The dose is the power of the beams that come to the part which holds the sample, times how long. As the size of the
sample is unknown, all of a beam counts. Within one operation the greater of the powers before and after it counts. If
light may come that was not followed to its end, as between two mirrors that face each other, the power has no bound.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from pico.diagnostics import Diagnostic, error
from pico.model.observation import Observation, with_value
from pico.model.operation import Operation
from pico.model.plan import DOSE
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.model.trace.dose import Dose
from pico.planning.checks.emission import may_shine


def samples(setup: Setup) -> dict[str, str]:
    """Return the parts that hold a sample, each with which."""
    return {name: part.sample for name, part in sorted(setup.lab.inventory.items()) if part.sample}


def powers(setup: Setup, seen: Observation) -> dict[str, float]:
    """Return the power [mW] of the beams that come to each part with a sample, see `falling`."""
    return falling(setup, seen)[0]


def falling(setup: Setup, seen: Observation) -> tuple[dict[str, float], dict[str, str]]:
    """Return the power [mW] of the beams that were followed to each part with a sample, and why more may come to some
    of these parts. A source that is not known to be dark shines."""
    from pico.optics.light import light_of

    poses = {name: part.pose for name, part in seen.components.items() if part.pose is not None}
    values = seen.known_values
    found = dict.fromkeys(samples(setup), 0.0)
    sources = [name for name in poses if name in setup.lab.inventory]
    if not any(setup.type_of(n).optics.element == "source" and may_shine(setup, seen, n, values.get(n, {}))
               for n in sources):  # fmt: skip
        return found, {}
    light = light_of(setup, {n: p for n, p in poses.items() if n in setup.lab.inventory}, values)
    for crossing in light.crossings:
        if crossing.component in found:
            found[crossing.component] += crossing.power
    return found, {name: why for name in found if (why := light.unfollowed(name))}


def refused(
    setup: Setup, seen: Observation, doses: Sequence[Dose], operations: Sequence[Operation]
) -> list[Diagnostic]:
    """Return an error for each sample that operations would give more than its budget, with the numbers; not where
    they let no more light on it than falls on it now, and end in the dark."""
    limited = [one for one in doses if one.budget is not None]
    if not limited:
        return []
    steps = list(_predicted(setup, seen, operations))
    found = []
    for one in limited:
        name = one.component
        mine = [(math.inf if name in more else power[name], seconds) for power, more, seconds in steps]
        first = math.inf if one.unknown else one.power
        last = mine[-1][0] if mine else first
        dose, before = 0.0, first
        for power, seconds in mine:
            dose, before = dose + max(before, power) * seconds, power
        darker = last == 0.0 and all(power <= first for power, _ in mine)
        if not darker and max([first, *(power for power, _ in mine)]) > 0.0:
            why = one.unknown or next((more[name] for _, more, _ in steps if name in more), "")
            found += over(one, dose, sum(seconds for _, seconds in mine), why)
    return found


def over(one: Dose, dose: float, seconds: float, why: str = "") -> list[Diagnostic]:
    """Return why a dose [mJ] in so many seconds is more than a sample may have; nothing where it is not. `why`: a dose
    is infinite, for it has no bound."""
    if one.budget is None or one.spent + dose <= one.budget:
        return []
    if math.isinf(dose):
        text = f"{one.said}; how much more this would give it is unknown: {why}"
        hint = "close a shutter before it, or turn or move the mirrors between which the light goes to and fro"
        return [error(DOSE, text, hint=hint, address=one.component)]
    text = f"{one.said}; this would give it {dose:.4g} mJ more, in {seconds:.4g} s"
    hint = "less light (a filter, a closed shutter), or less time; `dose_budget` of the part says what it may have"
    return [error(DOSE, text, hint=hint, address=one.component)]


def _predicted(
    setup: Setup, seen: Observation, operations: Sequence[Operation]
) -> Iterator[tuple[Mapping[str, float], Mapping[str, str], float]]:
    """Yield the powers on samples after each operation, in the order of their starts, why more may fall on some, and
    the seconds until it ends."""
    now = 0.0
    for op in sorted(operations, key=lambda o: o.start):
        ends = max(now, op.start + op.seconds)
        after = _after(seen, op)
        seen = after if after is not None else seen
        yield *falling(setup, seen), ends - now
        now = ends


def _after(seen: Observation, op: Operation) -> Observation | None:
    part = seen.components.get(op.component)
    if part is None:
        return None
    to, tunable = op.arguments.get("to"), op.arguments.get("tunable")
    if op.primitive in ("set", "operator") and tunable is not None:
        return with_value(seen, op.component, str(tunable), op.arguments["to"])
    if isinstance(to, Mapping) and "pose" in to:  # by an arm or by hand
        moved = replace(part, pose=Pose(**to["pose"]))
        return replace(seen, components={**seen.components, op.component: moved})
    return None
