"""The brightest pixel above black. Of many that are alike it is the luckiest, so it reads high by some of its noise."""

from __future__ import annotations

import math
from collections.abc import Mapping

from pico.kernels.frame import Frame
from pico.kernels.kernel import Declaration, Result

KERNEL = Declaration(version="2", takes="image", units={"peak": "count"})


def apply(given: Frame, parameters: Mapping[str, float]) -> Result:
    """Return it [count]."""
    if why := given.refusal:
        return Result(unknown=why)
    top = float(given.signal.max())
    return Result({"peak": top}, {"peak": math.sqrt(max(top, 0.0) / given.electrons_per_count + given.dark_variance)})
