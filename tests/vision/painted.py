"""Pictures of markers for the tests of vision: drawn by rays onto planes, by nothing that the product draws with."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np

from pico.manifest.catalog import load_catalog
from pico.model.lab import Camera, Datum, Lab, Part, Slot, Table
from pico.model.pose import Pose
from pico.model.robot import Mount, Robot
from pico.model.setup import Setup
from pico.vision.camera import CameraModel
from pico.vision.frame import Frame
from pico.vision.rigid import motion, rotation, square, upright

BACKGROUND, WHITE, BLACK = 150.0, 225.0, 20.0


@dataclass(frozen=True, eq=False)
class Painted:
    """A plate in space (4, 4) [mm] with a marker of edge `size`; the part of it with x < `covered` [mm] is hidden."""

    number: int
    pose: np.ndarray
    size: float = 24.0
    covered: float = -1e9


def looking(name: str, position: Sequence[float], at: Sequence[float], pixels=(1280, 960), view=45.0, distortion=None):
    """Return a camera at `position` that looks `at` a point, +y of the table up in its picture."""
    forward = np.subtract(at, position) / np.linalg.norm(np.subtract(at, position))
    right = np.cross(forward, [0, 1, 0])
    right /= np.linalg.norm(right)
    turn = np.column_stack((right, np.cross(forward, right), forward))
    focal = pixels[1] / 2 / math.tan(math.radians(view) / 2)
    matrix = np.array([[focal, 0, (pixels[0] - 1) / 2], [0, focal, (pixels[1] - 1) / 2], [0, 0, 1.0]])
    lens = np.zeros(5) if distortion is None else np.array(distortion, float)
    return CameraModel(name, tuple(pixels), matrix, lens, motion(turn, np.array(position, float)))


def stereo(pixels=(1280, 960), distortion=None) -> dict[str, CameraModel]:
    """Return two cameras over a table of 1000 x 700."""
    return {
        name: looking(name, (x, 350, 1000), (500 + (x - 500) / 3, 350, 0), pixels, 45, distortion)
        for name, x in (("left", 350.0), ("right", 650.0))
    }


def bumped(camera: CameraModel, shift: Sequence[float], turn: Sequence[float] = (0, 0, 0)) -> CameraModel:
    """Return the camera shifted [mm] and turned [deg] about the axes of the table."""
    pose = camera.pose.copy()
    pose[:3, :3] = rotation(np.radians(turn)) @ pose[:3, :3]
    pose[:3, 3] += shift
    return replace(camera, pose=pose)


def picture(camera: CameraModel, plates: Sequence[Painted], rng: np.random.Generator, noise=2.0, blur=0.7) -> Frame:
    """Return what a camera sees of plates, the last over those before it."""
    width, height = camera.pixels
    image = np.full((height, width), BACKGROUND)
    for plate in plates:
        _draw(image, camera, plate)
    image = cv2.GaussianBlur(image, (0, 0), blur) if blur else image
    image = image + rng.normal(0, noise, image.shape)
    return Frame(np.clip(np.round(image), 0, 255).astype(np.uint8), (0, 0), camera.name, 0.0)


_DRAWN: dict[tuple[object, ...], tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray] | None] = {}


def _draw(image: np.ndarray, camera: CameraModel, plate: Painted) -> None:
    lens = (camera.pixels, *(numbers.tobytes() for numbers in (camera.matrix, camera.distortion, camera.pose)))
    key = (*lens, plate.number, plate.pose.tobytes(), plate.size, plate.covered)
    if key not in _DRAWN:  # most pictures show the same plates, but for one
        _DRAWN[key] = _drawn(image.shape, camera, plate)
    found = _DRAWN[key]
    if found is not None:
        low, high, value, on = found
        part = image[low[1] : high[1], low[0] : high[0]]
        part[:] = part * (1 - on) + value


def _drawn(size: tuple[int, ...], camera: CameraModel, plate: Painted, fine: int = 4):
    """Return the corners of the part of a picture that a plate covers, its gray levels times cover, and its cover."""
    half = plate.size / 2 * 4 / 3
    corners = square(2 * half) @ plate.pose[:3, :3].T + plate.pose[:3, 3]
    seen = camera.project(corners)
    height, width = size
    low = np.maximum(np.floor(seen.min(axis=0)).astype(int) - 1, 0)
    high = np.minimum(np.ceil(seen.max(axis=0)).astype(int) + 2, (width, height))
    if np.any(high <= low):
        return None
    steps = (np.arange(fine) + 0.5) / fine - 0.5
    u = (np.arange(low[0], high[0])[:, None] + steps).ravel()
    v = (np.arange(low[1], high[1])[:, None] + steps).ravel()
    grid = np.stack(np.meshgrid(u, v), -1).reshape(-1, 2)
    origin, along = camera.rays(grid)
    inverse = np.linalg.inv(plate.pose)
    start, way = inverse[:3, :3] @ origin + inverse[:3, 3], along @ inverse[:3, :3].T
    local = (start + way * (-start[2] / way[:, 2])[:, None])[:, :2]
    value, on = _paint(plate, local, half)
    shape = (len(v) // fine, fine, len(u) // fine, fine)
    return low, high, value.reshape(shape).mean(axis=(1, 3)), on.reshape(shape).mean(axis=(1, 3))


def _paint(plate: Painted, local: np.ndarray, half: float) -> tuple[np.ndarray, np.ndarray]:
    """Return gray levels times cover, and cover, of points on a plate."""
    dictionary = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_4X4_1000)
    cells = cv2.aruco.generateImageMarker(dictionary, plate.number, 6)
    on = (np.abs(local).max(axis=1) < half).astype(float)
    column = np.floor((local[:, 0] / plate.size + 0.5) * 6).astype(int)
    row = np.floor((0.5 - local[:, 1] / plate.size) * 6).astype(int)
    inside = (column >= 0) & (column < 6) & (row >= 0) & (row < 6)
    value = np.full(len(local), WHITE)
    value[inside] = np.where(cells[row[inside], column[inside]] > 0, WHITE, BLACK)
    value[local[:, 0] < plate.covered] = 120.0
    return value * on, on


DATUMS = {
    "d1": Datum(marker=990, x=60, y=60),
    "d2": Datum(marker=991, x=940, y=60, yaw=90),
    "d3": Datum(marker=992, x=940, y=640),
    "d4": Datum(marker=993, x=60, y=640),
}


def setup(count: int = 12, types: Sequence[str] = ("linear_polarizer", "plano_convex_100", "mirror_tip_tilt")) -> Setup:
    """Return a bench with `count` parts, markers 1 to `count`, two cameras and four datums."""
    catalog = load_catalog(types)
    slots = {f"s{i}": Slot(x=100 + 90 * (i % 10), y=100 + 90 * (i // 10)) for i in range(count)}
    inventory = {f"part_{i + 1}": Part(type=types[i % len(types)], marker=i + 1, home=f"s{i}") for i in range(count)}
    cameras = {n: Camera(position=(0, 0, 1000), look_at=(0, 0, 0)) for n in ("left", "right")}
    lab = Lab(
        name="test",
        table=Table(size=(1000, 700)),
        slots=slots,
        robots={"arm1": Robot(mount=Mount(x=500, y=650))},
        cameras=cameras,
        datums=DATUMS,
        inventory=inventory,
    )
    return Setup(lab=lab, catalog=catalog)


def datum_plates() -> list[Painted]:
    return [Painted(d.marker, upright(Pose(d.x, d.y, d.yaw), 0.0), d.size) for d in DATUMS.values()]


def plate_of(bench: Setup, name: str, pose: Pose) -> Painted:
    """Return the plate of a part that stands at `pose`."""
    marker = bench.type_of(name).geometry.marker
    there = pose.compose(Pose(marker.at[0], marker.at[1]))
    return Painted(bench.lab.inventory[name].marker, upright(there, marker.at[2]), marker.size)


def scattered(bench: Setup, rng: np.random.Generator) -> dict[str, Pose]:
    """Return a pose for each part, no two closer than 60 mm, none over a datum."""
    poses: dict[str, Pose] = {}
    taken = [(d.x, d.y) for d in bench.lab.datums.values()]
    while len(poses) < len(bench.lab.inventory):
        x, y = rng.uniform(130, 870), rng.uniform(80, 620)
        if all(math.hypot(x - a, y - b) > 60 for a, b in taken):
            taken.append((x, y))
            poses[f"part_{len(poses) + 1}"] = Pose(x, y, rng.uniform(-180, 180))
    return poses


def scene(bench: Setup, poses: Mapping[str, Pose]) -> list[Painted]:
    """Return the plates of parts and datums."""
    return [*datum_plates(), *(plate_of(bench, name, pose) for name, pose in poses.items())]
