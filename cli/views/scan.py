"""What the cameras see."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pico.model.observation import ObservedComponent, doubtful, slot_at
from pico.model.record import as_json
from pico.model.setup import Setup

from .style import columns, count, number, paint

if TYPE_CHECKING:
    from pico.backends.sight import Look

_HOW = {"fixed": "fixed by the lab", "gripper": "in a gripper", "": "-"}


def text(setup: Setup, look: Look) -> str:
    """Return a line a part: where it is, how surely, how it was seen; then strangers and a tally."""
    seen = look.observation
    head = [paint("dim", cell) for cell in ("part", "x", "y", "yaw", "±", "how", "where")]
    rows = [_row(setup, name, part) for name, part in seen.components.items()]
    rows += [
        [paint("yellow", name), number(t.pose.x), number(t.pose.y), "", "", "an obstacle", "not in the inventory"]
        for name, t in sorted(seen.unknown.items())
    ]
    missing = sum(part.presence == "missing" for part in seen.components.values())
    tally = [f"{count(len(seen.components) - missing, 'part')} found", f"{missing} not" if missing else ""]
    strangers = count(len(seen.unknown), "stranger") if seen.unknown else ""
    return "\n".join([*columns([head, *rows]), "", ", ".join(t for t in (*tally, strangers) if t), _cameras(look)])


def _row(setup: Setup, name: str, part: ObservedComponent) -> list[str]:
    if part.pose is None:
        return [name, "", "", "", "", "", paint("red", _unseen(part))]
    slot = slot_at(setup, part.pose) if part.presence == "seen" else part.presence
    sigma, how = part.uncertainty, _HOW.get(part.how, part.how)
    known = f"{sigma.position:.2f} mm {sigma.yaw:.2f}°" if sigma.position or sigma.yaw else ""
    known = paint("red", f"{known} uncertain") if doubtful(setup, name, part) else known
    late = f", {number(part.age, 0)} s old" if part.age else ""
    cells = [name, f"{part.pose.x:.2f}", f"{part.pose.y:.2f}", f"{part.pose.yaw:.2f}°"]
    return [*cells, known, how + late, slot or ""]


def _unseen(part: ObservedComponent) -> str:
    """Return why a component has no pose, in a word."""
    if part.is_unlooked:
        return "unknown"
    return "not seen" if part.presence == "missing" else part.presence


def _cameras(look: Look) -> str:
    moved = {drift.camera for drift in look.sighting.drift}
    names = [frame.camera for frame in look.frames]
    said = [
        f"{n} {paint('red', 'is black')}" if n in look.sighting.dark
        else f"{n} {paint('red', 'has moved')}" if n in moved
        else n
        for n in names
    ]  # fmt: skip
    datums = look.sighting.datums
    drifted = f", datums within {max(datums.values()):.2f} mm of it" if datums else ""
    made = f"calibrated {look.calibration.made_at}" if look.calibration.made_at else "not calibrated, as the lab says"
    return paint("dim", f"cameras: {', '.join(said)} ({made}{drifted})")


def data(setup: Setup, look: Look) -> dict[str, Any]:
    """Return schema `pico.scan/v1`: `components` (pose, uncertainty, age, how, slot), `unknown`, `cameras`,
    `problems`."""
    seen = look.observation
    moved = {drift.camera: as_json(drift) for drift in look.sighting.drift}
    parts = {}
    for name, part in seen.components.items():
        slot = slot_at(setup, part.pose) if part.pose and part.presence == "seen" else None
        found = {k: v for k, v in as_json(part).items() if k != "values"}
        parts[name] = {**found, "slot": slot, "uncertain": doubtful(setup, name, part)}
    cameras = {f.camera: {"black": f.camera in look.sighting.dark, "moved": moved.get(f.camera),
                          "datums_mm": look.sighting.datums.get(f.camera)} for f in look.frames}  # fmt: skip
    return {
        "schema": "pico.scan/v1",
        "lab": setup.lab.name,
        "backend": seen.backend,
        "time": seen.time,
        "observed_at": seen.observed_at,
        "calibration": look.calibration.digest if look.calibration.made_at else None,
        "cameras": cameras,
        "components": parts,
        "unknown": as_json(seen.unknown),
        "problems": as_json(seen.problems),
    }
