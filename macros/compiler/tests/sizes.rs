//! Declarations of every size have an integrator or an error that says so: there is no gap between small and large
//! ones.

use clebsch_compiler::{Graph, compile};

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
