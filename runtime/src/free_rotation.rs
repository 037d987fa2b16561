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
//! differences of inertia. Where few terms are not enough, those of a part of the time are, and formulas of duplication lead from d of a part
//! to d of twice the part, as often as it takes.
//!
//! Source: the equation is that of J. Moser and A. P. Veselov, *Discrete versions of some classical integrable systems and factorization of
//! matrix polynomials*, Comm. Math. Phys. 139 (1991); that modified constants make it exact, R. I. McLachlan and A. Zanna, *The discrete
//! Moser–Veselov algorithm for the free rigid body, revisited*, Found. Comput. Math. 5 (2005), for the first terms. The differential
//! equation follows from d_i = ½τ|M| cot Ψ_i, where tan(Ψ_i − Ψ_j) = |M| (x_i − x_j) σσ_k/(σ_iσ_j) in Weierstrass' functions of τ/2.

use crate::newton::Spectrum;
use crate::root::root;
use crate::space::{each_lane, lane_of, set_lane};
use crate::{Error, Real, Scalar};
use duplication::{Functions, duplicated};
use nalgebra::{Quaternion, SMatrix, SVector};
use num_traits::{One, Zero};
use series::{Coefficients, coefficient};
use turn::{balanced, ratio, turn, turn_of_tensor};

mod duplication;
mod series;
mod turn;

/// The most duplications: each doubles the error of the angle, which is that of its last digit.
const DUPLICATIONS: u32 = 24;

/// The error of an angle up to which it is still one.
const LARGEST_ERROR: f64 = 1.0 / 8192.0;

/// How many duplications numbers of this type are good for: 10 of `f32`.
fn duplications<T: Scalar>() -> u32 {
    let good =
        (1..=DUPLICATIONS).take_while(|&times| f64::from(1 << times) * T::Lane::EPSILON.to_f64() <= LARGEST_ERROR);
    good.last().unwrap_or(1)
}

/// What a motion keeps: d_i x over 2ⁿ, and 2⁻ⁿ, by which m is multiplied too; 0 where the motion is too long.
pub type KeptRotation<T> = SVector<T, 4>;

/// What no free motion of a body over a given time changes.
#[derive(Clone, Copy, Debug)]
pub struct FreeRotation<T> {
    /// h x/2 with the largest x of x_i = 1/J_i by size: m = `scale` M is free of units.
    scale: T,
    /// J_i x
    inertia: [T; 3],
    /// x_i/x
    reciprocals: [T; 3],
    axes: Axes<T>,
    series: Coefficients<T>,
    /// Up to which α a polynomial of each degree is enough.
    reach: [T; 9],
}

/// The axes in which vectors are written.
#[derive(Clone, Copy, Debug)]
enum Axes<T> {
    /// Those of the coordinates, which are principal axes.
    Coordinates,
    /// The columns of this rotation, which are principal axes.
    Principal(SMatrix<T, 3, 3>),
    /// Those of the coordinates, with J/x and X = xJ⁻¹: numbers with derivatives know no principal axes.
    Tensor { inertia: SMatrix<T, 3, 3>, reciprocal: SMatrix<T, 3, 3>, invariants: [T; 3] },
}

impl<T: Scalar> FreeRotation<T> {
    /// The free motions over the time `h` of a body with the inertia tensor `inertia`, of which the lower triangle is read.
    ///
    /// # Errors
    /// [`Error::SingularKineticEnergy`] where a principal moment is 0, [`Error::NotFinite`].
    pub fn new(inertia: &SMatrix<T, 3, 3>, h: T) -> Result<Self, Error> {
        Self::to_tolerance(inertia, h, 0.0)
    }

