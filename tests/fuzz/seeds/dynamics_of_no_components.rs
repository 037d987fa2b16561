#[clebsch(
    dynamics = |h, x: Vector0, u: Vector1| x + h * vector![u.x],
    cost     = |h, x, u| h * (x.norm_squared() + u.norm_squared()) / 2,
    scalar   = f64,
)]
pub struct Nothing;
