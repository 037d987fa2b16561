//! The free motion of a rigid body, exactly: M′ = M × ω, R′ = R ω^ with ω = J⁻¹M, by power series that converge for all bodies.
//!
//! The rotation by the unit quaternion (ρ₀, ρ) over a time h obeys, in principal axes,
//!
//! ```text
//! d ρ − m × ρ = ρ₀ m,    m = h M/2,    d = diag(d₁, d₂, d₃)
//! ```
//! where the d_i depend only on the body, on h and on the two invariants |M|² and M·J⁻¹M. This is the equation of Moser
//! and Veselov for a body of modified inertia, linear in the Gibbs vector ρ/ρ₀. With x_i = 1/J_i, a = |M|², e = M·J⁻¹M
//! and, (i, j, k) in any order,
//!
//! ```text
//! D′_i = −½ (a + D_i²) (x_i + P_i (e − a x_i)/(℘(τ/2) − e_i + a P_i)),    D_i = 2 d_i/τ
//! P_i = (x_i − x_j)(x_i − x_k),    e_i = a x_j x_k + e x_i − their mean,    ℘ with the roots e_i
//! ```
//! So d_i is a power series in τ². Its coefficients are homogeneous polynomials in a and e, computed once for a body,
//! without a division by differences of inertia. Where few terms are not enough, the series gives d for a part of the
//! time. Formulas then double that time as often as needed.
//!
//! Source: the equation is that of J. Moser and A. P. Veselov, *Discrete versions of some classical integrable systems and factorization of
//! matrix polynomials*, Comm. Math. Phys. 139 (1991); that modified constants make it exact, R. I. McLachlan and A. Zanna, *The discrete
//! Moser–Veselov algorithm for the free rigid body, revisited*, Found. Comput. Math. 5 (2005), for the first terms. The differential
//! equation follows from d_i = ½τ|M| cot Ψ_i, where tan(Ψ_i − Ψ_j) = |M| (x_i − x_j) σσ_k/(σ_iσ_j) in Weierstrass' functions of τ/2.

use crate::matrices::axial;
use crate::root::root;
use crate::space::each_lane;
use crate::{Error, Real, Scalar, Space};
use axes::Axes;
use core::array::from_fn;
use duplication::{Functions, duplicated};
use nalgebra::{ArrayStorage, Quaternion, SMatrix, SVector};
use num_traits::{One, Zero};
use series::{Coefficients, in_alpha};
use turn::{Turn, balanced, minors, ratio, shorter, turn, turn_of_tensor};

pub(crate) mod axes;
mod duplication;
mod series;
mod turn;

/// The most duplications: each doubles the error of the angle, which is that of its last digit.
const DUPLICATIONS: u32 = 24;
/// The error of an angle up to which it is still one.
const LARGEST_ERROR: f64 = 1.0 / 8192.0;

/// Up to this degree, polynomials are summed in pairs of terms. Longer ones have other work to do during the chain of Horner's rule.
const PAIRED: usize = 6;

/// How many duplications numbers of this type are good for: 10 of `f32`.
fn duplications<T: Scalar>() -> u32 {
    let good =
        (1..=DUPLICATIONS).take_while(|&times| f64::from(1 << times) * T::Lane::EPSILON.to_f64() <= LARGEST_ERROR);
    good.last().unwrap_or(1)
}

/// The constants of a motion: d_i x over 2ⁿ, and 2⁻ⁿ, by which m is multiplied too. They are 0 if the motion is too
/// long.
pub type KeptRotation<T> = SVector<T, 4>;

type Vector<T> = SVector<T, 3>;

/// The constants of all free motions of a body over a given time.
#[derive(Clone, Copy, Debug)]
pub struct FreeRotation<T> {
    /// h x/2 with the largest x of x_i = 1/J_i by size: m = `scale` M is free of units.
    scale: T,
    /// J_i x
    inertia: Vector<T>,
    /// x_i/x
    reciprocals: Vector<T>,
    axes: Axes<T, Tensor<T>, 3>,
    series: Coefficients<T>,
    /// Up to which α a polynomial of each degree is enough.
    reach: [T; 9],
}

