"""`pico log`, `pico diff` and `pico show`: ranges, components and files as in git, with what happened on the table."""

from __future__ import annotations

import os
import pty
import re
import subprocess
import sys
from pathlib import Path

import pytest
from commanding import Pico, edit


def git(*arguments: str) -> str:
    return subprocess.run(["git", *arguments], check=True, capture_output=True, text=True).stdout


def commit(message: str, *edits: tuple[str, str], path: str = "state/table.yaml") -> None:
    for before, after in edits:
        edit(Path(path), before, after)
    git("add", "-A")
    git("commit", "-q", "-m", message)


@pytest.mark.parametrize(
    ("words", "labels"),
    [
        (["C1..e1"], ["E1-3", "E1-2", "E1-1", "C3", "C2"]),
        (["^C3", "e1"], ["E1-3", "E1-2", "E1-1"]),
        (["e1", "-2"], ["E1-3", "E1-2"]),
        (["e1", "-n", "1"], ["E1-3"]),
        (["e2...e3", "--until=2026-01-05T17:30Z"], ["E2-3", "E2-2"]),
        (["--all", "--grep", "lens pair"], ["E3-2", "E2-3", "E1-3"]),
        (["--all", "--since", "2026-01-05T18:30Z", "--author", "PICO"], ["E3-2"]),
        (["e1^!"], ["E1-3"]),
        (["--all", "--", "p1.angle"], ["E3-2", "E2-3", "E1-3", "C1"]),
        (["e1", "--", "ly_150"], ["E1-2", "C1"]),
        (["--graph", "--", "lx_100"], ["E2-1"]),
        (["e1", "--", "state/table.yaml"], ["E1-3", "E1-2", "E1-1", "C3", "C2", "C1"]),
        (["--merges"], []),
    ],
)
def test_the_commits_are_those_that_git_would_show(shel: Path, pico: Pico, words: list[str], labels: list[str]) -> None:
    commits = pico("log", "--json", *words).data["commits"]
    assert [next((r for r in c["refs"] if "-" in r or r.startswith("C")), c["id"][:7]) for c in commits] == labels
    shown = pico("log", "--oneline", *words)
    assert shown.code == 0 and (not labels or all(label in shown.out for label in labels))


def test_a_log_about_a_part_shows_what_became_of_it_alone(shel: Path, pico: Pico) -> None:
    out = pico("log", "e1", "--", "p2").out
    assert "p2  turned +30°" in out and "p1.angle" not in out
    assert pico("log", "e1", "--", "p1.pose").out.count("commit ") == 1


def test_only_the_first_state_is_called_that(shel: Path, pico: Pico) -> None:
    assert "the first state: 1 tunable set" in pico("log", "--graph", "--", "p1.angle").out
    assert "ly_200 placed at (720, 420, 0°)" in pico("log", "--graph", "--", "ly_200").out


def test_a_part_is_followed_from_file_to_file_and_after_it_is_gone(shel: Path, pico: Pico) -> None:
    text = Path("state/table.yaml").read_text()
    head, _, rest = text.partition("  p2:\n")
    Path("state/table.yaml").write_text(head)
    Path("state/more.yaml").write_text(
        f"apiVersion: pico/v1\nkind: LabState\nmetadata: {{lab: shel}}\ncomponents:\n  p2:\n{rest}"
    )
    commit("p2 in a file of its own")
    moved = pico("log", "-1").out
    assert "no change on the table" in moved
    commit("further", ("x: 520", "x: 530"), path="state/more.yaml")
    assert pico("log", "--oneline", "--", "p2").out.splitlines()[0].endswith("p2 moved 10 mm (dx +10)")
    assert "further" in pico("log", "--", "state/more.yaml").out
    bench = Path("lab.yaml")
    bench.write_text(re.sub(r"(?m)^  p2:.*\n(?:    .*\n)*", "", bench.read_text()))
    Path("state/more.yaml").unlink()
    git("add", "-A")
    git("commit", "-q", "-m", "p2 sold")
    assert "further" in pico("log", "--", "p2").out


