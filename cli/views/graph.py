"""A plan as a graph: as DOT, as Mermaid, and for people the operations that decide when it ends."""

from __future__ import annotations

from typing import Any

from pico.model.operation import Operation
from pico.model.plan import Plan
from pico.model.record import as_json
from pico.planning.explaining.graph import Dependency, PlanGraph, ScheduledOperation

from .plan import arms, change_of, header, what
from .style import columns, count, paint, seconds

_RED = "#c62828"


NAMES_BENCH = True
"""The first line says on which bench the plan is."""


def text(plan: Plan, graph: PlanGraph, *, head: str = "", goal: str = "", next_step: str = "") -> str:
    """Return the makespan, the operations on the critical path in their order, and what the others have to spare."""
    lines = [header(plan, head, goal), ""]
    if not graph.nodes:
        return "\n".join([*lines, "  No operations, so there is nothing to draw."])
    critical = [n for n in graph.nodes if n.critical]
    others = [n for n in graph.nodes if not n.critical]
    lines.append(
        f"  Critical path: {count(len(critical), 'operation')}, {seconds(graph.length)}; the plan ends when they do."
    )
    lines += ["", *_table(plan, critical, False)]
    if others:
        lines += ["", "  Beside it, with the time by which each may be late:", "", *_table(plan, others, True)]
    ends = f"{seconds(plan.makespan)} in all · {count(len(graph.nodes), 'operation')}"
    return "\n".join([*lines, "", f"  {ends}", *(["", next_step] if next_step else [])])


def _table(plan: Plan, nodes: list[ScheduledOperation], spare: bool) -> list[str]:
    rows, several = [], len(arms(plan)) > 1
    for n in nodes:
        op = n.operation
        cells = [paint("red" if n.critical else "dim", op.id), op.address, what(op, change_of(plan, op))]
        cells += [op.robot or ""] if several else []
        cells += [f"at {seconds(op.start)}", f"{seconds(op.seconds):>6}"]
        rows.append([*cells, f"may be {seconds(n.spare)} late"] if spare else cells)
    return columns(rows, indent="  ")


def data(plan: Plan, graph: PlanGraph, **_: Any) -> dict[str, Any]:
    """Return schema `pico.graph/v1`: `makespan`, `length`, `path`, `nodes` and `edges`."""
    nodes = [as_json(n) | {"operation": n.operation.id} for n in graph.nodes]
    for node, n in zip(nodes, graph.nodes, strict=True):
        op = n.operation
        node |= {"label": _label(plan, op), "start": op.start, "seconds": op.seconds, "resources": list(op.resources)}
    return {"schema": "pico.graph/v1", **as_json(graph), "nodes": nodes}


def _label(plan: Plan, op: Operation) -> str:
    return f"{op.address} {what(op, change_of(plan, op))}"


def _times(op: Operation) -> str:
    used = ", ".join(r for r in op.resources if r != op.component)
    return f"{op.start:.1f} to {op.start + op.seconds:.1f} s" + (f", {used}" if used else "")


def dot(plan: Plan, graph: PlanGraph) -> str:
    """Return the graph in Graphviz's DOT: solid edges wait for an operation, dashed ones for a resource, red ones are
    the critical path. Edges that others imply are left out."""
    title = f"{plan.lab.name}: {seconds(plan.makespan)}, critical path red"
    lines = [
        "digraph plan {",
        "  rankdir=LR;",
        f"  label={_quoted(title)};",
        '  node [shape=box, style=rounded, fontname="Helvetica", fontsize=11];',
        '  edge [fontname="Helvetica", fontsize=9, color="#607080"];',
    ]
    for n in graph.nodes:
        op = n.operation
        label = _quoted(f"{op.id}  {_label(plan, op)}\n{_times(op)}")
        strong = f', color="{_RED}", penwidth=2' if n.critical else ""
        lines.append(f"  {_quoted(op.id)} [label={label}{strong}];")
    lines += [f"  {_quoted(e.source)} -> {_quoted(e.target)}{_dot_style(e)};" for e in graph.edges if not e.implied]
    return "\n".join([*lines, "}"])


def _dot_style(edge: Dependency) -> str:
    style = [] if edge.after else ["style=dashed", f"label={_quoted(', '.join(edge.resources))}"]
    if edge.critical:
        style += [f'color="{_RED}"', "penwidth=2"]
    return f" [{', '.join(style)}]" if style else ""


def _quoted(words: str) -> str:
    escaped = words.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
    return f'"{escaped}"'


def mermaid(plan: Plan, graph: PlanGraph) -> str:
    """Return the graph as a Mermaid flowchart; edges and colors mean what they do in `dot`."""
    lines = ["flowchart LR"]
    for n in graph.nodes:
        label = f"{n.operation.id}  {_label(plan, n.operation)}<br/>{_times(n.operation)}"
        lines.append(f'  {n.operation.id}["{label.replace(chr(34), "#quot;")}"]')
    drawn = [e for e in graph.edges if not e.implied]
    for e in drawn:
        arrow = "-->" if e.after else f'-. "{", ".join(e.resources)}" .->'
        lines.append(f"  {e.source} {arrow} {e.target}")
    if graph.path:
        lines += [f"  classDef critical stroke:{_RED},stroke-width:3px", f"  class {','.join(graph.path)} critical"]
    if red := [str(i) for i, e in enumerate(drawn) if e.critical]:
        lines.append(f"  linkStyle {','.join(red)} stroke:{_RED},stroke-width:3px")
    return "\n".join(lines)
