//! The implicit equation of a step: ρ(ξ; μ) = 0 for the chart coordinates ξ of the group element F, given the momentum μ.
//!
//! [`solve`] first tries full Newton steps from the predictor, one to four linearisations for usual step sizes. Where these do not contract
//! cleanly, it follows the path from the identity with bounded work, until that arrives or turns back. In the latter case no solution is
//! connected to the identity. [`solve_linear_equation`] does without iteration where ρ is affine in ξ.
//!
//! Solves are inlined once, in the part of the step that calls them. The result of a call lies in memory, and small
//! steps would wait for it.

mod fixed_point;
mod jacobian;
mod lane;
mod linear_equation;
mod path;

pub(crate) use fixed_point::solve_at_last;
pub use fixed_point::solve_fixed_point;
pub use jacobian::Jacobian;
pub use linear_equation::{LinearEquation, solve_linear_equation};
pub use path::LINEARIZATIONS;

use crate::linear::Solution;
use crate::matrices::total;
use crate::orientation::Orientation;
use crate::space::larger;
use crate::{Error, Mask, Scalar, Space};
use nalgebra::SVector;

/// An implicit equation ρ(ξ; μ) = 0 for M unknowns ξ, given N components of momentum, the target μ.
///
/// ρ is affine in μ, and ξ = 0 solves it for μ = 0. So sμ with s from 0 to 1 leads from the identity to the solution.
/// Solves look for the solution on the branch that starts there. The branch ends where det Dρ changes its sign, as h or
/// s grows.
///
/// The momentum of the identity may not be 0, as for a cost with a potential of q and F together. It is then subtracted
/// from μ, and so from ρ.
///
/// ```
/// use clebsch::implicit::{Equation, solve};
/// use nalgebra::{Matrix1, Vector1};
///
/// /// ρ(ξ; μ) = ξ + ξ³ − μ
/// struct Cubic;
///
/// impl Equation<f64, 1> for Cubic {
///     type Terms = f64;
///     type Jacobian = Matrix1<f64>;
///
///     fn prepare(&self, target: &Vector1<f64>) -> f64 {
///         target.x
///     }
///
///     fn linearize(&self, mu: &f64, xi: &Vector1<f64>) -> (Vector1<f64>, Matrix1<f64>) {
///         let x = xi.x;
///         (Vector1::new(x + x * x * x - mu), Matrix1::new(1.0 + 3.0 * x * x))
///     }
/// }
///
/// assert_eq!(solve(&Cubic, &Vector1::new(10.0))?.x, 2.0);
/// # Ok::<(), clebsch::Error>(())
/// ```
pub trait Equation<T: Scalar, const M: usize, const N: usize = M> {
    /// Values that do not change during the iteration.
    type Terms;

    /// The form of Dρ(ξ): `SMatrix<T, M, M>`, or a form that is inverted faster.
    type Jacobian: Jacobian<T, M>;

    /// The terms for the target μ.
    fn prepare(&self, target: &SVector<T, N>) -> Self::Terms;

    /// A first approximation of ξ, best Σ⁻¹μ in the units of the chart; it should be 0 for μ = 0.
    ///
    /// The provided method answers 0, which asks [`solve`] for the first Newton correction from ξ = 0: for a Σ that is no constant.
    #[inline]
    fn predict(&self, _target: &SVector<T, N>) -> SVector<T, M> {
        SVector::from_element(T::zero())
    }

    /// The residual ρ(ξ) and its Jacobian Dρ(ξ), row i the derivatives of ρ_i.
    fn linearize(&self, terms: &Self::Terms, xi: &SVector<T, M>) -> (SVector<T, M>, Self::Jacobian);

    /// The residual ρ(ξ) alone, for [`solve_fixed_point`].
    #[inline]
    fn residual(&self, terms: &Self::Terms, xi: &SVector<T, M>) -> SVector<T, M> {
        self.linearize(terms, xi).0
    }

