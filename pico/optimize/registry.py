"""Algorithms by name: a file each of `pico.optimize.algorithms`; a plug-in brings more by the entry point
`pico.algorithms`, a module of the same kind: `DECLARATION` and `make(problem, parameters, seed)`."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Protocol, cast

from pico.diagnostics import PicoError, did_you_mean, error
from pico.optimize.problem import Algorithm, Declaration, Problem
from pico.plug_ins.calling import Interface, function, instance
from pico.registered import intact, module, modules

FOLDER = "pico.optimize.algorithms"
GROUP = "pico.algorithms"


class AlgorithmFile(Protocol):
    """A file of FOLDER."""

    DECLARATION: Declaration
    make: Callable[[Problem, Mapping[str, float], int], Algorithm]


INTERFACE = Interface(GROUP, {"DECLARATION": instance(Declaration), "make": function}, makes=("make",))


def known() -> tuple[str, ...]:
    """Return the names of all algorithms, PICO's own first; imports none of PICO's own."""
    return tuple(modules(FOLDER, GROUP))


def algorithm_file(name: str) -> AlgorithmFile:
    """Return the file of an algorithm; raises PicoError for a name that there is not, for what it needs and is not
    installed, and for a plug-in that is broken."""
    if name not in known():
        hint = did_you_mean(name, known()) or f"known: {', '.join(known())}"
        raise PicoError(error("algorithm", f"there is no algorithm `{name}`", hint=hint))
    return cast(AlgorithmFile, module(INTERFACE, name))


def refusal(name: str, problem: Problem) -> PicoError | None:
    """Return why an algorithm cannot solve a problem, and which can; None where it can. Raises PicoError for a name
    that there is not."""
    if why := algorithm_file(name).DECLARATION.refusal(problem):
        fits = ", ".join(n for n, one in intact(INTERFACE)[0].items() if not one.DECLARATION.refusal(problem))
        return PicoError(error("algorithm", f"{name} {why}", hint=f"those that can: {fits}"))
    return None


def made(name: str, problem: Problem, parameters: Mapping[str, float] | None = None, seed: int = 1) -> Algorithm:
    """Return an algorithm for a problem; raises PicoError where it cannot solve that, and for parameters that it does
    not have."""
    file, given = algorithm_file(name), dict(parameters or {})
    declared = file.DECLARATION
    if wrong := refusal(name, problem):
        raise wrong
    for parameter in given:
        if parameter not in declared.parameters:
            hint = did_you_mean(parameter, declared.parameters) or f"known: {', '.join(declared.parameters) or 'none'}"
            raise PicoError(error("algorithm", f"{name} has no parameter `{parameter}`", hint=hint))
    return file.make(problem, {**declared.parameters, **given}, seed)
