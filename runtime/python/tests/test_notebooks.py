"""The notebook runs, and its motion has the bits of the scene in Rust."""

from __future__ import annotations

from pathlib import Path

import nbformat
import numpy as np
from conftest import REPOSITORY, reference
from nbclient import NotebookClient

NOTEBOOK = REPOSITORY / "runtime" / "python" / "notebooks" / "heavy_top.ipynb"


def test_the_notebook_of_the_heavy_top_has_the_bits_of_the_scene(tmp_path: Path) -> None:
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    saved = tmp_path / "motion.npy"
    notebook.cells.append(nbformat.v4.new_code_cell(f"np.save({str(saved)!r}, motion.array)"))
    NotebookClient(notebook, timeout=600, kernel_name="python3").execute()

    shown = next(cell for cell in notebook.cells if cell.source == "HeavyTop.derivation").outputs[0].data
    assert shown["text/markdown"].startswith("### HeavyTop")
    assert shown["text/latex"].startswith(r"$$\begin{align*}")

    scene = np.genfromtxt(reference("heavy_top.csv"), delimiter=",", names=True)
    motion = np.load(saved)[::50]
    columns = [f"R{row}{column}" for row in "123" for column in "123"] + ["pi1", "pi2", "pi3"]
    there = np.stack([scene[name] for name in columns], axis=1)
    here = np.concatenate([motion["R"].reshape(-1, 9), motion["N"]], axis=1)
    assert scene["step"].tolist() == list(range(0, 4201, 50))
    assert np.array_equal(here, there)
