"""Commits carry their runs, through everything that git does to them; and what proves a state is told truly."""

from __future__ import annotations

import shutil
import sqlite3
import zlib
from contextlib import closing
from pathlib import Path

import pytest
from attended import ended_when
from bench_at import bench_at
from carrying import (
    apply,
    carried,
    commit,
    files_of,
    git,
    own,
    standing,
    standing_here,
    turn,
    turned,
    write,
)
from commanding import Pico

from pico.bench.bench import Bench
from pico.diagnostics import Diagnostic, PicoError
from pico.edge.lease import BenchLock
from pico.history.examples.example import make_example
from pico.history.lab.folder import LabFolder
from pico.history.repository.repository import Repository
from pico.history.runs.committed import places_at, read_carried, runs_added
from pico.history.runs.loading import load_run
from pico.model.trace.run import Run
from pico.runs.journal import Journal
from pico.runs.operations import operations


@pytest.fixture(scope="module")
def stood(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The case study with its bench as C3 says, and nothing that is not committed."""
    folder = tmp_path_factory.mktemp("carried") / "shel"
    make_example("shel", folder)
    with Bench.open(folder) as bench:
        bench.apply()
    for name in ("journal.sqlite", "changes"):
        (folder / ".pico/benches/sim" / name).unlink()
    return folder


@pytest.fixture
def lab(stood: Path, tmp_path: Path) -> Path:
    shutil.copytree(stood, tmp_path / "lab")
    return tmp_path / "lab"


def added(folder: Path, revision: str = "HEAD", wrong: list[Diagnostic] | None = None) -> list[str]:
    repository = Repository.discover(folder)
    assert repository is not None
    return [d.id for d in runs_added(repository, repository.resolve(revision), folder, wrong)]


def document(folder: Path, run: str) -> Run:
    repository = Repository.discover(folder)
    assert repository is not None
    head = repository.resolve("HEAD").id
    return next(r for r in read_carried(repository, places_at(repository, head, folder).values()) if r.id == run)


def recorded(folder: Path, run: str) -> Run:
    return load_run(LabFolder(folder, place=bench_at(folder)), run)[0].document


# what a commit carries


def test_a_commit_carries_the_run_that_led_to_its_state(lab: Path) -> None:
    before = standing(lab).state
    run, made = turned(lab, "p1", 5)
    assert added(lab, made) == [run]
    assert len(files_of(lab, run)) == 3
    found = document(lab, run)
    assert (found.state_before, found.state_after) == (before, standing(lab).state)
    assert (found.goal, found.cause.kind, found.outcome) == ("set p1.angle", "single", "done")
    assert [(c.component, c.tunable, c.before, c.after) for c in found.changes] == [("p1", "angle", 90, 5)]
    assert own(lab) == []
    assert f"Pico-Run: {run}" in git(lab, "log", "-1", "--format=%B")
    assert git(lab, "status", "--porcelain") == ""


def test_all_runs_since_the_last_commit_go_along_each_with_the_state_that_it_led_to(lab: Path) -> None:
    first, second, third = turn(lab, "p1", 5), turn(lab, "p1", 7), apply(lab)
    made = commit(lab, "there and back").commit
    assert added(lab, made) == [f"{first}-fold", third]
    one, two, three = (recorded(lab, run) for run in (first, second, third))
    assert one.state_after == two.state_before
    assert three.state_after == standing(lab).state == one.state_before
    assert len({d.state_after for d in (one, two, three)}) == 3
    assert own(lab) == []


@pytest.mark.slow
def test_a_session_of_settings_is_one_run_in_a_commit(lab: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch) -> None:
    with Bench.open(lab) as bench:
        angles = [(("p1", "p2", "hwp")[n % 3], str(n % 40 + 1)) for n in range(55)]
        runs = [bench.apply(bench.plans.single(name, "set", {"angle": a})).run for name, a in angles]
        made = bench.commit(None, "capture").commit
    monkeypatch.chdir(lab)
    text = pico("log", "-n", "1").out.rstrip()
    assert len(git(lab, "show", "--format=", "--name-only", made).splitlines()) <= 6
    assert len(git(lab, "log", "-1", "--format=%B").splitlines()) <= 25
    assert len(text.splitlines()) <= 15
    assert own(lab) == []
    whole = load_run(LabFolder(lab, place=bench_at(lab)))[0]
    assert [op.run for op in operations(whole.trace)] == runs
    assert whole.document.tally["done"] == 55
    found, commit = load_run(LabFolder(lab, place=bench_at(lab)), runs[17][-6:])
    assert (found.document.id, commit and commit.id) == (runs[17], made)
    assert [c.text for c in found.document.changes] == ["15 → 18 deg"]
    assert [op.arguments["to"] for op in operations(found.trace)] == [18]
    assert found.after is not None and found.diagnostics == ()
    assert standing(lab).verdict == "verified"


@pytest.mark.parametrize("spoilt", ["nonsense", "2026/11/x:zz", f"2026/11/x:{'0' * 40}", ":"])
def test_what_was_remembered_of_runs_counts_only_where_git_has_it(lab: Path, spoilt: str) -> None:
    turned(lab, "p1", 5)
    turned(lab, "p1", 6)
    found = carried(lab)
    assert len(found) == 2 and carried(lab) == found
    with closing(sqlite3.connect(lab / ".git" / "pico" / "runs.sqlite")) as cache, cache:
        spoiled = zlib.compress(spoilt.encode())
        cache.execute("UPDATE read SET data = ? WHERE key LIKE 'added %'", (spoiled,))
        assert cache.total_changes == 1
    assert carried(lab) == found


def test_what_was_folded_is_blamed_and_undone_as_what_it_was(lab: Path) -> None:
    runs = [turn(lab, *one) for one in (("p1", 5), ("p2", 7), ("p1", 9))]
    commit(lab, "three")
    with Bench.open(lab) as bench:
        blamed = [leaf.last.how.run for leaf in bench.history.blame("p1.angle", "p2.angle").leaves]
        assert blamed == [runs[2], runs[1]]
        assert bench.recovery.undo_plan().target.of == runs[-1]
        assert [run.id for run, _ in bench.history.runs(components=["p2"])][:1] == [f"{runs[0]}-fold"]


def test_a_commit_is_verified_by_the_one_of_folded_runs_that_led_to_its_state(lab: Path) -> None:
    write(lab, "p2", 7)
    git(lab, "commit", "-qam", "by hand")
    runs = [turn(lab, *one) for one in (("p2", 8), ("p2", 7), ("p1", 9))]
    commit(lab, "elsewhere", "capture")
    assert (standing(lab, "HEAD~1").run, standing(lab).run) == (runs[1], f"{runs[0]}-fold")


def test_trials_stay_with_the_bench_and_are_in_no_commit(lab: Path) -> None:
    first = turn(lab, "p1", 5)
    with Bench.open(lab) as bench:
        trial = bench.apply(bench.plans.single("p1", "set", {"angle": "6"}).because("bisect")).run
    last = turn(lab, "p1", 7)
    assert added(lab, commit(lab, "found").commit) == [first, last]
    assert [run.id for run in own(lab)] == [trial]
    with pytest.raises(PicoError, match="nothing to commit"):
        commit(lab, "nothing else")


def test_a_goal_that_was_reached_counts_though_the_bench_went_on(lab: Path) -> None:
    write(lab, "p1", 5)
    git(lab, "commit", "-qam", "by hand")
    apply(lab)
    turned(lab, "p1", 7)
    assert standing(lab, "HEAD~1").verdict == "verified"


def test_a_commit_of_a_plan_carries_nothing_and_says_so(lab: Path) -> None:
    turn(lab, "p1", 5)
    write(lab, "p2", 3)
    made = commit(lab, "an idea", "planned").commit
    assert added(lab, made) == []
    assert standing(lab, made).verdict == "planned"
    assert len(own(lab)) == 1


def test_a_run_that_only_stood_in_a_commit_that_was_thrown_away_is_carried_again(lab: Path) -> None:
    run, _ = turned(lab, "p1", 5)
    git(lab, "reset", "-q", "--hard", "HEAD~1")
    assert [d.id for d in own(lab)] == [run]
    assert added(lab, commit(lab, "again").commit) == [run]


def test_what_a_refused_commit_left_behind_is_not_what_the_next_one_says(lab: Path) -> None:
    hook = lab / ".git" / "hooks" / "pre-commit"
    hook.parent.mkdir(exist_ok=True)
    hook.write_text("#!/bin/sh\nexit 1\n")
    hook.chmod(0o755)
    run = turn(lab, "p1", 5)
    with pytest.raises(PicoError):
        commit(lab, "refused")
    hook.unlink()
    turn(lab, "p1", 8)
    made = commit(lab, "allowed").commit
    assert added(lab, made) == [f"{run}-fold"]
    assert recorded(lab, run).state_after != standing(lab, made).state
    assert standing(lab, made).verdict == "verified"
    assert git(lab, "status", "--porcelain") == ""


def test_what_a_hand_did_after_the_run_is_told(lab: Path) -> None:
    run = turn(lab, "p1", 5)
    with Bench.open(lab) as bench:
        bench.sim.nudge("p2", dx=4)
    commit(lab, "pushed")
    found = document(lab, run)
    assert [(c.component, c.text) for c in found.afterwards] == [("p2", "moved 4 mm (dx +4)")]
    assert found.observed is not None
    assert found.observed.state != found.state_after == standing(lab).state


def test_a_run_that_was_interrupted_and_resumed_is_one(lab: Path) -> None:
    with Bench.open(lab) as bench:
        report = ended_when(bench, bench.plan("e1"), lambda event: event.kind == "operation_done")
        assert report.outcome == "interrupted"
        plan, name = bench.recovery.resume_plan()
        again = bench.run(plan, resumes=name)
        assert [e.kind for e in again][-1] == "run_finished"
    git(lab, "checkout", "-q", "e1")
    made = commit(lab, "e1, in two goes").commit
    assert added(lab, made) == [name]
    found = document(lab, name)
    assert (found.resumed, found.outcome, found.goal) == (1, "done", "e1")
    assert found.tally["done"] == report.done + again.report.done
    assert standing(lab, made).run == name


def test_what_is_resumed_after_a_commit_is_carried_by_the_next_one(lab: Path) -> None:
    with Bench.open(lab) as bench:
        ended_when(bench, bench.plan("e1"), lambda event: event.kind == "operation_done")
    commit(lab, "half way")
    with Bench.open(lab) as bench:
        plan, name = bench.recovery.resume_plan()
        for _ in bench.run(plan, resumes=name):
            pass
    made = commit(lab, "the other half").commit
    assert added(lab, made) == [f"{name}-r1"]
    half, rest = document(lab, name), document(lab, f"{name}-r1")
    assert (half.outcome, rest.outcome, rest.cause.kind, rest.cause.of) == ("interrupted", "done", "resume", name)
    assert rest.state_before == half.observed.state  # type: ignore[union-attr]
    assert rest.state_after == standing(lab).state


# what git does to it


def test_runs_go_along_with_push_clone_and_pull(lab: Path, tmp_path: Path) -> None:
    git(tmp_path, "init", "-q", "--bare", "-b", "main", "shared.git")
    git(lab, "remote", "add", "origin", str(tmp_path / "shared.git"))
    first, made = turned(lab, "p1", 5)
    git(lab, "push", "-q", "origin", "main")
    git(tmp_path, "clone", "-q", "shared.git", "clone")
    clone = tmp_path / "clone"
    assert carried(clone) == {first: made}
    assert standing_here(clone).run == first
    second, _ = turned(lab, "p1", 7)
    git(lab, "push", "-q", "origin", "main")
    git(clone, "pull", "-q")
    assert set(carried(clone)) == {first, second}
    assert standing_here(clone).run == second


def test_a_rebase_keeps_the_files_and_what_it_made_of_the_state_is_not_proven(lab: Path) -> None:
    git(lab, "checkout", "-qb", "side")
    run, _ = turned(lab, "p1", 5)
    git(lab, "checkout", "-q", "main")
    write(lab, "p2", 3)
    git(lab, "commit", "-qam", "p2 otherwise")
    git(lab, "checkout", "-q", "side")
    git(lab, "rebase", "-q", "main")
    assert added(lab) == [run]
    found = standing(lab)
    assert (found.verdict, found.run) == ("inherited", None)
    assert standing(lab, "main").verdict == "planned"
    proof = apply(lab)
    assert standing_here(lab).run == proof
    commit(lab, "it works together, too")
    assert (standing(lab, "HEAD~1").verdict, standing(lab, "HEAD~1").run) == ("verified", proof)


def test_a_rebase_that_leaves_the_state_as_it_was_stays_proven(lab: Path) -> None:
    git(lab, "checkout", "-qb", "side")
    run, before = turned(lab, "p1", 5)
    git(lab, "checkout", "-q", "main")
    (lab / "README.md").write_text("words\n")
    git(lab, "add", "README.md")
    git(lab, "commit", "-qm", "words")
    git(lab, "rebase", "-q", "main", "side")
    assert git(lab, "rev-parse", "side") != before
    assert (standing(lab, "side").verdict, standing(lab, "side").run) == ("verified", run)


def test_a_squash_keeps_the_files_and_the_proof_of_the_same_state(lab: Path) -> None:
    git(lab, "checkout", "-qb", "side")
    first, _ = turned(lab, "p1", 5)
    second, _ = turned(lab, "p1", 7)
    git(lab, "checkout", "-q", "main")
    git(lab, "merge", "-q", "--squash", "side")
    git(lab, "commit", "-qm", "all in one")
    git(lab, "branch", "-qD", "side")
    assert added(lab) == [first, second]
    assert (standing(lab).verdict, standing(lab).run) == ("verified", second)


def test_a_squash_with_something_else_is_inherited(lab: Path) -> None:
    git(lab, "checkout", "-qb", "side")
    turned(lab, "p1", 5)
    git(lab, "checkout", "-q", "main")
    git(lab, "merge", "-q", "--squash", "side")
    write(lab, "p2", 3)
    git(lab, "commit", "-qam", "and a little more")
    assert standing(lab).verdict == "inherited"


def test_a_cherry_pick_with_its_stale_words_is_not_believed(lab: Path) -> None:
    git(lab, "checkout", "-qb", "side")
    turned(lab, "p2", 3)
    run, _ = turned(lab, "p1", 5)
    git(lab, "checkout", "-q", "main")
    git(lab, "cherry-pick", "-x", "side")
    words = git(lab, "log", "-1", "--format=%B")
    assert f"Pico-Run: {run}" in words
    assert standing(lab).state not in words
    assert standing(lab).verdict == "inherited"
    git(lab, "rm", "-rq", "runs")
    git(lab, "commit", "-q", "--amend", "--no-edit")
    assert standing(lab).verdict == "inherited"


def test_a_merge_is_a_hypothesis_until_a_run_reaches_it(lab: Path) -> None:
    git(lab, "checkout", "-qb", "side")
    turned(lab, "p1", 5)
    git(lab, "checkout", "-q", "main")
    apply(lab)
    turned(lab, "p2", 3)
    git(lab, "merge", "-q", "side", "-m", "both")
    merge = git(lab, "rev-parse", "HEAD")
    assert added(lab) == []
    assert standing(lab).verdict == "inherited"
    proof = apply(lab)
    here = standing_here(lab)
    assert (here.verdict, here.run, here.carried) == ("verified", proof, None)
    assert standing(lab).verdict == "inherited"
    made = commit(lab, "both, and they agree").commit
    assert added(lab) == [proof]
    assert (standing(lab, merge).run, standing(lab, merge).carried) == (proof, made)


def test_a_revert_takes_the_files_away_and_not_the_run(lab: Path) -> None:
    run, made = turned(lab, "p1", 5)
    git(lab, "revert", "--no-edit", "HEAD")
    assert files_of(lab, run) == []
    assert carried(lab) == {run: made}
    assert added(lab) == []
    assert standing(lab, made).run == run
    apply(lab)
    assert run not in added(lab, commit(lab, "back").commit)


# what proves it


def test_an_edit_with_an_editor_is_planned_and_its_message_counts_for_nothing(lab: Path) -> None:
    turned(lab, "p1", 5)
    words = git(lab, "log", "-1", "--format=%B")
    write(lab, "p1", 6)
    git(lab, "commit", "-qam", "an edit")
    assert standing(lab).verdict == "planned"
    git(lab, "commit", "-q", "--amend", "-m", words)
    assert standing(lab).verdict == "inherited"


def test_what_a_hand_did_is_proven_by_having_been_seen(lab: Path) -> None:
    with Bench.open(lab) as bench:
        bench.sim.nudge("p2", dx=4)
    commit(lab, "pushed")
    found = standing(lab)
    assert (found.verdict, found.run, found.evidence) == ("verified", None, "kinematic")


def test_a_commit_that_leaves_the_state_alone_is_as_proven_as_before(lab: Path) -> None:
    run, _ = turned(lab, "p1", 5)
    (lab / "README.md").write_text("words\n")
    git(lab, "add", "README.md")
    git(lab, "commit", "-qm", "words")
    assert standing(lab).run == run


def test_a_simulation_never_counts_as_hardware_and_hardware_counts_more(lab: Path) -> None:
    from dataclasses import replace

    from pico.runs.files import run_files

    run, _ = turned(lab, "p1", 5)
    assert (standing(lab).evidence, standing(lab).simulated) == ("kinematic", True)
    real = replace(document(lab, run), id="20270101T000000Z-bbbbbb", evidence="hardware", files={})
    for path, data in run_files(real).items():
        (lab / path).parent.mkdir(parents=True, exist_ok=True)
        (lab / path).write_bytes(data)
    git(lab, "add", "runs")
    git(lab, "commit", "-qm", "on the real table")
    for revision in ("HEAD", "HEAD~1"):
        found = standing(lab, revision)
        assert (found.run, found.evidence, found.simulated) == (real.id, "hardware", False)


@pytest.mark.parametrize("name", ["run.json", "trace.jsonl"])
def test_a_run_whose_files_were_tampered_with_proves_nothing_and_is_named(lab: Path, name: str) -> None:
    run = turn(lab, "p1", 5)
    commit(lab, "turned")
    (path,) = [p for p in files_of(lab, run) if p.endswith(name)]
    (lab / path).write_bytes((lab / path).read_bytes()[:-20] + b"\n")
    git(lab, "commit", "-q", "--amend", "-m", "tampered", "--", path)
    found = standing_here(lab)
    assert found.verdict != "verified"
    assert any(path in d.summary for d in found.diagnostics)
    wrong: list[Diagnostic] = []
    assert added(lab, wrong=wrong) == ([] if name == "run.json" else [run])
    assert bool(wrong) == (name == "run.json")


def test_a_state_that_cannot_be_read_is_unknown(lab: Path) -> None:
    write(lab, "p1", 5)
    path = lab / "state" / "table.yaml"
    text = path.read_text()
    path.write_text(text.replace("angle: 5", "angle: [5"))
    git(lab, "commit", "-qam", "broken")
    path.write_text(text)
    assert standing(lab).verdict == "unknown"


def test_a_shallow_clone_has_the_runs_of_its_commits(lab: Path, tmp_path: Path) -> None:
    turned(lab, "p1", 5)
    run, _ = turned(lab, "p1", 7)
    git(tmp_path, "clone", "-q", "--depth", "1", f"file://{lab}", "shallow")
    assert run in carried(tmp_path / "shallow")
    assert standing(tmp_path / "shallow").run == run


def test_the_first_commit_of_a_lab_carries_its_runs_and_a_lab_may_lie_in_a_folder(lab: Path, tmp_path: Path) -> None:
    inside = tmp_path / "repo" / "labs" / "shel"
    shutil.copytree(lab, inside, ignore=shutil.ignore_patterns(".git"))
    git(tmp_path / "repo", "init", "-q", "-b", "main")
    run = turn(inside, "p1", 5)
    git(tmp_path / "repo", "add", "labs/shel/lab.yaml", "labs/shel/.gitignore")
    made = commit(inside, "the first").commit
    assert added(inside, made) == [run]
    assert files_of(tmp_path / "repo", run)[0].startswith("labs/shel/runs/")
    assert standing(inside).run == run


def begun(folder: Path, outcome: str | None) -> None:
    """Leave a run in the journal that began one operation and was killed, or ended."""
    with Bench.open(folder) as bench:
        plan = bench.plans.single("p1", "set", {"angle": "5"})
        seen = bench.observe().components["p1"]
    with closing(Journal(folder / ".pico/benches/sim" / "journal.sqlite")) as journal:
        journal.begin_run("r1", plan.digest, "test", document=plan.to_json())
        journal.intend("r1/op1/1", plan.operations[0], 1)
        journal.started("r1/op1/1", seen, 1)
        if outcome:
            journal.end_run("r1", outcome, {"done": 0, "unknown": 1})  # type: ignore[arg-type]


def test_a_run_that_was_killed_is_carried_as_what_it_was(lab: Path) -> None:
    begun(lab, None)
    made = commit(lab, "after the crash").commit
    assert added(lab, made) == ["r1"]
    found = document(lab, "r1")
    assert (found.outcome, found.tally["unknown"], found.tally["done"]) == ("killed", 1, 0)
    assert found.observed is not None
    assert not found.observed.looked
    assert (found.evidence, found.cause.kind, found.operator) == ("kinematic", "", "")
    assert standing(lab, made).why == "the run r1 (killed) left exactly this state"


def test_a_run_that_goes_on_is_not_carried_yet(lab: Path) -> None:
    begun(lab, None)
    with BenchLock(bench_at(lab)).held("somebody's apply"):
        assert own(lab) == []
    assert [d.id for d in own(lab)] == ["r1"]


def test_a_run_that_moved_nothing_is_not_carried(lab: Path) -> None:
    with Bench.open(lab) as bench:
        plan = bench.plans.single("p1", "set", {"angle": "5"})
    with closing(Journal(lab / ".pico/benches/sim" / "journal.sqlite")) as journal:
        journal.begin_run("r1", plan.digest, "test", document=plan.to_json())
        journal.intend("r1/op1/1", plan.operations[0], 1)
        journal.end_run("r1", "interrupted", {"done": 0, "skipped": 1})
    assert own(lab) == []


def test_what_is_too_big_for_a_commit_goes_to_the_content_store(lab: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("pico.runs.files.INLINE", 500)
    run, _ = turned(lab, "p1", 5)
    assert [Path(path).name for path in files_of(lab, run)] == ["run.json"]
    found, carrier = load_run(LabFolder(lab, place=bench_at(lab)), run)
    assert [artifact.name for artifact in found.document.artifacts] == ["trace.jsonl.gz", "measurements.jsonl.gz"]
    assert carrier and carrier.id == git(lab, "rev-parse", "HEAD").strip() and not found.missing
    assert [op.outcome for op in operations(found.trace)] == ["done"]
    assert (found.diagnostics, standing(lab).run) == ((), run)
    shutil.rmtree(lab / ".git" / "pico" / "cas")
    away, _ = load_run(LabFolder(lab, place=bench_at(lab)), run)
    assert (away.trace, away.missing) == ((), {artifact.sha256 for artifact in away.document.artifacts})
    assert "trace.jsonl.gz" in away.diagnostics[0].summary


def test_a_log_tells_for_each_commit_what_proves_it(lab: Path) -> None:
    git(lab, "checkout", "-qb", "side")
    turned(lab, "p2", 3)
    run, _ = turned(lab, "p1", 5)
    git(lab, "checkout", "-q", "main")
    git(lab, "cherry-pick", "side")
    for _ in range(2):  # the second time from what the first remembered
        with Bench.open(lab) as bench:
            copied, plain, *_ = list(bench.log("main"))
            proven = next(iter(bench.log("side")))
        assert copied.standing is not None
        assert (copied.standing.verdict, copied.evidence) == ("inherited", "")
        assert (plain.standing, plain.evidence) == (None, "")
        assert proven.standing is not None
        assert (proven.standing.run, proven.evidence) == (run, "kinematic")
