"""Integrators that keep the structure of a mechanical system, derived from its declaration.

>>> import clebsch
>>> Particle = clebsch.compile('''
... #[derive(Clebsch, Clone, Debug)]
... #[clebsch(action = |a: Translation<1>, x: Vector1| x + a, cost = |h, a| self.mass * a.norm_squared() / (2 * h))]
... pub struct Particle { pub mass: f64 }
... ''')
>>> stepper = Particle(mass=2.0).stepper(0.5)
>>> start = stepper.state(x=[0.0], N=[6.0])
>>> stepper.run(start, [0.0, 0.5, 1.25])["x"].ravel().tolist()
[0.0, 1.5, 3.75]
"""

from ._compiler import VERSION as __version__
from .declaration import Declaration, check, compile, derive
from .derivation import Derivation
from .ensemble import Ensemble
from .errors import DeclarationError, Error, ParameterError, SolveError, StateError, ToolchainError
from .motion import Motion
from .system import State, Stepper, System

__all__ = [
    "Declaration",
    "DeclarationError",
    "Derivation",
    "Ensemble",
    "Error",
    "Motion",
    "ParameterError",
    "SolveError",
    "State",
    "StateError",
    "Stepper",
    "System",
    "ToolchainError",
    "__version__",
    "check",
    "compile",
    "derive",
]
