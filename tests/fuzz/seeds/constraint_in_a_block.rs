#[clebsch(
    action = |(F, a): (SO<3>, Translation<2>), (R, x): (SO<3>, Vector2)| (R * F, x + a),
    cost = |h, (F, a)| self.inertia * (F - I).norm_squared() / (4 * h) + a.norm_squared() / (2 * h),
    constraint = |t, (R, x), (w, v)| {
        let up = R.transpose() * Vector3::z();
        let arm = self.axes.component_mul(&up) / up.dot(&self.axes).sqrt();
        [v + (R * w.cross(&arm)).xy() == vector![-x.y, x.x] * (1 + t)]
    },
)]
pub struct Rolling {
    pub inertia: f64,
    pub axes: Vector3<f64>,
}
