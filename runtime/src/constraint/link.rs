//! A forced step with a constraint, linearised, with the data for its second derivatives.
//!
//! The step is that of an [edge with a constraint](super::edge). With the costate (α, β) at (q⁺, N⁺) its second derivatives are those of
//!
//! ```text
//! α·η′ + β̂·(F⁺ℓd + A⁺ᵀν) + ρ·(A⁺Σ⁻¹N⁺ − b) + κ·(F⁻ℓd − Aᵀλ − N) + σ·ψ
//! ```
//! where β̂ = Qᵀβ and ρ = −Pᵀβ at q⁺. With the multipliers κ̂ of the joined equation Q (F⁻ℓd − Aᵀλ − N) + P ψ = 0, κ = Qᵀκ̂ and σ = Pᵀκ̂.
//! This function is linear in λ, ν and N⁺. So besides its curvature along motions and inputs there are the products of the changes of these
//! with the motions.

use super::edge::{Balance, ConstrainedSubstep, Place, sides};
use crate::linear::divided;
use crate::matrices::embedded;
use crate::parts::Mu;
use crate::steered::{Link, Price};
use crate::tangent::times;
use crate::{BoundsExpansion, Carried, Ends, Expansion, Method, Scalar};
use nalgebra::{SMatrix, SVector};

/// The multipliers of a constraint in a step, and those of its equations in a price.
#[derive(Clone, Copy, Debug)]
pub struct Reactions<T, const M: usize, const R: usize> {
    /// λ, the multipliers at the start.
    pub lambda: SVector<T, R>,
    /// ν, the multipliers at the end.
    pub nu: SVector<T, R>,
    /// N⁺
    pub landed: SVector<T, M>,
    /// σ
    pub sigma: SVector<T, R>,
    /// ρ
    pub rho: SVector<T, R>,
}

/// A forced step with R equations of a constraint between places (q, N), where D = 2M.
#[derive(Clone, Copy, Debug)]
pub struct ConstrainedLink<T, const M: usize, const D: usize, const U: usize, const R: usize> {
    /// β̂
    pub costate: SVector<T, M>,
    /// α
    pub driving: SVector<T, M>,
    /// κ
    pub multiplier: SVector<T, M>,
    /// The constraint in the step.
    pub reactions: Reactions<T, M, R>,
    link: Link<T, M, U>,
    /// How λ and ν change with (η, ν) and with u.
    by_place: [SMatrix<T, R, D>; 2],
    by_input: [SMatrix<T, R, U>; 2],
    bend: ReactionBend<T, D, U>,
}

/// The part of second derivatives that is due to the changes of λ, ν and N⁺.
#[derive(Clone, Copy, Debug)]
struct ReactionBend<T, const D: usize, const U: usize> {
    places: SMatrix<T, D, D>,
    mixed: SMatrix<T, U, D>,
    inputs: SMatrix<T, U, U>,
}

