"""The beam audit: hazards planted on the shipped benches are found, each by its branch; what is harmless is let be."""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from dataclasses import replace

import pytest
from audited import Bench, carrying, plan_of, said, setting, shipped, states

from pico.diagnostics import Diagnostic
from pico.model.catalog import Axis
from pico.model.operation import Operation, Reason
from pico.optics.audit.audit import audit
from pico.optics.audit.branches import Branches
from pico.optics.audit.limits import class_1, class_of
from pico.optics.audit.plane import _steep, elevation
from pico.optics.light import light_of
from pico.policy.audit import audit_of


def shel(p1: float = 45.5, p2: float = 45.5) -> Bench:
    """The bench of the case study with its polarizers along the light, 1.26 mW behind them."""
    return shipped("shel").set("p1", angle=p1).set("p2", angle=p2)


def two_arms() -> Bench:
    return shipped("two_arms").set("p1", angle=0).set("p2", angle=0)


def minimal() -> Bench:
    return shipped("minimal")


def folded(trap: tuple[float, float] = (0.0, 0.0), yaw: float = -90.0, tilt: float = 5.0) -> Bench:
    """The beam folded to the front by a mirror of a range of tilt [mrad], into a trap moved by (x, y)."""
    bench = shel().put("fold", "mirror_tip_tilt", 700, 420, 45, tilt=(-tilt, tilt)).set("fold", tip=0, tilt=0)
    return bench.put("trap", "beam_block", 700 + trap[0], 200 + trap[1], yaw)


def two_folds(tilt: float = 7.0) -> Bench:
    """The beam folded to the back and to the right again, into a trap."""
    bench = folded(tilt=tilt).move("fold", dyaw=-90).without("trap").put("end", "beam_block", 1000, 600)
    return bench.put("m", "mirror_tip_tilt", 700, 600, 135, tilt=(-tilt, tilt)).set("m", tip=0, tilt=0)


def divided(kind: str = "beam_splitter_50_50") -> Bench:
    return shel().put("bs", kind, 400, 420)


def strong(power: float) -> Bench:
    return shel().made("laser", power=power).made("p1", damage_threshold=None).made("p2", damage_threshold=None)


def brighter(bench: Bench) -> Bench:
    """The same with a laser of class 3B, for which mirrors count over their full range, and no housing ends a beam."""
    return bench.made("laser", power=6.0)


def tilted_glass(power: float, **parameters: object) -> Bench:
    glass = {"optical_density": 0.0, "thickness": 2.0, "refractive_index": 1.5, **parameters}
    return strong(power).put("window", "neutral_density_filter", 400, 420, 20, **glass)


def polarizer_cube(**parameters: object) -> Bench:
    return shel(p2=135).made("p2", rejected="reflected", **parameters)


