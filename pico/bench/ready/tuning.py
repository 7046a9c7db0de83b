"""What of the parts that a user names a ready-made goal tunes, where they do not say which tunable."""

from __future__ import annotations

from collections.abc import Sequence

from pico.planning.asked import Asked

ACROSS = ("stage_y", "stage_z", "tip", "tilt", "pinhole_y", "pinhole_z")
TURNED = ("angle",)
ALONG = ("stage_x", "piezo")


def tuned(asked: Asked, *usual: Sequence[str]) -> dict[str, tuple[float, float]]:
    """Return what is tuned of all words but the last, with their whole ranges: the first of the `usual` groups that a
    part has anything of, else what else it turns or moves. Raises PicoError for a part without."""
    found: dict[str, tuple[float, float]] = {}
    for word in asked.words[:-1]:
        found |= _of(asked, word, usual)
    return found


def _instead(asked: Asked, component: str, kinds: Sequence[str]) -> str:
    """Return what a part has that is of no use here; of one without any, that an arm may put it down by the light."""
    if not kinds and asked.what == "center" and asked.setup.movable(component):
        return f"`pico optimize center {component} {asked.words[-1]} --by-arm`: the arm puts it down anew"
    return f"it has: {', '.join(kinds) or 'none'}"


def _of(asked: Asked, word: str, usual: Sequence[Sequence[str]]) -> dict[str, tuple[float, float]]:
    component, _, one = word.partition(".")
    kinds = asked.setup.type_of(asked.part(component)).tunables
    groups = ((one,),) if one else (*usual, (*TURNED, *ALONG))
    names = next((own for group in groups if (own := [n for n in group if n in kinds])), None)
    if names is None:
        raise asked.refused(f"{word} has nothing to tune for it", _instead(asked, component, list(kinds)))
    return dict(asked.bounds(component, *names))
