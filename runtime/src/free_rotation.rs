//! The free motion of a rigid body, exactly: M′ = M × ω, R′ = R ω^ with ω = J⁻¹M, by power series that converge for all bodies.
//!
//! The rotation by the unit quaternion (ρ₀, ρ) over a time h obeys, in principal axes,
//!
//! ```text
//! d ρ − m × ρ = ρ₀ m,    m = h M/2,    d = diag(d₁, d₂, d₃)
//! ```
//! where the d_i depend on the body, on h and on the two invariants |M|² and M·J⁻¹M alone: this is the equation of Moser and Veselov for a body
//! of modified inertia, linear in the Gibbs vector ρ/ρ₀. With x_i = 1/J_i, a = |M|², e = M·J⁻¹M and, (i, j, k) in any order,
//!
//! ```text
//! D′_i = −½ (a + D_i²) (x_i + P_i (e − a x_i)/(℘(τ/2) − e_i + a P_i)),    D_i = 2 d_i/τ
//! P_i = (x_i − x_j)(x_i − x_k),    e_i = a x_j x_k + e x_i − their mean,    ℘ with the roots e_i
//! ```
//! so that d_i is a power series in τ², its coefficients homogeneous polynomials in a and e: made once for a body, without a division by
//! differences of inertia. Where few terms are not enough the motion is made of equal parts of the time, which is exact too.
//!
//! Source: the equation is that of J. Moser and A. P. Veselov, *Discrete versions of some classical integrable systems and factorization of
//! matrix polynomials*, Comm. Math. Phys. 139 (1991); that modified constants make it exact, R. I. McLachlan and A. Zanna, *The discrete
//! Moser–Veselov algorithm for the free rigid body, revisited*, Found. Comput. Math. 5 (2005), for the first terms. The differential
//! equation follows from d_i = ½τ|M| cot Ψ_i, where tan(Ψ_i − Ψ_j) = |M| (x_i − x_j) σσ_k/(σ_iσ_j) in Weierstrass' functions of τ/2.

use crate::eigen::Spectrum;
use crate::linear::solve_dense;
use crate::{Error, Real, Scalar};
use nalgebra::{Quaternion, SMatrix, SVector};
use num_traits::{One, Zero};

/// The degree up to which the series are known.
const DEGREE: usize = 14;

/// One for each monomial of degree 1 to [`DEGREE`], and one for 1.
const MONOMIALS: usize = (DEGREE + 1) * (DEGREE + 2) / 2;

/// The degrees of polynomials that are evaluated: as many terms as α asks for.
const DEGREES: [usize; 8] = [3, 4, 5, 6, 8, 10, 12, 14];

/// The place of the coefficient of α^i ε^j, those of one j after the other.
const fn place(i: usize, j: usize) -> usize {
    // Σ_{k<j} (DEGREE + 1 − k)
    j * (2 * DEGREE + 3 - j) / 2 + i
}

/// The coefficients of α^i ε^j; there are some for all that are asked for, without a panic where the optimiser cannot see that.
#[inline(always)]
fn coefficient<T: Scalar>(series: &[[T; 4]; MONOMIALS], i: usize, j: usize) -> [T; 4] {
    series.get(place(i, j)).copied().unwrap_or([T::zero(); 4])
}

/// The most parts that a motion is made of.
const PARTS: u32 = 1024;

/// What no free motion of a body over a given time changes.
#[derive(Clone, Copy, Debug)]
pub struct FreeRotation<T> {
    /// h x/2 with the largest x of x_i = 1/J_i by size: m = `scale` M is free of units.
    scale: T,
    /// J_i x
    inertia: [T; 3],
    /// x_i/x
    reciprocals: [T; 3],
    /// The columns are the principal axes, where they are not those of the coordinates.
    axes: Option<SMatrix<T, 3, 3>>,
    /// The coefficients of α^i ε^j in x_i d_i, at [`place`]; the fourth of each is 0, as registers hold two or four.
    series: [[T; 4]; MONOMIALS],
    /// Up to which α each of [`DEGREES`] is enough.
    reach: [T; 8],
}

