"""Pictures of a beam from files: the numbers are those of the same picture from a camera, in pixels or micrometers, and
a series along the beam gives its propagation ratio."""

from __future__ import annotations

import json
import math
from pathlib import Path

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray
from oracles.beam_pictures import Beam, light, taken

from pico.diagnostics import PicoError
from pico.kernels.caustic import Caustic, caustic
from pico.kernels.files import frame_from, pictures, places_of, read_picture
from pico.kernels.pipeline import parsed, run

SHAPE = (240, 320)
BEAM = Beam(60, 40, 20, x=5.3, y=-3.7)
PIXELS = taken(light(BEAM, SHAPE), 1).pixels
WAVELENGTH = 632.8


def write(path: Path, pixels: NDArray[np.generic]) -> Path:
    if path.suffix == ".npy":
        np.save(path, pixels)
    else:
        assert cv2.imwrite(str(path), pixels)
    return path


@pytest.mark.parametrize("suffix", ["png", "pgm", "tif", "npy"])
@pytest.mark.parametrize("shift", [0, 4], ids=["at the lower end", "at the upper end of 16 bits"])
def test_every_format_gives_the_same_numbers(tmp_path: Path, suffix: str, shift: int) -> None:
    frame = frame_from(read_picture(write(tmp_path / f"a.{suffix}", PIXELS << shift)), black_level=64 << shift)
    found = run(parsed("image | d4sigma"), frame)
    assert frame.full_scale == 4095 << shift and not frame.refusal
    assert found.value["major"] == pytest.approx(60, abs=4 * found.sigma["major"]) and found.sigma["major"] < 0.5


def test_the_noise_of_a_picture_tells_electrons_a_count() -> None:
    frame = frame_from(PIXELS, black_level=64)
    assert frame.electrons_per_count == pytest.approx(3.66, rel=0.15) and frame.read_noise < 4


def test_a_color_picture_of_gray_is_gray_and_any_other_is_refused(tmp_path: Path) -> None:
    gray = (PIXELS >> 4).astype(np.uint8)
    color = np.stack([gray, gray, gray], axis=-1)
    assert np.array_equal(read_picture(write(tmp_path / "gray.png", color)), gray)
    color[..., 2] //= 2
    with pytest.raises(PicoError, match="not one for each pixel"):
        read_picture(write(tmp_path / "color.png", color))


@pytest.mark.parametrize(
    ("name", "content", "why"),
    [("a.png", b"", "damaged"), ("a.tif", b"II*\0nonsense", "damaged"), ("a.npy", b"nonsense", "no array of NumPy"),
     ("a.jpg", b"\xff\xd8", "of none of the formats"), ("a.pgm", None, "cannot be read")],
)  # fmt: skip
def test_what_is_no_picture_is_refused_by_name(tmp_path: Path, name: str, content: bytes | None, why: str) -> None:
    if content is not None:
        (tmp_path / name).write_bytes(content)
    with pytest.raises(PicoError) as refused:
        read_picture(tmp_path / name)
    assert name in refused.value.diagnostics[0].summary and why in refused.value.diagnostics[0].summary


def test_places_come_from_the_number_that_differs() -> None:
    assert places_of([Path(f"t-{z}mm_5um.pgm") for z in (480, 510, 520)]) == (480, 510, 520)
    assert places_of([Path("z_-5.png"), Path("z_10.5.png")]) == (-5, 10.5)
    for names in (["a.png", "b.png"], ["1_2.png", "2_3.png"], ["z1.png", "z1_0.png"]):
        with pytest.raises(PicoError, match="do not tell where"):
            places_of([Path(name) for name in names])


def test_a_pattern_means_its_files_once(tmp_path: Path) -> None:
    for name in ("a1.png", "a2.png"):
        write(tmp_path / name, PIXELS)
    found = pictures([str(tmp_path / "a*.png"), str(tmp_path / "a1.png")])
    assert [path.name for path in found] == ["a1.png", "a2.png"]
    with pytest.raises(PicoError, match="no file matches"):
        pictures([str(tmp_path / "b*.png")])


def widths(z: NDArray[np.float64], m2: float, waist: float, at: float) -> NDArray[np.float64]:
    """The law that a beam's width [um] follows, z and `at` [mm]."""
    rayleigh = math.pi * (waist * 1e-3) ** 2 / (4 * WAVELENGTH * 1e-6 * m2)
    return waist * np.sqrt(1 + ((z - at) / rayleigh) ** 2)


