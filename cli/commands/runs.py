"""`pico runs`: what was done on the bench, as the commits carry it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from pico.diagnostics import PicoError, error, warning

from ..arguments import Fidelity, LockTimeout, Scoped, Yes, group, scope_of
from ..session import Session
from ..terminal.waiting import waiting
from ..views import compared, exported, figured, kept, plotted, published, replayed
from ..views import recorded as view
from ..views import runs as table
from ..views.style import listed

HEADING = "History"
ORDER = 90

if TYPE_CHECKING:
    from pico.bench.bench import Bench
    from pico.diagnostics import Diagnostic
    from pico.history.lab_history import LabHistory
    from pico.runs.document import RecordedRun
    from pico.runs.operations import OperationRun

app = group(
    help="List, show, compare, plot, export and replay runs of commits.",
    examples=(
        "pico runs",
        "pico runs list main..e1 -- p2",
        "pico runs show",
        "pico runs export e1 --out e1.zip",
        "pico runs plot",
    ),
    alone=True,
)
Run = Annotated[
    str | None, typer.Argument(metavar="RUN", help="The beginning or the end of its id; without it the last run.")
]


@app.callback()
def main(context: typer.Context) -> None:
    if context.invoked_subcommand is None:
        list_(context)


@app.command("list", cls=Scoped)
def list_(
    context: typer.Context,
    revision: Annotated[
        str | None, typer.Argument(metavar="REV|A..B", help="Of the history of this; without it of HEAD.")
    ] = None,
    every: Annotated[bool, typer.Option("--all", help="Of all branches and tags.")] = False,
    others: Annotated[bool, typer.Option("--others", help="What others began at the bench as well.")] = False,
    number: Annotated[int | None, typer.Option("-n", "--number", metavar="N", min=1, help="At most N runs.")] = None,
) -> None:
    """List runs, the newest first; `pico runs` alone does the same.

    What led where, how it ended, and which commit carries it; those that no commit has yet, too: the next `pico
    commit` takes them. With names after `--` only what changed these components or tunables.

    Examples:
      pico runs list -n 3
      pico runs list main..e1 -- p2
    """
    session = Session.of(context)
    wrong: list[Diagnostic] = []
    history = _history(session)
    found = history.runs(revision, every=every, components=scope_of(context), diagnostics=wrong)
    session.show(table, found, wrong, history.runs_of_others(wrong) if others else None, most=number)
    session.tell(wrong)


@app.command()
def show(
    context: typer.Context,
    run: Run = None,
    frames: Annotated[
        bool, typer.Option("--frames", help="What moved when instead, to be drawn moment by moment.")
    ] = False,
) -> None:
    """Show a run: its operations, what it changed, what proves it.

    Examples:
      pico runs show
      pico --json runs show 20260101 --frames
    """
    session = Session.of(context)
    found, commit = _history(session).recorded_run(run)
    if frames:
        _frames(session, session.bench(), found)
    else:
        session.show(view, found, commit)
    session.tell(found.diagnostics)


def _history(session: Session) -> LabHistory:
    """Return the history with what the bench knows; what commits carry is there also where that is out of reach."""
    from pico.edge.protocol import Cut

    try:
        return session.bench().history
    except Cut:
        return session.history()


def _frames(session: Session, bench: Bench, found: RecordedRun) -> None:
    """Show what moved in a run."""
    from pico.bench.picturing.frames import frames_of_run

    from ..views import framed

    with waiting("Finding the ways of the arms"):
        made, told = frames_of_run(bench.setup, found)
    session.show(framed, made)
    session.tell(told)


@app.command()
def attach(
    context: typer.Context,
    run: Annotated[
        str | None,
        typer.Argument(metavar="RUN", help="The beginning or end of its id; without it the one that goes on."),
    ] = None,
) -> int:
    """Follow a run that the bench has under way, whoever began it, or a recipe that goes on by itself.

    What a recipe committed beside a coordinator comes as the branch `detached/RUN`; its runs go into the next commit.

    From its first event to its report, with the exit code of that. Ctrl-C lets go of it: it goes on, and `pico stop`
    ends it. With --json: each event and the report, a line each.

    Examples:
      pico runs attach
      pico runs attach 7b7b54 --bench shel/bench1
    """
    from ..runs import detached as beside
    from ..runs.leaving import follow, left
    from ..runs.running import Screen
    from ..views import report as report_view
    from ..views.run import Progress

    session = Session.of(context)
    bench = session.bench()
    if (path := left(bench, run)) is not None:
        try:
            return follow(session, path)
        except KeyboardInterrupt:
            session.say(f"\nRun {path.stem} goes on: `pico runs attach` follows it again.")
            raise
    if (sent := beside.detached(bench, run)) is not None:
        try:
            return beside.follow(session, bench, sent)
        except KeyboardInterrupt:
            session.say(f"\nRun {sent.run} goes on: `pico runs attach` follows it again.")
            raise
    going = bench.moves.follow(run)
    screen = Screen(session, Progress(going.plan))
    try:
        for event in going:
            screen.show(event)
    except KeyboardInterrupt:
        screen.clear()
        session.say(f"Run {going.id} goes on: `pico stop` ends it, `pico runs attach` follows it again.")
        raise
    session.show(report_view, going.report)
    session.tell(going.report.diagnostics)
    return int(going.report.exit_code)


@app.command()
def compare(
    context: typer.Context,
    a: Annotated[str, typer.Argument(metavar="A", help="The beginning of a run's id.")],
    b: Annotated[str, typer.Argument(metavar="B", help="The beginning of another's.")],
) -> None:
    """Compare two runs: where each ended, how long, what was otherwise.

    Examples:
      pico runs compare 20260101 20260102
    """
    session = Session.of(context)
    session.show(compared, session.bench().history.compare_runs(a, b))


@app.command()
def export(
    context: typer.Context,
    revision: Annotated[str, typer.Argument(metavar="REV", help="A commit, branch or tag.")] = "HEAD",
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="DIR|FILE.zip", help="A new folder or zip file; without it LAB-COMMIT.zip."),
    ] = None,
    run: Annotated[
        list[str] | None,
        typer.Option(
            "--run", metavar="RUN", help="This run of REV instead of those that led to it; may be given again."
        ),
    ] = None,
    pictures: Annotated[
        Literal["all", "none"], typer.Option("--pictures", metavar="all|none", help="With pictures of the table?")
    ] = "all",
    form: Annotated[
        Literal["crate", "csv", "documents"],
        typer.Option("--as", metavar="crate|csv|documents", help="Measurements of runs, or event-model documents."),
    ] = "crate",
    recipe: Annotated[
        str | None,
        typer.Option(
            "--recipe", metavar="NAME|ID", help="All runs of the last run of this recipe, for csv or documents."
        ),
    ] = None,
) -> None:
    """Write a revision with its runs and pictures as an RO-Crate.

    Runs, measurements, plan and pictures of the table, to publish. The same commit gives the same bytes. Refused where
    an artifact of a run is not here. `--as csv` writes what runs measured (`--run`, or all of `--recipe`, or the last),
    a row each; `--as documents` the runs in the documents of bluesky's event model, a line each; without `--out`, or
    with `--out -`, to the terminal.

    Examples:
      pico runs export e1 --out e1.zip
      pico runs export --as csv --run 20260101 --out scan.csv
      pico runs export --as csv --recipe tilt_scan --out scan.csv
    """
    if form != "crate":
        if revision != "HEAD" or (run and recipe):
            hint = f"`--as {form} --run RUN`, `--as {form} --recipe NAME`, or of the last run"
            raise PicoError(error("usage", f"--as {form} writes runs, or those of a recipe", hint=hint))
        _export_runs(Session.of(context), form, run or [], recipe, out)
        return
    if recipe is not None:
        raise PicoError(error("usage", "a crate has a revision's runs", hint="`--as csv --recipe NAME`"))
    if str(out) == "-":
        raise PicoError(error("usage", "a crate is not written to the terminal", hint="name a folder or a file.zip"))
    from pico.bench.publishing import publish
    from pico.history.lab.folder import LabFolder
    from pico.manifest.load import find_lab

    session = Session.of(context)
    root = find_lab(session.folder)
    folder = LabFolder(root, place=session.place(root))
    with waiting("Publishing"):
        path = session.folder / out if out else None
        made = publish(folder, revision, path, runs=run or (), pictures=pictures == "all", beside=session.folder)
    session.show(published, made)
    session.tell(made.diagnostics)


def _export_runs(
    session: Session, form: Literal["csv", "documents"], names: list[str], recipe: str | None, out: Path | None
) -> None:
    """Write runs, or print them; those of a run of a recipe in the order in which it began them."""
    import json

    from pico.disk import write_whole
    from pico.recipes.recipes import Recipes
    from pico.runs.event_model import documents, units_of
    from pico.runs.table import as_csv, rows_of

    bench = session.bench()
    if recipe is not None:
        names = Recipes(bench).ran(recipe)[1].runs
    wanted: list[str | None] = [*names] or [None]
    found = [bench.history.recorded_run(name)[0] for name in wanted]
    table = rows_of([(run.document.id, run.trace) for run in found])
    if form == "csv":
        text = as_csv(table)
    else:
        units = units_of(bench.setup)
        text = "".join(f"{json.dumps(pair)}\n" for run in found for pair in documents(run, units))
    ids = [run.document.id for run in found]
    if out is None or str(out) == "-":
        if not session.json:
            session.say(text.removesuffix("\n"))
        for line in text.splitlines() if session.json and form == "documents" else ():
            session.document(json.loads(line))
        if session.json and form == "csv":
            session.document(exported.rows(ids, [row.flat for row in table]))
    else:
        write_whole(session.folder / out, text.encode())
        session.show(exported, ids, form, out)
    if form == "csv" and not table:
        hint = "`pico runs list` shows them; `--recipe NAME` takes all runs of a recipe"
        session.tell([warning("nothing-measured", f"nothing was measured in {listed(ids)}", hint=hint)])


@app.command()
def plot(
    context: typer.Context,
    run: Run = None,
    x: Annotated[
        str | None, typer.Option("--x", metavar="COLUMN", help="Without it the first that the run changed meanwhile.")
    ] = None,
    y: Annotated[
        str | None, typer.Option("--y", metavar="COLUMN", help="Without it the first number that was measured.")
    ] = None,
    picture: Annotated[Path | None, typer.Option("--picture", metavar="PNG", help="Write it as a picture.")] = None,
    recipe: Annotated[bool, typer.Option("--recipe", help="Of a recipe: RUN is its id or the recipe's name.")] = False,
    pictures: Annotated[
        Path | None, typer.Option("--pictures", metavar="DIR", help="Write commits, trace and figures of a recipe.")
    ] = None,
) -> None:
    """Plot what a run measured, against what it changed.

    Columns are those of `pico runs export --as csv`: `t`, `p1.angle`, `cam.centroid.x`. Bars are one standard
    deviation. `--recipe` plots the figures that a recipe declares of what it returned.

    Examples:
      pico runs plot
      pico runs plot 20260101 --x p1.angle --y cam.centroid.x --picture scan.png
      pico runs plot --recipe shel --pictures figures
    """
    if recipe or pictures:
        if x or y or picture:
            raise PicoError(error("usage", "--recipe plots what the recipe declares", hint="with --pictures DIR"))
        _plot_recipe(Session.of(context), run, pictures)
        return
    from pico.bench.picturing.plots import points_of
    from pico.drawing.picture import write_png
    from pico.drawing.plots import scatter

    session = Session.of(context)
    bench = session.bench()
    found, _ = bench.history.recorded_run(run)
    points = points_of(bench.setup, found, x, y)
    title = f"{found.document.goal}, {found.document.id}"
    session.show(plotted, title, points)
    session.draw(picture, points.y_name, lambda path: write_png(scatter.picture(title, points), path))


def _plot_recipe(session: Session, word: str | None, folder: Path | None) -> None:
    """Plot the figures of a run of a recipe."""
    from pico.drawing.picture import write_png
    from pico.recipes.figures.pictures import curves_of
    from pico.recipes.figures.pictures import pictures as drawn
    from pico.recipes.figures.retold import require_returned, retold
    from pico.recipes.recipes import Recipes

    bench = session.bench()
    recipe, log = Recipes(bench).ran(word)
    found, about = retold(recipe, log), log.about
    if folder is not None:
        for name, draw in drawn(bench, recipe, about, found):
            (session.folder / folder).mkdir(parents=True, exist_ok=True)
            session.draw(folder / f"{name}.png", name, lambda path, d=draw: write_png(d(), path))  # type: ignore[misc]
    returns = require_returned(found, recipe.name, about.id) if recipe.figures else {}
    figures = [(figure, curves_of(figure, returns, about.id)) for figure in recipe.figures.values()]
    session.show(figured, recipe, about, figures)


@app.command()
def pictures(
    context: typer.Context,
    run: Run = None,
    of: Annotated[
        list[str] | None,
        typer.Option("--of", metavar="OPERATION", help="Of this alone, or by the SHA-256 of it; may be given again."),
    ] = None,
    width: Annotated[
        int, typer.Option("--width", metavar="PIXELS", min=16, max=2048, help="Of a picture in JSON, at most.")
    ] = 640,
    out: Annotated[Path | None, typer.Option("--out", metavar="DIR", help="Write each as PNG, pixel by pixel.")] = None,
) -> int:
    """Show what cameras saw in a run, and how its searches went.

    Lists them, or draws them into a folder. With --json each as data, a line each: pictures of cameras (small, with
    the numbers of their kernels and marks), spectra, and each measurement of a search with the best so far.

    Examples:
      pico runs pictures
      pico runs pictures 20260101 --out pictures
      pico --json runs pictures 20260101 --of op1 --width 160
    """
    from pico.bench.picturing import kept as keeping
    from pico.diagnostics import ExitCode
    from pico.drawing.picture import write_png

    session = Session.of(context)
    history = _history(session)
    found = keeping.kept(history.recorded_run(run)[0], of or ())
    keeping.fetched(history.folder, found)
    if out is None and not session.json:
        session.say(kept.text(found, keeping.absent(history.folder, found)))
        return ExitCode.DONE
    wrong: list[Diagnostic] = []
    for one in found:
        try:
            drawn = keeping.drawn(history.folder, one)
            if session.json:
                session.document(keeping.document(one, drawn, width))
            if out is not None:
                (session.folder / out).mkdir(parents=True, exist_ok=True)
                session.draw(out / f"{one.name}.png", one.title, lambda path, d=drawn: write_png(d.picture(), path))  # type: ignore[misc]
        except PicoError as exc:
            wrong += exc.diagnostics
    session.report(wrong)
    return ExitCode.ERROR if wrong else ExitCode.DONE


@app.command()
def replay(
    context: typer.Context, run: Run = None, auto_approve: Yes = False, fidelity: Fidelity = None,
    lock_timeout: LockTimeout = None,
) -> int:  # fmt: skip
    """Do again what a run did, on the bench as it is now, as one run.

    Each operation is planned and checked anew; numbers are set beside those of then. What only a search or a person
    did is refused before anything moves.

    Examples:
      pico runs replay 20260101
    """
    from pico.diagnostics import ExitCode
    from pico.scripting.replaying import replay as again
    from pico.scripting.replaying import steps

    session = Session.of(context)
    session.require_answer(auto_approve)
    bench = session.bench(fidelity, writing=True)
    found, _ = bench.history.recorded_run(run)
    planned = steps(found)
    session.say(replayed.head(found.document.id, planned))
    if not session.confirm("Do it again?", auto_approve):
        session.say("Nothing moved.")
        return ExitCode.ERROR

    def say(op: OperationRun) -> None:
        if not session.json:
            session.say(replayed.step(op))

    made = again(bench, found, say)
    session.show(replayed, made)
    return int(made.report.exit_code)
