//! The derived formulas as methods of a stepper, which knows the step size.

use super::Stepper;
use crate::parameters::check_finite;
use crate::scheme::Scheme;
use crate::{Clebsch, Error, Method};
use num_traits::Zero;

impl<S: Clebsch, M: Method<S>> Stepper<S, M> {
    /// The potential V(t, q).
    #[inline]
    pub fn potential_at(&self, t: S::Scalar, q: &S::Configuration) -> S::Scalar {
        self.system.potential(t, q)
    }

    /// The discrete Legendre transform F⁻ℓd: the momentum N_k before the step that starts at the time t and moves q by F.
    ///
    /// It is known to about ε·inertia/h, as F is a rounded matrix: see [`Clebsch::legendre`].
    #[inline]
    pub fn legendre_at(&self, t: S::Scalar, q: &S::Configuration, f: &S::Element) -> S::Momentum {
        M::legendre(&self.system, self.h, t, q, f)
    }

    /// The discrete Legendre transform F⁺ℓd: the momentum N_{k+1} after the step that starts at the time t and moves q by F.
    ///
    /// It is known to about ε·inertia/h, as F is a rounded matrix: see [`Clebsch::legendre`].
    #[inline]
    pub fn legendre_next_at(&self, t: S::Scalar, q: &S::Configuration, f: &S::Element) -> S::Momentum {
        M::legendre_next(&self.system, self.h, t, q, f)
    }

    /// The group element F of the step that starts at (q, N) and the time t: the implicit solve. (q, N) is checked as by [`state`](Self::state).
    ///
    /// # Errors
    /// As [`state`](Self::state) and [`step`](Self::step); [`Error::NotFinite`] for the time too.
    #[inline]
    pub fn inverse_legendre_at(
        &self,
        t: S::Scalar,
        q: &S::Configuration,
        mu: &S::Momentum,
    ) -> Result<S::Element, Error> {
        check_finite("the time", &t)?;
        self.check_state(t, q, mu)?;
        let name = |_: &_, _| "the group element of the step";
        let f = self.computed(t, name, |at| M::Scheme::inverse_legendre(at, q, mu))?;
        if S::MAY_LEAVE_ORBIT {
            self.check_configuration(&self.system.act(&f, q))?;
        }
        Ok(f)
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
}

/// For autonomous systems; the others have the same methods with `_at` in their names and the time as the first argument.
impl<S: Clebsch<Time = ()>, M: Method<S>> Stepper<S, M> {
    /// The potential V(q).
    #[inline]
    pub fn potential(&self, q: &S::Configuration) -> S::Scalar {
        self.potential_at(S::Scalar::zero(), q)
    }

    /// The discrete Legendre transform F⁻ℓd: the momentum N_k before the step that moves q by F.
    ///
    /// It is known to about ε·inertia/h, as F is a rounded matrix: see [`Clebsch::legendre`].
    #[inline]
    pub fn legendre(&self, q: &S::Configuration, f: &S::Element) -> S::Momentum {
        self.legendre_at(S::Scalar::zero(), q, f)
    }

    /// The discrete Legendre transform F⁺ℓd: the momentum N_{k+1} after the step that moves q by F.
    ///
    /// It is known to about ε·inertia/h, as F is a rounded matrix: see [`Clebsch::legendre`].
    #[inline]
    pub fn legendre_next(&self, q: &S::Configuration, f: &S::Element) -> S::Momentum {
        self.legendre_next_at(S::Scalar::zero(), q, f)
    }

    /// The group element F of the step that starts at (q, N): the implicit solve. (q, N) is checked as by [`state`](Self::state).
    ///
    /// # Errors
    /// As [`state`](Self::state) and [`step`](Self::step).
    #[inline]
    pub fn inverse_legendre(&self, q: &S::Configuration, mu: &S::Momentum) -> Result<S::Element, Error> {
        self.inverse_legendre_at(S::Scalar::zero(), q, mu)
    }
}
