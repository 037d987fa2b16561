#[clebsch(
    action = |F: SO<3>, q: SMatrix<3, 3>| ((F * q) * F.inverse()),
    cost = |h, F| ((self.field_0 * (F - I).norm_squared()) / (2 * h)),
    potential = |q| (((-0.875) * q[(2, 2)]) * q[(1, 2)]),
    isotropy = free,
    chart = exponential,
)]
pub struct Problem {
    pub field_0: f64,
}
