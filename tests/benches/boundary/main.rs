//! Fixed endpoints and derivatives of steps: `cargo bench -p clebsch-tests --bench boundary`.
//!
//! Solutions of P5 and P5v, cold and warm, beside Newton's method by hand, timed in turn in the same run; the time per node of long
//! paths; then derivatives of steps as multiples of the step.

mod hand;
mod slews;
mod systems;
mod tangents;
#[path = "../steps/timing.rs"]
mod timing;

fn main() {
    println!(
        "Fixed endpoints: time of a solution, µs; of an edge in an iteration, ns; ratio to the same by hand; bytes of the path\n"
    );
    println!(
        "{:8} {:>6} {:14} {:>10} {:>10} {:>7} {:>6} {:>5} {:>9} {:>14} {:>9}",
        "problem", "edges", "", "least", "median", "edge", "ratio", "iter.", "bytes", "action", "residual"
    );
    for edges in [50, 10, 100, 1000, 10_000] {
        for lines in slews::lines(edges).chunk_by(|a, b| a.problem == b.problem) {
            for line in lines {
                let [least, median] = [line.time.least, line.time.median].map(|time| time / 1e3);
                let per_edge = line.time.least / f64::from(line.iterations) / line.edges as f64;
                let ratio = line.time.least / lines[2].time.least;
                println!(
                    "{:8} {:6} {:14} {least:10.2} {median:10.2} {per_edge:7.1} {ratio:6.2} {:5} {:9} {:14.10} {:9.1e}",
                    line.problem, line.edges, line.peer, line.iterations, line.bytes, line.action, line.residual
                );
            }
        }
    }
    println!("\nDerivatives: time of a step, ns, and multiples of it with the tangent map, with sensitivities too\n");
    println!("{:20} {:>3} {:>3} {:>8} {:>8} {:>12}", "system", "M", "P", "step", "tangent", "sensitivity");
    for line in tangents::lines() {
        let [step, tangent, sensitivity] = [0, 1, 2].map(|k: usize| line.times[k].least);
        println!(
            "{:20} {:3} {:3} {step:8.1} {:8.2} {:12.2}",
            line.system,
            line.dimension,
            line.quantities,
            tangent / step,
            sensitivity / step
        );
    }
}
