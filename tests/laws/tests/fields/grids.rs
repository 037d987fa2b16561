//! Grids and their sides, against chains of a const generic and against each other.

use std::f64::consts::TAU;

use clebsch::{Clebsch, Field, Grid, Side, Sides, SiteError};
use clebsch_tests::fixtures::cosserat_rod::CosseratRod;
use clebsch_tests::fixtures::wave_map::WaveMap;
use nalgebra::{Matrix4, SVector, UnitVector3, Vector3, Vector6};

/// Spins in one direction.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, q: Unit<Vector3>| F * q,
    cost      = |h, F| (F - I).norm_squared() / (4 * h),
    potential = |q| self.field.dot(&q),
    space     = |dx, q, next| self.stiffness * (next - q).norm_squared() / (2 * dx),
)]
struct Spins {
    field: Vector3<f64>,
    stiffness: f64,
}

/// The same as a chain with free ends.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: [SO<3>; N], q: [Unit<Vector3>; N]| (0..N).map(|i| F[i] * q[i]),
    cost      = |h, F| (0..N).map(|i| (F[i] - I).norm_squared() / (4 * h)).sum(),
    potential = |q| (0..N).map(|i| self.field.dot(&q[i])).sum() + (0..N - 1).map(|i| self.stiffness * (q[i + 1] - q[i]).norm_squared() / 2).sum(),
)]
struct OpenChain<const N: usize> {
    field: Vector3<f64>,
    stiffness: f64,
}

fn points<const N: usize>(seed: f64) -> [Vector3<f64>; N] {
    let angle = |i: usize, rate: f64| seed + rate * i as f64;
    std::array::from_fn(|i| {
        UnitVector3::new_normalize(Vector3::new(angle(i, 0.7).sin(), angle(i, 1.1).cos(), angle(i, 0.3).sin() + 0.4))
            .into_inner()
    })
}

fn momenta<const N: usize>(q: &[Vector3<f64>; N]) -> [Vector3<f64>; N] {
    std::array::from_fn(|i| q[i].cross(&Vector3::new(0.3, -0.2, 0.1 * i as f64)))
}

fn apart<const R: usize>(a: &[SVector<f64, R>], b: &[SVector<f64, R>]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).amax()).fold(0.0, f64::max)
}

/// A row with free ends steps as the chain of a const generic with the same energies.
#[test]
fn a_row_is_a_chain() -> Result<(), SiteError> {
    let (field, stiffness, q) = (Vector3::new(0.1, 0.2, -0.4), 1.3, points::<9>(0.2));
    let chain = OpenChain::<9> { field, stiffness }.into_stepper(0.05)?;
    let expected = chain.advance(&chain.state(q, momenta(&q))?, 100)?;
    let stepper = Spins { field, stiffness }.grid([9]).stepper(0.05)?;
    let mut state = stepper.state(q, momenta(&q))?;
    assert!((stepper.energy(&state)? - chain.energy(&chain.state(q, momenta(&q))?)).abs() < 1e-13);
    stepper.advance(&mut state, 100)?;
    let error =
        apart(state.configuration(), expected.configuration()).max(apart(state.momentum(), &expected.momentum()));
    assert!(error < 1e-12, "{error:e}");
    Ok(())
}

/// Steps one by one are those of one call, but for rounding.
#[test]
fn kicks_that_meet_are_one() -> Result<(), SiteError> {
    let stepper = WaveMap.grid([3, 4]).spacing([0.5, 0.6]).periodic().stepper(0.1)?;
    let q = points::<12>(0.4);
    let (mut one, mut other) = (stepper.state(q, momenta(&q))?, stepper.state(q, momenta(&q))?);
    stepper.advance(&mut one, 30)?;
    (0..30).try_for_each(|_| stepper.step(&mut other))?;
    assert!(apart(one.configuration(), other.configuration()) < 1e-13);
    assert_eq!((one.steps(), other.steps()), (30, 30));
    Ok(())
}

