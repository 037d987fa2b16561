"""Values as numbers one after the other, and back."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

#: An array, or anything that NumPy makes one of.
Values = npt.ArrayLike

#: Numbers in double precision.
Array = npt.NDArray[np.float64]

#: A name with the lengths of its array.
Shape = tuple[str, tuple[int, ...]]


def counted(shape: tuple[int, ...]) -> int:
    """How many numbers an array of this shape has."""
    return int(np.prod(shape, dtype=np.int64))


def flat(shape: Shape, values: Values) -> Array:
    """The numbers of a value of this shape, by rows."""
    name, lengths = shape
    try:
        array = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise ValueError(f"{name} is no array of numbers: {error}") from None
    if array.shape != lengths:
        raise ValueError(f"{name} has the shape {array.shape}, and {lengths} is needed")
    return array.ravel()


def joined(shapes: Sequence[Shape], values: Mapping[str, Any], of: str) -> bytes:
    """The bytes of named values in the order of their shapes."""
    names = [name for name, _ in shapes]
    unknown = [name for name in values if name not in names]
    missing = [name for name in names if name not in values]
    if unknown or missing:
        said = f"{of} has no {', '.join(map(repr, unknown))}" if unknown else f"{of} lacks {', '.join(map(repr, missing))}"
        raise TypeError(f"{said}: it is made of {', '.join(map(repr, names)) or 'nothing'}")
    parts = [flat(shape, values[shape[0]]) for shape in shapes]
    return np.concatenate(parts).tobytes() if parts else b""


def row_type(shapes: Sequence[Shape]) -> np.dtype[np.void]:
    """The type of a row: a field for each value."""
    return np.dtype([(name, np.float64, lengths) for name, lengths in shapes])
