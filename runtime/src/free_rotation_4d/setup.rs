//! The constants of a motion, from its Taylor series.

use super::flow::{Matrix, Moved, PLANES, Vector, at, dot, dual, entry, flow, pfaffian, product, skew};
use crate::stumpff::stumpff;
use crate::{Real, Scalar, Space};
use nalgebra::SVector;

/// The fields of [`Constants`], in their order.
pub type Numbers<T> = (T, T, T, [T; 4], [T; 3], [[T; 3]; 3], [T; 2], [T; 4]);

/// The constants of a motion with m = h̃M.
#[derive(Clone, Copy, Debug)]
pub(super) struct Constants<T> {
    /// The number of equal parts of the time; 0 for a motion that has none of these constants.
    pub parts: T,
    /// 1 where each part is a Taylor series, as none of the constants below was found; else 0.
    pub by_series: T,
    /// h̃ of a part.
    pub step: T,
    /// J̃
    pub moments: [T; 4],
    /// e₁, e₂ and e₃ at m = 0, and their slopes by the [`integrals`].
    pub origin: [T; 3],
    pub slopes: [[T; 3]; 3],
    /// 1/(|m|² ± 2 Pf m), or 0 where that vanishes.
    pub casimirs: [T; 2],
    /// exp(δM + κ⋆M) − I = a + b m + c ⋆m + d (m² + |m|²/2).
    pub turn: [T; 4],
}

impl<T: Scalar> Constants<T> {
    #[inline]
    pub fn read(&(parts, by_series, step, moments, origin, slopes, casimirs, turn): &Numbers<T>) -> Self {
        Self { parts, by_series, step, moments, origin, slopes, casimirs, turn }
    }

    pub fn write(&self) -> Numbers<T> {
        let Self { parts, by_series, step, moments, origin, slopes, casimirs, turn } = *self;
        (parts, by_series, step, moments, origin, slopes, casimirs, turn)
    }
}

impl<T: Real> Constants<T> {
    /// Whether `parts` is a number of parts that a motion can have.
    pub fn are_of_parts(&self) -> bool {
        let parts = self.parts.to_f64();
        (1..=super::PARTS).contains(&(parts as u32)) && f64::from(parts as u32) == parts
    }
}

/// Σm², Pf² − Σ m_ij²(k_p + k_q) and Σ m_ij² k_p k_q, where p and q are the indices other than i and j. det(λ² − λm −
/// K) depends on these.
#[inline]
pub(super) fn integrals<T: Scalar>(k: &[T; 4], squares: &Vector<T>, pfaffian: T) -> [T; 3] {
    let [a, b, c, d] = *k;
    let sums = [c + d, b + d, b + c, a + d, a + c, a + b];
    let products = [c * d, b * d, b * c, a * d, a * c, a * b];
    let whole = (squares[0] + squares[1]) + (squares[2] + squares[3]) + (squares[4] + squares[5]);
    [whole, pfaffian * pfaffian - dot(squares, &sums), dot(squares, &products)]
}

/// The constants of the free motion with the momentum `momentum` over the time 1 of a body with ΣΩ = DΩ + ΩD. `None` if
/// they are not found, or if the formulas with them give another motion.
#[cold]
pub(super) fn set_up<T: Real>(d: &[T; 4], momentum: &Vector<T>) -> Option<Constants<T>> {
    let exact = flow(|m| velocity(d, m), momentum)?;
    let mut motion = exact.0;
    (0..4).for_each(|i| motion[i][i] += T::one());
    let fitted = Fit { d, momentum, motion: &motion }.fit()?;
    let [_, step, delta, kappa] = fitted.unknowns;
    let moments = fitted.moments;
    let m = momentum * step;
    let k = moments.map(|j| j * j);
    let squares = m.component_mul(&m);
    let (pf, square) = (pfaffian(&m), dot(&m, &m));
    let here = integrals(&k, &squares, pf);
    let e = characteristic(&moments, &fitted.motion, &k, &here)?;
    let slopes = slopes(&e, last(&moments))?;
    let [[a, b, c], [p, q, r]] = [e, slopes.map(|slopes| dot(&slopes, &here))];
    let origin = [a - p, b - q, c - r];
    let two = T::from_f64(2.0);
    let least = T::from_f64(1e4) * T::EPSILON * square;
    let casimirs = [square + two * pf, square - two * pf].map(|c| if c > least { c.recip() } else { T::zero() });
    let turn = turn([delta / step, kappa / step], square, pf);
    let constants = Constants { parts: T::one(), by_series: T::zero(), step, moments, origin, slopes, casimirs, turn };
    let is_right = Space::<T>::all_finite(&constants.write()) && reproduces(&constants, momentum, &exact);
    is_right.then_some(constants)
}

