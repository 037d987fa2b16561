//! Which property holds which public function to its law.

/// A property: its name, and the functions that it is about.
pub type Property = (&'static str, &'static [&'static str]);

/// The properties of each file.
#[rustfmt::skip]
pub const PROPERTIES: &[(&str, &[Property])] = &[
    ("runtime/src/composition.rs", &[
        ("impulses_scale_with_their_steps",        &["Impulse::scaled"]),
        ("slopes_are_those_along_the_whole_step",  &["Stage::slopes"]),
    ]),
    ("runtime/src/double_double/tests.rs", &[
        ("pairs_are_unevaluated_sums", &["DoubleDouble::new", "DoubleDouble::parts"]),
    ]),
    ("runtime/src/free_rotation/tests.rs", &[
        ("motions_add_up",               &["FreeRotation::gibbs_vector"]),
        ("series_end_at_the_tolerance",  &["FreeRotation::to_tolerance"]),
    ]),
    ("runtime/src/free_rotation_4d/tests.rs", &[
        ("motions_add_up", &["FreeRotation4::new", "FreeRotation4::motion", "FreeRotation4::turn"]),
    ]),
    ("runtime/src/lanes/tests.rs", &[
        ("operations_are_those_of_single_numbers", &["Scalar::select", "Scalar::sqrt", "Scalar::from_lanes"]),
    ]),
    ("tests/laws/tests/properties/derivatives.rs", &[
        ("tangent_maps_are_linear",      &["Tangent::apply", "Tangent::apply_transposed", "Tangent::then", "Tangent::identity", "Sensitivity::zero", "Sensitivity::after"]),
        ("tangent_maps_are_differences", &["Stepper::step_tangent", "Stepper::step_tangent_with", "Stepper::infinitesimal_motion"]),
        ("sensitivities_are_differences", &["Stepper::step_sensitivity", "Stepper::step_sensitivity_with"]),
        ("increments_are_those_of_the_group", &["Variational::retraction", "Variational::retractions", "Variational::compose", "Variational::advance", "Variational::drift", "Variational::infinitesimal_motion", "Variational::orbit_metric", "Variational::approach"]),
        ("edges_are_differentiated_twice", &["Variational::edge", "Variational::momenta", "Variational::carried", "Sensitive::edge_slopes"]),
        ("ends_have_a_price",            &["Variational::endpoint"]),
        ("links_are_implicit_functions", &["Link::new", "Link::expansion", "forced_step", "check_state"]),
    ]),
    ("tests/laws/tests/properties/ensembles.rs", &[
        ("ensembles_are_bodies_alone",         &["Stepper::ensemble", "Ensemble::step", "Ensemble::advance", "Ensemble::par_advance", "Ensemble::len", "Ensemble::is_empty", "Ensemble::steps", "Ensemble::body", "Ensemble::bodies", "Ensemble::set_body", "Ensemble::energy", "Ensemble::failures", "Ensemble::failure", "Ensemble::conserved"]),
        ("drives_share_their_words",           &["Drive::step", "Drive::advance", "Drive::state", "Drive::steps"]),
        ("bodies_have_their_own_parameters",   &["Ensemble::with_parameters"]),
        ("bodies_have_times",                  &["Ensemble::time"]),
    ]),
    ("tests/laws/tests/properties/equations.rs", &[
        ("equations_are_solved_to_rounding",       &["solve", "solve_fixed_point", "orientation", "Equation::prepare", "Equation::predict", "Equation::linearize", "Equation::residual", "Equation::correct", "Equation::tolerance", "Equation::orientation"]),
        ("poles_are_no_solutions",                 &["Equation::has_poles"]),
        ("iterations_have_a_limit",                &["Equation::limit"]),
        ("tolerances_end_at_rounding",             &["tolerance"]),
        ("affine_equations_take_one_elimination",  &["solve_linear_equation", "LinearEquation::system", "LinearEquation::correct", "LinearEquation::orientation"]),
        ("transforms_obey_fenchel_and_young",      &["legendre_fenchel", "VelocityEquation::linearize"]),
        ("collocation_follows_linear_equations",   &["collocate"]),
        ("compositions_have_their_orders",         &["compose", "compose_symmetric"]),
        ("compositions_are_their_stages",          &["Composed::new", "Composed::stage"]),
        ("splittings_have_their_orders",           &["split"]),
    ]),
    ("tests/laws/tests/properties/formulas.rs", &[
        ("rotations_act_from_the_right", &[
            "Clebsch::act", "Clebsch::coadjoint", "Clebsch::momentum_map", "Clebsch::momentum_matrix", "Clebsch::momentum_components", "Clebsch::constants", "Clebsch::into_stepper",
            "Stepper::act", "Stepper::coadjoint", "Stepper::momentum_map", "Stepper::momentum_matrix", "Stepper::momentum_components", "Stepper::system", "Stepper::step_size",
        ]),
        ("rotations_act_on_the_sphere_from_the_left", &["Clebsch::isotropy_defect", "Clebsch::project_momentum", "Clebsch::orbit_defect", "Stepper::project"]),
        ("motions_act_from_the_right",       &["Clebsch::act", "Clebsch::coadjoint", "Clebsch::momentum_map"]),
        ("legendre_transforms_are_inverse",  &["Clebsch::legendre", "Clebsch::legendre_next", "Clebsch::inverse_legendre", "Stepper::legendre", "Stepper::legendre_next", "Stepper::inverse_legendre"]),
        ("energies_are_kinetic_and_potential", &["Clebsch::kinetic_energy", "Clebsch::potential", "Stepper::energy", "Stepper::kinetic_energy", "Stepper::potential"]),
        ("potentials_depend_on_time",        &["Stepper::potential_at", "Stepper::legendre_at", "Stepper::legendre_next_at", "Stepper::inverse_legendre_at"]),
    ]),
    ("tests/laws/tests/properties/matrices.rs", &[
        ("linear_systems_are_solved_backward_stably",    &["solve_dense", "Orientation::of"]),
        ("symmetric_systems_are_solved_backward_stably", &["solve_symmetric"]),
        ("inverses_undo",                                &["invert", "inverse"]),
        ("exponentials_are_their_series",                &["exponential", "phi"]),
        ("logarithms_are_those_of_rotations",            &["logarithm"]),
        ("stumpff_functions_are_trigonometric",          &["stumpff"]),
        ("the_largest_is_one_of_them",                   &["largest"]),
        ("projections_are_orthogonal",                   &["annihilator_projection", "annihilator_defect"]),
        ("kinetic_energies_are_quadratic",               &["kinetic_energy", "kinetic_energy_at"]),
        ("compensated_sums_lose_nothing",                &["accumulate"]),
    ]),
    ("tests/laws/tests/properties/paths.rs", &[
        ("motions_are_found_from_their_ends", &[
            "Stepper::boundary", "Boundary::stepper", "Boundary::rest", "Boundary::solve", "Node::configuration", "Node::increment", "Node::momentum", "Node::gain", "Extremal::action", "Extremal::iterations",
            "Extremal::residual", "Extremal::gap", "Extremal::negative", "Extremal::momentum", "Extremal::final_momentum", "Extremal::end", "Extremal::nodes", "Extremal::states",
        ]),
        ("ways_are_extremals_in_order", &["Boundary::several"]),
        ("free_ends_are_pulled",        &["Boundary::solve_free", "Boundary::starting_at"]),
        ("free_times_are_critical",     &["Boundary::free_time"]),
    ]),
    ("tests/laws/tests/properties/places.rs", &[
        ("what_has_left_its_space_comes_back",           &["orthogonal", "of_length_one", "orthogonality_defect", "orientation_defect", "length_defect"]),
        ("rests_come_back_with_their_sums",              &["orthogonal_with_rest", "of_length_one_with_rest"]),
        ("promises_of_fields_are_checked",               &["check_symmetric", "check_diagonal", "check_unit", "check_finite"]),
        ("elements_are_the_identity_and_their_increments", &["from_increment", "quaternion", "quaternion_from_increment", "matrix", "vector"]),
        ("cosines_belong_to_their_sines",                &["per_one_plus_cosine", "below_right_angle"]),
        ("slopes_are_those_of_values",                   &["check_slope"]),
        ("gibbs_vectors_are_tangents_of_half_angles",    &["gibbs_vector_of_matrix", "gibbs_vector_of_quaternion"]),
        ("displacements_are_shortest",                   &["displacement"]),
        ("places_are_pairs",                             &["pair", "arrival_of_state", "endpoint", "no_endpoint"]),
        ("bounds_do_not_depend_on_momenta",              &["bounds"]),
        ("places_are_checked",                           &["check_on_orbit", "check_reached"]),
    ]),
    ("tests/laws/tests/properties/plans.rs", &[
        ("expansions_are_differences", &[
            "Controlled::prepare", "Controlled::check_place", "Controlled::control", "Controlled::follow", "Controlled::price", "Controlled::expand", "Controlled::price_of_time", "Controlled::bounds",
            "Controlled::bounds_expanded", "Controlled::endpoint", "Controlled::endpoint_expanded", "Controlled::arrival", "Controlled::displacement", "Control::follow",
        ]),
        ("regulators_are_those_of_riccati", &[
            "Control::solve", "Control::feedback", "Control::stage", "Control::step_size", "Control::system", "Stage::place", "Stage::input", "Stage::costate", "Stage::gain", "Optimum::price", "Optimum::step_size",
            "Optimum::iterations", "Optimum::residual", "Optimum::gap", "Optimum::negative", "Optimum::is_minimum", "Optimum::end", "Optimum::final_costate", "Optimum::stages",
        ]),
        ("unicycles_park",            &["Stage::with_input", "Stage::multipliers", "Stage::active"]),
        ("plans_start_at_their_time", &["Control::starting_at"]),
        ("free_times_are_critical",   &["Control::solve_free_time"]),
        ("maps_are_followed",         &["Controlled::follow", "Controlled::expand"]),
    ]),
    ("tests/laws/tests/properties/powers.rs", &[
        ("sites_are_systems_alone",    &["Power::site", "Power::act_on_sites", "Power::momenta_of", "Power::coadjoint_of_sites", "Power::matrices_of", "Power::components_of", "Power::projected", "Power::power_drift", "Power::moved", "Power::at_site", "Power::power_kinetic_energy", "Power::power_isotropy_defect", "Power::power_orbit_defect"]),
        ("what_terms_have_is_added_up", &["Power::add_gradient"]),
        ("kicks_are_gradients",        &["Power::potential_of_sites", "Power::gradient_at", "Power::kick_of_site", "Power::slope", "Power::power_kick", "Power::kick_into", "Power::power_stagger"]),
        ("steps_are_kicks_and_moves",  &["Power::power_constants", "Power::constants_of_sites", "PowerConstants::part", "Power::drift_into", "Power::drift_in_place", "Power::power_step_into", "Power::power_steps_of_second_order", "Power::power_steps_of_first_order", "Power::power_legendre", "Power::power_legendre_next", "Power::power_inverse_legendre", "Power::power_step_symmetric"]),
        ("storage_does_not_matter",    &["SiteStorage::of", "Stepper::sites", "Sites::step", "Sites::advance", "Sites::configuration", "Sites::momentum", "Sites::energy", "Sites::steps", "Sites::time", "Sites::stepper", "Sites::into_storage"]),
        ("conserved_momenta_are_sums", &["Sites::conserved"]),
        ("indices_go_round",           &["wrapped"]),
    ]),
    ("tests/laws/tests/properties/rotations.rs", &[
        ("free_bodies_turn_back",               &["FreeRotation::new", "FreeRotation::turn", "FreeRotation::motion", "FreeRotation::gibbs_vector_of", "FreeRotation::turn_of"]),
        ("momenta_belong_to_their_rotations",   &["FreeRotation::momentum", "free_momentum"]),
        ("momenta_belong_to_their_rotations_of_four_dimensions", &["free_momentum_4d"]),
    ]),
    ("tests/laws/tests/properties/scalars.rs", &[
        ("elementary_functions_are_those_of_the_standard_library", &[
            "Scalar::abs", "Scalar::sqrt", "Scalar::recip", "Scalar::sin", "Scalar::cos", "Scalar::tan", "Scalar::asin", "Scalar::acos", "Scalar::atan", "Scalar::sinh", "Scalar::cosh", "Scalar::tanh", "Scalar::exp",
            "Scalar::ln", "Scalar::powf",
        ]),
        ("powers_are_products",                  &["Scalar::powi"]),
        ("conversions_round_once",               &["Scalar::from_ratio", "Scalar::from_f64", "Scalar::to_f64"]),
        ("comparisons_are_made_in_each_lane",    &["Scalar::lane", "Scalar::from_lanes", "Scalar::below", "Scalar::at_most", "Scalar::equals", "Scalar::select", "Scalar::finite", "Scalar::is_finite", "Scalar::iterated"]),
        ("masks_are_sets_of_lanes",              &["Mask::from_bits", "Mask::bits", "Mask::any", "Mask::all", "Mask::lane", "Mask::everywhere", "Mask::nowhere"]),
        ("spaces_are_lists_of_scalars",          &["Space::all", "Space::max_abs", "Space::filled", "Space::origin", "Space::distance_squared", "Space::sum", "Space::zip_map", "Space::finite", "Space::is_finite"]),
        ("spaces_have_lanes",                    &["Space::lane", "Space::set_lane", "Space::side_by_side"]),
        ("clocks_do_not_drift",                  &["Clock::now", "Time::at", "Time::now", "Time::after_step", "Time::take_lane"]),
        ("conserved_values_have_names",          &["Conserved::new", "Conserved::names", "Conserved::values", "Conserved::get", "Conserved::iter", "Conserved::lane"]),
        ("lanes_hold_single_numbers",            &["lanes!::splat", "lanes!::to_array"]),
    ]),
    ("tests/laws/tests/properties/steps.rs", &[
        ("ways_of_stepping_agree", &[
            "Clebsch::impulse", "Clebsch::impulse_after", "Clebsch::step", "Clebsch::steps", "Clebsch::stepper", "State::configuration", "State::momentum", "State::into_parts", "Stepper::state", "Stepper::step",
            "Stepper::advance", "Stepper::trajectory",
        ]),
        ("merged_steps_agree",                             &["Stepper::advance"]),
        ("steps_are_legendre_transforms_and_symmetric",    &["Stepper::step", "Stepper::conserved", "Conserves::conserved"]),
        ("representations_agree",                          &["Stepper::cotangent_state", "Stepper::step_symmetric", "Clebsch::step_symmetric", "CotangentState::configuration", "CotangentState::covector", "CotangentState::into_parts"]),
        ("lanes_are_bodies_alone",                         &["Stepper::step_each", "Stepper::failure", "State::lane"]),
        ("states_know_their_time",                         &["Stepper::state_at", "Stepper::cotangent_state_at", "Stepper::staggered_state_at", "State::time", "CotangentState::time"]),
        ("staggered_steps_are_read_to_second_order",       &["Stepper::staggered_state", "Stepper::synchronized", "Stepper::synchronized_energy", "Clebsch::stagger"]),
        ("torques_add_to_the_momentum",                    &["Stepper::step_with"]),
        ("pendulums_stay_on_the_sphere",                   &["Stepper::project"]),
        ("suggested_steps_reach_their_error",              &["Stepper::suggest_step_size"]),
    ]),
    ("tests/tests/saved/main.rs", &[
        ("saved_states_resume_bit_for_bit", &["Stepper::resume"]),
    ]),
    ("tests/laws/tests/properties/whole.rs", &[
        ("operations_are_those_of_matrices", &["shifted", "determinant", "embedded", "matrix_of"]),
        ("maps_of_skew_matrices_are_their_matrices", &["Sylvester::new", "Sylvester::times", "Jacobian::all_finite", "Jacobian::between", "Jacobian::column", "Jacobian::lane", "Jacobian::largest_entry", "Jacobian::orientation", "Jacobian::size_of_terms", "Jacobian::solve", "Jacobian::solve_exchanged"]),
        ("maps_of_all_kinds_of_numbers_are_inverted", &["Jacobian::solve"]),
        ("skew_matrices_have_components",    &["skew", "skew_components", "skew_times", "skew_outer"]),
        ("inertias_are_inverted",            &["InertiaInverse::new", "InertiaInverse::matrix", "InertiaInverse::times", "InertiaInverse::energy", "invert_uniform", "kinetic_energy_uniform", "orientation_of_inertia", "orientation_of_uniform"]),
        ("integrators_step_in_place",           &["Clebsch::step_into", "in_place", "Stepper::integrator", "Integrator::state", "Integrator::set_state", "Integrator::stepper", "Integrator::steps", "Integrator::step", "Integrator::step_with", "Integrator::advance"]),
        ("states_hold_what_they_step_in",        &["Clebsch::held", "Clebsch::momentum_held"]),
        ("covectors_are_turned_in_their_plane", &["turned_in_plane"]),
        ("points_follow_great_circles",      &["tangent", "momentum_of_tangent", "push", "turn_freely", "turn_great_circle"]),
        ("units_of_projections_do_not_matter", &["projection", "distance_of_projection"]),
    ]),
];