impl<T: Scalar, const M: usize, const D: usize, const U: usize, const R: usize> ConstrainedLink<T, M, D, U, R> {
    /// The step from the momentum N over an edge of ℓd, with ∂F⁻ℓd/∂u and ∂F⁺ℓd/∂u, for a price with the slope ∂ℓ/∂η′. `None` where the
    /// step has no derivative.
    pub fn new<S, B, const P: usize>(
        system: &S,
        place: Place<'_, S, B>,
        (ends, mu): (Ends<'_, S>, &Mu<S>),
        edge: &Carried<T, M>,
        (before, after): (&SMatrix<T, M, U>, &SMatrix<T, M, U>),
        (costate, price): (&SVector<T, D>, &SVector<T, M>),
    ) -> Option<Self>
    where
        S: ConstrainedSubstep<0, M, R, P, B, Scalar = T>,
        B: Method<S>,
    {
        let sides = sides(system, place, ends, mu)?;
        let balance = sides.leaving.projection();
        let landed = sides.landing.of(after, &SMatrix::zeros());
        let link = Link::over(&sides.joined(edge), Some(balance), (before, &landed), costate, price)?;
        let reactions = Reactions {
            lambda: sides.multipliers[0],
            nu: sides.multipliers[1],
            landed: sides.momentum,
            sigma: times(&sides.leaving.lift.transpose(), &link.multiplier),
            rho: -times(&sides.landing.lift.transpose(), &link.costate),
        };
        let (motions, by_input): (SMatrix<T, D, D>, SMatrix<T, D, U>) = link.directions();
        // η′ = Ad η + ζ, and ζ
        let carried = |part: &SMatrix<T, M, M>| -> SMatrix<T, M, D> {
            embedded(&times(part, &edge.adjoint), 0, 0) + embedded(part, 0, M)
        };
        let along = |start: &SMatrix<T, M, M>, end: &SMatrix<T, M, M>| -> SMatrix<T, M, D> {
            embedded(start, 0, 0) + embedded(end, 0, M)
        };
        // Aᵀδλ = δF⁻ℓd − δ(Aᵀ)λ − δN
        let leaving = multipliers_of_push(&sides.start.rows, &sides.start.by_inertia)?;
        let push = along(&(edge.before - sides.start.push), &edge.before_by_end);
        let changed: SMatrix<T, M, D> = embedded(&SMatrix::<T, M, M>::identity(), 0, M);
        let lambda = times(&leaving, &(times(&push, &motions) - changed));
        let lambda_by_input = times(&leaving, &(times(&push, &by_input) + before));
        // Aᵀδν = δN⁺ − δF⁺ℓd − δ(Aᵀ)ν
        let landing = multipliers_of_push(&sides.end.rows, &sides.end.by_inertia)?;
        let push = along(&edge.after, &edge.after_by_end) + carried(&sides.end.push);
        let (momentum, momentum_by_input) = link.momentum::<D>();
        let nu = times(&landing, &(momentum - times(&push, &motions)));
        let nu_by_input = times(&landing, &(momentum_by_input - times(&push, &by_input) - after));
        Some(Self {
            costate: times(&sides.landing.projection().transpose(), &link.costate),
            driving: link.driving,
            multiplier: times(&balance.transpose(), &link.multiplier),
            reactions,
            link,
            by_place: [lambda, nu],
            by_input: [lambda_by_input, nu_by_input],
            bend: ReactionBend { places: SMatrix::zeros(), mixed: SMatrix::zeros(), inputs: SMatrix::zeros() },
        })
    }

    /// The same with the derivatives along the motions of both ends of the slopes with respect to λ, ν and N⁺; K = 2R + M.
    #[must_use]
    pub fn crossed<const K: usize>(self, slopes: &SMatrix<T, K, D>) -> Self {
        let Self { link, by_place: [lambda, nu], by_input: [lambda_by_input, nu_by_input], .. } = &self;
        let (motions, by_input): (SMatrix<T, D, D>, SMatrix<T, D, U>) = link.directions();
        let (momentum, momentum_by_input) = link.momentum::<D>();
        let places: SMatrix<T, K, D> = embedded(lambda, 0, 0) + embedded(nu, R, 0) + embedded(&momentum, 2 * R, 0);
        let inputs: SMatrix<T, K, U> =
            embedded(lambda_by_input, 0, 0) + embedded(nu_by_input, R, 0) + embedded(&momentum_by_input, 2 * R, 0);
        let (moved, moved_by_input) = (times(slopes, &motions), times(slopes, &by_input));
        let of_places = times(&places.transpose(), &moved);
        let of_inputs = times(&inputs.transpose(), &moved_by_input);
        let bend = ReactionBend {
            places: of_places + of_places.transpose(),
            mixed: times(&inputs.transpose(), &moved) + times(&moved_by_input.transpose(), &places),
            inputs: of_inputs + of_inputs.transpose(),
        };
        Self { bend, ..self }
    }

    /// [`Link::expansion`] with the constraint.
    pub fn expansion<X, const W: usize>(
        &self,
        next: X,
        curvature: &SMatrix<T, W, W>,
        bracket: &SMatrix<T, M, M>,
        price: &Price<T, M, U>,
    ) -> Expansion<X, T, D, U> {
        self.bent(self.link.expansion(next, curvature, bracket, price))
    }

    /// [`Link::expansion_of_edge`] with the constraint.
    pub fn expansion_of_edge<X, const W: usize>(
        &self,
        next: X,
        curvature: &SMatrix<T, W, W>,
        bracket: &SMatrix<T, M, M>,
        price: (T, &SVector<T, W>, &SMatrix<T, W, W>),
    ) -> Expansion<X, T, D, U> {
        self.bent(self.link.expansion_of_edge(next, curvature, bracket, price))
    }

    /// [`Link::bounds`] with the constraint.
    pub fn bounds<const W: usize, const C: usize>(
        &self,
        values: SVector<T, C>,
        slopes: &SMatrix<T, C, W>,
        curvature: &SMatrix<T, W, W>,
    ) -> BoundsExpansion<T, D, U, C> {
        let bounds = self.link.bounds(values, slopes, curvature);
        let ReactionBend { places, mixed, inputs } = &self.bend;
        BoundsExpansion {
            place_curvature: bounds.place_curvature + places,
            mixed_curvature: bounds.mixed_curvature + mixed,
            input_curvature: bounds.input_curvature + inputs,
            ..bounds
        }
    }

    fn bent<X>(&self, step: Expansion<X, T, D, U>) -> Expansion<X, T, D, U> {
        let ReactionBend { places, mixed, inputs } = &self.bend;
        Expansion {
            place_curvature: step.place_curvature + places,
            mixed_curvature: step.mixed_curvature + mixed,
            input_curvature: step.input_curvature + inputs,
            ..step
        }
    }
}

/// The projector to the changes (η, ν) of a state that a constraint allows at the end of a step from the time t. With the rows A′ of its K
/// equations on places, S′ = A′Σ⁻¹A′ᵀ, V = ∂(A Σ⁻¹N − b)/∂η and Q = I − AᵀS⁻¹A Σ⁻¹ it is
///
/// ```text
/// η ↦ Π η = η − Σ⁻¹A′ᵀS′⁻¹A′η,    (η, ν) ↦ Q ν − AᵀS⁻¹V Π η
/// ```
/// So A′η = 0 and V η + A Σ⁻¹ν = 0. `None` where rows depend on each other.
pub fn tangent_projector<S, B, const M: usize, const D: usize, const R: usize, const P: usize, const K: usize>(
    system: &S,
    c: &B::Constants,
    t: S::Scalar,
    (q, mu): &(S::Configuration, Mu<S>),
) -> Option<SMatrix<S::Scalar, D, D>>
where
    S: ConstrainedSubstep<0, M, R, P, B>,
    B: Method<S>,
{
    let end = system.at_end(c, t, q, mu, &SVector::zeros());
    let rows: SMatrix<S::Scalar, K, M> = embedded(&end.rows, 0, 0);
    let by_inertia: SMatrix<S::Scalar, K, M> = embedded(&end.by_inertia, 0, 0);
    let solved = divided(&times(&by_inertia, &rows.transpose()), &rows)?;
    let motions = SMatrix::identity() - times(&by_inertia.transpose(), &solved);
    let balance = Balance::new(&end.rows, &end.by_inertia)?;
    let carried = -times(&balance.lift, &times(&end.velocity, &motions));
    Some(embedded(&motions, 0, 0) + embedded(&carried, M, 0) + embedded(&balance.projection(), M, M))
}

/// The projectors to A′η = 0, in units of one by lengths, and to the momenta across Aᵀ. The force of the constraint changes none of these.
/// Both parts determine a state that obeys the constraint. A′ are the rows of the K equations on places. `None` where rows depend on each other.
pub fn independent<S, B, const M: usize, const D: usize, const R: usize, const P: usize, const K: usize>(
    system: &S,
    c: &B::Constants,
    t: S::Scalar,
    (q, mu): &(S::Configuration, Mu<S>),
    lengths: &SVector<S::Scalar, D>,
) -> Option<SMatrix<S::Scalar, D, D>>
where
    S: ConstrainedSubstep<0, M, R, P, B>,
    B: Method<S>,
{
    let rows = system.at_end(c, t, q, mu, &SVector::zeros()).rows;
    let mut on_places: SMatrix<S::Scalar, K, M> = embedded(&rows, 0, 0);
    for (mut column, length) in on_places.column_iter_mut().zip(lengths.iter()) {
        column.iter_mut().for_each(|entry| *entry /= *length);
    }
    Some(embedded(&across(&on_places)?, 0, 0) + embedded(&across(&rows)?, M, M))
}

/// I − Aᵀ(AAᵀ)⁻¹A, with rows of length one.
fn across<T: Scalar, const M: usize, const R: usize>(rows: &SMatrix<T, R, M>) -> Option<SMatrix<T, M, M>> {
    let mut rows = *rows;
    for mut row in rows.row_iter_mut() {
        let length = row.iter().fold(T::zero(), |sum, entry| sum + *entry * *entry).sqrt();
        row.iter_mut().for_each(|entry| *entry /= length);
    }
    let transposed = rows.transpose();
    let solved = divided(&times(&rows, &transposed), &rows)?;
    Some(SMatrix::identity() - times(&transposed, &solved))
}

/// S⁻¹A Σ⁻¹, the multipliers of a push Aᵀκ. `None` where rows depend on each other.
fn multipliers_of_push<T: Scalar, const M: usize, const R: usize>(
    rows: &SMatrix<T, R, M>,
    by_inertia: &SMatrix<T, R, M>,
) -> Option<SMatrix<T, R, M>> {
    divided(&times(by_inertia, &rows.transpose()), by_inertia)
}
