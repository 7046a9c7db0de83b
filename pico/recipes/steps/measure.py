"""`measure: cam.centroid`: one measurable or several; expressions then speak of the numbers by their addresses, and by
the name that `as` gives. What kernels make of a picture (`cam.image | centroid`) has only that name."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pico.diagnostics import PicoError, error
from pico.kernels.pipeline import spelt
from pico.manifest.text.tree import Node
from pico.model.measurement import Measurement
from pico.model.plan import Plan
from pico.model.record import as_json
from pico.recipes.doing import Doing
from pico.recipes.reader import Reader, scalar_texts
from pico.recipes.registry import Given, Kind
from pico.recipes.scanning import result_names
from pico.recipes.scope import Scope

KIND = Kind("one measurable or several", "{measure: cam.centroid, as: spot}", within=True)


def read(reader: Reader, scope: Scope, body: Node, beside: Mapping[str, Node]) -> Given:
    """See `pico.recipes.registry.StepFile`."""
    listed = scalar_texts(body)
    if listed is None:
        reader.wrong(body, "type", "`measure` takes measurables", f"`{KIND.example}`")
        return Given({"of": ()})
    of = [a for node, text in listed if reader.measurable(node, a := spelt(text))]
    numbers = {a: reader.numbers(a) for a in of}
    names = result_names(reader.setup, of[0], numbers[of[0]]) if len(of) == 1 else {}
    return Given(
        {"of": tuple(of)},
        names=names,
        measured=tuple(f"{a.partition('.')[0]}.{n}" for a in of for n in numbers[a]),
    )


def plan(doing: Doing, given: Mapping[str, Any]) -> Plan:
    """Return what is to be measured."""
    return doing.bench.plans.measuring([tuple(a.split(".", 1)) for a in given["of"]])


def run(doing: Doing, given: Mapping[str, Any]) -> Mapping[str, Any]:
    """See `pico.recipes.registry.StepFile`."""
    found = doing.run(plan(doing, given))
    if (without := [m for m in found.values() if m.unknown]) and given.get("required", True):
        advice = doing.bench.measurements.advice
        raise PicoError([
            error("unknown", f"{m.address} has no value: {m.unknown}", hint=advice(m), address=m.address)
            for m in without
        ])  # fmt: skip
    return {"measured": {address: as_json(m) for address, m in found.items()}, **_result(found, given["of"])}


def _result(found: Mapping[str, Measurement], of: tuple[str, ...]) -> dict[str, Any]:
    if len(of) != 1 or of[0] not in found:
        return {}
    value, sigma = found[of[0]].value, found[of[0]].sigma
    if isinstance(value, Mapping):
        named = {n: float(v) for n, v in value.items()}
        return named | {f"{n}_sigma": float(s) for n, s in (sigma.items() if isinstance(sigma, Mapping) else ())}
    if value is None or isinstance(value, bool | str):
        return {} if value is None else {"": value}
    return {"": float(value), **({"sigma": float(sigma)} if isinstance(sigma, int | float) else {})}
