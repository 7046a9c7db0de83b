"""The paper's table: experiments in which three states are restored, how long that takes, and what came back.

An experiment builds the commit graph of the case study on a new bench: C1 to E1-3, back to C3 (graph distance ratio
3/2), E2-1 to E2-3, back to E2-1 (2/3), E3-1 and E3-2, back to E1-1 (4/3). The arm builds commit by commit; the
polarizers are nulled by light at C2 and C3, goals are aligned, and of states that are to come back light and shift are
recorded. Two histories are made so: one of the bench as it ships, and one of a bench whose first lenses are on stages.

A restoration is `apply --align` of a commit. It succeeds where the bench is as the commit says, its goals are aligned
again, the camera has 95 % of the recorded light against the laser's own monitor, the spot is within 5 um where a goal
of the state puts it by its axes, the differential shift is within 1 um, and it took no longer than 1.15 times its
bound. The shift is half the way of the spot from one side of crossed to the other; after E2-1 and E1-1 it is measured
in E2-3 and E1-3, built again from there. There p2 is put down until it is seen tilted to 0.03 deg, before and after a
restoration: its seat repeats to 0.05 deg, 0.2 um of the shift. Without a stage that centres it the first lens
does as much, by 0.1 mm; `pico budget --repeats` tells that, and nothing of it is noise. Where no axis reaches the spot,
it is where the placement of parts puts it, as PICO says by how they are seen to stand now against then: those farther
off from there than 2.49 standard deviations of what is not seen, both axes taken together, are counted; one in 22 is by
chance.

The bound is reckoned before anything moves, from the bench as it is seen and the state that is wanted. Travel: the
least time that the arm needs for these moves in any order, its hand and its parking included, or the slowest motor.
Settling: the table once for each look, a goal's axes once, what a goal wanted otherwise set back; a goal takes two
looks, for what is off and for that it no longer is, and what the commit recorded takes one. Exposures: one a look.

Rebuilding is counted as it was built, from C1 on. The percentage is the seconds of a restoration over those of
rebuilding; without alignment neither counts what light took. Slow alignment makes it small: it informs, and is no bar.

    python benchmarks/restoration.py [--experiments 5] [--first 1] [--fidelity kinematic] [--history staged]
                                     [--only C3] [--dark] [--coarse]
"""

from __future__ import annotations

import argparse
import math
import statistics
import subprocess
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import astuple, dataclass, field, replace
from itertools import pairwise
from pathlib import Path

from restoring_light import KEPT, LIKELY, MEASURED, NEAR, bench_of, git

from pico.backends.sim.session import SETTLING
from pico.bench.bench import Bench
from pico.model.plan import Plan
from pico.model.primitive import primitive
from pico.model.setpoint import set_seconds
from pico.model.trace.report import RunReport
from pico.recipes.recipes import Recipes
from pico.runs.operations import operations

SLOWEST, SHIFTED = 1.15, 1.0
"""How much longer than its bound a restoration may take; how far the differential shift may be from before [um]."""
COARSE = "    parameters: {pixels_across: 612, pixels_up: 512, pixel_size: 13.8, full_well: 168000}\n"
"""The camera with 4 x 4 pixels read as one."""
TILTED = 0.03
"""How far p2 may be from its tilt where the shift is measured [deg]: one placement in two is as near."""
GOALS = {"E1-1": "lx_125_centred", "E1-2": "ly_150_centred", "E2-1": "lx_100_centred", "E2-2": "ly_150_centred",
         "E3-1": "ly_200_centred"}  # fmt: skip
"""What is aligned when a state is built, as in the recipe; a first lens only where it is on stages."""
KINDS = ("moving", "settling", "aligning", "measuring")
HISTORIES = {"shipped": True, "staged": False}
"""Whether the first lenses are passive."""


@dataclass(frozen=True)
class Restored:
    """A restoration of the paper: from where, along which commits the state was built, the share of the graph; the
    state at it or `beyond` in which the shift is measured, and the lenses there [mm]."""

    tag: str
    after: str
    ratio: str
    paper: float
    way: tuple[str, ...]
    beyond: str
    first: float
    second: float = 150.0


