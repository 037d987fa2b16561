//! Costs that couple the configuration and the group element lose no digits, however short the step is.
//!
//! Their residuals have terms of size 1/h that cancel. Written with D = F − I, these have cancelled as formulas, and the others are of the
//! size of a momentum. So the loss of a conserved momentum and the rounding of a trajectory are those of costs that do not couple.

mod scenes;

use clebsch::{DoubleDouble, Real};
use scenes::{
    Attached, Cart, Chain, Exponential, Midpoint, Pendulums, Quaternions, Run, Scene, Separate, Shifted, Top,
};

/// Step sizes, from coarse ones to those at which a residual with terms of size 1/h has lost all digits of `f32`.
const STEP_SIZES: &[f64] =
    if cfg!(feature = "heavy") { &[1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6] } else { &[1e-1, 1e-4, 1e-6] };
/// Runs of each scene and step size.
const RUNS: u64 = 6;

/// The root mean squares over all runs of two errors. One is the loss of conserved momenta. The other is the distance of
/// the end of a run from that of the same run in double-double numbers. Momenta and configurations are of size one.
#[derive(Clone, Copy, Debug)]
struct Loss {
    momentum: f64,
    rounding: f64,
}

fn distance_squared(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum()
}

/// The same runs in double-double numbers.
fn exact<S: Scene>(h: f64) -> Vec<Run> {
    (0..RUNS).map(|seed| S::run::<DoubleDouble>(seed, h)).collect()
}

fn loss<S: Scene, T: Real>(h: f64, exact: &[Run]) -> Loss {
    let mut squares = [0.0; 2];
    for (seed, exact) in (0..RUNS).zip(exact) {
        let found = S::run::<T>(seed, h);
        let [before, after] = &found.conserved;
        squares[0] += distance_squared(before, after);
        squares[1] += distance_squared(&found.end, &exact.end);
    }
    let [momentum, rounding] = squares.map(|sum| (sum / RUNS as f64).sqrt());
    Loss { momentum, rounding }
}

/// The losses in `f32` and in `f64` for each step size.
fn losses<S: Scene>() -> Vec<[Loss; 2]> {
    let of_step_size = |&h: &f64| {
        let exact = exact::<S>(h);
        [loss::<S, f32>(h, &exact), loss::<S, f64>(h, &exact)]
    };
    STEP_SIZES.iter().map(of_step_size).collect()
}

/// Compares a scene whose cost couples with the losses of one whose cost does not.
fn assert_like<S: Scene>(name: &str, separate: &[[Loss; 2]]) {
    for ((h, coupled), separate) in STEP_SIZES.iter().zip(losses::<S>()).zip(separate) {
        for ((scalar, coupled), separate) in ["f32", "f64"].iter().zip(coupled).zip(separate) {
            let name = format!("{name}, {scalar}, h = {h:e}: {coupled:?}, without coupling {separate:?}");
            println!("{name}");
            assert!(coupled.momentum <= 10.0 * separate.momentum, "{name}");
            assert!(coupled.rounding <= 10.0 * separate.rounding, "{name}");
        }
    }
}

#[test]
fn pendulums_in_series() {
    let separate = losses::<Separate>();
    assert_like::<Pendulums>("two bobs", &separate);
    assert_like::<Chain>("three bobs", &separate);
    assert_like::<Cart>("a bob on a cart", &separate);
}

#[test]
fn bodies_whose_inertia_moves() {
    let separate = losses::<Top>();
    assert_like::<Attached>("a Lagrangian by Cayley's map", &separate);
    assert_like::<Exponential>("a Lagrangian by the exponential", &separate);
    assert_like::<Midpoint>("a potential in the cost", &separate);
    assert_like::<Quaternions>("unit quaternions", &separate);
    assert_like::<Shifted>("motions of space", &separate);
}
