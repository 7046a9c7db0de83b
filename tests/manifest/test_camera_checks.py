"""What `pico validate` says of cameras and datum markers."""

from __future__ import annotations

import pytest
from manifest_samples import LAB, STATE

from pico.manifest.load import load_files

OVERHEAD = "{position: [600, 450, 1500], look_at: [600, 450, 0], field_of_view: 50}"
DATUMS = "  d1: {marker: 91, x: 1180, y: 20}\n  d2: {marker: 92, x: 1180, y: 880}\n"


def found(cameras: str, *, datums: str = DATUMS, sim: str = "") -> list[str]:
    """Return the diagnostics of the small bench with these cameras, as `severity summary`."""
    lab = LAB.replace("inventory:\n", f"{datums}cameras:\n{cameras}\n{sim}inventory:\n")
    manifests = load_files({"lab.yaml": lab.encode(), "state.yaml": STATE.encode()})
    return [f"{d.severity} {d.summary}" for d in manifests.diagnostics]


def test_a_camera_over_the_table_and_three_datums_are_right() -> None:
    assert found(f"  top: {OVERHEAD}") == []


@pytest.mark.parametrize(
    ("camera", "summary"),
    [
        ("{position: [600, 450, 1500], look_at: [600, 450, 3000]}", "error camera top does not see the table"),
        ("{position: [600, 450, -100], look_at: [600, 450, 0]}", "error camera top does not see the table"),
        ("{position: [1, 2, 3], look_at: [1, 2, 3]}", "error the look_at of camera top can't be"),
        (OVERHEAD.replace("50}", "180}"), "error the field_of_view of camera top can't be"),
        (OVERHEAD.replace("}", ", pixels: [0, 960]}"), "error the pixels of camera top can't be"),
        (OVERHEAD.replace("}", ", noise: -1}"), "error the noise of camera top can't be"),
        (OVERHEAD.replace("}", ", depth: {range: [300, 100]}}"), "error the depth of camera top can't be"),
        (
            OVERHEAD.replace("}", ", robot: arm2}"),
            "error camera top rides on a robot that this lab does not have: `arm2`",
        ),
    ],
)
def test_what_can_not_be_is_an_error(camera: str, summary: str) -> None:
    assert summary in found(f"  top: {camera}")


def test_a_slot_that_no_camera_sees_is_a_warning() -> None:
    narrow = "{position: [900, 450, 1500], look_at: [900, 450, 0], field_of_view: 30}"
    assert "warning no camera over the table sees slot storage/a1, slot storage/a2" in found(f"  top: {narrow}")


def test_roll_turns_the_picture() -> None:
    wide = "{position: [600, 450, 1500], look_at: [600, 450, 0], field_of_view: 34, pixels: [1600, 1000]}"
    assert found(f"  top: {wide}") == []
    assert any("sees slot" in text for text in found(f"  top: {wide.replace('}', ', roll: 90}')}"))


def test_fewer_than_three_datums_are_a_warning() -> None:
    few = [text for text in found(f"  top: {OVERHEAD}", datums="") if "datum" in text]
    assert few == ["warning the cameras see 1 datum marker: a bumped camera can't be told from moved parts"]


def test_a_datum_under_a_part_is_a_warning() -> None:
    datums = DATUMS + "  d3: {marker: 93, x: 125, y: 420}\n"
    assert found(f"  top: {OVERHEAD}", datums=datums) == ["warning laser stands on datum d3"]


def test_a_number_carried_twice_or_unknown_to_the_dictionary_is_an_error() -> None:
    assert "error d3 and p1 carry the same marker, 1" in found(
        f"  top: {OVERHEAD}", datums="  d3: {marker: 1, x: 600, y: 20}\n"
    )
    assert "error the marker of d3 is 1000" in found(
        f"  top: {OVERHEAD}", datums="  d3: {marker: 1000, x: 600, y: 20}\n"
    )


def test_injected_errors_have_their_ranges() -> None:
    sim = "sim: {errors: {lost_frames: 1.5, camera_position: 0.2}}\n"
    assert found(f"  top: {OVERHEAD}", sim=sim) == ["error sim.errors.lost_frames is 1.5"]
    dark = "sim: {errors: {light: {dim: 0, defocus: -1}}}\n"
    wrong = ["error sim.errors.light.dim is 0", "error sim.errors.light.defocus is -1"]
    assert found(f"  top: {OVERHEAD}", sim=dark) == wrong
    arm = "sim: {errors: {arm: {backlash: -0.1, encoder_noise: 0.01}}}\n"
    assert found(f"  top: {OVERHEAD}", sim=arm) == ["error sim.errors.arm.backlash is -0.1"]
