"""One sequence of `cross_bench.py`: each command is run in a process of its own, and the benches are compared before
and after it."""

from __future__ import annotations

import os
import re
import shlex
import signal
import time
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from random import Random

import cross_bench_oracle as oracle
from cross_bench_child import TIMEOUT, Answer, Child
from cross_bench_labs import FAR, GIT, PACE, git
from cross_bench_oracle import BenchPrint
from cross_bench_sequences import FLAGS, Command, Commands, Model, bench_of

HINT = re.compile(r"`(pico [^`\n]+)`")
MAY_NAME_OTHERS = ("undo RUN", "runs show RUN", "log", "diff", "commit", "hint")
"""Kinds that may name runs of other benches: they were given one, or commits hold them."""
SHOWS_COMMITTED = ("runs", "runs show")
"""Kinds that show the runs of commits, too, of whichever bench these are."""
MAY_POINT_ELSEWHERE = ("commit", "stop", "undo", "undo RUN", "redo", "resume", "killed")
"""Kinds whose hints may name another bench by its flags, as those of a refusal may: its runs stay pending, continue, or
are later than those of this bench."""
NAMES_BENCH = ("plan", "plan REV", "apply", "apply REV", "status", "drift", "undo", "redo", "resume", "recover")
"""Kinds whose output names the bench that they mean."""
SHORTEST, LONGEST = 8, 30
"""How many commands a sequence has."""


@dataclass(frozen=True)
class Options:
    """How sequences are run."""

    seed: int
    plant: str = ""
    """The fault that is planted in PICO; empty for none."""
    verbose: bool = False
    """Whether each command is printed."""
    hints: bool = True
    """Whether a hint that means another bench is a violation."""


