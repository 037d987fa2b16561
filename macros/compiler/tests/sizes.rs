//! Declarations of every size have an integrator or an error that says so: there is no gap between small and large
//! ones.

use clebsch_compiler::{Graph, compile, emit};

fn compiles(declaration: &str) -> Result<(), String> {
    let item = declaration.parse().expect("Rust tokens");
    compile(&Graph::new(), item).map(|_| ()).map_err(|errors| errors.to_string())
}

fn body(n: usize) -> String {
    format!(
        "#[derive(Clebsch)]
        #[clebsch(action = |F: SO<{n}>, R: SO<{n}>| R * F, cost = |h, F| (self.j_d * (F - I) * (F - I).transpose()).trace() / h)]
        struct Body {{ #[clebsch(symmetric)] j_d: SMatrix<f64, {n}, {n}> }}"
    )
}

fn point(n: usize) -> String {
    format!(
        "#[derive(Clebsch)]
        #[clebsch(action = |F: SO<{n}>, q: Unit<SVector<f64, {n}>>| F * q, cost = |h, F| (F - I).norm_squared() / (4 * h),
            potential = |q| self.stiffness.dot(&q.component_mul(&q)) / 2)]
        struct Point {{ stiffness: SVector<f64, {n}> }}"
    )
}

/// Points on S¹² to S¹⁵ were refused once. They lie between those that were unrolled and those whose symmetries are
/// looked for one by one.
#[test]
fn points_of_all_dimensions() {
    for n in (2..=10).chain(12..=20).chain([33, 64]) {
        assert_eq!(compiles(&point(n)), Ok(()), "{n}");
    }
}

/// The largest that the documentation names.
#[test]
fn symplectic_and_unimodular_matrices_of_all_sizes() {
    let named = ["Sp<4>", "Sp<6>", "Sp<8>", "Sp<10>", "SL<3>", "SL<5>", "SL<7>", "SL<8>"];
    for group in named {
        let declaration = format!(
            "#[derive(Clebsch)]
            #[clebsch(action = |F: {group}, q: {group}| q * F, cost = |h, F| (F - I).norm_squared() / (2 * h), scalar = f64)]
            struct Motion;"
        );
        assert_eq!(compiles(&declaration), Ok(()), "{group}");
    }
}

#[test]
fn bodies_of_all_dimensions() {
    for n in 2..=11 {
        assert_eq!(compiles(&body(n)), Ok(()), "{n}");
    }
    for n in [12, 16] {
        let error = compiles(&body(n)).expect_err("too many unknowns");
        assert!(error.contains("is too large"), "{error}");
    }
}

/// A particle with a potential and further keys.
fn particle(potential: &str, rest: &str) -> String {
    let kinetic = "action = |a: Translation<3>, x: Vector3| x + a, cost = |h, a| a.norm_squared() / (2 * h)";
    format!(
        "#[clebsch({kinetic}, potential = |x| {potential}{rest})] struct P {{ a: SVector<f64, 16>, b: SVector<f64, 16>, scalar: f64 }}"
    )
}

/// The second derivatives of a product have a term for each pair of factors. Once all products in them were distributed.
#[test]
fn products_of_sums_have_second_derivatives() {
    for n in [2, 6, 10, 12] {
        let factors: Vec<String> =
            (0..n).map(|k| format!("(self.a[{k}] * x.x + self.b[{k}] * x.y + x.z + 1)")).collect();
        assert_eq!(compiles(&particle(&factors.join(" * "), ", emit = [tangent]")), Ok(()), "{n}");
    }
}

/// One formula has a million terms once its products are distributed. The text of the other doubles with each level.
#[test]
fn texts_of_long_formulas_are_short() {
    let nested = format!("{{ let b = x.x; {} b }}", "let b = (b + self.scalar * x.y).sin() * b;".repeat(12));
    let metric =
        "lagrangian = |q, v| (v.dot(&(self.inertia * v)) + self.linear.dot(&v)) / 2 * (1 + q[(2, 1)].powi(2) / 4)";
    let body = format!(
        "#[clebsch(action = |F: SO<4>, q: SO<4>| q * F, {metric}, discretization = exponential)]
        struct Body {{ inertia: SMatrix<f64, 6, 6>, linear: SVector<f64, 6> }}"
    );
    for declaration in [particle(&nested, ""), body] {
        let (graph, item) = (Graph::new(), declaration.parse().expect("Rust tokens"));
        let program = compile(&graph, item).unwrap_or_else(|errors| panic!("{errors}"));
        let text = emit::derivations(&program);
        let longest = text.lines().map(|line| line.chars().count()).max().unwrap_or(0);
        assert!(longest < 20_000, "a line of {longest} characters");
        assert!(text.contains(", P₁ = "), "{text}");
    }
}
