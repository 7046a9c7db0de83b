"""All component types on one page of HTML that needs nothing else: a drawing of each, and what is to be known of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape
from typing import Any

from pico.model.catalog import ComponentType, Measurable, Parameter, Tunable

from .style import count, number

GROUPS = {
    "Sources": ("source",), "Mirrors": ("mirror", "roof_mirror", "retroreflector", "parabola", "prism", "grating"),
    "Lenses": ("lens", "expander"),
    "Polarization": ("polarizer", "waveplate", "isolator", "wollaston"),
    "Beam splitters": ("beam_splitter", "plate_splitter"),
    "Apertures and filters": (
        "iris", "slit", "spatial_filter", "filter", "bandpass", "shutter", "block",
    ),
    "Detectors": ("detector",),
}  # fmt: skip
"""Headings with the optical elements below them; what else there is comes last."""
_STYLE = """
body { font: 15px/1.45 system-ui, sans-serif; margin: 2em auto; max-width: 72em; padding: 0 1em; color: #222831 }
section { display: grid; grid-template-columns: repeat(auto-fill, minmax(21em, 1fr)); gap: 1.2em }
article { border: 1px solid #ced2da; border-radius: 6px; padding: 0 1em 1em; overflow: hidden }
article img { display: block; width: calc(100% + 2em); margin: 0 -1em }
h3 { font: 600 1em ui-monospace, monospace; margin: .8em 0 0 } p { margin: .3em 0 }
table { border-collapse: collapse; font-size: .87em; width: 100% } td { padding: .1em .4em .1em 0; vertical-align: top }
td:first-child { font-family: ui-monospace, monospace; white-space: nowrap } td + td { color: #4b5563 }
caption { text-align: left; font-weight: 600; padding-top: .6em } .how { color: #4b5563; font-size: .87em }
"""


def page(title: str, catalog: Mapping[str, ComponentType], pictures: Mapping[str, str]) -> str:
    """Return the page; `pictures`: of each type, as text that an `img` shows."""
    left, body = dict(sorted(catalog.items())), []
    for heading, elements in GROUPS.items():
        mine = [name for name, kind in left.items() if kind.optics.element in elements]
        body += _section(heading, {name: left.pop(name) for name in mine}, pictures)
    body += _section("Other", left, pictures)
    head = ["<!doctype html>", "<html lang=en>", "<meta charset=utf-8>", f"<title>{escape(title)}</title>"]
    style = [f"<style>{_STYLE}</style>", f"<h1>{escape(title)}</h1>", f"<p>{count(len(catalog), 'type')}.</p>"]
    return "\n".join([*head, *style, *body, "</html>", ""])


def _section(heading: str, kinds: Mapping[str, ComponentType], pictures: Mapping[str, str]) -> list[str]:
    if not kinds:
        return []
    cards = [_card(name, kind, pictures[name]) for name, kind in kinds.items()]
    return [f"<h2>{escape(heading)}</h2>", "<section>", *cards, "</section>"]


def _card(name: str, kind: ComponentType, picture: str) -> str:
    tables = [
        _table("Parameters", [(n, _parameter(p), p.description) for n, p in kind.parameters.items()]),
        _table("Tunables", [(n, _domain(t), t.description or t.mover) for n, t in kind.tunables.items()]),
        _table("Measurables", [(n, m.unit, _made(m)) for n, m in kind.measurables.items()]),
    ]
    return (
        f'<article id="{escape(name)}"><img src="{picture}" alt="{escape(kind.title)}">\n<h3>{escape(name)}</h3>'
        f"<p>{escape(kind.title)}</p><p>{escape(kind.description)}</p>{''.join(tables)}"
        f"<p class=how>{escape(_how(kind))}</p></article>"
    )


def _table(caption: str, rows: Sequence[tuple[str, str, str]]) -> str:
    lines = ["".join(f"<td>{escape(cell)}</td>" for cell in row) for row in rows]
    return f"<table><caption>{caption}</caption>{''.join(f'<tr>{line}</tr>' for line in lines)}</table>" if rows else ""


def _parameter(parameter: Parameter) -> str:
    return f"{_plain(parameter.value)} {parameter.unit}".strip()


def _plain(value: Any) -> str:
    return number(value, 6) if isinstance(value, int | float) and not isinstance(value, bool) else str(value).lower()


def _domain(tunable: Tunable) -> str:
    if tunable.range is not None:
        return f"{number(tunable.range[0], 6)} to {number(tunable.range[1], 6)} {tunable.unit}".strip()
    return (
        ", ".join(tunable.choices) if tunable.choices else "on or off" if tunable.datatype == "bool" else tunable.unit
    )


def _made(measurable: Measurable) -> str:
    return measurable.description or measurable.kernel or measurable.datatype


def _how(kind: ComponentType) -> str:
    """Return how it is moved, and what it does to light."""
    grasp = kind.geometry.grasp
    held = "An arm moves it" if kind.pose.mover == "arm" and grasp and kind.seating != "bolted" else "It is fixed"
    if held.startswith("An") and grasp:
        yaws = " or ".join(f"{number(yaw)}°" for yaw in grasp.yaws)
        held = f"{held}: held {number(grasp.height)} mm above the table, {number(grasp.width)} mm wide, from {yaws}"
    light = f"light: {kind.optics.element}" if kind.optics.element != "none" else "nothing for light"
    return f"{held}; {number(kind.geometry.height)} mm high, {number(kind.geometry.mass, 3)} kg; {light}."


def text(path: str, *, types: int) -> str:
    """Return where the page is."""
    return f"Wrote {path}: {count(types, 'type')}. Open it in a browser."


def data(path: str, *, types: int) -> dict[str, Any]:
    """Return schema `pico.catalog_page/v1`: `path`, `types`."""
    return {"schema": "pico.catalog_page/v1", "path": path, "types": types}