HAZARDS: dict[str, tuple[Callable[[], Bench], str]] = {
    "the camera is gone": (lambda: shel().without("cam"), "laser → hwp → p1 → p2 → leaves the table at (1200, 420)"),
    "the camera beside its aperture": (
        lambda: brighter(shel()).move("cam", dy=9), "p2 → ends on the housing of cam at (1030"),
    "the camera turned away": (lambda: brighter(shel()).move("cam", dyaw=90), "p1 → p2 → ends on the housing of cam"),
    "a camera that ends nothing": (
        lambda: shel().made("cam", ends=False), "p2 → ends on cam, which is not declared to end beams"),
    "a rejected port of a splitter": (divided, "laser → hwp → p1 → bs → leaves the table at (400, 900)"),
    "a rejected port of a polarizing splitter": (
        lambda: divided("polarizing_beam_splitter"), "p1 → bs → leaves the table at (400, 900)"),
    "the reflected part of a polarizer cube": (polarizer_cube, "hwp → p1 → p2 → leaves the table at (520, 900)"),
    "the face of an uncoated lens": (
        lambda: strong(40).put("bare", "plano_convex_125", 400, 420, 180, coating="none"),
        "laser → hwp → p1 → bare → p1 → hwp → comes back to laser"),
    "an uncoated window": (
        lambda: strong(40).put("window", "sample_holder", 400, 420, 25, refractive_index=1.5, coating="none"),
        "p1 → window → ends on the housing of lx_125"),
    "a ghost of a plate": (lambda: tilted_glass(40, coating="none"), "p1 → window → ends on the housing of lx_125"),
    "faces that are coated, before a strong laser": (
        lambda: tilted_glass(100), "p1 → window → ends on the housing of lx_125"),
    "a mirror in the beam": (
        lambda: shel().put("m", "mirror_tip_tilt", 700, 420, 45, tilt=(-1, 1)),
        "p2 → m → leaves the table at (700, 0)"),
    "a mirror square to the beam": (
        lambda: shel().put("m", "mirror_tip_tilt", 400, 420, 0, tilt=(-1, 1)), "m → p1 → hwp → comes back to laser"),
    "a mirror that may be tilted": (
        lambda: brighter(folded(tilt=70)),
        "fold → may leave the plane of the table by 106 mrad (fold.tip = -70, fold.tilt = -70) and"),
    "a mirror that is tilted": (
        lambda: folded(tilt=5).made("fold", tilt=(-60.0, 0.0)).set("fold", tilt=-40), "fold → may leave the plane"),
    "two mirrors that may be tilted a little each": (
        lambda: brighter(two_folds()), "fold → m → may leave the plane of the table by 2"),
    "the trap is gone": (lambda: folded().without("trap"), "p2 → fold → leaves the table at (700, 0)"),
    "the trap moved by its radius": (lambda: folded((6.35, 0)), "p2 → fold → ends beside the opening of trap"),
    "the trap from the side": (lambda: folded(yaw=0), "p2 → fold → comes to trap from the side"),
    "the trap from behind": (lambda: folded(yaw=90), "p2 → fold → comes to trap from the side"),
    "a laser that no eye sees": (
        lambda: shel().without("cam").made("laser", wavelength=780.0, power=1.5),
        "p2 → leaves the table at (1200, 420)"),
    "a laser of which no limit is known": (
        lambda: shel().without("cam").made("laser", wavelength=12000.0, power=0.1),
        "no limit is known at its wavelength"),
    "too much power on a polarizer": (lambda: shel().made("laser", power=900.0), "laser → hwp → damages p1: "),
    "too much in the focus on a camera": (
        lambda: minimal().made("laser", power=4.5), "laser → lens → damages camera: 719 mW/mm², above the"),
    "the leaves of an iris": (
        lambda: brighter(two_arms()).set("iris_in", opening=0.4),
        "laser → p1 → is stopped in part by the edge of iris_in"),
    "a lens turned across": (
        lambda: brighter(two_arms()).move("in_100", dyaw=90), "iris_in → ends on the housing of in_100"),
    "a sample beside the beam": (lambda: two_arms().move("sample", dy=15), "in_100 → ends on the housing of sample"),
    "a lens beside the beam": (lambda: brighter(minimal()).move("lens", dy=9), "lens → ends on the housing of camera"),
    "a laser turned": (lambda: minimal().move("laser", dyaw=6), "laser → leaves the table at (1200"),
    "mirrors that face one another": (
        lambda: shipped("crowded"), "mirror_3 → pol_1 → iris_1 → lens_60 → lens_100 → hwp → comes back to laser"),
    "what passes a mirror": (
        lambda: folded().made("fold", transmittance=0.4).without("cam"), "fold → leaves the table at (1200, 420)"),
    "a closed shutter that is declared to end nothing": (
        lambda: shel().put("gate", "shutter", 400, 420, ends=False).set("gate", shutter="closed"),
        "p1 → ends on gate, which is not declared"),
    "a mirror that may be flipped into the beam": (
        lambda: shel().put("flip", "mirror_flip", 700, 420, 45, tilt=(-1, 1)),
        "p2 → flip → leaves the table at (700, 0)"),
    "a mirror that may be flipped out of the beam": (
        lambda: shel().without("cam").put("flip", "mirror_flip", 700, 420, 45, tilt=(-1, 1)).put(
            "trap", "beam_block", 700, 200, -90),
        "p2 → flip → leaves the table at (1200, 420)"),
    "a wave plate at an angle that nobody knows": (
        lambda: divided("polarizing_beam_splitter").unset("hwp", "angle").unset("p1", "angle").without("p1").put(
            "trap", "beam_block", 1000, 420),
        "hwp → bs → leaves the table at (400, 900)"),
    "a part that keeps light": (
        lambda: shel().put("box", "neutral_density_filter", 400, 420, element="unheard_of"), "is kept by box"),
}  # fmt: skip


