//! d of twice the time from d: the formulas of duplication of Weierstrass' functions.
//!
//! With ℘ and ℘′ at half the time before, which is the unit of time, and α, ε in this unit, on each axis
//!
//! ```text
//! d ↦ ((d² − α) N − 2 d α G)/(2 d N + (d² − α) G)
//! N = ℘³ − 3v ℘² − A (℘ + v) − 2C,    G = −℘′ b,    (½℘′)² = ℘³ + A℘ + C
//! b = P (ε − αx),    P_i = (x_i − x_j)(x_i − x_k),    v = e − αP
//!
//! ℘ − e ↦ (((℘ − e)² − Pβ)/℘′)²,    β_i = (ε − αx_j)(ε − αx_k)
//! ```
//! and from d_j on one axis follow the others,
//!
//! ```text
//! d_i = (d_j − αT)/(1 + d_j T),    T = −(x_i − x_j)(℘ − e_k)/(½℘′)
//! ```
//! There is no division by differences of inertia.
//!
//! Derivation: d = |m| cot Ψ with exp 2iΨ(u) = e^{2cu} σ(w + u)/σ(w − u), where ℘(w) = v and ℘′(w) = 2i√α b. Start from
//! σ(w + 2u) σ(w) = σ²(w + u) σ²(u) (℘(u) − ℘(w + u)). It follows that exp 2i(Ψ(2u) − 2Ψ(u)) = (℘(u) − ℘(w + u))/(℘(u)
//! − ℘(w − u)). The theorem of addition makes ℘(w ± u) rational in ℘ and ℘′. Powers of v beyond the first drop out by
//! −αb² = v³ + Av + C; where v is large, as for a needle, they would cancel. The last formula is that of Ψ_i − Ψ_j with
//! σσ_k/(σ_iσ_j) = −(℘ − e_k)/(½℘′).

use super::half;
use super::series::{product, trace};
use crate::Real;
use nalgebra::SVector;

type Vector<T> = SVector<T, 3>;

/// Functions of X = J⁻¹.
#[derive(Clone, Copy, Debug)]
pub(super) enum Functions<T> {
    /// Their values at x₁, x₂ and x₃.
    OnAxes(Vector<T>),
    /// The coefficients of c₀ + c₁X + c₂X², where (e₁, e₂, e₃) are the symmetric functions of the x_i.
    InPowers(Vector<T>),
}

/// The constants of all duplications.
struct Curve<T> {
    functions: Functions<T>,
    alpha: T,
    e: Vector<T>,
    v: Vector<T>,
    b: Vector<T>,
    /// Pβ: (e_i − e_j)(e_i − e_k)
    gaps: Vector<T>,
    /// A = −½ Σ e_k²
    linear: T,
    /// C = −e₁e₂e₃
    constant: T,
}

/// (Q, Y, Z) with ℘ − e = Q/Z² and ½℘′ = Y/Z³: poles of ℘ are points as others.
struct CurvePoint<T> {
    q: Vector<T>,
    y: T,
    z: T,
}

/// d of 2ⁿ times the time, over 2ⁿ, for n = `times`; `p` is ℘ at half the time before. `None` where that may be beyond half a period.
#[cold]
pub(super) fn duplicated<T: Real>(
    functions: Functions<T>,
    invariants: [T; 2],
    mut d: Vector<T>,
    p: T,
    times: u32,
) -> Option<Vector<T>> {
    let curve = Curve::new(functions, invariants);
    let mut point = curve.start(p)?;
    for _ in 1..times {
        d = functions.quotient(curve.twice(&d, &point));
        point = curve.settled(curve.point_twice(&point));
    }
    let fraction = curve.twice(&d, &point);
    Some(match functions {
        Functions::OnAxes(x) => curve.on_all_axes(&x, fraction, &curve.point_twice(&point)),
        Functions::InPowers(_) => functions.quotient(fraction),
    })
}

impl<T: Real> Functions<T> {
    fn product(&self, a: &Vector<T>, b: &Vector<T>) -> Vector<T> {
        match self {
            Self::OnAxes(_) => a.component_mul(b),
            Self::InPowers(e) => product(a, b, e),
        }
    }

