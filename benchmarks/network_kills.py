"""Kills and freezes the processes of a lab on the network: `python benchmarks/network_kills.py --runs 500`.

`pico apply` goes from a checkout through the coordinator to the edge of a bench whose emulated table, with the
controllers of its arm and motors, has a process of its own. At a random instant the coordinator, the edge, the client,
or the link between edge and coordinator is killed or frozen, for up to 15 s, and started anew. Then everything is
healed: the run must end, and the same command from a client of its own must reach the goal. Prints the counts; exit
code 1 where anything was lost, repeated, begun after its lease was over by the coordinator's books, or does not end.

`--sim`: on a simulated table in the edge's own process, which is sooner done.
"""

from __future__ import annotations

import argparse
import os
import random
import signal
import sys
import tempfile
import time
from collections import Counter
from datetime import datetime
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "benchmarks")]

from kills import forked as command  # noqa: E402
from kills import preload, repeated  # noqa: E402
from network_bench import Expiries, Network, until  # noqa: E402

GOALS = ("E1-3", "C1", "E3-2", "E2-1", "E1-1")
VICTIMS = ("coordinator", "edge", "client", "link")
ENDS = 240.0
"""Seconds in which a run ends once all is healed, and another one is made [s]."""
TOGETHER = 5
"""Runs on one table, before a new one is made."""
SLACK = 0.05
"""So much may the clocks of journal and books differ, which count milliseconds [s]."""


def over(child: int, seconds: float) -> int | None:
    """Return the exit code of a client, None where it does not end in time: then it is killed."""
    found: list[int] = []

    def ended() -> bool:
        process, status = os.waitpid(child, os.WNOHANG)
        if process:
            found.append(os.waitstatus_to_exitcode(status))
        return bool(process)

    if until(ended, seconds):
        return found[0]
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)
    return None


def places(network: Network) -> dict[str, tuple[str, object]]:
    """Return where the parts of the table are."""
    from pico.backends.emulated.world import FOLDER
    from pico.backends.sim.store import load_world
    from pico.history.lab.folder import LabFolder

    setup = LabFolder(network.beside).setup
    world, _ = load_world(setup, network.beside, FOLDER) if network.emulated else load_world(setup, network.beside)
    return {n: (body.presence, body.pose) for n, body in world.components.items()}


def records(network: Network) -> tuple[dict[str, str], list[Any]]:
    """Return for whom each run was, and the records of the journal."""
    from pico.runs.journal import Journal

    path = network.beside / ".pico" / "journal.sqlite"
    if not path.exists():
        return {}, []
    journal = Journal(path, looking=True)
    found = {run.run: run.holder for run in journal.runs()}, list(journal.records())
    journal.close()
    return found


def _lost(presence: str, other: bool, begun: bool) -> bool:
    """Whether a part is gone, or is not as it was though nothing began to move it."""
    return presence not in ("seen", "held") or (other and not begun)


def wrong(network: Network, expiries: Expiries, before: dict[str, tuple[str, object]]) -> dict[str, list[str]]:
    """Return what went against the rules, by rule: `before` is where the parts were at first."""
    holders, known = records(network)
    started = [r for r in known if r.kind == "started"]
    begun = {r.component for r in started}
    now = places(network)
    late = []
    for record in started:
        until_ = expiries.known.get(record.token)
        at = datetime.fromisoformat(record.at).timestamp()
        if holders.get(record.key.split("/")[0]) != "the edge" and (until_ is None or at > until_ + SLACK):
            late.append(f"{record.key} at {record.at}, lease {record.token} until {until_}")
    tokens = [r.token for r in started]
    return {
        "lost": [
            n for n, (presence, pose) in now.items() if _lost(presence, (presence, pose) != before[n], n in begun)
        ],
        "repeated": repeated(network.beside),
        "after the deadline": late,
        "out of order": [] if tokens == sorted(tokens) else [str(tokens)],
    }


