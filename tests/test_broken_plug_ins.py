"""A broken plug-in is one diagnostic that names it, whatever its kind and mistake; what does not need it goes on."""

from __future__ import annotations

import asyncio
import importlib
import shutil
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from commanding import Answer, Pico, edit
from pico_cli import commands
from pico_cli.app import build

from pico import registered
from pico.backends.sim import plugins as simulated
from pico.diagnostics import Diagnostic, PicoError
from pico.drivers import registry as drivers
from pico.emulators import registry as emulators
from pico.manifest.checks import devices
from pico.model import primitive
from pico.model.wiring import DeviceEntry
from pico.optics import following
from pico.optimize import registry as algorithms
from pico.optimize.problem import Problem, Variable
from pico.planning import routines
from pico.resources import catalog_dir, labs_dir

sys.path.insert(0, str(Path(__file__).resolve().parent / "server"))  # for what serves a coordinator there

TITLE, PACKAGE = "lamp upside down", "own-parts"
Install = Callable[[str, str | None], None]
"""Installs a package: the text of its entry points, and that of its module `own_parts`, None for none."""


@dataclass(frozen=True)
class Kind:
    """A kind of plug-in: its `group`, what its entry point names (`at`), the `text` of a good one with `BODY` in the
    function that is called, the command that needs it, and what the lab needs for that."""

    called: str
    group: str
    at: str
    text: str
    words: tuple[str, ...]
    prepare: Callable[[Path], None] = lambda lab: None
    beside: str = ""


DEVICES = """apiVersion: pico/v1
kind: Devices
metadata: {lab: minimal}
devices:
  laser_box:
    of: laser
    driver: DRIVER
    emulator: EMULATOR
    address: {host: laser.invalid, port: 4000, name: laser}
    identity: {serial: "0042"}
    map: {emission: {property: emission}}
"""


def cell(lab: Path) -> None:
    shutil.copy(catalog_dir() / "sample_holder.yaml", lab / "cuvette.yaml")
    edit(lab / "cuvette.yaml", "name: sample_holder", "name: cuvette")
    edit(lab / "cuvette.yaml", "primitives: [move, stow]", "primitives: [move, stow, own]")
    edit(lab / "lab.yaml", "inventory:\n", "inventory:\n  cell: {type: cuvette, marker: 2, home: storage/a1}\n")


def glass(lab: Path) -> None:
    text = (catalog_dir() / "neutral_density_filter.yaml").read_text()
    text = text.replace("name: neutral_density_filter", "name: glass").replace("element: filter", "element: own")
    (lab / "glass.yaml").write_text(text)
    bolted = "inventory:\n  glass: {type: glass, marker: 2, home: storage/a1}\n"
    edit(lab / "lab.yaml", "inventory:\n", bolted)
    edit(lab / "state" / "table.yaml", "components:\n", "components:\n  glass: {pose: {x: 450, y: 420, yaw: 0}}\n")


def recipe(lab: Path) -> None:
    (lab / "recipes").mkdir()
    (lab / "recipes" / "short.yaml").write_text(
        "apiVersion: pico/v1\nkind: Recipe\nmetadata: {name: short, title: Short, lab: minimal}\nsteps:\n  - own: 2\n"
    )


def polarizer(lab: Path) -> None:
    edit(lab / "lab.yaml", "inventory:\n", "inventory:\n  pol: {type: linear_polarizer, marker: 2, home: storage/a1}\n")


def wired(driver: str, emulator: str) -> Callable[[Path], None]:
    return lambda lab: (lab / "devices.yaml").write_text(
        DEVICES.replace("DRIVER", driver).replace("EMULATOR", emulator)
    )  # type: ignore[return-value]


