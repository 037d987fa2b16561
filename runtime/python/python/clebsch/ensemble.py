"""Many runs on all cores."""

from __future__ import annotations

import os
from collections.abc import Iterable

import numpy as np

from ._numbers import Values, row_type
from .errors import SolveError
from .motion import Motion
from .system import State, Stepper, in_order


class Ensemble:
    """Many bodies of one declaration, each with its start. They may have parameters and step sizes of their own.

    Each body has the bits that it has alone.
    """

    def __init__(self, steppers: Stepper | Iterable[Stepper], starts: Iterable[State]) -> None:
        #: The starts.
        self.starts = tuple(starts)
        #: The stepper of each body.
        self.steppers = (steppers,) * len(self.starts) if isinstance(steppers, Stepper) else tuple(steppers)
        if len(self.steppers) != len(self.starts):
            raise ValueError(f"there are {len(self.steppers)} steppers and {len(self.starts)} starts: give one for each")
        if len({id(stepper.declaration) for stepper in self.steppers}) > 1:
            raise ValueError("the bodies of an ensemble have one declaration")

    def run(self, times: Values, threads: int | None = None) -> Motion:
        """The states of all bodies at these times: `motion["R"]` has the bodies first, then the times.

        Raises `SolveError` for the first body that fails, by its number, which the error has.
        """
        if not self.steppers:
            raise ValueError("the ensemble has no bodies")
        pairs = list(zip(self.steppers, self.starts, strict=True))
        # one check for bodies that start at one time
        ordered = next(in_order(times, step, t) for step, t in {(stepper.step_size, start.t) for stepper, start in pairs})
        declaration = self.steppers[0].declaration
        natives = [stepper._native for stepper in self.steppers], [stepper._own(start) for stepper, start in pairs]
        try:
            rows, ends = declaration._run_all(*natives, ordered.tobytes(), threads or os.cpu_count() or 1)
        except SolveError as error:
            # by construction: the library says which body
            stepper = self.steppers[error.body or 0]
            error.state = State(stepper, error.state)
            raise
        array = np.frombuffer(rows, row_type(declaration.columns)).reshape(len(pairs), len(ordered))
        return Motion(array, tuple(State(stepper, end) for stepper, end in zip(self.steppers, ends, strict=True)))

    def __len__(self) -> int:
        return len(self.starts)