/// A homogeneous polynomial of each degree n in α and ε: entry (n, j) belongs to α^{n−j} ε^j.
type Series<T> = [[T; DEGREE + 1]; DEGREE + 1];

impl<T: Scalar> FreeRotation<T> {
    /// The free motions over the time `h` of a body with the inertia tensor `inertia`, of which the lower triangle is read.
    ///
    /// # Errors
    /// [`Error::SingularKineticEnergy`] where a principal moment is 0, [`Error::NotFinite`].
    pub fn new(inertia: &SMatrix<T, 3, 3>, h: T) -> Result<Self, Error> {
        let of_lane =
            |lane: usize| FreeRotation::<T::Lane>::of_number(&inertia.map(|entry| entry.lane(lane)), h.lane(lane));
        let first = of_lane(0)?;
        let everywhere = |number: T::Lane| T::from_lanes(|_| number);
        let mut all = Self {
            scale: everywhere(first.scale),
            inertia: first.inertia.map(everywhere),
            reciprocals: first.reciprocals.map(everywhere),
            axes: first.axes.map(|axes| axes.map(everywhere)),
            series: first.series.map(|coefficients| coefficients.map(everywhere)),
            reach: first.reach.map(everywhere),
        };
        for lane in 1..T::LANES {
            all.put(lane, &of_lane(lane)?);
        }
        Ok(all)
    }

    /// Puts the constants of one body into a lane.
    #[cold]
    fn put(&mut self, lane: usize, other: &FreeRotation<T::Lane>) {
        let put = |number: &mut T, other: T::Lane| {
            let before = *number;
            *number = T::from_lanes(|i| if i == lane { other } else { before.lane(i) });
        };
        let put_all = |numbers: &mut [T], others: &[T::Lane]| {
            numbers.iter_mut().zip(others).for_each(|(number, other)| put(number, *other));
        };
        put(&mut self.scale, other.scale);
        put_all(&mut self.inertia, &other.inertia);
        put_all(&mut self.reciprocals, &other.reciprocals);
        put_all(&mut self.reach, &other.reach);
        self.series.iter_mut().zip(&other.series).for_each(|(numbers, others)| put_all(numbers, others));
        // the axes of the coordinates are those of the identity, by which nothing is rounded
        if self.axes.is_some() || other.axes.is_some() {
            let mut axes = self.axes.unwrap_or_else(identity);
            put_all(axes.as_mut_slice(), other.axes.unwrap_or_else(identity).as_slice());
            self.axes = Some(axes);
        }
    }

    /// The Gibbs vector ρ/ρ₀ = tan(θ/2) n of the rotation that starts with the momentum `momentum`.
    ///
    /// # Errors
    /// As [`turn`](Self::turn).
    #[inline]
    pub fn gibbs_vector(&self, momentum: &SVector<T, 3>) -> Result<SVector<T, 3>, Error> {
        self.turn(momentum).map(ratio)
    }

    /// A multiple (w, x) of the quaternion of the rotation that starts with the momentum `momentum`: its Gibbs vector is x/w.
    ///
    /// Accuracy: a few units in the last place of the angle. Work: a polynomial of degree up to 14 in two variables, and one rotation for
    /// each 1.4 rad or so of the angle. Lanes are turned one after the other; those that fail beside others are NaN.
    ///
    /// # Errors
    /// [`Error::Unsolvable`] where the angle is more than a thousand or so; [`Error::NotFinite`].
    #[inline]
    pub fn turn(&self, momentum: &SVector<T, 3>) -> Result<(T, SVector<T, 3>), Error> {
        let m = self.in_principal_axes(momentum).map(|component| component * self.scale);
        let (w, x) = in_lanes(|lane| match self.modified_inertia(lane, &of_lane(&m, lane)) {
            Some(d) => Ok(turn(&d, &of_lane(&m, lane))),
            None => self.in_parts(lane, &of_lane(&m, lane)),
        })?;
        Ok((w, self.in_coordinates(x)))
    }

