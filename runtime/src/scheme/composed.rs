//! Steps of order 4, 6 and 8: symmetric compositions of time-symmetric steps of second order.
//!
//! ```text
//! Ψ_h = Φ_{γ_1 h} ∘ Φ_{γ_2 h} ∘ … ∘ Φ_{γ_m h},    γ_i = γ_{m+1−i},    Σ γ_i = 1
//! ```
//! Ψ conserves every quantity that each Φ conserves: group, momenta, symplectic form. Kicks that meet differ by the
//! ratio of sizes: one gradient serves both.
//!
//! Source: Hairer, Lubich and Wanner, *Geometric Numerical Integration*, section V.3.2. Order 4 is Suzuki's (1990).
//! Order 8 is that of Kahan and Li (1997), *Composition constants for raising the orders of unconventional schemes for
//! ordinary differential equations*.
//!
//! Order 6 minimises the error of a model: `cargo run --release -p clebsch-tests --example compositions` finds it.
//! It lies next to the eleven steps of Sofroniou and Spaletta (2005), *Derivation of symmetric composition constants for
//! symmetric integrators*. That command compares it with those, and with the nine of Kahan and Li.

use super::joined::JoinedInStorage;
use super::sites::{AtSite, InStorage, Stored};
use super::{At, AtOf, Before, Pair, Parted, Push, Scheme, Stepped};
use crate::parts::{Mu, Q, T, U};
use crate::power::Power;
use crate::{Clebsch, Error, Method, Scalar, Space};
use core::marker::PhantomData;
use nalgebra::SMatrix;
use num_traits::Zero;

/// γ_1, …, γ_K: the others are these backwards.
pub trait Sizes<const K: usize> {
    /// γ_1, …, γ_K
    const SIZES: [f64; K];
}

/// Five steps.
pub struct OfOrderFour;

/// Eleven steps.
pub struct OfOrderSix;

/// Seventeen steps.
pub struct OfOrderEight;

impl Sizes<3> for OfOrderFour {
    /// 1/(4 − ∛4), and the size that remains for the middle.
    const SIZES: [f64; 3] = [0.414_490_771_794_375_7, 0.414_490_771_794_375_7, -0.657_963_087_177_503];
}

impl Sizes<6> for OfOrderSix {
    /// The first two, which are free, and those that follow from the four conditions of order 6.
    const SIZES: [f64; 6] = [
        0.2073,
        0.1879,
        0.183_279_586_224_566_9,
        -0.443_893_233_917_182_94,
        0.113_006_149_361_662_08,
        0.504_814_996_661_907_9,
    ];
}

impl Sizes<9> for OfOrderEight {
    const SIZES: [f64; 9] = [
        0.130_202_483_088_890_07,
        0.561_162_981_775_108_4,
        -0.389_474_962_644_847_27,
        0.158_841_906_555_155_6,
        -0.395_903_894_133_237_57,
        0.184_539_640_978_315_7,
        0.258_374_387_686_322_04,
        0.295_011_723_609_310_3,
        -0.605_508_533_830_034_6,
    ];
}

/// Steps of the scheme I with the K sizes Z, and the same backwards.
pub struct Composed<I, Z, const K: usize>(PhantomData<(I, Z)>);

impl<S: Clebsch, M: Method<S>, I: Scheme<S, M>, Z: Sizes<K>, const K: usize> Scheme<S, M> for Composed<I, Z, K> {
    type Held = I::Held;
    type Left = I::Left;
    type Constants = Stages<S::Scalar, I::Constants, K>;

    fn constants(system: &S, h: S::Scalar) -> Result<Self::Constants, Error> {
        Stages::new(h, &Z::SIZES, |h| I::constants(system, h))
    }

    #[inline(always)]
    fn whole(constants: &Self::Constants) -> &M::Constants {
        I::whole(&constants.whole)
    }

    #[inline(always)]
    fn held(q: &Q<S>, mu: &Mu<S>) -> I::Held {
        I::held(q, mu)
    }

    #[inline(always)]
    fn momentum(q: &Q<S>, held: &I::Held) -> Mu<S> {
        I::momentum(q, held)
    }

