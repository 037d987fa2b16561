//! Fields at rest: harmonic maps against published energies and closed forms, an elliptic equation, and the sweeps that it takes.

use clebsch::{Clebsch, Error, Field, FieldSite, Grid, Population, Side, Sides, SiteError, StaticField};
use clebsch_tests::fixtures::harmonic_map::HarmonicMap;
use nalgebra::{Matrix3, Rotation3, SVector, Vector1, Vector3};

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

/// Springs between neighbours, and one from each site to 0.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |a: Translation<1>, x: Vector1| x + a,
    potential = |x| self.stiffness * x.norm_squared() / 2,
    space     = [|dx, x, next| (next - x).norm_squared() / 2, |dy, x, next| (next - x).norm_squared() / 2],
)]
struct Springs {
    stiffness: f64,
}

/// Unit vectors that are smooth on the sides and rough inside.
fn waved(n: usize) -> Vec<Vector3<f64>> {
    let at = |i: usize| -2.0 + 4.0 * i as f64 / (n - 1) as f64;
    let place = |site: usize| {
        let (x, y) = (at(site / n), at(site % n));
        let rough = 0.3 * ((site as f64 * 12.9898).sin() * 43758.5).fract();
        Vector3::new(x.sin() + rough, (x * y).cos(), 1.0 + 0.5 * y).normalize()
    };
    (0..n * n).map(place).collect()
}

/// Multigrid ends where over-relaxation does, in as many cycles whatever the size.
#[test]
fn cycles_do_not_grow_with_the_grid() -> Result<(), SiteError> {
    for n in [16, 17, 32, 50, 65] {
        let square = HarmonicMap.grid([n, n]).fixed();
        let mut q = waved(n);
        let found = square.relax().multigrid().solve(&mut q)?;
        assert!(found.sweeps() <= 4 * 10, "{n}: {} sweeps", found.sweeps());
        assert!(found.residual() < 1e-10, "{n}: {}", found.residual());
        if n < 60 {
            let mut expected = waved(n);
            square.relax().tolerance(1e-13).solve(&mut expected)?;
            let farthest = q.iter().zip(&expected).map(|(q, expected)| (q - expected).amax()).fold(0.0, f64::max);
            assert!(farthest < 1e-9, "{n}: {farthest}");
        }
    }
    Ok(())
}

