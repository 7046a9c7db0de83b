"""Parts with parameters of their own: read back, refused with their line, and lenses that follow their focal length."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pico.diagnostics import Diagnostic
from pico.manifest.load import load_folder
from pico.model.catalog import RADII, ComponentType, Parameter, with_parameters
from pico.model.lab import Lab
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.optics.light import light_of
from pico.resources import labs_dir

LENS = """
  extra:
    type: {kind}
    marker: 40
    home: storage/c1
    parameters: {{{given}}}
"""


def loaded(folder: Path, given: str, kind: str = "plano_convex") -> tuple[Setup | None, list[Diagnostic]]:
    """Return shel with one part more, and what is wrong with it."""
    folder.mkdir(exist_ok=True)
    (folder / "state").mkdir(exist_ok=True)
    source = labs_dir() / "shel"
    (folder / "lab.yaml").write_text((source / "lab.yaml").read_text() + LENS.format(kind=kind, given=given)[1:])
    (folder / "state/table.yaml").write_text((source / "state/table.yaml").read_text())
    found = load_folder(folder)
    return found.setup, [d for d in found.diagnostics if d.severity == "error"]


def loaded_folder(folder: Path, given: str) -> Path:
    loaded(folder, given)
    return folder


def _without_parameters(setup: Setup) -> Lab:
    inventory = {name: replace(part, parameters=None) for name, part in setup.lab.inventory.items()}
    return replace(setup.lab, inventory=inventory)


@pytest.mark.parametrize(
    ("given", "focal"), [("focal_length: 80", 80), ("focal_length: 8 cm", 80), ("focal_length: 1 m", 1e3)]
)
def test_a_part_has_parameters_of_its_own_in_the_unit_of_its_type(tmp_path: Path, given: str, focal: float) -> None:
    setup, wrong = loaded(tmp_path / "lab", given)
    assert setup and not wrong
    kind = setup.type_of("extra")
    assert kind.number("focal_length", "mm") == pytest.approx(focal) and kind is setup.type_of("extra")
    assert kind.title == f"Plano-convex lens; focal_length {focal:g} mm"
    assert setup.catalog["plano_convex"].number("focal_length", "mm") == 100


@pytest.mark.parametrize(
    ("kind", "given", "said", "hint"),
    [
        ("plano_convex", "focal_lenght: 80", "extra (plano_convex) has no parameter `focal_lenght`", "`focal_length`?"),
        ("plano_convex", "focal_length: 80 s", "`80 s` is a time, not a length", "its type has 100"),
        ("plano_convex", "focal_length: long", "`long` is not a quantity", "its type has 100"),
        ("plano_convex", "focal_length: 0", "`focal_length` is 0 mm", "other than 0"),
        ("plano_convex", "focal_length: 12", "no lens 22 mm wide and 3.6 mm thick", "expected beyond 21.4 mm"),
        ("plano_convex", "radius_of_curvature: 40", "has no parameter `radius_of_curvature`", ""),
        ("plano_convex", "form: 3", "is not a word", "its type has plano"),
        ("plano_convex", "form: round", "`form` is `round`", "`bi`, `plano`"),
        (
            "plano_convex_100",
            "radius_of_curvature: 41.2",
            "`radius_of_curvature` is its own",
            "give its `focal_length`",
        ),
        ("neutral_density_filter", "optical_density: -2", "`optical_density` is -2", "from 0 to 20"),
    ],
)
def test_what_a_part_cannot_have_is_told_at_its_line(
    tmp_path: Path, kind: str, given: str, said: str, hint: str
) -> None:
    (wrong,) = loaded(tmp_path / "lab", given, kind)[1]
    assert said in wrong.summary and hint in (wrong.hint or ""), wrong
    assert wrong.source and wrong.source.path.endswith("lab.yaml")
    assert given.split(":", maxsplit=1)[0] in wrong.source.snippet


def test_the_lab_is_another_where_a_parameter_is(tmp_path: Path) -> None:
    digests = {setup.digest() for n in (80, 90) if (setup := loaded(tmp_path / str(n), f"focal_length: {n}")[0])}
    assert len(digests) == 2
    written = ("80", "80.0", '"80 mm"', "8 cm", "0.08 m")
    digests = {s.digest() for n, w in enumerate(written) if (s := loaded(tmp_path / f"w{n}", f"focal_length: {w}")[0])}
    assert len(digests) == 1
    none = load_folder(loaded_folder(tmp_path / "none", "")).setup
    assert none and none.digest() == replace(none, lab=_without_parameters(none)).digest()
    plain = load_folder(labs_dir() / "shel").setup
    assert (
        plain and replace(plain, lab=replace(plain.lab, inventory=dict(plain.lab.inventory))).digest() == plain.digest()
    )


@given(
    st.sampled_from([("plano_convex", 1), ("biconvex", 1), ("plano_concave", -1)]), st.floats(40, 500), st.booleans()
)
def test_a_lens_has_the_focal_length_that_it_says(kind: tuple[str, int], focal: float, turned: bool) -> None:
    """A beam that comes parallel to the axis, h beside it, leaves at -h / f: within 1 %, thick as the lens is."""
    base, beside = SETUP, 0.2
    name, sign = kind
    part = replace(base.lab.inventory["lx_100"], type=name, parameters={"focal_length": sign * focal})
    catalog = {**base.catalog, name: CATALOG[name]}
    setup = replace(base, lab=replace(base.lab, inventory={**base.lab.inventory, "lx_100": part}), catalog=catalog)
    lens = Pose(335, 420 - beside, 180.0 if turned else 0.0)
    poses = {"laser": Pose(120, 420), "lx_100": lens, "cam": Pose(400, 420)}
    found = light_of(setup, poses, lit=lambda _: True)
    ahead, left, _ = found.crossings[1].beam.along
    assert -beside / (left / ahead) == pytest.approx(sign * focal, rel=0.01)


def _catalog() -> dict[str, object]:
    from pico.manifest.catalog import load_catalog

    return dict(load_catalog())


SETUP = load_folder(labs_dir() / "shel").require()[0]
CATALOG = _catalog()


@given(st.floats(20, 400), st.sampled_from(["plano_convex_100", "plano_convex_150_stage"]))
def test_the_radius_of_a_lens_follows_its_measured_focal_length(length: float, name: str) -> None:
    kind = SETUP.catalog[name]
    own = with_parameters(kind, {"focal_length": length})
    before, after = (one.number("radius_of_curvature", "mm") or 0.0 for one in (kind, own))
    assert after / before == pytest.approx(length / (kind.number("focal_length", "mm") or 0.0))
    both = with_parameters(kind, {"focal_length": length, "radius_of_curvature": 60.0})
    assert both.number("radius_of_curvature", "mm") == 60


@given(st.floats(30, 400), st.floats(30, 400), st.floats(1, 8), st.floats(0.5, 2))
def test_both_sides_of_a_lens_are_bent_alike(front: float, back: float, thick: float, share: float) -> None:
    """1/f = (n - 1) (1/R1 + 1/R2 - (n - 1) t / (n R1 R2)), for any lens, before and after."""
    index = 1.5151

    def strength(kind: ComponentType) -> float:
        one, other = (1 / (kind.number(r, "mm") or 0.0) for r in ("radius_of_curvature", "radius_of_curvature_back"))
        return (index - 1) * (one + other - (index - 1) * thick / index * one * other)

    def mm(value: float) -> Parameter:
        return Parameter(value=value, unit="mm")

    kind = replace(SETUP.catalog["plano_convex_100"], parameters={
        **SETUP.catalog["plano_convex_100"].parameters, "radius_of_curvature": mm(front),
        "radius_of_curvature_back": mm(back), "center_thickness": mm(thick),
    })  # fmt: skip
    kind = replace(kind, parameters={**kind.parameters, "focal_length": mm(1 / strength(kind))})
    own = with_parameters(kind, {"focal_length": share / strength(kind)})
    assert 1 / strength(own) == pytest.approx(share / strength(kind), rel=1e-9)
    ratio = [(own.number(r, "mm") or 0.0) / (kind.number(r, "mm") or 1.0) for r in RADII]
    assert ratio[0] == pytest.approx(ratio[1])