    /// Δ with Dρ Δ = ρ, and the sign of det Dρ; `None` where it is singular in all lanes.
    ///
    /// The provided method is [`Jacobian::solve`], for a matrix elimination with pivoting. Where the Jacobian is known to be symmetric or block triangular, answer with
    /// [`solve_symmetric`](crate::linear::solve_symmetric), or with one [`solve_dense`](crate::linear::solve_dense) for each block on its diagonal.
    #[inline(always)]
    fn correct(jacobian: &Self::Jacobian, residual: &SVector<T, M>) -> Solution<T, M> {
        jacobian.solve(residual)
    }

    /// The part of |ξ| below which a correction is not made.
    ///
    /// A quarter of ε by the provided method: the solution is then right to rounding. Larger ones, made by [`tolerance`], end it earlier.
    #[inline]
    fn tolerance() -> T {
        T::EPSILON * T::from_ratio(1, 4)
    }

    /// The most iterations of one solve, linearisations and residuals together.
    ///
    /// `None` by the provided method: the bounds of [`solve`] and [`solve_fixed_point`].
    #[inline]
    fn limit() -> Option<u32> {
        None
    }

    /// Whether ρ has poles in the chart, as where det(I + F) vanishes.
    ///
    /// `false` by the provided method. Near a pole a correction is as small as the distance to it, while the residual
    /// is as large as its inverse. If ρ has poles, [`solve`] also compares the residual of its result with that at the
    /// start.
    #[inline]
    fn has_poles() -> bool {
        false
    }

    /// The size of the places that ρ compares, 1 + |q|, in the units of ξ. A motion below ε times this is lost to their
    /// rounding. An equation without a predictor has it too where a constraint may take up all of μ.
    ///
    /// The provided method returns zero: then a small ξ is right to its own last digits.
    #[inline]
    fn extent(&self) -> T {
        T::zero()
    }

    /// The sign of det Dρ which every solution on the branch has; `None` where it is singular.
    ///
    /// The provided method makes one linearisation, at ξ = 0 and μ = 0. It is called in every solve, so a constant is
    /// best. Make one by [`orientation`], or answer with the sign of det Σ/h, which Dρ has there for short steps. A
    /// force or a potential in the cost may change this sign. The step is then too long: a solution that is not
    /// connected to those of short steps is refused.
    #[inline]
    fn orientation(&self) -> Option<Orientation> {
        at_identity(self)
    }
}

/// A part of |ξ| for [`Equation::tolerance`], no smaller than the rounding of T.
#[inline]
pub fn tolerance<T: Scalar>(part: f64) -> T {
    T::from_f64(part.max(T::Lane::EPSILON.to_f64() / 4.0))
}

/// 1 + |q|, for [`Equation::extent`].
#[inline]
pub fn extent<T: Scalar>(q: &impl Space<T>) -> T {
    T::one() + q.max_abs()
}

/// The sign of det Dρ at ξ = 0 and μ = 0, from a linearisation.
#[inline]
fn at_identity<T: Scalar, const M: usize, const N: usize, E: Equation<T, M, N> + ?Sized>(
    equation: &E,
) -> Option<Orientation> {
    let terms = equation.prepare(&SVector::from_element(T::zero()));
    let (_, jacobian) = equation.linearize(&terms, &SVector::from_element(T::zero()));
    jacobian.orientation()
}

/// The sign of det Dρ at the identity, computed without asking [`Equation::orientation`]: for the constant that answers it.
///
/// # Errors
/// [`Error::SingularKineticEnergy`] where Dρ is singular there.
pub fn orientation<T: Scalar, const M: usize, const N: usize>(
    equation: &impl Equation<T, M, N>,
) -> Result<Orientation, Error> {
    at_identity(equation).ok_or(Error::SingularKineticEnergy { condition: f64::INFINITY })
}

/// Newton steps that are tried before the path is followed. Each at least halves the correction and most square it.
const QUICK: u32 = 12;
/// How many times as large as that of the predictor a residual may be, where ρ has poles.
const FARTHEST: f64 = 1024.0;

/// How many of `most` iterations may be made after `spent` others.
#[inline]
fn allowed(most: u32, limit: Option<u32>, spent: u32) -> u32 {
    limit.map_or(most, |limit| most.min(limit.saturating_sub(spent)))
}

