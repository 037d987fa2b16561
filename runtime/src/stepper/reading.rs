//! What is read from a stepper and its states.

use super::Stepper;
use crate::fields::getters;
use crate::parameters::check_finite;
use crate::scheme::{Constants, Scheme};
use crate::{Clebsch, Conserves, Error, Method, State, Time};

impl<S: Clebsch, M: Method<S>> Stepper<S, M> {
    /// Kinetic energy plus potential, at the time of the state.
    ///
    /// Nearly constant for an autonomous system: its oscillation shrinks with the order.
    #[inline]
    pub fn energy(&self, state: &State<S, M>) -> S::Scalar {
        self.kinetic_energy(state) + self.system.potential(state.time.now(), &state.configuration)
    }

    /// Kinetic energy N·ξ − ℓ(q, ξ) at the velocity ξ with the momentum N = ∂ℓ/∂ξ: ½ N·Σ⁻¹N where ℓ is quadratic with the
    /// Hessian Σ; +∞ where no velocity has this momentum.
    #[inline]
    pub fn kinetic_energy(&self, state: &State<S, M>) -> S::Scalar {
        let constants = M::Scheme::whole(&self.constants);
        M::kinetic_energy(&self.system, constants, state.time.now(), &state.configuration, &state.momentum())
    }

    /// The step size h, seconds in SI units.
    #[inline]
    pub fn step_size(&self) -> S::Scalar {
        self.h
    }

    getters! {
        /// The system.
        ref system: S;
    }

    /// The momentum nearest to `mu` that motions of q can have: the orthogonal projection of its components to 𝔤_q^⊥.
    ///
    /// `mu` itself where the action is free or the declaration says `isotropy = free`.
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::OffOrbit`].
    pub fn project(&self, q: &S::Configuration, mu: &S::Momentum) -> Result<S::Momentum, Error> {
        self.check_configuration(q)?;
        let projected = self.system.project_momentum(q, mu);
        check_finite("the momentum", &(*mu, projected))?;
        Ok(projected)
    }

    /// What no step changes.
    #[inline]
    pub(crate) fn constants(&self) -> &Constants<S, M> {
        &self.constants
    }
}

/// Where conserved momenta were found.
impl<S: Conserves, M: Method<S>> Stepper<S, M> {
    /// The momenta that no step changes, with their names: what the symmetry of cost and potential leaves.
    #[inline]
    pub fn conserved(&self, state: &State<S, M>) -> S::Conserved {
        self.system.conserved(&state.configuration, &state.momentum())
    }
}
