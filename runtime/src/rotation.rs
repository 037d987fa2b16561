//! The momentum equation of a rotating body, of whatever inertia, by one scalar unknown.
//!
//! For the Gibbs vector x = tan(θ/2) n of the rotation, with A = 2Σ/h for a step of the size h, it is
//!
//! ```text
//! A x = μ + (μ·x) x + μ × x
//! ```
//! With κ = μ·x it is linear in x, so that x = r/p with
//!
//! ```text
//! r = adj(A − κ) μ + |μ|² μ + (A μ) × μ,    p = det(A − κ) + μ·(A − κ) μ
//! 0 = f(κ) = κ⁴ − e₁κ³ + (e₂ + 2m) κ² − (e₃ + e₁m) κ + m² + μ·adj(A) μ,    m = |μ|²
//! ```
//! e_k are the elementary symmetric functions of A. The solution that is connected to the identity belongs to the least
//! root. There det Dρ = −f′(κ), so the branch ends where this root is double.
//!
//! Source: J. Moser and A. P. Veselov, *Discrete versions of some classical integrable systems and factorization of matrix polynomials*,
//! Comm. Math. Phys. 139 (1991), for the equation; that it is linear in x for a given κ is our own.
//!
//! f is positive at 0 and falls. As long as 3e₁κ ≤ e₂ + 2m it is convex on all of [0, κ], so a root that is found there
//! is the least one.
//!
//! The Cayley map has another equation, which is linear for another scalar: see [`cayley`].

use crate::implicit::{Equation, solve_at_last, with_derivatives};
use crate::linear::power_of_two_near;
use crate::matrices::hat;
use crate::orientation::Orientation;
use crate::parameters::orientation_of_inertia;
use crate::{Error, Mask, Scalar, Space};
use core::fmt::Debug;
use nalgebra::{SMatrix, SVector};

mod cayley;

type Vector<T> = SVector<T, 3>;

/// A symmetric tensor in the coordinates of a body.
pub trait Tensor<T: Scalar>: Copy + Debug {
    /// From its matrix.
    fn of(matrix: &SMatrix<T, 3, 3>) -> Self;
    /// A v
    fn times(&self, v: &Vector<T>) -> Vector<T>;
    /// Its matrix.
    fn matrix(&self) -> SMatrix<T, 3, 3>;
}

/// A diagonal tensor, in principal axes.
#[derive(Clone, Copy, Debug)]
pub struct Diagonal<T>([T; 3]);

/// Any symmetric tensor, by its diagonal and the entries 12, 02 and 01.
#[derive(Clone, Copy, Debug)]
pub struct Symmetric<T>([T; 3], [T; 3]);

impl<T: Scalar> Tensor<T> for Diagonal<T> {
    fn of(matrix: &SMatrix<T, 3, 3>) -> Self {
        let [[a, _, _], [_, b, _], [_, _, c]] = matrix.data.0;
        Self([a, b, c])
    }

    #[inline(always)]
    fn times(&self, v: &Vector<T>) -> Vector<T> {
        let ([a, b, c], [[x, y, z]]) = (self.0, v.data.0);
        SVector::from([a * x, b * y, c * z])
    }

    fn matrix(&self) -> SMatrix<T, 3, 3> {
        SMatrix::from_diagonal(&SVector::from(self.0))
    }
}

impl<T: Scalar> Tensor<T> for Symmetric<T> {
    fn of(matrix: &SMatrix<T, 3, 3>) -> Self {
        let [[a, w, v], [_, b, u], [_, _, c]] = matrix.data.0;
        Self([a, b, c], [u, v, w])
    }

    #[inline(always)]
    fn times(&self, v: &Vector<T>) -> Vector<T> {
        let (Self([a, b, c], [d, e, f]), [[x, y, z]]) = (*self, v.data.0);
        SVector::from([a * x + (f * y + e * z), b * y + (f * x + d * z), c * z + (e * x + d * y)])
    }

    fn matrix(&self) -> SMatrix<T, 3, 3> {
        let Self([a, b, c], [d, e, f]) = *self;
        SMatrix::from_data(nalgebra::ArrayStorage([[a, f, e], [f, b, d], [e, d, c]]))
    }
}

