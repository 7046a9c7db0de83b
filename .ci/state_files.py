"""Print docs/reference/state-files.md from the registry of `pico/base/state_files.py`.

`.ci/state_files.py` writes the page; `.ci/state_files.py --check` says whether it is as the registry has it.
"""

from __future__ import annotations

from pathlib import Path

from pico.base.state_file import StateFile
from pico.base.state_files import ALL

PAGE = Path(__file__).resolve().parents[1] / "docs" / "reference" / "state-files.md"
_HEAD = """# State files

All that PICO keeps on disk beside your manifests and commits. This page is printed from the registry in
`pico/base/state_files.py` (`make docs`); do not edit it.

`pico doctor` checks all of these files. A file that is damaged is named with its path, the cause, what is lost with it
and the command that continues. Every JSON file carries the SHA-256 of its content (`{"sha256": "...", ...`), every
record of the journal a CRC-32; files from before that have none and are read as they are. A file is written whole or
not at all. If something else lies in its place (a folder, a named pipe, a link that leads nowhere), it is named with
the command that moves it away; nothing waits for it.

`pico laser disarm` shuts a laser by the Lab that the bench keeps (`lab.json`), also if `lab.yaml` cannot be read or
requires a newer PICO; if `lab.json` is damaged, by `lab.yaml`, else by `HEAD`. It needs no journal. It does need to
know which bench it is and that nobody else has it: `lock`, `enrolment.json`, `bench.json`. `pico recover` moves arms,
and goes by `lab.json` alone if the manifests are wrong.

What PICO cannot notice: an older copy of the whole folder `.pico` that is put back. Its journal, its counts and its
table agree with one another, and runs in commits may be of the same bench in another clone. What was done since that
copy is then unknown: look at the table before anything moves.

| kind | may it be deleted? | if it is damaged |
|---|---|---|
| cache | yes, at any time | PICO makes it anew without a word |
| process | yes, while no PICO runs | PICO makes it anew without a word |
| memory | yes; what it knew is found again by looking | PICO forgets it; `pico doctor` says so |
| record | no: what it holds is nowhere else | commands that need it stop and name it |
| safety | no | nothing moves until a person has decided; it is never read as empty |
"""
_GROUPS = (
    ("Of each bench",
     "Below `.pico/benches/BENCH/` of the worktree that has the bench (`sim`, `emulated`, `hardware`).",
     lambda file: file.pattern.startswith("benches/BENCH/")),
    ("Of a bench of a coordinator", "Below `.pico/benches/HOST/LAB/BENCH/` of each checkout, beside `called.json`, "
     "`mornings.json` and `recipes/` as above.", lambda file: file.pattern.startswith("benches/HOST/")),
    ("Of the lab", "Below `.pico/`.",
     lambda file: not file.pattern.startswith((".git/", "benches/BENCH/", "benches/HOST/"))),
    ("In Git's own folder", "Shared by all worktrees, in no commit and no clone.",
     lambda file: file.pattern.startswith(".git/")),
)  # fmt: skip


def page() -> str:
    """Return the page."""
    parts = [_HEAD]
    for title, where, belongs in _GROUPS:
        rows = "\n".join(_row(file) for file in ALL if belongs(file))
        parts.append(
            f"## {title}\n\n{where}\n\n| file | kind | holds | written by | format | lost if deleted | if damaged |\n"
            f"|---|---|---|---|---|---|---|\n{rows}\n"
        )
    return "\n".join(parts)


def _row(file: StateFile) -> str:
    name = file.pattern.removeprefix("benches/BENCH/").removeprefix("benches/HOST/LAB/BENCH/")
    kept = file.schema or (file.text if file.text else "JSON, version 1")
    remedy = file.remedy.format(path=name, aside=f"{name}.damaged", stem="LASER") if file.remedy else "nothing to do"
    cells = (f"`{name}`", file.kind, file.holds, file.writer, kept, file.lost or "nothing", remedy)
    return f"| {' | '.join(cells)} |"


if __name__ == "__main__":
    import sys

    from printing import printed

    sys.exit(printed(PAGE, page()))
