"""`pico calibrate`."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from pico.backends.devices import SIMULATOR
from pico.diagnostics import ExitCode, PicoError, did_you_mean, error
from pico.disk import write_whole
from pico.model.calibration.steps import STEPS, CalibrationStep

from .. import arguments
from ..arguments import LockTimeout, Yes, group
from ..runs.calibrating import Person
from ..session import Session
from ..terminal.waiting import waiting
from ..views import calibration as view
from ..views import calibration_steps as standing_view
from ..views import lesson
from ..views import markers as sheets

if TYPE_CHECKING:
    from pico.bench.bench import Bench
    from pico.vision.charuco import Board

HEADING = "The simulator, and the rest"
ORDER = 80

_OF_STEPS = ("--list", "--hands", "--shots", "--board", "--square", "--marker", "--yes", "-y", "--auto-approve")


class Group(arguments.Group):
    """Commands of `pico calibrate`; a step, or an option of `steps`, in the place of a command means `steps`."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Parse the words after `pico calibrate`."""
        first = args[0] if args else ""
        if first in STEPS or first.partition("=")[0] in _OF_STEPS:
            args = ["steps", *args]
        return super().parse_args(ctx, args)


app = group(
    help="Calibrate cameras, mounts, detectors and arms; print the markers.",
    examples=("pico calibrate", "pico --backend hardware calibrate --list", "pico calibrate markers --paper letter"),
    alone=True,
)
app.info.cls = Group


Steps = Annotated[list[str] | None, typer.Argument(metavar="[STEP]...", help="Steps of `--list`; else all to do.")]
Listed = Annotated[bool, typer.Option("--list", help="Show how each step stands, and do nothing.")]
AtTable = Annotated[
    Literal["person", "simulated"],
    typer.Option("--hands", metavar="person|simulated", help="Who is at the table; `simulated` with --emulate alone."),
]
Shots = Annotated[int, typer.Option("--shots", metavar="N", min=6, max=200, help="Pictures of the board.")]
Squares = Annotated[
    str | None, typer.Option("--board", metavar="COLUMNSxROWS", help="Squares of another board than PICO's (7x5).")
]
Square = Annotated[float | None, typer.Option("--square", metavar="MM", help="Edge of its squares as measured.")]
Marker = Annotated[float | None, typer.Option("--marker", metavar="MM", help="Edge of its markers as measured.")]


@app.callback()
def main(context: typer.Context) -> None:
    if context.invoked_subcommand is None:
        steps(context)


@app.command()
def steps(
    context: typer.Context, step: Steps = None, listed: Listed = False, hands: AtTable = "person",
    shots: Shots = 20, board: Squares = None, square: Square = None, marker: Marker = None, auto_approve: Yes = False,
    lock_timeout: LockTimeout = None,
) -> int:  # fmt: skip
    """Calibrate a bench with devices step by step, with a person at its table.

    Lenses and places of the cameras over the table, direction and zero of mounts that turn, dark levels of detectors,
    arms and the cameras in their hands.
    Each step says what to do, shows how far it is, and writes a picture. What it finds goes into calibration/BENCH.json
    with how it was found; call it again to go on after a stop. `steps` may be left out before a STEP. In the
    simulator all is found at once, see `pico calibrate cameras`. Exit code 2: steps are left.

    Examples:
      pico calibrate steps --list --backend hardware
      pico --backend hardware calibrate intrinsics --square 36.1 --marker 27.1
      pico --emulate calibrate --hands simulated
    """
    session = Session.of(context)
    chosen = _known(step or ())
    bench = session.bench(writing=not listed)
    if bench.backend_name == SIMULATOR:
        if chosen or listed:
            text = "the simulator finds its cameras and arms at once, and has no steps"
            raise PicoError(error("usage", text, hint="`pico --backend hardware calibrate --list`"))
        _in_simulator(session, bench)
        return ExitCode.DONE
    from pico.bench.calibrating.walk import CalibrationWalk

    person = Person(session, auto_approve, bench.backend_name)
    shown = _board(board, square, marker)
    walk = CalibrationWalk(bench, person, None if hands == "simulated" else person, board=shown, shots=shots)
    if not listed:
        for done in walk.walk(chosen or walk.todo()):
            session.say("\n".join(f"  {line}" for line in done.lines))
    rows = walk.standing()
    session.show(standing_view, rows, bench=bench.backend_name, file=walk.file, pictures=walk.pictures)
    return ExitCode.DONE if listed or not any(row.why for row in rows) else ExitCode.CHANGES


def _known(words: Sequence[str]) -> tuple[CalibrationStep, ...]:
    wrong = [word for word in words if word not in STEPS]
    if wrong:
        hint = did_you_mean(wrong[0][:40], STEPS) or f"steps: {', '.join(STEPS)}"
        raise PicoError(error("usage", f"there is no step `{wrong[0][:40]}`", hint=hint))
    return tuple(name for name in STEPS if name in words)


