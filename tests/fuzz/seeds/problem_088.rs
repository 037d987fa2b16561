#[clebsch(
    action = |F: GL<2>, q: SMatrix<2, 2>| ((F * q) * F.transpose()),
    cost = |h, q, F| (((((F - I) * self.field_0) * (F - I).transpose()).trace() * (1 + (q[(0, 1)].powi(2) * 0.25))) / (2 * h)),
    potential = |t, q| (((((1 * q[(1, 0)]) * (1 + t)) - self.field_1.dot(&q)) - (((self.field_2 * q[(1, 1)]) * q[(1, 1)]) * q[(1, 1)])) - ((-0.71875) * q[(0, 0)])),
    isotropy = free,
)]
pub struct Problem {
    pub field_0: SMatrix<f64, 2, 2>,
    pub field_1: SMatrix<f64, 2, 2>,
    pub field_2: f64,
}
