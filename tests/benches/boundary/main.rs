//! Fixed endpoints and derivatives of steps: `cargo bench -p clebsch-tests --bench boundary`.
//!
//! Solutions of P5 and P5v, cold and warm, next to Newton's method by hand, timed in turn in the same run. Time and
//! bytes of each edge of paths of any length, and the share of random endpoints that is solved. Plans of least price
//! within bounds, and the share of random goals that is reached. Then derivatives of steps as multiples of the step.

mod goals;
mod hand;
#[path = "../../laws/tests/boundary/pairs.rs"]
mod pairs;
mod plans;
mod slews;
mod systems;
mod tangents;
#[path = "../steps/timing.rs"]
mod timing;

fn main() {
    println!(
        "Fixed endpoints: time of a solution, µs; of each edge of it, ns; ratio to the same by hand; bytes of the path, of an edge\n"
    );
    println!(
        "{:8} {:>6} {:14} {:>10} {:>10} {:>7} {:>6} {:>5} {:>9} {:>5} {:>14} {:>9}",
        "problem", "edges", "", "least", "median", "edge", "ratio", "iter.", "bytes", "edge", "action", "residual"
    );
    for edges in [50, 10, 100, 1000, 10_000] {
        for lines in slews::lines(edges).chunk_by(|a, b| a.problem == b.problem) {
            for line in lines {
                let [least, median] = [line.time.least, line.time.median].map(|time| time / 1e3);
                let (per_edge, bytes_per_edge) = (line.time.least / line.edges as f64, line.bytes / line.edges);
                let ratio = line.time.least / lines[2].time.least;
                println!(
                    "{:8} {:6} {:14} {least:10.2} {median:10.2} {per_edge:7.1} {ratio:6.2} {:5} {:9} {bytes_per_edge:5} {:14.10} {:9.1e}",
                    line.problem, line.edges, line.peer, line.iterations, line.bytes, line.action, line.residual
                );
            }
        }
    }
    println!(
        "\nRandom endpoints: solved to 1e-12 away from the cut locus, near it; linearisations; what was said of the others\n"
    );
    println!(
        "{:14} {:>6} {:>6} {:>8} {:>5} {:>5} {:>7} {:>5}",
        "system", "away", "solved", "share", "near", "solved", "iter.", "most"
    );
    for line in pairs::lines(10_000) {
        let mean = line.iterations as f64 / (line.away + line.near) as f64;
        println!(
            "{:14} {:6} {:6} {:7.3}% {:5} {:6} {mean:7.2} {:5} {:?}",
            line.system,
            line.away,
            line.solved,
            100.0 * line.share(),
            line.near,
            line.solved_near,
            line.most,
            line.errors
        );
    }
    println!(
        "\nPlans: time of a solution from no guess and from itself, µs; of each step in a linearisation, ns; bytes of a step\n"
    );
    println!(
        "{:8} {:>6} {:>10} {:>10} {:>5} {:>5} {:>8} {:>6} {:>6} {:>14}",
        "problem", "steps", "cold", "again", "iter.", "iter.", "step", "bytes", "held", "price"
    );
    for line in [10, 50, 200, 1000].into_iter().flat_map(plans::lines) {
        let [cold, again] = [0, 1].map(|k: usize| line.times[k].least);
        let [first, second] = line.iterations;
        let (per_step, bytes) = (cold / line.steps as f64 / f64::from(first), line.bytes / line.steps);
        println!(
            "{:8} {:6} {:10.1} {:10.1} {first:5} {second:5} {per_step:8.1} {bytes:6} {:6} {:14.10}",
            line.problem,
            line.steps,
            cold / 1e3,
            again / 1e3,
            line.held,
            line.price
        );
    }
    println!(
        "\nRandom goals of a unicycle within bounds, from standing still: reached; linearisations; errors of another kind\n"
    );
    println!(
        "{:>8} {:>6} {:>7} {:>8} {:>6} {:>6} {:>6}",
        "turning", "goals", "reached", "share", "median", "most", "others"
    );
    for line in goals::lines(2000) {
        let iterations = &line.iterations;
        println!(
            "{:8} {:6} {:7} {:7.2}% {:6} {:6} {:6}",
            line.top_turn,
            line.goals,
            line.solved,
            100.0 * line.solved as f64 / line.goals as f64,
            iterations.get(iterations.len() / 2).copied().unwrap_or_default(),
            iterations.last().copied().unwrap_or_default(),
            line.otherwise
        );
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