NONE = 1e9
"""The focal length of no lens [mm]."""
TABLE = (
    Restored("C3", "E1-3", "3/2", 27.8, ("C2", "C3"), "C3", NONE, NONE),
    Restored("E2-1", "E2-3", "2/3", 11.9, ("C2", "C3", "E2-1"), "E2-3", 100),
    Restored("E1-1", "E3-2", "4/3", 20.6, ("C2", "C3", "E1-1"), "E1-3", 125),
)
ORDER = ("C1", "C2", "C3", "E1-1", "E1-2", "E1-3", ">C3", "E2-1", "E2-2", "E2-3", ">E2-1", "E3-1", "E3-2", ">E1-1")
"""The paper's experiment; > is a restoration."""


@dataclass(frozen=True)
class Spent:
    """Simulated seconds by kind; while several things go on, those of the first kind."""

    moving: float = 0.0
    settling: float = 0.0
    aligning: float = 0.0
    measuring: float = 0.0

    def __add__(self, other: Spent) -> Spent:
        return Spent(*(a + b for a, b in zip(astuple(self), astuple(other), strict=True)))

    @property
    def total(self) -> float:
        return float(sum(astuple(self)))

    @property
    def unaligned(self) -> float:
        """Without what light took."""
        return self.moving + self.settling


@dataclass(frozen=True)
class Bound:
    """What a restoration takes at least [s]."""

    travel: float = 0.0
    settling: float = 0.0
    exposures: float = 0.0

    @property
    def total(self) -> float:
        return float(sum(astuple(self)))


@dataclass(frozen=True)
class Came:
    """How a restoration ended: `spent` and its `bound`; what `rebuilding` took; the `share` of the light; how far the
    spot is `off` and may be (`open_to`), in um where a goal puts it, else in standard deviations of what is predicted;
    by how much the shift is `shifted` [um], and one standard deviation of that; `why` it did not come back."""

    of: Restored
    why: str = ""
    spent: Spent = field(default_factory=Spent)
    bound: Bound = field(default_factory=Bound)
    rebuilding: Spent = field(default_factory=Spent)
    share: float = math.nan
    off: float = math.nan
    open_to: float = math.nan
    shifted: float = math.nan
    sigma: float = math.nan

    @property
    def ratio(self) -> float:
        return self.spent.total / self.bound.total if self.bound.total else math.nan

    @property
    def wrong(self) -> str:
        """Why it is no success; empty where it is one."""
        checks = {
            f"{100 * self.share:.1f} % of the light": self.share >= KEPT,
            f"spot {self.off:.2f} um off": self.open_to != NEAR or self.off <= NEAR,
            f"shift {self.shifted:+.2f} um off": abs(self.shifted) <= SHIFTED,
            f"{self.ratio:.2f} times its bound": self.ratio <= SLOWEST,
        }
        return self.why or ", ".join(text for text, right in checks.items() if not right)

    def percent(self, *, aligned: bool) -> float:
        own, whole = self.spent, self.rebuilding
        return 100 * (own.total / whole.total if aligned else own.unaligned / whole.unaligned)


