"""What a plain scalar means: the core schema of YAML 1.2 (section 10.3.2), where `on`, `no` and `12:30:45` are text."""

from __future__ import annotations

import re

Plain = None | bool | int | float | str

_WORDS: dict[str, Plain] = {
    "": None, "~": None, "null": None, "Null": None, "NULL": None,
    "true": True, "True": True, "TRUE": True, "false": False, "False": False, "FALSE": False,
}  # fmt: skip
_INT = re.compile(r"[-+]?[0-9]+")
_BASED = re.compile(r"0o[0-7]+|0x[0-9a-fA-F]+")
_FLOAT = re.compile(r"[-+]?(?:\.[0-9]+|[0-9]+(?:\.[0-9]*)?)(?:[eE][-+]?[0-9]+)?")
_INFINITE = re.compile(r"[-+]?\.(?:inf|Inf|INF)|\.(?:nan|NaN|NAN)")
_EXACT_DIGITS = 15


def resolve(text: str) -> Plain:
    """Return the value of a plain scalar. Numbers too large for a float come out infinite."""
    if not text or text[0] not in "+-.0123456789":
        return _WORDS.get(text, text)
    if _INT.fullmatch(text):
        return int(text) if len(text) <= _EXACT_DIGITS else float(text)
    if _FLOAT.fullmatch(text):
        return float(text)
    if _BASED.fullmatch(text):
        return int(text, 0) if len(text) <= _EXACT_DIGITS else float("inf")
    return float(text.replace(".", "", 1)) if _INFINITE.fullmatch(text) else text
