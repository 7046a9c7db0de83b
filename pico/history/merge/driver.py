"""What git runs to merge one manifest:
`python -P -m pico.history.merge.driver OURS OUT BASE THEIRS SIZE PATH [NAMES...]`.

The wrapper in git's configuration (`history.git.attributes`) takes its result only if it ends with CLEAN or CONFLICT,
codes that nothing else ends with by accident; on anything else git's own merge of lines takes its place.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from pathlib import Path

from pico.diagnostics import PicoError
from pico.history.git.attributes import CLEAN, CONFLICT, FAILED
from pico.history.merge.groups import groups_near
from pico.history.merge.manifests import Merged, merge
from pico.history.merge.markers import Labels


def drive(arguments: Sequence[str]) -> tuple[int, str]:
    """Merge the files that git names, write the result to OUT, and return the exit code and what to tell the user."""
    ours, out, base, theirs, size, path, *names = arguments
    labels = _labels(names, int(size))
    groups, strict = groups_near(Path(path))
    contents = [Path(name).read_bytes() for name in (base, ours, theirs)]
    merged = merge(contents[0], contents[1], contents[2], labels=labels, groups=groups, strict=strict)
    with Path(out).open("wb") as file:
        file.write(merged.data)
        file.flush()
        os.fsync(file.fileno())
    ways = [] if merged.clean else ways_out(path, os.environ.get("GIT_REFLOG_ACTION", ""))
    return (CLEAN if merged.clean else CONFLICT), "".join(f"{line}\n" for line in (*told(merged, path, labels), *ways))


def ways_out(path: str, doing: str) -> list[str]:
    """Return what can be done about conflicts in a file; `doing`: what git says of itself (`merge left`). After other
    commands than a merge git itself says how to go on, and how to go back."""
    command, _, names = doing.partition(" ")
    if command != "merge":
        return []
    instead = f"then `pico merge {names}` asks first whether the result can stand on the table"
    return [
        f"pico: {path}: edit what is between the markers, `git add`, `pico commit`",
        f"pico: or `git merge --abort` takes it back; {instead}",
    ]


def told(merged: Merged, path: str, labels: Labels) -> list[str]:
    """Return what to say of a merge: a line for each conflict, and for each group that both sides changed in part."""
    lines = [
        f"pico: {path}: {c.address}: {labels.base} {c.base} | {labels.ours} {c.ours} | {labels.theirs} {c.theirs}"
        for c in merged.conflicts
    ]
    lines += [
        f"pico: {path}: warning: {labels.ours} changed {', '.join(c.ours)} of {c.component}, {labels.theirs} "
        f"{', '.join(c.theirs)}: they belong together, check the result"
        for c in merged.coupled
    ]
    if not merged.clean and not merged.conflicts:
        lines.append(f"pico: {path}: merged line by line: not a valid manifest on all sides")
    return lines


def _labels(names: Sequence[str], size: int) -> Labels:
    """Return the labels; git before 2.44 leaves `%Y` as it is where a later one puts a name."""
    given = [name if name and not name.startswith("%") else "" for name in (*names, "", "", "")[:3]]
    return Labels(given[1] or "ours", given[0] or "base", given[2] or "theirs", size)


def main(arguments: Sequence[str]) -> int:
    """Merge, say what conflicts on standard error, and return the exit code; no error goes unanswered."""
    try:
        code, said = drive(arguments)
    except (PicoError, OSError, ValueError, RecursionError, MemoryError) as exc:
        code, said = FAILED, f"pico: {exc}; git merges line by line instead\n"
    sys.stderr.write(said)
    return code


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