class Experiment:
    """One experiment on a new bench."""

    def __init__(
        self, folder: Path, seed: int, fidelity: str, passive: bool, only: str = "", shifts: bool = True,
        coarse: bool = False,
    ) -> None:  # fmt: skip
        self.folder, self.fidelity, self.only, self.shifts = folder, fidelity, only, shifts
        bench_of(folder, seed, passive=passive, sighted=False)
        if coarse:
            path = folder / "lab.yaml"
            path.write_text(path.read_text().replace("    type: beam_camera\n", f"    type: beam_camera\n{COARSE}"))
            git(folder, "commit", "-aqm", "a camera of coarse pixels")
        self.built: dict[str, Spent] = {}
        self.shift: dict[str, tuple[float, float]] = {}

    def run(self) -> Iterator[Came]:
        """Yield how each restoration came; ends where a state can't be built."""
        for step in ORDER:
            restored = next((one for one in TABLE if one.tag == step.removeprefix(">")), TABLE[0])
            if not step.startswith(">"):
                self._build(step)
            elif self.only in ("", restored.tag):
                yield self._restore(restored)
            if step == f">{self.only}":
                return

    def _build(self, tag: str) -> None:
        """Build a state of the history by the arm, with the light that it needs; commit it."""
        git(self.folder, "checkout", "-q", "-B", tag.lower(), "main")
        state = subprocess.run(["git", "show", f"{tag}:state/table.yaml"], cwd=self.folder, check=True,
                               capture_output=True)  # fmt: skip
        (self.folder / "state" / "table.yaml").write_bytes(state.stdout)
        git(self.folder, "commit", "--allow-empty", "-aqm", f"{tag}, as it is to be")
        with Bench.open(self.folder, fidelity=self.fidelity) as bench:
            report = bench.apply()
            if why := _unreached(report):
                raise SystemExit(f"{tag} was not built: {why}")
            spent = (_spent(bench, report.run) if report.done else Spent()) + _aligned(bench, GOALS.get(tag, ""))
            if tag in ("C2", "C3"):
                spent += self._nulled(bench, "p1" if tag == "C2" else "p2")
            restored = next((one for one in TABLE if one.beyond == tag and self.only in ("", one.tag)), None)
            if restored and self.shifts:
                _tilted(bench, tag)
                self.shift[tag] = _shift(bench, restored)
            if tag in {one.tag for one in TABLE}:
                spent += _recorded(bench, tag)
            bench.commit(f"{tag}, aligned and measured")
        self.built[tag] = spent

    def _nulled(self, bench: Bench, name: str) -> Spent:
        """Find the null of a polarizer by light, as the recipe does; set it as the state has it."""
        wanted = bench.folder.state.components
        before = {"hwp": wanted["hwp"].values["angle"], "cam": wanted["cam"].values["exposure"]}
        spent = _did(bench, "hwp", "set", angle=0) if name == "p1" else Spent()
        spent += _did(bench, name, "set", angle=88 if name == "p1" else 2)
        spent += _did(bench, "cam", "auto_range", tunable="exposure")
        spent += _aligned(bench, "null", name, "cam")
        if name == "p2":
            spent += _did(bench, "p2", "set", angle=90)
        spent += _did(bench, "cam", "set", exposure=before["cam"])
        return spent + _did(bench, "hwp", "set", angle=before["hwp"])

    def _restore(self, restored: Restored) -> Came:
        tag = restored.tag.lower()
        git(self.folder, "checkout", "-q", "--detach", tag)
        with Bench.open(self.folder, fidelity=self.fidelity) as bench:
            plan = bench.plan(tag, align=True)
            bound = bound_of(bench, tag, plan)
            report = bench.apply(plan)
            came = Came(restored, _unreached(report), bound=bound)
            if came.why:
                return came
            rebuilding = sum((self.built[t] for t in restored.way), Spent())
            came = replace(came, spent=_spent(bench, report.run, plan), rebuilding=rebuilding)
            came = _light(bench, came, tag, report)
            if not self.shifts:
                return replace(came, shifted=0.0)
            if restored.beyond != restored.tag:
                onward = bench.apply(restored.beyond.lower())
                if why := _unreached(onward):
                    return replace(came, why=f"from there {restored.beyond} was not built: {why}")
                _tilted(bench, restored.beyond)
                _aligned(bench, f"ly_{restored.second:g}_centred")
            (was, a), (now, b) = self.shift[restored.beyond], _shift(bench, restored)
            return replace(came, shifted=now - was, sigma=math.hypot(a, b))


def _unreached(report: RunReport) -> str:
    """Return why a bench is not as was wanted; empty where it is."""
    goals = [goal for goal in report.goals or () if not goal.met]
    good = report.outcome == "done" and report.reached and not report.exit_code and not goals
    return "" if good else f"{report.outcome}, exit code {int(report.exit_code)}: {goals} {report.remaining}"


def _aligned(bench: Bench, *goal: str) -> Spent:
    """Bring light to a goal, where the lab has it; return what it took."""
    if len(goal) == 1 and goal[0] not in (bench.setup.lab.goals or {}):
        return Spent()
    found = bench.optimize(*goal)
    if not found.met:
        raise SystemExit(f"{' '.join(goal)} was not met: {found.why}")
    return _spent(bench, None, aligns=True)


def _did(bench: Bench, component: str, what: str, **arguments: object) -> Spent:
    """Do one operation; return what it took."""
    report = bench.apply(bench.single(component, what, **arguments))
    if report.outcome != "done":
        raise SystemExit(f"{component} {what}: {[d.summary for d in report.diagnostics]}")
    return _spent(bench, report.run) if report.done else Spent()


def _spent(bench: Bench, run: str | None, plan: Plan | None = None, *, aligns: bool = False) -> Spent:
    """Return what a run took, the last one for None; all that it did was for light if it `aligns`."""
    aligning = {op.id for op in plan.operations if op.aligns} if plan else set()
    spans = [
        (op.start, op.start + op.seconds, _kind(op.primitive, aligns=aligns or op.id in aligning))
        for op in operations(bench.history.recorded_run(run)[0].trace)
        if op.start is not None and op.seconds is not None
    ]
    took = dict.fromkeys(KINDS, 0.0)
    times = sorted({t for begin, end, _ in spans for t in (begin, end)})
    for begin, end in pairwise(times):
        going = {kind for a, b, kind in spans if a <= begin and end <= b}
        took[next((kind for kind in ("moving", "aligning", "measuring") if kind in going), "settling")] += end - begin
    return Spent(**took)


