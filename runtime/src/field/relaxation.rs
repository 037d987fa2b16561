//! Fields at rest: the configuration of least energy, by over-relaxation.

use super::edges::Configured;
use super::stability::projection;
use super::{Domain, FieldSite, Lattice, Population, StaticField};
use crate::linear::{matrix, rows};
use crate::newton::{Ldl, Spectrum};
use crate::parts::{Mu, Q, T};
use crate::space::{larger, plus};
use crate::stepper::check_on_orbit;
use crate::{Clebsch, Error, Real, Scalar, SiteError, Space};
use nalgebra::{SMatrix, SVector};
use num_traits::Zero;

/// The most sweeps as provided.
const SWEEPS: u64 = 10_000;
/// The tolerance as provided.
const TOLERANCE: f64 = 1e-10;
/// Sweeps with one factor before it is judged, at least.
const TRIAL: u64 = 6;
/// Halvings of a correction that raises the energy, at most.
const HALVINGS: usize = 8;
/// The rounding errors of the energy of a site, in units of ε of all of its terms.
const ROUNDINGS: i64 = 32;
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
    domain: &'a Domain<S, G, P>,
    tolerance: T<S>,
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

impl<S: Clebsch<Scalar: Real> + Clone, G, P: Population> Domain<S, G, P> {
    /// A relaxation of this field to rest: to a configuration where no site feels a force.
    pub fn relax(&self) -> Relaxation<'_, S, G, P>
    where
        S: StaticField,
    {
        Relaxation { domain: self, tolerance: T::<S>::from_f64(TOLERANCE), sweeps: SWEEPS, factor: None }
    }
}

impl<S: Clebsch<Scalar: Real> + Clone, G, P: Population> Relaxation<'_, S, G, P> {
    /// The same with another tolerance: the largest correction of the last sweep, in the coordinates of the group. 10⁻¹⁰ as
    /// provided. Slow modes are further from rest, by about the number of sites along the longest way.
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
    /// Laplace with fixed sides. The factor that is found may take several times as many.
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
        let mut rate = Rate::new(self.factor);
        let (mut sweeps, mut correction) = (0, T::<S>::zero());
        while sweeps < self.sweeps {
            let (largest, squares) = self.sweep(configuration, rate.factor)?;
            sweeps += 1;
            correction = largest;
            if correction <= self.tolerance {
                return self.found(configuration, sweeps, correction);
            }
            rate.judge(squares.sqrt());
        }
        let tolerance = self.tolerance.to_f64();
        Err(Error::NotRelaxed { sweeps, correction: correction.to_f64(), tolerance }.into())
    }

    fn check(&self, q: &[Q<S>]) -> Result<(), SiteError> {
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

    /// One sweep. Returns the largest correction, and the sum of the squares of all.
    fn sweep(&self, q: &mut [Q<S>], factor: T<S>) -> Result<(T<S>, T<S>), SiteError> {
        let (mut largest, mut squares) = (T::<S>::zero(), T::<S>::zero());
        for site in 0..q.len() {
            if self.domain.lattice().is_fixed(site) {
                continue;
            }
            let field = self.domain.configured(q);
            let Some((moved, motion)) = field.relaxed(site, factor)? else { continue };
            if let Some(q) = q.get_mut(site) {
                *q = moved;
            }
            largest = larger(largest, motion.max_abs());
            squares += motion.dot(&motion);
        }
        Ok((largest, squares))
    }

    fn found(&self, q: &[Q<S>], sweeps: u64, correction: T<S>) -> Result<Relaxed<T<S>>, SiteError> {
        let field = self.domain.configured(q);
        let mut residual = T::<S>::zero();
        let sites = (0..q.len()).filter(|site| !self.domain.lattice().is_fixed(*site));
        sites.for_each(|site| residual = larger(residual, field.force_at(site).max_abs()));
        Ok(Relaxed { sweeps, correction, residual, energy: field.energy() })
    }
}

/// The factor w of over-relaxation, found from the rate at which corrections shrink.
struct Rate<T> {
    factor: T,
    is_given: bool,
    /// Sweeps with this factor.
    sweeps: u64,
    /// The size of the last correction, and the rate before.
    last: Option<(T, T)>,
}

impl<T: Real> Rate<T> {
    fn new(factor: Option<T>) -> Self {
        Self { factor: factor.unwrap_or(T::one()), is_given: factor.is_some(), sweeps: 0, last: None }
    }

