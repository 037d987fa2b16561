//! A grid of 3 by 4 sites against an integrator that knows nothing of spheres.

use crate::sheet::steps;
use clebsch_examples::claims::Claims;
use clebsch_examples::convergence::Convergence;
use clebsch_examples::flags::Order;
use clebsch_examples::reference::solve;
use clebsch_examples::scene::Failure;
use nalgebra::{SVector, Vector3};

const SIZES: [usize; 2] = [3, 4];
const SITES: usize = 12;
/// In units of the spacing.
const TIME: f64 = 3.0;
/// q and N of all sites.
type Numbers = SVector<f64, 72>;

fn joined(q: &[Vector3<f64>], mu: &[Vector3<f64>]) -> Numbers {
    Numbers::from_iterator(q.iter().chain(mu).flat_map(|vector| vector.iter().copied()))
}

/// q̇ = N × q, Ṅ = q × Δq
fn law(spacing: [f64; 2], y: &Numbers) -> Numbers {
    let part = |i: usize| Vector3::new(y[3 * i], y[3 * i + 1], y[3 * i + 2]);
    let at = |i: usize, j: usize| part((i % SIZES[0]) * SIZES[1] + j % SIZES[1]);
    let pull = |index: usize| {
        let (i, j) = (index / SIZES[1], index % SIZES[1]);
        (at(i + 1, j) + at(i + SIZES[0] - 1, j)) / spacing[0].powi(2)
            + (at(i, j + 1) + at(i, j + SIZES[1] - 1)) / spacing[1].powi(2)
    };
    let (moved, turned): (Vec<_>, Vec<_>) =
        (0..SITES).map(|i| (part(SITES + i).cross(&part(i)), part(i).cross(&pull(i)))).unzip();
    joined(&moved, &turned)
}

/// Claims the order of the steps.
///
/// # Errors
/// Those of steps.
pub fn claim(spacing: [f64; 2], h: f64, claims: &mut Claims) -> Result<(), Failure> {
    let q: Vec<Vector3<f64>> = (0..SITES)
        .map(|i| i as f64)
        .map(|i| Vector3::new((0.9 * i).sin(), (1.7 * i).cos(), 0.5 + (2.3 * i).sin()).normalize())
        .collect();
    let mu: Vec<Vector3<f64>> = q.iter().map(|q| q.cross(&Vector3::new(0.3, -0.5, 0.2)) / spacing[0]).collect();
    let count = (TIME * spacing[0] / h).ceil() as u64;
    let exact = solve(|y| law(spacing, y), joined(&q, &mu), h * count as f64, 3.0 / spacing[0].min(spacing[1]));
    let mut errors = [0.0; 3];
    for (error, part) in errors.iter_mut().zip([8, 16, 32]) {
        let stepper = steps(SIZES, spacing, h / part as f64)?;
        let mut state = stepper.state(q.clone(), mu.clone())?;
        stepper.advance(&mut state, count * part).map_err(Failure::step(1))?;
        let found = joined(state.configuration(), state.momentum()) - exact.end;
        *error = found.rows(0, 36).amax();
    }
    let convergence = Convergence { errors, reference: exact.error, steps: 8 * count };
    let name = "3 by 4 sites, steps of h/8: the order, by extrapolation that knows nothing of spheres";
    convergence.claim(Order::Second, name, claims);
    Ok(())
}
