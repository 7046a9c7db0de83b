"""Plots of what runs measured."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pico.diagnostics import PicoError, did_you_mean, error
from pico.runs.event_model import units_of
from pico.runs.table import FIRST, columns, rows, scanned

if TYPE_CHECKING:
    from collections.abc import Sequence

    from pico.drawing.plots.scatter import Points
    from pico.model.setup import Setup
    from pico.runs.document import RecordedRun
    from pico.runs.table import Row


def points_of(setup: Setup, run: RecordedRun, x: str | None = None, y: str | None = None) -> Points:
    """Return one column of a run's measurements against another: `y` is the first number that was measured where nobody
    says, `x` the first that the run changed between measurements, else the time. Raises PicoError where there is
    nothing to plot."""
    from pico.drawing.plots.scatter import of_columns

    found = rows(run.trace)
    units = units_of(setup) | {"t": "s"} | {key: unit for row in found for key, unit in _units(row)}
    changed = scanned(run.trace)
    numbers = [n for n in dict.fromkeys(n for row in found for n in row.numbers) if not n.endswith("_sigma")]
    y = _known(run, y, found) or next((n for n in numbers if n not in changed), next(iter(numbers), None))
    if y is None:
        raise PicoError(error("nothing", f"run {run.document.id} measured no numbers", hint="`pico runs show` tells"))
    sought = sorted({name for row in found for name in row.tunables if ".pose." not in name})
    x = _known(run, x, found) or next((n for n in (*changed, *sought) if n != y and _varies(found, n)), "t")
    flat = [row.flat for row in found]
    try:
        return of_columns(
            [one.get(x) for one in flat], [one.get(y) for one in flat], [one.get(f"{y}_sigma") for one in flat],
            (x, y), (units.get(x, ""), units.get(y, "")),
        )  # fmt: skip
    except ValueError as exc:
        raise PicoError(error("nothing", str(exc), hint=_choice(found))) from exc


def _known(run: RecordedRun, name: str | None, found: Sequence[Row]) -> str | None:
    if name is not None and name not in columns(found):
        text = f"run {run.document.id} has no column `{name}`"
        raise PicoError(error("column", text, hint=did_you_mean(name, columns(found)) or _choice(found)))
    return name


def _choice(found: Sequence[Row]) -> str:
    known = [c for c in columns(found) if c not in FIRST[2:] and not c.endswith("_sigma")]
    return f"there are: {', '.join(known)}"


def _varies(found: Sequence[Row], name: str) -> bool:
    return len({v for row in found if not isinstance(v := row.tunables.get(name), bool | str)}) > 1


def _units(row: Row) -> list[tuple[str, str]]:
    of = row.measurement
    return [(f"{of.address}.{n}" if n else of.address, unit) for n, (_, _, unit) in of.numbers.items()]
