"""Nights in which one to four things happen to a bench, or none, and what `pico morning` makes of them.

    python benchmarks/nights.py [--nights 20] [--quiet 4] [--seed 1] [--only K] [--lab fiber shel pickoff]
    python benchmarks/nights.py --overnight [--plant NAME|all]

Each bench (tests/labs/fiber, labs/shel, `morning_lab.py`) is set up in the kinematic twin, aligned, and accepted as the
reference once. Each night starts from a copy of that evening: nine hours pass, and causes of up to 18 kinds happen
through the commands of `pico sim`, each on a different part. A cause is drawn so large that, with the others of its
night in place, it changes some reading by at least 10 sigma, of which 8 sigma remain if the sizes of the others are
free. Sigma combines what the instrument states, 0.3 % of the light, and how well a camera over the table locates a
bumped part. These numbers come from the simulator's instruments on the true table, not from the diagnosis. Then
`pico morning` runs as a user would run it, once with --json and once without.

An answer is wrong if a cause is neither named nor in a group of parts that the answer says cannot be told apart, if
anything else is reported as a cause, if a reading that truly changed by 6 sigma is not listed, or if a reference was
rewritten. It is useless if the groups hold more than 4 parts at the median, or if more than 30 % of the causes are
only in a group; parts count there only if the simulator, with the sizes of its causes fitted, finds a reading that
tells them apart (`nights_alike.py`). The exit code is 3 for both, and 1 for a morning that fails or rewrites a
reference. `--plant` puts a fault into the morning of the overnight case and exits with 1 unless that fault is reported.
"""

from __future__ import annotations

import argparse
import os
import random
import statistics
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "benchmarks")]

from nights_causes import KINDS, Happening, Night, drawn  # noqa: E402
from nights_judged import Judged, judge, reference_changed, useless  # noqa: E402
from nights_plants import CHANGES, plant  # noqa: E402
from nights_table import LABS, Evening, make_evening, preload, run  # noqa: E402

OVERNIGHT = Night(
    (
        Happening("part bumped", "pm", "nudge", {"dx": 1.5, "dy": 2.0}),
        Happening("part bumped", "qwp", "nudge", {"dy": 4.0}),
        Happening("laser lost power", "laser", "upset", {"power": 0.7}),
        Happening("rotation mount slipped", "hwp", "slip", {"angle": 12.0}),
    ),
    (float("inf"),) * 4,
)
"""Two parts bumped, the laser at 70 %, and the half-wave plate turned by 12 degrees, below a camera over the table."""
MISSED = 3
"""The exit code if an answer is wrong or useless."""
FEWEST = 10
"""Kinds of causes that 20 nights must have."""


def pass_night(bench: Evening, night: Night) -> None:
    """Restore the evening, and let nine hours pass in which the causes happen."""
    bench.restore()
    for words in (("sim", "wait", "9 h"), *(c.words for c in night.causes)):
        done = run(bench.folder, *words)
        if done.code:
            raise SystemExit(f"`pico {' '.join(words)}` ended with {done.code}\n{done.out}{done.err}")


def morning(bench: Evening, night: Night, before: Callable[[], None] = lambda: None) -> Judged:
    """Let a night pass; return what its morning says, judged."""
    import json

    pass_night(bench, night)
    kept = bench.references()
    told = run(bench.folder, "morning", "--yes", "--json", before=before)
    text = run(bench.folder, "morning", "--yes", before=before)
    try:
        data = next(
            d
            for d in map(json.loads, reversed(told.out.splitlines()))
            if d.get("schema", "").startswith("pico.morning/")
        )
        found = judge(bench, night, data, text.out)
    except (StopIteration, ValueError):
        found = Judged(night, wrong=[("failed", f"no verdict; exit code {told.code}: {(told.err or told.out)[-600:]}")])
    for done in (told, text):
        if done.code:
            found.wrong.append(("failed", f"exit code {done.code}: {done.err.strip()[-300:]}"))
    found.wrong += reference_changed(kept, bench.references())
    found.cpu = [told.cpu, text.cpu]
    return found


def show(title: str, found: Judged) -> None:
    """Print a night with what its morning said."""
    bad = "WRONG" if found.wrong else "ok"
    print(f"{title}: {len(found.night.causes)} causes, {found.cpu[0]:.1f} s CPU: {bad}")
    for one, shown in zip(found.night.causes, found.night.clear, strict=True):
        if one.seen:
            said = "moved" if one.part in found.moved else "-"
        elif group := found.of.get(one.part):
            kind = group.kind if group.part == one.part else "listed"
            rest = (
                ""
                if found.named(one.part)
                else f", one of {len(group.parts)} ({found.floor[one.part]} by the readings)"
            )
            said = f"{kind}{rest}"
        else:
            said = "-"
        size = "" if one.seen else f"{shown:.0f} sigma"
        print(f"    {one.kind:31} {'pico ' + ' '.join(one.words):44} {size:>12}  {said}")
    for sort, text in found.wrong:
        print(f"    {sort.upper()}: {text}")
    for note in found.notes:
        print(f"    note: {note}")
    sys.stdout.flush()


