"""Measurements of a run as a table, for notebooks, spreadsheets and pandas."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pico.bench.picturing.plots import points_of
from pico.diagnostics import PicoError, error
from pico.disk import write_whole
from pico.model.shown.html import number, table
from pico.runs.table import as_csv, columns, rows

if TYPE_CHECKING:
    import pandas

    from pico.drawing.plots.scatter import Points
    from pico.model.setup import Setup
    from pico.runs.document import RecordedRun


class Plot:
    """A plot: `print` gives it as text, a notebook shows the picture, `save` writes that as PNG."""

    def __init__(self, title: str, points: Points) -> None:
        self.title, self.points = title, points

    def __repr__(self) -> str:
        return f"<plot of {self.points.y_name} against {self.points.x_name}: {len(self.points.x)} points>"

    def __str__(self) -> str:
        from pico.drawing.plots.scatter import text

        return text(self.title, self.points)

    def _repr_png_(self) -> bytes:
        from pico.drawing.picture import png
        from pico.drawing.plots.scatter import picture

        return png(picture(self.title, self.points))

    def save(self, out: Path | str) -> None:
        """Write it as PNG; raises PicoError where that can't be."""
        write_whole(Path(out), self._repr_png_())


class Table:
    """Rows of measurements, each a mapping by column: `seq`, `t` [s], `at`, `measured`, the tunables that the run
    changed (`p1.angle`), and numbers with their sigmas (`cam.centroid.x`, `cam.centroid.x_sigma`)."""

    def __init__(self, setup: Setup, run: RecordedRun) -> None:
        self._setup, self.run = setup, run
        self.rows = rows(run.trace)
        self.title = f"{run.document.goal}, {run.document.id}"

    def __repr__(self) -> str:
        return f"<table: {len(self)} measurements, {', '.join(self.columns[4:]) or 'no numbers'}>"

    def _repr_html_(self) -> str:
        head = self.columns
        return table(f"{len(self)} measurements", head, [[number(row.get(c, "")) for c in head] for row in self])

    def __len__(self) -> int:
        return len(self.rows)

    def __iter__(self) -> Iterator[dict[str, Any]]:
        return (row.flat for row in self.rows)

    def __getitem__(self, column: str) -> list[Any]:
        """Return a column, None where a row does not have it; raises KeyError for one that no row has."""
        if column not in self.columns:
            raise KeyError(f"there is no column `{column}`; there are {', '.join(self.columns)}")
        return [row.get(column) for row in self]

    @property
    def columns(self) -> list[str]:
        """The names of the columns."""
        return columns(self.rows)

    def plot(self, x: str | None = None, y: str | None = None) -> Plot:
        """Return a plot of one column against another, which shows itself in a notebook: `y` is the first number that
        was measured where nobody says, `x` the first that the run changed between measurements. Raises
        PicoError."""
        return Plot(self.title, points_of(self._setup, self.run, x, y))

    def to_csv(self, out: Path | str | None = None) -> str:
        """Return it as CSV, and write it to `out`; raises PicoError where that can't be written."""
        text = as_csv(self.rows)
        if out is not None:
            write_whole(Path(out), text.encode())
        return text

    def to_pandas(self) -> pandas.DataFrame:
        """Return it as a DataFrame; raises PicoError without pandas."""
        try:
            import pandas
        except ImportError as exc:
            hint = "`pip install pico-lab[pandas]`; `to_csv` needs nothing"
            raise PicoError(error("extra", "pandas is not installed", hint=hint)) from exc
        return pandas.DataFrame(list(self), columns=self.columns)
