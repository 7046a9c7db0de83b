"""Commands that texts name between backticks: each exists, and reaches the bench of the command that prints it."""

from __future__ import annotations

import ast
import json
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest
from commanding import Pico
from pico_cli.at_once.complete import SHARED, plain
from pico_cli.at_once.declared import declared
from pico_cli.commands import files
from pico_cli.hints import FILES, NOWHERE, flags_of, with_flags, with_flags_in
from pico_cli.names import MOVED, RESERVED

ROOT = Path(__file__).resolve().parents[2]
SAID = {"folder": "my lab", "backend": "hardware", "emulate": True}
FLAGS = ("-C 'my lab'", "--backend hardware", "--emulate")
BLANK = "X"
"""What stands for an expression in a text."""


def rendered(node: ast.AST) -> str | None:
    """Return a text of the code, as far as it is known before it runs."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        return node.value
    if isinstance(node, ast.JoinedStr):
        return "".join(str(v.value) if isinstance(v, ast.Constant) else BLANK for v in node.values)
    return None


def hints() -> Iterator[tuple[str, str]]:
    """Yield each command between backticks in a text of the code, and where it stands."""
    for path in sorted(p for top in ("pico", "cli") for p in (ROOT / top).rglob("*.py")):
        code, parts = path.read_text(), set[int]()
        for node in ast.walk(ast.parse(code)) if "`pico" in code else ():
            if isinstance(node, ast.JoinedStr):
                parts |= {id(value) for value in node.values}
            if id(node) not in parts and (text := rendered(node)):
                for found in re.findall(r"`pico\s+([^`]*)`", text):
                    yield " ".join(found.split()), f"{path.relative_to(ROOT)}:{getattr(node, 'lineno', 0)}"


def unknown(command: str) -> str:
    """Return what of a command there is not; empty if all of it is there."""
    words = [word.rstrip(BLANK) or BLANK for word in command.partition(" | ")[0].split()]
    if words[0] in SHARED or words[0] == BLANK or words[0].isupper():
        return ""
    if words[0] not in files():
        return "" if words[0] in MOVED.keys() | RESERVED.keys() or words[0] == "help" else words[0]
    below = declared(files()[words[0]])
    group = "" not in below
    if group and len(words) > 1 and words[1].islower() and words[1] not in below:
        return " ".join(words[:2])
    taken = below.get("") or below.get(words[1] if len(words) > 1 else "") or ({}, [])
    known = {"--help", "--lock-timeout", *SHARED, *taken[0]} if taken[0] or not group else None
    given = {word.partition("=")[0].rstrip(",.;") for word in words if word.startswith("--") and word != "--"}
    return " ".join(sorted(given - known)) if known is not None else ""


@cache
def commands() -> list[tuple[str, str]]:
    """Return the hints in order. Not a constant: each worker would parse all of the code while it collects."""
    return sorted(set(hints()))


def test_every_command_that_a_text_names_exists_with_its_options() -> None:
    assert len(commands()) > 400
    assert [(where, command, wrong) for command, where in commands() if (wrong := unknown(command))] == []


def test_every_command_that_depends_on_the_bench_gets_the_flags() -> None:
    for command, where in commands():
        got = with_flags(f"Go on: `pico {command}`.", FLAGS)
        names = plain(command.split(), SHARED)
        first, two = names[0] if names else "", " ".join(names[:2])
        if first in NOWHERE or first not in files() or "--help" in command.split():
            assert got == f"Go on: `pico {command}`.", where
            continue
        own = {flag for flag in ("-C", "--backend", "--emulate", "--bench") if flag in command.split()}
        of_bench = (first not in FILES and two not in FILES) or "--journal" in command.split()
        bench = of_bench and not own - {"-C"}
        wanted = [*(FLAGS[:1] if "-C" not in own else ()), *(FLAGS[1:] if bench else ())]
        assert got == f"Go on: `{' '.join(['pico', *wanted, command])}`.", where


def test_the_tables_name_commands_that_there_are() -> None:
    known = files().keys() | {"help"}
    assert {name.split()[0] for name in NOWHERE | FILES} <= known
    assert all(two.split()[1] in declared(files()[two.split()[0]]) for two in FILES if " " in two)


def test_no_command_that_asks_the_bench_counts_as_one_that_reads_files() -> None:
    """A command whose own function asks for the bench that is meant needs the flags in a hint."""
    for name, path in files().items():
        for function in ast.parse(Path(path).read_text()).body:
            if isinstance(function, ast.FunctionDef) and {
                node.attr for node in ast.walk(function) if isinstance(node, ast.Attribute)
            } & {"bench", "here"}:
                assert f"{name} {function.name.rstrip('_')}" not in FILES, name
                assert name not in FILES or function.name.startswith("_"), name


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("Apply with `pico apply e1`, or `pico plan --out e1.plan`",
         "Apply with `pico -C 'my lab' --backend hardware --emulate apply e1`, or "
         "`pico -C 'my lab' --backend hardware --emulate plan --out e1.plan`"),
        ("`pico -C there plan`", "`pico --backend hardware --emulate -C there plan`"),
        ("`pico --bench local status`", "`pico -C 'my lab' --bench local status`"),
        ("`pico\n     apply e1`", "`pico -C 'my lab' --backend hardware --emulate\n     apply e1`"),
        ("`pico fmt`, `pico init DIR` and `pico plan --help`",
         "`pico -C 'my lab' fmt`, `pico init DIR` and `pico plan --help`"),
        ("`pico` and `picojoule` and `git apply`", "`pico` and `picojoule` and `git apply`"),
    ],
)  # fmt: skip
def test_flags_stand_before_the_command_and_never_twice(text: str, said: str) -> None:
    assert flags_of(SAID) == FLAGS
    assert with_flags(text, FLAGS) == said == with_flags(said, FLAGS)
    assert with_flags(text, flags_of({})) == text


def test_in_json_diagnostics_and_hints_have_them_and_data_stays() -> None:
    wrong = {"severity": "error", "code": "x", "summary": "run `pico plan`", "hint": "`pico apply`"}
    document = {"diagnostics": [wrong], "message": "made by `pico apply`", "rows": [{"hint": "`pico apply`"}]}
    found = with_flags_in(document, ("--emulate",))
    assert found["message"] == document["message"] and found["rows"][0]["hint"] == "`pico --emulate apply`"
    assert found["diagnostics"][0]["summary"] == "run `pico --emulate plan`"


def test_what_is_printed_names_the_folder_that_was_given(shel: Path, pico: Pico, tmp_path: Path) -> None:
    """Given before the command or behind it; of answers, of errors, and as JSON."""
    for words in (["-C", str(shel), "plan", "e1"], ["plan", "-C", str(shel), "e1"]):
        assert f"Apply with `pico -C {shel} apply e1`" in pico(*words).out
    assert f"`pico -C {shel} log --graph` shows them" in pico("plan", "e9", "-C", str(shel)).err
    told = json.loads(pico("-C", str(shel), "--json", "plan", "e9").out)["diagnostics"][0]
    assert told["hint"] == f"`pico -C {shel} log --graph` shows them"
    assert "Apply with `pico apply e1`" in pico("plan", "e1").out