def test_a_merge_shows_where_it_differs_from_both_sides(shel: Path, pico: Pico) -> None:
    git("checkout", "-q", "-b", "left", "main")
    commit("left", ("x: 290", "x: 300"))
    git("checkout", "-q", "-b", "right", "main")
    commit("right", ("x: 520", "x: 530"))
    assert pico("merge", "left").code == 0
    about = pico("log", "--graph", "--", "p1").out
    assert "left" in about and "right" not in about and "Merge" not in about
    assert "|/" in pico("log", "--graph", "HEAD").out


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["log", "a..b..c"], "`a..b..c` is no range of commits"),
        (["log", "^a..b"], "no range"),
        (["log", "e9..main"], "there is no revision `e9`"),
        (["log", "p2"], "`pico log -- p2`"),
        (["log", "--sincee=now"], "no option --sincee"),
        (["log", "-n", "9" * 20], "less than or equal to 1000000000"),
        (["log", f"-{'9' * 20}"], "no option -9999"),
        (["log", "--", "p22"], "did you mean `p2`?"),
        (["log", "--", "p1.angel"], "did you mean `angle`?"),
        (["log", "--", "state/tabel.yaml"], "did you mean `state/table.yaml`?"),
        (["log", "--", "../x.yaml"], "lies outside the lab"),
        (["diff", "e1..e2", "e3"], "a range stands alone"),
        (["diff", "e1", "--", "p22"], "did you mean `p2`?"),
        (["diff", "e1", "e2", "e3"], "components go after `--`"),
        (["diff", "main", "e11"], "did you mean `e1`?"),
        (["show", "e1:p22"], "did you mean `p2`?"),
        (["show", "e1:state/table.yaml"], "git show e1:./state/table.yaml"),
    ],
)
def test_mistakes_say_what_would_be_right(shel: Path, pico: Pico, words: list[str], said: str) -> None:
    answer = pico(*words)
    assert answer.code == 1 and said in answer.err, answer


def test_a_diff_of_ranges_is_that_of_git(shel: Path, pico: Pico) -> None:
    def changes(*words: str) -> list[tuple[str, str, str]]:
        return [(c["component"], c["tunable"], c["text"]) for c in pico("diff", "--json", *words).data["changes"]]

    assert changes("e1..e2") == changes("e1", "e2") != []
    assert changes("e1...e2") == changes("C3", "e2")
    assert changes("e1...") == changes("main..HEAD") == []
    assert changes("C1..e1", "--", "lx_125", "p1.angle") == [
        ("lx_125", "pose", "placed at (395, 420, 0°)"), ("p1", "angle", "90 → 1 deg")
    ]  # fmt: skip
    assert changes("C1..e1", "--", "state") == changes("C1..e1")


def test_exit_code_stat_and_picture(shel: Path, pico: Pico) -> None:
    assert pico("diff", "--exit-code").code == 0 and pico("diff", "e1", "e2", "--exit-code").code == 1
    assert pico("diff", "e1", "e2").code == 0
    assert pico("diff", "e1", "--exit-code", "--", "p1.pose").code == 0
    stat = pico("diff", "C3", "e1", "--stat").out
    assert "5 tunables of 4 components differ" in stat or "4 tunables of 4 components differ" in stat
    assert pico("diff", "e1...e2", "--picture", "d.png").code == 0 and Path("d.png").stat().st_size > 1000


def test_what_moves_nothing_is_told_in_a_line(shel: Path, pico: Pico) -> None:
    edit(Path("state/table.yaml"), "    angle: 22.75", "    angle: 22.75  # found by hand")
    answer = pico("diff", "--exit-code")
    assert answer.code == 1 and "And text that changes nothing physical: state/table.yaml" in answer.out
    with Path("state/table.yaml").open("a") as file:
        file.write("expect:\n  - that: 'p2.angle == 90.0'\n")
    edit(Path("lab.yaml"), "home: storage/a1", "home: storage/a1   # left")
    out = pico("diff").out
    assert "No component differs." in out and "+ expects p2.angle == 90.0" in out and "lab.yaml" in out
    assert pico("diff", "--json").data["text"] == ["lab.yaml"]
    edit(Path("lab.yaml"), "marker: 1", "marker: 41")
    assert "The bench itself differs: lab.yaml (`git diff HEAD -- lab.yaml`)" in pico("diff").out


def test_show_of_one_component_at_a_revision(shel: Path, pico: Pico) -> None:
    out = pico("show", "e1:p2").out
    assert "p2 at E1-3:" in out and "(520, 420, 30°)  angle 90 deg" in out and "ly_150" not in out
    assert list(pico("show", "e1:p2", "--json").data["state"]) == ["p2"]
    assert pico("show", "e1").out.count("ly_150") == 1


