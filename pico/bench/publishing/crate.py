"""The description of what is published: an RO-Crate 1.1 (w3id.org/ro/crate/1.1) that is a Process Run Crate 0.5.

Written by hand, for it must come out the same each time; entities refer to each other by `@id`.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator, Mapping
from typing import Any
from urllib.parse import quote

from pico.base import clock
from pico.bench.publishing.parts import File, Revision
from pico.model.trace.run import Run
from pico.runs.files import run_folder

NAME = "ro-crate-metadata.json"
SPECIFICATION, PROFILE = "https://w3id.org/ro/crate/1.1", "https://w3id.org/ro/wfrun/process/0.5"
Entity = dict[str, Any]

EVIDENCE: Mapping[str, str] = {
    "planned": "no run is known that led to this state",
    "kinematic": "simulated: paths with collision checks; nothing was measured on a real table",
    "physics": "simulated with contacts and friction; nothing was measured on a real table",
    "emulated": "drivers of the devices against emulators; nothing was measured on a real table",
    "hardware": "done on the real table",
}
"""What each evidence means, to somebody who does not know PICO."""
_TERMS = {"sha256": "http://schema.org/sha256"}
"""What the context of RO-Crate 1.1 does not know yet, as that of 1.2 does."""
_TRAILER = re.compile(r"\n[A-Z][A-Za-z-]+: .*")
_SLUG = re.compile(r"[^a-z0-9]+")


def metadata(revision: Revision) -> bytes:
    """Return the content of `ro-crate-metadata.json`."""
    entities = {e["@id"]: e for e in _entities(revision)}
    root = [entities.pop(NAME), entities.pop("./")]
    graph = [*root, *(entities[name] for name in sorted(entities))]
    document = {"@context": [f"{SPECIFICATION}/context", _TERMS], "@graph": graph}
    return (json.dumps(document, indent=2, ensure_ascii=False, sort_keys=True) + "\n").encode()


def folders(files: Iterable[str]) -> dict[str, list[str]]:
    """Return what each folder directly holds (`./` is the root), by path; folders end with `/`."""
    found: dict[str, list[str]] = {}
    for path in files:
        steps = path.split("/")
        for n in range(len(steps)):
            holder = "/".join(steps[:n]) + "/" if n else "./"
            held = "/".join(steps[: n + 1]) + ("/" if n + 1 < len(steps) else "")
            if held not in found.setdefault(holder, []):
                found[holder].append(held)
    return found


def _entities(revision: Revision) -> Iterator[Entity]:
    yield {"@id": NAME, "@type": "CreativeWork", "about": _ref("./"), "conformsTo": _ref(SPECIFICATION)}
    yield {"@id": PROFILE, "@type": "CreativeWork", "name": "Process Run Crate", "version": "0.5"}
    held = folders(f.path for f in revision.files)
    yield _root(revision, held.pop("./"))
    for path, inside in held.items():
        yield {"@id": quote(path), "@type": "Dataset", "name": _title(path, revision), "hasPart": _refs(inside)}
    yield from (_file(f) for f in revision.files)
    yield from _license(revision)
    yield _person(_author(revision))
    for evidence in sorted({revision.evidence, *(run.evidence for run in revision.runs)}):
        yield _evidence(evidence)
    for run in revision.runs:
        yield from _run(revision, run)


def _root(revision: Revision, inside: list[str]) -> Entity:
    commit, lab = revision.commit, revision.setup.lab
    said = "; ".join(
        f"{c.component}{'' if c.tunable == 'pose' else f'.{c.tunable}'} {c.text}" for c in revision.changes
    )
    message = _TRAILER.sub("", f"\n{commit.message}").strip()
    entity = {
        "@id": "./",
        "@type": "Dataset",
        "conformsTo": _ref(PROFILE),
        "name": f"{lab.title or lab.name}: {commit.summary}",
        "description": f"State of the optical table {lab.name} at the commit {commit.id}: {message}\n"
        f"Against the commit before: {said or 'nothing differs'}.\nEvidence: {EVIDENCE[revision.evidence]}.",
        "identifier": commit.id,
        "datePublished": commit.time.isoformat(),
        "author": _ref(_person(_author(revision))["@id"]),
        "license": _ref(next(_license(revision))["@id"]),
        "additionalProperty": _ref(f"#evidence-{revision.evidence}"),
        "hasPart": _refs(inside),
    }
    return entity | ({"mentions": _refs(_action(run) for run in revision.runs)} if revision.runs else {})


def _file(file: File) -> Entity:
    return {
        "@id": quote(file.path),
        "@type": "File",
        "name": file.name,
        "encodingFormat": file.media_type,
        "contentSize": str(file.size),
        "sha256": file.sha256,
    }


def _run(revision: Revision, run: Run) -> Iterator[Entity]:
    """Yield the action that a run was, and what it was done by and with."""
    files = (f.path for f in revision.files if f.path.startswith(f"{run_folder(run)}/"))
    software = [_software(name, version) for name, version in sorted(run.versions.items())]
    yield from software
    own = next((s["@id"] for s in software if s["name"] == "pico"), "#pico")
    needed = [s["@id"] for s in software if s["@id"] != own]
    pico = _software("pico", run.versions.get("pico", "unknown")) | {"@id": own}
    yield pico | ({"softwareRequirements": [_ref(name) for name in needed]} if needed else {})
    bench = _bench(revision, run)
    yield bench
    done = run.outcome == "done"
    reached = ["state.json"] if run.state_after == revision.state else []
    entity = {
        "@id": _action(run),
        "@type": "CreateAction",
        "name": f"{run.cause.kind or 'run'}: {run.goal or run.id}",
        "description": f"{EVIDENCE[run.evidence]}; {_tally(run)}",
        "instrument": [_ref(own), _ref(bench["@id"])],
        "object": _ref("lab/"),
        "result": _refs([*files, *reached]),
        "startTime": _time(run.started_at),
        "actionStatus": f"http://schema.org/{'Completed' if done else 'Failed'}ActionStatus",
        "additionalProperty": _ref(f"#evidence-{run.evidence}"),
    }
    entity |= {"endTime": _time(run.ended_at)} if run.ended_at else {}
    entity |= {} if done else {"error": f"it ended {run.outcome}"}
    if run.operator:
        person = _person(run.operator)
        yield person
        entity["agent"] = _ref(person["@id"])
    yield entity


def _bench(revision: Revision, run: Run) -> Entity:
    """Return the bench: a simulated one is software, a real one a thing."""
    simulated = run.evidence in ("kinematic", "physics", "emulated")
    lab = revision.setup.lab
    robots = ", ".join(f"{name} ({robot.model})" for name, robot in sorted(lab.robots.items()))
    width, depth = lab.table.size
    return {
        "@id": f"#bench-{run.evidence}",
        "@type": "SoftwareApplication" if simulated else "IndividualProduct",
        "name": f"bench {lab.name}{', simulated' if simulated else ''}",
        "description": f"table of {width:g} x {depth:g} mm, {robots}; {EVIDENCE[run.evidence]}",
    } | ({"softwareVersion": run.lab.digest} if simulated else {"identifier": run.lab.digest})


def _software(name: str, version: str) -> Entity:
    entity = {"@type": "SoftwareApplication", "name": name, "softwareVersion": version}
    if name in ("pico", "python"):
        where = {"url": "https://www.python.org/"} if name == "python" else {}
        return {"@id": f"#{_slug(name)}-{_slug(version)}", **entity, **where}
    package = f"pkg:pypi/{quote(name)}@{quote(version)}"  # a package URL (purl), which names no host
    return {"@id": package, **entity, "identifier": package}


def _license(revision: Revision) -> Iterator[Entity]:
    path = revision.license
    if path is None:
        text = "The laboratory states no license: ask the author before using this."
        yield {"@id": "#no-license", "@type": "CreativeWork", "name": "No license stated", "description": text}
        return
    file = next(f for f in revision.files if f.path == path)
    first = next(
        (line.strip() for line in (file.content or b"").decode(errors="replace").splitlines() if line.strip()), ""
    )
    yield _file(file) | {
        "@type": ["File", "CreativeWork"],
        "name": first[:120] or "License",
        "description": f"see {path}",
    }


def _evidence(evidence: str) -> Entity:
    return {
        "@id": f"#evidence-{evidence}",
        "@type": "PropertyValue",
        "name": "evidence",
        "value": evidence,
        "description": EVIDENCE[evidence],
    }


def _person(name: str) -> Entity:
    return {"@id": f"#person-{_slug(name)}", "@type": "Person", "name": name}


def _author(revision: Revision) -> str:
    """Return the author's name; the address stays out of what everybody can read."""
    return revision.commit.author.partition(" <")[0] or "unknown"


def _title(path: str, revision: Revision) -> str:
    known = {
        "lab/": "the manifests",
        "catalog/": "component types of PICO",
        "pictures/": "the table as it should stand",
    }
    run = next((r for r in revision.runs if path == f"{run_folder(r)}/"), None)
    return f"run {run.id}: {run.goal}" if run else known.get(path, path.rstrip("/"))


def _tally(run: Run) -> str:
    counted = ", ".join(f"{n} {how}" for how, n in sorted(run.tally.items()) if n)
    return f"operations: {counted or 'none'}; {run.seconds:g} s on the clock of the bench"


def _time(moment: str) -> str:
    """Return a moment with its offset in digits, for not every reader knows `Z`."""
    return clock.parse(moment).isoformat(timespec="milliseconds")


def _action(run: Run) -> str:
    return f"#run-{quote(run.id)}"


def _refs(names: Iterable[str]) -> list[Entity] | Entity:
    """Return references to entities; one alone stands for itself."""
    found = [_ref(name if name.startswith("#") else quote(name)) for name in names]
    return found[0] if len(found) == 1 else found


def _ref(name: str) -> Entity:
    return {"@id": name}


def _slug(name: str) -> str:
    return _SLUG.sub("-", name.lower()).strip("-") or "unknown"
