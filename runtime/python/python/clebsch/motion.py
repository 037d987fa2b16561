"""Motions: the states of a run as arrays of NumPy."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ._numbers import Array

if TYPE_CHECKING:
    from .system import State


class Motion:
    """The states of a run at its times, or those of many runs. `motion["R"]` has one entry for each, `motion.array` all of them."""

    def __init__(self, array: npt.NDArray[np.void], ends: tuple[State, ...]) -> None:
        #: An array with a field for each value: time, configuration, momentum, energy, conserved momenta.
        self.array = array
        #: The last state of each run, to go on from.
        self.ends = ends

    @property
    def names(self) -> tuple[str, ...]:
        """The names of its values."""
        return self.array.dtype.names or ()

    @property
    def end(self) -> State:
        """The last state of a single run."""
        if len(self.ends) != 1:
            raise ValueError(f"the motion has {len(self.ends)} runs: take one of `ends`")
        return self.ends[0]

    @property
    def t(self) -> Array:
        """The times."""
        return self["t"]

    @property
    def energy(self) -> Array:
        """The energy at each time."""
        return self["energy"]

    def __getitem__(self, name: str) -> Array:
        if name not in self.names:
            raise KeyError(f"the motion has no {name!r}: it has {', '.join(self.names)}")
        return self.array[name]

    def __len__(self) -> int:
        return len(self.array)

    def __repr__(self) -> str:
        return f"<motion of shape {self.array.shape}: {', '.join(self.names)}>"

    def __eq__(self, other: object) -> bool:
        """Whether all numbers have the same bits."""
        if not isinstance(other, Motion):
            return NotImplemented
        same: Any = self.array.dtype == other.array.dtype and self.array.shape == other.array.shape
        return bool(same) and self.array.tobytes() == other.array.tobytes()

    __hash__ = None  # type: ignore[assignment]
