//! What steered systems have in common, for generated code: checks, and the second derivatives of an implicit step.

use crate::linear::{eliminate, rows};
use crate::newton::shortest;
use crate::scheme::{At, Constants, Scheme};
use crate::space::{lane_of, set_lane};
use crate::stepper::{check_configuration, check_momentum, check_on_orbit as on_orbit};
use crate::tangent::{of_edge, times};
use crate::{Arrival, BoundsExpansion, Carried, Clebsch, EndpointExpansion, Error, Expansion, Scalar, Space, Tangent};
use core::array::from_fn;
use nalgebra::{SMatrix, SVector};

/// Whether a configuration is finite and, by its defect, where configurations are.
pub fn check_on_orbit<T: Scalar, Q: Space<T>>(q: &Q, defect: T) -> Result<(), Error> {
    on_orbit(q, defect)
}

/// A place that a step has reached, where it is finite.
#[inline]
pub fn check_reached<T: Scalar, X: Space<T>>(x: X) -> Result<X, Error> {
    if x.is_finite() { Ok(x) } else { Err(Error::NotFinite { name: "the place after the step" }) }
}

/// Whether (q, N) is a state.
pub fn check_state<S: Clebsch>(system: &S, q: &S::Configuration, mu: &S::Momentum) -> Result<(), Error> {
    check_configuration(system, q)?;
    check_momentum(system, q, mu)
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

/// The shortest η with GᵀG η = Gᵀ(q⁺ − q).
#[inline]
pub fn displacement<T: Scalar, const M: usize>(metric: &SMatrix<T, M, M>, approach: &SVector<T, M>) -> SVector<T, M> {
    let mut displacement = *approach;
    for lane in 0..T::LANES {
        set_lane(&mut displacement, lane, &shortest(&lane_of(metric, lane), &lane_of(approach, lane)).0);
    }
    displacement
}

/// (a, b)
#[inline]
pub fn pair<T: Scalar, const M: usize, const D: usize>(a: &SVector<T, M>, b: &SVector<T, M>) -> SVector<T, D> {
    SVector::from_fn(|i, _| if i < M { a[i] } else { b[i - M] })
}

/// What separates a state from another: (Gᵀ(q* − q), N* − N) and (GᵀG, I).
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

/// The price of the end as a function of a place of which q is the first part.
pub fn endpoint<T: Scalar, const M: usize, const D: usize>(
    price: T,
    by_time: T,
    slope: &SVector<T, M>,
    curvature: &SMatrix<T, M, M>,
) -> EndpointExpansion<T, D> {
    EndpointExpansion { price, by_time, slope: extended(slope), curvature: extended(curvature) }
}

/// No price of the end.
pub fn no_endpoint<T: Scalar, const D: usize>() -> EndpointExpansion<T, D> {
    EndpointExpansion::none()
}

/// Bounds as functions of a place of which q is the first part.
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
        by_place: extended(by_motion),
        by_input,
        place_curvature: extended(motions),
        mixed_curvature: extended(mixed),
        input_curvature,
    }
}

/// A matrix with zeros to the right of it and below.
#[inline]
fn extended<T: Scalar, const R: usize, const C: usize, const R2: usize, const C2: usize>(
    a: &SMatrix<T, R, C>,
) -> SMatrix<T, R2, C2> {
    SMatrix::from_fn(|i, j| if i < R && j < C { a[(i, j)] } else { T::zero() })
}

