//! Constraints A ξ = b on the velocity: violations, the momenta that obey them, and states from velocities.

pub(crate) mod edge;
pub(crate) mod link;

use crate::linear::entry;
use crate::parts::{F, Mu, Q, T};
use crate::space::larger;
use crate::{Clebsch, Declared, Error, Mask, Method, Scalar, Space};
use nalgebra::{SMatrix, SVector};
use num_traits::Zero;

/// A system whose velocities obey a constraint A ξ = b.
///
/// Implemented by `#[derive(Clebsch)]` where the declaration has the key `constraint`. See
/// [`Stepper::state_moving`](crate::Stepper::state_moving).
///
/// ```
/// use clebsch::{Clebsch, Constrained};
/// use nalgebra::Vector2;
///
/// /// A particle that a wheel guides: it moves along (1, x).
/// #[derive(Clebsch, Clone, Debug)]
/// #[clebsch(
///     action     = |a: Translation<2>, x: Vector2| x + a,
///     lagrangian = |v| self.mass * v.norm_squared() / 2,
///     constraint = |x, v| [v.y == x.x * v.x],
/// )]
/// struct Guided { mass: f64 }
///
/// let guided = Guided { mass: 2.0 };
/// let momentum = guided.momentum_of_velocity(0.0, &Vector2::zeros(), &Vector2::new(3.0, 0.0));
/// assert_eq!(momentum, Vector2::new(6.0, 0.0));
/// ```
#[diagnostic::on_unimplemented(message = "`{Self}` has no constraint")]
pub trait Constrained: Clebsch {
    /// One number for each scalar equation of the constraint, in the order of the declaration: a vector. In a list of
    /// closures those of places come first.
    type Reactions: Space<Self::Scalar>;

    /// The momentum of a velocity: ∂ℓ/∂ξ at (t, q, ξ), in the components of all factors.
    fn momentum_of_velocity(
        &self,
        t: Self::Scalar,
        q: &Self::Configuration,
        velocity: &Self::Momentum,
    ) -> Self::Momentum;
}

/// A system whose constraint pushes in the steps of the method M.
///
/// Implemented by `#[derive(Clebsch)]` where the declaration has the key `constraint`, for the declared dials and for
/// each method. See [`Stepper::reactions`](crate::Stepper::reactions).
///
/// ```
/// use clebsch::{Clebsch, Error, Method, Reacting, State, Stepper};
/// use nalgebra::Vector2;
///
/// /// A mass on an incline.
/// #[derive(Clebsch, Clone, Debug)]
/// #[clebsch(
///     action     = |a: Translation<2>, x: Vector2| x + a,
///     lagrangian = |v| self.mass * v.norm_squared() / 2,
///     potential  = |x| self.weight * x.y,
///     constraint = |x| [0.6 * x.y == 0.8 * x.x],
/// )]
/// struct Sliding { mass: f64, weight: f64 }
///
/// /// The reactions at the end of so many steps.
/// fn late<S: Reacting<M>, M: Method<S>>(by: &Stepper<S, M>, from: &State<S, M>) -> Result<S::Reactions, Error> {
///     by.reactions(&by.advance(from, 10)?)
/// }
///
/// let stepper = Sliding { mass: 2.0, weight: 5.0 }.into_stepper(0.1)?;
/// let start = stepper.state(Vector2::zeros(), Vector2::zeros())?;
/// assert!((late(&stepper, &start)?.x - 3.0).abs() < 1e-14); // 0.6 · 5 N, across the incline
/// # Ok::<(), Error>(())
/// ```
#[diagnostic::on_unimplemented(message = "`{Self}` has no constraint")]
pub trait Reacting<M: Method<Self> = Declared>: Constrained {
    /// The multipliers κ of a push p = Aᵀκ at (t, q): S⁻¹A Σ⁻¹p.
    #[doc(hidden)]
    fn multipliers(&self, c: &M::Constants, t: T<Self>, q: &Q<Self>, push: &Mu<Self>) -> Self::Reactions;

    /// The multipliers λ of the motion N′ = N′_free + Aᵀλ through (q, μ), with the input u of the forces.
    ///
    /// # Errors
    /// [`Error::DependentConstraints`] where the rows depend on each other.
    #[doc(hidden)]
    fn reactions_of_motion(
        &self,
        c: &M::Constants,
        t: T<Self>,
        q: &Q<Self>,
        mu: &Mu<Self>,
        u: &Self::Input,
    ) -> Result<Self::Reactions, Error>;
}

/// The violation of a constraint by a velocity.
#[derive(Clone, Copy, Debug)]
pub struct Violation<T> {
    /// The largest |A ξ − b|.
    pub largest: T,
    /// The largest √(S_ii N·ξ) + |b|, which A ξ and b can have for this kinetic energy.
    pub size: T,
}

