"""What can't be right about a device in a file of kind Devices: its address, identity, settings, properties, units."""

from __future__ import annotations

import pytest

from pico.manifest.load import load_files
from pico.resources import labs_dir

LAB = {"lab.yaml": (labs_dir() / "shel" / "lab.yaml").read_bytes()}
HEAD = "apiVersion: pico/v1\nkind: Devices\nmetadata: {lab: shel}\ndevices:\n"
P1 = """\
  p1_mount:
    of: p1
    driver: elliptec.rotator
    address: {port: /dev/ttyUSB0, bus: "1"}
    identity: {serial: "11400001"}
    map: {angle: {property: angle}}
"""
STAGE = """\
  y_stage:
    of: ly_150
    driver: zaber.stage
    address: {port: /dev/ttyUSB1, device: 2}
    identity: {serial: "52001"}
    settings: {counts_per_unit: 20997.375}
    map: {stage_y: {property: position}}
"""
BOX = """\
  shutter_box:
    of: laser
    driver: switches.shutter
    address: {host: 10.0.0.7, port: 4000, name: shutter}
    identity: {serial: "7"}
  laser_box:
    of: laser
    driver: switches.laser
    address: {host: 10.0.0.7, port: 4000, name: laser}
    identity: {serial: "7"}
"""
METER = """\
  meter:
    driver: scpi.meter
    address: {visa: "TCPIP0::10.0.0.9::5025::SOCKET"}
    identity: {serial: P001}
    settings: {timeout: 3}
"""
ARM = """\
  arm1:
    driver: xarm.arm
    address: {host: 10.0.0.2}
  arm1_hand:
    driver: xarm.gripper
    of: arm1
    address: {host: 10.0.0.2}
"""
ALL = HEAD + P1 + STAGE + BOX + METER + ARM


def wrong(text: str) -> list[tuple[str, str, str]]:
    found = load_files({**LAB, "devices.yaml": text.encode()}).diagnostics
    return [(str(d.source), d.summary, d.hint) for d in found if d.code != "no-state"]


def only(text: str) -> tuple[str, str, str]:
    (found,) = wrong(text)
    return found


def line(text: str, of: str) -> int:
    return text[: text.index(of)].count("\n") + 1


def test_devices_that_fit_are_accepted() -> None:
    assert wrong(ALL) == []


@pytest.mark.parametrize(("text", "first"), [
    (P1, P1), (P1.replace('"1"', "1"), P1), (P1.replace('bus: "1"', 'bus: "a"'), P1.replace('bus: "1"', 'bus: "A"')),
    (P1.replace(', bus: "1"', ""), P1.replace('"1"', '"0"')), (STAGE.replace("y_stage", "other"), STAGE),
    (STAGE.replace("device: 2", "device: 1"), STAGE.replace(", device: 2", "")),
    (BOX[: BOX.index("  laser_box")], BOX[: BOX.index("  laser_box")]), (METER, METER),
    (METER.replace("TCPIP0", "tcpip"), METER),
])  # fmt: skip
def test_two_devices_at_one_address_are_refused(text: str, first: str) -> None:
    name = text.split(":", maxsplit=1)[0].strip()
    again = text.replace(name, "z_again", 1).replace("serial: ", "serial: Z").replace('Z"', '"Z')
    whole = HEAD + first + again
    said = [(at, one) for at, one, _ in wrong(whole) if " is at " in one]
    assert len(said) == 1 and said[0][1].startswith("z_again is at ") and ", where " in said[0][1]
    assert said[0][0].startswith(f"devices.yaml:{line(whole, 'z_again') + (3 if 'of:' in text else 2)}:")


def test_two_drivers_that_cannot_share_a_link_are_refused_on_one_port() -> None:
    at, said, hint = only(HEAD + P1 + STAGE.replace("ttyUSB1", "ttyUSB0"))
    assert said == "y_stage (zaber.stage) is at /dev/ttyUSB0, where p1_mount (elliptec.rotator) is"
    assert "address" in hint and at.startswith("devices.yaml:14:")
    over = METER.replace("meter", "line", 1).replace("TCPIP0::10.0.0.9::5025::SOCKET", "ASRL/dev/ttyUSB0::INSTR")
    assert "where p1_mount" in only(HEAD + P1 + over)[1]
    laser = METER.replace("meter", "source", 1).replace("scpi.meter", "scpi.laser").replace("P001", "P002")
    assert "where meter (scpi.meter) is" in only(HEAD + METER + laser)[1]


