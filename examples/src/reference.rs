//! Another integrator to compare with, which knows nothing of groups: extrapolation of the modified midpoint rule.

use nalgebra::SVector;

/// Columns of the extrapolation: order 2 · 8 in the length of a stride.
const COLUMNS: usize = 8;
/// Roundings of a stride in units of ε, as the extrapolation weighs them.
const ROUNDINGS: f64 = 16.0;

/// Where a solution of ẏ = f(y) ends.
#[derive(Clone, Copy, Debug)]
pub struct Solution<const N: usize> {
    /// y at the end.
    pub end: SVector<f64, N>,
    /// The sum over all strides of the difference of the last two columns, and of the rounding; the motion may magnify it.
    pub error: f64,
}

/// Integrates ẏ = `field`(y) over `duration` in strides of at most 1/(2 `rate`), `rate` being the fastest of the motion.
///
/// Source: Hairer, Nørsett and Wanner, *Solving Ordinary Differential Equations I*, §II.9 (Gragg, Bulirsch and Stoer), with
/// 2, 4, 6, … substeps and no smoothing step.
pub fn solve<const N: usize>(
    field: impl Fn(&SVector<f64, N>) -> SVector<f64, N>,
    start: SVector<f64, N>,
    duration: f64,
    rate: f64,
) -> Solution<N> {
    let strides = (2.0 * rate * duration.abs()).ceil().clamp(1.0, 1e6);
    let stride = duration / strides;
    let mut solution = Solution { end: start, error: 0.0 };
    for _ in 0..strides as u64 {
        let (end, error) = extrapolate(&field, &solution.end, stride);
        solution = Solution { end, error: solution.error + error + ROUNDINGS * f64::EPSILON * end.amax() };
    }
    solution
}

/// One stride: the last entry of the tableau of Aitken and Neville in h², and how far the last but one is from it.
fn extrapolate<const N: usize>(
    field: &impl Fn(&SVector<f64, N>) -> SVector<f64, N>,
    start: &SVector<f64, N>,
    stride: f64,
) -> (SVector<f64, N>, f64) {
    let mut row = [*start; COLUMNS];
    let mut last = f64::INFINITY;
    for k in 0..COLUMNS {
        let mut entry = midpoint(field, start, stride, 2 * (k + 1));
        for (j, above) in row.iter_mut().take(k).enumerate() {
            let ratio = ((k + 1) as f64 / (k - j) as f64).powi(2);
            let next = entry + (entry - *above) / (ratio - 1.0);
            *above = entry;
            entry = next;
        }
        last = if k > 0 { (entry - row[k - 1]).amax() } else { last };
        row[k] = entry;
    }
    (row[COLUMNS - 1], last)
}

/// Gragg's modified midpoint rule with an even number of substeps, whose error is a series in h².
fn midpoint<const N: usize>(
    field: &impl Fn(&SVector<f64, N>) -> SVector<f64, N>,
    start: &SVector<f64, N>,
    stride: f64,
    substeps: usize,
) -> SVector<f64, N> {
    let h = stride / substeps as f64;
    let (mut before, mut here) = (*start, start + field(start) * h);
    for _ in 1..substeps {
        (before, here) = (here, before + field(&here) * (2.0 * h));
    }
    here
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Vector2, Vector3};

    /// Full turns of a harmonic oscillator, and ẏ = y² with y = 1/(1 − t).
    #[test]
    fn exact_solutions_are_met_to_round_off() {
        let turn =
            solve(|y: &Vector2<f64>| Vector2::new(y.y, -y.x), Vector2::new(1.0, 0.5), 8.0 * std::f64::consts::TAU, 1.0);
        let defect = (turn.end - Vector2::new(1.0, 0.5)).amax();
        assert!(defect < turn.error && turn.error < 1e-12, "{turn:?}");
        let blow = solve(|y: &Vector3<f64>| y.component_mul(y), Vector3::repeat(1.0), 0.5, 4.0);
        let defect = (blow.end - Vector3::repeat(2.0)).amax();
        assert!(defect < 4.0 * blow.error && blow.error < 1e-12, "{blow:?}");
    }
}
