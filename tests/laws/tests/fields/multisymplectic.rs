//! The multisymplectic formula on linearised solutions of harmonic maps and of bodies in a sheet, found by differences.

use clebsch::{Clebsch, Error, Field, SiteError};
use clebsch_tests::fixtures::harmonic_map::HarmonicMap;
use nalgebra::{Matrix3, Rotation3, Vector2, Vector3};

/// How far the sides are moved for a difference.
const SHORT: f64 = 1e-4;

/// Bodies at the corners of triangles, with springs that are stiff about some axes.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<3>, R: SO<3>| R * F,
    space  = |length, W| {
        let x = W.cayley();
        x.dot(&self.stiffness.component_mul(&x)) / 2
    },
)]
struct Bodies {
    stiffness: Vector3<f64>,
}

/// Motions of the sides, smooth and in general position.
fn pushed(site: usize, phase: f64) -> Vector3<f64> {
    let s = site as f64;
    Vector3::new((0.9 * s + phase).sin(), (0.4 * s - phase).cos(), (0.2 * s * phase).sin())
}

/// The derivative of a configuration at rest by a factor of the motions of the sides.
fn linearised<A: Copy>(
    relaxed: impl Fn(f64) -> Result<Vec<A>, SiteError>,
    motion: impl Fn(&A, &A, &A) -> Vector3<f64>,
) -> Result<Vec<Vector3<f64>>, SiteError> {
    let [before, at, after] = [relaxed(-SHORT)?, relaxed(0.0)?, relaxed(SHORT)?];
    Ok(at.iter().zip(before.iter().zip(&after)).map(|(q, (before, after))| motion(q, before, after)).collect())
}

#[test]
fn linearised_harmonic_maps_pair_to_zero() -> Result<(), SiteError> {
    let n = 9;
    let square = HarmonicMap.grid([n, n]).fixed();
    let start = |site: usize| {
        let (x, y) = (0.3 * (site / n) as f64, 0.3 * (site % n) as f64);
        Vector3::new(x.sin(), (x * y).cos(), 1.0 + 0.5 * y).normalize()
    };
    let relaxed = |phase: f64| {
        move |factor: f64| -> Result<Vec<Vector3<f64>>, SiteError> {
            let square = HarmonicMap.grid([n, n]).fixed();
            let is_side = |site: usize| square.lattice().is_fixed(site);
            let place = |site: usize| {
                let turn = if is_side(site) { pushed(site, phase) * factor } else { Vector3::zeros() };
                Rotation3::new(turn) * start(site)
            };
            let mut q: Vec<_> = (0..n * n).map(place).collect();
            square.relax().multigrid().tolerance(1e-15).cycles(40).solve(&mut q).map(|_| ()).or_else(finished)?;
            Ok(q)
        }
    };
    let motion =
        |q: &Vector3<f64>, before: &Vector3<f64>, after: &Vector3<f64>| q.cross(&(after - before)) / (2.0 * SHORT);
    let (v, w) = (linearised(relaxed(0.3), motion)?, linearised(relaxed(1.1), motion)?);
    let q = relaxed(0.0)(0.0)?;
    let regions: [&dyn Fn(usize) -> bool; 4] =
        [&|_| true, &|site| site % n < 5, &|site| (site / n + site % n) % 7 < 5, &|site| (site / n).abs_diff(4) < 3];
    for (number, is_inside) in regions.into_iter().enumerate() {
        let sum = square.multisymplectic(&q, [&v, &w], is_inside)?;
        assert!(sum.abs() < 1e-6, "region {number}: {sum}");
        // motions that are no solution do not pair to zero
        let other: Vec<_> = w.iter().enumerate().map(|(site, w)| w + q[site].cross(&pushed(3 * site, 0.7))).collect();
        let sum = square.multisymplectic(&q, [&v, &other], is_inside)?;
        assert!(number == 0 || sum.abs() > 1e-2, "region {number}: {sum}");
    }
    let refused = square.multisymplectic(&q, [&v, &w[1..]], |_| true);
    assert_eq!(refused, Err(Error::NumberOfSites { found: n * n - 1, sites: n * n }.into()));
    Ok(())
}

/// Rounding may leave corrections above a tolerance of 1e-15.
fn finished(error: SiteError) -> Result<(), SiteError> {
    match error.error {
        Error::NotRelaxed { correction, .. } if correction < 1e-12 => Ok(()),
        _ => Err(error),
    }
}

#[test]
fn linearised_bodies_pair_to_zero() -> Result<(), SiteError> {
    let (n, m) = (6, 5);
    let place = |site: usize| {
        let (i, j) = ((site / m) as f64, (site % m) as f64);
        Vector2::new(i + 0.1 * (3.0 * j).sin(), j + 0.1 * (2.0 * i).cos())
    };
    let square = |k: usize| {
        let (i, j) = (k / (m - 1), k % (m - 1));
        let [a, b, c, d] = [i * m + j, (i + 1) * m + j, (i + 1) * m + j + 1, i * m + j + 1];
        [[a, b, c], [a, c, d]]
    };
    let vertices: Vec<_> = (0..n * m).map(place).collect();
    let faces: Vec<_> = (0..(n - 1) * (m - 1)).flat_map(square).collect();
    let bodies = Bodies { stiffness: Vector3::new(1.0, 2.0, 0.6) };
    let sheet = bodies.mesh(&vertices, &faces)?.cotangent_weights()?.fixed();
    let relaxed = |phase: f64| {
        let sheet = &sheet;
        move |factor: f64| -> Result<Vec<Matrix3<f64>>, SiteError> {
            let turn = |site: usize| {
                let own = Rotation3::new(pushed(site, 0.2) * 0.4);
                let more = if sheet.lattice().is_fixed(site) { pushed(site, phase) * factor } else { Vector3::zeros() };
                (own * Rotation3::new(more)).into_inner()
            };
            let mut q: Vec<_> = (0..n * m).map(turn).collect();
            sheet.relax().tolerance(1e-15).sweeps(3000).solve(&mut q).map(|_| ()).or_else(finished)?;
            Ok(q)
        }
    };
    let motion = |q: &Matrix3<f64>, before: &Matrix3<f64>, after: &Matrix3<f64>| {
        let a = q.transpose() * (after - before) / (2.0 * SHORT);
        Vector3::new(a[(2, 1)] - a[(1, 2)], a[(0, 2)] - a[(2, 0)], a[(1, 0)] - a[(0, 1)]) / 2.0
    };
    let (v, w) = (linearised(relaxed(0.5), motion)?, linearised(relaxed(1.3), motion)?);
    let q = relaxed(0.0)(0.0)?;
    for (number, is_inside) in [(0, 30), (1, 17), (2, 24)] {
        let sum = sheet.multisymplectic(&q, [&v, &w], |site| site < is_inside)?;
        assert!(sum.abs() < 1e-6, "region {number}: {sum}");
    }
    let other: Vec<_> = (0..n * m).map(|site| pushed(site, 2.0)).collect();
    assert!(sheet.multisymplectic(&q, [&v, &other], |site| site < 17)?.abs() > 1e-2);
    Ok(())
}
