//! Fields at rest: the configuration of least energy, by over-relaxation.

use super::edges::{Configured, Placed};
use super::stability::projection;
use super::{Domain, FieldSite, Lattice, Population, StaticField};
use crate::linear::{matrix, rows};
use crate::newton::{Ldl, Spectrum};
use crate::parts::{Mu, Q, T};
use crate::space::larger;
use crate::{Clebsch, Error, Real, Scalar, SiteError, Space};
use nalgebra::{SMatrix, SVector};
use num_traits::Zero;

/// The most sweeps as provided.
const SWEEPS: u64 = 10_000;
/// The tolerance as provided, and the least one in units of ε.
const TOLERANCE: f64 = 1e-10;
const ROUNDED: i64 = 64;
/// Corrections shrink by e^(−FOLDS) in a trial of the best factor.
const FOLDS: f64 = 4.0;
/// How much further from 2 a factor goes that was too large.
const BACK: f64 = 1.2;
/// Halvings of a correction that raises the energy, at most.
const HALVINGS: usize = 8;
/// The rounding errors of an energy, in units of ε of all of its terms.
pub(super) const ROUNDINGS: i64 = 32;
/// The least eigenvalue of a stiffness relative to the largest, where one is not positive.
const LEAST: f64 = 1e-6;

/// How a field is relaxed. Made by [`Domain::relax`].
///
/// ```
/// use clebsch::{Clebsch, Field};
/// use nalgebra::Vector1;
///
/// /// A soap film over a frame, its height x.
/// #[derive(Clebsch, Clone, Debug)]
/// #[clebsch(
///     action = |a: Translation<1>, x: Vector1| x + a,
///     space  = [|dx, x, next| (next - x).norm_squared() / (2 * dx), |dy, x, next| (next - x).norm_squared() / (2 * dy)],
/// )]
/// struct Film;
///
/// // height i on the sides, and none inside
/// let film = Film.grid([5, 5]).fixed();
/// let is_side = |site: &usize| film.lattice().is_fixed(*site);
/// let mut height: Vec<_> = (0..25).map(|site| Vector1::new(if is_side(&site) { (site / 5) as f64 } else { 0.0 })).collect();
/// let found = film.relax().tolerance(1e-13).solve(&mut height)?;
/// assert!((height[12].x - 2.0).abs() < 1e-12);
/// assert!((found.energy() - 10.0).abs() < 1e-12 && found.residual() < 1e-12);
/// # Ok::<(), clebsch::SiteError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Relaxation<'a, S: Clebsch + Clone, G, P: Population> {
    pub(super) domain: &'a Domain<S, G, P>,
    pub(super) tolerance: T<S>,
    sweeps: u64,
    factor: Option<T<S>>,
}

/// The result of a relaxation.
///
/// ```
/// # use clebsch::{Clebsch, Field};
/// # use nalgebra::Vector1;
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(
/// #     action = |a: Translation<1>, x: Vector1| x + a,
/// #     space  = |dx, x, next| (next - x).norm_squared() / (2 * dx),
/// # )]
/// # struct Strand;
/// let mut x = [0.0, 5.0, 2.0].map(Vector1::new);
/// let found = Strand.grid([3]).fixed().relax().solve(&mut x)?;
/// assert!(found.sweeps() < 10 && (found.energy() - 1.0).abs() < 1e-14);
/// # Ok::<(), clebsch::SiteError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Relaxed<T> {
    sweeps: u64,
    correction: T,
    residual: T,
    energy: T,
}

impl<T: Copy> Relaxed<T> {
    /// The sweeps over all sites.
    pub fn sweeps(&self) -> u64 {
        self.sweeps
    }

    /// The largest correction of the last sweep, in the coordinates of the group.
    pub fn correction(&self) -> T {
        self.correction
    }

    /// The largest component of the forces on sites that move: momenta per time.
    pub fn residual(&self) -> T {
        self.residual
    }

    /// The energy of all sites and edges, in joules.
    pub fn energy(&self) -> T {
        self.energy
    }
}

impl<T: Scalar> Relaxed<T> {
    /// The result with this configuration.
    pub(super) fn of<S, G, P: Population>(field: &Configured<'_, S, G, P>, sweeps: u64, correction: T) -> Self
    where
        S: FieldSite<Scalar = T>,
        G: Lattice<S>,
    {
        let sites = (0..field.q.len()).filter(|site| !field.lattice.is_fixed(*site));
        let residual = sites.fold(T::zero(), |residual, site| larger(residual, field.force_at(site).max_abs()));
        Self { sweeps, correction, residual, energy: field.energy(T::zero()) }
    }
}

impl<S: Clebsch<Scalar: Real> + Clone, G, P: Population> Domain<S, G, P> {
    /// A relaxation of this field to rest: to a configuration where no site feels a force.
    pub fn relax(&self) -> Relaxation<'_, S, G, P>
    where
        S: StaticField,
    {
        let least = T::<S>::EPSILON * T::<S>::from_ratio(ROUNDED, 1);
        let tolerance = larger(T::<S>::from_f64(TOLERANCE), least);
        Relaxation { domain: self, tolerance, sweeps: SWEEPS, factor: None }
    }
}

impl<S: Clebsch<Scalar: Real> + Clone, G, P: Population> Relaxation<'_, S, G, P> {
    /// The same with another tolerance: the largest correction of the last sweep, in the coordinates of the group. The larger one of
    /// 10⁻¹⁰ and 64 ε as provided. Slow modes are further from rest, by about the number of sites along the longest way.
    #[must_use]
    pub fn tolerance(self, tolerance: T<S>) -> Self {
        Self { tolerance, ..self }
    }

