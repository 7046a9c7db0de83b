"""Text is read and written as UTF-8, whatever the locale of whoever runs PICO."""

from __future__ import annotations

import ast
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
NO_FILES = ("eyes", "server")
"""What is opened and is no file: cameras, a socket."""


def calls(tree: ast.AST) -> Iterator[tuple[ast.Call, str]]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
            yield node, name


def literal(node: ast.expr | None) -> object:
    return node.value if isinstance(node, ast.Constant) else None


def by_locale(call: ast.Call, name: str) -> bool:
    """Whether a call reads or writes text as the locale has it."""
    given = {k.arg: k.value for k in call.keywords}
    if "encoding" in given or None in given:
        return False
    if name == "read_text":
        return not call.args
    if name == "write_text":
        return len(call.args) < 2
    if name in ("run", "Popen", "check_output"):
        return literal(given.get("text")) is True or literal(given.get("universal_newlines")) is True
    if name in ("open", "fdopen"):
        return opens_text(call, name, given)
    return name in ("NamedTemporaryFile", "TemporaryFile") and "b" not in str(literal(given.get("mode")) or "w+b")


def opens_text(call: ast.Call, name: str, given: dict[str | None, ast.expr]) -> bool:
    method = name == "open" and isinstance(call.func, ast.Attribute)
    if method and getattr(call.func.value, "id", "") in NO_FILES:  # type: ignore[attr-defined]
        return False
    at = 0 if method else 1
    said = call.args[at] if len(call.args) > at else given.get("mode")
    mode = literal(said) if said is not None else "r"
    return isinstance(mode, str) and set(mode) <= set("rwax+t")


def test_no_text_is_read_or_written_by_the_locale() -> None:
    found = [
        f"{path.relative_to(ROOT)}:{call.lineno} {name}"
        for folder in ("pico", "cli")
        for path in sorted((ROOT / folder).rglob("*.py"))
        for call, name in calls(ast.parse(path.read_bytes()))
        if by_locale(call, name)
    ]
    assert found == []


def test_a_note_and_its_path_are_utf8_in_a_locale_of_ascii(shel_of_umlauts: Path) -> None:
    command = [sys.executable, "-c", "import sys; from pico_cli.main import main; sys.exit(main())"]
    plain = {"LC_ALL": "POSIX", "LANG": "", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}
    who = {"GIT_AUTHOR_NAME": "Jürgen", "GIT_AUTHOR_EMAIL": "j@localhost"}
    done = subprocess.run(
        [*command, "note", "p1", "größer"], cwd=shel_of_umlauts, env={**os.environ, **plain, **who},
        capture_output=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert "Jürgen: größer" in (shel_of_umlauts / "notes/p1.md").read_text(encoding="utf-8")


@pytest.fixture
def shel_of_umlauts(case_study: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(case_study, tmp_path / "Größe"))
