"""Whole trees united: labs of several files, and what is in the way where they can't be."""

from __future__ import annotations

import hashlib
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
import yaml
from moving_cases import LAB, Files, moved_case

sys.path.append(str(Path(__file__).resolve().parents[2]))

from kept import differs

from pico.diagnostics import PicoError
from pico.history.git.attributes import CLEAN, CONFLICT, FAILED
from pico.history.merge.alignment import Alike, disagreement, made_alike, settled
from pico.history.merge.driver import main
from pico.history.merge.groups import groups_of
from pico.history.merge.layout import both
from pico.history.merge.lines import merge_lines
from pico.history.merge.manifests import merge
from pico.history.merge.markers import Labels, view
from pico.history.merge.parts import bare, without
from pico.history.merge.trees import Union, contents, opened, unite_trees
from pico.history.repository.repository import Repository

HEAD = "apiVersion: pico/v1\nkind: LabState\nmetadata: {lab: bench}\ncomponents:\n"
TABLE = HEAD + "  m1:\n    slot: a1\n    tip: 1\n  m2:\n    slot: a2\n    tip: 2\n  m3:\n    slot: a3\n    tip: 3\n"
M1, M2, M3 = (f"  m{n}:\n    slot: a{n}\n    tip: {n}\n" for n in (1, 2, 3))


@pytest.fixture(scope="module")
def repository(tmp_path_factory: pytest.TempPathFactory) -> Repository:
    return Repository.init(tmp_path_factory.mktemp("trees"))


def united(repository: Repository, base: Files, ours: Files, theirs: Files) -> tuple[Union, dict[str, bytes]]:
    """Return what comes of three trees, and every file of the tree."""
    import pygit2

    handle = opened(repository.root)
    trees = []
    for files in (base, ours, theirs):
        index = pygit2.Index()
        for path, text in files.items():
            index.add(pygit2.IndexEntry(path, handle.create_blob(text.encode()), pygit2.enums.FileMode.BLOB))
        trees.append(str(index.write_tree(handle)))
    union = unite_trees(handle, *trees, Labels())
    index = pygit2.Index()
    if union.tree:
        index.read_tree(handle[union.tree])
    assert not union.tree or contents(handle, handle[union.tree]).keys() <= {entry.path for entry in index}
    return union, {entry.path: handle[entry.id].data for entry in index}


def told(union: Union, files: dict[str, bytes]) -> Iterator[str]:
    for path, c in union.conflicts:
        yield f"  {path}: {c.address}: {c.base} | {c.ours} | {c.theirs} | {c.keys} {c.files} {c.out}"
    yield from (f"  {path}: {c.component}: {c.ours} with {c.theirs}" for path, c in union.coupled)
    yield from (f"  in the way: {path}" for path in union.files)
    for path, data in files.items():
        yield f"  {path}: {len(data.splitlines())} lines, {hashlib.sha256(data).hexdigest()[:12]}"


def test_labs_of_several_files_come_out_as_they_are_kept(repository: Repository) -> None:
    lines: list[str] = []
    for seed in range(500, 530):
        c = moved_case(seed)
        for name, ours, theirs in (("forth", c.ours, c.theirs), ("back", c.theirs, c.ours)):
            lines += [f"seed {seed}, {name}", *told(*united(repository, c.base, ours, theirs))]
    assert not differs("merges_of_trees.txt", "\n".join(lines) + "\n")


def alike(base: Files, ours: Files, theirs: Files) -> tuple[Alike, list[Files]]:
    versions = [{path: text.encode() for path, text in files.items()} for files in (base, ours, theirs)]
    made = made_alike(*versions, labs={"."})
    return made, [{p: d.decode() for p, d in files.items()} for files in (made.base, made.ours, made.theirs)]


def test_a_part_that_one_side_moved_is_moved_in_the_other_versions_only_where_something_was_done_to_it() -> None:
    moved = {"a": TABLE.replace(M2, ""), "b": HEAD + M2}
    made, (base, ours, theirs) = alike({"a": TABLE}, moved, {"a": TABLE.replace("tip: 2", "tip: 9")})
    assert base == {"a": TABLE.replace(M2, ""), "b": HEAD + M2} and ours == moved
    assert theirs == {"a": TABLE.replace(M2, ""), "b": HEAD + M2.replace("tip: 2", "tip: 9")}
    assert made.conflicts == [] and made.present == {(".", name) for name in ("m1", "m2", "m3")}
    untouched = {"a": TABLE.replace("tip: 1", "tip: 9")}
    _, versions = alike({"a": TABLE}, moved, untouched)
    assert versions == [{"a": TABLE}, moved, untouched]


