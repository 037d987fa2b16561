"""Declarations: their mistakes, and what they say of themselves."""

from __future__ import annotations

import pickle
import re
from pathlib import Path

import clebsch
import pytest
from conftest import REPOSITORY, fixture_text

REJECTED = sorted((REPOSITORY / "tests" / "fixtures" / "reject").glob("*.rs"))

PARTICLE = """
#[derive(Clebsch, Clone, Debug)]
#[clebsch(action = |a: Translation<1>, x: Vector1| x + a, cost = |h, a| self.mass * a.norm_squared() / (2 * h))]
pub struct Particle {
    pub mass: f64,
}
"""


def mistakes_of_macro(fixture: Path) -> list[tuple[str, int, int]]:
    """The mistakes that the tests of the macro expect: lines of text, then the line and the column, both from 1."""
    snapshot = REPOSITORY / "tests" / "snapshots" / "reject" / f"{fixture.stem}.snap"
    said = snapshot.read_text(encoding="utf-8").split("\n---\n", 1)[1]
    texts, places = re.split(r"\n\n(?=\d+:\d+$)", said, maxsplit=1, flags=re.MULTILINE)
    messages = [re.sub(r"\n *", "\n", text) for text in re.split(r"\n*^error: ", texts, flags=re.MULTILINE)[1:]]
    spans = re.findall(r"^(\d+):(\d+)$", places, re.MULTILINE)
    return [(text, int(line), int(column)) for text, (line, column) in zip(messages, spans, strict=True)]


@pytest.mark.parametrize("fixture", REJECTED, ids=lambda fixture: fixture.stem)
def test_mistakes_have_the_text_and_the_place_of_the_macro(fixture: Path) -> None:
    with pytest.raises(clebsch.DeclarationError) as raised:
        clebsch.check(fixture.read_text(encoding="utf-8"))
    found = [(text.replace("\n\n", "\n"), line, column) for text, line, column in raised.value.mistakes]
    assert found == mistakes_of_macro(fixture)


def test_a_mistake_is_shown_in_its_line() -> None:
    with pytest.raises(clebsch.DeclarationError) as raised:
        clebsch.check(PARTICLE.replace("self.mass", "self.mas"))
    error = raised.value
    assert (error.line, error.column) == (3, PARTICLE.splitlines()[2].index("self.mass") + 6)
    assert str(error).splitlines()[4].endswith("|" + " " * error.column + "^^^")
    assert "help: a field with a similar name exists: `mass`" in error.message
    assert str(pickle.loads(pickle.dumps(error))) == str(error)


def test_mistakes_that_rustc_finds_have_their_place() -> None:
    text = PARTICLE + "\nfn other() -> Missing { todo!() }\n"
    with pytest.raises(clebsch.DeclarationError, match="cannot find type `Missing` in this scope") as raised:
        clebsch.compile(text)
    assert (raised.value.line, raised.value.column) == (8, 15)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "the text has no struct"),
        ("struct Plain;", "the text has no struct"),
        (PARTICLE + PARTICLE.replace("Particle", "Other"), "more than one struct"),
        (PARTICLE.replace("{\n    pub mass: f64,\n}", "(f64);").replace("self.mass * ", ""), "fields without names"),
        (fixture_text("sine_gordon"), "is a field"),
        (fixture_text("unicycle"), "has no momentum"),
        ("#[derive(Clebsch)", "cannot parse|expected|unclosed|lex"),
    ],
)
def test_texts_that_python_does_not_step_are_refused(text: str, message: str) -> None:
    with pytest.raises(clebsch.DeclarationError, match=message):
        clebsch.compile(text)


def test_parameters_of_the_struct_are_asked_for() -> None:
    with pytest.raises(ValueError, match=r"the constants \[\] are given, and \['N'\] are needed"):
        clebsch.compile(fixture_text("spin_chain"))
    with pytest.raises(ValueError, match="the scalar is `f16`, and f64 or f32 is needed"):
        clebsch.compile(PARTICLE, scalar="f16")


def test_a_declaration_says_what_it_is_made_of(
    heavy_top: clebsch.Declaration,
    probe: clebsch.Declaration,
    spin_chain: clebsch.Declaration,
    three_ways: clebsch.Declaration,
) -> None:
    assert heavy_top.parameters == (("mass_matrix", (3, 3)), ("weight", ()), ("center", (3,)))
    assert (heavy_top.configuration, heavy_top.momentum) == ((("R", (3, 3)),), ("N", (3,)))
    assert (heavy_top.order, heavy_top.is_timed, heavy_top.conserved) == (2, False, ("about e3, spatial",))
    assert (probe.configuration, probe.input) == ((("x", (3,)), ("Q", (4,))), ("input", (6,)))
    assert probe.is_timed
    assert (spin_chain.configuration, spin_chain.momentum) == ((("q", (5, 3)),), ("N", (5, 3)))
    assert three_ways.methods == ("Fine", "Quick")
    assert repr(heavy_top) == "<declaration HeavyTop(mass_matrix[3, 3], weight, center[3])>"


def test_the_derivation_is_that_of_rust(heavy_top: clebsch.Declaration) -> None:
    derivation = heavy_top.derivation
    assert "discrete Lagrangian" in str(derivation)
    assert derivation.equations.startswith(r"\begin{align*}")
    assert r"\tag*{momentum update}" in derivation.equations
    assert derivation._repr_latex_() == f"$${derivation.equations}$$"
    shown = derivation._repr_markdown_()
    assert shown.startswith("### HeavyTop")
    assert shown.count("$$") == 2
    assert not re.search(r"\\(section|paragraph|item|allowdisplaybreaks)", shown)
    assert clebsch.derive(heavy_top.text).latex == derivation.latex
