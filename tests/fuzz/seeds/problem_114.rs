#[clebsch(
    action = |F: SE<2>, q: SE<2>| (q * F),
    cost = |t, h, q, F| ((((((F - I) * self.field_0) * (F - I).transpose()).trace() * (1 + ((t * t) * 0.5))) / (2 * h)) - ((h * q[(2, 0)].powi(2)) * 0.5)),
    potential = |q| ((((self.field_1.dot(&q).powi(3) / 3) - (((0.53125 * q[(1, 1)]) * q[(1, 2)]) * q[(2, 1)])) + ((0.875 * q[(2, 1)]) * q[(0, 1)])) - ((0.75 * q[(2, 0)]) * q[(1, 1)])),
    isotropy = free,
)]
pub struct Problem {
    pub field_0: SMatrix<f64, 3, 3>,
    pub field_1: SMatrix<f64, 3, 3>,
}
