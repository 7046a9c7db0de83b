"""What is said of a tunable that a search or a survey would change, and whose value is unknown."""

from __future__ import annotations

from pico.diagnostics import Diagnostic, error
from pico.model.setup import Setup


def unknown_start(setup: Setup, address: str, code: str) -> Diagnostic:
    """Return why nothing begins with a tunable whose value is unknown, and the command that makes it known."""
    component, _, tunable = address.partition(".")
    kind = setup.type_of(component).tunables.get(tunable) if component in setup.lab.inventory else None
    if kind is not None and kind.axis is not None and kind.axis.kind == "homed":
        hint = f"`pico do {component} home {tunable}` finds it out"
    elif tunable == "exposure":
        hint = f"`pico do {component} auto_range` sets it, or `pico set {component} exposure=VALUE`"
    else:
        hint = f"`pico set {component} {tunable}=VALUE` sets it"
    text = f"the value of {address} is unknown, and it is set back to that value at the end"
    return error(code, text, hint=hint, address=address)
