"""The calibration of each bench as a file of the lab, `calibration/BENCH.json`, so that Git keeps what it was when.

A lab of before has one `calibration.json` for all benches; its simulator reads that as long as it has no file of its
own, and no other bench does.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pico.diagnostics import Diagnostic, PicoError, error, warning
from pico.disk import write_whole
from pico.model.calibration.results import ACCEPTED, AxisZero
from pico.vision.arm import ArmOffsets
from pico.vision.calibration import Calibration, calibration_from_json, digest_of

FOLDER = "calibration"
EARLIER = "calibration.json"
"""The file of labs of before: it says nothing of where it came from, and counts as simulated."""
LARGEST = 4 * 1024 * 1024
CODE = "calibration-file"
_SEEN = ("intrinsics/", "extrinsics/", "arms/", "hands/")
SIMULATED = "sim"
"""The bench that reads the file of before."""


def calibration_file(root: Path, bench: str) -> Path:
    """Return where the calibration of a bench of the lab in `root` is written."""
    return root / FOLDER / f"{bench}.json"


def read_from(root: Path, bench: str) -> Path | None:
    """Return the file from which the calibration of a bench is read; None if it has none."""
    own = calibration_file(root, bench)
    if own.exists():
        return own
    return root / EARLIER if bench == SIMULATED and (root / EARLIER).exists() else None


def command(bench: str) -> str:
    """Return the command that calibrates a bench."""
    return "pico calibrate" if bench == SIMULATED else f"pico --bench {bench} calibrate"


def write_calibration(root: Path, bench: str, calibration: Calibration) -> Path:
    """Write the calibration of a bench into the lab's folder, and return the file; raises PicoError."""
    path = calibration_file(root, bench)
    path.parent.mkdir(exist_ok=True)
    write_whole(path, (json.dumps(calibration.as_json(), indent=2) + "\n").encode())
    return path


def read_calibration(root: Path, bench: str) -> Calibration | None:
    """Return the calibration of a bench of the lab in `root`, None if it has none. Raises PicoError if its file is
    something else, or holds results of evidence that the bench does not accept."""
    found = stored_calibration(root, bench)
    if found is not None and (wrong := refused(found, root, bench)):
        raise PicoError(wrong)
    return found


def stored_calibration(root: Path, bench: str) -> Calibration | None:
    """Return what `read_calibration` does, whatever its evidence."""
    path = read_from(root, bench)
    if path is None:
        return None
    try:
        if path.stat().st_size > LARGEST:
            raise ValueError("too large")
        return calibration_from_json(json.loads(path.read_text(encoding="utf-8")))
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError) as exc:
        hint = f"make it again with `{command(bench)}`, or bring it back from Git"
        text = f"{path.relative_to(root)} is no calibration: {str(exc).splitlines()[0][:200]}"
        raise PicoError(error(CODE, text, hint=hint)) from exc


def refused(found: Calibration, root: Path, bench: str) -> list[Diagnostic]:
    """Return one error for each kind of evidence that a bench does not accept in its calibration."""
    accepted, path = ACCEPTED.get(bench), read_from(root, bench)
    if accepted is None or path is None:
        return []
    others: dict[tuple[str, str], list[str]] = {}
    for step, how in found.provenance.items():
        if how.evidence != accepted:
            others.setdefault((how.evidence, how.bench), []).append(step)
    unsaid = sorted(set(results_of(found)) - found.provenance.keys())
    if unsaid and accepted != "simulated":  # what does not say where it came from counts as simulated
        others.setdefault(("simulated", "not stated"), []).extend(unsaid)
    return [
        error("calibration-evidence",
              f"{path.relative_to(root)} holds {evidence} results (bench {of}: {_few(steps)}), and the bench `{bench}` "
              f"accepts only {accepted} ones",
              hint=f"calibrate this bench itself: `{command(bench)}`")
        for (evidence, of), steps in sorted(others.items())
    ]  # fmt: skip


