"""Which bench a command means: what its options say, else `PICO_BENCH`, else what this worktree chose, else `sim`.

Nothing but an option, or `pico bench use hardware` in this worktree, leads to the real bench of this machine.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path

from pico.backends.devices import HARDWARE, SIMULATOR, known_devices, shipped
from pico.diagnostics import PicoError, did_you_mean, error
from pico.edge.network.remotes import PAGE, Far, Place, Remotes, at_url, known, named
from pico.places.bench import BenchPlace
from pico.places.choice import read_choice

VARIABLE = "PICO_BENCH"
LOCAL = "local"
"""Another word for the simulated bench of this machine."""


def meant(
    root: Path, *, backend: str | None = None, word: str | None = None, environment: Mapping[str, str] | None = None,
    safety: bool = False,
) -> Place:  # fmt: skip
    """Return the bench that is meant for the lab in `root`: by the name of its device (`backend`), or by a `word` (a
    device, LAB/BENCH of a remote, `pico://host/LAB/BENCH`); without both by the environment (that of this process for
    None), then by what this worktree chose. `safety`: coordinators that can't be read are none, for what only makes a
    bench of this machine safer. Raises PicoError for a word that names no bench."""
    try:
        remotes = known(root)  # also puts back what a killed `pico gui` left
    except PicoError:
        if not safety:
            raise
        remotes = Remotes()
    if backend and word:
        found = named_bench(root, remotes, word)
        if isinstance(found, BenchPlace) and found.name != backend:
            hint = f"leave one of them out: `--bench {found.name}`, or `--bench {backend}`"
            raise PicoError(error("usage", f"these options name two benches: {found.name} and {backend}", hint=hint))
    elif backend:
        found = BenchPlace(root, backend)
    elif word:
        found = named_bench(root, remotes, word)
    elif said := (os.environ if environment is None else environment).get(VARIABLE):
        found = _by_environment(root, remotes, said)
    else:
        found = chosen(root, remotes)
    return found if isinstance(found, Far) else _on_page(remotes, found)


def chosen(root: Path, remotes: Remotes) -> Place:
    """Return the bench that this worktree chose, `sim` if it chose none. Raises PicoError."""
    word = read_choice(root) or remotes.default
    if not word:
        return BenchPlace(root, SIMULATOR)
    try:
        return named_bench(root, remotes, word)
    except PicoError as exc:
        hint = f"`pico bench use {SIMULATOR}` chooses the simulator, `pico bench list` shows the others"
        wrong = error(
            "remote", f"the bench that this worktree chose is unknown: {exc.diagnostics[0].summary}", hint=hint
        )
        raise PicoError(wrong) from exc


def named_bench(root: Path, remotes: Remotes, word: str) -> Place:
    """Return the bench that a word names; raises PicoError for one that names none."""
    if "://" in word:
        return at_url(root, word)
    if "/" in word:
        remote, lab, bench = named(remotes, word)
        return Far(remotes.named[remote], lab, bench, root, remotes.page[0] if remote == PAGE and remotes.page else "")
    name = SIMULATOR if word == LOCAL else word
    if name not in shipped() and name not in (devices := known_devices()):
        hint = did_you_mean(word, devices) or "LAB/BENCH, `sim`, `emulated` or `hardware`"
        raise PicoError(error("remote", f"`{word[:80]}` names no bench", hint=hint))
    return BenchPlace(root, name)


def _by_environment(root: Path, remotes: Remotes, word: str) -> Place:
    found = named_bench(root, remotes, word)
    if isinstance(found, BenchPlace) and found.name == HARDWARE:
        text = f"{VARIABLE}={word} would select the real bench, which no environment variable may"
        hint = "`--bench hardware` for one command, or `pico bench use hardware` in this worktree"
        raise PicoError(error("usage", text, hint=hint))
    return found


def _on_page(remotes: Remotes, place: BenchPlace) -> Place:
    """Return a bench of this machine as `pico gui` serves it meanwhile, itself if that does not."""
    if remotes.page is None or remotes.page[0] != place.name or PAGE not in remotes.named:
        return place
    lab, _, bench = remotes.page[1].partition("/")
    return Far(remotes.named[PAGE], lab, bench, place.root, place.name)


def word_for(place: Place) -> str:
    """Return the word by which `--bench` names a bench, from any checkout of its lab."""
    if isinstance(place, BenchPlace):
        return place.name
    if place.local:
        return place.local
    known_as = [name for name, one in known(place.root).named.items() if one == place.remote]
    return f"{known_as[0]}/{place.name}" if known_as else f"{place.remote.url}/{place.name}"
