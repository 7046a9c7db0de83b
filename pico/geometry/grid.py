"""A spatial hash: which shapes may lie near a place, without looking at all of them."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Iterator, Mapping
from typing import Generic, TypeVar

from pico.geometry.shape import Shape, conflict

K = TypeVar("K", bound=Hashable)


class Grid(Generic[K]):
    """Shapes by key, in square cells of `cell` mm; a large shape lies in many cells."""

    def __init__(self, cell: float) -> None:
        self.cell = cell
        self.shapes: dict[K, Shape] = {}
        self._cells: dict[tuple[int, int], list[K]] = {}

    @classmethod
    def of(cls, shapes: Mapping[K, Shape]) -> Grid[K]:
        """Return a grid of `shapes`, with cells that suit their middle size."""
        radii = sorted(s.radius for s in shapes.values())
        grid = cls(max(1.0, 2 * radii[len(radii) // 2]) if radii else 100.0)
        for key, shape in shapes.items():
            grid.add(key, shape)
        return grid

    def _span(self, shape: Shape, margin: float) -> Iterator[tuple[int, int]]:
        reach = shape.radius + margin
        columns = range(int((shape.x - reach) // self.cell), int((shape.x + reach) // self.cell) + 1)
        rows = range(int((shape.y - reach) // self.cell), int((shape.y + reach) // self.cell) + 1)
        return ((c, r) for c in columns for r in rows)

    def add(self, key: K, shape: Shape) -> None:
        """Add a shape under a key that the grid does not have yet."""
        self.shapes[key] = shape
        for cell in self._span(shape, 0.0):
            self._cells.setdefault(cell, []).append(key)

    def near(self, shape: Shape, margin: float) -> Iterable[K]:
        """Return the keys of the shapes that may come within `margin` mm of `shape`, in the order they were added
        in a cell, each once."""
        found: dict[K, None] = {}
        for cell in self._span(shape, margin):
            for key in self._cells.get(cell, ()):
                found[key] = None
        return found

    def conflicts(self, shape: Shape, margin: float) -> list[K]:
        """Return the keys of the shapes that come nearer to `shape` than `margin` mm, or touch it."""
        return [key for key in self.near(shape, margin) if conflict(shape, self.shapes[key], margin)]
