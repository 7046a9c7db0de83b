"""Which commit changed each leaf last: against a slow reference, and in the corners of Git."""

from __future__ import annotations

import dataclasses
import os
import sqlite3
import subprocess
import sys
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import pytest
from blame_cases import PARTS, Version, histories, truth
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from examples import examples
from pico.diagnostics import PicoError
from pico.history.blame.answer import answer, dumps, loads
from pico.history.blame.blamed import Blamed, blame
from pico.history.blame.flat import flatten, parsed
from pico.history.blame.follow import Blame, WalkStep, walk
from pico.history.blame.leaves import shown
from pico.history.blame.lines import read_lines
from pico.history.blame.walk import CACHE, Walker, packaged_units
from pico.history.examples.example import example_names, make_example
from pico.history.git import cache as blame_cache
from pico.history.lab.folder import LabFolder
from pico.history.repository.repository import Repository
from pico.model.diff import Change, place_json
from pico.model.plan import LabRef
from pico.model.setup import Setup
from pico.model.state import LabState, place_of
from pico.model.trace.run import Cause, Run
from pico.runs.files import run_files

Git = Any
HEAD = "apiVersion: pico/v1\nkind: LabState\nmetadata: {lab: t}\ncomponents:\n"
LAB = (
    "apiVersion: pico/v1\nkind: Lab\nmetadata: {name: t}\ninventory:\n"
    + "".join(f"  {n}: {{type: linear_polarizer, home: h/{n}}}\n" for n in PARTS)
)  # fmt: skip


def names(count: int) -> list[str]:
    return [f"commit {i}" for i in range(count)]


def walked(versions: Sequence[Version], first: int, last: int, known: Mapping[str, Blame] | None = None) -> Blame:
    """Walk the ancestors of version `last` that are no ancestors of `first - 1`, in memory."""
    ids = names(len(versions))
    wanted = ancestors(versions, last) - (ancestors(versions, first - 1) if first else set())
    steps = [WalkStep(ids[i], tuple(ids[p] for p in versions[i].parents)) for i in sorted(wanted)]

    def delta(commit: str, base: str | None) -> dict[str, Any]:
        new = versions[ids.index(commit)].files()
        old = versions[ids.index(base)].files() if base else {}
        changed = {path: flatten(data) for path, data in new.items() if old.get(path) != data}
        return changed | dict.fromkeys(old.keys() - new.keys())

    return walk(steps, delta, packaged_units, known)


def ancestors(versions: Sequence[Version], number: int) -> set[int]:
    return {number}.union(*(ancestors(versions, p) for p in versions[number].parents))


def told(blame_: Blame) -> dict[tuple[str, str], tuple[Any, str]]:
    rows = answer(blame_, packaged_units).rows
    return {at: (plain(row.value), row.node.commit) for at, row in rows.items() if row.value is not None}


def plain(leaf: str | None) -> Any:
    value = shown(leaf)
    return tuple(value.values()) if isinstance(value, dict) else value


@settings(max_examples=examples(120), deadline=None)
@given(histories())
def test_every_leaf_of_random_histories_is_blamed_as_by_the_reference(versions: list[Version]) -> None:
    ids = names(len(versions))
    last = len(versions) - 1
    expected = {at: (value, ids[number]) for at, (value, number) in truth(versions, last).items()}
    assert told(walked(versions, 0, last)) == expected


