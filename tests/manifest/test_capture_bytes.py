"""A capture changes the values that differ, and not another byte: whatever the manifests look like."""

from __future__ import annotations

from dataclasses import dataclass, field
from decimal import Decimal

from hypothesis import given, settings
from hypothesis import strategies as st

from examples import examples
from pico.manifest.capture import capture
from pico.manifest.load import load_files
from pico.model.address import read_addresses
from pico.model.pose import Pose
from pico.model.state import ComponentState, LabState

PARTS = [f"c{i}" for i in range(6)]
FIELDS = ("x", "y", "yaw", "angle")
LAB = "\n".join(
    [
        "apiVersion: pico/v1\nkind: Lab\nmetadata: {name: bench}\ntable: {size: [4000, 4000], beam_height: 70}",
        "robots: {arm1: {model: gantry, mount: {x: 0, y: 0}}}\nslots:",
        *(f"  rack/{name}: {{x: {3000 + 100 * i}, y: 3500}}" for i, name in enumerate(PARTS)),
        "inventory:",
        *(f"  {n}: {{type: linear_polarizer, marker: {i}, home: rack/{n}}}" for i, n in enumerate(PARTS)),
    ]
)
EMPTY = b"apiVersion: pico/v1\nkind: LabState\nmetadata: {lab: bench}\n"
SETUP, _ = load_files({"lab.yaml": LAB.encode(), "s.yaml": EMPTY}).require()


@dataclass
class Written:
    """A manifest as pieces of text between values: `pieces` are text, or the part and field whose value is there."""

    pieces: list[str | tuple[str, str]] = field(default_factory=list)
    ends: str = "\n"
    mark: str = ""
    last: bool = True

    def text(self, values: dict[tuple[str, str], str]) -> bytes:
        """Return the manifest with the texts of these values."""
        text = "".join(values[p] if isinstance(p, tuple) else p for p in self.pieces)
        text = text if self.last else text.rstrip("\n")
        return (self.mark + text.replace("\n", self.ends)).encode()


def number(value: Decimal) -> str:
    """Return a number as a manifest holds it, with no more digits than it needs."""
    text = format(value.normalize(), "f")
    return "0" if text == "-0" else text


SPACE = st.sampled_from(["", " ", "  # note", "   # 90 deg: was 3", "\t# tab"])
BETWEEN = st.sampled_from(["", "\n", "  # x: 5, angle: 7\n", "\n    # deeper\n\n"])
EXTRA = st.sampled_from(["", "expect:\n- {that: 'c0.angle >= 0'}\n", "# the end\n"])


@st.composite
def files(draw: st.DrawFn) -> list[tuple[str, Written]]:
    """Draw the parts, in one to three manifests, each in a layout of its own."""
    cuts = sorted(draw(st.lists(st.integers(0, len(PARTS)), max_size=2)))
    groups = [PARTS[a:b] for a, b in zip([0, *cuts], [*cuts, len(PARTS)], strict=True) if b > a]
    return [(f"state/{i}.yaml", draw(manifest(group))) for i, group in enumerate(groups)]


@st.composite
def manifest(draw: st.DrawFn, parts: list[str]) -> Written:
    found = Written(
        ends=draw(st.sampled_from(["\n", "\r\n"])), mark=draw(st.sampled_from(["", "\ufeff"])), last=draw(st.booleans())
    )
    head = ["apiVersion: pico/v1\n", "kind: LabState\n", "metadata: {lab: bench}\n"]
    found.pieces = ["# mine\n" * draw(st.integers(0, 1)), *draw(st.permutations(head))]
    if draw(st.integers(0, 9)) == 0:  # everything in one line
        inner: list[str | tuple[str, str]] = [piece for name in parts for piece in (*flow(draw, name), ", ")]
        found.pieces += ["components: {", *inner[:-1], "}\n"]
    else:
        found.pieces += [f"components:{draw(SPACE)}\n"]
        for name in parts:
            found.pieces += [draw(BETWEEN), *draw(st.sampled_from([flow_line, block, nested]))(draw, name)]
    found.pieces.append(draw(EXTRA))
    return found


def flow(draw: st.DrawFn, name: str) -> list[str | tuple[str, str]]:
    space = draw(st.sampled_from(["", " "]))
    pose = ["pose: {x: ", (name, "x"), ", y: ", (name, "y"), ", yaw: ", (name, "yaw"), f"{space}}}"]
    angle = ["angle: ", (name, "angle")]
    first, second = draw(st.permutations([pose, angle]))
    return [f"{name}: {{{space}", *first, ", ", *second, f"{space}}}"]


def flow_line(draw: st.DrawFn, name: str) -> list[str | tuple[str, str]]:
    return ["  ", *flow(draw, name), f"{draw(SPACE)}\n"]


