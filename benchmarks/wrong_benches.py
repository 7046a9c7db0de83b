"""Benches with one wrong thing each, which is to be named, and right ones: `python benchmarks/wrong_benches.py`.

40 benches of a `--seed` have one wrong thing each: light of a wavelength that a part is not made for, a blind detector,
a meter set to another wavelength, no polarizer behind the plate that is searched over, something shut or parked, a
search that cannot find its goal. On each the commands run that a person would use first (`validate`, `plan`, `apply`,
then `measure` or `optimize`); one message must name the part and the cause, and a wrong reading may not be assured. On
the right ones, usual setups and all states of the shipped labs, no message may be of such a kind.

`--plant NAME` (all by default, `none`) switches a check off, or lets it warn of everything: that must be noticed. The
exit code is 1 if a bar or a plant fails. `--only TEXT` runs the benches whose name has it, and shows what they said;
`--wrong N`, `--right N`: so many of each, spread over the kinds.
"""

from __future__ import annotations

import argparse
import io
import json
import os
import re
import shlex
import subprocess
import sys
import tempfile
from collections import defaultdict
from collections.abc import Iterator, Sequence
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "benchmarks")]

import yaml  # noqa: E402
from wrong_benches_drawn import Bench, wrong  # noqa: E402
from wrong_benches_plants import PLANTS, plant  # noqa: E402
from wrong_benches_right import right  # noqa: E402

from pico.history.examples.example import make_example  # noqa: E402

LAB = {
    "apiVersion": "pico/v1", "kind": "Lab", "metadata": {"name": "drawn"},
    "table": {"size": [1200, 900], "beam_height": 70}, "robots": {},
    "policy": {"arming": {"waived": ["kinematic", "physics", "emulated"]}},
    "sim": {"fidelity": "kinematic", "environment": "none", "seed": 1},
}  # fmt: skip
KIND = (
    r"wavelength|\bnm\b|blind|sees nothing|polarizer|does not change|insensitive|searched|outside|no light|dark|shut\b|"
    r"closed|switched off|storage|parked|range"
)
"""What a message is about that no right bench may bring."""
OF_SAFETY = ("beam-audit", "stray-light", "unarmed", "bench-lab", "laser-class")
"""Codes of messages that are about something else: what light may do to people, and how a bench is kept."""


@dataclass(frozen=True)
class Said:
    """One message: the command that it came by, its code, the part that it stands at, and its words."""

    command: str
    code: str
    at: str
    text: str

    def __str__(self) -> str:
        """The message in one line."""
        return f"{self.command.split()[0]}: {self.code} {self.at}: {self.text}"


@dataclass(frozen=True)
class Outcome:
    """What was said of a bench, and how each command ended."""

    said: tuple[Said, ...]
    codes: tuple[int, ...]


def lay(bench: Bench, folder: Path) -> None:
    """Write the bench as files."""
    if bench.example is None:
        inventory = {n: {k: p[k] for k in ("type", "pose", "parameters") if p[k]} for n, p in bench.parts.items()}
        state = {n: p["set"] for n, p in bench.parts.items() if p["set"]}
        folder.mkdir(parents=True)
        (folder / "state").mkdir()
        lab = LAB | {"inventory": inventory} | ({"goals": dict(bench.goals)} if bench.goals else {})
        (folder / "lab.yaml").write_text(yaml.safe_dump(lab, sort_keys=False))
        document = {"apiVersion": "pico/v1", "kind": "LabState", "metadata": {"lab": "drawn"}, "components": state}
        (folder / "state" / "table.yaml").write_text(yaml.safe_dump(document, sort_keys=False))
        return
    make_example(bench.example[0], folder)
    subprocess.run(["git", "checkout", "-q", f"tags/{bench.example[1]}"], cwd=folder, check=True)
    for name, more in bench.parts.items():
        if parameters := more.get("parameters"):
            edit(folder / "lab.yaml", "inventory", name, "parameters", parameters)
        if values := more.get("set"):
            (path,) = (
                p for p in (folder / "state").glob("*.yaml") if name in yaml.safe_load(p.read_text())["components"]
            )
            for key, value in values.items():
                edit(path, "components", name, key, value)


