"""Mutants of a module: its text with one thing in it that somebody might have got wrong.

What nobody's behaviour hangs on is passed over: docstrings, annotations, decorators, strings, and what is said by
diagnostics and exceptions.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

FLIPPED: dict[type[ast.cmpop], tuple[str, ...]] = {
    ast.Eq: ("==", "!="),
    ast.NotEq: ("!=", "=="),
    ast.Lt: ("<", "<=", ">="),
    ast.LtE: ("<=", "<", ">"),
    ast.Gt: (">", ">=", "<="),
    ast.GtE: (">=", ">", "<"),
    ast.Is: ("is", "is not"),
    ast.IsNot: ("is not", "is"),
    ast.In: ("in", "not in"),
    ast.NotIn: ("not in", "in"),
}
"""How a comparison is written, and what it may become."""

OPERATORS: dict[type[ast.operator], tuple[str, str]] = {
    ast.Add: ("+", "-"),
    ast.Sub: ("-", "+"),
    ast.Mult: ("*", "/"),
    ast.Div: ("/", "*"),
    ast.FloorDiv: ("//", "*"),
    ast.Mod: ("%", "*"),
    ast.BitAnd: ("&", "|"),
    ast.BitOr: ("|", "&"),
    ast.LShift: ("<<", ">>"),
    ast.RShift: (">>", "<<"),
}
SAYS = {"error", "warning", "note", "info", "Diagnostic", "PicoError", "print"}
"""Calls whose arguments are words for people."""
TOLD = {"message", "hint", "help", "text", "why", "maxsize", "strict"}
"""Keywords whose values are words for people, or matter to nobody's behaviour."""
_ROUNDING = 1e-5  # numbers below only cover what doubles round
UNSEEN = ("annotation", "returns", "decorator_list", "type_params")
SYMMETRIC = {"min", "max", "hypot", "isclose", "gcd", "dist"}
"""Calls whose arguments may change places."""


@dataclass(frozen=True)
class Mutant:
    """A module's text with `right`, which begins at a byte, made `wrong`; `line` counts from one, as does `first`, the
    line where the statement begins.

    `function` is the outermost function that holds it, "" for what runs at import, where `name` is what it gives a
    value to.
    """

    file: str
    start: int
    right: str
    wrong: str
    kind: str
    line: int
    first: int
    function: str = ""
    name: str = ""

    def apply(self, text: str) -> str:
        """Return the module's text with the mutation in it."""
        data, end = text.encode(), self.start + len(self.right.encode())
        return (data[: self.start] + self.wrong.encode() + data[end:]).decode()


def mutants(file: str, text: str) -> Iterator[Mutant]:
    """Yield each mutant of a module, in the order of the text."""
    yield from _Module(file, text).mutants()


def planted(file: str, text: str, right: str, wrong: str) -> Mutant:
    """Return the mutant that has `wrong` for what stands once in a module's text."""
    start = text.encode().index(right.encode())
    line = text.encode()[:start].count(b"\n") + 1
    found = [
        (place.lineno, function)
        for place, _, function, _ in _walk(ast.parse(text))
        if isinstance(place, ast.stmt) and place.lineno <= line <= (place.end_lineno or 0)
    ]
    first, function = max(found)
    return Mutant(file, start, right, wrong, "by hand", line, first, function)


def is_python(text: str) -> bool:
    """Return whether a text compiles."""
    try:
        compile(text, "mutant", "exec", dont_inherit=True)
    except SyntaxError:
        return False
    return True


@dataclass(frozen=True)
class _Module:
    file: str
    text: str

    @cached_property
    def starts(self) -> list[int]:
        found = [0]
        for line in self.text.encode().splitlines(keepends=True):
            found.append(found[-1] + len(line))
        return found

    def mutants(self) -> Iterator[Mutant]:
        for node, first, function, name in _walk(ast.parse(self.text)):
            for kind, start, end, wrong in self._changes(node):
                right = self.text.encode()[start:end].decode()
                if right != wrong:
                    line = self.text.encode()[:start].count(b"\n") + 1
                    yield Mutant(self.file, start, right, wrong, kind, line, first, function, name)

    def _changes(self, node: ast.AST) -> Iterator[tuple[str, int, int, str]]:
        """Yield what may become of a node: kind, first byte, byte after the last, new text."""
        match node:
            case ast.Compare():
                for left, op, right in zip([node.left, *node.comparators], node.ops, node.comparators, strict=False):
                    was, *become = FLIPPED[type(op)]
                    yield from (self._between("comparison", left, right, was, new) for new in become)
            case ast.BinOp() if type(node.op) in OPERATORS and not _of_words(node):
                yield self._between("arithmetic", node.left, node.right, *OPERATORS[type(node.op)])
            case ast.BoolOp():
                was, new = ("and", "or") if isinstance(node.op, ast.And) else ("or", "and")
                for left, right in zip(node.values, node.values[1:], strict=False):
                    yield self._between("and, or", left, right, was, new)
            case ast.UnaryOp(op=ast.Not() | ast.USub()):
                yield self._whole("not, minus", node, f"({ast.unparse(node.operand)})")
            case ast.Constant() if (new := _other(node.value)) is not None:
                yield self._whole("constant", node, new)
            case ast.Return(value=ast.expr() as value):
                truth = isinstance(value, ast.Compare | ast.BoolOp | ast.UnaryOp)
                yield from (self._whole("return", value, new) for new in (("True", "False") if truth else ("None",)))
            case (
                ast.Expr(value=ast.Call() | ast.Await()) | ast.AugAssign() | ast.Raise() | ast.Continue() | ast.Break()
            ):
                yield self._whole("deleted", node, "pass")
            case ast.If() | ast.IfExp():
                yield from (self._whole("condition", node.test, new) for new in ("True", "False"))
            case ast.comprehension():
                yield from (self._whole("condition", test, "True") for test in node.ifs)
            case ast.Call(args=[first, second, *_]) if not _fixed(node, first, second):
                yield self._swapped(first, second)

    def _swapped(self, first: ast.expr, second: ast.expr) -> tuple[str, int, int, str]:
        (a, b), (c, d), data = self._span(first), self._span(second), self.text.encode()
        return "swapped", a, d, (data[c:d] + data[b:c] + data[a:b]).decode()

    def _whole(self, kind: str, node: ast.expr | ast.stmt, new: str) -> tuple[str, int, int, str]:
        return kind, *self._span(node), new

    def _between(
        self, kind: str, left: ast.expr, right: ast.expr, was: str, new: str
    ) -> tuple[str, int, int, str]:  # fmt: skip
        start, end = self._span(left)[1], self._span(right)[0]
        gap = self.text.encode()[start:end].decode()
        return kind, start, end, gap.replace(was, new, 1)

    def _span(self, node: ast.expr | ast.stmt) -> tuple[int, int]:
        assert node.end_lineno is not None
        assert node.end_col_offset is not None
        return (
            self.starts[node.lineno - 1] + node.col_offset,
            self.starts[node.end_lineno - 1] + node.end_col_offset,
        )