/// The constants of all steps of one size of a rotating body.
#[derive(Clone, Copy, Debug)]
pub struct RotatingBody<T, A> {
    /// A power of two, times which A is of ordinary size.
    unit: T,
    /// A
    tensor: A,
    /// adj A
    adjugate: A,
    /// e₁, e₂, e₃; NaN where A is not positive definite, as the root may then be another.
    invariants: [T; 3],
    /// e₁/e₃, e₂/e₃, 1/e₃
    per_determinant: [T; 3],
    /// Up to which sum of y and g the series for κ is enough.
    short: T,
    /// Twice the square of the deviator of A⁻¹, 4 (e₂² − 3e₁e₃)/(3e₃²).
    deviation: T,
    orientation: Orientation,
}

impl<T: Scalar, A: Tensor<T>> RotatingBody<T, A> {
    /// For a body with this inertia, A = Σ/`step`. The Gibbs vector of a short motion by the velocity ξ is `step` ξ.
    ///
    /// # Errors
    /// [`Error::SingularKineticEnergy`] where a moment is 0.
    pub fn new(inertia: &SMatrix<T, 3, 3>, step: T) -> Result<Self, Error> {
        let per_step = inertia.map(|entry| entry / step);
        let unit = unit_of(Space::<T>::max_abs(&per_step));
        // backwards in time A is negative, and the equation that of −A and −μ
        let unit = T::select(per_step.trace().below(T::zero()), -unit, unit);
        let a = per_step.map(|entry| entry * unit);
        let orientation = orientation_of_inertia(&a, T::one())?;
        let [x, y, z] = [a.column(0), a.column(1), a.column(2)];
        let adjugate = SMatrix::<T, 3, 3>::from_columns(&[y.cross(&z), z.cross(&x), x.cross(&y)]);
        let invariants = [a.trace(), adjugate.trace(), x.dot(&adjugate.column(0))];
        let zero = T::zero();
        let positive = invariants.iter().fold(T::Mask::everywhere(), |mask, e| mask & zero.below(*e));
        let nothing = T::from_f64(f64::NAN);
        let invariants = invariants.map(|e| T::select(positive, e, nothing));
        let [e1, e2, e3] = invariants;
        let per_determinant = [e1 / e3, e2 / e3, e3.recip()];
        let short = reach_of_series();
        let three = T::from_ratio(3, 1);
        let deviation = T::from_ratio(4, 3) * ((e2 * e2 - three * e1 * e3) / (e3 * e3));
        Ok(Self {
            unit,
            tensor: A::of(&a),
            adjugate: A::of(&adjugate),
            invariants,
            per_determinant,
            short,
            deviation,
            orientation,
        })
    }
}

/// The s with 42 s⁵ = ε/4, or a little less: the terms of the fourth order change x by less than a quarter of ε.
fn reach_of_series<T: Scalar>() -> T {
    let (mut reach, part) = (1.0_f64, T::Lane::EPSILON.to_f64() / 168.0);
    while reach * reach * reach * reach * reach > part {
        reach *= 0.96875;
    }
    T::from_f64(reach)
}

/// A power of two, times which `size` is about 1.
pub(crate) fn unit_of<T: Scalar>(size: T) -> T {
    let mut unit = power_of_two_near(size);
    let (one, two, half) = (T::one(), T::from_ratio(2, 1), T::from_ratio(1, 2));
    for _ in 0..16 {
        let scaled = size * unit;
        unit = T::select(scaled.below(half), unit * two, T::select(one.below(scaled), unit * half, unit));
    }
    unit
}

/// The momentum equation of a rotating body, A x = μ + (μ·x) x + μ × x. By the Cayley map it is (1 + |x|²) A x = μ + μ × x. It may be that of
/// the body that turns back.
pub trait RotationEquation<T: Scalar> {
    /// The form of A.
    type Tensor: Tensor<T>;

    /// Whether the action is from the left: − μ × x stands for + μ × x then, which is the equation of −x and −μ.
    const IS_LEFT: bool = false;

    /// Whether it is that of the Cayley map.
    const IS_CAYLEY: bool = false;

    /// The constants.
    fn body(&self) -> &RotatingBody<T, Self::Tensor>;
}

/// Newton's steps for κ after the series for short steps: each squares the error.
const MOST: u32 = 4;