def block(draw: st.DrawFn, name: str) -> list[str | tuple[str, str]]:
    step = " " * draw(st.sampled_from([1, 2, 4]))
    pose: list[str | tuple[str, str]] = [f"  {step}pose:{draw(SPACE)}\n"]
    for axis in draw(st.permutations(["x", "y", "yaw"])):
        pose += [f"  {step}{step}{axis}: ", (name, axis), f"{draw(SPACE)}\n"]
    angle: list[str | tuple[str, str]] = [f"  {step}angle:  ", (name, "angle"), f"{draw(SPACE)}\n"]
    first, second = draw(st.permutations([pose, angle]))
    return [f"  {name}:{draw(SPACE)}\n", *first, *second]


def nested(draw: st.DrawFn, name: str) -> list[str | tuple[str, str]]:
    pose = ["    pose: {x: ", (name, "x"), ", y: ", (name, "y"), ", yaw: ", (name, "yaw"), f"}}{draw(SPACE)}\n"]
    return [f"  '{name}':\n", *pose, '    "angle": ', (name, "angle"), "\n"]


@st.composite
def said(draw: st.DrawFn, key: str) -> tuple[Decimal, str]:
    """Draw a value, and how somebody wrote it."""
    top = {"x": 2000, "y": 2000, "yaw": 170, "angle": 179}[key]
    value = Decimal(draw(st.integers(2 if key == "angle" else 200 if key in "xy" else -170, top)))
    whole = {"x": ("mm", "cm", 10), "y": ("mm", "cm", 10), "yaw": ("deg", "deg", 1), "angle": ("deg", "deg", 1)}[key]
    small, large, ratio = whole
    texts = [f"{value}", f"{value}.0", f"{value}.00", f'"{value} {small}"', f"'{value / ratio} {large}'"]
    return value, draw(st.sampled_from(texts))


FAR = {"x": ("1", "300"), "y": ("1", "300"), "yaw": ("1", "170"), "angle": ("0.5", "80")}
NEAR = {"x": "0.2", "y": "0.2", "yaw": "0.3", "angle": "0.09"}


@st.composite
def moved(draw: st.DrawFn, key: str, value: Decimal, text: str) -> tuple[Decimal, str]:
    """Draw where a value is on the bench, and how the manifest must then have it: as it was where that is near."""
    steps = Decimal("0.001")
    if draw(st.integers(0, 2)):
        near = int(Decimal(NEAR[key]) / steps)
        return value + draw(st.integers(-near, near)) * steps, text
    low, high = (int(Decimal(end) / steps) for end in FAR[key])
    live = value + draw(st.integers(low, high)) * steps * draw(st.sampled_from([-1, 1]))
    kind = SETUP.type_of("c0")
    step = kind.tunables["angle"].resolution if key == "angle" else (
        kind.pose.resolution.yaw if key == "yaw" else kind.pose.resolution.position)  # fmt: skip
    unit = Decimal(str(step))
    live += steps if abs(live / unit % 1) == Decimal("0.5") else 0  # halfway, and either is right
    new = number((live / unit).quantize(Decimal(1)) * unit)
    pointed = "." in text and text.replace(".", "").lstrip("-").isdigit()
    return live, f"{new}.0" if pointed and "." not in new else new


@settings(deadline=None, max_examples=examples(40))
@given(st.data())
def test_only_what_left_its_tolerance_is_written_and_nothing_else(data: st.DataObject) -> None:
    layout = data.draw(files())
    drawn = {(n, k): data.draw(said(k)) for n in PARTS for k in FIELDS}
    lives = {key: data.draw(moved(key[1], *drawn[key])) for key in drawn}
    before = {path: written.text({k: text for k, (_, text) in drawn.items()}) for path, written in layout}
    wanted = load_files(before, setup=SETUP).require()[1]
    live = LabState(
        lab="bench",
        components={
            n: ComponentState(
                pose=Pose(*(float(lives[n, axis][0]) for axis in ("x", "y", "yaw"))),
                values={"angle": float(lives[n, "angle"][0])},
            )
            for n in PARTS
        },
    )
    after = {path: written.text({k: text for k, (_, text) in lives.items()}) for path, written in layout}
    expected = {path: text for path, text in after.items() if text != before[path]}
    assert capture(before, SETUP, wanted, live) == expected
    only = data.draw(st.sets(st.sampled_from([*PARTS, "c1.angle", "c2.pose"]), min_size=1))
    named = read_addresses(SETUP, only)
    chosen = {k: lives[k] if allowed(named, *k) else drawn[k] for k in drawn}
    after = {path: written.text({k: text for k, (_, text) in chosen.items()}) for path, written in layout}
    expected = {path: text for path, text in after.items() if text != before[path]}
    assert capture(before, SETUP, wanted, live, named) == expected


def allowed(named: dict[str, frozenset[str] | None], part: str, key: str) -> bool:
    return part in named and (named[part] is None or ("angle" if key == "angle" else "pose") in (named[part] or ()))
