"""How `.pico` is laid out: a folder for each bench, or one for all as an earlier PICO had it."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pico.base.state_files import LAYOUT
from pico.diagnostics import Diagnostic, PicoError, warning
from pico.places.lab import BENCHES, FOLDER

JOURNAL = "journal.sqlite"
UNSORTED = "unsorted"
EARLIER = "earlier"
DEVICES = ("sim", "emulated", "hardware")
ALL = ("lab.json", "lock", "dose.json")
"""Files that each bench gets: its Lab, its last token, and how much light samples had, which must not be forgotten."""
OF_RUNS = ("run", "points", "recipes")
"""What names a run, and goes with that."""
OF_SIM = ("seen.json", "hands.json")
OF_LAST = ("enrolment.json", "gate.sqlite", "unattended.json")
GONE = ("edge.json", "stop.json", "unattended.lock", "holder.json", "incoming")
"""What counts only while a process lives."""
OLD = frozenset({
    *ALL, *OF_RUNS, *OF_SIM, *OF_LAST, *DEVICES, JOURNAL, "armed", "mornings.json", "edge.json", "stop.json",
})  # fmt: skip
"""Names in `.pico` that tell of the old layout."""


@dataclass(frozen=True)
class Layout:
    """What was done with the old layout."""

    benches: tuple[str, ...] = ()
    """The benches that it was split into."""
    clearing: bool = False
    """Whether what is left of it has still to be cleared."""
    unclear: tuple[str, ...] = ()
    """The runs whose bench is unclear; they are in `UNSORTED`."""
    earlier: tuple[str, ...] = ()
    """Folders below `.pico` with what an earlier PICO wrote after the split."""
    told: bool = True
    """Whether a person was told of these."""


def read_layout(root: Path) -> Layout | None:
    """Return what was done with the old layout of the lab in `root`; None if nothing was. Raises PicoError for a file
    that can't be read."""
    return LAYOUT.read(LAYOUT.path(root / FOLDER / BENCHES), _layout)


def _layout(found: Mapping[str, Any]) -> Layout:
    return Layout(
        tuple(found["benches"]), bool(found["clearing"]), tuple(found["unclear"]), tuple(found["earlier"]),
        bool(found["told"]),
    )  # fmt: skip


def take_report(root: Path) -> tuple[Diagnostic, ...]:
    """Return, once, what a split could not sort."""
    try:
        layout = read_layout(root)
    except PicoError as exc:
        return tuple(exc.diagnostics)
    if layout is None or layout.told:
        return ()
    folder = root / FOLDER
    with suppress(PicoError):  # on a read-only disk it is told again
        write_layout(folder, layout, clearing=layout.clearing, told=True)
    found = []
    if layout.unclear:
        text = f"it is unclear on which bench these runs were: {', '.join(layout.unclear)}"
        hint = f"they are kept in {folder / UNSORTED / JOURNAL}, and no bench of this lab counts them"
        found.append(warning("unsorted-runs", text, hint=hint))
    for name in layout.earlier:
        text = f"an earlier PICO moved benches of this lab since each has a folder of its own: see {folder / name}"
        hint = "look at what stands on the table (`pico status`) before you move it, and update that PICO"
        found.append(warning("earlier-layout", text, hint=hint))
    return tuple(found)


def write_layout(folder: Path, layout: Layout, *, clearing: bool, told: bool | None = None) -> None:
    """Write down what was done with the old layout; raises PicoError."""
    document = {
        "benches": layout.benches, "clearing": clearing, "unclear": layout.unclear,
        "earlier": layout.earlier, "told": layout.told if told is None else told,
    }  # fmt: skip
    LAYOUT.write(LAYOUT.path(folder / BENCHES), document, indent=1)
