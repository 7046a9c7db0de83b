"""The header of a manifest: apiVersion, kind and metadata, and which documents are PICO's at all."""

from __future__ import annotations

import re
from collections.abc import Container
from typing import Literal

from pico.diagnostics import Diagnostic, did_you_mean, error
from pico.manifest.text.source import Source
from pico.manifest.text.tree import Document, Map, Node, Scalar

API = "pico/v1"
Kind = Literal["Lab", "LabState", "ComponentType", "Devices"]
KINDS: tuple[Kind, ...] = ("Lab", "LabState", "ComponentType", "Devices")
READ_ELSEWHERE = ("Recipe", "Emulation")
METADATA: dict[str, tuple[str, ...]] = {
    "Lab": ("name", "title"),
    "LabState": ("lab",),
    "ComponentType": ("name", "title", "description"),
    "Devices": ("lab",),
    "Emulation": ("lab",),
}
NAME = re.compile(r"[a-z][a-z0-9_]*")
PATH_NAME = re.compile(r"[a-z][a-z0-9_]*(?:/[a-z0-9][a-z0-9_]*)*")
_OURS = {"components", "inventory", "tunables", "apiversion", "api_version", "expect"}
_HEADER = "apiVersion: pico/v1"


def kind_of(document: Document) -> tuple[Kind | None, list[Diagnostic]]:
    """Return the kind of a document; None, and no diagnostic, for YAML that is not meant for PICO."""
    root, source = document.root, document.source
    if not isinstance(root, Map):
        hint = f"begin it with `{_HEADER}` and `kind:`; YAML for other programs may end in `.yml`"
        return None, [_at(source, root, "not-a-manifest", "a manifest is a mapping of keys to values", hint)]
    api = root.get("apiVersion")
    if api is None or not isinstance(api, Scalar) or not api.text.startswith("pico/"):
        return None, _foreign(document, root, api)
    if api.text != API:
        return None, [
            _at(source, api, "api-version", f"this version of PICO does not read `{api.text[:40]}`", f"known: `{API}`")
        ]
    return _declared(document, root)


def _foreign(document: Document, root: Map, api: Node | None) -> list[Diagnostic]:
    kind = root.get("kind")
    named = isinstance(kind, Scalar) and kind.text in KINDS
    meant = isinstance(api, Scalar) and "pico" in api.text.lower()
    if not (named or meant or any(key.lower() in _OURS and key != "apiVersion" for key in root.entries)):
        return []
    near = [at for key, (at, _) in root.entries.items() if did_you_mean(key[:40], ["apiVersion"]).startswith("did")]
    if api is None and near:
        hint = "did you mean `apiVersion`?"
        return [_at(document.source, near[0], "unknown-key", f"unknown key `{near[0].text[:40]}`", hint)]
    if api is None:
        return [
            _at(document.source, root, "api-version", "`apiVersion` is missing", f"begin the file with `{_HEADER}`")
        ]
    return [_at(document.source, api, "api-version", "`apiVersion` is not one of PICO's", f"write `{_HEADER}`")]


def headless(document: Document, parts: Container[str]) -> list[Diagnostic]:
    """Return an error for a document that is not meant for PICO by its header, and is a state by what it holds: keys at
    its top are `parts` of the inventory."""
    entries = document.root.entries if isinstance(document.root, Map) else {}
    held = [at for name, (at, node) in entries.items() if name in parts and isinstance(node, Map)]
    if not held:
        return []
    hint = f"begin it with `{_HEADER}`, `kind: LabState`, `metadata` and `components:`"
    return [_at(document.source, held[0], "api-version", f"`{held[0].text}` stands outside any LabState", hint)]


def _declared(document: Document, root: Map) -> tuple[Kind | None, list[Diagnostic]]:
    node, source = root.get("kind"), document.source
    if node is None:
        hint = "add `kind: LabState` (or `Lab`, `ComponentType`, `Devices`)"
        return None, [_at(source, root, "kind", "`kind` is missing", hint)]
    text = node.text if isinstance(node, Scalar) else "[...]"
    if text in READ_ELSEWHERE:
        parts = root.entries.get("components")
        hint = "if it is a state, write `kind: LabState`; if not, take `components` out"
        return None, [_at(source, parts[0], "kind", f"a {text} has no `components`", hint)] if parts else []
    for kind in KINDS:
        if text == kind:
            return kind, _metadata(document, root, kind)
    hint = did_you_mean(text[:40], [*KINDS, *READ_ELSEWHERE])
    return None, [_at(source, node, "kind", f"unknown kind `{text[:40]}`", hint)]


def _metadata(document: Document, root: Map, kind: Kind) -> list[Diagnostic]:
    node = root.get("metadata")
    example = f"metadata: {{{METADATA[kind][0]}: ...}}"
    if node is None:
        return [_at(document.source, root, "missing-key", f"the {kind} has no `metadata`", f"add `{example}`")]
    if not isinstance(node, Map):
        return [_at(document.source, node, "type", "`metadata` is not a mapping", f"write `{example}`")]
    found = []
    for key, (at, _) in node.entries.items():
        if key not in METADATA[kind]:
            hint = did_you_mean(key[:40], METADATA[kind])
            summary = f"unknown key `{key[:40]}` in metadata of a {kind}"
            found.append(_at(document.source, at, "unknown-key", summary, hint))
    return found


def _at(source: Source, node: Node, code: str, summary: str, hint: str) -> Diagnostic:
    # A block mapping is shown by its first key.
    if isinstance(node, Map) and node.entries and not node.flow:
        node = next(iter(node.entries.values()))[0]
    return error(code, summary, hint=hint, source=source.range(node.start, node.end))
