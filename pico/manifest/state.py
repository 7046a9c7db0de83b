"""LabState documents against a bench: by hand rather than by pydantic, because there are thousands of them."""

from __future__ import annotations

from collections.abc import Iterable

from pico.diagnostics import Diagnostic, SourceRange, did_you_mean, error, slot_meant, warning
from pico.manifest.bench_view import BenchView
from pico.manifest.by_light import read_reference, too_many
from pico.manifest.checks.labs import off_table
from pico.manifest.file_names import EXCLUDED, RENAMED
from pico.manifest.text.names import name_problem
from pico.manifest.text.places import where, where_key
from pico.manifest.text.tree import Document, List, Map, Node, Scalar, plain
from pico.manifest.values import read_number, read_value
from pico.manifest.wording import shown
from pico.model.address import renamed_expression
from pico.model.pose import Pose, wrap
from pico.model.quantities import Value
from pico.model.state import ComponentState, Expectation, LabState, LightReference

MOST_COMPONENTS = 200
"""More components in one file than this are warned about: merges and blame work best with 10 to 50."""
_POSE = (("x", "mm"), ("y", "mm"), ("yaw", "deg"))
_KEYS = ("apiVersion", "kind", "metadata", "components", "expect")

TURN = 360.0
"""No yaw is more than one turn [deg]: more is a slip of the pen."""
FAR = 1e5
"""No pose is farther from the origin [mm]; one off the table is told by whoever asks what can stand there."""


def read_states(
    documents: Iterable[Document], view: BenchView, *, whole: bool = True
) -> tuple[LabState | None, list[Diagnostic]]:
    """Return the state that several documents make up together, or None and every error.

    Not `whole`: there are others, so who has which slot is not looked at.
    """
    reader = _Reader(view)
    for document in documents:
        reader.read(document)
    if whole:
        reader.check_slots()
    state = LabState(lab=view.lab or reader.lab, components=reader.components, expect=tuple(reader.expect))
    reader.found.extend(too_many(state, reader.place))
    return None if any(d.severity == "error" for d in reader.found) else state, reader.found