/// The solution ξ of ρ(ξ; `target`) = 0 that is connected to ξ = 0. Each lane has the result of a single number; lanes
/// without a solution are NaN.
///
/// Accuracy: the next correction of Newton's method is below [`Equation::tolerance`] of ξ, by default a quarter of a
/// unit in its last place. Otherwise the residual is round-off. It is always the latter where Newton's method alone
/// does not decide. Work: at most 12 linearisations, then at most [`LINEARIZATIONS`] more (ten to two hundred in
/// practice); in all not more than [`Equation::limit`].
///
/// # Errors
/// If no lane has a solution: [`Error::Unsolvable`] if no solution is connected to the identity, with the largest
/// fraction of `target` that has one. [`Error::NotFinite`] if `target` or the equation is not finite.
/// [`Error::NotConverged`] if the work was not enough.
#[inline(always)]
pub fn solve<T: Scalar, const M: usize, const N: usize>(
    equation: &impl Equation<T, M, N>,
    target: &SVector<T, N>,
) -> Result<SVector<T, M>, Error> {
    solve_after(equation, target, 0)
}

/// The same after `spent` iterations of another kind.
#[inline(always)]
fn solve_after<T: Scalar, E: Equation<T, M, N>, const M: usize, const N: usize>(
    equation: &E,
    target: &SVector<T, N>,
    spent: u32,
) -> Result<SVector<T, M>, Error> {
    let (xi, solved, made) = newton(equation, target, allowed(QUICK, E::limit(), spent));
    if !solved.all() {
        // a copy on the cold path only, as within the iteration
        let reached = xi;
        return lane::follow(equation, target, &reached, solved, spent + made);
    }
    Ok(if T::DERIVATIVES == 0 { xi } else { with_derivatives(equation, target, xi) })
}

/// Newton's method from the predictor: ξ, in which lanes it is the solution, and how many linearisations were made, at
/// most `most`. A lane stays as it is once it has arrived. A lane that does not contract cleanly, or leaves the branch,
/// is given up at once.
///
/// Near a solution the corrections obey |Δ_{k+1}| ≈ C|Δ_k|². With C from the last two, |Δ_k|³/|Δ_{k−1}|² would come next, and is not made if
/// it is negligible. The predictor counts as the correction of ξ = 0; where it is 0 the first correction is the predictor.
#[inline(always)]
fn newton<T: Scalar, E: Equation<T, M, N>, const M: usize, const N: usize>(
    equation: &E,
    target: &SVector<T, N>,
    most: u32,
) -> (SVector<T, M>, T::Mask, u32) {
    let (mut open, mut solved, mut made) = (T::Mask::everywhere(), T::Mask::nowhere(), 0);
    let mut xi = equation.predict(target);
    let Some(branch) = equation.orientation() else { return (xi, solved, made) };
    let terms = equation.prepare(target);
    let mut start = xi;
    let half = T::from_ratio(1, 2);
    let negligible = E::tolerance();
    let visible = larger(T::EPSILON, negligible);
    let mut predicted = size(&start);
    let (mut before, mut residual_before) = (predicted, xi);
    let mut farthest = T::zero();
    while made < most {
        T::iterated();
        made += 1;
        let (residual, jacobian) = equation.linearize(&terms, &xi);
        let Some((correction, orientation)) = E::correct(&jacobian, &residual) else { break };
        if orientation != branch {
            open = open & orientation.agrees::<T>(branch);
            if !open.any() {
                break;
            }
        }
        if E::has_poles() {
            farthest = if made == 1 { T::from_f64(FARTHEST) * size(&residual) } else { farthest };
            open = open & size(&residual).at_most(farthest);
            if !open.any() {
                break;
            }
        }
        let old = xi;
        xi = select(open, &(xi - correction), &xi);
        let (now, scale) = (size(&correction), size(&xi));
        // All comparisons are written so that NaN leads to no solution.
        let seen = open & now.at_most(visible * scale);
        (solved, open) = (solved | seen, open & !seen);
        if !open.any() {
            break;
        }
        let ratio = now / before;
        let unpredicted = open & predicted.equals(T::zero());
        if unpredicted.any() {
            start = select(unpredicted, &xi, &start);
            predicted = T::select(unpredicted, now, predicted);
        }
        let contracts = open & !unpredicted & ratio.at_most(half);
        if contracts.any() {
            let arrived = contracts & (now * ratio * ratio).at_most(negligible * scale);
            (solved, open) = (solved | arrived, open & !arrived);
            if !open.any() {
                break;
            }
        }
        let others = open & !unpredicted & !contracts;
        if made > 1 && others.any() {
            // copies on the cold path only: a value that is passed by reference lies in memory in every iteration
            let (rest, linear, from, rest_before) = (residual, jacobian, old, residual_before);
            let arrived =
                others & is_round_off(&rest, &linear, &[from, start, SVector::from_element(equation.extent())]);
            let strays = predicted.below(size(&(xi - start))) | !is_much_smaller::<T, M>(&rest, &rest_before);
            (solved, open) = (solved | arrived, open & !arrived & !(others & strays));
            if !open.any() {
                break;
            }
        }
        (before, residual_before) = (now, residual);
    }
    (xi, solved, made)
}

