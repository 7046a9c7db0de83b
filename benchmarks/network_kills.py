"""Kills and freezes the processes of a lab on the network: `python benchmarks/network_kills.py --faults 500`.

`pico apply` goes from a checkout through the coordinator to the edge of a bench whose emulated table, with the
controllers of its arm and motors, has a process of its own. At random instants the coordinator, the edge or the client
is killed, or frozen for up to longer than a lease lasts, and started anew, also while what came of the last fault is
not over; meanwhile the links go wrong, too. After some faults everything is healed: every run must end, and the same
command from a client of its own must reach the goal. Leases last 4 s and all that is waited goes with them. Prints the
counts; exit code 1 where anything was lost, let fall, repeated, moved without an operation in the journal, moved after
its lease was over by the coordinator's books (both by the log of the controllers), or does not end.

`--sim`: on a simulated table in the edge's own process, of which there is no such log. `--tables 2`: on two tables at a
time. Where the machine lets an ordinary user make network namespaces, edge and table are in one of their own, and the
cable to it is pulled, too; `--together`: all in one.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import signal
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from pico.places.bench import BenchPlace

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "benchmarks")]

import network_judged as judged  # noqa: E402
from kills import forked as command  # noqa: E402
from kills import repeated  # noqa: E402
from network_bench import Expiries, Network, until  # noqa: E402
from network_hasty import hasten, preload  # noqa: E402
from network_links import Cable, apart  # noqa: E402
from network_table import REST  # noqa: E402

GOALS = ("E1-3", "C1", "E3-2", "E2-1", "E1-1")
VICTIMS = ("coordinator", "edge", "edge", "client")
PAUSES, LONG = (0.02, 0.1, 0.5, 1.0, 2.0), (4.5, 5.0, 6.0)
"""How long something stays killed or frozen: for less long than a lease lasts, or longer [s]."""
OUTLASTS = {("edge", "frozen"): 0.6, ("coordinator", "killed"): 0.4, ("coordinator", "frozen"): 0.4}
"""How often it is longer; else 0.2."""
SPOILT = {"link": ("deaf", "dumb", "slow", "cut", "pulled"), "line": ("deaf", "dumb", "slow", "cut")}
SPOILS = 0.3
"""How often a link goes wrong before a fault."""
TOGETHER = 8
"""Faults before everything is healed."""
ROUNDS = 4
"""So often on one table, before a new one is made."""
ENDS = 200.0
"""Seconds in which a run ends once all is healed, and another one is made [s]."""


class Client:
    """`pico apply`, again and again: at any time one of them is there."""

    def __init__(self, network: Network, draw: random.Random) -> None:
        self._network, self._draw, self.goal, self.codes = network, draw, draw.choice(GOALS), Counter[int]()
        self.child = self._start()

    def _start(self) -> int:
        return command(self._network.checkout, "apply", self.goal, "--auto-approve", "--lock-timeout", "100")

    def ended(self) -> bool:
        """Whether it has ended, which it is remembered for."""
        process, status = os.waitpid(self.child, os.WNOHANG)
        if process:
            self.child, self.codes = 0, self.codes + Counter([os.waitstatus_to_exitcode(status)])
        return bool(process)

    def close(self) -> None:
        """Kill it, where it is still there."""
        if self.child:
            os.kill(self.child, signal.SIGKILL)
            os.waitpid(self.child, 0)
            self.child = 0

    def lives(self) -> None:
        """Start another one where it has ended: to another goal where it came to its own."""
        before = self.codes[0]
        if self.ended():
            self.goal = self._draw.choice(GOALS) if self.codes[0] > before else self.goal
            self.child = self._start()

    def hit(self, number: int) -> None:
        """Send it a signal, if it is still there."""
        if self.child:
            os.kill(self.child, number)


def places(network: Network) -> dict[str, tuple[str, object]]:
    """Return where the parts of the table are."""
    from pico.backends.emulated.world import FOLDER
    from pico.backends.sim.store import load_world
    from pico.history.lab.folder import LabFolder

    setup = LabFolder(network.beside).setup
    world, _ = (
        load_world(setup, BenchPlace(network.beside, "sim"), FOLDER)
        if network.emulated
        else load_world(setup, BenchPlace(network.beside, "sim"))
    )
    return {n: (body.presence, body.pose) for n, body in world.components.items()}


@dataclass
class Seen:
    """What there is to judge by: the journal's records and runs, what began and has no end, and what was asked of the
    bench and never answered, by the coordinator's books."""

    records: list[Any] = field(default_factory=list)
    holders: dict[str, str] = field(default_factory=dict)
    unsettled: list[str] = field(default_factory=list)
    unanswered: list[str] = field(default_factory=list)


