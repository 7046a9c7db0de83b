"""Checks and runs recipes made at random: `python benchmarks/random_recipes.py --recipes 200 --broken 100`.

`--recipes`: right ones (`tests/recipes/generating.py`), each checked and foreseen, which must move nothing, and run on
the simulated bench of the case study; none may come to a mistake of types, names or capabilities. A tag that is given
twice must be told before, as far as a recipe is known in advance, and what is told so must come true. `--broken`: as
many with one mistake each, which the check must tell at its line. Then recipes that run away, which must end within
their budget.
Prints the counts; the exit code is 1 where anything was wrong.
"""

from __future__ import annotations

import argparse
import os
import random
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "tests" / "recipes")]

from generating import HEAD, HELPER, MISTAKES, Maker, mistaken  # noqa: E402

if TYPE_CHECKING:
    from pico.recipes.ahead import Foreseen

RUNAWAY: Mapping[str, str] = {
    "a loop that never ends": '- while: "1 < 2"\n  most: 10000\n  steps: [{let: {a: "1"}}]\n',
    "loops in loops": "- foreach: {a: {from: 1, to: 9000, step: 1}, b: {from: 1, to: 9000, step: 1}}\n"
    '  steps: [{let: {c: "a * b"}}]\n',
    "a list that doubles": '- let: {l: "[1]"}\n- while: "1 < 2"\n  most: 9999\n  steps: [{let: {l: "l + l"}}]\n',
    "a text that doubles": '- let: {s: "\'ab\'"}\n- while: "1 < 2"\n  most: 9999\n  steps: [{let: {s: "s + s"}}]\n',
    "maps in maps": '- let: {l: "range(0, 999, 1).map(a, sum(range(0, 999, 1).map(b, sum(range(0, 999, 1).map(c, a))))'
    ')"}\n',
    "a number that grows": '- let: {a: "2"}\n- while: "a > 0"\n  most: 10000\n  steps: [{let: {a: "a * a"}}]\n',
    "one that calls itself": "- call: runaway\n",
    "parentheses without end": f'- let: {{a: "{"(" * 5000}1{")" * 5000}"}}\n',
    "a power of conditions": f'- let: {{a: "{"1 < 2 ? 3 : (" * 300}4{")" * 300}"}}\n',
}


class Trying:
    """A bench on which recipes are tried, and what came of them."""

    def __init__(self, folder: Path) -> None:
        from pico.bench.bench import Bench
        from pico.history.examples.example import make_example

        make_example("shel", folder)
        (folder / "recipes" / "helper.yaml").write_text(HELPER)
        self.bench, self.count = Bench.open(folder, fidelity="kinematic"), Counter[str]()

    def wrong(self, name: str, what: object) -> None:
        self.count["wrong"] += 1
        print(f"{name}: {what}", flush=True)

    def check(self, name: str, text: str) -> tuple[Any, tuple[Any, ...]]:
        """Check a recipe; that it moves nothing is looked after."""
        from pico.recipes.recipes import Recipes

        path = self.bench.root / "recipes" / f"{name}.yaml"
        path.write_text(text)
        before, recipes = self.bench.observe().components, Recipes(self.bench)
        recipe, found = recipes.check(str(path))
        if self.bench.observe().components != before:
            self.wrong(name, "the check moved something")
        return recipe, found

    def run(self, name: str, text: str) -> Any:
        """Run a recipe that is right; return its outcome, or None where it is not right."""
        from pico.recipes.recipes import Recipes

        recipe, found = self.check(name, text)
        if found or recipe is None:
            return None
        recipes = Recipes(self.bench)
        return recipes.run(recipe, recipes.begin(recipe, recipes.arguments(recipe, {})))

    def foresee(self, name: str, text: str) -> Foreseen | None:
        """Return what is known in advance of a recipe, None of one that is not right; that moves nothing, either."""
        from pico.recipes.recipes import Recipes

        recipe, found = self.check(name, text)
        if found or recipe is None:
            return None
        before, recipes = self.bench.observe().components, Recipes(self.bench)
        ahead = recipes.ahead(recipe, recipes.arguments(recipe, {}))
        if self.bench.observe().components != before:
            self.wrong(name, "to foresee it moved something")
        return ahead

    def right(self, seed: int) -> None:
        name = f"made{seed}"
        text = Maker(seed, name).recipe()
        ahead = self.foresee(name, text)
        found = self.run(name, text)
        if found is None or ahead is None:
            self.count["refused"] += 1
            return
        if mistaken(found):
            self.wrong(name, found)
        how = found.outcome if found.outcome == "done" else found.diagnostics[0].code
        if ahead.diagnostics and how == "done":
            self.wrong(name, f"it was told to fail, and did not: {ahead.diagnostics}")
        if ahead.whole and how == "exists":
            self.wrong(name, f"a name that is given twice was not told before: {found.diagnostics}")
        self.count[f"ended as {how}{', which was told before' if ahead.diagnostics else ''}"] += 1

    def broken(self, seed: int) -> None:
        mistake = [*MISTAKES][seed % len(MISTAKES)]
        _, found = self.check("broken", Maker(random.Random(seed).randrange(10**6), "broken").recipe(mistake))
        if MISTAKES[mistake][0] not in {d.code for d in found} or not all(d.source for d in found):
            self.wrong(mistake, found)
        self.count["told"] += 1

    def runaway(self, what: str) -> None:
        began = time.process_time()
        found = self.run("runaway", f"{HEAD}metadata: {{name: runaway}}\nsteps:\n{RUNAWAY[what]}")
        how = "refused" if found is None else "done" if found.outcome == "done" else found.diagnostics[0].summary
        print(f"  {what}: {time.process_time() - began:.1f} s, {how[:90]}", flush=True)
        self.count["stopped"] += 1


def main() -> int:
    """Try."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--recipes", type=int, default=200)
    parser.add_argument("--broken", type=int, default=100)
    parser.add_argument("--first", type=int, default=0, help="first seed")
    given = parser.parse_args()
    os.environ |= {
        f"GIT_{who}_{what}": "benchmark@localhost" for who in ("AUTHOR", "COMMITTER") for what in ("NAME", "EMAIL")
    }
    with tempfile.TemporaryDirectory() as temporary:
        tried = Trying(Path(temporary) / "shel")
        with tried.bench:
            for n in range(given.recipes):
                tried.right(given.first + n)
            for n in range(given.broken):
                tried.broken(given.first + n)
            for what in RUNAWAY:
                tried.runaway(what)
    said = ", ".join(f"{n} {what}" for what, n in sorted(tried.count.items()))
    print(f"{given.recipes} recipes, {given.broken} broken, {len(RUNAWAY)} that run away: {said}")
    return 1 if tried.count["wrong"] else 0


if __name__ == "__main__":
    sys.exit(main())