def test_one_relay_is_of_one_device_and_contacts_may_be_read_by_several() -> None:
    box = """\
  shut:
    driver: scpi.shutter
    of: laser
    address: {visa: "TCPIP0::10.0.0.8::5025::SOCKET", relay: 1, channel: 3}
  shut_sensor:
    driver: scpi.safety
    address: {visa: "TCPIP0::10.0.0.8::5025::SOCKET", channel: 3}
"""
    assert wrong(HEAD + box) == []
    lamp = box[: box.index("  shut_sensor")].replace("shut:", "lamp:").replace("scpi.shutter", "scpi.lamp")
    lamp = lamp.replace(", channel: 3", "") + "    map: {emission: {property: on}}\n"
    assert any("relay 1, where shut is" in said for _, said, _ in wrong(HEAD + box + lamp))


def test_a_laser_is_not_switched_as_a_lamp() -> None:
    text = HEAD + BOX[BOX.index("  laser_box") :].replace("switches.laser", "switches.lamp")
    at, said, hint = only(text + "    map: {emission: {property: on}}\n")
    assert said == "laser.emission lets light out, and the guard of light can't end it through a lamp"
    assert at.startswith("devices.yaml:10:") and "`scpi.laser`, `switches.laser`" in hint


def test_a_lamp_may_be_a_source_of_class_1() -> None:
    lab = LAB["lab.yaml"].replace(b"type: hene_laser_expanded", b"type: white_light_source")
    text = HEAD + BOX[BOX.index("  laser_box") :].replace("switches.laser", "switches.lamp")
    text += "    map: {emission: {property: on}}\n"
    found = load_files({"lab.yaml": lab, "devices.yaml": text.encode()}).diagnostics
    assert lab != LAB["lab.yaml"] and not [d for d in found if "lets light out" in d.summary]


def test_a_serial_number_is_of_one_device() -> None:
    other = P1.replace("p1", "p2").replace('bus: "1"', 'bus: "2"')
    at, said, _ = only(HEAD + P1 + other)
    assert (at, said) == ("devices.yaml:15:24", "p2_mount has the serial number 11400001 of p1_mount")


def test_who_shares_a_line_has_an_identity() -> None:
    other = P1.replace("p1", "p2").replace('bus: "1"', 'bus: "2"').replace('    identity: {serial: "11400001"}\n', "")
    at, said, hint = only(HEAD + P1 + other)
    assert at == "devices.yaml:11:3" and said.startswith("p2_mount shares /dev/ttyUSB0 with p1_mount, and has no")
    assert "pico devices identify p2_mount" in hint
    assert wrong(HEAD + other) == []  # it is alone


@pytest.mark.parametrize(("written", "instead", "at", "said", "hint"), [
    ("property: position", "property: positon", "17:31", "y_stage: `zaber.stage` has no property `positon`",
     "did you mean `position`? it has `position`"),
    ("{property: angle}", "{property: power}", "10:29", "p1_mount: `elliptec.rotator` has no property `power`",
     "it has `angle`"),
    ("{counts_per_unit: 20997.375}", "{counts_per_unt: 20997.375, counts_per_unit: 1.0}", "16:16",
     "y_stage: `zaber.stage` has no setting `counts_per_unt`",
     "did you mean `counts_per_unit`? it has `counts_per_unit`, `emulated_speed`, `unit`"),
    ("    settings: {counts_per_unit: 20997.375}\n", "", "13:13",
     "y_stage: `zaber.stage` needs the setting `counts_per_unit`",
     "`settings: {counts_per_unit: ...}`: counts a mm or a degree: 1 / the microstep size on the vendor's page"),
    ("timeout: 3", "timeout: 60", "32:25", "meter: `timeout` is 0.05 to 4.5 s, not 60", "how long one reply may take"),
    ("timeout: 3", "timeout: soon", "32:25", "meter: `timeout` is a number, not `soon`", "how long one reply may take"),
    ("timeout: 3", "baud_rate: 9600", "32:27",
     "meter: `baud_rate` does nothing: `TCPIP0::10.0.0.9::5025::SOCKET` is no serial line",
     "delete it, or write the address of a serial line, `ASRL...::INSTR`"),
    ("device: 2", "devic: 2", "14:35", "y_stage: `zaber.stage` has no `devic` in its address",
     "did you mean `device`? it has `axis`, `device`, `host`, `port`"),
    ('bus: "1"', 'bus: "G"', "8:40", "p1_mount: `G` is no address on the line", "it is `0` to `F`"),
    ('{serial: "11400001"}', '{serial: "11400001", model: ELL17}', "7:13", "p1_mount: an ELL17 is not a rotation mount",
     "write `driver: elliptec.stage`"),
    ("{property: position}", "{property: position, scale: -1, unit: um}", None, "", ""),
    ("{property: position}", "{property: position, scale: -1}", None, "", ""),
])  # fmt: skip
def test_what_a_driver_does_not_take_is_refused_at_its_place(
    written: str, instead: str, at: str | None, said: str, hint: str
) -> None:
    found = wrong(ALL.replace(written, instead, 1))
    assert found == ([] if at is None else [(f"devices.yaml:{at}", said, hint)])


