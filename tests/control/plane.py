"""A coordinator, an edge and two clients in virtual time, on a network that loses, doubles, delays and cuts, with
crashes at any point, clocks that run apart and jump, torn writes, and a database that is restored from a backup.

Leases, commands and gate are the product's; the network, the stores and the bench are plain. The bench is the truth,
and it alone judges: each motion is checked when it begins, by what then is true and written.
"""

from __future__ import annotations

import json
import random
import zlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from typing import Any

from chaos import Crash, Network, Process, Sim, Violation

from pico.control import commands as commanding
from pico.control import gate as gating
from pico.control import leases as leasing
from pico.control.commands import Commands
from pico.control.gate import Command, Gate, Memory, Record
from pico.control.leases import Asker, Lease, Said
from pico.teleop.frames import SILENCE, Frame

TROUBLE, PEACE = 60.0, 240.0
"""How long things go wrong, and how long nothing does afterwards [s of true time]."""
AXES = 4
CAP = 60.0
"""How long a job may go on by itself at most [s]."""
STEP = 0.1
"""How long a step of a teleoperation takes [s]."""


@dataclass
class Bench:
    """The table as it is, and what is checked of each motion."""

    sim: Sim
    axes: list[int] = field(default_factory=lambda: [0] * AXES)
    glued: int = 0
    moving: str = ""
    parked: bool = True
    last: int = 0
    """The token of the last motion."""
    fenced: int = 0
    """The highest token for which the coordinator heard that the edge has fenced."""
    expiry: dict[int, float] = field(default_factory=dict)
    """Until when a lease holds that the coordinator granted, in true time; longer where its clock jumped."""
    begun: set[str] = field(default_factory=set)
    complete: set[str] = field(default_factory=set)
    framed: float = -1.0
    """When the last frame was accepted."""
    told: list[tuple[int, str]] = field(default_factory=list)
    """The tokens that sessions were told, in order."""

    def begins(self, key: str, command: Command, store: Store, beyond: float = 0.0) -> None:
        """A motion of a command begins; `beyond`: how long it may go on over its lease."""
        self._mover(key, command.token, beyond)
        record = store.read().records.get(key)
        if record is None or record.phase != "started":
            raise Violation(f"I6: {key} moves with the record {record}")
        if key in self.begun:
            raise Violation(f"I4: {key} moves twice")
        self.begun.add(key)
        if unknown := [k for k, r in store.read().records.items() if r.phase == "unknown"]:
            raise Violation(f"I7: {key} moves while nobody knows of {unknown}")
        run, number, _ = key.split("/")
        if int(number) and f"{run}/{int(number) - 1}" not in self.complete:
            raise Violation(f"I5: {key} moves before what comes before it")
        if self.holds(command):
            raise Violation(f"I4: {command.digest} is done and done again")

    def goes_on(self, key: str, command: Command, beyond: float) -> None:
        """A further step of a job begins."""
        self.moving = ""
        self._mover(key, command.token, beyond)

    def _mover(self, key: str, token: int, beyond: float) -> None:
        if self.moving:
            raise Violation(f"I8: {key} moves while {self.moving} does")
        if token < self.fenced or token < self.last:
            raise Violation(f"I1: {key} of lease {token} moves; fenced for {self.fenced}, moved for {self.last}")
        if self.sim.now > self.expiry.get(token, -1.0) + beyond + 1e-6:
            raise Violation(f"I3: {key} begins {self.sim.now - self.expiry.get(token, -1.0):.2f} s after its lease")
        self.moving, self.last, self.parked = key, token, False

    def holds(self, command: Command) -> bool:
        what, _, value = command.digest.partition("=")
        return bool(self.glued) if what == "glue" else what != "job" and self.axes[int(what)] == int(value)

    def ends(self, command: Command) -> None:
        what, _, value = command.digest.partition("=")
        if what == "glue":
            self.glued += 1
            if self.glued > 1:
                raise Violation("I4: glued twice")
        elif what != "job":
            self.axes[int(what)] = int(value)
        run, number, _ = command.key.split("/")
        self.complete.add(f"{run}/{number}")

    def jogs(self, token: int, seconds: float) -> None:
        """A step of a teleoperation begins, which is over after so long."""
        self._mover("steering", token, 0.0)
        if self.sim.now + seconds > self.framed + SILENCE * 1.002:
            raise Violation("I9: a step goes on for longer than its frame counts")

    def rests(self) -> None:
        self.moving = ""

    def granted(self, token: int, session: str) -> None:
        known = dict(self.told)
        if token in known and known[token] != session:
            raise Violation(f"I2: lease {token} was given to {known[token]} and {session}")
        if token not in known:
            if self.told and token < self.told[-1][0]:
                raise Violation(f"I2: lease {token} comes after {self.told[-1][0]}")
            self.told.append((token, session))


