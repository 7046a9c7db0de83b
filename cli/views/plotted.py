"""A plot of what a run measured."""

from __future__ import annotations

from typing import Any

from pico.drawing.plots import scatter


def text(title: str, points: scatter.Points) -> str:
    """Return the plot as lines."""
    return scatter.text(title, points)


def data(title: str, points: scatter.Points) -> dict[str, Any]:
    """Return its points, schema `pico.plotted/v1`."""
    axes = {
        axis: {"name": name, "unit": unit}
        for axis, name, unit in (("x", points.x_name, points.x_unit), ("y", points.y_name, points.y_unit))
    }
    found = [{"x": x, "y": y, "sigma": s} for x, y, s in zip(points.x, points.y, points.sigma, strict=True)]
    return {"schema": "pico.plotted/v1", "title": title, **axes, "points": found}
