//! The common part of steered systems, for generated code: checks, and the second derivatives of an implicit step.

use crate::linear::{eliminate, rows};
use crate::matrices::{Blocks, embedded};
use crate::newton::shortest;
use crate::scheme::{At, Constants, Scheme};
use crate::tangent::{of_edge, times};
use crate::{
    Arrival, BoundsExpansion, Carried, Clebsch, EndpointExpansion, Error, Expansion, Scalar, Space, Tangent,
    TargetExpansion,
};
use core::array::from_fn;
use nalgebra::{SMatrix, SVector};

/// A place that a step has reached, where it is finite.
#[inline]
pub fn check_reached<T: Scalar, X: Space<T>>(x: X) -> Result<X, Error> {
    if x.all_finite() { Ok(x) } else { Err(Error::NotFinite { name: "the place after the step" }) }
}

/// Refuses a reference that the motion of a step reads and that was not given.
///
/// # Errors
/// [`Error::NoReference`], as of a plan of one step.
#[inline]
pub fn check_given<T: Scalar, R: Space<T>>(reference: &R) -> Result<(), Error> {
    if reference.all_finite() { Ok(()) } else { Err(Error::NoReference { step: 0, steps: 1 }) }
}

/// (q, N) after one step under the input u.
#[inline]
pub fn forced_step<S: Clebsch>(
    system: &S,
    constants: &Constants<S>,
    t: S::Scalar,
    (q, mu): &(S::Configuration, S::Momentum),
    u: &S::Input,
) -> Result<(S::Configuration, S::Momentum), Error>
where
    (S::Configuration, S::Momentum): Space<S::Scalar>,
{
    let at = At::new(system, constants, t);
    let left = S::Scheme::left(at, q, mu);
    let held = S::Scheme::held(q, mu);
    let (q, held, _) = S::Scheme::step(at, (q, &held, &left), u)?;
    check_reached((q, S::Scheme::momentum(&q, &held)))
}

/// The state that obeys the constraint at the time t, next to (q, N); this one where there is none nearby.
pub fn placed_state<S: Clebsch>(
    system: &S,
    constants: &S::Constants,
    t: S::Scalar,
    (q, mu): &(S::Configuration, S::Momentum),
) -> (S::Configuration, S::Momentum) {
    let placed = system.placed(constants, t, q);
    let placed = placed.and_then(|q| Ok((q, system.constrained(constants, t, &q, mu)?)));
    placed.unwrap_or((*q, *mu))
}

/// The shortest η with GᵀG η = Gᵀ(q⁺ − q).
#[inline]
pub fn displacement<T: Scalar, const M: usize>(metric: &SMatrix<T, M, M>, approach: &SVector<T, M>) -> SVector<T, M> {
    Space::side_by_side(|lane| shortest(&metric.lane(lane), &approach.lane(lane)).0)
}

/// (a, b)
#[inline]
pub fn pair<T: Scalar, const M: usize, const D: usize>(a: &SVector<T, M>, b: &SVector<T, M>) -> SVector<T, D> {
    SVector::from_fn(|i, _| if i < M { a[i] } else { b[i - M] })
}

/// The parts a and b of (a, b).
#[inline]
pub fn parted<T: Scalar, const M: usize, const D: usize>(ab: &SVector<T, D>) -> (SVector<T, M>, SVector<T, M>) {
    (SVector::from_fn(|i, _| ab[i]), SVector::from_fn(|i, _| ab[M + i]))
}

/// The difference of one state from another: (Gᵀ(q* − q), N* − N) and (GᵀG, I).
#[inline]
pub fn arrival_of_state<T: Scalar, const M: usize, const D: usize>(
    metric: &SMatrix<T, M, M>,
    approach: &SVector<T, M>,
    missing: &SVector<T, M>,
) -> Arrival<T, D> {
    let slope = SMatrix::from_fn(|i, j| match (i < M, j < M) {
        (true, true) => metric[(i, j)],
        (false, false) if i == j => T::one(),
        _ => T::zero(),
    });
    Arrival { residual: pair(approach, missing), slope }
}

/// The price of the end as a function of a place, along its first M components.
pub fn endpoint<T: Scalar, const M: usize, const D: usize>(
    price: T,
    by_time: T,
    slope: &SVector<T, M>,
    curvature: &SMatrix<T, M, M>,
) -> EndpointExpansion<T, D> {
    EndpointExpansion { price, by_time, slope: embedded(slope, 0, 0), curvature: embedded(curvature, 0, 0) }
}

