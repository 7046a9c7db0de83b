"""`pico runs` and what `pico verify` says of a commit, as somebody at the terminal reads it."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest
from commanding import Pico
from pico_cli.views.verified import proof

from pico.bench.bench import Bench
from pico.model.trace.expectation import Standing


@pytest.fixture(scope="module")
def ran(example: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The example after e1, a commit of it, a change of p1 with a commit, and one that no commit has."""
    folder = tmp_path_factory.mktemp("ran") / "shel"
    shutil.copytree(example, folder)
    git = ["git", "-c", "user.name=A", "-c", "user.email=a@localhost"]
    subprocess.run([*git, "checkout", "-q", "e1"], cwd=folder, check=True)
    for key, value in (("user.name", "A"), ("user.email", "a@localhost")):
        subprocess.run(["git", "config", key, value], cwd=folder, check=True)
    with Bench.open(folder) as bench:
        bench.apply()
        bench.commit("e1 stands")
        bench.apply(bench.plans.single("p1", "set", {"angle": "5"}))
        bench.commit("p1 at 5", mode="capture")
        bench.apply(bench.plans.single("p1", "set", {"angle": "9"}))
    return folder


@pytest.fixture
def here(ran: Path, tmp_path: Path, shel: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    folder = tmp_path / "ran"
    shutil.copytree(ran, folder)
    monkeypatch.chdir(folder)
    return folder


def runs(pico: Pico, *words: str) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = pico("--json", "runs", "list", *words).data["runs"]
    return found


def test_what_others_began_stands_apart(here: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch) -> None:
    assert "Nobody else began a run here." in pico("runs", "list", "--others").out
    monkeypatch.setattr("pico.history.runs.uncommitted._own", lambda *_: [])  # as at a bench that others use
    found = pico("--json", "runs", "list", "--others").data
    (theirs,) = (one["document"] for one in found["others"])
    assert theirs["id"] not in [one["document"]["id"] for one in found["runs"]]
    own, _, others = pico("runs", "list", "--others").out.partition("What others began at this bench")
    assert theirs["id"][-6:] in others and theirs["operator"] in others and theirs["id"][-6:] not in own
    assert theirs["id"] in pico("runs", "show", theirs["id"][-6:]).out


def test_runs_are_listed_newest_first_a_line_each(here: Path, pico: Pico) -> None:
    answer = pico("runs", "list")
    assert answer.code == 0
    head, own, second, first, _, last = answer.out.splitlines()
    assert head.split()[:2] == ["run", "when"]
    assert own.split()[3:8] == ["set", "p1.angle", "sim", "kinematic", "done"]
    assert own.endswith("not yet")
    assert "apply the manifest" in first
    assert first.rstrip().endswith(runs(pico)[2]["commit"][:7])
    assert second.rstrip().endswith("e1")
    assert last == "1 run that no commit has yet: `pico commit` takes it."
    assert max(map(len, answer.out.splitlines())) <= 110


def test_a_revision_a_range_and_a_component_narrow_the_list(here: Path, pico: Pico) -> None:
    own, second, first = (run["document"]["id"] for run in runs(pico))

    def ids(*words: str) -> list[str]:
        return [run["document"]["id"] for run in runs(pico, *words)]

    assert ids("e1") == [second, first]
    assert ids("HEAD~1") == [first]
    assert ids("HEAD~1..") == [second]
    assert ids("main..e1") == [second, first]
    assert ids("main") == []
    assert ids("--", "p1") == [own, second, first]
    assert ids("--", "lx_125") == [first]
    subprocess.run(["git", "checkout", "-q", "main"], check=True)
    assert ids() == [own]
    assert ids("--all") == [own, second, first]


def test_a_run_is_shown_with_everything_by_the_beginning_of_its_id(here: Path, pico: Pico) -> None:
    (_, second, first) = (run["document"]["id"] for run in runs(pico))
    answer = pico("runs", "show", first)
    assert answer.code == 0
    assert f"run {first}  carried by" in answer.out
    assert "11 of 11 operations done" in answer.out
    assert "kinematic: simulated, never hardware" in answer.out
    assert "placed at (395, 420, 0°)" in answer.out
    assert "move lx_125 → (395, 420, 0°)" in answer.out
    assert "planned" in answer.out
    assert pico("runs", "show", second[:-1]).out.startswith(f"run {second}")
    assert pico("runs", "show", second[-6:]).out.startswith(f"run {second}")
    data = pico("runs", "show", first, "--json").data
    assert (data["schema"], data["document"]["id"]) == ("pico.recorded/v1", first)
    assert {op["outcome"] for op in data["operations"]} == {"done"}
    assert sum(op["primitive"] == "move" for op in data["operations"]) == 4
    assert {m["component"] for m in data["measurements"]} >= {"p1", "p2", "laser"}


def test_without_a_name_the_last_run_is_shown(here: Path, pico: Pico) -> None:
    answer = pico("runs", "show")
    assert "no commit has it yet" in answer.out
    assert "set p1.angle → 9" in answer.out


def test_two_runs_are_compared(here: Path, pico: Pico) -> None:
    own, second, first = (run["document"]["id"] for run in runs(pico))
    answer = pico("runs", "compare", second, own)
    assert answer.code == 0
    assert "p1.angle  5 → 9 deg" in answer.out
    assert "set p1.angle → 9" in answer.out
    same = pico("runs", "compare", first, first)
    assert "They led to the same state." in same.out
    assert "Nothing else differs." in same.out
    data = pico("runs", "compare", first, second, "--json").data
    assert (data["schema"], data["same"]) == ("pico.run-comparison/v1", False)
    assert {d["name"] for d in data["differing"]} >= {"goal", "cause", "seconds", "plan"}
    only = [p for p in data["operations"] if p["primitive"] == "move"]
    assert all("a" in p and "b" not in p for p in only)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["show", "2026"], "3 runs begin or end with `2026`"),
        (["show", "1999"], "there is no run `1999`"),
        (["list", "e9"], "there is no revision `e9`"),
        (["list", "--all", "e1"], "--all"),
        (["list", "main...e1"], "runs are listed of `A..B`"),
        (["list", "--", "p3"], "there is no component `p3`"),
        (["compare", "2026", "1999"], "begin or end with"),
    ],
)
def test_mistakes_are_sentences(here: Path, pico: Pico, words: list[str], said: str) -> None:
    year = runs(pico)[0]["document"]["id"][:4]
    answer = pico("runs", *(word.replace("2026", year) for word in words))
    assert answer.code == 1
    assert said.replace("2026", year) in answer.err
    assert "error[" in answer.err


