"""One try of `damaged_state.py`: a file is damaged, a command is called, and what it says is followed literally."""

from __future__ import annotations

import re
import shlex
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from random import Random

import damaged_state_oracle as oracle
from damaged_state_damage import DAMAGES, DELETED, damage
from damaged_state_lab import EMULATED, SIM, Answer, Commands, after_operations, copy_lab
from damaged_state_oracle import WorldPrint

from pico.base.state_files import entry_of

LOOKS = ("plan e1", "plan", "drift", "status", "runs list", "doctor", "commit -m x", "laser")
"""Commands that move nothing."""
COMMANDS: dict[str, tuple[str, ...]] = {
    "idle": ("plan e1", "plan", "apply --yes", "apply e1 --yes", "undo --yes", "set p1 angle=7 --yes", "drift",
             "status", "commit -m x", "doctor", "resume --yes", "recover --yes", "runs list", "laser",
             "morning --yes"),
    "held": ("resume --yes", "recover --yes", "undo --yes", "apply --yes", "status", "doctor", "runs list", "plan"),
    "night": ("status", "apply --yes", "set p1 angle=7 --yes", "undo --yes", "run --resume --yes", "runs list"),
}  # fmt: skip
EMULATED_COMMANDS = (f"{EMULATED} set cam exposure=9 --yes", f"{EMULATED} status")
STOPPED = "apply e1 --yes, stopped"
"""An `apply` in whose middle somebody calls `pico stop`, and the request is damaged."""
STOP = "benches/BENCH/stop.json"
CACHE, MENDED_ALONE = "cache", ("cache", "process", "memory")
SLOW = {"morning --yes": "benches/BENCH/mornings.json", "run --resume --yes": "benches/BENCH/recipes/RUN.jsonl"}
"""Commands that are called only if the file of this kind is damaged."""
FLAGS = ("--yes", "-y", "--auto-approve")
WAYS = 4
"""So many hints are followed in turn."""


@dataclass(frozen=True)
class Case:
    """What is tried: in which lab, what happens to which file, and which command is called."""

    lab: str
    kind: str
    """The file's pattern in the registry, with `-wal` or `-shm` of a database."""
    path: str
    how: str
    command: str


@dataclass
class Result:
    """What a try found."""

    case: Case
    outcome: str = ""
    """`harmless`; `other`: it answered differently, and says why; `deleted`: it answered as the registry says of a file
    that is gone; `refused and mended`; `refused and lost`: it is refused for another reason after the way on."""
    violations: list[str] = field(default_factory=list)
    transcript: list[str] = field(default_factory=list)
    seconds: float = 0.0


@dataclass(frozen=True)
class State:
    """The benches and commits of a lab."""

    worlds: dict[str, WorldPrint]
    commits: tuple[int, str, int]
    bytes: dict[str, bytes]
    """The files of worlds as they are."""


@dataclass(frozen=True)
class Reference:
    """What an undamaged lab does: the answer, and the lab afterwards."""

    answer: Answer
    before: State
    after: State
    runs: frozenset[str]
    text: str
    ended: int