@pytest.fixture
def _unheard_of(monkeypatch: pytest.MonkeyPatch) -> None:
    """An element of a plug-in that weakens light, and says nothing else."""
    from pico.optics import following
    from pico.optics.elements import filter as known

    class UnheardOf:
        meet = staticmethod(known.meet)

    found = following.element
    monkeypatch.setattr(following, "element", lambda name: UnheardOf if name == "unheard_of" else found(name))


@pytest.mark.usefixtures("_unheard_of")
@pytest.mark.parametrize("name", HAZARDS)
def test_a_plan_that_opens_a_laser_onto_a_hazard_is_refused_and_the_branch_named(name: str) -> None:
    make, branch = HAZARDS[name]
    refused = [d.summary for d in said(make()) if d.severity == "error"]
    assert any(branch in text for text in refused), (branch, refused)


def test_what_nobody_knows_is_told_with_the_branch_that_hangs_on_it() -> None:
    (found,) = said(HAZARDS["a mirror that may be flipped out of the beam"][0]())
    assert found.hint.startswith("nobody knows flip.flipped: here it is down; ")


def test_there_are_thirty_and_each_is_of_a_shipped_bench() -> None:
    assert len(HAZARDS) >= 30


HARMLESS: dict[str, Callable[[], Bench]] = {
    **{f"{lab} {tag}": (lambda lab=lab, tag=tag: states(lab)[tag])  # type: ignore[misc]
       for lab in ("shel", "minimal", "two_arms") for tag in states(lab)},
    "polarizers along the light": shel,
    "polarizers crossed": lambda: shel(p2=135),
    "two_arms with all its light": two_arms,
    "the camera a little aside": lambda: shel().move("cam", dy=3),
    "a splitter with a trap": lambda: divided().put("trap", "beam_block", 400, 600, 90),
    "a polarizing splitter with a trap": lambda: divided("polarizing_beam_splitter").put(
        "trap", "beam_block", 400, 600, 90),
    "a polarizer cube with a trap": lambda: polarizer_cube().put("trap", "beam_block", 520, 600, 90),
    "a polarizer cube at a weak laser": lambda: polarizer_cube().made("laser", power=0.4),
    "a fold into a trap": folded,
    "two folds of little range": lambda: two_folds(4.0),
    "a trap half its radius aside": lambda: folded((3.0, 0)),
    "a trap further away": lambda: folded((0, -100)),
    "a mirror of all ranges before a wall": lambda: folded(tilt=70).without("trap").put(
        "wall", "beam_block", 700, 330, -90, opening=None, diameter=None),
    "an uncoated window at 2 mW": lambda: tilted_glass(2.0, coating="none"),
    "coated faces at 15 mW": lambda: tilted_glass(15),
    "an iris that stops little": lambda: two_arms().set("iris_in", opening=1.0),
    "a mirror that is flipped out of the beam": lambda: shel().put(
        "flip", "mirror_flip", 700, 420, 45, tilt=(-1, 1)).set("flip", flipped="down"),
    "a mirror that may be flipped, each way into a trap": lambda: shel().put(
        "flip", "mirror_flip", 700, 420, 45, tilt=(-1, 1)).put("trap", "beam_block", 700, 200, -90),
    "a weak end": lambda: shel().without("cam").put("nd", "neutral_density_filter", 700, 420),
    "a strong laser whose head takes what comes back": lambda: strong(40).made("laser", ends=True),
    "an open end of class 1": lambda: shel().without("cam").made("laser", power=0.39),
    "a mirror that leaks little": lambda: folded().made("fold", transmittance=0.02).without("cam"),
    "an infrared laser that ends": lambda: shel().made("laser", wavelength=780.0, power=1.5),
    "a closed shutter": lambda: shel().without("cam").put("gate", "shutter", 400, 420).set("gate", shutter="closed"),
    "mirrors behind crossed polarizers": lambda: shipped("crowded").set("pol_1", angle=-45),
}  # fmt: skip


