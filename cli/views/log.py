"""Commits with what each changed on the table."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from itertools import chain, islice
from typing import TYPE_CHECKING, Any

from pico.history.git.commit import Commit
from pico.history.git.lanes import RailRow, lanes, places
from pico.history.lab.folder import CommitEntry
from pico.history.messages.default import default_message
from pico.history.messages.trailers import meta, without_trailers
from pico.model.record import as_json
from pico.model.trace.run import Run

from .diff import brief, lines
from .runs import shown
from .style import columns, count, on_bench, pad, paint, printable, seconds, wide, width, wrap

FEW = 2
"""Runs of a commit that are told one by one where it has a line; more are summed up."""
CHANGES = 8
"""Lines about what a commit changed, at most; `pico show` has them all."""

if TYPE_CHECKING:
    from pico.history.lab.notes import Note
    from pico.history.log import Log


def text(log: Log, *, graph: bool, oneline: bool, head: str | None = None) -> str:
    """Return the commits, newest first, with a rail of the branches where `graph`; `head` is the one checked out."""
    return "\n".join(blocks(log, graph=graph, oneline=oneline, head=head)).rstrip()


def blocks(log: Log, *, graph: bool, oneline: bool, head: str | None = None) -> Iterator[str]:
    """Yield the text of `text` in pieces, each when its commit has been read."""
    if graph:
        yield from _railed(log, head)
        return
    commits = log.commits()
    first = list(islice(commits, 50 if oneline else 1))
    if not first:
        yield _none(log)
        return
    render = _short(first, head) if oneline else _long
    for commit in chain(first, commits):
        yield "\n".join(render(log.entry(commit), wide()))


def _railed(log: Log, head: str | None) -> Iterator[str]:
    """Yield lines with the rail before them."""
    commits = list(log.commits())
    if not commits:
        yield _none(log)
    rows = lanes(commits)
    render = _short(commits, head)
    for i, row in enumerate(rows):
        if row.commit is None:
            yield row.rail.rstrip()
            continue
        first, *rest = render(log.entry(row.commit), wide() - len(row.rail) - 1)
        below = _below(rows, i)
        yield "\n".join([f"{row.rail} {first}", *(f"{below}{line}".rstrip() for line in rest)])


def _none(log: Log) -> str:
    asked = log.asked
    if asked.scope or asked.options or asked.revisions:
        return "No commit among these changed that." if asked.scope else "No commit is like that."
    return "No commit has touched this lab yet."


def _below(rows: list[RailRow], i: int) -> str:
    """Return the rail under a commit: its own line of history goes on where it has a parent on the rail."""
    rail = rows[i].rail
    ends = i + 1 >= len(rows) or rows[i + 1].rail[rail.index("*") : rail.index("*") + 1] in ("", " ")
    return rail.replace("*", " " if ends else "|") + " "


def _short(commits: Sequence[Commit], checked_out: str | None) -> Callable[[CommitEntry, int], list[str]]:
    """Return a function from a commit to one line: name, message, motions, proof; more where they do not fit."""
    names = min(max((width(_name(c, checked_out)) for c in commits), default=0), 24)
    room = min(max((width(printable(c.summary)) for c in commits), default=0), 44)

    def render(entry: CommitEntry, columns: int) -> list[str]:
        name = _name(entry.commit, checked_out)
        head = f"{pad(paint('yellow', name), names)}  {pad(printable(entry.commit.summary), room)}"
        what, proof = _what(entry), " · ".join(proofs(entry))
        if width(head) + 2 + width(what) + (3 + width(proof) if proof else 0) <= columns:
            return [f"{head}  {paint('cyan', what)}{paint('dim', f' · {proof}' if proof else '')}".rstrip()]
        indent = " " * (names + 2)
        lines = [*(paint("cyan", line) for line in wrap(what, indent, columns))]
        return [head.rstrip(), *lines, *([indent + paint("dim", proof)] if proof else [])]

    return render


def _name(commit: Commit, checked_out: str | None) -> str:
    name = ", ".join(list(dict.fromkeys(commit.refs))[:2]) or commit.short
    return f"{name} (HEAD)" if commit.id == checked_out else name


def _what(entry: CommitEntry) -> str:
    if entry.shallow:
        return entry.unreadable
    if entry.unreadable:
        return f"can't be read: {entry.unreadable}"
    if not entry.changes:
        return "no change on the table"
    if entry.first:
        moved = sum(c.tunable == "pose" for c in entry.changes)
        values = len(entry.changes) - moved
        parts = [count(moved, "component") + " away from home"] * bool(moved) + [
            count(values, "tunable") + " set"
        ] * bool(values)
        return f"the first state: {', '.join(parts)}"
    return brief(entry.changes)


def _long(entry: CommitEntry, _: int) -> list[str]:
    what = [f"  {_what(entry)}"] if entry.unreadable or not entry.changes else _first(lines(entry.changes), entry)
    return [*header(entry, brief=True), "", *what, *evidence_lines(entry, CHANGES), ""]


def _first(told: list[str], entry: CommitEntry) -> list[str]:
    """Return the first of the lines about a commit, and how the rest is found."""
    more = len(told) - CHANGES + 1
    return told if more < 2 else [*told[: CHANGES - 1], f"    and {more} more: `pico show {entry.commit.short}`"]


def header(entry: CommitEntry, *, brief: bool = False) -> list[str]:
    """Return id, names, author, date and message of a commit, without the trailers that PICO wrote; where it is to be
    `brief`, without what PICO wrote of the changes, which follow."""
    c = entry.commit
    refs = f" ({', '.join(c.refs)})" if c.refs else ""
    head = [paint("yellow", f"commit {c.short}{refs}"), printable(f"{c.author}, {c.time:%Y-%m-%d %H:%M}")]
    recorded = [printable(f"    {key}: {value}") for key, value in meta(c.message).items()]
    message = without_trailers(c.message)
    message = c.summary if brief and message == default_message(entry.changes) else message
    return [*head, "", *wrap(printable(message), "    "), *([""] if recorded else []), *recorded]


def noted(part: str, notes: Sequence[Note]) -> str:
    """Return the notes on a part, oldest first."""
    rows = [[note.day, printable(note.author), printable(note.text)] for note in notes]
    return "\n".join([paint("bold", f"Notes on {part}:"), *columns(rows, indent="  "), ""])


def proofs(entry: CommitEntry) -> list[str]:
    """Return in a few words how far the state of a commit is proven, and how its runs ended."""
    inherited = entry.standing is not None and entry.standing.verdict == "inherited"
    evidence = ["inherited"] if inherited else [entry.evidence] if entry.evidence else []
    return [*evidence, *([ended(*entry.runs)] if len(entry.runs) > FEW else map(ended, entry.runs))]


def evidence_lines(entry: CommitEntry, most: int | None = None) -> list[str]:
    """Return lines with the evidence for a commit, and for each of its runs how it ended and what did not hold; of more
    than `most` runs together how they ended."""
    found = []
    standing = entry.standing
    if standing and standing.verdict != "unknown":
        by = f" ({on_bench(standing.evidence, standing.bench)})" if standing.evidence else ""
        found += wrap(f"{paint('dim', standing.verdict)}{by}: {shown(standing.why)}", "  ")
    if most is not None and len(entry.runs) > most:
        return [*found, f"  {ended(*entry.runs)}: `pico show {entry.commit.short}`"]
    for run in entry.runs:
        color = "green" if run.outcome == "done" else "red"
        by = on_bench(run.evidence, run.bench)
        found.append(f"  {paint('dim', f'run {shown(run.id)}')}: {paint(color, ended(run))} ({by})")
        for one in run.expectations:
            if not one.holds:
                verb = "failed" if one.holds is False else "could not be told" if one.assured else "was not assured"
                said = f"{one.message}: `{one.that}`" if one.message else f"`{one.that}`"
                found.append(f"    {paint('red', '✗')} {shown(said)} {verb}")
    return found


def ended(*runs: Run) -> str:
    """Return how a run ended: `5 operations done, 31 s`; of several together with how many they are."""
    tally, ends = Counter[str](), Counter(run.outcome for run in runs if run.outcome != "done")
    for run in runs:
        tally.update(run.tally)
    done = tally.pop("done", 0)
    words = [f"{number} {outcome}" for outcome, number in tally.items() if number]
    broken = sum(e.failed for run in runs for e in run.expectations)
    words += [f"{count(broken, 'expectation')} failed"] if broken else []
    several = len(runs) > 1
    end = [count(len(runs), "run")] * several + [
        f"{n} {outcome}" if several else outcome for outcome, n in ends.items()
    ]
    return ", ".join([*end, f"{count(done, 'operation')} done", *words, seconds(sum(run.seconds for run in runs))])


def data(log: Log, *, graph: bool, oneline: bool, head: str | None = None) -> dict[str, Any]:
    """Return schema `pico.log/v1`: `head`, and `commits`: id, parents, refs, author, time, message, changes, evidence,
    verdict, runs, meta; with `graph` also rail, and as numbers the lane with the links to the row below."""
    commits = list(log.commits())
    rails = {r.commit.id: r.rail for r in lanes(commits) if r.commit} if graph else {}
    drawn = {name: as_json(place) | {"rail": rails[name]} for name, place in places(commits).items()} if graph else {}
    shown = [entry_data(log.entry(c)) | drawn.get(c.id, {}) for c in commits]
    return {"schema": "pico.log/v1", "head": head, "commits": shown}


def entry_data(entry: CommitEntry) -> dict[str, Any]:
    """Return one commit with its physical diff as JSON data."""
    c = entry.commit
    runs = [
        {"id": run.id, "outcome": run.outcome, "bench": run.bench, "evidence": run.evidence, "seconds": run.seconds,
         "tally": run.tally, "expectations": as_json(run.expectations)}
        for run in entry.runs
    ]  # fmt: skip
    return {
        "id": c.id, "parents": list(c.parents), "refs": list(c.refs), "author": c.author, "time": c.time.isoformat(),
        "message": c.message, "changes": as_json(entry.changes), "evidence": entry.evidence,
        "bench": entry.standing.bench if entry.standing else None,
        "verdict": entry.standing.verdict if entry.standing else "", "runs": as_json(runs),
        "meta": meta(c.message),
    } | ({"unreadable": entry.unreadable} if entry.unreadable else {})  # fmt: skip