@settings(max_examples=examples(60), deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(versions=histories(9), asked=st.lists(st.integers(0, 8), max_size=3), at=st.integers(0, 1))
def test_a_repository_with_what_is_kept_between_calls(
    versions: list[Version], asked: list[int], at: int, tmp_path_factory: pytest.TempPathFactory
) -> None:
    folder = tmp_path_factory.mktemp("random")
    repository = Repository.init(folder)
    inside = ("", "labs/t")[at]
    ids = commit_all(repository, versions, inside)
    for number in [*(n for n in asked if n < len(versions)), len(versions) - 1]:
        walker = Walker(repository, inside)
        found = walker.answer(ids[number])
        walker.cache.close()
        expected = {a: (value, ids[origin]) for a, (value, origin) in truth(versions, number).items()}
        rows = {a: (plain(row.value), row.node.commit) for a, row in found.rows.items() if row.value is not None}
        assert rows == expected


def commit_all(repository: Repository, versions: Sequence[Version], inside: str) -> list[str]:
    ids: list[str] = []
    for number, version in enumerate(versions):
        files = {f"{inside}/{p}" if inside else p: data for p, data in version.files().items()}
        time = datetime(2026, 1, 1, tzinfo=UTC) + timedelta(hours=number)
        parents = [ids[p] for p in version.parents]
        author = ("A Physicist", "physicist@localhost")
        ids.append(repository.write_commit(files, f"commit {number}", parents, author=author, time=time))
    return ids


@settings(max_examples=examples(100), deadline=None)
@given(histories())
def test_an_answer_survives_being_kept(versions: list[Version]) -> None:
    found = answer(walked(versions, 0, len(versions) - 1), packaged_units)
    again = loads(dumps(found))
    assert list(again.rows) == list(found.rows)
    for at, row in found.rows.items():
        assert [(n.value, n.commit) for n in again.rows[at].node.chain()] == [
            (n.value, n.commit) for n in row.node.chain()
        ]


LINES = [
    "  a:", "  b:", "  a: {slot: s1}", "  b: {pose: {x: 1, y: 2}, angle: 3}  # c", "  c: {a: [1", "    slot: s1",
    "    slot: 5",
    "    pose:", "    pose: {x: 1, yaw: 3 deg, y: 2}", "    pose: {}", "      x: 1", "      x: 1.50 cm # c",
    "      y: -2",
    "      yaw: 030", "      z: 1", "    angle: 90", "    angle: 90.0  ", "    angle: 1e3", "    angle: ~",
    "    angle: null", "    shutter: open", "    emission: true", "    emission: yes", "    angle: 1 : 2", "# comment",
    "    # another", "", "   ", "    angle: 5 deg", "    angle: 1_000", "components:", "---", "  a : 1", "\tb: 1",
    "    'q': 1", "    angle: |", "      text", "expect: []", "  a:  # empty", "metadata: {lab: t}", "    angle:",
]  # fmt: skip


@settings(max_examples=examples(1500), deadline=None)
@given(st.lists(st.sampled_from(LINES), max_size=9), st.booleans())
def test_the_short_way_through_a_manifest_says_what_the_parser_says_or_nothing(lines: list[str], ended: bool) -> None:
    data = (HEAD + "\n".join(lines) + "\n" * ended).encode()
    short = read_lines(data)
    if short is not None:
        whole = parsed(data)
        assert (short, "") == (whole.state, whole.wrong)


def test_the_short_way_is_taken_by_manifests_as_they_are_written() -> None:
    data = (Path(__file__).resolve().parents[3] / "labs" / "shel" / "state" / "table.yaml").read_bytes()
    assert read_lines(data) == parsed(data).state


# --- by hand, in repositories that git made


@pytest.fixture
def lab(git: Git, tmp_path: Path) -> Path:
    git("init", "-q", "-b", "main")
    root = tmp_path / "repo"
    (root / "lab.yaml").write_text(LAB)
    return root


def put(root: Path, text: str, path: str = "state.yaml") -> None:
    (root / path).write_text(HEAD + text)


def commit(git: Git, message: str, *more: str) -> str:
    git("add", "-A")
    git("commit", "-q", "--allow-empty", "-m", message, *more)
    return str(git("rev-parse", "HEAD").strip())


def last(found: Blamed) -> dict[str, str | None]:
    """Return the summary of the commit that changed each leaf last, None where it is not committed."""
    return {f"{leaf.component}.{leaf.tunable}": leaf.last.summary or None for leaf in found.leaves}


A = "  a:\n    slot: s1\n    angle: 12 deg\n"
B = "  b:\n    slot: s2\n"


def test_files_comments_units_and_layout_change_nothing(git: Git, lab: Path) -> None:
    put(lab, A + B)
    commit(git, "first")
    put(lab, "  # kept for later\n" + A.replace("12 deg", "12.0 # by eye") + B)
    commit(git, "comment and unit")
    put(lab, B)
    put(lab, "  a: {angle: 12, slot: s1}\n", "other.yaml")
    commit(git, "another file")
    (lab / "sub").mkdir()
    git("mv", "other.yaml", "sub/renamed.yaml")
    commit(git, "renamed")
    assert last(blame(lab)) == {"a.pose": "first", "a.angle": "first", "b.pose": "first", "c.pose": "first"}


def test_a_component_that_the_state_leaves_out_is_at_home(git: Git, lab: Path) -> None:
    put(lab, A + B)
    commit(git, "first")
    put(lab, B)
    commit(git, "a goes home")
    (leaf,) = blame(lab, ["a.pose"], history=True).leaves
    assert leaf.value == "h/a"
    assert [(t.summary, t.before, t.after) for t in leaf.history or ()] == [
        ("a goes home", "s1", "h/a"), ("first", None, "s1"),
    ]  # fmt: skip
    put(lab, "  a: {slot: h/a}\n" + B)
    commit(git, "said in so many words")
    assert last(blame(lab, ["a"])) == {"a.pose": "a goes home"}
    assert last(blame(lab, ["a.angle"])) == {"a.angle": "a goes home"}
    assert blame(lab, ["a.angle"]).leaves[0].value is None


def test_of_a_part_in_two_files_the_first_file_counts_and_moving_it_by_halves_changes_nothing(
    git: Git, lab: Path
) -> None:
    put(lab, A)
    commit(git, "first")
    put(lab, A, "z.yaml")
    commit(git, "copied")
    put(lab, B)
    commit(git, "taken out here")
    assert last(blame(lab, ["a"])) == {"a.pose": "first", "a.angle": "first"}


def test_a_criss_cross_merge(git: Git, lab: Path) -> None:
    put(lab, A + B)
    commit(git, "base")
    git("checkout", "-q", "-b", "side")
    put(lab, A + B.replace("s2", "s3"))
    side = commit(git, "side moves b")
    git("checkout", "-q", "main")
    put(lab, A.replace("12", "13") + B)
    main = commit(git, "main turns a")
    both = A.replace("12", "13") + B.replace("s2", "s3")
    for branch, other in (("main", side), ("side", main)):
        git("checkout", "-q", branch)
        git("merge", "-q", "--no-commit", "-s", "ours", other)
        put(lab, both)
        commit(git, f"merge into {branch}")
    git("merge", "-q", "--no-commit", "-s", "ours", "main")
    put(lab, both.replace("s3", "s4"))
    commit(git, "merge of merges, b elsewhere")
    found = last(blame(lab, ["a.angle", "b"]))
    assert found == {"a.angle": "main turns a", "b.pose": "merge of merges, b elsewhere"}
    assert blame(lab, ["b"]).leaves[0].last.how.kind == "merge"


@pytest.mark.parametrize("broken", ["  a: [\n", "  a: &x {slot: s1}\n", "  a: " + "[" * 50_000 + "\n", "\0"])
def test_a_manifest_that_can_not_be_read_in_the_middle_is_skipped_and_said(git: Git, lab: Path, broken: str) -> None:
    put(lab, A)
    put(lab, B, "b.yaml")
    commit(git, "first")
    put(lab, broken)
    put(lab, B.replace("s2", "s3"), "b.yaml")
    wrong = commit(git, "broken")
    put(lab, A.replace("12", "13"))
    commit(git, "repaired")
    for _ in range(2):
        found = blame(lab)
        assert last(found) == {"a.pose": "first", "a.angle": "repaired", "b.pose": "broken", "c.pose": "first"}
        assert [d.code for d in found.diagnostics] == ["skipped"]
        assert f"state.yaml can't be read at {wrong[:7]}" in found.diagnostics[0].summary
    at = blame(lab, ["a"], at=wrong)
    assert last(at) == {"a.pose": "first", "a.angle": "first"}
    put(lab, broken)
    edited = blame(lab, ["a"])
    assert last(edited) == {"a.pose": "first", "a.angle": "repaired"}
    assert "the working tree" in edited.diagnostics[0].summary


def test_edits_are_not_committed(git: Git, lab: Path) -> None:
    put(lab, A + B)
    commit(git, "first")
    put(lab, A.replace("12", "13") + "  b:\n    slot:  s2   # the same\n  c: {slot: s7}\n")
    found = blame(lab)
    assert found.edited
    assert last(found) == {"a.pose": "first", "a.angle": None, "b.pose": "first", "c.pose": None}
    leaf = next(leaf for leaf in found.leaves if leaf.tunable == "angle")
    assert (leaf.value, leaf.unit, leaf.last.how.kind, leaf.last.text) == (13, "deg", "edit", "12 → 13 deg")
    assert last(blame(lab, at="HEAD")) == dict.fromkeys(last(found), "first")
    (lab / "state.yaml").unlink()
    assert last(blame(lab)) == {"a.pose": None, "a.angle": None, "b.pose": None, "c.pose": "first"}


def test_before_the_first_commit_nothing_is_committed(lab: Path) -> None:
    put(lab, A)
    found = blame(lab, ["a"])
    assert (found.commit, found.name, last(found)) == (None, "main", {"a.pose": None, "a.angle": None})


def test_without_a_repository_it_says_how_to_get_one(tmp_path: Path) -> None:
    with pytest.raises(PicoError, match="is in no Git repository"):
        blame(tmp_path)


def test_a_shallow_clone_says_that_it_may_have_been_earlier(git: Git, lab: Path, tmp_path: Path) -> None:
    for angle in (12, 13, 14):
        put(lab, A.replace("12", str(angle)))
        commit(git, f"turned to {angle}")
    clone = tmp_path / "clone"
    git("clone", "-q", "--depth", "2", lab.as_uri(), str(clone))
    found = {leaf.tunable: leaf.last for leaf in blame(clone, ["a"]).leaves}
    assert (found["pose"].summary, found["pose"].earlier) == ("turned to 13", True)
    assert (found["angle"].summary, found["angle"].earlier) == ("turned to 14", False)
    git("fetch", "-q", "--unshallow", at="clone")
    found = {leaf.tunable: leaf.last for leaf in blame(clone, ["a"]).leaves}
    assert (found["pose"].summary, found["pose"].earlier) == ("turned to 12", False)


def test_names_that_nobody_knows_get_the_nearest_and_those_of_parts_that_are_gone_are_known(
    git: Git, lab: Path
) -> None:
    put(lab, A + "  mirror_7: {slot: s9}\n")
    commit(git, "first")
    put(lab, A)
    commit(git, "mirror_7 was sold")
    (leaf,) = blame(lab, ["mirror_7"]).leaves
    assert (leaf.value, leaf.last.summary, leaf.last.text) == (None, "mirror_7 was sold", "taken out")
    assert "mirror_7" not in {leaf.component for leaf in blame(lab).leaves}
    for word, said in (("miror_7", "mirror_7"), ("a.angel", "angle")):
        with pytest.raises(PicoError) as caught:
            blame(lab, [word, "a"])
        assert f"did you mean `{said}`?" in caught.value.diagnostics[0].hint
    assert last(blame(lab, ["a.slot"])) == last(blame(lab, ["a.pose.x"])) == {"a.pose": "first"}


def test_a_lab_whose_folder_was_moved_keeps_its_history(git: Git, lab: Path) -> None:
    put(lab, A)
    commit(git, "first")
    put(lab, A.replace("12", "13"))
    old = commit(git, "turned")
    (lab / "labs" / "t").mkdir(parents=True)
    git("mv", "lab.yaml", "state.yaml", "labs/t/")
    commit(git, "tidied up")
    put(lab / "labs" / "t", A.replace("12", "14") + B)
    commit(git, "b placed")
    expected = {"a.pose": "first", "a.angle": "b placed", "b.pose": "b placed", "c.pose": "first"}
    assert last(blame(lab / "labs" / "t")) == expected
    with pytest.raises(PicoError, match="has no folder labs/t"):
        blame(lab / "labs" / "t", at=old)
    git("mv", "labs/t", "one")
    commit(git, "again")
    assert last(blame(lab / "one", at="HEAD")) == expected


def test_links_are_not_followed(git: Git, lab: Path, tmp_path: Path) -> None:
    put(lab, A)
    commit(git, "first")
    put(tmp_path, A.replace("12", "13"), "outside.yaml")
    (lab / "state.yaml").unlink()
    (lab / "state.yaml").symlink_to(tmp_path / "outside.yaml")
    commit(git, "a link")
    assert last(blame(lab, ["a.pose"], at="HEAD")) == {"a.pose": "a link"}
    assert blame(lab, ["a.pose"], at="HEAD").leaves[0].value == "h/a"


@pytest.mark.parametrize("example", example_names())
def test_the_examples_are_blamed_as_by_their_whole_states(example: str, tmp_path: Path) -> None:
    repository = make_example(example, tmp_path / "lab")
    folder = LabFolder(tmp_path / "lab")
    commits = {c.id: c for tip in repository.tips() for c in repository.log([tip])}
    states = {name: whole_state(*folder.historic(name)) for name in commits}

    def origin(commit: str, at: tuple[str, str]) -> str:
        same = [p for p in commits[commit].parents if states[p].get(at) == states[commit][at]]
        return origin(same[0], at) if same else commit

    for tip in repository.tips():
        head = repository.resolve(tip).id
        found = {(x.component, x.tunable): (x.value, x.last.commit) for x in blame(folder.root, at=tip).leaves}
        assert found == {at: (value, origin(head, at)) for at, value in states[head].items()}


def whole_state(setup: Setup, state: LabState) -> dict[tuple[str, str], Any]:
    found: dict[tuple[str, str], Any] = {}
    for name in setup.lab.inventory:
        found[name, "pose"] = place_json(*place_of(setup, state, name))
        values = state.components[name].values if name in state.components else {}
        found |= {(name, tunable): value for tunable, value in values.items()}
    return found


# --- what is kept between calls


def spoil_bytes(path: Path) -> None:
    data = path.read_bytes()
    path.write_bytes(data[:200] + os.urandom(len(data) - 200))


def spoil_rows(path: Path) -> None:
    with sqlite3.connect(path) as database:
        database.execute("UPDATE read SET data = x'00'")
        database.execute("UPDATE result SET data = x'789c030000000001'")
    database.close()


def other_version(path: Path) -> None:
    with sqlite3.connect(path) as database:
        database.executescript("DROP TABLE read; DROP TABLE result; PRAGMA user_version = 99")
    database.close()


def no_tables(path: Path) -> None:
    with sqlite3.connect(path) as database:
        database.executescript("DROP TABLE read")
    database.close()


def be_a_folder(path: Path) -> None:
    path.unlink()
    path.mkdir()


@pytest.mark.parametrize(
    "spoil",
    [spoil_bytes, spoil_rows, other_version, no_tables, be_a_folder, lambda path: path.write_bytes(b""),
     lambda path: path.write_text("no database"), lambda path: path.write_bytes(path.read_bytes()[:5000])],
)  # fmt: skip
def test_a_cache_that_is_spoiled_is_not_used_and_no_error(git: Git, lab: Path, spoil: Any) -> None:
    put(lab, A)
    commit(git, "first")
    expected = blame(lab)
    spoil(lab / ".git" / CACHE)
    assert blame(lab) == expected
    put(lab, A + B)
    commit(git, "second")
    for _ in range(2):
        assert last(blame(lab, ["a.pose", "b"])) == {"a.pose": "first", "b.pose": "second"}


def test_a_cache_that_is_locked_is_waited_for_shortly_and_done_without(
    git: Git, lab: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(blame_cache, "_WAIT", 0.01)
    put(lab, A)
    commit(git, "first")
    expected = blame(lab)
    with sqlite3.connect(lab / ".git" / CACHE, isolation_level=None) as database:
        database.execute("BEGIN EXCLUSIVE")
        assert blame(lab) == expected
    database.close()


def test_where_nothing_can_be_written_the_answer_is_the_same(
    git: Git, lab: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    put(lab, A)
    commit(git, "first")
    monkeypatch.setattr(blame_cache, "_open", lambda path: sqlite3.connect(":memory:"))
    assert last(blame(lab, ["a.pose"])) == {"a.pose": "first"}
    (lab / ".git" / "pico").write_text("in the way")
    monkeypatch.undo()
    assert last(blame(lab, ["a.pose"])) == {"a.pose": "first"}


def test_what_is_kept_stays_small(git: Git, lab: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(blame_cache, "MOST_BYTES", 60_000)
    for number in range(6):
        put(lab, "".join(f"  p{i}: {{slot: s/{os.urandom(8).hex()}}}\n" for i in range(400)))
        commit(git, f"commit {number}")
        blame(lab)
    assert (lab / ".git" / CACHE).stat().st_size < 150_000
    assert set(last(blame(lab, ["p7"])).values()) == {"commit 5"}


def test_calls_at_the_same_time_do_not_break_one_another(git: Git, lab: Path) -> None:
    for number in range(8):
        put(lab, A.replace("12", str(number)))
        commit(git, f"turned to {number}")
    code = "import sys; from pathlib import Path; from pico.history.blame.blamed import blame; "
    code += "print([leaf.last.summary for leaf in blame(Path(sys.argv[1]), ['a.angle'], at=sys.argv[2]).leaves])"

    def ask(number: int) -> str:
        at = f"HEAD~{number % 3}"
        return subprocess.run(
            [sys.executable, "-c", code, str(lab), at], capture_output=True, text=True, check=True
        ).stdout.strip()

    with ThreadPoolExecutor(4) as pool:
        assert list(pool.map(ask, range(6))) == [f"['turned to {7 - i % 3}']" for i in range(6)]


def test_worktrees_share_what_is_kept(git: Git, lab: Path, tmp_path: Path) -> None:
    put(lab, A)
    commit(git, "first")
    git("worktree", "add", "-q", str(tmp_path / "second"))
    assert last(blame(tmp_path / "second", ["a.pose"])) == {"a.pose": "first"}
    assert (lab / ".git" / CACHE).is_file()


def test_only_what_is_new_is_read(git: Git, lab: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    put(lab, A)
    put(lab, B, "b.yaml")
    for number in range(4):
        put(lab, A.replace("12", str(number)))
        commit(git, f"turned to {number}")
    blame(lab)
    read: list[bytes] = []
    monkeypatch.setattr("pico.history.blame.walk.flatten", lambda data: read.append(data) or flatten(data))
    blame(lab)
    assert read == []
    put(lab, B.replace("s2", "s3"), "b.yaml")
    commit(git, "b moved")
    assert last(blame(lab, ["a.angle", "b"])) == {"a.angle": "turned to 3", "b.pose": "b moved"}
    assert len(read) == 1


# --- how it was changed


def run_document(name: str, changes: Sequence[str], afterwards: Sequence[str] = (), **cause: str) -> Run:
    def made(addresses: Sequence[str]) -> tuple[Change, ...]:
        return tuple(Change(component=a.partition(".")[0], tunable=a.partition(".")[2]) for a in addresses)

    nothing = "sha256:" + "0" * 64
    return Run(
        id=name, lab=LabRef(name="t", digest=nothing), state_before=nothing, state_after=nothing, plan=nothing,
        cause=Cause(**({"kind": "apply"} | cause)), evidence="physics", started_at=f"2026-01-01T00:00:{name[-2:]}Z",
        outcome="done", changes=made(changes), afterwards=made(afterwards),
    )  # fmt: skip


def carry(root: Path, *documents: Run) -> None:
    for document in documents:
        for path, data in run_files(document, (), ()).items():
            (root / path).parent.mkdir(parents=True, exist_ok=True)
            (root / path).write_bytes(data)


def hows(found: Blamed) -> dict[str, str]:
    return {f"{x.component}.{x.tunable}": f"{x.last.how.kind} {x.last.how.run or ''}".strip() for x in found.leaves}


REALIZED = ("-m", "Pico-Evidence: physics\nPico-Lab: t sha256:0")


def test_a_leaf_is_blamed_on_the_last_run_that_changed_it_else_on_a_hand(git: Git, lab: Path) -> None:
    put(lab, A + B + "  c: {slot: s7, angle: 1}\n")
    carry(
        lab,
        run_document("r01", ["a.pose", "a.angle", "b.pose"]),
        run_document("r02", ["a.angle"], ["b.pose", "a.pose"], kind="recipe", recipe="scan.yaml", step="4"),
        run_document("r03", ["a.pose"], ["a.angle"]),
    )
    commit(git, "runs and a hand", *REALIZED)
    found = blame(lab)
    assert hows(found) == {
        "a.pose": "run r03", "a.angle": "run r02", "b.pose": "run r01", "c.pose": "hand", "c.angle": "hand",
    }  # fmt: skip
    how = next(leaf.last.how for leaf in found.leaves if leaf.tunable == "angle")
    assert (how.cause, how.recipe, how.step, how.evidence) == ("recipe", "scan.yaml", "4", "physics")
    assert hows(blame(lab)) == hows(found)


def test_what_changed_after_the_run_was_changed_by_hand(git: Git, lab: Path) -> None:
    put(lab, A + B)
    carry(lab, run_document("r01", ["a.pose", "b.pose"], ["a.pose"]))
    commit(git, "captured", *REALIZED)
    assert hows(blame(lab, ["a.pose", "b"])) == {"a.pose": "hand", "b.pose": "run r01"}


def test_a_planned_commit_and_one_that_does_not_say(git: Git, lab: Path) -> None:
    put(lab, A)
    commit(git, "with git")
    put(lab, A + B)
    commit(git, "planned", "-m", "Pico-Evidence: planned\nPico-Lab: t sha256:0")
    put(lab, A + B + "  c: {slot: s7}\n")
    commit(git, "before runs were kept", "-m", "Pico-Evidence: kinematic\nPico-State: sha256:0")
    assert hows(blame(lab)) == {"a.pose": "commit", "a.angle": "commit", "b.pose": "planned", "c.pose": "commit"}


def test_a_damaged_run_is_no_run(git: Git, lab: Path) -> None:
    put(lab, A)
    carry(lab, run_document("r01", ["a.pose"]))
    (lab / "runs/2026/01/r01/run.json").write_text("{")
    commit(git, "damaged", *REALIZED)
    for _ in range(2):
        assert hows(blame(lab, ["a.pose"])) == {"a.pose": "hand"}


def test_a_merge_did_not_make_the_runs_that_it_merges(git: Git, lab: Path) -> None:
    put(lab, A)
    commit(git, "base")
    git("checkout", "-q", "-b", "side")
    put(lab, A + B)
    carry(lab, run_document("r01", ["b.pose", "c.pose"]))
    commit(git, "side", *REALIZED)
    git("checkout", "-q", "main")
    commit(git, "other")
    git("merge", "-q", "--no-commit", "--no-ff", "side")
    put(lab, A + B + "  c: {slot: s7}\n")
    commit(git, "merge")
    assert hows(blame(lab, ["b", "c.pose"])) == {"b.pose": "run r01", "c.pose": "merge"}


@pytest.mark.parametrize(
    ("left", "how"),
    [
        ({"x": 640.0, "y": 420.0, "yaw": 10.0}, "edited"),
        ({"x": 5.3, "y": 7.0, "yaw": 0.0}, "run r01"),
        ("s7", "run r01"),
    ],
)
def test_a_run_that_a_rebase_took_along_to_another_value_is_not_blamed_for_it(
    git: Git, lab: Path, left: object, how: str
) -> None:
    put(lab, "  a: {pose: {x: 5, y: 7, yaw: 0}}\n")
    moved = Change(component="a", tunable="pose", after=left)
    carry(lab, dataclasses.replace(run_document("r01", []), changes=(moved,)))
    commit(git, "rebased, its conflict resolved", *REALIZED)
    assert hows(blame(lab, ["a.pose"])) == {"a.pose": how}