    #[inline]
    fn left(at: AtOf<'_, S, Self, M>, q: &Q<S>, mu: &Mu<S>) -> I::Left {
        I::left(At::new(at.system, at.constants.first(), at.t), q, mu)
    }

    #[inline]
    fn left_after(at: AtOf<'_, S, Self, M>, q: &Q<S>, mu: &Mu<S>, left: &I::Left) -> I::Left {
        I::left_after(At::new(at.system, at.constants.first(), at.t), q, mu, left)
    }

    #[inline]
    fn left_elsewhere(at: AtOf<'_, S, Self, M>, q: &Q<S>, mu: &Mu<S>, left: &I::Left) -> I::Left {
        I::left_elsewhere(At::new(at.system, at.constants.first(), at.t), q, mu, left)
    }

    #[inline]
    fn kicked(at: AtOf<'_, S, Self, M>, q: &Q<S>, state: (&I::Held, &I::Left), impulse: &Mu<S>) -> (I::Held, I::Left) {
        I::kicked(At::new(at.system, at.constants.first(), at.t), q, state, impulse)
    }

    fn resumed(at: AtOf<'_, S, Self, M>, q: &Q<S>, mu: &Mu<S>, left: &I::Left) -> I::Left {
        I::resumed(At::new(at.system, at.constants.first(), at.t), q, mu, left)
    }

    fn held_defect(q: &Q<S>, held: &I::Held) -> S::Scalar {
        I::held_defect(q, held)
    }

    #[inline]
    fn step(at: AtOf<'_, S, Self, M>, (q, held, left): Before<'_, S, Self, M>, u: &S::Input) -> Stepped<S, Self, M> {
        let step = |stage: &I::Constants, t, (q, held, left): Parted<S, Self, M>| {
            I::step(At::new(at.system, stage, t), (&q, &held, &left), u)
        };
        let scaled = |(q, held, left): Parted<S, Self, M>, ratio| (q, held, I::scaled(left, ratio));
        compose(at.constants, at.t, (*q, *held, *left), step, scaled)
    }

    #[inline]
    fn step_pushed(
        at: AtOf<'_, S, Self, M>,
        (q, held, left): Before<'_, S, Self, M>,
        u: &S::Input,
        mut pushed: impl FnMut(Push<'_, S, M>),
    ) -> Stepped<S, Self, M> {
        let mut number = 0;
        let step = |stage: &I::Constants, t, (q, held, left): Parted<S, Self, M>| {
            let size = at.constants.at(number).map_or_else(Zero::zero, |(_, size)| size);
            number += 1;
            let pushed = |push: Push<'_, S, M>| pushed(push.at_its_time(size));
            I::step_pushed(At::new(at.system, stage, t), (&q, &held, &left), u, pushed)
        };
        let scaled = |(q, held, left): Parted<S, Self, M>, ratio| (q, held, I::scaled(left, ratio));
        compose(at.constants, at.t, (*q, *held, *left), step, scaled)
    }

    #[inline]
    fn step_symmetric(at: AtOf<'_, S, Self, M>, q: &Q<S>, p: &Q<S>) -> Result<Pair<S>, Error> {
        let step = |stage: &I::Constants, t, (q, p): Pair<S>| I::step_symmetric(At::new(at.system, stage, t), &q, &p);
        compose(at.constants, at.t, (*q, *p), step, |state, _| state)
    }

    #[inline]
    fn inverse_legendre(at: AtOf<'_, S, Self, M>, q: &Q<S>, mu: &Mu<S>) -> Result<S::Element, Error> {
        I::inverse_legendre(At::new(at.system, &at.constants.whole, at.t), q, mu)
    }
}

/// The sites between two steps, the sum of their numbers, and the room of a step.
type Stage<'a, 'r, S, R> = (Stored<'a, S>, T<S>, &'r mut [R]);

impl<S: Power<N>, I: InStorage<S, N>, Z: Sizes<K>, const K: usize, const N: usize> InStorage<S, N>
    for Composed<I, Z, K>
{
    type Room = I::Room;

    fn check(at: AtOf<'_, S, Self>, state: (&Q<S>, &Mu<S>), room: &mut [I::Room]) -> Result<(), AtSite> {
        I::check(At::new(at.system, &at.constants.whole, at.t), state, room)
    }

    fn start(at: AtOf<'_, S, Self>, state: Stored<'_, S>) {
        I::start(At::new(at.system, at.constants.first(), at.t), state);
    }

    #[inline]
    fn step_in_place<'a>(
        at: AtOf<'_, S, Self>,
        u: Option<&U<S>>,
        state: Stored<'a, S>,
        room: &mut [I::Room],
    ) -> Result<(Stored<'a, S>, T<S>), AtSite> {
        Self::in_place(at, state, room, |stage, t, state, room| {
            I::step_in_place(At::new(at.system, stage, t), u, state, room)
        })
    }
}

