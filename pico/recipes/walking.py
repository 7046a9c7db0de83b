"""A recipe step by step: what is to be done next, with its values; told what came of it. No bench, no clock, no files.

What is asked for and told decides all that follows: a log of it, told again, leads to the same place without anything
being done.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Generator, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from pico.diagnostics import Diagnostic, ExitCode, PicoError, SourceRange, error
from pico.expressions import ExpressionError, UnknownValue
from pico.recipes.recipe import (
    MOST_ITEMS,
    MOST_TURNS,
    Act,
    Assert,
    Call,
    Choice,
    Each,
    Let,
    Recipe,
    Scan,
    Step,
    While,
    blocks,
)
from pico.recipes.scanning import apart, column, columns, row
from pico.recipes.terms import Term


@dataclass(frozen=True)
class Ask:
    """What is to be done: an act (`step`, with the values `given`), at `path`: `3[2].1`, the first step in the third
    turn of step 3. Without a step the values of `names` of the bench are asked for."""

    path: str
    step: Act | None = None
    given: Mapping[str, Any] = field(default_factory=dict)
    names: tuple[str, ...] = ()


class _Unknown:
    """A value that only a measurement will tell."""


UNKNOWN = _Unknown()
Told = Mapping[str, Any]
"""What came of an act, as JSON data: its result by name, `measurements` by address; or values by name."""
Walk = Generator[Ask, Told, dict[str, Any]]


@dataclass(frozen=True)
class Entered:
    """A step that is begun, for who watches: `depth` of blocks around it; `turn`: which one of how many (None: nobody
    knows) of a loop; `title`: of the step, where values stand in it."""

    path: str
    step: Step
    depth: int
    values: Mapping[str, Any] = field(default_factory=dict)
    turn: tuple[int, int | None] | None = None
    title: str = ""
    known: bool = True

    @property
    def said(self) -> str:
        """What it does, in words, with the values that are known of them."""
        return self.title or self.step.title


def walk(
    recipe: Recipe, arguments: Mapping[str, Any], enter: Callable[[Entered], None] = lambda _: None, *,
    ahead: Callable[[Step], None] | None = None, failing: Callable[[str], None] = lambda _: None,
) -> Walk:  # fmt: skip
    """Walk a recipe with all its parameters given; return what it `returns`.

    `failing`: called with the path of the step that failed, before those of `finally`.

    `ahead`: nothing is done yet, and what is measured is not known: what depends on it is left out, what that would
    change is not known from there on, such steps are entered as not `known`, and `ahead` hears of each act and scan
    among them.

    Throw PicoError in where an act failed: the steps of `finally` are then asked for, and it comes out again. Raises
    PicoError for an assertion that does not hold (exit code EXPECTATION), for a loop beyond its bound, and for an
    expression without a value.
    """
    return (yield from _Walker(enter, ahead, failing).recipe(recipe, arguments, "", 0))


@dataclass
class _Names:
    """Values by name where a step stands: a block sees those around it, and what it changes of them stays changed."""

    own: dict[str, Any]
    around: _Names | None = None

    def all(self) -> dict[str, Any]:
        return {**(self.around.all() if self.around else {}), **self.own}

    def give(self, name: str, value: Any) -> None:
        place: _Names | None = self
        while place is not None and name not in place.own:
            place = place.around
        (place or self).own[name] = value


class _Walker:
    def __init__(
        self, enter: Callable[[Entered], None], ahead: Callable[[Step], None] | None, failing: Callable[[str], None]
    ) -> None:
        self.enter, self.ahead, self.failing, self.turns = enter, ahead, failing, 0
        self.begun = ""
        """The path of the step that was begun last, of which nothing may have been evaluated yet."""
        self.measured: dict[str, float] = {}
        self.looked: dict[str, Any] = {}
        """Names of the bench with their values as the step asked for them that is begun."""
        self.spoken: Mapping[str, Any] = {}
        """Names with their values of which the last condition spoke."""

    def titled(self, step: Step, names: _Names) -> str:
        """Return the title of a step with the values that are known of it; empty where it is as it is written."""
        if step.says is None:
            return ""
        own = {name: value for name, value in names.all().items() if value is not UNKNOWN}
        return step.says.as_far_as({**self.measured, **self.looked, **own})

    def recipe(self, recipe: Recipe, arguments: Mapping[str, Any], at: str, depth: int) -> Walk:
        names = _Names(dict(arguments))
        try:
            yield from self.block(recipe.steps, names, at, depth)
        except GeneratorExit:
            raise
        except BaseException as failed:
            self.failing(self.begun)
            try:
                yield from self.block(recipe.finally_, _Names(dict(arguments)), f"{at}finally.", depth)
            except PicoError as again:
                if isinstance(failed, PicoError):
                    raise PicoError([*failed.diagnostics, *again.diagnostics], failed.exit_code) from again
                raise
            raise
        yield from self.block(recipe.finally_, _Names(dict(arguments)), f"{at}finally.", depth)
        found = {}
        for name, term in recipe.returns.items():
            found[name] = yield from self.value(term, names, f"{at}returns.{name}", None)
        return found

    def block(self, steps: tuple[Step, ...], names: _Names, at: str, depth: int) -> Walk:
        for step in steps:
            path = self.begun = at + step.at.rpartition(".")[2]
            self.looked = {}
            if isinstance(step, Act):
                yield from self.act(step, names, path, depth)
            elif isinstance(step, Each):
                yield from self.each(step, names, path, depth)
            elif isinstance(step, Scan):
                yield from self.scan(step, names, path, depth)
            elif isinstance(step, While):
                yield from self.again(step, names, path, depth)
            elif isinstance(step, Choice):
                holds = yield from self.holds(step, step.that, names, path)
                if holds is None:
                    self.left_out(step, names, path, depth)
                    continue
                self.enter(Entered(path, step, depth, {**self.spoken, "holds": holds}))
                inner, branch = (step.then, f"{path}.") if holds else (step.otherwise, f"{path}.else.")
                yield from self.block(inner, _Names({}, names), branch, depth + 1)
            elif isinstance(step, Call):
                yield from self.call(step, names, path, depth)
            elif isinstance(step, Let):
                for name, term in step.values.items():
                    names.give(name, (yield from self.value(term, names, f"{path}.{name}", step.source)))
                values = {n: names.all()[n] for n in step.values}
                known = not _unknown(values)
                self.enter(Entered(path, step, depth, values, title=self.titled(step, names), known=known))
            elif isinstance(step, Assert):
                yield from self.require(step, names, path, depth)
        return {}

    def act(self, step: Act, names: _Names, path: str, depth: int) -> Walk:
        given = yield from self.filled(step.given, names, path, step.source)
        if _unknown(given):
            self.left_out(step, names, path, depth)
            return {}
        self.enter(Entered(path, step, depth, given, title=self.titled(step, names)))
        told = yield Ask(path, step, given)
        self.hear(told)
        for part in step.names if step.binds else ():
            if part in told or self.ahead:
                names.give(f"{step.binds}.{part}" if part else step.binds, told.get(part, UNKNOWN))
        return {}

    def hear(self, told: Told) -> None:
        """Remember what was measured, by the address of each number."""
        for address, found in told.get("measured", {}).items():
            component, _, measurable = address.partition(".")
            self.measured = {k: v for k, v in self.measured.items() if not k.startswith(f"{address}.") and k != address}
            value = found.get("value")
            for number, one in value.items() if isinstance(value, Mapping) else ((measurable, value),):
                if isinstance(one, int | float) and not isinstance(one, bool):
                    self.measured[f"{component}.{_full(measurable, number)}"] = float(one)

    def scan(self, step: Scan, names: _Names, path: str, depth: int) -> Walk:
        lists = []
        for address, term in step.over.items():
            lists.append((yield from self.value(term, names, f"{path}.{address}", step.source)))
        if _unknown(lists):
            self.left_out(step, names, path, depth)
            return {}
        turns = self.combined(step, lists)
        rows: list[dict[str, float]] = []
        point, last, taken, part = dict[str, Any](), dict[str, float](), 0, 0.0
        for n, values in enumerate(turns):
            self.count(step)
            before, point = point, dict(zip(step.over, values, strict=True))
            self.enter(Entered(path, step, depth, point, (n + 1, len(turns))))
            told = yield from self.point(step, point, f"{path}[{n + 1}]", depth)
            if last and told.get("taken_up", 0) > taken:
                again = yield from self.point(step, before, f"{path}[{n + 1}].again", depth)
                part += apart(last, row(again))
            taken = told.get("taken_up", 0)
            last = {**{column(a): v for a, v in point.items()}, **row(told), "part": part}
            if step.required or all(one.get("value") is not None for one in told.get("measured", {}).values()):
                rows.append(last)
        found = columns(rows)
        for name in step.names if step.binds else ():
            names.give(f"{step.binds}.{name}", found.get(name, UNKNOWN if self.ahead else []))
        return {}

    def point(self, step: Scan, values: Mapping[str, Any], path: str, depth: int) -> Generator[Ask, Told, Told]:
        """Set what is scanned, and measure there."""
        told: Told = {}
        asked = (
            ("set", values, ", ".join(f"{a}: {v:g}" for a, v in values.items())),
            ("measure", {"of": step.of} | ({} if step.required else {"required": False}), ", ".join(step.of)),
        )
        for kind, given, title in asked:
            act = Act(at=step.at, title=f"{kind} {title}", source=step.source, retries=step.retries, kind=kind)
            self.enter(Entered(f"{path}.{kind}", act, depth + 1, given))
            told = yield Ask(f"{path}.{kind}", act, given)
            self.hear(told)
        return told

    def each(self, step: Each, names: _Names, path: str, depth: int) -> Walk:
        lists = []
        for name, term in step.over.items():
            lists.append((yield from self.value(term, names, f"{path}.{name}", step.source)))
        if _unknown(lists):
            self.left_out(step, names, path, depth)
            return {}
        turns = self.combined(step, lists)
        for n, values in enumerate(turns):
            self.count(step)
            own = dict(zip(step.over, values, strict=True))
            self.enter(Entered(path, step, depth, own, (n + 1, len(turns))))
            yield from self.block(step.steps, _Names(dict(own), names), f"{path}[{n + 1}].", depth + 1)
        return {}

    def again(self, step: While, names: _Names, path: str, depth: int) -> Walk:
        for n in range(step.most + 1):
            holds = yield from self.holds(step, step.that, names, f"{path}[{n + 1}]")
            if holds is None:
                self.left_out(step, names, path, depth)
            if not holds:
                return {}
            if n == step.most:
                break
            self.count(step)
            self.enter(Entered(path, step, depth, dict(self.spoken), (n + 1, step.most)))
            yield from self.block(step.steps, _Names({}, names), f"{path}[{n + 1}].", depth + 1)
        text = f"step {path} went round {step.most} times, and `{step.that.written if step.that else ''}` still holds"
        raise PicoError(
            _wrong("bound", text, step.source, "raise `most`, or mend what it waits for"), ExitCode.EXPECTATION
        )

    def call(self, step: Call, names: _Names, path: str, depth: int) -> Walk:
        assert step.recipe is not None
        given = yield from self.filled(step.given, names, path, step.source)
        arguments = {p.name: given.get(p.name, p.default) for p in step.recipe.parameters.values()}
        self.enter(Entered(path, step, depth, arguments))
        found = yield from self.recipe(step.recipe, arguments, f"{path}.", depth + 1)
        for name, value in found.items() if step.binds else ():
            names.give(f"{step.binds}.{name}", value)
        return {}

    def require(self, step: Assert, names: _Names, path: str, depth: int) -> Walk:
        holds = yield from self.holds(step, step.that, names, path)
        if holds is None:
            self.left_out(step, names, path, depth)
            return {}
        self.enter(Entered(path, step, depth, {**self.spoken, "holds": holds}))
        if holds:
            return {}
        said = ""
        if step.message is not None:
            said = str((yield from self.value(step.message, names, f"{path}.message", step.source)))
        assert step.that is not None
        text = said or f"`{step.that.written}` does not hold"
        raise PicoError(_wrong("assert", text, step.source, f"step {path}"), ExitCode.EXPECTATION)

    def left_out(self, step: Step, names: _Names, path: str, depth: int) -> None:
        """Take what a step changes for unknown, of which only a measurement will tell whether it is done, or with
        what; and so of the steps in it."""
        assert self.ahead is not None  # all is known where it is done
        self.enter(Entered(path, step, depth, known=False))
        for name in _given(step):
            names.give(name, UNKNOWN)
        if isinstance(step, Act | Scan):
            self.ahead(step)
        inside = list(blocks(step))
        if isinstance(step, Call) and step.recipe is not None:
            inside, names = [("", step.recipe.steps), ("finally", step.recipe.finally_)], _Names({})
        turn = "[1]" if isinstance(step, Each | While) else ""
        for word, inner in inside:
            at = f"{path}{turn}.{word}." if word in ("else", "finally") else f"{path}{turn}."
            for one in inner:
                self.left_out(one, names, at + one.at.rpartition(".")[2], depth + 1)

    # values

    def holds(self, step: Step, term: Term | None, names: _Names, path: str) -> Generator[Ask, Told, bool | None]:
        """Return whether something holds; None where only a measurement will tell."""
        assert term is not None
        found = yield from self.value(term, names, path, step.source)
        return None if found is UNKNOWN else bool(found)

    def filled(self, given: Any, names: _Names, path: str, source: SourceRange | None) -> Generator[Ask, Told, Any]:
        """Return what is given to a step with the values of its terms."""
        if isinstance(given, Term):
            return (yield from self.value(given, names, path, source))
        if isinstance(given, Mapping):
            found = {}
            for key, one in given.items():
                found[key] = yield from self.filled(one, names, f"{path}.{key}", source)
            return found
        return given

    def value(self, term: Term, names: _Names, path: str, source: SourceRange | None) -> Generator[Ask, Told, Any]:
        if term.known:
            return term.literal
        own = {name: value for name, value in names.all().items() if value is not UNKNOWN}
        known = {**{w: self.measured[w] for w in term.words() & self.measured.keys()}, **own}
        if term.asks:
            self.looked |= yield Ask(f"{path}?", names=term.asks)
            known |= {name: self.looked[name] for name in term.asks if name in self.looked}
        self.spoken = {
            w: known[w] for w in sorted(term.words() & known.keys()) if isinstance(known[w], bool | int | float)
        }
        try:
            found = term.value(known)
        except ExpressionError as exc:
            if self.ahead and isinstance(exc, UnknownValue):
                return UNKNOWN
            raise PicoError(
                _wrong("expression", f"`{term.written}` has no value: {exc}", source, f"step {path}")
            ) from exc
        if isinstance(found, list | str) and len(found) > MOST_ITEMS:
            text = f"`{term.written}` has {len(found)} items; a value has at most {MOST_ITEMS}"
            raise PicoError(_wrong("bound", text, source, "it is taken for one that runs away"))
        return found

    def combined(self, step: Step, lists: list[Any]) -> list[tuple[Any, ...]]:
        """Return all combinations of lists, the last fastest."""
        if (many := math.prod(map(len, lists))) > MOST_TURNS:
            text = f"this would go round {many} times; the loops of a recipe go round {MOST_TURNS} times in all"
            raise PicoError(_wrong("bound", text, step.source, "it is taken for one that runs away"))
        return list(itertools.product(*lists))

    def count(self, step: Step) -> None:
        self.turns += 1
        if self.turns > MOST_TURNS:
            text = f"the loops of this recipe have gone round {MOST_TURNS} times in all"
            raise PicoError(_wrong("bound", text, step.source, "it is taken for one that runs away"))


def _given(step: Step) -> Iterable[str]:
    """Return the names to which a step gives values."""
    if isinstance(step, Let):
        return step.values
    if isinstance(step, Call) and step.recipe is not None and step.binds:
        return [f"{step.binds}.{name}" for name in step.recipe.returns]
    if isinstance(step, Act | Scan) and step.binds:
        return [f"{step.binds}.{name}" if name else step.binds for name in step.names]
    return ()


def _unknown(given: Any) -> bool:
    """Return whether any value of what is given to a step is not known yet."""
    if isinstance(given, Mapping):
        return any(map(_unknown, given.values()))
    return any(map(_unknown, given)) if isinstance(given, list) else given is UNKNOWN


def _full(measurable: str, number: str) -> str:
    return number if number == measurable or number.startswith(f"{measurable}.") else f"{measurable}.{number}"


def _wrong(code: str, text: str, source: SourceRange | None, hint: str = "") -> Diagnostic:
    return error(code, text, hint=hint, source=source)