    /// The same with series that end before terms below `tolerance` of d: turns are of the group and momenta turn by them, but d, and with it
    /// the energy, is off by so much.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn to_tolerance(inertia: &SMatrix<T, 3, 3>, h: T, tolerance: f64) -> Result<Self, Error> {
        let of_lane = |lane: usize| {
            FreeRotation::<T::Lane>::of_number(&inertia.map(|entry| entry.lane(lane)), h.lane(lane), tolerance)
        };
        let first = of_lane(0)?;
        let everywhere = |number: T::Lane| T::from_lanes(|_| number);
        let mut all = Self {
            scale: everywhere(first.scale),
            inertia: first.inertia.map(everywhere),
            reciprocals: first.reciprocals.map(everywhere),
            axes: match first.axes {
                Axes::Coordinates => Axes::Coordinates,
                Axes::Principal(axes) => Axes::Principal(axes.map(everywhere)),
                Axes::Tensor { inertia, reciprocal, invariants } => Axes::Tensor {
                    inertia: inertia.map(everywhere),
                    reciprocal: reciprocal.map(everywhere),
                    invariants: invariants.map(everywhere),
                },
            },
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
        match (&mut self.axes, &other.axes) {
            (Axes::Coordinates, Axes::Coordinates) => {}
            (
                Axes::Tensor { inertia, reciprocal, invariants },
                Axes::Tensor { inertia: other, reciprocal: inverse, invariants: symmetric },
            ) => {
                put_all(inertia.as_mut_slice(), other.as_slice());
                put_all(reciprocal.as_mut_slice(), inverse.as_slice());
                put_all(invariants, symmetric);
            }
            (before, other) => {
                let mut axes = before.rotation();
                put_all(axes.as_mut_slice(), other.rotation().as_slice());
                *before = Axes::Principal(axes);
            }
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
    /// Accuracy: a few units in the last place of the angle. Work: a polynomial of degree up to 14 in two variables, and for long motions
    /// some hundred operations each time that the angle doubles. Lanes are turned one after the other; those that fail beside others are NaN.
    ///
    /// # Errors
    /// [`Error::Unsolvable`] where the angle is more than a thousand or so; [`Error::NotFinite`].
    #[inline(always)]
    pub fn turn(&self, momentum: &SVector<T, 3>) -> Result<(T, SVector<T, 3>), Error> {
        let m = self.in_principal_axes(momentum).map(|component| component * self.scale);
        let (w, x) = match T::LANES {
            // no closure: it would be called, and the turn would go through memory
            1 => in_one_lane(self.lane_turned(0, &m)?),
            _ => in_lanes(|lane| self.lane_turned(lane, &m))?,
        };
        Ok((w, self.in_coordinates(x)))
    }

    /// The momentum of the free motion that makes the rotation of less than half a turn with this Gibbs vector; NaN where none is found.
    ///
    /// The inverse of [`gibbs_vector`](Self::gibbs_vector).
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
                Some(d) => Some(self.turned(lane, &d, &m)),
                None => self.long_turn(lane, &m).ok(),
            }
            .map(|(w, x)| ratio((w, SVector::from(x))))
        };
        // the equation of Moser and Veselov, which is right to second order
        let c = SVector::from(*c);
        let image = match &self.axes {
            Axes::Tensor { inertia, .. } => lane_of(inertia, lane) * c,
            _ => SVector::from(of_lane(&self.inertia, lane)).component_mul(&c),
        };
        let start = (image + c.cross(&image)) * (one + c.dot(&c)).recip();
        // of the angle rather than of its tangent, which grows beyond all bounds towards half a turn
        let scale = (one + c.dot(&c)).recip();
        root(start, |m| Some((reached(m)? - c) * scale)).map_or(nothing, SVector::into)
    }

    /// d_i x of the whole time in a lane, or the coefficients of d; `None` where that is beyond the reach of the series.
    #[inline(always)]
    fn modified_inertia(&self, lane: usize, m: &[T::Lane; 3]) -> Option<[T::Lane; 3]> {
        let invariants = self.invariants(lane, m);
        self.sum_of_series(lane, invariants).map(|sum| self.scaled(lane, sum))
    }

    /// α = |m|² and ε = m·Xm.
    #[inline(always)]
    fn invariants(&self, lane: usize, m: &[T::Lane; 3]) -> [T::Lane; 2] {
        let squares = m.map(|component| component * component);
        let epsilon = match &self.axes {
            Axes::Tensor { reciprocal, .. } if T::DERIVATIVES > 0 => {
                let m = SVector::from(*m);
                m.dot(&(lane_of(reciprocal, lane) * m))
            }
            _ => {
                let [a, b, c] = of_lane(&self.reciprocals, lane);
                a * squares[0] + b * squares[1] + c * squares[2]
            }
        };
        [squares[0] + squares[1] + squares[2], epsilon]
    }

    /// x_i d_i, or the coefficients of X d, and τ²/4 ℘(τ/2), by the polynomial of the least degree that is enough.
    #[inline(always)]
    fn sum_of_series(&self, lane: usize, [alpha, epsilon]: [T::Lane; 2]) -> Option<[T::Lane; 4]> {
        macro_rules! degrees {
            ($($number:literal $degree:literal),*) => {$(
                if alpha <= self.reach[$number].lane(lane) {
                    return Some(self.polynomial::<$degree>(lane, alpha, epsilon));
                }
            )*};
        }
        degrees!(0 2, 1 3, 2 4, 3 5, 4 6, 5 8, 6 10, 7 12, 8 14);
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

    #[inline(always)]
    fn scaled(&self, lane: usize, [a, b, c, _]: [T::Lane; 4]) -> [T::Lane; 3] {
        match &self.axes {
            Axes::Tensor { .. } if T::DERIVATIVES > 0 => [a, b, c],
            _ => {
                let [x, y, z] = of_lane(&self.inertia, lane);
                [a * x, b * y, c * z]
            }
        }
    }

    /// A multiple of the quaternion with d ρ − m × ρ = ρ₀ m.
    #[inline(always)]
    fn turned(&self, lane: usize, d: &[T::Lane; 3], m: &[T::Lane; 3]) -> (T::Lane, [T::Lane; 3]) {
        match &self.axes {
            Axes::Tensor { inertia, reciprocal, .. } if T::DERIVATIVES > 0 => {
                // X d = c₀ + c₁X + c₂X²
                let (inertia, reciprocal) = (lane_of(inertia, lane), lane_of(reciprocal, lane));
                let tensor = inertia * d[0] + SMatrix::identity() * d[1] + reciprocal * d[2];
                turn_of_tensor(&tensor, m)
            }
            _ => turn(d, m),
        }
    }

    /// What the motion with the momentum `momentum` keeps, for many steps of it.
    pub fn motion(&self, momentum: &SVector<T, 3>) -> KeptRotation<T> {
        let m = self.in_principal_axes(momentum).map(|component| component * self.scale);
        let mut kept = KeptRotation::<T>::from_element(T::zero());
        for lane in 0..T::LANES {
            let m = of_lane(&m, lane);
            let found = match self.modified_inertia(lane, &m) {
                Some(inertia) => Ok((inertia, <T::Lane as One>::one())),
                None => self.long_motion(lane, &m),
            };
            if let Ok(([a, b, c], part)) = found {
                set_lane(&mut kept, lane, &SVector::from([a, b, c, part]));
            }
        }
        kept
    }

    /// As [`gibbs_vector`](Self::gibbs_vector), of a motion that is known.
    ///
    /// # Errors
    /// As [`turn`](Self::turn).
    #[inline]
    pub fn gibbs_vector_of(&self, kept: &KeptRotation<T>, momentum: &SVector<T, 3>) -> Result<SVector<T, 3>, Error> {
        self.turn_of(kept, momentum).map(ratio)
    }

    /// As [`turn`](Self::turn), of a motion that is known.
    ///
    /// # Errors
    /// As [`turn`](Self::turn).
    #[inline(always)]
    pub fn turn_of(&self, kept: &KeptRotation<T>, momentum: &SVector<T, 3>) -> Result<(T, SVector<T, 3>), Error> {
        let m = self.in_principal_axes(momentum).map(|component| component * self.scale);
        let (w, x) = match T::LANES {
            // as in `turn`
            1 => in_one_lane(self.lane_turned_of(0, kept, &m)?),
            _ => in_lanes(|lane| self.lane_turned_of(lane, kept, &m))?,
        };
        Ok((w, self.in_coordinates(x)))
    }

    /// The turn of one lane.
    ///
    /// # Errors
    /// As [`turn`](Self::turn).
    #[inline(always)]
    fn lane_turned(&self, lane: usize, m: &[T; 3]) -> Result<(T::Lane, [T::Lane; 3]), Error> {
        let m = of_lane(m, lane);
        match self.modified_inertia(lane, &m) {
            Some(d) => Ok(self.turned(lane, &d, &m)),
            None => self.long_turn(lane, &m),
        }
    }

    /// The same of a motion that keeps `kept`.
    ///
    /// # Errors
    /// As [`turn_of`](Self::turn_of).
    #[inline(always)]
    fn lane_turned_of(
        &self,
        lane: usize,
        kept: &KeptRotation<T>,
        m: &[T; 3],
    ) -> Result<(T::Lane, [T::Lane; 3]), Error> {
        let ([[a, b, c, part]], m) = (lane_of(kept, lane).data.0, of_lane(m, lane));
        match part == <T::Lane as One>::one() {
            true => Ok(self.turned(lane, &[a, b, c], &m)),
            false => self.long_turn_of(lane, &[a, b, c], part, &m),
        }
    }

    /// The same for a lane whose motion was made longer by duplication, or is too long for that.
    #[cold]
    #[inline(never)]
    fn long_turn_of(
        &self,
        lane: usize,
        d: &[T::Lane; 3],
        part: T::Lane,
        m: &[T::Lane; 3],
    ) -> Result<(T::Lane, [T::Lane; 3]), Error> {
        match part == <T::Lane as Zero>::zero() {
            true => self.long_turn(lane, m),
            false => Ok(self.turned_by_part(lane, d, part, m)),
        }
    }

    /// The turn of the whole time, of d over 2ⁿ and 2⁻ⁿ.
    #[inline]
    fn turned_by_part(
        &self,
        lane: usize,
        d: &[T::Lane; 3],
        part: T::Lane,
        m: &[T::Lane; 3],
    ) -> (T::Lane, [T::Lane; 3]) {
        balanced(self.turned(lane, d, &m.map(|component| component * part)))
    }

    /// The turn of a motion beyond the reach of the series.
    #[cold]
    #[inline(never)]
    fn long_turn(&self, lane: usize, m: &[T::Lane; 3]) -> Result<(T::Lane, [T::Lane; 3]), Error> {
        let (d, part) = self.long_motion(lane, m)?;
        Ok(self.turned_by_part(lane, &d, part, m))
    }

    /// d_i x over 2ⁿ, and 2⁻ⁿ, by n duplications: d ρ − m × ρ = ρ₀ m holds for multiples of d and m too.
    #[cold]
    fn long_motion(&self, lane: usize, m: &[T::Lane; 3]) -> Result<([T::Lane; 3], T::Lane), Error> {
        if m.iter().any(|component| !component.is_finite()) {
            return Err(Error::NotFinite { name: "the momentum" });
        }
        let (mut size, mut part) = (<T::Lane as One>::one(), *m);
        let most = duplications::<T>();
        for times in 1..=most {
            (size, part) = (half(size), part.map(half));
            let invariants = self.invariants(lane, &part);
            let sum = self.sum_of_series(lane, invariants);
            if let Some(d) = sum.and_then(|sum| self.made_longer(lane, invariants, sum, times)) {
                return Ok((d, size));
            }
        }
        let [.., reach] = of_lane(&self.reach, lane);
        let square = m.iter().fold(<T::Lane as Zero>::zero(), |sum, component| sum + *component * *component);
        let fraction = T::Lane::from_f64(0.999 * f64::from(1 << most)) * (reach / square).sqrt();
        Err(Error::Unsolvable { solvable_fraction: fraction.to_f64(), step_size: None, solvable_step: None })
    }

    /// d_i x, or the coefficients of X d, of 2ⁿ times the time that `sum` belongs to, over 2ⁿ; `None` where that has to be shorter.
    fn made_longer(
        &self,
        lane: usize,
        invariants: [T::Lane; 2],
        sum: [T::Lane; 4],
        times: u32,
    ) -> Option<[T::Lane; 3]> {
        let [a, b, c, p] = sum;
        match &self.axes {
            Axes::Tensor { invariants: symmetric, .. } if T::DERIVATIVES > 0 => {
                let e @ [first, second, third] = of_lane(symmetric, lane);
                // X⁻¹ = (X² − e₁X + e₂)/e₃
                let top = a / third;
                let d = [b + top * second, c - top * first, top];
                let [a, b, c] = duplicated(Functions::InPowers(e), invariants, d, p, times)?;
                Some([c * third, a - c * second, b + c * first])
            }
            _ => {
                let functions = Functions::OnAxes(of_lane(&self.reciprocals, lane));
                duplicated(functions, invariants, self.scaled(lane, sum), p, times)
            }
        }
    }

    #[inline]
    fn in_principal_axes(&self, vector: &SVector<T, 3>) -> [T; 3] {
        match &self.axes {
            Axes::Principal(axes) => axes.tr_mul(vector).into(),
            _ => [vector[0], vector[1], vector[2]],
        }
    }

    #[inline]
    fn in_coordinates(&self, vector: [T; 3]) -> SVector<T, 3> {
        match &self.axes {
            Axes::Principal(axes) => axes * SVector::from(vector),
            _ => SVector::from(vector),
        }
    }
}

