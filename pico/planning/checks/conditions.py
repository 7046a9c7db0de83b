"""What a plug-in's primitive states of the bench: what must hold before it is done, and what must hold afterwards.

Expressions in the language of `expect:`, in which `it` is the component that the primitive is done on, and `args.NAME`
an argument: `it.pose.x < 500`, `distance(it, m1) > 60`, `abs(it.level - args.volume) < 0.1`.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any, Literal

from pico.diagnostics import Diagnostic, error
from pico.expressions import ExpressionError, Kind, Language, UnknownValue
from pico.model.observation import Observation
from pico.model.operation import Operation, Outcome
from pico.model.setup import Setup
from pico.model.vocabulary import functions_of, names_of, shown, spoken_of, values_of

IT = re.compile(r"(?<![\w.])it(?!\w)")


def refused(setup: Setup, seen: Observation, operation: Operation) -> tuple[Diagnostic, ...]:
    """Return what of a bench as it is seen forbids an operation: what it requires and does not hold, or is unknown."""
    return tuple(found for found, _ in _unmet(setup, seen, operation, "requires"))


def missed(setup: Setup, seen: Observation, operation: Operation) -> tuple[Diagnostic, Outcome] | None:
    """Return what does not hold on a bench as it is seen after an operation that was done, and how that ended then:
    `unknown` where only nobody can tell; None where all holds that it ensures."""
    found = sorted(_unmet(setup, seen, operation, "ensures"), key=lambda one: one[1] != "failed")
    return found[0] if found else None


def _unmet(
    setup: Setup, seen: Observation, operation: Operation, when: Literal["requires", "ensures"]
) -> Iterator[tuple[Diagnostic, Outcome]]:
    kind, name = operation.kind, operation.component
    told = {f"args.{key}": value for key, value in operation.arguments.items() if isinstance(value, float | int | str)}
    for said in kind.requires if when == "requires" else kind.ensures:
        text = IT.sub(name, said)
        spoken = spoken_of(setup, [text])
        values, unknown = values_of(setup, seen, spoken)
        kinds = names_of(setup, spoken) | {key: _kind(value) for key, value in told.items()}
        outcome: Outcome = "failed"
        try:
            if Language(kinds, functions_of(setup, seen)).compile(text).evaluate(values | told):
                continue
            why = shown(text, values | told)
        except UnknownValue as exc:
            why, outcome = unknown.get(exc.name, str(exc)), "unknown"
        except ExpressionError as exc:
            why = str(exc)
        first = "wants" if when == "requires" else "was done, and does not hold:"
        summary = f"{operation.primitive} of {name} {first} `{text}`" + (f": {why}" if why else "")
        yield error(when, summary, address=name), outcome


def _kind(value: Any) -> Kind:
    return "bool" if isinstance(value, bool) else "text" if isinstance(value, str) else "number"
