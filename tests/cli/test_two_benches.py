"""The benches of one lab: each has its own runs, and a command reaches the one that is asked for and no other."""

from __future__ import annotations

import json
import shutil
import subprocess
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from bench_at import bench_at
from commanding import Pico, a_run_goes_on

import pico as library
from pico.backends import emulated
from pico.backends.device import Capabilities
from pico.backends.sim.device import SimDevice
from pico.diagnostics import ExitCode, PicoError
from pico.model.observation import Observation
from pico.model.setup import Setup
from pico.places.bench import BenchPlace

EMULATED = ("--bench", "emulated")


class Quick(SimDevice):
    """The simulator in the place of the emulated bench, whose emulators take long."""

    async def describe(self) -> Capabilities:
        return replace(await super().describe(), name=self.place.name, evidence=self.place.name)

    async def observe(self) -> Observation:
        return replace(await super().observe(), backend=self.place.name)


@pytest.fixture
def lab(shel: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The example, whose emulated bench is quick."""

    def opened(setup: Setup, place: BenchPlace, fidelity: str, clock: Callable[[], str]) -> Quick:
        return Quick(setup, place, fidelity, clock=clock)

    monkeypatch.setattr(emulated, "opened", opened)
    monkeypatch.delenv("PICO_BENCH", raising=False)
    return shel


def done(pico: Pico, *words: str) -> Any:
    answer = pico("--json", *words)
    assert answer.code == 0, answer.out + answer.err
    return json.loads(answer.out.splitlines()[-1])


def world(lab: Path, name: str) -> bytes:
    path = bench_at(lab, name).folder / "world.json"
    return path.read_bytes() if path.exists() else b""


def runs(pico: Pico, *flags: str) -> list[str]:
    return [run["document"]["id"] for run in done(pico, *flags, "runs", "list")["runs"] if "commit" not in run]


@pytest.mark.parametrize(("flags", "name"), [((), "sim"), (EMULATED, "emulated")])
def test_every_answer_names_its_bench_once(lab: Path, pico: Pico, flags: tuple[str, ...], name: str) -> None:
    plan = pico(*flags, "plan", "e1")
    assert plan.out.startswith(f"shel · {name}") and f"shel · {name}" not in plan.err
    assert "shel ·" not in pico(*flags, "plan", "e1", "--explain", "p2").err
    assert pico(*flags, "apply", "e1", "-y").out.count(f"shel · {name}") == 1
    for words in (
        "measure p1.angle",
        "get p1.angle",
        "beam",
        "capture",
        "drift",
        "runs list",
        "verify",
        "optimize",
        "status",
    ):
        answer = pico(*flags, *words.split())
        assert answer.err.splitlines()[0] == f"shel · {name}", words
        assert f"shel · {name}" not in answer.out
    assert "shel ·" not in pico(*flags, "get", "p1.angle", "--json").err


def test_a_group_of_benches_is_listed_by_its_name_alone(lab: Path, pico: Pico) -> None:
    assert pico("bench").out == pico("bench", "list").out and "*  sim" in pico("bench").out


def test_no_run_of_one_bench_is_undone_or_taken_up_on_another(lab: Path, pico: Pico) -> None:
    done(pico, *EMULATED, "apply", "e1", "-y")
    done(pico, "set", "cam", "exposure=8", "-y")
    before = world(lab, "emulated")
    (own,), (other,) = runs(pico), runs(pico, *EMULATED)
    assert own != other
    done(pico, "undo", "-y")
    assert world(lab, "emulated") == before, "what was tried in the simulator moved no other bench"
    assert pico("resume", "-y").code != 0 and world(lab, "emulated") == before
    simulated = world(lab, "sim")
    done(pico, *EMULATED, "undo", "-y")
    assert world(lab, "sim") == simulated and world(lab, "emulated") != before


@pytest.mark.parametrize("words", [("undo", "-y"), ("resume", "-y")])
def test_a_bench_without_runs_says_where_the_last_one_was(lab: Path, pico: Pico, words: tuple[str, ...]) -> None:
    done(pico, "set", "cam", "exposure=8", "-y")
    simulated = world(lab, "sim")
    refused = pico(*EMULATED, *words)
    assert refused.code == ExitCode.ERROR and "`emulated` knows no run" in refused.err
    assert "--bench sim" in refused.err and not world(lab, "emulated") and world(lab, "sim") == simulated


def test_an_undo_says_that_the_last_run_was_on_another_bench(lab: Path, pico: Pico) -> None:
    done(pico, "set", "cam", "exposure=8", "-y")
    done(pico, *EMULATED, "set", "cam", "exposure=9", "-y")
    told = pico("undo", "-y")
    assert "the last run of this lab was on the bench `emulated`" in told.out + told.err
    assert "add `--bench emulated` if that one is meant" in told.out + told.err


def test_an_id_of_another_bench_is_refused_with_both_names_and_the_way_there(lab: Path, pico: Pico) -> None:
    done(pico, *EMULATED, "apply", "e1", "-y")
    (run,) = runs(pico, *EMULATED)
    for words in (("runs", "show", run), ("runs", "show", run[-6:]), ("runs", "replay", run, "-y")):
        refused = pico(*words)
        said = " ".join(refused.err.split())
        assert refused.code == 1 and f"run {run} was on the bench `emulated`, and this command means `sim`" in said
        assert "`pico --bench emulated runs show" in said
    refused = pico("recover", "--done", f"{run}/op1/1")
    assert refused.code == 1 and "was on the bench `emulated`" in refused.err
    assert f"`pico --bench emulated recover --done {run}/op1/1`" in " ".join(refused.err.split())
    assert pico(*EMULATED, "runs", "show", run).code == 0
    assert "there is no run `1999`" in pico("runs", "show", "1999").err


@pytest.mark.parametrize("verb", ["undo", "redo", "resume"])
@pytest.mark.parametrize("used", [False, True])
def test_a_run_of_another_bench_is_refused_in_any_worktree(lab: Path, pico: Pico, verb: str, used: bool) -> None:
    """Also if the bench that is meant has no run yet, and if another worktree has the one whose run it is."""
    other = lab.parent / "other"
    subprocess.run(["git", "worktree", "add", "-q", str(other), "-b", "second", "e1"], cwd=lab, check=True)
    done(pico, *EMULATED, "set", "cam", "exposure=9", "-y")
    (run,) = runs(pico, *EMULATED)
    if used:
        done(pico, "set", "cam", "exposure=8", "-y")
    for at in (lab, other):
        refused = pico("-C", str(at), verb, run, "-y")
        said = " ".join(refused.err.split())
        assert refused.code == 1 and f"run {run} was on the bench `emulated`, and this command means `sim`" in said
        assert f"`pico -C {at} --bench emulated {verb} {run}`" in said


def test_a_stop_names_the_bench_that_is_in_use(lab: Path, pico: Pico) -> None:
    done(pico, *EMULATED, "set", "cam", "exposure=9", "-y")
    with a_run_goes_on(lab, "pico apply e1", "emulated"):
        told = pico("stop", "--now")
        assert told.code == 0 and "Nothing moves on sim" in told.out
        assert "emulated is in use by" in told.out and "`pico --bench emulated stop --now`" in told.out
        assert done(pico, "stop")["others"].keys() == {"emulated"}
        assert "a run goes on" not in pico("status").err
        assert "a run goes on" in pico(*EMULATED, "status").err


def test_a_commit_takes_the_runs_of_its_bench_and_names_the_others(lab: Path, pico: Pico) -> None:
    done(pico, "apply", "-y")
    done(pico, "set", "cam", "exposure=8", "-y")
    for exposure in ("9", "7"):
        done(pico, *EMULATED, "set", "cam", f"exposure={exposure}", "-y")
    waiting = runs(pico, *EMULATED)
    told = pico("commit", "-m", "as simulated")
    assert "2 runs on emulated stay uncommitted" in told.err and "`pico --bench emulated commit`" in told.err
    assert runs(pico, *EMULATED) == waiting and not runs(pico)
    entry = done(pico, "log", "-n", "1")["commits"][0]
    assert (entry["bench"], entry["evidence"]) == ("sim", "kinematic")
    assert {run["bench"] for run in entry["runs"]} == {"sim"} and "Pico-Bench: sim" in entry["message"]
    assert "kinematic, sim" in pico("verify", "HEAD").out + pico("log", "-n", "1").out
    documents = [json.loads(path.read_text()) for path in lab.glob("runs/**/run.json")]
    assert {one["bench"] for one in documents if one["environment"]["backend"] == "sim"} == {"sim"}
    done(pico, *EMULATED, "commit", "--capture", "-m", "as emulated")
    entry = done(pico, "log", "-n", "1")["commits"][0]
    assert (entry["bench"], entry["evidence"]) == ("emulated", "emulated")
    assert {run["bench"] for run in entry["runs"]} == {"emulated"} and not runs(pico, *EMULATED)
    listed = done(pico, "runs", "list")["runs"]
    benches = [one["document"]["bench"] for one in listed]
    assert {*benches} == {"sim", "emulated"}, "those of other benches are marked"
    rows = [line.split() for line in pico("runs", "list").out.splitlines() if line.startswith("20")]
    assert [next(w for w in row if w in ("sim", "emulated")) for row in rows] == benches


def test_a_plan_is_for_one_bench(lab: Path, pico: Pico) -> None:
    done(pico, "plan", "e1", "--out", "e1.plan")
    refused = pico(*EMULATED, "apply", "./e1.plan", "-y")
    assert refused.code == ExitCode.STALE and not world(lab, "emulated")
    assert "made for the bench `sim`, and this command means `emulated`" in " ".join(refused.err.split())


def test_a_worktree_chooses_its_bench_and_a_command_may_name_another(
    lab: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    def means(*flags: str) -> str:
        return str(done(pico, *flags, "plan")["backend"])

    assert means() == "sim"
    assert done(pico, "bench", "use", "emulated")["bench"] == "emulated"
    assert (means(), means("--bench", "sim"), means("--bench", "local"), means("--backend", "sim")) == (
        "emulated", "sim", "sim", "sim",
    )  # fmt: skip
    assert "shel · emulated" in pico("status").err and "shel · emulated" in pico("plan", "e1").out
    assert (
        "?? "
        not in subprocess.run(
            ["git", "status", "--porcelain"], cwd=lab, capture_output=True, text=True, check=True
        ).stdout
    )
    monkeypatch.setenv("PICO_BENCH", "sim")
    assert (means(), means("--bench", "emulated")) == ("sim", "emulated")
    monkeypatch.delenv("PICO_BENCH")
    assert "two benches" in pico("--bench", "sim", "--emulate", "plan").err
    assert "names no bench" in pico("--bench", "emulate", "plan").err
    done(pico, "bench", "use", "local")
    assert means() == "sim"


def test_nothing_but_an_option_or_a_choice_selects_the_real_bench(
    lab: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PICO_BENCH", "hardware")
    for words in (("plan",), ("apply", "e1", "-y"), ("stop",)):
        refused = pico(*words)
        assert refused.code == 1 and "which no environment variable may" in refused.err
    monkeypatch.delenv("PICO_BENCH")
    told = pico("bench", "use", "hardware")
    assert told.code == 0 and "this lab has no devices file" in told.err
    refused = pico("plan")
    assert refused.code == 1 and "the devices of this bench cannot be used yet" in refused.err
    with pytest.raises(PicoError, match="a script must name that itself"):
        library.open(lab)
    with library.open(lab, bench="sim") as bench:
        assert bench.observe().backend == "sim"
    assert pico("check", "HEAD").code == 0


def test_the_list_says_what_each_bench_has(lab: Path, pico: Pico) -> None:
    done(pico, *EMULATED, "set", "cam", "exposure=9", "-y")
    listed = {one["bench"]: one for one in done(pico, "bench", "list")["local"]}
    assert list(listed) == ["sim", "emulated", "hardware"]
    (run,) = runs(pico, *EMULATED)
    assert (listed["emulated"]["pending"], listed["emulated"]["last"]) == (1, run)
    assert listed["emulated"]["attached"] == str(lab) and not listed["hardware"]["last"]
    text = pico("bench", "list").out
    assert "1 run not committed" in text and "*  sim" in text


def test_two_worktrees_have_a_bench_each(lab: Path, pico: Pico) -> None:
    other = lab.parent / "other"
    subprocess.run(["git", "worktree", "add", "-q", str(other), "-b", "second", "e1"], cwd=lab, check=True)
    done(pico, "set", "cam", "exposure=8", "-y")
    done(pico, "-C", str(other), *EMULATED, "set", "cam", "exposure=9", "-y")
    assert pico("-C", str(other), "set", "cam", "exposure=7", "-y").code == ExitCode.LOCKED
    assert pico(*EMULATED, "set", "cam", "exposure=7", "-y").code == ExitCode.LOCKED
    assert not (lab / ".pico/benches/emulated/world.json").exists()
    assert done(pico, *EMULATED, "git", "attach")["before"] == str(other)
    done(pico, *EMULATED, "undo", "-y")
    assert pico("-C", str(other), "set", "cam", "exposure=7", "-y").code == ExitCode.LOCKED


def test_git_leaves_what_pico_keeps_alone(lab: Path, pico: Pico) -> None:
    (lab / ".gitignore").unlink()
    subprocess.run(["git", "commit", "-qam", "without"], cwd=lab, check=True)
    done(pico, "set", "cam", "exposure=8", "-y")
    (own,) = runs(pico)
    (lab / "scratch.txt").write_text("mine")
    for words in (("stash", "-u", "-q"), ("clean", "-fdq"), ("add", "-A")):
        subprocess.run(["git", *words], cwd=lab, check=True)
    staged = subprocess.run(
        ["git", "diff", "--cached", "--name-only"], cwd=lab, capture_output=True, text=True, check=True
    )
    assert runs(pico) == [own] and ".pico" not in staged.stdout


def test_a_bench_that_vanished_is_told_before_anything_moves(lab: Path, pico: Pico) -> None:
    done(pico, "apply", "e1", "-y")
    subprocess.run(["git", "clean", "-fdxq"], cwd=lab, check=True)
    assert not (lab / ".pico/benches").exists()
    looked = pico("status")
    assert looked.code == 0 and "what PICO kept of the bench `sim` is gone" in " ".join(looked.err.split())
    refused = pico("apply", "e2", "-y")
    assert refused.code == ExitCode.LOCKED and "`pico --bench sim git attach`" in " ".join(refused.err.split())
    assert pico("doctor").code == 1 and "is gone" in pico("doctor").out + pico("doctor").err
    assert pico(*EMULATED, "set", "cam", "exposure=9", "-y").code == 0, "another bench is not concerned"
    done(pico, "--bench", "sim", "git", "attach")
    assert pico("apply", "e2", "-y").code == 0 and "is gone" not in pico("status").err


def test_a_lab_that_was_moved_without_its_bench_is_told_where_that_is(lab: Path, pico: Pico) -> None:
    done(pico, "apply", "e1", "-y")
    inner = lab / "labs" / "shel"
    inner.mkdir(parents=True)
    for path in list(lab.iterdir()):
        if path.name not in (".git", ".pico", "labs"):
            shutil.move(path, inner)
    refused = pico("-C", str(inner), "apply", "-y")
    assert refused.code == ExitCode.LOCKED and "stayed in" in refused.err
    move = f"mv {lab}/.pico/benches {inner}/.pico/"
    assert move in refused.err.replace("\n", " ").replace("      ", "")  # however wide the terminal is
    shutil.move(lab / ".pico/benches", inner / ".pico")
    assert pico("-C", str(inner), "plan").code == 0
    assert len(runs(pico, "-C", str(inner))) == 1


def test_after_git_clean_a_choice_that_is_gone_is_named(lab: Path, pico: Pico) -> None:
    done(pico, "bench", "use", "emulated")
    done(pico, "set", "cam", "exposure=9", "-y")
    subprocess.run(["git", "clean", "-fdxq"], cwd=lab, check=True)
    said = " ".join(pico("status").err.split())
    assert "the bench `emulated` is gone, too" in said and "this one means `sim`" in said, said
    assert "`pico bench use emulated` chooses it again" in said
    assert "is gone" not in pico("--bench", "sim", "status").err


def test_a_choice_that_is_a_folder_hints_at_what_works(lab: Path, pico: Pico) -> None:
    path = lab / ".pico/chosen.json"
    path.mkdir(parents=True)
    refused = " ".join(pico("status").err.split())
    assert f"`mv {path} {path}.damaged`" in refused and "`pico bench use sim`" in refused
    path.rename(f"{path}.old")
    done(pico, "bench", "use", "sim")
    assert pico("status").code == 0


def test_a_word_that_names_no_bench_lists_those_of_the_docs(lab: Path, pico: Pico) -> None:
    assert "known: `emulated`, `hardware`, `sim`" in pico("bench", "use", "").err
