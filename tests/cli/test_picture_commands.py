"""Pictures, lengths and films from the command line, and what is said where there can be none."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path

import cv2
import pytest
from commanding import Pico, edit

PNG = b"\x89PNG"


def test_manifest_revision_and_bench_are_three_pictures(shel: Path, pico: Pico) -> None:
    edit(shel / "state" / "table.yaml", "  p2:\n    pose:\n      x: 520", "  p2:\n    pose:\n      x: 700")
    for words in (["live.png"], ["manifest.png", "--manifest"], ["e1.png", "e1"]):
        answer = pico("render", *words[1:], "--view", "top", "--size", "480x360", "--out", words[0])
        assert answer.code == 0, answer.err
    found = [(shel / name).read_bytes() for name in ("live.png", "manifest.png", "e1.png")]
    assert all(content.startswith(PNG) for content in found)
    assert len(set(found)) == 3
    assert cv2.imread(str(shel / "live.png")).shape == (360, 480, 3)


def test_a_drawing_is_xml_with_every_part(shel: Path, pico: Pico) -> None:
    assert pico("render", "e1", "--out", "bench.svg").code == 0
    root = ET.fromstring((shel / "bench.svg").read_text())
    assert {"lx_125", "p2", "cam"} <= {element.get("id") for element in root.iter()}


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--out", "bench.bmp"], "neither a .png nor a .svg"), (["--size", "9"], "1920x1440"),
        (["e1", "--manifest"], "leave one of them out"), (["--plan", "--out", "a.svg"], "pico plan --picture"),
    ],
)  # fmt: skip
def test_what_cannot_be_drawn_is_refused(shel: Path, pico: Pico, words: list[str], said: str) -> None:
    answer = pico("render", *words)
    assert answer.code == 1
    assert said in " ".join(answer.err.split())


def test_a_ruler_answers_in_columns_as_json_and_as_picture(shel: Path, pico: Pico) -> None:
    answer = pico("ruler", "laser", "cam", "--picture", "r.png")
    assert answer.code == 0
    assert "nearest faces" in answer.out and "along the axis of laser" in answer.out
    assert (shel / "r.png").read_bytes().startswith(PNG)
    found = pico("ruler", "laser:base", "cam:base", "--json").data
    assert found["schema"] == "pico.ruler/v1"
    assert found["centers"]["dx"] == pytest.approx(940)
    both = pico("ruler", "lasr", "hole:0,0")
    assert both.code == 1 and "2 errors" in both.err and "laser" in both.err


def test_a_difference_is_drawn(shel: Path, pico: Pico) -> None:
    answer = pico("diff", "C3", "e1", "--picture", "d.png")
    assert answer.code == 0 and "Drew the difference to d.png" in answer.out
    assert (shel / "d.png").read_bytes().startswith(PNG)


def test_a_film_that_cannot_be_written_is_refused_before_anything_moves(shel: Path, pico: Pico) -> None:
    answer = pico("apply", "e1", "--auto-approve", "--record", "film.avi")
    assert answer.code == 1 and "film.mp4" in answer.err
    assert not (shel / "film.avi").exists()


@pytest.mark.slow
@pytest.mark.parametrize("fidelity", ["kinematic", "physics"])
def test_an_apply_is_filmed_and_ends_as_without_a_film(shel: Path, pico: Pico, fidelity: str) -> None:
    answer = pico("apply", "C2", "--fidelity", fidelity, "--auto-approve", "--record", "run.gif")
    assert answer.code == 0, answer.err
    assert "Filmed" in answer.out and "The bench equals C2" in answer.out
    film, count = cv2.VideoCapture(str(shel / "run.gif")), 0
    while film.read()[0]:
        count += 1
    assert count > 60


def test_without_a_display_the_viewer_says_what_to_do(shel: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.platform", "linux")
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    answer = pico("sim", "view")
    assert answer.code == 1 and "no display" in answer.err and "pico render" in answer.err
