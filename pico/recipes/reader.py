"""Reading the values of a step: each as a term of the kind that is wanted, or a diagnostic that says what is wrong."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, replace
from typing import Any

from pico.diagnostics import Diagnostic, PicoError, did_you_mean, error, slot_meant
from pico.expressions import RESERVED, ExpressionError, Kind
from pico.kernels.measured import units_by
from pico.kernels.pipeline import source_of
from pico.manifest.text.names import name_problem
from pico.manifest.text.tree import Document, List, Map, Node, Scalar, plain
from pico.manifest.text.within import inside, places_of
from pico.manifest.values import read_value
from pico.manifest.wording import expected_quantity, quantity, shown
from pico.model.catalog import Tunable
from pico.model.quantities import QuantityError, convert
from pico.model.setpoint import STEP, canonical
from pico.model.setup import Setup
from pico.model.vocabulary import numbers_of
from pico.recipes.recipe import Name
from pico.recipes.scope import Scope, even, function_names, spaced
from pico.recipes.terms import INSIDE, Term, literal, text_term

NOTHING = Term()
"""What stands for a value that could not be read; then there is a diagnostic."""
_WORDS = {
    "number": "a number", "bool": "true or false", "text": "text", "numbers": "a list of numbers",
    "texts": "a list of texts", "list": "a list", "any": "a value",
}  # fmt: skip
RANGE = "`{from: 0, to: 45, step: 5}`, or `count: 10` instead of the step"
LISTED = "`pico recipe steps` lists what expressions may have, after the steps"
NAMES = "letters, digits, `-`, `_`"
_QUANTITY = re.compile(r"\s*[-+]?\d")
_WORD = re.compile(r"[A-Za-z_]\w*(?:\.[A-Za-z_]\w*)*")


@dataclass(frozen=True)
class Able:
    """What a bench can do, and which revisions there are, as far as anybody knows: `measurables` by address, None for
    all that its types have; `revision`: whether there is one of that name."""

    measurables: frozenset[str] | None = None
    revision: Callable[[str], bool] = lambda _: True


class Reader:
    """Reads the values of one recipe against a bench; `found` collects what is wrong."""

    def __init__(
        self,
        document: Document,
        setup: Setup,
        found: list[Diagnostic],
        able: Able = Able(),
        made: set[str] | None = None,
    ) -> None:
        self.document, self.setup, self.found, self.able = document, setup, found, able
        self.made = set[str]() if made is None else made
        """Branches and tags that steps before made."""
        self.mark, self.lost = 0, set[str]()
        """How much was wrong before the step that is read; names of results of which nobody knows what they are, for
        something is wrong with their step: that is said, and nothing of who speaks of them."""

    def wrong(self, node: Node, code: str, summary: str, hint: str = "", label: str = "") -> Term:
        """Say what is wrong at a node; return a term that stands for it."""
        self.found.append(error(code, summary, hint=hint, label=label, source=self.at(node)))
        return NOTHING

    def at(self, node: Node) -> Any:
        """Return where a node stands; of a block its first key."""
        if isinstance(node, Map) and node.entries and not node.flow:
            node = next(iter(node.entries.values()))[0]
        return self.document.source.range(node.start, node.end)

    # values

    def number(
        self, scope: Scope, node: Node, what: str, unit: str = "", low: float | None = None, high: float | None = None
    ) -> Term:
        """Return a number in `unit`: written out, with a unit, or an expression."""
        if not isinstance(node, Scalar) or isinstance(node.value, bool) or node.value is None:
            told = shown(plain(node))
            return self.wrong(node, "type", f"{what} is {told}, not a number", label=expected_quantity(unit))
        if _is_number(node, unit):
            value, code, said = quantity(what, node.value, unit)
            if value is None:
                return self.wrong(node, code, said, label=expected_quantity(unit))
            if (low is not None and value < low) or (high is not None and value > high):
                limits = f"expected {_limit(low)} to {_limit(high)} {unit}".rstrip()
                return self.wrong(node, "range", f"{what} is out of range: {value:g} {unit}".rstrip(), label=limits)
            return literal(value)
        return self.expression(scope, node, "number", what, unit)

    def stepping(
        self, scope: Scope, node: Node, now: str, what: str, unit: str = "", low: float | None = None,
        high: float | None = None,
    ) -> Term:  # fmt: skip
        """Return a number, or a step from the present value, whose name in expressions is `now`: `+=5`, `-= tilt`."""
        step = STEP.fullmatch(node.text) if isinstance(node, Scalar) else None
        if step is None or not isinstance(node, Scalar):
            return self.number(scope, node, what, unit, low, high)
        places = places_of(self.document.source.content, node)
        by = self.number(scope, Scalar(step[2], "", places[step.start(2)], places[-1]), f"the step of {what}", unit)
        return by if by is NOTHING else self._composed(scope, node, f"{now} {step[1]} {_source(by)}")

    def flag(self, scope: Scope, node: Node, what: str) -> Term:
        """Return something that is true or false."""
        if isinstance(node, Scalar) and isinstance(node.value, bool):
            return literal(node.value)
        return self.expression(scope, node, "bool", what)

    def tunable(self, scope: Scope, component: str, name: str, kind: Tunable, node: Node) -> Term:
        """Return a value of a tunable, in its unit and range where it is written out."""
        source = self.document.source
        if kind.datatype == "float":
            low, high = kind.range or (None, None)
            if isinstance(node, Scalar) and _is_number(node, kind.unit):
                found = read_value(source, component, name, kind, node)
                return self._told(found) if isinstance(found, Diagnostic) else literal(found)
            return self.stepping(scope, node, f"{component}.{name}", f"{name} of {component}", kind.unit, low, high)
        if kind.datatype == "bool":
            return self.flag(scope, node, f"{name} of {component}")
        if isinstance(node, Scalar) and INSIDE.search(node.text):
            return self.text(scope, node, f"{name} of {component}")
        choice = read_value(source, component, name, kind, node)
        return self._told(choice) if isinstance(choice, Diagnostic) else literal(choice)

    def all_of_tunable(self, scope: Scope, component: str, name: str, kind: Tunable, node: Node) -> tuple[Term, Name]:
        """Return the values that a tunable takes, in its unit, and in its range as far as they are known."""
        term, each = self.values(scope, node, f"{name} of {component}", kind.unit)
        if kind.datatype != "float":
            return self.wrong(node, "type", f"{component}.{name} is no number"), Name("number")
        low, high = kind.range or (-math.inf, math.inf)
        known = [canonical(kind, v) for v in term.literal] if isinstance(term.literal, list) else []
        beyond = [v for v in known if not low <= v <= high]
        if beyond:
            text = f"{beyond[0]:g} {kind.unit} is outside of the range of {component}.{name}"
            self.wrong(node, "range", text, f"{low:g} to {high:g} {kind.unit}")
        return term, each

    def text(self, scope: Scope, node: Node, what: str, *, empty: bool = False) -> Term:
        """Return a text, with the expressions in it."""
        if not isinstance(node, Scalar) or (not node.text.strip() and not empty):
            return self.wrong(node, "type", f"{what} is {shown(plain(node))}, not a text")
        try:
            return self._sure(scope, node, text_term(node.text, scope.language))
        except ExpressionError as exc:
            return self._mistake(node, exc, what)

    def values(self, scope: Scope, node: Node, what: str, unit: str = "") -> tuple[Term, Name]:
        """Return a list of values with what each is: written out (numbers, expressions, or texts), a range
        (`{from: 0, to: 45, step: 5}`, or `count:`, each of them an expression), or an expression."""
        if isinstance(node, Map):
            return self._range(scope, node, what, unit), Name("number", unit)
        if isinstance(node, Scalar):
            return self._listed(scope, node, what, unit)
        items = [i for i in node.items if isinstance(i, Scalar)]
        if len(items) < len(node.items):
            return self.wrong(node, "type", f"{what} is no list of numbers or texts"), Name("number", unit)
        if not unit and any(isinstance(i.value, str) for i in items):
            return self._mixed(scope, node, what, items)
        terms = [self.number(scope, item, f"each of {what}", unit) for item in items]
        if NOTHING in terms:
            return NOTHING, Name("number", unit)
        known = all(t.known for t in terms)
        found = literal([t.literal for t in terms]) if known else self._composed(scope, node, _in_list(terms))
        return found, Name("number", unit)

    def _mixed(self, scope: Scope, node: Node, what: str, items: list[Scalar]) -> tuple[Term, Name]:
        """Return a list with texts in it: expressions, or none of them a number, as they stand."""
        kinds, wrong = list[Kind](), list[tuple[Scalar, ExpressionError]]()
        for item in items:
            try:
                kinds.append(scope.language.kind_of(item.text)[0])
            except ExpressionError as exc:
                wrong.append((item, exc))
        if wrong and not {"number", "numbers"} & set(kinds):
            return literal([i.text for i in items]), Name("text")
        if wrong:
            hint = "a text among numbers has quotes of its own: `\"'e1'\"`"
            return self._mistake(*wrong[0], f"each of {what}", hint), Name("number")
        for item, kind in zip(items, kinds, strict=True):
            if kind != kinds[0] or kind not in ("number", "text"):
                text = f"`{item.text[:40]}` is {_WORDS[kind]}: {what} has numbers in it, or texts"
                return self.wrong(item, "type", text), Name("number")
        return self._composed(scope, node, f"[{', '.join(i.text for i in items)}]"), Name(kinds[0])

    def _listed(self, scope: Scope, node: Scalar, what: str, unit: str) -> tuple[Term, Name]:
        """Return a list that is an expression."""
        try:
            kind, expression = scope.language.kind_of(node.text)
        except ExpressionError as exc:
            return self._mistake(node, exc, what), Name("number", unit)
        if kind not in ("numbers", "texts"):
            told = f"{what} is {_WORDS[kind]}, not a list of values"
            return self.wrong(node, "type", told, f"`[0, 5, 10]`, or {RANGE}"), Name("number", unit)
        known, term = scope.name(node.text), self._sure(scope, node, Term(parts=(expression,)))
        return term, Name("number" if kind == "numbers" else "text", known.unit if known else unit)

    def _composed(self, scope: Scope, node: Node, text: str) -> Term:
        """Return the term of an expression that was made of ones that are right."""
        try:
            return self._sure(scope, node, Term(parts=(scope.language.kind_of(text)[1],)))
        except ExpressionError as exc:
            return self.wrong(node, "expression", f"`{text[:60]}` can't be told: {exc}", exc.hint)

    def _range(self, scope: Scope, node: Map, what: str, unit: str) -> Term:
        """Return a range: `from` and `to` are in it, values are `step` apart, or as many as `count` says."""
        last = "step" if "step" in node.entries else "count"
        if set(node.entries) != {"from", "to", last}:
            return self.wrong(node, "range", f"{what} is no range", RANGE)
        given = {
            k: self.number(scope, node.entries[k][1], f"{k} of {what}", "" if k == "count" else unit)
            for k in ("from", "to", last)
        }
        terms = list(given.values())
        if NOTHING in terms:
            return NOTHING
        if not all(t.known for t in terms):
            function = "range" if last == "step" else "linspace"
            return self._composed(scope, node, f"{function}({', '.join(map(_source, terms))})")
        try:
            return literal((spaced if last == "step" else even)(*(t.literal for t in terms)))
        except ValueError as exc:
            return self.wrong(node, "range", f"{what}: {exc}")

    def expression(self, scope: Scope, node: Node, kind: Kind, what: str, unit: str = "") -> Term:
        """Return an expression whose value is of a kind, in `unit` where it is a number that has one."""
        if not isinstance(node, Scalar) or not node.text.strip():
            return self.wrong(node, "type", f"{what} is {shown(plain(node))}, not {_WORDS[kind]}")
        text = node.text.strip()
        before = node.text.find(text)
        if (whole := INSIDE.fullmatch(text)) is not None:
            text, before = whole[1], before + whole.start(1)
        try:
            found = scope.language.compile(text, kind)
            told = scope.language.kind_of(text)[0]
        except ExpressionError as exc:
            hint = expected_quantity(unit) if kind == "number" and exc.end - exc.start >= len(text) else ""
            return self._mistake(node, exc, what, hint, before)
        if told == "any" and kind != "any":
            return self.wrong(node, "type", f"nobody can tell beforehand that {what} is {_WORDS[kind]}: `{text[:40]}`")
        self._same_unit(scope, node, text, what, unit)
        return self._sure(scope, node, Term(parts=(found,)))

    def any(self, scope: Scope, node: Node, what: str) -> tuple[Term, Name]:
        """Return a value of whatever kind, with what it is: a number, true or false, a list, an expression, or a
        text with expressions in it."""
        if isinstance(node, List):
            term, each = self.values(scope, node, what)
            return term, Name("texts" if each.kind == "text" else "numbers", each.unit)
        if not isinstance(node, Scalar) or node.value is None:
            return self.wrong(node, "type", f"{what} is {shown(plain(node))}: no value"), Name("number")
        if isinstance(node.value, bool | int | float):
            return literal(node.value), Name("bool" if isinstance(node.value, bool) else "number")
        if INSIDE.search(node.text):
            return self.text(scope, node, what, empty=True), Name("text")
        return self._told_by(scope, node, what)

    def _told_by(self, scope: Scope, node: Scalar, what: str) -> tuple[Term, Name]:
        try:
            kind, found = scope.language.kind_of(node.text)
        except ExpressionError as exc:
            hint = "a text stands in quotes of its own: `\"'e1'\"`" if is_name(node.text.replace(" ", "-")) else ""
            return self._mistake(node, exc, what, hint), Name("number")
        if kind == "any" or (kind == "list" and node.text.replace(" ", "") != "[]"):
            told = f"nobody can tell beforehand what {what} is: `{node.text[:40]}`"
            return self.wrong(node, "type", told), Name("number")
        known, term = scope.name(node.text), self._sure(scope, node, Term(parts=(found,)))
        return term, Name("numbers" if kind == "list" else kind, known.unit if known else "")

    # names

    def keys(self, node: Map, known: Collection[str], what: str) -> None:
        """Say which keys of a mapping there are not."""
        before = ""
        for key, (at, value) in node.entries.items():
            if key not in known:
                cut = before and node.flow and isinstance(value, Scalar) and value.start == value.end
                hint = f"in `{{}}` a comma ends a text: put quotes around that of `{before}`" if cut else ""
                hint = hint or did_you_mean(key[:40], known)
                self.wrong(at, "unknown-key", f"unknown key `{key[:40]}` in {what}", hint)
            else:
                before = key

    def component(self, node: Node, word: str) -> bool:
        """Say where there is no component of that name; return whether there is."""
        if word in self.setup.lab.inventory:
            return True
        hint = did_you_mean(word[:40], self.setup.lab.inventory) or "`pico catalog parts` lists them"
        self.wrong(node, "unknown-component", f"there is no component `{word[:40]}` in {self.setup.lab.name}", hint)
        return False

    def tunable_at(self, node: Node, address: str) -> tuple[str, str, Tunable] | None:
        """Return component, name and kind of the tunable at an address, None where there is none, which is said."""
        component, _, name = address.partition(".")
        if not self.component(node, component):
            return None
        kinds = self.setup.type_of(component).tunables
        if name in kinds:
            return component, name, kinds[name]
        if not name and kinds:
            text = f"`{component}` is a component: one of its tunables is wanted"
            self.wrong(node, "unknown-tunable", text, f"`{component}.{next(iter(kinds))}`, on one line")
            return None
        hint = did_you_mean(name[:40], kinds) or f"it has: {', '.join(kinds) or 'none'}"
        self.wrong(node, "unknown-tunable", f"{component} has no tunable `{name[:40]}`", hint)
        return None

    def measurable(self, node: Node, address: str) -> bool:
        """Say where there is no such measurable, or the bench can't measure it; return whether it can."""
        component, _, name = address.partition(".")
        known = self.setup.measurables_of(component)
        of, chained = source_of(name), "|" in name
        if not known:
            names = [*self.setup.lab.inventory, *self.setup.lab.cameras]
            hint = did_you_mean(component[:40], names) or "COMPONENT.MEASURABLE: `cam.centroid`"
            self.wrong(node, "unknown-component", f"there is no component `{component[:40]}` to be measured", hint)
        elif of not in known:
            hint = did_you_mean(of[:40], known) or f"it has: {', '.join(known)}"
            self.wrong(node, "unknown-measurable", f"{component} has no measurable `{of[:40]}`", hint)
        elif self.able.measurables is not None and f"{component}.{of}" not in self.able.measurables:
            self.wrong(node, "capability", f"this bench can't measure {component}.{of}")
        else:
            return not chained or self._kernels(node, component, name)
        return False

    def _kernels(self, node: Node, component: str, chain: str) -> bool:
        """Say what is wrong with kernels in a row; return whether they give numbers."""
        try:
            self.setup.measurable_of(component, chain)
        except PicoError as exc:
            self.found.extend(replace(d, source=self.at(node)) for d in exc.diagnostics)
            return False
        return True

    def numbers(self, address: str) -> dict[str, str]:
        """Return the numbers of a measurable, or of kernels in a row, each with its unit."""
        component, _, measurable = address.partition(".")
        kind = self.setup.measurable_of(component, measurable)
        if kind.kernel:
            return {n: "" if unit == "1" else unit for n, unit in units_by(kind.kernel, measurable).items()}
        return {n: kind.unit for n, m in numbers_of(self.setup, component).items() if m == measurable}

    def slot(self, node: Node, name: str) -> None:
        """Say that there is no slot of that name."""
        self.wrong(node, "unknown-slot", f"there is no slot `{name[:40]}`", slot_meant(name[:40], self.setup.lab.slots))

    def goal(self, node: Node, words: Sequence[str]) -> None:
        """Say what is wrong with a goal: one of the lab by its name, or a ready-made one with its parts."""
        from pico.bench.ready.registry import current, known, wrong_words

        goals = self.setup.lab.goals or {}
        if len(words) == 1 and words[0] in goals:
            return
        words = current(words)
        if words[0] not in known():
            hint = did_you_mean(words[0][:40], [*goals, *known()])
            self.wrong(node, "goal", f"{self.setup.lab.name} has no goal `{' '.join(words)[:60]}`", hint)
            return
        wrong = wrong_words(self.setup, words)
        self.found.extend(replace(d, source=self.at(node)) for d in wrong)

    def revision(self, scope: Scope, node: Node) -> Term:
        """Return the name of a revision that there is, or that a step before makes."""
        term = self.text(scope, node, "a revision")
        if term.known and term is not NOTHING and not (term.literal in self.made or self.able.revision(term.literal)):
            hint = "a branch, a tag or a commit: `pico log --oneline`"
            self.wrong(node, "unknown-revision", f"there is no revision `{str(term.literal)[:40]}`", hint)
        return term

    def new_revision(self, scope: Scope, node: Node, what: str) -> Term:
        """Return the name of a branch or tag that a step makes."""
        term = self.text(scope, node, f"the name of {what}")
        if term.known and term is not NOTHING:
            if not is_name(str(term.literal)):
                self.wrong(node, "name", f"`{str(term.literal)[:40]}` is no name of {what}", NAMES)
            self.made.add(str(term.literal))
        return term

    def addresses(self, node: Node) -> tuple[str, ...]:
        """Return components and tunables that a step is about; none for all."""
        if isinstance(node, Scalar) and node.value is None:
            return ()
        listed = scalar_texts(node)
        if listed is None:
            self.wrong(node, "type", "expected components or tunables", "`[p2, p1.angle]`")
        for at, text in listed or ():
            self.tunable_at(at, text) if "." in text else self.component(at, text)
        return tuple(text for _, text in listed or ())

    def new_name(self, node: Node, word: str, scope: Scope) -> bool:
        """Say where a name can't be given to a value; return whether it can."""
        problem = name_problem(word)
        if problem:
            self.wrong(node, "name", f"`{word[:40]}` is no name: {problem}")
        elif word in scope.bench:
            self.wrong(node, "name", f"`{word}` is a component of {self.setup.lab.name}", "give the value another name")
        elif word in RESERVED:
            self.wrong(node, "name", f"`{word}` is a word of expressions", f"give the value another name, `{word}_`")
        elif word in function_names():
            self.wrong(node, "name", f"`{word}` is a function of expressions", "give the value another name")
        else:
            return True
        return False

    def _sure(self, scope: Scope, node: Node, term: Term) -> Term:
        """Return a term with what it asks of the bench; say which numbers nothing measures before it."""
        words = term.words()
        for word in sorted(words):
            component, _, number = word.partition(".")
            if (
                not number
                or word in scope.own
                or word in scope.measured
                or number not in numbers_of(self.setup, component)
            ):
                continue
            hint = f"put `measure: {component}.{numbers_of(self.setup, component)[number]}` before it"
            return self.wrong(node, "unmeasured", f"nothing measures {word} before this step", hint)
        asks = (words & scope.bench.keys()) - scope.own.keys() - scope.measured
        return replace(term, asks=tuple(sorted(asks))) if asks else term

    def _same_unit(self, scope: Scope, node: Node, text: str, what: str, unit: str) -> None:
        """Say where a name alone stands for a number in another unit: nothing is converted in expressions."""
        known = scope.name(text) if _WORD.fullmatch(text) else None
        if known is not None and known.unit and unit and known.unit != unit:
            hint = f"declare `{text}` in {unit}" if text in scope.own else expected_quantity(unit)
            self.wrong(node, "unit", f"{what} is in {unit}, and `{text}` in {known.unit}", hint)

    def _told(self, found: Diagnostic) -> Term:
        self.found.append(found)
        return NOTHING

    def _mistake(self, node: Scalar, exc: ExpressionError, what: str, hint: str = "", before: int = 0) -> Term:
        """Say what is wrong with an expression that stands in a scalar after so many of its characters."""
        if self.lost & {word.partition(".")[0] for word in _WORD.findall(node.text)}:
            return NOTHING
        source = inside(self.document.source, node, before + exc.start, before + exc.end)
        self.found.append(
            error("expression", f"{what} can't be told: {exc}", hint=exc.hint or hint or LISTED, source=source)
        )
        return NOTHING