impl<I, Z, const K: usize> Composed<I, Z, K> {
    /// The steps of a composed step, one after the other.
    #[inline(always)]
    fn in_place<'a, 'r, S: Power<N>, const N: usize>(
        at: AtOf<'_, S, Self>,
        state: Stored<'a, S>,
        room: &'r mut [I::Room],
        mut step: impl FnMut(&I::Constants, T<S>, Stored<'a, S>, &mut [I::Room]) -> Result<(Stored<'a, S>, T<S>), AtSite>,
    ) -> Result<(Stored<'a, S>, T<S>), AtSite>
    where
        I: InStorage<S, N>,
        Z: Sizes<K>,
    {
        let step = |stage: &I::Constants, t, (state, _, room): Stage<'a, 'r, S, I::Room>| {
            let (state, sum) = step(stage, t, state, &mut *room)?;
            Ok((state, sum, room))
        };
        let scaled = |(state, sum, room): Stage<'a, 'r, S, I::Room>, ratio| {
            state.kick.iter_mut().for_each(|kick| *kick = kick.zip_map(kick, |kick, _| kick * ratio));
            (state, sum, room)
        };
        compose(at.constants, at.t, (state, T::<S>::zero(), room), step, scaled).map(|(state, sum, _)| (state, sum))
    }
}

impl<S: Power<N>, I: JoinedInStorage<S, N>, Z: Sizes<K>, const K: usize, const N: usize> JoinedInStorage<S, N>
    for Composed<I, Z, K>
{
    type Multipliers = I::Multipliers;
    type OfLoops = I::OfLoops;

    fn momenta_of_velocities(at: AtOf<'_, S, Self>, q: &Q<S>, velocities: &mut Mu<S>) {
        I::momenta_of_velocities(At::new(at.system, &at.constants.whole, at.t), q, velocities);
    }

    fn to_joints(at: AtOf<'_, S, Self>, state: (&mut Q<S>, &mut Mu<S>), room: &mut [I::Room]) -> Result<(), AtSite> {
        I::to_joints(At::new(at.system, &at.constants.whole, at.t), state, room)
    }

    #[inline]
    fn step_with_reactions<'a>(
        at: AtOf<'_, S, Self>,
        u: Option<&U<S>>,
        state: Stored<'a, S>,
        room: &mut [I::Room],
        (impulses, of_loops): (&mut [I::Multipliers], &mut I::OfLoops),
    ) -> Result<(Stored<'a, S>, T<S>), AtSite> {
        let step = |stage: &I::Constants, t, state: Stored<'a, S>, room: &mut [I::Room]| {
            I::step_with_reactions(At::new(at.system, stage, t), u, state, room, (&mut *impulses, &mut *of_loops))
        };
        Self::in_place(at, state, room, step)
    }

    fn reactions(
        at: AtOf<'_, S, Self>,
        state: (&Q<S>, &Mu<S>),
        u: &U<S>,
        room: &mut [I::Room],
        free: (&mut Q<S>, &mut Mu<S>, &mut Mu<S>),
        multipliers: &mut [I::Multipliers],
    ) -> Result<I::OfLoops, AtSite> {
        I::reactions(At::new(at.system, &at.constants.whole, at.t), state, u, room, free, multipliers)
    }
}