def test_both_sides_moving_a_part_to_one_file_is_followed_in_the_base() -> None:
    moved = {"a": TABLE.replace(M2, ""), "b": HEAD + M2}
    also = {"a": TABLE.replace(M2, ""), "b": HEAD + M2.replace("tip: 2", "tip: 9")}
    _, (base, ours, theirs) = alike({"a": TABLE}, moved, also)
    assert (base, ours, theirs) == (moved, moved, also)


def test_a_part_is_put_behind_what_it_came_after() -> None:
    base, there = {"a": HEAD + M1 + M2, "b": HEAD + M3}, {"a": HEAD + M1, "b": HEAD + M3 + M2}
    _, versions = alike(base, there, {"a": HEAD + M1 + M2.replace("tip: 2", "tip: 7"), "b": HEAD + M3})
    assert versions[2]["b"] == HEAD + M3 + M2.replace("tip: 2", "tip: 7")


def test_where_the_file_is_in_braces_nothing_is_moved() -> None:
    braces = "{apiVersion: pico/v1, kind: LabState, metadata: {lab: b}, components: {m2: {slot: a2, tip: 2}}}\n"
    changed = {"a": TABLE.replace("tip: 2", "tip: 9")}
    made, versions = alike({"a": TABLE}, {"a": TABLE.replace(M2, ""), "b": braces}, changed)
    assert versions[2] == changed and made.present >= {(".", "m2")}


def test_a_file_taken_away_here_and_changed_there_stays_empty_until_all_is_known() -> None:
    base = {"a": TABLE, "b": HEAD + "  m4:\n    slot: a4\n"}
    ours = {"b": base["b"]}
    theirs = {**base, "a": TABLE.replace("tip: 1", "tip: 5")}
    made, (_, mine, _) = alike(base, ours, theirs)
    assert made.emptied == {"a"} and mine["a"] == HEAD
    kept, wrong = settled(made, {"a": HEAD.encode(), "b": base["b"].encode()})
    assert kept == {"b": base["b"].encode()} and wrong == []
    commented = (HEAD + "  # here\n").encode()
    assert settled(made, {"a": commented, "b": base["b"].encode()})[1] == ["a"]
    assert settled(made, {"a": (HEAD + M1).encode(), "b": base["b"].encode()})[1] == ["a"], "m1 came back"


def test_a_part_that_is_lost_or_twice_or_came_back_is_told_with_its_file() -> None:
    made, _ = alike({"a": TABLE}, {"a": TABLE.replace("tip: 1", "tip: 7")}, {"a": TABLE.replace(M3, "")})
    whole = TABLE.replace(M3, "").encode()
    assert settled(made, {"a": whole}) == ({"a": whole}, [])
    assert settled(made, {"a": TABLE.encode()})[1] == ["a"], "m3 came back"
    assert settled(made, {"a": whole, "b": (HEAD + M1).encode()})[1] == ["a", "b"], "m1 is twice"
    assert settled(made, {"a": (HEAD + M1).encode()})[1] == ["a"], "m2 is lost"


def test_a_renamed_file_is_one_with_more_than_half_of_the_parts() -> None:
    rest = {"z": HEAD}
    for held, followed in ((M1 + M2, True), (M1, False)):
        changed = {"a": TABLE.replace("tip: 1", "tip: 5"), **rest}
        _, (_, _, theirs) = alike({"a": TABLE, **rest}, {"b": HEAD + held, **rest}, changed)
        assert (theirs.get("b") == changed["a"]) is followed, held
    pair = HEAD + M1 + M2
    _, (_, _, theirs) = alike({"a": pair}, {"b": HEAD + M1}, {"a": pair.replace("tip: 2", "tip: 5")})
    assert "a" in theirs, "half is not more than half"


