"""Names, help, options before and after the command, and errors that are nobody's traceback."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from bench_at import bench_at
from commanding import Pico, edit
from pico_cli.app import build
from pico_cli.at_once.complete import SHARED, candidates
from pico_cli.at_once.declared import declared
from pico_cli.at_once.help import help_text
from pico_cli.commands import files, summary
from pico_cli.terminal.output import write

LEAVES = [f"{name} {below}".strip() for name, path in files().items() for below in declared(path)]


def command(name: str) -> Any:
    """Return the real command behind a name such as `plan` or `sim nudge`."""
    first, *rest = name.split()
    found = build().get_command(None, first)
    for word in rest:
        found = found.commands[word]
    return found


def test_the_top_level_help_says_of_each_command_what_its_own_help_says() -> None:
    listed = {name: line for commands in summary().values() for name, line in commands.items()}
    assert set(listed) == set(files()) == set(build().list_commands(None))
    for name, line in listed.items():
        assert command(name).help.strip().splitlines()[0] == line, name
        assert f"  {name:<11} {line}" in help_text(every=True)


@pytest.mark.parametrize("name", LEAVES)
def test_every_command_has_help_and_the_shared_options(name: str, pico: Pico) -> None:
    answer = pico(*name.split(), "--help")
    assert answer.code == 0
    assert f"Usage: pico {name}" in answer.out
    for option in SHARED:
        assert option in answer.out, option
    for parameter in command(name).params:
        assert getattr(parameter, "help", "") or parameter.name == "help", f"{name} {parameter.name} says nothing"


@pytest.mark.parametrize("name", LEAVES)
def test_completion_knows_the_options_of_every_command(name: str) -> None:
    first, _, below = name.partition(" ")
    options, arguments = declared(files()[first])[below]
    params = [p for p in command(name).params if not set(p.opts) & set(SHARED)]
    real = {word: not p.is_flag for p in params for word in p.opts if word.startswith("-")}
    assert {word: bool(metavar) for word, metavar in options.items()} == real
    assert arguments == [p.metavar or "VALUE" for p in params if not p.opts[0].startswith("-")]


def test_tab_offers_commands_names_and_revisions(shel: Path) -> None:
    assert candidates(["pl"]) == ["plan"]
    assert candidates(["plan", "e1", "--explain", "p"]) == ["p1", "p2"]
    assert candidates(["move", "l"]) == ["laser", "lx_100", "lx_125", "ly_150", "ly_200"]
    assert candidates(["diff", "C1", "E1"]) == ["E1-1", "E1-2", "E1-3"]
    assert candidates(["-C", ".", "plan", "--fidelity", ""]) == ["kinematic", "physics"]
    assert candidates(["sim", "n"]) == ["nudge"]
    assert candidates(["-C", str(shel), "sim", "nudge", "p"]) == ["p1", "p2"]
    assert candidates(["checkout", "e1", "--", "p1", "p"]) == ["p1", "p2"]
    assert candidates(["stash", "p"]) == ["pop", "push"]


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_a_completion_script_is_printed(shell: str, pico: Pico) -> None:
    assert "_PICO_COMPLETE=1 pico" in pico("completion", shell).out


def test_options_count_before_and_after_the_command(shel: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir("/")
    for words in (["-C", str(shel), "--json", "status"], ["status", "--json", "-C", str(shel)],
                  ["-C", "/nowhere", "status", "-C", str(shel), "--json"]):  # fmt: skip
        answer = pico(*words)
        assert answer.code == 0, answer
        assert answer.data["schema"] == "pico.status/v1"


@pytest.mark.parametrize(
    ("words", "schema"),
    [
        (["plan", "e1"], "plan"), (["status"], "status"), (["diff", "C3", "E1-3"], "diff"), (["log"], "log"),
        (["log", "--graph"], "log"), (["show", "E1-3"], "revision"), (["drift"], "drift"),
        (["catalog", "parts"], "parts"),
        (["catalog", "list"], "catalog"), (["catalog", "show", "linear_polarizer"], "component-type"),
        (["validate"], "validation"), (["fmt", "--check"], "fmt"), (["get", "p1"], "values"), (["doctor"], "doctor"),
        (["runs"], "runs"), (["catalog"], "catalog"),
        (["sim", "nudge", "p1", "--dx", "1"], "sim"), (["capture"], "capture"), (["completion", "zsh"], "completion"),
        (["note", "p1"], "notes"),
    ],
)  # fmt: skip
def test_every_answer_can_be_json(shel: Path, pico: Pico, words: list[str], schema: str) -> None:
    answer = pico(*words, "--json")
    assert answer.code == 0, answer
    assert answer.err == ""
    assert answer.data["schema"] == f"pico.{schema}/v1"


def test_the_plan_as_json_is_the_file_that_out_writes(shel: Path, pico: Pico) -> None:
    from pico.model.plan import plan_from_json

    shown = pico("plan", "e1", "--json", "--out", "e1.plan").data
    assert plan_from_json((shel / "e1.plan").read_text()).digest == shown["digest"]
    assert shown["target"]["revision"] == "e1"
    assert shown["base"]["commit"]


def test_manifest_errors_come_all_at_once_with_place_and_caret(shel: Path, pico: Pico) -> None:
    edit(shel / "state" / "table.yaml", "exposure: 10", "exposure: 2 kg")
    edit(shel / "state" / "table.yaml", "angle: 22.75", "angel: 22.75")
    for words in (["validate"], ["plan"], ["apply", "--auto-approve"], ["status"]):
        answer = pico(*words)
        assert answer.code == 1
        assert "--> state/table.yaml:10:15" in answer.err
        assert "exposure: 2 kg" in answer.err
        assert "^^^^" in answer.err
        assert "did you mean `angle`?" in answer.err
        assert "2 errors" in answer.err
    found = pico("validate", "--json").data["diagnostics"]
    assert [d["source"]["start"]["line"] for d in found] == [10, 16]


def test_the_catalog_is_there_without_a_lab(tmp_path: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert "beam_camera" in pico("catalog", "list").out
    shown = pico("catalog", "show", "linear_polarizer").out
    assert "0 to 360 deg" in shown
    assert "repeats every 180 deg" in shown
    wrong = pico("catalog", "show", "linear_polariser")
    assert wrong.code == 1
    assert "did you mean `linear_polarizer`?" in wrong.err


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["nosuch"], "no command `nosuch`"),
        (["plann"], "did you mean `plan`?"),
        (["plan", "--bogus"], "no such option: --bogus"),
        (["checkout"], "missing argument"),
        (["commit", "--meta", "x"], "key=value"),
        (["commit", "p9"], "no component `p9`"),
        (["commit", "--meta", "X=1", "--meta", "t=a\nb"], "no key"),
        (["capture", "p2.angel"], "did you mean `angle`"),
        (["note", "p9", "x"], "no part `p9`"),
        (["sim", "kick"], "kick"),
        (["sim", "nudge", "p2", "--dx", "nan"], "--dx"),
        (["plan", "e1", "e2"], "extra argument"),
        (["plan", "e9"], "there is no revision `e9`"),
        (["plan", "--backend", "hardware"], "no driver for the arm arm1 (xarm7)"),
        (["plan", "--backend", "hardware", "--emulate"], "no driver for the arm arm1 (xarm7)"),
        (["plan", "--backend", "sim", "--emulate"], "has no devices that could be emulated"),
        (["plan", "--backend", "sin"], "did you mean `sim`?"),
        (["plan", "--fidelity", "physic"], "did you mean `physics`?"),
        (["commit", "-m", "x", "--capture", "--planned"], "contradict"),
        (["render", "--view", "side"], "--view can't be `side`"),
        (["render", "--plan"], "from above only"),
        (["completion", "tcsh"], "shell can't be `tcsh`"),
        (["fmt", "nosuch.yaml"], "nosuch.yaml"),
        (["plan", "--out", "no/such/folder/x.plan"], "no/such/folder/x.plan"),
        (["init", "."], "exist"),
        (["init", "d", "--example", "shell"], "did you mean `shel`?"),
        (["-C", "/nowhere", "plan"], "there is no folder /nowhere"),
    ],
)  # fmt: skip
def test_mistakes_exit_1_with_a_sentence(shel: Path, pico: Pico, words: list[str], said: str) -> None:
    answer = pico(*words)
    assert answer.code == 1, answer
    assert said in answer.err
    assert "error[" in answer.err
    assert "Traceback" not in answer.err
    as_json = pico(*words, "--json")
    assert as_json.code == 1
    assert as_json.data["diagnostics"][0]["severity"] == "error"


def test_a_folder_that_is_gone_is_called_gone(tmp_path: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "gone").mkdir()
    monkeypatch.chdir(tmp_path / "gone")
    (tmp_path / "gone").rmdir()
    for words in (["status"], ["init", "new"]):
        answer = pico(*words)
        assert answer.code == 1 and "the folder you are in is gone" in answer.err, answer


def test_a_mistake_in_pico_itself_is_one_line_with_what_to_report(
    shel: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(*_: object, **__: object) -> None:
        raise ZeroDivisionError("division by zero")

    monkeypatch.setattr("pico.bench.watching.Watch.status", broken)
    answer = pico("status")
    assert answer.code == 1
    assert "error[internal]: PICO itself failed: ZeroDivisionError: division by zero" in answer.err
    assert "--debug" in answer.err
    assert "Traceback" not in answer.err
    assert "Traceback" in pico("--debug", "status").err


def test_init_makes_a_lab_that_validates_and_says_what_next(
    tmp_path: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    answer = pico("init", "mybench")
    assert answer.code == 0
    assert "cd mybench" in answer.out
    assert pico("-C", "mybench", "validate").code == 0
    assert pico("-C", "mybench", "plan").code == 0
    assert "no camera over the bench sees it" in pico("-C", "mybench", "do", "lens", "measure", "pose", "-y").err


def test_a_folder_is_made_where_the_shell_says_also_inside_another_repository(
    tmp_path: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    subprocess.run(["git", "init", "-q", str(tmp_path / "outer")], check=True)
    (tmp_path / "outer" / "bench").mkdir()
    monkeypatch.chdir(tmp_path / "outer" / "bench")
    answer = pico("init", "--example", "minimal", "../other")
    assert answer.code == 0 and (tmp_path / "outer" / "other" / "lab.yaml").is_file()
    assert "add `other/` to .gitignore" in answer.err and "rm -rf" not in answer.err
    (tmp_path / "outer" / ".gitignore").write_text("third/\n")
    assert "nested" not in pico("init", "--example", "minimal", "../third").err
    assert "nested" not in pico("init", "--example", "minimal", "../../outside").err


def test_one_mistake_in_the_inventory_is_one_error_with_what_would_be_right(shel: Path, pico: Pico) -> None:
    assert pico("set", "p1", "angle=3", "-y").code == 0  # the bench keeps its own Lab from now on
    whole = (shel / "lab.yaml").read_text()
    edit(shel / "state" / "table.yaml", "components:", "components:\n  l4: {pose: {x: 900, y: 100}}")
    for part, code, hint in (
        ("{type: plano_convex_100, home: storage/a1, marker: 77}", "slot", "free slots: `storage/"),
        ("{type: plano_convex_100, marker: 77}", "value", "add `home:` with a free slot"),
        ("{type: plano_convex_100, home: storage/a9, pose: {x: 1, y: 2}}", "value", "keep one: `home`"),
    ):
        (shel / "lab.yaml").write_text(whole.replace("inventory:", f"inventory:\n  l4: {part}"))
        for words in (["plan"], ["validate"]):
            answer = pico(*words)
            assert answer.code == 1 and answer.err.count("error[") == 1, answer
            assert f"error[{code}]" in answer.err and hint in answer.err, answer


def test_fmt_check_names_the_file_and_fmt_writes_it(shel: Path, pico: Pico) -> None:
    edit(shel / "state" / "table.yaml", "    exposure: 10", "    exposure:   10   # ms")
    assert pico("fmt", "--check").code == 1
    assert pico("fmt").out.startswith("state/table.yaml\n1 file brought")
    assert "exposure: 10" in (shel / "state" / "table.yaml").read_text()
    assert "# ms" in (shel / "state" / "table.yaml").read_text()
    assert pico("fmt", "--check").code == 0


def test_the_graph_shows_all_branches_with_their_motions(shel: Path, pico: Pico) -> None:
    out = pico("log", "--graph", "--oneline").out
    assert len([line for line in out.splitlines() if "*" in line]) == 11
    assert "C3, main (HEAD)" in out
    assert "p2 turned +30°, p1.angle 90 → 1 deg" in out
    assert "|/" in out
    assert len([line for line in pico("log", "--oneline").out.splitlines() if line]) == 3
    assert len(pico("log", "-n", "1", "--json").data["commits"]) == 1


def test_a_bench_in_use_is_told_with_its_holder(shel: Path, pico: Pico) -> None:
    from pico.edge.lease import BenchLock

    with BenchLock(bench_at(shel)).held("somebody's apply"):
        answer = pico("apply", "e1", "--auto-approve")
    assert answer.code == 5
    assert "somebody's apply" in answer.err


def test_a_closed_pipe_ends_nothing(shel: Path) -> None:
    pico = f"{sys.executable} -c 'import sys; from pico_cli.main import main; sys.exit(main())'"
    done = subprocess.run(
        ["bash", "-c", f"{pico} apply e1 --auto-approve | true; echo ${{PIPESTATUS[0]}}; {pico} plan e1 --json"],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    code, plan = done.stdout.splitlines()
    assert code == "0", done.stderr
    assert "Error" not in done.stderr and "error" not in done.stderr
    assert json.loads(plan)["operations"] == []


def test_color_only_on_a_terminal_and_never_with_no_color(monkeypatch: pytest.MonkeyPatch) -> None:
    import io

    class Terminal(io.StringIO):
        def isatty(self) -> bool:
            return True

    def written(stream: io.StringIO) -> str:
        write(stream, "\x1b[31mred\x1b[0m")
        return stream.getvalue()

    monkeypatch.delenv("NO_COLOR", raising=False)
    monkeypatch.setenv("TERM", "xterm")
    assert written(Terminal()) == "\x1b[31mred\x1b[0m\n"
    assert written(io.StringIO()) == "red\n"
    monkeypatch.setenv("NO_COLOR", "1")
    assert written(Terminal()) == "red\n"


def test_the_page_about_json_has_every_schema_that_is_printed() -> None:
    root = Path(__file__).resolve().parents[2]
    page = (root / "docs" / "reference" / "json.md").read_text()
    for view in (root / "cli").rglob("*.py"):
        for schema in re.findall(r'"(pico\.[a-z-]+/v1)"', view.read_text()):
            assert f"`{schema}`" in page, schema


def test_an_unknown_command_of_a_group_is_looked_for_in_the_group(pico: Pico) -> None:
    answer = pico("runs", "sho")
    assert answer.code == 1
    assert (
        "`" not in answer.out and "pico runs has no command `sho`" in answer.err and "did you mean `show`" in answer.err
    )


@pytest.mark.parametrize(("typed", "meant"), [
    ("stauts", "status"), ("plna", "plan"), ("mesure", "measure"), ("measrue", "measure"), ("validat", "validate"),
    ("remove", "remote"), ("drfit", "drift"), ("restore", ""), ("reset", ""), ("sync", ""),
    ("aply", ""), ("undoo", ""), ("mvoe", ""), ("resum", ""), ("optimise", ""), ("rn", ""), ("seet", ""),
])  # fmt: skip
def test_a_command_is_offered_for_a_slip_of_the_fingers_and_not_for_another_word(
    typed: str, meant: str, pico: Pico, shel: Path
) -> None:
    answer = pico(typed)
    assert answer.code == 1
    assert (f"did you mean `{meant}`?" in answer.err) if meant else ("did you mean" not in answer.err)


def test_a_command_that_asks_before_it_moves_something_is_offered_for_no_slip() -> None:
    """What takes --yes moves the bench, but for what is named here: it only reads, or writes books and files."""
    from pico_cli.at_once.declared import declared
    from pico_cli.commands import files
    from pico_cli.names import moves

    harmless = {
        "bench update",
        "data",
        "data gc",
        "doctor",
        "drift",
        "lease steal",
        "measure",
        "morning",
        "swap",
        "verify",
    }
    asks = {
        f"{name} {below}".strip()
        for name, path in files().items()
        for below, (options, _) in declared(path).items()
        if "--yes" in options
    }
    assert {name for name in asks if not moves(name)} <= harmless
    assert moves("pico resume") and not moves("pico measure")