def test_runs_evidence_and_notes_are_told(shel: Path, pico: Pico) -> None:
    git("checkout", "-q", "e1")
    assert pico("apply", "--auto-approve", "--fidelity", "kinematic").code == 0
    edit(Path("state/table.yaml"), "x: 395", "x: 396")
    Path("notes").mkdir()
    Path("notes/lx_125.md").write_text("- 2026-11-21 Ada: scratched\n")
    with Path("state/table.yaml").open("a") as file:
        file.write('expect:\n  - {that: "p2.angle < 1.0", message: p2 is crossed}\n')
    pico("apply", "--auto-approve", "--fidelity", "kinematic")
    assert pico("commit", "-m", "a bit further", "--planned").code == 0
    commits = pico("log", "-1", "--json").data["commits"]
    assert [r["outcome"] for r in commits[0]["runs"]] == ["done", "done"]
    out = pico("log", "-1", "--", "lx_125").out
    assert "Notes on lx_125:" in out and "scratched" in out and "Pico-State" not in out
    assert "operations done" in out and "✗ p2 is crossed: `p2.angle < 1.0` failed" in out
    assert "1 expectation failed" in pico("log", "--graph", "-1").out
    assert "scratched" in pico("show", "HEAD:lx_125").out and "operations done" in pico("show").out


def test_a_lab_below_the_top_of_its_repository(shel: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch) -> None:
    Path("../outer/labs").mkdir(parents=True)
    monkeypatch.chdir("../outer")
    git("init", "-q")
    for name in ("lab.yaml", "state"):
        subprocess.run(["cp", "-r", str(shel / name), "labs"], check=True)
    commit("lab", path="labs/lab.yaml")
    Path("README").write_text("outside")
    commit("not about the lab", path="README")
    commit("moved", ("x: 520", "x: 521"), path="labs/state/table.yaml")
    out = pico("-C", "labs", "log", "--oneline").out
    assert len(out.splitlines()) == 2 and "not about" not in out
    assert "moved" in pico("-C", "labs/state", "log", "--oneline", "--", "table.yaml").out
    assert pico("-C", "labs", "log", "--", "../README").code == 1


def test_a_commit_that_can_not_be_read_stops_nothing(shel: Path, pico: Pico) -> None:
    commit("broken", ("x: 520", "x: [520"))
    commit("mended", ("x: [520", "x: 525"))
    shown = pico("log", "--oneline").out.splitlines()
    assert "mended" in shown[0] and any("broken" in line and "can't be read" in "".join(shown) for line in shown)
    assert pico("log", "--", "p2").code == 0


def test_nothing_is_paged_without_a_terminal_and_a_closed_pipe_ends_the_work(shel: Path) -> None:
    pico = f"{sys.executable} -c 'import sys; from pico_cli.main import main; sys.exit(main())'"
    done = subprocess.run(
        ["bash", "-c", f"GIT_PAGER='cat >&2' {pico} log --all | head -1; echo ${{PIPESTATUS[0]}}"],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.stderr == "" and done.stdout.splitlines()[-1] == "0" and done.stdout.startswith("commit ")


def test_a_terminal_gets_the_pager_of_git_with_colors(shel: Path, tmp_path: Path) -> None:
    program = "import sys; from pico_cli.main import main; sys.exit(main())"
    master, slave = pty.openpty()
    environment = os.environ | {"GIT_PAGER": f"cat > {tmp_path}/paged", "TERM": "xterm"}
    environment.pop("NO_COLOR", None)
    command = [sys.executable, "-c", program, "log", "e1", "--oneline"]
    done = subprocess.run(command, stdout=slave, stderr=subprocess.PIPE, env=environment, check=False)
    os.close(slave)
    os.close(master)
    assert done.returncode == 0 and done.stderr == b""
    assert "\x1b[33mE1-3" in (tmp_path / "paged").read_text()


def test_a_shallow_clone_shows_what_it_has(shel: Path, pico: Pico) -> None:
    git("clone", "-q", "--depth", "2", "--branch", "e1", f"file://{shel}", "../shallow")
    for words in ((), ("--", "p2"), ("--graph",), ("--", "state")):
        answer = pico("-C", "../shallow", "log", "--oneline", *words)
        assert answer.code == 0 and "tilt of p2" in answer.out


def test_history_can_be_read_while_the_manifests_are_in_conflict(shel: Path, pico: Pico) -> None:
    edit(Path("state/table.yaml"), "x: 520", "<<<<<<< ours\n      x: 520")
    assert "E1-3" in pico("log", "e1").out and pico("show", "e1:p2").code == 0
    assert pico("diff", "C1..e1").code == 0
    assert "state/table.yaml" in pico("diff").err
    edit(Path("lab.yaml"), "kind: Lab", "kind: Lob")
    assert "E1-3" in pico("log", "e1", "--", "p2").out


def test_messages_of_others_steer_no_terminal(shel: Path, pico: Pico) -> None:
    git("commit", "-q", "--allow-empty", "-m", "be\x1b]0;gone\x07ware\x1b[2J", "-m", "second \x9b2J line")
    for words in (["log", "-1"], ["log", "--oneline", "-1"], ["log", "--graph", "-1"], ["show"]):
        out = pico(*words).out
        assert "be?]0;gone?ware" in out and not {"\x1b", "\x07", "\x9b"} & set(out)