/// J/x and X = xJ⁻¹, and the symmetric functions of X.
type Tensor<T> = (SMatrix<T, 3, 3>, SMatrix<T, 3, 3>, Vector<T>);

impl<T: Scalar> FreeRotation<T> {
    /// The free motions over the time `h` of a body with the inertia tensor `inertia`; only its lower triangle is read.
    ///
    /// # Errors
    /// [`Error::SingularKineticEnergy`] where a principal moment is 0, [`Error::NotFinite`].
    pub fn new(inertia: &SMatrix<T, 3, 3>, h: T) -> Result<Self, Error> {
        Self::to_tolerance(inertia, h, 0.0)
    }

    /// The same with series that end before terms below `tolerance` of d. Turns stay in the group; d, and with it the energy, is off by so much.
    pub fn to_tolerance(inertia: &SMatrix<T, 3, 3>, h: T, tolerance: f64) -> Result<Self, Error> {
        let mut all = Self {
            scale: T::zero(),
            inertia: Space::<T>::origin(),
            reciprocals: Space::<T>::origin(),
            axes: Axes::unset(),
            series: Space::<T>::origin(),
            reach: Space::<T>::origin(),
        };
        for lane in 0..T::LANES {
            let own = FreeRotation::of_number(&inertia.lane(lane), h.lane(lane), tolerance)?;
            all.scale.set_lane(lane, &own.scale);
            all.inertia.set_lane(lane, &own.inertia);
            all.reciprocals.set_lane(lane, &own.reciprocals);
            all.axes.set_lane(lane, &own.axes);
            all.series.set_lane(lane, &own.series);
            all.reach.set_lane(lane, &own.reach);
        }
        Ok(all)
    }

    /// The Gibbs vector ρ/ρ₀ = tan(θ/2) n of the rotation that starts with the momentum `momentum`.
    #[inline]
    pub fn gibbs_vector(&self, momentum: &Vector<T>) -> Result<Vector<T>, Error> {
        self.turn(momentum).map(ratio)
    }

    /// A multiple (w, x) of the quaternion of the rotation that starts with the momentum `momentum`: its Gibbs vector is x/w.
    ///
    /// Accuracy: a few units in the last place of the angle. Work: a polynomial of degree up to 14 in two variables,
    /// and for long motions some hundred operations each time that the angle doubles. Lanes are turned one after the
    /// other. A lane that fails while others succeed is NaN.
    ///
    /// # Errors
    /// [`Error::Unsolvable`] where the angle is more than a thousand or so; [`Error::NotFinite`].
    #[inline(always)]
    pub fn turn(&self, momentum: &Vector<T>) -> Result<Turn<T>, Error> {
        self.turn_by(None, momentum)
    }

    /// As [`turn`](Self::turn), with w ≥ 0: of the two quaternions of a rotation the one that is nearer to 1.
    ///
    /// # Errors
    /// Those of [`turn`](Self::turn).
    #[inline(always)]
    pub fn shorter_turn(&self, momentum: &Vector<T>) -> Result<Turn<T>, Error> {
        self.turn_by(None, momentum).map(shorter)
    }

    /// As [`shorter_turn`](Self::shorter_turn), of a motion that is known.
    #[inline(always)]
    pub fn shorter_turn_of(&self, kept: &KeptRotation<T>, momentum: &Vector<T>) -> Result<Turn<T>, Error> {
        self.turn_by(Some(kept), momentum).map(shorter)
    }

    /// As [`gibbs_vector`](Self::gibbs_vector), of a motion that is known.
    #[inline]
    pub fn gibbs_vector_of(&self, kept: &KeptRotation<T>, momentum: &Vector<T>) -> Result<Vector<T>, Error> {
        self.turn_of(kept, momentum).map(ratio)
    }