    /// The momentum of the free motion that makes the rotation of less than half a turn with this Gibbs vector; NaN where none is found.
    ///
    /// The inverse of [`gibbs_vector`](Self::gibbs_vector), by Newton's method with differences for slopes.
    #[cold]
    pub fn momentum(&self, gibbs_vector: &SVector<T, 3>) -> SVector<T, 3> {
        let c = self.in_principal_axes(gibbs_vector);
        let found: Result<(T, [T; 3]), Error> =
            in_lanes(|lane| Ok((<T::Lane as One>::one(), self.momentum_of_number(lane, &of_lane(&c, lane)))));
        match found {
            Ok((_, m)) => self.in_coordinates(m.map(|component| component * self.scale.recip())),
            Err(_) => SVector::from_element(T::from_f64(f64::NAN)),
        }
    }

    /// The same for one body, in principal axes and without units.
    fn momentum_of_number(&self, lane: usize, c: &[T::Lane; 3]) -> [T::Lane; 3] {
        let (one, nothing) = (<T::Lane as One>::one(), [T::Lane::from_f64(f64::NAN); 3]);
        let reached = |m: &SVector<T::Lane, 3>| {
            let m = [m[0], m[1], m[2]];
            match self.modified_inertia(lane, &m) {
                Some(d) => Some(turn(&d, &m)),
                None => self.in_parts(lane, &m).ok(),
            }
            .map(|(w, x)| ratio((w, SVector::from(x))))
        };
        // the equation of Moser and Veselov, which is right to second order
        let moments = of_lane(&self.inertia, lane);
        let [a, b, g] = [0, 1, 2].map(|i| moments[i] * c[i]);
        let cross = SVector::from([c[1] * g - c[2] * b, c[2] * a - c[0] * g, c[0] * b - c[1] * a]);
        let square = one + c[0] * c[0] + c[1] * c[1] + c[2] * c[2];
        let mut m = (SVector::from([a, b, g]) + cross) * square.recip();
        let c = SVector::from(*c);
        let mut before = T::Lane::from_f64(f64::INFINITY);
        for _ in 0..50 {
            let Some(now) = reached(&m) else { break };
            let defect = now - c;
            let size = largest(&defect);
            // written so that NaN ends it
            if !(size > <T::Lane as Zero>::zero() && size < before) {
                return m.into();
            }
            before = size;
            let step = T::Lane::EPSILON.sqrt() * (largest(&m) + T::Lane::EPSILON);
            let mut slope = SMatrix::<T::Lane, 3, 3>::from_element(<T::Lane as Zero>::zero());
            for j in 0..3 {
                let mut beside = m;
                beside[j] += step;
                let Some(other) = reached(&beside) else { break };
                slope.set_column(j, &((other - now) * step.recip()));
            }
            let Some((correction, _)) = solve_dense(&slope, &defect) else { break };
            m -= correction;
        }
        nothing
    }

    /// d_i x of the whole time in a lane; `None` where that is beyond the reach of the series.
    #[inline]
    fn modified_inertia(&self, lane: usize, m: &[T::Lane; 3]) -> Option<[T::Lane; 3]> {
        let squares = m.map(|component| component * component);
        let alpha = squares[0] + squares[1] + squares[2];
        let [a, b, c] = of_lane(&self.reciprocals, lane);
        let epsilon = a * squares[0] + b * squares[1] + c * squares[2];
        macro_rules! degrees {
            ($($number:literal $degree:literal),*) => {$(
                if alpha <= self.reach[$number].lane(lane) {
                    return Some(self.scaled(lane, self.polynomial::<$degree>(lane, alpha, epsilon)));
                }
            )*};
        }
        degrees!(0 3, 1 4, 2 5, 3 6, 4 8, 5 10, 6 12, 7 14);
        None
    }

    /// The polynomial of degree `K` by the rule of Horner in ε, its coefficients by that in α.
    #[inline(always)]
    fn polynomial<const K: usize>(&self, lane: usize, alpha: T::Lane, epsilon: T::Lane) -> [T::Lane; 4] {
        let coefficients = |i: usize, j: usize| of_lane(&coefficient(&self.series, i, j), lane);
        let mut sum = [<T::Lane as Zero>::zero(); 4];
        for j in (0..=K).rev() {
            let mut inner = coefficients(K - j, j);
            for i in (0..K - j).rev() {
                let next = coefficients(i, j);
                inner = core::array::from_fn(|k| inner[k] * alpha + next[k]);
            }
            sum = core::array::from_fn(|k| sum[k] * epsilon + inner[k]);
        }
        sum
    }

