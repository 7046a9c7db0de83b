"""Recipes made at random over the bench of the case study: right ones, and ones with one mistake each.

A recipe is written as YAML in its flow style, which is JSON but for its texts; the same seed makes the same recipe.
"""

from __future__ import annotations

import json
import random
from typing import Any

from pico.recipes.running import Outcome

HEAD = "apiVersion: pico/v1\nkind: Recipe\n"
HELPER = HEAD + (
    "metadata: {name: helper}\n"
    "parameters: {to: {unit: deg, default: 5, range: [0, 90]}, times: {default: 1}, word: {kind: text, default: a}}\n"
    "steps:\n- set: {p2.angle: to}\n- {measure: p2.angle, as: found}\n"
    "returns: {angle: found, twice: 2 * found, said: word}\n"
)
"""A recipe beside those that are made, for them to call."""
TURNED = {"p1.angle": "deg", "p2.angle": "deg", "hwp.angle": "deg"}
READ = ("p1.angle", "p2.angle", "hwp.angle", "p2.pose", "cam.exposure")
NEVER = {
    "type", "name", "step", "unit", "choice", "capability", "unmeasured", "unknown-key", "missing-key", "no-recipe",
    "unknown-component", "unknown-tunable", "unknown-measurable", "unknown-slot", "unknown-revision", "request",
    "unsupported", "missing", "unknown-parameter", "missing-parameter",
}  # fmt: skip
"""Codes of mistakes that a recipe which passed the check must not come to while it runs."""


def mistaken(found: Outcome) -> bool:
    """Return whether a recipe that passed the check came to what the check is there to find."""
    if found.outcome == "done":
        return False
    own = {d.code for d in found.diagnostics}
    unknown = any(d.code == "expression" and ("nobody knows" in d.summary or "overload" in d.summary)
                  for d in found.diagnostics)  # fmt: skip
    return found.outcome != "failed" or bool(own & NEVER) or unknown


