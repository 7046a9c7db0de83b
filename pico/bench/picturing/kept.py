"""What the operations of a run kept beside it, as pictures: what cameras and spectrometers saw, how searches went.

As documents, one of each: `pico.still/v1`, `pico.curve/v1`, `pico.search/v1`; see docs/reference/json.md.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

from pico.backends.measured import Reading
from pico.bench.picturing.searches import search_of
from pico.content.arrays import load_array
from pico.content.store import store_of
from pico.diagnostics import PicoError, did_you_mean, error
from pico.edge.network.remotes import Far
from pico.model.goal import goal_from_json
from pico.model.measurement import ArrayRef, Measurement, measurement_from_json
from pico.model.setup import Setup
from pico.runs.document import RecordedRun
from pico.runs.operations import OperationRun, operations

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from pico.drawing.picture import Image
    from pico.history.lab.folder import LabFolder

MARKED = ("centroid", "d4sigma")
"""Kernels of a camera's own measurables that are marked on its pictures."""
LONGEST = 4096
"""Channels of a curve at most: of more the brightest of several in a row is told."""
Document = dict[str, Any]


@dataclass(frozen=True)
class Kept:
    """An `array` that an operation kept: of a `measurement`, or (None) what was tried for the goal of which the journal
    says so much `about` it, with the goal itself as `what`."""

    operation: OperationRun
    array: ArrayRef
    measurement: Measurement | None = None
    about: Mapping[str, Any] | None = None
    what: Any = None

    @property
    def title(self) -> str:
        """`cam.image`, or the goal that was sought."""
        return self.measurement.address if self.measurement else str((self.about or {}).get("goal", ""))

    @property
    def name(self) -> str:
        """What a file of it is called, without an ending: no two of a run are called so."""
        op = self.operation
        of = "".join(c if c.isalnum() or c in "._=" else "-" for c in self.title).strip("-.")
        return "-".join(filter(None, (op.run[-6:], op.id, f"{op.attempt}" if op.attempt > 1 else "", of)))


def kept(run: RecordedRun, of: Collection[str] = ()) -> tuple[Kept, ...]:
    """Return what a run kept, in the order in which it came about; `of`: of operations by their ids, or by the
    beginnings of the SHA-256 of their arrays. Raises PicoError where there is nothing, or no such operation."""
    found = tuple(one for op in operations(run.trace) for one in _of(op))
    if not found:
        text = f"run {run.document.id} kept no pictures, and sought no goal"
        raise PicoError(error("nothing", text, hint="`pico runs show` tells what it measured"))
    for word in of:
        if not any(_is(one, word) for one in found):
            ids = list(dict.fromkeys(one.operation.id for one in found))
            hint = did_you_mean(word[:40], ids) or f"there are: {', '.join(ids[:12])}"
            raise PicoError(error("nothing", f"no operation {word[:40]!r} of {run.document.id} kept any", hint=hint))
    return tuple(one for one in found if not of or any(_is(one, word) for word in of))


def _is(one: Kept, word: str) -> bool:
    return word == one.operation.id or (len(word) >= 8 and one.array.sha256.startswith(word))


def _of(op: OperationRun) -> Iterator[Kept]:
    try:
        if isinstance(measured := op.data.get("measurement"), Mapping):
            found = measurement_from_json(measured)
            if found.array is not None:
                yield Kept(op, found.array, found)
        stages, before = op.data.get("stages") or (), op.arguments.get("first") or ()
        for about, arguments in (*zip(stages, before, strict=False), (op.data, op.arguments)):
            if isinstance(points := about.get("points"), Mapping):
                array = ArrayRef(**{**points, "shape": tuple(points["shape"])})
                yield Kept(op, array, about=about, what=arguments.get("what"))
    except (KeyError, TypeError, ValueError, AttributeError):
        return  # written by another program


def fetched(folder: LabFolder, found: Iterable[Kept]) -> None:
    """Have the arrays here that are at the edge of a bench on the network; one that is not to be had stays away."""
    if not isinstance(folder.place, Far):
        return
    from pico.edge.network.arrays import bring
    from pico.edge.network.line import line_to

    for one in found:
        with suppress(PicoError):
            bring(folder.place, line_to(folder.place), [one.array.sha256])


def absent(folder: LabFolder, found: Iterable[Kept]) -> frozenset[str]:
    """Return the SHA-256 of arrays that are not here."""
    store = store_of(folder.root)
    return frozenset(one.array.sha256 for one in found if not store.has(one.array.sha256))