def seen(network: Network) -> Seen:
    """Read it."""
    import sqlite3

    from pico.runs.journal import Journal

    path, found = network.beside / ".pico/benches/sim" / "journal.sqlite", Seen()
    if path.exists():
        journal = Journal(path, looking=True)
        found.records, found.unsettled = list(journal.records()), [one.key for one in journal.unsettled()]
        found.holders = {run.run: run.holder for run in journal.runs()}
        journal.close()
    books = sqlite3.connect(f"file:{network.books / 'coordinator.sqlite'}?mode=ro", uri=True, timeout=10)
    found.unanswered = [f"{key}: {state}" for key, state in books.execute(
        "SELECT key, state FROM commands WHERE state NOT IN ('done', 'failed', 'unknown', 'withdrawn')")]  # fmt: skip
    books.close()
    return found


def wrong(
    network: Network, expiries: Expiries, before: Mapping[str, tuple[str, object]], faults: list[judged.Fault]
) -> tuple[dict[str, list[str]], int]:
    """Return what went against the rules, by rule, and how many operations outlasted their lease: `before` is where the
    parts were at first."""
    from pico.history.lab.folder import LabFolder

    until(lambda: False, 3 * REST)  # the log is written once something has come to rest
    known, log = seen(network), judged.controlled(network.log)
    begun = judged.doings(known.records, known.holders, faults)
    named = {one.operation.component for one in begun}
    lost = [
        f"{name} is {presence} at {pose}"
        for name, (presence, pose) in places(network).items()
        if presence not in ("seen", "held") or ((presence, pose) != before[name] and name not in named)
    ]
    tokens = [one.token for one in sorted(begun, key=lambda one: one.since)]
    return {
        "lost": [*lost, *judged.dropped(log)],
        "repeated": [*repeated(network.beside), *judged.repeated(LabFolder(network.beside).setup, log, begun)],
        "after the deadline": list(judged.late(log, begun, expiries.known, faults)),
        "without an operation": list(judged.unjournaled(log, begun)) if network.emulated else [],
        "out of order": [] if tokens == sorted(tokens) else [str(tokens)],
        "not ended": [*known.unsettled, *known.unanswered],
    }, judged.overtaken(begun, expiries.known)


def fault(network: Network, client: Client, draw: random.Random, longest: float) -> judged.Fault:
    """Let something befall somebody, and be over."""
    end = time.monotonic() + draw.uniform(0.0, longest)
    while time.monotonic() < end:
        client.lives()
        time.sleep(0.02)
    if draw.random() < SPOILS:
        name = draw.choice(sorted(SPOILT))
        ways = [how for how in SPOILT[name] if how != "pulled" or network.cable]
        network.spoil(name, draw.choice(ways))
    victim, deed = draw.choice(VICTIMS), draw.choice(("killed", "frozen"))
    pause = draw.choice(LONG if draw.random() < OUTLASTS.get((victim, deed), 0.2) else PAUSES)
    client.lives()
    since = time.time()
    if victim == "client":
        client.hit(signal.SIGKILL if deed == "killed" else signal.SIGSTOP)
    elif victim in network.running:
        (network.kill if deed == "killed" else network.freeze)(victim)
    time.sleep(pause)
    if victim == "client" and deed == "frozen":
        client.hit(signal.SIGCONT)
    network.start()
    return judged.Fault(victim, deed, since, time.time())


def healed(network: Network, client: Client, told: str) -> list[str]:
    """Let all that goes on end, and the goal be reached; return what does not."""
    if not network.ready():
        return [f"coordinator and edge do not find each other after {told}"]
    if not until(client.ended, ENDS):
        return [f"{client.goal}: the client did not end after {told}"]
    for words in (("apply", client.goal, "--auto-approve", "--lock-timeout", "100"),
                  ("plan", client.goal, "--detailed-exitcode")):  # fmt: skip
        begun, codes, said = time.monotonic(), _again(network, words), _said(network)
        while "error[away]" in said and time.monotonic() - begun < ENDS:  # a busy machine's line of 4 s was late
            codes, said = _again(network, words), _said(network)
        if codes[0] != 1:
            return [f"{' '.join(words[:2])} after {told}: {dict(codes)}: {said[-1500:]}"]
    return []


def _again(network: Network, words: tuple[str, ...]) -> Counter[int]:
    """Have a client of its own do a command; return its exit code, none where it does not end."""
    last = Client.__new__(Client)
    last.codes, last.child = Counter(), command(network.checkout, *words, out="again.txt")
    try:
        until(last.ended, ENDS)
    finally:
        last.close()
    return last.codes


def _said(network: Network) -> str:
    return (network.checkout / "again.txt").read_text()


