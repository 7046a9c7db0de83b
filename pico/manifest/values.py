"""The value of one tunable, read from its node: converted, in range, one of its choices."""

from __future__ import annotations

import math

from pico.diagnostics import Diagnostic, did_you_mean, error
from pico.manifest.text.source import Source
from pico.manifest.text.tree import Node, Scalar, plain
from pico.manifest.wording import expected_quantity, quantity, shown
from pico.model.catalog import Tunable
from pico.model.quantities import Value
from pico.model.setpoint import canonical

_YES = {
    "on": "true",
    "yes": "true",
    "off": "false",
    "no": "false",
    "y": "true",
    "n": "false",
    "1": "true",
    "0": "false",
}


def read_value(source: Source, component: str, name: str, kind: Tunable, node: Node) -> Value | Diagnostic:
    """Return the value of tunable `name` in the unit that its type declares, or what is wrong with it. An angle that is
    equivalent to one in range is read as that one."""
    value = node.value if isinstance(node, Scalar) else plain(node)
    if kind.datatype == "float":
        number = read_number(source, component, name, kind.unit, node)
        if isinstance(number, Diagnostic):
            return number
        number = canonical(kind, number)
        if kind.range is None or kind.range[0] <= number <= kind.range[1]:
            return number
        return _out_of_range(source, component, name, kind, node, number)
    if kind.datatype == "bool":
        return value if isinstance(value, bool) else _not_bool(source, component, name, node)
    if isinstance(node, Scalar) and node.text in kind.choices:
        return node.text
    text = shown(value)
    near = did_you_mean(str(value)[:40], kind.choices)
    listed = "expected one of " + ", ".join(f"`{c}`" for c in kind.choices)
    hint = near if near.startswith("did") else ""
    return _wrong(source, node, "choice", f"{name} of {component} is {text}", listed, hint, f"{component}.{name}")


def read_number(source: Source, component: str, name: str, unit: str, node: Node) -> float | Diagnostic:
    """Return a node as a finite number in `unit`, or what is wrong with it."""
    value = node.value if isinstance(node, Scalar) else plain(node)
    if (type(value) is float or type(value) is int) and math.isfinite(value):
        return float(value)
    number, code, summary = quantity(f"{name} of {component}", value, unit)
    if number is not None:
        return number
    return _wrong(source, node, code, summary, expected_quantity(unit), "", f"{component}.{name}")


def _out_of_range(source: Source, component: str, name: str, kind: Tunable, node: Node, number: float) -> Diagnostic:
    unit = f" {kind.unit}" if kind.unit else ""
    assert kind.range
    label = f"expected {kind.range[0]:g} to {kind.range[1]:g}{unit}"
    summary = f"{name} of {component} is out of range: {number:.6g}{unit}"
    return _wrong(source, node, "range", summary, label, "", f"{component}.{name}")


def _not_bool(source: Source, component: str, name: str, node: Node) -> Diagnostic:
    text = node.text if isinstance(node, Scalar) else ""
    meant = _YES.get(text.lower())
    label = f"did you mean `{meant}`?" if meant else "expected `true` or `false`"
    if text in ("true", "false"):
        text, label = f'"{text}"', f"expected {text} without quotes"
        return _wrong(
            source, node, "type", f"{name} of {component} is the text {text}", label, "", f"{component}.{name}"
        )
    summary = f"{name} of {component} is {shown(plain(node))}, not `true` or `false`"
    return _wrong(source, node, "type", summary, label, "", f"{component}.{name}")


def _wrong(source: Source, node: Node, code: str, summary: str, label: str, hint: str, address: str) -> Diagnostic:
    where = source.range(node.start, node.end)
    return error(code, summary, label=label, hint=hint, address=address, source=where)
