"""The benches of this machine that a lab has, with what each holds: runs that no commit has, and the last run."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

from pico.backends.devices import EMULATED, HARDWARE, shipped
from pico.base.clock import Waits
from pico.base.state_files import WORLD
from pico.diagnostics import Diagnostic, PicoError, error, warning
from pico.edge.network.opening import holder_of, remembered
from pico.edge.network.remotes import Place
from pico.edge.protocol import Holder
from pico.history.lab.folder import LabFolder
from pico.history.runs.uncommitted import is_awaited, unrecorded
from pico.model.record import record
from pico.places.bench import BenchPlace, local_benches
from pico.places.lab import lab_place
from pico.places.record import read_record


@record
class BenchState:
    """What a bench of this machine holds."""

    bench: str
    """Its name, such as `sim`."""
    pending: int = 0
    """The number of runs that moved something and that no commit has yet, as far as this worktree carries them."""
    last: str | None = None
    """The id of the last run, None before the first."""
    began: str | None = None
    """When that began, as ISO 8601."""
    attached: str | None = None
    """The folder of the lab in the worktree that is attached to the bench; None if none is."""
    here: bool = False
    """Whether that is this worktree."""
    holder: Holder | None = None
    """Who moves it now."""
    waits: Waits = ()
    """When a simulated bench was told to let time pass, and how long [s]."""


def bench_states(root: Path) -> tuple[BenchState, ...]:
    """Return the benches of this machine that the lab in `root` has or may have, those that come with PICO first."""
    lab = lab_place(root)
    recorded = read_record(lab).get(lab.inside, {}) if lab else {}
    used = [place.name for place in local_benches(root)]
    names = dict.fromkeys([*sorted(shipped(), key=_order), *sorted(used), *sorted(recorded)])
    return tuple(bench_state(BenchPlace(root, name)) for name in names if name)


def bench_state(place: BenchPlace) -> BenchState:
    """Return what a bench of this machine holds; of a journal that can't be read, nothing."""
    lab = lab_place(place.root)
    there = place.attached
    used = there.folder.is_dir()
    last, pending = None, 0
    with suppress(PicoError):
        with remembered(place) as memory:
            last = memory.last() if memory else None
        if last is not None:
            folder = LabFolder(place.root, history=True, place=place)
            pending = sum(is_awaited(run.document) for run in unrecorded(folder))
    return BenchState(
        bench=place.name, pending=pending, last=last.run if last else None, began=last.started_at if last else None,
        attached=str(there.root) if used else None, here=used and there.root in (place.root, lab and lab.root),
        holder=holder_of(place), waits=_waits(place),
    )  # fmt: skip


def _waits(place: BenchPlace) -> Waits:
    """Return the waits of a simulated bench; none of another one, or of one that can't be read."""
    with suppress(PicoError, ValueError, TypeError):
        found = WORLD.read(WORLD.path(place.folder), lambda data: data.get("waits", ()))
        return tuple((str(at), float(seconds)) for at, seconds in found or ())
    return ()


def other_benches(place: Place | None, root: Path) -> tuple[BenchPlace, ...]:
    """Return the benches of this machine that the lab in `root` has, but for `place`."""
    mine, lab = place.title if place is not None else "", lab_place(root)
    here = [one.name for one in local_benches(root)]
    recorded = read_record(lab).get(lab.inside, {}) if lab else {}  # also those that other worktrees have
    return tuple(BenchPlace(root, name) for name in dict.fromkeys([*here, *sorted(recorded)]) if name and name != mine)


def refuse_of_another(place: Place | None, word: str, command: str) -> None:
    """Raise PicoError if a word that names no run of the bench `place` is, begins or ends the id of a run of another
    bench of this machine, naming both; `command`: what to call there."""
    if place is None or not word:
        return
    for other in other_benches(place, place.root):
        with suppress(PicoError), remembered(other) as memory:
            found = [one.run for one in memory.runs() if fits(word, one.run)] if memory else []
            if not found:
                continue
            text = f"run {found[-1]} was on the bench `{other.name}`, and this command means `{place.title}`"
            wrong = error("other-bench", text, hint=f"`pico --bench {other.name} {command}` reaches it")
            break
    else:
        return
    raise PicoError(wrong)


def fits(word: str, run: str) -> bool:
    """Return whether a word is, begins or ends the id of a run."""
    return run.startswith(word) or run.endswith(f"-{word}")


def later_elsewhere(place: Place) -> str:
    """Return the bench of this machine whose last run began after that of the bench `place`, empty if none did."""
    last = {one.name: _last(one) for one in other_benches(place, place.root)}
    with suppress(PicoError), remembered(place) as memory:
        mine = memory.last() if memory else None
        later = {name: at for name, at in last.items() if at and at >= (mine.started_at if mine else "")}
        return max(later, key=lambda name: later[name]) if later else ""
    return ""


def _last(place: BenchPlace) -> str:
    with suppress(PicoError), remembered(place) as memory:
        last = memory.last() if memory else None
        return last.started_at if last else ""
    return ""


def pending_elsewhere(place: Place) -> tuple[Diagnostic, ...]:
    """Return, in one note, how many runs of other benches of this machine no commit has; none if there are none."""
    states = [bench_state(one) for one in other_benches(place, place.root)]
    left = [(one.bench, one.pending) for one in states if one.pending]
    if not left:
        return ()
    said = ", ".join(f"{n} run{'s' if n > 1 else ''} on {name}" for name, n in left)
    total = sum(n for _, n in left)
    hint = f"`pico --bench {left[0][0]} commit` takes {'it' if total == 1 else 'those of that bench'}"
    return (Diagnostic("note", "other-benches", f"{said} stay{'s' if total == 1 else ''} uncommitted", hint=hint),)


def require_usable(place: Place) -> tuple[Diagnostic, ...]:
    """Return what is worth knowing before a worktree chooses a bench: a real one whose lab describes no devices."""
    if not isinstance(place, BenchPlace) or place.name not in (HARDWARE, EMULATED):
        return ()
    from pico.manifest.checks.required_version import require_satisfied
    from pico.manifest.load import load_folder

    found = load_folder(place.root)
    require_satisfied(found.diagnostics)
    setup = found.setup
    if setup is None or setup.wiring is not None:
        return ()
    hint = 'a file with `kind: Devices` names a driver and an address for each: see "Running a real bench" in the docs'
    text = f"this lab has no devices file, so `{place.name}` can move nothing yet"
    return (warning("no-devices", text, hint=hint),)


def _order(name: str) -> tuple[int, str]:
    known = ("sim", EMULATED, HARDWARE)
    return (known.index(name) if name in known else len(known), name)