def table(folder: Path, draw: random.Random, count: Counter[str], given: argparse.Namespace) -> dict[str, list[str]]:
    """Let faults befall a new table, until something is wrong; return what is, by rule."""
    network = Network(folder, emulated=not given.sim, cable=None if given.together else Cable())
    faults: list[judged.Fault] = []
    network.start()
    expiries = Expiries(network.books)
    found, overtaken = dict[str, list[str]](), 0
    client: Client | None = None
    try:
        network.ready()
        before = places(network)
        for _ in range(ROUNDS):
            client = Client(network, draw)
            for _ in range(min(TOGETHER, given.faults - count["faults"])):
                faults.append(fault(network, client, draw, given.longest))
                count["faults"] += 1
                count[f"{faults[-1].victim} {faults[-1].deed}"] += 1
            told = ", ".join(f"{f.victim} {f.deed} {f.until - f.since:.1f} s" for f in faults[-TOGETHER:])
            unreached = healed(network, client, told)
            client.close()
            count["applies"] += sum(client.codes.values())
            broken, overtaken = wrong(network, expiries, before, faults)
            found = {"not ended or not reached": unreached, **broken}
            if any(found.values()) or count["faults"] >= given.faults:
                break  # what comes after it stands on a table that is not right
        count["overtaken"] += overtaken
        if given.keep and any(found.values()):
            keep(network, faults, expiries, given.keep)
        return found
    finally:
        if client is not None:
            client.close()
        expiries.close()
        network.close()


def keep(network: Network, faults: list[judged.Fault], expiries: Expiries, where: Path) -> None:
    """Keep what there is of a table on which something was wrong."""
    import shutil
    from dataclasses import asdict

    to = where / f"{int(time.time())}"
    shutil.copytree(network.folder, to, ignore=shutil.ignore_patterns("*.pickle"))
    (to / "faults.json").write_text(json.dumps([[asdict(f) for f in faults], expiries.known]))


def main() -> int:
    """Kill."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--faults", type=int, default=500)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--sim", action="store_true", help="a simulated table, in the edge's own process")
    parser.add_argument("--tables", type=int, default=1, help="so many at a time")
    parser.add_argument("--together", action="store_true", help="all in one network namespace")
    parser.add_argument("--minutes", type=float, default=1e6, help="no table is begun after them")
    parser.add_argument("--pace", type=float, default=10.0, help="of the emulated table's time")
    parser.add_argument("--longest", type=float, default=4.0, help="between two faults [s]")
    parser.add_argument("--keep", type=Path, help="folder for what there is of tables on which something was wrong")
    given = parser.parse_args()
    if not given.together and (why := apart()):
        print(f"no network namespaces here ({why}): all processes are in one", flush=True)
        given.together = True
    os.environ["PICO_EMULATED_PACE"] = str(given.pace)
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # whatever was started is ended then, too
    hasten()
    preload()
    began = time.monotonic()
    with tempfile.TemporaryDirectory() as temporary:
        shares = [given.faults // given.tables + (n < given.faults % given.tables) for n in range(given.tables)]
        results = [Path(temporary) / f"{n}.json" for n in range(given.tables)]
        children = []
        for number, result in enumerate(results[1:], start=1):
            child = os.fork()
            if not child:
                try:
                    _share(number, shares[number], given, result)
                finally:
                    os._exit(0)
            children.append(child)
        try:
            _share(0, shares[0], given, results[0])
        except BaseException:
            for child in children:
                os.kill(child, signal.SIGTERM)
            raise
        for child in children:
            os.waitpid(child, 0)
        found, count = dict[str, int](), Counter[str]()
        for result in results:
            counted, broken = json.loads(result.read_text())
            count.update(counted)
            for rule, n in broken.items():
                found[rule] = found.get(rule, 0) + n
    faults, applies, tables, overtaken = (count.pop(n) for n in ("faults", "applies", "tables", "overtaken"))
    what = ", ".join(f"{name} {n}" for name, n in sorted(count.items()))
    rules = ", ".join(f"{n} {rule}" for rule, n in found.items())
    spent, kind = time.monotonic() - began, "simulated" if given.sim else "emulated"
    where = "all in one network namespace" if given.together else "the edge in a network namespace of its own"
    print(f"{faults} faults ({what}) during {applies} applies over the network ({tables} {kind} tables, {where}; "
          f"{overtaken} operations were under way when their lease was over): {rules}; {spent:.0f} s, "
          f"{spent / max(1, faults):.1f} s a fault")  # fmt: skip
    return 1 if any(found.values()) else 0


def _share(number: int, faults: int, given: argparse.Namespace, result: Path) -> None:
    given.faults = faults
    draw, count, found = random.Random(given.seed * 1000 + number), Counter[str](), dict[str, int]()
    began = time.monotonic()
    while count["faults"] < faults and time.monotonic() < began + 60 * given.minutes:
        count["tables"] += 1
        with tempfile.TemporaryDirectory() as temporary:
            for rule, broken in table(Path(temporary), draw, count, given).items():
                found[rule] = found.get(rule, 0) + len(broken)
                for one in broken:
                    print(f"{rule}: {one}", flush=True)
        print(f"table {number}: {count['faults']} faults, {time.monotonic() - began:.0f} s", flush=True)
    result.write_text(json.dumps([count, found]))


if __name__ == "__main__":
    sys.exit(main())
