//! Mistakes as rustc shows them: one error each, at its place, and nothing that follows from it.
//!
//! The messages themselves are snapshots of `fixtures/reject`; here it is that they arrive. `TRYBUILD=overwrite` writes them.

#[test]
fn mistakes_as_rustc_shows_them() {
    trybuild::TestCases::new().compile_fail("cases/*.rs");
}
