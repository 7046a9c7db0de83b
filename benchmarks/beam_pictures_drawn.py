"""Pictures of a beam with a defect of a camera each, and the truth by construction: `beam_pictures.py` judges by them.

Nothing here asks the kernels. A picture follows from a seed and its number alone."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Draw = np.random.Generator
CYCLE = (
    "plain", "smear", "stuck", "taps", "columns", "few pixels", "smear", "stuck", "large", "mixed",
    "dim", "smear", "edge", "tilt", "columns", "stuck", "taps", "few pixels", "saturated", "mixed",
)  # fmt: skip
"""The kinds in their order, over and over: 20 pictures have each."""
SHAPES = ((480, 640), (512, 640), (768, 1024), (1024, 1280))
PIXEL = 1 / 12
"""What the light of a pixel, which is summed over it, adds to the variances of a picture [px^2]."""
_FINE = 12.0
"""Width [px] below which the light of each pixel is summed over 8 x 8 places in it."""


@dataclass(frozen=True)
class Camera:
    """`bits`; `full_scale` and `black` [count]; `electrons` per count; `read_noise` [electrons]."""

    bits: int
    full_scale: float
    black: float
    electrons: float
    read_noise: float


@dataclass(frozen=True)
class Truth:
    """A Gaussian beam: D4sigma widths [px], the angle of the major one counter-clockwise as one sees the picture [deg],
    middle from that of the sensor [px, right and up], peak [count]. `defects`: by kind, in words."""

    major: float
    minor: float
    angle: float
    x: float
    y: float
    peak: float
    defects: dict[str, str] = field(default_factory=dict)

    @property
    def on_pixels(self) -> tuple[float, float]:
        """The second-moment widths of the noise-free picture [px]: pixels add their own variance."""
        return (self.major**2 + 16 * PIXEL) ** 0.5, (self.minor**2 + 16 * PIXEL) ** 0.5


@dataclass(frozen=True, eq=False)
class Picture:
    """One picture: `pixels` (h, w) of whole counts, its camera, and the truth."""

    number: int
    kind: str
    pixels: NDArray[np.uint16] | NDArray[np.uint8]
    camera: Camera
    truth: Truth

    def __str__(self) -> str:
        """What was drawn, in one line."""
        t, (h, w) = self.truth, self.pixels.shape
        beam = f"{t.major:.1f} x {t.minor:.1f} px at {t.angle:.0f} deg, ({t.x:.1f}, {t.y:.1f})"
        counts = f"peak {t.peak:.0f} of {self.camera.full_scale:.0f}"
        return f"{self.number} {self.kind}: {w} x {h}, {beam}, {counts}; {'; '.join(t.defects.values()) or 'no defect'}"


def draw(seed: int, number: int) -> Picture:
    """Return picture `number` of a seed."""
    rng = np.random.default_rng([seed, number])
    kind = CYCLE[number % len(CYCLE)]
    camera = _camera(rng)
    truth, shape = _beam(rng, kind, camera)
    light = _light(truth, shape)
    counts, defects = light.copy(), dict(truth.defects)
    kinds = [kind]
    if kind == "mixed":
        kinds = rng.choice(sorted(_ON_LIGHT.keys() | {"stuck"}), 2, replace=False).tolist()
    for one in kinds:
        if one in _ON_LIGHT:
            offset, defects[one] = _ON_LIGHT[one](rng, truth, camera, light)
            counts += offset
    pixels = _taken(rng, counts, light, camera)
    if "stuck" in kinds:
        defects["stuck"] = _stick(rng, pixels, truth, camera)
    full = int((pixels[light > 0.05 * truth.peak] >= camera.full_scale).sum()) if kind == "saturated" else 0
    if full:
        defects["saturated"] = f"{full} pixels of the beam full"
    return Picture(number, kind, pixels, camera, replace(truth, defects=defects))


def _camera(rng: Draw) -> Camera:
    bits = int(rng.choice([8, 10, 12, 12, 14, 16]))
    full = 2.0**bits - 1
    electrons = rng.uniform(8e3, 30e3) / full
    read = rng.uniform(2, 10)
    if bits == 8:  # whole counts are made of at least some noise, as in a camera that is built so
        read = max(read, rng.uniform(0.3, 1.5) * electrons)
    return Camera(bits, full, round(0.025 * full), electrons, read)


def _beam(rng: Draw, kind: str, camera: Camera) -> tuple[Truth, tuple[int, int]]:
    low, high = {"few pixels": (3.0, 10.0), "large": (150.0, 300.0), "dim": (20.0, 120.0)}.get(kind, (10.0, 180.0))
    major = float(np.exp(rng.uniform(np.log(low), np.log(high))))
    minor = max(major * rng.uniform(0.4, 1.0), low if kind == "few pixels" else 5.0)
    angle = rng.uniform(-90, 90)
    share = {"dim": rng.uniform(0.03, 0.08), "saturated": rng.uniform(1.1, 2.5)}.get(kind, rng.uniform(0.3, 0.85))
    roomy = [s for s in SHAPES if min(s) >= 3.3 * major] or [SHAPES[-1]]
    h, w = roomy[rng.integers(len(roomy))]
    gap = [max(0.0, n / 2 - 1.1 * major - 2) for n in (w, h)]
    x, y = (rng.uniform(-0.8, 0.8) * g for g in gap)
    defects = {}
    if kind == "few pixels":
        defects["few pixels"] = f"{minor:.1f} px wide"
    elif kind == "dim":
        defects["dim"] = f"a peak of {share:.1%} of full scale"
    elif kind == "edge":
        rest = rng.uniform(0.3, 1.1)
        side = rng.integers(4)
        away = rest * major
        x, y = ((w / 2 - away, y), (away - w / 2, y), (x, h / 2 - away), (x, away - h / 2))[side]
        defects["edge"] = f"{rest:.2f} widths from the {('right', 'left', 'top', 'bottom')[side]} edge"
    return Truth(major, minor, angle, float(x), float(y), share * camera.full_scale, defects), (h, w)


def _light(beam: Truth, shape: tuple[int, int]) -> Array:
    """The noise-free light of the beam on each pixel [count]."""
    h, w = shape
    column, row = beam.x + (w - 1) / 2, (h - 1) / 2 - beam.y
    fine = 8 if beam.minor < _FINE else 1
    own = 0.0 if fine > 1 else PIXEL
    c, s = np.cos(np.radians(beam.angle)), np.sin(np.radians(beam.angle))
    along, across = ((d / 4) ** 2 + own for d in (beam.major, beam.minor))
    reach = int(2.2 * beam.major) + 4
    top, left = max(0, int(row) - reach), max(0, int(column) - reach)
    rows, columns = np.arange(top, min(h, int(row) + reach + 1)), np.arange(left, min(w, int(column) + reach + 1))
    places = (np.arange(fine) + 0.5) / fine - 0.5
    part = np.zeros((len(rows), len(columns)))
    for down in places:
        for right in places:
            x = (columns + right - column)[None]
            y = (row - rows - down)[:, None]
            u, v = c * x + s * y, c * y - s * x
            part += np.exp(-(u**2 / along + v**2 / across) / 2)
    light = np.zeros(shape)
    light[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1] = beam.peak * part / fine**2
    return light


def _taken(rng: Draw, counts: Array, light: Array, camera: Camera) -> NDArray[np.uint16] | NDArray[np.uint8]:
    """The picture of light and offsets [count]: only light has shot noise."""
    electrons = rng.poisson(light * camera.electrons) + rng.normal(0, camera.read_noise, light.shape)
    read = np.rint(electrons / camera.electrons + (counts - light) + camera.black)
    return np.clip(read, 0, camera.full_scale).astype(np.uint8 if camera.bits == 8 else np.uint16)


Offset = Callable[[Draw, Truth, Camera, Array], tuple[Array, str]]


def _smear(rng: Draw, beam: Truth, camera: Camera, light: Array) -> tuple[Array, str]:
    share = rng.uniform(0.001, 0.03)
    profile = light.sum(axis=0)
    streak = share * beam.peak * profile / profile.max()
    noise = rng.poisson(np.broadcast_to(streak * camera.electrons, light.shape)) / camera.electrons
    return noise.astype(float), f"smear of {share:.2%} of the peak"


def _taps(rng: Draw, beam: Truth, camera: Camera, light: Array) -> tuple[Array, str]:
    h, w = light.shape
    step = rng.uniform(0.001, 0.01) * camera.full_scale * rng.choice([-1, 1])
    offset = np.zeros(light.shape)
    offset[:, w // 2 :] += step
    if four := rng.random() < 0.4:
        offset[h // 2 :] += step * rng.uniform(-1, 1)
    return offset, f"{4 if four else 2} taps {step:+.1f} counts apart"


def _columns(rng: Draw, beam: Truth, camera: Camera, light: Array) -> tuple[Array, str]:
    spread = rng.uniform(0.0005, 0.004) * camera.full_scale
    return np.broadcast_to(rng.normal(0, spread, light.shape[1]), light.shape), f"columns {spread:.2f} counts apart"


def _tilt(rng: Draw, beam: Truth, camera: Camera, light: Array) -> tuple[Array, str]:
    h, w = light.shape
    size = rng.uniform(0.002, 0.02) * camera.full_scale
    turn = rng.uniform(0, 2 * np.pi)
    rise = np.cos(turn) * np.linspace(0, 1, w)[None] + np.sin(turn) * np.linspace(0, 1, h)[:, None]
    return size * rise, f"a background that rises by {size:.1f} counts"


_ON_LIGHT: dict[str, Offset] = {"smear": _smear, "taps": _taps, "columns": _columns, "tilt": _tilt}


def _stick(rng: Draw, pixels: NDArray[np.uint16] | NDArray[np.uint8], beam: Truth, camera: Camera) -> str:
    """Stick 1 to 50 pixels, one in five in the beam if it is broad; what they are, in words."""
    h, w = pixels.shape
    count, inside = int(rng.integers(1, 51)), 0
    for _ in range(count):
        row, column = int(rng.integers(h)), int(rng.integers(w))
        if beam.minor > 20 and rng.random() < 0.2:
            inside += 1
            row = int(np.clip((h - 1) / 2 - beam.y + rng.normal(0, beam.minor / 4), 0, h - 1))
            column = int(np.clip((w - 1) / 2 + beam.x + rng.normal(0, beam.minor / 4), 0, w - 1))
        level = (camera.full_scale, camera.full_scale * rng.uniform(0.3, 1.0), 0.0)[
            int(rng.choice(3, p=[0.5, 0.3, 0.2]))
        ]
        pixels[row, column] = round(level)
    return f"{count} stuck pixels, {inside} of them in the beam"
