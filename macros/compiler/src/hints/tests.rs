//! Which paths an editor is given.

use super::hints;

/// The paths behind `keys::`.
fn paths(item: &str) -> Vec<String> {
    let text = hints(&item.parse().expect("tokens")).to_string().replace(' ', "");
    text.split("keys::").skip(1).filter_map(|path| path.split("as_").next()).map(str::to_string).collect()
}

#[test]
fn keys_and_words_have_paths() {
    let declaration = "#[derive(Clone)] #[clebsch(
        action         = |F: SO<3>, R: SO<3>| R * F,
        cost           = |t, h, R, F| t,
        discretization = cayley,
        order          = 4,
        emit           = [tangent, boundary],
        method Fine    = (order = 6, chart = exponential),
        scalar         = f32,
    )]
    pub struct Body { #[clebsch(symmetric)] inertia: Matrix3<f64>, other: [u8; 2] }";
    let keys = ["action", "cost", "discretization::cayley", "order", "emit::tangent", "emit::boundary"];
    let others = ["method", "order", "chart::exponential", "scalar", "field::symmetric"];
    assert_eq!(paths(declaration), [&keys[..], &others].concat());
}

#[test]
fn names_that_are_still_being_written_have_paths() {
    assert_eq!(paths("#[clebsch(action = |F: SO<3>, R: SO<3>| R * F, discr)] struct Body;"), ["action", "discr"]);
    assert_eq!(paths("#[clebsch(emit = [tan])] struct Body;"), ["emit::tan"]);
}

#[test]
fn the_runtime_may_have_another_name() {
    let hints = hints(&"#[clebsch(crate = other::name, order = 2)] struct Body;".parse().expect("tokens"));
    assert!(hints.to_string().replace(' ', "").contains("useother::name::__private::keys::orderas_"), "{hints}");
}

#[test]
fn keywords_have_no_paths() {
    assert_eq!(paths("#[clebsch(struct, fn = 1, emit = [self, _], crate = 5 + 3)] struct Body;"), ["emit"]);
    assert_eq!(paths("#[clebsch(order = 2, emit = struct)] struct Body;"), ["order", "emit"]);
}
