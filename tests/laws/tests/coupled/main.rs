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

fn loss<S: Scene, T: Real>(h: f64) -> Loss {
    let mut squares = [0.0; 2];
    for seed in 0..RUNS {
        let (found, exact): (Run, Run) = (S::run::<T>(seed, h), S::run::<DoubleDouble>(seed, h));
        let [before, after] = &found.conserved;
        squares[0] += distance_squared(before, after);
        squares[1] += distance_squared(&found.end, &exact.end);
    }
    let [momentum, rounding] = squares.map(|sum| (sum / RUNS as f64).sqrt());
    Loss { momentum, rounding }
}

/// Compares a scene whose cost couples with one whose cost does not.
fn assert_like<S: Scene, R: Scene, T: Real>(name: &str) {
    for &h in STEP_SIZES {
        let (coupled, separate) = (loss::<S, T>(h), loss::<R, T>(h));
        let scalar = std::any::type_name::<T>();
        println!("{name}, {scalar}, h = {h:e}: {coupled:?}, without coupling {separate:?}");
        assert!(coupled.momentum <= 10.0 * separate.momentum, "{name}, {scalar}, h = {h:e}: {coupled:?} {separate:?}");
        assert!(coupled.rounding <= 10.0 * separate.rounding, "{name}, {scalar}, h = {h:e}: {coupled:?} {separate:?}");
    }
}

fn assert_all<S: Scene, R: Scene>(name: &str) {
    assert_like::<S, R, f32>(name);
    assert_like::<S, R, f64>(name);
}

#[test]
fn pendulums_in_series() {
    assert_all::<Pendulums, Separate>("two bobs");
    assert_all::<Chain, Separate>("three bobs");
    assert_all::<Cart, Separate>("a bob on a cart");
}

#[test]
fn bodies_whose_inertia_moves() {
    assert_all::<Attached, Top>("a Lagrangian by Cayley's map");
    assert_all::<Exponential, Top>("a Lagrangian by the exponential");
    assert_all::<Midpoint, Top>("a potential in the cost");
    assert_all::<Quaternions, Top>("unit quaternions");
    assert_all::<Shifted, Top>("motions of space");
}
