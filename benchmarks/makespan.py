"""How long plans take against a time that no plan of the same moves can beat: the shipped labs, along their history.

    python benchmarks/makespan.py [--labs shel crowded two_arms] [--prove] [--python PATH]

For every step of a lab's history, there and back: the makespan of the plan, and its lower bound, which is the longest
of what each arm needs for its moves (an exact or bounded tour of the empty hand, and the carrying), what the moves in a
zone where two arms meet need one after the other, any chain of moves that wait for one another, and the motors of one
component. The bound holds for the moves that the plan makes, by whatever arm and in whatever order, where an arm holds
a zone for the whole of a move. With --prove OR-Tools says for plans of two arms, up to 12 moves, how soon they could
be done at best (`pip install 'pico-lab[ortools]'`, or --python for an interpreter that has it): without shutters, and
with the times of moves that nothing is in the way of.
"""

from __future__ import annotations

import argparse
import statistics
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "tests")]

from oracles.proven import prove  # noqa: E402

from pico.history.examples.example import make_example  # noqa: E402
from pico.manifest.load import load_files, load_folder  # noqa: E402
from pico.model.observation import Observation, ObservedComponent, ObservedValue  # noqa: E402
from pico.model.plan import Plan  # noqa: E402
from pico.model.setup import Setup  # noqa: E402
from pico.model.state import LabState, place_of  # noqa: E402
from pico.motion.arms import ArmMotion  # noqa: E402
from pico.planning import PlanGoal, Planner  # noqa: E402
from pico.planning.ordering.arm_times import timed  # noqa: E402
from pico.planning.ordering.several_arms import work_of  # noqa: E402
from pico.planning.ordering.solve import OrderedMoves, OrderingProblem, solve  # noqa: E402
from pico.planning.ordering.travel import Clock  # noqa: E402
from pico.planning.passes.actors import actors, asides  # noqa: E402
from pico.planning.passes.comparison import compared  # noqa: E402
from pico.planning.passes.draft import Draft  # noqa: E402

MOST = 12
"""Up to so many moves are proven."""


@dataclass(frozen=True)
class Case:
    """From one state of a lab to another."""

    setup: Setup
    motion: ArmMotion
    seen: Observation
    wanted: LabState
    text: str

    def plan(self) -> Plan:
        """Return the plan."""
        return Planner(self.setup, self.motion, self.seen).plan(PlanGoal(self.wanted))

    def proof(self, python: str) -> str:
        """Return in words how soon the arms can be done with the moves of the plan, and when they are."""
        draft = compared(Draft(self.setup, self.motion, self.seen, PlanGoal(self.wanted)))
        movers, obstacles, _ = actors(draft)
        others = asides(draft, movers)
        answer = solve(OrderingProblem(self.setup, self.seen, movers, tuple(obstacles), others, self.motion))
        if (
            not isinstance(answer, OrderedMoves)
            or len(answer.steps) > MOST
            or len({s.hold.robot for s in answer.steps}) < 2
        ):
            return ""
        work = work_of(Clock(answer.table, self.seen, self.motion), answer.steps)
        best, ours = prove(work, python), timed(work, range(len(answer.steps)))[0]
        return f"{ours:8.1f}  {best.lower_bound:8.1f} {'proven' if best.proven else 'at least'}"


def cases(name: str, folder: Path) -> list[Case]:
    """Return the steps of a lab's history, each there and back."""
    repository = make_example(name, folder)
    setup, _ = load_folder(folder).require()
    motion, found = ArmMotion(setup), []
    commits = {c.id: c for c in repository.log(repository.tips())}
    states = {i: load_files(repository.files(i), setup=setup).require()[1] for i in commits}
    for child in reversed(list(commits.values())):
        for parent in child.parents[:1]:
            for a, b in ((parent, child.id), (child.id, parent)):
                text = f"{commits[a].label} to {commits[b].label}"
                found.append(Case(setup, motion, observed(setup, states[a]), states[b], text))
    return found


def observed(setup: Setup, state: LabState) -> Observation:
    """Return a bench that is exactly as a state says."""
    seen = {}
    for name in setup.lab.inventory:
        values = state.components[name].values if name in state.components else {}
        known = {k: ObservedValue(value=v) for k, v in values.items()}
        seen[name] = ObservedComponent(pose=place_of(setup, state, name)[1], values=known)
    return Observation(backend="sim", components=seen)


def main() -> int:
    """Print a line for each step, and the median and worst of each lab."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--labs", nargs="+", default=["shel", "crowded", "two_arms"])
    parser.add_argument("--prove", action="store_true", help="the least time that OR-Tools proves, for two arms")
    parser.add_argument("--python", default=sys.executable, help="an interpreter that has OR-Tools")
    given = parser.parse_args()
    head = "   arms [s]   at best" if given.prove else ""
    print(f"{'lab':10} {'step':24} {'moves':>5} {'makespan [s]':>13} {'bound [s]':>10} {'ratio':>7}{head}")
    with tempfile.TemporaryDirectory() as folder:
        for lab in given.labs:
            ratios = []
            for case in cases(lab, Path(folder) / lab):
                made = case.plan()
                if made.errored or not made.bound:
                    print(f"{lab:10} {case.text:24} {'no plan' if made.errored else 'nothing moves':>30}", flush=True)
                    continue
                ratios.append(made.makespan / made.bound)
                moves = sum(o.primitive in ("move", "stow") for o in made.operations)
                more = f"   {case.proof(given.python)}" if given.prove else ""
                times = f"{made.makespan:13.1f} {made.bound:10.1f} {ratios[-1]:7.3f}{more}"
                print(f"{lab:10} {case.text:24} {moves:5d} {times}", flush=True)
            print(
                f"{lab:10} {'median, worst':24} {'':30} {statistics.median(ratios):7.3f} {max(ratios):.3f}\n",
                flush=True,
            )
    return 0


if __name__ == "__main__":
    sys.exit(main())
