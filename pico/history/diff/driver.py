"""What git's diff says of one manifest before its lines: `python -P -m pico.history.diff.driver COLOR MODE PATH ...`.

The wrapper in git's configuration (`history.git.diff_wrapper`) shows its lines only if it ends with SUMMARY or ALONE;
the ordinary diff comes from git in any case, unless `git config pico.diff summary` asks for these lines alone.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

from pico.diagnostics import PicoError
from pico.history.diff.manifests import FileDiff, diff_files
from pico.history.git.diff_wrapper import ALONE, SUMMARY
from pico.manifest.file_names import MAX_BYTES
from pico.model.diff import Change

FAILED = 42
MOST = 100
"""More lines than this are counted, not shown."""
_COLORS = {"+": "32", "-": "31", "~": "33"}
Line = tuple[str, str, str]


def summary(path: str, found: FileDiff, *, color: bool = False) -> str:
    """Return the headline of a file and a line for each thing that differs."""
    lines = [*_lines(found.changes), *found.others]
    head = f"{path}: {_tally(found)}"
    width = min(max((len(name) for _, name, _ in lines), default=0), 40)
    said = [_painted(line, width, color) for line in lines[:MOST]]
    more = [f"  and {len(lines) - MOST} more"] if len(lines) > MOST else []
    return "\n".join([f"\x1b[1;36m{head}\x1b[m" if color else head, *said, *more])


def _lines(changes: Sequence[Change]) -> Iterator[Line]:
    for change in changes:
        pose = change.tunable == "pose"
        sign = "~"
        if pose and change.text.startswith("added"):
            sign = "+"
        elif pose and change.text.startswith("taken out"):
            sign = "-"
        yield sign, change.component if pose else f"{change.component}.{change.tunable}", change.text


def _tally(found: FileDiff) -> str:
    parts = _count(len({c.component for c in found.changes}), "component")
    tally = [f"{_count(len(found.changes), 'tunable')} of {parts}"] if found.changes else []
    tally += [_count(len(found.others), "other value" if tally else "value")] if found.others else []
    return " and ".join(tally) or "the same values, other text"


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}{'' if number == 1 else 's'}"


def _painted(line: Line, width: int, color: bool) -> str:
    sign, name, said = (_printable(part) for part in line)
    named = f"{sign} {name.ljust(width)}"
    return f"  \x1b[{_COLORS[sign]}m{named}\x1b[m  {said}" if color else f"  {named}  {said}"


def _printable(part: str) -> str:
    """Return text of a manifest as one line that moves no cursor."""
    return "".join(c if c.isprintable() else "?" for c in part)


def drive(arguments: Sequence[str]) -> tuple[int, str]:
    """Return the exit code and what to print for what git names: COLOR MODE PATH OLD ID MODE NEW ID MODE [PATH ...]."""
    color, mode, path, old, _, _, new, *rest = arguments
    name = rest[2] if len(rest) > 2 else path
    contents = [_read(file) for file in (old, new)]
    found = diff_files(contents[0], contents[1], Path(name))
    if found is None:
        return FAILED, ""
    return ALONE if mode == "summary" else SUMMARY, summary(_printable(name), found, color=color == "true")


def _read(file: str) -> bytes:
    if file == "/dev/null":
        return b""
    with Path(file).open("rb") as opened:
        return opened.read(MAX_BYTES + 1)


def main(arguments: Sequence[str]) -> int:
    """Print the summary and return the exit code; whatever is wrong, git shows the lines."""
    try:
        code, said = drive(arguments)
        sys.stdout.buffer.write(said.encode())
        sys.stdout.flush()
    except (PicoError, OSError, ValueError, RecursionError, MemoryError):
        return FAILED
    return code


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
