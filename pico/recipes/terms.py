"""Values in recipes: written out, or as expressions, whole or inside a text (`${tilt}`)."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from pico.expressions import Expression, Language, doubles

INSIDE = re.compile(r"\$\{([^{}]*)\}")
"""An expression inside a text."""
_WORD = re.compile(r"[A-Za-z_]\w*(?:\.[A-Za-z_]\w*)*")
_TEXT = re.compile(r"'(?:\\.|[^'\\])*'|\"(?:\\.|[^\"\\])*\"")


@dataclass(frozen=True)
class Term:
    """A value that is known when it is read (`literal`), or expressions: one, or several with text between (`parts`).
    `asks`: names of the bench whose values they need as they are by then."""

    literal: Any = None
    parts: tuple[str | Expression, ...] = ()
    asks: tuple[str, ...] = ()

    @property
    def known(self) -> bool:
        """Whether it needs no names."""
        return not self.parts

    @property
    def written(self) -> str:
        """The expression alone if it is nothing else, as an `assert` has it; otherwise `text`."""
        one = self.parts[0] if len(self.parts) == 1 else ""
        return self.text if isinstance(one, str) else one.text

    @property
    def text(self) -> str:
        """It as it was written, about."""
        if self.known:
            return f"{self.literal:.6g}" if isinstance(self.literal, float) else str(self.literal)
        return "".join(p if isinstance(p, str) else f"${{{p.text}}}" for p in self.parts)

    def as_far_as(self, names: Mapping[str, Any]) -> str:
        """Return it as a text, with the values of its expressions that are known; the others as they are written."""
        from pico.expressions import ExpressionError

        def one(part: Expression) -> str:
            try:
                return said(part.evaluate(names))
            except ExpressionError:
                return f"${{{part.text}}}"

        return "".join(p if isinstance(p, str) else one(p) for p in self.parts) or self.text

    def words(self) -> set[str]:
        """Return the names that its expressions may speak of, with all that looks like one."""
        texts = [_TEXT.sub("", p.text) for p in self.parts if not isinstance(p, str)]
        return {word for text in texts for word in _WORD.findall(text)}

    def value(self, names: Mapping[str, Any]) -> Any:
        """Return the value; raises `pico.expressions.ExpressionError` where there is none."""
        if self.known:
            return self.literal
        if len(self.parts) == 1 and not isinstance(self.parts[0], str):
            return self.parts[0].evaluate(names)
        return "".join(p if isinstance(p, str) else said(p.evaluate(names)) for p in self.parts)


def said(value: Any) -> str:
    """Return a value as it stands in a text."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float):
        return f"{value:.6g}"
    return ", ".join(said(v) for v in value) if isinstance(value, list) else str(value)


def literal(value: Any) -> Term:
    """Return a value that is known; numbers count as floats, as in expressions."""
    return Term(literal=doubles(value))


def text_term(text: str, language: Language) -> Term:
    """Return a text with the expressions in it; raises `pico.expressions.ExpressionError` for what is wrong with one,
    at its place in the text."""
    from pico.expressions import ExpressionError

    parts: list[str | Expression] = []
    last = 0
    for found in INSIDE.finditer(text):
        try:
            parts += [text[last : found.start()], language.compile(found[1], "any")]
        except ExpressionError as exc:
            at = found.start(1)
            raise ExpressionError(str(exc), at + exc.start, at + exc.end) from exc
        last = found.end()
    if not parts:
        return Term(literal=text)
    return Term(parts=tuple(p for p in (*parts, text[last:]) if p != ""))
