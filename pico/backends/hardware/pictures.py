"""Pictures as cameras over a bench deliver them, made what vision takes."""

from __future__ import annotations

from typing import Any

from pico.vision.frame import Frame


def alike(frames: list[Frame], others: list[Frame]) -> bool:
    """Return whether frames are the same to the last pixel."""
    import numpy as np

    return len(frames) == len(others) and all(
        np.array_equal(a.gray, b.gray) for a, b in zip(frames, others, strict=True)
    )


def grayed(picture: Any) -> Any:
    """Return a picture (rows, columns) or (rows, columns, 3) as gray levels, uint8."""
    import numpy as np

    gray = picture.mean(axis=2) if picture.ndim == 3 else picture
    if gray.dtype == np.uint8:
        return gray
    most = np.iinfo(picture.dtype).max if np.issubdtype(picture.dtype, np.integer) else 255.0
    return np.clip(gray * (255.0 / most), 0, 255).astype(np.uint8)