@pytest.mark.parametrize("name", HARMLESS)
def test_a_plan_that_opens_a_laser_onto_nothing_dangerous_is_not_refused(name: str) -> None:
    assert not [d.summary for d in said(HARMLESS[name]())]


def test_there_are_as_many_harmless_ones() -> None:
    assert len(HARMLESS) >= len(HAZARDS)


def test_a_laser_up_to_class_2_is_warned_of_and_opened() -> None:
    for bench in (shel().without("cam").made("laser", power=1.0), folded().without("trap").made("laser", power=0.99)):
        assert {d.severity for d in said(bench)} == {"warning"}


def opened_beam(power: float = 2.0) -> Bench:
    return shel().made("laser", power=power).policy(open_beam=True).set("laser", emission=True, shutter="open")


def test_a_part_that_is_carried_through_an_open_beam_is_refused_above_class_2() -> None:
    bench = opened_beam()
    (found,) = said(bench, carrying(bench, "p1", dx=20))
    assert found.severity == "error" and "sent anywhere by p1 while arm1 carries it: 2 mW, class 3R" in found.summary
    shut = setting("laser", "shutter", "closed")
    assert not list(said(bench, shut, carrying(bench, "p1", "op1", dx=20)))
    weak = opened_beam(1.0)
    assert not [d for d in said(weak, carrying(weak, "p1", dx=20)) if d.severity == "error"]


def test_a_raster_search_counts_at_every_value_that_it_takes() -> None:
    bench = shel(p2=135).without("cam").set("laser", emission=True, shutter="open")
    scan = setting("p2", "angle", None, primitive="scan")
    assert not list(said(bench, setting("p1", "angle", 45.5)))
    assert any("p2 → leaves the table" in d.summary for d in said(bench, scan) if d.severity == "error")
    mirrors = folded(tilt=70).set("laser", emission=True, shutter="open")
    scan = setting("fold", "tilt", None, primitive="scan")
    assert any("may leave the plane" in d.summary for d in said(mirrors, scan) if d.severity == "error")


def test_a_search_is_refused_in_a_corner_that_no_tunable_reaches_alone_and_the_direction_is_named() -> None:
    bench = shel(p2=135).without("cam").set("laser", emission=True, shutter="open").set("p1", angle=45.0)

    def search(**bounds: tuple[float, float]) -> list[Diagnostic]:
        what = {"tunables": {name.replace("_", "."): value for name, value in bounds.items()}}
        sought = setting("p1", "angle", None, primitive="optimize")
        return [d for d in said(bench, replace(sought, arguments={"goal": "g", "what": what})) if d.severity == "error"]

    assert not search(p1_angle=(45, 65)) and not search(p2_angle=(115, 135))
    (found,) = search(p1_angle=(45, 65), p2_angle=(115, 135))
    assert "p2 → leaves the table" in found.summary
    assert "the search can reach this at p1.angle at 65, p2.angle at 115" in found.hint