/// The state after a composed step from the time `t`. `scaled` converts the data of a step for a step that is so many
/// times as long.
#[inline(always)]
pub fn compose<T: Scalar, C: Clone, X, E, const K: usize>(
    stages: &Stages<T, C, K>,
    t: T,
    start: X,
    mut step: impl FnMut(&C, T, X) -> Result<X, E>,
    scaled: impl Fn(X, T) -> X,
) -> Result<X, E> {
    let (mut state, mut t) = (start, t);
    let mut number = 0;
    while let Some((constants, size)) = stages.at(number) {
        state = step(constants, t, state)?;
        number += 1;
        // the last step is of the size of the first of the next composed one
        let next = stages.at(number).map_or(size, |(_, next)| next);
        state = scaled(state, next / size);
        t += size;
    }
    Ok(state)
}

/// The constants of a composed step: of a step of the full size, and of those that it is made of.
#[derive(Clone, Debug)]
pub struct Stages<T, C, const K: usize> {
    /// Those of a step of size h.
    pub whole: C,
    /// Those of the steps of sizes γ_1 h, …, γ_K h.
    stages: [C; K],
    /// γ_1 h, …, γ_K h
    sizes: [T; K],
    h: T,
}

impl<T: Scalar, C: Clone, const K: usize> Stages<T, C, K> {
    /// The constants for the step size `h`, those of each size made by `make`.
    pub fn new(h: T, sizes: &[f64; K], make: impl Fn(T) -> Result<C, Error>) -> Result<Self, Error> {
        let whole = make(h)?;
        let sizes = sizes.map(|size| T::from_f64(size) * h);
        let mut stages = core::array::from_fn(|_| whole.clone());
        for (stage, size) in stages.iter_mut().zip(sizes) {
            *stage = make(size)?;
        }
        Ok(Self { whole, stages, sizes, h })
    }

    /// Those of the first step that is made.
    #[inline]
    fn first(&self) -> &C {
        self.stages.first().unwrap_or(&self.whole)
    }

    /// The constants and the size of the step number `number`; `None` after the last.
    #[inline]
    fn at(&self, number: usize) -> Option<(&C, T)> {
        let index = if number < K { number } else { (2 * K - 2).checked_sub(number)? };
        Some((self.stages.get(index)?, *self.sizes.get(index)?))
    }

    /// The step number `number` < 2K − 1.
    #[inline]
    pub fn stage(&self, number: usize) -> SizedStep<'_, T, C> {
        let before = (0..number).filter_map(|number| self.at(number));
        let start = before.fold(T::zero(), |sum, (_, size)| sum + size);
        let (constants, size) = self.at(number).unwrap_or((&self.whole, self.h));
        SizedStep { constants, start, size, whole: self.h }
    }
}

/// One of the steps of a composed step.
#[derive(Clone, Copy, Debug)]
pub struct SizedStep<'a, T, C> {
    /// The constants of steps of its size.
    pub constants: &'a C,
    /// c_i h, the time from the start of the composed step to its own.
    pub start: T,
    /// γ_i h
    size: T,
    /// h
    whole: T,
}

impl<T: Scalar, C> SizedStep<'_, T, C> {
    /// The slopes of its momenta along h and t, from those along its own size and time. The column of h is γ_i ∂/∂h_i +
    /// c_i ∂/∂t_i.
    #[inline]
    pub fn slopes<const M: usize, const P: usize>(
        &self,
        slopes: SMatrix<T, M, P>,
        size: Option<usize>,
        time: Option<usize>,
    ) -> SMatrix<T, M, P> {
        let (part, begun) = (self.size / self.whole, self.start / self.whole);
        let along = |i: usize, column: Option<usize>| match column {
            Some(j) if j < P => slopes[(i, j)],
            _ => T::zero(),
        };
        SMatrix::from_fn(|i, j| match size {
            Some(column) if column == j => along(i, size) * part + along(i, time) * begun,
            _ => slopes[(i, j)],
        })
    }
}

#[cfg(test)]
mod tests;
