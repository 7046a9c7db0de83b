"""What the files of this repository import and name, read from their text: nothing is imported or run."""

from __future__ import annotations

import ast
import re
import tomllib
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
PACKAGES = {"pico": "pico", "cli": "pico_cli"}
"""Folders of the product, and the packages that they are."""
BESIDE = ("tests", "benchmarks", ".ci", "examples")
"""Folders whose modules are imported by their bare names."""
_BODIES = frozenset({ast.Module, ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef})
_BARE = frozenset({ast.Load, ast.Store, ast.Del})
LONGEST = 400
"""Characters of a text in the source that may name files and commands; longer ones are documents."""


@dataclass
class Unit:
    """A file, or one fixture of a conftest.py."""

    imports: set[str] = field(default_factory=set)
    """The files that it imports."""
    plug_ins: set[str] = field(default_factory=set)
    """The files that it names in a text: a module, all modules of a package, what an entry point leads to."""
    texts: set[str] = field(default_factory=set)
    names: set[str] = field(default_factory=set)
    """Its identifiers."""
    calls: set[str] = field(default_factory=set)
    """What may be the name of a command: the first text in a call, in a list, or of several words."""
    asks: set[str] = field(default_factory=set)
    """The arguments of a fixture: other fixtures."""
    below: set[str] = field(default_factory=set)
    """The folders that it takes from a path of its own file: `ROOT / "pico"`; with `ROOT / top` all that it names."""
    automatic: bool = False

    def add(self, other: Unit) -> None:
        """Take over what another unit imports and names."""
        self.imports |= other.imports
        self.plug_ins |= other.plug_ins
        self.texts |= other.texts
        self.names |= other.names
        self.calls |= other.calls

    @cached_property
    def words(self) -> frozenset[str]:
        """The words of its texts, paths taken apart: what may name a file or a folder."""
        return frozenset(word for text in self.texts for word in re.split(r"[\s/\"'`(),;:\[\]{}=]+", text) if word)


class Graph:
    """The Python files below `root`, by path from there; `gone`: the texts of those that were deleted since, by path,
    which others may import and find still."""

    def __init__(self, root: Path = ROOT, gone: Mapping[str, bytes] | None = None) -> None:
        self.root, self.gone = root, dict(gone or {})
        self.unreadable: dict[str, str] = {}
        """Files that are no Python, with the reason: they import nothing that is known."""
        self.modules = {**dict(module_of(path) for path in self.gone if _is_module(path)), **dict(_modules(root))}
        self._below: dict[str, list[str]] = {}
        for name, path in self.modules.items():
            self._below.setdefault(name.rpartition(".")[0], []).append(path)
        self._plug_ins = _plug_ins(root / "pyproject.toml")
        self.units: dict[str, Unit] = {}
        self.fixtures: dict[str, dict[str, Unit]] = {}
        for name, path in self.modules.items():
            self._read(name, path)

    @cached_property
    def importers(self) -> Mapping[str, set[str]]:
        """For each file of the product those of the product that import it."""
        found: dict[str, set[str]] = {}
        for path, unit in self.units.items():
            if path.split("/")[0] in PACKAGES:
                for imported in unit.imports:
                    found.setdefault(imported, set()).add(path)
        return found

    @cached_property
    def finders(self) -> Mapping[str, set[str]]:
        """For each file of the product those of the product that find it by a name, and do not import it."""
        found: dict[str, set[str]] = {}
        for path, unit in self.units.items():
            if path.split("/")[0] in PACKAGES:
                for named in unit.plug_ins:
                    found.setdefault(named, set()).add(path)
        return found

    @cached_property
    def tests(self) -> Mapping[str, Unit]:
        """Each test file with all that it imports and names: by itself, by its helpers and by the fixtures it uses."""
        return {p: self._whole(p) for p in self.units if p.startswith("tests/") and Path(p).name.startswith("test_")}

    def helpers(self, path: str) -> set[str]:
        """Return the files beside the tests that a test file imports, directly or by one another."""
        found: set[str] = set()
        waiting = [path]
        while waiting:
            near = {p for p in self.units[waiting.pop()].imports if p.split("/")[0] in BESIDE} - found
            found |= near
            waiting += near
        return found

    def _whole(self, path: str) -> Unit:
        own = self.units[path]
        whole = Unit(names=set(own.names))
        for one in (path, *self.helpers(path)):
            whole.add(self.units[one])
        folders = Path(path).parents
        known = {name: unit for at in reversed(folders) for name, unit in self.fixtures.get(str(at), {}).items()}
        waiting = {name for name, unit in known.items() if unit.automatic or name in own.names | own.words}
        used: set[str] = set()
        while waiting:
            name = waiting.pop()
            used.add(name)
            beside = {p for p in known[name].imports if p.split("/")[0] in BESIDE}
            if known[name].automatic:  # what each test has does not tell what it is about
                whole.imports |= beside
                continue
            whole.add(known[name])
            for one in {further for helper in beside for further in (helper, *self.helpers(helper))}:
                whole.add(self.units[one])
            waiting |= (known[name].asks & known.keys()) - used
        return whole

    # reading

    def _read(self, name: str, path: str) -> None:
        try:
            tree = ast.parse(self.gone[path] if path in self.gone else (self.root / path).read_bytes())
        except (SyntaxError, ValueError) as exc:
            line = f", line {exc.lineno}" if isinstance(exc, SyntaxError) and exc.lineno else ""
            self.unreadable[path] = f"{exc.msg if isinstance(exc, SyntaxError) else exc}{line}"
            self.units[path] = Unit()
            return
        package = name if path.endswith("/__init__.py") else name.rpartition(".")[0]
        self.units[path] = self._unit(tree, package)
        if path.startswith("tests/") and "__file__" in self.units[path].names:
            self.units[path].below = _taken(tree, self.units[path])
        if path.endswith("/conftest.py"):
            top = {alias: imported for node in tree.body for alias, imported in self._bound(node, package)}
            found = self.fixtures.setdefault(str(Path(path).parent), {})
            for node in tree.body:
                if isinstance(node, ast.FunctionDef) and any("fixture" in ast.dump(d) for d in node.decorator_list):
                    unit = self._unit(node, package)
                    unit.imports |= {imported for alias, imported in top.items() if alias in unit.names}
                    unit.asks = {argument.arg for argument in node.args.args}
                    unit.automatic = any("autouse" in ast.dump(d) for d in node.decorator_list)
                    found[node.name] = unit

    def _unit(self, tree: ast.AST, package: str) -> Unit:
        unit = Unit()
        documents: set[int] = set()
        waiting: list[Any] = [tree]
        while waiting:
            node = waiting.pop()
            kind = type(node)
            if kind is ast.Name:
                unit.names.add(node.id)
                continue
            if kind is ast.If and isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING":
                waiting += node.orelse
                continue
            if kind is ast.Constant:
                if id(node) not in documents:
                    self._text(unit, node.value)
                continue
            if kind in _BODIES and node.body and isinstance(node.body[0], ast.Expr):
                documents.add(id(node.body[0].value))
            elif kind in (ast.Call, ast.List, ast.Tuple):
                unit.calls |= _first_text(node.args if kind is ast.Call else node.elts)
            elif kind in (ast.arg, ast.Attribute):
                unit.names.add(node.arg if kind is ast.arg else node.attr)
            elif kind in (ast.Import, ast.ImportFrom):
                unit.imports |= {imported for _, imported in self._bound(node, package)}
            waiting += _below(node)
        return unit

    def _text(self, unit: Unit, value: object) -> None:
        if isinstance(value, str) and len(value) <= LONGEST:
            unit.texts.add(value)
            unit.plug_ins |= self._named(value)
            unit.calls |= set(value.split(maxsplit=1)[:1]) if " " in value else set()

    def _bound(self, node: ast.AST, package: str) -> Iterator[tuple[str, str]]:
        """Yield the names that an import binds, each with the file that it comes from."""
        if isinstance(node, ast.Import):
            for alias in node.names:
                if alias.name in self.modules:
                    yield alias.asname or alias.name.partition(".")[0], self.modules[alias.name]
        elif isinstance(node, ast.ImportFrom):
            parts = package.split(".")[: len(package.split(".")) - node.level + 1] if node.level else []
            base = ".".join([*parts, *([node.module] if node.module else [])])
            for alias in node.names:
                path = self.modules.get(f"{base}.{alias.name}") or self.modules.get(base)
                if path:
                    yield alias.asname or alias.name, path

    def _named(self, text: str) -> set[str]:
        """Return the files that a text names: a module, all modules of a package, a plug-in by its entry point."""
        module = self._plug_ins.get(text, text).partition(":")[0]
        if "." not in module or module not in self.modules:
            return set()
        return {self.modules[module], *(self._below.get(module, ()) if self._is_package(module) else ())}

    def _is_package(self, module: str) -> bool:
        return self.modules[module].endswith("/__init__.py")