class Maker:
    """Makes one recipe, called `name`."""

    def __init__(self, seed: int, name: str = "made") -> None:
        self.draw, self.name, self.made = random.Random(seed), name, 0
        self.parameters: dict[str, dict[str, Any]] = {}

    def recipe(self, mistake: str = "") -> str:
        """Return a recipe as text; with a `mistake` one of `MISTAKES` is in one of its lists of steps."""
        names = {f"given{n}": self.parameter(n) for n in range(self.draw.randrange(3))}
        given = dict(names)  # all that `finally` knows
        steps = self.steps(names, 0, self.draw.randint(2, 6))
        last = [self.simple(given) for _ in range(self.draw.randrange(2))]
        if mistake:
            steps.insert(self.draw.randint(0, len(steps)), MISTAKES[mistake][1])
        returns = {f"out{n}": self.number(names) for n in range(self.draw.randrange(3))}
        lines = [f"metadata: {{name: {self.name}}}", f"parameters: {json.dumps(self.parameters)}", "steps:"]
        lines += [f"- {json.dumps(step)}" for step in steps]
        lines += ["finally:", *(f"- {json.dumps(step)}" for step in last)] if last else []
        return HEAD + "\n".join([*lines, f"returns: {json.dumps(returns)}", ""])

    def parameter(self, n: int) -> str:
        """Declare a parameter; return the kind of what it stands for."""
        kind = self.draw.choice(("number", "number", "numbers", "text", "bool"))
        default: Any = {"number": self.draw.randint(1, 80), "numbers": [1, 20, self.draw.randint(3, 80)], "text": "ab",
                        "bool": True}[kind]  # fmt: skip
        unit = {"unit": "deg"} if kind in ("number", "numbers") and self.draw.random() < 0.5 else {}
        self.parameters[f"given{n}"] = {"kind": kind, "default": default, **unit}
        return kind

    # expressions

    def of_kind(self, names: dict[str, str], kind: str) -> list[str]:
        return [name for name, own in names.items() if own == kind]

    def number(self, names: dict[str, str], depth: int = 0) -> str:
        """Return an expression that is a number, and as a rule not far from 0."""
        own = [*self.of_kind(names, "number"), *TURNED, "p2.pose.x", "p2.pose.yaw"]
        if depth >= 3 or self.draw.random() < 0.25:
            return self.draw.choice((*own, *own, "0", "1", "2", "7.5", "30", "0.001"))
        one, pick = lambda: self.number(names, depth + 1), self.draw.choice
        lists = [f"[{self.draw.randint(1, 9)}, {pick(own)}]", *self.of_kind(names, "numbers")]
        some = pick(lists)
        ways = (
            lambda: f"({one()} {pick('+-*')} {one()})",
            lambda: f"({one()} {pick('+-*')} {one()})",
            lambda: f"{one()} / (1 + abs({one()}))",
            lambda: f"{pick(('abs', 'sin', 'cos', 'tan'))}({one()})",
            lambda: f"({self.holds(names, depth + 1)} ? {one()} : {one()})",
            lambda: f"{pick(('sum', 'mean', 'least', 'most'))}({pick(lists)})",
            lambda: f"sqrt(abs({one()}))",
            lambda: f"mod({one()}, 7) + floor(abs(sin({one()})))",
            lambda: f"{some}[size({some}) - 1]",
            lambda: f"{some}[int(abs(cos({one()})))]",
        )
        return pick(ways)()

    def holds(self, names: dict[str, str], depth: int = 0) -> str:
        """Return an expression that is true or false."""
        own = self.of_kind(names, "bool")
        if own and self.draw.random() < 0.3:
            return self.draw.choice(own)
        if depth < 2 and self.draw.random() < 0.3:
            return f"({self.holds(names, depth + 1)} {self.draw.choice(('&&', '||'))} {self.holds(names, depth + 1)})"
        less = self.draw.choice(("<", ">", "<=", "!="))
        return f"{self.number(names, depth + 1)} {less} {self.number(names, depth + 1)}"

    def angle(self, names: dict[str, str]) -> Any:
        """Return an angle that a motor can go to, written out or as an expression."""
        if self.draw.random() < 0.5:
            return self.draw.choice((self.draw.randint(0, 179), "0.1 rad", "12.5 deg"))
        return f"45 + 40 * sin({self.number(names)})"

    # steps

    def steps(self, names: dict[str, str], depth: int, count: int) -> list[dict[str, Any]]:
        """Return some steps; what they name is in `names` for those that follow."""
        return [self.step(names, depth) for _ in range(count)]

    def step(self, names: dict[str, str], depth: int) -> dict[str, Any]:
        if depth < 2 and self.draw.random() < 0.35:
            return self.block(names, depth)
        way = self.draw.randrange(12)
        if way < 3:
            return self.let(names)
        if way < 5:
            return self.measure(names)
        if way == 5:
            return self.scan(names)
        if way == 6 and depth == 0:
            return self.call(names)
        return self.simple(names)

    def simple(self, names: dict[str, str]) -> dict[str, Any]:
        """Return a step that names nothing."""
        number, some = self.fresh("n"), self.draw.sample(sorted(TURNED), self.draw.randint(1, 2))
        rest: Any = self.draw.choice((0, 1, "0.5 s", f"abs(sin({self.number(names)}))"))
        ways: tuple[dict[str, Any], ...] = (
            {"move": {"p2": {"yaw": f"10 * sin({self.number(names)})"}}},
            {"home": some[0]},
            {"note": {"p1": "turned to ${p1.angle}, ${round(" + self.number(names) + ", 2)}"}},
            {"assert": f"{self.holds(names)} || 1 < 2", "message": "never: ${p1.angle}"},
            {"wait": rest, "name": f"rest {number}"},
            {"tag": f"{self.name}-{number}"},
            {"commit": f"{number} of {self.name}"},
        )
        turned = {"set": {address: self.angle(names) for address in some}}
        return self.draw.choice((turned, turned, turned, turned, *ways))

    def let(self, names: dict[str, str]) -> dict[str, Any]:
        found, made = {}, {}
        for _ in range(self.draw.randint(1, 2)):
            kind = self.draw.choice(("number", "number", "number", "bool", "numbers"))
            same = self.of_kind({n: k for n, k in names.items() if n.startswith("v")}, kind)
            name = self.draw.choice(same) if same and self.draw.random() < 0.4 else self.fresh("v")
            lists = ["[]" if name not in names else name, *self.of_kind(names, "numbers")]
            found[name] = {
                "number": lambda: self.number(names), "bool": lambda: self.holds(names),
                "numbers": lambda: f"{self.draw.choice(lists)} + [{self.number(names)}]",  # noqa: B023
            }[kind]()  # fmt: skip
            made[name] = kind
        names |= made
        return {"let": found}

    def measure(self, names: dict[str, str]) -> dict[str, Any]:
        if self.draw.random() < 0.3:
            return {"measure": self.draw.sample(READ, 2), "retries": 1}
        address, name = self.draw.choice(READ), self.fresh("m")
        if address.endswith("pose"):
            names |= {f"{name}.{axis}": "number" for axis in ("x", "y", "yaw")}
        else:
            names[name] = "number"
        return {"measure": address, "as": name}

    def scan(self, names: dict[str, str]) -> dict[str, Any]:
        address, name, read = (
            self.draw.choice(sorted(TURNED)),
            self.fresh("s"),
            self.draw.choice(("p1.angle", "p2.angle")),
        )
        values: Any = self.draw.choice(([3, 9], {"from": 1, "to": 5, "count": 2}, {"from": 2, "to": 6, "step": 2}))
        names |= {f"{name}.{address.replace('.', '_')}": "numbers", f"{name}.{read.replace('.', '_')}": "numbers"}
        return {"scan": {address: values}, "read": read, "as": name}

    def call(self, names: dict[str, str]) -> dict[str, Any]:
        name = self.fresh("c")
        given = (
            {"to": f"45 + 40 * cos({self.number(names)})"}
            if self.draw.random() < 0.5
            else {"times": self.number(names)}
        )
        names |= {f"{name}.angle": "number", f"{name}.twice": "number", f"{name}.said": "text"}
        return {"call": "helper", "with": given, "as": name}

    def block(self, names: dict[str, str], depth: int) -> dict[str, Any]:
        way, inner, count = self.draw.randrange(3), dict(names), self.draw.randint(1, 3)
        if way == 0:
            whole = f"2 + floor(abs(cos({self.number(names)})))"
            lists: list[Any] = [
                [1, 2],
                {"from": 0, "to": 20, "step": 10},
                {"from": self.number(names), "to": 20, "count": whole},
                {"from": 0, "to": whole, "step": "1"},
                [1, self.number(names)],
                *self.of_kind(names, "numbers")[:1],
            ]
            over = self.fresh("t")
            values = self.draw.choice(lists)
            return {"foreach": {over: values}, "steps": self.steps(inner | {over: "number"}, depth + 1, count)}
        if way == 1:
            found: dict[str, Any] = {"if": self.holds(names), "then": self.steps(inner, depth + 1, count)}
            return found | ({"else": self.steps(dict(names), depth + 1, 1)} if self.draw.random() < 0.5 else {})
        turn = self.fresh("v")
        steps = [*self.steps(inner, depth + 1, 1), {"let": {turn: f"{turn} + 1"}}]
        return {"if": "1 < 2", "then": [{"let": {turn: "0"}}, {"while": f"{turn} < 2", "most": 3, "steps": steps}]}

    def fresh(self, letter: str) -> str:
        self.made += 1
        return f"{letter}{self.made}"