    #[inline]
    fn scaled(&self, lane: usize, [a, b, c, _]: [T::Lane; 4]) -> [T::Lane; 3] {
        let [x, y, z] = of_lane(&self.inertia, lane);
        [a * x, b * y, c * z]
    }

    /// The free motions with the invariants of one of them, here those of `momentum`: for many steps of one.
    ///
    /// # Errors
    /// As [`turn`](Self::turn).
    pub fn motion(&self, momentum: &SVector<T, 3>) -> Result<FreeMotion<'_, T>, Error> {
        let m = self.in_principal_axes(momentum).map(|component| component * self.scale);
        let mut parts = [1; LANES];
        let (_, inertia) = in_lanes(|lane| {
            let m = of_lane(&m, lane);
            let inertia = match self.modified_inertia(lane, &m) {
                Some(inertia) => inertia,
                None => {
                    let (inertia, count) = self.parts(lane, &m)?;
                    parts[lane] = count;
                    inertia
                }
            };
            Ok((<T::Lane as One>::one(), inertia))
        })?;
        Ok(FreeMotion { rotation: self, inertia, parts })
    }

    /// The same rotation as that of equal parts of the time, one after the other.
    #[cold]
    #[inline(never)]
    fn in_parts(&self, lane: usize, m: &[T::Lane; 3]) -> Result<(T::Lane, [T::Lane; 3]), Error> {
        let (d, parts) = self.parts(lane, m)?;
        Ok(turn_in_parts(&d, m, parts))
    }

    /// d_i x of a part of the time that is in reach of the series, and how many parts there are.
    #[cold]
    fn parts(&self, lane: usize, m: &[T::Lane; 3]) -> Result<([T::Lane; 3], u32), Error> {
        if m.iter().any(|component| !component.is_finite()) {
            return Err(Error::NotFinite { name: "the momentum" });
        }
        let (mut parts, mut part) = (1, *m);
        while parts < PARTS {
            parts *= 2;
            part = part.map(half);
            if let Some(d) = self.modified_inertia(lane, &part) {
                return Ok((d, parts));
            }
        }
        let [.., reach] = of_lane(&self.reach, lane);
        let square = m.iter().fold(<T::Lane as Zero>::zero(), |sum, component| sum + *component * *component);
        let fraction = T::Lane::from_f64(0.999 * f64::from(PARTS)) * (reach / square).sqrt();
        Err(Error::Unsolvable { solvable_fraction: fraction.to_f64(), step_size: None })
    }

    #[inline]
    fn in_principal_axes(&self, vector: &SVector<T, 3>) -> [T; 3] {
        match &self.axes {
            Some(axes) => axes.tr_mul(vector).into(),
            None => [vector[0], vector[1], vector[2]],
        }
    }

    #[inline]
    fn in_coordinates(&self, vector: [T; 3]) -> SVector<T, 3> {
        match &self.axes {
            Some(axes) => axes * SVector::from(vector),
            None => SVector::from(vector),
        }
    }
}

impl<T: Real> FreeRotation<T> {
    /// The constants of one body.
    fn of_number(inertia: &SMatrix<T, 3, 3>, h: T) -> Result<Self, Error> {
        let is_diagonal = [(1, 0), (2, 0), (2, 1)].iter().all(|&place| inertia[place] == T::zero());
        let (moments, axes) = match is_diagonal {
            true => ([0, 1, 2].map(|i| inertia[(i, i)]), None),
            false => {
                let spectrum = Spectrum::of(inertia);
                (spectrum.values.into(), Some(spectrum.vectors))
            }
        };
        if moments.iter().any(|moment| !moment.is_finite()) {
            return Err(Error::NotFinite { name: "the inertia" });
        }
        let least =
            moments.iter().fold(moments[0], |least, &moment| if moment.abs() < least.abs() { moment } else { least });
        let relative = moments.map(|moment| moment / least);
        if !relative.iter().all(|moment| moment.is_finite()) {
            return Err(Error::SingularKineticEnergy { condition: f64::INFINITY });
        }
        let x = relative.map(T::recip);
        let series = series(&x);
        let reach = reach(&x, &series);
        Ok(Self { scale: half(h) / least, inertia: relative, reciprocals: x, axes, series, reach })
    }
}

