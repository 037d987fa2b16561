//! The longest step at which small waves of a field do not grow.

use super::edges::{Configured, Edge};
use super::lattice::times;
use super::{Domain, FieldSite, FieldState, FieldStepper, Lattice, Population};
use crate::linear::{matrix, rows};
use crate::newton::{Ldl, Spectrum};
use crate::parts::{Mu, Q, T};
use crate::space::larger;
use crate::stepper::step_size::{Asked, STEPS, growth};
use crate::{Clebsch, Error, Real, Scalar, SiteError, Space};
use nalgebra::{SMatrix, SVector};
use num_traits::{One, Zero};

/// The largest hω at which an oscillation of frequency ω does not grow, by the order of the steps. There |tr M|/2 exceeds 1 for the
/// first time, with M the map of a step.
fn largest_phase(order: u32) -> f64 {
    match order {
        4 => 2.720_974_538,
        6 => 2.961_370_239,
        8 => 3.096_438_680,
        _ => 2.0,
    }
}

impl<S, G, P: Population, const M: usize> Domain<S, G, P>
where
    S: FieldSite<Momentum = SVector<<S as Clebsch>::Scalar, M>> + Clone,
    T<S>: Real,
    G: Lattice<S>,
{
    /// A step size up to which small waves about a configuration of all sites at rest do not grow.
    ///
    /// H are the second derivatives of all energies, and Σ is the inertia:
    ///
    /// ```text
    /// c/√λ,    λ = max over sites a of ‖Σ_a⁻¹H_aa‖ + Σ over neighbours b of ‖Σ_a⁻¹H_ab‖ ≥ λ_max(Σ⁻¹H),
    /// ```
    ///
    /// At order 2 c is 2. At orders 4, 6 and 8 it is 2.721, 2.961 and 3.096. For waves on a grid in d directions it is the limit of Courant,
    /// Friedrichs and Lewy itself, dx/√d. It is infinite where nothing pulls a site back.
    ///
    /// Waves that are not small change H: leave a margin, as in `0.9 * domain.stable_step(&q)?`. Spins turn the site that they belong
    /// to; their own frequency is not in H.
    ///
    /// ```
    /// use clebsch::{Clebsch, Field};
    /// use nalgebra::Vector3;
    ///
    /// #[derive(Clebsch, Clone, Debug)]
    /// #[clebsch(
    ///     action = |F: SO<3>, q: Unit<Vector3>| F * q,
    ///     cost   = |h, F| (F - I).norm_squared() / (4 * h),
    ///     space  = [
    ///         |dx, q, next| (next - q).norm_squared() / (2 * dx.powi(2)),
    ///         |dy, q, next| (next - q).norm_squared() / (2 * dy.powi(2)),
    ///     ],
    /// )]
    /// struct WaveMap;
    ///
    /// let sheet = WaveMap.grid([8, 8]).spacing([0.1, 0.1]).periodic();
    /// let h = sheet.stable_step(&[Vector3::z(); 64])?;
    /// assert!((h - 0.1 / 2.0_f64.sqrt()).abs() < 1e-15);
    /// # Ok::<(), clebsch::SiteError>(())
    /// ```
    ///
    /// Source: Feingold and Varga, *Block diagonally dominant matrices and generalizations of the Gerschgorin circle
    /// theorem*, Pacific Journal of Mathematics 12 (1962).
    ///
    /// # Errors
    /// [`Error::NumberOfSites`]; with the site [`Error::NotFinite`] and [`Error::OffOrbit`] of its configuration, and
    /// [`Error::IndefiniteKineticEnergy`] for an inertia that is not positive.
    pub fn stable_step(&self, configuration: &[Q<S>]) -> Result<T<S>, SiteError> {
        let field = self.configured(configuration);
        field.stable_step(T::<S>::zero())
    }
}