@dataclass
class Store:
    """The edge's disk: lines with a checksum; a crash may tear the last one."""

    sim: Sim
    lines: list[str] = field(default_factory=list)

    def write(self, what: dict[str, Any]) -> None:
        text = json.dumps(what)
        line = f"{zlib.crc32(text.encode())} {text}"
        before = len(self.lines)
        try:
            self.sim.point()
        except Crash:
            self.lines.append(line[: self.sim.random.randrange(len(line))])
            raise
        self.lines[before:] = [line]
        self.sim.point()

    def read(self) -> Memory:
        memory = Memory()
        for line in self.lines:
            number, _, text = line.partition(" ")
            if not number.isdigit() or zlib.crc32(text.encode()) != int(number):
                continue
            what = json.loads(text)
            if "fence" in what:
                memory = memory.fence(what["fence"])
            else:
                memory = memory.with_record(Record(Command(*what["command"]), what["phase"], what["result"]))
        return memory


@dataclass
class Edge(Process):
    """The edge beside the bench."""

    bench: Bench = field(init=False)
    plane: Plane = field(init=False)
    store: Store = field(init=False)
    rate: float = 1.0
    gate: Gate = field(default_factory=Gate)

    def clock(self) -> float:
        return self.sim.now * self.rate + 1000.0 * self.life

    def begin(self) -> None:
        self.bench.rests()  # what moved comes to rest when nobody drives it any more
        self.gate = gating.restarted(self.store.read())
        for key in self.gate.memory.unsettled:
            self._settle(key)
        self.every(1.0, self._poll)
        self.every(0.5, self._tick)

    def _settle(self, key: str) -> None:
        """Look whether what began was done; of glue no camera tells."""
        record = self.gate.memory.records[key]
        if record.phase == "unknown":
            return
        if record.command.digest.startswith("glue"):
            self._write(gating.ended(self.gate, key, "unknown"), key)
        else:
            there = self.bench.holds(record.command)
            if there:
                run, number, _ = key.split("/")
                self.bench.complete.add(f"{run}/{number}")
            self._write(gating.ended(self.gate, key, "done" if there else "failed", "looked"), key)

    def _write(self, gate: Gate, key: str) -> None:
        record = gate.memory.records[key]
        c = record.command
        line = {"command": [c.token, c.seq, c.key, c.digest], "phase": record.phase, "result": record.result}
        self.store.write(line)
        self.gate = gate

    def _poll(self) -> None:
        asked, memory = self.clock(), self.gate.memory
        there = self.plane.coordinator  # a connection ends with either of its ends
        self.net.send(self.name, "coordinator", there.guarded(there.polled, memory, asked, self.life))

    def hears(self, token: int, left: float, asked: float, life: int) -> None:
        if life != self.life:
            return
        self.gate = gating.heard(self.gate, token, left, asked)
        self._fence()

    def _fence(self) -> None:
        after = gating.fenced(self.gate)
        if after is not self.gate:
            self.store.write({"fence": after.memory.fenced})
            if self.bench.moving:
                raise Violation(f"I8: fenced for {after.memory.fenced} while {self.bench.moving} moves")
            self.gate = after
            self._poll()

    def _tick(self) -> None:
        if gating.to_park(self.gate, self.clock()):
            self.bench.parked = True

    def commanded(self, command: Command) -> None:
        verdict = gating.judged(self.gate, command, self.clock())
        if verdict.take:
            self._do(command)
        else:
            self._answer(command, verdict.known, verdict.refused or "")

    def _answer(self, command: Command, record: Record | None, refused: str = "") -> None:
        self.sim.point()
        self.net.send(self.name, "coordinator", self.plane.coordinator.arriving(
            self.plane.coordinator.answered, command, record, refused, self.gate.memory.taken))  # fmt: skip

    def _do(self, command: Command) -> None:
        self._write(gating.started(self.gate, command), command.key)
        stalled = self.sim.random.choice((0.0, 0.0, 0.3, 3.0)) if not self.sim.healed else 0.0
        self.sim.after(stalled, self.guarded(self._move, command))  # a disk that takes its time

    def _move(self, command: Command) -> None:
        if not gating.begins(self.gate, self.clock()):
            self._over(command, "failed", "lapsed")
            return
        self.bench.begins(command.key, command, self.store)
        if command.digest.startswith("job"):
            self.gate = gating.declared(self.gate, float(command.digest.partition("=")[2]))
            self.sim.after(0.7, self.guarded(self._step, command, 12))
        else:
            self.sim.after(self.sim.random.choice((0.2, 1.0, 2.5)), self.guarded(self._moved, command))
        self.sim.point()

    def _step(self, command: Command, left: int) -> None:
        self.bench.rests()
        self.sim.point()
        if not left:
            self._moved(command)
        elif not gating.begins(self.gate, self.clock(), offline=True):
            self._over(command, "failed", "lapsed")
        else:
            cut = self.gate.deadline < self.clock()
            own = float(command.digest.partition("=")[2])
            self.bench.goes_on(command.key, command, min(own, CAP) if cut else 0.0)
            self.sim.after(7.0 if own > CAP else 0.7, self.guarded(self._step, command, left - 1))

    def _moved(self, command: Command) -> None:
        self.bench.ends(command)
        self.bench.rests()
        self.sim.point()
        lost = command.digest.startswith("glue") and self.sim.chance(0.2)
        self._over(command, "unknown" if lost else "done", "")

    def _over(self, command: Command, phase: gating.Phase, result: str) -> None:
        self._write(gating.ended(self.gate, command.key, phase, result), command.key)
        self.gate = gating.declared(self.gate, 0.0)
        self._answer(command, self.gate.memory.records[command.key])
        self._fence()

    def resolved(self, key: str, phase: gating.Phase) -> None:
        record = self.gate.memory.records.get(key)
        if record is not None and record.phase == "unknown":
            if phase == "done":
                run, number, _ = key.split("/")
                self.bench.complete.add(f"{run}/{number}")
            self._write(gating.ended(self.gate, key, phase, "a person"), key)

    def steered(self, token: int, frame: Frame) -> None:
        self.gate, refused = gating.steered(self.gate, token, frame, self.clock())
        if refused:
            return
        self.bench.framed = self.sim.now
        self.sim.after(self.sim.random.uniform(0.0, 0.15), self.guarded(self._jog, token))

    def _jog(self, token: int) -> None:
        self.gate, step = gating.stepping(self.gate, self.clock(), STEP)
        if step is not None:
            self.bench.jogs(token, STEP)
            self.sim.after(STEP, self.guarded(self._stepped))

    def _stepped(self) -> None:
        self.bench.rests()
        self.gate = gating.stepped(self.gate)
        self._fence()