def test_a_lab_without_runs_says_so(shel: Path, pico: Pico) -> None:
    assert "No run here has moved anything" in pico("runs", "list").out
    assert "no run of this lab" in pico("runs", "show").err


@pytest.mark.parametrize("name", ["run.json", "trace.jsonl", "measurements.jsonl"])
def test_a_damaged_file_is_said_by_name_and_the_rest_is_shown(here: Path, pico: Pico, name: str) -> None:
    _, second, first = (run["document"]["id"] for run in runs(pico))
    (path,) = here.glob(f"runs/*/*/{second}/{name}")
    path.write_bytes(b"\x1b[2Jnonsense\n" + path.read_bytes()[5:])
    subprocess.run(["git", "commit", "-q", "--amend", "--no-edit", "--", str(path)], check=True)
    listed, shown, verified = pico("runs", "list", "--all"), pico("runs", "show", second), pico("verify", "HEAD")
    relative = str(path.relative_to(here))
    for answer in (listed, shown, verified):
        assert "Traceback" not in answer.err
        assert "\x1b" not in answer.out + answer.err
    assert first in listed.out
    assert relative in shown.err
    assert relative in verified.err
    assert "is verified" not in verified.out
    assert shown.code == (1 if name == "run.json" else 0)
    if name == "run.json":
        assert relative in listed.err
        assert relative in pico("runs", "list", "--all", "--json").data["diagnostics"][0]["summary"]


