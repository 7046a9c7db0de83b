"""What the tests of the command line share."""

from __future__ import annotations

import io
import json
import re
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pico.base.state_files import JOURNAL, RUN_MARK
from pico.edge.lease import BenchLock
from pico.places.bench import BenchPlace
from pico.runs.journal import Journal


@dataclass(frozen=True)
class Answer:
    code: int
    out: str
    err: str

    @property
    def data(self) -> Any:
        return json.loads(self.out)


Pico = Callable[..., Answer]
Brought = Callable[[Callable[[Path], Any]], Any]
"""Makes the example what a function makes of it, and returns what that returned."""


class Typed(io.StringIO):
    """What somebody types at a terminal, in place of `sys.stdin`."""

    def isatty(self) -> bool:
        return True


def succeed(*words: str) -> None:
    """Run a command in the current directory, as a function that `brought` calls does; it must succeed."""
    from pico_cli.main import main

    assert main(words) == 0, words


def apply_manifest(_: Path) -> None:
    """Make the bench what the manifest says."""
    succeed("apply", "--yes")


def apply_e1(_: Path) -> None:
    """Make the bench what the branch e1 says."""
    succeed("apply", "e1", "--yes")


def edit(path: Path, before: str, after: str) -> None:
    """Change a manifest as somebody with an editor would."""
    text = path.read_text()
    assert before in text
    path.write_text(text.replace(before, after, 1))


def with_goals(lab: Path, goals: str) -> None:
    """Give a lab other goals (a block `goals:`) than those that it comes with."""
    text = re.sub(r"^goals:\n(?:[ #].*\n)+", "", lab.read_text(), count=1, flags=re.MULTILINE)
    lab.write_text(text.replace("inventory:\n", goals.removesuffix("inventory:\n") + "inventory:\n", 1))


@contextmanager
def a_run_goes_on(root: Path, what: str, bench: str = "sim") -> Iterator[None]:
    """Hold the bench, in the midst of a run."""
    place, run = BenchPlace(root, bench), "20261123T120000Z-aaaaaa"
    mark = RUN_MARK.path(place.folder)
    with BenchLock(place).held(what), closing(Journal(JOURNAL.path(place.folder))) as journal:
        journal.begin_run(run, "", what)
        mark.write_text(run)
        yield
        mark.unlink()
        journal.end_run(run, "done", {})
