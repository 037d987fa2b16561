//! A Lagrangian T(ξ) − V(q) in one closure is the same declaration as its two parts.

use clebsch_compiler::{Graph, compile, emit};

/// The generated code, without the lines of the declaration.
fn code(energies: &str, keys: &str) -> String {
    let item = format!(
        "#[clebsch({energies}, {keys})] struct S {{ #[clebsch(symmetric)] inertia: Matrix3<f64>, weight: f64, center: Vector3<f64> }}"
    );
    let graph = Graph::new();
    let program =
        compile(&graph, item.parse().expect("Rust tokens")).unwrap_or_else(|errors| panic!("{item}\n{errors}"));
    emit::generated(&program)
}

/// A body and a particle, in several discretizations.
#[test]
fn a_potential_may_stand_in_the_lagrangian() {
    let body = ("action = |F: SO<3>, R: SO<3>| R * F", "R", "omega");
    let (turning, falling) = ("omega.dot(&(self.inertia * omega)) / 2", "self.weight * (R * self.center).z");
    let particle = ("action = |a: Translation<3>, x: Vector3| x + a", "x", "v");
    let (moving, pulled) = ("self.weight * v.norm_squared() / 2", "(x - self.center).norm_squared().powi(2)");
    for keys in [
        "",
        "order = 4",
        "discretization = moser_veselov",
        "discretization = exact",
        "discretization = exponential, emit = [tangent]",
    ] {
        let systems = [(body, turning, falling), (particle, moving, pulled)];
        let is_body = keys.contains("moser") || keys.contains("exact");
        for ((action, q, xi), kinetic, potential) in systems.into_iter().take(if is_body { 1 } else { 2 }) {
            let apart = format!("{action}, lagrangian = |{xi}| {kinetic}, potential = |{q}| {potential}");
            let together = format!("{action}, lagrangian = |{q}, {xi}| {kinetic} - {potential}");
            assert_eq!(code(&together, keys), code(&apart, keys), "{together}");
            let both = format!(
                "{action}, lagrangian = |{q}, {xi}| {kinetic} - {potential}, potential = |{q}| {q}.norm_squared()"
            );
            let sum =
                format!("{action}, lagrangian = |{xi}| {kinetic}, potential = |{q}| {potential} + {q}.norm_squared()");
            assert_eq!(code(&both, keys), code(&sum, keys), "{both}");
        }
    }
}

/// Where the kinetic energy depends on the configuration, it couples and stays as it is.
#[test]
fn a_metric_stays_in_the_lagrangian() {
    let coupled = "action = |a: Translation<3>, x: Vector3| x + a, lagrangian = |x, v| (1 + x.norm_squared()) * v.norm_squared() / 2 - self.weight * x.z";
    assert!(code(coupled, "").contains("couples"), "{}", code(coupled, ""));
}
