//! The items that generated code names, and no others. Not part of the public interface: it changes without notice.
//!
//! Code that is the same for every problem is here, and is compiled once. The compiler's side is the module `block` in
//! its `emit` stage.

pub mod keys;

pub use crate::__formulas_of_joints as formulas_of_joints;
pub use crate::__formulas_of_sites as formulas_of_sites;
pub use crate::collocation::{GAUSS_16, SWEEPS, collocate};
pub use crate::conserved::conserved;
pub use crate::constraint::edge::{
    ConstrainedSubstep, ConstraintAtEnd, ConstraintAtStart, PassedEdge, slopes_with_constraint, with_constraint,
};
pub use crate::constraint::link::{ConstrainedLink, Reactions, independent, tangent_projector};
pub use crate::constraint::{
    Correction, Violation, check_place, constrained, multipliers, placed, reactions, violation,
};
pub use crate::definite::{check_definite, check_definite_at, check_definite_uniform};
pub use crate::element::{
    below_right_angle, below_right_angle_from, from_increment, inverse, per_one_plus_cosine, quaternion,
    quaternion_from_increment, quotient_per_one_plus_cosine,
};
pub use crate::energy::{
    VelocityEquation, kinetic_energy, kinetic_energy_at, kinetic_energy_uniform, legendre_fenchel,
};
pub use crate::exponential::{exponential, phi, phi_times};
pub use crate::field::{ConnectedField, Field, FieldSite, MidpointSite, MovingField, StaticField, drifted, is_finite};
pub use crate::free_rotation::{
    FreeRotation, KeptRotation, free_momentum, gibbs_vector_of_matrix, gibbs_vector_of_quaternion,
};
pub use crate::free_rotation_4d::{FreeRotation4, KeptRotation4, free_momentum_4d};
pub use crate::implicit::{
    Equation, Jacobian, LinearEquation, extent, orientation, solve, solve_fixed_point, solve_linear_equation, tolerance,
};
pub use crate::joints::{
    Border, Branch, Joined, Limb, Loop, LoopedLimb, Loops, Mobile, Rows as JointRows, put_loop_values, put_loops,
    put_places,
};
pub use crate::linear::{matrix, solve_dense, solve_symmetric};
pub use crate::logarithm::{logarithm, motion_logarithm};
pub use crate::matrices::{Blocks, axial, determinant, embedded, hat, matrix_of, shifted};
pub use crate::matrices::{skew, skew_components, skew_outer, skew_times};
pub use crate::opaque::check_slope;
pub use crate::orbit::{
    largest, length_defect, near_length_one, of_length_one, of_length_one_with_rest, orientation_defect, orthogonal,
    orthogonal_with_rest, orthogonality_defect, orthonormality_defect, projector, projector_defect,
    projector_with_rest, symmetric, symmetric_with_rest, symmetry_defect,
};
pub use crate::orientation::Orientation;
pub use crate::parameters::{
    Constant, InertiaInverse, annihilator_defect, annihilator_projection, check_diagonal, check_finite, check_limit,
    check_symmetric, check_unit, constant, distance_of_projection, invert, invert_uniform, orientation_of_inertia,
    orientation_of_uniform, projection,
};
pub use crate::parts::{
    FreeMotion, GreatCircles, HamiltonEquations, Parts, Solved, SplitKicks, Substep, TimeTransformed, Varied,
    VariedSubstep,
};
pub use crate::power::{Constants as SiteConstants, Power, PowerConstants, wrapped};
pub use crate::rotation::{
    Diagonal, RotatingBody, RotationEquation, Symmetric, rotation_of_motion, scalar_of_motion, solve_rotation,
    turn_of_body, turn_of_motion,
};
pub use crate::rotation_4d::{RotatingBody4, RotationEquation4, solve_rotation_4d};
pub use crate::scheme::kinds::*;
pub use crate::scheme::{At, JoinedInStorage, Kicks, Scheme, Sizes, Stages, compose, split};
pub use crate::sphere::{push, tangent, turn_freely, turn_great_circle, turned_in_plane};
pub use crate::steered::{
    Link, Price, along_end, arrival_of_state, bound_prices, bounds, check_given, check_reached, conditions,
    displacement, endpoint, forced_step, no_endpoint, pair, parted, placed_state, pushed_along_end, weights,
};
pub use crate::stepper::{check_constraint, check_on_orbit, check_state};
pub use crate::stumpff::stumpff;
pub use crate::sums::{Compensated, Plain, accumulate};
pub use crate::sylvester::Sylvester;
pub use crate::{
    Arrival, BoundsExpansion, Carried, Clebsch, Clock, Conserved, Conserves, Constrained, Controlled, Declared, Edge,
    EndpointExpansion, Ends, Error, Expansion, Method, Momenta, Names, Reacting, Referring, Scalar, Sensitive, Space,
    TargetExpansion, Time, Variational, group,
};
pub use core;
pub use core::option::Option::{self, None, Some};
pub use core::result::Result::{self, Err, Ok};
pub use nalgebra::{Quaternion, SMatrix, SVector};
pub use num_traits::{One, Zero};

use nalgebra::ArrayStorage;

/// A column vector from its entries.
#[inline]
pub fn vector<T: Scalar, const N: usize>(entries: [T; N]) -> SVector<T, N> {
    SVector::from_array_storage(ArrayStorage([entries]))
}

#[cfg(test)]
mod tests;
