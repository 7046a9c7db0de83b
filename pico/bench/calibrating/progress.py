"""What a calibration under way has found so far: pictures of the board as corners, and lenses that wait for a place."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from pico.base.state_files import CALIBRATING
from pico.model.calibration.results import Provenance
from pico.model.record import as_json
from pico.places.bench import BenchPlace
from pico.vision.calibration import camera_as_json, camera_from_json
from pico.vision.camera import CameraModel
from pico.vision.charuco import Board, BoardView

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

Shot = Mapping[str, BoardView]


@dataclass(frozen=True, eq=False)
class Posture:
    """One posture in which an arm showed the board."""

    take: int
    """How often the hand had taken the board by then."""
    read: Array
    """What the encoders read (7,) [rad]."""
    board: Array | None
    """Where the board was (4, 4) [mm]; None if it was not seen well enough."""


@dataclass(frozen=True, eq=False)
class Progress:
    """What was found so far."""

    board: Board | None = None
    """The board of the pictures."""
    shots: tuple[Shot, ...] = ()
    """The board as the cameras saw it, by camera, one for each place at which it was held."""
    datums: Mapping[str, Mapping[int, Array]] = field(default_factory=dict)
    """Corners (4, 2) [pixels] of each datum before the board was shown, by camera and marker."""
    lenses: Mapping[str, CameraModel] = field(default_factory=dict)
    """Cameras whose lens is known and whose place is not, yet."""
    sigmas: Mapping[str, tuple[float, ...]] = field(default_factory=dict)
    """One standard deviation of the nine numbers of each lens."""
    provenance: Mapping[str, Provenance] = field(default_factory=dict)
    """How these lenses were found, as `intrinsics/CAMERA`."""
    postures: Mapping[str, tuple[Posture, ...]] = field(default_factory=dict)
    """The postures in which each arm showed the board, until all are done."""


def read_progress(place: BenchPlace) -> Progress:
    """Return what the calibration of a bench has found so far; nothing if it has not begun, or its file is damaged."""
    return CALIBRATING.read(CALIBRATING.path(place.folder), _from_json) or Progress()


def write_progress(place: BenchPlace, progress: Progress) -> None:
    """Keep what a calibration has found so far; raises PicoError."""
    path = CALIBRATING.path(place.folder)
    CALIBRATING.write(path, _as_json(progress), what=f"the calibration so far cannot be kept in {path}")


def _as_json(progress: Progress) -> dict[str, Any]:
    return {
        "schema": CALIBRATING.schema,
        "board": None if progress.board is None else vars(progress.board),
        "shots": [
            {name: {"corners": view.corners.tolist(), "pixels": view.pixels.tolist()} for name, view in shot.items()}
            for shot in progress.shots
        ],
        "datums": {camera: {str(n): at.tolist() for n, at in seen.items()} for camera, seen in progress.datums.items()},
        "lenses": {name: camera_as_json(camera) for name, camera in progress.lenses.items()},
        "sigmas": {name: list(sigmas) for name, sigmas in progress.sigmas.items()},
        "provenance": as_json(dict(progress.provenance)),
        "postures": {
            robot: [
                {"take": p.take, "read": p.read.tolist(), "board": None if p.board is None else p.board.tolist()}
                for p in each
            ]
            for robot, each in progress.postures.items()
        },
    }


def _from_json(data: dict[str, Any]) -> Progress:
    import numpy as np

    return Progress(
        board=Board(**data["board"]) if data["board"] else None,
        shots=tuple(
            {name: BoardView(name, np.array(v["corners"]), np.array(v["pixels"])) for name, v in shot.items()}
            for shot in data["shots"]
        ),
        datums={
            camera: {int(number): np.array(at) for number, at in seen.items()}
            for camera, seen in data["datums"].items()
        },
        lenses={name: camera_from_json(name, camera) for name, camera in data["lenses"].items()},
        sigmas={name: tuple(sigmas) for name, sigmas in data["sigmas"].items()},
        provenance={name: Provenance(**how) for name, how in data["provenance"].items()},
        postures={
            robot: tuple(
                Posture(p["take"], np.array(p["read"]), None if p["board"] is None else np.array(p["board"]))
                for p in each
            )
            for robot, each in data["postures"].items()
        },
    )
