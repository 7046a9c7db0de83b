"""YAML text as a tree whose nodes know where they stand, built from libyaml's events within limits.

Building from events rather than composing keeps hostile input harmless: libyaml's composer overflows the stack on
deep nesting, its event stream does not, and the limits apply before anything is built.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import yaml

from pico.diagnostics import Diagnostic, PicoError, error
from pico.manifest.text.scalars import Plain, resolve
from pico.manifest.text.source import Source
from pico.manifest.text.syntax_errors import conflict, explain

MAX_DEPTH = 32
MAX_NODES = 100_000
MAX_DIRECTIVES = 4
KEPT = 1_000_000
"""Characters of text whose nodes are kept: 10,000 components, some 30 MiB."""
_CORE = "tag:yaml.org,2002:"
_TAGS: dict[str, tuple[type, ...]] = {
    "str": (str,), "int": (int,), "float": (float, int), "bool": (bool,), "null": (type(None),),
}  # fmt: skip


@dataclass(slots=True, eq=False)
class Scalar:
    """A scalar: its text unquoted, how it was quoted ('' plain, ', ", |, >), and where it stands [start, end)."""

    text: str
    style: str
    start: int
    end: int
    tag: str = ""

    @property
    def value(self) -> Plain:
        """The value by YAML 1.2's core schema."""
        if self.tag:
            return self.text if self.tag == "str" else resolve(self.text)
        return self.text if self.style else resolve(self.text)


@dataclass(slots=True, eq=False)
class Map:
    """A mapping: for each key its text, the key's node and the value's."""

    start: int
    flow: bool
    end: int = 0
    entries: dict[str, tuple[Scalar, Node]] = field(default_factory=dict)

    def get(self, key: str) -> Node | None:
        """Return the value's node of `key`, or None."""
        entry = self.entries.get(key)
        return entry[1] if entry else None


@dataclass(slots=True, eq=False)
class List:
    """A sequence."""

    start: int
    flow: bool
    end: int = 0
    items: list[Node] = field(default_factory=list)


Node = Scalar | Map | List


@dataclass(slots=True, eq=False)
class Document:
    """One YAML document of a file."""

    source: Source
    root: Node


def parse(source: Source) -> tuple[list[Document], list[Diagnostic]]:
    """Return the documents of a text, and what is wrong with it as YAML. Empty documents are left out.

    Nodes are not to be changed: a text that is read again (most files are the same from one commit to the next) has
    the same ones.
    """
    known = _recent.roots.get(source.content)
    if known is not None:
        return [Document(source, root) for root in known], []
    marked = conflict(source)
    if marked:
        return [], [marked]
    builder = _Builder(source)
    try:
        _refuse_directives(source)
        builder.build()
    except PicoError as exc:
        return [], [*builder.found, *exc.diagnostics]
    except yaml.YAMLError as exc:
        return [], [*builder.found, explain(source, exc)]
    if not builder.found:
        _recent.keep(source.content, tuple(d.root for d in builder.documents))
    return builder.documents, builder.found


def plain(node: Node) -> Any:
    """Return a node as plain Python data; keys are text."""
    if isinstance(node, Scalar):
        return node.value
    if isinstance(node, Map):
        return {key: plain(value) for key, (_, value) in node.entries.items()}
    return [plain(item) for item in node.items]


def last_leaf(node: Node) -> Node:
    """Return the last scalar or flow collection of a node: block collections end where the next token begins."""
    while not isinstance(node, Scalar) and not node.flow:
        children = list(node.items) if isinstance(node, List) else [v for _, v in node.entries.values()]
        if not children:
            break
        node = children[-1]
    return node


def scalars(node: Node) -> Iterator[Scalar]:
    """Yield every scalar below a node in the order of the text, keys included."""
    if isinstance(node, Scalar):
        yield node
    elif isinstance(node, Map):
        for key, value in node.entries.values():
            yield key
            yield from scalars(value)
    else:
        for item in node.items:
            yield from scalars(item)


def _refuse_directives(source: Source) -> None:
    # libyaml compares each %TAG directive with all before it: a file of nothing else would take minutes.
    if source.content.startswith("%") or "\n%" in source.content:
        lines = source.content.splitlines()
        if sum(line.startswith("%") for line in lines) > MAX_DIRECTIVES:
            first = next(i for i, line in enumerate(lines) if line.startswith("%"))
            where = source.range(sum(len(line) + 1 for line in lines[:first]))
            raise PicoError(error("yaml", "too many `%` directives", hint="a manifest needs none", source=where))


class _Recent:
    """What texts hold that were read lately and had nothing wrong, up to KEPT characters of them."""

    def __init__(self) -> None:
        self.roots: dict[str, tuple[Node, ...]] = {}
        self.size = 0

    def keep(self, content: str, roots: tuple[Node, ...]) -> None:
        self.roots[content] = roots
        self.size += len(content)
        while self.size > KEPT and len(self.roots) > 1:
            oldest = next(iter(self.roots))
            self.size -= len(oldest)
            self.roots.pop(oldest, None)


_recent = _Recent()


class _Builder:
    """Turns the event stream of one text into documents; stops at the first breach of a limit."""

    def __init__(self, source: Source) -> None:
        self.source = source
        self.documents: list[Document] = []
        self.found: list[Diagnostic] = []
        self.open: list[Map | List] = []
        self.keys: list[Scalar | None] = []
        self.nodes = 0

    def build(self) -> None:
        loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)(self.source.content)
        try:
            while loader.check_event():
                event = loader.get_event()
                kind = event.__class__
                if kind is yaml.ScalarEvent:
                    self._add(self._scalar(event))
                elif kind is yaml.MappingStartEvent:
                    self._begin(Map(event.start_mark.index, bool(event.flow_style)), event)
                elif kind is yaml.SequenceStartEvent:
                    self._begin(List(event.start_mark.index, bool(event.flow_style)), event)
                elif kind is yaml.MappingEndEvent or kind is yaml.SequenceEndEvent:
                    node = self.open.pop()
                    self.keys.pop()
                    node.end = event.end_mark.index
                elif kind is yaml.AliasEvent:
                    self._refuse(event, "an alias (`*name`) is not allowed in a manifest", "write the value out")
        finally:
            loader.dispose()

    def _scalar(self, event: Any) -> Scalar:
        node = Scalar(event.value, event.style or "", event.start_mark.index, event.end_mark.index)
        if event.anchor is not None:
            self._refuse_anchor(event)
        if event.tag is not None:
            node.tag = self._scalar_tag(event)
        return node

    def _scalar_tag(self, event: Any) -> str:
        if event.tag == "!":
            return "str"
        name = event.tag.removeprefix(_CORE)
        if name not in _TAGS:
            self._refuse(
                event,
                f"the tag `{_shown(event.tag)}` is not allowed in a manifest",
                "remove the tag",
            )
        if name != "str" and not isinstance(resolve(event.value), _TAGS[name]):
            self._refuse(event, f"`{_shown(event.value)}` is not what its tag `!!{name}` says", "remove the tag")
        return str(name)

    def _begin(self, node: Map | List, event: Any) -> None:
        if event.anchor is not None:
            self._refuse_anchor(event)
        if event.tag is not None and event.tag not in (_CORE + "map", _CORE + "seq", "!"):
            self._refuse(
                event,
                f"the tag `{_shown(event.tag)}` is not allowed in a manifest",
                "remove the tag",
            )
        if len(self.open) >= MAX_DEPTH:
            self._refuse(event, f"nested deeper than {MAX_DEPTH} levels", "a manifest needs about six")
        self._add(node)
        self.open.append(node)
        self.keys.append(None)

    def _add(self, node: Node) -> None:
        self.nodes += 1
        if self.nodes > MAX_NODES:
            where = self.source.range(node.start)
            raise PicoError(
                error(
                    "too-large",
                    f"more than {MAX_NODES:,} values in one file",
                    hint="split it: one file a sub-assembly, 10 to 50 components each",
                    source=where,
                )
            )
        if not self.open:
            if not (isinstance(node, Scalar) and not node.text and not node.style):
                self.documents.append(Document(self.source, node))
            return
        parent = self.open[-1]
        if isinstance(parent, List):
            parent.items.append(node)
            return
        key = self.keys[-1]
        if key is not None:
            self.keys[-1] = None
            if not self._duplicate(parent, key):
                parent.entries[key.text] = (key, node)
        elif isinstance(node, Scalar):
            self.keys[-1] = node
        else:
            where = self.source.range(node.start)
            hint = "a key is a plain name; quote text that begins with `{` or `[`"
            raise PicoError(error("yaml", "a list or mapping can't be a key", hint=hint, source=where))

    def _duplicate(self, parent: Map, key: Scalar) -> bool:
        if key.text not in parent.entries:
            return False
        first = self.source.position(parent.entries[key.text][0].start)
        empty = [k for k, value in parent.entries.values() if isinstance(value, Scalar) and value.start == value.end]
        hint = "keep one of the two"
        if empty and self.source.position(empty[-1].start).line > first.line:
            hint += f"; or this is part of `{_shown(empty[-1].text)}:` above, which is indented too far"
        self.found.append(
            error(
                "duplicate",
                f"`{_shown(key.text)}` is given twice",
                detail=f"first at {self.source.path}:{first.line}:{first.column}",
                hint=hint,
                label=f"first given in line {first.line}",
                source=self.source.range(key.start, key.end),
            )
        )
        return True

    def _refuse_anchor(self, event: Any) -> None:
        self._refuse(event, f"an anchor (`&{_shown(event.anchor)}`) is not allowed in a manifest", "write values out")

    def _refuse(self, event: Any, summary: str, hint: str) -> None:
        where = self.source.range(event.start_mark.index, min(event.end_mark.index, event.start_mark.index + 60))
        raise PicoError(error("yaml", summary, hint=hint, source=where))


def _shown(text: str) -> str:
    text = text.replace(_CORE, "!!")
    return text if len(text) <= 40 else text[:37] + "..."