@pytest.mark.parametrize(
    ("base", "ours", "theirs", "said"),
    [
        ("a", "b", "c", ("in a", "moved to b", "moved to c", ("b", "c"), None)),
        (None, "b", "c", ("absent", "put into b", "put into c", ("b", "c"), None)),
        ("a", None, "c", ("in a", "taken out", "moved to c", ("c",), 0)),
        ("a", "c", None, ("in a", "moved to c", "taken out", ("c",), 1)),
        ("a", "a", "c", None),
        ("a", "b", "a", None),
        ("a", "b", "b", None),
        (None, "b", None, None),
        (None, None, "b", None),
        ("a", None, "a", None),
    ],
)
def test_where_the_sides_disagree_on_the_file_of_a_part(
    base: str | None, ours: str | None, theirs: str | None, said: tuple[object, ...] | None
) -> None:
    found = disagreement("m1", base, ours, theirs)
    if said is None:
        assert found is None
    else:
        assert found is not None
        c = found[1]
        assert (c.base, c.ours, c.theirs, c.files, c.out) == said
        assert (found[0], c.address) == (c.files[0], "m1")


def test_other_files_that_both_changed_are_united_or_told(repository: Repository) -> None:
    def of(notes: str | None, table: str = TABLE) -> Files:
        return {"lab.yaml": LAB, "table.yaml": table} | ({"notes.txt": notes} if notes is not None else {})

    base, twice = of("a\nb\nc\n"), TABLE.replace("tip: 3", "tip: 8")
    union, files = united(repository, base, of("A\nb\nc\n"), of("a\nb\nC\n", twice))
    assert union.files == [] and files["notes.txt"] == b"A\nb\nC\n" and files["table.yaml"] == twice.encode()
    union, _ = united(repository, base, of("1\nb\nc\n"), of("2\nb\nc\n", twice))
    assert (union.tree, union.files, union.conflicts) == ("", ["notes.txt"], [])
    union, _ = united(repository, base, of(None), of("a\nb\nC\n"))
    assert (union.tree, union.files) == ("", ["notes.txt"])
    union, files = united(repository, base, of(None), base)
    assert union.files == [] and "notes.txt" not in files
    broken = TABLE.replace("slot: a1", "slot: [")
    union, _ = united(repository, base, of("a\nb\nc\n", broken), of("a\nb\nc\n", broken.replace("tip: 1", "tip: 4")))
    assert (union.tree, union.files, union.conflicts) == ("", ["table.yaml"], [])


def test_a_part_is_followed_into_a_folder_of_its_lab_and_not_into_another_lab(repository: Repository) -> None:
    moved = {"lab.yaml": LAB, "table.yaml": TABLE.replace(M2, ""), "state/more.yaml": HEAD + M2}
    base, changed = {"lab.yaml": LAB, "table.yaml": TABLE}, TABLE.replace("tip: 2", "tip: 9")
    union, files = united(repository, base, moved, {"lab.yaml": LAB, "table.yaml": changed})
    assert union.files == [] and union.conflicts == []
    assert files["state/more.yaml"].decode() == HEAD + M2.replace("tip: 2", "tip: 9")
    assert files["table.yaml"].decode() == TABLE.replace(M2, "")
    apart = {f"other/{path}": text for path, text in {"lab.yaml": LAB, "b.yaml": HEAD + M2}.items()}
    union, files = united(repository, base, {**base, **apart}, {"lab.yaml": LAB, "table.yaml": changed})
    assert files["other/b.yaml"].decode() == HEAD + M2 and files["table.yaml"].decode() == changed


CHAINS = {
    "a list below a key that both changed": (
        "expect:\n  - that: a\n  - that: b\n",
        "expect:\n  - that: a\n  - that: c\n",
        "expect:\n  - that: d\n",
    ),
    "a value that one side made a mapping": ("note: old\n", "note:\n  by: me\n", "note: old  # seen\n"),
    "a mapping that one side took out": ("note:\n  by: me\n  on: 3\n", "", "note:\n  by: me\n  on: 3\n# end\n"),
}


@pytest.mark.parametrize("name", CHAINS)
@pytest.mark.parametrize("swapped", [False, True])
def test_what_is_no_component_is_merged_or_told_and_nothing_of_it_is_lost(name: str, swapped: bool) -> None:
    base, *sides = (TABLE + text for text in CHAINS[name])
    ours, theirs = sides[::-1] if swapped else sides
    found = merge(base.encode(), ours.encode(), theirs.encode())
    text = found.data.decode()
    assert view(text, "ours") == ours and view(text, "theirs") == theirs if not found.clean else True
    if found.clean:
        said = yaml.safe_load(text)
        wins = sides[0] if name != "a list below a key that both changed" else ""
        assert said == yaml.safe_load(wins) and ("# seen" in text or "# end" in text)
    assert found.clean is (name != "a list below a key that both changed")


