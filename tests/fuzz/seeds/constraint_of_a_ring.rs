#[clebsch(
    action = |a: [Translation<3>; N], x: [Vector3; N]| (0..N).map(|i| x[i] + a[i]),
    lagrangian = |v| (0..N).map(|i| self.mass[i] * v[i].norm_squared() / 2).sum(),
    potential = |x| (0..N).map(|i| self.pull.dot(&x[i])).sum(),
    constraint = |t, x| [
        (0..N).map(|i| (x[(i + 1) % N] - x[i]).norm_squared() == self.rod.powi(2)),
        x[0].z == t.sin(),
        x[N - 1].x == 0,
    ],
)]
pub struct Ring<const N: usize> {
    pub mass: [f64; N],
    pub pull: Vector3<f64>,
    pub rod: f64,
}
