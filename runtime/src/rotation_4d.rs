//! The momentum equation of a rotating body in four dimensions by one scalar unknown.
//!
//! For the Cayley coordinates X of the rotation F = (1 + X)(1 − X)⁻¹, with AX = 2(JX + XJ), it is
//!
//! ```text
//! A X = M + M X − X M − X M X,    which is    M = F J − J Fᵀ
//! ```
//! The matrix B = F J obeys B² = M B + J². So its characteristic polynomial λ⁴ − e₁λ³ + e₂λ² − e₃λ + e₄ gives F = N⁻¹G:
//!
//! ```text
//! N = M³ + J²M + MJ² + e₂M − e₁(M² + J²) − e₃,    G = −(M² + J² − e₁M + e₂ + e₄J⁻²) J,    X = (G + N)⁻¹ (G − N)
//! ```
//! Here e₄ = det J. The others are those of J and of corrections δᵢ, which det(λ² − λM − J²) determines. δ₁ is the unknown:
//!
//! ```text
//! δ₂ = e₁(0) δ₁ + (δ₁² + Q₂)/2,    δ₃ = (2e₂(0) δ₂ + δ₂² − Q₄ − 2e₃(0) δ₁)/(2e₁)
//! 0 = g(δ₁) = 2e₄ δ₂ − 2e₃(0) δ₃ − δ₃² − Q₆,    g′ = −2H/e₁,    H = e₁e₂e₃ − e₃² − e₁²e₄
//! ```
//! Q₂ = |M|², Q₄ = Pf² − Σ m²(k_p + k_q) and Q₆ = Σ m² k_p k_q are sums over the planes. k_p and k_q are the squares of the
//! moments of the other two axes. No difference of nearly equal numbers occurs for short steps.
//!
//! Short steps need less: in principal axes the equation is X = S⁻¹((1 + |x|² + Pf²)M − 2(X²J − JX²)) − Pf ⋆X with SX = 2(JX + XJ).
//! Its iterations contract like h|ω|, and each takes less than a quarter of the operations above.
//!
//! The solution that is connected to the identity has all eigenvalues of B right of the imaginary axis. By Hurwitz's criterion
//! this is so where e₁, e₃ and H are positive. That polynomial is unique, so a root with H > 0 is the one.
//!
//! Source: J. Moser and A. P. Veselov, *Discrete versions of some classical integrable systems and factorization of matrix polynomials*,
//! Comm. Math. Phys. 139 (1991), for the factorization; the scalar equation is our own.

use crate::free_rotation::axes::Axes;
use crate::free_rotation_4d::flow::{
    Matrix, PLANES, Vector, above, above_of_square, at, dot, dual, entry, pfaffian, place, product, skew,
};
use crate::free_rotation_4d::mass;
use crate::free_rotation_4d::turn::{Powers, adjugate, equation};
use crate::implicit::{Equation, solve, solve_at_last};
use crate::linear::rows;
use crate::orientation::Orientation;
use crate::parameters::orientation_of_inertia;
use crate::rotation::unit_of;
use crate::{Error, Mask, Scalar, Space};
use nalgebra::{SMatrix, SVector};

/// The constants of all steps of one size of a body that rotates in four dimensions.
#[derive(Clone, Copy, Debug)]
pub struct RotatingBody4<T> {
    /// A power of two, times which A is of ordinary size.
    unit: T,
    /// A
    tensor: SMatrix<T, 6, 6>,
    moments: [T; 4],
    /// J²
    squares: [T; 4],
    /// e₁, e₂, e₃ and e₄ of J.
    invariants: [T; 4],
    planes: Planes<T>,
    axes: Axes<T, T, 4>,
    orientation: Orientation,
}