/// No price of the end.
pub fn no_endpoint<T: Scalar, const D: usize>() -> EndpointExpansion<T, D> {
    EndpointExpansion { price: T::zero(), by_time: T::zero(), slope: SVector::zeros(), curvature: SMatrix::zeros() }
}

/// The prices of bounds: the last K are soft.
#[inline]
pub fn bound_prices<T: Scalar, const K: usize, const C: usize>(soft: &SVector<T, K>) -> SVector<T, C> {
    let price = |i: usize| (i + K).checked_sub(C).and_then(|k| soft.get(k)).copied();
    SVector::from_fn(|i, _| price(i).unwrap_or(T::from_f64(f64::INFINITY)))
}

/// The multipliers of so many conditions of the end.
#[inline]
pub fn weights<T: Scalar, const N: usize, const D: usize>(multipliers: &SVector<T, D>) -> SVector<T, N> {
    SVector::from_fn(|i, _| multipliers.get(i).copied().unwrap_or(T::zero()))
}

/// The conditions of the end as functions of a place, along its first M components.
#[inline]
pub fn conditions<T: Scalar, const N: usize, const M: usize, const D: usize>(
    [left, right, by_time]: [&SVector<T, N>; 3],
    slope: &SMatrix<T, N, M>,
    curvature: &SMatrix<T, M, M>,
) -> TargetExpansion<T, D> {
    let sizes = left.zip_map(right, |a, b| a.abs() + b.abs());
    let all = |values: &SVector<T, N>| embedded(values, 0, 0);
    TargetExpansion {
        values: all(&(left - right)),
        sizes: all(&sizes),
        by_time: all(by_time),
        slope: embedded(slope, 0, 0),
        curvature: embedded(curvature, 0, 0),
    }
}

/// Bounds as functions of a place; q is the first part of the place.
pub fn bounds<T: Scalar, const M: usize, const D: usize, const U: usize, const C: usize>(
    values: SVector<T, C>,
    by_motion: &SMatrix<T, C, M>,
    by_input: SMatrix<T, C, U>,
    motions: &SMatrix<T, M, M>,
    mixed: &SMatrix<T, U, M>,
    input_curvature: SMatrix<T, U, U>,
) -> BoundsExpansion<T, D, U, C> {
    BoundsExpansion {
        values,
        by_place: embedded(by_motion, 0, 0),
        by_input,
        place_curvature: embedded(motions, 0, 0),
        mixed_curvature: embedded(mixed, 0, 0),
        input_curvature,
    }
}

/// The part of a slope along the W directions of an edge that is along the motions ζ of its end alone.
#[inline]
pub fn along_end<T: Scalar, const W: usize, const M: usize>(slope: &SVector<T, W>) -> SVector<T, M> {
    slope.block(M, 0)
}

/// The same of z·a, for the slopes of bounds a.
#[inline]
pub fn pushed_along_end<T: Scalar, const C: usize, const W: usize, const M: usize>(
    slopes: &SMatrix<T, C, W>,
    z: &SVector<T, C>,
) -> SVector<T, M> {
    along_end(&times(&slopes.transpose(), z))
}

/// ℓ of a step with its derivatives along motions of q and along inputs.
#[derive(Clone, Copy, Debug)]
pub struct Price<T, const M: usize, const U: usize> {
    /// ℓ
    pub price: T,
    /// ∂ℓ/∂η
    pub by_motion: SVector<T, M>,
    /// ∂ℓ/∂u
    pub by_input: SVector<T, U>,
    /// ∂²ℓ/∂η²
    pub motions: SMatrix<T, M, M>,
    /// ∂²ℓ/∂u∂η
    pub mixed: SMatrix<T, U, M>,
    /// ∂²ℓ/∂u²
    pub inputs: SMatrix<T, U, U>,
}

