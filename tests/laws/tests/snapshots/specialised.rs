//! Only the code that a scene asks for: one rigid body, declared with less and less, costs less and less, and has
//! nothing else.

use clebsch_compiler::derive::{RotatingBody, Solution};
use clebsch_compiler::lower::{Cost, Program};

use crate::fixture::Fixture;

/// The inertia by the type of its field: how it is written, and the field.
const INERTIAS: [(&str, &str); 4] = [
    ("self.inertia", "#[clebsch(symmetric)] pub inertia: Matrix3<f64>"),
    ("Matrix3::from_diagonal(&self.moments)", "pub moments: Vector3<f64>"),
    ("Matrix3::from_diagonal(&vector![self.across, self.across, self.along])", "pub across: f64, pub along: f64"),
    ("self.moment", "pub moment: f64"),
];

/// The configuration: an attitude, or a direction seen from the body; and its weight.
const PLACES: [(&str, &str); 2] = [
    ("|F: SO<3>, R: SO<3>| R * F", "|R| self.weight * (R * self.center).z"),
    ("|F: SO<3>, Gamma: Unit<Vector3>| F.transpose() * Gamma", "|Gamma| self.weight * Gamma.dot(&self.center)"),
];

fn body((action, potential): (&str, &str), is_heavy: bool, (inertia, field): (&str, &str)) -> Fixture {
    let (potential, fields) = match is_heavy {
        true => (format!("potential = {potential},"), format!("{field}, pub weight: f64, pub center: Vector3<f64>")),
        false => (String::new(), field.to_string()),
    };
    let source = format!(
        "#[derive(Clebsch)]
         #[clebsch(
             action = {action}, lagrangian = |omega| omega.dot(&({inertia} * omega)) / 2, {potential}
             discretization = moser_veselov, isotropy = free,
         )]
         pub struct Body {{ {fields} }}"
    );
    Fixture { name: "body".to_string(), source }
}

/// The operations of a step with one linearisation.
fn operations(program: &Program<'_>) -> usize {
    let asked =
        ["act", "momentum", "coadjoint", "legendre", "potential", "inertia", "constants", "cotangent", "conserved"];
    let makes_increments =
        program.mechanics().is_none_or(|program| (0..program.steps.len()).all(|index| program.makes_increments(index)));
    // where D and c of F − I = c·D are made apart, a step does not multiply them
    let is_scaled = program.kernels().iter().any(|(name, _)| name == "scaled_increment");
    let makes_increments = makes_increments && !is_scaled;
    let is_stepped = |name: &str| {
        let is_formula = asked.iter().any(|other| name.starts_with(other)) && !name.starts_with("advance");
        !is_formula && name != "generator" && name != "membership" && (makes_increments || name != "increment")
    };
    let kernels = program.kernels().into_iter().filter(|(name, _)| is_stepped(name));
    let of_kernels = kernels.map(|(_, kernel)| kernel.cost()).fold(Cost::default(), Cost::plus).total();
    let solves = program.mechanics().into_iter().flat_map(|program| &program.steps).flat_map(|step| &step.solves);
    of_kernels + solves.map(|solve| of_tensors(solve.solution)).sum::<usize>()
}

/// The operations of the runtime with the tensor of a rotating body and its adjugate, each times a vector.
fn of_tensors(solution: Solution) -> usize {
    match solution {
        Solution::Rotation(RotatingBody::Space { is_principal: true, .. }) => 2 * 3,
        Solution::Rotation(RotatingBody::Space { .. }) => 2 * 15,
        _ => 0,
    }
}

#[test]
fn what_is_declared_with_less_costs_less() {
    let count = |place: usize, is_heavy: bool, inertia: usize| {
        body(PLACES[place], is_heavy, INERTIAS[inertia]).with_program(operations)
    };
    for (is_heavy, place) in [(true, 0), (true, 1), (false, 0), (false, 1)] {
        let of_inertias: Vec<usize> = (0..4).map(|inertia| count(place, is_heavy, inertia)).collect();
        let [general, principal, axisymmetric, spherical] = of_inertias[..] else { panic!("four inertias") };
        // one scalar is the unknown of a body with an axis of symmetry, and of any other
        assert!(
            general > principal && principal == axisymmetric && axisymmetric > spherical,
            "{is_heavy} {place}: {of_inertias:?}"
        );
    }
    for inertia in 0..4 {
        let [heavy, light] = [true, false].map(|is_heavy| [0, 1].map(|place| count(place, is_heavy, inertia)));
        assert!(heavy[0] > light[0] && heavy[1] > light[1], "a weight is a kick: {heavy:?} {light:?}");
        assert!(heavy[0] > heavy[1] && light[0] > light[1], "an attitude is nine numbers: {heavy:?} {light:?}");
    }
}

/// A step without potential has no kick; the closed form of a spherical body neither iterates nor changes the momentum.
#[test]
fn nothing_of_what_is_not_modelled() {
    let names = |fixture: Fixture| {
        fixture.with_program(|program| program.kernels().into_iter().map(|(name, _)| name).collect::<Vec<_>>())
    };
    for place in PLACES {
        for inertia in INERTIAS {
            let has_kick = |is_heavy| names(body(place, is_heavy, inertia)).iter().any(|name| name.ends_with("kick"));
            assert!(has_kick(true) && !has_kick(false));
        }
        let spherical = names(body(place, true, INERTIAS[3]));
        assert!(!spherical.iter().any(|name| name == "linearize" || name == "update"), "{spherical:?}");
    }
}
