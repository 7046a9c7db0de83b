"""Expectations against the bench as observed."""

from __future__ import annotations

from collections.abc import Iterable, Sequence, Set

from pico.diagnostics import Diagnostic, PicoError, error
from pico.expressions import ExpressionError, Language, UnknownValue
from pico.model.observation import Observation
from pico.model.setup import Setup
from pico.model.state import Expectation
from pico.model.trace.expectation import Expected
from pico.model.vocabulary import functions_of, names_of, numbers_of, shown, spoken_of, values_of
from pico.policy.reaching import reaching


def require_expressions(setup: Setup, texts: Iterable[str]) -> None:
    """Raise PicoError if an expression makes no sense on this bench."""
    if found := expression_faults(setup, texts):
        raise PicoError(found)


def expression_faults(setup: Setup, texts: Iterable[str]) -> list[Diagnostic]:
    """Return an error for each expression that makes no sense on this bench."""
    found = []
    for text in texts:
        try:
            Language(names_of(setup, spoken_of(setup, [text])), functions_of(setup)).compile(text)
        except ExpressionError as exc:
            hint = "it speaks of components, as `expect:` does: `p2.pose.x < 530`, `distance(p1, p2) > 100`"
            caret = " " * exc.start + "^" * (min(exc.end, len(text)) - exc.start)
            found.append(error("expression", f"{exc}", detail=f"{text}\n{caret}", hint=hint))
    return found


def check_expectations(
    setup: Setup, seen: Observation, expect: Sequence[Expectation], measurables: Set[str] = frozenset()
) -> tuple[Expected, ...]:
    """Return what became of each expectation; one that can't be told is unknown, and says why. What speaks of what
    nobody measured, or of which not all was assured, is not assured, and no failure. `measurables`: the addresses of
    what the bench can measure."""
    if not expect:
        return ()
    names = spoken_of(setup, (e.that for e in expect))
    values, unknown = values_of(setup, seen, names)
    language = Language(names_of(setup, names), functions_of(setup, seen, reaching(setup, seen)))
    found = []
    for one in expect:
        holds, why, assured = None, "", True
        try:
            holds = bool(language.compile(one.that).evaluate(values))
        except UnknownValue as exc:
            why = unknown.get(exc.name, str(exc))
            component, _, number = exc.name.partition(".")
            measurable = numbers_of(setup, component).get(number)
            assured = measurable is None
            if f"{component}.{measurable}" in measurables - seen.measurements.keys():
                why = f"{exc.name} was not measured now: `pico verify --measure` does it"
        except ExpressionError as exc:
            why = str(exc)
        if holds is False:
            why = shown(one.that, values)
        found.append(Expected(that=one.that, message=one.message, holds=holds, why=why, assured=assured))
    return tuple(found)
