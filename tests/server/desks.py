"""A coordinator with desks, the edge of a bench, and its lab in the coordinator's repository."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from coordinators import Served, served
from edges import Connected, connected

from pico.server.desk.desks import Desking
from pico.server.git.hosting import repository

WARM = (sys.executable, "-P", "-m", "pico_cli.warm")


@dataclass
class Desked:
    """A coordinator with desks, and the edge of its bench."""

    served: Served
    edge: Connected
    root: Path

    @property
    def bare(self) -> Path:
        """The lab's repository at the coordinator."""
        return repository(self.served.books.folder, "shel")

    def at(self, token: str, command: str, *words: str, **more: Any) -> tuple[int, list[Any]]:
        """Run a command at a desk; return the status and the documents of the answer."""
        path = f"/api/labs/shel/desk/{command.replace(' ', '/')}"
        status, body = self.served.ask("POST", path, token, {"words": list(words), **more})
        return status, [json.loads(line) for line in body.splitlines()] if isinstance(body, bytes) else [body]

    def said(self, token: str, command: str, *words: str, **more: Any) -> list[Any]:
        """Return what a command says that ends well."""
        status, documents = self.at(token, command, *words, **more)
        assert status == 200 and documents[-1]["exit"] == 0, (command, words, status, documents[-3:])
        return documents[:-1]

    def git(self, *words: str) -> str:
        """Return what git says of the lab's repository at the coordinator."""
        done = subprocess.run(["git", "--git-dir", self.bare, *words], check=True, capture_output=True, text=True)
        return done.stdout.strip()


def pushed(root: Path, bare: Path, *words: str) -> None:
    """Push from a checkout into the repository of its lab."""
    subprocess.run(["git", "-C", root, "push", "-q", bare, *(words or ("--all",))], check=True)


@contextmanager
def desked(folder: Path, root: Path) -> Iterator[Desked]:
    """Serve the lab in `root` with desks."""
    with served(folder, desks=Desking(WARM)) as serving, connected(serving, root) as edge:
        serving.loosen()
        found = Desked(serving, edge, root)
        pushed(root, found.bare)
        yield found