def test_lines_that_are_no_text_stay_as_ours_has_them_and_are_in_conflict() -> None:
    assert merge_lines(b"\0a\n", b"\0b\n", b"\0c\n", Labels()) == (b"\0b\n", False)
    said, clean = merge_lines(b"a\n", b"b\n", b"c\n", Labels("E1", "B0", "C3", 9))
    assert not clean and said.splitlines()[0] == b"<<<<<<<<< E1" and said.splitlines()[-1] == b">>>>>>>>> C3"


def test_without_git_no_lines_are_merged(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "/nowhere")
    with pytest.raises(PicoError, match="no `git` command"):
        merge_lines(b"a", b"b", b"c", Labels())


def test_what_the_driver_tells_and_ends_with(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    def drive(ours: str, theirs: str, *names: str) -> tuple[int, str]:
        for name, text in (("base", TABLE), ("ours", ours), ("theirs", theirs)):
            (tmp_path / name).write_text(text)
        files = [str(tmp_path / name) for name in ("ours", "out", "base", "theirs")]
        code = main([*files, "9", str(tmp_path / "t.yaml"), *names])
        return code, capfd.readouterr().err.replace(str(tmp_path), "")

    mine = TABLE.replace("tip: 1", "tip: 5")
    assert drive(mine, TABLE.replace("tip: 2", "tip: 6")) == (CLEAN, "")
    assert (tmp_path / "out").read_text() == mine.replace("tip: 2", "tip: 6")
    code, said = drive(mine, TABLE.replace("tip: 1", "tip: 6"), "B0", "E1", "C3")
    assert (code, said) == (CONFLICT, "pico: /t.yaml: m1.tip: B0 1 | E1 5 (+4) | C3 6 (+5)\n")
    assert "<<<<<<<<< E1: m1.tip" in (tmp_path / "out").read_text()
    broken = drive(TABLE.replace("slot: a1", "slot: ["), TABLE.replace("slot: a1", "slot: ]"))
    assert broken == (CONFLICT, "pico: /t.yaml: merged line by line: not a valid manifest on all sides\n")
    (tmp_path / "base").unlink()
    assert main([str(tmp_path / "ours"), "out", str(tmp_path / "base"), str(tmp_path / "theirs"), "7", "t"]) == FAILED
    assert capfd.readouterr().err.endswith("git merges line by line instead\n")


def test_what_holds_no_parts_that_are_lines_has_nothing_to_take_out() -> None:
    for data in (b"kind: Lab\n", b"kind: LabState\ncomponents: {m1: {}}\n", b"\xff"):
        with pytest.raises(ValueError, match="lines of their own"):
            without(data, ["m1"])
    assert without(TABLE.encode(), ["m1", "m3"]) == (HEAD + M2).encode()
    assert bare(("# above\n" + TABLE).encode()) == HEAD.encode()


def test_a_type_that_nobody_knows_belongs_to_no_group() -> None:
    lab = "apiVersion: pico/v1\nkind: Lab\ninventory:\n  m1: {type: no_such}\n  m2: {type: ../m}\n  m3: {home: a}\n"
    assert groups_of([("lab.yaml", lab.encode())]) == ({}, False)


def test_comments_that_one_side_alone_changed_are_as_it_has_them() -> None:
    was, now = ["# a", "", "# b"], ["# b", "# a", "# a", "# c"]
    assert both(was, was, now) == now == both(was, now, was) == both(was, now, now)
    assert both(was, ["# a"], ["# a", "# b", "# x"]) == ["# a", "# x"]
    assert both([], ["# one"], ["# two"]) == ["# one", "# two"] == both([], ["# two"], ["# one"])


def test_a_file_that_can_not_be_read_is_no_renamed_one_and_stays() -> None:
    broken = HEAD + "  m1: [\n"
    made, versions = alike({"a": broken, "z": TABLE}, {"b": HEAD + M1, "z": TABLE}, {"a": broken + "#\n", "z": TABLE})
    assert versions[2]["a"] == broken + "#\n" and "a" not in versions[1] and made.conflicts == []
