"""What manifests mean: YAML 1.2, units, several files, a catalog, and where each value stands."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from manifest_samples import GOOD, LAB, OWN_TYPE, STATE, USES_OWN

from pico.diagnostics import PicoError
from pico.manifest.catalog import catalog_names, load_catalog
from pico.manifest.checks.labs import touches_aperture
from pico.manifest.load import find_lab, load_files, load_folder
from pico.manifest.text.scalars import resolve
from pico.manifest.text.source import Source
from pico.manifest.text.tree import parse, plain
from pico.model.pose import Pose
from pico.model.robot import Fingers
from pico.resources import catalog_dir, labs_dir, schemas_dir


def test_a_lab_and_its_state() -> None:
    setup, state = load_files(GOOD).require()
    assert setup.lab.name == state.lab == "bench"
    assert setup.lab.title == "Two parts and a laser"
    assert setup.catalog.keys() == {"hene_laser", "linear_polarizer"}
    assert state.components["p1"].pose == Pose(290, 420, 0)
    assert state.components["p1"].values == {"angle": 90.0}
    assert state.components["p2"].slot == "storage/a2"
    assert state.components["laser"].values == {"emission": True, "shutter": "open"}
    assert state.expect[0].that == "p1.angle > 0"


def test_strings_with_units_are_converted() -> None:
    lab = LAB.replace("size: [1200, 900]", "size: [1.2 m, 90 cm]")
    state = STATE.replace("x: 290", "x: 29 cm").replace("angle: 90.0", "angle: 0.5 turn").replace("yaw: 0", "yaw: 30°")
    setup, read = load_files({"lab.yaml": lab.encode(), "state.yaml": state.encode()}).require()
    assert setup.lab.table.size == (1200, 900)
    assert read.components["p1"].pose == Pose(290, 420, 30)
    assert read.components["p1"].values["angle"] == pytest.approx(180)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1e-3", 1e-3), ("1e3", 1000.0), ("12:30:45", "12:30:45"), ("017", 17), ("0o17", 15), ("0x1f", 31),
        ("on", "on"),
        ("no", "no"), ("yes", "yes"), ("True", True), ("false", False), ("~", None), ("", None), ("null", None),
        ("2026-11-21", "2026-11-21"), ("1_000", "1_000"), (".5", 0.5), ("5.", 5.0), ("+1", 1), ("-0", 0), ("=", "="),
        ("<<", "<<"), ("1e", "1e"), ("0b1", "0b1"), ("-", "-"), (".", "."),
    ],
)  # fmt: skip
def test_plain_scalars_follow_the_core_schema_of_yaml_1_2(text: str, value: object) -> None:
    # YAML 1.2.2, section 10.3.2
    assert resolve(text) == value
    assert type(resolve(text)) is type(value)


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_every_float_is_read_as_it_was_written(number: float) -> None:
    assert resolve(repr(number)) == number


@given(st.binary(max_size=300))
@example(b"apiVersion: pico/v1\nkind: LabState\nmetadata: {lab: bench}\ncomponents: {p1: {pose: {x: 1e400, y: 0}}}")
def test_any_bytes_end_in_diagnostics(data: bytes) -> None:
    found = load_files(GOOD | {"state/table.yaml": data}).diagnostics
    assert all(d.source and d.summary for d in found)


YAML_BITS = st.sampled_from(
    ["a", "p1", ": ", "\n", "  ", "    ", "- ", "[", "]", "{", "}", ", ", "'", '"', "#", " # x", "|", ">", "&a", "*a",
     "!!str ",     "? ", "~", "1", "slot", "pose", "x", "\t", "é", "---\n", "...\n", "%YAML 1.2\n",
     "components:\n", "apiVersion: pico/v1\n", "kind: LabState\n", "\r\n"]
)  # fmt: skip


@given(st.lists(YAML_BITS, max_size=40).map("".join))
def test_any_yaml_ends_in_diagnostics(text: str) -> None:
    found = load_files(GOOD | {"state/table.yaml": text.encode()}).diagnostics
    assert all(d.source and (d.hint or d.label) for d in found)


NAMES = st.from_regex(r"[a-z][a-z0-9_]{0,6}", fullmatch=True).filter(lambda n: n not in ("slot", "pose"))
LEAVES = st.none() | st.booleans() | st.integers(-(10**9), 10**9) | st.text("abc é#:'\"\n-", max_size=8)
TREES = st.recursive(LEAVES, lambda t: st.lists(t, max_size=3) | st.dictionaries(NAMES, t, max_size=3), max_leaves=12)


@given(st.dictionaries(NAMES, TREES, min_size=1, max_size=4))
def test_json_is_yaml_and_keeps_its_values(data: dict[str, object]) -> None:
    import json

    documents, found = parse(Source("x.yaml", json.dumps(data, ensure_ascii=False, indent=1)))
    assert not found
    assert plain(documents[0].root) == data


@given(st.permutations(["laser", "p1", "p2"]), st.integers(1, 3))
def test_files_and_their_order_do_not_matter(order: list[str], split: int) -> None:
    head, body = STATE.split("components:\n")
    body, expect = body.split("expect:")
    chunks = {"laser": body.split("  p1:")[0], "p1": "  p1:" + body.split("  p1:")[1].split("  p2:")[0]}
    chunks["p2"] = "  p2:" + body.split("  p2:")[1]
    parts = [order[:split], order[split:]]
    files = {
        f"{i}.yaml": f"{head}components:\n{''.join(chunks[n] for n in p)}".encode() for i, p in enumerate(parts) if p
    }
    files["e.yaml"] = f"{head}expect:{expect}".encode()
    assert load_files(files | {"lab.yaml": LAB.encode()}).require()[1] == load_files(GOOD).require()[1]


def test_other_yaml_in_the_folder_is_left_alone(tmp_path: Path) -> None:
    for name, data in GOOD.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_bytes(data)
    (tmp_path / "environment.yaml").write_text("name: lab\ndependencies: [numpy]\n")
    (tmp_path / "recipe.yaml").write_text("apiVersion: pico/v1\nkind: Recipe\nmetadata: {name: r}\n")
    for folder in (".pico", "runs/2026", ".venv"):
        (tmp_path / folder).mkdir(parents=True)
        (tmp_path / folder / "bad.yaml").write_text("apiVersion: pico/v1\nkind: [\n")
    (tmp_path / ".hidden.yaml").write_text("[")
    assert load_folder(tmp_path).diagnostics == ()


def test_the_lab_is_found_from_any_folder_below(tmp_path: Path) -> None:
    (tmp_path / "state" / "deep").mkdir(parents=True)
    (tmp_path / "bench.yaml").write_text(LAB)
    (tmp_path / "state" / "table.yaml").write_text(STATE)
    assert find_lab(tmp_path / "state" / "deep") == tmp_path.resolve()
    assert find_lab(tmp_path / "state" / "table.yaml") == tmp_path.resolve()


def test_a_folder_without_a_lab_says_how_to_make_one(tmp_path: Path) -> None:
    with pytest.raises(PicoError) as caught:
        find_lab(tmp_path)
    assert "pico init --example minimal d" in caught.value.diagnostics[0].hint


def test_diagnostics_name_paths_from_where_the_user_stands(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "d" / "state").mkdir(parents=True)
    (tmp_path / "d" / "lab.yaml").write_text(LAB)
    (tmp_path / "d" / "state" / "table.yaml").write_text(STATE.replace("p1:", "p9:"))
    monkeypatch.chdir(tmp_path)
    assert str(load_folder(Path("d")).diagnostics[0].source) == "d/state/table.yaml:8:3"
    monkeypatch.chdir(tmp_path / "d")
    assert str(load_folder(Path()).diagnostics[0].source) == "state/table.yaml:8:3"
    assert str(load_folder(tmp_path / "d").diagnostics[0].source) == "state/table.yaml:8:3"


@pytest.mark.parametrize(
    ("address", "place"),
    [
        ("p1", "state/table.yaml:8:3"), ("p1.angle", "state/table.yaml:13:12"), ("p1.pose", "state/table.yaml:9:5"),
        ("p1.pose.x", "state/table.yaml:10:10"), ("p2.slot", "state/table.yaml:15:11"),
        ("p1.nothing", "state/table.yaml:8:3"),
        ("inventory.p1", "lab.yaml:28:3"), ("inventory.p1.home", "lab.yaml:31:11"),
        ("slots.storage/a1", "lab.yaml:13:3"),
        ("table.size", "lab.yaml:7:9"), ("laser.emission", "state/table.yaml:6:15"),
    ],
)  # fmt: skip
def test_an_address_leads_to_its_place(address: str, place: str) -> None:
    assert str(load_files(GOOD).source(address)) == place


def test_a_part_that_no_state_names_is_found_in_the_inventory() -> None:
    loaded = load_files(
        GOOD | {"state/table.yaml": STATE.replace("  p2:\n    slot: storage/a2\n    angle: 1\n", "").encode()}
    )
    assert str(loaded.source("p2")) == "lab.yaml:32:3"
    assert loaded.source("nobody") is None


def test_an_old_state_is_read_against_the_bench_as_it_is_now() -> None:
    setup, state = load_files(GOOD).require()
    old_lab = LAB.replace("beam_height: 70", "beam_height: 999")
    old = load_files({"lab.yaml": old_lab.encode(), "state/table.yaml": STATE.encode()}, setup=setup)
    assert old.require() == (setup, state)
    stranger = load_files({"s.yaml": STATE.replace("p1:", "p7:").encode()}, setup=setup)
    assert [d.code for d in stranger.diagnostics] == ["unknown-component"]


def test_a_slot_is_taken_by_the_part_whose_home_it_is() -> None:
    state = STATE.replace("  p2:\n    slot: storage/a2\n    angle: 1\n", "").replace(
        "    pose:\n      x: 290\n      y: 420\n      yaw: 0\n", "    slot: storage/a2\n"
    )
    (found,) = load_files(GOOD | {"state/table.yaml": state.encode()}).diagnostics
    assert found.summary == "p1 is put into storage/a2, the home of p2"


def test_the_catalog_reads_only_what_is_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    read: list[str] = []
    original = Path.read_bytes
    monkeypatch.setattr(Path, "read_bytes", lambda self: (read.append(self.stem), original(self))[1])
    catalog = load_catalog(["iris"])
    assert catalog.keys() == {"iris"}
    assert set(read) <= {"iris"}


def test_every_packaged_type_is_right_and_called_as_its_file() -> None:
    catalog = load_catalog()
    assert tuple(catalog) == catalog_names()
    assert all(kind.name == name for name, kind in catalog.items())


def test_a_lab_may_bring_its_own_type_but_not_one_of_the_catalog() -> None:
    files = GOOD | {"lab.yaml": USES_OWN.encode(), "own.yaml": OWN_TYPE.encode()}
    setup, _ = load_files(files).require()
    assert setup.catalog["own_lens"].tunables["mode"].choices == ("wide", "tele")
    with pytest.raises(PicoError) as caught:
        load_catalog(["iris"], {"iris": load_catalog(["iris"])["iris"]})
    assert "iris.yaml" in caught.value.diagnostics[0].detail


def test_pads_touch_the_optic_when_they_reach_down_to_it() -> None:
    kind = load_catalog(["linear_polarizer"])["linear_polarizer"]  # aperture up to 81 mm, grasped at 100 mm
    assert not touches_aperture(kind, Fingers(tip=10), 0)
    assert touches_aperture(kind, Fingers(tip=30), 0)
    assert not touches_aperture(kind, Fingers(tip=30), 90)  # the pads close beside the beam, 30 mm apart


def test_the_packaged_folders_exist() -> None:
    assert catalog_dir().is_dir()
    assert labs_dir().is_dir()
    assert schemas_dir().is_dir()


def test_loading_imports_neither_ruamel_nor_pint_nor_numpy() -> None:
    code = f"""
import sys
from pathlib import Path
from pico.manifest.load import load_folder
load_folder(Path({str(labs_dir() / "shel")!r})).require()
print([m for m in ("ruamel", "pint", "numpy", "mujoco", "pygit2", "rich") if m in sys.modules])
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
