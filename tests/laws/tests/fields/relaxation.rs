//! Fields at rest: an elliptic equation, closed forms, and relaxations that end early or are wrong.
//!
//! Published energies and the number of sweeps are in `tests/tests/fields`.

use super::squares::{Springs, edges, instanton, waved};
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
    assert!(found < plain / 2 && 3 * found < 4 * best, "{found}, {plain} and {best} sweeps");
    Ok(())
}

/// Grids too small for a coarser one, of one site, without a site that moves, and of numbers with few digits.
#[test]
fn cycles_take_any_grid() -> Result<(), SiteError> {
    for (n, m) in [(1, 1), (1, 7), (2, 2), (2, 40), (3, 3), (4, 5), (5, 100)] {
        let needles = Springs { stiffness: 0.5 }.grid([n, m]);
        let mut x: Vec<_> = (0..n * m).map(|site| Vector1::new((site as f64).sin())).collect();
        needles.relax().multigrid().solve(&mut x)?;
        assert!(x.iter().all(|x| x.x.abs() < 1e-9), "{n}, {m}");
        let mut x = vec![Vector1::new(2.0); n * m];
        let found = needles.fixed().relax().multigrid().solve(&mut x)?;
        assert!(n > 2 || x.iter().all(|x| x.x == 2.0), "{n}, {m}");
        assert!(found.residual() < 1e-9);
    }

    /// A film of numbers with few digits.
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        scalar = T,
        action = |a: Translation<1>, x: Vector1| x + a,
        space  = [|dx, x, next| (next - x).norm_squared() / 2, |dy, x, next| (next - x).norm_squared() / 2],
    )]
    struct Coarsely<T: clebsch::Scalar> {
        number: std::marker::PhantomData<T>,
    }
    let film = Coarsely::<f32> { number: std::marker::PhantomData }.grid([20, 20]).fixed();
    let plane = |site: usize| Vector1::new((site / 20) as f32 / 20.0);
    let guess = |site: usize| if film.lattice().is_fixed(site) { plane(site) } else { Vector1::new(0.0) };
    let mut x: Vec<_> = (0..400).map(guess).collect();
    film.relax().multigrid().solve(&mut x)?;
    assert!((0..400).all(|site| (x[site] - plane(site)).amax() < 1e-4));
    let mut x: Vec<_> = (0..400).map(guess).collect();
    film.relax().solve(&mut x)?;
    assert!((0..400).all(|site| (x[site] - plane(site)).amax() < 1e-3));
    Ok(())
}

/// Whatever is left of the cycles, one goes on from the configuration.
#[test]
fn cycles_that_end_early_can_go_on() {
    let n = if cfg!(feature = "heavy") { 33 } else { 17 };
    let mut q = waved(n);
    let square = HarmonicMap.grid([n, n]).fixed();
    let energy = |q: &[Vector3<f64>]| -> f64 { edges(n).map(|[a, b]| (q[a] - q[b]).norm_squared() / 2.0).sum() };
    let (mut last, mut cycles) = (energy(&q), 0);
    loop {
        let one = square.relax().multigrid().cycles(1).solve(&mut q).map_err(|error| error.error);
        assert!(energy(&q) <= last + 1e-12, "the energy rose in cycle {cycles}");
        (last, cycles) = (energy(&q), cycles + 1);
        match one {
            Ok(found) => break assert!(found.correction() <= 1e-10 && cycles > 3),
            Err(error) => assert!(matches!(error, Error::NotRelaxed { sweeps: 4, .. }) && cycles < 20, "{error}"),
        }
    }
    let refused = square.relax().multigrid().solve(&mut q[1..]);
    assert_eq!(refused, Err(Error::NumberOfSites { found: n * n - 1, sites: n * n }.into()));
    let refused = square.relax().tolerance(f64::NAN).multigrid().cycles(2).solve(&mut q);
    assert!(refused.is_err(), "{refused:?}");
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
