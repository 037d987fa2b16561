//! The choice of inputs, through the macro.

mod closed_forms;
mod derivatives;
mod extremes;
mod plans;