@dataclass(frozen=True)
class _Place:
    """Where a node is: the line of its statement, the class, the outermost function, the constant or field."""

    first: int = 1
    within: str = ""
    function: str = ""
    name: str = ""


def _walk(node: ast.AST, place: _Place = _Place()) -> Iterator[tuple[ast.AST, int, str, str]]:
    """Yield what may be mutated, with the line of its statement, its function and its name."""
    if isinstance(node, ast.stmt):
        place = replace(place, first=node.lineno)
    yield node, place.first, place.function, place.name
    for field, child in _children(node):
        if place.function:
            if field not in UNSEEN:
                yield from _walk(child, place)
        elif isinstance(child, ast.ClassDef):
            yield from _walk(child, replace(place, within=f"{place.within}{child.name}."))
        elif isinstance(child, ast.FunctionDef | ast.AsyncFunctionDef):
            for default in (*child.args.defaults, *child.args.kw_defaults):
                if default:
                    yield from _walk(default, replace(place, name=child.name))
            for statement in child.body:
                if not _is_silent(statement):
                    yield from _walk(statement, replace(place, function=place.within + child.name))
        elif isinstance(child, ast.Assign | ast.AnnAssign):
            target = child.targets[0] if isinstance(child, ast.Assign) else child.target
            yield from _walk(child, replace(place, name=ast.unparse(target)))
        elif field not in UNSEEN:
            yield from _walk(child, place)


def _children(node: ast.AST) -> Iterator[tuple[str, ast.AST]]:
    if _is_silent(node):
        return
    for field, value in ast.iter_fields(node):
        for child in value if isinstance(value, list) else (value,):
            if isinstance(child, ast.AST) and not _is_silent(child):
                yield field, child


def _is_silent(node: ast.AST) -> bool:
    """Whether nothing in a node is to be changed: words, imports, types. An exception may go, but keeps its words."""
    match node:
        case ast.JoinedStr() | ast.Import() | ast.ImportFrom() | ast.Assert() | ast.Constant(value=str()):
            return True
        case ast.Expr(value=ast.Constant()) | ast.Assign(targets=[ast.Name(id="__all__")]):
            return True
        case ast.If(test=ast.Name(id="TYPE_CHECKING") | ast.Compare(left=ast.Name(id="__name__"))):
            return True
        case ast.Call(func=ast.Name(id=called) | ast.Attribute(attr=called)):
            return called in SAYS
        case ast.keyword(arg=str() as told):
            return told in TOLD
    return False


def _of_words(node: ast.BinOp) -> bool:
    """Whether an operator joins words, lists or types, where another one is no Python that runs."""
    sides = (node.left, node.right)
    plain = any(isinstance(s, ast.JoinedStr | ast.List | ast.Tuple | ast.Dict | ast.Set) for s in sides)
    return plain or any(isinstance(s, ast.Constant) and not isinstance(s.value, int | float) for s in sides)


def _other(value: object) -> str | None:
    match value:
        case bool():
            return str(not value)
        case int():
            return str(value + 1 if abs(value) < 100 else value * 2)
        case float() if not 0 < abs(value) < _ROUNDING:
            return repr(value * 2 if value else 1.0)
    return None


def _fixed(node: ast.Call, first: ast.expr, second: ast.expr) -> bool:
    called = re.split(r"[.\[(]", ast.unparse(node.func))[-1]
    plain = not isinstance(first, ast.Starred) and not isinstance(second, ast.Starred)
    return called in SYMMETRIC or called in ("isinstance", "getattr", "cast") or not plain
