"""Faults that `cross_bench.py` plants in PICO, and must find. Each is planted in the process of a command, after the
fork."""

from __future__ import annotations

import json
import re
import socket
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

_LOCAL = ("sim", "emulated", "hardware")


@dataclass(frozen=True)
class Plant:
    """A fault in PICO."""

    plant: Callable[[], None]
    """Patches PICO in this process."""
    pattern: str
    """What a violation by it matches."""


def _ignores_use() -> None:
    """`bench use` has no effect."""
    from pico.edge.network import meant

    meant.read_choice = lambda root: ""


def _shares_use() -> None:
    """`bench use` in one worktree counts for all."""
    from pico.edge.network import meant
    from pico.places import choice
    from pico.places.lab import lab_place

    def main(root: Path) -> Path:
        place = lab_place(root)
        return place.common.parent if place else root

    read, write = choice.read_choice, choice.write_choice
    meant.read_choice = lambda root: read(main(root))
    choice.write_choice = lambda root, word: write(main(root), word)


def _variable_selects_hardware() -> None:
    """PICO_BENCH=hardware selects the real bench."""
    from pico.edge.network import meant

    meant._by_environment = meant.named_bench


def _shares_journal() -> None:
    """The emulated bench and the simulator have one journal."""
    from pico.runs.journal import Journal

    made = Journal.__init__

    def making(self: Any, path: Path, *given: Any, **more: Any) -> None:
        made(self, Path(re.sub("/benches/emulated/", "/benches/sim/", str(path))), *given, **more)

    Journal.__init__ = making  # type: ignore[method-assign]


def _shares_folder() -> None:
    """The hardware bench keeps what it knows in the folder of the emulated one."""
    from pico.places import bench

    within = bench.folder_in
    bench.folder_in = lambda root, name: within(root, "emulated" if name == "hardware" else name)


def _recovers_any(name: str) -> Callable[[], None]:
    """Undo or resume take the last run of any bench."""

    def plant() -> None:
        from pico.bench.recovery import Recovery
        from pico.places.bench import BenchPlace
        from pico.runs.journal import Journal

        own = Recovery._memory
        plan = getattr(Recovery, name)

        def memory(self: Recovery) -> Any:
            found = own(self)
            journals = [BenchPlace(self.opened.root, one).folder / "journal.sqlite" for one in _LOCAL]
            opened = [Journal(path, looking=True) for path in journals if path.exists()]
            began = [(one.last().started_at, n) for n, one in enumerate(opened) if one.last() is not None]
            return opened[max(began)[1]] if began else found

        def planned(self: Recovery, *given: Any, **more: Any) -> Any:
            Recovery._memory = memory  # type: ignore[method-assign]
            return plan(self, *given, **more)

        setattr(Recovery, name, planned)

    return plant


def _of_all_benches(unrecorded: Any) -> Any:
    """Return a reader of the runs that no commit holds, which reads those of all benches of this machine."""
    from pico.history.lab.folder import LabFolder
    from pico.places.bench import BenchPlace

    def read(folder: Any, *given: Any) -> Any:
        found = list(unrecorded(folder, *given))
        for name in _LOCAL:
            place = BenchPlace(folder.root, name)
            if place != folder.place and (place.folder / "journal.sqlite").exists():
                found += unrecorded(LabFolder(folder.root, history=True, place=place), *given)
        return found

    return read


def _commits_all() -> None:
    """A commit takes the runs of all benches."""
    from pico.history.runs import uncommitted

    uncommitted.unrecorded = _of_all_benches(uncommitted.unrecorded)
    uncommitted._of = lambda *_: True


def _stops_all() -> None:
    """`stop` stops what goes on at any bench of this machine."""
    from pico.bench.running import stopping
    from pico.places.bench import BenchPlace

    stop = stopping.stop

    def stopping_all(place: Any, **more: Any) -> Any:
        for name in _LOCAL:
            with suppress(Exception):
                stop(BenchPlace(place.root, name), **more)
        return stop(place, **more)

    stopping.stop = stopping_all


def _plan_writes() -> None:
    """A look writes into the folder of its bench."""
    from pico.bench.plans import Plans

    observe = Plans.to_state

    def planned(self: Any, *given: Any, **more: Any) -> Any:
        found = observe(self, *given, **more)
        place = self.opened.place
        if hasattr(place, "own"):
            (place.folder / "planned.json").write_text(json.dumps(found.digest))
        return found

    Plans.to_state = planned  # type: ignore[method-assign]


def _greets_hardware(words: bytes) -> Callable[[], None]:
    """Whatever bench is meant, something is sent to the mounts of the real one."""

    def plant() -> None:
        from pico.edge.network import meant

        own = meant.meant

        def meaning(root: Path, **more: Any) -> Any:
            found = re.search(r'h1_mount.*"port": (\d+)', (root / "devices.yaml").read_text())
            if found and int(found[1]) > 1:
                with socket.create_connection(("127.0.0.1", int(found[1])), timeout=1) as link:
                    link.sendall(words)
                    link.recv(100)
            return own(root, **more)

        meant.meant = meaning

    return plant


def _bare_hints() -> None:
    """Hints leave out the flags."""
    from cli.terminal import output

    output.with_flags = lambda text, flags: text


def _run_of_any() -> None:
    """A run is found by its id, whichever bench it is of."""
    from pico.history.runs import loading

    loading.unrecorded = _of_all_benches(loading.unrecorded)


PLANTS: dict[str, Plant] = {
    "ignores-use": Plant(_ignores_use, "was changed|received"),
    "shares-use": Plant(_shares_use, "was changed|received"),
    "variable-selects-hardware": Plant(_variable_selects_hardware, "devices of hardware received"),
    "shares-journal": Plant(_shares_journal, "was changed|refers to|names"),
    "shares-folder": Plant(_shares_folder, "emulated was changed"),
    "undo-any": Plant(_recovers_any("undo_plan"), "refers to|`undo.* names"),
    "resume-any": Plant(_recovers_any("resume_plan"), "refers to|`resume.* names|was changed"),
    "commits-all": Plant(_commits_all, "a commit for"),
    "stops-all": Plant(_stops_all, "stopped a run"),
    "plan-writes": Plant(_plan_writes, "a look changed"),
    "queries-hardware": Plant(_greets_hardware(b"/1 1 get pos\n"), "devices of hardware received .*queries only"),
    "moves-hardware": Plant(_greets_hardware(b"/1 1 home\n"), "hardware.* received .*home|devices of hardware act"),
    "bare-hints": Plant(_bare_hints, "a hint of"),
    "run-of-any": Plant(_run_of_any, "accepted a run of"),
}