def _kind(name: str, *, aligns: bool) -> str:
    """Return what kind of work an operation is. What motors do beside arms and light is settling."""
    if primitive(name).by == "arm":
        return "moving"
    if name in ("measure", "auto_range"):
        return "measuring"
    return "aligning" if aligns or name in ("optimize", "verify") else "settling"


def bound_of(bench: Bench, tag: str, whole: Plan) -> Bound:
    """Return what it takes at least to bring the bench as it is seen to a commit with its light, by the `whole` plan
    for that: which goals are sought. Nothing of it is from a run, or from what a plan reckons for light."""
    setup, moves = bench.setup, bench.plan(tag, align=False)
    goals = [
        (setup.lab.goals or {})[str(op.arguments["goal"])] for op in whole.operations if op.primitive == "optimize"
    ]
    recorded = bench.light.recorded(tag).measured
    wanted = bench.state_at(tag).components
    settling = SETTLING if recorded else 0.0
    exposures = sum(float(one.settings.get("exposure", 0.0)) for one in recorded.values()) / 1000
    for goal in goals:
        tuned = [setup.type_of(c).tunables[t] for c, _, t in (a.partition(".") for a in goal.tunables)]
        back = []
        for address, value in (goal.during or {}).items():
            component, _, tunable = address.partition(".")
            back.append(set_seconds(setup.type_of(component).tunables[tunable], value,
                                    wanted[component].values[tunable]) if wanted[component].values[tunable] != value
                        else 0.0)  # fmt: skip
            exposures += 2 * float(value) / 1000 if tunable == "exposure" else 0.0
        settling += 2 * SETTLING + max(kind.settle for kind in tuned) / 1000 + max(back, default=0.0)
    if moves.bound is None:
        raise SystemExit(f"{tag}: nobody can tell how long the arm takes")
    return Bound(moves.bound, settling, exposures)


def _recorded(bench: Bench, tag: str) -> Spent:
    """Measure what a commit is to record of its light."""
    spent = _did(bench, "hwp", "set", angle=2) if tag == "C3" else Spent()  # parallel polarizers pass too much
    spent += _did(bench, "cam", "auto_range", tunable="exposure")
    return sum((_did(bench, one, "measure", measurable=what) for one, what in MEASURED), spent)


def _tilted(bench: Bench, tag: str) -> None:
    """Put p2 down until it is seen tilted as a state has it."""
    wanted = bench.state_at(tag).components["p2"].pose
    if wanted is None:
        return
    for _ in range(10):
        if abs((bench.observe().components["p2"].pose or wanted).yaw - wanted.yaw) <= TILTED:
            return
        _did(bench, "p2", "move", x=wanted.x, y=wanted.y, yaw=wanted.yaw)


def _shift(bench: Bench, restored: Restored) -> tuple[float, float]:
    """Return the differential shift of the spot with its standard deviation [um]; all is set back after that."""
    seen = bench.observe().known_values
    bench.apply(bench.single("hwp", "set", angle=22.75))
    recipes = Recipes(bench)
    recipe = recipes.read("shel/shift")
    given = {"first": f"{restored.first:g}", "second": f"{restored.second:g}"}
    found = recipes.run(recipe, recipes.begin(recipe, recipes.arguments(recipe, given)))
    if found.outcome != "done":
        raise SystemExit(f"{restored.tag}: no shift at {found.at}: {[d.summary for d in found.diagnostics]}")
    for name, tunable in (("p1", "angle"), ("hwp", "angle"), ("cam", "exposure")):
        bench.apply(bench.single(name, "set", **{tunable: seen[name][tunable]}))
    return float(found.returns["y"]), float(found.returns["sigma"])


