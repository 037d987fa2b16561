#[clebsch(
    action    = |a: Translation<2>, x: Vector2| x + a,
    cost      = |h, a| a.norm_squared() / (2 * h),
    potential = |x| x[1.5],
    scalar    = f64,
)]
pub struct Particle;