impl<T: Scalar> Violation<T> {
    /// That of a system without a constraint.
    #[inline]
    pub fn none() -> Self {
        Self { largest: T::zero(), size: T::zero() }
    }

    /// Refuses a violation of more than √ε of that size.
    pub(crate) fn check(self) -> Result<(), Error> {
        let tolerance = T::EPSILON.sqrt() * self.size;
        within(self.largest, tolerance)
            .map_err(|[violation, tolerance]| Error::ConstraintViolated { violation, tolerance })
    }
}

/// Whether a violation is at most a tolerance in every lane, or both in the first lane where it is not. NaN is a violation.
pub(crate) fn within<T: Scalar>(violation: T, tolerance: T) -> Result<(), [f64; 2]> {
    (0..T::LANES).try_for_each(|lane| {
        let both = [violation.lane(lane), tolerance.lane(lane)];
        // the length of many of the largest numbers is beyond them
        if both[0] <= both[1] { Ok(()) } else { Err(both.map(|number| number.to_f64().min(f64::MAX))) }
    })
}

/// Whether φ(q) = 0. The rows are those of φ at q. The tolerance is √ε of the change of φ when q moves by 1 + |q|.
///
/// # Errors
/// [`Error::OffConstraint`].
pub fn check_place<T: Scalar, const R: usize, const M: usize>(
    places: &SVector<T, R>,
    rows: &SMatrix<T, R, M>,
    q: &impl Space<T>,
) -> Result<(), Error> {
    for i in 0..R {
        within(places[i].abs(), T::EPSILON.sqrt() * change(rows, i, q))
            .map_err(|[violation, tolerance]| Error::OffConstraint { violation, tolerance })?;
    }
    Ok(())
}

/// The data of a motion to φ = 0 at some configuration.
#[derive(Clone, Copy, Debug)]
pub struct Correction<T, const R: usize, const M: usize> {
    /// φ
    pub places: SVector<T, R>,
    /// A = J(q, ∂φ)
    pub rows: SMatrix<T, R, M>,
    /// S = A Σ⁻¹Aᵀ
    pub metric: SMatrix<T, R, R>,
    /// s Σ⁻¹Aᵀ
    pub moved: SMatrix<T, M, R>,
}

/// The corrections of a configuration, at most. Newton's method takes four from 10 % away on a sphere.
const CORRECTIONS: u32 = 32;

/// A configuration with φ = 0 next to q. Newton's method moves q by x = −s Σ⁻¹Aᵀ S⁻¹φ until φ no longer falls.
///
/// # Errors
/// [`Error::FarFromConstraint`], or [`Error::DependentConstraints`] where S is singular.
pub fn placed<S: Clebsch, const R: usize, const M: usize>(
    system: &S,
    q: &Q<S>,
    at: impl Fn(&Q<S>) -> Correction<T<S>, R, M>,
    element: impl Fn(&SVector<T<S>, M>) -> F<S>,
) -> Result<Q<S>, Error> {
    // of the change of φ when q moves by 1 + |q|: of rounding, and of states that are accepted
    let (rounding, most) = (T::<S>::EPSILON, T::<S>::EPSILON.sqrt());
    let half = T::<S>::from_f64(0.5);
    let (mut q, mut last) = (*q, T::<S>::zero());
    for number in 0..=CORRECTIONS {
        let Correction { places, rows, metric, moved } = at(&q);
        let mut violation = T::<S>::zero();
        for i in 0..R {
            violation = larger(violation, places[i].abs() / change(&rows, i, &q));
        }
        let has_stalled = violation.at_most(most) & (last * half).at_most(violation);
        let is_done = violation.at_most(rounding) | if number > 0 { has_stalled } else { Mask::nowhere() };
        if is_done.all() {
            return Ok(q);
        }
        if !places.all_finite() || number == CORRECTIONS {
            let violation = largest_number(&places);
            return Err(Error::FarFromConstraint { violation: violation.min(f64::MAX), corrections: number });
        }
        check_rank(&metric)?;
        last = violation;
        q = system.act(&element(&-(moved * multipliers(&metric, &places))), &q);
    }
    // by construction: the last pass of the loop returns
    Ok(q)
}

/// The largest number in all lanes, without those that are NaN.
fn largest_number<T: Scalar, const R: usize>(places: &SVector<T, R>) -> f64 {
    let in_lane = |lane| places.iter().fold(0.0, |sum: f64, place| sum.max(place.lane(lane).to_f64().abs()));
    (0..T::LANES).map(in_lane).fold(0.0, f64::max)
}

/// The change of φ_i when q moves by 1 + |q|.
fn change<T: Scalar, const R: usize, const M: usize>(rows: &SMatrix<T, R, M>, i: usize, q: &impl Space<T>) -> T {
    let row = rows.row(i).iter().fold(T::zero(), |sum, &entry| sum + entry.abs());
    (T::one() + q.max_abs()) * row
}

