"""The table by sight from the command line: scan, find, drift, apply, import, with errors in the cameras."""

from __future__ import annotations

import re
from pathlib import Path

import cv2
import pytest
from bench_at import bench_at
from commanding import Pico, edit

from pico.backends.sim.store import load_world, save_world
from pico.manifest.load import load_folder

ERRORS = "{camera_position: 0.2, camera_rotation: 0.05, focal_length: 0.005, marker_height: 0.05}"


@pytest.fixture
def seeing(shel: Path) -> Path:
    """The example observed by sight, by cameras of fewer pixels that are not quite where the lab has them."""
    text = (shel / "lab.yaml").read_text().replace("pixels: [2448, 2048]", "pixels: [1632, 1365]")
    text = text.replace("sim:\n", f"sim:\n  observe: sight\n  errors: {ERRORS}\n", 1)
    (shel / "lab.yaml").write_text(text)
    return shel


@pytest.mark.slow
def test_what_was_pushed_or_taken_is_seen_told_and_repaired(seeing: Path, pico: Pico) -> None:
    assert pico("apply", "--auto-approve").code == 0
    assert "No drift" in pico("drift").out
    pico("sim", "nudge", "p2", "--dx", "6", "--dyaw", "4")
    pico("sim", "remove", "lx_100")
    parts = pico("look", "--json").data["components"]
    assert parts["p2"]["pose"]["x"] == pytest.approx(526, abs=0.15) and parts["p2"]["how"] == "stereo"
    assert parts["p2"]["pose"]["yaw"] == pytest.approx(4, abs=0.1)
    assert parts["lx_100"]["presence"] == "missing"
    told = pico("drift")
    assert re.search(r"~ p2 +moved [56]\.?\d* mm \(dx \+[56].*turned \+[34]", told.out)
    assert "lx_100  nobody sees it; it belongs in storage/a1" in told.out
    assert "only you can put right: lx_100" in told.out
    assert "p2" in pico("apply", "--auto-approve").out
    after = pico("look", "--json").data["components"]
    assert after["p2"]["pose"]["x"] == pytest.approx(520, abs=0.15)
    pico("sim", "nudge", "lx_100")
    assert pico("apply", "--auto-approve").code == 0
    assert "No drift" in pico("drift").out


def test_a_scan_lists_every_part_and_draws_them(seeing: Path, pico: Pico) -> None:
    answer = pico("look", "--picture", "seen.png")
    assert answer.code == 0 and "9 parts found" in answer.out
    assert re.search(r"lx_100 +1\d\d\.\d\d +3\d\d\.\d\d .* mm .* stereo +storage/a1", answer.out)
    assert cv2.imread(str(seeing / "seen.png")).shape[1] == 1224


def test_a_part_is_found_by_hole_slot_and_uncertainty(seeing: Path, pico: Pico) -> None:
    answer = pico("look", "p2", "--picture", "p2.png")
    assert answer.code == 0
    assert re.search(
        r"p2 stands at \(.*\), .* hole \d+,\d+; in storage/b2; seen now ± 0\.0\d mm, .* by stereo", answer.out
    )
    assert (seeing / "p2.png").exists()
    pico("sim", "remove", "p2")
    answer = pico("look", "p2")
    assert answer.code == 1 and answer.out == "Nobody sees p2.\n" and "its place is in plain view" in answer.err


@pytest.mark.slow
def test_cameras_that_moved_stop_everything(seeing: Path, pico: Pico) -> None:
    pico("sim", "bump", "left", "--dx", "5")
    for words in (["plan"], ["apply", "--auto-approve"], ["capture"], ["drift"], ["status"]):
        answer = pico(*words)
        assert answer.code == 1 and "camera `left` has moved" in answer.err and "pico calibrate" in answer.err
    answer = pico("look")
    assert answer.code == 1 and "left has moved" in answer.out


def test_black_pictures_stop_everything(seeing: Path, pico: Pico) -> None:
    edit(seeing / "lab.yaml", "marker_height: 0.05", "lost_frames: 1.0")
    for words in (["apply", "--auto-approve"], ["look"]):
        answer = pico(*words)
        assert answer.code == 1 and "the picture of camera `left` is black" in answer.err


def forgotten(root: Path, *names: str) -> None:
    """Take parts out of the manifests; they stay on the table."""
    setup, _ = load_folder(root).require()
    save_world(bench_at(root), load_world(setup, bench_at(root))[0])
    for path in (root / "lab.yaml", root / "state" / "table.yaml"):
        text = path.read_text()
        for name in names:
            text = re.sub(rf"(?m)^  {name}:.*\n(?:    .*\n)+", "", text)
        path.write_text(text)


@pytest.mark.slow
def test_what_stands_there_is_imported_and_nothing_is_left_to_do(seeing: Path, pico: Pico) -> None:
    assert pico("apply", "--auto-approve").code == 0
    forgotten(seeing, "p2", "lx_100")
    assert pico("bench", "update", "--auto-approve").code == 0
    before, state = (seeing / "lab.yaml").read_text(), (seeing / "state" / "table.yaml").read_text()
    refused = pico("import")
    assert refused.code == 1 and "--types 3=TYPE" in refused.err and "marker 4 at (110, 310, 0°)" in refused.err
    assert (seeing / "lab.yaml").read_text() == before
    wrong = pico("import", "--types", "3=linear_polarizor,4=iris,9=iris")
    assert wrong.code == 1 and "did you mean `linear_polarizer`?" in wrong.err
    assert "is no iris" in wrong.err and "no marker 9" in wrong.err
    answer = pico("import", "--types", "3=linear_polarizer:p2,4=plano_convex_100")
    assert answer.code == 0 and "Wrote 2 parts into lab.yaml and state/table.yaml" in answer.out
    after = (seeing / "lab.yaml").read_text()
    assert after.startswith(before.rstrip("\n")), "what was there stays as it was"
    assert pico("validate").code == 0
    plan = pico("plan", "--detailed-exitcode", "--json")
    assert plan.code == 0 and plan.data["operations"] == []
    assert "Nothing to import" in pico("import").out
    (seeing / "state" / "table.yaml").write_text(state)  # as a disk leaves it that fails after the first file
    again = pico("import", "--types", "3=linear_polarizer:p2,4=plano_convex_100")
    assert again.code == 1 and "`pico capture p2`" in again.err and "`pico capture plano_convex_100_4`" in again.err
    assert pico("capture", "p2", "plano_convex_100_4").code == pico("plan", "--detailed-exitcode").code == 0