class Tries:
    """All tries over some labs, in `scratch/lab` one after the other."""

    def __init__(self, labs: dict[str, Path], plant: Callable[[], None] | None = None) -> None:
        self._labs, self.plant = labs, plant
        self._lab = next(iter(labs.values())).parent / "lab"
        self._references: dict[tuple[str, str], Reference] = {}
        self.files = {name: dict(_files(lab)) for name, lab in labs.items()}

    def kinds(self) -> list[str]:
        """Return the kinds of files of all labs, and that of a request to stop."""
        return sorted({kind for files in self.files.values() for kind in files.values()} | {STOP})

    def draw(self, draw: Random, kinds: list[str], commands: str = "") -> Case:
        """Return a case: each kind of file is as likely, and of the labs that have one each."""
        kind, how = draw.choice(kinds), draw.choice((*DAMAGES, DELETED))
        if kind == STOP:
            return Case("idle", kind, f"{SIM}/stop.json", draw.choice(tuple(DAMAGES)), STOPPED)
        lab = draw.choice([name for name, files in self.files.items() if kind in files.values()])
        paths = [path for path, one in self.files[lab].items() if one == kind]
        near = [path for path in paths if "/emulated/" not in path]
        path = draw.choice(near) if near and draw.random() < 0.85 else draw.choice(paths)
        possible = [one for one in COMMANDS[lab] if SLOW.get(one, kind) == kind and re.match(commands, one)]
        if "/emulated/" in path and lab == "idle" and draw.random() < 0.5:
            possible = list(EMULATED_COMMANDS)
        return Case(lab, kind, path, how, draw.choice(possible or COMMANDS[lab]))

    def run(self, case: Case, draw: Random) -> Result:
        """Try a case."""
        return Try(self, case, draw).run()

    def fresh(self, lab: str, *, planted: bool = True) -> tuple[Path, Commands]:
        """Copy a lab; return where it is, and what runs commands there."""
        copy_lab(self._labs[lab], self._lab)
        return self._lab, Commands(self._lab, self.plant if planted else None)

    def path(self, case: Case) -> Path:
        """Return the path of the file of a case in the lab that is copied, where it is whole."""
        return self._labs[case.lab] / case.path

    def reference(self, lab: str, command: str) -> Reference:
        """Return what a command does in an undamaged lab, with no planted fault."""
        if (lab, command) not in self._references:
            found: list[Reference] = []
            for _ in range(2):
                path, run = self.fresh(lab, planted=False)
                before, known = state(path), oracle.runs_of(path / SIM)
                answer = call(run, command)
                text = oracle.text_of(answer.text, known)
                found.append(Reference(answer, before, state(path), known, text, oracle.ended(path / SIM)))
            one, other = found
            if one.after.worlds != other.after.worlds and command != STOPPED:
                clocks = [r.after.worlds for r in found]
                if any(not clocks[0][name].equals(clocks[1][name]) for name in clocks[0]):
                    raise RuntimeError(f"`pico {command}` in the lab {lab} does not end as it did before")
            text = one.text if one.text == other.text else ""
            self._references[lab, command] = Reference(
                one.answer, one.before, one.after, one.runs, text, max(one.ended, other.ended)
            )
        return self._references[lab, command]


def call(run: Commands, command: str, hook: Callable[[Path], None] | None = None) -> Answer:
    """Run a command of a case; `hook` does what happens to the request to stop."""
    if command != STOPPED:
        return run(f"pico {command}")
    return run(f"pico {command.partition(',')[0]}", hook=partial(after_operations, partial(_stop, hook)))


def _stop(hook: Callable[[Path], None] | None, lab: Path) -> None:
    from pico.edge import stopping
    from pico.edge.lease import BenchLock
    from pico.places.bench import BenchPlace

    place, path = BenchPlace(lab, "sim"), lab / SIM / "stop.json"
    if path.exists():
        return
    stopping.ask_to_stop(place, BenchLock(place).last_token(), "safely")
    if hook:
        hook(path)


def state(lab: Path) -> State:
    """Return the benches and commits of a lab."""
    benches = {path.name: path for path in sorted((lab / ".pico/benches").glob("*")) if path.is_dir()}
    files = {name: path / "world.json" for name, path in benches.items()}
    return State(
        {name: oracle.world_print(path) for name, path in benches.items()},
        oracle.committed(lab),
        {name: path.read_bytes() for name, path in files.items() if path.exists()},
    )


def _files(lab: Path) -> Iterator[tuple[str, str]]:
    """Yield each file below `.pico` and `.git/pico` with its kind."""
    for top in (".pico", ".git/pico"):
        for path in sorted((lab / top).rglob("*")):
            if path.is_file() and path.stat().st_size:
                name = path.relative_to(lab).as_posix()
                entry = entry_of(name.removeprefix(".pico/"))
                suffix = next((one for one in ("-wal", "-shm") if name.endswith(one)), "")
                yield name, (entry.pattern if entry else name) + suffix


