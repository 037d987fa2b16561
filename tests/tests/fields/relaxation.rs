//! Fields at rest: harmonic maps against published energies and closed forms, an elliptic equation, and the sweeps that it takes.

use clebsch::{Clebsch, Error, Field, SiteError};
use clebsch_tests::fixtures::harmonic_map::HarmonicMap;
use nalgebra::{Matrix3, Rotation3, Vector1, Vector3};

/// A film over a frame, its height x.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |a: Translation<1>, x: Vector1| x + a,
    space  = [|dx, x, next| (next - x).norm_squared() / 2, |dy, x, next| (next - x).norm_squared() / 2],
)]
struct Film;

/// Rotations along a line, each with a spring to the next.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<3>, R: SO<3>| R * F,
    space  = |ds, W| {
        let x = W.cayley() / ds;
        ds * x.dot(&x) / 2
    },
)]
struct Ribbon;

/// Vectors in a field, each with a spring to the next.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, q: Unit<Vector3>| F * q,
    potential = |q| -self.field.dot(&q),
    space     = |dx, q, next| (next - q).norm_squared() / (2 * dx),
)]
struct Needles {
    field: Vector3<f64>,
}

/// The instanton of Belavin and Polyakov on [−2, 2]², with n sites along a side: a map of degree 1 to the sphere.
fn instanton(n: usize, size: f64) -> Vec<Vector3<f64>> {
    let at = |i: usize| -2.0 + 4.0 * i as f64 / (n - 1) as f64;
    let place = |site: usize| {
        let (x, y) = (at(site / n), at(site % n));
        let (squared, own) = (x * x + y * y, size * size);
        Vector3::new(2.0 * size * x, 2.0 * size * y, squared - own) / (squared + own)
    };
    (0..n * n).map(place).collect()
}

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
        assert!(found.sweeps() < 20 * n as u64, "{n}: {} sweeps", found.sweeps());
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

/// Against the solution of the linear equation by elimination, from a guess that is far away.
#[test]
fn a_film_solves_the_equation_of_laplace() -> Result<(), SiteError> {
    let n = 12;
    let film = Film.grid([n, n]).fixed();
    let height = |site: usize| {
        let (i, j) = ((site / n) as f64, (site % n) as f64);
        (0.7 * i).sin() + 0.1 * j * j
    };
    let is_side = |site: usize| film.lattice().is_fixed(site);
    let inside: Vec<usize> = (0..n * n).filter(|site| !is_side(*site)).collect();
    let number = |site: usize| inside.iter().position(|other| *other == site);
    let (mut matrix, mut sides) =
        (nalgebra::DMatrix::zeros(inside.len(), inside.len()), nalgebra::DVector::zeros(inside.len()));
    for (row, &site) in inside.iter().enumerate() {
        matrix[(row, row)] = 4.0;
        for neighbour in [site - 1, site + 1, site - n, site + n] {
            match number(neighbour) {
                Some(column) => matrix[(row, column)] = -1.0,
                None => sides[row] += height(neighbour),
            }
        }
    }
    let exact = matrix.lu().solve(&sides).expect("a regular matrix");
    let start: Vec<_> = (0..n * n).map(|site| Vector1::new(if is_side(site) { height(site) } else { 1e3 })).collect();
    let mut sweeps = Vec::new();
    for relaxation in [
        film.relax(),
        film.relax().over_relaxation(1.0),
        film.relax().over_relaxation(2.0 / (1.0 + (std::f64::consts::PI / 11.0).sin())),
    ] {
        let mut x = start.clone();
        sweeps.push(relaxation.tolerance(1e-12).solve(&mut x)?.sweeps());
        for (row, &site) in inside.iter().enumerate() {
            assert!((x[site].x - exact[row]).abs() < 1e-9, "site {site}");
        }
    }
    let [found, plain, best] = sweeps[..] else { panic!("three runs") };
    assert!(found < plain / 2 && found < 3 * best, "{found}, {plain} and {best} sweeps");
    Ok(())
}

