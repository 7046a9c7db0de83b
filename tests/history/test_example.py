"""The example repositories: the same history everywhere, one line a tunable, usable by plain git."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest

import pico
from pico.bench.bench import new_lab
from pico.diagnostics import PicoError
from pico.history.examples.example import example_names, init_empty, make_example
from pico.history.git.lanes import lanes
from pico.history.repository.repository import Repository
from pico.manifest.load import load_files, load_folder
from pico.model.setup import Setup
from pico.model.state import LabState, place_of
from pico.resources import labs_dir

Git = Callable[..., str]

TAGS = ("C1", "C2", "C3", "E1-1", "E1-2", "E1-3", "E2-1", "E2-2", "E2-3", "E3-1", "E3-2")


@pytest.fixture
def shel(tmp_path: Path) -> Repository:
    return make_example("shel", tmp_path / "repo")


@pytest.fixture
def setup() -> Setup:
    found = load_folder(labs_dir() / "shel").setup
    assert found is not None
    return found


def state(repository: Repository, revision: str, setup: Setup) -> LabState:
    return load_files(repository.files(revision), setup=setup).require()[1]


def test_shel_has_the_eleven_states_of_the_paper(shel: Repository) -> None:
    log = list(shel.log(shel.tips()))
    assert len(log) == 11 and sorted(tag for c in log for tag in c.refs if tag in TAGS) == sorted(TAGS)
    assert shel.head().branch == "main" and shel.head().label == "C3"
    follows = {c.label: [shel.resolve(p).label for p in c.parents] for c in log}
    assert follows == {
        "C1": [], "C2": ["C1"], "C3": ["C2"],
        "E1-1": ["C3"], "E1-2": ["E1-1"], "E1-3": ["E1-2"],
        "E2-1": ["C3"], "E2-2": ["E2-1"], "E2-3": ["E2-2"],
        "E3-1": ["E2-1"], "E3-2": ["E3-1"],
    }  # fmt: skip
    assert {b: shel.resolve(b).label for b in ("e1", "e2", "e3")} == {"e1": "E1-3", "e2": "E2-3", "e3": "E3-2"}


def test_the_log_of_shel_reads_branch_by_branch(shel: Repository) -> None:
    rows = lanes(shel.log(shel.tips()))
    assert [f"{r.rail}  {r.commit.label if r.commit else ''}".rstrip() for r in rows] == [
        "*    E3-2", "*    E3-1", "| *  E2-3", "| *  E2-2", "|/", "*    E2-1",
        "| *  E1-3", "| *  E1-2", "| *  E1-1", "|/", "*    C3", "*    C2", "*    C1",
    ]  # fmt: skip


def test_p2_stands_in_the_focus_of_both_lenses(shel: Repository, setup: Setup) -> None:
    for revision, pair in (
        ("E1-3", ("lx_125", "ly_150")),
        ("E2-3", ("lx_100", "ly_150")),
        ("E3-2", ("lx_100", "ly_200")),
    ):
        lab = state(shel, revision, setup)
        _, p2 = place_of(setup, lab, "p2")
        for lens, side in zip(pair, (-1, 1), strict=True):
            _, stands = place_of(setup, lab, lens)
            focal_length = setup.type_of(lens).parameters["focal_length"].value
            assert isinstance(focal_length, int | float)
            assert (stands.x - p2.x, stands.y - p2.y) == (side * focal_length, 0)
        assert p2.yaw == 30 and lab.components["p1"].values["angle"] == 1
        assert lab.components["p2"].values["angle"] == 90


def test_the_half_wave_plate_lets_p1_pass_light_at_both_of_its_angles(shel: Repository, setup: Setup) -> None:
    for revision in TAGS:
        plate = state(shel, revision, setup).components["hwp"]
        angle = plate.values["angle"]
        assert isinstance(angle, float) and plate.pose is not None and plate.pose.x == 222
        laser = setup.type_of("laser").parameters["polarization"].value
        assert isinstance(laser, int | float)
        polarization = 2 * angle - laser
        assert 30 < abs(polarization - 1) < 60 and 30 < abs(polarization - 90) < 60


def test_at_first_all_that_the_arm_moves_is_in_storage(shel: Repository, setup: Setup) -> None:
    first = state(shel, "C1", setup)
    stored = {n for n in setup.lab.inventory if place_of(setup, first, n)[0]}
    assert stored == {"p1", "p2", "lx_100", "lx_125", "ly_150", "ly_200"}
    assert all(place_of(setup, first, n)[0] == setup.lab.inventory[n].home for n in stored)


def test_a_changed_tunable_is_a_line_of_git_diff(shel: Repository, git: Git) -> None:
    assert git("diff", "--numstat", "E1-2", "E1-3").split() == ["2", "2", "state/table.yaml"]
    assert git("diff", "-U0", "E1-2", "E1-3").count("\n@@") == 2
    for branch in ("e2", "e3"):
        assert (
            git("diff", "--shortstat", f"{branch}~1", branch).strip().startswith("1 file changed, 2 insertions(+), 2 d")
        )
    assert git("diff", "--shortstat", "C3", "E1-1").strip() == "1 file changed, 4 insertions(+), 1 deletion(-)"


@pytest.mark.parametrize("name", example_names())
def test_an_example_is_the_same_everywhere_and_clean(
    name: str, tmp_path: Path, git: Git, monkeypatch: pytest.MonkeyPatch
) -> None:
    one = make_example(name, tmp_path / "repo")
    for who in ("AUTHOR", "COMMITTER"):
        monkeypatch.delenv(f"GIT_{who}_NAME")
        monkeypatch.delenv(f"GIT_{who}_EMAIL")
    monkeypatch.setenv("HOME", str(tmp_path / "nobody"))
    other = make_example(name, tmp_path / "other")
    assert [c.id for c in one.log(one.tips())] == [c.id for c in other.log(other.tips())]
    assert git("status", "--porcelain") == "" and git("fsck", "--strict") == ""
    assert {c.author for c in one.log(one.tips())} == {"PICO example <example@localhost>"}


@pytest.mark.parametrize("name", example_names())
def test_the_files_in_the_tree_are_those_at_head_of_the_example(name: str, tmp_path: Path) -> None:
    made = make_example(name, tmp_path / "repo")
    for path in (labs_dir() / name).rglob("*"):
        if path.is_file() and path.name != "history.yaml":
            assert (made.root / path.relative_to(labs_dir() / name)).read_bytes() == path.read_bytes(), path
    assert (made.root / ".gitignore").read_text().endswith(".pico/\n")
    assert not (made.root / "history.yaml").exists()


@pytest.mark.parametrize("name", example_names())
def test_every_state_of_an_example_loads_without_a_word(name: str, tmp_path: Path) -> None:
    made = make_example(name, tmp_path / "repo")
    for commit in made.log(made.tips()):
        assert load_files(made.files(commit.id)).diagnostics == (), commit.label


def test_plain_git_clones_and_checks_out(shel: Repository, git: Git, tmp_path: Path, setup: Setup) -> None:
    git("clone", "-q", "repo", "copy", at=".")
    git("checkout", "-q", "e2", at="copy")
    there = load_folder(tmp_path / "copy").require()[1]
    assert there == state(shel, "E2-3", setup)
    clone = Repository.discover(tmp_path / "copy")
    assert clone is not None and clone.head().label == "E2-3"
    assert state(clone, "e3", setup) == state(shel, "E3-2", setup)


def test_branches_that_change_different_tunables_merge(shel: Repository, git: Git, setup: Setup) -> None:
    git("checkout", "-q", "-b", "brighter", "E1-2")
    table = shel.root / "state" / "table.yaml"
    table.write_text(table.read_text().replace("exposure: 10", "exposure: 40"))
    git("commit", "-qam", "longer exposure")
    git("merge", "-q", "e1", "-m", "both")
    merged = state(shel, "HEAD", setup)
    assert merged.components["cam"].values["exposure"] == 40 and merged.components["p1"].values["angle"] == 1


def test_an_unknown_example_suggests_and_a_full_folder_is_left_alone(tmp_path: Path) -> None:
    with pytest.raises(PicoError) as caught:
        make_example("shell", tmp_path / "d")
    assert "`shel`" in caught.value.diagnostics[0].hint and not (tmp_path / "d").exists()
    (tmp_path / "d").mkdir()
    (tmp_path / "d" / "thesis.tex").write_text("years")
    with pytest.raises(PicoError, match="not empty"):
        make_example("shel", tmp_path / "d")
    (tmp_path / "file").write_text("")
    with pytest.raises(PicoError, match="can't make the folder"):
        make_example("shel", tmp_path / "file")


def test_an_empty_lab_loads_and_can_be_committed(tmp_path: Path) -> None:
    repository = init_empty(tmp_path / "3rd Bench")
    manifests = load_folder(repository.root)
    assert manifests.diagnostics == () and manifests.setup is not None
    assert manifests.setup.lab.name == "rd_bench"
    assert repository.head().commit is None
    assert repository.changed() == ("lab.yaml", "state/table.yaml")
    assert repository.commit(repository.changed(), "first state").summary == "first state"


@pytest.mark.parametrize(("beyond", "reached"), [(-0.02, False), (0.0, True), (0.5, True), (1.0, True), (1.02, False)])
def test_the_reach_that_an_empty_lab_tells_is_that_of_its_arm(tmp_path: Path, beyond: float, reached: bool) -> None:
    repository = init_empty(tmp_path / "bench")
    told = re.search(r"reaches ([\d.]+) to ([\d.]+) m", (repository.root / "lab.yaml").read_text())
    assert told is not None
    near, far = (1000 * float(number) for number in told.groups())
    with pico.open(repository.root) as bench:
        away = near + (far - near) * beyond
        plan = bench.plans.single("lens", "move", {"x": "480", "y": f"{760 - away:g}", "yaw": "0"})
        assert plan.errored != reached


def test_an_empty_lab_joins_the_repository_it_lies_in_and_overwrites_nothing(repo: Path) -> None:
    assert init_empty(repo / "labs" / "mine").root == repo
    before = (repo / "lab.yaml").read_text()
    with pytest.raises(PicoError, match="exists already"):
        init_empty(repo)
    assert (repo / "lab.yaml").read_text() == before


def test_an_example_inside_another_repository_is_told_to_be_one_of_its_own(tmp_path: Path) -> None:
    assert not new_lab(tmp_path / "outer", "minimal")
    (warned,) = new_lab(tmp_path / "outer" / "labs" / "inner", "minimal")
    assert warned.severity == "warning" and str(tmp_path / "outer") in warned.summary
    (tmp_path / "outer" / ".gitignore").write_text("scratch/\n")
    assert not new_lab(tmp_path / "outer" / "scratch" / "inner", "minimal")
    assert not new_lab(tmp_path / "outer" / "own")