/// Whether the formulas with these constants agree with the Taylor series of the motion. A small residual is not enough:
/// if moments differ by orders of magnitude, the formulas lose the squares of small ones.
fn reproduces<T: Real>(constants: &Constants<T>, momentum: &Vector<T>, (increment, end): &Moved<T>) -> bool {
    let Some((turned, next)) = super::turn::turn(constants, &(momentum * constants.step)) else { return false };
    let next = next / constants.step;
    let error: Matrix<T> =
        core::array::from_fn(|i| core::array::from_fn(|j| entry(&turned, i, j) - entry(increment, i, j)));
    let tolerance = T::from_ratio(super::turn::LARGEST_LOSS, 1) * T::EPSILON;
    Space::<T>::all_finite(&next)
        && error.max_abs() <= tolerance * increment.max_abs()
        && (next - end).max_abs() <= tolerance * end.max_abs()
}

/// Ω of M = DΩ + ΩD.
#[inline]
pub(super) fn velocity<T: Scalar>(d: &[T; 4], m: &Vector<T>) -> Vector<T> {
    let [p, q, r, s] = *d;
    m.component_div(&SVector::from([p + q, p + r, p + s, q + r, q + s, r + s]))
}

/// The coefficients of exp(δm + κ⋆m) − I, by the two factors of a rotation in four dimensions, which commute.
fn turn<T: Real>([delta, kappa]: [T; 2], square: T, pf: T) -> [T; 4] {
    let (half, quarter, two) = (T::from_ratio(1, 2), T::from_ratio(1, 4), T::from_f64(2.0));
    let (left, right) = (delta + kappa, delta - kappa);
    let angle = |rate: T, sign: T| rate * rate * quarter * (square + sign * two * pf);
    let (p, q) = (angle(left, T::one()), angle(right, -T::one()));
    // cos − 1
    let (versine, other) = (-p * stumpff(2, p), -q * stumpff(2, q));
    let (sine, sine_other) = (stumpff(1, p), stumpff(1, q));
    let along = (versine + T::one()) * sine_other * right;
    let of_left = (other + T::one()) * sine * left;
    [
        versine + other + versine * other,
        half * (of_left + along),
        half * (of_left - along),
        half * sine * sine_other * left * right,
    ]
}

/// e₁, e₂ and e₃ of A = F̃J̃, as its integrals ask for to the last place.
fn characteristic<T: Real>(moments: &[T; 4], motion: &Matrix<T>, k: &[T; 4], here: &[T; 3]) -> Option<[T; 3]> {
    let a: Matrix<T> = core::array::from_fn(|i| core::array::from_fn(|j| entry(motion, i, j) * at(moments, j)));
    let trace = |a: &Matrix<T>| a[0][0] + a[1][1] + a[2][2] + a[3][3];
    let square = product(&a, &a);
    let (first, second, third) = (trace(&a), trace(&square), trace(&product(&square, &a)));
    let half = T::from_ratio(1, 2);
    let mut e = [first, half * (first * first - second), T::zero()];
    e[2] = T::from_ratio(1, 3) * (e[1] * first - e[0] * second + third);
    let two = T::from_f64(2.0);
    let last = last(moments);
    let [a, b, c, d] = *k;
    let sum = a + b + c + d;
    let pairs = a * b + a * c + a * d + b * c + b * d + c * d;
    let triples = a * b * c + a * b * d + a * c * d + b * c * d;
    let wanted = [here[0] - sum, pairs + here[1], here[2] - triples];
    for _ in 0..3 {
        let found =
            [two * e[1] - e[0] * e[0], e[1] * e[1] + two * last - two * e[0] * e[2], two * e[1] * last - e[2] * e[2]];
        let slopes = slopes(&e, last)?;
        let mut defect = wanted;
        defect.iter_mut().zip(found).for_each(|(entry, found)| *entry -= found);
        e.iter_mut().zip(slopes).for_each(|(entry, slopes)| *entry += dot(&slopes, &defect));
    }
    Some(e)
}