/// A forced step between places (q, N), linearised by the implicit function theorem on F⁻ℓd(q, q⁺, u) = N and N⁺ = F⁺ℓd(q, q⁺, u). With the
/// costate (α, β) at (q⁺, N⁺), κ makes α·η′ + β·F⁺ℓd + κ·(F⁻ℓd − N) stationary in η′.
#[derive(Clone, Copy, Debug)]
pub struct Link<T, const M: usize, const U: usize> {
    /// β
    pub costate: SVector<T, M>,
    /// α
    pub driving: SVector<T, M>,
    /// κ = −(∂F⁻ℓd/∂η′)⁻ᵀ (α + (∂F⁺ℓd/∂η′)ᵀ β)
    pub multiplier: SVector<T, M>,
    adjoint: SMatrix<T, M, M>,
    tangent: Tangent<T, M>,
    motion_by_input: SMatrix<T, M, U>,
    momentum_by_input: SMatrix<T, M, U>,
}

impl<T: Scalar, const M: usize, const U: usize> Link<T, M, U> {
    /// The step over an edge, with ∂F⁻ℓd/∂u and ∂F⁺ℓd/∂u; `None` where ∂F⁻ℓd/∂η′ is singular.
    #[inline]
    pub fn new<const D: usize>(
        edge: &Carried<T, M>,
        before: &SMatrix<T, M, U>,
        after: &SMatrix<T, M, U>,
        costate: &SVector<T, D>,
    ) -> Option<Self> {
        Self::priced(edge, before, after, costate, &SVector::zeros())
    }

    /// The same where κ makes ℓ + α·η′ + β·F⁺ℓd + κ·(F⁻ℓd − N) stationary in η′, for a price with the slope ∂ℓ/∂η′.
    pub fn priced<const D: usize>(
        edge: &Carried<T, M>,
        before: &SMatrix<T, M, U>,
        after: &SMatrix<T, M, U>,
        costate: &SVector<T, D>,
        price: &SVector<T, M>,
    ) -> Option<Self> {
        Self::over(edge, None, (before, after), costate, price)
    }

    /// The same with Q of a constraint, which takes from a change of N the part that its force balances.
    #[inline]
    pub(crate) fn over<const D: usize>(
        edge: &Carried<T, M>,
        balance: Option<SMatrix<T, M, M>>,
        (before, after): (&SMatrix<T, M, U>, &SMatrix<T, M, U>),
        costate: &SVector<T, D>,
        price: &SVector<T, M>,
    ) -> Option<Self> {
        let tangent = of_edge(edge, balance)?;
        let motion_by_input = -times(&tangent.motion_by_momentum, before);
        let momentum_by_input = after + times(&edge.after_by_end, &motion_by_input);
        let alpha: SVector<T, M> = costate.block(0, 0);
        let beta = costate.block(M, 0);
        let wanted = price + (alpha + times(&edge.after_by_end.transpose(), &beta));
        let mut multiplier: [[T; 1]; M] = from_fn(|i| [wanted[i]]);
        eliminate(rows(&edge.before_by_end.transpose()), &mut multiplier)?;
        let multiplier = SVector::from_fn(|i, _| -multiplier[i][0]);
        let adjoint = edge.adjoint;
        Some(Self { costate: beta, driving: alpha, multiplier, adjoint, tangent, motion_by_input, momentum_by_input })
    }

    /// The step with its derivatives. `curvature` contains the second derivatives of β·F⁺ℓd + κ·F⁻ℓd along W = 2M + U
    /// directions. These are the motions η of q that leave F as it is, the motions ζ of q⁺ alone, and the inputs.
    /// `bracket` is ± ½ α·[E_i, E_j].
    pub fn expansion<X, const W: usize, const D: usize>(
        &self,
        next: X,
        curvature: &SMatrix<T, W, W>,
        bracket: &SMatrix<T, M, M>,
        price: &Price<T, M, U>,
    ) -> Expansion<X, T, D, U> {
        let step = self.step(next, curvature, bracket);
        Expansion {
            price: price.price,
            price_by_place: embedded(&price.by_motion, 0, 0),
            price_by_input: price.by_input,
            place_curvature: step.place_curvature + embedded(&price.motions, 0, 0),
            mixed_curvature: step.mixed_curvature + embedded(&price.mixed, 0, 0),
            input_curvature: step.input_curvature + price.inputs,
            ..step
        }
    }

    /// The same for a price that is a function of the edge, with its derivatives along the W directions.
    pub fn expansion_of_edge<X, const W: usize, const D: usize>(
        &self,
        next: X,
        curvature: &SMatrix<T, W, W>,
        bracket: &SMatrix<T, M, M>,
        (price, slope, bend): (T, &SVector<T, W>, &SMatrix<T, W, W>),
    ) -> Expansion<X, T, D, U> {
        let (by_place, by_input) = self.directions::<W, D>();
        Expansion {
            price,
            price_by_place: times(&by_place.transpose(), slope),
            price_by_input: times(&by_input.transpose(), slope),
            ..self.step(next, &(curvature + bend), bracket)
        }
    }

