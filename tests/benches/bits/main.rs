//! The bits of trajectories, to see that a redesign changes none: `cargo bench -p clebsch-tests --features heavy --bench bits > before.txt` before it, and after it
//! `cargo bench -p clebsch-tests --features heavy --bench bits -- compare before.txt`.
//!
//! One line for each system and each quantity. It has a hash over all numbers, and a hash in which −0 is 0. The first
//! and the last numbers with all their digits tell the size of a change. The systems are the accepted fixtures, and
//! small ones for the combinations of dials that no fixture has.
//!
//! Bits do not depend on optimisation: `--profile dev` builds sooner.

mod combinations;
mod compare;
mod endpoints;
mod fixtures;
#[path = "../../laws/tests/lanes/lift.rs"]
mod lift;
mod plans;
mod record;
mod run;
mod sites;
mod trajectories;

use trajectories::Recorder;

fn main() {
    // cargo adds `--bench`
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [] => lines().iter().for_each(|line| println!("{line}")),
        ["compare", file] => {
            let before = std::fs::read_to_string(file).unwrap_or_else(|error| panic!("{file}: {error}"));
            let same = compare::print(&before, &lines());
            std::process::exit(if same { 0 } else { 1 });
        }
        _ => panic!("usage: [compare FILE]"),
    }
}

/// All lines.
fn lines() -> Vec<String> {
    let recorder = Recorder::default();
    fixtures::all(&recorder);
    combinations::all(&recorder);
    sites::all(&recorder);
    endpoints::all(&recorder);
    plans::all(&recorder);
    recorder.lines()
}
