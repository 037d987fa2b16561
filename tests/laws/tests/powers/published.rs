//! Against facts that are known otherwise.

use clebsch::{Clebsch, Conserves, SiteStorage};
use nalgebra::*;

/// Bodies that attract each other.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |a: [Translation<3>; N], x: [Vector3; N]| (0..N).map(|i| x[i] + a[i]),
    cost      = |h, a| (0..N).map(|i| self.mass[i] * a[i].norm_squared()).sum() / (2 * h),
    potential = |x| (0..N).map(|i| (i + 1..N).map(|j| -self.mass[i] * self.mass[j] / (x[i] - x[j]).norm()).sum()).sum(),
)]
pub struct Bodies<const N: usize> {
    pub mass: [f64; N],
}

/// Chenciner and Montgomery's figure of eight returns to its start after the period 6.32591398. Initial values and
/// period are those of Simó. They are given by Chenciner and Montgomery, *A remarkable periodic solution of the
/// three-body problem in the case of equal masses*, Ann. of Math. 152 (2000).
#[test]
fn the_figure_of_eight_closes() {
    let period = 6.325_913_98;
    let first = Vector3::new(0.970_004_36, -0.243_087_53, 0.0);
    let last = Vector3::new(-0.932_407_37, -0.864_731_46, 0.0);
    let (q, mu) = ([first, -first, Vector3::zeros()], [-last / 2.0, -last / 2.0, last]);
    let distance = |steps: u32| {
        let stepper = Bodies::<3> { mass: [1.0; 3] }.stepper(period / f64::from(steps)).expect("three bodies");
        let mut state = stepper.state(q, mu).expect("a state");
        for _ in 0..steps {
            state = stepper.step(&state).expect("a step");
        }
        (0..3).map(|i| (state.configuration()[i] - q[i]).norm()).fold(0.0, f64::max)
    };
    let (coarse, fine) = (distance(2000), distance(4000));
    assert!(coarse < 1e-3, "{coarse:e}");
    assert!((coarse / fine - 4.0).abs() < 0.2, "second order: {coarse:e}, {fine:e}");
}

/// Spin waves of a ring of N rotors, θ̈_i = J(sin(θ_{i+1} − θ_i) − sin(θ_i − θ_{i−1})): small ones of wave number k have ω² = 2J(1 − cos k).
#[test]
fn small_waves_have_their_dispersion() {
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action    = |F: [SO<2>; N], q: [Unit<Vector2>; N]| (0..N).map(|i| F[i] * q[i]),
        cost      = |h, F| (0..N).map(|i| (F[i] - I).norm_squared() / (4 * h)).sum(),
        potential = |q| -self.exchange * (0..N).map(|i| q[i].dot(&q[(i + 1) % N])).sum(),
    )]
    struct Rotors<const N: usize> {
        exchange: f64,
    }
    const N: usize = 32;
    let (exchange, mode, amplitude) = (1.3_f64, 3.0, 1e-5);
    let wave = 2.0 * std::f64::consts::PI * mode / N as f64;
    let omega = (2.0 * exchange * (1.0 - wave.cos())).sqrt();
    let angle = |i: usize| amplitude * (wave * i as f64).cos();
    let q: Vec<Vector2<f64>> = (0..N).map(|i| Vector2::new(angle(i).cos(), angle(i).sin())).collect();
    let steps = 4000_u32;
    let h = 2.0 * std::f64::consts::PI / omega / f64::from(steps);
    let storage = SiteStorage::of(q.clone(), vec![Vector1::zeros(); N]);
    let mut sites = Rotors::<N> { exchange }.into_stepper(h).expect("regular").sites(storage).expect("a state");
    sites.advance(steps.into()).expect("steps");
    // after a period each is where it was, but for (hω)²/24 of the phase and amplitude² of the frequency
    for (now, then) in sites.configuration().iter().zip(&q) {
        assert!((now - then).norm() < 1e-5 * amplitude, "{:e}", (now - then).norm());
    }
}

/// The total momentum of bodies in space is conserved, and told by its name.
#[test]
fn momenta_are_summed_over_all_bodies() {
    let bodies = Bodies::<4> { mass: [1.0, 2.0, 3.0, 4.0] };
    let q: [Vector3<f64>; 4] = std::array::from_fn(|i| Vector3::ith(i % 3, 1.0 + i as f64));
    let mu: [Vector3<f64>; 4] = std::array::from_fn(|i| Vector3::new(0.1 * i as f64, 0.2, -0.1 * i as f64));
    let conserved = bodies.conserved(&q, &mu);
    assert_eq!(conserved.names().len(), 3);
    for (k, value) in conserved.values().iter().enumerate() {
        assert!((value - mu.iter().map(|mu| mu[k]).sum::<f64>()).abs() < 1e-15);
    }
}
