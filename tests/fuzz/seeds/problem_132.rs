#[clebsch(
    action = |F: Sim<2>, q: Sim<2>| (F * q),
    cost = |h, F| ((F - I).dot(&self.field_0.component_mul(&(F - I))) / (2 * h)),
    potential = |q| ((((((0.6875 * q[(1, 0)]) * q[(2, 2)]) * q[(2, 1)]) + self.field_1.dot(&q)) + self.field_2.dot(&q)) - ((0.75 * q[(0, 0)]) * q[(1, 0)])),
    isotropy = free,
)]
pub struct Problem {
    pub field_0: SMatrix<f64, 3, 3>,
    pub field_1: SMatrix<f64, 3, 3>,
    pub field_2: SMatrix<f64, 3, 3>,
}
