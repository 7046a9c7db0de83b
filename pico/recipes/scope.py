"""What expressions of a recipe may speak of at one place: parameters and variables, and the bench."""

from __future__ import annotations

import math
import statistics
from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from typing import Any

from pico.expressions import Function, Language
from pico.model.setup import Setup
from pico.model.vocabulary import cameras_of, names_of
from pico.recipes.recipe import Name


def bench_names(setup: Setup) -> dict[str, Name]:
    """Return the names of a bench: tunables and poses as observed, numbers as they were measured last."""
    kinds = names_of(setup, [*setup.lab.inventory, *cameras_of(setup)])
    return {name: Name(kind, _unit(setup, name)) for name, kind in kinds.items()}


def _unit(setup: Setup, address: str) -> str:
    component, _, rest = address.partition(".")
    if rest in ("pose.x", "pose.y"):
        return "mm"
    if rest == "pose.yaw":
        return "deg"
    if component not in setup.lab.inventory:
        return ""
    tunable = setup.type_of(component).tunables.get(rest)
    if tunable is not None:
        return tunable.unit
    measurable = setup.measurables_of(component).get(rest)
    return measurable.unit if measurable is not None and measurable.datatype == "float" else ""


MOST_VALUES = 10_000
"""Values that a range may have."""


class Scope:
    """The names at one place. `own`: those of the recipe; blocks see those around them, and keep theirs to
    themselves. `measured`: numbers of the bench that a step before measures."""

    def __init__(self, bench: Mapping[str, Name], own: Mapping[str, Name], measured: Iterable[str] = ()) -> None:
        self.bench, self.own, self.measured = bench, dict(own), set(measured)
        self._language: tuple[frozenset[str], Language] | None = None

    def inner(self) -> Scope:
        """Return the scope of a block in this one."""
        return Scope(self.bench, self.own, self.measured)

    def name(self, word: str) -> Name | None:
        """Return what a name stands for, None where it stands for nothing."""
        return self.own.get(word) or self.bench.get(word)

    @property
    def language(self) -> Language:
        """The language of expressions here."""
        known = frozenset((*self.own, *(f"{n}:{v.kind}" for n, v in self.own.items())))
        if self._language is None or self._language[0] != known:
            kinds = {n: v.kind for n, v in (*self.bench.items(), *self.own.items())}
            self._language = known, Language(kinds, FUNCTIONS)
        return self._language[1]


def _numbers(items: Any) -> list[float]:
    if not items:
        raise ValueError("the list is empty")
    return list(items)


def _range(first: float, last: float, step: float) -> list[float]:
    return list(spaced(first, last, step))


def spaced(first: float, last: float, step: float) -> tuple[float, ...]:
    """Return the values from `first` to `last`, both included where the `step` leads there; raises ValueError."""
    if step == 0 or not all(map(math.isfinite, (first, last, step))):
        raise ValueError("a range needs a step other than 0")
    turns = (last - first) / step
    count = math.floor(turns + 1e-9) + 1 if abs(turns) < MOST_VALUES else 0
    if not 0 < count <= MOST_VALUES:
        raise ValueError(f"a range from {first:g} to {last:g} in steps of {step:g} has no values, or too many")
    return tuple(round(first + n * step, 12) for n in range(count))


def even(first: float, last: float, count: float) -> tuple[float, ...]:
    """Return `count` values from `first` to `last`; raises ValueError."""
    if not all(map(math.isfinite, (first, last))) or not count.is_integer():
        raise ValueError("a range has two ends and a whole number of values")
    if not 2 <= count <= MOST_VALUES:
        raise ValueError("a range has 2 to 10,000 values")
    return tuple(round(first + n * (last - first) / (count - 1), 12) for n in range(int(count)))


def _sd(items: Any) -> float:
    numbers = _numbers(items)
    if len(numbers) < 2:
        raise ValueError("it takes two numbers or more")
    return statistics.stdev(numbers)


def _root(x: float) -> float:
    if x < 0:
        raise ValueError("the square root of a number below 0")
    return math.sqrt(x)


def _log(x: float) -> float:
    if x <= 0:
        raise ValueError("the logarithm of a number that is not above 0")
    return math.log(x)


def _exp(x: float) -> float:
    try:
        return math.exp(x)
    except OverflowError as exc:
        raise ValueError(f"exp({x:g}) is too large") from exc


def _mod(a: float, b: float) -> float:
    if b == 0 or not math.isfinite(a):
        raise ValueError("the remainder of a division by 0, or of what has no end")
    return a % b


def _rounded(x: float, digits: float = 0) -> float:
    return float(round(x, int(digits)))


def _floor(x: float) -> float:
    if not math.isfinite(x):
        raise ValueError(f"{x} has no whole part")
    return float(math.floor(x))


FUNCTIONS: Sequence[Function] = (
    Function("abs", ("number",), "number", abs),
    Function("sqrt", ("number",), "number", _root),
    Function("sin", ("number",), "number", lambda a: math.sin(math.radians(a))),
    Function("cos", ("number",), "number", lambda a: math.cos(math.radians(a))),
    Function("tan", ("number",), "number", lambda a: math.tan(math.radians(a))),
    Function("atan2", ("number", "number"), "number", lambda y, x: math.degrees(math.atan2(y, x))),
    Function("exp", ("number",), "number", _exp),
    Function("log", ("number",), "number", _log),
    Function("mod", ("number", "number"), "number", _mod),
    Function("floor", ("number",), "number", _floor),
    Function("round", ("number",), "number", _rounded),
    Function("round", ("number", "number"), "number", _rounded),
    Function("range", ("number", "number", "number"), "numbers", _range),
    Function("linspace", ("number", "number", "number"), "numbers", lambda *given: list(even(*given))),
    Function("mean", ("numbers",), "number", lambda items: statistics.fmean(_numbers(items))),
    Function("sd", ("numbers",), "number", _sd),
    Function("sum", ("numbers",), "number", lambda items: math.fsum(_numbers(items))),
    Function("least", ("numbers",), "number", lambda items: min(_numbers(items))),
    Function("most", ("numbers",), "number", lambda items: max(_numbers(items))),
)
"""Functions of expressions in recipes: angles in degrees."""


@cache
def function_names() -> frozenset[str]:
    """Return the names of functions, which nothing else may be called."""
    return frozenset(f.name for f in FUNCTIONS)
