"""A laboratory with all that PICO keeps of it, as files that a later version finds again: the repository as a bundle,
the bench's journal as SQL, its simulated table, saved plans; and what was true of it, in `facts.json`.

Facts are states, changes, digests and ends, never prose, seconds, or how many operations a plan takes.
"""

from __future__ import annotations

import json
import shutil
import sqlite3
import subprocess
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

RELEASES = Path(__file__).resolve().parent
LABS = tuple(sorted(path.parent for path in RELEASES.glob("*/*/facts.json")))

Call = Callable[..., Any]
"""Calls `pico` with words in the laboratory; returns its answer with `code`, `out` and `err`."""


def keep(lab: Path, kept: Path) -> None:
    """Write what a laboratory holds into the folder `kept`."""
    shutil.rmtree(kept, ignore_errors=True)
    (kept / "plans").mkdir(parents=True)
    _git(lab, "bundle", "create", "-q", str(kept / "repository.bundle"), "HEAD", "--branches", "--tags")
    with sqlite3.connect(lab / ".pico/benches/sim/journal.sqlite") as journal:
        (version,) = journal.execute("PRAGMA user_version").fetchone()
        lines = [*journal.iterdump(), f"PRAGMA user_version={version};"]
    (kept / "journal.sql").write_text("\n".join(lines) + "\n")
    shutil.copy(lab / ".pico/benches/sim/world.json", kept)
    for plan in lab.glob("*.plan"):
        shutil.copy(plan, kept / "plans")


def restore(kept: Path, lab: Path) -> None:
    """Make the laboratory that is kept in `kept` in the new folder `lab`, with all benches in one folder as then."""
    _git(kept, "clone", "-q", str(kept / "repository.bundle"), str(lab))
    for branch in _git(lab, "for-each-ref", "--format=%(refname:lstrip=3)", "refs/remotes/origin").split():
        if branch not in ("HEAD", "main"):
            _git(lab, "branch", "-q", branch, f"origin/{branch}")
    (lab / ".pico/sim").mkdir(parents=True)
    with sqlite3.connect(lab / ".pico/journal.sqlite") as journal:
        journal.executescript((kept / "journal.sql").read_text())
    shutil.copy(kept / "world.json", lab / ".pico/sim")
    for plan in (kept / "plans").glob("*"):
        shutil.copy(plan, lab)


def facts(pico: Call, lab: Path) -> dict[str, dict[str, Any]]:
    """Return what is true of a laboratory: its commits, runs and last changes, how the bench differs, saved plans."""
    goals = _git(lab, "for-each-ref", "--format=%(refname:lstrip=2)", "refs/heads", "refs/tags").split()
    return {
        "commits": {c["id"]: _commit(c) for c in _told(pico, "log", "--all")["commits"]},
        "diff": {goal: _changes(_told(pico, "diff", "main", goal)) for goal in goals},
        "runs": {run["document"]["id"]: _run(run["document"]) for run in _told(pico, "runs", "list", "--all")["runs"]},
        "blame": {_address(leaf): leaf["last"]["commit"] for leaf in _told(pico, "blame")["leaves"]},
        "status": {_address(row): [row.get(key) for key in _ROW] for row in _told(pico, "status")["rows"]},
        "plans": {goal: _plan(_told(pico, "plan", goal)) for goal in goals},
        "saved": {path.name: json.loads(path.read_text())["digest"] for path in lab.glob("*.plan")},
    }


def written(facts: Mapping[str, Mapping[str, Any]]) -> str:
    """Return facts as they are kept, a line each."""

    def one(what: object) -> str:
        return json.dumps(what, sort_keys=True, ensure_ascii=False)

    sections = (
        (name, ",\n".join(f"  {one(k)}: {one(found[k])}" for k in sorted(found))) for name, found in facts.items()
    )
    return "{\n" + ",\n".join(f' "{name}": {{\n{lines}\n }}' for name, lines in sections) + "\n}\n"


_ROW = ("committed", "desired", "live", "edited", "off", "drifted")
_RUN = ("state_before", "state_after", "plan", "goal", "goal_commit", "evidence", "outcome", "resumed", "tally")


def _address(told: Any) -> str:
    return f"{told['component']}.{told['tunable']}"


def _changes(told: Any) -> list[list[Any]]:
    return [[_address(c), c.get("before"), c.get("after"), c["tolerated"]] for c in told["changes"]]


def _commit(told: Any) -> dict[str, Any]:
    return {"changes": _changes(told), **{key: told[key] for key in ("parents", "evidence", "verdict")}}


def _run(document: Any) -> dict[str, Any]:
    return {"changes": _changes(document), **{key: document.get(key) for key in _RUN}}


def _plan(told: Any) -> dict[str, Any]:
    return {"changes": _changes(told), "target": told["target"]["state"], "lab": told["lab"]}


def _told(pico: Call, *words: str) -> Any:
    answer = pico(*words, "--json")
    assert answer.code in (0, 2, 7), (words, answer)  # a plan that is denied is told as well
    return json.loads(answer.out)


def _git(folder: Path, *words: str) -> str:
    return subprocess.run(["git", *words], cwd=folder, check=True, capture_output=True, text=True).stdout
