"""How near the kernels come to the truth, and how fast: synthetic pictures of a beam, beside laserbeamsize.

    python benchmarks/kernels.py [--seeds 4] [--shape 2048 2448]

Pictures are of 12 bits, 3.66 electrons a count, 2.5 electrons of read noise, 64 counts of black. A row is a beam:
errors of its middle [px] and of its widths [%] by moments (`centroid`, `d4sigma`) and by `gaussian_fit`, each the
median over the seeds of the worse of the two, and the times of one call. `laserbeamsize` is left out where it is not
installed. Below them fringes of a visibility of 0.6 and Stokes parameters from readings with 0.5 % of noise.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "tests")]

from oracles.beam_pictures import BLACK, Beam, fringe_picture, picture, six_states, turned_plate  # noqa: E402

from pico.kernels.frame import Frame  # noqa: E402
from pico.kernels.pipeline import parsed, run  # noqa: E402

BEAMS = {
    "500": Beam(500, 500, x=30.3, y=-20.7),
    "80": Beam(80, 80, x=30.3, y=-20.7),
    "600 x 350 at 30 deg": Beam(600, 350, 30, x=30.3, y=-20.7),
    "500, dim": Beam(500, 500, peak=150, x=30.3, y=-20.7),
    "500, 10 counts of tilt": Beam(500, 500, x=30.3, y=-20.7, tilt=10),
}
Errors = tuple[float, float]
Estimator = Callable[[Frame, Beam], Errors]


def known(kernel: str, frame: Frame) -> Mapping[str, float]:
    """What a kernel makes of a frame; ends the benchmark where that is unknown, as on one too small for the beams."""
    found = run(parsed(f"image | {kernel}"), frame)
    if found.unknown:
        raise SystemExit(f"{kernel}: {found.unknown}")
    return found.value


def moments(frame: Frame, beam: Beam) -> Errors:
    """Middle [px] and widths [%] by second moments."""
    return _errors({**known("centroid", frame), **known("d4sigma", frame)}, beam)


def fit(frame: Frame, beam: Beam) -> Errors:
    """The same by least squares."""
    return _errors(known("gaussian_fit", frame), beam)


def peer(frame: Frame, beam: Beam) -> Errors:
    """The same by laserbeamsize."""
    import laserbeamsize  # type: ignore[import-not-found]

    h, w = frame.pixels.shape
    column, row, major, minor, _ = laserbeamsize.beam_size(frame.pixels.astype(float) - BLACK)
    found = {"x": column - (w - 1) / 2, "y": (h - 1) / 2 - row}
    return _errors({**found, "major": max(major, minor), "minor": min(major, minor)}, beam)


def _errors(found: Any, beam: Beam) -> Errors:
    off = max(abs(found["x"] - beam.x), abs(found["y"] - beam.y))
    return off, 100 * max(abs(found["major"] / beam.major - 1), abs(found["minor"] / beam.minor - 1))


def rows(shape: tuple[int, int], seeds: int) -> Iterator[str]:
    """Yield the table of beams."""
    estimators: dict[str, Estimator] = {"moments": moments, "gaussian_fit": fit}
    try:
        import laserbeamsize  # noqa: F401

        estimators["laserbeamsize"] = peer
    except ImportError:
        yield "laserbeamsize is not installed"
    for name, beam in BEAMS.items():
        for called, estimator in estimators.items():
            found, times = [], []
            for seed in range(seeds):
                frame = picture(beam, shape, seed)
                begun = time.perf_counter()
                found.append(estimator(frame, beam))
                times.append(time.perf_counter() - begun)
            off, wide = (median(errors) for errors in zip(*found, strict=True))
            yield f"{name:24} {called:14} {off:8.4f} px {wide:8.4f} %  {1e3 * median(times):6.0f} ms"


def others(shape: tuple[int, int], seeds: int) -> Iterator[str]:
    """Yield what fringes and readings come to."""
    seen = [
        run(parsed("image | visibility"), fringe_picture(0.6, shape, seed)).value["visibility"] for seed in range(seeds)
    ]
    yield f"visibility, true 0.6: {np.mean(seen):.5f} +- {np.std(seen):.5f}"
    truth = np.array([0.5, 0.3, 0.6]) / np.linalg.norm([0.5, 0.3, 0.6])
    for name, kernel, readings in (
        ("six states", "stokes", six_states),
        ("8 angles of a plate of 93.6 deg, fitted", "stokes_waveplate", lambda t, s: turned_plate(t, s, 93.6)),
    ):
        found = [run(parsed(f"readings | {kernel}"), readings(truth, seed)).value for seed in range(50 * seeds)]
        known = [[v[n] for n in ("s1", "s2", "s3")] for v in found if v]
        rms = np.sqrt(np.mean((np.array(known) - truth) ** 2, axis=0))
        yield f"Stokes, {name}: RMS {', '.join(f'{r:.4f}' for r in rms)} ({len(known)} of {len(found)} known)"


def main() -> None:
    """Print all."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=4)
    parser.add_argument("--shape", type=int, nargs=2, default=(2048, 2448), metavar=("HEIGHT", "WIDTH"))
    options = parser.parse_args()
    shape = (options.shape[0], options.shape[1])
    for line in (*rows(shape, options.seeds), *others((480, 640), options.seeds)):
        print(line, flush=True)


if __name__ == "__main__":
    main()
