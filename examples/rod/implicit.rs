//! Implicit steps of a thin rod: its first mode in a hundred steps a period, thousands of times the longest stable step.

use crate::beam::Beam;
use crate::declaration::{Rod, centre, momenta};
use crate::modes::{euler_bernoulli, frequencies, thin};
use clebsch::{MidpointStepper, Various};
use clebsch_examples::claims::{Claims, largest};
use clebsch_examples::scene::Failure;
use clebsch_examples::table::Table;
use nalgebra::{Matrix3, Matrix4, Rotation3, SVector, Vector3};

/// Edges.
const EDGES: usize = 40;
/// Deflections of the ends in metres, with steps a period of the first mode.
const RUNS: [(f64, u32); 6] = [(1e-4, 50), (1e-4, 100), (1e-4, 200), (1e-2, 100), (1e-2, 200), (0.1, 4000)];
/// Deflections far below the thickness: the equations are linear.
const SMALL: f64 = 1e-3;

/// The first mode of Euler and Bernoulli with free ends, 1 at both of them, and its second derivative.
fn mode(s: f64) -> (f64, f64) {
    let (beta, part) = shape();
    let value = (beta * s).cosh() + (beta * s).cos() - part * ((beta * s).sinh() + (beta * s).sin());
    let bent = (beta * s).cosh() - (beta * s).cos() - part * ((beta * s).sinh() - (beta * s).sin());
    (value / 2.0, beta * beta * bent / 2.0)
}

/// β of this mode, and the part of its functions that are odd. Its slope at the start is −βσ.
fn shape() -> (f64, f64) {
    let beta = euler_bernoulli(1);
    (beta, (beta.cosh() - beta.cos()) / (beta.sinh() - beta.sin()))
}

/// A rod along z with the curvature of this mode, neither stretched nor sheared: each edge has the strain (κ, 0, 0, 0, 0, 1).
fn bent(beam: &Beam, deflection: f64) -> Vec<Matrix4<f64>> {
    let spacing = beam.spacing(EDGES);
    let edge = |i: usize| {
        let (_, second) = mode((i as f64 + 0.5) / EDGES as f64);
        let half = (-Vector3::x() * (deflection * second / beam.length.powi(2) * spacing / 2.0)).cross_matrix();
        let resolvent = (Matrix3::identity() - half).try_inverse().unwrap_or_default();
        let mut edge = (resolvent * (Matrix3::identity() + half)).to_homogeneous();
        edge.fixed_view_mut::<3, 1>(0, 3).copy_from(&(resolvent * Vector3::z() * spacing));
        edge
    };
    let (beta, part) = shape();
    let tilt = Rotation3::new(Vector3::x() * (deflection / beam.length * beta * part).atan()).to_homogeneous();
    let start = Matrix4::new_translation(&(Vector3::y() * deflection)) * tilt;
    let next = |place: &Matrix4<f64>, i: usize| *place * edge(i);
    let mut places = vec![start];
    (0..EDGES).for_each(|i| places.extend(places.last().map(|place| next(place, i))));
    places
}

/// The results of a run.
struct Shown {
    /// 2/h tan ½θ, where θ is the turn of the mode in a step.
    frequency: f64,
    /// Linear systems a step.
    systems: f64,
    /// Of its change, over its first value.
    energy: f64,
    /// The largest of both, over the mass times the deflection by the step.
    momentum: f64,
}

fn run(beam: &Beam, stepper: &MidpointStepper<Rod, Various>, steps: u32, deflection: f64) -> Result<Shown, Failure> {
    let mut state = stepper.state(bent(beam, deflection), vec![SVector::<f64, 6>::zeros(); EDGES + 1])?;
    let energy = stepper.energy(&state)?;
    let (mut along, mut systems, mut band, mut moved) = (Vec::new(), 0, 0.0_f64, 0.0_f64);
    let amplitude = |q: &[Matrix4<f64>]| -> f64 {
        let part = |i: usize| if i == 0 || i == EDGES { 0.5 } else { 1.0 };
        q.iter().enumerate().map(|(i, q)| part(i) * mode(i as f64 / EDGES as f64).0 * centre(q).y).sum()
    };
    for step in 0..=steps {
        along.push(amplitude(state.configuration()));
        band = band.max((stepper.energy(&state)? / energy - 1.0).abs());
        moved = moved.max(largest(momenta(&state).iter().map(|momentum| momentum.norm())));
        if step < steps {
            stepper.step(&mut state).map_err(Failure::step(u64::from(step) + 1))?;
            systems += state.iterations();
        }
    }
    // an oscillation has a⁺ + a⁻ = 2 a cos θ
    let (mut product, mut square) = (0.0, 0.0);
    for three in along.windows(3) {
        product += three[1] * (three[0] + three[2]) / 2.0;
        square += three[1] * three[1];
    }
    let angle = (product / square).acos();
    Ok(Shown {
        frequency: 2.0 / stepper.step_size() * (angle / 2.0).tan(),
        systems: f64::from(systems) / f64::from(steps),
        energy: band,
        momentum: moved * stepper.step_size() / (beam.mass * beam.length * deflection),
    })
}

/// A table of runs over one period, and the claims of their frequency, energy and momenta. Runs of more than `most` steps are left out.
///
/// # Errors
/// Those of steps.
pub fn compare(most: u64, claims: &mut Claims) -> Result<Table<6>, Failure> {
    let beam = thin();
    let near = [1, 2, 3].map(|mode| euler_bernoulli(mode).powi(2) * (beam.bending / beam.mass).sqrt());
    let exact = frequencies(&beam, EDGES, near)[0];
    let stable = beam.stable_step(EDGES)?;
    let headings = [
        "ends / m",
        "steps a period",
        "step over the stable one",
        "systems a step",
        "frequency over exact, less 1",
        "energy band",
    ];
    let mut table = Table::new(headings);
    for (deflection, steps) in RUNS.into_iter().filter(|&(_, steps)| u64::from(steps) <= most) {
        let h = std::f64::consts::TAU / exact / f64::from(steps);
        let shown = run(&beam, &beam.implicit(EDGES, h)?, steps, deflection)?;
        let off = shown.frequency / exact - 1.0;
        let (ends, period, longer) = (format!("{deflection}"), steps.to_string(), format!("{:.0}", h / stable));
        let [systems, energy] = [format!("{:.2}", shown.systems), format!("{:.1e}", shown.energy)];
        table.row([ends, period, longer, systems, format!("{off:.1e}"), energy]);
        let name = format!("implicit steps, ends at {deflection} m, {steps} a period");
        claims.at_most(&format!("{name}: momenta"), shown.momentum, 1e-12, "over mass · deflection / step");
        claims.at_most(&format!("{name}: change of the energy"), shown.energy, 1e-2, "of the first one");
        if deflection < SMALL {
            let reason = "of the sections, by bisection without steps";
            claims.at_most(&format!("{name}: difference from the frequency"), off.abs(), 1e-5, reason);
        }
    }
    Ok(table)
}
