"""The glass in a housing: when and how well its numbers were measured, what that leaves open, when it is too old."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pico.manifest.exchange import exchanged
from pico.manifest.load import load_files
from pico.model.lab import Known
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.optics.light import Light, light_of
from pico.optics.nominal.specimens import uncertain
from pico.policy.expired import expired, old
from pico.resources import labs_dir
from pico.vision.calibration_files import EARLIER, made_at

LAB = (labs_dir() / "shel" / "lab.yaml").read_text()
LENS = "  lx_100:\n    type: plano_convex_100\n    marker: 4\n    home: storage/a1\n"


def read(own: str, policy: str = "") -> tuple[Setup | None, list[tuple[str, str]]]:
    """Return the bench whose lens has more lines, and what is wrong with it, each with its place."""
    text = LAB.replace(LENS, LENS + own).replace("policy:\n", f"policy:\n{policy}", 1)
    found = load_files({"lab.yaml": text.encode()})
    wrong = [(d.summary, str(d.source)) for d in found.diagnostics if d.severity == "error" and d.code != "no-state"]
    return found.setup, wrong


def lens(sigma: str, more: str = "") -> str:
    known = f"at: 2026-01-20, sigma: {sigma}{more}"
    return f"    parameters: {{focal_length: 100.3}}\n    measured: {{focal_length: {{{known}}}}}\n"


def test_what_was_measured_says_when_and_how_well() -> None:
    setup, wrong = read(lens("0.2 mm", ", valid_for: 365 d"))
    assert setup is not None and not wrong
    assert (setup.lab.inventory["lx_100"].measured or {})["focal_length"] == Known(
        at="2026-01-20", sigma="0.2 mm", valid_for="365 d"
    )


@pytest.mark.parametrize(
    ("own", "said", "column"),
    [
        (lens("0.2 s"), "sigma of `focal_length` of lx_100", 54),
        (lens("-1"), "sigma of `focal_length` of lx_100 is -1", 54),
        (lens("1", ", valid_for: 3 mm"), "valid_for:", 68),
        (lens("1").replace("2026-01-20", "monday"), "`monday` is no date", 35),
        (lens("1").replace("measured: {focal", "measured: {vocal"), "no `vocal_length` of its own", 16),
    ],
)
def test_what_can_not_be_is_told_at_its_place(own: str, said: str, column: int) -> None:
    _, wrong = read(own)
    line = LAB[: LAB.index(LENS)].count("\n") + LENS.count("\n") + 2
    assert len(wrong) == 1 and said in wrong[0][0] and wrong[0][1] == f"lab.yaml:{line}:{column}", wrong


def test_a_lab_without_it_has_the_digest_that_it_had() -> None:
    plain, known = (read(own)[0] for own in ("", lens("1")))
    assert plain is not None and known is not None
    before = load_files({"lab.yaml": LAB.encode()}).setup
    assert before is not None and plain.digest() == before.digest() != known.digest()


def test_another_specimen_leaves_nothing_of_what_was_measured_of_the_one_before() -> None:
    text = {"lab.yaml": LAB.replace(LENS, LENS + lens("0.2 mm")).encode()}
    bare = exchanged(text, "lx_100", "B7", None, {})["lab.yaml"].decode()
    assert "measured" not in bare and "focal_length: 100.3" in bare
    anew = exchanged(
        text, "lx_100", "B7", None, {"focal_length": 99.0}, Known(at="2026-11-24", sigma="0.1 mm", valid_for="1 d")
    )
    found = load_files(anew).setup
    assert found is not None
    assert found.lab.inventory["lx_100"].measured == {
        "focal_length": Known(at="2026-11-24", sigma="0.1 mm", valid_for="1 d")
    }
    again = exchanged(anew, "lx_100", "B7", None, {}), exchanged(anew, "lx_100", "B7", None, {"focal_length": 99.0})
    assert again[0] == anew and "measured" not in again[1]["lab.yaml"].decode(), "nobody says how well that is known"


@given(st.integers(1, 1000), st.floats(0, 2000))
def test_it_is_old_once_it_was_valid_for_less(valid: int, age: float) -> None:
    now = f"{2026 + int(age) // 366}-01-01"
    days = (int(age) // 366) * 365.25
    if abs(days - valid) > 3:
        assert old("2026-01-01", f"{valid} d", now) == (days > valid)


def test_what_is_too_old_is_one_line_with_what_to_do(tmp_path: Path) -> None:
    setup, _ = read(lens("0.2 mm", ", valid_for: 30 d"), "  calibrated_for: 10 d\n")
    assert setup is not None
    assert made_at(tmp_path, "sim") == ""
    (tmp_path / EARLIER).write_text('{"made_at": "2026-01-25T10:00:00Z"}')
    made = made_at(tmp_path, "sim")
    assert not [*expired(setup, made, "2026-01-30T00:00:00Z")]
    (one,) = expired(setup, made, "2026-02-06T00:00:00Z")
    assert one.summary == "measured too long ago: the calibration of the cameras (2026-01-25, valid for 10 d)"
    (both,) = expired(setup, made, "2026-03-06T00:00:00Z")
    assert "focal_length of lx_100 (2026-01-20, valid for 30 d); the calibration" in both.summary
    assert "`pico swap lx_100" in both.hint and "`pico calibrate`" in both.hint and both.severity == "warning"


def test_the_radius_behind_a_lens_is_known_as_well_as_its_focal_length() -> None:
    """A beam that is wide against its waist is |1 - d/f| times as wide d behind the lens: dw = w d/f^2 sigma."""
    setup, _ = read(lens("0.5 mm"))
    plain, _ = read("")
    assert setup is not None and plain is not None
    places = {"laser": Pose(120, 420), "lx_100": Pose(420, 420), "cam": Pose(620, 420)}

    def trace(bench: Setup) -> Light:
        return light_of(bench, places, lit=lambda _: True)

    light = trace(setup)
    found = uncertain(setup, light, trace)
    (at_lens, at_camera) = (
        next(n for n, c in enumerate(light.crossings) if c.component == p) for p in ("lx_100", "cam")
    )
    behind = light.crossings[at_camera].beam.widths[0]
    more = replace(setup.lab.inventory["lx_100"], parameters={"focal_length": 100.8})
    other = trace(replace(setup, lab=replace(setup.lab, inventory={**setup.lab.inventory, "lx_100": more})))
    assert found[at_camera][0] == pytest.approx(abs(other.crossings[at_camera].beam.widths[0] - behind))
    wide = light.crossings[at_lens].beam.widths[0]
    assert found[at_camera][0] == pytest.approx(wide * 200 / 100.3**2 * 0.5, rel=0.1)
    assert found[at_lens] == (0.0, 0.0, 0.0) and not uncertain(plain, trace(plain), trace)
