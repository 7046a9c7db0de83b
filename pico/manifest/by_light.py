"""Set-points that light finds, read from their nodes: `angle: {null_of: [p1, p2], offset: 1.0}`."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from pico.diagnostics import Diagnostic, SourceRange, did_you_mean, error
from pico.manifest.bench_view import BenchView
from pico.manifest.text.source import Source
from pico.manifest.text.splice import write_flow
from pico.manifest.text.tree import List, Map, Node, Scalar, plain
from pico.manifest.values import read_number
from pico.manifest.wording import article, shown
from pico.model.catalog import Tunable
from pico.model.state import KINDS, NULL, OFFSET, THROUGH, LabState, LightReference, goals_of

EXAMPLES = {NULL: "{null_of: [p1, p2], offset: 1.0}", THROUGH: "{through: [iris1, iris2]}"}


def read_reference(
    source: Source, view: BenchView, component: str, name: str, kind: Tunable, node: Map
) -> LightReference | list[Diagnostic]:
    """Return where light says that tunable `name` of a component belongs, or all that is wrong with it."""
    reader = _Reader(source, view, component, name, kind, node)
    found = [*reader.problems()]
    return found or LightReference(**{reader.said: reader.named}, offset=reader.offset)  # type: ignore[arg-type]


def too_many(state: LabState, place: Callable[[str, str], SourceRange]) -> Iterator[Diagnostic]:
    """Yield which references are one too many: a third mirror that is to bring a beam through two irises, and a second
    tunable at the null of the same two parts, for one of them can be right whatever the other is. `place`: where a
    component has a tunable."""
    nulls: dict[frozenset[str], str] = {}
    for references in goals_of(state).values():
        mirrors: dict[str, str] = {}
        for address, one in references.items():
            component, _, tunable = address.partition(".")
            if one.kind == THROUGH:
                mirrors.setdefault(component, address)
            elif (first := nulls.setdefault(frozenset(one.parts), address)) != address:
                text = f"{first} and {address} are both at the null of {' and '.join(one.parts)}, and one of them does"
                hint = f"give one a number; what brings {address} there makes {first} stale, and the other way round"
                yield error("by-light", text, hint=hint, address=address, source=place(component, tunable))
        for address in [*mirrors.values()][2:]:
            text = f"{', '.join(mirrors)} are all to bring a beam {references[address].text}, and two of them do"
            at = place(*address.split("."))
            yield error("by-light", text, hint="give one numbers", address=address, source=at)


class _Reader:
    """One reference; `said`, `named` and `offset` are what it says once there are no problems."""

    def __init__(
        self, source: Source, view: BenchView, component: str, name: str, kind: Tunable, node: Map
    ) -> None:  # fmt: skip
        self.source, self.view, self.node, self.kind = source, view, node, kind
        self.component, self.name, self.address = component, name, f"{component}.{name}"
        self.said = next((key for key in KINDS if key in node.entries), "")
        self.named: tuple[str, ...] = ()
        self.offset = 0.0

    def problems(self) -> Iterator[Diagnostic]:
        """Yield what is wrong, from the outside inward."""
        if not self.said:
            yield from self._nothing()
            return
        both = all(key in self.node.entries for key in KINDS)
        if both:
            hint = "keep one of the two"
            yield self._error(self.node, "by-light", f"{self.address} has both `{NULL}` and `{THROUGH}`", hint)
        if not self.node.flow or "\n" in self.source.content[self.node.start : self.node.end]:
            hint = f"write `{self.name}: {write_flow(plain(self.node))}`, as `pico fmt` does: one tunable is one line"
            yield self._error(self.node, "by-light", f"what {self.address} refers to is not on one line", hint)
        for key, (at, _) in self.node.entries.items():
            if key not in (*KINDS, OFFSET):
                hint = did_you_mean(key[:40], (self.said, OFFSET))
                yield self._error(at, "unknown-key", f"unknown key `{key[:40]}` in what {self.address} refers to", hint)
        yield from self._bearer()
        yield from self._parts()
        yield from self._offset()

    def _nothing(self) -> Iterator[Diagnostic]:
        unit = f" in {self.kind.unit}" if self.kind.unit else ""
        example = EXAMPLES[NULL if self._tunes(NULL) else THROUGH]
        hint = f"expected a number{unit}, or what light finds: `{self.name}: {example}`"
        for key, (at, _) in self.node.entries.items():
            near = did_you_mean(key[:40], (*KINDS, OFFSET))
            if near.startswith("did"):
                yield self._error(at, "unknown-key", f"unknown key `{key[:40]}` in what {self.address} refers to", near)
                return
        yield self._error(self.node, "type", f"{self.name} of {self.component} is a mapping, not a number", hint)

    def _tunes(self, said: str) -> bool:
        kind = self.view.kinds.get(self.component)
        elements, names = KINDS[said].elements, KINDS[said].tunables
        return kind is None or (kind.optics.element in elements and self.name in names)

    def _bearer(self) -> Iterator[Diagnostic]:
        if not self._tunes(self.said):
            elements, names = KINDS[self.said].elements, KINDS[self.said].tunables
            text = f"`{self.said}` finds the {' and '.join(names)} of a {' or a '.join(elements)}, not {self.address}"
            yield self._error(self.node, "by-light", text, "give it a number")
        elif self.kind.mover not in ("motor", "electronics"):
            text = f"{self.address} is set by a person, so no search for light can set it"
            yield self._error(self.node, "by-light", text, "give it a number, or the part a motor")

    def _parts(self) -> Iterator[Diagnostic]:
        at, node = self.node.entries[self.said]
        names = [item.text if isinstance(item, Scalar) else "" for item in node.items] if isinstance(node, List) else []
        if len(names) != 2 or not all(names):
            text = f"`{self.said}` of {self.address} is {shown(plain(node))}, not two parts"
            yield self._error(at if isinstance(node, Scalar) and node.start == node.end else node, "type", text,
                              f"expected `{self.said}: [{', '.join(KINDS[self.said].example)}]`")  # fmt: skip
            return
        assert isinstance(node, List)
        names = [self.view.name(name) for name in names]
        wrong = [problem for item, name in zip(node.items, names, strict=True) for problem in self._part(item, name)]
        yield from wrong
        if names[0] == names[1]:
            yield self._error(node.items[1], "by-light", f"{self.address} names {names[0]} twice", "two parts")
        elif self.said == NULL and not wrong and "polarizer" not in map(self._element, names):
            text = f"{names[0]} and {names[1]} are wave plates: light passes both at any angle"
            yield self._error(node, "by-light", text, "one of the two must be a polarizer")
        elif self.said == NULL and self._element(self.component) == "polarizer" and self.component not in names:
            text = f"turning {self.component} finds no null of {names[0]} and {names[1]}: it is neither"
            hint = f"for example `{NULL}: [{names[0]}, {self.component}]`"
            yield self._error(node, "by-light", text, hint)
        self.named = (names[0], names[1])

    def _part(self, node: Node, name: str) -> Iterator[Diagnostic]:
        if name not in self.view.kinds:
            hint = did_you_mean(name[:40], self.view.kinds) or "`pico catalog parts` lists them"
            text = f"{self.address} refers to {shown(name)}, which is not in the inventory of this lab"
            yield self._error(node, "unknown-component", text, hint)
        elif (element := self._element(name)) not in (None, *KINDS[self.said].takes):
            kind = self.view.kinds[name]
            fit = [n for n, k in sorted(self.view.kinds.items()) if k and k.optics.element in KINDS[self.said].takes]
            hint = f"there are: {', '.join(fit)}" if fit else "the bench has none"
            wanted = " nor ".join(article(word) for word in KINDS[self.said].takes)
            text = f"{name} ({kind.name if kind else element}) is {'neither ' if 'nor' in wanted else 'not '}{wanted}"
            yield self._error(node, "by-light", text, hint)

    def _element(self, name: str) -> str | None:
        kind = self.view.kinds.get(name)
        return kind.optics.element if kind else None

    def _offset(self) -> Iterator[Diagnostic]:
        entry = self.node.entries.get(OFFSET)
        if entry is None:
            return
        if self.said == THROUGH:
            text = f"`{OFFSET}` of {self.address} means nothing: a beam goes through two irises, or does not"
            yield self._error(entry[0], "by-light", text, "take it out")
            return
        number = read_number(self.source, self.component, f"{self.name}.{OFFSET}", self.kind.unit, entry[1])
        if isinstance(number, Diagnostic):
            yield number
            return
        self.offset = number
        if self.kind.period and abs(number) >= self.kind.period:
            text = f"the offset of {self.address} is {number:g} {self.kind.unit}: more than its period"
            hint = f"write {number % self.kind.period:.10g}, which is the same"
            yield self._error(entry[1], "range", text, hint)

    def _error(self, node: Node, code: str, summary: str, hint: str) -> Diagnostic:
        at = self.source.range(node.start, node.end)
        return error(code, summary, hint=hint, address=self.address, source=at)