def test_a_linear_stage_is_no_rotator() -> None:
    text = HEAD + STAGE.replace("ly_150", "p1").replace("stage_y", "angle")
    _, said, hint = only(text)
    assert said == "p1.angle is in deg, of angle, and position of zaber.stage in mm, of length"
    assert hint.startswith("choose a driver of a rotation mount or of a linear stage")
    assert only(text.replace("{property: position}", "{property: position, scale: 2}"))[1] == said
    assert only(text.replace("{property: position}", "{property: position, unit: deg}"))[1] == said
    assert wrong(text.replace("{property: position}", "{property: position, scale: 2, unit: deg}")) == []
    turns = text.replace("settings: {", "settings: {unit: deg, ")
    assert wrong(turns) == []
    mount = HEAD + P1.replace("of: p1", "of: ly_150").replace("map: {angle:", "map: {stage_y:")
    assert "of length, and angle of elliptec.rotator in deg, of angle" in only(mount)[1]


def test_a_scale_between_two_units_says_which_it_leads_to() -> None:
    lab = (labs_dir() / "mach_zehnder" / "lab.yaml").read_bytes()
    text = (
        HEAD.replace("shel", "mach_zehnder") + METER + "    of: meter\n    map: {power: {property: power, scale: 2}}\n"
    )

    def of_scale(text: str) -> list[str]:
        found = load_files({"lab.yaml": lab, "devices.yaml": text.encode()}).diagnostics
        return [one.summary for one in found if one.code != "no-state"]

    assert of_scale(text) == [
        "meter.power is in mW, power of scpi.meter in W, and it is not stated which of them `scale` leads to"
    ]
    assert of_scale(text.replace("scale: 2", "scale: 2, unit: W")) == []
    assert of_scale(text.replace(", scale: 2", "")) == []


def test_a_plug_ins_driver_that_declares_no_settings_takes_any() -> None:
    from pico.drivers.driver import Driver
    from pico.drivers.registry import driver
    from pico.model.wiring import DeviceEntry

    plain = Driver(
        kind="axis", made=driver("zaber.stage").made, opened=lambda entry: None, closed=lambda link: None,
        address={"port": "its port"}, bus=("port",),
    )  # fmt: skip
    assert [*plain.complaints(DeviceEntry(driver="own", address={"port": "x"}, settings={"any": 1}))] == []


def test_a_kind_whose_usual_tunable_the_part_lacks_needs_a_map() -> None:
    at, said, hint = only(HEAD + BOX[: BOX.index("  laser_box")].replace("of: laser", "of: p1"))
    assert said == "p1 has no `shutter`, which a shutter is if the lab has no `map`"
    assert at.startswith("devices.yaml:7:") and "map: {NAME: {property: open}}" in hint


def test_a_heartbeat_is_no_longer_than_a_lost_link_may_keep_light_on() -> None:
    box = BOX[BOX.index("  laser_box") :].replace("laser_box", "door_box").replace("switches.laser", "switches.input")
    text = (
        HEAD
        + box.replace("    of: laser\n", "")
        + "safety_inputs:\n  door: {kind: door, device: door_box, heartbeat: %s}\n"
    )
    assert wrong(text % "1.0") == []
    at, said, _ = only(text % "1.5")
    assert "the `heartbeat` of door is 1.5 s" in said and at.startswith("devices.yaml:10:")


