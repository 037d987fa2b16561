#[clebsch(
    group Own = basis([vector![0, 1]]),
    action    = |F: Own, q: Own| q * F,
    cost      = |h, F| (F - I).norm_squared() / (2 * h),
    scalar    = f64,
)]
pub struct Frame;
