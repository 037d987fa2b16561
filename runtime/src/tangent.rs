//! Tangent maps: the derivatives of a step, exact for the step as it is, not for the motion that it approximates.

use crate::constraint::edge::PassedEdge;
use crate::linear::divided;
use crate::parameters::check_finite;
use crate::parts::{Q, U};
use crate::scheme::Scheme;
use crate::scheme::edges::{Drift, Edges, Passing, PassingByQuantities};
use crate::{
    Carried, Clebsch, Differentiated, Error, Method, Scalar, Sensitive, Space, State, Stepper, Time, Variational,
};
use nalgebra::{SMatrix, SVector};

/// A variation of a state: the motion η of q ↦ Φ_{exp η}(q), in the basis of 𝔤, and the change ν of the momentum.
///
/// ```
/// use clebsch::{Tangent, Variation};
/// use nalgebra::Vector3;
///
/// let variation = Variation { motion: Vector3::x(), momentum: Vector3::zeros() };
/// assert_eq!(Tangent::<f64, 3>::identity().apply(&variation), variation);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Variation<T, const M: usize> {
    /// η; the configuration moves by η_Q(q).
    pub motion: SVector<T, M>,
    /// ν = δN, in the same units as N.
    pub momentum: SVector<T, M>,
}

/// The derivative of a map of states (q, N) ↦ (q⁺, N⁺), from variations (η, ν) at the one to variations (η′, ν′) at the other.
///
/// In these coordinates the canonical symplectic form is Ω_N((η₁, ν₁), (η₂, ν₂)) = ν₂·η₁ − ν₁·η₂ ± N·[η₁, η₂]. The sign
/// is + for the body momenta of a right action and − for the spatial ones of a left action. Tangent maps of unforced
/// steps preserve the form. If motions fix the configuration, the directions η of 𝔤_q do nothing to q. The map is then
/// that of the body that has them as motions.
///
/// With a constraint the map is the derivative of the step as it is, for every variation. Its images obey the constraint.
/// It preserves the form if the constraint is on places alone, and on the motions η that obey it.
///
/// ```
/// # use clebsch::Clebsch;
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(
/// #     action     = |a: Translation<1>, x: Vector1| x + a,
/// #     lagrangian = |v| self.mass * v.norm_squared() / 2,
/// #     potential  = |x| self.stiffness * x.norm_squared() / 2,
/// #     emit       = [tangent],
/// # )]
/// # struct Spring { mass: f64, stiffness: f64 }
/// # use nalgebra::Vector1;
/// let stepper = Spring { mass: 2.0, stiffness: 8.0 }.into_stepper(0.1)?;
/// let (_, tangent) = stepper.step_tangent(&stepper.state(Vector1::new(0.5), Vector1::zeros())?)?;
/// // in one dimension symplectic means: of determinant one
/// let determinant = tangent.motion_by_motion.x * tangent.momentum_by_momentum.x
///     - tangent.motion_by_momentum.x * tangent.momentum_by_motion.x;
/// assert!((determinant - 1.0).abs() < 1e-14);
/// # Ok::<(), clebsch::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tangent<T, const M: usize> {
    /// ∂η′/∂η
    pub motion_by_motion: SMatrix<T, M, M>,
    /// ∂η′/∂ν
    pub motion_by_momentum: SMatrix<T, M, M>,
    /// ∂ν′/∂η
    pub momentum_by_motion: SMatrix<T, M, M>,
    /// ∂ν′/∂ν
    pub momentum_by_momentum: SMatrix<T, M, M>,
}

/// The derivatives of a state by P quantities that are fixed during a step: column k by [`QUANTITIES`](Sensitive::QUANTITIES)`[k]`.
///
/// ```
/// # use clebsch::{Clebsch, Sensitive};
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(
/// #     action     = |a: Translation<1>, x: Vector1| x + a,
/// #     lagrangian = |v| self.mass * v.norm_squared() / 2,
/// #     potential  = |x| self.stiffness * x.norm_squared() / 2,
/// #     emit       = [tangent],
/// # )]
/// # struct Spring { mass: f64, stiffness: f64 }
/// # use nalgebra::Vector1;
/// let stepper = Spring { mass: 2.0, stiffness: 8.0 }.into_stepper(0.1)?;
/// let (_, _, sensitivity) = stepper.step_sensitivity(&stepper.state(Vector1::new(0.5), Vector1::zeros())?)?;
/// assert_eq!(Spring::QUANTITIES, ["mass", "stiffness", "h"]);
/// assert!(sensitivity.momentum[(0, 1)] < 0.0); // a stiffer spring pulls back more
/// # Ok::<(), clebsch::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sensitivity<T, const M: usize, const P: usize> {
    /// ∂η
    pub motion: SMatrix<T, M, P>,
    /// ∂N
    pub momentum: SMatrix<T, M, P>,
}

