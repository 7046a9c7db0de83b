"""Checks that are switched off, or warn of everything, one at a time, for `wrong_benches.py` to notice."""

from __future__ import annotations

import importlib
import math
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from typing import Any
from unittest.mock import patch

from pico.diagnostics import PicoError, error


@dataclass(frozen=True)
class Plant:
    """A function of PICO as `module:function`; what stands in its place, which is given the function and its arguments;
    and the kinds of wrong benches that lose by it: without kinds it is the right ones that do."""

    function: str
    instead: Callable[..., Any]
    kinds: tuple[str, ...] = ()


def _always(value: Any) -> Callable[..., Any]:
    return lambda *_, **__: value


def _without(code: str) -> Callable[..., Any]:
    return lambda original, *given, **more: tuple(d for d in original(*given, **more) if d.code != code)


def _vaguely(original: Callable[..., Any], *given: Any) -> Any:
    try:
        return original(*given)
    except PicoError:
        raise PicoError(error("goal", "this cannot be sought")) from None


RANGES, RESPONSE = "pico.model.materials.ranges", "pico.model.materials.response"
LIGHTED, NOMINAL = "pico.backends.sim.lighted", "pico.optics.nominal.sensitivity"
PLANTS = {
    "ranges-ignored": Plant(f"{RANGES}:span", _always((0.0, math.inf)), ("wavelength",)),
    "readings-out-of-range-assured": Plant("pico.optics.ends:doubts", _always(()), ("wavelength",)),
    "nothing-blind": Plant(f"{RESPONSE}:blind", _always(False), ("blind detector",)),
    "blind-reads-a-number": Plant(f"{LIGHTED}:sightless", _always(None), ("blind detector",)),
    "meter-setting-ignored": Plant(f"{LIGHTED}:unset", _always({}), ("meter",)),
    "insensitive-not-told": Plant(f"{NOMINAL}:cautions", _without("insensitive"), ("polarizer", "goal")),
    "bounds-without-a-name": Plant("pico.planning.optimizing:_from", _vaguely, ("goal",)),
    "dark-not-told": Plant("pico.planning.darkness:darkness", _always(()), ("shut",)),
    "storage-not-told": Plant("pico.planning.darkness:gone", _always(""), ("parked",)),
    "everything-out-of-range": Plant(f"{RANGES}:span", _always((100.0, 101.0))),
    "everything-blind": Plant(f"{RESPONSE}:blind", _always(True)),
    "everything-insensitive": Plant(f"{NOMINAL}:_moves", _always(False)),
    "every-meter-set-wrong": Plant(f"{LIGHTED}:unset", _always({"wavelength": "the meter is set to 1 nm"})),
}


@contextmanager
def plant(name: str) -> Iterator[None]:
    """Plant a fault under each name by which PICO has the function; raises LookupError if it is gone."""
    planted = PLANTS[name]
    path, _, function = planted.function.partition(":")
    try:
        original = getattr(importlib.import_module(path), function)
    except (ImportError, AttributeError):
        raise LookupError(f"there is no `{planted.function}`, which the plant alters: mend the plant") from None

    def altered(*given: Any, **more: Any) -> Any:
        return planted.instead(original, *given, **more)

    with ExitStack() as stack:
        for module in [m for path, m in list(sys.modules.items()) if path.startswith("pico.")]:
            for attribute in [n for n, value in vars(module).items() if value is original]:
                stack.enter_context(patch.object(module, attribute, altered))
        yield
