//! The trait that the derive macro implements.

use crate::{Clock, Error, Scalar, Space, Stepper, Time};
use core::fmt::Debug;

/// A mechanical or control system with everything that is derived from its declaration.
///
/// Implemented by `#[derive(Clebsch)]`; the documentation of each generated method carries its formula as derived for that
/// struct. Notation: configuration q in Q, group element F in G, action Φ, momentum μ in the dual of the Lie algebra 𝔤, step
/// size h, time t, discrete Lagrangian ℓd(t, h, q, F). Momenta are components with respect to the basis E_i of 𝔤 that
/// [`group`](crate::group) documents, m_i = ⟨M, E_i⟩ = tr(MᵀE_i), all factors of a product one after the other.
///
/// The time of a step, in [`legendre`](Self::legendre) and wherever h matters, is that of its start; elsewhere it is that of the
/// configuration. An autonomous system takes no notice of it.
///
/// People use it through a [`Stepper`], which holds h and the [`Constants`](Self::Constants).
///
/// Source: Nordkvist, Crouch and Bloch, *Discrete Clebsch Optimal Control*, theorems 1 and 2.
pub trait Clebsch {
    /// The number type.
    type Scalar: Scalar;
    /// q, nested as in the declared action; `()` where the momentum is stepped alone, by `emit = [momentum]`.
    type Configuration: Space<Self::Scalar>;
    /// F, nested as in the declared action.
    type Element: Space<Self::Scalar>;
    /// μ: all components in one vector; of a power an array of those of each site.
    type Momentum: Space<Self::Scalar>;
    /// The representing matrices M = Σ G^{ij} m_j E_i, nested as `Element`; G_ij = tr(E_iᵀE_j).
    type MomentumMatrix: Space<Self::Scalar>;
    /// What a state holds of its momentum from step to step: N itself, or, of a point on a large sphere, the covector w ⊥ q with N = J(q, w), n numbers in
    /// place of n(n − 1)/2.
    type Held: Space<Self::Scalar>;
    /// What one step leaves to the next: the kick that the end of one and the start of the other share, or what a free motion keeps; `()` where
    /// there is none. With `summation = compensated`, that and what rounding has taken off q and N.
    type Impulse: Space<Self::Scalar>;
    /// What forces take from outside during a step, `()` where they take nothing; the `u` of `force`.
    type Input: Space<Self::Scalar>;
    /// What is computed once per stepper.
    type Constants: Clone + Debug;
    /// What a state knows of the time: `()` for an autonomous system, [`Clock`](crate::Clock) where the cost or the potential
    /// depends on it.
    type Time: Time<Self::Scalar>;

    /// The name of the struct.
    const NAME: &'static str;
    /// Order of accuracy of `step` and `step_symmetric`: 4, 6 and 8 are composed of steps of second order, of which
    /// [`legendre`](Self::legendre) and [`legendre_next`](Self::legendre_next) are the transforms; 16 collocates Hamilton's equations, and the
    /// transforms are those of the step of second order that is declared beside.
    const ORDER: u32;
    /// Whether a step is the free motion itself, without an error in h and with nothing that acts: then h and N count by their product alone, and the longest
    /// step with a momentum is known without trying. `false` as provided.
    const IS_FREE_MOTION: bool = false;
    /// The derivation in words and formulas, with operation counts and what was left out and why. With `emit = [latex]` the struct has a constant
    /// `DERIVATION_LATEX` too, the same formulas for a paper.
    const DERIVATION: &'static str;

    /// Checks the parameters and computes what no step changes.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::NotSymmetric`] or [`Error::SingularKineticEnergy`].
    fn constants(&self, h: Self::Scalar) -> Result<Self::Constants, Error>;

    /// The action: Φ_F(q).
    fn act(&self, f: &Self::Element, q: &Self::Configuration) -> Self::Configuration;

    /// The momentum map of the cotangent lift: J(q, p)_i = ⟨p, (E_i)_Q(q)⟩.
    fn momentum_map(&self, q: &Self::Configuration, p: &Self::Configuration) -> Self::Momentum;

    /// The coadjoint action Ad*_F μ = (Ad_F)* μ, without an inverse inside.
    fn coadjoint(&self, f: &Self::Element, mu: &Self::Momentum) -> Self::Momentum;