    /// The same with at most so many sweeps; 10 000 as provided.
    #[must_use]
    pub fn sweeps(self, sweeps: u64) -> Self {
        Self { sweeps, ..self }
    }

    /// The same with corrections that go `factor` times as far as the one that brings a single site to rest. It is between 0 and 2.
    /// With 1 no sweep raises the energy. As provided, it is found from the rate at which corrections shrink.
    #[must_use]
    pub fn over_relaxation(self, factor: T<S>) -> Self {
        Self { factor: Some(factor), ..self }
    }
}

impl<S, G, P: Population, const M: usize> Relaxation<'_, S, G, P>
where
    S: FieldSite<Momentum = SVector<<S as Clebsch>::Scalar, M>> + Clone,
    T<S>: Real,
    G: Lattice<S>,
{
    /// Moves the sites to rest, in place, from this guess. Sites that are fixed stay where they are.
    ///
    /// Each sweep moves one site after the other to where no force f acts on it. H are its own second derivatives, and w is the factor:
    ///
    /// ```text
    /// q ← exp(w H⁻¹f)·q
    /// ```
    ///
    /// Where H is not positive, eigenvalues are turned over: all corrections go downhill, to a minimum. The number of sweeps of a grid
    /// of n × n sites grows as n² with the factor 1, and as n with the best one. That is 2/(1 + sin(π/(n − 1))) for the equation of
    /// Laplace with fixed sides.
    ///
    /// Without a factor, trials find it. In a trial corrections would shrink by e⁻⁴ with the best factor. The rate in its second half
    /// decides the next one.
    ///
    /// Source: Hageman and Young, *Applied Iterative Methods*, chapter 9 (the factor from the rate of convergence).
    ///
    /// # Errors
    /// * [`Error::OverRelaxation`] for a factor that is not between 0 and 2, [`Error::NumberOfSites`]; with the site [`Error::NotFinite`] and [`Error::OffOrbit`] of its configuration. Nothing has
    ///   moved then.
    /// * [`Error::NotRelaxed`] after the most sweeps. The configuration is then the best one, from which to go on.
    /// * [`Error::NotFinite`] with the site where a force overflows.
    pub fn solve(&self, configuration: &mut [Q<S>]) -> Result<Relaxed<T<S>>, SiteError> {
        self.check(configuration)?;
        let placed = self.domain.placed();
        let mut rate = Rate::new(self.factor);
        let (mut sweeps, mut correction) = (0, T::<S>::zero());
        while sweeps < self.sweeps {
            let (largest, squares) = sweep(&placed, configuration, rate.factor, |_, _| ())?;
            sweeps += 1;
            correction = largest;
            if correction <= self.tolerance {
                return Ok(Relaxed::of(&placed.at(configuration), sweeps, correction));
            }
            rate.judge(squares.sqrt());
        }
        let tolerance = self.tolerance.to_f64();
        Err(Error::NotRelaxed { sweeps, correction: correction.to_f64(), tolerance }.into())
    }

    pub(super) fn check(&self, q: &[Q<S>]) -> Result<(), SiteError> {
        self.domain.lattice().check()?;
        let field = self.domain.configured(q);
        field.check_sites()?;
        if let Some(factor) = self.factor
            && !(factor > T::<S>::zero() && factor < T::<S>::from_ratio(2, 1))
        {
            return Err(Error::OverRelaxation { factor: factor.to_f64() }.into());
        }
        Ok(())
    }
}

/// The factor w of over-relaxation, found from the rate at which corrections shrink.
pub(super) struct Rate<T> {
    pub factor: T,
    is_given: bool,
    /// Sweeps of this trial, and the size of the corrections after its first half.
    sweeps: u64,
    half: T,
}

impl<T: Real> Rate<T> {
    pub fn new(factor: Option<T>) -> Self {
        Self { factor: factor.unwrap_or(T::one()), is_given: factor.is_some(), sweeps: 0, half: T::zero() }
    }

    /// The sweeps of one half of a trial. If w is the best factor, corrections shrink by e^(−FOLDS) in a trial.
    fn half_of_trial(&self) -> u64 {
        (FOLDS / 2.0 / (2.0 - self.factor.to_f64())) as u64
    }