/// Between two rotations the ribbon turns evenly about the axis from one to the other. Its energy is a polynomial of tan(θ/2n).
#[test]
fn a_ribbon_turns_evenly() -> Result<(), SiteError> {
    let (sites, turn) = (9, Vector3::new(0.6, -0.9, 1.2));
    let (ds, angle) = (0.25, turn.norm() / 8.0);
    let even = |i: usize| Rotation3::new(turn * (i as f64 / 8.0)).into_inner();
    let mut rotations: Vec<Matrix3<f64>> = (0..sites).map(|i| if i < 5 { even(0) } else { even(8) }).collect();
    let ribbon = Ribbon.grid([sites]).spacing([ds]).fixed();
    let found = ribbon.relax().tolerance(1e-12).solve(&mut rotations)?;
    for (i, rotation) in rotations.iter().enumerate() {
        assert!((rotation - even(i)).amax() < 1e-10, "site {i}");
    }
    // |x| = 2 tan(angle/2)/ds
    let expected = 8.0 * 2.0 * (angle / 2.0).tan().powi(2) / ds;
    assert!((found.energy() - expected).abs() < 1e-12, "{} is not {expected}", found.energy());
    Ok(())
}

/// Turned upside down against the field, needles stand on a maximum: forces vanish, and any disturbance leads to the minimum.
#[test]
fn corrections_go_downhill_from_a_saddle() -> Result<(), SiteError> {
    let needles = Needles { field: Vector3::new(0.0, 0.0, 1.0) }.grid([5]);
    let mut q = vec![Vector3::new(1e-4, 0.0, -1.0).normalize(); 5];
    let found = needles.relax().solve(&mut q)?;
    assert!((found.energy() + 5.0).abs() < 1e-12, "{}", found.energy());
    assert!(q.iter().all(|q| (q - Vector3::z()).amax() < 1e-8));
    Ok(())
}

#[test]
fn sweeps_without_over_relaxation_lower_the_energy() -> Result<(), SiteError> {
    let n = 9;
    let square = HarmonicMap.grid([n, n]).fixed();
    let mut q = instanton(n, 0.9);
    // far from rest inside
    (0..n * n).filter(|site| !square.lattice().is_fixed(*site)).for_each(|site| {
        let s = site as f64;
        q[site] = Vector3::new(s.sin(), (1.7 * s).cos(), (0.3 * s).sin()).normalize();
    });
    let mut last = f64::INFINITY;
    let mut sweeps = 0;
    while sweeps < 300 {
        let one = square.relax().over_relaxation(1.0).sweeps(1).solve(&mut q);
        let energy: f64 = edges(n).map(|[a, b]| (q[a] - q[b]).norm_squared() / 2.0).sum();
        assert!(energy <= last + 1e-12, "sweep {sweeps}: {energy} after {last}");
        last = energy;
        sweeps += 1;
        match one {
            Ok(_) => return Ok(()),
            Err(SiteError { error: Error::NotRelaxed { sweeps: 1, correction, tolerance: 1e-10 }, site: None }) => {
                assert!(correction > 1e-10)
            }
            Err(error) => return Err(error),
        }
    }
    panic!("not at rest after {sweeps} sweeps")
}

/// The edges of a square of n × n sites.
fn edges(n: usize) -> impl Iterator<Item = [usize; 2]> {
    (0..n * n).flat_map(move |site| {
        let right = (site % n + 1 < n).then_some([site, site + 1]);
        right.into_iter().chain((site + n < n * n).then_some([site, site + n]))
    })
}

#[test]
fn wrong_relaxations_are_named() {
    let film = Film.grid([3, 3]).fixed();
    let mut x = [Vector1::new(0.0); 9];
    for factor in [0.0, 2.0, -1.0, f64::NAN] {
        let refused = film.relax().over_relaxation(factor).solve(&mut x).map_err(|error| error.error);
        assert!(matches!(refused, Err(Error::OverRelaxation { .. })), "{factor}: {refused:?}");
    }
    let refused = film.relax().solve(&mut x[..8]);
    assert_eq!(refused, Err(Error::NumberOfSites { found: 8, sites: 9 }.into()));
    let refused = HarmonicMap.grid([2, 2]).relax().solve(&mut [Vector3::new(0.0, 0.0, 2.0); 4]);
    assert!(matches!(refused, Err(SiteError { site: Some(0), error: Error::OffOrbit { .. } })));
    x[4].x = f64::NAN;
    let refused = film.relax().solve(&mut x).map_err(|error| error.site);
    assert_eq!(refused, Err(Some(4)));
}