    /// As [`turn`](Self::turn), of a motion that is known.
    #[inline(always)]
    pub fn turn_of(&self, kept: &KeptRotation<T>, momentum: &Vector<T>) -> Result<Turn<T>, Error> {
        self.turn_by(Some(kept), momentum)
    }

    #[inline(always)]
    fn turn_by(&self, kept: Option<&KeptRotation<T>>, momentum: &Vector<T>) -> Result<Turn<T>, Error> {
        let m = self.without_units(momentum);
        let (w, x) = match T::LANES {
            // no closure: it would be called, and the turn would go through memory
            1 => {
                let (w, x) = self.of_lane(0).turn(kept.map(|kept| kept.lane(0)), &m.lane(0))?;
                (T::from_lanes(|_| w), x.map(|entry| T::from_lanes(|_| entry)))
            }
            _ => {
                let nothing = T::Lane::from_f64(f64::NAN);
                let all = each_lane::<T, _>((nothing, SVector::from_element(nothing)), |lane| {
                    self.of_lane(lane).turn(kept.map(|kept| kept.lane(lane)), &m.lane(lane))
                })?;
                let x = SVector::from_fn(|i, _| T::from_lanes(|lane| all[lane].1[i]));
                (T::from_lanes(|lane| all[lane].0), x)
            }
        };
        Ok((w, self.in_coordinates(x)))
    }

    /// The constants of the motion with the momentum `momentum`, for many steps along it.
    pub fn motion(&self, momentum: &Vector<T>) -> KeptRotation<T> {
        let m = self.without_units(momentum);
        let mut kept = KeptRotation::<T>::from_element(T::zero());
        for lane in 0..T::LANES {
            let (body, m) = (self.of_lane(lane), m.lane(lane));
            let found = match body.modified_inertia(&m) {
                Some(inertia) => Ok((inertia, <T::Lane as One>::one())),
                None => body.long_motion(&m),
            };
            if let Ok((d, part)) = found {
                kept.set_lane(lane, &SVector::from([d[0], d[1], d[2], part]));
            }
        }
        kept
    }

    /// The momentum of the free motion that makes the rotation of less than half a turn with this Gibbs vector; NaN where none is found. The
    /// inverse of [`gibbs_vector`](Self::gibbs_vector).
    #[cold]
    pub fn momentum(&self, gibbs_vector: &Vector<T>) -> Vector<T> {
        let c = self.in_principal_axes(gibbs_vector);
        let m: Vector<T> = Space::side_by_side(|lane| self.of_lane(lane).momentum(&c.lane(lane)));
        self.in_coordinates(m * self.scale.recip())
    }

    #[inline(always)]
    fn of_lane(&self, lane: usize) -> OfLane<'_, T> {
        OfLane { free: self, lane }
    }

    /// m = h x M/2 in principal axes.
    #[inline(always)]
    fn without_units(&self, momentum: &Vector<T>) -> Vector<T> {
        self.in_principal_axes(momentum) * self.scale
    }

    #[inline]
    fn in_principal_axes(&self, vector: &Vector<T>) -> Vector<T> {
        match &self.axes {
            Axes::Principal(axes) => axes.tr_mul(vector),
            _ => *vector,
        }
    }

    #[inline]
    fn in_coordinates(&self, vector: Vector<T>) -> Vector<T> {
        match &self.axes {
            Axes::Principal(axes) => axes * vector,
            _ => vector,
        }
    }
}

/// The motions of one lane, in principal axes and without units.
#[derive(Clone, Copy)]
struct OfLane<'a, T> {
    free: &'a FreeRotation<T>,
    lane: usize,
}