class Trial:
    """One sequence, over the benches in `at`."""

    def __init__(self, at: Mapping[str, Path], draw: Random, arm: bool, options: Options) -> None:
        self.far, self.wires, self.scratch = at["far"], at["wires"], at["main"].parent
        self.model = Model({"main": at["main"]}, {"main": "sim"})
        self.draw, self.options = draw, options
        self.commands = Commands(draw, self.model, arm)
        self.usual: dict[str, float] = {}
        """How long an apply takes by bench [s]."""
        self.count: Counter[str] = Counter()
        self.transcript: list[str] = []

    def run(self) -> Iterator[str]:
        """Run the sequence; yield the violations."""
        for _ in range(self.draw.randint(SHORTEST, LONGEST)):
            command = self.commands.draw_one()
            before = self.prints()
            heads = {name: git(tree, "rev-parse", "HEAD") for name, tree in self.model.trees.items()}
            answer = self.execute(command)
            outlives = command.killed is not None or "remote" in (command.meant, command.stopped)
            after = self.settled_prints() if outlives else self.prints()
            self.note(command, answer, before, after)
            for violation in self.check(command, answer, before, after, heads):
                self.transcript.append(f"  !! {violation}")
                yield violation
            self.learn(command, answer, after)

    def prints(self) -> dict[str, BenchPrint]:
        """Return the benches as they are now."""
        return oracle.read_prints(self.model.trees, self.far, self.wires)

    def settled_prints(self) -> dict[str, BenchPrint]:
        """Return the benches once nothing changes any more: a run of the remote bench outlives its client."""
        found, ends = self.prints(), time.monotonic() + 10
        while time.monotonic() < ends:
            time.sleep(0.1)
            again = self.prints()
            if again == found:
                break
            found = again
        return found

    def note(
        self, command: Command, answer: Answer, before: Mapping[str, BenchPrint], after: Mapping[str, BenchPrint]
    ) -> None:
        """Add a command to the transcript and the counts."""
        meant = command.meant or "none"
        lines = sorted(answer.err.strip().splitlines(), key=lambda line: not line.startswith("error"))
        why = f": {lines[0][:120]}" if answer.code > 0 and lines else ""
        self.transcript.append(f"{command.text}   -> {answer.code}, {meant}{why}")
        if self.options.verbose:
            print(f"    {self.transcript[-1]}  ({answer.seconds:.1f} s)", flush=True)
        self.count[f"{command.kind:14} {meant:9} {'exit 0' if answer.code == 0 else 'not 0'}"] += 1
        self.count[f"{meant:9} seconds"] += round(answer.seconds)
        if command.killed is not None and command.meant and after[command.meant].runs != before[command.meant].runs:
            self.count["killed after a run began"] += 1
        if command.kind == "hint":
            self.count["hints run literally"] += 1

    # the oracle

    def check(
        self, command: Command, answer: Answer, before: Mapping[str, BenchPrint], after: Mapping[str, BenchPrint],
        heads: Mapping[str, str],
    ) -> Iterator[str]:  # fmt: skip
        """Yield the violations of a command."""
        meant, kind = command.meant, command.kind
        self.model.hints.clear()  # of the command before this one: `bench use` gives them another meaning
        if answer.seconds > TIMEOUT:
            yield f"`{kind}` did not end within {TIMEOUT:g} s"
        if failure := re.search(r"error\[internal\].*|Traceback \(most recent call last\)", answer.text):
            yield f"`{kind}` failed inside PICO: {failure[0][:160]}"
        if kind == "bench use" and answer.code:
            yield f"`bench use {command.use}` was refused: {answer.err.strip()[:200]}"
        yield from oracle.check_others(before, after, (meant, command.stopped))
        if command.stopped:
            yield from oracle.check_look(before[command.stopped], after[command.stopped], command.stopped)
            if answer.code == 130 or "interrupted" in answer.text.lower():
                yield f"`stop` on {command.stopped} stopped a run on {meant}"
        if meant is not None:
            if command.looks:
                yield from oracle.check_look(before[meant], after[meant], meant)
            yield from self.check_runs(command, answer, before[meant], after[meant], heads[command.tree])
            yield from self.check_messages(command, answer)
            yield from self.check_hints(command, answer)

    def check_runs(
        self, command: Command, answer: Answer, before: BenchPrint, after: BenchPrint, head: str
    ) -> Iterator[str]:
        """Yield the runs of other benches that a command used, named or committed."""
        meant, kind, owners = command.meant or "", command.kind, self.model.owners
        for run in after.runs.keys() - before.runs.keys():
            if others := oracle.runs_of_others(meant, after.runs[run], owners):
                yield f"the new run {run} on {meant} refers to {', '.join(others)}"
        if kind in SHOWS_COMMITTED:
            owners = {run: bench for run, bench in owners.items() if run in self.model.pending}
        named = oracle.runs_of_others(meant, answer.text, owners)
        refused = answer.code != 0 and all(_names(owners[one[:23]], answer.text) for one in named)
        if kind not in MAY_NAME_OTHERS and named and not refused:
            yield f"`{kind}` on {meant} names {', '.join(named)}"
        if command.foreign and answer.code == 0:
            yield f"`{kind}` on {meant} accepted a run of {command.foreign}"
        tree = self.model.trees[command.tree]
        if git(tree, "rev-parse", "HEAD") != head:
            name = FAR if meant == "remote" else meant
            yield from oracle.check_commits(tree, head, meant, owners, name)

    def check_messages(self, command: Command, answer: Answer) -> Iterator[str]:
        """Yield the benches that an answer should have named."""
        meant, kind = command.meant or "", command.kind
        if (
            command.foreign and answer.code and "unexpected extra argument" not in answer.err
        ):  # else it takes no run yet
            named = (meant, command.foreign) if command.foreign != "remote" else ()  # only its coordinator knows
            missing = [one for one in named if not _names(one, answer.text)]
            if missing:
                text = answer.err.strip()[:200]
                yield f"`{kind}` on {meant} refused a run of {command.foreign} without naming {missing}: {text}"
        if kind in NAMES_BENCH and answer.code == 0 and not _names(meant, answer.text):
            yield f"`{kind}` does not say that it means {meant}"
        if kind == "commit" and answer.code == 0:
            for bench in oracle.LOCAL:
                if bench != meant and self.model.pending_in(command.tree, bench) and not _names(bench, answer.text):
                    yield f"`commit` on {meant} does not say that runs of {bench} stay pending"

    def check_hints(self, command: Command, answer: Answer) -> Iterator[str]:
        """Record the hints of an answer, and yield those that mean another bench."""
        if command.kind == "hint":
            return
        for hint in sorted(set(HINT.findall(re.sub(r"\s*\n\s*", " ", answer.text)))):
            try:
                words = shlex.split(hint)
            except ValueError:
                continue
            if not self.commands.can_run(hint):
                continue
            self.count["hints printed"] += 1
            tree = command.cwd
            if "-C" in words[:-1]:
                path = Path(words[words.index("-C") + 1])
                tree = next((name for name, one in self.model.trees.items() if one == path), command.tree)
            means = bench_of(words, command.environment, self.model.use[tree])
            explicit = any(word.startswith(("--bench", "--backend", "--emulate")) for word in words)
            other = explicit and (answer.code != 0 or command.kind in MAY_POINT_ELSEWHERE)
            if means == command.meant or other:
                self.model.hints.append((hint, replace(command, meant=means)))
            elif self.options.hints:
                yield f"a hint of `{command.kind}` on {command.meant} means {means}: `{hint}`"

    # the model

    def learn(self, command: Command, answer: Answer, after: Mapping[str, BenchPrint]) -> None:
        """Record what a command made: runs, worktrees, the bench in use, commits."""
        model = self.model
        for bench, one in after.items():
            for run in one.runs.keys() - model.owners.keys():
                model.owners[run] = command.meant or bench
                model.pending[run] = answer.code == 0 and command.kind in ("apply", "apply REV", "set", "gate", "move")
        if command.kind in ("commit", "hint"):
            for path in model.trees[command.tree].glob("runs/*/*/*/run.json"):
                for run in oracle.runs_in(path):
                    model.pending.pop(run, None)
        if answer.code == 0 and command.kind == "bench use":
            model.use[command.tree] = command.use
        if answer.code == 0 and command.kind == "worktree":
            name = Path(command.words[-2]).name
            model.trees[name] = self.scratch / name
            model.use[name] = "sim"

    # processes

    def execute(self, command: Command) -> Answer:
        """Run a command to its end, or until it is killed."""
        child = self._start(command)
        usual = self.usual.get(command.meant or "", 0.5)
        if command.stopped:
            time.sleep(self.draw.random() * usual)
            words = ("pico", *FLAGS[command.stopped][0], "stop")
            self._start(replace(command, words=words, environment={})).wait()
        if command.killed is not None:
            if self.draw.random() < 0.7:  # in the middle of a run, else at any moment
                self._wait_for_run(command.meant, child)
                usual *= 0.3
            time.sleep(command.killed * usual)
            if not child.ended():
                os.kill(child.process, signal.SIGKILL)
        answer = child.wait()
        if command.kind.startswith("apply") and answer.code == 0 and command.meant:
            self.usual[command.meant] = 0.5 * usual + 0.5 * answer.seconds
        return answer

    def _wait_for_run(self, bench: str | None, child: Child) -> None:
        """Wait until a run begins on a bench, or the process has ended."""
        before, ends = self._runs_begun(bench), time.monotonic() + TIMEOUT
        while self._runs_begun(bench) == before and not child.ended() and time.monotonic() < ends:
            time.sleep(0.002)

    def _runs_begun(self, bench: str | None) -> int:
        folders = [self.far] if bench == "remote" else list(self.model.trees.values())
        kept = ("*.sqlite", f"benches/{'sim' if bench == 'remote' else bench}/journal.sqlite")
        paths = [path for folder in folders for one in kept for path in (folder / ".pico").glob(one)]
        return sum(oracle.count_runs(path) for path in paths)

    def _start(self, command: Command) -> Child:
        environment = {
            **{k: v for k, v in os.environ.items() if not k.startswith(("PICO_", "GIT_"))}, **GIT,
            "PICO_TOKEN": os.environ["PICO_TOKEN"], "PICO_EMULATED_PACE": PACE, **command.environment,
        }  # fmt: skip
        folder = self.model.trees[command.cwd]
        return Child(command.words, folder, environment, self.scratch, command.typed, self.options.plant)


def _names(bench: str, text: str) -> bool:
    """Return whether a text names a bench."""
    return (FAR if bench == "remote" else bench) in text
