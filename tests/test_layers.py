"""The rooms of the library stand in one order, each imports only from those before it, and nothing in a circle."""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Iterator, Mapping
from functools import cache
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent

ORDER = (
    "version", "diagnostics", "disk", "base", "expressions", "resources", "plug_ins", "registered",
    "places", "kernels", "optimize",
    "model", "teleop", "control", "content", "geometry",
    "manifest", "optics", "diagnosis", "vision", "motion", "staging", "planning", "twin", "cameras", "drawing",
    "drivers", "emulators",
    "backends", "policy", "execution", "runs", "edge", "history", "bench", "scripting", "recipes", "server",
)  # fmt: skip
LOOSE = 6
"""How many modules may lie beside the rooms."""
FULL = 25
"""How many files a room may hold, but for rooms of one command, or one view of a command, each."""

FILES = {".".join(p.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__"): p
         for p in sorted((ROOT / "pico").rglob("*.py"))}  # fmt: skip


@pytest.fixture(scope="module", autouse=True)
def _forgotten() -> Iterator[None]:
    """Let go of the trees at the end: they take 250 MB."""
    yield
    parsed.cache_clear()


@cache
def parsed(path: Path) -> tuple[ast.Module, tuple[ast.AST, ...]]:
    """Return the tree of a file, and all that is in it."""
    tree = ast.parse(path.read_text())
    return tree, tuple(ast.walk(tree))


def imported(path: Path) -> set[str]:
    """Return the modules of pico that a file imports, at its top or inside a function."""
    found = set()
    for node in parsed(path)[1]:
        names = [a.name for a in node.names] if isinstance(node, ast.Import) else []
        if isinstance(node, ast.ImportFrom) and node.module and node.level == 0:
            names = [n if (n := f"{node.module}.{a.name}") in FILES else node.module for a in node.names]
        found |= {name for name in names if name in FILES and name != "pico"}
    return found


@cache
def imports() -> Mapping[str, set[str]]:
    """Return for each module those that it imports."""
    return {name: imported(path) for name, path in FILES.items()}


def room(module: str) -> str:
    """Return the room at the top of `pico/` that a module is in, or its own name."""
    return module.split(".")[1] if "." in module else ""


def folder(module: str) -> str:
    """Return the package that a module is in."""
    return module if FILES[module].name == "__init__.py" else module.rpartition(".")[0]


def circle(graph: Mapping[str, set[str]]) -> list[str]:
    """Return the names along one circle of a graph, none where there is none."""
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as exc:
        return list(exc.args[1])
    return []


def backwards() -> Iterator[str]:
    for module, taken in imports().items():
        here = room(module)
        for other in sorted(taken):
            if here and room(other) and ORDER.index(room(other)) > ORDER.index(here):
                yield f"{module} imports {other}, which comes later"


def test_every_room_imports_only_from_those_before_it() -> None:
    assert {room(m) for m in FILES} - {""} == set(ORDER)
    assert not list(backwards())


def test_no_files_import_one_another_in_a_circle() -> None:
    assert not circle(imports())


def test_no_packages_import_one_another_in_a_circle() -> None:
    packages: dict[str, set[str]] = {}
    for module, taken in imports().items():
        at = folder(module)
        packages.setdefault(at, set()).update({folder(m) for m in taken} - {at})
    packages.pop("pico")  # `pico.open` opens what all the others make
    assert not circle(packages)


def test_few_modules_lie_loose_and_no_room_is_overfull() -> None:
    assert len(list((ROOT / "pico").glob("*.py"))) <= LOOSE
    full = [p for top in ("pico", "tests") for p in (ROOT / top).rglob("*") if len(list(p.glob("*.py"))) > FULL]
    assert [p.name for p in full if p != ROOT / "tests" / "cli"] == []


def test_the_command_is_built_on_the_library_and_the_library_does_not_know_it() -> None:
    library = "\n".join(p.read_text() for p in FILES.values())
    assert "pico_cli" not in library


def name_of(node: ast.AST) -> str:
    """Return the name that stands there; that it is imported is no use yet."""
    return node.id if isinstance(node, ast.Name) else node.attr if isinstance(node, ast.Attribute) else ""


def test_what_only_tests_ask_is_no_part_of_the_library() -> None:
    paths = [p for top in ("pico", "cli") for p in (ROOT / top).rglob("*.py")]
    uses = Counter(name_of(node) for path in paths for node in parsed(path)[1])
    idle = [
        f"{path.relative_to(ROOT)}:{node.lineno} {node.name}: a test's own goes to tests/oracles"
        for name, path in FILES.items()
        if room(name) not in ("scripting", "drivers")  # a driver does what its kind demands, whoever asks for it
        and room(name) not in ("control", "server")  # which those elsewhere ask
        and name != "pico.model.wiring"
        and path.stem != "pytest_fixtures"  # what scripts, notebooks and bluesky ask for, nobody asks here
        for node in parsed(path)[1]
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef)
        and not node.name.startswith("__")
        and uses[node.name] < 20  # nothing calls itself so often
        and uses[node.name] == sum(name_of(n) == node.name for n in ast.walk(node))
    ]
    assert not idle, "\n".join(idle)


def test_nothing_in_the_library_prints() -> None:
    printing = []
    for path in FILES.values():
        tree, nodes = parsed(path)
        main_only = {id(n) for top in tree.body if isinstance(top, ast.If) for n in ast.walk(top)}
        printing += [
            f"{path.relative_to(ROOT)}:{node.lineno}"
            for node in nodes
            if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "print" and id(node) not in main_only
        ]
    assert not printing, "\n".join(printing)