impl<T: Scalar> OfLane<'_, T> {
    /// A multiple of the quaternion of the turn, of a motion with the constants `kept` where they are known.
    #[inline(always)]
    fn turn(self, kept: Option<KeptRotation<T::Lane>>, m: &Vector<T::Lane>) -> Result<Turn<T::Lane>, Error> {
        let inertia = match kept {
            Some(SVector { data: ArrayStorage([[a, b, c, part]]), .. }) => {
                (part == <T::Lane as One>::one()).then_some(SVector::from([a, b, c]))
            }
            None => self.modified_inertia(m),
        };
        match inertia {
            Some(d) => Ok(self.solution(&d, m)),
            None => self.long_turn(kept, m),
        }
    }

    /// The turn of a motion beyond the reach of the series, or of one that was made longer by duplication.
    #[cold]
    #[inline(never)]
    fn long_turn(self, kept: Option<KeptRotation<T::Lane>>, m: &Vector<T::Lane>) -> Result<Turn<T::Lane>, Error> {
        let (d, part) = match kept {
            Some(kept) if kept[3] != <T::Lane as Zero>::zero() => (SVector::from([kept[0], kept[1], kept[2]]), kept[3]),
            _ => self.long_motion(m)?,
        };
        Ok(balanced(self.solution(&d, &(m * part))))
    }

    /// d_i x over 2ⁿ, and 2⁻ⁿ, by n duplications: d ρ − m × ρ = ρ₀ m holds for multiples of d and m too.
    #[cold]
    fn long_motion(self, m: &Vector<T::Lane>) -> Result<(Vector<T::Lane>, T::Lane), Error> {
        if m.iter().any(|component| !component.is_finite()) {
            return Err(Error::NotFinite { name: "the momentum" });
        }
        let (mut size, mut part) = (<T::Lane as One>::one(), *m);
        let most = duplications::<T>();
        for times in 1..=most {
            (size, part) = (half(size), part.map(half));
            let invariants = self.invariants(&part);
            let sum = self.sum_of_series(invariants);
            if let Some(d) = sum.and_then(|sum| self.made_longer(invariants, sum, times)) {
                return Ok((d, size));
            }
        }
        let [.., reach] = self.free.reach;
        let square = m.iter().fold(<T::Lane as Zero>::zero(), |sum, component| sum + *component * *component);
        let fraction = T::Lane::from_f64(0.999 * f64::from(1 << most)) * (reach.lane(self.lane) / square).sqrt();
        Err(Error::unsolvable(fraction))
    }

    /// The m of the motion with the Gibbs vector `c`.
    fn momentum(self, c: &Vector<T::Lane>) -> Vector<T::Lane> {
        // the equation of Moser and Veselov, which is right to second order
        let image = match &self.free.axes {
            Axes::Tensor((inertia, ..)) => inertia.lane(self.lane) * c,
            _ => self.free.inertia.lane(self.lane).component_mul(c),
        };
        // of the angle rather than of its tangent, which grows beyond all bounds towards half a turn
        let scale = (<T::Lane as One>::one() + c.dot(c)).recip();
        let start = (image + c.cross(&image)) * scale;
        let found = root(start, |m| Some((ratio(self.turn(None, m).ok()?) - c) * scale));
        found.unwrap_or(SVector::from_element(T::Lane::from_f64(f64::NAN)))
    }

    /// d_i x for all of the time, or the coefficients of d; `None` beyond the reach of the series.
    #[inline(always)]
    fn modified_inertia(self, m: &Vector<T::Lane>) -> Option<Vector<T::Lane>> {
        self.sum_of_series(self.invariants(m)).map(|sum| self.scaled(sum))
    }

    /// α = |m|² and ε = m·Xm.
    #[inline(always)]
    fn invariants(self, m: &Vector<T::Lane>) -> [T::Lane; 2] {
        let epsilon = match &self.free.axes {
            Axes::Tensor((_, reciprocal, _)) if T::DERIVATIVES > 0 => m.dot(&(reciprocal.lane(self.lane) * m)),
            _ => self.free.reciprocals.lane(self.lane).dot(&m.component_mul(m)),
        };
        [m.dot(m), epsilon]
    }

    /// x_i d_i, or the coefficients of X d, and τ²/4 ℘(τ/2), by the polynomial of the least degree that is enough.
    #[inline(always)]
    fn sum_of_series(self, [alpha, epsilon]: [T::Lane; 2]) -> Option<[T::Lane; 4]> {
        macro_rules! degrees {
            ($($number:literal $degree:literal),*) => {$(
                if alpha <= self.free.reach[$number].lane(self.lane) {
                    return Some(self.polynomial::<$degree>(alpha, epsilon));
                }
            )*};
        }
        degrees!(0 2, 1 3, 2 4, 3 5, 4 6, 5 8, 6 10, 7 12, 8 14);
        None
    }

    /// The polynomial of degree `K`. The coefficients of powers of ε are found by the rule of Horner in α. Where the degree is low,
    /// it is the rule in α² for pairs of terms: a short drift waits for this sum.
    #[inline(always)]
    fn polynomial<const K: usize>(self, alpha: T::Lane, epsilon: T::Lane) -> [T::Lane; 4] {
        let nothing = [<T::Lane as Zero>::zero(); 4];
        let plus = |sum: [T::Lane; 4], factor: T::Lane, next: [T::Lane; 4]| from_fn(|k| sum[k] * factor + next[k]);
        let own = |entry: &[T; 4]| from_fn(|k| entry[k].lane(self.lane));
        let pair = |pair: &[[T; 4]]| match pair {
            [first, second] => plus(own(second), alpha, own(first)),
            [first] => own(first),
            _ => nothing,
        };
        let square = alpha * alpha;
        let mut sum = nothing;
        let mut power = <T::Lane as One>::one();
        // the longest rule comes first: the others do not wait for it
        for j in 0..=K {
            let coefficients = in_alpha::<T, K>(&self.free.series, j);
            let next = if K <= PAIRED {
                let mut pairs = coefficients.chunks(2).rev();
                let last = pairs.next().map_or(nothing, pair);
                pairs.fold(last, |sum, next| plus(sum, square, pair(next)))
            } else {
                coefficients.iter().rev().fold(nothing, |sum, next| plus(sum, alpha, own(next)))
            };
            sum = plus(next, power, sum);
            power *= epsilon;
        }
        sum
    }

    #[inline(always)]
    fn scaled(self, [a, b, c, _]: [T::Lane; 4]) -> Vector<T::Lane> {
        let sum = SVector::from([a, b, c]);
        match &self.free.axes {
            Axes::Tensor(_) if T::DERIVATIVES > 0 => sum,
            _ => sum.component_mul(&self.free.inertia.lane(self.lane)),
        }
    }

    /// A multiple of the quaternion with d ρ − m × ρ = ρ₀ m.
    #[inline(always)]
    fn solution(self, d: &Vector<T::Lane>, m: &Vector<T::Lane>) -> Turn<T::Lane> {
        match &self.free.axes {
            Axes::Tensor((inertia, reciprocal, _)) if T::DERIVATIVES > 0 => {
                // X d = c₀ + c₁X + c₂X²
                let (inertia, reciprocal) = (inertia.lane(self.lane), reciprocal.lane(self.lane));
                let tensor = inertia * d[0] + SMatrix::identity() * d[1] + reciprocal * d[2];
                turn_of_tensor(&tensor, m)
            }
            _ => turn(d, m),
        }
    }

    /// d_i x, or the coefficients of X d, for 2ⁿ times the time of `sum`, over 2ⁿ. `None` if the time has to be
    /// shorter.
    fn made_longer(self, invariants: [T::Lane; 2], sum: [T::Lane; 4], times: u32) -> Option<Vector<T::Lane>> {
        let [a, b, c, p] = sum;
        match &self.free.axes {
            Axes::Tensor((.., symmetric)) if T::DERIVATIVES > 0 => {
                let e = symmetric.lane(self.lane);
                let [[first, second, third]] = e.data.0;
                // X⁻¹ = (X² − e₁X + e₂)/e₃
                let top = a / third;
                let d = SVector::from([b + top * second, c - top * first, top]);
                let [[a, b, c]] = duplicated(Functions::InPowers(e), invariants, d, p, times)?.data.0;
                Some(SVector::from([c * third, a - c * second, b + c * first]))
            }
            _ => {
                let functions = Functions::OnAxes(self.free.reciprocals.lane(self.lane));
                duplicated(functions, invariants, self.scaled(sum), p, times)
            }
        }
    }
}

