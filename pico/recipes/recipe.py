"""A recipe that was read and checked: frozen steps whose values are terms. See docs/how-to/recipes.md."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import time
from typing import Any, Literal

from pico.diagnostics import Diagnostic, SourceRange
from pico.expressions import Kind
from pico.model.arming import LaserClass
from pico.model.trace.unattended import ENDS
from pico.recipes.terms import Term

MOST_ITEMS = 10_000
"""Items of a list, or characters of a text, that a value of a recipe may have."""
MOST_TURNS = 10_000
"""Turns that a recipe takes in all its loops together; more are a loop that runs away."""

EVERY = 600.0
"""After how long what stops a run is measured again [s], where a recipe does not say."""


@dataclass(frozen=True)
class Name:
    """What a name stands for in expressions: the kind of its value, and its unit where that is a number of one."""

    kind: Kind
    unit: str = ""


@dataclass(frozen=True)
class Parameter:
    """A value that whoever runs a recipe may give, in `unit`; `default` None: it must be given. Numbers lie from `low`
    to `high`, texts are one of `choices` where there are any; so is each item of a list."""

    name: str
    kind: Literal["number", "bool", "text", "numbers", "texts"]
    unit: str = ""
    default: Any = None
    low: float | None = None
    high: float | None = None
    choices: tuple[str, ...] = ()
    description: str = ""
    source: SourceRange | None = None


@dataclass(frozen=True)
class Step:
    """One step. `at`: its place in the recipe, `2.then.0`; `title`: what a person calls it, as it is written; `says`:
    the same with the values of the expressions in it (None: there are none); `retries`: how often it is tried again
    after a failure."""

    at: str
    title: str
    source: SourceRange | None = field(default=None, compare=False)
    retries: int = 0
    says: Term | None = None


@dataclass(frozen=True)
class Act(Step):
    """A step that does something on the bench or in Git: its `kind` is the name of a file of `steps/`, `given` what
    that reads; `binds`: the name under which its result is known afterwards, empty for none."""

    kind: str = ""
    given: Mapping[str, Any] = field(default_factory=dict)
    binds: str = ""
    names: Mapping[str, Name] = field(default_factory=dict)


@dataclass(frozen=True)
class Let(Step):
    """Names get values."""

    values: Mapping[str, Term] = field(default_factory=dict)


@dataclass(frozen=True)
class Assert(Step):
    """What must hold; `message`: what is said where it does not."""

    that: Term | None = None
    message: Term | None = None


@dataclass(frozen=True)
class Each(Step):
    """Steps for each value of a list, or each combination of several: the last name changes fastest."""

    over: Mapping[str, Term] = field(default_factory=dict)
    steps: tuple[Step, ...] = ()


@dataclass(frozen=True)
class Scan(Step):
    """Tunables are set to each value of a list, or each combination of several, and measurables measured there.
    `binds`: the name of what it finds; `names`: its columns. `required`: it fails where a measurable has no value;
    else that point is left out of the columns."""

    over: Mapping[str, Term] = field(default_factory=dict)
    of: tuple[str, ...] = ()
    binds: str = ""
    names: Mapping[str, Name] = field(default_factory=dict)
    required: bool = True


@dataclass(frozen=True)
class Choice(Step):
    """Steps where something holds, and others where it does not."""

    that: Term | None = None
    then: tuple[Step, ...] = ()
    otherwise: tuple[Step, ...] = ()


@dataclass(frozen=True)
class While(Step):
    """Steps again and again while something holds, `most` times at the most: then it has failed."""

    that: Term | None = None
    most: int = 1
    steps: tuple[Step, ...] = ()


@dataclass(frozen=True)
class Call(Step):
    """Another recipe, with arguments; it knows nothing of the names around it, and `binds` what it `returns`."""

    recipe: Recipe | None = None
    given: Mapping[str, Term] = field(default_factory=dict)
    binds: str = ""


@dataclass(frozen=True)
class Stop:
    """What stops a run: `when` something holds of what is measured for it (`of`, addresses), or a goal is `lost`."""

    text: str
    when: Term | None = None
    of: tuple[str, ...] = ()
    lost: str = ""
    source: SourceRange | None = None


@dataclass(frozen=True)
class Unattended:
    """The highest class that a laser may emit as; from when to when it may run, by the clock on the wall (over midnight
    where `begins` is later than `ends`); what stops it, measured again `every` so many seconds; how it leaves the
    bench."""

    laser_class: LaserClass
    begins: time
    ends: time
    stops: tuple[Stop, ...] = ()
    every: float = EVERY
    end: tuple[str, ...] = ENDS

    def covers(self, now: time) -> bool:
        """Return whether it may run at a time of day."""
        if self.begins <= self.ends:
            return self.begins <= now < self.ends
        return now >= self.begins or now < self.ends


@dataclass(frozen=True)
class Series:
    """What a figure draws, by the names of what its recipe returns: numbers, or lists as long as one another. `sigma`
    and `theory` are empty where there is none."""

    label: str
    x: str
    y: str
    sigma: str = ""
    theory: str = ""


@dataclass(frozen=True)
class Figure:
    """A figure of what a recipe returns: its series, and what its axes are called, `tilt of p2 [deg]`."""

    name: str
    title: str
    x: str
    y: str
    series: tuple[Series, ...] = ()


@dataclass(frozen=True)
class Recipe:
    """An experiment. `digest`: of its text and of those that it calls; `returns`: values that a call has by
    name, `returned` what they are; `unattended`: what it states of runs where nobody is there. `figures` of what it
    returns by name; `notes` stand on each. `told`: warnings about it."""

    name: str
    title: str = ""
    description: str = ""
    lab: str = ""
    parameters: Mapping[str, Parameter] = field(default_factory=dict)
    steps: tuple[Step, ...] = ()
    finally_: tuple[Step, ...] = ()
    returns: Mapping[str, Term] = field(default_factory=dict)
    returned: Mapping[str, Name] = field(default_factory=dict)
    figures: Mapping[str, Figure] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    digest: str = ""
    path: str = ""
    unattended: Unattended | None = None
    told: tuple[Diagnostic, ...] = ()


def blocks(step: Step) -> Sequence[tuple[str, tuple[Step, ...]]]:
    """Return the steps within a step, by what they are called."""
    if isinstance(step, Each | While):
        return (("steps", step.steps),)
    if isinstance(step, Choice):
        return (("then", step.then), ("else", step.otherwise))
    return ()


def paths(steps: Iterable[Step], at: str = "") -> Iterator[str]:
    """Yield the paths that steps and those within them have when they are run, without the turns of loops."""
    for step in steps:
        path = at + step.at.rpartition(".")[2]
        yield path
        if isinstance(step, Scan):
            yield from (f"{path}.set", f"{path}.measure")
        if isinstance(step, Call) and step.recipe is not None:
            yield from paths_of(step.recipe, f"{path}.")
        for name, inner in blocks(step):
            yield from paths(inner, f"{path}.else." if name == "else" else f"{path}.")


def paths_of(recipe: Recipe, at: str = "") -> Iterator[str]:
    """Yield the paths of all steps of a recipe, and of those that it calls, without the turns of loops."""
    yield from paths(recipe.steps, at)
    yield from paths(recipe.finally_, f"{at}finally.")
