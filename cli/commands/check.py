"""`pico check`."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, TextIO

import typer

from pico.disk import write_whole, writing

from ..arguments import Fidelity
from ..session import Session
from ..terminal.output import write
from ..terminal.waiting import waiting
from ..views import check as view

HEADING = "History"
ORDER = 120

if TYPE_CHECKING:
    from pico.bench.checking import CheckReport

Base = Annotated[
    str | None,
    typer.Argument(
        metavar="BASE",
        help="What to compare with: the commit where HEAD left BASE; without it the branch that CI merges into, or the "
        "default branch.",
    ),
]
Merge = Annotated[
    str | None, typer.Option("--merge", metavar="REV", help="Check what a merge of REV into HEAD would be.")
]
Report = Annotated[Path | None, typer.Option("--report", metavar="FILE", help="Write a report in Markdown to FILE.")]
Markdown = Annotated[bool, typer.Option("--markdown", help="Print the report in Markdown.")]
JUnit = Annotated[Path | None, typer.Option("--junit", metavar="FILE", help="Write JUnit XML to FILE.")]
Pictures = Annotated[
    Path | None,
    typer.Option(
        "--pictures",
        metavar="DIR|none",
        help="Draw the table before and after into DIR; with --report into `pictures` beside it, unless `none`.",
    ),
]


def check(
    context: typer.Context,
    base: Base = None,
    merge: Merge = None,
    report: Report = None,
    markdown: Markdown = False,
    junit: JUnit = None,
    pictures: Pictures = None,
    fidelity: Fidelity = None,
) -> int:
    """Check a change as a pull request: valid, buildable, as expected.

    Reads the manifests and recipes as they are now, and tries the manifests in a simulated bench of its own: the bench,
    its journal and its lock are not touched. Above labs, each that differs from BASE is checked. Exits with 1 if
    manifests or recipes are not valid, 3 if the state is physically impossible, 6 if an expectation fails, 7 if policy
    denies it; the first that applies. `pico test` runs the recipes.

    Examples:
      pico check main
      pico check --report report.md --junit checks.xml
    """
    from pico.bench.checking import check
    from pico.recipes.reading import check_recipes

    session = Session.of(context)
    folder = _folder(session, report, pictures)
    with waiting("Checking"):
        found = check(
            session.folder, base, merging=merge, fidelity=fidelity or "kinematic", pictures=folder,
            recipes=check_recipes,
        )  # fmt: skip
    _write_files(session, found, report, junit)
    if markdown and not session.json:
        from ..views.check_markdown import report as in_markdown

        session.say(in_markdown(found).rstrip("\n"))
        if not sys.stdout.isatty():
            _show(session, found, sys.stderr)
    else:
        _show(session, found, sys.stdout)
    _tell_github(found)
    return int(found.exit_code)


def _folder(session: Session, report: Path | None, pictures: Path | None) -> Path | None:
    """Return where pictures go, None for no pictures."""
    if pictures is None:
        return (session.folder / report).parent / "pictures" if report else None
    return None if str(pictures) == "none" else session.folder / pictures


def _write_files(session: Session, found: CheckReport, report: Path | None, junit: Path | None) -> None:
    if report:
        from ..views.check_markdown import report as in_markdown

        path = session.folder / report
        _write(path, in_markdown(found, path.parent))
    if junit:
        from ..views.check_junit import junit as in_junit

        _write(session.folder / junit, in_junit(found))


def _write(path: Path, text: str) -> None:
    """Write a file anew; a link that a branch put in its place is not followed."""
    write_whole(path, text.encode(), folders=True)


def _show(session: Session, found: CheckReport, stream: TextIO) -> None:
    """Show what was found; `stream`: where people read the verdicts, findings go to standard error."""
    from ..views import diagnostics
    from ..views.check_annotations import harmless

    if session.json:
        session.document(view.data(found))
        return
    safe = harmless if os.environ.get("GITHUB_ACTIONS") else str
    write(stream, safe(view.text(found)))
    wrong = [d for lab in found.labs for d in lab.diagnostics]
    if wrong:
        write(sys.stderr, safe(diagnostics.text(wrong)))


def _tell_github(found: CheckReport) -> None:
    """Put the report on the page of the job, and the findings beside their lines, where GitHub runs this."""
    if os.environ.get("GITHUB_ACTIONS"):
        from ..views.check_annotations import beside

        if lines := beside(found):
            write(sys.stderr, lines)
    if summary := os.environ.get("GITHUB_STEP_SUMMARY"):
        from ..views.check_markdown import report as in_markdown

        with writing(Path(summary)), Path(summary).open("a", encoding="utf-8") as file:
            file.write(in_markdown(found))
