"""A small bench that is right, and the many ways in which people and machines write it wrong."""

from __future__ import annotations

from collections.abc import Iterator

LAB = """\
apiVersion: pico/v1
kind: Lab
metadata:
  name: bench
  title: Two parts and a laser
table:
  size: [1200, 900]
  beam_height: 70
  holes: {pitch: 25, first: [12.5, 12.5]}
regions:
  storage: {area: {x: [60, 520], y: [90, 350]}}
slots:
  storage/a1: {x: 110, y: 310}
  storage/a2: {x: 200, y: 310, capture: 8}
robots:
  arm1:
    model: xarm7
    mount: {x: 480, y: 760, yaw: -90}
    gripper: {stroke: 84, fingers: {tip: 10}}
    transit_height: 250
    speed: 0.5
keep_out:
  shelf: {area: {x: [0, 100], y: [800, 900]}, z: [300, 500]}
datums:
  d0: {marker: 90, x: 20, y: 20}
inventory:
  laser: {type: hene_laser, pose: {x: 120, y: 420, yaw: 0}}
  p1:
    type: linear_polarizer
    marker: 1
    home: storage/a1
  p2:
    type: linear_polarizer
    marker: 2
    home: storage/a2
"""
STATE = """\
apiVersion: pico/v1
kind: LabState
metadata: {lab: bench}
components:
  laser:
    emission: true
    shutter: open
  p1:
    pose:
      x: 290
      y: 420
      yaw: 0
    angle: 90.0
  p2:
    slot: storage/a2
    angle: 1
expect:
  - {that: "p1.angle > 0", message: no light}
"""
OWN_TYPE = """\
apiVersion: pico/v1
kind: ComponentType
metadata: {name: own_lens, title: A lens of our own}
tunables:
  focus: {unit: mm, range: [0, 25], tolerance: 0.1}
  mode: {datatype: choice, choices: [wide, tele]}
pose: {tolerance: {position: 0.5, yaw: 0.5}}
geometry:
  footprint: {box: [60, 60]}
  height: 140
  mass: 0.3
  bodies:
    - {name: base, shape: box, size: [60, 60, 12], at: [0, 0, 6]}
  grasp: {height: 100, width: 30, yaws: [0, 90]}
  clear_aperture: {center: [0, 0, 70], diameter: 22}
frames: {optical: [0, 0, 70]}
optics: {element: lens}
repeatability: {position: 0.1, yaw: 0.05}
primitives: [move, stow, set]
"""
USES_OWN = LAB.replace("inventory:\n", "inventory:\n  lens: {type: own_lens, pose: {x: 700, y: 420}}\n")
GOOD = {"lab.yaml": LAB.encode(), "state/table.yaml": STATE.encode()}
Case = tuple[str, dict[str, bytes]]


def malformed() -> list[Case]:
    """Return every malformed lab: a name, and its files."""
    cases = [
        *_raw(),
        *_quantities(),
        *_edits("lab.yaml", LAB, LAB_EDITS),
        *_edits("state/table.yaml", STATE, STATE_EDITS),
    ]
    uses = {"lab.yaml": USES_OWN.encode()}
    cases += [(name, files | uses) for name, files in _edits("own.yaml", OWN_TYPE, TYPE_EDITS)]
    return [*cases, *_several_files()]


def _edits(path: str, text: str, edits: tuple[tuple[str, str], ...]) -> Iterator[Case]:
    for i, (old, new) in enumerate(edits):
        assert text.count(old) >= 1, old
        yield (
            f"{path} {i}: {old.strip()[:25]!r} to {new.strip()[:25]!r}",
            GOOD | {path: text.replace(old, new, 1).encode()},
        )


# Each number of the samples becomes each of these; none is a length, an angle or a plain number.
_NOT_NUMBERS = (
    "2 kg",
    "abc",
    "[]",
    "{}",
    "true",
    "~",
    ".nan",
    ".inf",
    "1e999",
    "'12'",
    "[1, 2]",
    "12 mmm",
    "0x",
    "1,5",
    "--1",
)
_STATE_NUMBERS = ("x: 290", "y: 420", "yaw: 0", "angle: 90.0")
_LAB_NUMBERS = ("beam_height: 70", "x: 110", "transit_height: 250", "stroke: 84", "tip: 10")