PRIMITIVE = "from pico.model.primitive import Primitive\nPRIMITIVE = Primitive(name='own', changes='anything')\n"
BY_ARM = PRIMITIVE.replace("changes", "by='arm', changes")
DRIVER = """
from pico.drivers.driver import Driver
def made(name, entry, bus):
    BODY
OWN = Driver(kind="laser", made=made, bus=("host", "port"), opened=lambda entry: None, closed=lambda link: None,
             properties={"emission": ""}, address={"host": "its name", "port": "its port", "name": "its switch"},
             emulator="switches")
"""
KINDS = (
    Kind(
        "kernel", "pico.kernels", "own_parts",
        "from pico.kernels.kernel import Declaration\n"
        "KERNEL = Declaration(version='1', takes='image', units={'level': 'count'})\n"
        "def apply(given, parameters):\n    BODY\n",
        ("measure", "camera.image | own"),
    ),
    Kind(
        "recipe step", "pico.recipe_steps", "own_parts",
        "from pico.recipes.registry import Given, Kind\nKIND = Kind('nothing is done', 'own: 2')\n"
        "def read(reader, scope, body, beside):\n    return Given({})\ndef run(doing, given):\n    BODY\n",
        ("run", "short", "--yes"), recipe,
    ),
    Kind(
        "goal", "pico.goals", "own_parts", "TAKES, LEAST = 'CAMERA', 1\ndef make(asked):\n    BODY\n",
        ("optimize", "own", "camera", "--yes"),
    ),
    Kind(
        "primitive", "pico.primitives", "own_parts:PRIMITIVE", PRIMITIVE, ("do", "cell", "own", "-y"), cell,
    ),
    Kind(
        "simulated primitive", "pico.sim.primitives", "own_parts:done", "def done(world, operation):\n    BODY\n",
        ("do", "cell", "own", "-y"), cell, PRIMITIVE,
    ),
    Kind(
        "routine", "pico.routines", "own_parts:asked", "def asked(setup, seen, operation):\n    BODY\n",
        ("do", "cell", "own", "-y"), cell, BY_ARM,
    ),
    Kind(
        "optical element", "pico.elements", "own_parts", "def meet(part, beam):\n    BODY\n",
        ("apply", "--yes"), glass,
    ),
    Kind(
        "driver", "pico.drivers", "own_parts:OWN", DRIVER, ("devices", "check"), wired("own", "switches"),
    ),
    Kind(
        "emulator", "pico.emulators", "own_parts:OWN",
        "from pico.emulators.behind import Emulator\ndef started(devices):\n    BODY\n"
        "OWN = Emulator(started=started, bus=('host', 'port'))\n",
        ("devices", "check", "--emulate"), wired("switches.laser", "own"),
    ),
    Kind(
        "backend", "pico.devices", "own_parts:opened", "def opened(setup, place, fidelity, clock):\n    BODY\n",
        ("--backend", "own", "measure", "camera.light"),
    ),
)  # fmt: skip
MISTAKES: dict[str, tuple[Callable[[str], str | None], str]] = {
    "syntax": (lambda text: text + "def (\n", "SyntaxError"),
    "import": (lambda text: f"raise RuntimeError('{TITLE}')\n" + text, f"RuntimeError: {TITLE}"),
    "dependency": (lambda text: "import lamp_library\n" + text, "No module named 'lamp_library'"),
    "missing": (lambda text: None, "No module named 'own_parts'"),
    "attribute": (lambda text: "OTHER = 1\n", "has no"),
    "raises": (lambda text: text.replace("BODY", f"raise ValueError('{TITLE}')"), f"ValueError: {TITLE}"),
    "returns": (lambda text: text.replace("BODY", "return 42"), "42 (int), "),
}
TABLE = [
    (kind, mistake)
    for kind in KINDS
    for mistake in MISTAKES
    if kind.called != "primitive" or mistake not in ("raises", "returns")  # it is data, and has no function
]


def forget() -> None:
    """Let what was read of installed packages be read anew."""
    registered._LOADED.clear()
    for one in (registered.modules, primitive.plugged_in, simulated.plugged_in, routines.plugged_in, drivers.known,
                emulators.known, following.element, devices.declaration):  # fmt: skip
        one.cache_clear()
    for name in ("own_parts", "own_primitive"):
        sys.modules.pop(name, None)
    importlib.invalidate_caches()