/// Films whose energies count lengths in three ways: for each length, for each site, and not at all. And one in three directions.
#[test]
fn cycles_do_not_grow_with_dimensions_sides_and_spacings() -> Result<(), SiteError> {
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action    = |a: Translation<1>, x: Vector1| x + a,
        potential = |x| self.stiffness * x.norm_squared() / 2 - self.load * x.x,
        space     = [|dx, x, next| (next - x).norm_squared() / (2 * dx.powi(2)), |dy, x, next| (next - x).norm_squared() / (2 * dy.powi(2))],
    )]
    struct Density {
        stiffness: f64,
        load: f64,
    }

    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(action = |a: Translation<1>, x: Vector1| x + a, space = |dx, x, next| (next - x).norm_squared() / (2 * dx))]
    struct Integral;

    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action = |a: Translation<1>, x: Vector1| x + a,
        space  = [
            |dx, x, next| (next - x).norm_squared() / 2,
            |dy, x, next| (next - x).norm_squared() / 2,
            |dz, x, next| (next - x).norm_squared() / 2,
        ],
    )]
    struct Block;

    let noise = |sites: usize| -> Vec<Vector1<f64>> {
        (0..sites).map(|site| Vector1::new(((site as f64 * 12.9898).sin() * 43758.5).fract())).collect()
    };
    fn count<S, const D: usize, P: Population, const M: usize>(
        domain: &clebsch::Domain<S, Grid<f64, D>, P>,
        mut q: Vec<S::Configuration>,
    ) -> Result<u64, SiteError>
    where
        S: StaticField<Scalar = f64, Momentum = SVector<f64, M>> + Field<D> + FieldSite + Clone,
    {
        let found = domain.relax().multigrid().solve(&mut q)?;
        assert!(found.residual() < 1e-9, "{}", found.residual());
        Ok(found.sweeps() / 4)
    }
    let open = |first, last| Sides::Open(first, last);
    for n in if cfg!(feature = "heavy") { vec![20, 33, 64] } else { vec![20, 33] } {
        for sides in [
            [Sides::Periodic; 2],
            [open(Side::Free, Side::Fixed), Sides::Periodic],
            [open(Side::Fixed, Side::Fixed), open(Side::Free, Side::Free)],
        ] {
            for spacing in [[1.0, 1.0], [0.1, 0.03], [0.1, 1.0]] {
                let stiffness = 0.02;
                let domain = Density { stiffness, load: 0.3 }.grid([n, n + 3]).sides(sides).spacing(spacing);
                let cycles = count(&domain, noise(n * (n + 3)))?;
                assert!(cycles <= 13, "{n}, {sides:?}, {spacing:?}: {cycles} cycles");
            }
        }
        // sites that differ by 4 to 1
        let soft = |[i, j]: [usize; 2]| Density {
            stiffness: 0.02 * if (i / 8 + j / 8) % 2 == 0 { 1.0 } else { 4.0 },
            load: 1.0,
        };
        let cycles = count(&Density { stiffness: 0.0, load: 0.0 }.grid([n, n]).fixed().various(soft), noise(n * n))?;
        assert!(cycles <= 13, "{n}: {cycles} cycles with various sites");
        let cycles = count(&Integral.grid([16 * n]).spacing([0.1]).fixed(), noise(16 * n))?;
        assert!(cycles <= 10, "{n}: {cycles} cycles of a string");
        let cycles = count(&Block.grid([n / 2, n / 2, n / 2 + 1]).fixed(), noise(n / 2 * (n / 2) * (n / 2 + 1)))?;
        assert!(cycles <= 13, "{n}: {cycles} cycles of a block");
    }
    Ok(())
}

/// Rotations in a square: the coarser grids move bodies, each in its own frame.
#[test]
fn cycles_turn_bodies() -> Result<(), SiteError> {
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action = |F: SO<3>, R: SO<3>| R * F,
        space  = [
            |dx, W| {
                let x = W.cayley() / dx;
                x.dot(&(self.stiffness.component_mul(&x))) / 2
            },
            |dy, W| {
                let x = W.cayley() / dy;
                x.dot(&x) / 2
            },
        ],
    )]
    struct Crystal {
        stiffness: Vector3<f64>,
    }

    for n in [17, 33] {
        let crystal = Crystal { stiffness: Vector3::new(1.0, 2.0, 0.5) }.grid([n, n]).spacing([0.1, 0.1]).fixed();
        let turn = |site: usize| {
            let (x, y) = ((site / n) as f64 / n as f64, (site % n) as f64 / n as f64);
            Rotation3::new(Vector3::new(x.sin(), 1.5 * x * y, y.cos())).into_inner()
        };
        let inside = |site: usize| !crystal.lattice().is_fixed(site);
        let start: Vec<Matrix3<f64>> = (0..n * n).map(|site| if inside(site) { turn(0) } else { turn(site) }).collect();
        let (mut q, mut expected) = (start.clone(), start);
        let found = crystal.relax().multigrid().solve(&mut q)?;
        assert!(found.sweeps() <= 4 * 15, "{n}: {} sweeps", found.sweeps());
        crystal.relax().tolerance(1e-13).solve(&mut expected)?;
        let farthest = q.iter().zip(&expected).map(|(q, expected)| (q - expected).amax()).fold(0.0, f64::max);
        assert!(farthest < 1e-9, "{n}: {farthest}");
    }
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
    let (n, mut q) = (33, waved(33));
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