    /// The discrete Legendre transform F⁻ℓd: the momentum N_k before the step that moves q by F.
    fn legendre(&self, h: Self::Scalar, t: Self::Scalar, q: &Self::Configuration, f: &Self::Element) -> Self::Momentum;

    /// The discrete Legendre transform F⁺ℓd: the momentum N_{k+1} after the step that moves q by F.
    fn legendre_next(
        &self,
        h: Self::Scalar,
        t: Self::Scalar,
        q: &Self::Configuration,
        f: &Self::Element,
    ) -> Self::Momentum;

    /// The group element F with `legendre(h, t, q, F)` = μ that is connected to the identity.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::Unsolvable`] or [`Error::NotConverged`].
    fn inverse_legendre(
        &self,
        constants: &Self::Constants,
        t: Self::Scalar,
        q: &Self::Configuration,
        mu: &Self::Momentum,
    ) -> Result<Self::Element, Error>;

    /// What a state at q with the momentum μ holds of it.
    fn held(q: &Self::Configuration, mu: &Self::Momentum) -> Self::Held;

    /// The momentum of a state at q that holds this of it; the inverse of [`held`](Self::held) on 𝔤_q^⊥.
    fn momentum_held(q: &Self::Configuration, held: &Self::Held) -> Self::Momentum;

    /// The kick at q and the time t of q, shared by the end of one step and the start of the next, or what the free motion with the momentum μ
    /// keeps.
    fn impulse(
        &self,
        constants: &Self::Constants,
        t: Self::Scalar,
        q: &Self::Configuration,
        mu: &Self::Momentum,
    ) -> Self::Impulse;

    /// The impulse at q for steps that go on where others, of another size, have ended with the impulse `left`: what these leave that does not
    /// depend on their size stays.
    fn impulse_after(
        &self,
        constants: &Self::Constants,
        t: Self::Scalar,
        q: &Self::Configuration,
        mu: &Self::Momentum,
        left: &Self::Impulse,
    ) -> Self::Impulse {
        let _ = left;
        self.impulse(constants, t, q, mu)
    }

    /// By how much the momentum N of a state is ahead of the momentum π that belongs to its configuration: N − π = ½ J(q, ∂(U₁ − U₀)), where
    /// U₀(t, q) and U₁(t, q) are what ℓd adds at the start and at the end of a step.
    ///
    /// The time is that of the configuration. −h/2 J(q, ∂V) with `order = 1`, half of the kick; 0 with every other order, where N is π. See
    /// [`Stepper::synchronized`](crate::Stepper::synchronized).
    fn stagger(&self, h: Self::Scalar, t: Self::Scalar, q: &Self::Configuration) -> Self::Momentum {
        let _ = (h, t, q);
        Self::Momentum::origin()
    }

    /// One step of the discrete Euler–Poincaré representation: (q, N) ↦ (q⁺, N⁺), from the time t to t + h, given the impulse
    /// at q and the input of its forces; returns the impulse at q⁺ too. What it takes and gives of momenta is what states hold.
    ///
    /// # Errors
    /// As [`inverse_legendre`](Self::inverse_legendre).
    #[allow(clippy::type_complexity)]
    fn step(
        &self,
        constants: &Self::Constants,
        t: Self::Scalar,
        q: &Self::Configuration,
        mu: &Self::Held,
        impulse: &Self::Impulse,
        u: &Self::Input,
    ) -> Result<(Self::Configuration, Self::Held, Self::Impulse), Error>;

    /// The same step, from the parts of a state into the place of those of another: what points on large spheres and arrays of sites are saved is to hand
    /// them on by value. After an error the other state is none.
    ///
    /// # Errors
    /// As [`inverse_legendre`](Self::inverse_legendre).
    #[allow(clippy::type_complexity, reason = "a place, and one to write to")]
    #[inline]
    fn step_into(
        &self,
        constants: &Self::Constants,
        t: Self::Scalar,
        (q, mu, impulse): (&Self::Configuration, &Self::Held, &Self::Impulse),
        u: &Self::Input,
        (next, held, left): (&mut Self::Configuration, &mut Self::Held, &mut Self::Impulse),
    ) -> Result<(), Error> {
        (*next, *held, *left) = self.step(constants, t, q, mu, impulse, u)?;
        Ok(())
    }

