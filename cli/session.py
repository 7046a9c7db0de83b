"""What every command is told (`-C`, `--json`, `--debug`, `--backend`), and where its answer goes."""

from __future__ import annotations

import json
import shlex
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

import typer

from pico.backends.devices import EMULATED, HARDWARE, SIMULATOR, opener
from pico.diagnostics import Diagnostic, PicoError, error
from pico.places.layout import take_report

from .at_once.complete import SHARED
from .garbage import loaded
from .hints import OPTIONS, flags_of, with_flags_in
from .terminal.output import flags, write
from .terminal.waiting import waiting
from .views.style import inert_json, paint

if TYPE_CHECKING:
    from pico.bench.bench import Bench
    from pico.edge.network.remotes import Place
    from pico.history.lab.folder import Safety
    from pico.history.lab_history import LabHistory
    from pico.places.bench import BenchPlace

    from .standing import Standing

YES = ("--auto-approve", "--yes", "-y")
"""The options by which a command runs without confirmation."""
standing: list[Standing] = []
"""How the lab stood before this command was to change something."""


class View(Protocol):
    """A module of `views`."""

    def text(self, *args: Any, **options: Any) -> str: ...

    def data(self, *args: Any, **options: Any) -> dict[str, Any]: ...


@dataclass(frozen=True)
class Session:
    """One call of `pico`."""

    context: typer.Context | None = None
    folder: Path = Path()
    json: bool = False
    debug: bool = False
    lock_timeout: float = 0.0
    at: str | None = None
    """The bench that `--bench` names; None if it was not given."""
    backend: str | None = None
    """The bench that `--backend` and `--emulate` name; None if neither was given."""
    said: Mapping[str, Any] = field(default_factory=dict, compare=False)
    """The options that say which bench is meant, as far as they were given; see `hints.OPTIONS`."""
    told: list[Diagnostic] = field(default_factory=list, compare=False)
    headline: list[str] = field(default_factory=list, compare=False)
    """On which bench this command is, until that was said."""
    intended: list[Callable[[], Callable[[], None]]] = field(default_factory=list, compare=False)
    """Keeps this call, once it is approved, and returns what to call at its end; see `calls`."""

    @classmethod
    def of(cls, context: typer.Context) -> Session:
        """Return the session of a command, from the options given before and after its name."""
        given = dict(context.meta.get("pico.session", {}))
        said = {name: value for name, value in given.items() if name in OPTIONS}
        if given.pop("emulate", False):
            if given.get("backend", HARDWARE) not in (HARDWARE, EMULATED):
                text = f"`--backend {given['backend']}` has no devices that could be emulated"
                raise PicoError(error("usage", text, hint="`--backend hardware --emulate`"))
            given["backend"] = EMULATED
        found = cls(context=context, said=said, **given)
        flags[:] = found.flags()
        return found

    def flags(self) -> tuple[str, ...]:
        """Return the flags with which another command reaches the same bench, each as it is typed."""
        return flags_of(self.said)

    def place(self, root: Path, *, safety: bool = False) -> Place:
        """Return the bench that is meant for the lab in `root`, see `pico.edge.network.meant`. Raises PicoError."""
        from pico.edge.network.meant import meant

        return meant(root, backend=self.backend, word=self.at, safety=safety)

    def root(self, *, safety: bool = False) -> Path:
        """Return the folder of the lab; with `safety` also if its manifest is gone. Raises PicoError."""
        from pico.manifest.load import find_lab, find_lab_of_bench

        return (find_lab_of_bench if safety else find_lab)(self.folder)

    def here(self, root: Path, *, safety: bool = False) -> BenchPlace:
        """Return the bench that is meant, which is to be one of this machine; raises PicoError for another."""
        from pico.places.bench import BenchPlace

        place = self.place(root, safety=safety)
        if isinstance(place, BenchPlace):
            return place
        if place.local:  # `pico gui` serves it
            return BenchPlace(root, place.local)
        text = f"{place.said} is not a bench of this machine"
        hint = "`--bench sim`, `--bench emulated` or `--bench hardware` names one of this lab"
        raise PicoError(error("remote", text, hint=hint))

    def bench(
        self, fidelity: str | None = None, speed: float | None = None, *, writing: bool = False, calls: bool = True,
        safety: Safety = "",
    ) -> Bench:  # fmt: skip
        """Open the lab of this session; `writing`: to move something, or change files or history. What is called is
        kept then, see `calls`, unless the command does that later itself. `safety`: to switch light off or to empty a
        hand, also if the manifests are wrong or gone; that is reported. Raises PicoError."""
        from pico.bench.bench import Bench

        from .views.style import count_waits, no_waits

        if self.backend is not None:
            opener(self.backend)
        place = self.place(self.root(safety=bool(safety)), safety=bool(safety))
        bench = Bench.open(
            self.folder, backend=self.backend, fidelity=fidelity, speed=speed, bench=place, safety=safety
        )
        loaded()
        self._head(bench.setup.lab.name, place)
        count_waits(lambda: bench.waits)
        if self.context is not None:
            self.context.call_on_close(lambda: count_waits(no_waits))
            self.context.call_on_close(bench.close)
            self.context.call_on_close(lambda: self.tell(bench.folder.recovered))  # while a guard was still at it
        if writing:
            from .standing import Standing

            standing[:] = [Standing(bench.place)]
            self.wire(bench.root)
        self.tell(
            (
                *lost_warning(place, chosen=not (self.at or self.backend)),
                *take_report(bench.root),
                *bench.folder.recovered,
                *bench.folder.proposed,
                *_without_manifests(bench, safety),
            )
        )
        if self.lock_timeout:
            with waiting("Waiting for the bench"):
                bench.wait_until_free(self.lock_timeout)
        if writing and calls:
            self.calls(bench)
        return bench

    def calls(self, bench: Bench) -> None:
        """Keep what somebody called, until the command ends, if it is one to be approved, which may start a run: at
        once with `--auto-approve`, else as soon as somebody says yes. A command that is killed before its run begins
        leaves that."""
        if self.context is None or "auto_approve" not in self.context.params:
            return
        command = shlex.join(_own_words(self.context.meta.get("pico.words", ())))
        self.intended[:] = [lambda: bench.recovery.intend(command)]
        if self.context.params["auto_approve"]:
            self.intend()

    @property
    def command(self) -> str:
        """What is called, without its arguments: `pico move`."""
        return "pico" if self.context is None else self.context.command_path

    @property
    def words(self) -> str:
        """What is called, with its arguments but without what says on which bench it is and `-y`: `pico apply e1`."""
        return f"pico {shlex.join(_own_words(self.context.meta.get('pico.words', ())))}" if self.context else "pico"

    def intend(self) -> None:
        """Keep what was called: it is approved."""
        if self.context is not None and self.intended:
            self.context.call_on_close(self.intended.pop()())

    def name_bench(self) -> None:
        """Say on which bench this command is, unless that was said, or a plan says it at its head."""
        if self.headline:
            write(sys.stderr, paint("dim", self.headline.pop()))

    def _head(self, lab: str, place: Place) -> None:
        """Have the bench named before the first answer; at the end at last if it is not the simulator of this lab."""
        if not self.json:
            self.headline[:] = [f"{lab} · {place.said}"]
            if place.name != SIMULATOR and self.context is not None:
                self.context.call_on_close(self.name_bench)

    def history(self) -> LabHistory:
        """Open the history of this session's lab, also while its manifests are wrong; raises PicoError."""
        from pico.history.lab.folder import LabFolder
        from pico.history.lab_history import LabHistory
        from pico.manifest.load import find_lab

        root = find_lab(self.folder)
        folder = LabFolder(root, history=True, place=self.place(root))
        loaded()
        self.tell((*take_report(root), *folder.recovered))
        return LabHistory(folder)

    def wire(self, folder: Path) -> None:
        """Let git merge the manifests by PICO where the repository asks for it; said once."""
        from pico.history.git.attributes import wire

        if wire(folder):
            from .views.wired import SET

            write(sys.stderr, SET)

    def show(self, view: View, *args: Any, **options: Any) -> None:
        """Print an answer, for people or as one JSON document."""
        if self.json:
            self.document(view.data(*args, **options))
            return
        if getattr(view, "NAMES_BENCH", False):
            self.headline.clear()
        self.say(view.text(*args, **options))

    def draw(self, shown: Path | None, what: str, draw: Callable[[Path], object]) -> None:
        """Have a picture of `what` drawn where somebody asked for one, and say where it is."""
        if shown is not None:
            from .views import picture

            with waiting("Drawing"):
                draw(self.folder / shown)
            self.say(f"\n{picture.text(self.folder / shown, shown=shown, what=what)}")

    def document(self, data: Any) -> None:
        """Print one JSON document, in one line."""
        found = with_flags_in(data, flags)
        write(sys.stdout, inert_json(json.dumps(found, ensure_ascii=False, default=str)), data=True)

    def say(self, text: str) -> bool:
        """Print text for people; nothing with `--json`. Return whether somebody may still read."""
        self.name_bench()
        return self.json or write(sys.stdout, text)

    def report(self, diagnostics: Sequence[Diagnostic]) -> None:
        """Print diagnostics: on standard error for people, on standard output as JSON."""
        from .views import diagnostics as view

        if diagnostics and self.json:
            self.document(view.data(diagnostics))
        elif diagnostics:
            write(sys.stderr, view.text(diagnostics))

    def tell(self, diagnostics: Sequence[Diagnostic]) -> None:
        """Print what came up beside the answer, once, for people alone: JSON is the answer."""
        new = [d for d in diagnostics if d not in self.told]
        self.told.extend(new)
        if not self.json:
            self.report(new)

    def require_answer(self, auto_approve: bool) -> None:
        """Raise PicoError where a question would have to be asked and JSON is the answer."""
        if self.json and not auto_approve:
            raise PicoError(error("usage", "with --json nobody is asked", hint="add --auto-approve"))

    def confirm(self, question: str, auto_approve: bool, *, by_person: bool = False) -> bool:
        """Ask, unless told not to, and return whether the answer is yes. Raises PicoError if the call has no terminal.
        `by_person`: only a person at the table knows the answer, and no option gives it."""
        if auto_approve and not by_person:
            self.intend()
            return True
        if sys.stdin is None or not sys.stdin.isatty():
            hint = "add --auto-approve (or -y) if this call has no terminal"
            if by_person:
                hint = "run this command at a terminal by the table: --yes does not answer this question"
            raise PicoError(error("usage", f"nobody can be asked here: {question.strip()}", hint=hint))
        write(sys.stdout, f"{question} [y/N] ", end="")
        try:
            answer = input()
        except (EOFError, OSError):  # the end of what was piped in, or of the terminal
            answer = ""
            write(sys.stdout, "")
        if answer.strip().lower() not in ("y", "yes"):
            return False
        self.intend()
        return True


