"""Parts of a revision taken into a manifest: what was named is as it was then, everything else as it is now."""

from __future__ import annotations

from collections.abc import Mapping

from hypothesis import given, settings
from hypothesis import strategies as st

from examples import examples
from pico.manifest.changes import entries
from pico.manifest.edit import set_values
from pico.manifest.load import load_files, load_folder
from pico.model.address import holds, read_addresses
from pico.model.state import LabState, place_of
from pico.resources import labs_dir

SETUP = load_folder(labs_dir() / "shel").require()[0]
PARTS = {"cam": "exposure", "hwp": "angle", "lx_100": "", "p1": "angle", "p2": "angle"}
FIXED = ("cam", "hwp")
HEADER = "apiVersion: pico/v1\nkind: LabState\nmetadata: {lab: shel}\ncomponents:\n"

Part = tuple[float | None, float | None]
"""x of a pose (None: at home) and the value of the other tunable (None: not given)."""
numbers = st.none() | st.integers(100, 180).map(float)
states = st.dictionaries(st.sampled_from(sorted(PARTS)), st.tuples(numbers, numbers))
addresses = st.sampled_from([*PARTS, *(f"{n}.pose" for n in PARTS), *(f"{n}.{t}" for n, t in PARTS.items() if t)])


def text(state: Mapping[str, Part]) -> str:
    """Write a state as a person would, a comment for each component and each value."""
    lines = []
    for name, (x, value) in sorted(state.items()):
        home = SETUP.lab.inventory[name].home
        fixed = SETUP.lab.inventory[name].pose
        lines += [f"  # the {name}", f"  {name}:"]
        if x is None and home:
            lines.append(f"    slot: {home}")
        elif x is not None or fixed:
            at = x if x is not None else fixed.x if fixed else 0
            lines += ["    pose:", f"      x: {at}  # x of {name}", "      y: 420", "      yaw: 0"]
        if value is not None and PARTS[name]:
            lines.append(f"    {PARTS[name]}: {value}  # {PARTS[name]} of {name}")
    return HEADER + "\n".join(lines) + "\n"


def read(manifest: str) -> LabState:
    return load_files({"table.yaml": manifest.encode()}, setup=SETUP).require()[1]


@settings(max_examples=examples(150), deadline=None)
@given(then=states, now=states, names=st.sets(addresses, min_size=1, max_size=4))
def test_only_what_was_named_is_as_then(then: dict[str, Part], now: dict[str, Part], names: set[str]) -> None:
    was, is_, named = read(text(then)), read(text(now)), read_addresses(SETUP, names)
    made = {name: entries(SETUP, name, some, was, is_) for name, some in named.items()}
    result = set_values(text(now), {name: change for name, change in made.items() if change != {}})
    state = read(result)
    for name, tunable in PARTS.items():
        for kind, get in (("pose", _place), (tunable, _value)):
            source = was if holds(named, name, kind) else is_
            assert get(state, name, kind) == get(source, name, kind), f"{name}.{kind}"
    for name in now.keys() - named.keys():
        assert f"  # the {name}\n  {name}:\n" in result
        assert all(line in result for line in text({name: now[name]}).splitlines()[4:])
    if state == is_:
        assert result == text(now)


def _place(state: LabState, name: str, _: str) -> object:
    return place_of(SETUP, state, name)


def _value(state: LabState, name: str, tunable: str) -> object:
    return state.components[name].values.get(tunable) if name in state.components else None