def _quantities() -> Iterator[Case]:
    for path, text, numbers in (("state/table.yaml", STATE, _STATE_NUMBERS), ("lab.yaml", LAB, _LAB_NUMBERS)):
        for number in numbers:
            key = number.split(":")[0]
            for wrong in _NOT_NUMBERS:
                bad = text.replace(number, f"{key}: {wrong}", 1)
                yield f"{path} {key}: {wrong}", GOOD | {path: bad.encode()}


def _raw() -> Iterator[Case]:
    for path, text in (("state/table.yaml", STATE), ("lab.yaml", LAB)):
        for name, data in {**BYTES, **{n: (text + t).encode() for n, t in APPENDED.items()}}.items():
            yield f"{path} is {name}", GOOD | {path: data}
        for cut in range(40, len(text), 97):
            broken = text[:cut] + "\n\t: [}" + text[cut:]
            yield f"{path} broken at {cut}", GOOD | {path: broken.encode()}


def _several_files() -> Iterator[Case]:
    second = "apiVersion: pico/v1\nkind: LabState\nmetadata: {lab: bench}\ncomponents:\n  p1: {slot: storage/a1}\n"
    yield "a component in two files", GOOD | {"state/b.yaml": second.encode()}
    yield (
        "two in one slot over two files",
        {
            "lab.yaml": LAB.encode(),
            "state/a.yaml": second.encode(),
            "state/b.yaml": second.replace("p1:", "p2:").encode(),
        },
    )
    yield "two labs", GOOD | {"other.yaml": LAB.encode()}
    yield "no lab", {"state/table.yaml": STATE.encode()}
    yield "no state", {"lab.yaml": LAB.encode()}
    yield "a type of the catalog again", GOOD | {"t.yaml": OWN_TYPE.replace("own_lens", "linear_polarizer").encode()}
    yield "a type twice", GOOD | {"t.yaml": OWN_TYPE.encode(), "u.yaml": OWN_TYPE.encode()}