/// Numbers of each plane.
#[derive(Clone, Copy, Debug)]
struct Planes<T> {
    /// −1/(2(j_i + j_j)): δ₁ is the sum of these times m², but for terms of the fourth order.
    start: Vector<T>,
    /// (j_j − j_i)/(j_i + j_j)
    bends: Vector<T>,
    /// k_p + k_q of the other two axes.
    sums: Vector<T>,
    /// k_p k_q
    products: Vector<T>,
    /// 1 where the first of two axes has the larger moment, 0 where the second has it: its row of X is more exact.
    share: Vector<T>,
}

/// The momentum equation of a rotating body in four dimensions, or that of the body that turns back.
pub trait RotationEquation4<T: Scalar> {
    /// Whether the action is from the left: the equation is that of −x and −μ.
    const IS_LEFT: bool = false;

    /// The constants.
    fn body(&self) -> &RotatingBody4<T>;
}

/// Iterations of short steps. Where one leaves more than a 32nd of the change before, the scalar equation is cheaper.
const MOST_SWEEPS: u32 = 8;

/// Newton's steps for δ₁: each squares the error, and the start is right to the second order.
const MOST: u32 = 5;

/// Up to which ratio the sums of two moments may differ: the formulas lose the square of it.
const LARGEST_RATIO: i64 = 64;

impl<T: Scalar> RotatingBody4<T> {
    /// For a body with this inertia, A = Σ/`step`.
    ///
    /// # Errors
    /// [`Error::SingularKineticEnergy`] where a sum of two moments is 0.
    pub fn new(inertia: &SMatrix<T, 6, 6>, step: T) -> Result<Self, Error> {
        let per_step = inertia.map(|entry| entry / step);
        let unit = unit_of(Space::<T>::max_abs(&per_step));
        // backwards in time A is negative, and the equation that of −A and −μ
        let unit = T::select(per_step.trace().below(T::zero()), -unit, unit);
        let tensor = per_step.map(|entry| entry * unit);
        let orientation = orientation_of_inertia(&tensor, T::one())?;
        let (mut moments, mut axes): ([T; 4], _) = (Space::<T>::origin(), Axes::unset());
        for lane in 0..T::LANES {
            let (own, own_axes) = Axes::principal(&mass(&tensor.lane(lane)));
            moments.set_lane(lane, &own.into());
            axes.set_lane(lane, &own_axes);
        }
        let half = T::from_ratio(1, 2);
        let moments = usable(moments.map(|moment| moment * half));
        let squares = moments.map(|moment| moment * moment);
        let invariants = invariants(&moments);
        let planes = Planes::of(&moments, &squares);
        Ok(Self { unit, tensor, moments, squares, invariants, planes, axes, orientation })
    }
}

/// The moments; NaN where one is negative or they differ too much, as the formulas are of no use then.
fn usable<T: Scalar>(moments: [T; 4]) -> [T; 4] {
    let zero = T::zero();
    let sums = PLANES.map(|(i, j)| at(&moments, i) + at(&moments, j));
    let largest = sums.into_iter().fold(zero, |most, sum| T::select(most.below(sum), sum, most));
    let least = sums.into_iter().fold(largest, |least, sum| T::select(sum.below(least), sum, least));
    let usable = moments.into_iter().fold(T::Mask::everywhere(), |mask, moment| mask & zero.at_most(moment));
    let usable = usable & largest.at_most(T::from_ratio(LARGEST_RATIO, 1) * least);
    moments.map(|moment| T::select(usable, moment, T::from_f64(f64::NAN)))
}

/// The elementary symmetric functions.
fn invariants<T: Scalar>(&[a, b, c, d]: &[T; 4]) -> [T; 4] {
    let (ab, cd, a_b, c_d) = (a * b, c * d, a + b, c + d);
    [a_b + c_d, ab + cd + a_b * c_d, ab * c_d + cd * a_b, ab * cd]
}

/// A value for each plane, from its axes.
fn by_plane<T: Scalar>(value: impl Fn(usize, usize) -> T) -> SVector<T, 6> {
    SVector::from(PLANES.map(|(i, j)| value(i, j)))
}

/// The same from the other two axes. Those are the axes of the last plane but for it.
fn by_others<T: Scalar>(value: impl Fn(usize, usize) -> T) -> SVector<T, 6> {
    let mut values = by_plane(value);
    values.as_mut_slice().reverse();
    values
}

