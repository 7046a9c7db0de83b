"""The open run that the steps of a recipe are done in, one after the other: the bench is taken once for all of them."""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING

from pico.diagnostics import PicoError
from pico.model.plan import Target
from pico.model.trace.run import RunOutcome

if TYPE_CHECKING:
    from pico.bench.bench import Bench
    from pico.scripting.recording import Recording


class OneRun:
    """The open run of a `recipe` (`NAME@ID`): begun when a step first needs it, and ended before what needs a run that
    is over, such as a commit, and before what nobody knows the end of. Then another one begins."""

    def __init__(self, bench: Bench, recipe: str) -> None:
        self.bench, self.recipe = bench, recipe
        self._recording: Recording | None = None

    def begin(self) -> str:
        """Begin it where none is open (one that somebody records around the recipe is), and return its id; raises
        PicoError where somebody else has the bench."""
        from pico.scripting.recording import Recording

        if self.bench.recording is None:
            target = Target(title=self.recipe.partition("@")[0], cause="recipe", recipe=self.recipe)
            self._recording = Recording(self.bench, target.name, target).__enter__()
        return str(self.bench.recording)

    def end(self, how: RunOutcome = "done") -> None:
        """End it where one is open; raises PicoError where one that is done was stopped from elsewhere."""
        recording, self._recording = self._recording, None
        if recording is not None:
            with suppress(*() if how == "done" else (PicoError,)):
                recording.end(how)