_HEAD = b"apiVersion: pico/v1\nkind: LabState\nmetadata: {lab: bench}\ncomponents:\n"
BYTES: dict[str, bytes] = {
    "empty": b"",
    "white space": b" \n\n  \n",
    "comments": b"# nothing here yet\n# and here\n",
    "a lone document mark": b"---\n...\n",
    "NUL": b"apiVersion: pico/v1\0\n",
    "random bytes": bytes((i * 73 + 41) % 256 for i in range(4000)),
    "a PNG": b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR" + bytes(64),
    "Latin-1": "apiVersion: pico/v1 # Größe".encode("latin-1"),
    "a lone continuation byte": b"apiVersion: pico/v1\nkind: \x80\n",
    "a cut UTF-8 sequence": b"apiVersion: pico/v1\nkind: \xe2\x82",
    "an encoded surrogate": b"a: \xed\xa0\x80\n",
    "UTF-16": STATE.encode("utf-16"),
    "UTF-16 without mark": STATE.encode("utf-16-le"),
    "UTF-32": STATE.encode("utf-32"),
    "an escape character": b"a: \x1b[31mred\n",
    "a bell": b"a: \x07\n",
    "a BOM in the middle": "a: \ufeff1\n".encode(),
    "a list": b"- a\n- b\n",
    "a word": b"hello\n",
    "a number": b"42\n",
    "JSON that is cut": b'{"apiVersion": "pico/v1", "kind": "LabState", "metad',
    "50,000 brackets": b"[" * 50_000,
    "50,000 braces": b"{a: " * 50_000,
    "closed brackets": b"[" * 20_000 + b"]" * 20_000,
    "50,000 dashes": b"- " * 50_000,
    "50,000 question marks": b"? " * 50_000,
    "a staircase": b"".join(b" " * i + b"a:\n" for i in range(600)),
    "brackets in a component": _HEAD + b"  p1: " + b"[" * 50_000,
    "a billion laughs": b"a: &a [x, x]\nb: &b [*a, *a]\nc: &c [*b, *b]\nd: [*c, *c]\n",
    "an alias of itself": b"a: &a [*a]\n",
    "an anchor": _HEAD + b"  p1: &p {slot: storage/a1}\n",
    "a merge key": _HEAD + b"  p1:\n    <<: {slot: storage/a1}\n",
    "an unknown alias": b"a: *nobody\n",
    "a Python object": b"a: !!python/object/apply:os.system [echo]\n",
    "a local tag": _HEAD + b"  p1: !part {slot: storage/a1}\n",
    "a binary tag": b"a: !!binary aGVsbG8=\n",
    "a timestamp tag": b"a: !!timestamp 2026-01-01\n",
    "a tag that lies": b"a: !!int abc\n",
    "an unknown tag handle": b"a: !x!y z\n",
    "3 MB": b"# " + b"x" * 3_000_000,
    "3 MB of components": _HEAD + b"".join(b"  c%06d: {slot: storage/a1}\n" % i for i in range(100_000)),
    "200,000 values": b"a: [" + b"1," * 200_000 + b"1]\n",
    "a line of 1 MB": b"a: '" + b"x" * 1_000_000,
    "100,000 directives": b"%TAG !a! tag:a\n" * 100_000 + b"--- a\n",
    "many tag handles": b"".join(b"%%TAG !a%d! tag:a\n" % i for i in range(80_000)) + b"--- a\n",
    "YAML 3": b"%YAML 3.0\n---\na: 1\n",
    "a huge number": _HEAD + b"  p1: {pose: {x: " + b"9" * 100_000 + b", y: 1}, angle: 1}\n",
    "a huge exponent": _HEAD + b"  p1: {pose: {x: 1e99999999, y: 1}, angle: 1}\n",
    "a bomb in a unit": _HEAD + b"  p1: {pose: {x: 2 m**9**9**9**9, y: 1}, angle: 1}\n",
    "a long unit": _HEAD + b"  p1: {pose: {x: 2 " + b"m*" * 20_000 + b"m, y: 1}, angle: 1}\n",
    "a huge hexadecimal": _HEAD + b"  p1: {pose: {x: 0x" + b"f" * 10_000 + b", y: 1}}\n",
    "a key of 100 kB": _HEAD + b"  ? " + b"k" * 100_000 + b"\n  : {slot: storage/a1}\n",
    "a list as a key": b"[a, b]: c\n",
    "a mapping as a key": b"{a: b}: c\n",
    "a block key": b"? a: b\n: c\n",
    "another version": b"apiVersion: pico/v2\nkind: LabState\nmetadata: {lab: bench}\n",
    "without a kind": b"apiVersion: pico/v1\nmetadata: {lab: bench}\n",
    "of an unknown kind": b"apiVersion: pico/v1\nkind: LabStat\nmetadata: {lab: bench}\n",
    "of a kind that is a list": b"apiVersion: pico/v1\nkind: [LabState]\nmetadata: {lab: bench}\n",
    "without apiVersion": b"kind: LabState\nmetadata: {lab: bench}\n",
    "of a misspelt apiVersion": b"apiVersoin: pico/v1\nkind: LabState\nmetadata: {lab: bench}\n",
    "of a wrong apiVersion": b"apiVersion: v1\nkind: LabState\nmetadata: {lab: bench}\n",
    "without metadata": b"apiVersion: pico/v1\nkind: LabState\n",
    "with a list as metadata": b"apiVersion: pico/v1\nkind: LabState\nmetadata: [bench]\n",
}
APPENDED: dict[str, str] = {
    "followed by a tab": "\tx: 1\n",
    "followed by an open quote": "note: 'never closed\n",
    "followed by an open double quote": 'note: "never closed\n',
    "followed by an open list": "note: [1, 2\n",
    "followed by an open mapping": "note: {a: 1\n",
    "followed by a bad escape": 'note: "\\q"\n',
    "followed by a key without colon": "note\n",
    "followed by a deeper key": "   note: 1\n",
    "followed by two colons": "note: a: b\n",
    "followed by an at sign": "note: @home\n",
    "followed by a backtick": "note: `x`\n",
    "followed by a per cent": "note: %x\n",
    "followed by a stray bracket": "note: ]\n",
    "followed by a dash": "- note\n",
    "followed by an unknown key": "note: 1\n",
    "followed by a key again": "kind: Lab\n",
    "followed by metadata again": "metadata: {name: other}\n",
    "followed by an empty key": ": 1\n",
    "followed by a word": "...\nword\n",
    "followed by a list document": "---\n- 1\n",
}
LAB_EDITS: tuple[tuple[str, str], ...] = (
    ("name: bench", "name: Bench"),
    ("name: bench", "name: ''"),
    ("name: bench", "name: [bench]"),
    ("name: bench", "nam: bench"),
    ("title: Two", "titel: Two"),
    ("table:", "tabel:"),
    ("size: [1200, 900]", "size: [1200]"),
    ("size: [1200, 900]", "size: [1200, 900, 5]"),
    ("size: [1200, 900]", "size: 1200 x 900"),
    ("size: [1200, 900]", "size: [-1200, 900]"),
    ("size: [1200, 900]", "size: {x: 1200, y: 900}"),
    ("size: [1200, 900]", "size: [1200, 2 s]"),
    ("beam_height: 70", "beam_height: 75"),
    ("beam_height: 70", "beam_height: -70"),
    ("beam_height: 70", "beam_hight: 70"),
    ("pitch: 25", "pitch: 0"),
    ("area: {x: [60, 520], y: [90, 350]}", "area: {x: [520, 60], y: [90, 350]}"),
    ("area: {x: [60, 520], y: [90, 350]}", "area: {x: [60, 520]}"),
    ("area: {x: [60, 520], y: [90, 350]}", "area: [60, 520]"),
    ("storage/a1: {x: 110, y: 310}", "storage/a1: {x: 110}"),
    ("storage/a1: {x: 110, y: 310}", "storage/a1: {x: 2110, y: 310}"),
    ("storage/a1: {x: 110, y: 310}", "storage/a1: {x: 110, y: -5}"),
    ("storage/a1: {x: 110, y: 310}", "Storage/A1: {x: 110, y: 310}"),
    ("storage/a1: {x: 110, y: 310}", "storage//a1: {x: 110, y: 310}"),
    ("storage/a1: {x: 110, y: 310}", "storage/a1: {x: 110, y: 310, fits: 20}"),
    ("storage/a1: {x: 110, y: 310}", "storage/a1: {x: 110, y: 310, capture: -1}"),
    ("storage/a1: {x: 110, y: 310}", "storage/a1: [110, 310]"),
    ("storage/a2:", "storage/a1:"),
    ("model: xarm7", "model: xarm6"),
    ("model: xarm7", "model: 7"),
    ("mount: {x: 480, y: 760, yaw: -90}", "mount: {x: 480}"),
    ("mount: {x: 480, y: 760, yaw: -90}", "mount: {x: 480, y: 760, yaw: south}"),
    ("gripper: {stroke: 84, fingers: {tip: 10}}", "gripper: {stroke: 40}"),
    ("gripper: {stroke: 84, fingers: {tip: 10}}", "gripper: {fingers: nothing}"),
    ("gripper: {stroke: 84, fingers: {tip: 10}}", "gripper: {fingers: {tipp: 10}}"),
    ("gripper: {stroke: 84, fingers: {tip: 10}}", "gripper: {fingers: {tip: 40}}"),
    ("gripper: {stroke: 84, fingers: {tip: 10}}", "gripper: {fingers: 3}"),
    ("speed: 0.5", "speed: 5"),
    ("speed: 0.5", "speed: 0"),
    ("speed: 0.5", "speed: fast"),
    ("speed: 0.5", "tool_speed: 1001"),
    ("speed: 0.5", "tool_speed: 0"),
    ("speed: 0.5", "park: [0, 1, two]"),
    ("speed: 0.5", "park: 7"),
    ("z: [300, 500]", "z: [500, 300]"),
    ("keep_out:", "keepout:"),
    ("shelf:", "Shelf:"),
    ("marker: 90", "marker: 1"),
    ("marker: 90", "marker: 9.5"),
    ("d0: {marker: 90, x: 20, y: 20}", "d0: {marker: 90, x: 20}"),
    ("d0: {marker: 90, x: 20, y: 20}", "d0: {marker: 90, x: 20, y: 2000}"),
    ("type: hene_laser", "type: hene_lazer"),
    ("type: hene_laser", "type: spectrometer_of_unknown_make"),
    ("type: hene_laser", "type: 3"),
    ("type: hene_laser", "typ: hene_laser"),
    ("pose: {x: 120, y: 420, yaw: 0}", "pose: {x: 120}"),
    ("pose: {x: 120, y: 420, yaw: 0}", "pose: {x: 120, y: 420, z: 0}"),
    ("pose: {x: 120, y: 420, yaw: 0}", "pose: {x: 1201, y: 420}"),
    ("pose: {x: 120, y: 420, yaw: 0}", "pose: [120, 420, 0]"),
    ("pose: {x: 120, y: 420, yaw: 0}", "home: storage/a1"),
    ("marker: 1", "marker: 2"),
    ("marker: 1", "marker: one"),
    ("marker: 1", "marker: -1"),
    ("marker: 1", "marker: '1'"),
    ("home: storage/a1", "home: storage/a3"),
    ("home: storage/a1", "home: storage/a2"),
    ("home: storage/a1", "home: [storage/a1]"),
    ("home: storage/a1", "pose: {x: 1, y: 1}\n    home: storage/a1"),
    ("home: storage/a1", "seating: glued"),
    ("home: storage/a1", "home: storage/a1\n    stage: sometimes"),
    ("home: storage/a1", "home: storage/a1\n    tether: {length: 500}"),
    ("home: storage/a1", "home: storage/a1\n    calibration: {offset: large}"),
    ("home: storage/a1", "home: storage/a1\n    serial: 1234"),
    ("  p2:\n", "  P2:\n"),
    ("  p2:\n", "  p1:\n"),
    ("  p2:\n", "  2p:\n"),
    ("  p2:\n", "  p 2:\n"),
    ("inventory:", "inventory: []\nparts:"),
    ("robots:", "robots: ~\nrobot:"),
    ("metadata:\n", "name: bench\nmetadata:\n"),
)
STATE_EDITS: tuple[tuple[str, str], ...] = (
    ("lab: bench", "lab: shel"),
    ("lab: bench", "lab: ~"),
    ("lab: bench", "lab: [bench]"),
    ("lab: bench", "name: bench"),
    ("lab: bench", "lab: bench, name: x"),
    ("components:", "component:"),
    ("components:", "components: []\nparts:"),
    ("components:", "components: 3\nparts:"),
    ("  p1:\n", "  p3:\n"),
    ("  p1:\n", "  P1:\n"),
    ("  p1:\n", "  p2:\n"),
    ("  p1:\n", "  polarizer one:\n"),
    ("  p1:\n", "  ''  :\n"),
    ("emission: true", "emission: on"),
    ("emission: true", "emission: yes"),
    ("emission: true", "emission: 1"),
    ("emission: true", "emission: 'true'"),
    ("emission: true", "emission: ~"),
    ("emission: true", "emision: true"),
    ("emission: true", "emission: {on: true}"),
    ("shutter: open", "shutter: ajar"),
    ("shutter: open", "shutter: true"),
    ("shutter: open", "shutter: Open"),
    ("shutter: open", "shutter: [open]"),
    ("shutter: open", "shutter: ~"),
    ("shutter: open", "slot: storage/a1"),
    ("angle: 90.0", "angle: 900"),
    ("angle: 90.0", "angle: -361"),
    ("angle: 90.0", "angle: 90 mm"),
    ("angle: 90.0", "angle: 70 rad"),
    ("angle: 90.0", "angle: 90 furlongs"),
    ("angle: 90.0", "angle: 90 90"),
    ("angle: 90.0", "angle: 12:30:45"),
    ("angle: 90.0", "angel: 90"),
    ("angle: 90.0", "power: 5"),
    ("angle: 90.0", "angle:"),
    ("x: 290", "x: 2900"),
    ("x: 290", "x: -1"),
    ("x: 290", "x: 2.9 m"),
    ("x: 290\n", "z: 290\n"),
    ("y: 420\n", "why: 420\n"),
    ("yaw: 0", "roll: 0"),
    ("yaw: 0", "x: 0"),
    ("    pose:\n      x: 290\n      y: 420\n      yaw: 0\n", ""),
    ("    pose:\n      x: 290\n      y: 420\n      yaw: 0\n", "    pose: [290, 420, 0]\n"),
    ("    pose:\n      x: 290\n      y: 420\n      yaw: 0\n", "    pose: storage/a1\n"),
    ("    pose:\n      x: 290\n      y: 420\n      yaw: 0\n", "    pose:\n"),
    ("    pose:\n      x: 290\n      y: 420\n      yaw: 0\n", "    pose: {}\n"),
    ("    pose:\n      x: 290\n      y: 420\n      yaw: 0\n", "    slot: storage/a2\n"),
    ("slot: storage/a2", "slot: storage/a3"),
    ("slot: storage/a2", "slot: ~"),
    ("slot: storage/a2", "slot: {x: 1, y: 2}"),
    ("slot: storage/a2", "slot: storage"),
    ("slot: storage/a2", "slot: storage/a2\n    pose: {x: 1, y: 2}"),
    ("  p2:\n    slot: storage/a2\n", "  p2:\n    slot: storage/a1\n  p1_:\n"),
    ("    slot: storage/a2\n    angle: 1\n", ""),
    ("  p2:\n    slot: storage/a2\n    angle: 1\n", "  p2: storage/a2\n"),
    ("  p2:\n    slot: storage/a2\n    angle: 1\n", "  p2: [storage/a2]\n"),
    ('  - {that: "p1.angle > 0", message: no light}', "  that: x"),
    ('  - {that: "p1.angle > 0", message: no light}', "  - p1.angle > 0"),
    ('  - {that: "p1.angle > 0", message: no light}', "  - {message: x}"),
    ('  - {that: "p1.angle > 0", message: no light}', "  - {that: 3}"),
    ('  - {that: "p1.angle > 0", message: no light}', "  - {that: ''}"),
    ('  - {that: "p1.angle > 0", message: no light}', "  - {that: a, mesage: b}"),
    ('  - {that: "p1.angle > 0", message: no light}', "  - {that: a, message: [b]}"),
    ("expect:", "expects:"),
)
TYPE_EDITS: tuple[tuple[str, str], ...] = (
    ("name: own_lens", "name: OwnLens"),
    ("title: A lens of our own", "titel: A lens"),
    ("range: [0, 25]", "range: [25, 0]"),
    ("range: [0, 25]", "range: 25"),
    ("range: [0, 25]", "range: [0, true]"),
    ("tolerance: 0.1", "tolerance: -0.1"),
    ("focus:", "pose:"),
    ("focus:", "Focus:"),
    ("datatype: choice", "datatype: enum"),
    ("choices: [wide, tele]", "choices: []"),
    ("choices: [wide, tele]", "choices: wide"),
    ("choices: [wide, tele]", "choices: [wide, tele], initial: macro"),
    ("tolerance: 0.1", "initial: 26"),
    ("tolerance: 0.1", "initial: 1 mm"),
    ("tolerance: 0.1", "initial: [1]"),
    ("position: 0.5", "position: 0.1"),
    ("yaw: 0.5}", "yaw: 0.01}"),
    ("footprint: {box: [60, 60]}", "footprint: {box: [60, 60], disc: 30}"),
    ("footprint: {box: [60, 60]}", "footprint: {box: [60, -60]}"),
    ("footprint: {box: [60, 60]}", "footprint: {polygon: [[0, 0], [0, 10], [10, 0]]}"),
    ("footprint: {box: [60, 60]}", "footprint: {polygon: [[0, 0], [1, 1]]}"),
    ("footprint: {box: [60, 60]}", "footprint: {}"),
    ("footprint: {box: [60, 60]}", "footprint: {box: [40, 40]}"),
    ("footprint: {box: [60, 60]}", "footprint: {box: [6000, 60]}"),
    ("height: 140", "height: 0"),
    ("height: 140", "height: 80"),
    ("mass: 0.3", "mass: 3 mm"),
    ("mass: 0.3", "mass: -3"),
    ("shape: box", "shape: sphere"),
    ("size: [60, 60, 12]", "size: [60, 60]"),
    ("optical: [0, 0, 70]", "optical: [0, 0, 71]"),
    ("element: lens", "element: lenses"),
    ("grasp: {height: 100, width: 30, yaws: [0, 90]}", "grasp: {width: 30}"),
    ("grasp: {height: 100, width: 30, yaws: [0, 90]}", "grasp: {height: 100, width: 30, yaws: []}"),
    ("geometry:\n", "geometri:\n"),
    ("unit: mm, range", "unit: mmm, range"),
)