impl<T: Scalar, const M: usize> Tangent<T, M> {
    /// The identity, the derivative of no step at all.
    pub fn identity() -> Self {
        let one = SMatrix::identity();
        let zero = Space::origin();
        Self { motion_by_motion: one, motion_by_momentum: zero, momentum_by_motion: zero, momentum_by_momentum: one }
    }

    /// (η′, ν′) of (η, ν).
    pub fn apply(&self, variation: &Variation<T, M>) -> Variation<T, M> {
        let (motion, momentum) = self.image(&variation.motion, &variation.momentum);
        Variation { motion, momentum }
    }

    /// The transposed map, which pulls gradients back: from a function of the state after to the same function of the state before.
    pub fn apply_transposed(&self, gradient: &Variation<T, M>) -> Variation<T, M> {
        let transposed = Self {
            motion_by_motion: self.motion_by_motion.transpose(),
            motion_by_momentum: self.momentum_by_motion.transpose(),
            momentum_by_motion: self.motion_by_momentum.transpose(),
            momentum_by_momentum: self.momentum_by_momentum.transpose(),
        };
        transposed.apply(gradient)
    }

    /// The derivative of this map and after it `next`.
    #[must_use]
    pub fn then(&self, next: &Self) -> Self {
        let (motion_by_motion, momentum_by_motion) = next.image(&self.motion_by_motion, &self.momentum_by_motion);
        let (motion_by_momentum, momentum_by_momentum) =
            next.image(&self.motion_by_momentum, &self.momentum_by_momentum);
        Self { motion_by_motion, motion_by_momentum, momentum_by_motion, momentum_by_momentum }
    }

    /// (η′, ν′) of (η, ν), column by column.
    fn image<const K: usize>(
        &self,
        motion: &SMatrix<T, M, K>,
        momentum: &SMatrix<T, M, K>,
    ) -> (SMatrix<T, M, K>, SMatrix<T, M, K>) {
        (
            times(&self.motion_by_motion, motion) + times(&self.motion_by_momentum, momentum),
            times(&self.momentum_by_motion, motion) + times(&self.momentum_by_momentum, momentum),
        )
    }
}

impl<T: Scalar, const M: usize, const P: usize> Sensitivity<T, M, P> {
    /// Nothing: the sensitivity of a state that depends on no quantity.
    pub fn zero() -> Self {
        Self { motion: Space::origin(), momentum: Space::origin() }
    }

    /// The sensitivity after a step with the tangent map `tangent`, whose own sensitivity is `of_step`.
    #[must_use]
    pub fn after(&self, tangent: &Tangent<T, M>, of_step: &Self) -> Self {
        let (motion, momentum) = tangent.image(&self.motion, &self.momentum);
        Self { motion: motion + of_step.motion, momentum: momentum + of_step.momentum }
    }
}

/// A B
#[inline]
pub(crate) fn times<T: Scalar, const R: usize, const M: usize, const K: usize>(
    a: &SMatrix<T, R, M>,
    b: &SMatrix<T, M, K>,
) -> SMatrix<T, R, K> {
    SMatrix::from_fn(|i, j| (0..M).fold(T::zero(), |sum, k| sum + a[(i, k)] * b[(k, j)]))
}

/// The tangent map of an edge, by the implicit function theorem on F⁻ℓd = N. It is η′ = Ad η + ζ with ζ = (∂F⁻ℓd/∂η′)⁻¹
/// (ν − ∂F⁻ℓd η), ∂/∂η at fixed F. With a constraint Qν takes the place of ν.
#[inline]
pub(crate) fn of_edge<T: Scalar, const M: usize>(
    edge: &Carried<T, M>,
    balance: Option<SMatrix<T, M, M>>,
) -> Option<Tangent<T, M>> {
    let inverse = divided(&edge.before_by_end, &SMatrix::identity())?;
    let by_momentum = balance.map_or(inverse, |balance| times(&inverse, &balance));
    Some(by_inverse(edge, &inverse, by_momentum))
}