/// Every side and every size: the forces are minus the differences of the energy along all motions of all sites.
#[test]
fn forces_are_differences_of_the_energy() -> Result<(), SiteError> {
    let open = [
        Sides::Periodic,
        Sides::Open(Side::Free, Side::Free),
        Sides::Open(Side::Fixed, Side::Free),
        Sides::Open(Side::Free, Side::Fixed),
    ];
    let h = 1e-3;
    for sizes in [[3, 4], [1, 5], [4, 1], [2, 2], [2, 3]] {
        for sides in open.into_iter().flat_map(|first| open.map(|second| [first, second])) {
            let domain = WaveMap.grid(sizes).spacing([0.5, 0.8]).sides(sides);
            let (grid, stepper) = (*domain.lattice(), domain.stepper(h)?);
            let q = points::<12>(0.9)[..grid.sites()].to_vec();
            let rest = vec![Vector3::zeros(); grid.sites()];
            let energy = |q: Vec<Vector3<f64>>| stepper.energy(&stepper.state(q, rest.clone())?);
            let mut state = stepper.state(q.clone(), rest.clone())?;
            stepper.step(&mut state)?;
            for site in 0..grid.sites() {
                // N after a step from rest is h times the force, and an error of h³
                let force = state.momentum()[site] / h;
                for axis in [Vector3::x(), Vector3::y(), Vector3::z()] {
                    let moved = |angle: f64| {
                        let mut q = q.clone();
                        q[site] = nalgebra::Rotation3::new(axis * angle) * q[site];
                        energy(q)
                    };
                    let slope = (moved(1e-5)? - moved(-1e-5)?) / 2e-5;
                    let expected = if grid.is_fixed(site) { 0.0 } else { -slope };
                    assert!(
                        (force.dot(&axis) - expected).abs() < 1e-4,
                        "{sizes:?} {sides:?} {site}: {force:?} {expected}"
                    );
                }
            }
        }
    }
    Ok(())
}

/// A site on a fixed side stays, and its momentum is 0.
#[test]
fn fixed_sites_do_not_move() -> Result<(), SiteError> {
    let stepper = WaveMap.grid([3, 4]).spacing([0.5, 0.5]).fixed().stepper(0.1)?;
    let q = points::<12>(0.1);
    let mut state = stepper.state(q, momenta(&q))?;
    stepper.advance(&mut state, 50)?;
    for (site, start) in q.iter().enumerate() {
        let is_inside = [5, 6].contains(&site);
        assert_eq!(stepper.lattice().is_fixed(site), !is_inside, "{site}");
        assert_eq!(state.configuration()[site] == *start, !is_inside, "{site}");
        assert_eq!(state.momentum()[site] == Vector3::zeros(), !is_inside, "{site}");
    }
    Ok(())
}

/// Sites whose parameters were given one by one move as sites that share them.
#[test]
fn various_sites_may_be_alike() -> Result<(), SiteError> {
    let spins = Spins { field: Vector3::new(0.1, 0.2, -0.4), stiffness: 1.3 };
    let q = points::<7>(0.2);
    let alike = spins.grid([7]).spacing([0.5]).periodic();
    let various = alike.clone().various(|_| spins.clone()).stepper(0.05)?;
    let alike = alike.stepper(0.05)?;
    let (mut one, mut other) = (alike.state(q, momenta(&q))?, various.state(q, momenta(&q))?);
    alike.advance(&mut one, 50)?;
    various.advance(&mut other, 50)?;
    assert!(apart(one.configuration(), other.configuration()) < 1e-13);
    assert!((alike.energy(&one)? - various.energy(&other)?).abs() < 1e-13);
    assert_eq!(various.system(3).map(|site| site.stiffness), Some(1.3));
    Ok(())
}

/// The total momentum of a torus of 100 sites stays for 10 000 steps.
#[test]
fn total_momenta_stay() -> Result<(), SiteError> {
    let stepper = WaveMap.grid([10, 10]).spacing([0.5, 0.5]).periodic().stepper(0.05)?;
    let q = points::<100>(0.3);
    let mut state = stepper.state(q, momenta(&q))?;
    let (before, energy) = (stepper.conserved(&state)?, stepper.energy(&state)?);
    stepper.advance(&mut state, if cfg!(feature = "heavy") { 10_000 } else { 2000 })?;
    let after = stepper.conserved(&state)?;
    for ((name, a), (_, b)) in before.iter().zip(after.iter()) {
        assert!((a - b).abs() < 1e-11, "{name}: {a} {b}");
    }
    assert!((stepper.energy(&state)? / energy - 1.0).abs() < 0.05);
    Ok(())
}

