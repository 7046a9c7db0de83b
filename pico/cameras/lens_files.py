"""Lenses that were calibrated elsewhere: `camera_info` of ROS, and matrices as OpenCV writes them, in YAML or JSON."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from pico.diagnostics import PicoError, error
from pico.vision.camera import CameraModel

LARGEST = 1024 * 1024
_MATRIX = ("camera_matrix", "cameraMatrix", "CameraMatrix", "K", "k", "mtx", "intrinsic_matrix")
_DISTORTION = (
    "distortion_coefficients", "distCoeffs", "DistortionCoefficients", "dist_coeffs", "D", "d", "dist", "distortion",
)  # fmt: skip
_WIDTH, _HEIGHT = ("image_width", "width", "imageWidth"), ("image_height", "height", "imageHeight")
_FISHEYE = ("fisheye", "equidistant", "kannala_brandt")
_PLAIN = ("", "plumb_bob", "rational_polynomial", "brown_conrady", "opencv")
LENGTHS = (0, 4, 5, 8)
"""How many coefficients a distortion may have: none, k1 k2 p1 p2, with k3, with k4 k5 k6 (rational model of OpenCV)."""


def read_lens(path: Path, camera: CameraModel) -> CameraModel:
    """Return `camera` with the lens that a file describes. Raises PicoError for a file that describes none, or that of
    another sensor size."""
    try:
        if path.stat().st_size > LARGEST:
            raise ValueError("it is too large")
        return _with_lens(camera, _document(path.read_text(encoding="utf-8")))
    except (OSError, ValueError, KeyError, TypeError, RecursionError) as exc:
        said = (
            exc.strerror if isinstance(exc, OSError) and exc.strerror else str(exc).strip("'\"").splitlines()[0][:160]
        )
        hint = "a `camera_info` of ROS, or `camera_matrix` and `distortion_coefficients` as OpenCV writes them"
        text = f"{path} describes no lens of camera `{camera.name}`: {said}"
        raise PicoError(error("lens-file", text, hint=hint, address=camera.name)) from exc


def _document(text: str) -> Mapping[str, Any]:
    """Return what a file says; the tags of OpenCV's matrices are left out."""
    import json

    import yaml

    if text.lstrip().startswith("{"):
        found = json.loads(text)
    else:
        plain = re.sub(r"\A%YAML[: ][^\n]*\n", "", text)
        if re.search(r"(?:^|[\s\[,:-])[&*]\w", plain):
            raise ValueError("it has aliases, which a lens needs none of")
        try:
            found = yaml.safe_load(re.sub(r"!!opencv-(?:matrix|nd-matrix)", "", plain))
        except yaml.YAMLError as exc:
            raise ValueError(f"it is no YAML ({str(exc).splitlines()[0]})") from exc
    if not isinstance(found, Mapping):
        raise ValueError("it is no mapping")
    return found


def _with_lens(camera: CameraModel, said: Mapping[str, Any]) -> CameraModel:
    import numpy as np

    size = tuple(int(_first(said, names)) for names in (_WIDTH, _HEIGHT)) if _has(said, _WIDTH) else None
    if size is not None and size != camera.pixels:
        was, own = (f"{w} x {h}" for w, h in (size, camera.pixels))
        raise ValueError(f"it is of pictures of {was} pixels, and the lab has {own}")
    matrix = np.array(_numbers(_first(said, _MATRIX)), np.float64)
    if matrix.size != 9:
        raise ValueError(f"its camera matrix has {matrix.size} numbers, not 9")
    matrix = matrix.reshape(3, 3)
    if not (matrix[0, 0] > 0 and matrix[1, 1] > 0 and abs(matrix[0, 1]) < 1e-6 and abs(matrix[2, 2] - 1) < 1e-9):
        raise ValueError("its camera matrix is none of a camera without skew")
    model = str(said.get("distortion_model", said.get("model", ""))).lower()
    fisheye = model in _FISHEYE
    if not fisheye and model not in _PLAIN:
        raise ValueError(f"its distortion model is `{model[:40]}`; known: {', '.join((*_PLAIN[1:], *_FISHEYE))}")
    numbers = _numbers(_first(said, _DISTORTION)) if _has(said, _DISTORTION) else []
    if fisheye and len(numbers) != 4:
        raise ValueError(f"a fisheye lens has 4 coefficients, and it has {len(numbers)}")
    if not fisheye:
        numbers = _trimmed(numbers)
    return replace(camera, matrix=matrix, distortion=np.array(numbers, np.float64), fisheye=fisheye)


def _trimmed(numbers: list[float]) -> list[float]:
    """Five or eight coefficients; longer models of OpenCV if what is beyond is zero."""
    if len(numbers) > 8 and not any(numbers[8:]):
        numbers = numbers[:8]
    if len(numbers) not in LENGTHS:
        raise ValueError(f"its distortion has {len(numbers)} coefficients; known: 4, 5, 8, and 4 of a fisheye lens")
    return numbers if len(numbers) == 8 else [*numbers, *(0.0,) * (5 - len(numbers))]


def _has(said: Mapping[str, Any], names: tuple[str, ...]) -> bool:
    return any(name in said for name in names)


def _first(said: Mapping[str, Any], names: tuple[str, ...]) -> Any:
    for name in names:
        if name in said:
            return said[name]
    raise ValueError(f"it has no `{names[0]}`")


def _numbers(said: Any) -> list[float]:
    """Return the numbers of a matrix: a mapping with `data`, or lists."""
    if isinstance(said, Mapping):
        said = said["data"]
    if not isinstance(said, list | tuple):
        raise ValueError("a matrix is a list of numbers, or has `data`")
    flat = [number for row in said for number in (_numbers(row) if isinstance(row, list | tuple) else [row])]
    if not all(isinstance(n, int | float) and not isinstance(n, bool) and math.isfinite(n) for n in flat):
        raise ValueError("a matrix holds something else than numbers")
    return [float(number) for number in flat]