/// The free motions of a body with the same energy and the same length of the momentum.
#[derive(Clone, Copy, Debug)]
pub struct FreeMotion<'a, T> {
    rotation: &'a FreeRotation<T>,
    /// d_i x of a part of the time.
    inertia: [T; 3],
    /// How many parts there are in each lane, a power of two.
    parts: [u32; LANES],
}

impl<T: Scalar> FreeMotion<'_, T> {
    /// The Gibbs vector of the rotation that starts with the momentum `momentum`, one of the motion.
    #[inline]
    pub fn gibbs_vector(&self, momentum: &SVector<T, 3>) -> SVector<T, 3> {
        ratio(self.turn(momentum))
    }

    /// A multiple (w, x) of its quaternion.
    #[inline]
    pub fn turn(&self, momentum: &SVector<T, 3>) -> (T, SVector<T, 3>) {
        let rotation = self.rotation;
        let m = rotation.in_principal_axes(momentum).map(|component| component * rotation.scale);
        let turned = in_lanes(|lane| {
            let (d, m) = (of_lane(&self.inertia, lane), of_lane(&m, lane));
            Ok(if self.parts[lane] == 1 { turn(&d, &m) } else { turn_in_parts(&d, &m, self.parts[lane]) })
        });
        // by construction: none of them fails
        let Ok((w, x)) = turned else { return (T::zero(), SVector::from_element(T::zero())) };
        (w, rotation.in_coordinates(x))
    }
}

/// The momentum of the free motion over the time `h` that makes the rotation with this Gibbs vector; NaN where there is none.
#[cold]
pub fn free_momentum<T: Scalar>(inertia: &SMatrix<T, 3, 3>, h: T, gibbs_vector: &SVector<T, 3>) -> SVector<T, 3> {
    match FreeRotation::new(inertia, h) {
        Ok(free) => free.momentum(gibbs_vector),
        Err(_) => SVector::from_element(T::from_f64(f64::NAN)),
    }
}

/// tan(θ/2) n of a rotation: (F − Fᵀ)^∨/(1 + tr F).
pub fn gibbs_vector_of_matrix<T: Scalar>(f: &SMatrix<T, 3, 3>) -> SVector<T, 3> {
    let twice = SVector::from([f[(2, 1)] - f[(1, 2)], f[(0, 2)] - f[(2, 0)], f[(1, 0)] - f[(0, 1)]]);
    twice * (T::one() + f[(0, 0)] + f[(1, 1)] + f[(2, 2)]).recip()
}

/// tan(θ/2) n of a rotation: the vector part over the scalar part.
pub fn gibbs_vector_of_quaternion<T: Scalar>(f: &Quaternion<T>) -> SVector<T, 3> {
    SVector::from_fn(|i, _| f.coords[i] / f.coords[3])
}

/// What cannot be seen beside 1.
#[inline]
fn negligible<T: Real>() -> T {
    T::from_ratio(1, 8) * T::EPSILON
}

