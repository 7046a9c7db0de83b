"""Mutants made by hand, each a thing that somebody might get wrong and that would hurt: see `mutants.py --by-hand`."""

# ruff: noqa: E501 (a line of the product is quoted whole)
from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class ByHand:
    """What it means, text that stands once under `pico/`, what becomes of it, and the test file that kills it."""

    means: str
    right: str
    wrong: str
    tests: str


BY_HAND: tuple[ByHand, ...] = (
    ByHand("a laser that the plan turns on counts as dark",
        'return _read(seen, laser, "emission") is False and not lit', 'return _read(seen, laser, "emission") is False', "test_rules.py"),
    ByHand("a part turned in its place since is picked as planned",
        'if away > tolerance.position or turned > tolerance.yaw:\n            yield stale', 'if away > tolerance.position:\n            yield stale', "test_checks.py"),
    ByHand("the simulated hand picks what was turned in its place",
        "    if away > tolerance.position or turned > tolerance.yaw:\n        text = f\"{name} stands", "    if away > tolerance.position:\n        text = f\"{name} stands", "test_sim_backend.py"),
    ByHand("an arm may park while its move still runs",
        "after=tuple(op.id for op in own if op.id not in waited),", "after=(),", "test_plans.py"),
    ByHand("no margin between the goals of two parts",
        "return all(conflict(shape, end, margin) for end in ends)", "return all(conflict(shape, end, 0.0) for end in ends)", "test_refusals.py"),
    ByHand("no margin between a part that arrives and what stands there",
        "self._meeting(i, self.shape(i, place), self.setup.lab.margins.body)", "self._meeting(i, self.shape(i, place), 0.0)", "test_plans.py"),
    ByHand("a part is put into a slot that another covers meanwhile",
        "return mask | self._meeting(i, self._mouths.shapes[slot], 0.0) if slot else mask", "return mask", "test_plans.py"),
    ByHand("a part is put down meanwhile over the mouth of a slot in use",
        "mask |= users & ~self._ends_in if place in mover.finished else users", "pass", "test_plans.py"),
    ByHand("the fingers reach into a keep-out",
        'if any(reaches(k, lowest, float("inf")) and conflict(zone, outline(k)) for k in keep_out):', "if False:", "test_refusals.py"),
    ByHand("the fingers avoid a keep-out that ends below them",
        'if any(reaches(k, lowest, float("inf")) and conflict(zone, outline(k)) for k in keep_out):',
        "if any(conflict(zone, outline(k)) for k in keep_out):", "test_refusals.py"),
    ByHand("a keep-out has no heights",
        "return keep_out.z[0] <= highest and keep_out.z[1] >= lowest", "return True", "test_tables.py"),
    ByHand("a goal is refused for a keep-out above the part",
        "return [z for z in zones if reaches(keep_out[z], 0.0, height) and conflict(shape, outline(keep_out[z]))]",
        "return [z for z in zones if conflict(shape, outline(keep_out[z]))]", "test_refusals.py"),
    ByHand("a place is excluded for a keep-out above the part",
        "if any(reaches(k, 0.0, mover.geometry.height) and conflict(shape, outline(k)) for k in lab.keep_out.values()):",
        "if any(conflict(shape, outline(k)) for k in lab.keep_out.values()):", "test_refusals.py"),
    ByHand("a rule is told of a keep-out above the part",
        "zones = {k: z for k, z in setup.lab.keep_out.items() if reaches(z, 0.0, geometry.height)}", "zones = setup.lab.keep_out", "test_rules.py"),
    ByHand("the arm refuses a place for a keep-out above the part",
        "if gap < 0 and tabletop.reaches(zone, 0.0, geometry.height):", "if gap < 0:", "test_reach.py"),
    ByHand("the error of the calibration is left out of the uncertainty",
        "position=math.hypot(noise.position, accuracy.position)", "position=noise.position", "test_poses.py"),
    ByHand("the error of the calibration is left out of the uncertainty of the yaw",
        "yaw=math.hypot(noise.yaw, accuracy.yaw)", "yaw=noise.yaw", "test_poses.py"),
    ByHand("a rigid fit may mirror",
        "np.diag([1.0, 1.0, np.linalg.det(u @ vt)])", "np.diag([1.0, 1.0, 1.0])", "test_rigid.py"),
    ByHand("what the lens bends is bent the other way",
        "view.marker.corners - (fitted - corners)", "view.marker.corners + (fitted - corners)", "test_poses.py"),
    ByHand("a part may stand with its mass over its edge",
        "if edge < EDGE:", "if edge < 0:", "test_blocked.py"),
    ByHand("the edge that a part must keep is twice as wide",
        "EDGE = 3.0", "EDGE = 6.0", "test_blocked.py"),
    ByHand("nothing is too tall for the room above the fingers",
        "if above > room:", "if above > 2 * room:", "test_reach.py"),
    ByHand("the jaws need no time to settle",
        "return abs(opening - width) / JAW_SPEED + JAW_SETTLE", "return abs(opening - width) / JAW_SPEED", "test_timing.py"),
    ByHand("a merge may lose comments",
        "return all(held[comment] >= times for comment, times in plan.remarks.items())", "return True", "test_merge.py"),
    ByHand("a comment that one side added is lost in a merge entry by entry",
        "return [*blank, *kept, *shared, *(line for block in sorted(added) for line in block)]", "return [*blank, *kept, *shared]", "test_merge.py"),
    ByHand("true equals 1 in a merge",
        "value = node.value\n        number = isinstance(value, int | float) and not isinstance(value, bool)", "value = node.value\n        number = isinstance(value, int | float)", "test_merge.py"),
    ByHand("events of another run are told as those of this one",
        "if event.run == self._run:", "if event.run is not None:", "test_run.py"),
    ByHand("any run renews the lease of another one",
        "if row.grant is None or not job or row.grant.job != job:", "if row.grant is None or not job:", "test_lease_rules.py"),
    ByHand("a dose counts the light after an operation alone",
        "dose, before = dose + max(before, power) * seconds, power", "dose, before = dose + power * seconds, power", "test_sample_doses.py"),
    ByHand("a dose forgets what was spent",
        "if one.budget is None or one.spent + dose <= one.budget:", "if one.budget is None or dose <= one.budget:", "test_sample_doses.py"),
    ByHand("a quiet client saves up requests for ever",
        "return min(self.burst, had + max(0.0, now - then) * self.per_second)", "return had + max(0.0, now - then) * self.per_second", "test_rates.py"),
    ByHand("a power that is raised is classed at the lower of before and after",
        "own[tunable] = max(before, to) if _number(before)", "own[tunable] = min(before, to) if _number(before)", "test_light_let_out.py"),
    ByHand("an unattended client is given up after its own time, however short",
        "max(terms.every, SILENCE) + GRACE", "terms.every + GRACE", "test_alone_rules.py"),
    ByHand("an object that cannot be read counts as damaged",
        'if exc.diagnostics[0].code != "data-damaged":\n                raise', 'if exc.diagnostics[0].code != "data-damaged":\n                return False', "test_intact.py"),
    ByHand("a mount that stops short of its goal has reached it",
        "if abs(at - position) > REACHED:", "if at - position > REACHED:", "test_stopping_short.py"),
    ByHand("a stage that stops short of its goal has reached it",
        "if abs(at - position) * abs(self._counts) > _REACHED:", "if (at - position) * abs(self._counts) > _REACHED:", "test_stopping_short.py"),
    ByHand("a power that was not read back counts as that of the smallest laser",
        "numbers = (own,) if _number(own) else tunable.range or (math.inf,)", "numbers = (own,) if _number(own) else (otherwise,)", "test_laser_classes.py"),
    ByHand("a mount of a real bench that reads short of its goal has reached it",
        "if value_distance(kind, value, goal) > max(kind.tolerance, 1e-9):", "if value - goal > max(kind.tolerance, 1e-9):", "test_light_and_inputs.py"),
)  # fmt: skip
