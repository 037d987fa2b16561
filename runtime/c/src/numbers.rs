//! The numbers that C has.

/// The number types that C has too.
///
/// ```
/// use clebsch_c::Real;
///
/// assert_eq!((f64::NAME, f32::NAME), ("double", "float"));
/// ```
pub trait Real: clebsch::Real {
    /// The name of the type in C.
    const NAME: &'static str;
}

impl Real for f64 {
    const NAME: &'static str = "double";
}

impl Real for f32 {
    const NAME: &'static str = "float";
}
