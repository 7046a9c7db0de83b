"""Cuts a coordinator, an edge and two clients off at any point, in virtual time, and plants bugs in what they share:
`python benchmarks/control_plane.py --crashes 100000 --seeds 2000`.

The product's leases, commands and gate under a seeded simulator; see tests/control/plane.py. Prints each violation of an
invariant (I1 to I11) with its seed, and the counts; then (`--seeds`) a table of planted bugs, a patch of one line each,
with the seeds that it took to find them, and any survivors. The exit code is 1 where there is one of either.
"""

# ruff: noqa: E501 (a line of the product is quoted whole)
from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "tests" / "control"), str(ROOT / "benchmarks")]

from planted_bugs import Bug, hunted  # noqa: E402

LEASES, GATE, COMMANDS = "control/leases.py", "control/gate.py", "control/commands.py"
PLANE = ROOT / "tests" / "control" / "plane.py"

BUGS = (
    Bug("a number is given twice", LEASES, "    token = row.token + 1\n", "    token = max(row.token, 1)\n"),
    Bug("a lease never lapses", LEASES, "if grant is None or now <= grant.expires:", "if grant is None or now <= grant.expires + 1e9:"),
    Bug("a lease lasts a thousand seconds", LEASES, "    kept = replace(turn.row, grant=replace(grant, expires=now + TTL))", "    kept = replace(turn.row, grant=replace(grant, expires=now + 1000))"),
    Bug("numbers are given before the edge said its own", LEASES, "if row.grant or not row.queue or not met:", "if row.grant or not row.queue:"),
    Bug("what the edge fenced for is not counted", LEASES, "    row = replace(row, token=max(row.token, fenced))\n", ""),
    Bug("the holder hears before the edge has fenced", LEASES, "if grant is None or grant.token != fenced or grant.fenced:", "if grant is None or grant.fenced:"),
    Bug("who asks again hears before the edge has fenced", LEASES, "        if row.grant.fenced:\n", "        if row.grant:\n"),
    Bug("a theft has two rows", LEASES, "return replace(turn, audit=(taken,), said=victim)", "return replace(turn, audit=(*turn.audit, taken), said=victim)"),
    Bug("a grant has no row", LEASES, '(_audit("granted", row.bench, grant),))', '(_audit("released", row.bench, grant),))'),
    Bug("the edge is told a whole TTL", LEASES, "max(0.0, row.grant.expires - now)", "TTL"),
    Bug("the edge is told that the last lease goes on", LEASES, "if row.grant else (row.token, 0.0)", "if row.grant else (row.token, TTL)"),
    Bug("who waits is never served", LEASES, "    return _given(replace(row, queue=tuple(others)), first, now)", "    return Turn(row)"),
    Bug("a detached run is not kept", LEASES, "    return Turn(replace(row, grant=replace(row.grant, expires=now + TTL)))\n\n\ndef detached", "    return Turn(row)\n\n\ndef detached"),
    Bug("time counts double", GATE, "asked + left * RATE", "asked + 2 * left * RATE"),
    Bug("time counts from the answer, a second late", GATE, "asked + left * RATE", "asked + 1.0 + left * RATE"),
    Bug("what is left is the other lease's", GATE, "    if token != gate.memory.fenced or gate.pending:", "    if gate.pending:"),
    Bug("a lower number is fenced for", GATE, "    if token > max(gate.memory.fenced, gate.pending):", "    if token != gate.memory.fenced:"),
    Bug("fenced while something moves", GATE, "    if gate.running or not gate.pending:", "    if not gate.pending:"),
    Bug("the fence is forgotten", GATE, "    return Gate(memory)", "    return Gate(replace(memory, fenced=0))"),
    Bug("numbers go on from the last lease", GATE, "replace(self, fenced=token, taken=0, stopped=frozenset())", "replace(self, fenced=token, stopped=frozenset())"),
    Bug("no deadline", GATE, "not self.pending and now <= self.deadline", "not self.pending"),
    Bug("a failed command is done again", GATE, "    if known is not None:\n        return _recalled", '    if known is not None and known.phase == "done":\n        return _recalled'),
    Bug("order does not count", GATE, "    elif command.seq != gate.memory.taken + 1:", "    elif command.seq < 0:"),
    Bug("a run goes on after a failure", GATE, "    elif command.run in gate.memory.stopped:", "    elif command.run in ():"),
    Bug("others go on beside an unknown end", GATE, "    elif gate.memory.unsettled:", "    elif ():"),
    Bug("what was cut short is not looked at", GATE, 'if record.phase in ("started", "unknown"))', 'if record.phase == "unknown")'),
    Bug("not asked again before it moves", GATE, "    return gate.may_move(token, now) or (offline and alone(gate, token, now))", "    return True"),
    Bug("any job may go on by itself", GATE, "not gate.pending and now <= gate.deadline + gate.budget", "not gate.pending"),
    Bug("what has ended still runs", GATE, 'running="" if gate.running == key else gate.running', "running=gate.running"),
    Bug("left as it is when nobody has it", GATE, "    return not gate.running and now > gate.deadline and", "    return gate.running is None and now > gate.deadline and"),
    Bug("anybody may steer", GATE, "    if not gate.may_move(token, now):", "    if gate.pending:"),
    Bug("steered while something else moves", GATE, "    frame = None if gate.running else gate", "    frame = gate"),
    Bug("a step may be longer than its frame counts", GATE, "gate.steering.authorized(now, seconds)", "gate.steering.authorized(now, 0.0)"),
    Bug("what began is told as done", COMMANDS, '    if record.phase == "started":', '    if record.phase == "":'),
    Bug("a failure is told as done", COMMANDS, "state=record.phase, result", 'state="done", result'),
    Bug("left alone before all of it is there", COMMANDS, "        return [row.command.seq for row in self.of(token)] == list(range(1, count + 1))", "        return True"),
)  # fmt: skip

