#[clebsch(
    action = |F: SO<discretization = exact>, R: SO<3>| R * F,
    cost   = |h, F| (F - I).norm_squared() / h,
    scalar = f64,
)]
pub struct Body;
