"""A type that is begun from another: all of its text, with a name and numbers of its own."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from pico.diagnostics import PicoError
from pico.manifest.catalog import catalog_names
from pico.manifest.folders import check_folder, component_type
from pico.manifest.new_type import new_type
from pico.resources import catalog_dir, labs_dir


@pytest.fixture
def lab(tmp_path: Path) -> Path:
    return Path(shutil.copytree(labs_dir() / "shel", tmp_path / "shel"))


@pytest.mark.parametrize("base", sorted(catalog_names()))
def test_every_type_can_be_begun_from(lab: Path, base: str) -> None:
    path = new_type(lab, "another", base, {})
    assert path.read_text() == (catalog_dir() / f"{base}.yaml").read_text().replace(f"name: {base}", "name: another", 1)
    assert component_type(lab, "another").parameters == component_type(lab, base).parameters
    again = new_type(lab, "third", "another", {})
    assert again.read_text() == path.read_text().replace("name: another", "name: third")
    assert not [d for d in check_folder(lab).diagnostics if d.severity == "error"]


def test_numbers_are_its_own_and_comments_stay(lab: Path) -> None:
    path = new_type(lab, "red", "hene_laser", {"wavelength": "0.65 um", "laser_class": "2", "power": "0.9"})
    kind = component_type(lab, "red")
    assert kind.number("wavelength", "nm") == pytest.approx(650) and kind.parameters["laser_class"].value == "2"
    assert kind.title.endswith("; wavelength 650 nm, laser_class 2, power 0.9 mW")
    assert "# where it has no power" in path.read_text() and kind.parameters["wavelength"].unit == "nm"


@pytest.mark.parametrize(
    ("name", "base", "given", "said"),
    [
        ("hene_laser", "plano_convex", {}, "there is a type `hene_laser` already"),
        ("mine", "plano_convx", {}, "no component type `plano_convx`"),
        ("mine", "plano_convex", {"focal": "3"}, "no parameter `focal`"),
        ("mine", "plano_convex", {"focal_length": "3 s"}, "is a time, not a length"),
        ("mine", "plano_convex", {"focal_length": "1"}, "no lens 22 mm wide"),
        ("My lens", "plano_convex", {}, "is not a name"),
        ("../mine", "plano_convex", {}, "is not a name"),
    ],
)
def test_nothing_is_written_of_what_cannot_be(
    lab: Path, name: str, base: str, given: dict[str, str], said: str
) -> None:
    before = sorted(lab.rglob("*"))
    with pytest.raises(PicoError, match=said):
        new_type(lab, name, base, given)
    assert sorted(lab.rglob("*")) == before
