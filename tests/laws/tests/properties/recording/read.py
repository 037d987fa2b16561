"""Reads an array, a text and an archive of the test `numpy_reads_recordings`, and checks names, shapes and numbers."""

import csv
import sys
import zipfile

import numpy

array, table, archive = sys.argv[1:]

top = numpy.load(array)
assert top.shape == (4,), top.shape
assert top.dtype.names == ("t", "R", "N", "about e3, spatial"), top.dtype.names
assert top["R"].shape == (4, 3, 3) and top["N"].shape == (4, 3)
assert (top["t"] == [0, 0.125, 0.25, 0.375]).all()
assert (top["R"][0] == numpy.eye(3)).all() and (top["N"][0] == [0.5, 0.25, 2]).all()
# rotations, by rows: the conserved momentum is the third component of R N
assert numpy.allclose(top["R"] @ top["R"].transpose(0, 2, 1), numpy.eye(3), rtol=0, atol=1e-14)
spatial = numpy.einsum("kij,kj->ki", top["R"], top["N"])
assert numpy.allclose(spatial[:, 2], top["about e3, spatial"], rtol=0, atol=1e-14)

with open(table, newline="") as file:
    lines = list(csv.reader(file))
assert lines[0][:2] == ["t", "R[0,0]"] and lines[0][13] == "about e3, spatial", lines[0]
numbers = numpy.array(lines[1:], dtype=float)
assert (numbers[:, 1:10].reshape(-1, 3, 3) == top["R"]).all() and (numbers[:, 10:13] == top["N"]).all()

assert zipfile.ZipFile(archive).testzip() is None
runs = numpy.load(archive)
assert sorted(runs.files) == ["chain", "top"], runs.files
assert (runs["top"] == top).all()
chain = runs["chain"]
assert chain["q"].shape == (1, 3, 3) and (chain["q"][0, 2] == [1, 0, 0]).all()
assert chain["pair ξ"].shape == (1, 2) and (chain["pair ξ"]["1"][0, 1] == [1, 2, 3]).all()
