"""The code of the README, of the recipe and of the package runs as it is shown."""

from __future__ import annotations

import doctest
import re

import clebsch
import pytest
from conftest import REPOSITORY


@pytest.mark.parametrize("page", ["runtime/python/README.md", "docs/book/src/recipes/python.md"])
def test_the_code_of_a_page_runs(page: str) -> None:
    text = (REPOSITORY / page).read_text(encoding="utf-8")
    blocks = re.findall(r"^```python\n(.*?)^```$", text, re.DOTALL | re.MULTILINE)
    names: dict[str, object] = {"__name__": "__main__"}
    assert blocks
    for block in blocks:
        exec(compile(block, page, "exec"), names)


def test_the_code_of_the_package_runs() -> None:
    results = doctest.testmod(clebsch)
    assert (results.failed, results.attempted > 0) == (0, True)


def test_exceptions_of_the_recipe_are_those_of_the_package() -> None:
    text = (REPOSITORY / "docs/book/src/recipes/python.md").read_text(encoding="utf-8")
    named = set(re.findall(r"^\| `(\w+Error)` \|", text, re.MULTILINE)) - {"ValueError"}
    assert named == {name for name in clebsch.__all__ if name.endswith("Error") and name != "Error"}