impl<T: Scalar> Planes<T> {
    fn of(moments: &[T; 4], squares: &[T; 4]) -> Self {
        let half = T::from_ratio(1, 2);
        Self {
            start: by_plane(|i, j| -half / (at(moments, i) + at(moments, j))),
            bends: by_plane(|i, j| (at(moments, j) - at(moments, i)) / (at(moments, i) + at(moments, j))),
            sums: by_others(|p, q| at(squares, p) + at(squares, q)),
            products: by_others(|p, q| at(squares, p) * at(squares, q)),
            share: by_plane(|i, j| T::select(at(moments, i).below(at(moments, j)), T::zero(), T::one())),
        }
    }
}

/// The Cayley coordinates of the rotation whose momentum is μ.
///
/// Work: three to eight iterations for short steps. Else one to five of Newton's steps for one scalar, and one system of four
/// equations. Where these do not decide, [`solve`](crate::implicit::solve) does.
///
/// # Errors
/// Those of [`solve`](crate::implicit::solve).
#[inline(always)]
pub fn solve_rotation_4d<T: Scalar, E: RotationEquation4<T>>(
    equation: &E,
    target: &Vector<T>,
) -> Result<Vector<T>, Error> {
    if T::DERIVATIVES > 0 {
        return solve(&Iterated(equation), target);
    }
    let body = equation.body();
    let unit = if E::IS_LEFT { -body.unit } else { body.unit };
    let (x, solved) = body.turn(&target.map(|entry| entry * unit));
    let x = if E::IS_LEFT { -x } else { x };
    if solved.all() { Ok(x) } else { at_last(equation, target, &x, solved) }
}

#[cold]
#[inline(never)]
fn at_last<T: Scalar, E: RotationEquation4<T>>(
    equation: &E,
    target: &Vector<T>,
    x: &Vector<T>,
    solved: T::Mask,
) -> Result<Vector<T>, Error> {
    let found = solve_at_last(&Iterated(equation), target, x, solved, MOST)?;
    // the lanes that are solved have the bits that they have alone
    Ok(SVector::from_fn(|i, _| T::select(solved, x[i], found[i])))
}

impl<T: Scalar> RotatingBody4<T> {
    /// The coordinates of the rotation, and in which lanes it is found.
    #[inline(always)]
    fn turn(&self, mu: &Vector<T>) -> (Vector<T>, T::Mask) {
        let momentum = self.in_principal_axes(mu);
        let (mut x, mut solved) = self.by_sweeps(&momentum);
        if !solved.all() {
            let (by_root, is_right) = self.by_root(&momentum);
            x = x.zip_map(&by_root, |swept, x| T::select(solved, swept, x));
            solved = solved | is_right;
        }
        (self.in_coordinates(&x), solved)
    }

    /// The entries of X by iterations of X ← S⁻¹((1 + |x|² + Pf²)M − 2(X²J − JX²)) − Pf ⋆X, SX = 2(JX + XJ), and in which lanes they
    /// have settled. Each leaves h|ω| of the error of the one before: short steps need three to six.
    #[inline(always)]
    fn by_sweeps(&self, momentum: &Vector<T>) -> (Vector<T>, T::Mask) {
        let first = -momentum.component_mul(&self.planes.start);
        let (mut x, mut before) = (first, square_of(&first));
        let (mut settled, mut open) = (T::Mask::nowhere(), T::Mask::everywhere());
        let rounding = T::EPSILON * T::EPSILON * T::from_ratio(1, 16);
        for _ in 0..MOST_SWEEPS {
            T::iterated();
            let (square, pf) = (square_of(&x), pfaffian(&x));
            let size = T::one() + (square + pf * pf);
            let bent = self.planes.bends.component_mul(&above_of_square(&x));
            let next = first * size - (bent + dual(&x) * pf);
            let change = next - x;
            let now = square_of(&change);
            x = x.zip_map(&next, |x, next| T::select(open, next, x));
            // the error is to this change as this change is to the one before
            let contracts = now.at_most(before * T::from_ratio(1, 1 << 10)) & square.below(T::from_ratio(1, 4));
            settled = settled | open & contracts & (now * now).at_most(rounding * (square * before));
            open = open & contracts & !settled;
            if !open.any() {
                break;
            }
            before = now;
        }
        (x, settled)
    }

