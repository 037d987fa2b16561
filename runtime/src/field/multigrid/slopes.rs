//! The energy of a field along motions of all sites.

use crate::field::edges::Configured;
use crate::field::stability::unit;
use crate::field::{FieldSite, Lattice, Population};
use crate::parts::{Mu, T};
use crate::{Clebsch, Real, Scalar};
use nalgebra::SVector;
use num_traits::{One, Zero};

/// Curvatures are singular where their determinant is a smaller part of the product of the diagonal.
const SINGULAR: f64 = 1e-6;

/// The derivatives of the energy along two motions: the work f·ξ of all forces, and the curvatures −Df(ξ)·η.
#[derive(Clone, Copy)]
pub(super) struct Slopes<T> {
    work: [T; 2],
    curvature: [[T; 2]; 2],
}

impl<T: Real> Slopes<T> {
    /// How far to go along the first motion alone to the least energy; 1 where it is not curved upwards. `None` where it rises.
    pub fn least_along_first(&self) -> Option<T> {
        let (work, curvature) = (self.work[0], self.curvature[0][0]);
        let factor = if curvature > T::zero() { work / curvature } else { T::one() };
        (work > T::zero() && factor.is_finite()).then_some(factor)
    }

    /// How far to go along both; along the first alone where both are nearly the same.
    pub fn least(&self) -> Option<[T; 2]> {
        let ([f, g], [[a, b], [_, c]]) = (self.work, self.curvature);
        let (product, determinant) = (a * c, a * c - b * b);
        if a > T::zero() && determinant > product.abs() * T::from_f64(SINGULAR) {
            let factors = [(f * c - g * b) / determinant, (a * g - b * f) / determinant];
            return factors.iter().all(|factor| Scalar::is_finite(*factor)).then_some(factors);
        }
        self.least_along_first().filter(|_| a > T::zero()).map(|factor| [factor, T::zero()])
    }
}

impl<S, G: Lattice<S>, P: Population, const M: usize> Configured<'_, S, G, P>
where
    S: FieldSite<Momentum = SVector<<S as Clebsch>::Scalar, M>>,
    T<S>: Real,
{
    /// The size of the second derivatives of edges by both ends, in each direction of a lattice.
    pub(super) fn couplings<const D: usize>(&self, lattice: &impl Lattice<S>) -> [T<S>; D] {
        let mut couplings = [(T::<S>::zero(), T::<S>::zero()); D];
        for site in 0..self.q.len() {
            lattice.visit_edges(site, |edge, end| {
                let Some((system, q)) = self.ends(edge).filter(|_| end == 0) else { return };
                for j in 0..M {
                    let change = lattice.forces_along(system, edge, q, [&unit(j), &SVector::zeros()]).1;
                    couplings[edge.direction].0 += change.dot(&change);
                }
                couplings[edge.direction].1 += T::<S>::one();
            });
        }
        couplings.map(|(squares, edges)| if edges.is_zero() { T::<S>::zero() } else { (squares / edges).sqrt() })
    }

    /// The derivatives of the energy along two motions of all sites; a motion without sites is none.
    pub(super) fn slopes(&self, motions: [&[Mu<S>]; 2]) -> Slopes<T<S>> {
        let mut slopes = Slopes { work: [T::<S>::zero(); 2], curvature: [[T::<S>::zero(); 2]; 2] };
        for (i, own) in motions.iter().enumerate().filter(|(_, own)| !own.is_empty()) {
            let along = |site: usize| own.get(site).copied().unwrap_or_else(SVector::zeros);
            let mut change = alloc::vec![SVector::zeros(); own.len()];
            for site in 0..own.len() {
                let Some((system, q)) = self.site(site) else { continue };
                slopes.work[i] += self.force_at(site).dot(&along(site));
                if S::HAS_POTENTIAL {
                    let by_potential = system.force_on_site_along(T::<S>::zero(), q, &along(site));
                    add(&mut change, site, &(by_potential * self.lattice.share(site)));
                }
                self.lattice.visit_edges(site, |edge, end| {
                    let Some((system, q)) = self.ends(edge).filter(|_| end == 0) else { return };
                    let (before, after) = self.lattice.forces_along(system, edge, q, edge.ends.map(along).each_ref());
                    add(&mut change, edge.ends[0], &before);
                    add(&mut change, edge.ends[1], &after);
                });
            }
            for (curvature, other) in slopes.curvature[i].iter_mut().zip(motions) {
                *curvature = -change.iter().zip(other).fold(T::<S>::zero(), |sum, (change, own)| sum + change.dot(own));
            }
        }
        // the second derivative along exp(s ξ) is the symmetric part
        let across = (slopes.curvature[0][1] + slopes.curvature[1][0]) * T::<S>::from_ratio(1, 2);
        (slopes.curvature[0][1], slopes.curvature[1][0]) = (across, across);
        slopes
    }

    /// The energy, and the sum of the sizes of all terms.
    pub(super) fn energy_and_size(&self) -> (T<S>, T<S>) {
        let (mut energy, mut size) = (T::<S>::zero(), T::<S>::zero());
        for site in 0..self.q.len() {
            let Some((system, q)) = self.site(site) else { continue };
            let mut own = self.lattice.share(site) * system.potential(T::<S>::zero(), q);
            size += own.abs();
            self.lattice.visit_edges(site, |edge, end| {
                let Some((system, q)) = self.ends(edge).filter(|_| end == 0) else { return };
                let edge = self.lattice.energy_of_edge(system, edge, q);
                own += edge;
                size += edge.abs();
            });
            energy += own;
        }
        (energy, size)
    }
}

/// Adds to the value of a site.
fn add<T: Scalar, const M: usize>(values: &mut [SVector<T, M>], site: usize, value: &SVector<T, M>) {
    if let Some(sum) = values.get_mut(site) {
        *sum += value;
    }
}