@pytest.mark.parametrize("m2", [1.0, 1.7, 20.0])
def test_a_caustic_knows_how_far_it_is_off(m2: float) -> None:
    z = np.concatenate([np.linspace(-1, 1, 6), np.linspace(2, 4, 3), np.linspace(-4, -2, 3)]) * 30 / m2 + 100
    truth = widths(z, m2, 150, 100)
    rng, off = np.random.default_rng(1), []
    for _ in range(200):
        sigma = 0.01 * truth
        found = caustic(z, truth + sigma * rng.standard_normal(len(z)), sigma, WAVELENGTH)
        assert isinstance(found, Caustic)
        off.append([(found.m2 - m2) / found.sigma[0], (found.waist - 150) / found.sigma[1]])
    assert np.all(np.sqrt(np.mean(np.square(off), axis=0)) < 1.2) and np.all(np.std(off, axis=0) > 0.6)


@pytest.mark.parametrize(
    ("z", "d", "why"),
    [([0, 1, 2], [1, 2, 3], "4 places"), ([0, 1, 2, 3, 4], [100, 120, 130, 120, 100], "no waist")],
)
def test_widths_without_a_waist_are_unknown(z: list[float], d: list[float], why: str) -> None:
    found = caustic(np.array(z, float), np.array(d, float), np.full(len(z), 0.1), WAVELENGTH)
    assert isinstance(found, str) and why in found


def write_series(folder: Path, across: tuple[float, float, float], up: tuple[float, float, float]) -> None:
    """Pictures of a beam along its way; M2, waist [um] and its place [mm] of each axis; pixels of 5 um."""
    for z in (*range(60, 140, 10), *range(20, 60, 20), *range(160, 220, 20)):
        w, h = (float(widths(np.array([float(z)]), *axis)[0]) / 5 for axis in (across, up))
        pixels = taken(light(Beam(w, h, x=5.3, y=-3.7), SHAPE), z).pixels
        write(folder / f"z-{z}mm.png", pixels)


def test_a_series_of_pictures_tells_m2(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    from pico_cli.main import main

    write_series(tmp_path, (1.6, 200.0, 100.0), (1.6, 200.0, 100.0))
    words = ["measure", "--image", str(tmp_path / "z-*mm.png"), "--pixel-size", "5", "--json"]
    assert main([*words, "gaussian_fit | m2(wavelength=632.8)"]) == 0
    found = json.loads(capsys.readouterr().out)["measured"][-1]
    assert found["picture"] == "13 pictures" and found["unit"]["at"] == "mm"
    for name, true in (("m2", 1.6), ("waist", 200), ("at", 100)):
        assert abs(found["value"][name] - true) < 4 * found["sigma"][name], name
    assert found["sigma"]["m2"] < 0.02
    assert main(["measure", *words[1:3], "--pixel-size", "2", "gaussian_fit | m2(wavelength=632.8)"]) == 1
    assert "no beam has less than 1" in capsys.readouterr().out


def test_a_series_of_an_astigmatic_beam_tells_m2_of_both_axes(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    from pico_cli.main import main

    write_series(tmp_path, (1.2, 200.0, 80.0), (2.0, 240.0, 140.0))
    words = ["measure", "--image", str(tmp_path / "z-*mm.png"), "--pixel-size", "5", "--json"]
    assert main([*words, "gaussian_fit | m2(wavelength=632.8)"]) == 0
    found = {row["picture"]: row for row in json.loads(capsys.readouterr().out)["measured"][-2:]}
    for axis, m2, at in (("13 pictures at 0 deg", 1.2, 80), ("13 pictures at 90 deg", 2.0, 140)):
        row = found[axis] if axis in found else found[axis.replace(" 90", " -90")]
        assert row["value"]["m2"] == pytest.approx(m2, rel=0.02) and row["value"]["at"] == pytest.approx(at, abs=1)


def test_a_picture_from_disk_is_measured_without_a_lab(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    from pico_cli.main import main

    monkeypatch.chdir(tmp_path)
    pixels = PIXELS.copy()
    pixels[20, 30] = 4095
    write(tmp_path / "a.tif", pixels)
    assert main(["measure", "--image", "a.tif", "centroid", "peak"]) == 0
    said = capsys.readouterr().out
    assert "a.tif  centroid" in said and " px" in said and " um" not in said
    assert "1 defective pixel left out, at column and row (30, 20)" in " ".join(said.split())
    assert "the black level is taken as 0" in " ".join(said.split())
    of_file = ["--image", "a.tif"]
    for wrong in (
        ["--at", "3", "cam.image"], [*of_file, "--dry-run", "peak"], [*of_file, "m2"],
        [*of_file, "centroid | m2(wavelength=633)"], [*of_file, "d4sigma | m2(wavelength=633)"],
        [*of_file, "--at", "1", "--at", "2", "peak"],
    ):  # fmt: skip
        assert main(["measure", *wrong]) == 1
        assert "error[" in capsys.readouterr().err
