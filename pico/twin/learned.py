"""`twin.json` in the folder of a lab: what its twin learned from the bench. Git keeps it."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from pico.diagnostics import PicoError, error
from pico.disk import write_whole
from pico.model.record import as_json
from pico.model.setup import Setup
from pico.model.trace.learned import FORMAT, Estimate, Learned, Scatter

FILE = "twin.json"


def write_learned(folder: Path, learned: Learned) -> Path:
    """Write what a twin learned into the folder of a lab, and return the file."""
    path = folder / FILE
    write_whole(path, (json.dumps(as_json(learned, _six), indent=2) + "\n").encode())
    return path


def read_learned(folder: Path) -> Learned | None:
    """Return what the twin of the lab in a folder learned, None where nothing; raises PicoError where the file is
    something else."""
    path = folder / FILE
    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError:
        return None
    except (OSError, UnicodeDecodeError) as exc:
        raise PicoError(_broken(path, str(exc))) from exc
    try:
        return learned_from_json(json.loads(text))
    except (ValueError, KeyError, TypeError, AttributeError) as exc:
        raise PicoError(_broken(path, f"no {exc}" if isinstance(exc, KeyError) else str(exc))) from exc


def learned_from_json(data: object) -> Learned:
    """Return what `as_json` gave `data` of; raises ValueError, KeyError, TypeError or AttributeError for other data."""
    document = FORMAT.lifted(data)
    looks, noise = document.get("looks"), document.get("noise")
    return Learned(
        made_at=str(document.get("made_at", "")),
        evidence=str(document.get("evidence", "")),
        runs=tuple(str(run) for run in document.get("runs", ())),
        types={str(name): _scatter(one) for name, one in document.get("types", {}).items()},
        seatings={str(name): _scatter(one) for name, one in document.get("seatings", {}).items()},
        times={str(name): _estimate(one, least=1e-3) for name, one in document.get("times", {}).items()},
        looks=None if looks is None else _scatter(looks),
        noise=None if noise is None else _number(noise),
    )


def with_noise(setup: Setup, learned: Learned | None) -> Setup:
    """Return a lab whose simulated cameras are as noisy as its twin learned."""
    if learned is None or learned.noise is None:
        return setup
    sim = setup.lab.sim
    errors = replace(sim.errors, noise=learned.noise)
    return replace(setup, lab=replace(setup.lab, sim=replace(sim, errors=errors)))


def _scatter(data: Mapping[str, Any]) -> Scatter:
    return Scatter(**{key: _estimate(data[key]) for key in ("position", "yaw") if data.get(key) is not None})


def _estimate(data: Mapping[str, Any], least: float = 0.0) -> Estimate:
    return Estimate(
        value=_number(data["value"], least), sigma=_number(data["sigma"]), count=int(data["count"]),
        before=_number(data["before"]),
    )  # fmt: skip


def _number(value: Any, least: float = 0.0) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not least <= value < 1e6:
        raise ValueError(f"{value!r} is no number from {least:g} on")
    return float(value)


def _six(number: float) -> float:
    return round(number, 6)


def _broken(path: Path, what: str) -> Any:
    hint = "make it again with `pico calibrate twin`, or take it away: then the twin is as the lab declares it"
    return error("twin-file", f"{path} is not what a twin learned: {what}", hint=hint)
