"""Pictures of a bench and lengths on it: of what stands there, of a state, of a plan."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from pico.backends.devices import SIMULATOR
from pico.bench.opened import Opened
from pico.bench.plans import Plans
from pico.model.plan import Plan

if TYPE_CHECKING:
    from pico.drawing.beams import Place
    from pico.drawing.picture import Image, View
    from pico.drawing.ruler import Measured
    from pico.model.setup import Setup
    from pico.motion.types import Joints
    from pico.optics.axis import Values
    from pico.twin.placement import Placement


class Pictures:
    """Pictures of one bench."""

    def __init__(self, opened: Opened) -> None:
        self.opened, self.folder = opened, opened.folder

    def render(
        self,
        revision: str | None = None,
        *,
        manifest: bool = False,
        view: View = "perspective",
        plan: bool | Plan = False,
        size: tuple[int, int | None] = (960, None),
        out: Path | None = None,
    ) -> Image:
        """Return a picture (height, width, 3), sRGB, of the bench as it is, or as a revision or the manifest wants it.

        `plan` (from above only): the bench as it is, with what this plan moves, or that to the revision or the
        manifest, drawn dashed and numbered, with a list below; where it is impossible, what is in whose way, in red.
        `size`: width and height [pixels], without that list; no height: as high as what is in it. `out`: write it
        there, too, as PNG. Raises PicoError.
        """
        from pico.bench.picturing.contents import goals, marks, standing, steps, wanted
        from pico.drawing.picture import render, write_png

        if plan is True:
            plan = Plans(self.opened).plan(revision)
        drawn = plan if isinstance(plan, Plan) else None
        setup, poses, joints, values = self._live()
        if not drawn and (revision or manifest):
            state = self.folder.state_at(revision) if revision else self.folder.state
            poses, values = standing(self.folder.setup, state), wanted(state)
        image = render(
            setup,
            poses,
            joints,
            view=view,
            width=size[0],
            height=size[1],
            ghosts=goals(self.folder.setup, drawn) if drawn else None,
            marks=marks(self.folder.setup, drawn) if drawn else (),
            steps=steps(drawn) if drawn else (),
            values=values,
            red=self._not_safe(drawn) if drawn else (),
        )
        if out is not None:
            write_png(image, out)
        return image

    def _not_safe(self, plan: Plan) -> tuple[tuple[tuple[float, float], ...], ...]:
        """Return the branches that the beam audit finds fault with in a plan, as lines [mm]."""
        from pico.bench.auditing import case_of

        audit, _ = case_of(self.opened, plan, self.opened.observe()).light
        return tuple(f.path for f in audit.findings if f.path)

    def sheet(self, revision: str | None = None, *, manifest: bool = False) -> str:
        """Return a drawing of the bench from above as SVG at true scale, with its parts list: as it is, or as a
        revision or the manifest wants it; raises PicoError."""
        from pico.bench.picturing.contents import standing, wanted
        from pico.drawing.sheet import sheet

        setup, poses, _, values = self._live()
        title = self.opened.history.head_name()
        if revision or manifest:
            state = self.folder.state_at(revision) if revision else self.folder.state
            poses, values = standing(self.folder.setup, state), wanted(state)
            title = self.opened.history.name_of(revision) if revision else "the manifest"
        return sheet(setup, poses, subtitle=title, values=values)

    def render_diff(self, a: str | None = None, b: str | None = None, *, out: Path | None = None) -> Image:
        """Return a picture (height, width, 3) from above of how state `a` (HEAD) becomes `b` (the manifest), numbered
        in the order of `diff`; raises PicoError."""
        from pico.bench.picturing.contents import differences, standing, wanted
        from pico.drawing.picture import render, write_png

        setup, before = self.folder.setup, self.folder.state_at(a or "HEAD")
        after = self.folder.state_at(b) if b else self.folder.state
        found = differences(setup, before, after, self.folder.diff(a, b))
        image = render(setup, standing(setup, before), {}, view="top", steps=found, values=wanted(before))
        if out is not None:
            write_png(image, out)
        return image

    def ruler(self, a: str, b: str) -> Measured:
        """Return how far two things on the bench are from each other: components, slots, holes or points, see
        `pico.drawing.ruler`; raises PicoError."""
        from pico.drawing.ruler import measure

        setup, poses, joints, values = self._live()
        return measure(setup, poses, joints, a, b, values)

    def render_ruler(self, measured: Measured, *, out: Path | None = None) -> Image:
        """Return a picture (height, width, 3) from above of what `ruler` found."""
        from pico.drawing.picture import render, write_png

        setup, poses, joints, values = self._live()
        image = render(setup, poses, joints, view="top", dimensions=measured.dimensions, values=values)
        if out is not None:
            write_png(image, out)
        return image

    def view(self) -> None:
        """Open MuJoCo's own viewer on the bench, and follow it until the window is closed; raises PicoError."""
        from pico.drawing.picture import placed
        from pico.drawing.viewer import view

        def now() -> tuple[Mapping[str, Placement], Mapping[str, Joints]]:
            _, poses, joints, _ = self._live()
            return placed({name: at for name, at in poses.items() if name in setup.lab.inventory}), joints

        setup = self._live()[0]
        view(setup, now)

    def _live(self) -> tuple[Setup, dict[str, Place], dict[str, Joints], Values]:
        """Return the bench with strangers on it, where everything is, the joints of each robot, and known tunables."""
        from pico.bench.picturing.contents import places, with_strangers

        seen = self.opened.observe()
        in_space = self.opened.sim.placements() if self.opened.backend_name == SIMULATOR else {}
        setup = with_strangers(self.folder.setup, seen)
        found = places(setup, seen, in_space)
        return setup, found, {name: robot.joints for name, robot in seen.robots.items()}, seen.known_values
