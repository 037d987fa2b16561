//! The choice of inputs, through the macro: plans that take long. The others are in the test `control` of `clebsch-laws`.

mod bounds;
mod extremes;
mod plans;