/// e₄ = det J̃
#[inline]
fn last<T: Scalar>(moments: &[T; 4]) -> T {
    (moments[0] * moments[1]) * (moments[2] * moments[3])
}

/// The derivatives of e₁, e₂ and e₃ by the integrals: the inverse of (−2e₁ 2 0; −2e₃ 2e₂ −2e₁; 0 2e₄ −2e₃).
fn slopes<T: Real>(e: &[T; 3], last: T) -> Option<[[T; 3]; 3]> {
    let ([a, b, c], half) = (*e, T::from_ratio(1, 2));
    // half of each entry
    let determinant = a * (b * c - a * last) - c * c;
    let cofactors = [[a * last - b * c, c, -a], [-c * c, a * c, -a * a], [-c * last, a * last, c - a * b]];
    let inverse = half / determinant;
    inverse.is_finite().then(|| cofactors.map(|row| row.map(|entry| entry * inverse)))
}

/// The four constants that make a map of Moser and Veselov of the exact motion.
struct Fit<'a, T> {
    d: &'a [T; 4],
    momentum: &'a Vector<T>,
    /// F
    motion: &'a Matrix<T>,
}

/// β, h̃, δ, κ, and their results.
struct Fitted<T> {
    unknowns: [T; 4],
    /// J̃
    moments: [T; 4],
    /// F̃ = exp(−(δM + κ⋆M)) F
    motion: Matrix<T>,
    /// F̃J̃ − J̃F̃ᵀ − h̃M
    residual: Vector<T>,
}

impl<T: Real> Fit<'_, T> {
    /// By the method of Gauss and Newton, from no correction at all. If a moment vanishes, it starts from a small one,
    /// since J̃ has no slope at zero.
    fn fit(&self) -> Option<Fitted<T>> {
        let small = T::from_ratio(1, 1000) * dot(self.momentum, self.momentum);
        let beta = if self.d.iter().any(|d| *d * *d <= small) { small } else { T::zero() };
        let mut found = self.at([beta, T::one(), T::zero(), T::zero()]);
        let mut derivatives = T::DERIVATIVES;
        for _ in 0..20 {
            let next = self.corrected(&found);
            // NaN ends it
            let shrinks = next.residual.max_abs() < T::from_ratio(1, 2) * found.residual.max_abs();
            if !shrinks {
                if derivatives == 0 {
                    break;
                }
                derivatives -= 1;
            }
            found = next;
        }
        let accepted = T::from_f64(64.0) * T::EPSILON * self.momentum.max_abs();
        (found.residual.max_abs() <= accepted).then_some(found)
    }

    fn at(&self, unknowns: [T; 4]) -> Fitted<T> {
        let [beta, step, delta, kappa] = unknowns;
        let moments = self.d.map(|d| {
            let root = (d * d + beta).sqrt();
            if d < T::zero() { -root } else { root }
        });
        let m = self.momentum;
        let square = dot(m, m);
        let [a, b, c, d] = turn([-delta, -kappa], square, pfaffian(m));
        let (body, perpendicular) = (skew(m), skew(&dual(m)));
        let squared = product(&body, &body);
        let increment: Matrix<T> = core::array::from_fn(|i| {
            core::array::from_fn(|j| {
                let sum = b * entry(&body, i, j) + c * entry(&perpendicular, i, j) + d * entry(&squared, i, j);
                if i == j { sum + a + d * T::from_ratio(1, 2) * square } else { sum }
            })
        });
        let carried = product(&increment, self.motion);
        let sum = |i: usize, j: usize| entry(self.motion, i, j) + entry(&carried, i, j);
        let motion: Matrix<T> = core::array::from_fn(|i| core::array::from_fn(|j| sum(i, j)));
        let residual = SVector::from(PLANES.map(|plane| across(&motion, &moments, plane))) - m * step;
        Fitted { unknowns, moments, motion, residual }
    }

    /// One correction.
    fn corrected(&self, found: &Fitted<T>) -> Fitted<T> {
        let Fitted { unknowns, moments, motion, residual } = found;
        let (body, perpendicular) = (skew(self.momentum), skew(&dual(self.momentum)));
        let (turned, other) = (product(&body, motion), product(&perpendicular, motion));
        let half = T::from_ratio(1, 2);
        let reciprocals = moments.map(T::recip);
        let columns = [
            PLANES.map(|plane| half * across(motion, &reciprocals, plane)).into(),
            -self.momentum,
            PLANES.map(|plane| -across(&turned, moments, plane)).into(),
            PLANES.map(|plane| -across(&other, moments, plane)).into(),
        ];
        let correction = least_squares(columns, *residual);
        self.at(core::array::from_fn(|i| unknowns[i] - correction[i]))
    }
}