impl<S, G, P: Population, const M: usize> FieldStepper<S, G, P>
where
    S: FieldSite<Momentum = SVector<<S as Clebsch>::Scalar, M>> + Clone,
    T<S>: Real,
    G: Lattice<S>,
{
    /// A step size up to which small waves about the configuration of a state do not grow, as
    /// [`Domain::stable_step`] gives it.
    ///
    /// # Errors
    /// As [`Domain::stable_step`].
    pub fn stable_step<Points, Momenta>(&self, state: &FieldState<Points, Momenta, S::Time>) -> Result<T<S>, SiteError>
    where
        Points: AsRef<[Q<S>]>,
    {
        self.configured(state.configuration().as_ref()).stable_step(state.time())
    }

    /// Small waves about the configuration of a state surely do not grow at this step size.
    ///
    /// # Errors
    /// [`Error::UnstableStep`] above [`stable_step`](Self::stable_step), and those of it.
    pub fn check_stable<Points, Momenta>(&self, state: &FieldState<Points, Momenta, S::Time>) -> Result<(), SiteError>
    where
        Points: AsRef<[Q<S>]>,
    {
        let (step_size, stable) = (self.step_size().abs(), self.stable_step(state)?);
        if step_size <= stable {
            return Ok(());
        }
        Err(Error::UnstableStep { step_size: step_size.to_f64(), stable: stable.to_f64() }.into())
    }

    /// A step size with which the motion from `start` is wrong by about `error` after `duration`, and never above
    /// [`stable_step`](Self::stable_step).
    ///
    /// It is found by probing runs as for [`Stepper::suggest_step_size`](crate::Stepper::suggest_step_size), with steps of h and of
    /// h/2. The error is the largest of all sites.
    ///
    /// # Errors
    /// As [`Stepper::suggest_step_size`](crate::Stepper::suggest_step_size) and [`stable_step`](Self::stable_step).
    pub fn suggest_step_size<Points, Momenta>(
        &self,
        start: &FieldState<Points, Momenta, S::Time>,
        error: T<S>,
        duration: T<S>,
    ) -> Result<T<S>, SiteError>
    where
        Points: AsRef<[Q<S>]> + AsMut<[Q<S>]> + Clone,
        Momenta: AsRef<[Mu<S>]> + AsMut<[Mu<S>]> + Clone,
    {
        let longest = self.stable_step(start)?;
        let asked = Asked { h: self.step_size(), error, duration, longest, order: S::ORDER_OF_FIELD };
        asked.suggestion(|h, time| self.probe(start, h, time))
    }

    /// How fast the error with steps of h grows, by steps of h and of h/2 side by side.
    fn probe<Points, Momenta>(
        &self,
        start: &FieldState<Points, Momenta, S::Time>,
        h: T<S>,
        time: T<S>,
    ) -> Result<Option<T<S>>, SiteError>
    where
        Points: AsRef<[Q<S>]> + AsMut<[Q<S>]> + Clone,
        Momenta: AsRef<[Mu<S>]> + AsMut<[Mu<S>]> + Clone,
    {
        let signed = if self.step_size() < T::<S>::zero() { -h } else { h };
        let (plain, halved) = (self.of_step_size(signed)?, self.of_step_size(signed * T::<S>::from_ratio(1, 2))?);
        let (mut a, mut b) = (start.clone(), start.clone());
        let (mut steps, mut difference, mut size) = (0, T::<S>::zero(), largest(b.momentum().as_ref()));
        while steps < STEPS[1] && T::<S>::from_ratio(steps, 1) * h < time {
            plain.step(&mut a)?;
            halved.advance(&mut b, 2)?;
            steps += 1;
            size = larger(size, largest(b.momentum().as_ref()));
            let turned = farthest(a.configuration().as_ref(), b.configuration().as_ref());
            let pushed = farthest(a.momentum().as_ref(), b.momentum().as_ref());
            let pushed = if size > T::<S>::zero() { pushed / size } else { pushed };
            difference = larger(difference, larger(turned, pushed));
        }
        let size = T::<S>::one() + largest(start.configuration().as_ref());
        Ok(growth(difference, (steps, h), size, S::ORDER_OF_FIELD))
    }
}

