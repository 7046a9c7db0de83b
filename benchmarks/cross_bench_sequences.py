"""The commands of `cross_bench.py`, drawn one after the other, each with the bench that it means."""

from __future__ import annotations

import re
import shlex
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from random import Random

from cross_bench_labs import FAR, STATES
from cross_bench_oracle import BENCHES, LOCAL

FLAGS: Mapping[str, tuple[tuple[str, ...], ...]] = {
    "sim": (("--backend", "sim"), ("--bench", "local", "--backend", "sim")),
    "emulated": (("--backend", "hardware", "--emulate"), ("--backend", "emulated")),
    "hardware": (("--backend", "hardware"),),
    "remote": (("--bench", FAR), ("--bench", f"lab/{FAR}")),
}
"""The flags that name each bench."""
USES = {"sim": ("sim", "local"), "emulated": ("emulated",), "hardware": ("hardware",), "remote": (FAR, f"lab/{FAR}")}
"""The words that name each bench after `bench use`."""
LOOKS = ("plan", "status", "drift", "runs", "runs show", "log", "diff", "bench list")
"""Kinds that change no bench, not even the one that they mean."""
KINDS = {
    "plan": 6, "plan REV": 4, "status": 6, "drift": 3, "runs": 3, "runs show": 2, "runs show RUN": 4, "log": 1,
    "apply": 9, "apply REV": 8, "set": 8, "gate": 3, "move": 2, "measure": 3, "undo": 8, "redo": 4, "undo RUN": 5,
    "resume": 5, "recover": 3, "stop": 4, "commit": 10, "capture": 4, "edit": 5, "bench use": 9, "checkout": 5,
    "branch": 1, "worktree": 2, "attach": 2, "killed": 7, "stop beside": 3, "hint": 25,
}  # fmt: skip
"""The weight of each kind of command."""
YES = ("--yes",)
NOT_RUN = re.compile(
    r"^pico( -\S+)* (init|gui|edge|serve|login|git (install|uninstall|attach)|bench (use|list|update)|remote|calibrate|"
    r"commission|teleop|doctor|help|completion|test|check|fleet|mcp|sim|laser|morning|optimize|data|devices|import|show|log|diff|blame|checkout|validate|catalog)\b|--help"
)
"""Hints that mean no bench, choose one, act on the simulated world alone, or take long."""
PLACEHOLDER = re.compile(r"[A-Z]{3,}|\.\.\.|…|[<>|]|KEY=")


@dataclass(frozen=True)
class Command:
    """One command."""

    kind: str
    words: tuple[str, ...]
    tree: str
    """The worktree that it is about."""
    cwd: str
    """The worktree in which it is typed."""
    meant: str | None
    """The bench that it means; None if it may change none."""
    environment: Mapping[str, str] = field(default_factory=dict)
    foreign: str = ""
    """The bench of the run that it names, if that is not the one that it means."""
    killed: float | None = None
    """When it is killed, as a share of the usual duration of an apply."""
    typed: str = ""
    """What is typed at its terminal; without it, its standard input is empty."""
    stopped: str = ""
    """The bench on which `pico stop` runs meanwhile."""
    use: str = ""
    """The bench that it chooses, of `bench use`."""

    @property
    def looks(self) -> bool:
        """Whether it must change no bench."""
        return any(self.kind == one or self.kind.startswith(f"{one} ") for one in LOOKS)

    @property
    def text(self) -> str:
        """The command line, with the worktree, the variables, and what happens meanwhile."""
        before = "".join(f"{k}={v} " for k, v in self.environment.items())
        after = f"   # killed at {self.killed:.2f}" if self.killed is not None else ""
        beside = f"   # meanwhile: stop on {self.stopped}" if self.stopped else ""
        return f"({self.cwd}) {before}{shlex.join(self.words)}{after}{beside}"


