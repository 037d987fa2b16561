#[clebsch(
    action = |(F, G): (Aff<1>, Translation<1>), (q, x): (SMatrix<2, 2>, SVector<1>)| (((F * q) * F.inverse()), (G + x)),
    cost = |h, (q, x), (F, G)| (((((self.field_0 * (F - I)) * (F - I).transpose()).trace() + G.dot(&(self.field_1 * G))) + ((((F * q) * F.inverse()) - q).norm_squared() * 0.25)) / (2 * h)),
    potential = |t, (q, x)| (((((((0.1875 * q[(1, 1)]) * x[(0, 0)]) * q[(1, 0)]) * (1 + t)) - self.field_2.dot(&q)) - self.field_3.dot(&q)) - self.field_4.dot(&q)),
    order = 1,
    isotropy = free,
    chart = exponential,
)]
pub struct Problem {
    pub field_0: SMatrix<f64, 2, 2>,
    pub field_1: f64,
    pub field_2: SMatrix<f64, 2, 2>,
    pub field_3: SMatrix<f64, 2, 2>,
    pub field_4: SMatrix<f64, 2, 2>,
}
