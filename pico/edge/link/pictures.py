"""A look through the cameras over a link: its pictures go by SHA-256 and are fetched one by one."""

from __future__ import annotations

import base64
import hashlib
import zlib
from collections.abc import Callable, Mapping
from typing import Any

from pico.backends.sight import Look
from pico.diagnostics import PicoError, error
from pico.edge.link import wire
from pico.model.observation import Observation
from pico.model.record import as_json
from pico.vision.calibration import calibration_from_json
from pico.vision.frame import Frame
from pico.vision.sighting import Sighting

Arrays = dict[str, bytes]


def look_as_json(look: Look) -> tuple[dict[str, Any], Arrays]:
    """Return a look as JSON, and its pictures by the SHA-256 of their bytes."""
    arrays: Arrays = {}
    frames = []
    for frame in look.frames:
        data = frame.gray.tobytes()
        name = hashlib.sha256(data).hexdigest()
        arrays[name] = data
        frames.append(
            {"camera": frame.camera, "time": frame.time, "offset": frame.offset, "shape": frame.gray.shape,
             "sha256": name}
        )  # fmt: skip
    document = {
        "observation": as_json(look.observation), "sighting": as_json(look.sighting),
        "calibration": look.calibration.as_json(), "frames": frames,
    }  # fmt: skip
    return document, arrays


def look_from_json(document: Mapping[str, Any], fetch: Callable[[str], str]) -> Look:
    """Return the look whose `look_as_json` gave `document`; `fetch` gives a picture by its SHA-256, packed."""
    import numpy as np

    frames = []
    for found in document["frames"]:
        data = unpacked(fetch(found["sha256"]))
        if hashlib.sha256(data).hexdigest() != found["sha256"]:
            raise PicoError(error("link", f"the picture of {found['camera']} came damaged"))
        gray = np.frombuffer(data, np.uint8).reshape(found["shape"])
        u, v = found["offset"]
        frames.append(Frame(gray=gray, offset=(u, v), camera=found["camera"], time=found["time"]))
    return Look(
        observation=wire.adapter(Observation).validate_python(document["observation"]),
        sighting=wire.adapter(Sighting).validate_python(document["sighting"]),
        frames=tuple(frames),
        calibration=calibration_from_json(document["calibration"]),
    )


def packed(data: bytes) -> str:
    """Return bytes as a word of JSON."""
    return base64.b64encode(zlib.compress(data, 1)).decode()


def unpacked(text: str) -> bytes:
    """Return the bytes that `packed` packed."""
    return zlib.decompress(base64.b64decode(text))