    /// Takes the size of the corrections of a sweep. A steady rate δ is that of the slowest mode, whose rate without over-relaxation is
    /// μ² with μ = (δ + w − 1)/(w√δ). The best factor for it is 2/(1 + √(1 − μ²)).
    fn judge(&mut self, size: T) {
        self.sweeps += 1;
        let Some((last, before)) = self.last.replace((size, T::zero())) else { return };
        let rate = size / last;
        self.last = Some((size, rate));
        let one = T::one();
        let is_steady = (rate - before).abs() < T::from_ratio(1, 10) * (one - rate);
        // corrections of the best factor shrink by w − 1
        if self.is_given || self.sweeps < TRIAL || !is_steady || rate >= one || rate <= self.factor - one {
            return;
        }
        let mu = (rate + self.factor - one) / (self.factor * rate.sqrt());
        if mu < one {
            let best = T::from_ratio(2, 1) / (one + (one - mu * mu).sqrt());
            if best > self.factor {
                (self.factor, self.sweeps, self.last) = (best, 0, None);
            }
        }
    }
}

impl<S, G, P: Population> Configured<'_, S, G, P>
where
    S: FieldSite,
    G: Lattice<S>,
{
    /// There is a configuration for each site, and it is one.
    pub(super) fn check_sites(&self) -> Result<(), SiteError> {
        let (found, sites) = (self.q.len(), self.lattice.sites());
        if found != sites {
            return Err(Error::NumberOfSites { found, sites }.into());
        }
        for site in 0..sites {
            let Some((system, q)) = self.site(site) else { continue };
            check_on_orbit(q, system.orbit_defect(q)).map_err(|error| SiteError { site: Some(site), error })?;
        }
        Ok(())
    }

    /// The force on a site, of its potential and of all edges.
    fn force_at(&self, site: usize) -> Mu<S> {
        let Some((system, q)) = self.site(site) else { return Space::origin() };
        let mut force = system.force_on_site(T::<S>::zero(), q);
        self.lattice.visit_edges(site, |edge, end| {
            let Some((system, q)) = self.ends(edge) else { return };
            let (own, next) = self.lattice.forces(system, edge, q);
            force = plus(&force, if end == 0 { &own } else { &next });
        });
        force
    }

    /// The energy of all sites and edges.
    fn energy(&self) -> T<S> {
        let potential =
            |site| self.site(site).map_or_else(T::<S>::zero, |(system, q)| system.potential(T::<S>::zero(), q));
        let sites = (0..self.q.len()).fold(T::<S>::zero(), |sum, site| sum + potential(site));
        let Some(first) = self.systems.first() else { return sites };
        sites + self.lattice.energy(|site| self.systems.get(P::number(site)).unwrap_or(first), self.q)
    }

    /// The energy of a site and of its edges, if it stood at `q`. Behind it is the sum of the sizes of all terms, which tells its rounding.
    fn energy_at(&self, site: usize, q: &Q<S>) -> (T<S>, T<S>) {
        let Some((system, _)) = self.site(site) else { return (T::<S>::zero(), T::<S>::zero()) };
        let mut energy = system.potential(T::<S>::zero(), q);
        let mut size = energy.abs();
        self.lattice.visit_edges(site, |edge, end| {
            let Some((system, mut ends)) = self.ends(edge) else { return };
            // an edge from the site to itself is visited for each end
            let is_own = edge.ends == [site; 2];
            if is_own && end == 1 {
                return;
            }
            for (place, number) in ends.iter_mut().zip(edge.ends) {
                if number == site {
                    *place = q;
                }
            }
            let own = self.lattice.energy_of_edge(system, edge, ends);
            energy += own;
            size += own.abs();
        });
        (energy, size)
    }
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
        let stiffness = self.stiffness_at(site, T::<S>::zero());
        let step = downhill(&stiffness, &projection(system, q), &force);
        if !(size.is_finite() && step.all_finite()) {
            return Err(SiteError { site: Some(site), error: Error::NotFinite { name: "the force on a site" } });
        }
        let (before, terms) = self.energy_at(site, q);
        let rounding = T::<S>::EPSILON * T::<S>::from_ratio(ROUNDINGS, 1);
        let mut motion = step * factor;
        for _ in 0..HALVINGS {
            let moved = system.moved_by(q, &motion);
            let (after, others) = self.energy_at(site, &moved);
            if after <= before + rounding * (terms + others) {
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
