"""`pico plan --graph`: DOT and Mermaid that other programs read, and a screen that names what decides the end."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

from commanding import Pico
from pico_cli.views import graph as view

from pico.model.plan import Plan, plan_from_json
from pico.planning.explaining.graph import graph_of

ID = r'"(?:[^"\\\n]|\\.)*"'
VALUE = rf"(?:{ID}|[A-Za-z0-9.]+)"
ATTRIBUTES = rf"\[\w+={VALUE}(?:, \w+={VALUE})*\]"
STATEMENT = re.compile(rf"  (?:\w+={VALUE}|(?:node|edge) {ATTRIBUTES}|{ID}(?: -> {ID})?(?: {ATTRIBUTES})?);")
NODE = re.compile(r'  (\w+)\["([^"\n]*)"\]')
ARROW = re.compile(r'  (\w+) (?:-->|-\. "[^"\n]*" \.->) (\w+)')


def saved(pico: Pico, folder: Path) -> Plan:
    pico("plan", "e1", "--out", "e1.plan")
    return plan_from_json((folder / "e1.plan").read_text())


def test_dot_is_well_formed_and_marks_the_critical_path(shel: Path, pico: Pico) -> None:
    plan = saved(pico, shel)
    first, *lines, last = pico("plan", "e1.plan", "--graph", "--format", "dot").out.splitlines()
    assert (first, last) == ("digraph plan {", "}")
    for line in lines:
        assert STATEMENT.fullmatch(line), line
    nodes = {m[1] for line in lines if (m := re.match(r'  "(\w+)" \[', line))}
    assert nodes == {o.id for o in plan.operations}
    assert {e for line in lines for e in re.findall(r'  "(\w+)" -> "(\w+)"', line)} <= {
        (a, b) for a in nodes for b in nodes
    }
    red = {m[1] for line in lines if (m := re.match(r'  "(\w+)" \[.*penwidth=2', line))}
    assert red == set(graph_of(plan).path)


def test_mermaid_is_well_formed_and_marks_the_critical_path(shel: Path, pico: Pico) -> None:
    plan = saved(pico, shel)
    first, *lines = pico("plan", "e1.plan", "--graph", "--format", "mermaid").out.splitlines()
    assert first == "flowchart LR"
    nodes = [m[1] for line in lines if (m := NODE.fullmatch(line))]
    arrows = [m.groups() for line in lines if (m := ARROW.fullmatch(line))]
    assert nodes == [o.id for o in plan.operations]
    assert all(a in nodes and b in nodes for a, b in arrows)
    define, classes, links = lines[len(nodes) + len(arrows) :]
    assert define.startswith("  classDef critical ")
    assert classes == f"  class {','.join(graph_of(plan).path)} critical"
    numbers = [int(n) for n in links.split()[1].split(",")]
    assert [arrows[n] for n in numbers] and all(set(arrows[n]) <= set(graph_of(plan).path) for n in numbers)


def test_quotes_and_backslashes_in_a_value_break_neither(shel: Path, pico: Pico) -> None:
    plan = saved(pico, shel)
    odd = replace(plan.changes[0], text='say "a\\b" → ]')
    plan = replace(plan, changes=tuple(odd if c.tunable == odd.tunable else c for c in plan.changes))
    graph = graph_of(plan)
    assert all(STATEMENT.fullmatch(line) for line in view.dot(plan, graph).splitlines()[1:-1])
    assert len([line for line in view.mermaid(plan, graph).splitlines() if NODE.fullmatch(line)]) == len(graph.nodes)


def test_the_screen_names_the_makespan_and_what_decides_it(shel: Path, pico: Pico) -> None:
    plan = saved(pico, shel)
    screen = pico("plan", "e1.plan", "--graph")
    assert screen.code == 0
    assert f"{plan.makespan:.1f} s in all" in screen.out
    critical, beside = screen.out.split("Beside it")
    assert "lx_125  " in critical and "arm1 " in critical
    assert "hwp.angle" in beside and "late" in beside
    data = pico("plan", "e1.plan", "--graph", "--json").data
    assert data["schema"] == "pico.graph/v1"
    assert abs(data["length"] - plan.makespan) < 1e-3


def test_a_file_gets_the_format_of_its_name(shel: Path, pico: Pico) -> None:
    assert "to plan.mmd" in pico("plan", "e1", "--graph", "--out", "plan.mmd").out
    assert (shel / "plan.mmd").read_text().startswith("flowchart LR\n")
    pico("plan", "e1", "--graph", "--out", "plan.dot")
    assert (shel / "plan.dot").read_text().startswith("digraph plan {\n")
    wrong = pico("plan", "e1", "--graph", "--format", "svg")
    assert wrong.code == 1 and "--format can't be `svg`" in wrong.err