/// Up to which α the polynomial of each degree is enough, whatever ε is: it lies between the least and the largest x times α.
///
/// Then the first terms that are left, those of one degree more and of the next, cannot be seen.
#[cold]
fn reach<T: Real>(x: &[T; 3], series: &[[T; 4]; MONOMIALS]) -> [T; 8] {
    const SAMPLES: i64 = 16;
    let (mut low, mut high) = (x[0], x[0]);
    for &other in x {
        low = if other < low { other } else { low };
        high = if other > high { other } else { high };
    }
    // the largest sum of terms of each degree where α = 1
    let mut sizes = [T::zero(); DEGREE + 1];
    for sample in 0..=SAMPLES {
        let epsilon = low + (high - low) * T::from_ratio(sample, SAMPLES);
        for (n, size) in sizes.iter_mut().enumerate() {
            let terms = (0..=n).rev().fold([T::zero(); 4], |sum, j| {
                let coefficients = coefficient(series, n - j, j);
                core::array::from_fn(|k| sum[k] * epsilon + coefficients[k])
            });
            *size = crate::space::larger(*size, terms[0].abs() + terms[1].abs() + terms[2].abs());
        }
    }
    let root = |size: T, n: usize| match size > T::zero() {
        true => (negligible::<T>() / size).powf(T::from_ratio(1, n as i64)),
        false => T::one(),
    };
    let size = |n: usize| sizes.get(n).copied().unwrap_or(T::one());
    DEGREES.map(|degree| {
        // beyond the last degree, terms go on to shrink as they did
        let reach = match degree == DEGREE {
            true => root(size(degree), degree + 1),
            false => root(size(degree + 1), degree + 1),
        };
        let next = degree + 2;
        let other = if next <= DEGREE { root(size(next), next) } else { reach };
        let reach = if other < reach { other } else { reach };
        if reach.is_finite() { reach } else { T::zero() }
    })
}

/// Lanes, at most.
const LANES: usize = 16;

/// The numbers of one lane.
#[inline]
fn of_lane<T: Scalar, const N: usize>(numbers: &[T; N], lane: usize) -> [T::Lane; N] {
    numbers.map(|number| number.lane(lane))
}

fn identity<T: Scalar>() -> SMatrix<T, 3, 3> {
    SMatrix::from_fn(|i, j| if i == j { T::one() } else { T::zero() })
}

/// What a function of the lane gives, side by side; NaN in the lanes that fail.
///
/// # Errors
/// That of the first lane that is not merely NaN, where all of them fail.
#[inline]
fn in_lanes<T: Scalar>(
    mut value: impl FnMut(usize) -> Result<(T::Lane, [T::Lane; 3]), Error>,
) -> Result<(T, [T; 3]), Error> {
    if T::LANES == 1 {
        let (w, x) = value(0)?;
        return Ok((T::from_lanes(|_| w), x.map(|entry| T::from_lanes(|_| entry))));
    }
    let nothing = T::Lane::from_f64(f64::NAN);
    let (mut all, mut first, mut some) = ([(nothing, [nothing; 3]); LANES], None, false);
    for (lane, place) in all.iter_mut().enumerate().take(T::LANES) {
        match value(lane) {
            Ok(found) => (*place, some) = (found, true),
            // lanes that have failed before are NaN, and say nothing new
            Err(Error::NotFinite { .. }) if first.is_some() => {}
            Err(error) if matches!(first, None | Some(Error::NotFinite { .. })) => first = Some(error),
            Err(_) => {}
        }
    }
    match first {
        Some(error) if !some => Err(error),
        _ => Ok((T::from_lanes(|lane| all[lane].0), core::array::from_fn(|i| T::from_lanes(|lane| all[lane].1[i])))),
    }
}

#[inline]
fn half<T: Scalar>(x: T) -> T {
    T::from_ratio(1, 2) * x
}

fn largest<T: Real>(vector: &SVector<T, 3>) -> T {
    vector.iter().fold(T::zero(), |most, component| crate::space::larger(most, component.abs()))
}

/// (p, r), a multiple of the quaternion with d r − m × r = p m.
#[inline]
fn turn<T: Scalar>(d: &[T; 3], m: &[T; 3]) -> (T, [T; 3]) {
    let ([a, b, c], [x, y, z]) = (*d, *m);
    let (xx, yy, zz) = (x * x, y * y, z * z);
    let square = xx + yy + zz;
    let p = a * (b * c + xx) + (b * yy + c * zz);
    let r = [
        (b * c + square) * x + (b - c) * (y * z),
        (c * a + square) * y + (c - a) * (z * x),
        (a * b + square) * z + (a - b) * (x * y),
    ];
    (p, r)
}

