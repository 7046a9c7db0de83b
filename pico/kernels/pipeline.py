"""Kernels in a row, as text: `image | background | mode_overlap(radius=450)`. Read strictly, checked, and run."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import pairwise

from pico.diagnostics import Diagnostic, PicoError, did_you_mean, error
from pico.kernels.frame import Frame
from pico.kernels.kernel import Declaration, Given, Result
from pico.kernels.known import INTERFACE, kernel, modules
from pico.registered import intact

_NAME = r"[a-z][a-z0-9_]*"
_STEP = re.compile(rf"({_NAME})(?:\((.*)\))?")
_PARAMETER = re.compile(rf"({_NAME})\s*=\s*([-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?)")
_LONGEST = 500
_HINT = "expected a measurable and kernels, such as `image | background | mode_overlap(radius=450)`"


@dataclass(frozen=True)
class Step:
    """A kernel by name, with what it is told."""

    name: str
    parameters: Mapping[str, float]


@dataclass(frozen=True)
class Pipeline:
    """The measurable that all begins with, and the kernels in their order, one at least."""

    source: str
    steps: tuple[Step, ...]

    @property
    def last(self) -> Declaration:
        """What the last kernel gives."""
        return kernel(self.steps[-1].name).KERNEL


def parsed(text: str) -> Pipeline:
    """Return the pipeline that a text says, with the defaults of its kernels; raises `PicoError` where it says none."""
    words = [word.strip() for word in text.split("|")]
    if len(text) > _LONGEST or len(words) < 2 or not re.fullmatch(_NAME, words[0]):
        raise _wrong(f"`{text[:60]}` is no pipeline of kernels", _HINT)
    steps = tuple(_step(word) for word in words[1:])
    for before, after in pairwise(steps):
        gives, takes = kernel(before.name).KERNEL.gives, kernel(after.name).KERNEL.takes
        if gives != takes:
            raise _wrong(f"`{after.name}` takes {_a(takes)}, and `{before.name}` gives {_a(gives)}", _takers(gives))
    return Pipeline(words[0], steps)


def spelt(address: str) -> str:
    """Return a measurable, or kernels in a row (`image|centroid`), with or without its component, with the same spaces
    however a person writes it: `image | centroid`."""
    return " | ".join(word.strip() for word in address.split("|"))


def source_of(address: str) -> str:
    """Return what a measurement is made of by kernels, where it is: `cam.image` of `cam.image | centroid`."""
    return address.partition("|")[0].strip()


def misfit(pipeline: Pipeline, given: str) -> Diagnostic | None:
    """Return what is wrong where the pipeline begins with a `given` (such as `image`) that its kernel can't take."""
    first = pipeline.steps[0].name
    takes = kernel(first).KERNEL.takes
    if takes == given:
        return None
    text = f"`{first}` takes {_a(takes)}, and `{pipeline.source}` gives {_a(given)}"
    return error("kernel", text, hint=_takers(given))


def require_numbers(pipeline: Pipeline) -> None:
    """Raise PicoError where kernels that begin with a picture can't take it, or make no numbers of it."""
    if problem := misfit(pipeline, "image"):
        raise PicoError(problem)
    if not pipeline.last.units:
        raise _pictured(pipeline)


def _pictured(pipeline: Pipeline) -> PicoError:
    return _wrong(f"`{pipeline.steps[-1].name}` gives an image, no number", "append a kernel such as `| centroid`")


def run(pipeline: Pipeline, given: Given) -> Result:
    """Return what the kernels make of what is given.

    Raises `PicoError` where the first can't take that, or the last gives an image.
    """
    if problem := misfit(pipeline, "image" if isinstance(given, Frame) else "readings"):
        raise PicoError(problem)
    for step in pipeline.steps:
        module = kernel(step.name)
        made = module.apply(given, step.parameters)
        if isinstance(made, Result):
            made = _finite(made)
            masked = given.remark if isinstance(given, Frame) and "defects" in vars(given) and not made.unknown else ""
            remark = "; ".join(words for words in (made.remark, masked) if words)
            declared = module.KERNEL
            return replace(made, units=declared.units, kernel=step.name, version=declared.version, remark=remark)
        given = made
    raise _pictured(pipeline)


def _finite(made: Result) -> Result:
    """A value that is no number is no value."""
    bad = [name for name, value in {**made.sigma, **made.value}.items() if not math.isfinite(value)]
    return Result(unknown=f"the {bad[0]} came out as no number") if bad else made


def _step(word: str) -> Step:
    found = _STEP.fullmatch(word)
    if not found:
        raise _wrong(f"`{word[:40]}` is no kernel", _HINT)
    name, told = found[1], (found[2] or "").strip()
    if name not in modules():
        known = sorted(modules())
        raise _wrong(
            f"there is no kernel `{name[:40]}`", did_you_mean(name[:40], known) or f"known: {', '.join(known)}"
        )
    return Step(name, _parameters(name, told))


def _parameters(name: str, told: str) -> dict[str, float]:
    """The parameters of a kernel, those that are told and the defaults of the others."""
    declared = kernel(name).KERNEL.parameters
    values = {n: p.default for n, p in declared.items()}
    given: set[str] = set()
    for word in told.split(",") if told else ():
        found = _PARAMETER.fullmatch(word.strip())
        if not found or found[1] in given:
            hint = "expected each parameter once, as `name=number`"
            raise _wrong(f"`{word.strip()[:40]}` is no parameter of `{name}`", hint)
        if found[1] not in declared:
            hint = did_you_mean(found[1][:40], declared) or f"`{name}` has none"
            raise _wrong(f"`{name}` has no parameter `{found[1][:40]}`", hint)
        given.add(found[1])
        values[found[1]] = _number(name, found[1], float(found[2]))
    if missing := [n for n, value in values.items() if value is None]:
        hint = f"expected `{name}({', '.join(f'{n}=' for n in missing)})`, each a number [{declared[missing[0]].unit}]"
        raise _wrong(f"`{name}` is not told its `{missing[0]}`", hint)
    return {n: value for n, value in values.items() if value is not None}


def _number(name: str, parameter: str, value: float) -> float:
    least = kernel(name).KERNEL.parameters[parameter].least
    if not math.isfinite(value) or (least is not None and value <= least):
        raise _wrong(
            f"the {parameter} of `{name}` is {value:g}", f"expected above {least:g}" if least is not None else ""
        )
    return value


def _takers(gives: str) -> str:
    names = sorted(name for name, known in intact(INTERFACE)[0].items() if known.KERNEL.takes == gives)
    return f"of {_a(gives)}: {', '.join(names)}" if names else "nothing follows after numbers"


def _a(kind: str) -> str:
    return "an image" if kind == "image" else f"a {kind}" if kind in ("pose", "float", "setpoint") else kind


def _wrong(summary: str, hint: str) -> PicoError:
    return PicoError(error("kernel", summary, hint=hint))
