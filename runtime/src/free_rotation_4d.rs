//! The free motion of a rigid body in four dimensions, exactly: M′ = MΩ − ΩM, R′ = RΩ with M = DΩ + ΩD. The constants
//! serve as long as it is the same motion.
//!
//! A motion conserves |M|², the Pfaffian of M, its energy, and one more quadratic integral. The map of Moser and Veselov commutes with it, so that
//! four constants of the motion make that map exact:
//!
//! ```text
//! m = h̃M = F̃J̃ − J̃F̃ᵀ,    J̃² = D² + β,    F = exp(h(δM + κ⋆M)) F̃,    ⋆M the dual of M
//! ```
//! They are found once, from the Taylor series of one step. A step then solves no equation by iteration, because A =
//! F̃J̃ obeys A² = mA + J̃². The characteristic polynomial λ⁴ − e₁λ³ + e₂λ² − e₃λ + e₄ of A is a constant of the
//! motion. F̃ is the solution of
//!
//! ```text
//! N F̃ = G,    N = m³ + J̃²m + mJ̃² + e₂m − e₁(m² + J̃²) − e₃,    G = −(m² + J̃² − e₁m + e₂ + e₄J̃⁻²)J̃
//! ```
//! The e_i are taken from m anew in each step, from det(λ² − λm − J̃²): taken over unchanged, rounding would grow exponentially.
//!
//! Source: J. Moser and A. P. Veselov, *Discrete versions of some classical integrable systems and factorization of matrix polynomials*,
//! Comm. Math. Phys. 139 (1991); for the integrals S. V. Manakov, *Note on the integration of Euler's equations of the dynamics of an n-dimensional
//! rigid body*, Funct. Anal. Appl. 10 (1976). By the theorem of Liouville and Arnold the map is the flow of a function of the four integrals.

use crate::free_rotation::axes::Axes;
use crate::linear::{matrix, rows};
use crate::parameters::invert;
use crate::root::root;
use crate::space::each_lane;
use crate::{Error, Mask, Real, Scalar, Space};
use flow::{Matrix, Moved, PLANES, Vector, above, dot, flow, product, skew};
use nalgebra::{SMatrix, SVector};
use setup::Constants;
use turn::{composed, turn};

pub(crate) mod flow;
mod setup;
pub(crate) mod turn;

/// The most parts that a motion is made of.
const PARTS: u32 = 1024;
/// The most Taylor series of a step, with those that are too long. Each part usually takes one.
const SERIES: u32 = 8 * PARTS;

/// The constants of a motion, one after the other.
pub type KeptRotation4<T> = setup::Numbers<T>;

/// The error of a motion whose end no series finds.
const ENDLESS: Error = Error::NotFinite { name: "the free motion" };

/// The constants of all free motions of a body over a given time.
#[derive(Clone, Copy, Debug)]
pub struct FreeRotation4<T> {
    /// d_i/s, with the largest s of them.
    moments: [T; 4],
    /// h/s: by it momenta are free of units.
    scale: T,
    axes: Axes<T, Tensor<T>, 4>,
}

/// s Σ⁻¹
type Tensor<T> = SMatrix<T, 6, 6>;

impl<T: Scalar> FreeRotation4<T> {
    /// The free motions over the time `h` of a body with the quadratic form `inertia` of velocities; only its lower
    /// triangle is read.
    ///
    /// # Errors
    /// [`Error::SingularKineticEnergy`] where Σ is singular, [`Error::NotFinite`].
    pub fn new(inertia: &SMatrix<T, 6, 6>, h: T) -> Result<Self, Error> {
        let mut all = Self { moments: Space::<T>::origin(), scale: T::zero(), axes: Axes::unset() };
        for lane in 0..T::LANES {
            let own = FreeRotation4::of_number(&inertia.lane(lane), h.lane(lane))?;
            all.moments.set_lane(lane, &own.moments);
            all.scale.set_lane(lane, &own.scale);
            all.axes.set_lane(lane, &own.axes);
        }
        Ok(all)
    }

    /// The constants of the motion with the momentum `momentum`; those of a motion that is too long are 0.
    #[cold]
    pub fn motion(&self, momentum: &SVector<T, 6>) -> KeptRotation4<T> {
        let m = self.in_principal_axes(momentum);
        let mut kept: KeptRotation4<T> = Space::<T>::origin();
        for lane in 0..T::LANES {
            if let Ok(found) = self.of_lane(lane).constants(&m.lane(lane)) {
                kept.set_lane(lane, &found.write());
            }
        }
        kept
    }

    /// F − I and the momentum after a step of the motion with these constants.
    ///
    /// # Errors
    /// [`Error::Unsolvable`] where the motion is too long, [`Error::NotFinite`]: of the first lane, where all fail; else those lanes are NaN.
    #[inline]
    pub fn turn(&self, kept: &KeptRotation4<T>, momentum: &Vector<T>) -> Result<(SMatrix<T, 4, 4>, Vector<T>), Error> {
        let constants = Constants::read(kept);
        let m = self.in_principal_axes(momentum);
        let alone = constants.parts.equals(T::one()) & constants.by_series.equals(T::zero());
        let turned = if alone.all() { turn(&constants, &(m * constants.step)) } else { None };
        let (increment, next) = match turned {
            Some((increment, next)) => (increment, next * constants.step.recip()),
            None => self.lane_by_lane(kept, &m)?,
        };
        Ok(self.in_coordinates(&increment, &next))
    }