def _own_words(words: Sequence[str]) -> list[str]:
    """Return the words of a call without those that say on which bench it is, and without `-y`: hints add the first,
    and the second a person."""
    kept, rest = list[str](), iter(words)
    for word in rest:
        if word == "--":
            return [*kept, word, *rest]
        if (name := word.partition("=")[0]) in SHARED:
            if SHARED[name] and "=" not in word:
                next(rest, None)
        elif word not in YES:
            kept.append(word)
    return kept


def _without_manifests(bench: Bench, safety: Safety) -> tuple[Diagnostic, ...]:
    """Return what is wrong with manifests that a command for safety does without, and which Lab it goes by."""
    if not safety or (wrong := bench.folder.wrong) is None:
        return ()
    by = "the Lab that the bench keeps as its own" if bench.folder.own is not None else "the Lab of the manifests"
    note = Diagnostic("note", "bench-lab", f"this command continues by {by}")
    return (*(replace(one, severity="warning") for one in wrong.diagnostics if one.severity == "error"), note)


def lost_warning(place: Place, *, chosen: bool = False) -> tuple[Diagnostic, ...]:
    """Return a warning if what was kept of a bench of this machine is gone; what would move it is refused, but for a
    table of emulated devices, which begins anew. `chosen`: no option named it; then also if another bench is gone, for
    the worktree may have chosen that one."""
    from pico.places.bench import BenchPlace
    from pico.places.lost import lost_bench, others_lost

    if not isinstance(place, BenchPlace):
        return ()
    found = [lost_bench(place), *(others_lost(place) if chosen else ())]
    if place.name == EMULATED:
        from pico.edge.recovery import lost_table

        found.append(lost_table(place))
    return tuple(replace(one, severity="warning") for one in found if one)
