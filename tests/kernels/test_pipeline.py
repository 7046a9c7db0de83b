"""Kernels in a row by text: what is read, what is refused and how, and a kernel that one new file brings."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from oracles.beam_pictures import Beam, picture

from pico.diagnostics import PicoError
from pico.kernels import known
from pico.kernels.frame import Frame
from pico.kernels.kernel import Parameter
from pico.kernels.pipeline import parsed, run
from pico.registered import modules

MEAN = """
from pico.kernels.kernel import Declaration, Result

KERNEL = Declaration(version="3", takes="image", units={"mean": "count"})

def apply(given, parameters):
    return Result({"mean": float(given.pixels.mean())}, {"mean": 0.0})
"""


def test_a_text_is_read_with_the_defaults_of_its_kernels() -> None:
    found = parsed("image|background | mode_overlap( radius = 4.5e2 , x=-3)")
    assert found.source == "image" and [s.name for s in found.steps] == ["background", "mode_overlap"]
    assert found.steps[1].parameters == {"radius": 450.0, "x": -3.0, "y": 0.0}


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("image", "is no pipeline"),
        ("", "is no pipeline"),
        ("image | ", "is no kernel"),
        ("image | centroit", "did you mean `centroid`?"),
        ("image | mode_overlap", "is not told its `radius`"),
        ("image | mode_overlap(radius=0)", "expected above 0"),
        ("image | mode_overlap(radius=1e999)", "expected above 0"),
        ("image | mode_overlap(radius=4, radius=5)", "each parameter once"),
        ("image | mode_overlap(radus=4)", "`radius`"),
        ("image | mode_overlap(4)", "is no parameter"),
        ("image | centroid(x=4)", "`centroid` has none"),
        ("image | centroid | background", "`background` takes an image, and `centroid` gives numbers"),
        ("image | __import__", "is no kernel"),
    ],
)
def test_a_text_that_says_none_is_told_what_would_be_right(text: str, said: str) -> None:
    with pytest.raises(PicoError) as refused:
        parsed(text)
    assert said in str(refused.value)


@given(st.text(max_size=60) | st.text("imagecentroid |(=)., 0123", max_size=60))
def test_any_text_is_read_or_refused(text: str) -> None:
    try:
        assert parsed(text).steps
    except PicoError as exc:
        assert all(d.code == "kernel" for d in exc.diagnostics)


def test_readings_are_no_image() -> None:
    frame = Frame(np.zeros((10, 10)))
    with pytest.raises(PicoError, match="`stokes` takes readings, and `image` gives an image"):
        run(parsed("image | stokes"), frame)
    with pytest.raises(PicoError, match="gives an image, no number"):
        run(parsed("image | background"), picture(Beam(60, 60), (200, 200), 1))


def _example(parameter: Parameter) -> float:
    """A value that a parameter takes: its default, else one that fits a radius [um], an angle [deg] or a share, above
    its least."""
    if parameter.default is not None:
        return parameter.default
    return max(30.0 if parameter.unit else 0.5, 2 * (parameter.least or 0.0))


def test_every_kernel_has_a_version_and_says_what_it_gives_of_a_picture() -> None:
    _try_kernels(*known.modules())


@pytest.mark.usefixtures("mean")
@pytest.mark.parametrize(
    "parameter",
    ['"wavelength": Parameter("nm", least=400.0)', '"share": Parameter("")', '"radius": Parameter("um", least=0.0)'],
)
def test_the_test_of_every_kernel_takes_any_parameter(tmp_path: Path, parameter: str) -> None:
    declaration = f'takes="image", parameters={{{parameter}}},'
    text = MEAN.replace("import Declaration, Result", "import Declaration, Parameter, Result")
    (tmp_path / "mean_kernel.py").write_text(text.replace('takes="image",', declaration))
    sys.modules.pop("mean_kernel", None)
    _try_kernels("mean")


def _try_kernels(*names: str) -> None:
    frame = picture(Beam(60, 60), (200, 200), 1)
    for name in names:
        declared = known.kernel(name).KERNEL
        assert declared.version
        if declared.takes == "image" and declared.gives == "numbers":
            words = ", ".join(f"{n}={_example(p):g}" for n, p in declared.parameters.items())
            found = run(parsed(f"image | {name}({words})" if words else f"image | {name}"), frame)
            assert (found.kernel, found.version) == (name, declared.version)
            assert found.unknown or tuple(found.value) == tuple(found.sigma) == tuple(declared.units)


@pytest.fixture
def mean(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """A plug-in that brings the kernel `mean`."""
    about = tmp_path / "mean_kernel-1.0.dist-info"
    about.mkdir()
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: mean_kernel\nVersion: 1.0\n")
    (about / "entry_points.txt").write_text("[pico.kernels]\nmean = mean_kernel\ncentroid = mean_kernel\n")
    (tmp_path / "mean_kernel.py").write_text(MEAN)
    monkeypatch.syspath_prepend(tmp_path)
    modules.cache_clear()
    yield
    monkeypatch.undo()
    modules.cache_clear()
    sys.modules.pop("mean_kernel", None)


@pytest.mark.usefixtures("mean")
def test_a_kernel_is_added_by_one_new_file() -> None:
    frame = picture(Beam(60, 60), (200, 200), 1)
    found = run(parsed("image | background | mean"), frame)
    assert found.value["mean"] == frame.pixels.mean() and (found.kernel, found.version) == ("mean", "3")
    assert run(parsed("image | centroid"), frame).version == "2", "a plug-in can't replace PICO's own"
