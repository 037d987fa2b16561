#[clebsch(
    action = |F: [SE<2>; 2], q: [SE<2>; 2]| [(q[0] * F[0]), (q[1] * F[1])],
    lagrangian = |t, v| (v[0].dot(&(self.field_0 * v[0])) + v[1].norm_squared() * (1 + t) / 2) / 2,
    constraint = [
        |t, q, v| [(0..2).map(|i| ((0.25 + (q[i][(0, 2)] * 0.25)) * v[i].x) == v[i].z), (1 / (2 + q[0][(0, 1)].powi(2))) * v[1].y == t],
        |t, q| [q[0].translation() == q[1].rotation() * self.field_1 + q[1].translation()],
    ],
)]
pub struct Problem {
    #[clebsch(symmetric)]
    pub field_0: SMatrix<f64, 3, 3>,
    pub field_1: SVector<f64, 2>,
}