fn rod() -> CosseratRod {
    CosseratRod {
        section: nalgebra::Vector4::new(0.0035, 0.0025, 0.0015, 0.8) / 6.0,
        weight: 0.5,
        stiffness: Vector6::new(0.5, 0.6, 0.4, 40.0, 50.0, 80.0),
        reference: Vector6::new(0.0, 0.0, 0.0, 0.0, 0.0, 1.0),
        damping: 0.0,
    }
}

/// Forces at both ends of a step change the total momentum by ½h (f(q) + f(q⁺)), to rounding.
#[test]
fn wrenches_push_sites() -> Result<(), SiteError> {
    let rod = CosseratRod { weight: 0.0, ..rod() };
    let stepper = rod.grid([5]).spacing([0.2]).stepper(0.002)?;
    let place = |i: usize| Matrix4::new_translation(&Vector3::new(0.0, 0.0, 0.2 * i as f64));
    let mut state = stepper.state((0..5).map(place).collect::<Vec<_>>(), vec![SVector::<f64, 6>::zeros(); 5])?;
    let mut inputs = [SVector::<f64, 6>::zeros(); 5];
    inputs[4][3] = 0.7;
    let mut expected = Vector3::zeros();
    for _ in 0..50 {
        // 0.7 N in the frame of the last section
        let force = |q: &Matrix4<f64>| q.fixed_view::<3, 1>(0, 0) * 0.7;
        let before = force(&state.configuration()[4]);
        stepper.step_with(&mut state, &inputs)?;
        expected += (before + force(&state.configuration()[4])) * 0.001;
    }
    let spatial =
        |(q, mu): (&Matrix4<f64>, &SVector<f64, 6>)| (q.fixed_view::<3, 3>(0, 0) * mu.fixed_rows::<3>(3)).into_owned();
    let total: Vector3<f64> = state.configuration().iter().zip(state.momentum()).map(spatial).sum();
    assert!((total - expected).norm() < 1e-15 && total.norm() > 0.06, "{total} {expected}");
    Ok(())
}

/// A grid numbers its sites row by row.
#[test]
fn places_and_numbers_agree() {
    let grid: Grid<f64, 3> = Grid::new([2, 3, 4]);
    for index in 0..24 {
        let place = grid.place(index).expect("a site");
        assert_eq!(grid.index(place), Some(index));
    }
    assert_eq!((grid.place(24), grid.index([1, 3, 0])), (None, None));
    assert_eq!(grid.place(23), Some([1, 2, 3]));
}

/// The linear rod with a hanging end: standing waves of a stretched bar have the frequencies of its masses and springs.
#[test]
fn a_bar_rings_at_the_frequencies_of_its_sections() -> Result<(), SiteError> {
    let rod = CosseratRod { weight: 0.0, ..rod() };
    let (mass, stiffness, ds, h, n) = (0.8 / 6.0, 80.0, 0.2, 1e-4, 8);
    let stepper = rod.grid([n]).spacing([ds]).stepper(h)?;
    // free ends: u_i = cos(k (i + ½)), k = π/n, with m ω² = 4 (EA/ds) sin²(k/2)
    let k = TAU / 2.0 / n as f64;
    let omega = 2.0 * (stiffness / ds / mass).sqrt() * (k / 2.0).sin();
    let size = 1e-6;
    let shape = |i: usize| size * (k * (i as f64 + 0.5)).cos();
    let place = |i: usize| Matrix4::new_translation(&Vector3::new(0.0, 0.0, ds * i as f64 + shape(i)));
    let mut state = stepper.state((0..n).map(place).collect::<Vec<_>>(), vec![SVector::<f64, 6>::zeros(); n])?;
    let steps = 2000;
    stepper.advance(&mut state, steps)?;
    let now = (2.0 * (omega * h / 2.0).asin() * steps as f64).cos();
    for (i, q) in state.configuration().iter().enumerate() {
        let found = (q[(2, 3)] - ds * i as f64) / size;
        assert!((found - now * shape(i) / size).abs() < 1e-4, "{i}: {found} {}", now * shape(i) / size);
    }
    Ok(())
}