    /// Bounds that are functions of the edge, with their derivatives along the W directions. `curvature` contains those of
    /// z·a + κ·F⁻ℓd, with the κ of the slope of z·a.
    pub fn bounds<const W: usize, const D: usize, const C: usize>(
        &self,
        values: SVector<T, C>,
        slopes: &SMatrix<T, C, W>,
        curvature: &SMatrix<T, W, W>,
    ) -> BoundsExpansion<T, D, U, C> {
        let (by_place, by_input) = self.directions::<W, D>();
        let (bent_places, bent_inputs) = (times(curvature, &by_place), times(curvature, &by_input));
        let (places, inputs) = (by_place.transpose(), by_input.transpose());
        BoundsExpansion {
            values,
            by_place: times(slopes, &by_place),
            by_input: times(slopes, &by_input),
            place_curvature: times(&places, &bent_places),
            mixed_curvature: times(&inputs, &bent_places),
            input_curvature: times(&inputs, &bent_inputs),
        }
    }

    /// How η, ζ and the inputs change with (η, ν) and with u.
    #[inline(always)]
    pub(crate) fn directions<const W: usize, const D: usize>(&self) -> (SMatrix<T, W, D>, SMatrix<T, W, U>) {
        let tangent = &self.tangent;
        let carried = tangent.motion_by_motion - self.adjoint;
        let by_place = embedded(&SMatrix::<T, M, M>::identity(), 0, 0)
            + embedded(&carried, M, 0)
            + embedded(&tangent.motion_by_momentum, M, M);
        let by_input = embedded(&self.motion_by_input, M, 0) + embedded(&SMatrix::<T, U, U>::identity(), 2 * M, 0);
        (by_place, by_input)
    }

    /// How N⁺ changes with (η, ν) and with u.
    #[inline(always)]
    pub(crate) fn momentum<const D: usize>(&self) -> (SMatrix<T, M, D>, SMatrix<T, M, U>) {
        let Tangent { momentum_by_motion, momentum_by_momentum, .. } = &self.tangent;
        (embedded(momentum_by_motion, 0, 0) + embedded(momentum_by_momentum, 0, M), self.momentum_by_input)
    }

    /// The step without its price.
    #[inline(always)]
    fn step<X, const W: usize, const D: usize>(
        &self,
        next: X,
        curvature: &SMatrix<T, W, W>,
        bracket: &SMatrix<T, M, M>,
    ) -> Expansion<X, T, D, U> {
        // ± ½ α·[Ad η, ζ]
        let turned = times(&self.adjoint.transpose(), bracket);
        let curvature = &SMatrix::<T, W, W>::from_fn(|i, j| match (i < M, j < M) {
            (true, false) if j < 2 * M => curvature[(i, j)] + turned[(i, j - M)],
            (false, true) if i < 2 * M => curvature[(i, j)] + turned[(j, i - M)],
            _ => curvature[(i, j)],
        });
        let tangent = &self.tangent;
        let (by_place, by_input) = self.directions::<W, D>();
        let (bent_places, bent_inputs) = (times(curvature, &by_place), times(curvature, &by_input));
        let (places, inputs) = (by_place.transpose(), by_input.transpose());
        Expansion {
            next,
            by_place: SMatrix::from_fn(|i, j| match (i < M, j < M) {
                (true, true) => tangent.motion_by_motion[(i, j)],
                (true, false) => tangent.motion_by_momentum[(i, j - M)],
                (false, true) => tangent.momentum_by_motion[(i - M, j)],
                (false, false) => tangent.momentum_by_momentum[(i - M, j - M)],
            }),
            by_input: SMatrix::from_fn(|i, j| {
                if i < M { self.motion_by_input[(i, j)] } else { self.momentum_by_input[(i - M, j)] }
            }),
            price: T::zero(),
            price_by_place: SVector::zeros(),
            price_by_input: SVector::zeros(),
            place_curvature: times(&places, &bent_places),
            mixed_curvature: times(&inputs, &bent_places),
            input_curvature: times(&inputs, &bent_inputs),
        }
    }
}
