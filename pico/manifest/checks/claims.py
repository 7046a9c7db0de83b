"""Whether claims make sense: numbers that can be measured, settings that a motor makes, a share or a size."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping

from pico.diagnostics import Diagnostic, error
from pico.expressions import Expression, ExpressionError, Function, Kind, Language
from pico.kernels.pipeline import parsed
from pico.manifest.checks.goals import look_errors
from pico.model.goal import Claim, Looks
from pico.model.quantities import QuantityError, Value, convert
from pico.model.setup import Setup
from pico.model.vocabulary import cameras_of, numbers_of

_SPEAK = "numbers that are measured, by address: `cam.centroid.y`, `meter.power`; `pico catalog show TYPE` lists them"
_TO = "a share of the result, `2 %`, or a size in its unit, `1 um`; above 0"


def claim_errors(setup: Setup, claims: Mapping[str, Claim]) -> Iterator[tuple[tuple[str, ...], Diagnostic]]:
    """Yield what is wrong with claims, each with where: the path of keys below `claims`."""
    for name, claim in claims.items():
        yield from (((name, *path), wrong) for path, wrong in look_errors(setup, claim.looks))
        try:
            _, used = spoken(setup, claim.of, claim.looks)
        except ExpressionError as exc:
            yield (name, "of"), error("expression", f"`{claim.of[:60]}` can't be told: {exc}", hint=_SPEAK)
            continue
        try:
            share_of(claim.to) or size_of(claim.to, unit_in(setup, used.values()))
        except QuantityError as exc:
            yield (name, "to"), error("value", str(exc), hint=_TO)


def spoken(setup: Setup, of: str, looks: Looks | None) -> tuple[Expression, dict[str, tuple[str, str]]]:
    """Return an expression over measured numbers, and by the name of each its look (empty: as all stands) and its
    address; raises ExpressionError."""
    names = (*setup.lab.inventory, *cameras_of(setup))
    plain = {f"{name}.{number}": ("", f"{name}.{number}") for name in names for number in numbers_of(setup, name)}
    known = plain | {f"{look}.{address}": (look, address) for look in looks or () for address in plain}
    kinds: dict[str, Kind] = dict.fromkeys(known, "number")
    found = Language(kinds, (Function("abs", ("number",), "number", abs),)).compile(of, "number")
    used = {word: known[word] for word in re.findall(r"[A-Za-z_]\w*(?:\.[A-Za-z_]\w*)+", of) if word in known}
    if not used:
        raise ExpressionError("it speaks of nothing that is measured")
    return found, used


def unit_in(setup: Setup, used: Iterable[tuple[str, str]]) -> str:
    """Return the unit that all the numbers of an expression have, each with its look and its address; empty where they
    differ."""
    units = {_unit(setup, *address.split(".", 1)) for _, address in used}
    return units.pop() if len(units) == 1 else ""


def _unit(setup: Setup, component: str, number: str) -> str:
    measurable = setup.measurables_of(component)[numbers_of(setup, component)[number]]
    if not measurable.kernel:
        return measurable.unit
    units = parsed(measurable.kernel).last.units
    return units.get(number.rpartition(".")[2]) or next(iter(units.values()))


def share_of(to: Value) -> float | None:
    """Return what `2 %` is as a share, None for anything else; raises QuantityError."""
    if not isinstance(to, str) or not to.strip().endswith("%"):
        return None
    return _above_zero(to, convert(to.strip(), "%")) / 100


def size_of(to: Value, unit: str) -> float:
    """Return a size in a unit; raises QuantityError for what is none above 0."""
    return _above_zero(to, convert(to, unit))


def _above_zero(to: Value, number: Value) -> float:
    if isinstance(number, bool | str) or not 0 < number < math.inf:
        raise QuantityError(f"`{to}` is not above 0")
    return float(number)
