//! How far rounding can carry a quantity that is conserved exactly.

/// The most roundings in sequence that one step makes in one number, rounded up to a power of two. The group element
/// takes some 20 operations from the solved chart vector, itself known to a few units in the last place. Its product
/// with the configuration or the momentum takes 5, the kick 10, and the evaluation of the measured quantity 20.
const ROUNDINGS_PER_STEP: f64 = 64.0;

/// The worst case after `steps` steps: every rounding is by at most ε/2 of `scale`, and all of them have the same sign.
///
/// The growth is then *linear*. That happens: a body in steady rotation repeats one group element and with it one rounding.
/// Roundings of random sign grow like √steps and stay far below; [`in_random_walks`] tells by how much.
///
/// Below the smallest normal number rounding is no longer relative, and squares underflow.
pub fn worst_case(steps: u64, scale: f64) -> f64 {
    ROUNDINGS_PER_STEP * (steps as f64 + 1.0) * (f64::EPSILON / 2.0 * scale).max(f64::MIN_POSITIVE)
}

/// `defect` in units of ε √steps `scale`: of the order of 1 where roundings of random sign add up.
pub fn in_random_walks(defect: f64, steps: u64, scale: f64) -> f64 {
    defect / (f64::EPSILON * (steps as f64).sqrt() * scale)
}