@dataclass
class Database:
    """The coordinator's: a row of the bench, its commands, the audit."""

    row: Lease = field(default_factory=lambda: Lease("bench"))
    commands: Commands = field(default_factory=Commands)
    audit: tuple[leasing.Audit, ...] = ()


@dataclass
class Coordinator(Process):
    """The coordinator: what it has in memory is whether the edge has said hello."""

    bench: Bench = field(init=False)
    plane: Plane = field(init=False)
    db: Database = field(default_factory=Database)
    met: bool = False
    jump: float = 0.0
    rate: float = 1.0
    backup: Database | None = None

    def clock(self) -> float:
        return self.sim.now * self.rate + self.jump

    def jumps(self, seconds: float) -> None:
        self.jump += seconds
        grant = self.db.row.grant
        if grant:  # what the edge was told of until now holds for a TTL at most
            over = self.bench.expiry.get(grant.token, 0.0)
            self.bench.expiry[grant.token] = max(over, self.sim.now + leasing.TTL * 1.002)
            self._recorded()

    def begin(self) -> None:
        self.met = False
        if self.backup and self.sim.chance(0.3):
            self.db = replace(self.backup)
        self.every(1.0, self._tick)

    def _commit(self, turn: leasing.Turn, commands: Commands | None = None) -> None:
        self.sim.point()
        job = self.db.row.grant.job if self.db.row.grant else ""
        if job and self.sim.now > TROUBLE + 20 and any(a.deed == "lapsed" for a in turn.audit):
            raise Violation(f"I10: the lease of {job} lapses, which was left to the coordinator")
        self.db.row = turn.row
        self.db.audit += turn.audit
        if commands is not None:
            self.db.commands = commands
        self._recorded()
        if self.sim.chance(0.05):
            self.backup = replace(self.db)
        self.sim.point()
        for said in turn.said:
            self._say(said)

    def _recorded(self) -> None:
        grant = self.db.row.grant
        if grant:
            over = self.sim.now + (grant.expires - self.clock()) / self.rate
            self.bench.expiry[grant.token] = max(over, self.bench.expiry.get(grant.token, 0.0))

    def _say(self, said: Said) -> None:
        client = self.plane.clients.get(said.session.partition("#")[0])
        if client:
            if said.what == "granted":
                self.bench.granted(said.token, said.session)
                rows = [a for a in self.db.audit if a.token == said.token and a.deed in ("granted", "stolen")]
                if len(rows) != 1 or rows[0].session != said.session:
                    raise Violation(f"I11: {said.session} is told of lease {said.token}, and the audit has {rows}")
            self.net.send(self.name, client.name, client.arriving(client.hears, said))

    def _tick(self) -> None:
        row = self.db.row
        turn = leasing.Turn(row)
        if row.grant and row.grant.job:
            states = [r.state for r in self.db.commands.of(row.grant.token)]
            if {"failed", "withdrawn"} & set(states) or not any(s in commanding.OPEN for s in states):
                job = row.grant
                turn = leasing.released(row, job.holder.session, job.token, self.clock(), self.met)
            else:
                turn = leasing.kept(row, row.grant.job, self.clock())
        self._commit(turn.then(lambda r: leasing.promoted(r, self.clock(), self.met)))
        self._send()

    def _send(self) -> None:
        grant = self.db.row.grant
        if grant and grant.fenced:
            for command in self.db.commands.due(grant.token):
                self.net.send(self.name, "edge", self.plane.edge.arriving(self.plane.edge.commanded, command))

    def polled(self, memory: Memory, asked: float, life: int) -> None:
        self.met = True
        self.bench.fenced = max(self.bench.fenced, memory.fenced)
        commands = commanding.reconciled(self.db.commands, memory)
        turn = leasing.heard(self.db.row, memory.fenced, self.clock())
        self._commit(turn.then(lambda r: leasing.promoted(r, self.clock(), self.met)), commands)
        token, left = leasing.left(self.db.row, self.clock())
        edge = self.plane.edge
        self.net.send(self.name, "edge", edge.arriving(edge.hears, token, left, asked, life))

    def answered(self, command: Command, record: Record | None, refused: str, taken: int) -> None:
        row, turn = self.db.row, leasing.Turn(self.db.row)
        commands = commanding.answered(self.db.commands, record) if record else self.db.commands
        if refused == "gap" and taken >= command.seq and row.grant and row.grant.token == command.token:
            grant = row.grant  # the edge has done what this database never heard of
            turn = leasing.released(row, grant.holder.session, grant.token, self.clock(), self.met)
            lost = Said(grant.holder.session, "lost", grant.token, why="restored")
            turn = replace(turn, said=(*turn.said, lost))
        news = commands is not self.db.commands
        self._commit(turn, commands)
        if news:
            self._send()

    # what clients ask

    def asks(self, asker: Asker) -> None:
        self._commit(leasing.asked(self.db.row, asker, self.clock(), self.met))

    def steals(self, asker: Asker, why: str) -> None:
        self._commit(leasing.stolen(self.db.row, asker, why, self.clock(), self.met))

    def renews(self, session: str, token: int) -> None:
        self._commit(leasing.renewed(self.db.row, session, token, self.clock(), self.met))
        self._report(session, token)

    def releases(self, session: str, token: int) -> None:
        self._commit(leasing.released(self.db.row, session, token, self.clock(), self.met))

    def detaches(self, session: str, token: int, job: str, count: int) -> None:
        if self.db.commands.whole(token, count):
            self._commit(leasing.detached(self.db.row, session, token, job))

    def submits(self, session: str, command: Command) -> None:
        grant = self.db.row.grant
        if grant is None or grant.token != command.token or grant.holder.session != session:
            return
        commands = commanding.submitted(self.db.commands, command)
        if commands is not self.db.commands:
            self._commit(leasing.Turn(self.db.row), commands)
            self._send()

    def settles(self, key: str, phase: gating.Phase, by: str) -> None:
        if key in self.db.commands.rows and self.db.commands.rows[key].state == "unknown":
            self._commit(leasing.Turn(self.db.row), commanding.resolved(self.db.commands, key, phase, by))
        self.net.send(self.name, "edge", self.plane.edge.arriving(self.plane.edge.resolved, key, phase))

    def _report(self, session: str, token: int) -> None:
        client = self.plane.clients[session.partition("#")[0]]
        rows = self.db.commands.of(token)
        for row in rows:
            if row.state == "done":
                self.plane.durable(row.command.key)
        self.net.send(self.name, client.name, client.arriving(client.progress, rows))