def test_what_a_file_of_somebody_else_says_does_not_steer_the_terminal(here: Path, pico: Pico) -> None:
    second = runs(pico)[1]["document"]["id"]
    (path,) = here.glob(f"runs/*/*/{second}/run.json")
    content = json.loads(path.read_text())
    path.write_text(
        json.dumps(content | {"operator": "\x1b]0;mine\x07", "goal": "\x1b[2J", "cause": {"kind": "\x1bc"}})
    )
    subprocess.run(["git", "commit", "-q", "--amend", "--no-edit", "--", str(path)], check=True)
    for words in (["list", "--all"], ["show", second], ["compare", second, second]):
        answer = pico("runs", *words)
        assert answer.code == 0
        assert "\x1b" not in answer.out.replace("\x1b[33m", "")
        assert "\x07" not in answer.out


def test_verify_says_what_proves_the_commit(here: Path, pico: Pico) -> None:
    own, second, first = (run["document"]["id"] for run in runs(pico))
    answer = pico("verify", "HEAD~1")
    assert f"was verified: the run {first} led to exactly this state; the bench has left it since." in " ".join(
        answer.out.split()
    )
    assert "Simulated (kinematic, sim): never hardware." in answer.out
    assert answer.code == 1  # the bench is at 9 by now
    assert "is planned: no run in this history led to it." in pico("verify", "E2-3").out
    data = pico("verify", "--json").data["standing"]
    assert (data["verdict"], data["evidence"], data["run"]) == ("verified", "kinematic", second)
    assert own not in json.dumps(data)


def test_that_a_commit_is_verified_is_told_of_the_commit_whatever_the_manifest_says(here: Path, pico: Pico) -> None:
    pico("capture")
    answer = pico("verify")
    assert "The bench equals the manifest" in answer.out and "has left it since" in " ".join(answer.out.split())
    subprocess.run(["git", "checkout", "-q", "state"], check=True)
    pico("apply", "--auto-approve")
    table = here / "state" / "table.yaml"
    table.write_text(table.read_text().replace("x: 520", "x: 525"))
    answer = pico("verify")
    assert "not as the manifest says" in answer.out and "is verified" in answer.out


def test_a_plan_that_was_committed_is_verified_once_it_was_applied(here: Path, pico: Pico) -> None:
    from commanding import edit

    pico("commit", "--capture", "-m", "at 9")
    edit(here / "state" / "table.yaml", "angle: 9\n", "angle: 11\n")
    assert pico("commit", "--planned", "-m", "an idea").code == 0
    assert "is planned" in pico("verify", "HEAD").out
    assert pico("apply", "--auto-approve").code == 0
    proven = pico("verify", "HEAD")
    assert "is verified" in proven.out
    assert "no commit has it yet: `pico commit` takes it" in proven.out
    assert pico("commit", "-m", "it works").code == 0
    assert "is verified" in pico("verify", "HEAD~1").out
    assert "that no commit has" not in pico("runs", "list").out


def test_a_damaged_journal_hides_nothing_of_what_commits_prove(here: Path, pico: Pico) -> None:
    for path in (here / ".pico").glob("journal.sqlite*"):
        path.unlink()
    (here / ".pico/benches/sim" / "journal.sqlite").write_bytes(b"this is no database " * 300)
    answer = pico("verify", "HEAD")
    assert "was verified" in answer.out
    assert "is damaged" in answer.err
    listed = pico("runs", "list")
    assert listed.code == 0
    assert len(listed.out.splitlines()) == 3
    assert "is damaged" in listed.err


@pytest.mark.parametrize(
    ("evidence", "said"),
    [
        ("kinematic", "Simulated (kinematic): never hardware."),
        ("physics", "Simulated (physics): never hardware."),
        ("emulated", "On emulated devices, never hardware."),
        ("hardware", "On hardware."),
    ],
)
def test_what_kind_of_bench_proved_it_is_said_in_words(evidence: str, said: str) -> None:
    found = Standing(verdict="verified", commit="c" * 40, evidence=evidence, run="r1", carried="d" * 40, why="it did")
    assert said in [line.strip() for line in proof(found)]


