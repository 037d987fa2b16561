//! The first benchmark: `cargo bench -p clebsch-tests --bench steps [-- --json]`.
//!
//! For each scene the time of a step, next to the same scheme written by hand and the classical Runge–Kutta method. All
//! are timed in turn in the same run. Then drifts, the work of a step, and the cost of each fixture's expansion. With
//! `--json` one line for each of these. The expansion without optimisation, as macros are built by default:
//! `cargo run -p clebsch-tests --features heavy --example expansion`.

mod counted;
mod engine;
mod expansion;
mod hand;
mod hand4;
mod problems;
mod runge_kutta;
mod timing;
mod trial;

use problems::Result;

fn main() {
    let is_json = std::env::args().any(|argument| argument == "--json");
    let (results, expansions) = (problems::all(), expansion::all());
    if is_json {
        results.iter().for_each(print_json);
        expansion::print_json(&expansions);
    } else {
        print(&results);
        print_ends();
        println!();
        expansion::print(&expansions);
    }
}

/// The table for a person.
fn print(results: &[Result]) {
    println!(
        "Time of a step, ns; ratio to the same scheme by hand; largest drift of the energy and of the constraint;"
    );
    println!("operations and linearisations of a step\n");
    println!(
        "{:8} {:>5} {:22} {:>8} {:>8} {:>6} {:>9} {:>11} {:>6} {:>6}",
        "problem", "h", "", "least", "median", "ratio", "energy", "constraint", "ops", "lin."
    );
    for group in results.chunk_by(|a, b| a.problem == b.problem && a.h == b.h) {
        for Result { problem, peer, h, time, drift, work, .. } in group {
            let ratio = time.least / group[1].time.least;
            let work =
                work.map(|work| format!("{:6.0} {:6.2}", work.operations, work.linearizations)).unwrap_or_default();
            println!(
                "{problem:8} {h:5} {peer:22} {:8.2} {:8.2} {ratio:6.2} {:9.1e} {:11.1e} {work}",
                time.least, time.median, drift.energy, drift.constraint
            );
        }
    }
}

/// The end of the free body after a million steps, next to that of the gyroscopic step of game engines.
fn print_ends() {
    println!(
        "\nThe free body after a million steps of 0.01: relative errors of energy and spatial momentum; the nearest axis of"
    );
    println!("the body to its momentum (of least, middle and greatest inertia), and the angle to it\n");
    println!("{:22} {:>9} {:>9} {:>5} {:>7}", "", "energy", "momentum", "axis", "angle");
    for end in problems::ends() {
        println!("{:22} {:9.1e} {:9.1e} {:5} {:6.2}°", end.peer, end.energy, end.spatial, end.axis, end.angle);
    }
}

/// One line with the keys of other benchmarks of these problems; errors against a reference are not measured here.
fn print_json(result: &Result) {
    let Result { problem, peer, setting, h, time, drift, work } = result;
    let per_unit = time.least * 1e-9 / h;
    let linearizations = work.map_or(0.0, |work| work.linearizations);
    let operations = work.map(|work| format!(",\"ops\":{:.0}", work.operations)).unwrap_or_default();
    println!(
        "{{\"problem\":\"{problem}\",\"peer\":\"{peer}\",\"setting\":\"{setting}\",\"h\":{h},\"ns_step_min\":{:.2},\"ns_step_med\":{:.2},\
         \"s_per_unit\":{per_unit:.4e},\"iters\":{linearizations:.3},\"err_max\":NaN,\"err_T\":NaN,\"dE\":{:.3e},\"orth\":{:.3e}{operations}}}",
        time.least, time.median, drift.energy, drift.constraint
    );
}