/// A multiple (w, x) of the quaternion of the rotation whose momentum is μ: its Gibbs vector is x/w.
///
/// Work: a series for short steps, or one to four of Newton's steps for one scalar; by the Cayley map up to eight. Where these do not decide,
/// [`solve`](crate::implicit::solve) does.
///
/// # Errors
/// Those of [`solve`](crate::implicit::solve).
#[inline(always)]
pub fn turn_of_body<T: Scalar, E: RotationEquation<T>>(
    equation: &E,
    target: &Vector<T>,
) -> Result<(T, Vector<T>), Error> {
    let body = equation.body();
    let unit = if E::IS_LEFT { -body.unit } else { body.unit };
    let mu = target.map(|entry| entry * unit);
    let (w, x, solved, made) = if E::IS_CAYLEY { body.cayley_turn(&mu) } else { body.turn(&mu) };
    let x = if E::IS_LEFT { -x } else { x };
    if !solved.all() || T::DERIVATIVES > 0 {
        let (reached, scale) = (x, w);
        let found = at_last(equation, target, &(reached * scale.recip()), (solved, made))?;
        if T::DERIVATIVES > 0 {
            return Ok((T::one(), found));
        }
        // the lanes that are solved have the bits that they have alone
        let x = SVector::from_fn(|i, _| T::select(solved, reached[i], found[i]));
        return Ok((T::select(solved, scale, T::one()), x));
    }
    Ok((w, x))
}

/// The Gibbs vector of the rotation whose momentum is μ, as by [`turn_of_body`].
///
/// # Errors
/// Those of [`solve`](crate::implicit::solve).
#[inline(always)]
pub fn solve_rotation<T: Scalar, E: RotationEquation<T>>(equation: &E, target: &Vector<T>) -> Result<Vector<T>, Error> {
    turn_of_body(equation, target).map(|(w, x)| x * w.recip())
}

/// The sum of the moments times that of their reciprocals, up to which a free motion keeps its κ.
/// The rounding of a κ that is carried along moves a step by the square of the ratio of the moments. That of a new one moves it by the ratio.
const SLENDER: i64 = 1000;

/// κ of a free motion, which stays the same as the momentum moves with the body. It is 0 where there is none, or the body is slender.
/// The Cayley map has no such κ.
pub fn scalar_of_motion<T: Scalar, E: RotationEquation<T>>(equation: &E, target: &Vector<T>) -> T {
    let body = equation.body();
    let ([e1, ..], [_, reciprocals, _]) = (body.invariants, body.per_determinant);
    let kappa = |x: Vector<T>| {
        let kappa = dot(&target.map(|entry| entry * body.unit), &x);
        let is_slender = T::from_ratio(SLENDER, 1).below(e1 * reciprocals);
        T::select(kappa.finite() & !is_slender, kappa, T::zero())
    };
    solve_rotation(equation, target).map_or(T::zero(), kappa)
}

/// As [`turn_of_body`], where κ is known: no iteration.
#[inline(always)]
pub fn turn_of_motion<T: Scalar, E: RotationEquation<T>>(
    equation: &E,
    kappa: T,
    target: &Vector<T>,
) -> Result<(T, Vector<T>), Error> {
    let known = !kappa.equals(T::zero());
    if !known.all() {
        return turn_of_others(equation, (kappa, known), target);
    }
    let body = equation.body();
    let unit = if E::IS_LEFT { -body.unit } else { body.unit };
    let (w, x) = body.polynomials(&target.map(|entry| entry * unit)).turn(kappa);
    Ok((w, if E::IS_LEFT { -x } else { x }))
}

/// The same where some lanes have no κ: these are solved, or say why they cannot be.
#[cold]
#[inline(never)]
fn turn_of_others<T: Scalar, E: RotationEquation<T>>(
    equation: &E,
    (kappa, known): (T, T::Mask),
    target: &Vector<T>,
) -> Result<(T, Vector<T>), Error> {
    let (w, x) = turn_of_body(equation, target)?;
    let body = equation.body();
    let unit = if E::IS_LEFT { -body.unit } else { body.unit };
    let (own_w, own) = body.polynomials(&target.map(|entry| entry * unit)).turn(kappa);
    let own = if E::IS_LEFT { -own } else { own };
    Ok((T::select(known, own_w, w), SVector::from_fn(|i, _| T::select(known, own[i], x[i]))))
}