def edit(path: Path, section: str, name: str, key: str, value: Any) -> None:
    """Change one key of a component in a YAML file."""
    document = yaml.safe_load(path.read_text())
    document[section][name][key] = value
    path.write_text(yaml.safe_dump(document, sort_keys=False))


def command(words: Sequence[str]) -> int:
    """Run a command of PICO in the present folder, and return its exit code."""
    from cli.main import main

    try:
        return int(main(list(words)) or 0)
    except SystemExit as exc:
        return int(exc.code or 0)


def look(bench: Bench, folder: Path) -> Outcome:
    """Run the bench's commands on it and return what was said."""
    here = Path.cwd()
    folder.parent.mkdir(parents=True, exist_ok=True)
    try:
        lay(bench, folder)
        os.chdir(folder)
        said, codes = [], []
        for words in bench.commands:
            out, err = io.StringIO(), io.StringIO()
            with redirect_stdout(out), redirect_stderr(err):
                answer = () if words.startswith("optimize") else ("--json",)  # its warnings are for people
                codes.append(command([*shlex.split(words), *answer]))
            said += list(messages(words, out.getvalue(), err.getvalue()))
        return Outcome(tuple(dict.fromkeys(said)), tuple(codes))
    finally:
        os.chdir(here)


def messages(words: str, out: str, err: str) -> Iterator[Said]:
    """Yield what a command said: its diagnostics, and what its measurements do not assure or do not know."""
    for line in out.splitlines():
        try:
            document = json.loads(line)
        except ValueError:
            continue
        yield from _walk(words, document)
    for block in re.findall(r"(?ms)^(?:error|warning|note)\[[a-z0-9-]+\].*?(?=^(?:error|warning|note)\[|\Z)", err):
        code = block.partition("[")[2].partition("]")[0]
        yield Said(words, code, "", " ".join(block.split()))


def _walk(words: str, node: Any) -> Iterator[Said]:
    if isinstance(node, list):
        for one in node:
            yield from _walk(words, one)
    if not isinstance(node, dict):
        return
    if {"severity", "summary"} <= node.keys():
        text = f"{node['summary']} {node.get('detail') or ''} {node.get('hint') or ''}".strip()
        yield Said(words, str(node.get("code", "")), str(node.get("address", "")), text)
        return
    component = str(node.get("component", ""))
    lacking = node.get("not_assured")
    for key, why in (lacking or {}).items() if isinstance(lacking, dict) else ():
        yield Said(words, "not-assured", component, f"{key}: {why}")
    if why := node.get("unknown"):
        yield Said(words, "unknown", component, json.dumps(why) if isinstance(why, dict) else str(why))
    for key, one in node.items():
        if key != "not_assured":
            yield from _walk(words, one)


def names(bench: Bench, said: Said) -> bool:
    """Whether a message names the part and the cause."""
    if said.code in OF_SAFETY or not re.search(bench.cause, said.text, re.IGNORECASE):
        return False
    words = re.findall(r"[A-Za-z_][A-Za-z_0-9]*", f"{said.at} {said.text}")
    return any(name in words for name in bench.named)


def complains(said: Said) -> bool:
    """Whether a message is of the kind that no right bench may bring."""
    return said.code not in OF_SAFETY and bool(re.search(KIND, f"{said.code} {said.text}", re.IGNORECASE))