def summed(nights: Sequence[Judged]) -> None:
    """Print what many nights gave."""
    hidden = [(j, c) for j in nights for c in j.night.hidden]
    seen = [(j, c) for j in nights for c in j.night.moved]
    named = [(j, c) for j, c in hidden if j.named(c.part)]
    listed = [(j.of[c.part], j.floor[c.part]) for j, c in hidden if c.part in j.of and not j.named(c.part)]
    kinds = sum(c.part in j.of and j.kind_right(c) for j, c in hidden)
    missed = sum(c.part not in j.of for j, c in hidden) + sum(c.part not in j.moved for j, c in seen)
    wrong = Counter(sort for j in nights for sort, _ in j.wrong)
    print(
        f"\n{len(nights)} nights, {len(hidden) + len(seen)} causes of {len({c.kind for _, c in hidden + seen})} kinds:"
    )
    print(f"{len(seen)} seen by a camera, {len(named)} hidden ones named, {len(listed)} in a group, {missed} missed")
    if listed:
        sizes, floors = [len(group.parts) for group, _ in listed], [floor for _, floor in listed]
        print(f"parts in a group: median {statistics.median(sizes):g}, at most {max(sizes)}; ", end="")
        print(f"of these look alike: median {statistics.median(floors):g}, at most {max(floors)}")
    print(f"what befell the part is told, too, of {kinds} of {len(hidden)}")
    cpu = [s for j in nights for s in j.cpu]
    print(f"CPU of a morning: median {statistics.median(cpu):.1f} s, most {max(cpu):.1f} s")
    print("wrong: " + (", ".join(f"{n} {sort}" for sort, n in sorted(wrong.items())) or "nothing"), flush=True)


def nights_of(bench: Evening, args: argparse.Namespace, numbers: Sequence[int]) -> list[Judged]:
    """Let the nights of some numbers pass on a bench; those from `args.nights` on are quiet."""
    found = []
    for number in numbers:
        draw = random.Random(f"{args.seed}/{bench.lab}/{number}")
        quiet = number >= args.nights
        night = Night((), ()) if quiet else drawn(bench, draw, 1 + number // len(args.lab) % 4)
        if not quiet and not night.causes:
            print(f"night {number} of {bench.lab}: nothing that its readings would tell of was drawn", flush=True)
            continue
        one = morning(bench, night)
        show(f"night {number} ({bench.lab}, --lab {' '.join(args.lab)} --seed {args.seed} --only {number})", one)
        found.append(one)
    return found


def planted(bench: Evening, names: Sequence[str]) -> int:
    """Put faults into the morning of the overnight case; return how many are not reported."""
    sound = morning(bench, OVERNIGHT)
    show("overnight, as it is", sound)
    missed = 0
    for name in names:
        sort = CHANGES[name][0]
        found = morning(bench, OVERNIGHT, plant(name))
        told = [text for s, text in [*found.wrong, *useless([found])] if s == sort and (s, text) not in sound.wrong]
        print(f"planted {name}: {'reported: ' + told[0] if told else f'NOT reported as {sort}'}", flush=True)
        missed += not told
    return missed


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--nights", type=int, default=20, help="with causes, by turns on the labs")
    parser.add_argument("--quiet", type=int, default=4, help="without")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", type=int, help="the night of that number alone")
    parser.add_argument("--lab", nargs="+", choices=LABS, default=["fiber", "shel"])
    parser.add_argument(
        "--overnight", action="store_true", help="the case of two bumps, a laser and a wave plate, first"
    )
    parser.add_argument("--plant", choices=["all", *CHANGES], help="a fault into the overnight case; nothing else runs")
    args = parser.parse_args()
    for who in ("AUTHOR", "COMMITTER"):
        os.environ |= {f"GIT_{who}_NAME": "A Physicist", f"GIT_{who}_EMAIL": "physicist@localhost"}
    began, found = time.process_time(), list[Judged]()
    preload()
    numbers = list(range(args.nights + args.quiet)) if args.only is None else [args.only]
    print(f"seed {args.seed}, labs {' '.join(args.lab)}, {len(KINDS)} kinds of causes", flush=True)
    with tempfile.TemporaryDirectory() as place:
        if args.plant:
            names = list(CHANGES) if args.plant == "all" else [args.plant]
            return int(planted(make_evening("fiber", Path(place), args.seed), names) > 0)
        benches: dict[str, Evening] = {}
        for n, lab in enumerate(args.lab):
            own = [k for k in numbers if k % len(args.lab) == n]
            if not own and not (args.overnight and lab == "fiber"):
                continue
            benches[lab] = make_evening(lab, Path(place), args.seed)
            parts, quantities = len(benches[lab].parts), len(benches[lab].quantities)
            took = f"the evening took {benches[lab].cpu:.1f} s CPU"
            print(f"{lab}: {parts} parts in the light, {quantities} quantities; {took}", flush=True)
            if args.overnight and lab == "fiber":
                found.append(morning(benches[lab], OVERNIGHT))
                show("overnight", found[-1])
            found += nights_of(benches[lab], args, own)
    summed(found)
    worse = list(useless(found))
    kinds = {c.kind for j in found for c in j.night.causes}
    if args.only is None and args.nights >= 20 and len(kinds) < FEWEST:
        worse.append(("few", f"only {len(kinds)} kinds of causes were drawn"))
    for sort, text in worse:
        print(f"{sort.upper()}: {text}")
    print(f"drawing and judging took {time.process_time() - began:.0f} s CPU")
    if any(sort in ("failed", "reference") for j in found for sort, _ in j.wrong):
        return 1
    return MISSED if worse or any(j.wrong for j in found) else 0


if __name__ == "__main__":
    sys.exit(main())
