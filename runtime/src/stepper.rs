//! A system with a step size: what a person integrates with.

use crate::{Clebsch, CotangentState, Error, Scalar, Space, State, Trajectory};

/// A system, a step size and what no step changes, computed once.
///
/// Made by [`Clebsch::stepper`]. Nothing in it changes from step to step: one stepper can serve any number of states.
#[derive(Clone, Debug)]
pub struct Stepper<S: Clebsch> {
    system: S,
    h: S::Scalar,
    constants: S::Constants,
}

impl<S: Clebsch> Stepper<S> {
    /// Checks `h` and the parameters of `system`.
    pub(crate) fn new(system: S, h: S::Scalar) -> Result<Self, Error> {
        if !h.is_finite() || h == <S::Scalar as num_traits::Zero>::zero() {
            return Err(Error::StepSize { value: h.to_f64() });
        }
        let constants = system.constants(h)?;
        Ok(Self { system, h, constants })
    }

    /// The state (q, N), after checks: finite, q on its orbit, N in 𝔤_q^⊥, the momenta that motions of q can have.
    ///
    /// What is accepted as round-off of the input is √ε: 1.5e-8 for `f64`, 3.5e-4 for `f32`; for N relative to its largest
    /// component.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::OffOrbit`] or [`Error::OutsideMomentumSpace`].
    pub fn state(&self, q: S::Configuration, mu: S::Momentum) -> Result<State<S>, Error> {
        check_configuration::<S>(&q)?;
        if !mu.is_finite() {
            return Err(Error::NotFinite { name: "the momentum" });
        }
        let tolerance = S::Scalar::EPSILON.sqrt() * mu.max_abs();
        let violation = S::isotropy_defect(&q, &mu);
        // Written so that NaN is a violation.
        if !matches!(violation.partial_cmp(&tolerance), Some(core::cmp::Ordering::Less | core::cmp::Ordering::Equal)) {
            return Err(Error::OutsideMomentumSpace { violation: violation.to_f64(), tolerance: tolerance.to_f64() });
        }
        let impulse = self.system.impulse(&self.constants, &q);
        if !impulse.is_finite() {
            return Err(Error::NotFinite { name: "the gradient of the potential at the configuration" });
        }
        Ok(State { configuration: q, momentum: mu, impulse })
    }