/// The quaternion of the turns of equal parts of the time, one after the other.
fn turn_in_parts<T: Scalar>(d: &[T; 3], m: &[T; 3], parts: u32) -> (T, [T; 3]) {
    let size = T::from_ratio(1, i64::from(parts));
    let mut part = m.map(|component| component * size);
    let mut whole = (T::one(), [T::zero(); 3]);
    for _ in 0..parts {
        let (p, r) = unit(turn(d, &part));
        whole = product(whole, (p, r));
        part = carried(&part, p, &r);
    }
    whole
}

/// x/w; at half a turn, where w vanishes, that of an angle which differs by a unit in the last place.
#[inline]
fn ratio<T: Scalar>((w, x): (T, SVector<T, 3>)) -> SVector<T, 3> {
    let least = T::EPSILON * (x[0].abs() + x[1].abs() + x[2].abs());
    x * T::select(w.abs().below(least), least, w).recip()
}

/// The unit quaternion of a multiple.
fn unit<T: Scalar>((p, r): (T, [T; 3])) -> (T, [T; 3]) {
    let [x, y, z] = r;
    let inverse = (p * p + x * x + y * y + z * z).sqrt().recip();
    (p * inverse, r.map(|component| component * inverse))
}

/// The product of two quaternions.
fn product<T: Scalar>((p, [x, y, z]): (T, [T; 3]), (s, [a, b, c]): (T, [T; 3])) -> (T, [T; 3]) {
    let scalar = p * s - x * a - y * b - z * c;
    let vector = [p * a + s * x + y * c - z * b, p * b + s * y + z * a - x * c, p * c + s * z + x * b - y * a];
    (scalar, vector)
}

/// Fᵀm of the rotation by a unit quaternion: m − 2ρ₀ ρ × m + 2 ρ × (ρ × m).
fn carried<T: Scalar>(m: &[T; 3], p: T, r: &[T; 3]) -> [T; 3] {
    let cross = |[a, b, c]: [T; 3], [x, y, z]: [T; 3]| [b * z - c * y, c * x - a * z, a * y - b * x];
    let once = cross(*r, *m);
    let twice = cross(*r, once);
    let two = T::one() + T::one();
    core::array::from_fn(|i| m[i] + two * (twice[i] - p * once[i]))
}

/// The coefficients of x_i d_i for the reciprocal moments x. Scales are such that h M/2 is m.
#[cold]
fn series<T: Scalar>(x: &[T; 3]) -> [[T; 4]; MONOMIALS] {
    let zero = T::zero();
    let others = |i: usize| ((i + 1) % 3, (i + 2) % 3);
    // e_i, less their mean: coefficients of α and of ε
    let raw: [[T; 2]; 3] = core::array::from_fn(|i| {
        let (j, k) = others(i);
        [x[j] * x[k], x[i]]
    });
    let third = T::from_ratio(1, 3);
    let mean: [T; 2] = core::array::from_fn(|part| third * (raw[0][part] + raw[1][part] + raw[2][part]));
    let roots: [[T; 2]; 3] = raw.map(|[a, b]| [a - mean[0], b - mean[1]]);
    let elliptic = elliptic(&roots);
    let mut all = [[zero; 4]; MONOMIALS];
    for i in 0..3 {
        let (j, k) = others(i);
        let differences = (x[i] - x[j]) * (x[i] - x[k]);
        // p = 1 + α P_i − e_i + …
        let mut p = elliptic;
        (p[1][0], p[1][1]) = (differences - roots[i][0], -roots[i][1]);
        let inverse = reciprocal(&p);
        let mut rate: Series<T> = [[zero; DEGREE + 1]; DEGREE + 1];
        rate[0][0] = x[i];
        for n in 1..=DEGREE {
            // (ε − x_i α) times the polynomial of one degree less
            let mut factor = [zero; DEGREE + 1];
            (factor[0], factor[1]) = (-differences * x[i], differences);
            add_product(&mut rate[n], (&factor, 1), (&inverse[n - 1], n - 1));
        }
        let solution = riccati(x[i], &rate);
        for (n, row) in solution.iter().enumerate() {
            for (part, value) in row.iter().enumerate().take(n + 1) {
                if let Some(entry) = all.get_mut(place(n - part, part)) {
                    entry[i] = x[i] * *value;
                }
            }
        }
    }
    all
}

