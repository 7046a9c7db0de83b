"""Whatever stands in a manifest, the answer is diagnostics: where, what, and what would be right."""

from __future__ import annotations

import os
import re
from pathlib import Path

import pytest
from manifest_samples import BYTES, GOOD, LAB, OWN_TYPE, STATE, USES_OWN, malformed

from pico.diagnostics import PicoError
from pico.history.merge.checked import overlapping
from pico.manifest.fmt import format_text
from pico.manifest.load import load_files, load_folder

CASES = malformed()
JARGON = re.compile(r"\b(pydantic|Input should|Field required|dataclass|NoneType|dict|str)\b")


def test_the_samples_are_right_before_they_are_broken() -> None:
    assert load_files(GOOD).diagnostics == ()
    own = GOOD | {"lab.yaml": USES_OWN.encode(), "own.yaml": OWN_TYPE.encode()}
    assert load_files(own).diagnostics == ()
    assert len(CASES) >= 300
    assert len({name for name, _ in CASES}) == len(CASES)


@pytest.mark.parametrize("files", [files for _, files in CASES], ids=[name for name, _ in CASES])
def test_each_gives_an_error_with_a_place_and_a_hint(files: dict[str, bytes]) -> None:
    read = load_files(files)
    found = read.diagnostics or overlapping(read)
    errors = [d for d in found if d.severity == "error"]
    assert errors
    for diagnostic in errors:
        assert diagnostic.source is not None
        assert diagnostic.source.path.endswith(".yaml")
        assert diagnostic.source.start.line >= 1
        assert diagnostic.source.start.column >= 1
        assert diagnostic.source.end.column > diagnostic.source.start.column
        assert diagnostic.hint or diagnostic.label
        assert not JARGON.search(diagnostic.summary + diagnostic.hint + diagnostic.label)
    places = [(d.source.path, d.source.start.line, d.source.start.column) for d in found if d.source]
    assert places == sorted(places)


@pytest.mark.parametrize("data", list(BYTES.values()), ids=list(BYTES))
def test_the_formatter_refuses_what_the_loader_refuses_or_leaves_it_alone(data: bytes) -> None:
    try:
        text = data.decode()
    except UnicodeDecodeError:
        return
    try:
        format_text(text)
    except PicoError as exc:
        assert exc.diagnostics


def test_the_whole_bench_is_told_at_once() -> None:
    lab = LAB.replace("beam_height: 70", "beam_height: 70 kg").replace("model: xarm7", "modl: xarm7")
    state = STATE.replace("angle: 90.0", "angle: 2 kg").replace("shutter: open", "shutter: ajar")
    codes = [d.code for d in load_files({"lab.yaml": lab.encode(), "s.yaml": state.encode()}).diagnostics]
    assert codes == ["unit", "unknown-key", "choice", "unit"]


def test_a_wrong_dimension_reads_like_a_sentence() -> None:
    wrong = STATE.replace("angle: 90.0", "angle: 2 kg")
    (found,) = load_files(GOOD | {"state/table.yaml": wrong.encode()}).diagnostics
    assert found.summary == "angle of p1 is an angle, not a mass"
    assert found.label == "expected degrees, for example `2` or `2 deg`"
    assert str(found.source) == "state/table.yaml:13:12"
    assert found.source is not None
    assert found.source.snippet == "    angle: 2 kg"
    assert found.source.end.column - found.source.start.column == len("2 kg")


def test_a_duplicate_names_both_places() -> None:
    second = "apiVersion: pico/v1\nkind: LabState\nmetadata: {lab: bench}\ncomponents:\n  p1: {slot: storage/a1}\n"
    (found,) = load_files(GOOD | {"state/z.yaml": second.encode()}).diagnostics
    assert str(found.source) == "state/z.yaml:5:3"
    assert "state/table.yaml:8:3" in found.detail


@pytest.mark.parametrize(
    ("first", "second", "said"),
    [
        ("   m1", "  p2", "line 5 begins in column 4, this one in column 3: one of them is askew"),
        ("  m1", " p2", "line 5 begins in column 3, this one in column 2: one of them is askew"),
        ("  m1", "     p2", "it begins in column 6: bring it below line 5 (column 3), or below line 6 (column 7)"),
    ],
)
def test_of_lines_that_stand_askew_both_are_named(first: str, second: str, said: str) -> None:
    head = "apiVersion: pico/v1\nkind: LabState\nmetadata: {lab: bench}\ncomponents:\n"
    text = f"{head}{first}:\n      slot: storage/a1\n  # about p2\n\n{second}:\n      slot: storage/a2\n"
    (found,) = load_files(GOOD | {"state/table.yaml": text.encode()}).diagnostics[:1]
    assert found.source is not None and found.source.start.line == 9
    assert found.detail == said


@pytest.mark.parametrize(
    ("old", "new", "hint"),
    [
        ("  p2:", "    p2:", "`p2` is a component: begin it in the column of the others"),
        ("  p2:", "p2:", "`p2` is a component: begin it in the column of the others"),
        ("    angle: 90.0", "  angle: 90.0", "`angle` is a tunable, of p1 for example: indent it"),
        ("    angle: 90.0", "      angle: 90.0", "`angle` is a tunable of p1: bring it back"),
        (
            "    slot: storage/a2\n    angle: 1",
            "    angle: 1\n  slot: storage/a2",
            "`slot` says where a component is: indent",
        ),
        ("    angle: 90.0", "\tangle: 90.0", "indent with spaces"),
        ("x: 290", "x: 290,5", "decimals are written with a point, `290.5`"),
    ],
)
def test_of_what_is_indented_wrongly_it_is_said_where_it_belongs(old: str, new: str, hint: str) -> None:
    assert STATE.count(old) >= 1
    found = load_files(GOOD | {"state/table.yaml": STATE.replace(old, new, 1).encode()}).diagnostics
    assert any(hint in f"{one.summary} {one.hint}" for one in found), found


