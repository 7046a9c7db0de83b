"""What stands on a table and is in no inventory, taken into the manifests of its lab as the cameras see it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from pico.diagnostics import Diagnostic, PicoError, did_you_mean, error
from pico.disk import write_all
from pico.manifest.adopt import Adopted, adopt
from pico.manifest.catalog import catalog_names, packaged_type, read_type
from pico.manifest.files import read_folder
from pico.manifest.text.kinds import NAME
from pico.model.catalog import ComponentType
from pico.model.observation import Observation, slot_at
from pico.model.pose import Pose
from pico.model.record import record
from pico.vision.localize import component_pose

if TYPE_CHECKING:
    from pico.backends.sight import Look
    from pico.history.lab.folder import LabFolder
    from pico.model.setup import Setup
    from pico.vision.sighting import Stranger

_OFF = 8.0  # mm that a marker may be off the height that its type has it at


@record
class MarkerIdentity:
    """What a marker is said to be: a type, and the name that the part is to have (one is made where it is empty)."""

    type: str
    name: str = ""


@record
class Imported:
    """What an import took in, and the files that it changed, sorted."""

    parts: tuple[Adopted, ...] = ()
    files: tuple[str, ...] = ()


def read_types(texts: Sequence[str]) -> dict[int, MarkerIdentity]:
    """Return what `7=plano_convex_100,9=linear_polarizer:p3` says of markers; raises PicoError for anything else."""
    found: dict[int, MarkerIdentity] = {}
    for word in (w.strip() for text in texts for w in text.split(",") if w.strip()):
        number, _, rest = word.partition("=")
        kind, _, name = rest.partition(":")
        if not number.isdecimal() or not kind or (name and not NAME.fullmatch(name)):
            hint = "`--types 7=plano_convex_100` or `--types 7=plano_convex_100:lx_100`"
            raise PicoError(error("usage", f"`{word[:60]}` is not MARKER=TYPE nor MARKER=TYPE:NAME", hint=hint))
        if int(number) in found:
            raise PicoError(error("usage", f"marker {number} is given twice", hint="give each marker once"))
        found[int(number)] = MarkerIdentity(type=kind, name=name)
    return found


def importable(folder: LabFolder, look: Look, types: Mapping[int, MarkerIdentity]) -> tuple[Adopted, ...]:
    """Return the parts that `look` shows and the inventory lacks, as they would be taken in.

    Raises PicoError for a look that can't be trusted, and, all at once, for markers of which nobody said what they are,
    types that there are not, and parts for which there is no home.
    """
    from pico.backends.sight import require_trusted

    seen, setup = require_trusted(look.observation), folder.setup
    problems = [
        _not_there(setup, number) for number in sorted(types) if f"unknown/{number}" not in look.sighting.unknown
    ]
    parts: list[Adopted] = []
    free = _free_slots(setup, look)
    # Those that stand in a slot first, so that it becomes their home and not that of another part.
    for stranger in sorted(look.sighting.unknown.values(), key=lambda s: (slot_at(setup, s.pose) is None, s.marker)):
        try:
            parts.append(_adopted(folder, seen, stranger, types.get(stranger.marker), parts, free))
        except PicoError as exc:
            problems += exc.diagnostics
    if problems:
        raise PicoError(problems)
    return tuple(sorted(parts, key=lambda part: part.marker))


def take_in(folder: LabFolder, parts: Sequence[Adopted], write: bool = True) -> Imported:
    """Write parts into inventory and state, for the bench to adopt; raises PicoError, before anything is written, where
    that would be wrong, or where the lab's files propose something else already.

    `write`: else only find out whether it could be.
    """
    if not parts:
        return Imported()
    if folder.proposed:
        told = folder.proposed[0].summary
        raise PicoError(error("bench-lab", told, hint="adopt that first: `pico bench update`; or `git restore` it"))
    written = adopt(read_folder(folder.root)[0], parts)
    if write:
        write_all({Path(path): data for path, data in written.items()})
    return Imported(parts=tuple(parts), files=tuple(sorted(written)))


def _adopted(
    folder: LabFolder,
    seen: Observation,
    stranger: Stranger,
    wanted: MarkerIdentity | None,
    before: Sequence[Adopted],
    free: dict[str, Pose],
) -> Adopted:
    place = (
        f"marker {stranger.marker} at {Pose(round(stranger.pose.x), round(stranger.pose.y), round(stranger.pose.yaw))}"
    )
    if wanted is None:
        hint = f"say what it is: `--types {stranger.marker}=TYPE`; `pico catalog list` lists the types"
        raise PicoError(error("no-type", f"{place} is not in the inventory, and nothing says what it is", hint=hint))
    kind = _type(folder, wanted.type)
    plate = kind.geometry.marker
    if plate is None:
        raise PicoError(error("no-type", f"{place} is no {wanted.type}: that carries no marker"))
    if stranger.uncertainty.position < _OFF and abs(stranger.height - plate.at[2]) > _OFF:
        text = f"{place} is no {wanted.type}: it is {stranger.height:.0f} mm high, and that {plate.at[2]:g} mm"
        raise PicoError(error("wrong-type", text, hint="look at what it is, or at `geometry.marker` of its type"))
    step = kind.pose.resolution
    raw = component_pose(stranger.pose, plate)
    pose = Pose(_to(raw.x, step.position), _to(raw.y, step.position), _to(raw.yaw, step.yaw))
    slot = slot_at(folder.setup, raw)
    home = slot if slot in free else next(iter(sorted(free, key=lambda name: (free[name].distance(raw), name))), None)
    if home is None:
        hint = "add slots to the lab: each part needs a home of its own"
        raise PicoError(error("no-slot", f"{place}: no slot is left that could be its home", hint=hint))
    del free[home]
    name = wanted.name or _name(folder.setup, wanted.type, stranger.marker)
    if name in folder.setup.lab.inventory or name in {p.name for p in before}:
        raise PicoError(error("duplicate", f"there is a part `{name}` already", hint="give it another name"))
    at_home = slot is not None and slot == home
    return Adopted(
        name=name, type=wanted.type, marker=stranger.marker, home=home, slot=home if at_home else None,
        pose=None if at_home else pose,
    )  # fmt: skip


def _type(folder: LabFolder, name: str) -> ComponentType:
    own = {kind.name: kind for kind in _own(folder)}
    known = [*catalog_names(), *own]
    if name not in known:
        hint = did_you_mean(name, known) or "`pico catalog list` lists them"
        raise PicoError(error("unknown-type", f"there is no component type `{name}`", hint=hint))
    return own.get(name) or packaged_type(name)


def _own(folder: LabFolder) -> Iterator[ComponentType]:
    for document in folder.manifests.documents.get("ComponentType", ()):
        kind, _ = read_type(document)
        if kind is not None:
            yield kind


def _free_slots(setup: Setup, look: Look) -> dict[str, Pose]:
    """The slots that are nobody's home and in which no part of the inventory stands."""
    homes = {part.home for part in setup.lab.inventory.values()}
    standing = [part.pose for part in look.observation.components.values() if part.pose is not None]
    taken = {slot_at(setup, pose) for pose in standing}
    return {name: slot.pose for name, slot in setup.lab.slots.items() if name not in homes | taken}


def _name(setup: Setup, kind: str, marker: int) -> str:
    return f"{kind}_{marker}"


def _not_there(setup: Setup, marker: int) -> Diagnostic:
    if known := next((name for name, part in setup.lab.inventory.items() if part.marker == marker), ""):
        hint = f"`pico capture {known}` takes where it stands into the state"
        return error("no-marker", f"marker {marker} is that of {known}, which the inventory has", hint=hint)
    text = f"no marker {marker} stands on the table that the inventory lacks"
    return error("no-marker", text, hint="`pico look` lists what is seen")


def _to(value: float, step: float) -> float:
    return round(round(value / step) * step, 6) + 0.0 if step > 0 else round(value, 3)