def _modules(root: Path) -> Iterator[tuple[str, str]]:
    """Yield every module with its path; those beside the product by their bare names."""
    for folder in (*PACKAGES, *BESIDE):
        for path in sorted((root / folder).rglob("*.py")):
            yield module_of(str(path.relative_to(root)))


def module_of(path: str) -> tuple[str, str]:
    """Return the name by which a file is imported, and the file."""
    folder, _, below = path.partition("/")
    if folder in PACKAGES:
        parts = [PACKAGES[folder], *Path(below).with_suffix("").parts]
        return ".".join(parts).removesuffix(".__init__"), path
    return path if Path(path).name == "conftest.py" else Path(path).stem, path


def _is_module(path: str) -> bool:
    return path.endswith(".py") and path.partition("/")[0] in (*PACKAGES, *BESIDE)


def _below(node: ast.AST) -> Iterator[ast.AST]:
    """Yield what stands in a node; `ast.iter_child_nodes` takes twice as long."""
    for name in node._fields:
        value = getattr(node, name, None)
        if isinstance(value, list):
            yield from (one for one in value if isinstance(one, ast.AST))
        elif isinstance(value, ast.AST) and type(value) not in _BARE:
            yield value


def _taken(tree: ast.Module, unit: Unit) -> set[str]:
    """Return the folders that a file takes from constants made of its own path."""
    made = [n for n in tree.body if isinstance(n, ast.Assign) and "'__file__'" in ast.dump(n.value)]
    roots = {target.id for n in made for target in n.targets if isinstance(target, ast.Name)}
    found: set[str] = set()
    for node in ast.walk(tree):
        if not (isinstance(node, ast.BinOp) and isinstance(node.op, ast.Div)):
            continue
        left, right = node.left, node.right
        if isinstance(left, ast.Name) and left.id in roots:
            named = isinstance(right, ast.Constant) and isinstance(right.value, str)
            found |= {*right.value.split("/")} if named else set(unit.words)
    return found


def _first_text(given: Iterable[ast.AST]) -> set[str]:
    texts = (one.value for one in given if isinstance(one, ast.Constant) and isinstance(one.value, str))
    return set([text for text in texts if not text.startswith("-")][:1])


def _plug_ins(config: Path) -> dict[str, str]:
    """Return the entry points of the product by name; a name in two groups stands for the first."""
    groups: Iterable[Mapping[str, str]] = tomllib.loads(config.read_text())["project"].get("entry-points", {}).values()
    found: dict[str, str] = {}
    for group in groups:
        found = {**group, **found}
    return found