@pytest.mark.parametrize("marker", [">>>>>>> e1", "=======", "<<<<<<< HEAD", "||||||| 1a2b3c4"])
def test_a_marker_that_a_merge_left_alone_is_told_as_that(marker: str) -> None:
    lines = STATE.splitlines()
    at = next(i for i, line in enumerate(lines) if "x: 290" in line)
    text = "\n".join([*lines[: at + 1], marker, *lines[at + 1 :]])
    (found,) = load_files(GOOD | {"state/table.yaml": text.encode()}).diagnostics
    assert (found.code, found.summary) == ("merge-conflict", "a left-over merge marker")
    assert found.hint == "delete the line" and found.source is not None and found.source.start.line == at + 2


@pytest.mark.parametrize(("yaw", "same"), [("900", "180"), ("-405", "-45"), ("360.5", "0.5")])
def test_a_yaw_beyond_a_turn_is_refused_with_what_it_would_be(yaw: str, same: str) -> None:
    text = STATE.replace("yaw: 0", f"yaw: {yaw}", 1)
    (found,) = load_files(GOOD | {"state/table.yaml": text.encode()}).diagnostics
    assert found.code == "range" and found.hint == f"write {same}, which is the same"
    assert load_files(GOOD | {"state/table.yaml": text.replace(yaw, "-360").encode()}).diagnostics == ()


def test_more_than_200_components_in_a_file_are_warned_about() -> None:
    names = [f"c{i:03}" for i in range(201)]
    slots = "".join(f"  storage/{n}: {{x: {10 + i}, y: 10}}\n" for i, n in enumerate(names))
    parts = "".join(f"  {n}: {{type: beam_block, home: storage/{n}}}\n" for n in names)
    lab = LAB.split("slots:")[0] + f"slots:\n{slots}robots:\n  arm1: {{mount: {{x: 1, y: 1}}}}\ninventory:\n{parts}"
    state = STATE.split("components:")[0] + "components:\n" + "".join(f"  {n}: {{slot: storage/{n}}}\n" for n in names)
    loaded = load_files({"lab.yaml": lab.encode(), "state.yaml": state.encode()})
    assert [(d.severity, d.code) for d in loaded.diagnostics] == [("warning", "large-file")]
    assert loaded.require()


def test_a_byte_order_mark_is_warned_about_and_read(tmp_path: Path) -> None:
    loaded = load_files(GOOD | {"state/table.yaml": b"\xef\xbb\xbf" + STATE.encode()})
    assert [(d.severity, d.code) for d in loaded.diagnostics] == [("warning", "encoding")]
    assert loaded.require()


def test_links_and_pipes_are_refused_unread(tmp_path: Path) -> None:
    (tmp_path / "lab.yaml").write_text(LAB)
    (tmp_path / "table.yaml").write_text(STATE)
    (tmp_path / "linked.yaml").symlink_to("/etc/passwd")
    os.mkfifo(tmp_path / "pipe.yaml")
    (tmp_path / "folder.yaml").mkdir()
    found = load_folder(tmp_path).diagnostics
    assert [d.code for d in found] == ["symlink", "not-a-file"]


HEADLESS = {
    "the header and `components:` are gone": ("more.yaml", "  p1:\n    pose: {x: 290, y: 420}\n    angle: 20\n"),
    "parts in a second document": ("state.yaml", f"{STATE}---\n  p1:\n    angle: 90.0\n"),
    "parts in flow style": ("more.yaml", "{p1: {slot: storage/a1}}\n"),
    "a header of somebody else's": ("more.yaml", "apiVersion: v1\nkind: Pod\np1: {slot: storage/a1}\n"),
    "a recipe with components": (
        "more.yaml", "apiVersion: pico/v1\nkind: Recipe\nmetadata: {name: r}\ncomponents: {p1: {slot: storage/a1}}\n"
    ),
    "a recipe with parts": ("more.yaml", "apiVersion: pico/v1\nkind: Recipe\np1: {slot: storage/a1}\n"),
}  # fmt: skip


@pytest.mark.parametrize("path,text", HEADLESS.values(), ids=HEADLESS)
def test_parts_without_the_header_of_a_state_are_not_passed_over(path: str, text: str) -> None:
    files = {"lab.yaml": LAB, "state.yaml": STATE, path: text}
    (said,) = load_files({name: content.encode() for name, content in files.items()}).diagnostics
    assert (said.severity, said.source and said.source.path) == ("error", path)
    assert "LabState" in said.hint


def test_the_yaml_of_other_programs_may_name_what_a_part_is_called() -> None:
    other = "p1: a word\nservices: {p1: {image: postgres}}\n"
    files = {"lab.yaml": LAB, "state.yaml": STATE, "other.yaml": other}
    assert not load_files({name: content.encode() for name, content in files.items()}).diagnostics