    /// The entries of X by Newton's steps for δ₁.
    #[inline(never)]
    fn by_root(&self, momentum: &Vector<T>) -> (Vector<T>, T::Mask) {
        let powers = Powers::of(momentum);
        let [sums, products, start] = [&self.planes.sums, &self.planes.products, &self.planes.start]
            .map(|of_plane| dot(&powers.squares, of_plane));
        let integrals = [powers.square, powers.pf * powers.pf - sums, products];
        let (mut delta, mut solved, mut open) = (start, !T::Mask::everywhere(), T::Mask::everywhere());
        for _ in 0..MOST {
            T::iterated();
            let (correction, is_last) = self.correction(delta, &integrals);
            delta = T::select(open, delta + correction, delta);
            solved = solved | open & is_last;
            open = open & !is_last;
            if !open.any() {
                break;
            }
        }
        (self.rotation((momentum, &powers), &integrals, delta), solved)
    }

    /// δ₂ and δ₃
    #[inline(always)]
    fn others(&self, delta: T, [q2, q4, _]: &[T; 3]) -> (T, T) {
        let ([e1, e2, e3, _], half) = (self.invariants, T::from_ratio(1, 2));
        let second = e1 * delta + half * (delta * delta + *q2);
        let third = half * (second * (e2 + e2 + second) - *q4) - e3 * delta;
        (second, third / (e1 + delta))
    }

    /// Newton's correction of δ₁, and whether it is the last one of the right root.
    #[inline(always)]
    fn correction(&self, delta: T, integrals: &[T; 3]) -> (T, T::Mask) {
        let ([e1, e2, e3, e4], half) = (self.invariants, T::from_ratio(1, 2));
        let (second, third) = self.others(delta, integrals);
        let half_g = e4 * second - third * (e3 + half * third) - half * integrals[2];
        let (e1, e2, e3) = (e1 + delta, e2 + second, e3 + third);
        let hurwitz = e3 * (e1 * e2 - e3) - e1 * e1 * e4;
        let correction = half_g * e1 / hurwitz;
        // the next correction is at most the square of this one times (e₁e₃ + e₂²)e₁/H
        let next = correction * correction * (e1 * e3 + e2 * e2);
        let is_small = next.at_most(T::EPSILON * T::from_ratio(1, 4) * hurwitz);
        let is_right = T::zero().below(e1) & T::zero().below(e3) & T::zero().below(hurwitz);
        (correction, is_small & is_right)
    }

    /// X = (G + N)⁻¹ (G − N)
    #[inline(always)]
    fn rotation(&self, (m, powers): (&Vector<T>, &Powers<T>), integrals: &[T; 3], delta: T) -> Vector<T> {
        let ([e1, e2, e3, _], j, k) = (self.invariants, &self.moments, &self.squares);
        let (second, third) = self.others(delta, integrals);
        let e = [e1 + delta, e2 + second, e3 + third];
        let (n, g) = equation(j, k, &e, m, (&powers.of_square, powers.square, powers.pf));
        let entries = |combined: fn(T, T) -> T| -> Matrix<T> {
            core::array::from_fn(|i| core::array::from_fn(|j| combined(entry(&g, i, j), entry(&n, i, j))))
        };
        let (mut sum, mut difference) = (entries(|g, n| g + n), entries(|g, n| g - n));
        // those of G − N on the diagonal without the terms that cancel
        for i in 0..4 {
            difference[i][i] = powers.of_square.1[i] * (e[0] - j[i]) + (delta * k[i] - second * j[i] + third);
            sum[i][i] = n[i][i] + n[i][i] + difference[i][i];
        }
        let adjugate = adjugate(&sum);
        let term = |row: usize, k: usize, column: usize| entry(&adjugate, row, k) * entry(&difference, k, column);
        let of =
            |row, column| (term(row, 0, column) + term(row, 1, column)) + (term(row, 2, column) + term(row, 3, column));
        let determinant = (sum[0][0] * adjugate[0][0] + sum[0][1] * adjugate[1][0])
            + (sum[0][2] * adjugate[2][0] + sum[0][3] * adjugate[3][0]);
        let inverse = determinant.recip();
        SVector::from_fn(|index, _| {
            let ((row, column), share) = (PLANES[index % 6], self.planes.share[index % 6]);
            let other = of(column, row);
            inverse * (share * (of(row, column) + other) - other)
        })
    }

