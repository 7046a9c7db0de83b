"""A real bench as a device: arms, cameras, mounts and instruments through drivers, or the same through emulators."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Collection, Coroutine, Mapping
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NoReturn, TypeVar

from pico.backends.by_sight import BySight
from pico.backends.device import Began, Capabilities
from pico.backends.devices import HARDWARE
from pico.backends.hardware.clearing import clear, faults_of
from pico.backends.hardware.guard.note import EDGE_END, STOPPED, notices
from pico.backends.hardware.guard.note import read as read_note
from pico.backends.hardware.guard.verdict import Trip
from pico.backends.hardware.instruments import Instruments, unwired
from pico.backends.hardware.lights import Lights, closes_itself, lasers_of
from pico.backends.hardware.links import Links
from pico.backends.hardware.measuring import Readers
from pico.backends.hardware.pictures import alike, grayed
from pico.backends.hardware.reading import sensed, told
from pico.backends.hardware.report import read
from pico.backends.hardware.session import HardwareSession, one_motion
from pico.backends.hardware.settings import Settings
from pico.backends.hardware.showing import Shown
from pico.backends.last_seen import LastSeen, Taken, noted, placed_at, recall, recall_hands, remember
from pico.diagnostics import Diagnostic, PicoError, error
from pico.drivers.protocols import Arm
from pico.model.commissioning import CODE, NEAR, Basis, basis_of, motion_tried, slowly
from pico.model.instruments.fault import DeviceFault
from pico.model.measurement import Measurement
from pico.model.observation import Observation, with_value
from pico.model.operation import Operation, OperationResult
from pico.model.pose import Pose
from pico.model.record import as_json
from pico.model.setup import Setup
from pico.model.trace.event import Event
from pico.motion.deferred import DeferredMotion
from pico.motion.types import MovePath
from pico.places.bench import BenchPlace
from pico.planning.checks.beams import shutter_of
from pico.planning.checks.interlocks import LAMP
from pico.planning.routines import plugged_in
from pico.twin.arms import TwinArm
from pico.vision.arm import NOMINAL
from pico.vision.calibration_files import calibration_digest, not_counting, other_devices, read_calibration
from pico.vision.frame import TRIES, Frame

if TYPE_CHECKING:
    from pico.backends.hardware.guard.note import Ended
    from pico.backends.measured import Reading
    from pico.backends.sight import Look
    from pico.backends.world import Held, World
    from pico.twin.moment import Moment
    from pico.twin.snapshot import Snapshot
    from pico.vision.calibration import Calibration
    from pico.vision.frame import Region

LOST = 6
"""Pictures that are asked of a camera over the bench before none comes; of those that come black TRIES."""
PATIENCE = 10.0
"""After how long [s] one that failed is not asked again: a picture may come late once, where a machine is busy."""
PRIMITIVES = frozenset({"move", "stow", "set", "home", "park", "measure", "auto_range"})
T = TypeVar("T")


class HardwareDevice:
    """The bench at `place`, reached by `links`. `clock` gives the wall time as ISO 8601, UTC; a
    `fidelity` it has only in name, for plans to be compared."""

    def __init__(
        self, setup: Setup, place: BenchPlace, links: Links, fidelity: str, *, clock: Callable[[], str]
    ) -> None:  # fmt: skip
        self.fidelity = fidelity
        self.setup, self.place, self.links, self._clock = setup, place, links, clock
        self._motion, self._settings = DeferredMotion(setup), Settings(place)
        self._session: HardwareSession | None = None
        self._placed: dict[str, LastSeen] = {}
        self._shown = Shown(setup, place)
        self._before: tuple[tuple[Observation, str | None], list[Frame], Look] | None = None
        self._kinds = {n: said.kind for n, said in (setup.wiring.safety_inputs if setup.wiring else {}).items()}

    @property
    def bench(self) -> str:
        """`hardware`, or `emulated`."""
        return self.place.name

    async def describe(self) -> Capabilities:
        """Return what the bench can do, as its wiring says; asks no device."""
        about = self.links.about()
        readers = Readers(self.setup, self.place.root, about)
        return Capabilities(
            name=self.bench, fidelity=self.fidelity, evidence=self.bench, lab_digest=self.setup.digest(),
            primitives=PRIMITIVES | plugged_in().keys(), robots=tuple(sorted(self.setup.lab.robots)),
            measurables=frozenset(readers.measurables()), unmodelled=unwired(self.setup, about),
        )  # fmt: skip

    async def basis(self) -> Basis:
        """Return what a report of a commissioning would be of now; raises PicoError for what does not answer."""
        who = (await self.links.instruments()).who
        return basis_of(self.setup, {name: as_json(one) for name, one in who.items()})

    async def most(self) -> float | None:
        """Return the greatest speed of tools here while nobody has tried their stop [mm/s], None where somebody has."""
        basis = await self.basis()
        try:
            report = read(self.place.root, self.bench)
        except PicoError:  # of one that can't be read nobody knows what was tried
            return NEAR
        return NEAR if slowly(report, self.bench, basis) else None

    async def faults(self) -> tuple[DeviceFault, ...]:
        """Return the faults of all instruments; raises PicoError for links that are lost."""
        return await faults_of(await self.links.instruments())

    async def clear(self, name: str) -> None:
        """Clear the faults of an instrument for a person who was at the table; raises PicoError."""
        await clear(await self.links.instruments(), name)

    async def untried(self) -> frozenset[str]:
        """Return the robots of a real bench whose driver's motion test did not pass on the device that answers now, by
        its serial number and firmware. What a driver says of its own maturity does not count."""
        if self.bench != HARDWARE:
            return frozenset()
        who = (await self.links.instruments()).who
        try:
            report = read(self.place.root, self.bench)
        except PicoError:  # of one that can't be read nobody knows what was tried
            report = None
        return frozenset(
            robot for robot, device in self.links.arm_devices().items()
            if device not in who or not motion_tried(report, device, as_json(who[device]))
        )  # fmt: skip

    # looking

    async def observe(self) -> Observation:
        """Look, and return what was seen; raises PicoError where arms can't tell where they are, and cameras are dark
        or have moved."""
        from pico.backends.sight import require_trusted

        return require_trusted((await self.look()).observation)

    async def moment(self) -> Moment:
        """Return the bench as it is known without looking, arms as they report themselves where the links are open."""
        carried = self._session.carried() if self._session is not None else {}
        found = await self._shown.moment(self.links.now(), self.links.connected, self.arms(), carried)
        lit = self.links.lights().values() if self.links.connected is not None else {}
        seen = found.seen
        for address, value in lit.items():  # the guard asks lasers and shutters all the time
            name, _, tunable = address.partition(".")
            seen = with_value(seen, name, tunable, value) if name in seen.components else seen
        return replace(found, seen=seen)

    async def look(self) -> Look:
        """Look through the cameras over the table, with the lamps of the room on for it."""
        bench = await self.links.instruments()
        return await self._lit(bench, self._looked(bench))

    async def _lit(self, bench: Instruments, work: Coroutine[Any, Any, T]) -> T:
        """Do something with the lamps of the room on, and bring them back."""
        lamps = {a: one for a, one in bench.tunables.items() if a.partition(".")[2] == LAMP}
        was = {address: (await one.read()).value for address, one in lamps.items()}
        dark = [address for address, value in was.items() if value is not True]
        try:
            for address in dark:
                await lamps[address].set(True)
            return await work
        finally:
            for address in dark:
                if was[address] is False:
                    await lamps[address].set(False)

    async def picture(self, camera: str) -> Frame:
        """Return a picture of a camera over the table as it is taken now, lamps on; raises PicoError."""
        bench = await self.links.instruments()
        return await self._lit(bench, self._frame(bench, camera))

    async def _looked(self, bench: Instruments) -> Look:
        from pico.backends.sight import unlooked

        hands = {name for name, camera in self.setup.lab.cameras.items() if camera.robot is not None}
        frames = [await self._frame(bench, name) for name in sorted(bench.cameras.keys() - hands)]
        known = await self._felt(bench, recall_hands(self.place))
        found = await asyncio.to_thread(self._seen, frames, known)
        if not frames:
            found = replace(found, observation=unlooked(found.observation))
        self._shown.looked(found.observation)
        self.links.lights().gates = self._gates(found.observation)
        return found

    def _gates(self, seen: Observation) -> dict[str, str]:
        """Return the shutter on the table that stands in the beam of each laser, as the bench was seen."""
        found = {name: shutter_of(self.setup, seen, (), name) for name in lasers_of(self.setup)
                 if "shutter" not in self.setup.type_of(name).tunables}  # fmt: skip
        return {name: gate for name, gate in found.items() if gate}

    def _seen(self, frames: list[Frame], known: Observation) -> Look:
        """What frames show; those that are the same to the last pixel show the same."""
        from pico.backends.sight import BLIND, look

        last, same = {**recall(self.place), **self._placed}, calibration_digest(self.place.root, self.bench)
        about = replace(known, time=0.0, observed_at=""), same
        if (
            self._before is not None
            and self._before[0] == about
            and not self._placed
            and alike(frames, self._before[1])
        ):
            found = self._before[2]
            return replace(
                found, observation=replace(found.observation, time=known.time, observed_at=known.observed_at)
            )
        found = look(self.setup, frames, self.calibration(), known, last)
        if not any(problem.code in BLIND for problem in found.observation.problems):
            remember(self.place, noted(last, found.observation))
            self._placed.clear()
            self._before = about, frames, found
        return found

    async def _frame(self, bench: Instruments, name: str, region: Region | None = None) -> Frame:
        """Return a picture of a camera over the table, of a region of its sensor; taken again while it is black, and
        where it got lost."""
        began = time.monotonic()
        for left in reversed(range(LOST)):
            try:
                gray = grayed(await bench.cameras[name].grab())
            except PicoError:
                if not left or time.monotonic() - began > PATIENCE:
                    raise
                continue
            u, v, width, height = region or (0, 0, gray.shape[1], gray.shape[0])
            u, v = max(0, u), max(0, v)
            frame = Frame(gray[v : v + height, u : u + width], (u, v), name, self.links.now())
            if not frame.black or left <= LOST - TRIES:
                break
        return frame

    def _told(self, bench: Instruments, most: float | None, untried: Collection[str]) -> list[Diagnostic]:
        """What must be known of the instruments before anything moves."""
        found = list(not_counting(self.place.root, self.bench))
        if without := [a for a in unwired(self.setup, bench) if not self.setup.requests(*a.split("."))]:
            text = f"no device of this bench has {', '.join(without)}: PICO neither compares nor sets that"
            found.append(Diagnostic("note", "no-device", text))
        for name, why in sorted(bench.lacking.items()):
            found += [replace(one, severity="warning", address=name) for one in why]
        if most is not None and self.setup.lab.robots:
            text = f"how this bench stops was not tried yet: tools move at {most:g} mm/s at most"
            found.append(Diagnostic("note", CODE, text, hint="`pico commission` walks through it"))
        return found + [replace(one_motion(robot), severity="warning") for robot in sorted(untried)]

    async def _felt(self, bench: Instruments, taken: Mapping[str, Taken]) -> Observation:
        found = await told(bench)
        found = replace(found, values={**self._settings.commanded(self.setup), **found.values})
        said = self._told(bench, await self.most(), await self.untried())
        found = replace(found, problems=(*found.problems, *notices(read_note(self.place)), *said))
        return sensed(
            self.setup, self.arms(), found, self._kinds, taken, self.bench, self.links.now(), self._clock()
        )  # fmt: skip

    def calibration(self) -> Calibration | None:
        """Return the calibration of the bench, None without one. Raises PicoError for results of evidence that the
        bench does not accept, and for those of a device with another serial number than the one that answers."""
        found, connected = read_calibration(self.place.root, self.bench), self.links.connected
        if found is not None and connected is not None:
            serials = {name: one.serial for name, one in connected.who.items()}
            if wrong := other_devices(found, serials, self.bench):
                raise PicoError(wrong)
        return found

    def arms(self) -> dict[str, TwinArm]:
        """Return the arms as calibration knows them; raises PicoError as `calibration`."""
        found, robots = self.calibration(), self.setup.lab.robots.items()
        known = {name: arm.offsets for name, arm in found.arms.items()} if found else {}
        return {name: TwinArm(robot, known=known.get(name, NOMINAL)) for name, robot in robots}

    async def peek(self, component: str, measurable: str) -> Measurement:
        """Return what a measurement would give now, of which nothing is assured; raises PicoError."""
        from pico.backends.attempt import Failed

        try:
            return await self._measured(component, measurable, None)
        except Failed as exc:
            raise PicoError(exc.diagnostic) from exc

    async def snap(self, component: str, measurable: str) -> Reading:
        """Return what is read now of a measurable, and keep nothing; raises PicoError."""
        from pico.backends.attempt import Failed

        readers = Readers(self.setup, self.place.root, await self.links.instruments(), self.look, poses=self._poses)
        try:
            return await readers.read(component, measurable)
        except Failed as exc:
            raise PicoError(exc.diagnostic) from exc

    def _poses(self) -> dict[str, Pose]:
        """Return where parts were seen last."""
        return {name: last.pose for name, last in {**recall(self.place), **self._placed}.items()}

    async def _measured(self, component: str, measurable: str, busy: list[str] | None) -> Measurement:
        bench = await self.links.instruments()
        readers = Readers(self.setup, self.place.root, bench, self.look, self._clock(), self._poses)
        seen = await self._felt(bench, recall_hands(self.place))
        made, by = (
            await readers.measured(component, measurable, seen, busy),
            calibration_digest(self.place.root, self.bench),
        )
        return replace(made, settings={**made.settings, "calibration": by}) if by else made

    # moving

    async def take(self, token: int, tell: Callable[[Event], None], require: Callable[[], None] = lambda: None) -> None:
        """Get the arms ready: faults that may be cleared are, limits, load and collision detection are set and read
        back. Raises PicoError."""
        bench, most = await self.links.instruments(), await self.most()
        await asyncio.gather(*(_ready(arm) for arm in bench.arms.values()))
        loop = asyncio.get_running_loop()

        def wait(work: Coroutine[Any, Any, T]) -> T:
            return asyncio.run_coroutine_threadsafe(work, loop).result()

        known = BySight(
            self.setup, self.place, lambda taken: wait(self._felt(bench, taken)), lambda: wait(self._looked(bench)),
            lambda camera, region: wait(self._frame(bench, camera, region)),
        )  # fmt: skip
        self._session = HardwareSession(
            self.setup, bench, known, motion=self._motion, arms=self.arms(), tell=tell, now=self.links.now,
            pause=self.links.pause, measure=self._measured, image=Readers(self.setup, self.place.root, bench).image,
            keep=self._settings.put, untried=await self.untried(), most=most,
            require=require, darken=self.links.lights().tripped,
        )  # fmt: skip
        session, lights = self._session, self.links.lights()
        lights.session = lambda trip: self._heard(loop, session, trip)
        lights.moving = session.moving

    def _heard(self, loop: asyncio.AbstractEventLoop, session: HardwareSession, trip: Trip) -> None:
        """Let who has the bench hear that the guard ends light; called in the guard's thread."""
        if session is self._session and not loop.is_closed():
            asyncio.run_coroutine_threadsafe(session.trip(trip), loop)

    async def execute(self, operation: Operation, key: str, began: Began) -> OperationResult:
        """Execute one operation and return when it has ended."""
        assert self._session is not None  # only who has taken the device executes
        result = await self._session.execute(operation, key, began)
        self._shown.became(operation.component, result.after)
        if result.outcome == "done" and operation.kind.carries:
            self._placed[operation.component] = placed_at(self.setup, operation, result)
            remember(self.place, {**recall(self.place), **self._placed})
        return result

    async def walk(self, path: MovePath, speed: float) -> None:
        """Have an arm go along a path, for who has taken the bench and tries it out; see `HardwareSession.walk`."""
        assert self._session is not None  # only who has taken the device moves
        await self._session.walk(path, speed)

    async def try_motion(self, robot: str) -> Mapping[str, float]:
        """Have an arm do the motion test of its driver, for who has taken the bench; see `HardwareSession`."""
        assert self._session is not None  # only who has taken the device moves
        return await self._session.try_motion(robot)

    async def halt(self) -> None:
        """Bring everything under way to its safe end."""
        if self._session is not None:
            await self._session.halt()

    async def stop(self) -> None:
        """Stop everything where it is; grippers hold what they hold, and light ends: whether or not something moves."""
        work = [] if self._session is None else [self._session.stop()]
        await asyncio.gather(self._darkened(), *work)

    async def _darkened(self) -> None:
        with suppress(PicoError):  # what has no devices at all emits nothing that PICO could end
            await self.end_light()

    def listen(
        self, heard: Callable[[Ended, Trip | None], None], disarm: Callable[[str], tuple[str, ...]] | None = None
    ) -> None:
        """Have `heard` called after light was ended, see `pico.backends.device.LightGuarded`."""
        self.links.listen(heard, disarm)

    async def guarded(self) -> None:
        """Connect to the devices, and guard their light from now on."""
        await self.links.instruments()

    def guards(self) -> bool:
        """Return whether the bench has a laser that a device could make dark; asks no device."""
        return bool(Lights(self.setup, self.place, self.links.about()).lights())

    def may_emit(self) -> bool:
        """Return whether a laser may emit that this process guards, see `pico.backends.device.LightGuarded`."""
        return self.links.connected is not None and not self.links.lights().is_dark

    def dark_by_itself(self) -> frozenset[str]:
        """Return the lasers that have a dead-man, see `pico.backends.device.LightGuarded`; asks no device."""
        lights = Lights(self.setup, self.place, self.links.about()).lights()
        return frozenset(light.laser for light in lights if closes_itself(light))

    async def end_light(self, *, at_end: bool = False) -> Ended:
        """End all light now, and return what became of each laser, see `pico.backends.device.LightGuarded`."""
        if at_end:
            return await self.links.lights().end("the edge of this bench was stopped", EDGE_END, disarms=False)
        return await self.links.lights().end("a person stopped the bench", STOPPED)

    async def leave(self) -> None:
        """Let others have the bench, once everything under way has ended."""
        if self._session is not None:
            await self._session.idle()
            self._session = None
            self.links.lights().moving = tuple

    async def close(self) -> None:
        """Let go of the links to the instruments."""
        await self.links.close()

    # what only a simulator has

    def watch(self, look: Callable[[Snapshot], None] | None) -> None:
        """Raise PicoError where a film is wanted."""
        if look is not None:
            raise PicoError(error("film", "only the simulated bench is filmed", hint="`--backend sim`"))

    def kept(self) -> bool:
        """Return True: the table is where it is."""
        return True

    def world(self, held: Held, require_kept: Callable[[], None]) -> World:
        """Raise PicoError: hands change a real table."""
        return _no_world()


async def _ready(arm: Arm) -> None:
    if (await arm.state()).fault:
        await arm.recover()
    else:
        await arm.ready()


def _no_world() -> NoReturn:
    text = "this command works only on the simulator"
    raise PicoError(error("no-world", text, hint="`pico --bench sim ...` changes the simulated bench"))
