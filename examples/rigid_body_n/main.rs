//! The free rigid body of Moser and Veselov in five to ten dimensions, with up to 45 components of the momentum. The
//! step conserves all of Manakov's integrals.
//!
//! Sources: Moser and Veselov, *Discrete versions of some classical integrable systems* (1991). Manakov, *Note on the
//! integration of Euler's equations of the dynamics of an n-dimensional rigid body* (1976).

mod bodies;
mod euler;
mod figure;
mod manakov;
mod start;
mod watch;

use bodies::{RigidBody5, RigidBody6, RigidBody7, RigidBody8, RigidBody9, RigidBody10};
use clap::Parser;
use clebsch::{Clebsch, Declared};
use clebsch_examples::claims::Claims;
use clebsch_examples::convergence::{Convergence, refined};
use clebsch_examples::csv::{Csv, by_rows};
use clebsch_examples::flags::{Order, Run, Scene, parse};
use clebsch_examples::integrate::integrate;
use clebsch_examples::reference;
use clebsch_examples::scene::{Failure, conclude, say};
use nalgebra::SMatrix;
use start::{Body, Start, planes};
use std::process::ExitCode;
use watch::Watch;

const SCENE: Scene = Scene {
    name: "rigid_body_n",
    step_size: "0.1",
    time_unit: "seconds",
    steps: "10000",
    order: "2",
    order_note: "it places the potential; a free body has none, so 1 and 2 give the same step",
    columns_note: "attitude R11..Rnn, momentum M12,M13,.. (entries above the diagonal of the matrix M = J_d W + W J_d, kg m2/s)",
};

/// Steps of the comparison with the generalised Euler equations, at most.
const COMPARED: u64 = 200;

/// A free rigid body in 5 to 10 dimensions: spatial momentum, energy and all of Manakov's integrals conserved by the step
#[derive(Parser, Debug)]
struct Flags {
    /// Dimension n of the space that the body turns in, 5 to 10
    #[arg(long, value_name = "n", default_value = "6", allow_hyphen_values = true)]
    #[arg(value_parser = dimension)]
    dimension: u8,
    #[command(flatten)]
    body: Body,
    #[command(flatten)]
    run: Run,
}

/// A dimension that there is a declaration for.
fn dimension(text: &str) -> Result<u8, String> {
    let found = text.trim().parse().ok().filter(|dimension| (5..=10).contains(dimension));
    found.ok_or_else(|| format!("`{}` is not a whole number from 5 to 10", text.trim()))
}

fn main() -> ExitCode {
    let flags: Flags = parse(&SCENE);
    conclude(match flags.dimension {
        5 => run::<_, 5, 50>(|j_d| RigidBody5 { j_d }, &flags),
        6 => run::<_, 6, 72>(|j_d| RigidBody6 { j_d }, &flags),
        7 => run::<_, 7, 98>(|j_d| RigidBody7 { j_d }, &flags),
        8 => run::<_, 8, 128>(|j_d| RigidBody8 { j_d }, &flags),
        9 => run::<_, 9, 162>(|j_d| RigidBody9 { j_d }, &flags),
        _ => run::<_, 10, 200>(|j_d| RigidBody10 { j_d }, &flags),
    })
}

/// The scene in N dimensions; U = 2N² numbers are an attitude and a momentum.
fn run<S, const N: usize, const U: usize>(
    body: impl Fn(SMatrix<f64, N, N>) -> S,
    flags: &Flags,
) -> Result<Claims, Failure>
where
    S: Clebsch<Scalar = f64, Configuration = SMatrix<f64, N, N>, MomentumMatrix = SMatrix<f64, N, N>> + Clone,
{
    let start = Start::<N>::new(&flags.body)?;
    let body = body(SMatrix::from_diagonal(&start.j_d));
    let stepper = body.stepper(flags.run.step_size)?;
    let state = stepper.state(SMatrix::identity(), S::momentum_components(&start.momentum))?;

    let mut csv = Csv::create(&flags.run, &columns(N).iter().map(String::as_str).collect::<Vec<_>>())?;
    let mut watch = Watch::new(&flags.run, &start);
    integrate(&flags.run, &stepper, state, |step, time, state| {
        let (attitude, momentum) = (state.configuration(), S::momentum_matrix(&state.momentum()));
        csv.row(step, time, by_rows(attitude).chain(planes(N).map(|plane| momentum[plane])))?;
        watch.observe(step, time, attitude, &momentum, stepper.energy(state), stepper.system().orbit_defect(attitude));
        Ok(())
    })?;

    let Run { step_size, steps, .. } = flags.run;
    let duration = flags.run.duration();
    say(format_args!("free rigid body in {N} dimensions over {duration} s: {steps} steps of {step_size} s\n"));
    say(&watch.table);
    say(watch.integrals());
    csv.finish()?;
    figure::draw(&flags.run, &watch)?;

    let mut claims = Claims::new();
    watch.claim(&mut claims);
    claim_order::<S, N, U>(&flags.run, &body, &start, &mut claims)?;
    Ok(claims)
}

/// The columns of the CSV file.
fn columns(n: usize) -> Vec<String> {
    // R11 is R1_1 where there is an R1_10
    let between = if n < 10 { "" } else { "_" };
    let attitude = (1..=n).flat_map(|i| (1..=n).map(move |j| format!("R{i}{between}{j}")));
    attitude.chain(planes(n).map(|(i, j)| format!("M{}{between}{}", i + 1, j + 1))).collect()
}

/// Claims order 2 against the generalised Euler equations, of the attitude and the momentum at once.
fn claim_order<S, const N: usize, const U: usize>(
    run: &Run,
    body: &S,
    start: &Start<N>,
    claims: &mut Claims,
) -> Result<(), Failure>
where
    S: Clebsch<Scalar = f64, Configuration = SMatrix<f64, N, N>, MomentumMatrix = SMatrix<f64, N, N>> + Clone,
{
    let (steps, components) = (run.steps.min(COMPARED), S::momentum_components(&start.momentum));
    let unknowns = euler::pack::<N, U>(&SMatrix::identity(), &start.momentum);
    let exact = reference::solve(euler::field(start.j_d), unknowns, run.time(steps), start.rate());
    let errors = refined::<_, Declared>(body, run, steps, |stepper| stepper.state(SMatrix::identity(), components))?
        .map(|end| {
            let reached = euler::pack::<N, U>(end.configuration(), &S::momentum_matrix(&end.momentum()));
            (reached - exact.end).amax() / exact.end.amax()
        });
    let convergence = Convergence { errors, reference: exact.error / exact.end.amax(), steps };
    convergence.claim(Order::Second, "order 2 against the generalised Euler equations", claims);
    Ok(())
}
