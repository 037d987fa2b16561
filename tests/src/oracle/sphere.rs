//! Points on Sⁿ, left action of SO(n+1), in closed form, with the velocity w ⊥ q instead of a momentum.

use nalgebra::SVector;

/// sin θ = h|w|: q⁺ = cos θ q + h w, w⁺ = cos θ w − h|w|²q.
pub fn drift<const N: usize>(h: f64, (q, w): (SVector<f64, N>, SVector<f64, N>)) -> (SVector<f64, N>, SVector<f64, N>) {
    let speed = w.norm_squared();
    let cosine = (1.0 - h * h * speed).sqrt();
    tangent((q * cosine + w * h, w * cosine - q * (h * speed)))
}

/// w less h times the tangential part of the acceleration that a potential asks for.
pub fn kick<const N: usize>(
    h: f64,
    gradient: &SVector<f64, N>,
    (q, w): (SVector<f64, N>, SVector<f64, N>),
) -> (SVector<f64, N>, SVector<f64, N>) {
    tangent((q, w - gradient * h))
}

/// Half kick, drift, half kick; `gradient` is that of the potential of unit mass.
pub fn strang<const N: usize>(
    gradient: impl Fn(&SVector<f64, N>) -> SVector<f64, N>,
    h: f64,
    state: (SVector<f64, N>, SVector<f64, N>),
) -> (SVector<f64, N>, SVector<f64, N>) {
    let state = drift(h, kick(h / 2.0, &gradient(&state.0), state));
    kick(h / 2.0, &gradient(&state.0), state)
}

/// w made orthogonal to q: an identity in exact arithmetic, without which rounding errors grow exponentially.
fn tangent<const N: usize>((q, w): (SVector<f64, N>, SVector<f64, N>)) -> (SVector<f64, N>, SVector<f64, N>) {
    (q, w - q * (q.dot(&w) / q.norm_squared()))
}
