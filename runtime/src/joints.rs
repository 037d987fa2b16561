//! Joints: constraints φ(t, q) = 0 on neighbouring sites of a power, or on those of a tree.
//!
//! The rows of a site are those of the equations whose later site it is: they read this site and its parent. In a chain the
//! parent is the site before. Before the first site of a ring comes the last one. The rows are A along motions of the site
//! and B along those of its parent, and c are its children. A step solves:
//!
//! ```text
//! n_i = N_i + A_iᵀλ_i + Σ_c B_cᵀλ_c,    (q⁺_i, M⁺_i) = the free step of site i,    φ(t + h, q⁺) = 0
//! ```
//! Sweeps λ ← λ − S⁻¹φ(q⁺)/h find the multipliers, with S = A Σ⁻¹Aᵀ of all rows at q. It is factored once a step, in a chain
//! as a block tridiagonal matrix. The momentum after the step is N⁺ + Aᵀμ, whose velocity obeys A ξ = −∂φ/∂t at q⁺.

mod blocks;
mod loops;
mod solver;
mod tree;

use crate::constraint::Violation;
use crate::parts::{Mu, Q, T};
use crate::power::{Constants, Power};
use crate::scheme;
use crate::{Clebsch, Error, Scalar, Space};
use blocks::Block;
use core::array::from_fn;
use nalgebra::{SMatrix, SVector};
use num_traits::Zero;

pub use loops::{Border, BorderOf, Loop, Loops, put_loop_values, put_loops};
pub(crate) use solver::{Joints, least_of_steps};
pub use tree::{Branch, Limb, LoopedLimb};

/// The rows of one site.
#[derive(Clone, Copy, Debug)]
pub struct Rows<T, const R: usize, const M: usize> {
    /// A, along motions of the site.
    pub own: SMatrix<T, R, M>,
    /// B, along motions of the parent.
    pub before: SMatrix<T, R, M>,
    /// −∂φ/∂t.
    pub velocity: SVector<T, R>,
    /// Which of the R rows there are.
    pub are_there: [bool; R],
}

impl<T: Scalar, const R: usize, const M: usize> Rows<T, R, M> {
    /// No rows.
    #[inline]
    pub fn none() -> Self {
        let (own, velocity) = (Space::origin(), Space::origin());
        Self { own, before: own, velocity, are_there: [false; R] }
    }

    /// Puts C rows in their place, the first of them in row `first`.
    #[inline(always)]
    pub fn put<const C: usize>(&mut self, first: usize, own: [[T; M]; C], before: [[T; M]; C], velocity: [T; C]) {
        for (i, ((own, before), velocity)) in own.iter().zip(&before).zip(&velocity).enumerate() {
            let Some(is_there) = self.are_there.get_mut(first + i) else { return };
            *is_there = true;
            for j in 0..M {
                self.own[(first + i, j)] = own[j];
                self.before[(first + i, j)] = before[j];
            }
            self.velocity[first + i] = *velocity;
        }
    }
}

/// Puts C values of φ in their place, the first of them in row `first`.
#[inline(always)]
pub fn put_places<T: Scalar, const R: usize, const C: usize>(places: &mut SVector<T, R>, first: usize, values: [T; C]) {
    // of a slice: the iterator of a matrix is not unrolled
    let behind = places.as_mut_slice().get_mut(first..).unwrap_or_default();
    for (place, value) in behind.iter_mut().zip(values) {
        *place = value;
    }
}

/// The room of one site for the rows of its joint, their multipliers, and the factors of S.
///
/// See [`Stepper::joined_sites`](crate::Stepper::joined_sites).
#[derive(Clone, Debug)]
pub struct Joint<T, C, B, const R: usize, const M: usize> {
    rows: Rows<T, R, M>,
    block: Block<T, R>,
    /// λ
    multipliers: SVector<T, R>,
    /// The rounding errors of φ.
    rounding: SVector<T, R>,
    /// The diagonal of S.
    metric: SVector<T, R>,
    /// The constants of the site, where sites differ.
    constants: Option<C>,
    /// The room of a site in a tree.
    branch: B,
}

/// The room of a joint of P.
pub type JointOf<P, const N: usize, const R: usize, const M: usize> =
    Joint<T<P>, scheme::Constants<<P as Power<N>>::Site>, <P as Joined<N, R, M>>::Branch, R, M>;

impl<T: Scalar, C, B: Branch<T, R, M>, const R: usize, const M: usize> Default for Joint<T, C, B, R, M> {
    fn default() -> Self {
        let zero = SVector::from_element(T::zero());
        Self {
            rows: Rows::none(),
            block: Block::zero(),
            multipliers: zero,
            rounding: zero,
            metric: zero,
            constants: None,
            branch: B::new(),
        }
    }
}