class _Reader:
    """Collects components, expectations and diagnostics over the documents of a state."""

    def __init__(self, view: BenchView) -> None:
        self.view = view
        self.lab = ""
        self.components: dict[str, ComponentState] = {}
        self.expect: list[Expectation] = []
        self.found: list[Diagnostic] = []
        self.first: dict[str, Document] = {}
        self.words: dict[str, str] = {}  # what a document calls a component, which may be a former name

    def read(self, document: Document) -> None:
        root = document.root
        assert isinstance(root, Map)
        self._lab(document, root)
        for key, (at, _) in root.entries.items():
            if key not in _KEYS:
                hint = self._belongs(key) or did_you_mean(key[:40], _KEYS)
                self._error(document, at, "unknown-key", f"unknown key `{key[:40]}` in a LabState", hint)
        components = root.get("components")
        if isinstance(components, Map):
            self._components(document, components)
        elif components is not None and not _empty(components):
            hint = "expected a mapping of component names, such as `p1: {slot: storage/a1}`"
            self._error(document, components, "type", "`components` is not a mapping", hint)
        self._expect(document, root.get("expect"))

    def check_slots(self) -> None:
        """Find slots that two components of the whole state claim; a part that the state does not name goes home."""
        owner: dict[str, str] = {}
        for name, part in self.components.items():
            if part.slot is None:
                continue
            if part.slot in owner:
                other = owner[part.slot]
                detail = f"{other} is put there at {self.place(other, 'slot')}"
                self._slot_error(name, f"{name} and {other} are both put into {part.slot}", detail)
            owner.setdefault(part.slot, name)
        for name, home in self.view.homes.items():
            if name not in self.first and home in owner and owner[home] != name:
                detail = f"{name} is not in the state, so it goes home, and {home} is its home"
                self._slot_error(owner[home], f"{owner[home]} is put into {home}, the home of {name}", detail)

    def _lab(self, document: Document, root: Map) -> None:
        node = root.get("metadata")
        value = node.get("lab") if isinstance(node, Map) else None
        text = value.text if isinstance(value, Scalar) else ""
        self.lab = self.lab or text
        if not isinstance(node, Map):
            return  # said with the header
        hint = f"write `metadata: {{lab: {self.view.lab or 'NAME'}}}`"
        if value is None:
            where_ = where_key(document, "metadata")
            self.found.append(error("missing-key", "metadata has no `lab`", hint=hint, source=where_))
        elif not isinstance(value, Scalar) or not isinstance(value.value, str) or not text:
            self._error(document, value, "type", "`metadata.lab` is not a name", hint)
        elif self.view.lab is not None and text != self.view.lab:
            summary = f"this state is of lab `{text[:40]}`, the bench here is `{self.view.lab}`"
            self._error(document, value, "lab", summary, hint)

    def _components(self, document: Document, components: Map) -> None:
        if len(components.entries) > MOST_COMPONENTS:
            summary = f"{len(components.entries)} components in one file"
            hint = "split it: one file a sub-assembly, 10 to 50 components; states that branches change then merge"
            self.found.append(warning("large-file", summary, hint=hint, source=where_key(document, "components")))
        for word, (key, node) in components.entries.items():
            name = self._present(document, word, key)
            if name in self.view.without and name not in self.view.kinds:
                at = document.source.range(key.start, key.end)
                text = f"{name} is not in the inventory of this lab, and left out as asked"
                self.found.append(Diagnostic("note", EXCLUDED, text, address=name, source=at))
                continue
            if name in self.first and self.words[name] != word:
                detail = f"at {where_key(self.first[name], 'components', self.words[name])} as {self.words[name]}"
                hint = f"keep one of the two: {name} is the name of now"
                summary = f"{self.words[name]} and {word} are one part, which is now called {name}"
                self._error(document, key, "duplicate", summary, hint, name, detail=detail)
                continue
            if name in self.first:
                first = where_key(self.first[name], "components", self.words[name])
                hint = "keep one of the two"
                self._error(
                    document, key, "duplicate", f"{name} is in two files", hint, name, detail=f"first at {first}"
                )
                continue
            self.first[name], self.words[name] = document, word
            if name not in self.view.kinds:
                self._unknown(document, key)
            else:
                self._component(document, name, key, node)

    def _present(self, document: Document, word: str, key: Scalar) -> str:
        """Return the present name of a component that may be named as it was before."""
        name = self.view.name(word)
        if name != word:
            at = document.source.range(key.start, key.end)
            hint = f"write `{name}:` here"
            self.found.append(warning(RENAMED, f"{word} is now called {name}", hint=hint, address=name, source=at))
        return name

    def _belongs(self, key: str) -> str:
        """Return where a key belongs that is the name of a component."""
        return f"`{key}` is a component: begin it in the column of the others" if key in self.view.kinds else ""

    def _unknown(self, document: Document, key: Scalar) -> None:
        problem = name_problem(key.text)
        if problem:
            self._error(document, key, "name", f"`{key.text[:40]}` is not a name", f"expected {problem}")
            return
        owner = next((n for n, kind in sorted(self.view.kinds.items()) if kind and key.text in kind.tunables), None)
        hint = did_you_mean(key.text, self.view.kinds) or "add it to the inventory in lab.yaml"
        if owner is not None:
            hint = f"`{key.text}` is a tunable, of {owner} for example: indent it as the `pose` of its component is"
        if key.text in ("slot", "pose", "x", "y", "yaw"):
            hint = f"`{key.text}` says where a component is: indent it below the name of its component"
        self._error(
            document, key, "unknown-component", f"{key.text} is not in the inventory of this lab", hint, key.text
        )

    def _component(self, document: Document, name: str, key: Scalar, node: Node) -> None:
        if not isinstance(node, Map):
            if not _empty(node):
                hint = "expected `slot:` or `pose:` and one line a tunable"
                self._error(document, node, "type", f"{name} is {shown(plain(node))}", hint, name)
                return
            node = Map(key.start, True)
        slot, pose = node.entries.get("slot"), node.entries.get("pose")
        if slot and pose:
            hint = "keep one: a slot for storage, a pose on the table"
            self._error(document, slot[0], "place", f"{name} has both a slot and a pose", hint, name)
        elif not slot and not pose and name not in self.view.fixed:
            hint = "add `slot: NAME`, or `pose: {x: ..., y: ..., yaw: ...}`"
            self._error(document, key, "place", f"{name} has neither a slot nor a pose", hint, name)
        self.components[name] = ComponentState(
            slot=self._slot(document, name, slot[1]) if slot else None,
            pose=self._pose(document, name, *pose) if pose else None,
            values=self._values(document, name, node),
            by_light=self._by_light(document, name, node),
        )

    def _slot(self, document: Document, name: str, node: Node) -> str | None:
        text = node.text if isinstance(node, Scalar) else ""
        if name in self.view.fixed:
            summary = f"{name} is fixed to the table and can't be in a slot"
            self._error(document, node, "slot", summary, "give its `pose`, or leave it out", name)
        elif not isinstance(node, Scalar) or text not in self.view.slots:
            hint = slot_meant(text[:40], self.view.slots) or "the slots are listed under `slots:` in lab.yaml"
            said = (
                f"there is no slot {shown(text)}" if isinstance(plain(node), str) else f"slot is {shown(plain(node))}"
            )
            self._error(document, node, "unknown-slot", f"{name}: {said}", hint, f"{name}.slot")
        else:
            return text
        return None

    def _pose(self, document: Document, name: str, key: Scalar, node: Node) -> Pose | None:
        example = "expected `{x: ..., y: ..., yaw: ...}` in mm and deg"
        if not isinstance(node, Map):
            at = key if _empty(node) else node
            self._error(document, at, "type", f"the pose of {name} is {shown(plain(node))}", example, f"{name}.pose")
            return None
        numbers: dict[str, float] = {}
        for axis, unit in _POSE:
            value = node.get(axis)
            if value is None:
                if axis != "yaw":
                    self._error(
                        document, key, "missing-key", f"the pose of {name} has no `{axis}`", example, f"{name}.pose"
                    )
                continue
            number = read_number(document.source, name, axis, unit, value)
            if isinstance(number, Diagnostic):
                self.found.append(number)
                continue
            numbers[axis] = number
            if axis == "yaw" and abs(number) > TURN:
                summary = f"the yaw of {name} is {shown(number)}: more than one turn"
                hint = f"write {wrap(number):.10g}, which is the same"
                self._error(document, value, "range", summary, hint, f"{name}.pose.yaw")
        for other, (at, _) in node.entries.items():
            if other not in ("x", "y", "yaw"):
                own = other in kinds.tunables if (kinds := self.view.kinds.get(name)) else False
                hint = f"`{other}` is a tunable of {name}: bring it back to the column of `pose`" if own else ""
                hint = hint or did_you_mean(other[:40], ("x", "y", "yaw"))
                summary = f"unknown key `{other[:40]}` in the pose of {name}"
                self._error(document, at, "unknown-key", summary, hint, f"{name}.pose")
        if "x" not in numbers or "y" not in numbers:
            return None
        pose = Pose(numbers["x"], numbers["y"], numbers.get("yaw", 0.0))
        if self.view.size and max(abs(pose.x), abs(pose.y)) > FAR:
            spot = where(document, "components", name, "pose", "y" if abs(pose.x) <= FAR else "x")
            self.found.append(off_table(name, pose.x, pose.y, self.view.size, spot))
        return pose

    def _values(self, document: Document, name: str, node: Map) -> dict[str, Value]:
        kind = self.view.kinds[name]
        values: dict[str, Value] = {}
        for key, (at, value) in node.entries.items():
            if key in ("slot", "pose") or kind is None:
                continue
            tunable = kind.tunables.get(key)
            if tunable is None:
                hint = self._belongs(key) or self._tunables(key[:40], kind.tunables)
                if key in ("x", "y", "yaw") and "pose" in node.entries:
                    hint = f"`{key}` belongs to the pose: indent it by two more, below `pose:`"
                self._error(
                    document, at, "unknown-tunable", f"{name} ({kind.name}) has no tunable `{key[:40]}`", hint, name
                )
                continue
            if isinstance(value, Map) and tunable.datatype == "float":
                continue  # where light says
            read = read_value(document.source, name, key, tunable, value)
            if isinstance(read, Diagnostic):
                self.found.append(read)
            else:
                values[key] = read
        return values

    def _by_light(self, document: Document, name: str, node: Map) -> dict[str, LightReference]:
        kind = self.view.kinds[name]
        found: dict[str, LightReference] = {}
        for key, (_, value) in node.entries.items():
            tunable = kind.tunables.get(key) if kind and key not in ("slot", "pose") else None
            if tunable is None or tunable.datatype != "float" or not isinstance(value, Map):
                continue
            read = read_reference(document.source, self.view, name, key, tunable, value)
            if isinstance(read, LightReference):
                found[key] = read
            else:
                self.found.extend(read)
        return found

    def _tunables(self, key: str, known: Iterable[str]) -> str:
        near = did_you_mean(key, known)
        place = did_you_mean(key, ("slot", "pose"))
        if near.startswith("did") or not place.startswith("did"):
            return near or "this type has none: only `slot` or `pose`"
        return place

    def _expect(self, document: Document, node: Node | None) -> None:
        example = 'expected a list of `{that: "cam.peak > 200", message: ...}`'
        if node is None or _empty(node):
            return
        if not isinstance(node, List):
            self._error(document, node, "type", "`expect` is not a list", example)
            return
        for item in node.items:
            data = plain(item)
            if not isinstance(item, Map) or not isinstance(data.get("that"), str) or not data["that"].strip():
                self._error(document, item, "type", "an expectation has no `that`", example)
                continue
            for key, (at, value) in item.entries.items():
                if key not in ("that", "message"):
                    summary = f"unknown key `{key[:40]}` in an expectation"
                    self._error(document, at, "unknown-key", summary, did_you_mean(key[:40], ("that", "message")))
                elif not isinstance(data[key], str):
                    self._error(document, value, "type", f"`{key}` is {shown(data[key])}", "expected text")
            that = renamed_expression(self.view.formerly, data["that"])
            self.expect.append(Expectation(that=that, message=str(data.get("message") or "")))

    def place(self, name: str, key: str) -> SourceRange:
        """Return where a component has what a key says of it."""
        return where(self.first[name], "components", self.words[name], key)

    def _slot_error(self, name: str, summary: str, detail: str) -> None:
        hint = "give one of them another slot or a pose, or take back with `git revert` the commit that did it"
        at = self.place(name, "slot")
        self.found.append(error("slot", summary, detail=detail, hint=hint, address=f"{name}.slot", source=at))

    def _error(
        self, document: Document, node: Node, code: str, summary: str, hint: str, address: str = "", detail: str = ""
    ) -> None:
        at = document.source.range(node.start, node.end)
        self.found.append(error(code, summary, detail=detail, hint=hint, address=address, source=at))


def _empty(node: Node) -> bool:
    return isinstance(node, Scalar) and node.value is None
