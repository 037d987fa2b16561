//! Squares of n × n sites, their edges, and configurations of unit vectors and springs on them.

use clebsch::Clebsch;
use nalgebra::Vector3;

/// Springs between neighbours, and one from each site to 0.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |a: Translation<1>, x: Vector1| x + a,
    potential = |x| self.stiffness * x.norm_squared() / 2,
    space     = [|dx, x, next| (next - x).norm_squared() / 2, |dy, x, next| (next - x).norm_squared() / 2],
)]
pub struct Springs {
    pub stiffness: f64,
}

/// The instanton of Belavin and Polyakov on [−2, 2]², with n sites along a side: a map of degree 1 to the sphere.
pub fn instanton(n: usize, size: f64) -> Vec<Vector3<f64>> {
    let at = |i: usize| -2.0 + 4.0 * i as f64 / (n - 1) as f64;
    let place = |site: usize| {
        let (x, y) = (at(site / n), at(site % n));
        let (squared, own) = (x * x + y * y, size * size);
        Vector3::new(2.0 * size * x, 2.0 * size * y, squared - own) / (squared + own)
    };
    (0..n * n).map(place).collect()
}

/// Unit vectors that are smooth on the sides and rough inside.
pub fn waved(n: usize) -> Vec<Vector3<f64>> {
    let at = |i: usize| -2.0 + 4.0 * i as f64 / (n - 1) as f64;
    let place = |site: usize| {
        let (x, y) = (at(site / n), at(site % n));
        let rough = 0.3 * ((site as f64 * 12.9898).sin() * 43758.5).fract();
        Vector3::new(x.sin() + rough, (x * y).cos(), 1.0 + 0.5 * y).normalize()
    };
    (0..n * n).map(place).collect()
}

/// The edges of a square of n × n sites.
pub fn edges(n: usize) -> impl Iterator<Item = [usize; 2]> {
    (0..n * n).flat_map(move |site| {
        let right = (site % n + 1 < n).then_some([site, site + 1]);
        right.into_iter().chain((site + n < n * n).then_some([site, site + n]))
    })
}