@pytest.fixture
def install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Install]:
    site = tmp_path / "site"
    about = site / "own_parts-1.0.dist-info"
    about.mkdir(parents=True)
    monkeypatch.setattr(sys, "dont_write_bytecode", True)

    def put(entries: str, text: str | None) -> None:
        (about / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {PACKAGE}\nVersion: 1.0\n")
        (about / "entry_points.txt").write_text(entries)
        if text is not None:
            (site / "own_parts.py").write_text(text)
        monkeypatch.syspath_prepend(site)
        forget()

    yield put
    monkeypatch.undo()
    forget()


@pytest.fixture
def lab(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    root = tmp_path / "lab"
    shutil.copytree(labs_dir() / "minimal", root)
    edit(root / "lab.yaml", "policy:\n", "sim: {environment: none}\npolicy:\n  enclosed: true\n")
    monkeypatch.chdir(root)
    return root


def require_named(answer: Answer, kind: Kind, said: str, *, file: bool) -> None:
    assert answer.code == 1, answer
    assert answer.err.count("error[plugin]") == 1 and "error[internal]" not in answer.err, answer.err
    assert f"the {kind.called} plug-in `own` of package {PACKAGE}" in answer.err, answer.err
    assert said in answer.err and f"pip uninstall {PACKAGE}" in answer.err, answer.err
    assert not file or "own_parts.py:" in answer.err, answer.err


@pytest.mark.parametrize(("kind", "mistake"), TABLE, ids=[f"{k.called.replace(' ', '-')}-{m}" for k, m in TABLE])
def test_it_is_named(kind: Kind, mistake: str, lab: Path, tmp_path: Path, install: Install, pico: Pico) -> None:
    change, said = MISTAKES[mistake]
    kind.prepare(lab)
    entries = f"[{kind.group}]\nown = {kind.at}\n"
    if kind.beside:
        (tmp_path / "site" / "own_primitive.py").write_text(kind.beside)
        entries += "[pico.primitives]\nown = own_primitive:PRIMITIVE\n"
    install(entries, change(kind.text))
    require_named(pico(*kind.words), kind, said, file=mistake in ("syntax", "import", "dependency", "raises"))
    apart = [("status",), ("stop", "--now"), ("recover",)]
    for words in apart if kind.called == "optical element" else [*apart, ("validate",)]:  # that computes the light
        assert pico(*words).code in (0, 2), (words, pico(*words))


ALGORITHM = """
from pico.optimize.problem import Declaration
DECLARATION = Declaration(what="nothing", aims=("minimize",), variables=(1, 1), outputs=(1, 1), parameters={}, usual=3)
class Own:
    finished = ""
    def suggest(self, num_points=None):
        BODY
    def ingest(self, results): ...
def make(problem, parameters, seed):
    return Own()
"""


@pytest.mark.parametrize("mistake", ["syntax", "import", "dependency", "missing", "attribute", "raises"])
def test_an_algorithm_is_named(mistake: str, install: Install) -> None:
    change, said = MISTAKES[mistake]
    install("[pico.algorithms]\nown = own_parts\n", change(ALGORITHM))
    problem = Problem((Variable("x", 0.0, 1.0, 0.5),), ("y",), "minimize")
    with pytest.raises(PicoError) as failed:
        algorithms.made("own", problem).suggest(1)
    (found,) = failed.value.diagnostics
    assert found.code == "plugin" and "the algorithm plug-in `own` of package own-parts" in found.summary
    assert said in found.summary


def test_a_kernel_that_returns_no_numbers_is_named(lab: Path, install: Install, pico: Pico) -> None:
    (kind,) = (k for k in KINDS if k.called == "kernel")
    for returned, said in (("{'level': 'much'}, {'level': 1.0}", "no number as its `level`: 'much'"),
                           ("{'level': 1.0}", "values of level, and sigmas of nothing")):  # fmt: skip
        text = kind.text.replace("BODY", f"return Result({returned})").replace("import ", "import Result, ", 1)
        install(f"[{kind.group}]\nown = {kind.at}\n", text)
        require_named(pico(*kind.words), kind, said, file=True)


def test_an_instrument_that_raises_or_whose_link_does_is_named(install: Install) -> None:
    """What a backend makes of it is a failed operation, as of any PicoError of an instrument."""
    text = (
        DRIVER.replace("BODY", "return Laser(bus)")
        + """
class Laser:
    def __init__(self, bus):
        self.bus = bus
    async def connect(self): ...
    async def stop(self): ...
    async def close(self): ...
    async def emit(self, on):
        return 1 / 0
    async def emitting(self):
        return await self.bus.ask("box", "tell whether it emits", lambda link: link.emits)
"""
    )
    install("[pico.drivers]\nown = own_parts:OWN\n", text)
    entry = DeviceEntry(driver="own", address={"host": "127.0.0.1", "port": 1, "name": "laser"})
    laser: Any = drivers.Buses().opened("box", entry)

    async def asked(call: Any) -> Diagnostic:
        with pytest.raises(PicoError) as failed:
            await call
        await laser.bus.close()
        return failed.value.diagnostics[0]

    for call, said in ((laser.emit(True), "ZeroDivisionError"), (laser.emitting(), "has no attribute 'emits'")):
        found = asyncio.run(asked(call))
        assert found.code == "plugin" and "the driver plug-in `own` of package own-parts" in found.summary, found
        assert said in found.summary and found.source is not None and found.source.path.endswith("own_parts.py")


COMMAND = """HEADING = "Manifests"
import typer
def own(context: typer.Context):
    \"\"\"Do nothing.\"\"\"
    BODY
"""


@pytest.mark.parametrize("mistake", ["syntax", "import", "dependency", "attribute", "raises", "returns"])
def test_a_command_is_named(
    mistake: str, lab: Path, tmp_path: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    change, said = MISTAKES[mistake]
    (tmp_path / "more").mkdir()
    if mistake == "returns":
        change, said = (lambda text: text.replace("BODY", "return 'fine'")), "it returned 'fine' (str)"
    (tmp_path / "more" / "own.py").write_text(str(change(COMMAND)))
    monkeypatch.setattr(commands, "__path__", [*commands.__path__, str(tmp_path / "more")])
    sys.modules.pop("pico_cli.commands.own", None)
    build.cache_clear()
    answer = pico("own")
    assert answer.code == 1 and answer.err.count("error[plugin]: the command plug-in `own`") == 1, answer.err
    assert "own.py:" in answer.err and "correct the file, or remove it" in answer.err, answer.err
    assert (said if mistake != "attribute" else "neither a function `own`") in answer.err
    assert pico("status").code == 0 and pico("--help").code == 0
    build.cache_clear()


@pytest.mark.parametrize("mistake", ["syntax", "import", "missing", "attribute", "raises"])
def test_a_coordinator_goes_on_without_a_route(mistake: str, tmp_path: Path, install: Install) -> None:
    pytest.importorskip("fastapi")
    from coordinators import served

    from pico.server.routes.known import routers

    change, said = MISTAKES[mistake]
    text = "from fastapi import APIRouter\nrouter = APIRouter()\n@router.get('/own')\nasync def own():\n    BODY\n"
    install("[pico.server_routes]\nown = own_parts\n", change(text))
    if mistake == "raises":
        with served(tmp_path / "books") as at:
            status, body = at.ask("GET", "/own", at.person("anna", "viewer"))
            assert status == 500 and at.ask("GET", "/api/benches", at.person("bert", "viewer"))[0] == 200
        found = (body["error"][0]["code"], body["error"][0]["summary"])
    else:
        (fault,) = routers()[1]
        assert fault.severity == "warning"
        found = (fault.code, fault.summary)
    assert found[0] == "plugin" and "the server route plug-in `own` of package own-parts" in found[1], found
    assert said in found[1], found


@pytest.mark.parametrize(
    ("called", "words", "code", "said"),
    [
        ("goal", ("optimize",), 0, "warning[plugin]"),
        ("recipe step", ("recipe", "steps"), 0, "warning[plugin]"),
        ("kernel", ("measure", "camera.image | centroid | centroid"), 1, "`centroid` takes an image"),
        ("driver", ("catalog", "list"), 0, ""),
    ],
)
def test_lists_and_hints_of_all_of_a_kind_go_on_without_a_broken_one(
    called: str, words: tuple[str, ...], code: int, said: str, lab: Path, install: Install, pico: Pico
) -> None:
    (kind,) = (k for k in KINDS if k.called == called)
    install(f"[{kind.group}]\nown = {kind.at}\n", MISTAKES["import"][0](kind.text))
    answer = pico(*words)
    assert answer.code == code and said in answer.err and "error[plugin]" not in answer.err, answer


BESIDE = """  arm1: {driver: xarm.arm, address: {host: 192.0.2.222}, settings: {tool_z: 172}}
  arm1_hand: {driver: xarm.gripper, of: arm1, address: {host: 192.0.2.222}}
  left: {driver: frames.camera, address: {host: 192.0.2.10, port: 5001}}
  right: {driver: frames.camera, address: {host: 192.0.2.10, port: 5002}}
  shutter_box: {driver: switches.shutter, of: laser, address: {host: 192.0.2.20, port: 4000, name: shutter}}
"""


@pytest.mark.parametrize("mistake", ["import", pytest.param("raises", marks=pytest.mark.slow)])
def test_a_broken_driver_stops_no_other_device_of_a_bench(
    mistake: str, lab: Path, install: Install, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The laser's own driver is broken: its shutter can be closed all the same."""
    monkeypatch.setenv("PICO_EMULATED_PACE", "20")
    wired("own", "switches")(lab)
    (lab / "devices.yaml").write_text((lab / "devices.yaml").read_text() + BESIDE)
    install("[pico.drivers]\nown = own_parts:OWN\n", MISTAKES[mistake][0](DRIVER))
    named = "the driver plug-in `own` of package own-parts"
    if mistake == "import":  # of what fails only when it is called the files know nothing
        checked = pico("validate")
        assert checked.code == 0 and "warning[plugin]" in checked.err and "devices.yaml:7:13" in checked.err, checked
    for words in (("devices",), ("--emulate", "devices", "read", "laser_box", "shutter_box")):
        shown = pico(*words)
        assert "shutter_box" in shown.out and "internal" not in shown.err, shown
    assert mistake != "import" or "broken" in pico("devices").out
    status = pico("--emulate", "status")
    assert status.code == 0 and named in status.err and "error" not in status.err, status
    assert pico("--emulate", "recover").code == 0
    shut = pico("--emulate", "set", "laser", "shutter=closed", "--yes")
    assert shut.code == 0, shut
    failed = pico("--emulate", "set", "laser", "emission=true", "--yes")
    assert failed.code != 0 and named in failed.err, failed


def test_a_driver_of_a_kind_that_there_is_not_is_named_with_those_that_there_are(
    lab: Path, install: Install, pico: Pico
) -> None:
    wired("own", "switches")(lab)
    install("[pico.drivers]\nown = own_parts:OWN\n", DRIVER.replace('"laser"', '"lasser"'))
    checked = pico("validate")
    assert checked.code == 0 and "warning[kind]" in checked.err and "devices.yaml:7:13" in checked.err, checked
    assert "there is no kind of instrument `lasser`" in checked.err and "did you mean `laser`?" in checked.err
    listed = pico("devices")
    assert listed.code == 0 and "broken" in listed.out, listed
    asked = pico("devices", "check")
    assert asked.code == 1 and "error[plugin]" in asked.err and "lasser" in asked.err, asked
    assert "KeyError" not in asked.err and "internal" not in asked.err


OWN_KIND = """
from typing import Protocol
from pico.drivers.protocols import Instrument
from pico.model.instruments.kind import InstrumentKind
class Bell(Instrument, Protocol):
    async def ring(self): ...
async def reads(bell):
    return "silent"
KIND = InstrumentKind(name="bell", about="what rings", protocol=Bell, reads=reads)
"""


def test_a_kind_of_a_package_is_known_and_its_protocol_is_asked_of_drivers(
    lab: Path, tmp_path: Path, install: Install, pico: Pico
) -> None:
    wired("own", "switches")(lab)
    text = DRIVER.replace('"laser"', '"bell"').replace('properties={"emission": ""}', "properties={'emission': ''}")
    (tmp_path / "site" / "own_kind.py").write_text(OWN_KIND)
    install("[pico.drivers]\nown = own_parts:OWN\n[pico.kinds]\nbell = own_kind\n", text.replace("BODY", "return 42"))
    edit(lab / "devices.yaml", "    map: {emission: {property: emission}}\n", "")
    assert "warning[kind]" not in pico("validate").err
    asked = pico("devices", "check")
    assert asked.code == 1 and "error[plugin]" in asked.err and "which has no `" in asked.err, asked
    sys.modules.pop("own_kind", None)
