"""The light on the bench of the case study is what the references of its figures assume, and its camera sees it all."""

from __future__ import annotations

import math

import numpy as np
import pytest
import yaml

from pico.history.examples.example import make_example
from pico.history.lab.folder import LabFolder
from pico.model.state import LabState, place_of
from pico.optics.axis import Values
from pico.optics.beam_table import exposed, troubles
from pico.optics.gaussian import front
from pico.optics.light import Light, light_of
from pico.resources import labs_dir

WAIST = 0.65
"""1/e2 radius at the first lens [mm], collimated: as `data/shel_shift.csv` assumes."""
STATES = [c["tag"] for c in yaml.safe_load((labs_dir() / "shel" / "history.yaml").read_text())["commits"]]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> LabFolder:
    root = tmp_path_factory.mktemp("light") / "shel"
    make_example("shel", root)
    return LabFolder(root)


def light_at(folder: LabFolder, tag: str, given: Values | None = None) -> tuple[LabState, Light]:
    """Return a state and its light, some tunables otherwise than it says."""
    state, setup = folder.state_at(tag), folder.setup
    poses = {name: place_of(setup, state, name)[1] for name in setup.lab.inventory}
    values = {name: {**part.values, **(given or {}).get(name, {})} for name, part in state.components.items()}
    return state, light_of(setup, poses, values)


@pytest.mark.parametrize(
    ("tag", "lens", "focal"), [("e1", "lx_125", 125), ("e2", "lx_100", 100), ("e3", "lx_100", 100)]
)
def test_the_beam_is_as_wide_and_as_flat_at_the_first_lens_as_references_assume(
    folder: LabFolder, tag: str, lens: str, focal: float
) -> None:
    _, light = light_at(folder, tag)
    came = next(c.beam for c in light.crossings if c.component == lens)
    assert came.widths[:2] == pytest.approx((WAIST, WAIST), rel=0.02)
    assert np.abs(front(came.curvature)).max() * focal < 0.02  # what it adds to the lens's own


CROSSED = ("E1-3", "E2-3", "E3-2")


@pytest.mark.parametrize("tag", STATES)
def test_nothing_clips_the_beam_or_lets_it_stray(folder: LabFolder, tag: str) -> None:
    _, light = light_at(folder, tag)
    assert [d.code for d in troubles(folder.setup, light)] == ([] if tag in CROSSED else ["saturated"])


@pytest.mark.parametrize("tag", STATES)
def test_no_state_saturates_the_camera_once_it_is_set_as_the_readme_of_the_lab_says(
    folder: LabFolder, tag: str
) -> None:
    given = {} if tag in CROSSED else {"hwp": {"angle": 2}, "cam": {"exposure": 0.2}}
    if tag == "C1":  # nothing polarizes yet
        given = {"cam": {"exposure": 0.02}, "laser": {"shutter": "closed"}}
    _, light = light_at(folder, tag, given)
    assert not [d for d in troubles(folder.setup, light) if d.code != "dark"]
    if tag != "C1":
        assert 0.005 < exposed(light, light.parts["cam"]).times < 1


def test_the_polarizers_say_what_they_are_made_of(folder: LabFolder) -> None:
    kind = folder.setup.type_of("p2")
    assert kind.parameters["substrate"].value in ("film", "ar_glass", "glass")
    assert math.isfinite(kind.number("refractive_index", "") or math.nan)
    assert math.isfinite(kind.number("thickness", "mm") or math.nan)
