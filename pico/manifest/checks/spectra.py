"""Whether the lines of a source's spectrum can be what they say."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from pico.diagnostics import Diagnostic, error
from pico.manifest.text.places import where, where_key
from pico.manifest.text.tree import Document
from pico.model.catalog import ComponentType, SpectralLine
from pico.model.quantities import QuantityError

_WIDEST = 0.9
"""A line may be as far from the carrier, or as wide, as this share of the frequency of that."""


def check_lines(document: Document, kind: ComponentType) -> Iterator[Diagnostic]:
    """Yield an error for each line of a type's spectrum that can't be what it says."""
    if kind.optics.lines is None:
        return
    if kind.optics.element != "source":
        text = f"`lines` are the spectrum of a source, and {kind.name} is `element: {kind.optics.element}`"
        yield error("value", text, hint="leave them out", source=where_key(document, "optics", "lines"))
        return
    if not sum(line.share for line in kind.optics.lines) > 0:
        text = "the lines of the spectrum share no power"
        hint = "expected at least one line with a `share` above 0"
        yield error("value", text, hint=hint, source=where_key(document, "optics", "lines"))
    carrier = kind.number("wavelength", "nm") or 632.8
    for number, line in enumerate(kind.optics.lines):
        yield from _line(document, number, line, carrier)


def _line(document: Document, number: int, line: SpectralLine, carrier: float) -> Iterator[Diagnostic]:
    most = _WIDEST * 1e6 / carrier  # 1/mm
    reading: tuple[tuple[str, float | str, Callable[[float], float], str], ...] = (
        ("center", line.center, line.detuning, "MHz from the parameter `wavelength`, or a wavelength, `633 nm`"),
        ("width", line.width, line.width_of, "MHz, or a width with its unit, `1.5 GHz` or `40 nm`"),
    )
    for key, given, read, hint in reading:
        at = where(document, "optics", "lines", number, key)
        try:
            found = read(carrier)
        except QuantityError as exc:
            yield error("value", f"the {key} of line {number + 1}: {exc}", hint=f"expected {hint}", source=at)
            return
        if abs(found) > most or (key == "width" and found < 0):
            text = f"the {key} of line {number + 1} is `{given}`, which can't be beside a wavelength of {carrier:g} nm"
            yield error("value", text, hint=f"expected {hint}", source=at)
            return
    if line.share < 0:
        at = where(document, "optics", "lines", number, "share")
        yield error("value", f"the share of line {number + 1} is {line.share:g}", hint="expected 0 or more", source=at)
