"""Systems, their steppers and their states."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ._numbers import Array, Shape, Values, flat, joined, row_type
from .errors import SolveError
from .motion import Motion

if TYPE_CHECKING:
    from .declaration import Declaration


class System:
    """A declaration with parameters."""

    def __init__(self, declaration: Declaration, parameters: bytes) -> None:
        #: The declaration.
        self.declaration = declaration
        self._parameters = parameters

    @property
    def parameters(self) -> dict[str, Any]:
        """The values of the fields."""
        row = np.frombuffer(self._parameters, row_type(self.declaration.parameters))
        return {name: row[name][0] for name, _ in self.declaration.parameters}

    def stepper(self, step_size: float, method: str | None = None) -> Stepper:
        """A stepper of this step size, by the declared dials or by a method of the declaration.

        Raises `ParameterError` if parameters or step size are refused.
        """
        return Stepper(self, float(step_size), method)

    def __repr__(self) -> str:
        values = ", ".join(f"{name}={value.tolist()}" for name, value in self.parameters.items())
        return f"{self.declaration.name}({values})"

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, System):
            return NotImplemented
        return self.declaration is other.declaration and self._parameters == other._parameters

    def __hash__(self) -> int:
        return hash((id(self.declaration), self._parameters))

    def __reduce__(self) -> tuple[Any, ...]:
        return System, (self.declaration, self._parameters)


class Stepper:
    """A system with a step size. It steps any number of states, and changes none."""

    def __init__(self, system: System, step_size: float, method: str | None) -> None:
        #: The system.
        self.system = system
        #: The step size.
        self.step_size = step_size
        #: The method; `None` for the declared dials.
        self.method = method
        self._native = self.declaration._library.stepper(system._parameters, step_size, method)

    @property
    def declaration(self) -> Declaration:
        """The declaration of the system."""
        return self.system.declaration

    def state(self, configuration: Any = None, momentum: Values | None = None, *, t: float = 0.0, **parts: Values) -> State:
        """The state of a configuration and a momentum, after checks: by names, as in `state(R=…, N=…)`, or in this order.

        A configuration of several parts is a tuple in the order of the action. `t` counts where the time matters.

        Raises `ValueError` with both shapes for a value of another shape, and `StateError` for numbers that are no state.
        """
        return State(self, self._native.state(self._row(configuration, momentum, t, parts), False))

    def project(self, configuration: Any = None, momentum: Values | None = None, *, t: float = 0.0, **parts: Values) -> State:
        """The state nearest to a configuration and a momentum, given as to `state`."""
        return State(self, self._native.state(self._row(configuration, momentum, t, parts), True))

    def step(self, state: State, input: Values | None = None) -> State:
        """The state after one step, with an input of the forces.

        Raises `SolveError`, which has the state, where the step has no solution.
        """
        numbers = None if input is None else flat(self.declaration.input, input).tobytes()
        with self._telling_states():
            return State(self, self._native.step(self._own(state), numbers))

    def advance(self, state: State, steps: int) -> State:
        """The state after so many steps.

        Raises `SolveError`, which has the last good state and the number of steps to it.
        """
        if steps < 0:
            raise ValueError(f"{steps} steps are asked for: a negative step size runs back")
        with self._telling_states():
            return State(self, self._native.advance(self._own(state), steps))

    def run(self, start: State, times: Values) -> Motion:
        """The states at these times, which are in the order of the steps.

        Times count from the start. Where the time matters they are those of the states. A time between two steps is reached by one step of
        a smaller size.

        Raises `ValueError` where a time is before the one in front of it, and `SolveError`, which has the last good state.
        """
        ordered = in_order(times, self.step_size, start.t)
        with self._telling_states():
            rows, end = self._native.run(self._own(start), ordered.tobytes())
        return Motion(np.frombuffer(rows, row_type(self.declaration.columns)), (State(self, end),))

    def kick(self, state: State, impulse: Values) -> State:
        """The state after an impulse, which is added to its momentum.

        Raises `StateError` if the impulse is none of this state.
        """
        return State(self, self._native.kick(self._own(state), flat(self.declaration.momentum, impulse).tobytes()))

    def energy(self, state: State) -> float:
        """Kinetic energy plus potential."""
        return float(self._row_of(state)["energy"])

    def conserved(self, state: State) -> dict[str, float]:
        """The momenta that no step changes, by their names."""
        row = self._row_of(state)
        return {name: float(row[name]) for name in self.declaration.conserved}

    def _own(self, state: State) -> Any:
        """The state in Rust. It has what the next step takes from the last one, which depends on the system."""
        if not isinstance(state, State):
            raise TypeError(f"a state is needed, and this is {type(state).__name__}")
        if state._stepper is not self and state._stepper.system != self.system:
            others = f"this state belongs to {state._stepper.system!r}, and the stepper to {self.system!r}"
            raise ValueError(f"{others}: make a state of its configuration and momentum")
        return state._native

    def _row_of(self, state: State) -> np.void:
        row: np.void = np.frombuffer(self._native.row(self._own(state)), row_type(self.declaration.columns))[0]
        return row

    def _row(self, configuration: Any, momentum: Values | None, t: float, parts: Mapping[str, Values]) -> bytes:
        shapes: list[Shape] = [("t", ()), *self.declaration.configuration, self.declaration.momentum]
        values: dict[str, Any] = {"t": t, **parts}
        if configuration is not None:
            of_configuration = [name for name, _ in self.declaration.configuration]
            several = configuration if len(of_configuration) > 1 else (configuration,)
            if len(several) != len(of_configuration):
                raise ValueError(f"the configuration has {len(several)} parts, and {', '.join(of_configuration)} are needed")
            values.update(zip(of_configuration, several, strict=True))
        if momentum is not None:
            values[self.declaration.momentum[0]] = momentum
        return joined(shapes, values, f"a state of {self.declaration.name}")

    @contextlib.contextmanager
    def _telling_states(self) -> Iterator[None]:
        """An error of a step has a state of Python."""
        try:
            yield
        except SolveError as error:
            error.state = State(self, error.state)
            raise

    def __repr__(self) -> str:
        method = f" by {self.method}" if self.method else ""
        return f"<stepper of {self.system!r}, h = {self.step_size}{method}>"

    def __reduce__(self) -> tuple[Any, ...]:
        return Stepper, (self.system, self.step_size, self.method)


class State:
    """A configuration with its momentum. It also has what the next step takes from the last one."""

    def __init__(self, stepper: Stepper, native: Any) -> None:
        self._stepper = stepper
        self._native = native

    @property
    def stepper(self) -> Stepper:
        """The stepper that made it."""
        return self._stepper

    @property
    def t(self) -> float:
        """The time; 0 where it does not matter."""
        return float(self["t"])

    @property
    def configuration(self) -> Any:
        """The configuration: an array, or a tuple of these."""
        row = self._stepper._row_of(self)
        parts = tuple(row[name] for name, _ in self._stepper.declaration.configuration)
        return parts if len(parts) > 1 else parts[0]

    @property
    def momentum(self) -> Array:
        """The momentum."""
        return np.asarray(self[self._stepper.declaration.momentum[0]])

    def __getitem__(self, name: str) -> Any:
        """A value of the row by its name: `state["R"]`, `state["energy"]`."""
        row = self._stepper._row_of(self)
        if name not in (row.dtype.names or ()):
            raise KeyError(f"the state has no {name!r}: it has {', '.join(row.dtype.names or ())}")
        return row[name]

    def __repr__(self) -> str:
        shown = [self._stepper.declaration.momentum[0], *(name for name, _ in self._stepper.declaration.configuration)]
        return f"State({', '.join(f'{name}={np.asarray(self[name]).tolist()}' for name in reversed(shown))})"

    def __eq__(self, other: object) -> bool:
        return self._saved() == other._saved() if isinstance(other, State) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._saved())

    def _saved(self) -> bytes:
        saved: bytes = self._stepper._native.save(self._native)
        return saved

    def __reduce__(self) -> tuple[Any, ...]:
        return _resumed, (self._stepper, self._saved())


def _resumed(stepper: Stepper, saved: bytes) -> State:
    return State(stepper, stepper._native.resume(saved))


def in_order(times: Values, step_size: float, start: float) -> Array:
    """The times, one after the other in the order of the steps, and none before the start."""
    ordered = np.asarray(times, dtype=np.float64)
    if ordered.ndim != 1:
        raise ValueError(f"the times have the shape {ordered.shape}, and one length is needed")
    if not np.isfinite(ordered).all():
        place = int(np.argmin(np.isfinite(ordered)))
        raise ValueError(f"times[{place}] is {ordered[place]}, and a time is finite")
    ways = np.sign(step_size) * np.diff(ordered, prepend=start)
    if (ways < 0).any():
        place = int(np.argmax(ways < 0))
        before = ordered[place - 1] if place else start
        order = "increase" if step_size > 0 else "decrease"
        raise ValueError(f"times[{place}] is {ordered[place]} after {before}, and times {order} with steps of {step_size}")
    return ordered