/// As [`solve_rotation`], where κ is known.
#[inline(always)]
pub fn rotation_of_motion<T: Scalar, E: RotationEquation<T>>(
    equation: &E,
    kappa: T,
    target: &Vector<T>,
) -> Result<Vector<T>, Error> {
    turn_of_motion(equation, kappa, target).map(|(w, x)| x * w.recip())
}

#[cold]
#[inline(never)]
fn at_last<T: Scalar, E: RotationEquation<T>>(
    equation: &E,
    target: &Vector<T>,
    xi: &Vector<T>,
    (solved, made): (T::Mask, u32),
) -> Result<Vector<T>, Error> {
    let equation = Iterated(equation);
    if solved.all() {
        return Ok(with_derivatives(&equation, target, *xi));
    }
    solve_at_last(&equation, target, xi, solved, made)
}

/// The polynomials of one momentum: f, r and p, by their coefficients.
struct Polynomials<T> {
    /// f(κ) = c₀ − c₁κ + c₂κ² − e₁κ³ + κ⁴
    c: [T; 3],
    e1: T,
    /// p(κ) = p₀ − p₁κ + e₁κ² − κ³
    p: [T; 2],
    /// r(κ) = r₀ + r₁κ + μκ²
    r: [Vector<T>; 2],
    mu: Vector<T>,
}

impl<T: Scalar, A: Tensor<T>> RotatingBody<T, A> {
    /// det A
    fn determinant(&self) -> T {
        self.tensor.matrix().column(0).dot(&self.adjugate.matrix().column(0))
    }

    #[inline(always)]
    fn polynomials(&self, mu: &Vector<T>) -> Polynomials<T> {
        let [e1, e2, e3] = self.invariants;
        let (image, adjugate) = (self.tensor.times(mu), self.adjugate.times(mu));
        let ([[x, y, z]], [[a, b, c]], [[d, e, f]]) = (mu.data.0, image.data.0, adjugate.data.0);
        let m = dot(mu, mu);
        let constant = |mu: T, adjugate: T, turned: T| adjugate + m * mu + turned;
        let slope = |mu: T, image: T| image - e1 * mu;
        let r0 = [constant(x, d, b * z - c * y), constant(y, e, c * x - a * z), constant(z, f, a * y - b * x)];
        Polynomials {
            c: [m * m + dot(mu, &adjugate), e3 + e1 * m, e2 + (m + m)],
            e1,
            p: [e3 + dot(mu, &image), e2 + m],
            r: [SVector::from(r0), SVector::from([slope(x, a), slope(y, b), slope(z, c)])],
            mu: *mu,
        }
    }

    /// A multiple (p, r) of the quaternion, in which lanes it is found, and by how many of Newton's steps.
    #[inline(always)]
    fn turn(&self, mu: &Vector<T>) -> (T, Vector<T>, T::Mask, u32) {
        let polynomials = self.polynomials(mu);
        let (mut kappa, is_short) = self.series(mu, &polynomials);
        let (mut w, mut x) = polynomials.turn(kappa);
        let (mut solved, mut open, mut made) = (is_short, !is_short, 0);
        if !open.any() {
            return (w, x, solved, made);
        }
        while made < MOST {
            T::iterated();
            made += 1;
            let (correction, is_last) = polynomials.correction(kappa);
            // the same as at κ + δ but for δ², which is below rounding with the last correction
            let (at, slope) = (polynomials.turn(kappa), polynomials.slope_of_turn(kappa));
            w = T::select(open, at.0 + correction * slope.0, w);
            x = SVector::from_fn(|i, _| T::select(open, at.1[i] + correction * slope.1[i], x[i]));
            kappa = T::select(open, kappa + correction, kappa);
            // f is convex from 0 to κ: this is the least root
            let is_least = (T::from_ratio(3, 1) * polynomials.e1 * kappa).at_most(polynomials.c[2]);
            solved = solved | open & is_last & is_least;
            open = open & !is_last;
            if !open.any() {
                break;
            }
        }
        (w, x, solved, made)
    }

