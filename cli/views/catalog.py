"""The component types."""

from __future__ import annotations

from typing import Any

from pico.model.catalog import Catalog

from .style import columns, count, paint


def text(catalog: Catalog) -> str:
    """Return a line a type: name, title, tunables."""
    head = [paint("dim", cell) for cell in ("type", "what it is", "tunables")]
    rows = [[name, kind.title, ", ".join(["pose", *kind.tunables])] for name, kind in sorted(catalog.items())]
    hint = f"{count(len(rows), 'type')}; `pico catalog show NAME` tells all of one."
    return "\n".join([*columns([head, *rows]), "", hint])


def data(catalog: Catalog) -> dict[str, Any]:
    """Return schema `pico.catalog/v1`: `types`, each `name`, `title`, `tunables`, `measurables`."""
    types = [
        {"name": n, "title": k.title, "tunables": list(k.tunables), "measurables": list(k.measurables)}
        for n, k in sorted(catalog.items())
    ]
    return {"schema": "pico.catalog/v1", "types": types}