/// The tangent map of an edge with (∂F⁻ℓd/∂η′)⁻¹, and ∂ζ/∂ν.
#[inline]
fn by_inverse<T: Scalar, const M: usize>(
    edge: &Carried<T, M>,
    inverse: &SMatrix<T, M, M>,
    by_momentum: SMatrix<T, M, M>,
) -> Tangent<T, M> {
    let turned = times(inverse, &edge.before);
    Tangent {
        motion_by_motion: edge.adjoint - turned,
        motion_by_momentum: by_momentum,
        momentum_by_motion: edge.after - times(&edge.after_by_end, &turned),
        momentum_by_momentum: times(&edge.after_by_end, &by_momentum),
    }
}

/// For derivatives that overflow.
const DERIVATIVE: Error = Error::NotFinite { name: "the derivative of the step" };

/// The tangent map of a step if it is finite.
fn finite_tangent<T: Scalar, const M: usize>(tangent: Tangent<T, M>) -> Result<Tangent<T, M>, Error> {
    let Tangent { motion_by_motion: a, motion_by_momentum: b, momentum_by_motion: c, momentum_by_momentum: d } =
        tangent;
    if [a, b, c, d].all_finite() { Ok(tangent) } else { Err(DERIVATIVE) }
}

/// One edge of a step: its increment, its end and its derivatives.
struct Passed<S: Clebsch, const M: usize> {
    increment: S::Element,
    next: S::Configuration,
    edge: Carried<S::Scalar, M>,
    /// (∂F⁻ℓd/∂η′)⁻¹
    inverse: SMatrix<S::Scalar, M, M>,
    tangent: Tangent<S::Scalar, M>,
}

// bounds of the methods, not of the block: their errors then give the text to write
#[allow(clippy::type_complexity, reason = "the state with its two kinds of derivatives, each of a named type")]
impl<S, B, T: Scalar, const M: usize> Stepper<S, B>
where
    S: Clebsch<Scalar = T, Momentum = SVector<T, M>>,
    B: Method<S>,
{
    /// One step with its derivative with respect to the state: (q⁺, N⁺) and the tangent map there.
    ///
    /// The map is exact up to round-off, by the implicit function theorem on the solved step: one linear system of M unknowns, no iteration.
    /// With a constraint of R equations two of R unknowns come to it.
    ///
    /// # Errors
    /// As [`step`](Stepper::step), and [`Error::SingularTangent`] at the very edge of solvability.
    pub fn step_tangent(&self, state: &State<S, B>) -> Result<(State<S, B>, Tangent<T, M>), Error>
    where
        S: Variational<M>,
        B: Differentiated<S, M>,
    {
        self.step_tangent_with(state, &S::Input::origin())
    }

    /// The same while the input of the forces is `u`.
    ///
    /// # Errors
    /// As [`step_tangent`](Self::step_tangent), and [`Error::NotFinite`] where the input is not.
    pub fn step_tangent_with(&self, state: &State<S, B>, u: &S::Input) -> Result<(State<S, B>, Tangent<T, M>), Error>
    where
        S: Variational<M>,
        B: Differentiated<S, M>,
    {
        let (q, mu, tangent) = self.pass_all(state, u, |_, _, _| Some(()))?;
        Ok((self.stepped(state, q, mu)?, finite_tangent(tangent)?))
    }

    /// One step with its derivatives by the state and by everything that is fixed during it: parameters, step size, time, input.
    ///
    /// # Errors
    /// As [`step_tangent`](Self::step_tangent).
    pub fn step_sensitivity<const P: usize>(
        &self,
        state: &State<S, B>,
    ) -> Result<(State<S, B>, Tangent<T, M>, Sensitivity<T, M, P>), Error>
    where
        S: Sensitive<M, P>,
        B: Differentiated<S, M>,
    {
        self.step_sensitivity_with(state, &S::Input::origin())
    }

    /// The same while the input of the forces is `u`.
    ///
    /// # Errors
    /// As [`step_tangent_with`](Self::step_tangent_with).
    pub fn step_sensitivity_with<const P: usize>(
        &self,
        state: &State<S, B>,
        u: &S::Input,
    ) -> Result<(State<S, B>, Tangent<T, M>, Sensitivity<T, M, P>), Error>
    where
        S: Sensitive<M, P>,
        B: Differentiated<S, M>,
    {
        let mut sensitivity = Sensitivity::zero();
        let (q, mu, tangent) = self.pass_all(state, u, |number, (q, mu), passed| {
            let Passed { increment, next, edge, inverse, tangent } = passed;
            let at = self.at(state.time.now());
            let (before, after) = B::Scheme::visit(at, number, PassingByQuantities((q, increment, next, u), mu))?;
            let columns = (S::STEP_SIZE, S::TIME);
            let [before, after] =
                [before, after].map(|slopes| B::Scheme::slopes_of_step(at.constants, number, slopes, columns));
            let motion = -times(inverse, &before);
            let of_edge = Sensitivity { motion, momentum: after + times(&edge.after_by_end, &motion) };
            sensitivity = sensitivity.after(tangent, &of_edge);
            Some(())
        })?;
        if !(sensitivity.motion, sensitivity.momentum).all_finite() {
            return Err(Error::NotFinite { name: "the sensitivity of the step" });
        }
        Ok((self.stepped(state, q, mu)?, finite_tangent(tangent)?, sensitivity))
    }

    /// ξ_Q(q): how the configuration moves under the motion η of a [`Variation`].
    #[inline]
    pub fn infinitesimal_motion(&self, q: &S::Configuration, eta: &SVector<T, M>) -> S::Configuration
    where
        S: Variational<M>,
    {
        self.system().infinitesimal_motion(q, eta)
    }
}