class Try:
    """One try."""

    def __init__(self, tries: Tries, case: Case, draw: Random) -> None:
        self._tries, self.case, self._draw = tries, case, draw
        self.result = Result(case)
        self._power = False
        """Whether the journal has lost its last two transactions at most, as a power failure may leave it."""
        entry = entry_of(case.path.removeprefix(".pico/"))
        self._class = entry.kind if entry else "record"

    def run(self) -> Result:
        """Try it; return what was found."""
        case, tries = self.case, self._tries
        self.reference = ref = tries.reference(case.lab, case.command)
        lab, self._run = tries.fresh(case.lab)
        self.lab, path = lab, lab / case.path
        if case.command == STOPPED:
            answer = self._stopped()
        else:
            if not damage(path, case.how, self._draw):
                self.result.outcome = "no damage"
                return self.result
            self.before = state(lab)
            self.damaged = path.read_bytes() if path.exists() else None
            self._power = self._is_as_after_a_power_failure()
            answer = self._said(f"pico {case.command}")
        self.before = self.before if case.command != STOPPED else ref.before
        self._judge_motion(answer, state(lab), case.command)
        if case.command == STOPPED:
            return self.result
        doctor = self._said("pico doctor")
        self._judge_doctor(answer, doctor)
        if answer.code == ref.answer.code:
            self._judge_silence(answer, doctor)
        else:
            self._judge_refusal(answer)
        return self.result

    def _stopped(self) -> Answer:
        def spoil(path: Path) -> None:
            while not damage(path, self.case.how, self._draw):
                pass

        answer = call(self._run, STOPPED, spoil)
        self._note(STOPPED, answer)
        most = self.reference.ended + 1  # one that the arm had begun
        if (ended := oracle.ended(self.lab / SIM)) > most:
            self._wrong(f"a damaged request to stop: {ended} operations ended, with a sound one {most}")
        self.result.outcome = "harmless"
        return answer

    # what was done

    def _judge_motion(self, answer: Answer, after: State, command: str) -> None:
        ref, before = self.reference, self.before
        emulated = command.startswith(EMULATED)
        for name in after.worlds:
            meant = (name == "emulated") == emulated
            if after.bytes.get(name) == before.bytes.get(name):
                continue
            if not meant:
                self._wrong(f"the bench {name} changed, which `{command}` does not mean")
            elif command in LOOKS and (self._class != "record" or "world" not in self.case.path):
                self._judge_look(name, before, after)
        name = "emulated" if emulated else "sim"
        now, was, expected = (one.worlds.get(name, WorldPrint(None)) for one in (after, before, ref.after))
        if (
            now.parts is None
            or command == STOPPED
            or self._power
            or (command in LOOKS and answer.code == ref.answer.code)
        ):
            return
        if answer.code == ref.answer.code and answer.code == 0:
            if not now.equals(expected):
                self._wrong(f"wrong motion: `{command}` went through and left {_first_difference(now, expected)}")
        elif was.parts is not None and not now.equals(was) and not now.equals(expected):
            self._wrong(f"wrong motion: `{command}` ended with {answer.code} and left {_first_difference(now, was)}")
        if now.is_light_out and not expected.is_light_out and not was.is_light_out:
            self._wrong(f"light: `{command}` left the laser open")

    def _judge_look(self, name: str, before: State, after: State) -> None:
        now, was, expected = (one.worlds[name] for one in (after, before, self.reference.after))
        if not now.equals(was) and not now.equals(expected):
            self._wrong(f"a look changed the bench: {_first_difference(now, was)}")

    # what was said

    def _judge_silence(self, answer: Answer, doctor: Answer) -> None:
        """Judge a command that ended as on an undamaged lab."""
        case, ref = self.case, self.reference
        text = oracle.text_of(answer.text, ref.runs)
        named = self._is_named(answer.text) or self._is_named(doctor.text)
        same = not ref.text or text == ref.text
        known = self._power or self._class in MENDED_ALONE or (case.how == DELETED and self._is_loss_documented())
        expected, now = ref.after.commits, state(self.lab).commits
        if (now[0], now[1]) != (expected[0], expected[1]) and not named:
            self._wrong(f"`{case.command}` committed another state, and nothing names the file")
        if now[2] < expected[2] and not named:
            self._wrong(f"`{case.command}` committed {now[2]} runs and not {expected[2]}, and nothing names the file")
        self.result.outcome = "harmless" if same else "deleted" if case.how == DELETED else "other"
        if not same and not named and not known:
            self._wrong(f"silent: `{case.command}` says something else: {_line_that_differs(text, ref.text)}")
        if same and self._class == "cache" and self._is_named(answer.text) and "error" in answer.text:
            self._wrong("a cache is spoken of as an error")

    def _judge_doctor(self, answer: Answer, doctor: Answer) -> None:
        """A record that is still damaged is named: its JSON holds something else, or is none."""
        path = self.lab / self.case.path
        entry = entry_of(self.case.path.removeprefix(".pico/"))
        if entry is None or entry.text or self._class in MENDED_ALONE or self.damaged is None or not path.exists():
            return
        same = oracle.document(path.read_bytes()) == oracle.document(self._tries.path(self.case).read_bytes())
        if path.read_bytes() == self.damaged and not same and not self._is_named(answer.text + doctor.text):
            self._wrong("`pico doctor` does not name a damaged file")

    def _judge_refusal(self, answer: Answer) -> None:
        """Judge a command that ended otherwise than on an undamaged lab, and follow what it says."""
        case, ref = self.case, self.reference
        if self._class == CACHE:
            self._wrong(f"damage of a cache makes `{case.command}` end with {answer.code}: {_error(answer.text)}")
        documented = case.how == DELETED and self._is_loss_documented()
        documented = documented or self._power
        if not self._is_named(answer.text) and not documented:
            self._wrong(f"not named: `{case.command}` ended with {answer.code}: {_error(answer.text)}")
        for _ in range(WAYS):
            ways = ways_on(answer.text)
            if not ways:
                if not documented:
                    self._wrong(f"no way on: `{case.command}`: {_error(answer.text)}")
                break
            for way in ways:
                done = self._said(way)
                asks = any(flag in done.text for flag in FLAGS)
                if done.code and asks and not any(flag in way for flag in FLAGS):
                    done = self._said(f"{way} --yes")
            answer = self._said(f"pico {case.command}")
            if answer.code == ref.answer.code or not self._is_named(answer.text):
                break
        if answer.code == ref.answer.code:
            self.result.outcome = "refused and mended"
            return
        self.result.outcome = "refused and lost"
        if self._is_named(answer.text):
            self._wrong(f"the way on does not lead on: `{case.command}` still: {_error(answer.text)}")
        elif not re.search(r"(?m)^error\[", answer.text):
            self._wrong(f"after the way on `{case.command}` ended with {answer.code}: {answer.text[-200:]}")
        if self._is_named(self._said("pico doctor").text):
            self._wrong("after the way on `pico doctor` still names the file")

    def _is_as_after_a_power_failure(self) -> bool:
        if not self.case.path.endswith("-wal"):
            return False
        whole, left = (
            oracle.rows(path.with_name("journal.sqlite"))
            for path in (self._tries.path(self.case), self.lab / self.case.path)
        )
        return whole is not None and left is not None and 0 < whole - left <= 2

    def _said(self, line: str) -> Answer:
        answer = self._run(line)
        self._note(line, answer)
        return answer

    def _note(self, line: str, answer: Answer) -> None:
        self.result.seconds += answer.seconds
        self.result.transcript.append(f"$ {line}   -> {answer.code}\n{_short(answer.text)}")
        if answer.code < 0:
            self._wrong(f"`{line}` hung or crashed: {answer.code}")
        if found := oracle.BROKEN.search(answer.text):
            self._wrong(f"`{line}`: {found[0]}: {_error(answer.text)}")

    def _is_named(self, text: str) -> bool:
        path = re.sub(r"-(wal|shm)$", "", self.case.path)
        name = path.rpartition("/")[2]
        if "/armed/" in path and re.search(r"armed/\w+\.json|warning\[unarmed\]|`pico laser arm", text):
            return True  # the seal is named by what it seals, and a laser that stays shut by how it is armed
        return path in text or f"/{name}" in text or "journal-record]: run" in text or f"/{name}.damaged" in text

    def _is_loss_documented(self) -> bool:
        entry = entry_of(self.case.path.removeprefix(".pico/"))
        return entry is None or entry.kind in MENDED_ALONE or bool(entry.lost)

    def _wrong(self, text: str) -> None:
        self.result.violations.append(text.replace(str(self.lab), "LAB"))
        self.result.transcript.append(f"!! {text}")