/// The largest number in the values of all sites.
fn largest<T: Real, V: Space<T>>(values: &[V]) -> T {
    values.iter().fold(T::zero(), |largest, value| larger(largest, value.max_abs()))
}

/// The largest distance of the values of a site.
fn farthest<T: Real, V: Space<T>>(a: &[V], b: &[V]) -> T {
    a.iter().zip(b).fold(T::zero(), |farthest, (a, b)| larger(farthest, a.distance_squared(b))).sqrt()
}

/// The inertia of a site and its roots: EΣEᵀ = 1, C = EΣ = E⁻ᵀ.
#[derive(Clone, Copy)]
struct Roots<T, const M: usize> {
    inertia: SMatrix<T, M, M>,
    inverse: SMatrix<T, M, M>,
    root: SMatrix<T, M, M>,
}

impl<T: Real, const M: usize> Roots<T, M> {
    fn of<S: FieldSite<Scalar = T, Momentum = SVector<T, M>>>(system: &S, t: T, q: &Q<S>) -> Result<Self, Error> {
        system.check_kinetic_energy(t, q)?;
        let at_rest = system.momentum_of_velocity(t, q, &SVector::zeros());
        let mut inertia = SMatrix::<T, M, M>::zeros();
        for j in 0..M {
            let momentum = system.momentum_of_velocity(t, q, &unit(j));
            for i in 0..M {
                inertia[(i, j)] = momentum[i] - at_rest[i];
            }
        }
        let factors = Ldl::definite(&rows(&inertia), T::one()).ok_or(Error::NotFinite { name: "the inertia" })?;
        let inverse = matrix(factors.inverse_root());
        Ok(Self { inertia, inverse, root: inverse * inertia })
    }
}

/// The unit vector of a coordinate.
pub(super) fn unit<T: Scalar, const M: usize>(j: usize) -> SVector<T, M> {
    SVector::from_fn(|i, _| if i == j { T::one() } else { T::zero() })
}

/// ‖A‖₂. That of the last matrix is known.
struct Norms<T, const M: usize> {
    last: Option<(SMatrix<T, M, M>, T)>,
}

impl<T: Real, const M: usize> Norms<T, M> {
    fn of(&mut self, a: SMatrix<T, M, M>) -> T {
        match self.last {
            Some((last, norm)) if last == a => norm,
            _ => {
                let norm = Spectrum::of(&(a.transpose() * a)).largest().sqrt();
                self.last = Some((a, norm));
                norm
            }
        }
    }
}

