"""Each kind of plug-in is one new file: put beside those of its kind it is found, and a command uses it.

The file is put into a folder that belongs to the package as well, which is how Python sees one more file in it. Drivers
and emulators are found by their entry points: one file each, installed beside PICO.
"""

from __future__ import annotations

import json
import shutil
import sys
from collections.abc import Callable, Iterator
from importlib import import_module
from pathlib import Path

import pytest
from commanding import Pico, edit

from pico.drivers import registry as drivers
from pico.emulators import registry as emulators
from pico.registered import modules
from pico.resources import catalog_dir, labs_dir

sys.path.insert(0, str(Path(__file__).resolve().parent / "server"))  # for what serves a coordinator there

ROOT = Path(__file__).resolve().parent.parent
Beside = Callable[[str, str, str], None]
"""Puts a file into a package: its dotted name, the name of the file, its text."""


@pytest.fixture
def beside(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Beside]:
    added: list[str] = []

    def put(package: str, name: str, text: str) -> None:
        folder = tmp_path / "more" / package
        folder.mkdir(parents=True)
        (folder / f"{name}.py").write_text(text)
        found = import_module(package)
        monkeypatch.setattr(found, "__path__", [*found.__path__, str(folder)])
        added.append(f"{package}.{name}")
        modules.cache_clear()

    yield put
    for name in added:
        package, _, last = name.rpartition(".")
        sys.modules.pop(name, None)
        vars(import_module(package)).pop(last, None)
    monkeypatch.undo()
    modules.cache_clear()