#[allow(clippy::type_complexity, reason = "the state with its two kinds of derivatives, each of a named type")]
impl<S, B, T: Scalar, const M: usize> Stepper<S, B>
where
    S: Variational<M> + Clebsch<Scalar = T, Momentum = SVector<T, M>>,
    B: Differentiated<S, M>,
{
    /// (q⁺, N⁺), edge by edge, with the tangent map. `seen` is told each edge with its number and the state where it starts.
    /// It returns `None` where a linear system is singular.
    fn pass_all(
        &self,
        state: &State<S, B>,
        u: &S::Input,
        mut seen: impl FnMut(usize, (&S::Configuration, &SVector<T, M>), &Passed<S, M>) -> Option<()>,
    ) -> Result<(S::Configuration, SVector<T, M>, Tangent<T, M>), Error> {
        let (mut q, mut mu) = (*state.configuration(), state.momentum());
        let mut tangent = Tangent::identity();
        for number in 0..B::EDGES {
            // the error of an edge is that of the step that it is a part of
            let told = |error| if T::LANES == 1 { self.refusal(state, u, 0, error) } else { error };
            let passed = self.pass(number, state.time.now(), &q, &mu, u).map_err(told)?;
            seen(number, (&q, &mu), &passed).ok_or_else(|| self.singular(true))?;
            tangent = if number == 0 { passed.tangent } else { tangent.then(&passed.tangent) };
            (q, mu) = (passed.next, passed.edge.momentum);
        }
        Ok((q, mu, tangent))
    }

    fn pass(&self, number: usize, t: T, q: &Q<S>, mu: &SVector<T, M>, u: &U<S>) -> Result<Passed<S, M>, Error> {
        check_finite("the input", u)?;
        let increment = B::Scheme::visit(self.at(t), number, Drift(q, mu, u))?;
        let next = S::advance(&self.system, q, &increment);
        let Some(PassedEdge { edge, balance }) =
            B::Scheme::visit(self.at(t), number, Passing((q, &increment, &next, u), mu))
        else {
            return Err(self.singular(true));
        };
        let Some(inverse) = divided(&edge.before_by_end, &SMatrix::identity()) else {
            return Err(self.singular(edge.before_by_end.all_finite()));
        };
        let by_momentum = balance.map_or(inverse, |balance| times(&inverse, &balance));
        let tangent = by_inverse(&edge, &inverse, by_momentum);
        Ok(Passed { increment, next, edge, inverse, tangent })
    }

    /// For a linear system without a solution.
    fn singular(&self, is_finite: bool) -> Error {
        if is_finite { Error::SingularTangent { step_size: self.step_size().to_f64() } } else { DERIVATIVE }
    }

    fn stepped(&self, state: &State<S, B>, q: S::Configuration, mu: SVector<T, M>) -> Result<State<S, B>, Error> {
        let time = state.time.after_step(self.step_size());
        // of the same size, but at another configuration: data that depends on neither stays
        let left = B::Scheme::left_after(self.at(time.now()), &q, &mu, &state.left);
        let held = B::Scheme::held(&q, &mu);
        let next = State { time, configuration: q, held, left, h: self.step_size() };
        if self.is_sound(&next) { Ok(next) } else { Err(self.overflow(&next, 0)) }
    }
}