def ways_on(text: str) -> list[str]:
    """Return the commands that the first hint of an error names, in their order, up to an alternative."""
    found = re.search(r"(?ms)^error\[.*?^ *= help: (.*?)$", text)
    if not found:
        return []
    hint = re.split(r",? or |; otherwise ", found[1])[0]
    return [one for one in re.findall(r"`([^`]+)`", hint) if shlex.split(one)[0] in ("pico", "mv", "rm", "git")][:3]


def _first_difference(now: WorldPrint, other: WorldPrint) -> str:
    for name, part in (now.parts or {}).items():
        if (there := (other.parts or {}).get(name)) != part:
            return f"{name} {part}, expected {there}"[:400]
    return f"light out {now.is_light_out}, expected {other.is_light_out}"


def _line_that_differs(text: str, other: str) -> str:
    known = set(other.splitlines())
    new = [line for line in text.splitlines() if line not in known]
    gone = [line for line in other.splitlines() if line not in set(text.splitlines())]
    return " / ".join((f"new {new[:2]}", f"gone {gone[:2]}"))[:500]


def _error(text: str) -> str:
    lines = [line for line in text.splitlines() if line.startswith("error")]
    return (lines or text.strip().splitlines() or [""])[-1 if not lines else 0][:240]


def _short(text: str) -> str:
    lines = [f"    {line[:300]}" for line in text.strip().splitlines() if line.strip()]
    return "\n".join(lines if len(lines) < 14 else [*lines[:6], "    ...", *lines[-7:]])
