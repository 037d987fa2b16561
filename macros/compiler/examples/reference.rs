//! Prints the reference of the derive macro: `cargo run -p clebsch-compiler --example reference > macros/reference.md`.
//! With the word `hints` it prints the texts that editors show: `… --example reference hints > runtime/src/__private/keys.rs`.

const DECLARATION: &str = include_str!("../../../tests/fixtures/accept/free_particle.rs");
const SNAPSHOT: &str = include_str!("../../../tests/snapshots/accept/free_particle.6_generated.snap");

fn main() {
    if std::env::args().nth(1).is_some_and(|word| word == "hints") {
        return print!("{}", clebsch_compiler::keys_for_editors());
    }
    // a snapshot has its header between two lines of dashes
    let expansion = SNAPSHOT.splitn(3, "---\n").nth(2).unwrap_or_default();
    print!("{}", clebsch_compiler::reference(DECLARATION, expansion));
}