    /// The same if lanes have different numbers of parts, or if a turn has lost its digits.
    #[cold]
    #[inline(never)]
    fn lane_by_lane(&self, kept: &KeptRotation4<T>, m: &Vector<T>) -> Result<Moved<T>, Error> {
        let nothing = T::Lane::from_f64(f64::NAN);
        let all = each_lane::<T, _>(([[nothing; 4]; 4], SVector::from_element(nothing)), |lane| {
            self.of_lane(lane).in_parts(&Constants::read(&kept.lane(lane)), &m.lane(lane))
        })?;
        Ok(Space::<T>::side_by_side(|lane| all[lane]))
    }

    fn of_lane(&self, lane: usize) -> FreeRotation4<T::Lane> {
        FreeRotation4 { moments: self.moments.lane(lane), scale: self.scale.lane(lane), axes: self.axes.lane(lane) }
    }

    /// The entries above the diagonal of hM/s. Components are those below it.
    #[inline]
    fn in_principal_axes(&self, momentum: &Vector<T>) -> Vector<T> {
        let scaled = momentum * -self.scale;
        match &self.axes {
            // columns, one after the other, are the rows of the transposed
            Axes::Principal(axes) => above(&product(&axes.data.0, &product(&skew(&scaled), &rows(axes)))),
            _ => scaled,
        }
    }

    #[inline]
    fn in_coordinates(&self, increment: &Matrix<T>, m: &Vector<T>) -> (SMatrix<T, 4, 4>, Vector<T>) {
        let inverse = -self.scale.recip();
        match &self.axes {
            Axes::Principal(axes) => {
                let turned = |a: &Matrix<T>| product(&rows(axes), &product(a, &axes.data.0));
                (matrix(turned(increment)), above(&turned(&skew(m))) * inverse)
            }
            _ => (matrix(*increment), m * inverse),
        }
    }
}

impl<T: Real> FreeRotation4<T> {
    /// The constants of one body.
    fn of_number(inertia: &SMatrix<T, 6, 6>, h: T) -> Result<Self, Error> {
        if inertia.iter().any(|entry| !entry.is_finite()) {
            return Err(Error::NotFinite { name: "the inertia" });
        }
        let (moments, axes) = Axes::principal(&mass(inertia));
        let size = moments.max_abs();
        let inverse = size.recip();
        let relative = moments * inverse;
        // Σ_(ij) = d_i + d_j
        let [[p, q, r, s]] = relative.data.0;
        let least = [p + q, p + r, p + s, q + r, q + s, r + s].into_iter().map(T::abs);
        let least = least.fold(T::one(), |least, sum| if sum < least { sum } else { least });
        let is_regular = least > T::EPSILON;
        if !is_regular {
            return Err(Error::SingularKineticEnergy { condition: f64::INFINITY });
        }
        let axes = if T::DERIVATIVES > 0 { Axes::Tensor(invert(inertia)? * size) } else { axes };
        Ok(Self { moments: relative.into(), scale: h * inverse, axes })
    }

    /// The constants of the motion with m = hM/s: as few parts as will do.
    #[cold]
    fn constants(&self, m: &Vector<T>) -> Result<Constants<T>, Error> {
        if m.iter().any(|entry| !entry.is_finite()) {
            return Err(Error::NotFinite { name: "the momentum" });
        }
        let velocity = self.velocity(m);
        let angle = dot(&velocity, &velocity).sqrt().to_f64();
        let is_short = angle < f64::from(PARTS);
        if !is_short {
            return Err(Error::unsolvable(0.999 * f64::from(PARTS) / angle));
        }
        // parts of no more than a radian, or so few that their series end
        let fewest = (0..10).fold(1, |parts, _| if f64::from(parts) < angle { 2 * parts } else { parts });
        let mut parts = fewest;
        while parts <= PARTS && !matches!(self.axes, Axes::Tensor(_)) {
            let part = T::from_ratio(1, i64::from(parts));
            if let Some(found) = setup::set_up(&self.moments, &(m * part)) {
                return Ok(Constants { parts: T::from_f64(f64::from(parts)), step: part * found.step, ..found });
            }
            parts *= 2;
        }
        let parts = T::from_f64(f64::from(fewest));
        Ok(Constants { parts, by_series: T::one(), step: parts.recip(), ..Constants::read(&Space::<T>::origin()) })
    }

