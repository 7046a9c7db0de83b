"""The numbers that the run of a survey gave: of each shot, by name, with their standard deviations."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pico.diagnosis.quantities import Got, Quantity, Shot, quantity

if TYPE_CHECKING:
    from pico.model.measurement import Measurement
    from pico.model.trace.event import Event
    from pico.model.trace.report import RunReport

NOT_ASKED = "that would shut a laser which nobody lets emit again"
"""Why a frame in the dark is not taken."""
Numbers = Mapping[str, tuple[float, float]]
DARK = ".dark"
"""How the address of a frame in the dark ends."""


@dataclass(frozen=True)
class Readings:
    """What was read: `numbers` by the keys of shots, and of others why they are `unknown`; `cut_short`: whether the
    survey was, or its run did not come to its end."""

    numbers: Mapping[str, Numbers]
    unknown: Mapping[str, str]
    cut_short: bool

    def dark(self, wanted: Quantity) -> bool:
        """Return whether a quantity was not read for want of light."""
        from pico.kernels.start import is_dark

        return is_dark(self.why(wanted))

    def got(self, wanted: Quantity) -> Got | None:
        """Return a quantity as it was read; None where it was not."""
        known = [self.numbers.get(shot.key, {}).get(wanted.number) for shot in wanted.shots]
        found = [one for one in known if one is not None]
        return quantity(wanted, found) if len(found) == len(known) else None

    def why(self, wanted: Quantity) -> str:
        """Return why a quantity was not read."""
        return next((self.unknown[s.key] for s in wanted.shots if s.key in self.unknown), "")


def readings_of(
    root: Path, shots: Sequence[Shot], dark: Sequence[str], report: RunReport, events: Sequence[Event],
    steady: Mapping[str, float],
) -> Readings:  # fmt: skip
    """Return what a run gave of `shots`, and of frames in the `dark` of cameras, whose addresses these are. `steady`:
    by component the share by which an instrument is always wrong, which is no noise."""
    from pico.model.measurement import measurement_from_json

    found: dict[str, Numbers] = {}
    unknown = dict.fromkeys((Shot(address).key for address in dark), NOT_ASKED)
    taken: list[Mapping[str, Any]] = next(
        (e.data["shots"] for e in events if e.kind == "operation_done" and "shots" in e.data), []
    )
    for shot, one in zip(shots, taken, strict=False):
        if "measurable" in one:
            measured = measurement_from_json(one)
            found[shot.key] = _numbers(root, measured, steady.get(shot.address.partition(".")[0], 0.0))
            if measured.unknown:
                unknown[shot.key] = measured.unknown
        else:
            unknown[shot.key] = str(one.get("unknown", ""))
    for address, measurement in report.measurements.items():
        if address.endswith(DARK):
            found[Shot(address).key] = _numbers(root, measurement, 0.0)
    whole = len(taken) == len(shots) and report.outcome == "done"
    return Readings(found, unknown, not whole)


def _numbers(root: Path, found: Measurement, steady: float) -> Numbers:
    """Return the numbers of a measurement by name."""
    if found.measurable == "dark" and found.array is not None:
        return _dark(root, found)
    if isinstance(found.value, Mapping):
        sigma = found.sigma if isinstance(found.sigma, Mapping) else {}
        given = {n: float(v) for n, v in found.value.items() if isinstance(v, int | float)}
        own = {n: (v, float(sigma.get(n, 0.0))) for n, v in given.items()}
        if given.get("major", 0.0) > 0 and given.get("minor", 0.0) > 0:
            size = math.sqrt(given["major"] * given["minor"])
            own["size"] = (size, size * own["major"][1] / own["major"][0])
        return own
    if isinstance(found.value, int | float) and not isinstance(found.value, bool):
        sigma_of = 0.0 if found.sigma is None or isinstance(found.sigma, Mapping) else float(found.sigma)
        noise = sigma_of**2 - (steady * found.value) ** 2
        return {found.measurable: (float(found.value), math.sqrt(noise) if noise > 0 else sigma_of)}
    return {}


def _dark(root: Path, found: Measurement) -> Numbers:
    """Return the mean and the spread of a frame in the dark, without its hot pixels [counts]."""
    import numpy as np

    from pico.content.arrays import load_array
    from pico.content.store import store_of

    assert found.array is not None
    counts = load_array(store_of(root), found.array).astype(np.float64).ravel()
    middle = float(np.median(counts))
    usual = counts[np.abs(counts - middle) <= 8 * max(1.0, float(np.median(np.abs(counts - middle))))]
    spread, many = float(usual.std()), max(1, usual.size)
    mean = (float(usual.mean()), math.hypot(0.01, spread / math.sqrt(many)))
    return {"mean": mean, "spread": (spread, 0.002 * spread)}
