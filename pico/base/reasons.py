"""Why a value is unknown or not assured: the closed list of reason codes."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Literal

ReasonCode = Literal[
    "over-range", "under-range", "no-number", "garbled", "instrument-error", "saturated", "stale", "wavelength",
    "out-of-limits", "not-homed", "moving", "no-answer", "not-computed", "cut-trace",
]  # fmt: skip
"""Why a value is unknown, or not assured: the closed list that `REASONS` explains."""
REASONS: Mapping[ReasonCode, str] = MappingProxyType(
    {
        "over-range": "the instrument reports that its input is above its range",
        "under-range": "the instrument reports that its input is below its range",
        "no-number": "the instrument reports that it has no number (NaN)",
        "garbled": "the reply does not have the form that the instrument's manual gives",
        "instrument-error": "the error queue of the instrument was not empty after the reading",
        "saturated": "the converter of the instrument was at full scale",
        "stale": "the instrument repeated an earlier frame or answer",
        "wavelength": "the instrument is not set to the wavelength of the light",
        "out-of-limits": "the number lies outside the `limits` of the device",
        "not-homed": "the axis has no zero: it must be homed first",
        "moving": "the device is between two of its positions",
        "no-answer": "the instrument did not answer in time, or its link was lost",
        "not-computed": "the kernels find no such number in what was measured",
        "cut-trace": "the model did not follow the light to its end, and the rest of it may come to the detector",
    }
)
"""What each reason code means."""
