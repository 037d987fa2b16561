"""Declarations: the text of a struct in Rust, compiled."""

from __future__ import annotations

import functools
import re
import threading
from collections.abc import Mapping
from typing import Any

from . import _build, _compiler, _load
from ._diagnostics import Mistake, error_of
from ._numbers import Shape, Values, joined
from .derivation import Derivation
from .errors import DeclarationError
from .system import System

_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")


def compile(text: str, *, scalar: str = "f64", constants: Mapping[str, int] | None = None) -> Declaration:
    """A declaration, from the text of its struct as a user of Rust writes it.

    Mistakes are found before anything is built. The library is built by cargo, without a network, and found again in the cache.
    Where the struct has a type parameter it is `scalar`, `f64` or `f32`. `constants` has the values of its parameters of constants,
    such as `{"N": 8}`.

    Raises `DeclarationError` for a mistake in the text, and `ToolchainError` if cargo is missing or fails.
    """
    if scalar not in ("f64", "f32"):
        raise ValueError(f"the scalar is `{scalar}`, and f64 or f32 is needed")
    return _compiled(text, scalar, tuple(sorted((constants or {}).items())))


_lock = threading.Lock()


def _compiled(text: str, scalar: str, constants: tuple[tuple[str, int], ...]) -> Declaration:
    with _lock:
        return _of_process(text, scalar, constants)


@functools.cache
def _of_process(text: str, scalar: str, constants: tuple[tuple[str, int], ...]) -> Declaration:
    source = _source(text, scalar, dict(constants))
    return Declaration(text, scalar, constants, _load.module(_build.library(source)))


def check(text: str) -> None:
    """Raises `DeclarationError` if a declaration has a mistake. It needs no cargo, and takes milliseconds."""
    _checked(text)


def derive(text: str) -> Derivation:
    """The formulas of a declaration. They need no cargo, and take milliseconds."""
    found, mistakes = _compiler.latex(text)
    if found is None:
        raise _error(mistakes, text)
    return Derivation(found)


def _checked(text: str) -> Any:
    found, mistakes = _compiler.check(text)
    if found is None:
        raise _error(mistakes, text)
    return found


def _error(mistakes: Any, text: str) -> DeclarationError:
    return error_of([Mistake(**mistake) for mistake in mistakes], text)


def _source(text: str, scalar: str, constants: dict[str, int]) -> _build.Source:
    found = _checked(text)
    generics: list[tuple[str, bool]] = found["generics"]
    known = [name for name, is_constant in generics if is_constant]
    if sorted(constants) != sorted(known):
        raise ValueError(f"the constants {sorted(constants)} are given, and {known} are needed")
    arguments = [str(int(constants[name])) if is_constant else scalar for name, is_constant in generics]
    items = [
        f"const {name}: usize = {value};" if is_constant else f"type {name} = {value};"
        for (name, is_constant), value in zip(generics, arguments, strict=True)
    ]
    name: str = found["name"]
    return _build.Source(
        text=text,
        system=f"{name}<{', '.join(arguments)}>" if arguments else name,
        name=name,
        fields=tuple(map(tuple, found["fields"])),
        methods=tuple(found["methods"]),
        generics=" ".join(items),
    )


class Declaration:
    """A declaration with its library. Called with the values of its fields it makes a system."""

    def __init__(self, text: str, scalar: str, constants: tuple[tuple[str, int], ...], module: Any) -> None:
        self._library = module.library
        self._run_all = module.run_all
        layout = self._library.layout()
        #: The text.
        self.text = text
        #: The type of a type parameter.
        self.scalar = scalar
        #: The values of parameters of constants.
        self.constants = dict(constants)
        #: The name of the struct.
        self.name: str = layout["name"]
        #: The order of a step.
        self.order: int = layout["order"]
        #: Whether a state has a time.
        self.is_timed: bool = layout["is_timed"]
        #: The names of conserved momenta.
        self.conserved: tuple[str, ...] = tuple(layout["conserved"])
        #: The methods besides that of the declared dials.
        self.methods: tuple[str, ...] = tuple(layout["methods"])
        #: The fields with the shapes of their arrays.
        self.parameters = _shapes(layout["parameters"])
        #: The parts of the configuration with the shapes of their arrays.
        self.configuration = _shapes(layout["configuration"])
        #: The name and the shape of the momentum.
        self.momentum = _shapes(layout["momentum"])[0]
        #: The name and the shape of the input of the forces.
        self.input = _shapes(layout["input"])[0]
        self._derivation: str = layout["derivation"]

    @property
    def columns(self) -> tuple[Shape, ...]:
        """The values of a row with their shapes: time, configuration, momentum, energy, and conserved momenta."""
        numbers = (("energy", ()), *((name, ()) for name in self.conserved))
        return (("t", ()), *self.configuration, self.momentum, *numbers)

    @property
    def derivation(self) -> Derivation:
        """The derivation in words and formulas. A notebook shows it."""
        return Derivation(derive(self.text).latex, self._derivation)

    def __call__(self, **parameters: Values) -> System:
        """The system with these parameters."""
        return System(self, joined(self.parameters, parameters, self.name))

    def __repr__(self) -> str:
        fields = ", ".join(f"{name}{list(shape) if shape else ''}" for name, shape in self.parameters)
        return f"<declaration {self.name}({fields})>"

    def __reduce__(self) -> tuple[Any, ...]:
        return _compiled, (self.text, self.scalar, tuple(sorted(self.constants.items())))


def _shapes(pairs: list[tuple[str, list[int]]]) -> tuple[Shape, ...]:
    return tuple((name, tuple(lengths)) for name, lengths in pairs)
