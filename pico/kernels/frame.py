"""What kernels take and give."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class Frame:
    """A picture with what is known of the camera that took it.

    `pixels` (h, w), any real type, row 0 at the top [count]; `pixel_size` [um]; `exposure` [ms]; `gain` [dB];
    `full_scale` and `black_level` [count]; `electrons_per_count` at that gain; `read_noise` [electrons]. `full`: how
    many pixels could tell no more; `flat`: the background is subtracted already, and with it the black level.

    In results x runs to the right in the picture and y up, from the middle of the sensor [um].
    """

    pixels: NDArray[Any]
    pixel_size: float = 1.0
    exposure: float = 1.0
    gain: float = 0.0
    full_scale: float = 4095.0
    black_level: float = 0.0
    electrons_per_count: float = 1.0
    read_noise: float = 0.0
    full: int | None = None
    flat: bool = False

    @property
    def saturated(self) -> int:
        """How many pixels read full scale."""
        return int((self.pixels >= self.full_scale).sum()) if self.full is None else self.full


@dataclass(frozen=True)
class Result:
    """What a kernel found: numbers by name, one standard deviation of each, and their units. `unknown`: why there are
    none, or none that could be believed."""

    values: Mapping[str, float] = field(default_factory=dict)
    sigma: Mapping[str, float] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)
    unknown: str = ""


def spoilt(frame: Frame) -> Result | None:
    """Return that nothing can be said of a saturated frame; None where it is not."""
    full = frame.saturated
    if not full:
        return None
    return Result(unknown=f"{full} of {frame.pixels.size} pixels read {frame.full_scale:g}")