    /// `f` + `number`
    fn plus(&self, f: &Vector<T>, number: T) -> Vector<T> {
        match self {
            Self::OnAxes(_) => f.add_scalar(number),
            Self::InPowers(_) => SVector::from([f[0] + number, f[1], f[2]]),
        }
    }

    /// The sum of the values on the axes.
    fn trace(&self, f: &Vector<T>) -> T {
        match self {
            Self::OnAxes(_) => f[0] + f[1] + f[2],
            Self::InPowers(e) => trace(f, e),
        }
    }

    /// The values on the axes but one, multiplied: f² − tr f f + ½ (tr² f − tr f²).
    fn adjugate(&self, f: &Vector<T>) -> Vector<T> {
        match self {
            Self::OnAxes(_) => SVector::from([f[1] * f[2], f[2] * f[0], f[0] * f[1]]),
            Self::InPowers(_) => {
                let (square, sum) = (self.product(f, f), self.trace(f));
                let second = half(sum * sum - self.trace(&square));
                self.plus(&square.zip_map(f, |square, f| square - sum * f), second)
            }
        }
    }

    /// The product of the values on the axes.
    fn determinant(&self, f: &Vector<T>) -> T {
        match self {
            Self::OnAxes(_) => f[0] * f[1] * f[2],
            Self::InPowers(_) => T::from_ratio(1, 3) * self.trace(&self.product(f, &self.adjugate(f))),
        }
    }

    fn quotient(&self, (a, b): (Vector<T>, Vector<T>)) -> Vector<T> {
        match self {
            Self::OnAxes(_) => a.zip_map(&b, quotient),
            Self::InPowers(_) => self.product(&a, &self.adjugate(&b)) * self.determinant(&b).recip(),
        }
    }

    /// x, the x_jx_k, and P_i = (x_i − x_j)(x_i − x_k).
    fn of_reciprocals(&self) -> [Vector<T>; 3] {
        let (zero, one) = (T::zero(), T::one());
        match self {
            Self::OnAxes(x) => {
                let differences =
                    [(x.x, x.y, x.z), (x.y, x.z, x.x), (x.z, x.x, x.y)].map(|(x, y, z)| (x - y) * (x - z));
                [*x, self.adjugate(x), differences.into()]
            }
            // x_jx_k = X² − e₁X + e₂
            Self::InPowers(e) => {
                let differences = [e.y, -(e.x + e.x), T::from_f64(3.0)];
                [[zero, one, zero], [e.y, -e.x, one], differences].map(SVector::from)
            }
        }
    }
}

impl<T: Real> Curve<T> {
    fn new(functions: Functions<T>, [alpha, epsilon]: [T; 2]) -> Self {
        let f = functions;
        let [x, products, differences] = f.of_reciprocals();
        let raw = products.zip_map(&x, |product, x| alpha * product + epsilon * x);
        let e = f.plus(&raw, -(T::from_ratio(1, 3) * f.trace(&raw)));
        let excess = f.plus(&x.map(|x| -(alpha * x)), epsilon);
        Self {
            functions,
            alpha,
            e,
            v: e.zip_map(&differences, |e, difference| e - alpha * difference),
            b: f.product(&differences, &excess),
            gaps: f.product(&differences, &f.adjugate(&excess)),
            linear: -half(f.trace(&f.product(&e, &e))),
            constant: -f.determinant(&e),
        }
    }

    /// The point where ℘ is `p`, before half a period: there ℘′ is negative. Half a period is at least π/2 over the
    /// root of the largest difference of the e_i. That difference is at most √(2Σe_k²): here below 1.2.
    fn start(&self, p: T) -> Option<CurvePoint<T>> {
        let q = self.functions.plus(&-self.e, p);
        let y = -self.functions.determinant(&q).sqrt();
        (-self.linear < T::from_ratio(36, 100)).then_some(CurvePoint { q, y, z: T::one() })
    }