def test_what_an_optimization_may_set_counts_over_all_of_its_bounds() -> None:
    bench = shel(p2=135).without("cam").set("laser", emission=True, shutter="open")
    for high, wrong in ((136.0, False), (225.0, True)):
        sought = replace(
            setting("p2", "angle", None, primitive="optimize"),
            arguments={"goal": "g", "what": {"tunables": {"p2.angle": (134.0, high)}}},
        )
        errors = [d.summary for d in said(bench, sought) if d.severity == "error"]
        assert any("p2 → leaves the table" in text for text in errors) is wrong


def test_what_only_closes_or_opens_nothing_is_warned_of() -> None:
    bench = shel().without("cam").set("laser", emission=True, shutter="open")
    assert {d.severity for d in said(bench, setting("hwp", "angle", 22.75))} == {"warning"}
    assert not list(said(bench, setting("laser", "shutter", "closed")))
    assert not list(said(bench, setting("laser", "emission", False)))


def test_a_laser_that_is_opened_and_closed_again_within_a_plan_counts_as_opened() -> None:
    bench = shel().without("cam").set("laser", emission=True, shutter="closed")
    both = (setting("laser", "shutter", "open"), setting("laser", "shutter", "closed", 2))
    assert {d.severity for d in said(bench, *both)} == {"error"}


def test_a_shutter_on_the_table_that_opens_lets_light_out() -> None:
    bench = shel().without("cam").set("laser", emission=True, shutter="open")
    bench = bench.put("gate", "shutter", 400, 420).set("gate", shutter="closed")
    assert not list(said(bench, setting("hwp", "angle", 22.75)))
    assert {d.severity for d in said(bench, setting("gate", "shutter", "open"))} == {"error"}


def test_in_an_enclosure_it_is_only_told() -> None:
    assert {d.severity for d in said(shel().without("cam").policy(enclosed=True))} == {"warning"}


def test_beams_of_one_laser_that_end_together_are_added_up() -> None:
    """The arms of a Michelson interferometer each send 0.34 mW to the open port: in phase, four times as much."""
    bench = divided().without("p2").without("cam")
    for name, x, y, yaw in (("far", 700, 420, 0), ("side", 400, 600, 90)):
        bench = bench.put(name, "mirror_tip_tilt", x, y, yaw, tilt=(-1, 1)).set(name, tip=0, tilt=0)
    bench = bench.without("ly_200")
    (found,) = [d.summary for d in said(bench) if "leaves the table at (400, 0)" in d.summary]
    assert "side → bs → leaves the table at (400, 0): 1.36 mW" in found.replace("far", "side")


def test_no_turn_of_mirrors_within_their_range_lifts_a_beam_above_its_bound() -> None:
    bench = two_folds(30.0).set("laser", emission=True, shutter="open")

    def branches(changed: Bench) -> Branches:
        light = light_of(changed.setup, changed.poses, changed.values, astray=lambda _: 0.039)
        return Branches(changed.setup, light, "laser", "3B", 0.39)

    nominal = branches(bench)
    bounds = {nominal.light.crossings[n].component: rise for n, rise in _steep(nominal)}
    assert set(bounds) == {"m", "end"}
    draw, found = random.Random(1), dict.fromkeys(bounds, 0.0)
    for _ in range(40):
        turned = bench
        for name in ("fold", "m"):
            turned = turned.set(name, tip=draw.choice((-30, 0, 30)), tilt=draw.choice((-30, draw.uniform(-30, 30), 30)))
        for crossing in branches(turned).light.crossings:
            after = crossing.before is not None and nominal.light.crossings[crossing.before].component
            if after in ("fold", "m"):
                goal = "m" if after == "fold" else "end"
                found[goal] = max(found[goal], abs(elevation(crossing)))
    for goal, bound in bounds.items():
        assert 0.8 * bound < found[goal] <= 1.01 * bound, goal


