//! The parts of a step, as they are derived for one declaration.
//!
//! A *scheme* is the order in which these parts are called, in [`scheme`](crate::scheme), the same for every declaration. The macro writes parts alone.

use crate::constraint::edge::PassedEdge;
use crate::sums::Sums;
use crate::{Carried, Clebsch, Declared, Edge, Ends, Error, Method, Momenta, Space};
use num_traits::Zero;

/// The values of a system S, by the letters that formulas have for them: t, q, F, μ and u.
pub(crate) type T<S> = <S as Clebsch>::Scalar;
pub(crate) type Q<S> = <S as Clebsch>::Configuration;
pub(crate) type F<S> = <S as Clebsch>::Element;
pub(crate) type Mu<S> = <S as Clebsch>::Momentum;
pub(crate) type U<S> = <S as Clebsch>::Input;
/// The coordinates that a solve finds.
type X<S, M> = <S as Parts<M>>::Coordinates;

/// The parts that all substeps of a step share: how q moves, and the types of a step.
#[allow(unused_variables, reason = "provided methods take what others need")]
pub trait Parts<M: Method<Self> = Declared>: Clebsch {
    /// How a step adds to q and N.
    type Sums: Sums;
    /// x, the coordinates of the group element that a solve finds.
    type Coordinates;
    /// The data that moves q and N: D = F − I, x, both of them, or D and c of F − I = c·D.
    type Motion;

    /// Whether a step has so few operations that it is inlined wherever it is called: a call hands states through memory.
    const IS_SHORT: bool = false;

    /// Whether there are covectors to step, (q, p): not where forces act in 𝔤*, nor where momenta are stepped alone.
    const HAS_COVECTORS: bool = true;

    /// D = F − I of the group element with the coordinates x (for translations F itself), without cancellation.
    fn increment(&self, x: &Self::Coordinates) -> F<Self>;

    /// F = I + D.
    fn element(d: &F<Self>) -> F<Self>;

    /// The data that moves q and N. `increment` computes F − I where that is a part of it.
    fn motion(&self, x: &Self::Coordinates, increment: impl FnOnce() -> F<Self>) -> Self::Motion;

    /// q⁺ = Φ_F(q); with compensated sums q⁺ − q, in which q has cancelled.
    fn advance(&self, q: &Q<Self>, motion: &Self::Motion) -> Q<Self>;

    /// (TΦ_F)^{-*} p at q⁺, the covector carried along by F = I + D.
    #[inline(always)]
    fn lift(&self, q: &Q<Self>, p: &Q<Self>, d: &F<Self>) -> Q<Self> {
        *p
    }

    /// q without the rounding that has moved it off rotations, unit vectors and unit quaternions. A step does it last, so that nothing waits
    /// for it. A run of splittings does it before each drift that two steps share.
    #[inline(always)]
    fn on_space(q: Q<Self>, rest: RestOf<Self, M>) -> (Q<Self>, RestOf<Self, M>) {
        (q, rest)
    }
}

/// The coordinates that a solve finds.
pub type Solved<X> = Result<X, Error>;

/// The rounding error of q so far, where sums are compensated.
pub type RestOf<S, M = Declared> =
    <<S as Parts<M>>::Sums as Sums>::Rest<<S as Clebsch>::Scalar, <S as Clebsch>::Configuration>;

/// The parts of substep K: 0 for a step that is one, 0 and 1 for a step and its adjoint. The last one can be inverted,
/// `inverse_legendre`. Every time is that at which the step starts, not the substep. A part that a declaration does not
/// have is `None` and costs nothing.
#[allow(unused_variables, reason = "provided methods take what others need")]
pub trait Substep<const K: usize, M: Method<Self> = Declared>: Parts<M> {
    /// Whether the same kick acts at the end of a substep and at its start, so that it is computed once.
    const ENDS_AS_IT_STARTS: bool = false;

    /// J(q, ∂U₀), the kick at the start, with −r(q, I) where sums are not compensated.
    #[inline(always)]
    fn start_kick(&self, c: &M::Constants, t: T<Self>, q: &Q<Self>) -> Option<Mu<Self>> {
        None
    }

    /// J(q⁺, ∂U₁), the kick at the end.
    #[inline(always)]
    fn end_kick(&self, c: &M::Constants, t: T<Self>, q: &Q<Self>) -> Option<Mu<Self>> {
        if Self::ENDS_AS_IT_STARTS { self.start_kick(c, t, q) } else { None }
    }

    /// −r(q, I): the value at F = I of a coupled cost, or of a cost with a term that is linear in the velocity.
    #[inline(always)]
    fn rest(&self, c: &M::Constants, t: T<Self>, q: &Q<Self>) -> Option<Mu<Self>> {
        None
    }

    /// The impulse of the force at the start.
    #[inline(always)]
    fn start_force(&self, c: &M::Constants, t: T<Self>, q: &Q<Self>, u: &U<Self>) -> Option<Mu<Self>> {
        None
    }