impl<T: Real> FreeRotation<T> {
    /// The constants of one body.
    fn of_number(inertia: &SMatrix<T, 3, 3>, h: T, tolerance: f64) -> Result<Self, Error> {
        let is_diagonal = [(1, 0), (2, 0), (2, 1)].iter().all(|&place| inertia[place] == T::zero());
        let (moments, axes): ([T; 3], _) = match is_diagonal {
            true => ([0, 1, 2].map(|i| inertia[(i, i)]), Axes::Coordinates),
            false => {
                let spectrum = Spectrum::of(inertia);
                (spectrum.values.into(), Axes::Principal(spectrum.vectors))
            }
        };
        if moments.iter().any(|moment| !moment.is_finite()) {
            return Err(Error::NotFinite { name: "the inertia" });
        }
        let least =
            moments.iter().fold(moments[0], |least, &moment| if moment.abs() < least.abs() { moment } else { least });
        let singular = Error::SingularKineticEnergy { condition: f64::INFINITY };
        if T::DERIVATIVES > 0 {
            return Self::of_tensor(inertia, h, (moments.map(T::to_f64), least.to_f64()), tolerance).ok_or(singular);
        }
        let relative = moments.map(|moment| moment / least);
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
    fn of_tensor(inertia: &SMatrix<T, 3, 3>, h: T, (moments, least): ([f64; 3], f64), tolerance: f64) -> Option<Self> {
        let values = moments.map(|moment| T::from_f64(moment / least));
        if !values.iter().all(|moment| moment.is_finite()) {
            return None;
        }
        let x = values.map(T::recip);
        let reach = series::reach(&x, &series::on_axes(&x), tolerance);
        let symmetric = SMatrix::<T, 3, 3>::from_fn(|i, j| inertia[(i.max(j), i.min(j))]);
        let relative = symmetric * T::from_f64(least).recip();
        let columns: [SVector<T, 3>; 3] = core::array::from_fn(|i| relative.column(i).into_owned());
        let minors =
            SMatrix::<T, 3, 3>::from_columns(&[0, 1, 2].map(|i| columns[(i + 1) % 3].cross(&columns[(i + 2) % 3])));
        // the symmetric functions of X are those of J over its determinant
        let inverse = columns[0].dot(&minors.column(0)).recip();
        let invariants = [minors.trace() * inverse, relative.trace() * inverse, inverse];
        let axes = Axes::Tensor { inertia: relative, reciprocal: minors * inverse, invariants };
        let series = series::in_powers(&invariants);
        Some(Self { scale: half(h) * T::from_f64(least).recip(), inertia: values, reciprocals: x, axes, series, reach })
    }
}

impl<T: Scalar> Axes<T> {
    fn rotation(&self) -> SMatrix<T, 3, 3> {
        match self {
            Axes::Principal(axes) => *axes,
            _ => SMatrix::identity(),
        }
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

/// The numbers of one lane.
#[inline]
fn of_lane<T: Scalar, const N: usize>(numbers: &[T; N], lane: usize) -> [T::Lane; N] {
    numbers.map(|number| number.lane(lane))
}

/// The turn of a single number.
#[inline(always)]
fn in_one_lane<T: Scalar>((w, x): (T::Lane, [T::Lane; 3])) -> (T, [T; 3]) {
    (T::from_lanes(|_| w), x.map(|entry| T::from_lanes(|_| entry)))
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
        return Ok(in_one_lane(value(0)?));
    }
    let nothing = T::Lane::from_f64(f64::NAN);
    let all = each_lane::<T, _>((nothing, [nothing; 3]), value)?;
    Ok((T::from_lanes(|lane| all[lane].0), core::array::from_fn(|i| T::from_lanes(|lane| all[lane].1[i]))))
}

#[inline]
fn half<T: Scalar>(x: T) -> T {
    T::from_ratio(1, 2) * x
}

#[cfg(test)]
mod tests;
