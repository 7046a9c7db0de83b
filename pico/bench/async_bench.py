"""One bench, asynchronous: reads its lab, observes, plans, runs. `pico.bench.bench.Bench` is its synchronous face."""

from __future__ import annotations

from collections.abc import Collection, Generator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Literal

from pico.backends.devices import SIMULATOR, opener
from pico.bench.pictures.pictures import Drawings
from pico.diagnostics import ExitCode, PicoError, did_you_mean, error
from pico.history.lab.folder import LabFolder
from pico.model.address import read_addresses
from pico.model.diff import Change
from pico.model.drift import drift_of
from pico.model.observation import Observation, live_state
from pico.model.plan import Base, Plan, Target
from pico.model.request import PrimitiveRequest, asked, read_peeked, read_values, require_seen
from pico.motion.deferred import DeferredMotion
from pico.vision.calibration import calibration_digest

if TYPE_CHECKING:
    from pico.backends.world import World
    from pico.bench.running.async_execution import AsyncExecution
    from pico.drawing.film.film import Caption
    from pico.edge.protocol import Edge
    from pico.history.restoring.selected import SelectedParts
    from pico.manifest.load import Manifests
    from pico.model.expectation import Verified
    from pico.model.measurement import Measurement
    from pico.model.report import Captured, Committed, PartRow, RunReport
    from pico.model.state import LabState
    from pico.model.status import Status
    from pico.planning.explaining.explain import Explanation
    from pico.planning.request import Preference
    from pico.twin.placement import Placement
    from pico.twin.snapshot import Recording

CommitMode = Literal["strict", "capture", "planned"]