/// The same solution with its derivatives: each of Newton's corrections doubles the order to which they are right.
///
/// Source: Griewank and Walther, *Evaluating Derivatives*, 2nd edition, SIAM 2008, section 15.4.
#[inline(never)]
pub(crate) fn with_derivatives<T: Scalar, E: Equation<T, M, N>, const M: usize, const N: usize>(
    equation: &E,
    target: &SVector<T, N>,
    mut xi: SVector<T, M>,
) -> SVector<T, M> {
    let terms = equation.prepare(target);
    // a number without derivatives needs no correction, and `ilog2` of 0 is a panic
    for _ in 0..T::DERIVATIVES.checked_ilog2().map_or(0, |doublings| doublings + 1) {
        let (residual, jacobian) = equation.linearize(&terms, &xi);
        let Some((correction, _)) = E::correct(&jacobian, &residual) else { break };
        xi -= correction;
    }
    xi
}

/// The error of an iteration that leaves this residual, relative to that of ξ = 0.
#[cold]
fn not_converged<T: Scalar>(residual: T, iterations: u32) -> Error {
    if residual.is_finite() {
        return Error::NotConverged { residual: residual.to_f64(), iterations };
    }
    Error::NotFinite { name: "the implicit equation of the step" }
}

/// The entries of `yes` in the lanes of `mask`, those of `no` elsewhere.
#[inline]
fn select<T: Scalar, const M: usize>(mask: T::Mask, yes: &SVector<T, M>, no: &SVector<T, M>) -> SVector<T, M> {
    yes.zip_map(no, |yes, no| T::select(mask, yes, no))
}

/// Whether the residual is no more than the rounding of the terms that it is made of. Their sizes are those of motions
/// times |Dρ|: ξ for r(ξ), the predictor for μ, 1 + |q| for places. A constraint may take up all of μ. Then the solution
/// is zero, and the others are left.
#[cold]
fn is_round_off<T: Scalar, const M: usize>(
    residual: &SVector<T, M>,
    jacobian: &impl Jacobian<T, M>,
    terms: &[SVector<T, M>; 3],
) -> T::Mask {
    let terms = terms.iter().fold(T::zero(), |sum, term| sum + jacobian.size_of_terms(term));
    size(residual).at_most(T::from_f64(8.0) * T::EPSILON * terms)
}

/// Whether the residual shrank to less than a quarter: progress too, where corrections grow as stiff directions settle before soft ones.
#[cold]
fn is_much_smaller<T: Scalar, const M: usize>(residual: &SVector<T, M>, before: &SVector<T, M>) -> T::Mask {
    size(residual).at_most(T::from_ratio(1, 4) * size(before))
}

/// The sum of all |x_i|: NaN where one of them is.
#[inline]
fn size<T: Scalar, const M: usize>(vector: &SVector<T, M>) -> T {
    if M < LONG {
        return vector.iter().fold(T::zero(), |sum, x| sum + x.abs());
    }
    let mut sums = [T::zero(); 8];
    for entries in vector.as_slice().chunks(8) {
        sums.iter_mut().zip(entries).for_each(|(sum, x)| *sum += x.abs());
    }
    total(sums)
}

/// From as many unknowns on, a sum in which each waits for those before it takes longer than eight sums.
const LONG: usize = 16;

#[cfg(test)]
mod tests;
