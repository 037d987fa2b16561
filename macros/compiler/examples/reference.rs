//! Prints the reference of the derive macro: `cargo run -p clebsch-compiler --example reference > macros/reference.md`.

const DECLARATION: &str = include_str!("../../../tests/fixtures/accept/free_particle.rs");
const SNAPSHOT: &str = include_str!("../../../tests/snapshots/accept/free_particle.6_generated.snap");

fn main() {
    // a snapshot has its header between two lines of dashes
    let expansion = SNAPSHOT.splitn(3, "---\n").nth(2).unwrap_or_default();
    print!("{}", clebsch_compiler::reference(DECLARATION, expansion));
}
