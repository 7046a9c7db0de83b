"""What is measured of a real bench: pictures and powers of its instruments, into the same kernels as the twin's."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from pico.backends.attempt import Failed
from pico.backends.hardware.instruments import Instruments, Metered
from pico.backends.hardware.pictures import grayed
from pico.backends.hardware.powers import Values, color_at, power_reading, read_as, without_dark
from pico.backends.measured import Reading, measurement
from pico.diagnostics import PicoError, error
from pico.kernels.frame import saturated
from pico.kernels.measured import computed, version
from pico.kernels.pipeline import parsed
from pico.model.instruments.readout import unknown
from pico.model.measurement import Measurement
from pico.model.observation import Observation
from pico.model.pose import Pose
from pico.model.quantities import Value
from pico.model.setup import Setup
from pico.optics.sensing.sensor import Sensor

if TYPE_CHECKING:
    from pico.backends.sight import Look

IMAGES = ("image", "dark")
_NOTHING: Values = {}
FULL = 255
"""What a pixel of a camera over the bench reads that has all the light that it can tell."""


class Readers:
    """What can be measured with the instruments of a bench; `look` looks through the cameras over it, `poses` returns
    where parts were seen last."""

    def __init__(
        self, setup: Setup, root: Path, bench: Instruments, look: Callable[[], Awaitable[Look]] | None = None,
        at: str = "", poses: Callable[[], Mapping[str, Pose]] = dict,
    ) -> None:  # fmt: skip
        self._setup, self._root, self._bench, self._look, self._at = setup, root, bench, look, at
        self._poses = poses

    def measurables(self) -> Iterator[str]:
        """Yield what can be measured, as addresses."""
        for name in (*self._setup.lab.inventory, *self._setup.lab.cameras):
            for measurable in self._setup.measurables_of(name):
                if self._reader(name, measurable) is not None:
                    yield f"{name}.{measurable}"

    async def measured(
        self, component: str, name: str, seen: Observation, busy: list[str] | None
    ) -> Measurement:  # fmt: skip
        """Return what is measured of a component on the bench as it is `seen`; `busy` as in `measurement`. Raises
        Failed where nothing measures it, or that fails."""
        known, reading = self._setup.measurable_of(component, name), await self.read(component, name, seen.known_values)
        made = (self._setup, self._root, seen, known, reading, component, name, busy, self._at)
        return await asyncio.to_thread(measurement, *made)

    async def read(self, component: str, name: str, values: Values = _NOTHING) -> Reading:
        """Return what is read of a measurable, with the tunables of the bench known to be at `values`; raises Failed
        where nothing measures it, or that fails."""
        reader = self._reader(component, name, values)
        if reader is None:
            text = f"no device of this bench measures {component}.{name}"
            raise Failed(error("unmeasured", text, address=f"{component}.{name}"))
        try:
            return await reader()
        except PicoError as exc:
            said = exc.diagnostics[0]
            text = f"{component}.{name} could not be measured: {said.summary}"
            raise Failed(replace(said, summary=text, address=f"{component}.{name}")) from exc

    async def image(self, component: str) -> Reading:
        """Return one frame of a camera in the beam, with its brightest pixel (`peak`) and its `mean` [counts]."""
        kind, tunables = self._setup.type_of(component), self._bench.tunables
        own: dict[str, float] = {}
        for setting in ("exposure", "gain"):
            if f"{component}.{setting}" in tunables:
                value = (await tunables[f"{component}.{setting}"].read()).value
                if not isinstance(value, int | float):
                    text = f"the value of {component}.{setting} is unknown: it was never set"
                    hint = f"`pico set {component} {setting}=...`"
                    if setting == "exposure" and "auto_range" in kind.primitives:
                        hint += f", or `pico do {component} auto_range`"
                    raise PicoError(error("unknown", text, hint=hint, address=f"{component}.{setting}"))
                own[setting] = float(value)
        counts = await self._bench.sensors[component].grab(exposure=own.get("exposure"), gain=own.get("gain"))
        sensor = Sensor(
            size=(counts.shape[1], counts.shape[0]), pitch=kind.number("pixel_size", "um") or 1.0,
            bits=round(kind.number("bit_depth", "bit") or 12), full_well=kind.number("full_well", "") or 1e4,
            read_noise=kind.number("read_noise", "") or 0.0, black=self._black(component),
        )  # fmt: skip
        gain = own.get("gain", 0.0)
        settings: dict[str, Value] = {
            "exposure": own.get("exposure", 1.0), "gain": gain, "pixel_size": sensor.pitch,
            "full_scale": sensor.full_scale, "black_level": sensor.black, "read_noise": sensor.read_noise,
            "electrons_per_count": sensor.electrons_per_count(gain),
        }  # fmt: skip
        values = {"peak": float(counts.max()), "mean": float(counts.mean())}
        return Reading(values, counts, settings=settings, saturated=saturated(counts, sensor.full_scale))

    def _reader(self, component: str, name: str, values: Values = _NOTHING) -> Callable[[], Awaitable[Reading]] | None:
        """Return what reads a measurable; None where nothing does."""
        bench, address = self._bench, f"{component}.{name}"
        over = component in self._setup.lab.cameras and component not in self._setup.lab.inventory
        found: list[tuple[bool, Callable[[], Awaitable[Reading]]]] = [
            (over and name == "frame" and component in bench.cameras, lambda: self._frame(component)),
            (not over and name == "pose" and self._marked(component), lambda: self._pose(component)),
            (address in bench.tunables, lambda: self._setpoint(address)),
            (address in bench.meters, lambda: self._metered(component, name, values)),
            (component in bench.sensors and name in IMAGES, lambda: self.image(component)),
            (
                component in bench.sensors and self._kernel(component, name) != "",
                lambda: self._computed(component, name),
            ),
        ]
        return next((read for can, read in found if can), None)

    def _marked(self, component: str) -> bool:
        """Whether cameras over the bench can find a part."""
        marked = self._setup.lab.inventory[component].marker is not None
        return marked and self._setup.type_of(component).geometry.marker is not None and bool(self._bench.cameras)

    def _kernel(self, component: str, name: str) -> str:
        """The kernels that make a measurable of a picture; empty where none do."""
        if component not in self._bench.sensors:
            return ""
        try:
            kernel = self._setup.measurable_of(component, name).kernel
        except PicoError:
            return ""
        return kernel if kernel and parsed(kernel).source in IMAGES else ""

    async def _frame(self, camera: str) -> Reading:
        gray = grayed(await self._bench.cameras[camera].grab())
        full = int((gray >= FULL).sum())
        said = f"{full} of {gray.size} pixels read {FULL}" if full else ""
        return Reading({"peak": float(gray.max()), "mean": float(gray.mean())}, gray, saturated=said)

    async def _pose(self, component: str) -> Reading:
        assert self._look is not None  # asked of an open bench only
        seen = (await self._look()).observation
        part = seen.components[component]
        if part.pose is None or part.how not in ("stereo", "known height"):
            said = next((p for p in seen.problems if p.address == component), None)
            raise Failed(said or error("unseen", f"the cameras do not see {component}", address=component))
        pose, sigma = part.pose, part.uncertainty
        spread = {"x": sigma.position, "y": sigma.position, "yaw": sigma.yaw}
        return Reading(
            {"x": pose.x, "y": pose.y, "yaw": pose.yaw}, sigma=spread, settings={"seen by": part.how},
            kernel="markers", kernel_version="1",
        )  # fmt: skip

    async def _setpoint(self, address: str) -> Reading:
        live = await self._bench.tunables[address].read()
        if live.status != "known":
            raise Failed(error("unread", f"{address} can't be read back: nobody knows it", address=address))
        return Reading(live.value)

    def _black(self, component: str) -> float:
        """The level of a camera without light [counts]: as it was calibrated, else as its type says."""
        if dark := self._bench.dark.get(f"{component}.image"):
            return dark.level
        return self._setup.type_of(component).number("black_level", "count") or 0.0

    async def _metered(self, component: str, name: str, values: Values) -> Reading:
        metered, dark = self._bench.meters[f"{component}.{name}"], self._bench.dark.get(f"{component}.{name}")
        if metered.measured.colored:
            found = await self._power(metered, component, values)
            return found if dark is None else without_dark(found, dark)
        return read_as(await metered.measured.read(), metered.conversion)

    async def _power(self, metered: Metered, component: str, values: Values) -> Reading:
        own = self._bench.tunables.get(f"{component}.wavelength")
        before = await own.read() if own is not None else None
        color = await asyncio.to_thread(lambda: color_at(self._setup, values, self._poses(), component))
        try:
            readout = await metered.measured.read(color.wavelength)
        except PicoError as exc:
            if exc.diagnostics[0].code != "device-limit":
                raise
            readout = unknown("W", "wavelength", why=exc.diagnostics[0].summary)
        if own is not None and before is not None and before.status == "known" and before.value is not None:
            await own.set(before.value)  # a measurement leaves the set-points of the lab as they were
        kind = self._setup.type_of(component)
        responds, sensor = kind.tunables.get("wavelength"), kind.parameters.get("sensor")
        material = "" if sensor is None else str(sensor.value)
        return power_reading(readout, color, metered.conversion, responds, material)

    async def _computed(self, component: str, name: str) -> Reading:
        kernel = self._kernel(component, name)
        base, pipeline = await self.image(component), parsed(kernel)
        assert base.array is not None
        found = await asyncio.to_thread(computed, pipeline, base.array, base.settings)
        return replace(
            base, array=base.array if name == kernel else None, value=found.value, sigma=found.sigma, kernel=kernel,
            kernel_version=version(pipeline), unknown=found.unknown, unit=found.unit,
            remark=found.remark,
        )  # fmt: skip