    /// The part of that impulse that depends on the velocity.
    #[inline(always)]
    fn moving_force(&self, c: &M::Constants, t: T<Self>, q: &Q<Self>, x: &X<Self, M>, u: &U<Self>) -> Option<Mu<Self>> {
        None
    }

    /// Aᵀλ, the force of the constraint at the solution x for the momentum μ and the input u.
    #[inline(always)]
    fn reaction(
        &self,
        c: &M::Constants,
        t: T<Self>,
        q: &Q<Self>,
        mu: &Mu<Self>,
        x: &X<Self, M>,
        u: &U<Self>,
    ) -> Option<Mu<Self>> {
        None
    }

    /// Aᵀμ with which the velocity of the momentum N at q⁺ obeys the constraint.
    #[inline(always)]
    fn projection(&self, c: &M::Constants, t: T<Self>, q: &Q<Self>, mu: &Mu<Self>) -> Option<Mu<Self>> {
        None
    }

    /// The impulse of the force at the end, at q⁺.
    #[inline(always)]
    fn end_force(&self, c: &M::Constants, t: T<Self>, q: &Q<Self>, x: &X<Self, M>, u: &U<Self>) -> Option<Mu<Self>> {
        None
    }

    /// ∂U₀(q), the kick of the covector at the start.
    #[inline(always)]
    fn start_gradient(&self, c: &M::Constants, t: T<Self>, q: &Q<Self>) -> Option<Q<Self>> {
        None
    }

    /// ∂U₁(q⁺), the kick of the covector at the end.
    #[inline(always)]
    fn end_gradient(&self, c: &M::Constants, t: T<Self>, q: &Q<Self>) -> Option<Q<Self>> {
        if Self::ENDS_AS_IT_STARTS { self.start_gradient(c, t, q) } else { None }
    }

    /// ∂_q K(q, F), F = I + D, of a cost that couples.
    #[inline(always)]
    fn coupled_gradient(&self, c: &M::Constants, t: T<Self>, q: &Q<Self>, d: &F<Self>) -> Option<Q<Self>> {
        None
    }

    /// The coordinates x of the group element with the momentum μ at q: the momentum equation.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::Unsolvable`] or [`Error::NotConverged`].
    fn solve(&self, c: &M::Constants, t: T<Self>, q: &Q<Self>, mu: &Mu<Self>, u: &U<Self>) -> Solved<X<Self, M>>;

    /// M⁺ of the momentum M that has moved, from M or from the q before the move; with compensated sums M⁺ − M. `None` where M does not change.
    #[inline(always)]
    fn update(
        &self,
        c: &M::Constants,
        t: T<Self>,
        q: &Q<Self>,
        mu: &Mu<Self>,
        motion: &Self::Motion,
    ) -> Option<Mu<Self>> {
        None
    }
}

/// Exact free motions: a step follows one. The constants of the motion are computed once for all of its steps.
pub trait FreeMotion<M: Method<Self> = Declared>: Parts<M> {
    /// The constants of the motion with a momentum.
    type Kept: Space<T<Self>>;

    /// The constants of the motion with this momentum.
    fn kept(&self, c: &M::Constants, mu: &Mu<Self>) -> Self::Kept;

    /// The coordinates x of this motion, and M after it where the motion gives both at once.
    fn follow(&self, c: &M::Constants, kept: &Self::Kept, mu: &Mu<Self>) -> Solved<(X<Self, M>, Mu<Self>)>;
}

/// Drifts that are exact, with kicks between them.
pub trait SplitKicks<M: Method<Self> = Declared>: Parts<M> {
    /// The size h of a step.
    fn step_size(c: &M::Constants) -> T<Self>;

    /// J(q, ∂U) of U = −h b V + h³ g G·Σ⁻¹G with the weights b and g.
    fn kick(&self, c: &M::Constants, t: T<Self>, q: &Q<Self>, weight: T<Self>, gradient: T<Self>) -> Mu<Self>;

    /// ∂U
    fn kick_gradient(&self, c: &M::Constants, t: T<Self>, q: &Q<Self>, weight: T<Self>, gradient: T<Self>) -> Q<Self>;
}

/// A monitor, which sets the times of steps. A step of the size h in s takes the time t with dt = g(q) ds.
pub trait TimeTransformed<M: Method<Self> = Declared>: Substep<0, M> {
    /// Whether a drift is the exact motion without the potential: two that meet are one then.
    const DRIFTS_ARE_EXACT: bool = false;

    /// The size h of a step, in s.
    fn step_size(c: &M::Constants) -> T<Self>;

    /// g(q), the monitor.
    fn monitor(&self, c: &M::Constants, q: &Q<Self>) -> T<Self>;

    /// −h g J(q, ∂V), the kick of a step.
    fn monitored_kick(&self, c: &M::Constants, t: T<Self>, q: &Q<Self>) -> Mu<Self>;

