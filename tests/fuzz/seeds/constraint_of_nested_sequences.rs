#[clebsch(
    action = |F: SO<4>, R: SO<4>| R * F,
    lagrangian = |w| w.norm_squared() / 2,
    constraint = |R, w| [(0..2).map(|i| (0..2).map(|j| w[2 * i + j] * (1 + R[(i, j)]) == w[5 - i] * R[(j, i)])), w[4] == 0],
    scalar = f64,
)]
pub struct Nested;
