"""The derivation of a declaration, as text, as LaTeX, and in a notebook."""

from __future__ import annotations

import re
from dataclasses import dataclass


@dataclass(frozen=True)
class Derivation:
    """The formulas of a declaration."""

    #: An appendix of a paper, in LaTeX.
    latex: str
    #: The derivation in words and formulas, with operation counts.
    text: str = ""

    def __str__(self) -> str:
        return self.text or self.latex

    @property
    def equations(self) -> str:
        """The equations alone, a block of `align*`."""
        found = re.search(r"\\begin\{align\*\}.*?\\end\{align\*\}", self.latex, re.DOTALL)
        return found.group() if found else ""

    def _repr_latex_(self) -> str:
        return f"$${self.equations}$$"

    def _repr_markdown_(self) -> str:
        text = re.sub(r"\{\\allowdisplaybreaks\s*|^%.*$", "", self.latex, flags=re.MULTILINE)
        text = re.sub(r"\\section\*\{(.*?)\}", r"### \1", text)
        text = re.sub(r"\\paragraph\{(.*?)\}", r"**\1**\n", text)
        text = re.sub(r"\\(begin|end)\{itemize\}", "", text)
        text = re.sub(r"^\\item", "*", text, flags=re.MULTILINE)
        text = re.sub(r"(\\begin\{align\*\})", r"$$\1", text)
        return re.sub(r"(\\end\{align\*\})\}?", r"\1$$", text).strip()
