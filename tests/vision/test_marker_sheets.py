"""Printed markers have their size, their bits and their names; the PDF is read back and rasterized."""

from __future__ import annotations

import re

import cv2
import numpy as np
import pytest
from painted import setup

from pico.vision.charuco import BOARD, charuco, find_board
from pico.vision.frame import Frame
from pico.vision.markers import detect
from pico.vision.pdf import POINTS
from pico.vision.sheets import labels, marker_sheets

BENCH = setup(30)
SCALE = 6  # pixels a mm


def pages(document: bytes) -> list[tuple[float, float, bytes]]:
    boxes = [(float(a), float(b)) for a, b in re.findall(rb"/MediaBox \[0 0 ([\d.]+) ([\d.]+)\]", document)]
    streams = re.findall(rb"stream\n(.*?)\nendstream", document, re.DOTALL)
    return [(w, h, s) for (w, h), s in zip(boxes, streams, strict=True)]


def raster(width: float, height: float, stream: bytes) -> Frame:
    """Return the filled rectangles of a page as a picture."""
    k = SCALE / POINTS
    image = np.full((round(height * k), round(width * k)), 255, np.uint8)
    for found in re.finditer(rb"([\d.]+) g ([\d. ]+) re f", stream):
        x, y, w, h = (float(v) * k for v in found[2].split())
        image[round(len(image) - y - h) : round(len(image) - y), round(x) : round(x + w)] = round(float(found[1]) * 255)
    return Frame(cv2.GaussianBlur(image, (0, 0), 1.0), (0, 0), "scanner", 0.0)


@pytest.mark.parametrize(("paper", "size"), [("a4", (210, 297)), ("letter", (215.9, 279.4))])
def test_every_marker_is_printed_once_in_its_size(paper: str, size: tuple[float, float]) -> None:
    *sheets, board = pages(marker_sheets(BENCH, paper))
    assert np.allclose([board[1] / POINTS, board[0] / POINTS], size)
    printed = {}
    for width, height, stream in sheets:
        assert np.allclose([width / POINTS, height / POINTS], size)
        for marker in detect(raster(width, height, stream)).markers:
            assert marker.number not in printed
            printed[marker.number] = np.linalg.norm(marker.corners - np.roll(marker.corners, 1, axis=0), axis=1) / SCALE
    wanted = {label.number: label.size for label in labels(BENCH)}
    assert printed.keys() == wanted.keys()
    for number, edges in printed.items():
        assert np.allclose(edges, wanted[number], atol=0.15)


def test_names_and_a_bar_of_100_mm_are_on_the_sheet() -> None:
    *_, stream = pages(marker_sheets(BENCH))[0]
    assert b"(part_1  #1)" in stream and b"linear_polarizer, 24 mm" in stream
    bars = [float(w) for w in re.findall(rb"[\d.]+ [\d.]+ ([\d.]+) [\d.]+ re f", stream)]
    assert any(abs(w / POINTS - 100) < 1e-3 for w in bars)


def test_the_board_is_the_one_that_calibration_looks_for() -> None:
    seen = find_board(raster(*pages(marker_sheets(BENCH))[-1]))
    assert seen is not None and len(seen.pixels) == len(charuco(BOARD).getChessboardCorners())
    across = np.ptp(seen.pixels[:, 0]) / SCALE
    assert across == pytest.approx((BOARD.columns - 2) * BOARD.square, abs=0.1)


def test_the_table_of_objects_points_at_objects() -> None:
    document = marker_sheets(BENCH)
    start = int(re.search(rb"startxref\n(\d+)", document)[1])
    assert document[start : start + 4] == b"xref"
    for number, place in enumerate(re.findall(rb"(\d{10}) 00000 n", document), 1):
        assert document[int(place) :].startswith(b"%d 0 obj" % number)
