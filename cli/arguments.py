"""Arguments and options that several commands take."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

Component = Annotated[str, typer.Argument(metavar="COMPONENT", help="A component of the inventory.")]
Revision = Annotated[
    str | None,
    typer.Argument(metavar="REV", help="A commit, branch or tag; without it the manifest."),
]
PlanOrRevision = Annotated[
    str | None,
    typer.Argument(metavar="PLANFILE|REV", help="A saved plan or a revision; ./NAME is a file."),
]
Fidelity = Annotated[
    str | None, typer.Option("--fidelity", metavar="kinematic|physics", help="How the simulator moves things.")
]
Yes = Annotated[bool, typer.Option("--auto-approve", help="Do not ask.")]
Exact = Annotated[bool, typer.Option("--exact", help="Move for differences below the tolerance, too.")]
DetailedExit = Annotated[bool, typer.Option("--detailed-exitcode", help="Exit with 2 where something would move.")]
Out = Annotated[Path | None, typer.Option("--out", metavar="FILE", help="Write to FILE.")]
Targets = Annotated[
    list[str] | None,
    typer.Option(
        "--target",
        metavar="NAME",
        help="Plan for this component only; may be given again. The plan names what must move with it, and what stays "
        "different.",
    ),
]
Exclude = Annotated[
    list[str] | None,
    typer.Option(
        "--exclude",
        metavar="NAME",
        help="Leave this component alone; may be given again. The plan names what can't be done without it.",
    ),
]
Prefer = Annotated[
    str,
    typer.Option("--prefer", metavar="fewest-moves|shortest-time", help="What counts first in the choice of a plan."),
]
Mainline = Annotated[
    int | None,
    typer.Option("--mainline", metavar="N", help="Of a merge: the side, from 1, that counts as what was before."),
]
NoCommit = Annotated[bool, typer.Option("--no-commit", help="Write the manifests, and leave the commit to you.")]
Speed = Annotated[float | None, typer.Option("--speed", metavar="SHARE", help="Share of the joint limits, up to 1.")]
DryRun = Annotated[bool, typer.Option("--dry-run", help="Show the plan of it and move nothing.")]
Pairs = Annotated[list[str] | None, typer.Argument(metavar="KEY=VALUE...", help="Arguments.")]