@pytest.mark.parametrize(
    ("index", "coating", "share"), [(1.5, "none", 0.04), (1.7, "none", 0.49 / 7.29), (1.5, "v", 0.005)]
)
def test_the_faces_of_a_window_send_back_what_fresnel_says(index: float, coating: str, share: float) -> None:
    bench = shel().put("window", "sample_holder", 700, 420, 0, refractive_index=index, coating=coating)
    light = light_of(bench.setup, bench.poses, bench.values, lit=lambda _: True, astray=lambda _: 1e-3)
    (window,) = (n for n, c in enumerate(light.crossings) if c.component == "window" and not c.beam.ghost)
    (back,) = (c for c in light.crossings if c.before == window and c.beam.ghost)
    assert back.power == pytest.approx(2 * share * light.crossings[window].power, rel=1e-6)
    assert back.beam.along == pytest.approx([-1, 0, 0], abs=1e-9)


def test_a_part_without_a_threshold_is_said_to_be_unjudged() -> None:
    bench = shel().made("p1", damage_threshold=None).set("laser", emission=True, shutter="open")
    assert audit(bench.setup, bench.poses, bench.values).unjudged == ("p1",)


@pytest.mark.parametrize(("power", "wavelength", "name"), [
    (0.39, 633, "1"), (0.4, 633, "2"), (1.0, 400, "2"), (1.01, 700, "3R"), (5.0, 633, "3R"), (5.1, 633, "3B"),
    (500, 633, "3B"), (501, 633, "4"), (0.6, 800, "1"), (0.7, 800, "3R"), (3.0, 800, "3R"), (3.2, 800, "3B"),
    (1e-3, 1064, "1"), (1e-3, 399, "1"), (0.039, 405, "1"), (1e-3, 179, "4"), (1e-3, 10700, "4"),
])  # fmt: skip
def test_classes_are_those_of_the_standard(power: float, wavelength: float, name: str) -> None:
    assert class_of(power, wavelength) == name


def test_the_limit_of_class_1_grows_tenfold_in_500_nm_of_infrared() -> None:
    assert class_1(700) == class_1(500) == 0.39
    assert math.isclose(class_1(1050) or 0, 0.39 * 10**0.7)
    assert class_1(10700) is None and class_1(179) is None


def test_where_no_laser_shines_nothing_is_asked() -> None:
    bench = shel().set("laser", emission=False)

    def never(*_: object) -> None:
        raise AssertionError("it was traced")

    plan = plan_of(bench, setting("hwp", "angle", 22.75))
    verdict, _ = audit_of(bench.setup, plan, bench.seen, never)
    assert verdict.passes and not verdict.lasers


def test_what_stands_within_tolerance_of_where_it_is_wanted_counts_as_there() -> None:
    """So the verdict that is kept of a state is found again for each look at it."""
    bench, asked = shel().set("laser", emission=True, shutter="open"), []
    operation: Operation = setting("hwp", "angle", 22.75)
    state = {n: {"pose": {"x": p.x, "y": p.y, "yaw": p.yaw}, **bench.values.get(n, {})} for n, p in bench.poses.items()}
    for dy in (0.0, 0.1):
        plan = plan_of(bench, operation)
        plan = replace(plan, target=replace(plan.target, state=state))
        audit_of(bench.setup, plan, bench.move("p1", dy=dy).seen, lambda _, lit: asked.append(lit))
    assert asked[0].poses == asked[1].poses


def test_a_declaration_of_a_lab_is_in_its_digest_and_those_of_the_catalog_are_as_they_were() -> None:
    """Plans of earlier releases stay fresh, and a bench that keeps its Lab notices what is declared anew."""
    bench = shel().put("mine", "linear_polarizer", 700, 420)
    before = bench.made("mine").setup.digest()
    assert bench.made("mine", ends=True).setup.digest() != before
    assert bench.made("mine", damage_threshold=7.0).setup.digest() != before
    catalog = {**bench.setup.catalog}
    catalog["beam_camera"] = replace(
        catalog["beam_camera"], optics=replace(catalog["beam_camera"].optics, ends_beams=None)
    )
    assert replace(bench.setup, catalog=catalog).digest() == bench.setup.digest()


