"""Lasers whose label says less than their power: rules of a lab read the label."""

from __future__ import annotations

from collections.abc import Iterator

from pico.diagnostics import Diagnostic, warning
from pico.manifest.load import Manifests
from pico.model.arming import CLASSES
from pico.optics.audit.lasers import laser_class

LABEL = "laser_class"
"""The parameter of a source that says its class (IEC 60825-1)."""


def check_labels(read: Manifests) -> Iterator[Diagnostic]:
    """Yield a warning for each laser that may emit more than the class on its label allows."""
    setup, _ = read.require()
    for name in sorted(setup.lab.inventory):
        kind = setup.type_of(name)
        stated = kind.parameters.get(LABEL)
        if kind.optics.element != "source" or stated is None or stated.value not in CLASSES:
            continue
        found, power = laser_class(setup, name, {})
        if CLASSES.index(found) > CLASSES.index(str(stated.value)):
            yield warning(
                "laser-label", f"{name} is labelled class {stated.value}, and its {power:.3g} mW are class {found}",
                hint=f"write `{LABEL}: \"{found}\"` among the parameters of {name}: rules of the lab may read it",
                source=read.source(f"inventory.{name}"), address=name,
            )  # fmt: skip