    /// κ = s t by its power series in y = e₂s/e₃ and g = e₁m/e₃, s = c₀/e₃, to third order, and whether that is enough.
    #[inline(always)]
    fn series(&self, mu: &Vector<T>, polynomials: &Polynomials<T>) -> (T, T::Mask) {
        let [e1, e2, one] = self.per_determinant;
        let m = dot(mu, mu);
        let s = polynomials.c[0] * one;
        let (y, g, w) = (e2 * s, e1 * m, e1 * s * s);
        let z = (m + m) * one * s;
        let (t1, b) = (y - g, y + y - g);
        let t2 = t1 * b + (z - w);
        let t3 = t2 * b + (t1 * (y * t1 + (z + z - T::from_ratio(3, 1) * w)) + s * s * s * one);
        (s * (T::one() + t1 + t2 + t3), (y + g).at_most(self.short))
    }
}

impl<T: Scalar> Polynomials<T> {
    /// Newton's correction of κ, and whether the next one would be below a quarter of ε of x.
    #[inline(always)]
    fn correction(&self, kappa: T) -> (T, T::Mask) {
        let ([c0, c1, c2], e1) = (self.c, self.e1);
        let square = kappa * kappa;
        let f = (c0 - c1 * kappa) + square * (c2 - kappa * (e1 - kappa));
        let [three, four] = [T::from_ratio(3, 1), T::from_ratio(4, 1)];
        let slope = (c1 - (c2 + c2) * kappa) + square * (three * e1 - four * kappa);
        let correction = f / slope;
        let next = c2 * correction;
        // |x| changes by e₂/e₃ of a change of κ, or less
        (correction, (next * next).at_most(T::EPSILON * T::from_ratio(1, 4) * c1 * slope))
    }

    /// p(κ) and r(κ)
    #[inline(always)]
    fn turn(&self, kappa: T) -> (T, Vector<T>) {
        let ([p0, p1], [r0, r1]) = (self.p, &self.r);
        let r = SVector::from_fn(|i, _| r0[i] + kappa * (r1[i] + kappa * self.mu[i]));
        (p0 - kappa * (p1 - kappa * (self.e1 - kappa)), r)
    }

    /// p′(κ) and r′(κ)
    #[inline(always)]
    fn slope_of_turn(&self, kappa: T) -> (T, Vector<T>) {
        let (twice, three) = (kappa + kappa, T::from_ratio(3, 1));
        let r = SVector::from_fn(|i, _| self.r[1][i] + twice * self.mu[i]);
        (self.e1 * twice - self.p[1] - three * kappa * kappa, r)
    }
}

#[inline(always)]
fn dot<T: Scalar>(a: &Vector<T>, b: &Vector<T>) -> T {
    let ([[a, b, c]], [[x, y, z]]) = (a.data.0, b.data.0);
    a * x + (b * y + c * z)
}

/// The same equation for the solver that follows the path from the identity.
struct Iterated<'a, E>(&'a E);

impl<T: Scalar, E: RotationEquation<T>> Equation<T, 3> for Iterated<'_, E> {
    type Terms = Vector<T>;
    type Jacobian = SMatrix<T, 3, 3>;

    fn prepare(&self, target: &Vector<T>) -> Vector<T> {
        target * if E::IS_LEFT { -self.0.body().unit } else { self.0.body().unit }
    }

    fn predict(&self, target: &Vector<T>) -> Vector<T> {
        let body = self.0.body();
        body.adjugate.times(&(target * body.unit)) / body.determinant()
    }

    fn linearize(&self, mu: &Vector<T>, x: &Vector<T>) -> (Vector<T>, SMatrix<T, 3, 3>) {
        let a = self.0.body().tensor.matrix();
        // x of the body that turns back is −x
        let x = if E::IS_LEFT { -x } else { *x };
        let image = a * x;
        let (residual, jacobian) = if E::IS_CAYLEY {
            // the momentum of x less μ: Newton's method goes farther than from (1 + |x|²) A x − μ − μ × x
            let along = dot(&x, &image);
            let turned = hat(&x) * a - hat(&image);
            let jacobian = a + turned + SMatrix::identity() * along + x * (image + image).transpose();
            (image + x.cross(&image) + x * along - mu, jacobian)
        } else {
            let kappa = dot(mu, &x);
            let jacobian = a - SMatrix::identity() * kappa - x * mu.transpose() - hat(mu);
            (image - mu - x * kappa - mu.cross(&x), jacobian)
        };
        (if E::IS_LEFT { -residual } else { residual }, jacobian)
    }

    fn orientation(&self) -> Option<Orientation> {
        Some(self.0.body().orientation)
    }
}

#[cfg(test)]
mod tests;
