"""A beam: a chief ray with what is Gaussian around it, its polarization, and its power.

Around the chief ray the field is a sum of waves that share one complex curvature M (`pico.optics.gaussian`):
E exp(i k (r' M r / 2 + b . r)), r (2,) in the frame (across, up), k = 2 pi / (wavelength M^2 of the beam). A plain
Gaussian is one wave with b = 0; what a tilted polarizer does is a shift of each circular part by some 100 nm, so it
makes several that interfere (`pico.optics.plane_waves`). Waves of different `group` do not interfere.
Lengths are in mm, powers in mW; |E|^2 is the power of a wave with b = 0.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from pico.optics import gaussian
from pico.optics.coherence import Spectrum
from pico.optics.gaussian import Matrix
from pico.optics.polarization import Field, Vector, carried, plane_of_incidence, product, stokes
from pico.optics.rays import Surface, cross_alone

_SAME = 1e-15  # 1/mm: shifts of waves that do not differ
_NOTHING = 1e-14
UP = np.array([0.0, 0.0, 1.0])
Amplitudes = Callable[[float], tuple[complex, complex]]


@dataclass(frozen=True, eq=False)
class Wave:
    """One wave of a beam: its complex field (3,) [sqrt(mW)], its `shift` b (2,) [1], and the group that it may
    interfere in."""

    field: Field
    shift: NDArray[np.complex128]
    group: int = 0


@dataclass(frozen=True, eq=False)
class Beam:
    """A beam at a point of its chief ray.

    `at`, `along`, `across` (3,); `curvature` M (2, 2) [1/mm]; `wavelength` in vacuum [mm], `quality` M^2; `index` of
    the medium; `path`: optical path from the source [mm]; `length`: geometrical. `unknown`: why nobody can say what its
    spot looks like, empty where one can. `ghost`: it came off a face that is not coated. `spectra`: of its groups of
    waves, in order; without, each is of one frequency.
    """

    source: str
    wavelength: float
    at: Vector
    along: Vector
    across: Vector
    curvature: Matrix
    waves: tuple[Wave, ...]
    quality: float = 1.0
    index: float = 1.0
    path: float = 0.0
    length: float = 0.0
    unknown: str = ""
    ghost: bool = False
    spectra: tuple[Spectrum, ...] = ()

    @cached_property
    def up(self) -> Vector:
        """The second transverse axis (3,)."""
        return product(self.along, self.across)

    @cached_property
    def frame(self) -> NDArray[np.float64]:
        """The transverse axes as rows (2, 3)."""
        return np.stack([self.across, self.up])

    @property
    def wave_number(self) -> float:
        """k of its Gaussian [1/mm]: of the vacuum wavelength times its quality, in the medium."""
        return 2 * math.pi * self.index / (self.wavelength * self.quality)

    @cached_property
    def of_light(self) -> tuple[float, NDArray[np.float64]]:
        """The power [mW] and the centroid (2,) [mm] from the chief ray."""
        return _moments(self)

    @property
    def power(self) -> float:
        """The power [mW]."""
        return self.of_light[0]

    @cached_property
    def widths(self) -> tuple[float, float, float]:
        """The 1/e^2 radii [mm] and the direction of the larger one, see `gaussian.widths`; of one wave."""
        return gaussian.widths(self.curvature, self.wavelength * self.quality / self.index)

    @property
    def stokes(self) -> tuple[float, float, float, float]:
        """S0 to S3 [mW] of its waves at the chief ray."""
        groups = [sum((w.field for w in self.waves if w.group == g), np.zeros(3)) for g in sorted(groups_of(self))]
        return stokes([f @ self.across for f in groups], [f @ self.up for f in groups])


def groups_of(beam: Beam) -> set[int]:
    """Return the groups that do not interfere with one another."""
    return {wave.group for wave in beam.waves}


def moments(beam: Beam) -> tuple[float, NDArray[np.float64]]:
    """Return the power [mW] and the centroid (2,) [mm] from the chief ray; worked out once for a beam."""
    return beam.of_light


def _moments(beam: Beam) -> tuple[float, NDArray[np.float64]]:
    """Return the power [mW] and the centroid (2,) [mm] from the chief ray, in closed form.

    With A = k Im M, the overlap of waves i and j is exp(-k^2 B' A^-1 B / 4), B = b_i - conj(b_j), and its first moment
    (i k / 2) A^-1 B times that.
    """
    k, inverse = beam.wave_number, gaussian.inverse(beam.wave_number * np.imag(beam.curvature))
    fields, shifts = _rows([w.field for w in beam.waves], 3), _rows([w.shift for w in beam.waves], 2)
    groups = np.array([w.group for w in beam.waves])
    apart = shifts[:, None] - shifts.conj()  # (n, n, 2)
    bent = apart @ inverse
    overlap = fields @ fields.conj().T * np.exp(-(k**2) / 4 * (bent * apart).sum(-1))
    overlap[groups[:, None] != groups] = 0.0
    total = float(overlap.real.sum())  # mW
    first = np.real(0.5j * k * (bent * overlap[..., None]).sum((0, 1)))  # mW mm
    return total, first / total if total else first


def _rows(vectors: list[NDArray[np.complex128]], size: int) -> NDArray[np.complex128]:
    """Return vectors as rows (n, size), n 0 where light is stopped."""
    return np.array(vectors, dtype=np.complex128).reshape(-1, size)


def forward(beam: Beam, distance: float) -> Beam:
    """Return a beam after a distance [mm] in its medium."""
    if distance == 0.0:
        return beam
    gouy = cmath.exp(-0.5j * gaussian.phase(beam.curvature, distance))
    back, k = gaussian.inverse(gaussian.stretch(beam.curvature, distance)), beam.wave_number
    waves = []
    for wave in beam.waves:
        turned = back @ wave.shift
        phase = gouy * cmath.exp(-0.5j * k * distance * complex(wave.shift @ turned))
        waves.append(Wave(wave.field * phase, turned, wave.group))
    return replace(
        beam, at=beam.at + distance * beam.along, curvature=gaussian.forward(beam.curvature, distance),
        waves=tuple(waves), path=beam.path + beam.index * distance, length=beam.length + distance,
    )  # fmt: skip


def beyond(beam: Beam, surface: Surface, *, reflect: bool = False, amplitudes: Amplitudes | None = None) -> Beam | None:
    """Return a beam behind a surface, or sent back by it; None where the chief ray misses it or is totally reflected.

    `amplitudes`: of s and p for the cosine of incidence; without, all passes, or is sent back as a perfect conductor
    does.
    """
    met = cross_alone(
        surface if surface.reflects == reflect else replace(surface, reflects=reflect), beam.at, beam.along
    )
    if met is None:
        return None
    came, along = forward(beam, float((met[0] - beam.at) @ beam.along)), met[1]
    normal = surface.normal - surface.curvature * (came.at - surface.vertex)
    normal = normal / np.linalg.norm(normal)
    facing = float(beam.along @ normal)
    index = beam.index if reflect else surface.after if facing >= 0 else surface.before
    s = plane_of_incidence(beam.along, normal, came.up)
    across = level(along, carried(came.across, beam.along, along, s))
    axes = np.stack([s, product(normal, s)])
    before, after = came.frame @ axes.T, np.stack([across, product(along, across)]) @ axes.T
    # a sphere of curvature c has the curvature c along any axis of its tangent plane
    bent = surface.curvature * gaussian.ONE if surface.form is None else axes @ surface.form @ axes.T
    curvature = gaussian.through(
        came.curvature, before, after, (beam.index, index), (facing, float(along @ normal)),
        bent,
    )  # fmt: skip
    back = gaussian.inverse(after).T @ before.T * (beam.index / index)
    of_s, of_p = amplitudes(abs(facing)) if amplitudes else (-1.0, 1.0) if reflect else (1.0, 1.0)
    arrives, leaves = product(s, beam.along), product(s, along)  # p on either side
    waves = tuple(
        Wave((of_s * (w.field @ s)) * s + (of_p * (w.field @ arrives)) * leaves, back @ w.shift, w.group)
        for w in came.waves
    )
    return replace(came, along=along, across=across, curvature=curvature, waves=waves, index=index)


def level(along: Vector, otherwise: Vector) -> Vector:
    """Return the level direction to the left of a beam; where it runs straight up or down, `otherwise`."""
    across = product(UP, along)
    size = float(np.linalg.norm(across))
    return across / size if size > 1e-6 else otherwise


def scaled(beam: Beam, amplitude: complex) -> Beam:
    """Return a beam with all its fields times a number."""
    return replace(beam, waves=tuple(Wave(w.field * amplitude, w.shift, w.group) for w in beam.waves))


def merged(waves: list[Wave]) -> tuple[Wave, ...]:
    """Return waves with those of one group and shift added up, without those that are only rounding."""
    found: list[Wave] = []
    for wave in waves:
        for n, known in enumerate(found):
            if known.group == wave.group and np.abs(known.shift - wave.shift).max() < _SAME:
                found[n] = replace(known, field=known.field + wave.field)
                break
        else:
            found.append(wave)
    sizes = [float(np.abs(wave.field).max()) for wave in found]
    return tuple(w for w, size in zip(found, sizes, strict=True) if size > _NOTHING * max(sizes))