    /// d of twice the time, as numerator and denominator.
    fn twice(&self, d: &Vector<T>, point: &CurvePoint<T>) -> (Vector<T>, Vector<T>) {
        let f = self.functions;
        let CurvePoint { y, z, .. } = *point;
        let two = T::one() + T::one();
        let (zz, x) = (z * z, self.abscissa(point));
        let (linear, constant) = (self.linear * zz * zz, self.constant * zz * zz * zz);
        let slope = zz * (T::from_f64(3.0) * x * x + linear);
        let n = f.plus(&self.v.map(|v| -(slope * v)), x * (x * x - linear) - two * constant);
        let g = self.b.map(|b| -two * y * (zz * z) * b);
        let difference = f.plus(&f.product(d, d), -self.alpha);
        let (cosine, sine) = (f.product(&difference, &n), f.product(&difference, &g));
        let (dn, dg) = (f.product(d, &n), f.product(d, &g));
        let above = cosine.zip_map(&dg, |cosine, dg| cosine - two * self.alpha * dg);
        (above, sine.zip_map(&dn, |sine, dn| sine + two * dn))
    }

    /// The point at twice the time.
    fn point_twice(&self, CurvePoint { q, y, z }: &CurvePoint<T>) -> CurvePoint<T> {
        let f = self.functions;
        let (squares, quartic) = (f.product(q, q), *z * *z * *z * *z);
        let n = squares.zip_map(&self.gaps, |square, gap| square - quartic * gap);
        CurvePoint { q: f.product(&n, &n), y: f.determinant(&n), z: (*y + *y) * *z }
    }

    /// The same point with numbers of the size of 1. An entry of Q that loses no digits by cancellation is computed
    /// from the mean X. Otherwise its errors would grow fourfold each time.
    fn settled(&self, CurvePoint { q, y, z }: CurvePoint<T>) -> CurvePoint<T> {
        let size = (self.functions.trace(&q) + z * z).recip();
        let scale = size.sqrt();
        let point = CurvePoint { q: q * size, y: y * size * scale, z: z * scale };
        let (x, zz) = (self.abscissa(&point), point.z * point.z);
        let from_mean = self.functions.plus(&self.e.map(|e| -(e * zz)), x);
        let q = match self.functions {
            Functions::OnAxes(_) => from_mean.zip_map(&point.q, |mean, own| if mean < half(x) { own } else { mean }),
            Functions::InPowers(_) => from_mean,
        };
        CurvePoint { q, ..point }
    }

    /// X = ⅓ Σ Q_i, as the sum of the roots vanishes.
    fn abscissa(&self, point: &CurvePoint<T>) -> T {
        T::from_ratio(1, 3) * self.functions.trace(&point.q)
    }

    /// All d_i from d_j on the axis where |x_j| is least, as the error of the angle is.
    fn on_all_axes(
        &self,
        x: &Vector<T>,
        (above, below): (Vector<T>, Vector<T>),
        CurvePoint { q, y, z }: &CurvePoint<T>,
    ) -> Vector<T> {
        let [[a, b, c]] = x.map(T::abs).data.0;
        let best = if c < a && c < b { 2 } else { usize::from(b < a) };
        // the axes in turn, from one of them on
        let from = |first: usize, of: &Vector<T>| -> [T; 3] { core::array::from_fn(|i| of[(first + i) % 3]) };
        let ([x, next, last], [_, q_next, q_last]) = (from(best, x), from(best, q));
        let ([above, ..], [below, ..]) = (from(best, &above), from(best, &below));
        // the d of the axis with `other`, where `third` is the Q of the third axis
        let on = |other: T, third: T| {
            let t = (x - other) * third * *z;
            quotient(above * *y - self.alpha * below * t, below * *y + above * t)
        };
        from(3 - best, &SVector::from([quotient(above, below), on(next, q_last), on(last, q_next)])).into()
    }
}

/// a/b; if |b| is below ε|a|, ε|a| takes its place.
fn quotient<T: Real>(a: T, b: T) -> T {
    let least = T::EPSILON * a.abs();
    a / if b.abs() < least { least } else { b }
}