class AsyncBench(Drawings):
    """One bench: its lab's folder, and the edge that sees and moves it. Open it with `AsyncBench.open`."""

    def __init__(self, folder: LabFolder, fidelity: str | None = None, backend: str = SIMULATOR) -> None:
        self.folder = folder
        self.backend_name = backend
        self.fidelity = fidelity or folder.setup.lab.sim.fidelity
        self._edge: Edge | None = None
        self.lock_timeout = 0.0

    @classmethod
    def open(
        cls,
        path: str | Path = ".",
        *,
        backend: str = SIMULATOR,
        fidelity: str | None = None,
        speed: float | None = None,
    ) -> AsyncBench:
        """Open the lab that `path` lies in. Nothing is contacted yet.

        `backend`: `sim`; `hardware` says what it lacks. `fidelity`: `kinematic` or `physics`, the lab's own word where
        None. `speed`: share of the joint limits for every robot, instead of the lab's. Raises PicoError.
        """
        _require_backend(backend, fidelity, speed)
        folder = LabFolder(Path(path), bench=True)
        if speed is not None:
            robots = {name: replace(robot, speed=speed) for name, robot in folder.setup.lab.robots.items()}
            folder.setup = replace(folder.setup, lab=replace(folder.setup.lab, robots=robots))
        bench = cls(folder, fidelity, backend)
        if backend != SIMULATOR:
            _ = bench.edge  # says what is missing
        return bench

    def _adopt(self, plan: Plan) -> None:
        """Run a saved plan in the fidelity that it was made for."""
        if plan.backend == self.backend_name and plan.fidelity != self.fidelity:
            self.fidelity, self._edge = plan.fidelity, None

    @property
    def edge(self) -> Edge:
        """The edge, made when it is first needed; raises PicoError where its device can't be had."""
        if self._edge is None:
            from pico.edge.link.opening import opened

            self._edge = opened(self.setup, self.root, self.backend_name, self.fidelity, self.folder.own)
        return self._edge

    async def wait_until_free(self, seconds: float) -> None:
        """Wait until nobody moves the bench, at most so long here and again when it is taken.

        Raises PicoError (exit code LOCKED), naming who has it.
        """
        from pico.edge.lease import wait_until_free

        self.lock_timeout = seconds
        await wait_until_free(self.root, seconds)

    async def close(self) -> None:
        """Let go of the edge."""
        if self._edge is not None:
            await self._edge.close()
            self._edge = None

    async def observe(self) -> Observation:
        """Look, and return what was seen."""
        return await self.edge.observe()

    async def plan(
        self,
        revision: str | None = None,
        *,
        exact: bool = False,
        prefer: Preference = "fewest-moves",
        targets: Collection[str] = (),
        exclude: Collection[str] = (),
        manifests: Manifests | None = None,
        expecting: bool = True,
    ) -> Plan:
        """Return the plan from the bench as it stands to a revision, or to the manifest in the working tree.

        The state comes from the revision, the bench as it is now. `prefer`: what counts first, `fewest-moves` or
        `shortest-time`. `targets`: plan for these components or tunables (`p2`, `p1.angle`), and for what must make way
        for them; `exclude`: leave these alone. `manifests`: instead of those in the working tree. `expecting`: whether
        the expectations of the state count; those of single components never do. Raises PicoError for a revision that
        can't be read, for a component that there is not, and for an expectation that makes no sense; what is physically
        impossible is in the plan's diagnostics.
        """
        from pico.history.merge.doubts import require_settled
        from pico.planning import plan

        _require_preference(prefer)
        given = manifests
        manifests = self.folder.manifests_at(revision) if revision else given or self.folder.manifests
        commit = self.folder.history().resolve(revision).id if revision else None
        wanted = self._goal(manifests, revision, targets)
        if not expecting:
            wanted = replace(wanted, expect=())
        if wanted.expect and not (targets or exclude):
            _require_sense("expect", manifests)
        if manifests is not given:
            require_settled(self.folder.repository, self.root, manifests, commit, targets)
        seen = await self.observe()
        found = plan(
            self.setup,
            seen,
            wanted,
            motion=DeferredMotion(self.setup),
            backend=self.backend_name,
            fidelity=self.fidelity,
            base=self.base(seen),
            target=Target(
                revision=revision,
                commit=commit,
                only=tuple(sorted(targets)) or None,
                exclude=tuple(sorted(exclude)) or None,
                state=wanted.as_json(),
                expect=wanted.expect or None,
            ),
            exact=exact,
            source=manifests.source,
            prefer=prefer,
            targets=targets,
            exclude=exclude,
        )
        told, calibration = manifests.told, calibration_digest(self.root)
        if told or calibration:
            found = replace(found, calibration=calibration, diagnostics=(*told, *found.diagnostics)).sealed()
        return self.judged(found, seen)

    def _goal(self, manifests: Manifests, revision: str | None, targets: Collection[str]) -> LabState:
        from pico.history.restoring.selected import state_for

        return state_for(self.folder, manifests, revision, targets) if revision and targets else manifests.require()[1]

    def judged(self, plan: Plan, seen: Observation) -> Plan:
        """Return the plan with what the policy of the lab says of it."""
        if not self.setup.lab.policy.rules:
            return plan
        from pico.policy.rules import judged

        if plan.operations:
            _require_sense("rules", self.folder.manifests)
        return judged(self.setup, plan, seen)

    def base(self, seen: Observation) -> Base:
        """Return what a plan from this observation starts from."""
        head = self.folder.head()
        state = live_state(self.setup, seen).as_json()
        return Base(commit=head.commit if head else None, observed_at=seen.observed_at, state=state)

    async def plan_of(self, word: str | None, *, folder: Path = Path(), **options: Any) -> Plan:
        """Return the saved plan that `word` names, or the plan to the revision it names (the manifest for None).

        `options` are those of `plan`; raises PicoError for any of them with a saved plan, which is what it is.
        """
        found = self.find(word, folder) if word else None
        if not isinstance(found, Plan):
            return await self.plan(found, **options)
        if any(options.get(k) for k in ("exact", "targets", "exclude")) or options.get("prefer") == "shortest-time":
            text = f"{word} is a saved plan, and is taken as it is"
            raise PicoError(error("usage", text, hint="--exact, --target, --exclude and --prefer go with `pico plan`"))
        return found

    def explain(self, plan: Plan, component: str | None = None) -> Explanation:
        """Return why a plan is as it is, or what it does with one component; raises PicoError for an unknown one."""
        from pico.planning.explaining.explain import explain

        return explain(self.setup, plan, component)

    async def checkout_plan(self, revision: str | SelectedParts, *, exact: bool = False) -> Plan:
        """Return the plan to a revision that is about to be checked out, or to what is taken from one for some
        components; raises PicoError where edits would be lost."""
        if not isinstance(revision, str):
            found = await self.plan(manifests=revision.manifests, targets=revision.names, exact=exact)
            return found.because("checkout")
        self.folder.refuse_edits()
        return (await self.plan(revision, exact=exact)).because("checkout")

    def checkout_files(self, revision: str | SelectedParts) -> None:
        """Check a revision out with git, or write what is taken from one. Moves nothing; raises PicoError.

        This bench stays what it is, for a revision can't change which parts there are.
        """
        if not isinstance(revision, str):
            revision.write(self.folder)
            return
        self.folder.history().checkout(revision)
        self.folder.reload()

    async def single(self, component: str, primitive: str, arguments: Mapping[str, str] | None = None) -> Plan:
        """Return the plan of one primitive, its arguments as a person writes them; raises PicoError for nonsense."""
        from pico.execution.checks import require_able

        seen = await self.observe()
        found = self._one(seen, asked(self.setup, seen, component, primitive, arguments or {}))
        require_able(found, await self.edge.describe())
        return found

    async def place(self, component: str, *, after: str, distance: float) -> Plan:
        """Return the plan that places a component `distance` mm after another along its beam; raises PicoError."""
        from pico.planning import place_after

        seen = await self.observe()
        require_seen(self.setup, seen, component, after)
        pose = place_after(self.setup, seen, component, after, distance)
        return self._one(seen, PrimitiveRequest(component=component, primitive="move", pose=pose))

    def _one(self, seen: Observation, request: PrimitiveRequest) -> Plan:
        from pico import planning

        name, options = request.component, {"backend": self.backend_name, "fidelity": self.fidelity}
        base = self.base(seen)
        if request.primitive == "set":
            assert request.tunable is not None and request.value is not None
            found = planning.set_one(self.setup, seen, name, request.tunable, request.value, base=base, **options)
        elif request.primitive == "home":
            assert request.tunable is not None
            found = planning.home_one(self.setup, seen, name, request.tunable, base=base, **options)
        elif request.measurable is not None:
            motion = DeferredMotion(self.setup)
            wanted = [(name, request.measurable)]
            found = planning.measure(self.setup, seen, wanted, motion=motion, base=base, **options)
        elif request.slot is None and request.pose is None:
            found = planning.do_one(self.setup, seen, name, request.primitive, request.arguments, base=base, **options)
        else:
            goal, motion = request.slot or request.pose, DeferredMotion(self.setup)
            assert goal is not None
            found = planning.move_one(self.setup, seen, name, goal, motion=motion, base=base, **options)
        return self.judged(found, seen)

    def run(
        self,
        plan: Plan,
        *,
        recording: Recording | None = None,
        resumes: str | None = None,
        stop_on_error: bool = False,
    ) -> AsyncExecution:
        """Return the run of a plan: iterate over it for its events, then read its `report`.

        `recording`: gets what a film of the run shows, see `film`.
        `resumes`: the run that goes on under its id. `stop_on_error`: the first failure lets nothing more start.
        """
        from pico.bench.running.async_execution import AsyncExecution

        self._adopt(plan)
        named = partial(self.goal_now, plan)
        return AsyncExecution(
            plan, self.edge, named, recording=recording, resumes=resumes, stop_on_error=stop_on_error,
            wait=self.lock_timeout,
        )  # fmt: skip

    def goal_now(self, plan: Plan) -> str:
        """Return what a plan leads to as a person calls it, and that it is not that any more where it was edited since
        or a name in Git leads elsewhere."""
        target = plan.target
        if target.revision:
            try:
                same = self.folder.history().resolve(target.revision).id == target.commit
            except PicoError:
                same = False
            return target.name if same else f"{target.name} as it was when it was planned ({str(target.commit)[:7]})"
        state = None if target.title else self.folder.state_now()
        if target.title or (state and state.as_json() == dict(target.state)):
            return target.name
        return f"{target.name} as it was when it was planned; it was edited since"

    def film(
        self, recording: Recording, out: Path, *, captions: Sequence[Caption] = (), fps: float = 12.0
    ) -> Generator[tuple[int, int], None, None]:
        """Write a film of a run to `out`, .mp4 or .gif, in simulated time, `fps` pictures a second.

        Yields (pictures done, of how many); ended early, the film is what was done until then. Raises PicoError.
        """
        from pico.drawing.film.film import write_film

        return write_film(self.setup, recording.snapshots, out, captions=captions, fps=fps)

    async def apply(self, what: Plan | str | None = None) -> RunReport:
        """Run a plan, or plan to a revision (the manifest for None) and run that; return what became of it."""
        run = self.run(what if isinstance(what, Plan) else await self.plan(what))
        async for _ in run:
            pass
        return run.report

    async def status(self) -> Status:
        """Return committed, desired and live side by side."""
        from pico.model.status import compare

        return compare(self.setup, self.folder.committed(), self.state, await self.observe(), self.head_name())

    async def drift(self) -> tuple[Change, ...]:
        """Return where the bench differs from HEAD: `before` is live, `after` committed; raises PicoError."""
        return drift_of(self.setup, await self.observe(), self.state_at("HEAD"))

    async def to_measure(self, revision: str | None = None) -> Plan:
        """Return the plan that measures what the expectations of a revision, or of the manifest, speak of, as far as
        this bench can; it has no operations where that is nothing."""
        from pico import planning
        from pico.model.vocabulary import measured_in

        state, able = self.state_at(revision) if revision else self.state, await self.edge.describe()
        seen, spoken = await self.observe(), measured_in(self.setup, [one.that for one in state.expect])
        found = planning.measure(
            self.setup, seen, [(name, m) for name, m in spoken if f"{name}.{m}" in able.measurables],
            motion=DeferredMotion(self.setup), backend=self.backend_name, fidelity=self.fidelity, base=self.base(seen),
        )  # fmt: skip
        return self.judged(found, seen)

    async def verify(
        self, revision: str | None = None, measurements: Mapping[str, Measurement] = MappingProxyType({})
    ) -> Verified:
        """Return how the bench as observed stands against a revision, or the manifest, and its expectations; and
        whether any bench ever stood as that commit (HEAD for the manifest) says. `measurements`: what was measured just
        now, by address."""
        from pico.history import runs as recording
        from pico.model.expectation import Verified
        from pico.policy.expectations import check_expectations

        wanted = self.state_at(revision) if revision else self.state
        seen = replace(await self.observe(), measurements=measurements)
        return Verified(
            goal=revision or "the manifest", observed_at=seen.observed_at, changes=drift_of(self.setup, seen, wanted),
            expectations=check_expectations(self.setup, seen, wanted.expect),
            standing=recording.standing_of(self.folder, revision),
        )  # fmt: skip

    async def expected(self, plan: Plan) -> Verified:
        """Return what became of the expectations of a plan's goal, which the bench has reached already."""
        from pico.model.expectation import Verified
        from pico.policy.expectations import check_expectations

        seen = await self.observe()
        found = check_expectations(self.setup, seen, plan.target.expect or ())
        return Verified(goal=plan.target.name, observed_at=seen.observed_at, expectations=found)

    async def parts(self, *, free: bool = False) -> tuple[PartRow, ...]:
        """Return the inventory with where each part is; `free`: only those that the manifest leaves in storage."""
        from pico.model.report import parts_of

        return parts_of(self.setup, self.state, await self.observe(), free=free)

    async def read(self, component: str, tunable: str | None = None) -> dict[str, dict[str, Any]]:
        """Return the tunables of a component as observed: `value`, `unit`, `status` of each; raises PicoError.

        A measurable, also of a camera over the bench, is peeked at: of its value nothing is assured.
        """
        declared = self.setup.measurables_of(component).get(tunable or "")
        if tunable and declared and declared.datatype in ("image", "float"):
            return {tunable: read_peeked(await self.edge.peek(component, tunable))}
        return read_values(self.setup, await self.observe(), component, tunable)

    async def capture(self, *only: str, write: bool = True) -> Captured:
        """Write what the bench shows otherwise than the manifest, beyond tolerance, into the manifest.

        `only`: these components or tunables (`p2`, `p1.angle`). Without `write`, say what would be written.
        """
        named = read_addresses(self.setup, only) if only else None
        return self.folder.capture(live_state(self.setup, await self.observe(), sure=True), named, write=write)

    async def commit(
        self,
        message: str | None = None,
        mode: CommitMode = "strict",
        *,
        only: Collection[str] = (),
        meta: Mapping[str, str] = MappingProxyType({}),
    ) -> Committed:
        """Capture and commit the manifests, with the runs that led to what they say; raises PicoError.

        `message`: why; the physical diff where None. `mode`: `strict` refuses edits that were never applied; `capture`:
        the bench wins; `planned`: the manifest wins where all of it can stand (exit code IMPOSSIBLE else), and the
        commit says where it was never realized. `only`, `meta`: see `pico.bench.commits.CommitRequest`.
        """
        from pico.bench.commits import CommitRequest, commit

        if mode == "planned":
            from pico.history.merge.checked import overlapping

            if found := overlapping(self.folder.manifests):
                raise PicoError(found, ExitCode.IMPOSSIBLE)
        asked = CommitRequest(message=message, mode=mode, only=only, meta=meta)
        return commit(self.folder, await self.observe(), asked, observed=self.fidelity)

    async def draft(self, mode: CommitMode = "strict", *, only: Collection[str] = ()) -> str:
        """Return the message that `commit` writes where nobody says why."""
        from pico.bench.commits import CommitRequest, draft

        return draft(self.folder, await self.observe(), CommitRequest(mode=mode, only=only))

    async def _planned(self, revision: str | None) -> Plan:
        return await self.plan(revision)

    def _in_space(self) -> Mapping[str, Placement]:
        return self.sim.placements() if self.backend_name == SIMULATOR else {}

    @property
    def sim(self) -> World:
        """The simulated world, to be changed as a hand would; raises PicoError where nothing is simulated."""
        return self.edge.world


def _require_sense(what: Literal["expect", "rules"], manifests: Manifests) -> None:
    """Raise PicoError, with their places, for expectations of a state or rules of a lab that can't be told."""
    from pico.manifest.expression_checks import check_expectations, check_rules

    found = check_expectations(manifests) if what == "expect" else check_rules(manifests)
    if found:
        raise PicoError(found)


def _require_backend(backend: str, fidelity: str | None, speed: float | None) -> None:
    opener(backend)
    if fidelity not in (None, "kinematic", "physics"):
        known = ["kinematic", "physics"]
        raise PicoError(error("fidelity", f"there is no fidelity `{fidelity}`", hint=did_you_mean(fidelity, known)))
    if speed is not None and not 0 < speed <= 1:
        raise PicoError(error("speed", f"a speed of {speed:g} is no share of the joint limits", hint="0.01 to 1"))


def _require_preference(prefer: str) -> None:
    known = ["fewest-moves", "shortest-time"]
    if prefer not in known:
        raise PicoError(error("prefer", f"a plan can't prefer `{prefer}`", hint=did_you_mean(prefer, known)))
