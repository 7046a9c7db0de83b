"""The Lab that a bench keeps as its own: whatever the working tree says, plans go by it until it adopts another one."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Iterator
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path

import pytest
from bench_at import bench_at
from serving import served

from pico.bench import updating
from pico.bench.bench import Bench
from pico.diagnostics import ExitCode, PicoError
from pico.edge import own_lab
from pico.edge.lease import attach
from pico.edge.protocol import OwnLab
from pico.history.examples.example import make_example

KEEP_OUT = "keep_out:\n  pillar: {area: {x: [500, 540], y: [400, 440]}, reason: a pillar}\n"


@pytest.fixture(params=["in this process", "behind a socket"])
def lab(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Path]:
    root = make_example("shel", tmp_path / "shel").root
    with served(root) if request.param == "behind a socket" else nullcontext():
        yield root


def edit(path: Path, old: str, new: str) -> None:
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))


def propose(root: Path) -> None:
    """Let the working tree want a bench without lx_125, and with another speed of its arm."""
    edit(root / "lab.yaml", "  lx_125:\n    type: plano_convex_125\n    marker: 5\n    home: storage/a3\n", "")
    edit(root / "state" / "table.yaml", "  lx_125:\n    slot: storage/a3\n", "")


def test_the_first_run_makes_the_lab_the_benchs_own_and_says_so(lab: Path) -> None:
    assert own_lab.read(bench_at(lab)) is None
    with Bench.open(lab) as bench:
        first, second = bench.apply("e1"), bench.apply("e2")
        digest = bench.setup.digest()
    assert [d.code for d in first.diagnostics] == ["bench-lab"] and not second.diagnostics
    kept = own_lab.read(bench_at(lab))
    assert kept is not None and kept.at and "pico apply" in kept.by
    assert kept.files["lab.yaml"] == (lab / "lab.yaml").read_text() and "state/table.yaml" not in kept.files
    assert own_lab.setup_of(kept).digest() == digest


def test_a_looking_command_adopts_nothing(lab: Path) -> None:
    with Bench.open(lab) as bench:
        bench.plan("e1")
        bench.status()
    assert own_lab.read(bench_at(lab)) is None


def test_what_the_tree_describes_is_a_proposal_until_it_is_adopted(lab: Path) -> None:
    with Bench.open(lab) as bench:
        bench.apply("e1")
        own = bench.setup.digest()
    propose(lab)
    with Bench.open(lab) as bench:
        assert bench.setup.digest() == own and "lx_125" in bench.setup.lab.inventory
        (told,) = (d for d in bench.plan().diagnostics if d.code == "bench-lab")
        assert "inventory.lx_125 removed" in told.summary and told.severity == "warning"
        proposal = updating.proposal(bench_at(lab))
        assert proposal.bench == own != proposal.tree and "-  lx_125:" in proposal.patch
        bench.lab.adopt()
        assert bench.setup.digest() == proposal.tree and "lx_125" not in bench.setup.lab.inventory
        assert not updating.proposal(bench_at(lab)).new
        assert not [d for d in bench.plan().diagnostics if d.code == "bench-lab"]
        assert bench.apply().outcome == "done"
    kept = own_lab.read(bench_at(lab))
    assert kept is not None and kept.files["lab.yaml"] == (lab / "lab.yaml").read_text()


def test_an_old_revision_is_planned_with_the_bench_of_today(lab: Path) -> None:
    with Bench.open(lab) as bench:
        bench.apply("e2")
    edit(lab / "lab.yaml", "seed: 1", "seed: 2")
    subprocess.run(["git", "commit", "-qam", "another seed"], cwd=lab, check=True)
    with Bench.open(lab) as bench:
        bench.lab.adopt()
        own = bench.setup.digest()
        plan = bench.plan("e1")
        assert plan.lab.digest == own
        assert any(d.code == "lab-differs" and "sim.seed 1 → 2" in d.summary for d in plan.diagnostics)
    subprocess.run(["git", "checkout", "-q", "e1"], cwd=lab, check=True)
    with Bench.open(lab) as bench:
        assert bench.setup.digest() == own and bench.plan().lab.digest == own
        assert bench.apply().outcome == "done"


def test_a_comment_proposes_nothing(lab: Path) -> None:
    with Bench.open(lab) as bench:
        bench.apply("e1")
    (lab / "lab.yaml").write_text("# a remark\n" + (lab / "lab.yaml").read_text())
    with Bench.open(lab) as bench:
        assert not bench.plan().diagnostics and bench.apply().outcome == "done"


def test_a_plan_of_before_is_stale_once_another_lab_is_adopted(lab: Path) -> None:
    with Bench.open(lab) as bench:
        bench.apply("e2")
        plan = bench.plan("e1")
        edit(lab / "lab.yaml", "seed: 1", "seed: 2")
        with Bench.open(lab) as other:
            other.lab.adopt()
        with pytest.raises(PicoError) as refused:
            bench.apply(plan)
        assert refused.value.exit_code == ExitCode.STALE
    with Bench.open(lab) as bench:
        assert bench.apply("e1").outcome == "done"


def test_a_state_with_a_part_that_is_only_proposed_names_the_way_out(lab: Path) -> None:
    with Bench.open(lab) as bench:
        bench.apply("e1")
    edit(
        lab / "lab.yaml",
        "  ly_200:\n",
        "  lx_new:\n    type: plano_convex_100\n    marker: 29\n    home: storage/b3\n  ly_200:\n",
    )
    edit(lab / "state" / "table.yaml", "  ly_200:\n", "  lx_new:\n    slot: storage/b3\n  ly_200:\n")
    with pytest.raises(PicoError) as refused:
        Bench.open(lab)
    found = next(d for d in refused.value.diagnostics if d.severity == "error")
    assert "lx_new" in found.summary and "pico bench update" in found.hint
    updating.update(bench_at(lab))
    with Bench.open(lab) as bench:
        assert "lx_new" in bench.setup.lab.inventory


def test_what_is_wrong_with_a_proposal_is_said_and_the_bench_stays(lab: Path) -> None:
    with Bench.open(lab) as bench:
        bench.apply("e1")
        edit(lab / "lab.yaml", "seed: 1", "seeed: 1")
        with pytest.raises(PicoError) as refused:
            bench.lab.adopt()
        assert "seeed" in refused.value.diagnostics[0].summary
    kept = own_lab.read(bench_at(lab))
    assert kept is not None and "seeed" not in kept.files["lab.yaml"]


def test_nobody_adopts_while_the_bench_is_in_use(lab: Path) -> None:
    with Bench.open(lab) as bench, Bench.open(lab) as other:
        edge = bench.edge
        lease = bench.wait(edge.acquire("somebody"))
        edit(lab / "lab.yaml", "seed: 1", "seed: 2")
        with pytest.raises(PicoError) as refused:
            other.lab.adopt()
        assert refused.value.exit_code == ExitCode.LOCKED
        bench.wait(edge.release(lease))
        other.lab.adopt()


@pytest.mark.parametrize(
    "text", ["", "[]", "[" * 100_000, '{"schema": "pico.bench-lab/v9"}', '{"schema": "pico.bench-lab/v1", "files": 3}']
)
def test_a_kept_lab_that_cannot_be_read_is_told_with_its_file(tmp_path: Path, text: str) -> None:
    (tmp_path / ".pico/benches/sim").mkdir(parents=True)
    (tmp_path / ".pico/benches/sim" / "lab.json").write_text(text)
    with pytest.raises(PicoError) as refused:
        own_lab.read(bench_at(tmp_path))
    assert "lab.json" in refused.value.diagnostics[0].summary and refused.value.diagnostics[0].hint


def test_a_kept_lab_that_makes_no_sense_any_more_says_how_to_get_on(tmp_path: Path) -> None:
    root = make_example("minimal", tmp_path / "minimal").root
    with Bench.open(root) as bench:
        bench.lab.adopt()
    kept = own_lab.read(bench_at(root))
    assert kept is not None
    own_lab.write(bench_at(root), replace(kept, files={"lab.yaml": kept.files["lab.yaml"].replace("table:", "tabel:")}))
    with pytest.raises(PicoError) as refused:
        Bench.open(root)
    assert "`pico bench update`" in refused.value.diagnostics[0].hint
    assert any(str(d.source).startswith("the bench's own lab.yaml:") for d in refused.value.diagnostics)


@pytest.mark.parametrize("what", ["another", "gone"])
def test_a_commit_can_neither_replace_nor_take_away_what_the_bench_keeps(tmp_path: Path, what: str) -> None:
    root = make_example("shel", tmp_path / "shel").root
    with Bench.open(root) as bench:
        bench.apply("e1")
    path = root / ".pico/benches/sim" / "lab.json"
    mine = path.read_bytes()
    if what == "gone":
        path.unlink()
    else:
        path.write_bytes(mine.replace(b"seed: 1", b"seed: 2"))
        assert path.read_bytes() != mine
    for _ in range(2):
        with pytest.raises(PicoError) as refused:
            Bench.open(root)
        assert "`pico bench update`" in refused.value.diagnostics[0].hint
    found = updating.proposal(bench_at(root))
    assert found.new and not found.bench and "+kind: Lab" in found.patch
    updating.update(bench_at(root))
    with Bench.open(root) as bench:
        assert bench.apply("e2").outcome == "done"
    kept = own_lab.read(bench_at(root))
    assert kept is not None and kept.files["lab.yaml"] == (root / "lab.yaml").read_text()


def test_what_git_does_not_hold_is_told_by_nothing(tmp_path: Path) -> None:
    (tmp_path / ".pico/benches/sim").mkdir(parents=True)
    own_lab.write(bench_at(tmp_path), OwnLab(files={"lab.yaml": "a: 1\n"}, by="me", at="now"))
    assert own_lab.read(bench_at(tmp_path)) is not None


def test_who_throws_the_whole_bench_away_is_told_before_anything_moves_and_may_begin_anew(tmp_path: Path) -> None:
    root = make_example("shel", tmp_path / "shel").root
    with Bench.open(root) as bench:
        bench.apply("e1")
    shutil.rmtree(root / ".pico")
    edit(root / "lab.yaml", "seed: 1", "seed: 2")
    with Bench.open(root) as bench, pytest.raises(PicoError, match="what PICO kept of the bench `sim` is gone"):
        bench.apply("e2")
    attach(bench_at(root))
    with Bench.open(root) as bench:
        assert bench.setup.lab.sim.seed == 2 and bench.apply("e2").outcome == "done"