MISTAKES: dict[str, tuple[str, Any]] = {
    "a step that there is not": ("step", {"mesure": "p1.angle"}),
    "two steps in one": ("step", {"home": "p1.angle", "wait": 1}),
    "no step at all": ("type", "wait"),
    "a component that there is not": ("unknown-component", {"measure": "p7.angle"}),
    "a measurable that there is not": ("unknown-measurable", {"measure": "cam.colour"}),
    "a tunable that there is not": ("unknown-tunable", {"set": {"p1.angel": 3}}),
    "a slot that there is not": ("unknown-slot", {"move": {"p2": "storage/z9"}}),
    "a revision that there is not": ("unknown-revision", {"apply": "nowhere"}),
    "a goal that there is not": ("goal", {"optimize": "happiness"}),
    "a recipe that there is not": ("no-recipe", {"call": "nothing"}),
    "an argument that there is not": ("unknown-key", {"call": "helper", "with": {"colour": 3}}),
    "a mass for an angle": ("unit", {"set": {"p1.angle": "2 kg"}}),
    "a name in another unit": ("unit", {"set": {"p1.angle": "p2.pose.x"}}),
    "a number out of range": ("range", {"set": {"p1.angle": 900}}),
    "a text for a number": ("expression", {"set": {"p1.angle": "'far'"}}),
    "a number for a condition": ("expression", {"if": "1 + 2", "then": [{"wait": 1}]}),
    "a list for a number": ("expression", {"wait": "[1, 2]"}),
    "a name that nobody gave": ("expression", {"wait": "nobody + 1"}),
    "a text for an index": ("expression", {"wait": "[1, 2]['a']"}),
    "a range of a text": (
        "expression",
        {"foreach": {"k": {"from": 0, "to": "'a'", "step": 1}}, "steps": [{"wait": 1}]},
    ),
    "a sum of what does not add": ("expression", {"wait": "1 + (2 < 3)"}),
    "an expression cut off": ("expression", {"wait": "(1 + "}),
    "a function that there is not": ("expression", {"wait": "twice(3)"}),
    "what nothing measured": ("unmeasured", {"wait": "cam.fit.x"}),
    "a choice that there is not": ("choice", {"set": {"laser.shutter": "ajar"}}),
    "a loop without a bound": ("bound", {"while": "1 < 2", "steps": [{"wait": 1}]}),
    "a loop over no list": ("type", {"foreach": {"k": 3}, "steps": [{"wait": 1}]}),
    "a part that no arm takes": ("capability", {"move": {"laser": {"x": 300}}}),
    "what a part cannot do": ("capability", {"do": "p1 auto_range"}),
    "what cannot be homed": ("capability", {"home": "cam.exposure"}),
    "a key that there is not": ("unknown-key", {"wait": 1, "colour": 3}),
    "a name of a component": ("name", {"let": {"p1": 3}}),
    "a result that there is not": ("name", {"wait": 1, "as": "x"}),
    "a retry and a half": ("type", {"measure": "p1.angle", "retries": 1.5}),
    "a kind that changes": ("type", {"if": "1 < 2", "then": [{"let": {"k": 1}}, {"let": {"k": "2 > 1"}}]}),
    "a name of a block outside it": (
        "expression",
        {"foreach": {"k": [1]}, "steps": [{"let": {"j": "k"}}, {"if": "1 < 2", "then": [{"wait": "l"}]}]},
    ),
}
"""Mistakes: the code that each is told by, and a step that makes it."""
