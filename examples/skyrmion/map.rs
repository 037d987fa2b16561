//! The declaration, the maps of the scene, and their solution on one grid.

use clebsch::{Clebsch, Domain, Field, Grid, SiteError};
use nalgebra::Vector3;
use std::f64::consts::PI;

/// Harmonic maps of a square to the sphere: the energy of an edge does not depend on its length.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<3>, q: Unit<Vector3>| F * q,
    space  = [|dx, q, next| (next - q).norm_squared() / 2, |dy, q, next| (next - q).norm_squared() / 2],
)]
pub struct HarmonicMap;

/// A square of sites, from −side/2 to side/2 in both directions.
#[derive(Clone, Copy, Debug)]
pub struct Square {
    /// Cells along a side, one less than sites.
    pub cells: usize,
    /// The length of a side.
    pub side: f64,
}

/// A map to the sphere at a place.
pub type Map<'a> = &'a dyn Fn(f64, f64) -> Vector3<f64>;

impl Square {
    /// Sites along a side.
    pub fn sites(&self) -> usize {
        self.cells + 1
    }

    /// The place of a site.
    pub fn place(&self, site: usize) -> [f64; 2] {
        [site / self.sites(), site % self.sites()].map(|i| self.side * (i as f64 / self.cells as f64 - 0.5))
    }

    /// The values of a map at all sites.
    pub fn values(&self, map: Map<'_>) -> Vec<Vector3<f64>> {
        let value = |site: usize| {
            let [x, y] = self.place(site);
            map(x, y)
        };
        (0..self.sites() * self.sites()).map(value).collect()
    }

    /// The field whose sides do not move.
    pub fn field(&self) -> Domain<HarmonicMap, Grid<f64, 2>> {
        HarmonicMap.grid([self.sites(); 2]).fixed()
    }

    /// The energy, the degree, and the energy less 4π |degree|. Edges along the sides belong to the square by half.
    pub fn above_degree(&self, q: &[Vector3<f64>]) -> Result<(f64, f64, f64), SiteError> {
        let n = self.sites();
        let field = self.field();
        let is_side = |site: usize| field.lattice().is_fixed(site);
        let mut energy = 0.0;
        for site in 0..n * n {
            let right = (site % n + 1 < n).then_some(site + 1);
            for next in right.into_iter().chain((site + n < n * n).then_some(site + n)) {
                let share = if is_side(site) && is_side(next) { 0.5 } else { 1.0 };
                energy += share * (q[next] - q[site]).norm_squared() / 2.0;
            }
        }
        let degree = field.lattice().degree(q)?;
        Ok((energy, degree, energy - 4.0 * PI * degree.abs()))
    }
}

/// The instanton of a size λ, a map of degree 1: (2λx, 2λy, r² − λ²)/(r² + λ²).
pub fn instanton(size: f64) -> impl Fn(f64, f64) -> Vector3<f64> {
    move |x, y| {
        let (squared, own) = (x * x + y * y, size * size);
        Vector3::new(2.0 * size * x, 2.0 * size * y, squared - own) / (squared + own)
    }
}

/// A smooth map of degree 0.
pub fn smooth(x: f64, y: f64) -> Vector3<f64> {
    Vector3::new((0.7 * x).sin(), (0.3 * x * y).cos(), 1.0 + 0.3 * y).normalize()
}
