"""What an edge lets emit, shuts and keeps, case by case: armings as files, licences, what shuts a laser, doses."""

from __future__ import annotations

import asyncio
import json
import re
import subprocess
from collections.abc import Sequence
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from bench_at import bench_at
from laser_lab import POSES, UNKNOWN, bench, carry, commanded, observed, set_to

from pico.base.state_files import JOURNAL
from pico.diagnostics import ExitCode, PicoError, error
from pico.edge import armings, dose, emission
from pico.model.arming import CLASSES, Arming, ArmingPolicy, LaserRole, Licence
from pico.model.commissioning import FILES, Basis
from pico.model.observation import Observation
from pico.model.operation import Operation, OperationResult
from pico.model.setup import Setup
from pico.optics.audit.findings import Audit, Finding
from pico.policy import audit
from pico.policy import dose as dose_policy
from pico.policy.audit import Lit
from pico.runs.journal import Journal

NOON, ONE, EVENING, NIGHT = (f"2026-11-24T{hour}:00:00Z" for hour in ("12", "13", "18", "22"))
ROLES = {"user": LaserRole(people=("Ada",), laser_class="3B", hours=8.0)}
LIT = {"emission": True, "shutter": "open", "power": 4.0}


def lab(**policy: Any) -> Setup:
    setup = bench()
    allowed = replace(setup.lab.policy, arming=ArmingPolicy(**{"roles": ROLES, **policy}))
    return replace(setup, lab=replace(setup.lab, policy=allowed))


SETUP = lab()


def given(**changes: Any) -> Arming:
    usual: dict[str, Any] = {"laser": "laser", "by": "Ada", "role": "user", "laser_class": "3R", "begins": NOON,
                             "ends": EVENING, "backend": "sim"}  # fmt: skip
    return Arming(**(usual | changes))


# armings as files