def once(network: Network, draw: random.Random, count: Counter[str], longest: float) -> str:
    """Apply, and kill or freeze somebody meanwhile; return what is wrong."""
    goal, victim, deed = draw.choice(GOALS), draw.choice(VICTIMS), draw.choice(("killed", "frozen"))
    words = ("apply", goal, "--auto-approve", "--lock-timeout", "60")
    client = command(network.checkout, *words)
    time.sleep(draw.uniform(0.2, longest))
    count[f"{victim} {deed}"] += 1
    pause = draw.choice((0.1, 1.0, 4.0, 12.0, 15.0))
    if victim == "client":
        os.kill(client, signal.SIGKILL if deed == "killed" else signal.SIGSTOP)
    elif deed == "killed":
        network.kill(victim)
    else:
        network.freeze(victim)
    time.sleep(pause)
    if victim == "client" and deed == "frozen":
        os.kill(client, signal.SIGCONT)
    network.start()
    if not network.ready():
        return f"{goal}: coordinator and edge do not find each other after the {victim} was {deed} for {pause:g} s"
    if over(client, ENDS) is None:
        return f"{goal}: the client did not end after the {victim} was {deed} for {pause:g} s"
    again = command(network.checkout, *words, out="again.txt")
    code = over(again, ENDS)
    said = (network.checkout / "again.txt").read_text()[-700:]
    if code != 0:
        return f"{goal}: after the {victim} was {deed} for {pause:g} s, again: {code}: {said}"
    plan = over(command(network.checkout, "plan", goal, "--detailed-exitcode", out="plan.txt"), ENDS)
    holders, _ = records(network)
    if plan != 0:
        text = (network.checkout / "plan.txt").read_text()[-400:]
        return f"{goal}: not reached after the {victim} was {deed}: {plan}: {text}"
    return "" if holders else "nothing was run"


def several(folder: Path, draw: random.Random, count: Counter[str], given: argparse.Namespace) -> dict[str, list[str]]:
    """Apply some times on a new table, until something is wrong; return what is, by rule."""
    network, failures = Network(folder, emulated=not given.sim), list[str]()
    network.start()
    expiries = Expiries(network.books)
    try:
        network.ready()
        before = places(network)
        for _ in range(min(TOGETHER, given.runs - count["runs"])):
            count["runs"] += 1
            if told := once(network, draw, count, given.longest):
                failures.append(told)
                break  # what comes after it stands on a table that is not right
        return {"not ended or not reached": failures, **wrong(network, expiries, before)}
    finally:
        expiries.close()
        network.close()


def main() -> int:
    """Kill."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=500)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--sim", action="store_true", help="a simulated table, in the edge's own process")
    parser.add_argument("--minutes", type=float, default=1e6, help="no run is begun after them")
    parser.add_argument("--pace", type=float, default=5.0, help="of the emulated table's time")
    parser.add_argument("--longest", type=float, default=20.0, help="of the random instants [s]")
    given = parser.parse_args()
    os.environ["PICO_EMULATED_PACE"] = str(given.pace)
    preload()
    draw, count, found = random.Random(given.seed), Counter[str](), dict[str, list[str]]()
    began = time.monotonic()
    while count["runs"] < given.runs and time.monotonic() < began + 60 * given.minutes:
        with tempfile.TemporaryDirectory() as temporary:
            for rule, broken in several(Path(temporary), draw, count, given).items():
                found.setdefault(rule, []).extend(broken)
                for one in broken:
                    print(f"{rule}: {one}", flush=True)
            print(f"{count['runs']} runs, {time.monotonic() - began:.0f} s", flush=True)
    runs = count.pop("runs")
    what = ", ".join(f"{name} {n}" for name, n in sorted(count.items()))
    rules = ", ".join(f"{len(broken)} {rule}" for rule, broken in found.items())
    kind = "simulated" if given.sim else "emulated"
    print(f"{runs} applies over the network ({kind}; {what}): {rules}; {time.monotonic() - began:.0f} s")
    return 1 if any(found.values()) else 0


if __name__ == "__main__":
    sys.exit(main())