/// τ²/4 ℘(τ/2) = 1 + Σ c_k of degree k, with the roots given by their coefficients of α and ε.
///
/// c₂ = g₂/20, c₃ = g₃/28, c_k = 3/((2k + 1)(k − 3)) Σ c_m c_{k−m}.
fn elliptic<T: Scalar>(roots: &[[T; 2]; 3]) -> Series<T> {
    let mut c: Series<T> = [[T::zero(); DEGREE + 1]; DEGREE + 1];
    let [[a, p], [b, q], [g, r]] = *roots;
    // g₂ = 2 Σ e_i², g₃ = 4 e₁e₂e₃
    let (tenth, seventh) = (T::from_ratio(1, 10), T::from_ratio(1, 7));
    c[2][0] = tenth * (a * a + b * b + g * g);
    c[2][1] = tenth * T::from_f64(2.0) * (a * p + b * q + g * r);
    c[2][2] = tenth * (p * p + q * q + r * r);
    c[3][0] = seventh * a * b * g;
    c[3][1] = seventh * (p * b * g + a * q * g + a * b * r);
    c[3][2] = seventh * (p * q * g + p * b * r + a * q * r);
    c[3][3] = seventh * p * q * r;
    for k in 4..=DEGREE {
        let mut row = [T::zero(); DEGREE + 1];
        for m in 2..=k - 2 {
            add_product(&mut row, (&c[m], m), (&c[k - m], k - m));
        }
        let factor = T::from_ratio(3, ((2 * k + 1) * (k - 3)) as i64);
        c[k] = row.map(|coefficient| factor * coefficient);
    }
    c[0][0] = T::one();
    c
}

/// 1/p for p = 1 + ….
fn reciprocal<T: Scalar>(p: &Series<T>) -> Series<T> {
    let mut inverse: Series<T> = [[T::zero(); DEGREE + 1]; DEGREE + 1];
    inverse[0][0] = T::one();
    for n in 1..=DEGREE {
        let mut row = [T::zero(); DEGREE + 1];
        for k in 1..=n {
            add_product(&mut row, (&p[k], k), (&inverse[n - k], n - k));
        }
        inverse[n] = row.map(|coefficient| -coefficient);
    }
    inverse
}

/// V of (2n − 1) V_n = −((α + V²) b)_n with V₀ = 1/b₀, which is the differential equation for d = V.
fn riccati<T: Scalar>(x: T, rate: &Series<T>) -> Series<T> {
    let mut v: Series<T> = [[T::zero(); DEGREE + 1]; DEGREE + 1];
    let mut square = v;
    v[0][0] = x.recip();
    square[0][0] = v[0][0] * v[0][0];
    for n in 1..=DEGREE {
        let mut row = [T::zero(); DEGREE + 1];
        // both halves of the square are the same
        for k in 1..n.div_ceil(2) {
            add_product(&mut row, (&v[k], k), (&v[n - k], n - k));
        }
        row = row.map(|coefficient| coefficient + coefficient);
        if n % 2 == 0 {
            add_product(&mut row, (&v[n / 2], n / 2), (&v[n / 2], n / 2));
        }
        if n == 1 {
            row[0] += T::one();
        }
        let mut right = row.map(|coefficient| coefficient * x);
        for k in 1..=n {
            add_product(&mut right, (&square[n - k], n - k), (&rate[k], k));
        }
        let factor = -T::from_ratio(1, (2 * n + 1) as i64);
        v[n] = right.map(|coefficient| factor * coefficient);
        let twice = T::from_f64(2.0) * v[0][0];
        square[n] = core::array::from_fn(|part| row[part] + twice * v[n][part]);
    }
    v
}

/// Adds the product of two homogeneous polynomials, given with their degrees.
fn add_product<T: Scalar>(sum: &mut [T; DEGREE + 1], one: (&[T; DEGREE + 1], usize), other: (&[T; DEGREE + 1], usize)) {
    for (i, a) in one.0.iter().enumerate().take(one.1 + 1) {
        for (entry, b) in sum.iter_mut().skip(i).zip(other.0.iter().take(other.1 + 1)) {
            *entry += *a * *b;
        }
    }
}

#[cfg(test)]
mod tests;