@dataclass
class Model:
    """What is known of a lab without asking PICO."""

    trees: dict[str, Path]
    """The worktrees by name."""
    use: dict[str, str]
    """The bench that each worktree chose."""
    owners: dict[str, str] = field(default_factory=dict)
    """The bench of each run, oldest first."""
    pending: dict[str, bool] = field(default_factory=dict)
    """The runs that no commit holds yet, and whether each surely moved something."""
    hints: list[tuple[str, Command]] = field(default_factory=list)
    """The hints that the last command printed, each with the command that it amounts to."""

    def pending_in(self, tree: str, bench: str) -> bool:
        """Return whether a bench that a worktree keeps has runs that no commit holds."""
        kept = (self.trees[tree] / ".pico" / "benches" / bench / "journal.sqlite").exists()
        return kept and any(moved and self.owners[run] == bench for run, moved in self.pending.items())


def bench_of(words: Sequence[str], environment: Mapping[str, str], use: str) -> str | None:
    """Return the bench that a command means: its flags, else PICO_BENCH, else what its worktree chose. None if it may
    change none, because no variable selects hardware."""
    at, backend = _option(words, "--bench"), _option(words, "--backend")
    if at and "/" in at:
        return "remote"
    if "--emulate" in words:
        return "emulated"
    if backend:
        return backend
    if at:
        return "sim" if at == "local" else at
    if variable := environment.get("PICO_BENCH"):
        return "remote" if "/" in variable else {"local": "sim", "hardware": None}.get(variable, variable)
    return use


def _option(words: Sequence[str], option: str) -> str | None:
    found = None
    for n, word in enumerate(words):
        if word == option and n + 1 < len(words):
            found = words[n + 1]
        elif word.startswith(f"{option}="):
            found = word.partition("=")[2]
    return found


