"""What of a bench each step of its calibration is about."""

from __future__ import annotations

from pico.backends.hardware.device import HardwareDevice
from pico.backends.hardware.instruments import Instruments
from pico.drivers.driven import Motorized
from pico.model.calibration.steps import CalibrationStep, StepStanding, standing
from pico.model.instruments.conversion import same_dimension
from pico.model.quantities import convert
from pico.model.setup import Setup
from pico.vision.calibration_files import stored_calibration


def subjects_of(setup: Setup, bench: Instruments) -> dict[CalibrationStep, tuple[str, ...]]:
    """Return the cameras, axes, detectors, arms and hands that each step calibrates, as the lab's devices have them;
    asks no device."""
    axes = (address for address, one in bench.tunables.items() if isinstance(one, Motorized))
    arms = tuple(sorted(name for name, robot in setup.lab.robots.items() if robot.model == "xarm7"))
    hands = (name for name, camera in setup.lab.cameras.items() if camera.robot in arms and name in bench.cameras)
    over = tuple(sorted(name for name, camera in setup.lab.cameras.items() if camera.robot is None))
    return {
        "intrinsics": over,
        "extrinsics": over,
        "axes": tuple(sorted(address for address in axes if _turns(setup, address))),
        "dark": tuple(sorted((*(f"{name}.image" for name in bench.sensors), *_meters(bench)))),
        "arms": arms,
        "hands": tuple(sorted(hands)),
    }  # fmt: skip


def _turns(setup: Setup, address: str) -> bool:
    """Whether a tunable is an angle, of which a scale or a mark can be read."""
    component, _, name = address.partition(".")
    tunable = setup.type_of(component).tunables.get(name)
    return tunable is not None and bool(tunable.unit) and same_dimension(tunable.unit, "deg")


def _meters(bench: Instruments) -> list[str]:
    return [address for address, one in bench.meters.items() if one.measured.colored]


def standing_of(device: HardwareDevice, now: str) -> tuple[StepStanding, ...]:
    """Return how each step of the calibration of a bench stands `now` (ISO 8601); the serial numbers of its devices
    count as far as they are connected. Raises PicoError for a file that is no calibration."""
    setup, links = device.setup, device.links
    found = stored_calibration(device.place.root, device.bench)
    known = found.provenance if found is not None else {}
    who = links.connected.who if links.connected is not None else {}
    lasts = setup.lab.policy.calibrated_for
    seconds = None if lasts is None else float(convert(lasts, "s"))
    serials = {name: one.serial for name, one in who.items()}
    return standing(subjects_of(setup, links.about()), known, device.bench, serials, now, seconds)
