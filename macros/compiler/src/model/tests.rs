//! Tables: an action and the side from which each factor acts, an action and its mistake.

use clebsch_symbolic::Graph;

use super::{ByNumber, Model, model};
use crate::diagnostic::Diagnostics;
use crate::parse::parse;

/// The sides of the factors: `left`, `right`, `left, moves nothing`.
fn sides(action: &str) -> Result<String, Diagnostics> {
    let typed = action.split('|').nth(1).unwrap_or_default();
    let element = typed.split(':').next().unwrap_or_default().trim();
    // a kinetic energy of every factor; its form does not matter here
    let names: Vec<&str> = element.split(|c: char| !c.is_alphanumeric()).filter(|name| !name.is_empty()).collect();
    let velocities: Vec<String> = names.iter().map(|name| format!("v{name}")).collect();
    let energy: Vec<String> = velocities.iter().map(|velocity| format!("{velocity}.norm_squared()")).collect();
    let velocities = velocities.join(", ");
    let pattern = if names.len() > 1 { format!("({velocities})") } else { velocities };
    let item = format!("#[clebsch(action = {action}, lagrangian = |{pattern}| {})] struct S;", energy.join(" + "));
    let declaration = parse(item.parse().expect("the table holds Rust"))?;
    let graph = Graph::new();
    let Model::Mechanics(model) = model(&graph, &declaration, ByNumber::Unrolled)? else {
        panic!("a Lagrangian is of mechanics")
    };
    let side = |factor: &super::Factor| match factor.moves {
        true => factor.side.to_string(),
        false => "moves nothing".to_string(),
    };
    Ok(model.factors.iter().map(side).collect::<Vec<_>>().join(", "))
}

