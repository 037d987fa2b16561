//! The choice of inputs, through the macro.

mod bounds;
mod closed_forms;
mod derivatives;
mod extremes;
mod kinks;
mod plans;
mod references;
mod right_hand_sides;
mod targets;
mod velocities;