    /// Takes the size of the corrections of a sweep. At the end of a trial their rate δ decides.
    ///
    /// One above w − 1 is that of the slowest mode. Its rate without over-relaxation is μ² with μ = (δ + w − 1)/(w√δ), and the best factor
    /// is 2/(1 + √(1 − μ²)). A rate of w − 1 is that of a factor that is too large.
    pub fn judge(&mut self, size: T) {
        self.sweeps += 1;
        let half = self.half_of_trial();
        if self.sweeps == half {
            self.half = size;
        }
        if self.is_given || self.sweeps < 2 * half {
            return;
        }
        self.sweeps = 0;
        let (one, two) = (T::one(), T::from_ratio(2, 1));
        let rate = (size / self.half).powf(T::from_f64(1.0 / half as f64));
        if rate >= one || !rate.is_finite() {
            return;
        }
        let mu = (rate + self.factor - one) / (self.factor * rate.sqrt());
        self.factor = if rate > self.factor - one && mu < one {
            larger(self.factor, two / (one + (one - mu * mu).sqrt()))
        } else {
            two - (two - self.factor) * T::from_f64(BACK)
        };
    }
}

/// One sweep: moves each site. Returns the largest motion, and the sum of the squares of all.
pub(super) fn sweep<S, G, P: Population, const M: usize>(
    placed: &Placed<'_, S, G, P>,
    q: &mut [Q<S>],
    factor: T<S>,
    mut visit: impl FnMut(usize, &Mu<S>),
) -> Result<(T<S>, T<S>), SiteError>
where
    S: FieldSite<Momentum = SVector<<S as Clebsch>::Scalar, M>>,
    T<S>: Real,
    G: Lattice<S>,
{
    let (mut largest, mut squares) = (T::<S>::zero(), T::<S>::zero());
    for site in 0..q.len() {
        if placed.lattice.is_fixed(site) {
            continue;
        }
        let Some((moved, motion)) = placed.at(q).relaxed(site, factor)? else { continue };
        if let Some(q) = q.get_mut(site) {
            *q = moved;
        }
        visit(site, &motion);
        largest = larger(largest, motion.max_abs());
        squares += motion.dot(&motion);
    }
    Ok((largest, squares))
}

impl<S, G, P: Population, const M: usize> Configured<'_, S, G, P>
where
    S: FieldSite<Momentum = SVector<<S as Clebsch>::Scalar, M>>,
    T<S>: Real,
    G: Lattice<S>,
{
    /// A site moved towards its rest, and the motion; `None` where it rests.
    #[allow(clippy::type_complexity, reason = "a configuration and a motion")]
    fn relaxed(&self, site: usize, factor: T<S>) -> Result<Option<(Q<S>, Mu<S>)>, SiteError> {
        let Some((system, q)) = self.site(site) else { return Ok(None) };
        let force = self.force_at(site);
        let size = force.max_abs();
        if size.is_zero() {
            return Ok(None);
        }
        let projection = projection(system, q);
        let step = downhill(&self.stiffness_at(site, T::<S>::zero(), &projection), &projection, &force);
        if !(size.is_finite() && step.all_finite()) {
            return Err(SiteError { site: Some(site), error: Error::NotFinite { name: "the force on a site" } });
        }
        let (before, terms) = self.energy_at(site, q);
        let rounding = T::<S>::EPSILON * T::<S>::from_ratio(ROUNDINGS, 1);
        let mut motion = step * factor;
        let load = self.load.and_then(|load| load.get(site));
        for _ in 0..HALVINGS {
            let moved = system.moved_by(q, &motion);
            let (after, others) = self.energy_at(site, &moved);
            let work = load.map_or_else(T::<S>::zero, |load| load.dot(&motion));
            if after - work <= before + rounding * (terms + others + work.abs()) {
                return Ok(Some((moved, motion)));
            }
            motion *= T::<S>::from_ratio(1, 2);
        }
        // it stays, and the correction counts: near rest it is as small as the rounding of the energy
        Ok(Some((*q, motion)))
    }
}

/// H⁻¹f with eigenvalues of the wrong sign turned over. Motions that do not move the site, outside of the image of P, have no force.
fn downhill<T: Real, const M: usize>(
    stiffness: &SMatrix<T, M, M>,
    projection: &SMatrix<T, M, M>,
    force: &SVector<T, M>,
) -> SVector<T, M> {
    let mut size = stiffness.max_abs();
    if size.is_zero() {
        size = T::one();
    }
    // with a stiffness of the same size along the others
    let filled = stiffness + (SMatrix::identity() - projection) * size;
    if let Some(factors) = Ldl::positive(&rows(&filled)) {
        let inverse: SMatrix<T, M, M> = matrix(factors.inverse_root());
        return inverse.transpose() * (inverse * force);
    }
    let spectrum = Spectrum::of(&filled);
    let least = spectrum.largest() * T::from_f64(LEAST);
    spectrum.map(|value| larger(value.abs(), least).recip()) * force
}