@pytest.fixture
def lab(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A laser, a lens and a camera, the light on."""
    root = tmp_path / "lab"
    shutil.copytree(labs_dir() / "minimal", root)
    dimmed = "type: beam_camera\n    parameters: {filter_density: 6}\n"  # nothing is saturated
    edit(root / "lab.yaml", "type: beam_camera\n", dimmed)
    edit(root / "lab.yaml", "policy:\n", "sim: {environment: none}\npolicy:\n  enclosed: true\n")
    monkeypatch.chdir(root)
    return root


@pytest.fixture
def lit(lab: Path, pico: Pico) -> Path:
    assert pico("apply", "--auto-approve").code == 0
    return lab


QUANTILE = """
import numpy as np
from pico.kernels.kernel import Declaration, Parameter, Result

KERNEL = Declaration(version="1", takes="image", units={"level": "count"},
                     parameters={"share": Parameter("", least=0.0)})

def apply(given, parameters):
    return Result({"level": float(np.quantile(given.pixels, parameters["share"]))}, {"level": 1.0})
"""


def test_a_kernel_is_one_file(beside: Beside, lit: Path, pico: Pico) -> None:
    beside("pico.kernels.standard", "quantile", QUANTILE)
    dark, bright = (
        pico("measure", f"camera.image | quantile(share={share})", "--json").data["value"] for share in (0.5, 1)
    )
    assert 50 < dark < 80 and bright > 5 * dark
    assert "share" in pico("measure", "camera.image | quantile").err


GOLDEN = """
from pico.optimize.problem import Declaration
from pico.optimize.stepwise import Stepwise

DECLARATION = Declaration(what="golden sections of the range", aims=("minimize",), variables=(1, 1), outputs=(1, 1),
                          parameters={"points": 16}, usual=17)
SHARE = (5 ** 0.5 - 1) / 2

def make(problem, parameters, seed):
    return Stepwise(problem, _steps(problem, int(parameters["points"])))

def _steps(problem, points):
    (variable,), (output,) = problem.variables, problem.outputs
    yield {variable.name: variable.start}
    low, high = max(variable.low, variable.start - 30), min(variable.high, variable.start + 30)
    inner = [high - SHARE * (high - low), low + SHARE * (high - low)]
    costs = [problem.cost((yield {variable.name: inner[0]})), problem.cost((yield {variable.name: inner[1]}))]
    for _ in range(points):
        if costs[0] < costs[1]:
            high, inner[1], costs[1] = inner[1], inner[0], costs[0]
            inner[0] = high - SHARE * (high - low)
            costs[0] = problem.cost((yield {variable.name: inner[0]}))
        else:
            low, inner[0], costs[0] = inner[0], inner[1], costs[1]
            inner[1] = low + SHARE * (high - low)
            costs[1] = problem.cost((yield {variable.name: inner[1]}))
    return "the section is small"
"""


def test_an_algorithm_is_one_file(beside: Beside, lab: Path, pico: Pico) -> None:
    beside("pico.optimize.algorithms", "golden", GOLDEN)
    edit(lab / "lab.yaml", "inventory:\n", "inventory:\n  pol: {type: linear_polarizer, marker: 2, home: storage/a1}\n")
    polarizer = "  pol: {pose: {x: 450, y: 420, yaw: 0}, angle: 80}\n"
    edit(lab / "state" / "table.yaml", "components:\n", f"components:\n{polarizer}")
    assert pico("apply", "--auto-approve").code == 0
    answer = pico("optimize", "null", "pol", "camera", "--algorithm", "golden", "--yes")
    assert "golden" in answer.out and answer.code == 0, answer
    found = pico("get", "pol.angle", "--json").data["values"]["angle"]["value"]
    assert found == pytest.approx(90, abs=0.5), "crossed with the light of the laser"
    assert "did you mean `golden`?" in pico("optimize", "null", "pol", "camera", "--algorithm", "godlen").err


HALVER = """
from pico.optics.beam import scaled
from pico.optics.part import Met, arrived

def meet(part, beam):
    came = arrived(part, beam)
    return Met(came, (scaled(came, 0.5 ** 0.5),), 0.0)
"""


def test_an_optical_element_is_one_file(beside: Beside, lit: Path, pico: Pico) -> None:
    beside("pico.optics.elements", "halver", HALVER)
    glass = (catalog_dir() / "neutral_density_filter.yaml").read_text()
    (lit / "glass.yaml").write_text(
        glass.replace("name: neutral_density_filter", "name: glass").replace("element: filter", "element: halver")
    )
    edit(lit / "lab.yaml", "inventory:\n", "inventory:\n  glass: {type: glass, marker: 2, home: storage/a1}\n")
    assert pico("bench", "update", "--yes").code == 0
    assert pico("do", "camera", "auto_range", "--yes").code == 0
    before = pico("measure", "camera.light", "--json").data["value"]
    assert pico("move", "glass", "x=450", "y=420", "yaw=0", "--yes").code == 0
    assert pico("measure", "camera.light", "--json").data["value"] == pytest.approx(before / 2, rel=0.02)


def test_a_component_type_is_one_file(lab: Path, tmp_path: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = tmp_path / "catalog"
    shutil.copytree(catalog_dir(), folder)
    page = (ROOT / "docs" / "how-to" / "component-type.md").read_text()
    (folder / "pinhole_25.yaml").write_text(page.split("```yaml\n")[1].split("```")[0])
    monkeypatch.setattr("pico.resources._folder", lambda name: tmp_path / name if name == "catalog" else ROOT / name)
    edit(lab / "lab.yaml", "inventory:\n", "inventory:\n  hole: {type: pinhole_25, marker: 2, home: storage/a1}\n")
    assert pico("move", "hole", "x=560", "y=340", "yaw=90", "--yes").code == 0
    assert pico("get", "hole", "--json").data["values"]["pose"]["value"]["x"] == pytest.approx(560, abs=0.5)


COMMAND = '''"""`pico shutter-speed`."""

from __future__ import annotations

import typer

from pico_cli.session import Session

HEADING = "Manifests"
ORDER = 15


def shutter_speed(context: typer.Context) -> int:
    """Say how long the camera exposes."""
    session = Session.of(context)
    found = session.bench().measurements.read("camera", "exposure")
    session.say(f"{found['exposure']['value']:g} ms")
    return 0
'''


def test_a_command_is_one_file(beside: Beside, lit: Path, pico: Pico) -> None:
    beside("pico_cli.commands", "shutter_speed", COMMAND)
    answer = pico("shutter-speed")
    assert (answer.code, answer.out) == (0, "5 ms\n"), answer
    section = pico("help", "all").out.split("Manifests:\n")[1].splitlines()
    assert section[1] == "  shutter-speed Say how long the camera exposes."


STEP = """
from pico.recipes.registry import Given, Kind

KIND = Kind("nothing is done for some minutes", "minutes: 2")

def read(reader, scope, body, beside):
    return Given({"minutes": reader.number(scope, body, "the time to wait", "min", 0.0, 60.0)})

def run(doing, given):
    doing.pause(60 * given["minutes"])
    return {}
"""


def test_a_recipe_step_is_one_file(beside: Beside, lit: Path, pico: Pico) -> None:
    beside("pico.recipes.steps", "minutes", STEP)
    (lit / "recipes").mkdir()
    (lit / "recipes" / "twice.yaml").write_text(
        "apiVersion: pico/v1\nkind: Recipe\nmetadata: {name: twice, title: Twice, lab: minimal}\n"
        "steps:\n  - minutes: 2\n  - minuets: 3\n"
    )
    assert "did you mean `minutes`?" in pico("run", "twice", "--yes").err
    edit(lit / "recipes" / "twice.yaml", "minuets", "minutes")
    clock = json.loads((lit / ".pico/benches/sim/world.json").read_text())["clock"]
    answer = pico("run", "twice", "--yes")
    assert answer.code == 0, answer
    assert json.loads((lit / ".pico/benches/sim/world.json").read_text())["clock"] - clock == pytest.approx(300)


MEASURABLE = """
from pico.backends.measured import Reading

def measures(setup, component, measurable):
    return component in setup.lab.inventory and measurable == "temperature"

def read(table, component, measurable):
    return Reading(21.5, sigma=0.1, saturated="")
"""


def test_a_measurable_of_the_simulator_is_one_file(beside: Beside, lab: Path, pico: Pico) -> None:
    beside("pico.backends.sim.measurables", "temperature", MEASURABLE)
    text = (catalog_dir() / "beam_camera.yaml").read_text().replace("name: beam_camera", "name: warm_camera")
    declared = "measurables:\n  temperature: {datatype: float, unit: degC, needs: {}, description: of the sensor}\n"
    (lab / "warm_camera.yaml").write_text(text.replace("measurables:\n", declared, 1))
    edit(lab / "lab.yaml", "type: beam_camera", "type: warm_camera")
    found = pico("measure", "camera.temperature", "--json").data
    assert (found["value"], found["unit"], found["sigma"]) == (21.5, "degC", 0.1)


ROUTE = '''
from pico.server.routes.admitting import needs, routed

router = routed()


@router.get("/moon/{phase}", **needs("known"))
async def moon(phase: str) -> dict[str, str]:
    """Tell the phase of the moon."""
    return {"phase": phase}
'''


def test_a_route_of_the_coordinator_is_one_file(beside: Beside, tmp_path: Path) -> None:
    pytest.importorskip("fastapi")
    from coordinators import served

    beside("pico.server.routes", "moon", ROUTE)
    with served(tmp_path / "books") as at:
        assert at.ask("GET", "/api/moon/full")[0] == 401, "who is not known gets no answer"
        assert at.ask("GET", "/api/moon/full", at.person("anna", "viewer")) == (200, {"phase": "full"})


DRIVER = """
import socket
from pico.drivers.driver import Driver
from pico.drivers.line import Line
from pico.drivers.protocols import Identity


class Link:
    def __init__(self, host, port):
        self.socket = socket.create_connection((host, port), timeout=1.0)
        self.file = self.socket.makefile("rb")

    def ask(self, words):
        self.socket.sendall(f"{words}\\n".encode())
        return self.file.readline(256).decode().strip()


def known(link):
    return Identity(vendor="A lab", model="1", serial=link.ask("who"))


class Laser:
    def __init__(self, name, entry, bus):
        self.name = name
        self.line = Line(name, bus, entry.identity, known)

    async def connect(self):
        return await self.line.connect()

    async def stop(self): ...

    async def close(self):
        await self.line.close()

    async def emit(self, on):
        return await self.line.move("emit", lambda link: link.ask(f"emit {int(on)}") == "1")

    async def emitting(self):
        return await self.line.ask("tell whether it emits", lambda link: link.ask("emits") == "1")


LASER = Driver(kind="laser", made=Laser, opened=lambda entry: Link(entry.address["host"], int(entry.address["port"])),
               closed=lambda link: link.socket.close(), address={"host": "its name", "port": "its TCP port"},
               bus=("host", "port"), properties={"emission": ""}, maturity="emulated", emulator="own.box", link="own")
"""
EMULATOR = """
from pico.emulators.behind import Emulator
from pico.emulators.serving import TcpServed


class Box:
    def __init__(self, serial, behind):
        self.serial, self.behind, self.rest = serial, behind, b""

    def heard(self, data):
        *lines, self.rest = (self.rest + data).split(b"\\n")
        return b"".join(self.answer(line.decode()) + b"\\n" for line in lines)

    def due(self):
        return b""

    def answer(self, words):
        if words == "who":
            return self.serial.encode()
        if words.startswith("emit "):
            self.behind.write("emission", words.endswith("1"))
        return b"1" if self.behind.read("emission") else b"0"


def started(devices):
    (entry, behind), = devices.values()
    return TcpServed(lambda: Box(str(entry.identity["serial"]), behind))


BOX = Emulator(started=started, bus=("host", "port"))
"""
DEVICES = """apiVersion: pico/v1
kind: Devices
metadata: {lab: minimal}
devices:
  laser_box:
    of: laser
    driver: own.laser
    emulator: own.box
    address: {host: laser.invalid, port: 4000}
    identity: {serial: "0042"}
    map: {emission: {property: emission}}
"""


def test_a_driver_and_its_emulator_are_a_file_with_an_entry_point_each(
    lab: Path, tmp_path: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    site = tmp_path / "site"
    about = site / "own_laser-1.0.dist-info"
    about.mkdir(parents=True)
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: own_laser\nVersion: 1.0\n")
    (about / "entry_points.txt").write_text(
        "[pico.drivers]\nown.laser = own_driver:LASER\n[pico.emulators]\nown.box = own_emulator:BOX\n"
    )
    (site / "own_driver.py").write_text(DRIVER)
    (site / "own_emulator.py").write_text(EMULATOR)
    (lab / "devices.yaml").write_text(DEVICES)
    monkeypatch.syspath_prepend(site)
    for one in (drivers, emulators):
        one.known.cache_clear()
    try:
        assert "own.laser" in pico("devices").out
        (row,) = json.loads(pico("devices", "check", "--emulate", "--json").out)["devices"]
    finally:
        monkeypatch.undo()
        for one in (drivers, emulators):
            one.known.cache_clear()
    assert row["answer"]["identity"] == {"vendor": "A lab", "model": "1", "serial": "0042", "firmware": ""}, row
