"""Mistakes shown in the text of the user."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from .errors import DeclarationError


@dataclass(frozen=True)
class Mistake:
    """A mistake: its text, and its first letter and the place behind its last one. Lines count from 1, columns from 0."""

    message: str
    start: tuple[int, int]
    end: tuple[int, int]

    def shown(self, text: str) -> str:
        """The message with the line of the text, and marks under it."""
        first, *others = [line for line in self.message.splitlines() if line]
        return "\n".join([f"error: {first}", *self._marked(text), *(f"  = {line}" for line in others)])

    def _marked(self, text: str) -> list[str]:
        (line, column), (last, end) = self.start, self.end
        lines = text.split("\n")
        if not 1 <= line <= len(lines):
            return []
        code = lines[line - 1]
        behind = end if last == line else len(code)
        number = str(line)
        margin = " " * len(number)
        return [
            f"{margin}--> line {line}, column {column + 1}",
            f"{margin} |",
            f"{number} | {code}",
            f"{margin} | {' ' * column}{'^' * max(behind - column, 1)}",
        ]


def error_of(mistakes: Iterable[Mistake], text: str) -> DeclarationError:
    """One exception for all mistakes."""
    found = list(mistakes)
    last = text.count("\n") + 1
    places = ((one.message, *(one.start if 1 <= one.start[0] <= last else (0, 0))) for one in found)
    rendered = "\n\n".join(one.shown(text) for one in found)
    return DeclarationError(rendered, tuple((message, line, column + 1) for message, line, column in places))