def _light(bench: Bench, came: Came, tag: str, report: RunReport) -> Came:
    """Return how the light came back, with what the commit recorded of it."""
    found = {one.address: one for one in bench.light.compared(tag, report.measurements)}
    light, across, up = (found[name] for name in ("cam.light", "cam.fit.x", "cam.fit.y"))
    if light.why or light.share is None or not light.reference:
        return replace(came, why=f"the light was not compared: {light.why}")
    if report.goals:  # one of them says where the spot is to be
        off, open_to = max(abs(one.now or 0.0) for one in (across, up)), NEAR
    else:
        off = math.hypot(*(((one.now or 0.0) - (one.wanted or 0.0)) / one.sigma for one in (across, up)))
        open_to = LIKELY
    return replace(came, share=light.share, off=off, open_to=open_to)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--experiments", type=int, default=5)
    parser.add_argument("--first", type=int, default=1, metavar="SEED")
    parser.add_argument("--fidelity", default="physics", choices=("physics", "kinematic"))
    parser.add_argument("--history", choices=[*HISTORIES], help="this one of the two alone")
    parser.add_argument("--only", choices=[one.tag for one in TABLE], default="", help="this restoration alone")
    parser.add_argument("--dark", action="store_true", help="without the differential shift, which takes longest")
    parser.add_argument(
        "--coarse", action="store_true", help="4 x 4 pixels of the camera read as one, in a third of the time"
    )
    args = parser.parse_args()
    histories, asked = [args.history] if args.history else [*HISTORIES], 1 if args.only else len(TABLE)
    came: dict[str, list[list[Came]]] = {history: [] for history in histories}
    for seed in range(args.first, args.first + args.experiments):
        for history in histories:
            came[history].append([])
            with tempfile.TemporaryDirectory(prefix="pico-restoration-") as place:
                made = Experiment(
                    Path(place) / "lab", seed, args.fidelity, HISTORIES[history], args.only, not args.dark, args.coarse
                )
                try:
                    for one in made.run():
                        came[history][-1].append(one)
                        print(f"seed {seed:3} {history}: {one.of.after} to {one.of.tag:4} {_said(one)}", flush=True)
                except SystemExit as exc:
                    print(f"seed {seed:3} {history}: {exc}", flush=True)
    for history, found in came.items():
        completed = sum(len(each) == asked for each in found)
        print(f"\n{history}, {args.fidelity}: {completed} of {args.experiments} experiments completed, ", end="")
        _table([one for each in found for one in each], args.experiments * asked)
    print("seconds are simulated, means but for `over`, the most of any over its bound; % of rebuilding from C1, with "
          "alignment, and without (dark)")  # fmt: skip


def _said(one: Came) -> str:
    if one.why:
        return one.why
    spot = f"spot {one.off:4.2f} {'um' if one.open_to == NEAR else 'sigma'} off"
    took = f"{one.spent.total:5.1f} s, bound {one.bound.total:5.1f} s ({one.ratio:.2f})"
    shift = f"shift {one.shifted:+.2f} um (sigma {one.sigma:.2f})"
    shift = shift if one.sigma == one.sigma else "no shift"
    return f"{100 * one.share:5.1f} % of the light, {spot}, {shift}, {took}{' NOT: ' if one.wrong else ''}{one.wrong}"


def _table(came: Sequence[Came], asked: int) -> None:
    good = sum(not one.wrong for one in came)
    loose = [one for one in came if one.open_to == LIKELY]
    far = sum(one.off > LIKELY for one in loose)
    print(f"{good} of {asked} restorations successful; of {len(loose)} spots that no axis reaches {far} farther off "
          f"than {LIKELY:.2f} sigma, {len(loose) / 22:.1f} by chance")  # fmt: skip
    columns = ("moving", "settling", "aligning", "measuring", "sum", "travel", "settling", "exposures", "bound", "over",
               "%", "% dark", "paper")  # fmt: skip
    print(f"{'restoration':14}{'ratio':>6} " + "".join(f"{one:>10}" for one in columns))
    for of in TABLE:
        mine = [one for one in came if one.of == of and not one.why]
        if not mine:
            continue
        own, least = (_mean([astuple(getattr(one, name)) for one in mine]) for name in ("spent", "bound"))
        whole = _mean([astuple(one.rebuilding) for one in mine])
        bright, dark = (statistics.mean(one.percent(aligned=lit) for one in mine) for lit in (True, False))
        numbers = (*own, sum(own), *least, sum(least), max(one.ratio for one in mine), bright, dark, of.paper)
        print(f"{of.after + ' to ' + of.tag:14}{of.ratio:>6} " + "".join(f"{n:10.2f}" for n in numbers))
        print(f"{'  rebuilt':20} " + "".join(f"{n:10.2f}" for n in (*whole, sum(whole))))


def _mean(rows: Sequence[Sequence[float]]) -> list[float]:
    return [statistics.mean(column) for column in zip(*rows, strict=True)]


if __name__ == "__main__":
    main()
