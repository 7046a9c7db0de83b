"""Parts of a state as a person names them: `p2`, or one tunable of it, `p2.pose`, `p1.angle`."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from pico.diagnostics import Diagnostic, PicoError, did_you_mean, error
from pico.model.renaming import called_now, renaming_of
from pico.model.setup import Setup

Named = Mapping[str, frozenset[str] | None]
"""For each component that was named, the tunables of it; None for all of them."""


def read_addresses(setup: Setup, words: Iterable[str]) -> Named:
    """Return what `words` name, by component, which may be named as it was before; raises PicoError for each that the
    lab does not have."""
    names = renaming_of(setup.lab)
    found: dict[str, frozenset[str] | None] = {}
    wrong: list[Diagnostic] = []
    for word in sorted({called_now(names, word) for word in words}):
        component, _, tunable = word.partition(".")
        problem = _problem(setup, word, component, tunable)
        if problem:
            wrong.append(problem)
        elif not tunable:
            found[component] = None
        else:
            before = found.get(component, frozenset())
            found[component] = None if before is None else before | {tunable}
    if wrong:
        raise PicoError(wrong)
    return found


def holds(named: Named, component: str, tunable: str) -> bool:
    """Return whether a tunable of a component is among what was named."""
    some = named.get(component, frozenset())
    return some is None or tunable in some


def addresses(named: Named) -> Iterator[str]:
    """Yield what was named as it would be written: `p1.angle`, `p2`."""
    for component, tunables in sorted(named.items()):
        if tunables is None:
            yield component
        else:
            yield from (f"{component}.{tunable}" for tunable in sorted(tunables))


def _problem(setup: Setup, word: str, component: str, tunable: str) -> Diagnostic | None:
    known = setup.lab.inventory
    if component not in known:
        return error("unknown-component", f"the lab has no component `{component}`", hint=_near(component, known))
    kinds = ["pose", *setup.type_of(component).tunables]
    if "." not in word or tunable in kinds:
        return None
    whole = "a pose is one thing: name it as `pose`" if tunable == "slot" or tunable.startswith("pose.") else ""
    return error(
        "unknown-tunable", f"{component} has no tunable `{tunable}`", hint=whole or _near(tunable, kinds),
        address=component,
    )  # fmt: skip


def _near(word: str, known: Iterable[str]) -> str:
    if word.startswith("-"):
        return "options go before `--`, components after it"
    return did_you_mean(word, known)
