"""What can go wrong, each with a class of its own."""

from __future__ import annotations

from typing import Any


class Error(Exception):
    """Every error of clebsch."""


class ToolchainError(Error):
    """There is no cargo, or it is too old, or it failed for a reason that is not in the declaration."""


class DeclarationError(Error, ValueError):
    """The declaration has a mistake. The text is that of the macro, or of rustc, with its place in the text of the user."""

    def __init__(self, rendered: str, mistakes: tuple[tuple[str, int, int], ...]) -> None:
        super().__init__(rendered)
        #: Each mistake: its message with help and notes, its line from 1, and its column from 1. The line is 0 if it is in none.
        self.mistakes = mistakes

    @property
    def message(self) -> str:
        """The message of the first mistake, with its help and its notes."""
        return self.mistakes[0][0]

    @property
    def line(self) -> int:
        """The line of the first mistake, from 1; 0 if it is in none."""
        return self.mistakes[0][1]

    @property
    def column(self) -> int:
        """The column of the first mistake, from 1."""
        return self.mistakes[0][2]

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (str(self), self.mistakes)


class _Refused(Error, ValueError):
    """A refusal of the runtime, whose words it has."""

    def __init__(self, message: str, kind: str) -> None:
        super().__init__(message)
        #: The name of the error in Rust, such as `OffOrbit`.
        self.kind = kind

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (str(self), self.kind)


class ParameterError(_Refused):
    """The parameters or the step size make no stepper."""


class StateError(_Refused):
    """The numbers are no state, or an impulse is none of this state."""


class SolveError(Error, ArithmeticError):
    """A step has no solution. The state before it is there."""

    def __init__(self, message: str, kind: str, state: Any, done: int, body: int | None = None) -> None:
        super().__init__(message)
        #: The name of the error in Rust, such as `Unsolvable`.
        self.kind = kind
        #: The last good state.
        self.state = state
        #: The number of steps before it, or of times in a run.
        self.done = done
        #: The number of the body in an ensemble.
        self.body = body

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (str(self), self.kind, self.state, self.done, self.body)
