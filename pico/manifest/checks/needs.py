"""Whether what a measurement needs can be set: tunables of its component, or of the bench, with values they take."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from pico.diagnostics import Diagnostic, did_you_mean, error, warning
from pico.manifest.text.places import where
from pico.manifest.text.tree import Document
from pico.model.catalog import ComponentType, Tunable
from pico.model.setpoint import refusal

OF_THE_BENCH: Mapping[str, Tunable] = {
    "shutter": Tunable(datatype="choice", mover="electronics", choices=("closed", "open")),
    "illumination": Tunable(datatype="bool", mover="electronics"),
}
"""What lasers and lamps of a bench have, whatever else they are."""


def check_needs(document: Document, kind: ComponentType) -> Iterator[Diagnostic]:
    """Yield what is wrong with the needs of a type's measurables, each at its place in the document."""
    known = {**OF_THE_BENCH, **kind.tunables}
    for name, measurable in kind.measurables.items():
        for tunable, value in measurable.needs.items():
            at = where(document, "measurables", name, "needs", tunable)
            if tunable not in known:
                text = f"`{name}` needs `{tunable}`, which {kind.name} does not have: it counts only of other parts"
                yield warning(
                    "need", text, hint=did_you_mean(tunable, known) or f"known: {', '.join(known)}", source=at
                )
            elif why := refusal(known[tunable], value):
                text = f"`{name}` needs `{tunable}`, which {why}"
                yield error("need", text, hint="a value that it takes", source=at)
