"""Figures of a recipe: what it returns against what, read from its text before anything moves."""

from __future__ import annotations

from collections.abc import Mapping

from pico.diagnostics import did_you_mean
from pico.manifest.text.names import name_problem
from pico.manifest.text.tree import Map, Node, Scalar
from pico.recipes.reader import Reader, scalar_texts
from pico.recipes.recipe import Figure, Name, Series

KEYS = ("title", "x", "y", "series")
SERIES = ("x", "y", "sigma", "theory")
_EXAMPLE = "`figures: {shift: {x: tilt [deg], y: shift [um], series: {first lens: {x: tilts, y: shifts}}}}`"


def read_figures(reader: Reader, returned: Mapping[str, Name], node: Node | None) -> dict[str, Figure]:
    """Return the figures that a recipe declares; what is wrong with them is said."""
    if node is None:
        return {}
    if not isinstance(node, Map):
        reader.wrong(node, "type", "`figures` is a mapping of names", _EXAMPLE)
        return {}
    found = {}
    for name, (at, body) in node.entries.items():
        if problem := name_problem(name):
            reader.wrong(at, "name", f"`{name[:40]}` is no name of a figure: {problem}")
        elif not isinstance(body, Map):
            reader.wrong(body, "type", f"the figure {name} is no mapping", _EXAMPLE)
        else:
            found[name] = _figure(reader, returned, name, body)
    return found


def read_notes(reader: Reader, node: Node | None) -> tuple[str, ...]:
    """Return what is to stand on each figure."""
    texts = scalar_texts(node) if node is not None else ()
    if texts is None and node is not None:
        reader.wrong(node, "type", "`notes` is a list of texts", "`notes: [lens inferred from its catalog]`")
    return tuple(text for _, text in texts or ())


def _figure(reader: Reader, returned: Mapping[str, Name], name: str, node: Map) -> Figure:
    reader.keys(node, KEYS, f"the figure {name}")
    texts = {k: v.text for k, (_, v) in node.entries.items() if isinstance(v, Scalar)}
    for key in ("x", "y"):
        if not texts.get(key):
            reader.wrong(node.get(key) or node, "missing-key", f"the {key} axis of {name} has no name", _EXAMPLE)
    series = node.get("series")
    if not isinstance(series, Map) or not series.entries:
        text = f"the figure {name} has no series" if series is None else f"`series` of the figure {name} names no curve"
        reader.wrong(series or node, "missing-key" if series is None else "type", text, _EXAMPLE)
        entries = {}
    else:
        entries = series.entries
    curves = (_series(reader, returned, label, body) for label, (_, body) in entries.items())
    return Figure(name, texts.get("title", name), texts.get("x", ""), texts.get("y", ""), tuple(filter(None, curves)))


def _series(reader: Reader, returned: Mapping[str, Name], label: str, node: Node) -> Series | None:
    if not isinstance(node, Map):
        reader.wrong(node, "type", f"the series {label[:40]} is no mapping", "`{x: tilts, y: shifts, sigma: sigmas}`")
        return None
    reader.keys(node, SERIES, f"the series {label[:40]}")
    texts, wrong = dict[str, str](), False
    for key, (_, value) in node.entries.items():
        text = value.text if isinstance(value, Scalar) else ""
        if key in SERIES and (text not in returned or returned[text].kind not in ("number", "numbers")):
            hint = did_you_mean(text[:40], returned) or f"it returns: {', '.join(returned) or 'nothing'}"
            reader.wrong(value, "unknown-name", f"the recipe returns no numbers called `{text[:40]}`", hint)
            wrong = True
        texts[key] = text
    for key in ("x", "y"):
        if key not in texts:
            reader.wrong(node, "missing-key", f"the series {label[:40]} has no {key}", "`{x: tilts, y: shifts}`")
            wrong = True
    return None if wrong else Series(label, **{k: v for k, v in texts.items() if k in SERIES})