@pytest.fixture(params=["in Git", "outside"])
def root(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    if request.param == "in Git":
        subprocess.run(["git", "init", "-q"], cwd=tmp_path, check=True)
    return tmp_path


def in_git(root: Path) -> bool:
    return (root / ".git").exists()


def file(root: Path, laser: str = "laser") -> Path:
    return bench_at(root).folder / "armed" / f"{laser}.json"


def test_what_a_bench_keeps_it_finds_again_until_it_forgets(root: Path) -> None:
    assert armings.kept(bench_at(root)) == ()
    armings.keep(bench_at(root), given())
    armings.keep(bench_at(root), given(laser="second", unattended=True))
    armings.keep(bench_at(root), given(ends=NIGHT))
    assert [(k.laser, k.arming, k.broken) for k in armings.kept(bench_at(root))] == [
        ("laser", given(ends=NIGHT), ""), ("second", given(laser="second", unattended=True), "")
    ]  # fmt: skip
    armings.forget(bench_at(root), "laser")
    armings.forget(bench_at(root), "laser")
    assert [k.laser for k in armings.kept(bench_at(root))] == ["second"]
    assert not file(root).exists()
    if in_git(root):
        assert len(list((root / ".git" / "pico" / "armed").iterdir())) == 1


@pytest.mark.parametrize("spoil", [
    lambda data: b"", lambda data: data[:-20], lambda data: b"[]", lambda data: b"{}",
    lambda data: data.replace(b'"3R"', b'"5"'), lambda data: data.replace(b"pico.arming/v1", b"pico.arming/v99"),
    lambda data: data.replace(b"2026-11-24T18:00:00Z", b"tomorrow"),
    lambda data: data.replace(b"2026-11-24T18:00:00Z", b"2026-11-24T18:00:00"),
    lambda data: data.replace(b'"laser": "laser"', b'"laser": "second"'),
    lambda data: b"\xff" + data,
])  # fmt: skip
def test_a_file_that_is_broken_arms_nothing(root: Path, spoil: Any) -> None:
    armings.keep(bench_at(root), given())
    data = file(root).read_bytes()
    assert spoil(data) != data
    file(root).write_bytes(spoil(data))
    (found,) = armings.kept(bench_at(root))
    assert (found.laser, found.arming) == ("laser", None) and found.broken
    assert set(emission.over(SETUP, bench_at(root), NOON)) == {"laser"}


def test_what_the_bench_did_not_write_counts_only_where_nothing_tells(root: Path) -> None:
    armings.keep(bench_at(root), given())
    longer = file(root).read_text().replace(EVENING, NIGHT)
    file(root).write_text(longer)
    (found,) = armings.kept(bench_at(root))
    assert found.arming is None and found.broken
    longer = re.sub('"sha256": "[0-9a-f]+", ', "", longer)  # as an earlier version wrote it
    file(root).write_text(longer)
    (found,) = armings.kept(bench_at(root))
    if in_git(root):
        assert found.arming is None and found.broken == "it is not what the bench wrote there"
        file(root, "second").write_text(longer.replace('"laser": "laser"', '"laser": "second"'))
        assert [k.arming for k in armings.kept(bench_at(root))] == [None, None], (
            "nor a file of a laser that it never armed"
        )
    else:
        assert found.arming == given(ends=NIGHT)


def test_another_lab_of_the_repository_has_seals_of_its_own(tmp_path: Path) -> None:
    subprocess.run(["git", "init", "-q"], cwd=tmp_path, check=True)
    one, two = tmp_path / "one", tmp_path / "two"
    for folder in (one, two):
        folder.mkdir()
    armings.keep(bench_at(one), given())
    armings.keep(bench_at(two), given(ends=NIGHT))
    assert [k.arming for k in armings.kept(bench_at(one))] == [given()]
    file(two).write_bytes(file(one).read_bytes())
    assert [k.arming for k in armings.kept(bench_at(two))] == [None]


def test_an_arming_of_one_bench_of_a_lab_arms_no_other_one(root: Path) -> None:
    sim, real = bench_at(root), bench_at(root, "hardware")
    armings.keep(sim, given())
    assert armings.kept(real) == ()
    armings.keep(real, given(ends=NIGHT, backend="hardware"))
    assert [k.arming for k in armings.kept(sim)] == [given()]
    (real.folder / "armed" / "laser.json").write_bytes(file(root).read_bytes())
    (found,) = armings.kept(real)
    assert (found.arming is None) is in_git(root), "what the simulated bench wrote is no arming of the real one"
    armings.forget(real, "laser")
    assert [k.arming for k in armings.kept(sim)] == [given()] and armings.kept(real) == ()


def test_a_link_arms_nothing(root: Path) -> None:
    armings.keep(bench_at(root), given())
    elsewhere = root / "elsewhere.json"
    file(root).rename(elsewhere)
    file(root).symlink_to(elsewhere)
    assert [(k.arming, k.broken) for k in armings.kept(bench_at(root))] == [(None, "it is a link")]
    file(root).unlink()
    elsewhere.rename(file(root))
    assert armings.kept(bench_at(root))[0].arming == given()
    moved = root / "folder"
    file(root).parent.rename(moved)
    (bench_at(root).folder / "armed").symlink_to(moved)
    for found in _kept_or_refused(root):
        assert found.arming is None


def _kept_or_refused(root: Path) -> Sequence[armings.Kept]:
    try:
        return armings.kept(bench_at(root))
    except PicoError:
        return ()


def test_a_folder_that_cannot_be_listed_arms_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(*_: Any) -> Any:
        raise PermissionError(13, "Permission denied")

    armings.keep(bench_at(tmp_path), given())
    monkeypatch.setattr(Path, "glob", refused)
    assert armings.kept(bench_at(tmp_path)) == ()


def test_a_broken_file_keeps_nobody_from_looking(tmp_path: Path) -> None:
    armings.keep(bench_at(tmp_path), given())
    armings.keep(bench_at(tmp_path), given(laser="second"))
    file(tmp_path).write_text("{")
    able: Any = SimpleNamespace(name="sim", evidence="hardware")
    seen = asyncio.run(emission.with_licences(SETUP, bench_at(tmp_path), able, object(), ONE, observed()))  # type: ignore[arg-type]
    assert seen.licences is not None and list(seen.licences) == ["second"]


# which are over


@pytest.mark.parametrize("now", ["2026-11-24T11:00:00Z", NOON, ONE, EVENING, NIGHT])
@pytest.mark.parametrize("changes", [{}, {"by": "Eve"}, {"seen_over": True}, {"ended_by": "Ben"}])
def test_an_arming_that_is_over_is_told_with_why(tmp_path: Path, now: str, changes: dict[str, Any]) -> None:
    armings.keep(bench_at(tmp_path), given(**changes))
    found = emission.over(SETUP, bench_at(tmp_path), now)
    ended = now >= EVENING or "seen_over" in changes
    assert bool(found) is (ended or "by" in changes)
    if "ended_by" in changes and ended:
        assert found == {"laser": "Ben disarmed it"}


# licences


@pytest.mark.parametrize("evidence", ["kinematic", "hardware"])
@pytest.mark.parametrize("now", ["2026-11-24T11:00:00Z", ONE, EVENING])
@pytest.mark.parametrize("waived", [(), ("kinematic",)])
def test_a_bench_is_observed_with_what_lets_its_lasers_emit(
    tmp_path: Path, evidence: Any, now: str, waived: Any
) -> None:
    armings.keep(bench_at(tmp_path), given())
    setup, able = lab(waived=waived), SimpleNamespace(name="sim", evidence=evidence)
    seen = observed({"laser": Licence(laser_class="4")})
    got = asyncio.run(emission.with_licences(setup, bench_at(tmp_path), able, object(), now, seen)).licences  # type: ignore[arg-type]
    assert got is not None
    if waived and evidence == "kinematic":
        assert {n: x.laser_class for n, x in got.items()} == dict.fromkeys(("bare", "laser", "second"), "4")
    else:
        assert {n: (x.laser_class, x.by) for n, x in got.items()} == ({"laser": ("3R", "Ada")} if now == ONE else {})
    kept = armings.kept(bench_at(tmp_path))[0].arming
    assert kept is not None and bool(kept.seen_over) is (now == EVENING), "its end is kept, whatever a clock says later"


class Real:
    """A bench that must be commissioned, or cannot tell."""

    def __init__(self, fails: bool = False) -> None:
        self.fails = fails

    async def basis(self) -> Basis:
        if self.fails:
            raise PicoError(error("device-lost", "no answer"))
        return Basis(wired="a", bench="b", identities={})

    async def describe(self) -> Any:
        return SimpleNamespace(name="hardware", evidence="hardware")


HARDWARE: Any = SimpleNamespace(name="hardware", evidence="hardware")


@pytest.mark.parametrize("of", CLASSES)
@pytest.mark.parametrize("waived", [(), ("kinematic", "physics", "emulated")])
@pytest.mark.parametrize("real", [True, False])
def test_above_class_2_a_real_bench_lets_out_nothing_before_it_is_commissioned(
    tmp_path: Path, of: Any, waived: Any, real: bool
) -> None:
    setup = lab(waived=waived, roles={"user": LaserRole(people=("Ada",), laser_class="4", hours=8.0)})
    armings.keep(bench_at(tmp_path), given(laser_class=of, backend="hardware"))
    armings.keep(bench_at(tmp_path), given(laser="second", laser_class="1", backend="hardware"))
    device: Any = Real() if real else object()
    why = asyncio.run(emission.uncommissioned(setup, bench_at(tmp_path), HARDWARE, device, ONE))
    assert why == (("it was never commissioned",) if real else ())
    got = asyncio.run(emission.with_licences(setup, bench_at(tmp_path), HARDWARE, device, ONE, observed())).licences
    assert got is not None
    held = of in ("3R", "3B", "4") and real
    assert got["laser"].laser_class == ("2" if held else of)
    assert got["laser"].withheld == ("the bench is not commissioned: it was never commissioned" if held else None)
    if real:
        require = emission.require_commissioned(
            setup, bench_at(tmp_path), device, ONE, given(laser_class=of, backend="hardware")
        )
        if held:
            with pytest.raises(PicoError, match="stays shut") as caught:
                asyncio.run(require)
            assert caught.value.exit_code == ExitCode.DENIED
        else:
            asyncio.run(require)


def test_a_waived_bench_needs_no_commissioning_and_a_report_that_cannot_be_read_is_none(tmp_path: Path) -> None:
    able: Any = SimpleNamespace(name="emulated", evidence="emulated")
    waived = lab(waived=("emulated",))
    assert asyncio.run(emission.uncommissioned(waived, bench_at(tmp_path), able, Real(), ONE)) == ()  # type: ignore[arg-type]
    assert asyncio.run(emission.uncommissioned(SETUP, bench_at(tmp_path), able, Real(), ONE)) != ()  # type: ignore[arg-type]
    (tmp_path / FILES["hardware"]).parent.mkdir(parents=True, exist_ok=True)
    (tmp_path / FILES["hardware"]).write_text("{")
    (why,) = asyncio.run(emission.uncommissioned(SETUP, bench_at(tmp_path), HARDWARE, Real(), ONE))  # type: ignore[arg-type]
    assert "is no report of a commissioning" in why
    with pytest.raises(PicoError, match="no answer"):
        asyncio.run(emission.uncommissioned(SETUP, bench_at(tmp_path), HARDWARE, Real(fails=True), ONE))  # type: ignore[arg-type]


# what shines without a licence


@pytest.mark.parametrize("power", [0.3, 0.9, 4.0, 50.0])
@pytest.mark.parametrize("values", [{}, {"shutter": "closed"}, {"emission": False}, {"emission": UNKNOWN},
                                    {"shutter": commanded("closed")}])  # fmt: skip
@pytest.mark.parametrize("licence", [None, "2", "3R", "3B"])
def test_a_laser_that_may_shine_above_its_licence_is_told(power: float, values: Any, licence: Any) -> None:
    licences = {"laser": Licence(laser_class=licence, by="Ada")} if licence else None
    found = emission.unlicensed(SETUP, observed(licences, laser={**LIT, "power": power, **values}))
    dark = values in ({"shutter": "closed"}, {"emission": False})
    of = "1" if power < 0.39 else "2" if power <= 1 else "3R" if power <= 5 else "3B"
    enough = of in ("1", "2") or (licence is not None and CLASSES.index(of) <= CLASSES.index(licence))  # type: ignore[arg-type]
    assert list(found) == ([] if dark or enough else ["laser"])
    assert not found or found["laser"].startswith(f"it is of class {of}, and ")


# what shuts it


@pytest.mark.parametrize(("values", "shuts"), [
    ({}, ("laser", "shutter", "open", "closed")), ({"shutter": "closed"}, None), ({"emission": False}, None),
    ({"emission": UNKNOWN}, ("laser", "shutter", "open", "closed")),
    ({"shutter": UNKNOWN}, ("laser", "shutter", None, "closed")),
    ({"shutter": commanded("closed")}, ("laser", "shutter", None, "closed")),
])  # fmt: skip
def test_a_laser_is_shut_by_its_own_shutter_unless_it_is_dark(values: Any, shuts: Any) -> None:
    op = emission.shutting(SETUP, observed(laser={**LIT, **values}), "laser", "it is late")
    assert (op is None) is (shuts is None)
    if op is not None:
        assert (op.component, op.arguments["tunable"], op.arguments["from"], op.arguments["to"]) == shuts
        assert (op.primitive, op.reason.kind, op.reason.text) == ("set", "interlock", "it is late")
        assert op.resources == ("laser.shutter", "laser") and op.id == "shut_laser"


@pytest.mark.parametrize(("gate", "shuts"), [
    ("before", ("gate", "shutter", "open", "closed")), ("closed", None), ("aside", ("bare", "emission", True, False)),
    ("missing", ("bare", "emission", True, False)),
])  # fmt: skip
def test_one_without_a_shutter_is_shut_by_the_one_in_its_beam_or_switched_off(gate: str, shuts: Any) -> None:
    seen = observed(bare={"emission": True}, gate={"shutter": "closed" if gate == "closed" else "open"})
    place = POSES["gate"] if gate == "aside" else replace(POSES["bare"], x=300.0)
    part = replace(seen.components["gate"], pose=place, presence="missing" if gate == "missing" else "seen")
    seen = replace(seen, components={**seen.components, "gate": part})
    op = emission.shutting(SETUP, seen, "bare", "w")
    assert (op and (op.component, op.arguments["tunable"], op.arguments["from"], op.arguments["to"])) == shuts


def test_what_is_not_there_or_no_laser_here_is_not_shut_and_shutting_is_nothing_to_undo() -> None:
    seen = observed(laser=LIT, without=("laser",))
    assert emission.shutting(SETUP, seen, "laser", "w") is None is emission.shutting(SETUP, seen, "nobody", "w")
    op = emission.shutting(SETUP, observed(laser=LIT), "laser", "it is late")
    assert op is not None
    plan = emission.shut_plan(SETUP, observed(laser=LIT), op, SimpleNamespace(name="sim", fidelity="kinematic"))  # type: ignore[arg-type]
    assert (plan.operations, plan.target.cause, plan.backend, plan.fidelity) == ((op,), "recover", "sim", "kinematic")
    assert plan.base.state == plan.target.state and plan.digest == plan.sealed().digest
    assert plan.target.title == "laser shut: it is late"
    said = emission.told("laser", "it is late")
    assert (said.severity, said.code, said.address) == ("warning", "unarmed", "laser")


# the device that lets out light by a licence only


class Inner:
    def __init__(self) -> None:
        self.done = list[str]()

    async def execute(self, operation: Operation, key: str, began: Any) -> OperationResult:
        self.done.append(operation.id)
        return OperationResult(key=key, outcome="done", data={"value": 1})


@pytest.mark.parametrize("licence", [None, "3R", "there"])
@pytest.mark.parametrize("most", [None, "2", "3R"])
@pytest.mark.parametrize("bare", [True, False])
@pytest.mark.parametrize("safe", [True, False])
@pytest.mark.parametrize("what", ["open", "close", "uncover", "else"])
def test_light_passes_where_it_is_licensed_stated_and_where_no_plan_asks_for_it_audited(
    licence: Any, most: Any, bare: bool, safe: bool, what: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    operation = {"open": set_to("laser", "shutter", "open"), "close": set_to("laser", "shutter", "closed"),
                 "uncover": carry("gate", 300, 700), "else": set_to("cam", "exposure", 2)}[what]  # fmt: skip
    laser = {"emission": True, "shutter": "open" if what == "uncover" else "closed", "power": 4.0}
    by = {"there": Licence(laser_class="3R", by="Ada"), "3R": Licence(laser_class="3R", by="Ada", unattended=True)}
    seen = observed({"laser": by[licence]} if licence else None, laser=laser)
    audited = list[Operation]()

    def audit_of(setup: Setup, plan: Any, at: Observation, *_: Any) -> tuple[Audit, Lit]:
        audited.extend(plan.operations)
        assert at is seen
        found = Finding(kind="end", source="laser", laser_class="3R", way=(), where="a wall", power=4.0, limit=0.39)
        return Audit(findings=() if safe else (found,), lasers={}), Lit({}, {}, ("laser",), frozenset({"laser"}))

    monkeypatch.setattr(audit, "audit_of", audit_of)

    async def look() -> Observation:
        return seen

    inner = Inner()
    guarded = emission.Guarded(SETUP, inner, look, lambda: bare, lambda: most)
    result = asyncio.run(guarded.execute(operation, "run/op1/1", lambda before: None))
    lets = what in ("open", "uncover")
    code = None
    if lets:
        if licence is None:
            code = "unarmed"
        elif most is not None and (most == "2" or licence == "there"):
            code = "unattended"
        elif bare and not safe:
            code = "beam-audit"
    assert (result.outcome, result.error and result.error.code) == ("failed" if code else "done", code)
    assert inner.done == ([] if code else [operation.id]) and result.key == "run/op1/1"
    assert audited == ([operation] if lets and bare and code in (None, "beam-audit") else [])


# doses


def held(budget: float | None = 10.0) -> Setup:
    part = replace(SETUP.lab.inventory["holder"], sample="W1", dose_budget=budget)
    return replace(SETUP, lab=replace(SETUP.lab, inventory={**SETUP.lab.inventory, "holder": part}))


@pytest.mark.parametrize("before", [0.0, 1.0, 3.0])
@pytest.mark.parametrize("now", [0.0, 2.0])
@pytest.mark.parametrize("seconds", [0.0, 4.0, -5.0])
@pytest.mark.parametrize("spent", [0.0, 1.5])
def test_a_ledger_counts_the_brighter_of_then_and_now(before: float, now: float, seconds: float, spent: float) -> None:
    seen = replace(observed(laser={**LIT, "power": now} if now else {}), time=100.0 + seconds)
    was = dose.Ledger(100.0, {"W1": spent, "other": 7.0}, {"W1": before, "other": 9.0})
    after = was.until(held(), seen)
    assert after.at == seen.time and after.power == {"W1": pytest.approx(now)}
    assert after.spent == {"W1": pytest.approx(spent + max(before, now) * max(0.0, seconds)), "other": 7.0}
    fresh = dose.Ledger(100.0, {}, {}).until(held(), seen)
    assert fresh.spent == {"W1": pytest.approx(now * max(0.0, seconds))}, "nothing is known to have fallen on it before"
    assert dose.Ledger().doses(held())[0].power == 0.0
    first = dose.Ledger().until(held(), seen)
    assert first.spent == {"W1": 0.0}, "nobody knows since when"
    (told,) = after.doses(held())
    assert (told.sample, told.component, told.budget) == ("W1", "holder", 10.0)
    assert (told.spent, told.power) == (after.spent["W1"], after.power["W1"])
    assert dose.Ledger().doses(held(None))[0].budget is None and dose.Ledger().doses(held())[0].spent == 0.0


@pytest.mark.parametrize("text", [
    "", "{", "[]", "{}", "null", '{"at": null, "spent": {}, "power": {}}',
    '{"at": 1, "spent": {"a": "x"}, "power": {}}', '{"at": 1, "spent": 3, "power": {}}',
])  # fmt: skip
def test_a_ledger_that_cannot_be_read_is_never_read_as_no_light(tmp_path: Path, text: str) -> None:
    assert dose.read(bench_at(tmp_path)) == dose.Ledger()
    dose.counted(held(), bench_at(tmp_path), replace(observed(laser=LIT), time=5.0))
    path = bench_at(tmp_path).folder / "dose.json"
    assert json.loads(path.read_text())["schema"] == "pico.dose/v1"
    assert dose.read(bench_at(tmp_path)) == dose.Ledger(5.0, {"W1": 0.0}, {"W1": pytest.approx(4.0)})
    path.write_text(text)
    with pytest.raises(PicoError) as refused:
        dose.read(bench_at(tmp_path))
    found = refused.value.diagnostics[0]
    assert str(path) in found.summary and "doses" in found.detail and "mv " in found.hint


def test_a_ledger_that_is_gone_is_counted_again_from_the_journal_and_said_to_be_the_least(tmp_path: Path) -> None:
    place = bench_at(tmp_path)
    place.folder.mkdir(parents=True, exist_ok=True)
    with closing(Journal(JOURNAL.path(place.folder))) as journal:
        journal.begin_run("r1", "plan", "test")
        for number, had in enumerate(({"W1": 4.0}, {"W1": 3.0, "W2": 1.0}, {})):
            key = f"r1/op{number}/1"
            journal.intend(key, set_to("cam", "exposure", number), 1)
            journal.started(key, None, 1)
            journal.ended(OperationResult(key=key, outcome="done", data={"dose": had} if had else {}), 1)
    assert dose.read(place) == dose.Ledger(spent={"W1": 7.0, "W2": 1.0}, least=frozenset({"W1", "W2"}))
    kept = dose.counted(held(), place, replace(observed(laser=LIT), time=5.0))
    assert dose.read(place) == kept and kept.spent["W1"] == 7.0
    (one,) = kept.doses(held())
    assert one.said == "W1 in holder has had at least 7 of its 10 mJ of light"
    assert dose_policy.over(one, 4.0, 1.0), "a deleted file is no new sample"


@pytest.mark.parametrize("spent", [0.0, 9.0])
@pytest.mark.parametrize("power", [0.0, 1.0])
@pytest.mark.parametrize("seconds", [0.5, 3.0, 20.0])
def test_what_would_give_a_sample_too_much_is_not_done_and_what_it_had_is_told(
    tmp_path: Path, spent: float, power: float, seconds: float
) -> None:
    setup, laser = held(), {**LIT, "power": power} if power else {}
    clock = [100.0]

    async def look() -> Observation:
        return replace(observed(laser=laser), time=clock[0])

    path = bench_at(tmp_path).folder / "dose.json"
    path.parent.mkdir(parents=True)
    path.write_text(json.dumps({"schema": "pico.dose/v1", "at": 100.0, "spent": {"W1": spent}, "power": {"W1": power}}))

    class Slow(Inner):
        async def execute(self, operation: Operation, key: str, began: Any) -> OperationResult:
            clock[0] += operation.seconds
            return await super().execute(operation, key, began)

    inner = Slow()
    op = replace(set_to("cam", "exposure", 3), seconds=seconds, start=50.0)
    device = dose.Dosing(setup, bench_at(tmp_path), inner, look)
    result = asyncio.run(device.execute(op, "run/op1/1", lambda before: None))
    if spent + power * seconds > 10.0:
        assert (result.outcome, result.error and result.error.code, inner.done) == ("failed", "dose", [])
        assert result.ended == 100.0 and result.key == "run/op1/1"
    else:
        assert result.outcome == "done" and inner.done == ["op1"]
        had = power * seconds
        assert result.data == {"value": 1, **({"dose": {"W1": pytest.approx(had)}} if had else {})}
        assert dose.read(bench_at(tmp_path)).spent["W1"] == pytest.approx(spent + had)