#[track_caller]
fn acts(table: &[(&str, &str)]) {
    let found = |action: &str| match sides(action) {
        Ok(sides) => sides,
        Err(errors) => errors.to_string().lines().next().unwrap_or_default().to_string(),
    };
    let differs = |(action, expected): &(&str, &str)| {
        let found = found(action);
        (found != *expected).then(|| format!("`{action}`\n  found    {found}\n  expected {expected}"))
    };
    let wrong: Vec<String> = table.iter().filter_map(differs).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Φ_gh = Φ_g Φ_h for factors on the left, Φ_gh = Φ_h Φ_g for factors on the right, and the inverse changes the side.
#[test]
fn every_group_acts_on_itself() {
    let groups = [
        "SO<3>",
        "SO<4>",
        "SO<1, 3>",
        "SO<2, 1>",
        "SE<2>",
        "SE<3>",
        "GL<2>",
        "GL<3>",
        "SL<2>",
        "SL<3>",
        "Sp<2>",
        "Sp<4>",
        "U<2>",
        "SU<2>",
        "SU<3>",
        "Heisenberg<1>",
        "Heisenberg<2>",
        "Aff<1>",
        "Aff<2>",
        "Sim<2>",
        "Sim<3>",
    ];
    for group in groups {
        for (action, side) in [
            ("F * q", "left"),
            ("q * F", "right"),
            ("F.inverse() * q", "right"),
            ("q * F.inverse()", "left"),
            ("F * q * F.inverse()", "left"),
            // in a Heisenberg group commutators lie in the centre, which conjugation does not move: both laws hold
            ("F.inverse() * q * F", if group.starts_with("Heisenberg") { "left" } else { "right" }),
        ] {
            acts(&[(&format!("|F: {group}, q: {group}| {action}"), side)]);
        }
    }
}

#[test]
#[rustfmt::skip]
fn actions_on_other_spaces() {
    acts(&[
        ("|F: SO<3>, q: Unit<Vector3>| F * q",                               "left"),
        ("|F: SO<3>, q: Unit<Vector3>| F.transpose() * q",                   "right"),
        ("|F: SO<3>, q: RowVector3| q * F",                                  "right"),
        ("|F: SO<4>, q: SMatrix<4, 2>| F * q",                               "left"),
        ("|F: SO<4>, p: Matrix4| F * p * F.transpose()",                     "left"),
        ("|F: GL<2>, s: Matrix2| F * s * F.transpose()",                     "left"),
        ("|F: GL<2>, s: Matrix2| F.transpose() * s * F",                     "right"),
        ("|F: GL<2>, q: Vector2| F.transpose() * q",                         "right"),
        ("|F: GL<2>, q: Vector2| F.inverse().transpose() * q",               "left"),
        ("|F: Sp<4>, z: Vector4| F * z",                                     "left"),
        ("|F: U<2>, z: Vector4| F * z",                                      "left"),
        ("|F: SE<3>, x: Vector3| F.rotation() * x + F.translation()",        "left"),
        ("|F: SE<3>, x: Vector3| F.rotation().transpose() * (x - F.translation())", "right"),
        ("|F: Aff<2>, x: Vector2| F.rotation() * x + F.translation()",       "left"),
        ("|F: Sim<3>, x: [Vector3; 2]| x.map(|p| F.rotation() * p + F.translation())", "left"),
        ("|F: SU<2>, q: Unit<Vector3>| F * q",                               "left"),
        ("|F: SU<2>, q: Unit<Vector3>| F.conjugate() * q",                   "right"),
        ("|F: SU<2>, q: Quaternion| F * q",                                  "left"),
        ("|F: SU<2>, q: Quaternion| F * q * F.conjugate()",                  "left"),
        ("|F: SU<2>, (R, x): (SU<2>, Vector3)| (R * F, F.inverse() * x)",    "right"),
        ("|F: SL<2>, z: Vector1| vector![(F[(0, 0)] * z.x + F[(0, 1)]) / (F[(1, 0)] * z.x + F[(1, 1)])]", "left"),
        ("|F: GL<2>, x: Vector1| F.determinant() * x",                       "left"),
        ("|F: GL<2>, x: Vector1| x / F.determinant()",                       "left"),
        ("|s: GL<1>, x: Vector3| s * x",                                     "left"),
        ("|a: Translation<3>, x: Translation<3>| x + a",                     "left"),
        ("|a: Translation<3>, x: Vector3| x - a",                            "left"),
        ("|F: SO<2>, (x, y): (Vector1, Vector1)| (F[(0, 0)] * x + F[(0, 1)] * y, F[(1, 0)] * x + F[(1, 1)] * y)", "left"),
        ("|F: Heisenberg<1>, x: Vector3| F * x",                             "left"),
    ]);
}

/// A factor on which both laws hold takes the side of the others, else left; one that moves nothing has none.
#[test]
#[rustfmt::skip]
fn sides_are_found_per_factor() {
    acts(&[
        ("|(F, W): (SO<3>, SO<3>), R: SO<3>| W * R * F",                                      "right, left"),
        ("|(F, W): (SO<3>, SO<3>), (R, q): (SO<3>, Unit<Vector3>)| (R * F, W * q)",           "right, left"),
        ("|(F, a): (SO<3>, Translation<3>), (R, x): (SO<3>, Vector3)| (R * F, x + a)",        "right, right"),
        ("|(F, a): (SO<3>, Translation<3>), (R, x): (SO<3>, Vector3)| (F * R, x + a)",        "left, left"),
        ("|(F, a): (SO<3>, SO<2>), (R, x): (SO<3>, Unit<Vector2>)| (R * F, a * x)",           "right, right"),
        ("|(F, W, a): (SO<3>, SO<3>, Translation<1>), (R, x): (SO<3>, Vector1)| (W * R * F, x + a)", "right, left, left"),
        ("|(s, F): (GL<1>, SO<3>), x: Vector3| s * (F * x)",                                  "left, left"),
        ("|(a, W): (Translation<2>, SO<3>), x: Vector2| x + a",                               "left, moves nothing"),
        ("|(F, G): (SU<2>, SU<2>), Q: SU<2>| G * Q * F",                                      "right, left"),
    ]);
}

#[test]
#[rustfmt::skip]
fn what_is_no_action() {
    acts(&[
        ("|F: SO<3>, q: Unit<Vector3>| F * F * q",          "error: `|F, q| F * F * q` is not an action of SO<3>"),
        ("|F: GL<2>, q: Vector2| F.transpose() * F * q",    "error: `|F, q| F.transpose() * F * q` is not an action of GL<2>"),
        ("|F: SU<2>, q: SU<2>| F * q * F",                  "error: `|F, q| F * q * F` is not an action of SU<2>"),
        ("|F: SE<2>, x: Vector2| F.rotation() * x + 2 * F.rotation() * F.translation()", "error: `|F, x| F.rotation() * x + 2 * F.rotation() * F.translation()` is not an action of SE<2>"),
        ("|F: SL<2>, q: SL<2>| F * q * F.transpose()",      "left"),
        ("|F: GL<2>, q: SL<2>| F * q",                      "error: the action moves `q` to `F*q`, which is not always in SL<2>"),
        ("|F: GL<2>, q: SL<2>| F * q * F.inverse()",        "left"),
        ("|F: SO<3>, q: GL<3>| F * q",                      "left"),
        ("|F: U<3>, q: SU<3>| F * q",                       "error: the action moves `q` to `F*q`, which is not always in SU<3>"),
        ("|F: GL<3>, q: Unit<Vector3>| F * q",              "error: the action moves `q` to `F*q`, which is not always a unit vector"),
        ("|F: SU<2>, q: SU<2>| (F * q + q) / 2",            "error: the action moves `q` to `(F * q + q) / 2`, which is not always in SU<2>"),
        ("|F: Heisenberg<1>, q: Heisenberg<1>| F.transpose() * q", "error: the action moves `q` to `Fᵀ*q`, which is not always in Heisenberg<1>"),
    ]);
}

/// The configuration of a site lies on the group that the action names. Closures of a power read the same parts as
/// those of a single system.
#[test]
fn sites_are_on_their_group() {
    for (group, read) in [
        ("SE<2>", "q[i].rotation().trace() + q[i].translation().x"),
        ("SE<3>", "(q[i].inverse() * q[i]).rotation().inverse().trace() + q[i].translation().x"),
        ("Aff<2>", "q[i].rotation().inverse().trace() + q[i].translation().x"),
        ("Sim<3>", "q[i].rotation().trace() + (q[i] * q[i]).translation().x"),
        ("SO<4>", "q[i].inverse().trace()"),
        ("SU<2>", "(q[i].inverse() * self.axis).x"),
        ("(SE<3>, SU<2>)", "q[i].0.translation().x + (q[i].1 * self.axis).x"),
    ] {
        let (product, square) = match group {
            "(SE<3>, SU<2>)" => ("(q[i].0 * F[i].0, q[i].1 * F[i].1)", "w[i].0.norm_squared() + w[i].1.norm_squared()"),
            _ => ("q[i] * F[i]", "w[i].norm_squared()"),
        };
        for (generics, n) in [("<const N: usize>", "N"), ("", "4")] {
            for neighbour in ["i".to_string(), format!("(i + 1) % {n}")] {
                let potential = read.replace("[i]", &format!("[{neighbour}]"));
                let metric = format!("(1 + ({read}).powi(2))");
                let item = format!(
                    "#[clebsch(action = |F: [{group}; {n}], q: [{group}; {n}]| (0..{n}).map(|i| {product}),
                        lagrangian = |q, w| (0..{n}).map(|i| {metric} * ({square}) / 2).sum(), potential = |q| (0..{n}).map(|i| {potential}).sum())]
                    struct S{generics} {{ axis: Vector3<f64> }}"
                );
                let declaration = parse(item.parse().expect("the table holds Rust")).expect("a declaration");
                let errors = model(&Graph::new(), &declaration, ByNumber::Unrolled).err();
                assert!(errors.is_none(), "{item}\n{}", errors.unwrap_or_default());
            }
        }
    }
}
