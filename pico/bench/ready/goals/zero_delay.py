"""Two arms of the same length: where the fringes of a source with a spectrum are clearest."""

from __future__ import annotations

from pico.bench.ready.asked import Asked, Ready
from pico.bench.ready.tuning import ALONG, tuned
from pico.model.lab import Goal

TAKES = "STAGE CAMERA: arms as long as one another, where fringes are clearest"
LEAST = 2


def make(asked: Asked) -> Ready:
    """Return the goal of what makes an arm longer, and the camera that sees the fringes."""
    tunables, camera = tuned(asked, ALONG), asked.camera(asked.words[-1], "fringes.visibility")
    ways = asked.ways(camera)
    if len(ways) != 2:
        text = f"{len(ways)} beams come to {camera}, not those of two arms"
        raise asked.refused(text, "`pico beam` shows where beams run")
    inside = [sum(address.partition(".")[0] in way for way in ways) for address in tunables]
    if any(count != 1 for count in inside):
        address = next(a for a, count in zip(tunables, inside, strict=True) if count != 1)
        raise asked.refused(f"{address} makes neither arm longer than the other", "a stage or a piezo in one arm")
    return Ready(asked.name, Goal(tunables=tunables, maximize=f"{camera}.fringes.visibility"))
