"""A package imports only from those above it in the layout of the design, and no import is circular."""

from __future__ import annotations

import ast
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

# What each package may import from, besides itself: those above it in the design's layout, and no more than it needs.
LAYERS: dict[str, set[str]] = {
    "diagnostics": set(),
    "disk": {"diagnostics"},
    "resources": set(),
    "expressions": set(),
    "attachment": {"diagnostics", "disk"},
    "model": {"diagnostics", "expressions"},
    "manifest": {"diagnostics", "disk", "expressions", "resources", "model"},
    "trace": {"diagnostics", "disk", "model", "manifest"},
    "history": {"diagnostics", "disk", "attachment", "resources", "model", "manifest", "trace"},
    "journal": {"diagnostics", "disk", "model"},
    "data": {"diagnostics", "disk", "model", "trace", "history", "recording"},
    "recording": {"diagnostics", "model", "trace", "history", "journal", "backends"},
    "geometry": {"diagnostics", "model"},
    "motion": {"diagnostics", "model", "geometry"},
    "planning": {"diagnostics", "model", "geometry", "motion"},
    "policy": {"diagnostics", "expressions", "model", "geometry", "planning"},
    "vision": {"diagnostics", "disk", "model", "geometry"},
    "twin": {"diagnostics", "disk", "model", "geometry", "motion", "vision"},
    "backends": {"diagnostics", "disk", "attachment", "model", "journal", "geometry", "motion", "vision", "twin"},
    "execution": {"diagnostics", "model", "journal", "policy", "backends"},
    "pictures": {"diagnostics", "model", "planning", "twin"},
    "drawings": {"model", "history", "motion", "twin", "pictures"},
    "scans": {"diagnostics", "model", "backends", "twin", "async_bench"},
    "imports": {"diagnostics", "disk", "model", "manifest", "vision", "backends", "async_bench"},
    "merging": {"diagnostics", "model", "manifest", "history", "motion", "planning"},
    "restoring": {"diagnostics", "model", "manifest", "history", "merging"},
    "checking": {
        "diagnostics", "disk", "model", "manifest", "history", "motion", "planning", "policy", "twin", "backends",
        "execution", "pictures", "merging",
    },
    "evidence": {"attachment", "model", "journal"},
    "committing": {"diagnostics", "model", "history", "recording", "evidence"},
    "publishing": {
        "diagnostics", "disk", "resources", "model", "manifest", "trace", "history", "planning", "twin", "pictures",
        "checking",
    },
    "takeup": {
        "diagnostics", "attachment", "model", "journal", "motion", "planning", "backends", "execution",
        "async_bench",
    },
    "watching": {"diagnostics", "attachment", "model", "journal", "backends", "async_bench"},
    "saved": {"diagnostics", "model", "execution", "vision", "async_bench"},
    "bisecting": {"diagnostics", "expressions", "model", "history", "motion", "policy"},
    "async_bench": {
        "diagnostics", "resources", "model", "manifest", "history", "journal", "geometry", "motion", "planning",
        "policy", "vision", "twin", "backends", "execution", "pictures", "drawings", "recording", "merging",
        "committing",
    },
    "bench": {
        "diagnostics", "resources", "model", "manifest", "history", "journal", "geometry", "motion", "planning",
        "vision", "twin", "backends", "execution", "pictures", "async_bench", "takeup", "merging", "saved", "watching",
        "scans", "imports", "committing", "restoring", "bisecting", "recording",
        "data", "publishing",
    },
}  # fmt: skip


def imported_packages(path: Path) -> set[str]:
    """Return the packages of pico that a file imports, at its top or inside a function."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text())):
        names = [a.name for a in node.names] if isinstance(node, ast.Import) else []
        if isinstance(node, ast.ImportFrom) and node.module and node.level == 0:
            names = [f"{node.module}.{a.name}" for a in node.names]
        found |= {n.split(".")[1] for n in names if n.startswith("pico.")}
    return found


def test_every_package_imports_only_from_its_layers() -> None:
    wrong = []
    for path in sorted((ROOT / "pico").rglob("*.py")):
        package = path.relative_to(ROOT / "pico").parts[0].removesuffix(".py")
        if package == "__init__":
            continue
        assert package in LAYERS, f"{package} is not in the design's layout"
        extra = imported_packages(path) - LAYERS[package] - {package, "__version__"}
        wrong += [f"{path.relative_to(ROOT)} imports pico.{name}" for name in sorted(extra)]
    assert not wrong, "\n".join(wrong)


def test_the_command_is_built_on_the_library_and_the_library_does_not_know_it() -> None:
    library = "\n".join(p.read_text() for p in (ROOT / "pico").rglob("*.py"))
    assert "pico_cli" not in library


def test_nothing_in_the_library_prints() -> None:
    printing = []
    for path in sorted((ROOT / "pico").rglob("*.py")):
        tree = ast.parse(path.read_text())
        main_only = {id(n) for top in tree.body if isinstance(top, ast.If) for n in ast.walk(top)}
        printing += [
            f"{path.relative_to(ROOT)}:{node.lineno}"
            for node in ast.walk(tree)
            if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "print" and id(node) not in main_only
        ]
    assert not printing, "\n".join(printing)