@dataclass
class Client(Process):
    """A client: it wants some axes somewhere, and glue perhaps; or it steers for a while."""

    plane: Plane = field(init=False)
    goal: dict[str, int] = field(default_factory=dict)
    tries: int = 0
    session: str = ""
    token: int = 0
    run: str = ""
    keys: dict[str, str] = field(default_factory=dict)
    steering: float = 0.0
    frame: int = 0
    press: int = 0
    finished: bool = False

    def begin(self) -> None:
        self.tries += 1
        self.session, self.token, self.keys, self.steering = f"{self.name}#{self.tries}", 0, {}, 0.0
        self.every(leasing.HEARTBEAT, self._beat)
        self.every(1.0, self._submit)

    @property
    def asker(self) -> Asker:
        return Asker(self.session, self.name)

    def _ask(self, what: Callable[..., None], *given: Any) -> None:
        self.sim.point()
        coordinator = self.plane.coordinator
        self.net.send(self.name, coordinator.name, coordinator.arriving(what, *given))

    def _beat(self) -> None:
        if self.finished:
            return
        if self.token:
            self._ask(self.plane.coordinator.renews, self.session, self.token)
        elif self.sim.chance(0.25):
            self._ask(self.plane.coordinator.steals, self.asker, "in a hurry")
        else:
            self._ask(self.plane.coordinator.asks, self.asker)

    def hears(self, said: Said) -> None:
        if said.session != self.session or self.finished:
            return
        if said.what == "lost" and said.token == self.token:
            self.tries += 1
            self.session, self.token, self.keys = f"{self.name}#{self.tries}", 0, {}
        elif said.what == "granted" and said.token > self.token:
            self.token, self.keys = said.token, {}
            self.run = f"{self.name}.{self.tries}.{said.token}"
            wanted = self.plane.lacking(self.goal)
            self.keys = {f"{self.run}/{n}/1": digest for n, digest in enumerate(wanted)}
            if self.sim.chance(0.3):
                self.steering = self.sim.now + self.sim.random.uniform(0.5, 8.0)
                self.press += 1
                self._steer()
            self._submit()

    def _submit(self) -> None:
        if not self.token or self.finished or self.steering > self.sim.now:
            return
        if not self.keys:
            self._end()
            return
        for number, (key, digest) in enumerate(self.keys.items(), 1):
            for _ in range(2 if self.sim.chance(0.1) else 1):  # once more, under the same key
                command = Command(self.token, number, key, digest)
                self._ask(self.plane.coordinator.submits, self.session, command)
        if self.sim.random.random() < 0.15:
            self._ask(self.plane.coordinator.detaches, self.session, self.token, self.run, len(self.keys))

    def progress(self, rows: tuple[commanding.Row, ...]) -> None:
        if self.finished or not rows or rows[0].command.token != self.token or not self.keys:
            return
        states = {row.command.key: row.state for row in rows}
        if any(state in ("failed", "withdrawn") for state in states.values()):
            self._again()
        elif all(states.get(key) == "done" for key in self.keys):
            self._again() if self.plane.lacking(self.goal) else self._end()

    def _again(self) -> None:
        """Give the lease back, and plan anew with the next one."""
        self._ask(self.plane.coordinator.releases, self.session, self.token)
        self.tries += 1
        self.session, self.token, self.keys = f"{self.name}#{self.tries}", 0, {}

    def _end(self) -> None:
        self._ask(self.plane.coordinator.releases, self.session, self.token)
        self.finished = True

    def _steer(self) -> None:
        if self.finished or not self.token or self.steering <= self.sim.now:
            return
        self.frame += 1
        seen = self.plane.edge.clock() - 0.02  # as the last answer told
        if self.sim.chance(0.03):
            self.press += 1
        frame = Frame(seq=self.frame, seen=seen, press=self.press, tunable="tip", by=0.1)
        self.net.send(self.name, "edge", self.plane.edge.arriving(self.plane.edge.steered, self.token, frame))
        self.sim.after(self.sim.random.choice((0.02, 0.05, 0.05, 0.3)), self.guarded(self._steer))