def test_runs_that_no_commit_has_are_counted_beyond_the_end_of_the_list(shel: Path, pico: Pico) -> None:
    for angle in ("1", "2", "3"):
        assert pico("set", "p1", f"angle={angle}", "-y").code == 0
    shown = pico("runs", "list", "-n", "2")
    assert "3 runs that no commit has yet" in shown.out and shown.out.count("set p1.angle") == 2
    assert len(pico("runs", "list", "-n", "2", "--json").data["runs"]) == 2


def test_without_git_the_runs_of_the_bench_are_listed_and_nothing_is_proven(
    ran: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, pico: Pico
) -> None:
    shutil.copytree(ran, tmp_path / "plain", ignore=shutil.ignore_patterns(".git", "runs"))
    monkeypatch.chdir(tmp_path / "plain")
    monkeypatch.setenv("GIT_CEILING_DIRECTORIES", str(tmp_path))
    assert len(runs(pico)) == 3
    assert "no commit has it yet" in pico("runs", "show").out
    assert "standing" not in pico("verify", "--json").data
    wrong = pico("runs", "list", "e1")
    assert wrong.code == 1
    assert "no Git repository" in wrong.err
    subprocess.run(["git", "init", "-q"], check=True)
    assert len(runs(pico)) == 3
    assert "standing" not in pico("verify", "--json").data


def test_what_moved_in_a_run_is_told_moment_by_moment(here: Path, pico: Pico) -> None:
    found = pico("--json", "runs", "show", runs(pico)[2]["document"]["id"], "--frames").data
    assert (found["schema"], found["origin"]) == ("pico.frames/v1", "reconstructed")
    assert found["scene"]["schema"] == "pico.scene/v1" and found["moved"] and not found["diagnostics"]
    assert [step["outcome"] for step in found["steps"]] == ["done"] * len(found["steps"])
    text = pico("runs", "show", "--frames").out
    assert "p1.angle" in text and "reconstructed: a run keeps no joints" in text


def test_what_would_move_in_a_plan_comes_after_the_plan(here: Path, pico: Pico) -> None:
    plan, found = (json.loads(line) for line in pico("--json", "plan", "--frames").out.splitlines())
    assert plan["schema"] == "pico.plan/v1" and found["schema"] == "pico.frames/v1"
    assert (found["origin"], found["plan"]) == ("planned", plan["digest"])
    assert [step["address"] for step in found["steps"]] == ["p1.angle"] and found["seconds"] == plan["makespan"]
    assert "as the plan reckons" in pico("plan", "--frames").out


def test_what_commits_carry_is_listed_and_shown_also_while_the_coordinator_is_away(here: Path, pico: Pico) -> None:
    import socket

    carried = [run["document"]["id"] for run in runs(pico, "e1")]
    with socket.socket() as nobody:
        nobody.bind(("127.0.0.1", 0))  # and does not listen
        assert pico("remote", "add", "lab", f"http://127.0.0.1:{nobody.getsockname()[1]}").code == 0
        listed = pico("--bench", "shel/bench1", "runs", "list")
        assert listed.code == 0 and all(name in listed.out for name in carried) and "does not answer" in listed.err
        shown = pico("--bench", "shel/bench1", "runs", "show", carried[0])
        assert shown.code == 0 and f"run {carried[0]}" in shown.out


def test_the_newest_runs_are_listed_as_many_as_are_asked_for(here: Path, pico: Pico) -> None:
    every = [run["document"]["id"] for run in pico("runs", "list", "--json").data["runs"]]
    assert len(every) == 3
    assert [run["document"]["id"] for run in pico("runs", "list", "-n", "2", "--json").data["runs"]] == every[:2]
    assert pico("runs", "list", "-n", "0").code == 1