/// The solutions of the blocks.
fn solutions<T: Scalar, C, B, const N: usize, const R: usize, const M: usize>(
    room: &[Joint<T, C, B, R, M>; N],
) -> [SVector<T, R>; N] {
    let mut all = [SVector::from_element(T::zero()); N];
    for i in 0..N {
        all[i] = room[i].block.right;
    }
    all
}

/// The multipliers of each site, and those of the loops.
pub type WithLoops<P, const N: usize, const R: usize, const M: usize> = ([SVector<T<P>, R>; N], BorderOf<P, N, R, M>);

/// A site, whose velocity follows from its momentum.
pub trait Mobile<const M: usize>: Clebsch<Momentum = SVector<<Self as Clebsch>::Scalar, M>> {
    /// Σ⁻¹μ
    fn mobility(c: &Self::Constants, mu: &Self::Momentum) -> Self::Momentum;

    /// The momentum A_g of velocity zero, where it is not 0.
    #[inline(always)]
    fn momentum_at_rest(&self, _t: Self::Scalar, _q: &Self::Configuration) -> Option<Self::Momentum> {
        None
    }

    /// The momentum Σξ + A_g of a velocity.
    fn momentum_of_velocity(&self, t: Self::Scalar, q: &Self::Configuration, x: &Self::Momentum) -> Self::Momentum;

    /// ξ′ of the velocity where no joint and no other site acts, with the input u of the forces.
    fn acceleration(
        &self,
        c: &Self::Constants,
        t: Self::Scalar,
        q: &Self::Configuration,
        mu: &Self::Momentum,
        u: &Self::Input,
    ) -> Self::Momentum;

    /// q after a motion by x, to first order in x.
    fn moved_by(&self, q: &Self::Configuration, x: &Self::Momentum) -> Self::Configuration;

    /// Σ⁻¹(μ − A_g), the velocity.
    #[inline(always)]
    fn velocity(
        &self,
        c: &Self::Constants,
        t: Self::Scalar,
        q: &Self::Configuration,
        mu: &Self::Momentum,
    ) -> Self::Momentum {
        match self.momentum_at_rest(t, q) {
            Some(at_rest) => Self::mobility(c, &(mu - at_rest)),
            None => Self::mobility(c, mu),
        }
    }
}

/// A power whose sites are joined: at most R rows a site, along motions of M components.
pub trait Joined<const N: usize, const R: usize, const M: usize>: Power<N, Site: Mobile<M>> {
    /// Whether a joint reads the last site and the first one.
    const IS_RING: bool;

    /// `()` in chains and rings, [`Limb`] in trees, and [`LoopedLimb`] in trees with loops.
    type Branch: Branch<T<Self>, R, M>;

    /// The other site that the joints of a site read. It is an earlier one, but in a ring for the first site.
    #[inline(always)]
    fn parent(site: usize) -> Option<usize> {
        if Self::IS_RING && site == 0 { N.checked_sub(1) } else { site.checked_sub(1) }
    }

    /// φ of the rows of a site; 0 for a row that is not there.
    fn places_at(&self, t: T<Self>, q: &Q<Self>, site: usize) -> SVector<T<Self>, R>;

    /// The rows of a site.
    fn rows_at(&self, t: T<Self>, q: &Q<Self>, site: usize) -> Rows<T<Self>, R, M>;

    /// φ″ of the rows of a site with the constant velocities x of it and y of its parent.
    fn bend_at(
        &self,
        t: T<Self>,
        q: &Q<Self>,
        site: usize,
        x: &SVector<T<Self>, M>,
        y: &SVector<T<Self>, M>,
    ) -> SVector<T<Self>, R>;

    /// The rows of the equations that close loops.
    #[inline(always)]
    fn loop_rows(&self, _t: T<Self>, _q: &Q<Self>, _loops: &mut [Loop<T<Self>, M>]) {}

    /// φ of these equations.
    #[inline(always)]
    fn loop_places(&self, _t: T<Self>, _q: &Q<Self>, _loops: &mut [Loop<T<Self>, M>]) {}

    /// φ″ of these equations with constant velocities of all sites.
    #[inline(always)]
    fn loop_bends(
        &self,
        _t: T<Self>,
        _q: &Q<Self>,
        _velocities: &[SVector<T<Self>, M>; N],
        _loops: &mut [Loop<T<Self>, M>],
    ) {
    }

    /// Whether all sites obey their joints.
    ///
    /// # Errors
    /// [`Error::OffConstraint`].
    fn check_joints(&self, t: T<Self>, q: &Q<Self>) -> Result<(), Error> {
        Joints::<Self, N, R, M>::check(self, t, q).map_err(|(_, error)| error)
    }