    /// The entries above the diagonal. Components are those below it.
    #[inline(always)]
    fn in_principal_axes(&self, mu: &Vector<T>) -> Vector<T> {
        match &self.axes {
            // columns, one after the other, are the rows of the transposed
            Axes::Principal(axes) => above(&product(&axes.data.0, &product(&skew(&-mu), &rows(axes)))),
            _ => -mu,
        }
    }

    #[inline(always)]
    fn in_coordinates(&self, x: &Vector<T>) -> Vector<T> {
        match &self.axes {
            Axes::Principal(axes) => -above(&product(&rows(axes), &product(&skew(x), &axes.data.0))),
            _ => -x,
        }
    }
}

/// The same equation for the solver that follows the path from the identity.
struct Iterated<'a, E>(&'a E);

impl<T: Scalar, E: RotationEquation4<T>> Equation<T, 6> for Iterated<'_, E> {
    type Terms = Vector<T>;
    type Jacobian = SMatrix<T, 6, 6>;

    fn prepare(&self, target: &Vector<T>) -> Vector<T> {
        target * if E::IS_LEFT { -self.0.body().unit } else { self.0.body().unit }
    }

    fn linearize(&self, mu: &Vector<T>, x: &Vector<T>) -> (Vector<T>, SMatrix<T, 6, 6>) {
        let a = self.0.body().tensor;
        // x of the body that turns back is −x
        let x = if E::IS_LEFT { -x } else { *x };
        let (m, of_x) = (skew(&-mu), skew(&-x));
        let (before, after) = (product(&of_x, &m), product(&m, &of_x));
        let turned = skew_part(&after) + skew_part(&product(&before, &of_x)) * -T::from_ratio(1, 2);
        let mut jacobian = a;
        for (index, &(row, column)) in PLANES.iter().enumerate() {
            let mut unit = [[T::zero(); 4]; 4];
            (*place(&mut unit, row, column), *place(&mut unit, column, row)) = (-T::one(), T::one());
            let commuted = skew_part(&product(&m, &unit));
            let carried = skew_part(&product(&unit, &after)) + skew_part(&product(&before, &unit));
            let change = commuted - carried * T::from_ratio(1, 2);
            jacobian.column_mut(index % 6).iter_mut().zip(change.iter()).for_each(|(entry, change)| *entry -= *change);
        }
        let residual = a * x - mu - turned;
        (if E::IS_LEFT { -residual } else { residual }, jacobian)
    }

    fn orientation(&self) -> Option<Orientation> {
        Some(self.0.body().orientation)
    }
}

/// |x|², in pairs: a short chain of operations.
#[inline(always)]
fn square_of<T: Scalar>(x: &Vector<T>) -> T {
    let [[a, b, c, d, e, f]] = x.data.0;
    ((a * a + b * b) + (c * c + d * d)) + (e * e + f * f)
}

/// The components of B − Bᵀ.
fn skew_part<T: Scalar>(b: &Matrix<T>) -> Vector<T> {
    SVector::from(PLANES.map(|(row, column)| entry(b, column, row) - entry(b, row, column)))
}

#[cfg(test)]
mod tests;