def _board(squares: str | None, square: float | None, marker: float | None) -> Board:
    """Return the board that is shown; raises PicoError for one that can't be."""
    from pico.vision.charuco import BOARD

    columns, rows = BOARD.columns, BOARD.rows
    if squares is not None:
        found = re.fullmatch(r"([1-9][0-9]?)[xX]([1-9][0-9]?)", squares)
        if found is None:
            raise PicoError(error("usage", f"--board is {squares[:20]!r}", hint="columns and rows: `--board 7x5`"))
        columns, rows = int(found[1]), int(found[2])
    made = replace(BOARD, columns=columns, rows=rows, square=square or BOARD.square, marker=marker or BOARD.marker)
    if min(columns, rows) < 3 or not 0 < made.marker < made.square <= 500:
        text = f"no board has {columns}x{rows} squares of {made.square:g} mm with markers of {made.marker:g} mm"
        hint = "3 squares or more each way, markers smaller than squares, squares up to 500 mm"
        raise PicoError(error("usage", text, hint=hint))
    return made


@app.command()
def lens(
    context: typer.Context,
    camera: Annotated[str, typer.Argument(metavar="CAMERA", help="A camera over the table.")],
    file: Annotated[Path, typer.Argument(metavar="FILE", help="Its lens, as ROS or OpenCV wrote it.")],
    lock_timeout: LockTimeout = None,
) -> None:
    """Take the lens of a camera from a file, instead of the step `intrinsics`.

    A `camera_info` of ROS, or `camera_matrix` and `distortion_coefficients` of OpenCV in YAML or JSON, with 4, 5 or 8
    coefficients, or 4 of a fisheye lens (`distortion_model: fisheye`). It counts with 1 px for focal lengths and
    principal point. Then the step `extrinsics` finds where the camera stands.

    Examples:
      pico calibrate lens left left_info.yaml --backend hardware
    """
    from pico.bench.calibrating.walk import CalibrationWalk

    session = Session.of(context)
    bench = session.bench(writing=True)
    person = Person(session, False, bench.backend_name)
    said = CalibrationWalk(bench, person, person).take_lens(camera, session.folder / file)
    if session.json:
        session.document({"schema": "pico.lens/v1", "camera": camera, "file": str(file)})
    else:
        session.say(f"{said}\n`pico calibrate steps extrinsics` finds where it stands.")


@app.command()
def cameras(context: typer.Context) -> None:
    """Find out in the simulator where the cameras are, how their lenses draw and how the arms are built.

    From pictures of the datums and of the calibration board, held up by a person and by the arms, and from the arms'
    encoders; takes about half a minute. Writes calibration/sim.json in the lab's folder. Nothing on the table moves.
    `pico calibrate` alone is the same there.
    """
    session = Session.of(context)
    _in_simulator(session, session.bench(writing=True))


def _in_simulator(session: Session, bench: Bench) -> None:
    session.say("Taking pictures of the calibration board (about half a minute) ...")
    session.show(view, bench.cameras.calibrate(), shown="calibration/sim.json")


@app.command()
def twin(
    context: typer.Context,
    runs: Annotated[
        list[str] | None,
        typer.Argument(metavar="RUN|A..B...", help="Ids of runs, or those of a range; without any the bench's own."),
    ] = None,
    since: Annotated[
        str | None, typer.Option("--since", metavar="DAY", help="Only from runs begun then or later (UTC).")
    ] = None,
    dry_run: Annotated[bool, typer.Option("--dry-run", help="Show it, and write nothing.")] = False,
) -> None:
    """Let the twin learn from recorded runs how the bench errs.

    How parts come to stand that are put down, by type; how long operations take; how what cameras see scatters. Told
    beside each other: what the twin said before, what was measured, what it says now. Writes twin.json into the lab's
    folder: the simulator reads it, plans do not. Without RUN all runs on hardware, or, where there are none, with
    emulated devices.

    Examples:
      pico calibrate twin --since 2026-11-01
      pico calibrate twin e1..e2 --dry-run
    """
    from pico.twin.learned import FILE

    session = Session.of(context)
    bench = session.bench(writing=not dry_run)
    with waiting("Learning"):
        found = bench.twin.learn(*(runs or ()), since=since, write=not dry_run)
    session.show(lesson, found, shown=FILE)
    session.tell(found.diagnostics)


@app.command()
def markers(
    context: typer.Context,
    out: Annotated[Path, typer.Option("--out", metavar="PDF", help="Where the sheets go.")] = Path("markers.pdf"),
    paper: Annotated[
        Literal["a4", "letter"], typer.Option("--paper", metavar="a4|letter", help="What they are printed on.")
    ] = "a4",
) -> None:
    """Write the markers of the lab as a PDF, to print and stick on.

    Parts, datums, and the board that `pico calibrate` needs. Print at 100 %.

    Examples:
      pico calibrate markers --paper letter
    """
    from pico.vision.sheets import labels, marker_sheets

    session = Session.of(context)
    setup = session.bench().setup
    path = session.folder / out
    write_whole(path, marker_sheets(setup, paper))
    session.show(sheets, path, shown=out, labels=labels(setup), paper=paper)