    /// γ = h Σ⁻¹J(q, ∂g)/g: γ·μ = h ġ/g where q moves by the velocity of the momentum μ.
    fn monitor_slope(&self, c: &M::Constants, q: &Q<Self>) -> Mu<Self>;
}

/// Hamilton's equations of (q, p): N numbers, the first half for q. K numbers are made of the time alone.
pub trait HamiltonEquations<const N: usize, const K: usize = 0, M: Method<Self> = Declared>: Parts<M> {
    /// Sweeps end where they change q and p by less than this part of them; 0 where only rounding ends them.
    const TOLERANCE: f64 = 0.0;
    /// The most sweeps of one step.
    const SWEEPS: u32 = crate::collocation::SWEEPS;
    /// Whether the action moves the origin, so that J is affine in q.
    const IS_AFFINE: bool = false;

    /// The size h of a step.
    fn step_size(c: &M::Constants) -> T<Self>;

    /// The numbers of the time alone that slopes take: found once a step for each stage, and not in each sweep.
    #[inline]
    #[allow(unused_variables, reason = "a system without time has none")]
    fn terms_of_time(&self, c: &M::Constants, t: T<Self>) -> [T<Self>; K] {
        [T::<Self>::zero(); K]
    }

    /// (q′, p′) at y = (q, p), all entries of q and then those of p; `terms` are those of the time t.
    fn slope(&self, c: &M::Constants, t: T<Self>, terms: &[T<Self>; K], y: &[T<Self>; N]) -> [T<Self>; N];

    /// A covector p at q with the momentum J(q, p) = μ.
    fn covector(&self, c: &M::Constants, q: &Q<Self>, mu: &Mu<Self>) -> Q<Self>;

    /// J(q, p), as [`Clebsch::momentum_map`], in the form that is fast.
    fn momentum(&self, q: &Q<Self>, p: &Q<Self>) -> Mu<Self>;

    /// The coordinates x of the motion by the velocity of the start for the time h, to first order in h.
    fn guess(&self, c: &M::Constants, t: T<Self>, q: &Q<Self>, mu: &Mu<Self>) -> Mu<Self>;

    /// A part of these coordinates.
    fn part(x: &Mu<Self>, part: T<Self>) -> Self::Coordinates;

    /// The entries of q and then those of p.
    fn joined(q: &Q<Self>, p: &Q<Self>) -> [T<Self>; N];

    /// q and p of their entries.
    fn parted(y: &[T<Self>; N]) -> (Q<Self>, Q<Self>);
}

/// Steps along great circles.
pub trait GreatCircles<M: Method<Self> = Declared>: Substep<0, M> {
    /// h/κ, κ the inertia.
    fn turn(c: &M::Constants) -> T<Self>;
}

/// A step that has been differentiated.
pub trait Varied<const M: usize>: Parts {
    /// The derivatives of F⁻ℓd and of F⁺ℓd with respect to the quantities that are fixed during a step; `()` if they
    /// are not asked for.
    type Slopes;
}

/// Substep K, differentiated: the discrete Lagrangian of an edge from q to `next` = Φ_F(q), F = I + D, with its derivatives along M directions.
#[allow(unused_variables, reason = "provided methods take what others need")]
pub trait VariedSubstep<const K: usize, const M: usize, B: Method<Self> = Declared>: Substep<K, B> + Varied<M> {
    /// ℓd with both Legendre transforms.
    fn momenta(&self, c: &B::Constants, t: T<Self>, ends: Ends<'_, Self>) -> Momenta<T<Self>, M>;

    /// The same with their derivatives along the motions of both ends.
    fn edge(&self, c: &B::Constants, t: T<Self>, ends: Ends<'_, Self>) -> Edge<T<Self>, M>;

    /// F⁺ℓd with the derivatives of both momenta, along motions that leave F as it is and along those of q⁺ alone.
    fn carried(&self, c: &B::Constants, t: T<Self>, ends: Ends<'_, Self>) -> Carried<T<Self>, M>;

    /// ∂F⁻ℓd and ∂F⁺ℓd with respect to the quantities that are fixed during a step.
    fn slopes(&self, c: &B::Constants, t: T<Self>, ends: Ends<'_, Self>) -> Self::Slopes;

    /// The edge with the force of a constraint, in a step from the momentum N. `None` where rows depend on each other.
    #[inline(always)]
    fn passed(
        &self,
        c: &B::Constants,
        t: T<Self>,
        ends: Ends<'_, Self>,
        mu: &Mu<Self>,
        edge: Carried<T<Self>, M>,
    ) -> Option<PassedEdge<T<Self>, M>> {
        Some(PassedEdge { edge, balance: None })
    }

    /// The slopes of that edge.
    #[inline(always)]
    fn slopes_passed(&self, c: &B::Constants, t: T<Self>, ends: Ends<'_, Self>, mu: &Mu<Self>) -> Option<Self::Slopes> {
        Some(self.slopes(c, t, ends))
    }
}
