//! Fields at rest: harmonic maps against published energies, and the sweeps that they take.

use super::squares::{Springs, edges, instanton, waved};
use clebsch::{Field, Side, Sides, SiteError};
use clebsch_tests::fixtures::harmonic_map::HarmonicMap;
use nalgebra::Vector1;

/// Energies of a reference solution by Newton's method, for the instanton of size 0.7 on the sides.
#[test]
fn the_instanton_has_the_energy_of_the_reference() -> Result<(), SiteError> {
    let mut distances = Vec::new();
    // the energy less 4π times the degree, and the distance to the instanton
    for (n, energy, above, distance) in [(33, 11.355273, -0.07059, 0.04159), (65, 11.40789, -0.0172, 0.009475)] {
        let square = HarmonicMap.grid([n, n]).fixed();
        let exact = instanton(n, 0.7);
        let mut q = exact.clone();
        let found = square.relax().solve(&mut q)?;
        // an edge along a side has a square on one hand alone: the reference counts half of it
        let is_side = |[a, b]: &[usize; 2]| [a, b].iter().all(|site| square.lattice().is_fixed(**site));
        let sides: f64 = edges(n).filter(is_side).map(|[a, b]| (q[a] - q[b]).norm_squared() / 2.0).sum();
        let inside = found.energy() - sides / 2.0;
        assert!((inside - energy).abs() < 1e-6, "{n}: {inside} is not {energy}");
        let covered = 4.0 * std::f64::consts::PI * square.lattice().degree(&q)?.abs();
        assert!((inside - covered - above).abs() < 1e-5, "{n}: {} is not {above}", inside - covered);
        assert!(found.residual() < 1e-9);
        assert!(found.sweeps() < 10 * n as u64, "{n}: {} sweeps", found.sweeps());
        let farthest = q.iter().zip(&exact).map(|(q, exact)| (q - exact).amax()).fold(0.0, f64::max);
        assert!((farthest / distance - 1.0).abs() < 0.01, "{n}: {farthest} is not {distance}");
        // each vector is along the sum of its neighbours
        let inside = (1..n - 1).flat_map(|i| (1..n - 1).map(move |j| i * n + j));
        let off = |site: usize| q[site].cross(&(q[site - 1] + q[site + 1] + q[site - n] + q[site + n])).amax();
        assert!(inside.map(off).fold(0.0, f64::max) < 1e-9);
        distances.push(farthest);
    }
    let order = (distances[0] / distances[1]).log2();
    assert!((order - 2.0).abs() < 0.2, "{order}");
    Ok(())
}

/// The factor is found in about as many sweeps as the best constant one takes, by search: linear, curved, heavy and light.
#[test]
fn the_factor_that_is_found_is_about_the_best() -> Result<(), SiteError> {
    let n = 17;
    let compare = |name: &str, sweeps: &mut dyn FnMut(Option<f64>) -> Result<u64, SiteError>| {
        let factors = (0..10).map(|k| 1.0 + 0.1 * f64::from(k));
        let best = factors.filter_map(|factor| sweeps(Some(factor)).ok()).min().expect("one that converges");
        let found = sweeps(None)?;
        assert!(3 * found < 4 * best, "{name}: {found} sweeps, the best factor takes {best}");
        Ok::<(), SiteError>(())
    };
    let noise = |s: usize| ((s as f64 * 12.9898).sin() * 43758.5).fract();
    for sides in [Sides::Periodic, Sides::Open(Side::Fixed, Side::Fixed)] {
        for stiffness in [0.01, 1.0] {
            let springs = Springs { stiffness }.grid([n, n]).sides([sides, Sides::Open(Side::Fixed, Side::Fixed)]);
            let start: Vec<_> = (0..n * n).map(|site| Vector1::new(noise(site))).collect();
            compare(&format!("{sides:?}, {stiffness}"), &mut |factor| {
                let mut x = start.clone();
                let relaxation = springs.relax().sweeps(3000);
                let found = match factor {
                    Some(factor) => relaxation.over_relaxation(factor).solve(&mut x),
                    None => relaxation.solve(&mut x),
                };
                found.map(|found| found.sweeps())
            })?;
        }
    }
    let square = HarmonicMap.grid([n, n]).fixed();
    let start = waved(n);
    compare("a harmonic map", &mut |factor| {
        let mut q = start.clone();
        let relaxation = square.relax().sweeps(3000);
        let found = match factor {
            Some(factor) => relaxation.over_relaxation(factor).solve(&mut q),
            None => relaxation.solve(&mut q),
        };
        found.map(|found| found.sweeps())
    })
}
