"""The least time for several arms, proven by OR-Tools' CP-SAT: in a process of its own, where no highspy is imported.

    python tests/oracles/proven.py < work.json

Reads an `ArmWork` as JSON; writes `makespan` and `lower_bound` [s], whether it is `proven`, and the `order`. For few
moves: up to about twelve.
"""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator, Sequence
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from pico.diagnostics import PicoError, error
from pico.model.record import as_json, record
from pico.planning.ordering.arm_times import ArmWork, timed

TICK = 1e-3
"""The unit of time of the model [s]; what takes part of one is rounded down, so that the bound holds."""
EFFORT = 10.0
"""How hard to try, in the deterministic time of CP-SAT, about seconds."""


@record
class Proof:
    """The order that is done soonest, when it is done, and a time before which none is [s]."""

    makespan: float
    lower_bound: float
    proven: bool
    order: tuple[int, ...]


def prove(work: ArmWork, python: str = sys.executable) -> Proof:
    """Return the order that ends soonest, from a process of `python`. Raises PicoError where OR-Tools is not there."""
    given = json.dumps(as_json(work))
    done = subprocess.run([python, __file__], input=given, capture_output=True, text=True, check=False)
    if done.returncode:
        raise PicoError(error("missing-extra", done.stderr.strip() or "the process ended without an answer"))
    found = json.loads(done.stdout)
    return Proof(**found | {"order": tuple(found["order"])})


def solved(work: ArmWork, cp: Any, effort: float = EFFORT) -> Proof:
    """Return the order that ends soonest, as far as it is found; `cp`: the module of CP-SAT."""
    model = cp.CpModel()
    solver = cp.CpSolver()
    solver.parameters.num_workers, solver.parameters.interleave_search, solver.parameters.random_seed = 8, True, 0
    solver.parameters.max_deterministic_time = effort
    begins = _modelled(work, model)
    status = solver.solve(model)
    if status not in (cp.OPTIMAL, cp.FEASIBLE):
        return Proof(makespan=float("inf"), lower_bound=0.0, proven=False, order=())
    order = tuple(sorted(range(len(begins)), key=lambda j: (solver.value(begins[j]), len(work.before[j]), j)))
    least = solver.best_objective_bound * TICK
    return Proof(
        makespan=round(timed(work, order)[0], 6), lower_bound=round(least, 6), proven=status == cp.OPTIMAL, order=order
    )  # fmt: skip


def _modelled(work: ArmWork, model: Any) -> list[Any]:
    """Put `timed` into a model, with the order free; return the moments at which the moves begin [ticks]."""
    moves = range(len(work.arm))
    longest = [max(work.start[j], work.again[j], *work.between[j]) + work.loaded[j] + work.end[j] for j in moves]
    horizon = 2 * _ticks(sum(longest)) + 1

    def moments() -> list[Any]:
        return [model.new_int_var(0, horizon, "") for _ in moves]

    begin, end, out, parks = moments(), moments(), moments(), [model.new_bool_var("") for _ in moves]
    last = model.new_int_var(0, horizon, "")
    for j in moves:
        parked = end[j] + _ticks(work.end[j])
        model.add(last >= parked)
        model.add(out[j] >= end[j])
        if work.stays[j]:
            model.add(out[j] >= parked).only_enforce_if(parks[j])
        for i in work.before[j]:
            model.add(begin[j] >= end[i])
    for own in (work.of(arm) for arm in range(work.arms)):
        model.add_no_overlap([
            model.new_interval_var(begin[j], model.new_int_var(_ticks(work.loaded[j]), horizon, ""), end[j], "")
            for j in own
        ])  # fmt: skip
        if own:
            model.add_circuit(list(_arcs(work, model, own, begin, end, parks, out)))
    for z in range(len(work.zones)):
        inside = [j for j in moves if z in work.enters[j]]
        model.add_no_overlap([
            model.new_interval_var(begin[j], model.new_int_var(0, horizon, ""), out[j], "") for j in inside
        ])  # fmt: skip
    model.minimize(last)
    return begin


def _arcs(
    work: ArmWork, model: Any, own: Sequence[int], begin: Sequence[Any], end: Sequence[Any], parks: Sequence[Any],
    out: Sequence[Any],
) -> Iterator[tuple[int, int, Any]]:  # fmt: skip
    """Yield the arcs of one arm's round through its moves, and let each take its time."""
    for n, j in enumerate(own, 1):
        first, final = model.new_bool_var(""), model.new_bool_var("")
        yield 0, n, first
        yield n, 0, final
        model.add(end[j] == begin[j] + _ticks(work.start[j] + work.loaded[j])).only_enforce_if(first)
        model.add_implication(final, parks[j])
        for m, i in enumerate(own, 1):
            if i == j:
                continue
            follows = model.new_bool_var("")
            yield m, n, follows
            straight, parked = [follows, parks[i].negated()], [follows, parks[i]]
            model.add(end[j] == begin[j] + _ticks(work.between[i][j] + work.loaded[j])).only_enforce_if(straight)
            model.add(begin[j] >= end[i]).only_enforce_if(straight)
            if work.stays[i]:
                left = begin[j] if work.stays[i] <= work.enters[j] else end[j]
                model.add(out[i] >= left).only_enforce_if(straight)
            model.add(end[j] == begin[j] + _ticks(work.again[j] + work.loaded[j])).only_enforce_if(parked)
            model.add(begin[j] >= end[i] + _ticks(work.end[i])).only_enforce_if(parked)


def _ticks(seconds: float) -> int:
    return int(seconds / TICK)


def read_work(text: str) -> ArmWork:
    """Return the `ArmWork` of its JSON."""
    raw = json.loads(text)
    for name in ("arm", "loaded", "start", "again", "end"):
        raw[name] = tuple(raw[name])
    for name in ("before", "enters", "stays"):
        raw[name] = tuple(frozenset(some) for some in raw[name])
    for name in ("between", "zones"):
        raw[name] = tuple(tuple(row) for row in raw[name])
    return ArmWork(**raw)


def main() -> int:
    """Answer what stands on the standard input."""
    if find_spec("ortools") is None:
        sys.stderr.write("a proven makespan needs OR-Tools: pip install 'pico-lab[ortools]'\n")
        return 1
    proof = solved(read_work(sys.stdin.read()), import_module("ortools.sat.python.cp_model"))
    sys.stdout.write(json.dumps(as_json(proof)) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