GANTRY = """\
  arm1:
    driver: zaber.gantry
    address: {host: 10.0.0.3, port: 55550}
    identity: {serial: "52001"}
    settings: {counts_per_mm: 2000, counts_per_deg: 1000}
"""
SHUTTER = BOX.split("  laser_box", maxsplit=1)[0]
RELAY = """\
  box:
    of: laser
    driver: scpi.shutter
    address: {visa: "TCPIP0::10.0.0.8::5025::SOCKET", relay: 1}
"""


@pytest.mark.parametrize(("written", "instead", "said"), [
    ("port: 55550}", "port: 55550, y: 1}", "arm1: `y` and `x` are both the stage 1 of the chain"),
    ("port: 55550}", "port: 55550, x: 3}", "arm1: `z` and `x` are both the stage 3 of the chain"),
    ("port: 55550}", "port: 55550, y: two}", "arm1: `y` is a whole number from 1 to 99, not `two`"),
    ("port: 55550}", "port: 55550, y: -1}", "arm1: `y` is a whole number from 1 to 99, not `-1`"),
    ("port: 55550}", "port: 70000}", "arm1: `port` is a whole number from 1 to 65535, not `70000`"),
    ("10.0.0.3", "10.0.0.03", "arm1: `10.0.0.03` is no IP address"),
    ("10.0.0.3", "10.0.0.300", "arm1: `10.0.0.300` is no IP address"),
    ("counts_per_mm: 2000", "counts_per_mm: 0", "arm1: `counts_per_mm` is 0.001 to 1e+09, not 0"),
])  # fmt: skip
def test_the_stages_of_a_gantry_are_four_with_counts(written: str, instead: str, said: str) -> None:
    assert said in [text for _, text, *_ in wrong(HEAD + GANTRY.replace(written, instead))]


@pytest.mark.parametrize("number", ["2", "02"])
def test_a_stage_of_a_gantry_is_no_other_device(number: str) -> None:
    stage = STAGE.replace("port: /dev/ttyUSB1, device: 2", f'host: 10.0.0.3, port: 55550, device: "{number}"')
    stage = stage.replace("52001", "52002")
    assert "y_stage is at 10.0.0.3:55550 device 2 axis 1, where arm1 is" in str(wrong(HEAD + GANTRY + stage))
    assert "where arm1 is" not in str(wrong(HEAD + GANTRY + stage.replace(f'"{number}"', "5")))


@pytest.mark.parametrize(("text", "said"), [
    (BOX + SHUTTER.replace("shutter_box", "other").replace("name: shutter", "name: b"),
     "other is laser.shutter, and shutter_box is, too"),
    (BOX + BOX.removeprefix(SHUTTER).replace("laser_box", "other").replace("name: laser", "name: b"),
     "other is laser.emission, and laser_box is, too"),
    (ARM + ARM.replace("arm1:", "arm2:").replace("arm2:", "second:").replace("arm1_hand", "hand2")
     .replace("10.0.0.2", "10.0.0.4"), "hand2 is the hand of arm1, and arm1_hand is, too"),
    (STAGE + STAGE.replace("y_stage", "other").replace("device: 2", "device: 3").replace("52001", "52002"),
     "other is ly_150.stage_y, and y_stage is, too"),
])  # fmt: skip
def test_one_thing_is_one_device(text: str, said: str) -> None:
    assert said in [text for _, text, *_ in wrong(HEAD + text)]


@pytest.mark.parametrize(("text", "said"), [
    (BOX.replace(", name: laser}", "}"), "laser_box: the address has no `name`"),
    (BOX.replace("host: 10.0.0.7, port: 4000, name: laser", "port: 4000, name: laser"),
     "laser_box: the address has no `host`"),
    (METER.replace("10.0.0.9", "10.0.0.009"), "meter: `10.0.0.009` is no IP address"),
    (RELAY, "box: the address has no `channel`"),
])  # fmt: skip
def test_an_address_says_all_that_the_driver_needs(text: str, said: str) -> None:
    assert said in [text for _, text, *_ in wrong(HEAD + text)]
