"""Run the quick tests of what changed: `make affected`, or `make affected AFFECTED="--list"`.

What changed is what differs from the merge base with main, what is edited and what git does not know yet.

A test file is chosen for a changed module if it imports that module or one that leads to it: itself, by its helpers or
by the fixtures that it uses. A module leads to the changed one if it imports it, or if it is of the same room
(`pico/planning`, `cli`) and imports it by way of others of that room; `--depth 2` and more follow so many imports
through all rooms. A plug-in that is found by being there leads to those that name its folder or its entry point, a
command to the tests that call it by its name. Tests in the folder of the room that are called like the module are
chosen, too. Other files choose the tests that name them, their lab, their component type, or list their folder. Of
what was deleted or renamed the text at the merge base says what it was to others. Tests that list the files of the
repository (layers, packaging, encodings ...) are chosen for every file in the folders that they name. A change of
pyproject.toml, constraints.txt or tests/conftest.py chooses all, and so does a file of the product that is not Python
and that no test names.

This is a first answer within minutes, read from the text of the files: tests that a change reaches by a longer way are
left out. `.ci/run` and CI run every test, the slow ones, too.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from import_graph import BESIDE, PACKAGES, ROOT, Graph, Unit

ALL = frozenset({"pyproject.toml", "constraints.txt", "tests/conftest.py"})
"""Files whose change may change any test."""
LISTS = frozenset({"glob", "rglob", "iterdir", "walk", "scandir", "listdir", "copytree"})
"""Names by which a test reads every file of a folder."""
DEPTH = 1


def changed(root: Path, base: str = "") -> tuple[str, list[str]]:
    """Return the merge base with `base` (by default main, else origin/main), and the paths that differ from it, are
    edited or untracked."""
    heads = _git(root, "for-each-ref", "--format=%(refname:short)", "refs/heads/main", "refs/remotes/origin/main")
    since = _git(root, "merge-base", base or next(iter(heads.split()), "HEAD"), "HEAD").strip()
    differ = _git(root, "diff", "--name-only", "--no-renames", "-z", since)
    untracked = _git(root, "ls-files", "--others", "--exclude-standard", "-z")
    return since, sorted({path for path in (differ + untracked).split("\0") if path})


def deleted(root: Path, since: str, paths: Iterable[str]) -> dict[str, bytes]:
    """Return the texts at a commit of those Python files among `paths` that are gone."""
    found = {}
    for path in paths:
        if path.endswith(".py") and not (root / path).exists():
            done = subprocess.run(["git", "show", f"{since}:./{path}"], cwd=root, capture_output=True, check=False)
            found[path] = done.stdout if not done.returncode else b""
    return found


def _git(root: Path, *words: str) -> str:
    done = subprocess.run(["git", *words], cwd=root, capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(f"git {' '.join(words)}: {done.stderr.strip()}")
    return done.stdout


def room(path: str) -> str:
    """Return the room of a file of the product: `pico/planning`, `pico/disk.py`, `cli`."""
    return "/".join(path.split("/")[:2]) if path.startswith("pico/") else _top(path)


def _top(path: str) -> str:
    return path.partition("/")[0]


def leads(graph: Graph, path: str, depth: int = DEPTH) -> dict[str, str]:
    """Return the files of the product by which a test depends on a changed one, each with the reason."""
    found = {path: "import it"}
    if path.endswith("/__init__.py"):  # whoever imports a module of a package imports the package
        below = path.removesuffix("__init__.py")
        found |= {p: "import the package" for p in graph.units if p.startswith(below) and p != path}
    edge = set(found)
    found |= dict.fromkeys(graph.finders.get(path, ()), "import what finds it by its name")
    waiting = [*found]
    while waiting:
        near = [p for p in graph.importers.get(waiting.pop(), ()) if room(p) == room(path) and p not in found]
        found |= dict.fromkeys(near, f"import it by way of {room(path)}")
        waiting += near
    for _ in range(depth):
        edge = {p for one in edge for p in graph.importers.get(one, ())}
        found |= {p: "import what imports it" for p in edge if p not in found}
    return found


def concerned(graph: Graph, path: str, depth: int = DEPTH) -> dict[str, str]:
    """Return the test files that a changed file concerns, each with the reason."""
    if path in ALL:
        return _there(graph, dict.fromkeys(graph.tests, "all: it may change any test"))
    if _top(path) in PACKAGES and path.endswith(".py"):
        found = _tests_of_module(graph, path, depth)
    elif path.startswith("tests/"):
        found = _tests_beside(graph, path)
    elif path.endswith(".py") and _top(path) in BESIDE:
        found = {**_tests_reading(graph, path), **_users(graph, path)}
    else:
        found = _tests_reading(graph, path)
        if not found and _top(path) in PACKAGES:
            found = dict.fromkeys(graph.tests, "all: no test names this file of the product")
    return _there(graph, {**_listing(graph, path), **found})


def _there(graph: Graph, found: Mapping[str, str]) -> dict[str, str]:
    """Return the tests that are not deleted."""
    return {test: why for test, why in found.items() if test not in graph.gone}


def _listing(graph: Graph, path: str) -> dict[str, str]:
    """Return the tests that go through the files of the repository in a folder that has the changed one."""
    folders = set(Path(path).parts[:-1])
    return {
        test: f"list the files of {_top(path)}/" for test, unit in graph.tests.items()
        if unit.names & LISTS and graph.units[test].below & folders
    }  # fmt: skip


def _users(graph: Graph, path: str) -> dict[str, str]:
    """Return the tests that import a file beside the product, directly or by a helper."""
    users = (t for t, unit in graph.tests.items() if path in unit.imports or path in graph.helpers(t))
    return dict.fromkeys(users, "import it")


def _tests_of_module(graph: Graph, path: str, depth: int) -> dict[str, str]:
    found: dict[str, str] = {}
    ways = leads(graph, path, depth)
    commands = {_command(p): p for p in ways if p.startswith("cli/commands/")}
    for test, unit in graph.tests.items():
        if path in unit.imports or path in unit.plug_ins:
            found[test] = ways[path]
        elif reached := (unit.imports | unit.plug_ins) & ways.keys():
            found[test] = ways[min(reached)]
        elif _calls_commands(unit) and (called := unit.calls & commands.keys()):
            found[test] = f"call `pico {min(called)}`" if len(commands) == 1 else "call a command that imports it"
    if path.startswith("cli/commands/"):  # which commands there are is read from the folder
        lists = (
            t for t, u in graph.tests.items() if t not in found and ("commands.md" in u.words or "help" in u.calls)
        )
        found |= dict.fromkeys(lists, "list the commands")
    for test in graph.tests:
        if test not in found and _named_alike(test, path):
            found[test] = f"are called like it, in tests/{room(path).rpartition('/')[2]}"
    return found


def _command(path: str) -> str:
    return Path(path).stem.rstrip("_").replace("_", "-")


def _calls_commands(unit: Unit) -> bool:
    return any(path in unit.imports for path in ("cli/main.py", "cli/__main__.py", "tests/commanding.py"))


def _named_alike(test: str, path: str) -> bool:
    return test.startswith(f"tests/{room(path).rpartition('/')[2]}/") and Path(path).stem.rstrip("_") in (
        Path(test).stem.removeprefix("test_"),
        *Path(test).stem.split("_"),
    )


def _tests_beside(graph: Graph, path: str) -> dict[str, str]:
    """Return the tests of a changed file among the tests: a test, a conftest, a helper, data."""
    if path in graph.tests:
        return {path: "it is a test"}
    if path.endswith("/conftest.py"):
        below = path.removesuffix("conftest.py")
        return {test: f"all of {below}" for test in graph.tests if test.startswith(below)}
    if path.endswith(".py"):
        named = {t: f"name {Path(path).name}" for t, u in graph.tests.items() if {Path(path).name, path} & u.words}
        return {**named, **_users(graph, path)}
    for folder in Path(path).parents:
        beside = [test for test in graph.tests if str(Path(test).parent) == str(folder) != "tests"]
        if beside:
            return dict.fromkeys(beside, f"stand beside it, in {folder}")
    return _tests_reading(graph, path)


def _tests_reading(graph: Graph, path: str) -> dict[str, str]:
    """Return the tests that read a changed data file or page, by the names in them."""
    names, stem = _names(graph, path), Path(path).stem
    folders = {*Path(path).parts[:-1], f"{Path(path).parts[0]}_dir"} - {"tests", *PACKAGES}
    found: dict[str, str] = {}
    opening: dict[str, str] = {}
    for test, unit in graph.tests.items():
        if named := unit.words & names:
            found[test] = f"name {min(named)}"
        elif folders & (unit.words | unit.names):
            opening[test] = f"read {Path(path).parent}/"
            called = any(stem == word or (word.endswith("_") and stem.startswith(word)) for word in unit.words)
            if called or (unit.names & LISTS and _top(path) != "tests"):
                found[test] = opening[test]
    return found or opening


def _names(graph: Graph, path: str) -> set[str]:
    """Return the names by which tests call a file: its own; of a lab that of its folder; of a type its name and those
    of the labs that have such a part."""
    parts = Path(path).parts
    if parts[0] == "labs" and len(parts) > 1:
        return {parts[1]}
    if parts[0] == "catalog":
        kind = Path(path).stem
        labs = [lab for lab in (graph.root / "labs").glob("*/*.yaml") if f"type: {kind}\n" in lab.read_text()]
        return {kind, *(lab.parent.name for lab in labs)}
    return {Path(path).name}


def chosen(graph: Graph, paths: Iterable[str], depth: int = DEPTH) -> dict[str, dict[str, str]]:
    """Return for each changed path the test files that it concerns, with the reasons."""
    return {path: concerned(graph, path, depth) for path in paths}


def report(found: dict[str, dict[str, str]], graph: Graph) -> Iterator[str]:
    """Yield the lines of the report: what each changed file chooses and why, and how many of all tests that makes."""
    for path, tests in found.items():
        reasons = Counter(tests.values())
        why = ", ".join(f"{count} {reason}" for reason, count in reasons.most_common()) or "no test reads it"
        yield f"  {path}: {len(tests)} ({why})" if tests else f"  {path}: {why}"
        if path in graph.unreadable:
            yield f"    cannot be read as Python: {graph.unreadable[path]}; what it imports is unknown"
    every = set().union(*found.values()) if found else set()
    yield f"Chosen: {len(every)} of {len(graph.tests)} test files, without slow tests. CI runs all of them."


def main() -> int:
    """Choose, say what and why, and run pytest; return its exit code, 0 if nothing is chosen."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--base", default="", metavar="REV", help="compare with the merge base with REV (main)")
    parser.add_argument("--depth", type=int, default=DEPTH, metavar="N", help=f"imports through all rooms ({DEPTH})")
    parser.add_argument("--list", action="store_true", help="print the chosen test files instead of running them")
    words, further = parser.parse_known_args()
    since, paths = changed(ROOT, words.base)
    graph = Graph(ROOT, deleted(ROOT, since, paths))
    found = chosen(graph, paths, words.depth)
    print(f"Changed since {since[:9]} (merge base with {words.base or 'main'}), edited or new: {len(paths)} files")
    print("\n".join(report(found, graph)), flush=True)
    tests = sorted(set().union(*found.values())) if found else []
    if words.list:
        print("\n".join(tests))
    if words.list or not tests:
        return 0
    command = [sys.executable, "-m", "pytest", "-n", "2", "-m", "not slow", *further, *tests]
    code = subprocess.run(command, cwd=ROOT, check=False).returncode
    return 0 if code == 5 else code  # 5: all of them are slow


if __name__ == "__main__":
    sys.exit(main())
