//! Keys that textbooks and other libraries have, and the text to write in their place.

use proc_macro2::Ident;

/// Names that are no keys, and the advice for each.
#[rustfmt::skip]
const EXPECTED: [(&[&str], &str); 12] = [
    (&["hamiltonian"],
        "write `lagrangian = |v| …`, the kinetic energy as a function of the velocity, and `potential = |q| …`"),
    (&["kinetic", "kinetic_energy", "energy", "mass", "masses", "inertia"],
        "write `lagrangian = |v| …`, the kinetic energy as a function of the velocity"),
    (&["potential_energy", "gravity", "spring"],
        "write `potential = |q| …`, the potential energy"),
    (&["friction", "damping", "dissipation", "drag", "rayleigh", "torque", "torques"],
        "write `force = |v| …`, with the components of the momentum"),
    (&["integrator", "scheme", "stepper", "rule"],
        "write `order = 2`, 4, 6, 8 or 16; `discretization` and `chart` choose among steps of one order"),
    (&["h", "dt", "step_size", "timestep", "time_step", "stepsize"],
        "leave it out: the step is the argument of `stepper(h)`"),
    (&["t", "time", "duration", "horizon", "steps"],
        "leave it out: the number of steps is chosen when they are made"),
    (&["configuration", "configurations", "configuration_space", "manifold", "state", "coordinates", "q"],
        "write the space as the type of the second argument of the action, `action = |F: SO<3>, R: SO<3>| R * F`"),
    (&["input", "inputs"],
        "write `controls = |u: Vector2| …` for the velocity that an input gives, or a typed last argument of `force`"),
    (&["goal", "terminal", "terminal_cost", "final_cost", "terminal_constraint", "final_constraint", "arrival"],
        "write `endpoint = |q| …`, the price of the end, or `target = |q| [a == b]`, conditions of the end"),
    (&["objective", "price", "running_cost", "stage_cost"],
        "write `cost = |h, u| …`, the price of the input of one step, or `effort` for the input of a force"),
    (&["type", "float", "precision", "dtype", "real"],
        "write `scalar = f32`, or give the fields their scalar type"),
];

/// The advice for a name that is no key.
pub(super) fn advice(key: &Ident) -> Option<&'static str> {
    let expected = EXPECTED.iter().find(|(names, _)| names.iter().any(|name| key == name));
    expected.map(|(_, advice)| *advice)
}