def faults(bench: Bench, outcome: Outcome) -> list[str]:
    """Return what is not as it should be with a bench."""
    if bench.named:
        found = []
        if not any(names(bench, one) for one in outcome.said):
            found.append(f"{' or '.join(bench.named)} is not named with its cause ({bench.cause})")
        of_reading = [one for one in outcome.said if one.command == bench.commands[-1]]
        if bench.reading == "unknown" and not any(one.code == "unknown" for one in of_reading):
            found.append("a blind detector shows a number")
        doubted = (one.code in ("unknown", "not-assured") and complains(one) for one in of_reading)
        if bench.reading == "doubted" and not any(doubted):
            found.append("the reading is shown as assured")
        return found
    found = [str(one) for one in outcome.said if complains(one)]
    return found or ([f"{bench.commands[n]} ended with {c}" for n, c in enumerate(outcome.codes) if c not in (0, 2)])


def judged(benches: Sequence[Bench], show: bool = False) -> list[list[str]]:
    """Run benches, each in a folder of its own, and return their faults."""
    found = []
    with tempfile.TemporaryDirectory(prefix="wrong-benches-") as scratch:
        for number, bench in enumerate(benches):
            outcome = look(bench, Path(scratch) / str(number) / "lab")
            found.append(faults(bench, outcome))
            if show:
                print(f"{bench.name}: {'; '.join(found[-1]) or 'as it should be'} (exit codes {outcome.codes})")
                print(*(f"    {one}" for one in outcome.said), sep="\n")
    return found


def spread(items: Sequence[Any], most: int | None) -> list[Any]:
    """Return so many of the items at most, evenly taken."""
    if most is None or most >= len(items):
        return list(items)
    return [items[n * len(items) // most] for n in range(most)]


def main(words: Sequence[str] | None = None) -> int:
    """Run all, plant faults, and return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--wrong", type=int)
    parser.add_argument("--right", type=int)
    parser.add_argument("--only", metavar="TEXT")
    parser.add_argument("--plant", default="all", choices=["all", "none", *PLANTS])
    options: Any = parser.parse_args(words)
    bad, good = wrong(options.seed), right(options.seed)
    if options.only is not None:
        benches = [b for b in (*(b for _, b in bad), *good) if options.only in b.name]
        return int(any(judged(benches, show=True)))
    bad, good = spread(bad, options.wrong), spread(good, options.right)
    base = judged([b for _, b in bad])
    by_kind = defaultdict(list)
    for (kind, bench), lacking in zip(bad, base, strict=True):
        by_kind[kind].append((bench, lacking))
    print(f"seed {options.seed}")
    for kind, of in by_kind.items():
        print(f"{kind:16} named in {sum(not f for _, f in of)} of {len(of)}")
        for name, lacking in ((bench.name, lacking) for bench, lacking in of if lacking):
            print(f"    {name}: {'; '.join(lacking)}")
    clear = judged(good)
    for bench, false in zip(good, clear, strict=True):
        for one in false:
            print(f"    {bench.name}: {one}")
    named, silent = sum(not f for f in base), sum(not f for f in clear)
    print(f"{'holds' if named == len(bad) else 'FAILS':6} named in {named} of {len(bad)} wrong benches")
    print(f"{'holds' if silent == len(good) else 'FAILS':6} nothing said of {silent} of {len(good)} right benches")
    ok = named == len(bad) and silent == len(good)
    for name in {"all": list(PLANTS), "none": []}.get(options.plant, [options.plant]):
        ok &= caught(name, bad, base, good, clear)
    return 0 if ok else 1


def caught(name: str, bad: Sequence[Any], base: Sequence[Any], good: Sequence[Bench], clear: Sequence[Any]) -> bool:
    """Plant a fault, run what it is about, and print and return whether a bench that was judged well no longer is."""
    kinds = PLANTS[name].kinds
    well = [b for (kind, b), f in zip(bad, base, strict=True) if kind in kinds and not f]
    if not kinds:
        well = spread([b for b, f in zip(good, clear, strict=True) if not f and not b.example], 6)
    try:
        with plant(name):
            lost = sum(map(bool, judged(well)))
    except LookupError as exc:
        lost, well = 0, []
        print(f"  {exc}")
    print(f"{'caught' if lost else 'MISSED':6} {name}: on {lost} of {len(well)} benches", flush=True)
    return bool(lost)


if __name__ == "__main__":
    sys.exit(main())
