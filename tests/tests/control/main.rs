//! The choice of inputs, through the macro.

mod derivatives;
mod plans;
