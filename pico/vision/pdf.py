"""A PDF with black rectangles, lines and words, to scale: all that a sheet of markers needs. mm from the lower left."""

from __future__ import annotations

from dataclasses import dataclass, field

POINTS = 72 / 25.4
"""PDF's unit, points, a mm (ISO 32000-1, 8.3.2.3)."""
PAPERS = {"a4": (210.0, 297.0), "letter": (215.9, 279.4)}
"""Width and height [mm]."""


@dataclass
class Page:
    """A page of `width` by `height` [mm]; what is drawn later lies over what was drawn before."""

    width: float
    height: float
    drawn: list[str] = field(default_factory=list)

    def rectangle(self, x: float, y: float, width: float, height: float, gray: float = 0.0) -> None:
        """Fill a rectangle from its lower left corner; `gray` 0 is black, 1 white."""
        self.drawn.append(f"{gray:g} g {_points(x, y, width, height)} re f")

    def line(self, x0: float, y0: float, x1: float, y1: float, width: float = 0.15, gray: float = 0.6) -> None:
        """Draw a line of `width` [mm]."""
        self.drawn.append(f"{gray:g} G {_points(width)} w {_points(x0, y0)} m {_points(x1, y1)} l S")

    def text(self, x: float, y: float, words: str, size: float = 2.5, gray: float = 0.0) -> None:
        """Write words in Helvetica from their lower left, letters of `size` [mm]; what it lacks becomes `?`."""
        safe = words.replace("\\", "\\\\").replace("(", "\\(").replace(")", "\\)")
        safe = safe.encode("latin-1", "replace").decode("latin-1")
        self.drawn.append(f"BT {gray:g} g /F1 {_points(size)} Tf {_points(x, y)} Td ({safe}) Tj ET")


def pdf(pages: list[Page], title: str) -> bytes:
    """Return a PDF 1.4 document. The same pages give the same bytes."""
    kids = " ".join(f"{4 + 2 * i} 0 R" for i in range(len(pages)))
    objects = [
        b"<< /Type /Catalog /Pages 2 0 R /ViewerPreferences << /PrintScaling /None >> >>",
        f"<< /Type /Pages /Kids [{kids}] /Count {len(pages)} >>".encode(),
        b"<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica /Encoding /WinAnsiEncoding >>",
    ]
    for i, page in enumerate(pages):
        box = f"/MediaBox [0 0 {_points(page.width, page.height)}]"
        font = "/Resources << /Font << /F1 3 0 R >> >>"
        objects.append(f"<< /Type /Page /Parent 2 0 R {box} {font} /Contents {5 + 2 * i} 0 R >>".encode())
        content = "\n".join(page.drawn).encode("latin-1", "replace")
        objects.append(b"<< /Length %d >>\nstream\n%b\nendstream" % (len(content), content))
    safe = title.encode("latin-1", "replace").decode("latin-1").replace("(", "").replace(")", "").replace("\\", "")
    objects.append(f"<< /Title ({safe}) >>".encode("latin-1"))
    return _file(objects)


def _file(objects: list[bytes]) -> bytes:
    """Number the objects and write the table of where each begins; the last one is the document's title."""
    out, places = b"%PDF-1.4\n", []
    for number, content in enumerate(objects, 1):
        places.append(len(out))
        out += b"%d 0 obj\n%b\nendobj\n" % (number, content)
    table = b"".join(b"%010d 00000 n \n" % place for place in places)
    count = len(objects) + 1
    trailer = b"trailer\n<< /Size %d /Root 1 0 R /Info %d 0 R >>\nstartxref\n%d\n%%%%EOF\n"
    return out + b"xref\n0 %d\n0000000000 65535 f \n%b" % (count, table) + trailer % (count, count - 1, len(out))


def _points(*millimetres: float) -> str:
    return " ".join(f"{value * POINTS:.4f}".rstrip("0").rstrip(".") for value in millimetres)