impl<T: Real> FreeRotation<T> {
    /// The constants of one body.
    fn of_number(inertia: &SMatrix<T, 3, 3>, h: T, tolerance: f64) -> Result<Self, Error> {
        let (moments, axes) = Axes::principal(inertia);
        if moments.iter().any(|moment| !moment.is_finite()) {
            return Err(Error::NotFinite { name: "the inertia" });
        }
        let least =
            moments.iter().fold(moments[0], |least, &moment| if moment.abs() < least.abs() { moment } else { least });
        let singular = Error::SingularKineticEnergy { condition: f64::INFINITY };
        if T::DERIVATIVES > 0 {
            return Self::of_tensor(inertia, h, (moments.map(T::to_f64), least.to_f64()), tolerance).ok_or(singular);
        }
        let relative = moments / least;
        if !relative.iter().all(|moment| moment.is_finite()) {
            return Err(singular);
        }
        let x = relative.map(T::recip);
        let series = series::on_axes(&x);
        let reach = series::reach(&x, &series, tolerance);
        Ok(Self { scale: half(h) / least, inertia: relative, reciprocals: x, axes, series, reach })
    }

    /// Those with derivatives: by the values of the moments alone it is decided how far series reach.
    #[cold]
    fn of_tensor(
        tensor: &SMatrix<T, 3, 3>,
        h: T,
        (moments, least): (Vector<f64>, f64),
        tolerance: f64,
    ) -> Option<Self> {
        let values = moments.map(|moment| T::from_f64(moment / least));
        if !values.iter().all(|moment| moment.is_finite()) {
            return None;
        }
        let x = values.map(T::recip);
        let reach = series::reach(&x, &series::on_axes(&x), tolerance);
        let symmetric = SMatrix::<T, 3, 3>::from_fn(|i, j| tensor[(i.max(j), i.min(j))]);
        let relative = symmetric * T::from_f64(least).recip();
        let minors = minors(&relative);
        // the symmetric functions of X are those of J over its determinant
        let inverse = relative.column(0).dot(&minors.column(0)).recip();
        let invariants = SVector::from([minors.trace() * inverse, relative.trace() * inverse, inverse]);
        let axes = Axes::Tensor((relative, minors * inverse, invariants));
        let series = series::in_powers(&invariants);
        Some(Self { scale: half(h) * T::from_f64(least).recip(), inertia: values, reciprocals: x, axes, series, reach })
    }
}

/// The momentum of the free motion over the time `h` that makes the rotation with this Gibbs vector; NaN where there is none.
#[cold]
pub fn free_momentum<T: Scalar>(inertia: &SMatrix<T, 3, 3>, h: T, gibbs_vector: &Vector<T>) -> Vector<T> {
    match FreeRotation::new(inertia, h) {
        Ok(free) => free.momentum(gibbs_vector),
        Err(_) => SVector::from_element(T::from_f64(f64::NAN)),
    }
}

/// tan(θ/2) n of a rotation: (F − Fᵀ)^∨/(1 + tr F).
pub fn gibbs_vector_of_matrix<T: Scalar>(f: &SMatrix<T, 3, 3>) -> Vector<T> {
    axial(f) * (T::one() + f[(0, 0)] + f[(1, 1)] + f[(2, 2)]).recip()
}

/// tan(θ/2) n of a rotation: the vector part over the scalar part.
pub fn gibbs_vector_of_quaternion<T: Scalar>(f: &Quaternion<T>) -> Vector<T> {
    SVector::from_fn(|i, _| f.coords[i] / f.coords[3])
}

#[inline]
fn half<T: Scalar>(x: T) -> T {
    T::from_ratio(1, 2) * x
}

#[cfg(test)]
mod tests;
