"""How much code there is: `python benchmarks/size.py [--base REV]`.

Counts statements of the syntax tree, docstrings left out, by room of `pico/` and `cli/`: what neither formatting nor
comments change. `--base`: beside what a revision has. The exit code is 1 where there are more than at the base.
"""

from __future__ import annotations

import argparse
import ast
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
COUNTED = ("pico", "cli")
DOCUMENTED = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)


def statements(text: str) -> int:
    """Return how many statements a file has, docstrings left out."""
    nodes = list(ast.walk(ast.parse(text)))
    documented = sum(isinstance(n, DOCUMENTED) and ast.get_docstring(n, clean=False) is not None for n in nodes)
    return sum(isinstance(n, ast.stmt) for n in nodes) - documented


def here() -> Iterator[tuple[str, str]]:
    """Yield the files of the working tree."""
    for path in sorted(p for top in COUNTED for p in (ROOT / top).rglob("*.py")):
        yield path.relative_to(ROOT).as_posix(), path.read_text()


def at(revision: str) -> Iterator[tuple[str, str]]:
    """Yield the files of a revision."""
    for path in _git("ls-tree", "-r", "--name-only", revision, "--", *COUNTED).split("\n"):
        if path.endswith(".py"):
            yield path, _git("show", f"{revision}:{path}")


def _git(*words: str) -> str:
    return subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True, check=True).stdout


def by_room(files: Iterator[tuple[str, str]]) -> Counter[str]:
    """Return the statements of each room: `pico/planning`, `cli/views`; a loose module is one by itself."""
    found = Counter[str]()
    for path, text in files:
        found["/".join(path.split("/")[:2])] += statements(text)
    return found


def main() -> int:
    """Count, print a line a room, and return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--base", help="a revision to compare with")
    given = parser.parse_args()
    now = by_room(here())
    before = by_room(at(given.base)) if given.base else None
    rooms = sorted(now.keys() | (before or {}).keys())
    for name, counts in [*((r, [r]) for r in rooms), ("all", rooms)]:
        total = sum(now[r] for r in counts)
        beside = f"{total - sum(before[r] for r in counts):+7}" if before is not None else ""
        print(f"{name:28}{total:7}{beside}")
    return 1 if before is not None and now.total() > before.total() else 0


if __name__ == "__main__":
    sys.exit(main())