    /// By how much the velocity of N violates the joints.
    ///
    /// # Errors
    /// [`Error::DependentConstraints`].
    fn defect_of_joints(
        &self,
        c: &Constants<Self, N>,
        t: T<Self>,
        q: &Q<Self>,
        mu: &Mu<Self>,
    ) -> Result<Violation<T<Self>>, Error> {
        let mut room = from_fn(|_| Joint::default());
        let defect = Joints::<Self, N, R, M>::new(self, c, &mut room).and_then(|mut joints| joints.defect(t, q, mu));
        defect.map(|(violation, _)| violation).map_err(|(_, error)| error)
    }

    /// The momentum N + Aᵀμ whose velocity obeys the joints.
    ///
    /// # Errors
    /// [`Error::DependentConstraints`].
    fn joined_momentum(
        &self,
        c: &Constants<Self, N>,
        t: T<Self>,
        q: &Q<Self>,
        mu: &Mu<Self>,
    ) -> Result<Mu<Self>, Error> {
        let (mut room, mut mu) = (from_fn(|_| Joint::default()), *mu);
        let projected = Joints::<Self, N, R, M>::new(self, c, &mut room)
            .and_then(|mut joints| joints.projected(t, q, &mut mu, T::<Self>::EPSILON.sqrt()));
        projected.map(|_| mu).map_err(|(_, error)| error)
    }

    /// A configuration that obeys the joints, next to q.
    ///
    /// # Errors
    /// [`Error::FarFromConstraint`], or [`Error::DependentConstraints`].
    fn joined_places(&self, c: &Constants<Self, N>, t: T<Self>, q: &Q<Self>) -> Result<Q<Self>, Error> {
        let (mut room, mut q) = (from_fn(|_| Joint::default()), *q);
        let placed = Joints::<Self, N, R, M>::new(self, c, &mut room).and_then(|mut joints| joints.placed(t, &mut q));
        placed.map(|()| q).map_err(|(_, error)| error)
    }

    /// The multipliers κ of a push p = Aᵀκ at (t, q): S⁻¹A Σ⁻¹p; NaN where the rows depend on each other.
    fn multipliers_of_joints(
        &self,
        c: &Constants<Self, N>,
        t: T<Self>,
        q: &Q<Self>,
        push: &Mu<Self>,
    ) -> [SVector<T<Self>, R>; N] {
        self.multipliers_with_loops(c, t, q, push).0
    }

    /// The same, and those of the loops.
    fn multipliers_with_loops(
        &self,
        c: &Constants<Self, N>,
        t: T<Self>,
        q: &Q<Self>,
        push: &Mu<Self>,
    ) -> WithLoops<Self, N, R, M> {
        let mut room = from_fn(|_| Joint::default());
        let found = Joints::<Self, N, R, M>::new(self, c, &mut room)
            .and_then(|mut joints| joints.multipliers(t, q, push).map(|()| joints.border));
        if let Ok(border) = found {
            return (solutions(&room), border);
        }
        let (nan, mut border) = (T::<Self>::zero() / T::<Self>::zero(), BorderOf::<Self, N, R, M>::new());
        border.all_mut().iter_mut().for_each(|row| row.value = nan);
        ([SVector::from_element(nan); N], border)
    }

    /// The multipliers λ of the motion N′ = N′_free + Aᵀλ through (q, N), with the input u of the forces.
    ///
    /// # Errors
    /// [`Error::DependentConstraints`].
    fn reactions_of_joints(
        &self,
        c: &Constants<Self, N>,
        t: T<Self>,
        q: &Q<Self>,
        mu: &Mu<Self>,
        u: &Self::Input,
    ) -> Result<[SVector<T<Self>, R>; N], Error> {
        self.reactions_with_loops(c, t, q, mu, u).map(|(joints, _)| joints)
    }

    /// The same, and those of the loops.
    ///
    /// # Errors
    /// [`Error::DependentConstraints`].
    fn reactions_with_loops(
        &self,
        c: &Constants<Self, N>,
        t: T<Self>,
        q: &Q<Self>,
        mu: &Mu<Self>,
        u: &Self::Input,
    ) -> Result<WithLoops<Self, N, R, M>, Error> {
        let mut room = from_fn(|_| Joint::default());
        let (gradient, zero) = (&mut [Space::origin(); N], [Space::origin(); N]);
        let free = (gradient, &mut { zero }, &mut { zero });
        let found = Joints::<Self, N, R, M>::new(self, c, &mut room)
            .and_then(|mut joints| joints.reactions(t, (q, mu), u, free).map(|()| joints.border));
        found.map(|border| (solutions(&room), border)).map_err(|(_, error)| error)
    }
}
