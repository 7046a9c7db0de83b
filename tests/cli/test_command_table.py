"""The top level as docs/decisions/0014-command-table.md has it; the help of every command: short, whole, by example."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from commanding import Pico
from pico_cli import commands
from pico_cli.app import build
from pico_cli.at_once.help import help_text
from pico_cli.commands import HEADINGS, LAST, files, summary
from pico_cli.main import main
from pico_cli.names import MOVED, RESERVED, SELDOM

TABLE = Path(__file__).resolve().parents[2] / "docs" / "decisions" / "0014-command-table.md"
MOVING = ("apply", "resume", "undo", "recover", "checkout", "do", "move", "set", "bisect")


def everything() -> Iterator[str]:
    """Yield the name of every command, and of each below it."""
    top = build()
    for name in top.list_commands(None):
        yield name
        yield from (f"{name} {below}" for below in getattr(top.get_command(None, name), "commands", ()))


def test_the_top_level_fits_a_screen_and_a_head() -> None:
    lines = help_text().splitlines()
    assert len(files().keys() - SELDOM) <= 45 and files().keys() >= SELDOM
    assert len(lines) <= 60
    assert {line.split()[0] for line in lines if line.startswith("  ")} == files().keys() - SELDOM
    assert [line for line in lines if len(line) > 80] == []


@pytest.mark.parametrize("name", [*everything()])
def test_each_help_is_a_screen_with_an_example_and_no_cut_word(
    name: str, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    answer = pico("help", *name.split())
    lines = answer.out.splitlines()
    assert answer.code == 0 and answer.out == pico(*name.split(), "--help").out
    assert len(lines) <= 40 and not re.search(r"[{}]", lines[0])
    assert [line for line in lines if len(line) > 80 or re.search(r"[a-z](\.\.\.|…)$", line)] == []
    assert (
        re.search(rf"Examples:\n( .*\n)*  .*pico {name}\b", answer.out)
        or f"`pico {name.partition(' ')[0]}` alone" in answer.out
    )
    assert "completion for the current shell" not in answer.out


@pytest.mark.parametrize("name", [*MOVED, *RESERVED])
def test_a_name_of_before_or_of_later_answers_in_a_line_and_does_nothing(name: str, pico: Pico, tmp_path: Path) -> None:
    for words in ([name], [name, "p2", "--yes"], ["help", name], ["-C", str(tmp_path), name, "--help"]):
        answer = pico(*words)
        bisecting = name == "bisect-step" and words[0] != "help"  # to `git bisect run` 1 would mean a bad commit
        assert (answer.code, answer.out) == (129 if bisecting else 1, "")
        assert len(answer.err.splitlines()) == 1 and answer.err.startswith(f"error[usage]: `pico {name}` is ")
        assert "did you mean" not in answer.err
    if name in MOVED:
        first, *rest = MOVED[name].removeprefix("pico ").split()
        made: Any = build().get_command(None, first)
        assert made is not None
        below = getattr(made, "commands", None)
        assert below is None or rest[0] in below
        assert all(any(word in p.opts for p in made.params) for word in rest if word.startswith("--"))
    else:
        assert not any(f"pico {moving}" in answer.err or f"`{moving}`" in answer.err for moving in MOVING)


def test_no_command_keeps_a_name_of_before_and_the_table_has_every_name() -> None:
    assert not files().keys() & MOVED.keys()
    assert not MOVED.keys() & RESERVED.keys()
    written = set(re.findall(r"`([a-z-]+)`", TABLE.read_text()))
    assert files().keys() | MOVED.keys() | RESERVED.keys() <= written


def test_a_command_file_of_a_reserved_name_takes_over_by_being_there(
    tmp_path: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    said = 'def mcp() -> None:\n    """Serve an assistant."""\n    print("here it is")\n'
    (tmp_path / "mcp.py").write_text(f'"""The simulator, and the rest, 99: `pico mcp`."""\n\n{said}')
    monkeypatch.setattr(commands, "__path__", [*commands.__path__, str(tmp_path)])
    assert "  mcp         Serve an assistant." in help_text()
    assert (pico("mcp").code, pico("mcp").out) == (0, "here it is\n")
    build().commands.pop("mcp")


def test_help_is_also_a_word(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["help"]) == 0
    assert capsys.readouterr().out == help_text() + "\n"
    assert main(["help", "nosuch"]) == 1


def test_each_command_declares_a_place_of_its_own_in_the_help() -> None:
    """Read as Python reads them, not as the help does: a declaration that the help misses would be missed here, too."""
    places = {}
    for name, path in files().items():
        assigned = [node for node in ast.parse(Path(path).read_text()).body if isinstance(node, ast.Assign)]
        declared = {node.targets[0].id: node.value.value for node in assigned if isinstance(node.value, ast.Constant)
                    and isinstance(node.targets[0], ast.Name)}  # fmt: skip
        assert declared["HEADING"] in HEADINGS and 0 < declared["ORDER"] < LAST, name
        places.setdefault((declared["HEADING"], declared["ORDER"]), []).append(name)
    assert [names for names in places.values() if len(names) > 1] == [], "two commands in one place"
    shown = [name for heading in HEADINGS for name in summary()[heading]]
    assert shown == [names[0] for _, names in sorted(places.items(), key=lambda at: (HEADINGS.index(at[0][0]), at[0]))]