def is_name(text: str) -> bool:
    """Return whether a branch or a tag may be called so."""
    return re.fullmatch(r"(?!-)[A-Za-z0-9._/-]+(?<![./])", text) is not None and ".." not in text


def _is_number(node: Scalar, unit: str) -> bool:
    """Return whether a scalar is a number, or one with a unit, right or wrong, and no expression."""
    if isinstance(node.value, int | float):
        return not isinstance(node.value, bool)
    return bool(_QUANTITY.match(node.text)) and _is_quantity(node.text, unit)


def _is_quantity(text: str, unit: str) -> bool:
    """Return whether a text is a number with a unit, right or wrong, and no expression that begins with a number."""
    try:
        float(convert(text, unit))
    except QuantityError:
        return bool(re.fullmatch(r"\s*[-+]?[\d.]+(?:[eE][-+]?\d+)?\s*[A-Za-zµ°%][A-Za-z0-9µ°%/^*]*\s*", text))
    return True


def _in_list(terms: Sequence[Term]) -> str:
    return f"[{', '.join(map(_source, terms))}]"


def _source(term: Term) -> str:
    """Return a number that is right as a part of an expression."""
    text = term.parts[0].text if term.parts and not isinstance(term.parts[0], str) else repr(term.literal)
    return f"({text})"


def _limit(value: float | None) -> str:
    return "any" if value is None else f"{value:g}"


def scalar_texts(node: Node) -> Sequence[tuple[Scalar, str]] | None:
    """Return the texts of a scalar, or of each in a list of them, with their nodes; None for anything else."""
    items = node.items if isinstance(node, List) else [node]
    found = [(i, i.text) for i in items if isinstance(i, Scalar) and i.text]
    return found if found and len(found) == len(items) else None
