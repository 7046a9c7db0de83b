"""Sheets of markers to print and stick on: those of the inventory, the datums, the calibration board. mm."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from pico.model.setup import Setup
from pico.vision.charuco import BOARD, Board
from pico.vision.markers import CELLS, cells
from pico.vision.pdf import PAPERS, Page, pdf

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

_EDGE, _GAP, _LABEL = 12.0, 4.0, 8.0  # around the sheet, between stickers, under each for words
_HEAD, _FOOT = 10.0, 14.0
_BAR = 100.0


@dataclass(frozen=True)
class Label:
    """A marker to print: its number, the edge of its black square [mm], what it belongs to, and of what type."""

    number: int
    size: float
    name: str
    kind: str

    @property
    def edge(self) -> float:
        """The edge of the sticker [mm], with a white cell around the black square."""
        return self.size * (CELLS + 2) / CELLS


def labels(setup: Setup) -> list[Label]:
    """Return the markers that a lab uses: of its parts by name, then its datums."""
    found = []
    for name, part in sorted(setup.lab.inventory.items()):
        plate = setup.type_of(name).geometry.marker
        if part.marker is not None and plate is not None:
            found.append(Label(part.marker, plate.size, name, part.type))
    for name, datum in sorted(setup.lab.datums.items()):
        found.append(Label(datum.marker, datum.size, f"datum {name}", f"at ({datum.x:g}, {datum.y:g})"))
    return found


def marker_sheets(setup: Setup, paper: str = "a4", board: Board = BOARD) -> bytes:
    """Return a PDF with the markers of a lab, each with its name, number and size, and the calibration board.

    `paper`: `a4` or `letter`. Every page has a bar of 100 mm to check the scale by.
    """
    found = labels(setup)
    pages = _pages(found, PAPERS[paper], setup.lab.name) if found else []
    return pdf([*pages, _board_page(board, PAPERS[paper])], f"markers of {setup.lab.name}")


def _pages(found: list[Label], paper: tuple[float, float], lab: str) -> list[Page]:
    """Lay the stickers out in rows from the upper left."""
    width, height = paper
    pages: list[Page] = []
    x, top, row = _EDGE, 0.0, 0.0
    for label in found:
        if pages and x + label.edge > width - _EDGE:
            x, top, row = _EDGE, top - row - _LABEL - _GAP, 0.0
        if not pages or top - label.edge - _LABEL < _EDGE + _FOOT:
            pages.append(_page(paper, f"PICO markers of {lab}, page {len(pages) + 1}"))
            x, top, row = _EDGE, height - _EDGE - _HEAD, 0.0
        _sticker(pages[-1], label, x, top - label.edge)
        x, row = x + max(label.edge, 26.0) + _GAP, max(row, label.edge)
    return pages


def _page(paper: tuple[float, float], title: str) -> Page:
    page = Page(*paper)
    page.text(_EDGE, paper[1] - _EDGE, f"{title}. Print at 100 %, not fitted to the page.", size=3.2)
    page.rectangle(_EDGE, _EDGE, _BAR, 1.0)
    for mark in range(0, 101, 10):
        page.rectangle(_EDGE + mark - (0.1 if mark else 0), _EDGE, 0.2, 2.5)
    page.text(_EDGE, _EDGE + 4, "This bar is 100 mm long. If yours is not, the markers have the wrong size.", size=2.6)
    return page


def _sticker(page: Page, label: Label, x: float, y: float) -> None:
    """Draw a marker whose sticker has its lower left corner at (x, y): squares, cut line, words below."""
    edge, cell = label.edge, label.size / CELLS
    _squares(page, cells(label.number)[1:-1, 1:-1], x + cell, y + cell, cell)
    corners = ((x, y), (x + edge, y), (x + edge, y + edge), (x, y + edge))
    for (x0, y0), (x1, y1) in zip(corners, corners[1:] + corners[:1], strict=True):
        page.line(x0, y0, x1, y1)
    page.text(x, y - 3.2, f"{label.name}  #{label.number}", size=2.4)
    page.text(x, y - 6.0, f"{label.kind}, {label.size:g} mm", size=1.9, gray=0.3)


def _squares(page: Page, bits: NDArray[np.float64], x: float, y: float, cell: float) -> None:
    """Draw the black cells, runs of them in a row as one rectangle, so that no printer leaves hairlines in between."""
    rows = len(bits)
    for i, row in enumerate(bits):
        start = None
        for j, white in enumerate([*row, 1.0]):
            if white < 0.5 and start is None:
                start = j
            elif white > 0.5 and start is not None:
                page.rectangle(x + start * cell, y + (rows - 1 - i) * cell, (j - start) * cell, cell)
                start = None


def _board_page(board: Board, paper: tuple[float, float]) -> Page:
    """The calibration board on a page across."""
    height, width = paper
    page = _page((width, height), f"PICO calibration board, squares of {board.square:g} mm, glue it to something flat")
    x, y = (width - board.size[0]) / 2, (height - board.size[1]) / 2 + 2
    inset, number = (board.square - board.marker) / 2, board.first
    for row in range(board.rows):
        for column in range(board.columns):
            left, bottom = x + column * board.square, y + (board.rows - 1 - row) * board.square
            if (row + column) % 2 == 0:
                page.rectangle(left, bottom, board.square, board.square)
                continue
            _squares(page, cells(number)[1:-1, 1:-1], left + inset, bottom + inset, board.marker / CELLS)
            number += 1
    return page