@dataclass
class Plane:
    """One history."""

    seed: int

    def __post_init__(self) -> None:
        draw = random.Random(self.seed)
        self.sim = Sim(draw)
        self.net, self.bench = Network(self.sim), Bench(self.sim)
        self.edge = Edge(self.sim, "edge", self.net)
        self.edge.store = Store(self.sim)
        self.edge.rate, drift = 1 + draw.uniform(-1e-3, 1e-3), 1 + draw.uniform(-1e-3, 1e-3)
        self.coordinator = Coordinator(self.sim, "coordinator", self.net, rate=drift)
        self.clients = {name: Client(self.sim, name, self.net) for name in ("anna", "ben")}
        for name, client in self.clients.items():
            axes = draw.sample(range(AXES), draw.randint(1, 3))
            client.goal = {str(axis): draw.randint(1, 3) + (10 if name == "ben" else 0) for axis in axes}
            client.goal |= {"glue": 1} if draw.random() < 0.3 else {}
            client.goal |= {"job": draw.choice((0, 5, 30, 500))} if draw.random() < 0.4 else {}
        for process in (self.edge, self.coordinator, *self.clients.values()):
            process.plane = self  # type: ignore[attr-defined]
        self.edge.bench = self.coordinator.bench = self.bench

    def lacking(self, goal: dict[str, int]) -> list[str]:
        """What a client sees is still to be done."""
        found = [f"{a}={v}" for a, v in goal.items() if a.isdigit() and self.bench.axes[int(a)] != v]
        found += ["glue=1"] if goal.get("glue") and not self.bench.glued else []
        records = self.edge.store.read().records.values()
        job = f"job={goal.get('job')}"
        if "job" in goal and not any(r.phase == "done" and r.command.digest == job for r in records):
            found.append(job)
        return found

    def durable(self, key: str) -> None:
        """What a client hears that it is done, the edge has written, or a person said."""
        record = self.edge.store.read().records.get(key)
        if record is None or record.phase not in ("done", "unknown"):
            raise Violation(f"I6: a client hears that {key} is done, and the edge has {record}")

    @property
    def unknown(self) -> list[str]:
        return [key for key, record in self.edge.gate.memory.records.items() if record.phase == "unknown"]

    def person(self) -> None:
        """Somebody at the table says of what nobody else can tell whether it was done."""
        phase: gating.Phase = "done" if self.bench.glued else "failed"
        for key in self.unknown:
            self.net.send("ann", "coordinator", self.coordinator.arriving(self.coordinator.settles, key, phase, "ann"))
        self.sim.after(self.sim.random.uniform(2, 8), self.person)

    def trouble(self) -> None:
        sim, draw = self.sim, self.sim.random
        if sim.healed:
            return
        kind = draw.random()
        if kind < 0.55:
            sim.left = sim.left or draw.randint(1, 25)
        elif kind < 0.8:
            ends = draw.choice((("edge", "coordinator"), ("coordinator", "anna"), ("coordinator", "ben"),
                                ("edge", "anna")))  # fmt: skip
            self.net.cut[frozenset(ends)] = sim.now + draw.choice((1.0, 5.0, 20.0))
            sim.cuts += 1
        elif kind < 0.9:
            process = draw.choice((self.edge, self.coordinator, *self.clients.values()))
            if not process.down:
                sim.crashes += 1
                process.die()
        elif kind < 0.95:
            self.coordinator.jumps(draw.choice((-30.0, -3.0, 3.0, 30.0)))
        sim.after(draw.uniform(0.2, 4.0), self.trouble)

    def live(self) -> Sim:
        """Live through it; raises Violation."""
        for process in (self.coordinator, self.edge, *self.clients.values()):
            process.guarded(process.begin)()
        self.sim.after(1.0, self.trouble)
        self.sim.after(5.0, self.person)
        self.sim.run(TROUBLE, lambda: False)
        self.sim.healed = True
        self.net.cut.clear()
        self.sim.run(TROUBLE + PEACE, lambda: all(c.finished for c in self.clients.values()) and not self.unknown)
        self._judge()
        return self.sim

    def _judge(self) -> None:
        for name, client in self.clients.items():
            if not client.finished:
                raise Violation(f"I10: {name} does not come to an end")
        self.sim.run(self.sim.now + PEACE, lambda: self.bench.parked)
        if not self.bench.parked:
            raise Violation("I3: nobody has the bench, and it is not parked")
        if self.unknown:
            raise Violation(f"I7: nobody settles {self.unknown}")


def histories(first: int, most: int) -> Iterator[tuple[int, Sim | Exception]]:
    """Yield what comes of each seed."""
    for seed in range(first, first + most):
        try:
            yield seed, Plane(seed).live()
        except Exception as exc:
            yield seed, exc
