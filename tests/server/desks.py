"""A coordinator with desks, the edge of a bench, its lab in the coordinator's repository, and who answers recipes."""

from __future__ import annotations

import json
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from coordinators import Served, served
from edges import Connected, connected

from pico.server.desk.desks import Desking
from pico.server.git.hosting import repository

ASKING = """\
apiVersion: pico/v1
kind: Recipe
metadata: {name: asking}
steps:
  - {prompt: Is the cover on?, unattended: skip}
  - {prompt: Read the meter., unit: mW, range: [0, 5], as: read}
  - {prompt: Which sample?, choices: [glass, gold], as: which, retries: 1}
returns: {read: read, which: which}
"""
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


def placed(desk: Desked, token: str, who: str) -> None:
    """Put the recipe onto somebody's desk."""
    assert desk.said(token, "status")
    (desk.served.books.folder / "desks" / "shel" / "of" / who / "recipes" / "asking.yaml").write_text(ASKING)


def asked(desk: Desked, token: str, number: str, path: str) -> tuple[str, dict[str, Any]]:
    """Return the run that asks the question of an id at a step, and the question, once it does."""
    until = time.monotonic() + 60
    while True:
        for run in desk.served.ask("GET", "/api/labs/shel/desk/runs", token)[1]["runs"]:
            with suppress(TypeError):
                if (run["question"]["id"], run["question"]["path"]) == (number, path):
                    return run["id"], run["question"]
        assert time.monotonic() < until
        time.sleep(0.02)


def say(desk: Desked, token: str, run: str, number: str, word: str) -> tuple[int, Any]:
    """Answer a question; return the status, and the value or what is wrong."""
    asks = {"question": number, "answer": word}
    status, told = desk.served.ask("POST", f"/api/labs/shel/desk/runs/{run}/answers", token, asks)
    return status, told["value"] if status == 200 else told["error"][0]["summary"]


def followed(desk: Desked, token: str, *words: str) -> Callable[[], list[Any]]:
    """Run a recipe as somebody who follows it; return what returns all that it said once it has ended."""
    said: list[Any] = []
    following = threading.Thread(target=lambda: said.extend(desk.at(token, "run", *words, "-y")[1]))
    following.start()

    def ended() -> list[Any]:
        following.join(60)
        assert not following.is_alive()
        return said

    return ended