HARMLESS = (
    Bug("a person's word is not written", COMMANDS, 'replace(row, state=state, by=by)) if row.state == "unknown"', 'row) if row.state == "unknown"'),
    Bug("a grant of before a restore stays", LEASES, "    if grant and grant.token < fenced:", "    if grant and grant.token < 0:"),
    Bug("an older lease is not told from none", GATE, "    if command.token < gate.memory.fenced:", "    if command.token < 0:"),
    Bug("busy is not looked at", GATE, "    elif gate.running:", "    elif gate.running is None:"),
    Bug("taken on without a lease", GATE, "    elif not gate.may_move(command.token, now):", "    elif gate.pending:"),
)  # fmt: skip
"""Plants that change nothing, because the product looks twice: `may_move` and `begins` refuse the same, and what runs is
unsettled; and what was granted by a database of before lapses, for the edge never fences for it, and it tells
what a person said, too. Hunted and printed all the same, and not counted."""


def main() -> int:
    """Run histories until there are as many crashes and cuts as asked for, then hunt the bugs."""
    from plane import histories

    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--crashes", type=int, default=100_000, help="crashes and cuts of the network")
    parser.add_argument("--first", type=int, default=0, help="first seed")
    parser.add_argument("--seeds", type=int, default=0, help="how many each planted bug may survive; 0 plants none")
    parser.add_argument("--only", default="", help="of the bugs, those of such a name")
    given = parser.parse_args()
    crashes = cuts = points = violations = count = 0
    began = time.process_time()
    for seed, found in histories(given.first, given.crashes):
        count += 1
        if isinstance(found, Exception):
            violations += 1
            print(f"seed {seed}: {type(found).__name__}: {found}", flush=True)
            continue
        crashes, cuts, points = crashes + found.crashes, cuts + found.cuts, points + found.points
        if crashes + cuts >= given.crashes:
            break
    spent = time.process_time() - began
    print(f"{count} histories, {crashes} crashes at {points} possible points and {cuts} cuts, {spent:.0f} CPU s: "
          f"{violations} violations", flush=True)  # fmt: skip
    if given.seeds:
        bugs, harmless = ([bug for bug in some if given.only in bug.name] for some in (BUGS, HARMLESS))
        violations += len(hunted(bugs, harmless, given.seeds, PLANE))
    return 1 if violations else 0


if __name__ == "__main__":
    sys.exit(main())