    /// `steps` steps of size `h` from the time t, as [`step`](Self::step) makes them but for rounding: where a step ends as the next one starts,
    /// both may be made at once.
    ///
    /// # Errors
    /// As [`inverse_legendre`](Self::inverse_legendre).
    #[allow(clippy::type_complexity, clippy::too_many_arguments, reason = "those of a step, and how many")]
    #[inline]
    fn steps(
        &self,
        constants: &Self::Constants,
        (t, h): (Self::Scalar, Self::Scalar),
        steps: usize,
        q: &Self::Configuration,
        mu: &Self::Held,
        impulse: &Self::Impulse,
        u: &Self::Input,
    ) -> Result<(Self::Configuration, Self::Held, Self::Impulse), Error> {
        let (mut state, mut clock) = ((*q, *mu, *impulse), Clock::at(t));
        for _ in 0..steps {
            let (q, mu, impulse) = &state;
            state = self.step(constants, clock.now(), q, mu, impulse, u)?;
            clock = clock.after_step(h);
        }
        Ok(state)
    }

    /// One step of the discrete symmetric representation on T*Q: (q, p) ↦ (q⁺, p⁺), from the time t to t + h.
    ///
    /// # Errors
    /// As [`inverse_legendre`](Self::inverse_legendre), and [`Error::NoCovector`] where forces act or momenta are stepped alone.
    fn step_symmetric(
        &self,
        constants: &Self::Constants,
        t: Self::Scalar,
        q: &Self::Configuration,
        p: &Self::Configuration,
    ) -> Result<(Self::Configuration, Self::Configuration), Error>;

    /// The potential V(t, q), 0 for a free system.
    fn potential(&self, t: Self::Scalar, q: &Self::Configuration) -> Self::Scalar;

    /// The kinetic energy μ·ξ − ℓ(q, ξ) at the velocity ξ with ∂ℓ/∂ξ = μ: the Legendre–Fenchel transform of ℓ(q, ·), with
    /// ℓ(q, ξ) = lim ℓd(t, h, q, exp hξ)/h less its value at ξ = 0.
    ///
    /// ½ μ·Σ⁻¹μ where ℓ is quadratic with the Hessian Σ; +∞ where no velocity has this momentum.
    fn kinetic_energy(
        &self,
        constants: &Self::Constants,
        t: Self::Scalar,
        q: &Self::Configuration,
        mu: &Self::Momentum,
    ) -> Self::Scalar;

    /// The representing matrices of μ.
    fn momentum_matrix(mu: &Self::Momentum) -> Self::MomentumMatrix;

    /// The components of a momentum given by its representing matrices; the inverse of [`momentum_matrix`](Self::momentum_matrix).
    fn momentum_components(m: &Self::MomentumMatrix) -> Self::Momentum;

    /// By how much q violates what the declaration promises, as the largest entry of |RᵀR − I| or ||q|² − 1|.
    ///
    /// 0 for plain vectors and matrices, +∞ on the wrong component of a group (det < 0).
    fn orbit_defect(&self, q: &Self::Configuration) -> Self::Scalar;

    /// The size of the component of μ outside of 𝔤_q^⊥, the momenta that motions of q can have.
    ///
    /// 0 where the action is free, and where the motions that fix q are declared to be motions (`isotropy = free`).
    fn isotropy_defect(&self, q: &Self::Configuration, mu: &Self::Momentum) -> Self::Scalar;

    /// The momentum in 𝔤_q^⊥ whose components are nearest to those of μ, in the Euclidean distance.
    ///
    /// μ itself where [`isotropy_defect`](Self::isotropy_defect) is 0 for every momentum.
    fn project_momentum(&self, q: &Self::Configuration, mu: &Self::Momentum) -> Self::Momentum;

    /// A stepper of step size `h`, on a copy of this system.
    ///
    /// # Errors
    /// [`Error::StepSize`], and those of [`constants`](Self::constants).
    fn stepper(&self, h: Self::Scalar) -> Result<Stepper<Self>, Error>
    where
        Self: Clone,
    {
        self.clone().into_stepper(h)
    }

    /// A stepper of step size `h` that owns this system.
    ///
    /// # Errors
    /// [`Error::StepSize`], and those of [`constants`](Self::constants).
    fn into_stepper(self, h: Self::Scalar) -> Result<Stepper<Self>, Error>
    where
        Self: Sized,
    {
        Stepper::new(self, h)
    }
}
