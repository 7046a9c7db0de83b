"""What a run of a recipe has done, line by line in `recipes/ID.jsonl` of the bench's folder: told again, it leads to
the same place.

The first line says which recipe, by its digest, with which parameters. A step that acts has a line when it begins, one
for each run that it begins on the bench, and one with what came of it. Every line is on the disk before what it tells
of begins, or anybody hears of it.
"""

from __future__ import annotations

import errno
import json
import os
from collections.abc import Mapping
from contextlib import closing
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from pico.base.plain_files import other_than_file, read_file, read_text
from pico.base.state_files import RECIPE_LINES, RECIPE_LOG
from pico.diagnostics import PicoError, error
from pico.disk import unwritable
from pico.edge.network.remotes import Place
from pico.model.record import digest
from pico.runs.damage import checksum
from pico.runs.storage.change_count import Count

SCHEMA = "pico.recipe_run/v1"
UNWRITTEN = "recipe-unwritten"
"""The code of what is said where a log can't be written."""


Checked = tuple[str | None, str | None]
"""The branch and the commit that are checked out; None for a detached head, and outside of Git."""


@dataclass
class Logged:
    """What is known of a step that acts: the digest of what it was `given`, its `kind`, the `head` commit when it first
    began, the `runs` that it began, and what it `told`, None while it has not ended. `at`: the branch and the commit
    that were checked out when it was last heard of, None where an older version did not write them."""

    given: str
    head: str | None = None
    kind: str = ""
    at: Checked | None = None
    runs: list[str] = field(default_factory=list)
    told: Mapping[str, Any] | None = None


@dataclass(frozen=True)
class About:
    """A run of a recipe: its id, the recipe by name, path and digest, the values of its parameters, when it began;
    `texts`: of it and of those that it calls, by path, for a checkout may take their files away;
    `ended` as what, empty while it has not."""

    id: str
    name: str
    path: str
    digest: str
    arguments: Mapping[str, Any]
    at: str
    texts: Mapping[str, str] = field(default_factory=dict)
    ended: str = ""


