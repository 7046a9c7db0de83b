"""Pictures of a bench and lengths on it: of what stands there, of a state, of a plan.

The bench itself says what it sees and plans; see `pico.bench.async_bench`.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from pico.history.reader import Reader
from pico.model.observation import Observation
from pico.model.plan import Plan

if TYPE_CHECKING:
    from pico.drawing.beams import Place
    from pico.drawing.picture import Image, View
    from pico.drawing.ruler import Measured
    from pico.motion.types import Joints
    from pico.optics.axis import Values
    from pico.twin.placement import Placement


class Drawings(Reader, ABC):
    """Draws for the class that sees and plans."""

    @abstractmethod
    async def observe(self) -> Observation:
        """Look, and return what was seen."""

    @abstractmethod
    async def _planned(self, revision: str | None) -> Plan: ...

    @abstractmethod
    def _in_space(self) -> Mapping[str, Placement]:
        """Return where components are that do not stand on the table, as far as the backend knows."""

    async def render(
        self,
        revision: str | None = None,
        *,
        manifest: bool = False,
        view: View = "perspective",
        plan: bool | Plan = False,
        size: tuple[int, int] = (960, 720),
        out: Path | None = None,
    ) -> Image:
        """Return a picture (height, width, 3), sRGB, of the bench as it is, or as a revision or the manifest wants it.

        `plan` (from above only): the bench as it is, with what this plan moves, or that to the revision or the
        manifest, drawn dashed and numbered, with a list below; where it is impossible, what is in whose way, in red.
        `size`: width and height [pixels], without that list. `out`: write it there, too, as PNG. Raises PicoError.
        """
        from pico.bench.pictures.contents import goals, marks, standing, steps, wanted
        from pico.drawing.picture import render, write_png

        if plan is True:
            plan = await self._planned(revision)
        drawn = plan if isinstance(plan, Plan) else None
        poses, joints, values = await self._live()
        if not drawn and (revision or manifest):
            state = self.state_at(revision) if revision else self.state
            poses, values = standing(self.setup, state), wanted(state)
        image = render(
            self.setup,
            poses,
            joints,
            view=view,
            width=size[0],
            height=size[1],
            ghosts=goals(self.setup, drawn) if drawn else None,
            marks=marks(self.setup, drawn) if drawn else (),
            steps=steps(drawn) if drawn else (),
            values=values,
        )
        if out is not None:
            write_png(image, out)
        return image

    async def sheet(self, revision: str | None = None, *, manifest: bool = False) -> str:
        """Return a drawing of the bench from above as SVG at true scale, with its parts list: as it is, or as a
        revision or the manifest wants it; raises PicoError."""
        from pico.bench.pictures.contents import standing, wanted
        from pico.drawing.sheet import sheet

        poses, _, values = await self._live()
        title = self.head_name()
        if revision or manifest:
            state = self.state_at(revision) if revision else self.state
            poses, values = standing(self.setup, state), wanted(state)
            title = self.name_of(revision) if revision else "the manifest"
        return sheet(self.setup, poses, subtitle=title, values=values)

    def render_diff(self, a: str | None = None, b: str | None = None, *, out: Path | None = None) -> Image:
        """Return a picture (height, width, 3) from above of how state `a` (HEAD) becomes `b` (the manifest), numbered
        in the order of `diff`; raises PicoError."""
        from pico.bench.pictures.contents import differences, standing, wanted
        from pico.drawing.picture import render, write_png

        before, after = self.state_at(a or "HEAD"), self.state_at(b) if b else self.state
        found = differences(self.setup, before, after, self.diff(a, b))
        image = render(self.setup, standing(self.setup, before), {}, view="top", steps=found, values=wanted(before))
        if out is not None:
            write_png(image, out)
        return image

    async def ruler(self, a: str, b: str) -> Measured:
        """Return how far two things on the bench are from each other: components, slots, holes or points, see
        `pico.drawing.ruler`; raises PicoError."""
        from pico.drawing.ruler import measure

        poses, joints, values = await self._live()
        return measure(self.setup, poses, joints, a, b, values)

    async def render_ruler(self, measured: Measured, *, out: Path | None = None) -> Image:
        """Return a picture (height, width, 3) from above of what `ruler` found."""
        from pico.drawing.picture import render, write_png

        poses, joints, values = await self._live()
        image = render(self.setup, poses, joints, view="top", dimensions=measured.dimensions, values=values)
        if out is not None:
            write_png(image, out)
        return image

    async def view(self) -> None:
        """Open MuJoCo's own viewer on the bench, and follow it until the window is closed; raises PicoError."""
        import asyncio

        from pico.drawing.picture import placed
        from pico.drawing.viewer import view

        loop = asyncio.get_running_loop()

        def now() -> tuple[Mapping[str, Placement], Mapping[str, Joints]]:
            poses, joints, _ = asyncio.run_coroutine_threadsafe(self._live(), loop).result()
            return placed(poses), joints

        await asyncio.to_thread(view, self.setup, now)

    async def _live(self) -> tuple[dict[str, Place], dict[str, Joints], Values]:
        """Return where components are, the joints of each robot, and what is known of tunables."""
        from pico.bench.pictures.contents import places

        seen = await self.observe()
        found = places(self.setup, seen, self._in_space())
        return found, {name: robot.joints for name, robot in seen.robots.items()}, seen.known_values