    /// F − I and the momentum after a part of a motion. It takes one series, or some series of half the time, of a
    /// quarter, …: each as long as possible. Each takes one off the number `left`.
    fn series(&self, m: &Vector<T>, left: &mut u32) -> Result<Moved<T>, Error> {
        let (mut whole, mut m) = ([[T::zero(); 4]; 4], *m);
        // of the time, in units of 1/PARTS
        let (mut done, mut length) = (0, PARTS);
        while done < PARTS {
            *left = left.checked_sub(1).ok_or(ENDLESS)?;
            let part = T::from_ratio(i64::from(length), i64::from(PARTS));
            match flow(|m| self.velocity(m), &(m * part)) {
                Some((increment, end)) => {
                    whole = if done == 0 { increment } else { composed(&whole, &increment) };
                    m = end * part.recip();
                    done += length;
                    // the remainder of the half that was too long
                    while done & (2 * length - 1) == 0 && done < PARTS {
                        length *= 2;
                    }
                }
                None if length == 1 => return Err(ENDLESS),
                None => length /= 2,
            }
        }
        Ok((whole, m))
    }

    fn velocity(&self, m: &Vector<T>) -> Vector<T> {
        match &self.axes {
            Axes::Tensor(inverse) => inverse * m,
            _ => setup::velocity(&self.moments, m),
        }
    }

    /// F − I and the momentum after all parts of the time.
    fn in_parts(&self, constants: &Constants<T>, m: &Vector<T>) -> Result<Moved<T>, Error> {
        // no constants, or none that were made here: the motion says why, or gives its own
        let constants = if constants.are_of_parts() { *constants } else { self.constants(m)? };
        let parts = constants.parts.to_f64() as u32;
        let by_series = constants.by_series > T::zero();
        // h̃ of the formulas, and the time of a series
        let (step, part) = (constants.step, constants.parts.recip());
        let (mut whole, mut left) = ([[T::zero(); 4]; 4], SERIES);
        let mut m = m * if by_series { part } else { step };
        for _ in 0..parts {
            let (increment, next) = if by_series {
                self.series(&m, &mut left)?
            } else {
                match turn(&constants, &m) {
                    Some(moved) => moved,
                    None => {
                        let (increment, next) = self.series(&(m / step * part), &mut left)?;
                        (increment, next / part * step)
                    }
                }
            };
            (whole, m) = (composed(&whole, &increment), next);
        }
        Ok((whole, m * if by_series { constants.parts } else { step.recip() }))
    }
}

/// The momentum of the free motion over the time `h` from I to `f`, which Newton's method finds from M = (FD − DFᵀ)/h.
/// NaN if it finds none.
#[cold]
pub fn free_momentum_4d<T: Scalar>(inertia: &SMatrix<T, 6, 6>, h: T, f: &SMatrix<T, 4, 4>) -> SVector<T, 6> {
    Space::<T>::side_by_side(|lane| {
        let found = momentum_of(&inertia.lane(lane), h.lane(lane), &f.lane(lane));
        found.unwrap_or(SVector::from_element(T::Lane::from_f64(f64::NAN)))
    })
}

fn momentum_of<T: Real>(inertia: &SMatrix<T, 6, 6>, h: T, f: &SMatrix<T, 4, 4>) -> Option<SVector<T, 6>> {
    let free = FreeRotation4::new(inertia, h).ok()?;
    // columns, one after the other: those of the transposed
    let below = |a: &SMatrix<T, 4, 4>| above(&a.data.0);
    // the turn that is left, R(μ)ᵀF, is small: its skew part tells it
    let defect = |momentum: &SVector<T, 6>| {
        let (increment, _) = free.turn(&free.motion(momentum), momentum).ok()?;
        let left = f.tr_mul(&increment) + f.transpose();
        Some(below(&(left - left.transpose())))
    };
    let mass = mass(inertia);
    let skew = f * mass - mass * f.transpose();
    root(below(&skew) * h.recip(), defect)
}

/// The symmetric D of a quadratic form Σ with ΣΩ = DΩ + ΩD: from R_ij = Σ_k Σ(e_i∧e_k, e_j∧e_k) = 2D + tr D.
pub(crate) fn mass<T: Scalar>(inertia: &SMatrix<T, 6, 6>) -> SMatrix<T, 4, 4> {
    // the component and the sign of e_i∧e_k
    let plane = |i: usize, k: usize| {
        let (low, high) = (i.min(k), i.max(k));
        let index = PLANES.iter().position(|&plane| plane == (low, high)).unwrap_or(0);
        (index, if i < k { T::one() } else { -T::one() })
    };
    // the lower triangle; by construction there is such an entry
    let entry = |a: usize, b: usize| inertia.get((a.max(b), a.min(b))).copied().unwrap_or_else(T::zero);
    let ricci = SMatrix::<T, 4, 4>::from_fn(|i, j| {
        (0..4).filter(|&k| k != i && k != j).fold(T::zero(), |sum, k| {
            let ((a, sign), (b, other)) = (plane(i, k), plane(j, k));
            sum + sign * other * entry(a, b)
        })
    });
    let mean = ricci.trace() * T::from_ratio(1, 6);
    (ricci - SMatrix::identity() * mean) * T::from_ratio(1, 2)
}

#[cfg(test)]
mod tests;