impl<S, G, P: Population, const M: usize> Configured<'_, S, G, P>
where
    S: FieldSite<Momentum = SVector<<S as Clebsch>::Scalar, M>>,
    T<S>: Real,
    G: Lattice<S>,
{
    fn stable_step(&self, t: T<S>) -> Result<T<S>, SiteError> {
        self.check_sites()?;
        let sites = self.lattice.sites();
        let (mut all, mut norms) = (T::<S>::zero(), Norms { last: None });
        let mut first: Option<Roots<T<S>, M>> = None;
        for site in (0..sites).filter(|site| !self.lattice.is_fixed(*site)) {
            let Some((system, q)) = self.site(site) else { continue };
            let at = |error| SiteError { site: Some(site), error };
            let roots = Roots::of(system, t, q).map_err(at)?;
            let first = first.get_or_insert(roots);
            let bound = self.bound_at(site, t, (first, &roots), &mut norms);
            if !bound.is_finite() {
                return Err(at(Error::NotFinite { name: "the stiffness of the edges at a site" }));
            }
            all = larger(all, bound);
        }
        Ok(T::<S>::from_f64(largest_phase(S::ORDER_OF_FIELD)) / all.sqrt())
    }

    /// ‖Σ_a⁻¹H_aa‖ + Σ ‖Σ_a⁻¹H_ab‖ of a site, in the norm |Cξ| with C of the first one.
    fn bound_at(
        &self,
        site: usize,
        t: T<S>,
        (first, own): (&Roots<T<S>, M>, &Roots<T<S>, M>),
        norms: &mut Norms<T<S>, M>,
    ) -> T<S> {
        // Σ_a⁻¹ = EᵀE, and both roots cancel where all inertias are the same
        let scale =
            if own.inertia == first.inertia { own.inverse } else { first.root * own.inverse.transpose() * own.inverse };
        let inverse = first.inverse.transpose();
        let mut neighbours = T::<S>::zero();
        self.lattice.visit_edges(site, |edge, end| {
            let is_moved = edge.ends.get(1 - end).is_some_and(|neighbour| !self.lattice.is_fixed(*neighbour));
            if is_moved {
                let mut block = SMatrix::zeros();
                self.add_block(&mut block, edge, [end, 1 - end]);
                neighbours += norms.of(scale * block * inverse);
            }
        });
        let stiffness = self.site(site).map(|(system, q)| self.stiffness_at(site, t, &projection(system, q)));
        norms.of(scale * stiffness.unwrap_or_else(SMatrix::zeros) * inverse) + neighbours
    }

    /// H_aa of a site: P H P with the projection P to motions that move the site, where some do not.
    pub(super) fn stiffness_at(&self, site: usize, t: T<S>, projection: &SMatrix<T<S>, M, M>) -> SMatrix<T<S>, M, M> {
        let mut stiffness = SMatrix::zeros();
        let Some((system, q)) = self.site(site) else { return stiffness };
        if S::HAS_POTENTIAL {
            for j in 0..M {
                let change = system.force_on_site_along(t, q, &unit(j));
                subtract_from(&mut stiffness, j, &times::<S>(&change, self.lattice.share(site)));
            }
        }
        self.lattice.visit_edges(site, |edge, end| self.add_block(&mut stiffness, edge, [end, end]));
        // the second derivative along exp(s η) is the symmetric part
        let symmetric = (stiffness + stiffness.transpose()) * T::<S>::from_ratio(1, 2);
        projection * symmetric * projection
    }

    /// Adds the second derivatives of the energy of an edge by motions of two of its ends, the second one by column.
    fn add_block(&self, block: &mut SMatrix<T<S>, M, M>, edge: Edge, [end, moved]: [usize; 2]) {
        let Some((system, q)) = self.ends(edge) else { return };
        let none = SVector::<T<S>, M>::zeros();
        for j in 0..M {
            let direction = unit(j);
            let motions = if moved == 0 { [&direction, &none] } else { [&none, &direction] };
            let (before, after) = self.lattice.forces_along(system, edge, q, motions);
            subtract_from(block, j, if end == 0 { &before } else { &after });
        }
    }
}

/// The orthogonal projection of momenta to those of motions of q.
pub(super) fn projection<S: FieldSite<Momentum = SVector<<S as Clebsch>::Scalar, M>>, const M: usize>(
    system: &S,
    q: &Q<S>,
) -> SMatrix<T<S>, M, M> {
    let mut projection = SMatrix::zeros();
    for j in 0..M {
        let column = system.project_momentum(q, &unit(j));
        for i in 0..M {
            projection[(i, j)] = column[i];
        }
    }
    projection
}

/// Subtracts from a column.
fn subtract_from<T: Scalar, const M: usize>(matrix: &mut SMatrix<T, M, M>, j: usize, column: &SVector<T, M>) {
    for i in 0..M {
        if let (Some(entry), Some(x)) = (matrix.get_mut((i, j)), column.get(i)) {
            *entry -= *x;
        }
    }
}