/// Entry (i, j) of FJ − JFᵀ.
#[inline]
fn across<T: Scalar>(f: &Matrix<T>, moments: &[T; 4], (i, j): (usize, usize)) -> T {
    entry(f, i, j) * at(moments, j) - entry(f, j, i) * at(moments, i)
}

/// The x that comes closest to Σ x_k a_k = b, by orthogonal columns, the longest first. Where columns are dependent, there are many, and x is small.
fn least_squares<T: Real>(columns: [Vector<T>; 4], b: Vector<T>) -> [T; 4] {
    let lengths = columns.map(|column| dot(&column, &column).sqrt());
    let mut left = columns;
    for (column, length) in left.iter_mut().zip(lengths) {
        *column = if length > T::zero() { *column / length } else { SVector::from_element(T::zero()) };
    }
    let mut rest = b;
    // a_k less its components along those before is r_kk q_k
    let (mut order, mut upper, mut right) = ([0; 4], [[T::zero(); 4]; 4], [T::zero(); 4]);
    let mut used = [false; 4];
    let mut rank = 0;
    for stage in 0..4 {
        let sizes = left.map(|column| dot(&column, &column).sqrt());
        let size = |k: usize| at(&sizes, k);
        let open = (0..4).filter(|&k| !at(&used, k));
        let Some(next) = open.reduce(|a, b| if size(a) < size(b) { b } else { a }) else { break };
        let length = size(next);
        // NaN ends it
        let is_independent = length > T::from_f64(1e3) * T::EPSILON;
        if !is_independent {
            break;
        }
        (order[stage], used[next % 4], rank) = (next % 4, true, stage + 1);
        let q = at(&left, next) / length;
        upper[stage][next % 4] = length;
        let part = dot(&q, &rest);
        right[stage] = part;
        rest -= q * part;
        let columns = left.iter_mut().zip(&mut upper[stage]).zip(used);
        for ((column, along), _) in columns.filter(|(_, used)| !used) {
            *along = dot(&q, &*column);
            *column -= q * *along;
        }
    }
    let mut x = [T::zero(); 4];
    for stage in (0..rank).rev() {
        let (column, row) = (at(&order, stage), at(&upper, stage));
        let later = order.iter().take(rank).skip(stage + 1);
        let known = later.fold(at(&right, stage), |sum, &other| sum - at(&row, other) * at(&x, other));
        x[column % 4] = known / at(&row, column);
    }
    x.iter_mut().zip(lengths).for_each(|(x, length)| *x = if length > T::zero() { *x / length } else { T::zero() });
    x
}