/// The violation of A ξ = b by the velocity ξ of the momentum μ.
///
/// # Errors
/// [`Error::DependentConstraints`] where S = A Σ⁻¹Aᵀ is singular.
pub fn violation<T: Scalar, const R: usize, const M: usize>(
    mu: &SVector<T, M>,
    a: &SMatrix<T, R, M>,
    velocity: &SVector<T, M>,
    b: &SVector<T, R>,
    metric: &SMatrix<T, R, R>,
) -> Result<Violation<T>, Error> {
    check_rank(metric)?;
    let twice_energy = mu.dot(velocity).abs();
    let moved = a * velocity;
    let mut violation = Violation::none();
    for i in 0..R {
        let size = (metric[(i, i)] * twice_energy).sqrt() + b[i].abs();
        violation.largest = larger(violation.largest, (moved[i] - b[i]).abs());
        violation.size = larger(violation.size, size);
    }
    Ok(violation)
}

/// μ + Aᵀκ with S κ = b − A ξ, where ξ is the velocity of μ.
///
/// # Errors
/// [`Error::DependentConstraints`] where S = A Σ⁻¹Aᵀ is singular.
pub fn constrained<T: Scalar, const R: usize, const M: usize>(
    mu: &SVector<T, M>,
    a: &SMatrix<T, R, M>,
    velocity: &SVector<T, M>,
    b: &SVector<T, R>,
    metric: &SMatrix<T, R, R>,
) -> Result<SVector<T, M>, Error> {
    check_rank(metric)?;
    let missing = b - a * velocity;
    // by construction: its rank was checked
    let Some(kappa) = crate::linear::solve_linear(metric, &missing) else { return Ok(*mu) };
    Ok(mu + a.transpose() * kappa)
}

/// κ of S κ = A Σ⁻¹p, the multipliers of a push p = Aᵀκ; NaN where S = A Σ⁻¹Aᵀ is singular.
pub fn multipliers<T: Scalar, const R: usize>(metric: &SMatrix<T, R, R>, along: &SVector<T, R>) -> SVector<T, R> {
    crate::linear::solve_linear(metric, along).unwrap_or_else(|| along.map(|_| T::zero() / T::zero()))
}

/// λ of S λ = −d/dt (A ξ − b) along the motion without the constraint.
///
/// # Errors
/// [`Error::DependentConstraints`] where S = A Σ⁻¹Aᵀ is singular.
pub fn reactions<T: Scalar, const R: usize>(
    metric: &SMatrix<T, R, R>,
    lag: &SVector<T, R>,
) -> Result<SVector<T, R>, Error> {
    check_rank(metric)?;
    Ok(multipliers(metric, lag))
}

/// The rank of a symmetric positive S, by pivots relative to its diagonal: √ε is zero.
///
/// # Errors
/// [`Error::DependentConstraints`] where it is not full in some lane.
fn check_rank<T: Scalar, const R: usize>(metric: &SMatrix<T, R, R>) -> Result<(), Error> {
    (0..T::LANES).try_for_each(|lane| {
        let rank = rank(metric.map(|entry| entry.lane(lane)));
        if rank == R { Ok(()) } else { Err(Error::DependentConstraints { rank, rows: R }) }
    })
}

/// The number of pivots of a symmetric positive matrix, scaled to ones on its diagonal, that are above √ε.
fn rank<T: Scalar, const R: usize>(metric: SMatrix<T, R, R>) -> usize {
    let root = |i: usize| metric[(i, i)].to_f64().max(0.0).sqrt();
    let mut scaled = [[0.0; R]; R];
    for (i, row) in scaled.iter_mut().enumerate() {
        for (j, entry) in row.iter_mut().enumerate() {
            let size = root(i) * root(j);
            *entry = if size > 0.0 { metric[(i, j)].to_f64() / size } else { 0.0 };
        }
    }
    let tolerance = T::EPSILON.to_f64().sqrt();
    let mut rank = 0;
    for _ in 0..R {
        let mut pivot = 0;
        for k in 0..R {
            if entry(&scaled, k, k) > entry(&scaled, pivot, pivot) {
                pivot = k;
            }
        }
        let largest = entry(&scaled, pivot, pivot);
        if largest.partial_cmp(&tolerance) != Some(core::cmp::Ordering::Greater) {
            break;
        }
        rank += 1;
        let mut row = [0.0; R];
        for (j, part) in row.iter_mut().enumerate() {
            *part = entry(&scaled, pivot, j) / largest;
        }
        for (i, line) in scaled.iter_mut().enumerate() {
            let factor = line.get(pivot).copied().unwrap_or(0.0);
            for (part, of_pivot) in line.iter_mut().zip(&row) {
                *part -= factor * of_pivot;
            }
            if i == pivot {
                line.fill(0.0);
            }
        }
    }
    rank
}

#[cfg(test)]
mod tests;