    /// The state (q, p) on T*Q, after checks: finite, q on its orbit.
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::OffOrbit`].
    pub fn cotangent_state(&self, q: S::Configuration, p: S::Configuration) -> Result<CotangentState<S>, Error> {
        check_configuration::<S>(&q)?;
        if !p.is_finite() {
            return Err(Error::NotFinite { name: "the covector" });
        }
        Ok(CotangentState { configuration: q, covector: p })
    }

    /// One step of the discrete Euler–Poincaré representation: (q_k, N_k) ↦ (q_{k+1}, N_{k+1}).
    ///
    /// # Errors
    /// [`Error::Unsolvable`] where the step is too long for the momentum, [`Error::NotFinite`] where the potential gave
    /// NaN or numbers overflowed, [`Error::NotConverged`].
    #[inline]
    pub fn step(&self, state: &State<S>) -> Result<State<S>, Error> {
        let stepped = self.system.step(&self.constants, &state.configuration, &state.momentum, &state.impulse);
        let (configuration, momentum, impulse) = match stepped {
            Ok(next) => next,
            Err(error) => return Err(error.with_step_size(self.h.to_f64())),
        };
        if !(configuration.is_finite() & momentum.is_finite()) {
            return Err(Error::NotFinite { name: "the state after the step" });
        }
        Ok(State { configuration, momentum, impulse })
    }

    /// One step of the discrete symmetric representation on T*Q: (q_k, p_k) ↦ (q_{k+1}, p_{k+1}).
    ///
    /// # Errors
    /// As [`step`](Self::step).
    #[inline]
    pub fn step_symmetric(&self, state: &CotangentState<S>) -> Result<CotangentState<S>, Error> {
        let stepped = self.system.step_symmetric(&self.constants, &state.configuration, &state.covector);
        let (configuration, covector) = match stepped {
            Ok(next) => next,
            Err(error) => return Err(error.with_step_size(self.h.to_f64())),
        };
        if !(configuration.is_finite() & covector.is_finite()) {
            return Err(Error::NotFinite { name: "the state after the step" });
        }
        Ok(CotangentState { configuration, covector })
    }

    /// The states of all steps, `start` first; ends after the first error.
    #[inline]
    pub fn trajectory(&self, start: State<S>) -> Trajectory<'_, S> {
        Trajectory::new(self, start)
    }

    /// Kinetic energy ½ N·Σ⁻¹N plus potential V(q): nearly constant, its oscillation shrinks with the order.
    #[inline]
    pub fn energy(&self, state: &State<S>) -> S::Scalar {
        self.kinetic_energy(state) + self.potential(&state.configuration)
    }

    /// Kinetic energy ½ N·Σ⁻¹N.
    #[inline]
    pub fn kinetic_energy(&self, state: &State<S>) -> S::Scalar {
        self.system.kinetic_energy(&self.constants, &state.momentum)
    }

    /// The potential V(q).
    #[inline]
    pub fn potential(&self, q: &S::Configuration) -> S::Scalar {
        self.system.potential(q)
    }

    /// The discrete Legendre transform F⁻ℓd: the momentum N_k before the step that moves q by F.
    #[inline]
    pub fn legendre(&self, q: &S::Configuration, f: &S::Element) -> S::Momentum {
        self.system.legendre(self.h, q, f)
    }

    /// The discrete Legendre transform F⁺ℓd: the momentum N_{k+1} after the step that moves q by F.
    #[inline]
    pub fn legendre_next(&self, q: &S::Configuration, f: &S::Element) -> S::Momentum {
        self.system.legendre_next(self.h, q, f)
    }

    /// The group element F of the step that starts at (q, N): the implicit solve.
    ///
    /// # Errors
    /// As [`step`](Self::step).
    #[inline]
    pub fn inverse_legendre(&self, q: &S::Configuration, mu: &S::Momentum) -> Result<S::Element, Error> {
        match self.system.inverse_legendre(&self.constants, q, mu) {
            Ok(element) => Ok(element),
            Err(error) => Err(error.with_step_size(self.h.to_f64())),
        }
    }

    /// The action Φ_F(q).
    #[inline]
    pub fn act(&self, f: &S::Element, q: &S::Configuration) -> S::Configuration {
        self.system.act(f, q)
    }

    /// The momentum map J(q, p).
    #[inline]
    pub fn momentum_map(&self, q: &S::Configuration, p: &S::Configuration) -> S::Momentum {
        self.system.momentum_map(q, p)
    }

    /// The coadjoint action Ad*_F μ.
    #[inline]
    pub fn coadjoint(&self, f: &S::Element, mu: &S::Momentum) -> S::Momentum {
        self.system.coadjoint(f, mu)
    }

    /// The representing matrices of a momentum.
    #[inline]
    pub fn momentum_matrix(&self, mu: &S::Momentum) -> S::MomentumMatrix {
        S::momentum_matrix(mu)
    }

    /// The components of a momentum given by its representing matrices.
    #[inline]
    pub fn momentum_components(&self, m: &S::MomentumMatrix) -> S::Momentum {
        S::momentum_components(m)
    }

    /// The step size h, seconds in SI units.
    #[inline]
    pub fn step_size(&self) -> S::Scalar {
        self.h
    }

    /// The system.
    #[inline]
    pub fn system(&self) -> &S {
        &self.system
    }
}

/// q is finite and on its orbit, up to √ε.
fn check_configuration<S: Clebsch>(q: &S::Configuration) -> Result<(), Error> {
    if !q.is_finite() {
        return Err(Error::NotFinite { name: "the configuration" });
    }
    let tolerance = S::Scalar::EPSILON.sqrt();
    let defect = S::orbit_defect(q);
    if defect <= tolerance {
        return Ok(());
    }
    Err(Error::OffOrbit { defect: defect.to_f64(), tolerance: tolerance.to_f64() })
}
