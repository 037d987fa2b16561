//! Times the expansion of every accepted fixture with the compiler built as this program is, by
//! `cargo run -p clebsch-tests --features heavy --example expansion [-- --json]`. This is without optimisation, as cargo builds macros
//! by default, or with `--release`.

#[path = "../benches/steps/expansion.rs"]
mod expansion;

fn main() {
    let expansions = expansion::all();
    match std::env::args().any(|argument| argument == "--json") {
        true => expansion::print_json(&expansions),
        false => expansion::print(&expansions),
    }
}
