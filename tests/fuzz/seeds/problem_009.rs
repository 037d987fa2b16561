#[clebsch(
    action = |(F, G): (SO<2>, SO<2>), q: SO<2>| ((G * q) * F),
    cost = |h, q, (F, G)| (((((((F - I) * self.field_0) * (F - I).transpose()).trace() + (self.field_1 * (G - I).norm_squared())) * (1 + (q[(0, 0)].powi(2) * 0.25))) / (2 * h)) - ((h * q[(1, 0)].powi(2)) * 0.5)),
    potential = |q| self.field_2.dot(&q),
)]
pub struct Problem {
    pub field_0: SMatrix<f64, 2, 2>,
    pub field_1: f64,
    pub field_2: SMatrix<f64, 2, 2>,
}