def drawn(folder: LabFolder, one: Kept) -> Drawn:
    """Return what draws what was kept; raises PicoError where the array is not here, or is no picture."""
    array, setup = load_array(store_of(folder.root), one.array), folder.setup
    if one.measurement is None:
        name = one.title
        try:
            return search_of(setup, name, goal_from_json(one.what), one.about or {}, array)
        except (TypeError, ValueError) as exc:  # written by another program
            raise PicoError(error("run-file", f"what was sought as {name} can't be read")) from exc
    if array.ndim == 2 and array.shape[0] > 1:
        return Still(setup, one.measurement, array)
    if array.ndim in (1, 2) and array.size:
        return Curve(one.measurement, array.reshape(-1))
    shape = " x ".join(map(str, array.shape))
    raise PicoError(error("picture", f"{one.title} is {shape} numbers, which is no picture"))


def document(one: Kept, found: Drawn, wide: int) -> Document:
    """Return what was kept as data, and of which operation; a picture is `wide` pixels across at most."""
    op = one.operation
    return {
        **found.data(wide), "operation": op.id, "attempt": op.attempt, **({"run": op.run} if op.run else {}),
        "sha256": one.array.sha256,
    }  # fmt: skip


class Drawn(Protocol):
    """Something that is drawn."""

    def data(self, wide: int) -> Document:
        """Return it as data, a picture `wide` pixels across at most."""
        ...

    def picture(self) -> Image:
        """Return it as a picture (height, width, 3), sRGB."""
        ...


@dataclass(frozen=True, eq=False)
class Still:
    """What a camera saw (height, width) [count]."""

    setup: Setup
    measurement: Measurement
    array: NDArray[Any]

    def data(self, wide: int) -> Document:
        """Return schema `pico.still/v1`, with what the camera's kernels mark on it."""
        from pico.edge.link.stills import still

        m = self.measurement
        saturated = m.not_assured.get("not saturated", "")
        reading = Reading(None, self.array, settings=m.settings, saturated=saturated)
        return {**still(m.component, m.measurable, reading, self._rows(), wide), "at": m.at}

    def picture(self) -> Image:
        return as_picture(self.array, self.measurement)

    def _rows(self) -> dict[str, str]:
        """Return the kernels whose numbers are marked, by name: those by which it was measured, and the camera's."""
        from pico.kernels.pipeline import parsed

        m = self.measurement
        known = self.setup.measurables_of(m.component) if m.component in self.setup.lab.inventory else {}
        rows = {name: one.kernel for name, one in known.items() if one.kernel}
        own = {m.measurable: m.kernel} if m.kernel else {}
        marked = {n: row for n, row in rows.items() if parsed(row).steps[-1].name in MARKED and not own}
        return {n: row for n, row in (own | marked).items() if own or parsed(row).source == m.measurable}


@dataclass(frozen=True, eq=False)
class Curve:
    """What a spectrometer saw, a number a channel."""

    measurement: Measurement
    counts: NDArray[Any]

    def data(self, wide: int) -> Document:
        """Return schema `pico.curve/v1`, of many channels the brightest of several in a row."""
        import numpy as np

        m, by = self.measurement, -(-len(self.counts) // LONGEST)
        padded = np.pad(self.counts.astype(np.float64), (0, -len(self.counts) % by), mode="edge").reshape(-1, by)
        first, step, unit = self._axis()
        x = [round(first + step * by * n, 6) for n in range(len(padded))]
        return {
            "schema": "pico.curve/v1", "component": m.component, "measurable": m.measurable, "at": m.at,
            "settings": dict(m.settings), "x": {"name": "wavelength" if unit else "channel", "unit": unit},
            "y": {"name": m.address, "unit": m.unit},
            "points": [{"x": a, "y": b} for a, b in zip(x, padded.max(axis=1).tolist(), strict=True)],
        }  # fmt: skip

    def picture(self) -> Image:
        from pico.drawing.plots import scatter

        said = self.data(0)
        x, y = (tuple(p[axis] for p in said["points"]) for axis in ("x", "y"))
        sigma = (None,) * len(x)
        names = said["x"]["name"], said["y"]["name"], said["x"]["unit"], said["y"]["unit"]
        return scatter.picture(self.measurement.address, scatter.Points(x, y, sigma, *names))

    def _axis(self) -> tuple[float, float, str]:
        """Return where the first channel is, how far apart they are, and in which unit; by their numbers where the
        settings do not tell wavelengths."""
        first, step = (self.measurement.settings.get(name) for name in ("first", "step"))
        if isinstance(first, int | float) and isinstance(step, int | float):
            return float(first), float(step), "nm"
        return 0.0, 1.0, ""


def as_picture(array: NDArray[Any], measurement: Measurement) -> Image:
    """Return what a camera saw (height, width) [count] as a picture (height, width, 3), its brightest pixel white, its
    black level black."""
    import numpy as np

    seen = array.astype(np.float64) - float(measurement.settings.get("black_level", 0.0))
    grey = np.clip(255 * seen / max(1.0, float(seen.max())), 0, 255).astype(np.uint8)
    return np.repeat(grey[:, :, None], 3, axis=2)
