"""A file of kind Devices: how a lab's instruments are wired, checked against the lab, and no part of its digest."""

from __future__ import annotations

import pytest

from pico.manifest.load import Manifests, load_files
from pico.model.wiring import Wired
from pico.resources import labs_dir

LAB = {str(p.name): p.read_bytes() for p in (labs_dir() / "shel").glob("lab.yaml")}
DEVICES = """\
apiVersion: pico/v1
kind: Devices
metadata: {lab: shel}
devices:
  p1_mount:
    of: p1
    driver: elliptec.rotator
    address: {port: /dev/ttyUSB0, bus: "2"}
    identity: {serial: "11400517"}
    limits: {angle: [0, 360]}
    map:
      angle: {property: angle}
safety_inputs:
  lid: {kind: door, device: p1_mount, heartbeat: 0.4}
"""


def read(text: str, more: str = "") -> Manifests:
    files = {**LAB, "devices.yaml": text.encode()} | ({"more.yaml": more.encode()} if more else {})
    return load_files(files)


def wrong(text: str, more: str = "") -> list[tuple[str, str, str]]:
    found = [d for d in read(text, more).diagnostics if d.code != "no-state"]
    return [(str(d.source), d.summary, d.hint) for d in found]


def test_devices_are_read_and_leave_the_digest_of_the_lab_as_it_is() -> None:
    setup, bare = read(DEVICES).setup, load_files(LAB).setup
    assert setup and bare and setup.wiring and bare.wiring is None
    assert setup.digest() == bare.digest()
    assert [*setup.wiring.of("p1")] == ["p1_mount"]
    assert setup.wiring.devices["p1_mount"].identity == {"serial": "11400517"}
    assert setup.wiring.safety_inputs["lid"].heartbeat == 0.4


@pytest.mark.parametrize(
    ("written", "instead", "place", "said", "hint"),
    [
        ("rotator", "rotatr", "7:13", "there is no driver `elliptec.rotatr`", "did you mean `elliptec.rotator`?"),
        ("of: p1", "of: pp1", "6:9", "the lab has no `pp1`", "did you mean `p1`?"),
        ("  angle: {", "  angl: {", "12:7", "p1 has no `angl`", "did you mean `angle`?"),
        ("property: angle", "property: angle, unit: mm", "12:38", "`mm` is of length, and angle is in deg, of angle",
         "say the unit of the device's number"),
        ("device: p1_mount", "device: p1_mounts", "14:29", "there is no device `p1_mounts`",
         "did you mean `p1_mount`?"),
        ("lab: shel", "lab: other", "3:17", "these are the devices of `other`, and the lab is `shel`",
         "write `metadata: {lab: shel}`"),
        ("[0, 360]", "[360, 0]", "10:21", "devices.p1_mount: the limits of `angle` are [least, greatest], not [360, 0]",
         "expected a list of 2, each a number"),
        ("identity:", "identiy:", "9:5", "unknown key `identiy` in devices.p1_mount", "did you mean `identity`?"),
        ("kind: door", "kind: shutter", "14:3", "lid does not say of which shutter it is", "add `of:`"),
    ],
)  # fmt: skip
def test_what_does_not_fit_the_lab_is_told_at_its_place(
    written: str, instead: str, place: str, said: str, hint: str
) -> None:
    assert wrong(DEVICES.replace(written, instead, 1)) == [(f"devices.yaml:{place}", said, hint)]


def test_a_device_is_given_once_however_many_files_there_are() -> None:
    more = DEVICES[: DEVICES.index("safety_inputs")]
    ((at, said, _),) = wrong(DEVICES, more)
    assert (at, said) == ("more.yaml:5:3", "p1_mount is given twice")
    other = more.replace("p1", "p2").replace('bus: "2"', 'bus: "3"').replace("11400517", "11400518")
    assert not wrong(DEVICES, other)


def test_numbers_go_to_the_device_and_back() -> None:
    plain, scaled = Wired(property="angle"), Wired(property="exposure", scale=0.5, offset=3.0, unit="us")
    assert plain.to_device(30.0, "deg") == plain.to_lab(30.0, "deg") == 30.0
    assert scaled.to_lab(10.0, "ms") == pytest.approx(0.008)
    assert scaled.to_device(0.008, "ms") == pytest.approx(10.0)
