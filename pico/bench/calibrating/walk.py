"""A calibration from its first step to the file of the lab: what is to be done, what is kept, what is refused."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from pico.backends.devices import EMULATED
from pico.backends.emulated.hands import SimulatedHands
from pico.backends.emulated.world import EmulatedWorld
from pico.backends.hardware.device import HardwareDevice
from pico.base.state_files import CALIBRATION_PICTURES
from pico.bench.bench import Bench
from pico.bench.calibrating.arms import arm_of
from pico.bench.calibrating.at_table import SHOTS, Asking, AtTable, Hands
from pico.bench.calibrating.axes import axis
from pico.bench.calibrating.board import intrinsics
from pico.bench.calibrating.dark import dark
from pico.bench.calibrating.hands import hand_of
from pico.bench.calibrating.progress import read_progress
from pico.bench.calibrating.subjects import standing_of
from pico.bench.calibrating.table import FoundCameras, extrinsics, names_of
from pico.bench.lasers import person_of
from pico.cameras.lens_files import read_lens
from pico.diagnostics import ExitCode, PicoError, did_you_mean, error
from pico.edge.local import LocalEdge
from pico.model.calibration.results import ACCEPTED, Provenance
from pico.model.calibration.steps import BEFORE, STEPS, CalibrationStep, StepStanding, refusal
from pico.model.record import record
from pico.vision.calibration import Accuracy, Calibration
from pico.vision.calibration_files import calibration_file, results_of, stored_calibration, write_calibration
from pico.vision.camera import CameraModel
from pico.vision.charuco import BOARD, Board
from pico.vision.nominal import camera_models

CODE = "calibration"
IMPORT = "imported/1"
"""The procedure of a lens that was calibrated elsewhere."""
IMPORTED = {"f": 1.0, "c": 1.0, "k": 1e-3, "p": 1e-4}
"""One standard deviation of the numbers of such a lens, see `pico.bench.calibrating.table.LOOSE`."""
KEPT = "kept; `extrinsics` writes it into the file"
"""Why a lens that was found is still to be done."""
LEAST_POSITION = 0.02
"""No position on the table counts as known better than this [mm]."""


@record
class Done:
    """A step that was done now, with one line for each of its subjects."""

    step: CalibrationStep
    lines: tuple[str, ...]


class CalibrationWalk:
    """The calibration of one bench with devices. Raises PicoError for a bench that has none, or is served elsewhere."""

    def __init__(
        self, bench: Bench, asks: Asking, hands: Hands | None, *, board: Board = BOARD, shots: int = SHOTS
    ) -> None:
        """`hands`: who is at the table; None for a simulated person at the emulated one."""
        edge = bench.edge
        if not isinstance(edge, LocalEdge):
            text = "the bench is served by another process, and a calibration asks its instruments itself"
            hint = "beside the table, in the lab's folder there, once `pico edge` has been ended"
            raise PicoError(error(CODE, text, hint=hint), ExitCode.LOCKED)
        if not isinstance(edge.device, HardwareDevice) or edge.device.bench not in ACCEPTED:
            text = "this bench has no devices to be calibrated"
            raise PicoError(error(CODE, text, hint="`--backend hardware`; with `--emulate` to try it"))
        self.bench, self.asks, self.edge, self.device = bench, asks, edge, edge.device
        self._hands, self._board, self._shots = hands, board, shots

    @property
    def file(self) -> Path:
        """The file that holds the calibration."""
        return calibration_file(self.device.place.root, self.device.bench)

    @property
    def pictures(self) -> Path:
        """The folder of the pictures of the steps."""
        return self.device.place.folder / CALIBRATION_PICTURES.pattern.split("/")[-2]

    def standing(self) -> tuple[StepStanding, ...]:
        """Return how each step stands, by the serial numbers of devices that answered so far."""
        return tuple(self._waiting(row) for row in standing_of(self.device, self.edge.now()))

    def _waiting(self, row: StepStanding) -> StepStanding:
        """A step with what was found and is not in the file yet: a lens that waits for `extrinsics`."""
        lens = read_progress(self.device.place).provenance.get(f"intrinsics/{row.subject}")
        before = row.how.at if row.how else ""
        if lens is None or row.step not in ("intrinsics", "extrinsics") or lens.at <= before:
            return row
        if row.step == "intrinsics":
            return replace(row, why=KEPT)
        return replace(row, why=row.why or "the lens was found anew since")

    def todo(self) -> tuple[CalibrationStep, ...]:
        """Return the steps that are still to be done, or again; asks the devices who they are."""
        self.bench.wait(self.device.links.instruments())
        left = {row.step for row in self.standing() if row.why and row.why != KEPT}
        return tuple(step for step in STEPS if step in left)

    def walk(self, steps: Sequence[CalibrationStep]) -> Iterator[Done]:
        """Do steps, write what each finds into the lab's folder, and yield it. Raises PicoError for what can't be done;
        what was found before is kept."""
        self.bench.wait(self.device.links.instruments())
        self._drop_refused()
        at = self._at()
        for step in steps:
            names = tuple(row.subject for row in standing_of(self.device, self.edge.now()) if row.step == step)
            if names:
                self.asks.say(f"{step}: {STEPS[step]}")
                self._require_before(step, at)
                yield Done(step=step, lines=self._done(step, names, at))

    def take_lens(self, name: str, path: Path) -> str:
        """Take the lens of a camera from a file that was made elsewhere, until `extrinsics` places the camera.

        Return it in words; raises PicoError.
        """
        over = {n: c for n, c in camera_models(self.device.setup).items() if c.robot is None}
        if name not in over:
            hint = did_you_mean(name[:40], over) or f"cameras over the table: {', '.join(over)}"
            raise PicoError(error("unknown-camera", f"no camera over the table is called `{name[:40]}`", hint=hint))
        self.bench.wait(self.device.links.instruments())
        self._drop_refused()
        at, camera = self._at(), read_lens(path, over[name])
        loose = {key: IMPORTED[key[:1]] for key in names_of(camera)}
        how = replace(
            at.provenance(f"{IMPORT}: {path.name}", at.devices_of(name), residual=0.0, held_out=None, unit="px",
                          uncertainty=loose), residual=None,
        )  # fmt: skip
        at.keep(replace(
            at.progress, shots=(), lenses={**at.progress.lenses, name: camera},
            provenance={**at.progress.provenance, f"intrinsics/{name}": how},
        ))  # fmt: skip
        kind = "fisheye" if camera.fisheye else f"{len(camera.distortion)} coefficients"
        return f"{name}: focal length {camera.matrix[0, 0]:.2f} px, {kind}, from {path.name}"

    def _at(self) -> AtTable:
        hands: Hands | None = self._hands
        if hands is None:
            world = self.device.links.world
            if self.device.bench != EMULATED or not isinstance(world, EmulatedWorld):
                text = "only the emulated bench has a simulated person"
                raise PicoError(error("usage", text, hint="leave `--hands simulated` out: a person is asked"))
            hands = SimulatedHands(world, self.device.setup.lab.sim.seed)
        return AtTable(
            edge=self.edge, device=self.device, asks=self.asks, hands=hands, wait=self.bench.wait,
            progress=read_progress(self.device.place), pictures=self.pictures,
            by=person_of(self.bench) or "nobody named", board=self._board, shots=self._shots,
        )  # fmt: skip

    def _require_before(self, step: CalibrationStep, at: AtTable) -> None:
        before = BEFORE.get(step)
        if before is None:
            return
        rows = [row for row in standing_of(self.device, self.edge.now()) if row.step == before]
        left = [row.subject for row in rows if row.why and f"{row.step}/{row.subject}" not in at.progress.provenance]
        if left:
            text = f"{step} comes after {before}, which is not done for {', '.join(left)}"
            raise PicoError(error(CODE, text, hint=f"`pico calibrate steps {before} {step}`"))

    def _done(self, step: CalibrationStep, names: tuple[str, ...], at: AtTable) -> tuple[str, ...]:
        if step == "intrinsics":
            return intrinsics(at, names)
        if step == "extrinsics":
            found = extrinsics(at, names, self._lenses(at))
            self._keep(_with_cameras(self._known(), found))
            at.keep(replace(at.progress, postures={}))  # where an arm showed the board is told by other cameras now
            return found.lines
        lines = []
        for name in names:
            known = self._known()
            if step == "axes":
                zero, how, line = axis(at, name)
                known = replace(known, axes={**known.axes, name: zero})
            elif step == "arms":
                arm, how, line = arm_of(at, name, known)
                known = self._without_hands(replace(known, arms={**known.arms, name: arm}), name)
            elif step == "hands":
                camera = self.device.setup.lab.cameras[name]
                eye, how, line = hand_of(at, name, known.cameras, known.arms[camera.robot or ""])
                known = replace(
                    known, cameras={**known.cameras, name: eye.camera},
                    residuals={**known.residuals, name: round(eye.residual, 4)},
                )  # fmt: skip
            else:
                level, how, line = dark(at, name)
                known = replace(known, dark={**known.dark, name: level})
            self._keep(replace(known, provenance={**known.provenance, f"{step}/{name}": how}))
            lines.append(line)
        return tuple(lines)

    def _without_hands(self, known: Calibration, robot: str) -> Calibration:
        """Leave out where the cameras in the hand of a robot are: that was told by the arm as it was known before."""
        hands = [name for name, camera in known.cameras.items() if camera.robot == robot]
        for name in hands:
            self.asks.say(f"hands/{name} is left out of {self.file.name}: {robot} was calibrated anew.")
        return without(known, {f"hands/{name}": "" for name in hands})

    def _lenses(self, at: AtTable) -> dict[str, tuple[CameraModel, Provenance]]:
        """The cameras whose lens is known, with how it was found: what was found last counts."""
        known = self._known()
        found = {n: (c, known.provenance[f"intrinsics/{n}"]) for n, c in known.cameras.items()
                 if f"intrinsics/{n}" in known.provenance}  # fmt: skip
        for name, camera in at.progress.lenses.items():
            how = at.progress.provenance[f"intrinsics/{name}"]
            if name not in found or how.at >= found[name][1].at:
                found[name] = camera, how
        return found

    def _known(self) -> Calibration:
        return stored_calibration(self.device.place.root, self.device.bench) or Calibration({})

    def _keep(self, calibration: Calibration) -> None:
        made = replace(calibration, made_at=self.edge.now())
        write_calibration(self.device.place.root, self.device.bench, made)

    def _drop_refused(self) -> None:
        """Take out of the calibration what the bench refuses: of other evidence, and of other devices. Git keeps it."""
        known, who = self._known(), self.bench.wait(self.device.links.instruments()).who
        serials = {name: one.serial for name, one in who.items()}
        results = {name: known.provenance.get(name) for name in (*results_of(known), *known.provenance)}
        wrong = {name: why for name, how in results.items() if (why := refusal(how, self.device.bench, serials))}
        if not wrong:
            return
        for name, why in wrong.items():
            self.asks.say(f"{name} is left out of {self.file.name}: {why}.")
        self._keep(without(known, wrong))


def without(known: Calibration, results: Mapping[str, str]) -> Calibration:
    """Return a calibration without some `results` (`step/subject`); a camera without lens or place is none."""
    of = {step: {r.partition("/")[2] for r in results if r.partition("/")[0] == step} for step in STEPS}
    cameras = {n: c for n, c in known.cameras.items() if n not in of["intrinsics"] | of["extrinsics"] | of["hands"]}
    gone = {
        *results,
        *(f"{s}/{n}" for n in known.cameras.keys() - cameras.keys() for s in ("intrinsics", "extrinsics", "hands")),
    }
    return replace(
        known, cameras=cameras, residuals={n: v for n, v in known.residuals.items() if n in cameras},
        arms={n: v for n, v in known.arms.items() if n not in of["arms"]},
        axes={n: v for n, v in known.axes.items() if n not in of["axes"]},
        dark={n: v for n, v in known.dark.items() if n not in of["dark"]},
        provenance={n: v for n, v in known.provenance.items() if n not in gone},
    )  # fmt: skip


def _with_cameras(known: Calibration, found: FoundCameras) -> Calibration:
    return replace(
        known, cameras={**known.cameras, **found.cameras}, residuals={**known.residuals, **found.residuals},
        accuracy=replace(Accuracy(), position=max(LEAST_POSITION, round(found.position, 3))),
        provenance={**known.provenance, **found.provenance},
    )  # fmt: skip
