"""`pico bisect` and `git bisect run pico bisect step`, with real git on a small simulated bench."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest
from bench_at import bench_at
from commanding import Answer, Brought, Pico, Typed, edit
from pico_cli.main import main
from test_stopping_commands import started

from pico.edge.lease import BenchLock
from pico.history.bisect.git_state import GitBisect

STEP = f"{sys.executable} -c 'import sys; from pico_cli.main import main; sys.exit(main())' bisect step -y"
TABLE = Path("state/table.yaml")
LIMIT = "p1.pose.x < 305"
YES = ("--auto-approve",)


def git(*arguments: str, ends: Sequence[int] = (0,)) -> str:
    done = subprocess.run(["git", *arguments], capture_output=True, text=True, check=False)
    assert done.returncode in ends, done
    return done.stdout.strip()


def commit(message: str, before: str, after: str) -> str:
    edit(TABLE, before, after)
    git("commit", "-q", "-a", "-m", message)
    return git("rev-parse", "HEAD")


@pytest.fixture
def history(brought: Brought) -> dict[str, str]:
    found: dict[str, str] = brought(eight_commits)
    return found


def eight_commits(_: Path) -> dict[str, str]:
    """Eight commits after `good`; `break` moved p1 beyond the limit, `comment` changed nothing on the table."""
    git("tag", "good")
    at, made = 290, {}
    for n, (name, to) in enumerate(
        (("a", 294), ("b", 298), ("angle", 0), ("comment", 0), ("break", 310), ("c", 314), ("d", 318), ("e", 322))
    ):
        if name == "comment":
            made[name] = commit(name, "components:\n", "components:  # as on Monday\n")
        elif name == "angle":
            made[name] = commit(name, "angle: 22.75", "angle: 30")
        else:
            made[name] = commit(name, f"x: {at}", f"x: {to}")
            at = to
        assert n < 8
    return made


def events(answer: Answer, kind: str) -> list[dict[str, Any]]:
    found = [json.loads(line) for line in answer.out.splitlines()]
    return [e for e in found if e.get("kind") == kind]


def bisecting() -> bool:
    return GitBisect.under_way(Path.cwd()) is not None


def test_the_commit_that_broke_it_is_found_and_nothing_of_the_files_is_touched(
    history: dict[str, str], pico: Pico
) -> None:  # fmt: skip
    edit(TABLE, "x: 520", "x: 525")
    before, head = TABLE.read_text(), git("rev-parse", "HEAD")
    answer = pico("bisect", "run", "main", "good", "--expect", LIMIT, *YES)
    assert answer.code == 0, answer
    assert f'{history["break"][:7]} is the first bad commit: "break"' in answer.out
    assert "p1  moved 12 mm" in answer.out and "p1.pose.x is 310" in answer.out
    assert "good end" in answer.out and "bad end" in answer.out
    assert "configurations tried" in answer.out and "`pico apply` brings it back" in answer.out
    assert TABLE.read_text() == before and git("rev-parse", "HEAD") == head
    assert git("symbolic-ref", "--short", "HEAD") == "main"
    assert "break" in git("-c", "core.pager=cat", "bisect", "visualize", "--oneline")
    log = git("bisect", "log")
    assert f"# first bad commit: [{history['break']}]" in log
    Path("kept.log").write_text(log + "\n")
    git("bisect", "reset")
    assert f"{history['break']} is the first bad commit" in git("bisect", "replay", "kept.log")


def test_every_configuration_is_an_event(history: dict[str, str], pico: Pico) -> None:
    answer = pico("bisect", "run", "main", "good", "--expect", LIMIT, "--json", *YES)
    tried = events(answer, "tried")
    assert [t["end"] for t in tried[:2]] == ["good", "bad"] and {t["verdict"] for t in tried} == {"good", "bad"}
    measured = [t for t in tried if t["by"] == "measured" and not t["end"]]
    assert all(t["measure"] == 5 and t["travel"] == pytest.approx(t["estimate"], abs=0.5) for t in measured)
    assert len(measured) <= 4
    over = events(answer, "over")[0]
    assert over["first_bad"] == history["break"] and over["tried"] == len(measured) + 2
    assert over["seconds"] == pytest.approx(sum(t["travel"] + t["measure"] for t in tried))
    assert over["halving"] > 0


def test_a_commit_that_changes_nothing_on_the_table_is_never_built(history: dict[str, str], pico: Pico) -> None:
    git("bisect", "start", "--no-checkout", history["break"], "good")
    answer = pico("bisect", "continue", "--expect", LIMIT, "--json", *YES)
    built = [t["commit"] for t in events(answer, "tried") if t["by"] == "measured"]
    assert history["comment"] not in built
    assert events(answer, "over")[0]["first_bad"] == history["break"]
    assert any(t["by"] == "same" and t["commit"] == history["comment"] for t in events(answer, "tried"))


def test_where_the_good_end_is_not_good_now_the_cause_is_not_in_the_history(
    history: dict[str, str], pico: Pico
) -> None:  # fmt: skip
    answer = pico("bisect", "run", "main", "good", "--expect", "p1.pose.x < 280", *YES)
    assert answer.code == 1 and "good was called good and is bad now: p1.pose.x is 290" in answer.err
    assert "not in the history" in answer.err and not bisecting()
    answer = pico("bisect", "run", "main", "good", "--expect", "p1.pose.x < 900", *YES)
    assert answer.code == 1 and "main was called bad and is good now" in answer.err and not bisecting()


def test_what_cannot_be_built_read_or_told_is_skipped_and_named(shel: Path, pico: Pico) -> None:
    git("tag", "good")
    made = [
        commit("onto p2", "x: 290", "x: 515"),
        commit("nonsense", "x: 515", "x: far"),
        commit("moved", "x: far", "x: 320"),
        commit("moved on", "x: 320", "x: 330"),
    ]
    answer = pico("bisect", "run", "main", "good", "--expect", LIMIT, *YES)
    assert answer.code == 1
    assert "one of 3 commits; the others could not be told" in answer.out
    assert f"skipped {made[0][:7]}: p1" in answer.out and "overlap" in answer.out
    assert f"skipped {made[1][:7]}:" in answer.out
    assert f"git bisect skip {made[0]}" in git("bisect", "log")


def test_what_the_policy_denies_is_skipped_but_somebody_at_the_table_stops_the_search(
    history: dict[str, str], pico: Pico
) -> None:  # fmt: skip
    pico("sim", "person", "here")
    answer = pico("bisect", "run", "main", "good", "--expect", LIMIT, *YES)
    assert answer.code == 7 and "nobody_near_the_arm" in answer.err and "pico bisect continue" in answer.err
    assert pico("bisect", "step", "-y", "--expect", LIMIT).code == 135
    pico("sim", "person", "away")
    rule = "plan.target.state.p1.pose.x < 300 || plan.target.state.p1.pose.x > 312"
    edit(Path("lab.yaml"), "  rules:", f"  rules:\n    - {{name: not_there, that: {rule}}}")
    answer = pico("bisect", "continue", "--json", *YES)
    skipped = [t for t in events(answer, "tried") if t["verdict"] == "skip"]
    assert [t["commit"] for t in skipped] == [history["break"]] and "not_there" in skipped[0]["why"]
    assert events(answer, "over")[0]["suspects"] == [history["break"], history["c"]]


def test_an_expectation_that_cannot_be_told_is_neither_good_nor_bad(history: dict[str, str], pico: Pico) -> None:
    answer = pico("bisect", "run", "main", "good", "--expect", "cam.peak > 200", *YES)
    assert answer.code == 1 and "can't be told" in answer.err and not bisecting()
    git("bisect", "start", "--no-checkout", "main", "good")
    assert pico("bisect", "step", "-y", "--expect", "cam.peak > 200").code == 125


def test_a_person_judges_step_by_step_in_words_of_git_or_of_pico(history: dict[str, str], pico: Pico) -> None:
    answer = pico("bisect", "start", "main", "good", *YES)
    assert answer.code == 0 and "then say `pico bisect good`" in answer.out
    for _ in range(4):
        at = git("rev-parse", "BISECT_HEAD")
        assert pico("plan", at, "--detailed-exitcode").code == 0  # the bench stands there
        bad = int(git("show", f"{at}:state/table.yaml").split("p1:")[1].split("x: ")[1][:3]) >= 310
        assert f"under trial: {at[:7]}" in pico("bisect").out
        answer = pico("bisect", "bad" if bad else "good", *YES)
        assert answer.code == 0
        if "is the first bad commit" in answer.out:
            break
    assert f"{history['break'][:7]} is the first bad commit" in answer.out
    assert "the bisection is over" in pico("bisect", "skip", *YES).err
    assert pico("bisect", "reset").code == 0 and not bisecting()


def test_nobody_judges_what_the_bench_was_not_brought_to(history: dict[str, str], pico: Pico) -> None:
    pico("bisect", "start", "main", "good", *YES)
    at = git("rev-parse", "BISECT_HEAD")
    git("bisect", "bad")
    assert at in git("bisect", "log").splitlines()[-1]
    answer = pico("bisect", "good", *YES)
    assert answer.code == 1 and "the bench was not brought to" in answer.err
    assert pico("bisect", "good", "good~0", *YES).code == 0


def test_nothing_moves_without_a_yes(history: dict[str, str], pico: Pico, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.stdin", open(os.devnull))  # noqa: SIM115, PTH123
    answer = pico("bisect", "start", "main", "good")
    assert answer.code == 1 and "nobody can be asked" in answer.err and "pico bisect continue" in answer.err
    monkeypatch.setattr("sys.stdin", Typed("n\n"))
    answer = pico("bisect", "continue")
    assert answer.code == 1 and "Nothing moved" in answer.out and "pico bisect continue" in answer.out
    assert pico("bisect", "run", "main", "good", "--json").code == 1


def test_one_that_is_killed_goes_on_with_every_verdict_it_had(
    history: dict[str, str], pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:  # fmt: skip
    told = GitBisect.tell

    def killed(self: GitBisect, verdict: Any, commits: Sequence[str]) -> str:
        raise KeyboardInterrupt

    monkeypatch.setattr(GitBisect, "tell", killed)
    answer = pico("bisect", "run", "main", "good", "--expect", LIMIT, *YES)
    assert answer.code == 130 and "pico bisect continue" in answer.err
    monkeypatch.setattr(GitBisect, "tell", told)
    written = [note["tried"] for note in GitBisect(Path.cwd()).notes() if "tried" in note]
    assert [t["end"] for t in written] == ["good", "bad", ""]
    assert f"git bisect good {written[2]['commit']}" not in git("bisect", "log")
    answer = pico("bisect", "run", "main", "good", "--expect", LIMIT, "--json", *YES)
    assert events(answer, "over")[0]["first_bad"] == history["break"]
    assert not {t["commit"] for t in events(answer, "tried")} & {t["commit"] for t in written}
    measured = [t for t in events(answer, "tried") if t["by"] == "measured"]
    assert events(answer, "over")[0]["tried"] == len(measured) + 3


@pytest.mark.parametrize(
    "number", [*(pytest.param(n, marks=pytest.mark.slow) for n in (signal.SIGINT, signal.SIGHUP)), signal.SIGKILL]
)
def test_one_that_is_cut_off_in_a_move_goes_on_from_there(
    history: dict[str, str], pico: Pico, number: signal.Signals
) -> None:
    process = started(Path.cwd(), "bisect", "run", "main", "good", "--expect", LIMIT, *YES)
    process.send_signal(number)
    Path(".pico/goes_on").write_text("")
    out, _ = process.communicate(timeout=120)
    if number != signal.SIGKILL:
        assert process.returncode == 130 and "`pico bisect continue` goes on" in out
    answer = pico("bisect", "continue", *YES)
    assert answer.code == 0 and f"{history['break'][:7]} is the first bad commit" in answer.out


def test_another_one_under_way_is_named(history: dict[str, str], pico: Pico) -> None:
    pico("bisect", "start", "main", "good", *YES)
    answer = pico("bisect", "run", history["d"], "good", "--expect", LIMIT, *YES)
    assert answer.code == 1 and "another bisection is under way, between main (bad) and good (good)" in answer.err
    assert "pico bisect reset" in answer.err


def test_a_bench_in_use_is_told_and_the_search_goes_on_later(history: dict[str, str], pico: Pico) -> None:
    with BenchLock(bench_at(Path.cwd())).held("somebody's apply"):
        answer = pico("bisect", "run", "main", "good", "--expect", LIMIT, *YES)
        assert answer.code == 5 and "somebody's apply" in answer.err and "pico bisect continue" in answer.err
        assert pico("bisect", "step", "-y", "--expect", "p1.pose.x < 100").code == 133
    assert pico("bisect", "continue", *YES).code == 0


def test_what_is_missing_stops_the_search_instead_of_counting_as_bad(history: dict[str, str], pico: Pico) -> None:
    pico("sim", "remove", "p2")
    answer = pico("bisect", "run", "main", "good", "--expect", LIMIT, *YES)
    assert answer.code == 1 and "p2" in answer.err
    assert pico("bisect", "step", "-y", "--expect", LIMIT).code == 129


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("good", "main", "--expect", LIMIT), "good comes before main"),
        (("main", "main", "--expect", LIMIT), "the same commit"),
        (("main", "good", "--expect", "p1.pose.z < 3"), "p1.pose.z"),
        (("main", "good"), "main expects nothing"),
        (("main", "nowhere", "--expect", LIMIT), "no revision `nowhere`"),
    ],
)
def test_mistakes_are_found_before_anything_moves(
    history: dict[str, str], pico: Pico, words: tuple[str, ...], said: str
) -> None:  # fmt: skip
    answer = pico("bisect", "run", *words, *YES)
    assert answer.code == 1 and said in answer.err and not bisecting()


def test_a_good_branch_asks_for_its_fork_first(history: dict[str, str], pico: Pico) -> None:
    git("checkout", "-q", "-b", "side", history["a"])
    commit("on the side", "angle: 22.75", "angle: 40")
    git("checkout", "-q", "main")
    answer = pico("bisect", "run", "main", "side", "--expect", LIMIT, "--json", *YES)
    assert answer.code == 0 and events(answer, "over")[0]["first_bad"] == history["break"]
    assert [t["commit"] for t in events(answer, "tried") if t["end"] == "fork"] == [history["a"]]


def test_a_fork_that_cannot_be_built_is_skipped_as_git_does(shel: Path, pico: Pico) -> None:
    fork = commit("onto p2", "x: 290", "x: 515")
    commit("back", "x: 515", "x: 295")
    made = commit("break", "x: 295", "x: 310")
    git("checkout", "-q", "-b", "side", fork)
    commit("also back", "x: 515", "x: 285")
    git("checkout", "-q", "main")
    answer = pico("bisect", "run", "main", "side", "--expect", LIMIT, *YES)
    assert answer.code == 0 and f"{made[:7]} (main) is the first bad commit" in answer.out
    assert f"skipped {fork[:7]}: p1" in answer.out


def test_where_the_fork_is_bad_it_was_mended_on_the_good_branch(history: dict[str, str], pico: Pico) -> None:
    git("checkout", "-q", "-b", "mended", history["c"])
    commit("mended", "x: 314", "x: 292")
    git("checkout", "-q", "main")
    answer = pico("bisect", "run", "main", "mended", "--expect", LIMIT, *YES)
    assert answer.code == 1 and f"{history['c'][:7]}" in answer.out and "was mended on the way to mended" in answer.out
    pico("bisect", "reset")
    pico("bisect", "start", "main", "mended", *YES)
    answer = pico("bisect", "bad", *YES)
    assert answer.code == 1 and "was mended on the way to mended" in answer.out


def test_a_shallow_clone_says_how_to_get_the_rest(history: dict[str, str], pico: Pico) -> None:
    git("tag", "lately", "main~2")
    git("clone", "-q", "--depth", "2", f"file://{Path.cwd()}", "../shallow")
    git("-C", "../shallow", "fetch", "-q", "--depth", "1", "origin", "tag", "lately")
    answer = pico("-C", "../shallow", "bisect", "run", "main", "lately", "--expect", LIMIT, *YES)
    assert answer.code in (0, 1) and "--unshallow" in answer.err


@pytest.mark.parametrize("checkout", [pytest.param(False, marks=pytest.mark.slow), True])
def test_git_bisect_run_finds_it_with_pico_bisect_step(
    history: dict[str, str], pico: Pico, checkout: bool
) -> None:  # fmt: skip
    edit(Path("lab.yaml"), "storage/a1:", "storage/z9: {x: 60, y: 860}\n  storage/a1:")
    git("commit", "-q", "-a", "-m", "another slot")
    git("bisect", "start", *([] if checkout else ["--no-checkout"]), history["c"], history["angle"])
    said = git("bisect", "run", "sh", "-c", f'{STEP} --expect "{LIMIT}"')
    assert f"{history['break']} is the first bad commit" in said
    git("bisect", "reset")
    assert git("symbolic-ref", "--short", "HEAD") == "main"


def test_no_mistake_of_a_step_counts_as_a_bad_commit(history: dict[str, str], pico: Pico) -> None:
    for words in ((), ("--expect", "p1.pose.x <"), ("--expect", LIMIT, "--fidelity", "fysics"), ("--no-such",)):
        assert pico("bisect", "step", "-y", *words).code == 129, words
    git("bisect", "start", "--no-checkout", "main", "good")
    assert pico("bisect", "step", "-y", "--expect", LIMIT).code in (0, 1)
    done = subprocess.run(
        ["git", "bisect", "run", "sh", "-c", f"{STEP} --expect 'p1.pose.x <'"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode != 0 and "is the first bad commit" not in done.stdout


def test_without_a_bisection_there_is_nothing_to_go_on_with(shel: Path, pico: Pico) -> None:
    for words in ((), ("continue", *YES), ("good", *YES), ("log",), ("reset",)):
        answer = pico("bisect", *words)
        assert answer.code == 1 and "no bisection is under way" in answer.err
    git("bisect", "start")
    assert "git checks files out" in pico("bisect", "continue", *YES).err
    assert main(["bisect", "--help"]) == 0


@pytest.mark.slow
@pytest.mark.parametrize("branches", [(), ("--merges",)])
def test_the_planted_commit_among_128_is_found_on_a_bench_of_thirty_parts(branches: tuple[str, ...]) -> None:
    benchmark = Path(__file__).resolve().parents[2] / "benchmarks" / "bisecting.py"
    words = [sys.executable, str(benchmark), "--seeds", "1", *branches]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert done.returncode == 0 and "1 searches, 0 wrong" in done.stdout, done