class Log:
    """The log of one run of a recipe. Raises PicoError where it can't be written."""

    def __init__(self, path: Path, about: About, steps: dict[str, Logged], times: int = 0, lines: int = 0) -> None:
        self.path, self.about, self.steps, self.times, self._lines = path, about, steps, times, lines

    @property
    def runs(self) -> list[str]:
        """The runs that its steps began, in their order."""
        return list(dict.fromkeys(run for step in self.steps.values() for run in step.runs))

    @classmethod
    def begin(cls, place: Place, about: About) -> Log:
        """Begin the log of a new run on a bench."""
        log = cls(folder(place) / f"{about.id}.jsonl", about, {})
        data = {k: v for k, v in vars(about).items() if k != "ended"}
        log._write({"schema": SCHEMA, **data})
        return log

    @classmethod
    def read(cls, path: Path) -> Log:
        """Return the log of a run that was begun before; a last line that was cut short does not count. Raises
        PicoError for one that is damaged, or that has fewer lines than were written: its last lines are missing."""
        try:
            least = _count(path).least()  # first: a run may write a line at this moment
            lines = read_text(path).split("\n")[:-1]
            if (missing := least - len(lines)) > 0:
                raise ValueError(f"its last {missing} lines are missing" if missing > 1 else "its last line is missing")
            if not lines:
                raise ValueError("it does not say of which recipe it is")
            if (schema := json.loads(lines[0]).get("schema")) != SCHEMA:
                raise ValueError(f"it is {schema}")
            first, *rest = [_read_line(line) for line in lines]
            known = {k: first[k] for k in ("id", "name", "path", "digest", "arguments", "at")}
            known["texts"] = first.get("texts", {})
            ended, steps, times = "", dict[str, Logged](), 0
            for line in rest:
                times = int(line.get("taken_up", times))
                ended = line.get("ended", "")
                _take(steps, line)
        except (OSError, ValueError, KeyError, TypeError, AttributeError) as exc:
            raise PicoError(RECIPE_LOG.damaged(path, str(exc))) from exc
        return cls(path, About(**known, ended=ended), steps, times, len(lines))

    def begun(self, path: str, given: Any, at: Checked, kind: str = "") -> Logged:
        """Note that a step begins, where `at` is checked out; return what is known of it: where it began before, what
        was known then.

        Raises PicoError where it was given something else then: the recipe can't be taken up.
        """
        known, content = self.steps.get(path), digest(given)
        if known is None:
            known = self.steps[path] = Logged(content, at[1], kind, at)
            self._write({"step": path, "given": content, "head": at[1], "branch": at[0], "kind": kind})
        elif known.given != content:
            text = f"step {path} is not what it was when this recipe was cut short"
            raise PicoError(error("recipe-changed", text, hint="begin it anew, without --resume"))
        return known

    def running(self, path: str, run: str) -> None:
        """Note that a step begins a run on the bench."""
        self.steps[path].runs.append(run)
        self._write({"step": path, "run": run})

    def told(self, path: str, result: Mapping[str, Any], at: Checked) -> None:
        """Note what came of a step, and what is checked out after it."""
        self.steps[path].told, self.steps[path].at = result, at
        self._write({"step": path, "told": result, "digest": digest(result), "head": at[1], "branch": at[0]})

    def taken_up(self) -> int:
        """Note that the run goes on after it was cut short; return how often it has by now."""
        self.times += 1
        self._write({"taken_up": self.times})
        return self.times

    def end(self, how: str) -> None:
        """Note how the run ended: `done`, `failed`; one that was interrupted has no end, and can be taken up."""
        self._write({"ended": how})

    def _write(self, line: Mapping[str, Any]) -> None:
        text = _text({**line, "checksum": checksum(_text(line))})
        try:
            self.path.parent.mkdir(parents=True, exist_ok=True)
            if what := other_than_file(self.path):
                raise OSError(errno.EINVAL, f"it is {what}")
            with self.path.open("ab") as file:
                if file.tell() and not _ends_line(self.path):
                    file.truncate(_whole(self.path))  # what a kill left of the last line
                file.write(f"{text}\n".encode())
                file.flush()
                os.fsync(file.fileno())
            self._lines += 1
            with closing(_count(self.path)) as count:
                count.note(self._lines, durable=True)
        except OSError as exc:
            found = unwritable(self.path, exc, what=f"{self.path} can't be written", code=UNWRITTEN)
            hint = f"{found.hint or 'mend that'}; `pico run --resume` goes on"
            raise PicoError(replace(found, hint=hint)) from exc


def _count(path: Path) -> Count:
    return Count(path.with_suffix(RECIPE_LINES.path(path).suffix))


def folder(place: Place) -> Path:
    """Return where the logs of a bench are."""
    return place.folder / "recipes"


def logs(place: Place) -> list[Path]:
    """Return the logs of a bench, the latest first."""
    return sorted(folder(place).glob("*.jsonl"), reverse=True)


def _text(line: Mapping[str, Any]) -> str:
    return json.dumps(line, ensure_ascii=False, allow_nan=False, sort_keys=True)


def _read_line(text: str) -> dict[str, Any]:
    """Return what a line holds beside its checksum, which those of an earlier version lack; raises ValueError."""
    line: dict[str, Any] = json.loads(text)
    if (known := line.pop("checksum", None)) is not None and known != checksum(_text(line)):
        raise ValueError("the checksum of a line does not match what it holds")
    return line


def _take(steps: dict[str, Logged], line: Mapping[str, Any]) -> None:
    if "given" in line:
        steps[line["step"]] = Logged(line["given"], line.get("head"), line.get("kind", ""), _checked(line))
    elif "run" in line:
        steps[line["step"]].runs.append(line["run"])
    elif "told" in line:
        if digest(line["told"]) != line["digest"]:
            raise ValueError(f"what step {line['step']} told was changed")
        steps[line["step"]].told, steps[line["step"]].at = line["told"], _checked(line)


def _checked(line: Mapping[str, Any]) -> Checked | None:
    return (line["branch"], line["head"]) if "branch" in line else None


def _ends_line(path: Path) -> bool:
    with path.open("rb") as file:
        file.seek(-1, os.SEEK_END)
        return file.read(1) == b"\n"


def _whole(path: Path) -> int:
    return read_file(path).rfind(b"\n") + 1
