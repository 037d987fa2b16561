#[clebsch(
    action = |(F, G): (SO<2>, SO<2>), q: SMatrix<2, 2>| ((G * q) * F),
    cost = |h, (F, G)| (((F - I).dot(&self.field_0.component_mul(&(F - I))) + ((self.field_1 * (G - I)) * (G - I).transpose()).trace()) / (2 * h)),
    potential = |q| (((1 * q[(1, 0)]) * q[(0, 1)]) + (0.75 * q[(1, 0)])),
)]
pub struct Problem {
    pub field_0: SMatrix<f64, 2, 2>,
        #[clebsch(symmetric)]
pub field_1: SMatrix<f64, 2, 2>,
}