ORDINARY: dict[str, Callable[[], Bench]] = {
    "a camera beside its aperture": lambda: shel().move("cam", dy=9),
    "a camera turned away": lambda: shel().move("cam", dyaw=90),
    "a lens turned across": lambda: two_arms().move("in_100", dyaw=90),
    "the leaves of an iris": lambda: two_arms().set("iris_in", opening=0.4),
    "a mirror with a long screw": lambda: folded(tilt=70),
    "two mirrors that may be tilted": lambda: two_folds(70.0),
}


@pytest.mark.parametrize("name", ORDINARY)
def test_housings_and_long_screws_are_hazards_above_class_3r_only(name: str) -> None:
    bench = ORDINARY[name]()
    assert not [d.summary for d in said(bench)]
    assert {d.severity for d in said(brighter(bench)) if "damages" not in d.summary} == {"error"}


def test_a_part_that_the_lab_says_ends_no_beam_does_not_up_to_class_3r_either() -> None:
    bench = shel().move("cam", dy=9)
    lab = bench.setup.lab
    shiny = replace(lab.inventory["cam"], ends_beams=False)
    bench = replace(bench, setup=replace(bench.setup, lab=replace(lab, inventory={**lab.inventory, "cam": shiny})))
    assert [d.severity for d in said(bench) if "ends on the housing of cam" in d.summary] == ["error"]


@pytest.mark.parametrize("axis", ["homed", "open_loop"])
def test_a_mirror_whose_angle_is_unknown_counts_over_its_full_range_at_any_class(axis: str) -> None:
    bench = folded(tilt=70)
    if axis == "open_loop":
        kind = bench.setup.type_of("fold")
        tilt = replace(kind.tunables["tilt"], axis=Axis(kind="open_loop", speed=60))
        kind = replace(kind, tunables={**kind.tunables, "tilt": tilt})
        bench = replace(bench, setup=replace(bench.setup, catalog={**bench.setup.catalog, kind.name: kind}))
    else:
        bench = bench.unset("fold", "tilt")
    assert any("fold → may leave the plane" in d.summary for d in said(bench) if d.severity == "error")


@pytest.mark.parametrize(
    ("before", "to", "wrong"), [(0.0, 2.0, False), (0.0, 40.0, True), (40.0, 0.0, True), (-40.0, 40.0, True)]
)
@pytest.mark.parametrize("tunable", ["tip", "tilt"])
def test_a_mirror_that_is_driven_in_light_counts_over_all_that_it_passes(
    tunable: str, before: float, to: float, wrong: bool
) -> None:
    bench = folded(tilt=70).set("laser", emission=True, shutter="open").set("fold", **{tunable: before})
    driven = setting("fold", tunable, to)
    assert ("error" in {d.severity for d in said(bench, driven)}) is wrong
    shut = bench.set("laser", shutter="closed")
    opened = replace(setting("laser", "shutter", "open", 2), after=("op1",))
    assert ("error" in {d.severity for d in said(shut, driven, opened)}) is (to == 40.0)


def test_homing_a_mirror_in_light_counts_over_its_full_range() -> None:
    bench = folded(tilt=70).set("laser", emission=True, shutter="open")
    home = Operation(id="home", primitive="home", component="fold", reason=Reason(kind="asked"))
    assert "error" in {d.severity for d in said(bench, home)}
    assert not list(said(bench.set("laser", shutter="closed"), home))


def test_what_a_search_finds_wrong_is_one_error_with_a_count() -> None:
    bench = shel(p2=135).without("cam").set("laser", emission=True, shutter="open")
    bench = bench.put("bs", "beam_splitter_50_50", 700, 420)
    sought = replace(
        setting("p2", "angle", None, primitive="optimize"),
        arguments={"goal": "g", "what": {"tunables": {"p2.angle": (134.0, 225.0)}}},
    )
    (found,) = said(bench, sought)
    assert found.severity == "error" and "the most powerful of 2 such branches" in found.summary
    assert found.hint.count("the search can reach this at p2.angle at") == 1
