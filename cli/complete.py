"""What Tab offers: names read straight from the files, for completion must not wait for a parser."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

from .summary import COMMANDS

_NAME = re.compile(r"  ([a-z][a-z0-9_]*):\s*(?:\{.*)?(?:#.*)?")


def components(incomplete: str) -> list[str]:
    """Return the parts of the inventory that start like `incomplete`."""
    return sorted({name for name in _inventory() if name.startswith(incomplete)})


def revisions(incomplete: str) -> list[str]:
    """Return the branches and tags that start like `incomplete`."""
    command = ["git", "-C", str(_folder()), "for-each-ref", "--format=%(refname:short)", "refs/heads", "refs/tags"]
    try:
        found = subprocess.run(command, capture_output=True, text=True, check=False, timeout=1).stdout.split()
    except (OSError, subprocess.SubprocessError):
        return []
    return [name for name in found if name.startswith(incomplete)]


def revisions_or_files(incomplete: str) -> list[str]:
    """Return revisions, and saved plans in the folder."""
    return revisions(incomplete) + sorted(p.name for p in _folder().glob(f"{incomplete}*.plan"))


def commands(incomplete: str) -> list[str]:
    """Return the commands that start like `incomplete`."""
    return [name for name in COMMANDS if name.startswith(incomplete)]


def _folder() -> Path:
    words = sys.argv
    return Path(words[words.index("-C") + 1]) if "-C" in words[:-1] else Path()


def _inventory() -> Iterator[str]:
    """Yield the keys under `inventory:` of the lab's files, as their indentation shows them."""
    here = _folder().resolve()
    root = next((p for p in (here, *here.parents) if (p / "lab.yaml").is_file()), here)
    for path in root.glob("*.yaml"):
        inside = False
        for line in path.read_text(errors="replace").splitlines():
            if line[:1] not in (" ", "#", ""):
                inside = line.startswith("inventory:")
            elif inside and (match := _NAME.fullmatch(line)):
                yield match[1]
