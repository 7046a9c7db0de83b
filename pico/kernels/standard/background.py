"""A picture without its background: a tilted plane, fitted to where the beam is not, becomes the dark frame."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from pico.kernels.frame import Frame
from pico.kernels.kernel import Declaration, Result

KERNEL = Declaration(version="2", takes="image")


def apply(given: Frame, parameters: Mapping[str, float]) -> Frame | Result:
    """Return the frame with a `dark` that has the background's plane in it. Its pixels stay as they were read, for a
    saturated one must still be told."""
    import numpy as np

    from pico.kernels.spot import spot

    beam = spot(given)
    if isinstance(beam, str):
        return Result(unknown=beam)
    black = np.float32(given.black_level) if given.dark is None else given.dark.astype(np.float32)
    return replace(given, dark=beam.behind() + black)