class Commands:
    """Draws commands. `arm`: whether the lab has a robot."""

    def __init__(self, draw: Random, model: Model, arm: bool) -> None:
        self.draw, self.model, self.arm = draw, model, arm
        self.weights = {kind: weight for kind, weight in KINDS.items() if arm or kind != "move"}

    def draw_one(self) -> Command:
        """Draw the next command."""
        while True:
            kind = self.draw.choices(list(self.weights), list(self.weights.values()))[0]
            made = getattr(self, f"_{kind.replace(' ', '_').lower()}", None)
            drawn = made() if made is not None else self._bench(kind, self._words(kind))
            if drawn is not None:  # else there is no run, hint or worktree to be had yet
                return drawn

    def _bench(self, kind: str, words: Sequence[str], *, to: str = "", **more: object) -> Command:
        """Return a command that means a bench: `to`, or one drawn, by flags, by PICO_BENCH, or by neither."""
        tree = self.draw.choice(sorted(self.model.trees))
        cwd = self.draw.choice(sorted(self.model.trees)) if self.draw.random() < 0.25 else tree
        flags: tuple[str, ...] = ()
        environment: dict[str, str] = {}
        how = self.draw.random()
        if to or how < 0.45:
            bench = to or self.draw.choice(BENCHES)
            flags = self.draw.choice((*FLAGS[bench], ("--bench", USES[bench][0])))
        elif how < 0.6:
            environment = {"PICO_BENCH": self.draw.choice((FAR, f"lab/{FAR}", "local", *LOCAL[:2]))}
            if how < 0.5:
                flags = self.draw.choice(FLAGS[self.draw.choice(BENCHES)])
        elif how < 0.62:
            environment = {"PICO_BENCH": "hardware"}
        if cwd != tree:
            flags = ("-C", str(self.model.trees[tree]), *flags)
        before = self.draw.random() < 0.7
        line = ("pico", *flags, *words) if before or "-C" in flags else ("pico", *words, *flags)
        meant = bench_of(line, environment, self.model.use[tree])
        return Command(kind, line, tree, cwd, meant, environment, **more)  # type: ignore[arg-type]

    def _words(self, kind: str) -> tuple[str, ...]:
        draw = self.draw
        angle, revision = f"{draw.choice((0, 5, 10, 30, 60))}", draw.choice([*STATES, "side", "HEAD"])
        words: dict[str, tuple[str, ...]] = {
            "plan REV": ("plan", revision), "apply": ("apply", *YES), "apply REV": ("apply", revision, *YES),
            "set": ("set", f"{draw.choice(('h1', 'h2'))}.angle", angle, *YES),
            "gate": ("set", "gate", f"shutter={draw.choice(('open', 'closed'))}", *YES),
            "move": ("move", "lens", f"x={draw.choice((560, 600, 640))}", f"y={draw.choice((380, 420))}", *YES),
            "measure": ("measure", "meter.power"), "undo": ("undo", *YES), "redo": ("redo", *YES),
            "resume": ("resume", *YES), "recover": ("recover", *YES),
            "commit": ("commit", "-m", "as it stands", *draw.choice(((), *2 * (("--capture",),), ("--allow-empty",)))),
            "log": ("log", "-n", "3"),
        }  # fmt: skip
        return words.get(kind, tuple(kind.split()))

    # kinds that need more than words and a bench: the method of a kind has its name

    def _run(self, kind: str, words: Sequence[str], pending: bool) -> Command | None:
        runs = [run for run in self.model.owners if not pending or run in self.model.pending]
        if not runs:
            return None
        run = self.draw.choice(runs[-8:])
        drawn = self._bench(kind, (*words, run, *(YES if words[0] == "undo" else ())))
        owner = self.model.owners[run]
        return replace(drawn, foreign=owner if owner != drawn.meant else "")

    def _undo_run(self) -> Command | None:
        return self._run("undo RUN", ("undo",), pending=False)

    def _runs_show_run(self) -> Command | None:
        return self._run("runs show RUN", ("runs", "show"), pending=True)

    def _bench_use(self) -> Command:
        tree, bench = self.draw.choice(sorted(self.model.trees)), self.draw.choice(BENCHES)
        words = ("pico", "bench", "use", self.draw.choice(USES[bench]))
        return Command("bench use", words, tree, tree, None, use=bench)

    def _git(self, kind: str, *words: str) -> Command:
        tree = self.draw.choice(sorted(self.model.trees))
        return Command(kind, ("git", *words), tree, tree, None)

    def _checkout(self) -> Command:
        where = self.draw.choice((*STATES, "side", "main"))
        return self._git("checkout", "checkout", "-q", *(("-f",) if self.draw.random() < 0.5 else ()), where)

    def _branch(self) -> Command:
        return self._git("branch", "checkout", "-q", "-b", f"b{self.draw.randrange(10**6)}")

    def _worktree(self) -> Command | None:
        if len(self.model.trees) >= 3:
            return None
        name = f"tree{len(self.model.trees)}"
        path = self.model.trees["main"].parent / name
        at = ("git", "worktree", "add", "-q", "-b", f"{name}b", str(path), self.draw.choice(list(STATES)))
        return Command("worktree", at, "main", "main", None)

    def _edit(self) -> Command:
        part, angle = self.draw.choice(("h1", "h2")), self.draw.choice((0, 15, 35, 50))
        tree = self.draw.choice(sorted(self.model.trees))
        words = ("sed", "-i", rf"/^  {part}:/,/angle/ s/angle: .*/angle: {angle}/", "state/table.yaml")
        return Command("edit", words, tree, tree, None)

    def _attach(self) -> Command:
        return self._bench("attach", ("git", "attach"))

    def _killed(self) -> Command:
        words = self._words(self.draw.choice(("apply", "apply REV", "set", "undo")))
        return self._bench("killed", words, killed=self.draw.uniform(0.2, 1.0))

    def _stop_beside(self) -> Command:
        to = self.draw.choice(BENCHES)
        stopped = self.draw.choice([bench for bench in BENCHES if bench != to])
        return self._bench("stop beside", self._words("apply REV"), to=to, stopped=stopped)

    def _hint(self) -> Command | None:
        if not self.model.hints:
            return None
        hint, by = self.draw.choice(self.model.hints)
        return Command("hint", tuple(shlex.split(hint)), by.tree, by.cwd, by.meant, by.environment, typed="y\n" * 3)

    @staticmethod
    def can_run(hint: str) -> bool:
        """Return whether a hint means a bench and can be run as it stands."""
        return not NOT_RUN.search(hint) and not PLACEHOLDER.search(hint)