/// A + B
#[inline]
fn plus<T: Scalar, const R: usize, const C: usize>(a: &SMatrix<T, R, C>, b: &SMatrix<T, R, C>) -> SMatrix<T, R, C> {
    SMatrix::from_fn(|i, j| a[(i, j)] + b[(i, j)])
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

/// A forced step between places (q, N), linearised by the implicit function theorem on F⁻ℓd(q, q⁺, u) = N and N⁺ = F⁺ℓd(q, q⁺, u).
///
/// With the costate (α, β) at (q⁺, N⁺), κ makes α·η′ + β·F⁺ℓd + κ·(F⁻ℓd − N) stationary in η′.
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
    pub fn new<const D: usize>(
        edge: &Carried<T, M>,
        before: &SMatrix<T, M, U>,
        after: &SMatrix<T, M, U>,
        costate: &SVector<T, D>,
    ) -> Option<Self> {
        let tangent = of_edge(edge)?;
        let motion_by_input = -times(&tangent.motion_by_momentum, before);
        let momentum_by_input = after + times(&edge.after_by_end, &motion_by_input);
        let beta = SVector::from_fn(|i, _| costate[M + i]);
        let alpha = SVector::<T, M>::from_fn(|i, _| costate[i]);
        let wanted = alpha + times(&edge.after_by_end.transpose(), &beta);
        let mut multiplier: [[T; 1]; M] = from_fn(|i| [wanted[i]]);
        eliminate(rows(&edge.before_by_end.transpose()), &mut multiplier)?;
        let multiplier = SVector::from_fn(|i, _| -multiplier[i][0]);
        let adjoint = edge.adjoint;
        Some(Self { costate: beta, driving: alpha, multiplier, adjoint, tangent, motion_by_input, momentum_by_input })
    }

    /// The step with its derivatives. `curvature` holds the second derivatives of β·F⁺ℓd + κ·F⁻ℓd along the motions η of q that leave F as
    /// it is, the motions ζ of q⁺ alone, and the inputs, W = 2M + U of them; `bracket` is ± ½ α·[E_i, E_j].
    pub fn expansion<X, const W: usize, const D: usize>(
        &self,
        next: X,
        curvature: &SMatrix<T, W, W>,
        bracket: &SMatrix<T, M, M>,
        price: &Price<T, M, U>,
    ) -> Expansion<X, T, D, U> {
        // ± ½ α·[Ad η, ζ]
        let turned = times(&self.adjoint.transpose(), bracket);
        let curvature = &SMatrix::<T, W, W>::from_fn(|i, j| match (i < M, j < M) {
            (true, false) if j < 2 * M => curvature[(i, j)] + turned[(i, j - M)],
            (false, true) if i < 2 * M => curvature[(i, j)] + turned[(j, i - M)],
            _ => curvature[(i, j)],
        });
        // how η, ζ and the inputs change with (η, ν) and with u
        let by_place = SMatrix::<T, W, D>::from_fn(|i, j| self.of_place(i, j));
        let by_input = SMatrix::<T, W, U>::from_fn(|i, j| self.of_input(i, j));
        let (bent_places, bent_inputs) = (times(curvature, &by_place), times(curvature, &by_input));
        let (places, inputs) = (by_place.transpose(), by_input.transpose());
        Expansion {
            next,
            by_place: SMatrix::from_fn(|i, j| self.tangent_entry(i, j)),
            by_input: SMatrix::from_fn(|i, j| match i < M {
                true => self.motion_by_input[(i, j)],
                false => self.momentum_by_input[(i - M, j)],
            }),
            price: price.price,
            price_by_place: extended(&price.by_motion),
            price_by_input: price.by_input,
            place_curvature: plus(&times(&places, &bent_places), &extended(&price.motions)),
            mixed_curvature: plus(&times(&inputs, &bent_places), &extended(&price.mixed)),
            input_curvature: plus(&times(&inputs, &bent_inputs), &price.inputs),
        }
    }

    /// ∂(η, ζ, u)_i/∂(η, ν)_j
    fn of_place(&self, i: usize, j: usize) -> T {
        match (i < M, i < 2 * M) {
            (true, _) if i == j => T::one(),
            (false, true) if j < M => self.tangent.motion_by_motion[(i - M, j)] - self.adjoint[(i - M, j)],
            (false, true) => self.tangent.motion_by_momentum[(i - M, j - M)],
            _ => T::zero(),
        }
    }

    /// ∂(η, ζ, u)_i/∂u_j
    fn of_input(&self, i: usize, j: usize) -> T {
        match (i < M, i < 2 * M) {
            (false, true) => self.motion_by_input[(i - M, j)],
            (false, false) if i - 2 * M == j => T::one(),
            _ => T::zero(),
        }
    }

    /// ∂(η′, N⁺)_i/∂(η, ν)_j
    fn tangent_entry(&self, i: usize, j: usize) -> T {
        let tangent = &self.tangent;
        match (i < M, j < M) {
            (true, true) => tangent.motion_by_motion[(i, j)],
            (true, false) => tangent.motion_by_momentum[(i, j - M)],
            (false, true) => tangent.momentum_by_motion[(i - M, j)],
            (false, false) => tangent.momentum_by_momentum[(i - M, j - M)],
        }
    }
}