def results_of(found: Calibration) -> tuple[str, ...]:
    """Return the results of a calibration as its provenance names them."""
    cameras = [f"{step}/{name}" for name, camera in found.cameras.items()
               for step in (("intrinsics", "extrinsics") if camera.robot is None else ("hands",))]  # fmt: skip
    of = {"arms": found.arms, "axes": found.axes, "dark": found.dark}
    return (*cameras, *(f"{step}/{name}" for step, each in of.items() for name in each))


def other_devices(found: Calibration, serials: dict[str, str], bench: str) -> list[Diagnostic]:
    """Return one error for each device that answers with another serial number than when the calibration was made.

    `serials`: of the devices that answer now, by device.
    """
    steps: dict[tuple[str, str, str], list[str]] = {}
    for step, how in found.provenance.items():
        for device, then in how.serials.items():
            now = serials.get(device, then)
            if now != then:
                steps.setdefault((device, then, now), []).append(step)
    return [
        error("calibration-serial",
              f"the calibration ({_few(names)}) is of {device} with serial number {then}, and {now or 'none'} answers",
              hint=f"calibrate it anew: `{command(bench)} {' '.join(sorted({n.partition('/')[0] for n in names}))}`",
              address=device)
        for (device, then, now), names in sorted(steps.items())
    ]  # fmt: skip


def not_counting(root: Path, bench: str) -> tuple[Diagnostic, ...]:
    """Return a warning if the lab has only a calibration that says nothing for a bench with devices."""
    if bench == SIMULATED or bench not in ACCEPTED or not (root / EARLIER).exists():
        return ()
    if calibration_file(root, bench).exists():
        return ()
    text = f"{EARLIER} holds simulated results, and the bench `{bench}` accepts only {ACCEPTED[bench]} ones"
    return (warning("calibration-evidence", text, hint=f"calibrate this bench itself: `{command(bench)}`"),)


def known_arms(root: Path, bench: str) -> dict[str, ArmOffsets]:
    """Return how the arms are off by the calibration of a bench, none without one; raises PicoError as
    `read_calibration`."""
    found = read_calibration(root, bench)
    return {name: arm.offsets for name, arm in found.arms.items()} if found else {}


def accepted_axes(root: Path, bench: str) -> Mapping[str, AxisZero]:
    """Return direction and zero of axes by the calibration of a bench, by the address of the tunable; none without one,
    or if the bench refuses it: who sends set-points then says so."""
    try:
        found = read_calibration(root, bench)
    except PicoError:
        return {}
    return found.axes if found else {}


def accepted_arms(root: Path, bench: str) -> dict[str, ArmOffsets]:
    """Return what `known_arms` does, none if the bench refuses its calibration: who goes by it says so."""
    try:
        return known_arms(root, bench)
    except PicoError:
        return {}


def calibration_digest(root: Path, bench: str) -> str | None:
    """Return the digest of the calibration of a bench, or None; reads no more than the file."""
    data = _document(root, bench)
    return None if data is None else digest_of(data)


def made_at(root: Path, bench: str) -> str:
    """Return when the oldest of what is known of the cameras and arms of a bench was found, empty without any; reads no
    more than the file."""
    data = _document(root, bench) or {}
    results = data.get("provenance") if isinstance(data.get("provenance"), dict) else {}
    found = [str(how["at"]) for step, how in (results or {}).items()
             if step.startswith(_SEEN) and isinstance(how, dict) and how.get("at")]  # fmt: skip
    return min(found) if found else str(data.get("made_at", ""))


def _document(root: Path, bench: str) -> dict[str, Any] | None:
    path = read_from(root, bench)
    try:
        data = json.loads(path.read_text(encoding="utf-8")) if path else None
    except (OSError, ValueError, RecursionError):
        return None
    return data if isinstance(data, dict) else None


def _few(names: list[str]) -> str:
    return ", ".join(sorted(names)[:4]) + (f" and {len(names) - 4} more" if len(names) > 4 else "")
