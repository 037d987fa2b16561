//! The free rigid body of Moser and Veselov on SO(5): ten unknowns a step, integrable, and the step keeps every integral.
//!
//! Sources: Moser and Veselov, *Discrete versions of some classical integrable systems* (1991). Manakov, *Note on the
//! integration of Euler's equations of the dynamics of an n-dimensional rigid body* (1976).

mod euler;
mod figure;
mod invariants;
mod watch;

use clap::Parser;
use clebsch::{Clebsch, State, Stepper};
use clebsch_examples::claims::Claims;
use clebsch_examples::convergence::{Convergence, refined};
use clebsch_examples::csv::{Csv, by_rows};
use clebsch_examples::flags::{Order, Run, Scene, finite_list, parse};
use clebsch_examples::integrate::integrate;
use clebsch_examples::reference;
use clebsch_examples::round_off;
use clebsch_examples::scene::{Failure, conclude, say};
use invariants::PLANES;
use nalgebra::{Matrix5, Vector5};
use std::process::ExitCode;
use watch::Watch;

/// The generalised free rigid body in five dimensions.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<5>, R: SO<5>| R * F,
    cost   = |h, F| (self.j_d * (F - I) * (F - I).transpose()).trace() / h,
)]
pub struct RigidBody5 {
    /// J_d of Moser and Veselov: half of ∫ρρᵀdm, kg·m².
    #[clebsch(symmetric)]
    pub j_d: Matrix5<f64>,
}

const SCENE: Scene = Scene {
    name: "rigid_body_5d",
    step_size: "0.1",
    time_unit: "seconds",
    steps: "20000",
    order: "2",
    order_note: "it places the potential; a free body has none, so 1 and 2 give the same step",
    columns_note: "attitude R11..R55, momentum M12,M13,..,M45 (entries of the matrix M = J_d W + W J_d, kg m2/s)",
};

/// Steps of the comparison with the generalised Euler equations, at most.
const COMPARED: u64 = 200;

/// A free rigid body in five dimensions: spatial momentum, energy and Manakov's integrals conserved by the step
#[derive(Parser, Debug)]
struct Flags {
    /// Diagonal of J_d (half the second moments of mass), kg m2; every two of them must have a sum above zero
    #[arg(long, value_name = "A,B,C,D,E", value_parser = second_moments, allow_hyphen_values = true)]
    #[arg(default_value = "1,1.5,2,2.5,3")]
    j_d: [f64; 5],
    /// Momentum at the start, body frame: the ten entries above the diagonal of the matrix M, row by row, kg m2/s
    #[arg(long, value_name = "M12,..,M45", value_parser = finite_list::<10>, allow_hyphen_values = true)]
    #[arg(default_value = "0.6,-0.9,0.4,0.5,1.1,-0.2,0.7,0.9,-0.8,1.2")]
    momentum: [f64; 10],
    #[command(flatten)]
    run: Run,
}

/// Five numbers with positive sums of every two: otherwise the kinetic energy is not positive.
fn second_moments(text: &str) -> Result<[f64; 5], String> {
    let moments = finite_list::<5>(text)?;
    for (i, j) in PLANES {
        let sum = moments[i] + moments[j];
        if sum <= 0.0 {
            return Err(format!("entries {} and {} have the sum {sum}: it must be above zero", i + 1, j + 1));
        }
    }
    Ok(moments)
}

fn main() -> ExitCode {
    conclude(run(&parse(&SCENE)))
}

fn run(flags: &Flags) -> Result<Claims, Failure> {
    let body = RigidBody5 { j_d: Matrix5::from_diagonal(&Vector5::from(flags.j_d)) };
    let stepper = body.stepper(flags.run.step_size)?;
    let start = start(&stepper, flags)?;

    let mut csv = Csv::create(&flags.run, &columns().iter().map(String::as_str).collect::<Vec<_>>())?;
    let mut watch = Watch::new(flags);
    let mut end = start;
    integrate(&flags.run, &stepper, start, |step, time, state| {
        let (attitude, momentum) = (state.configuration(), stepper.momentum_matrix(&state.momentum()));
        csv.row(step, time, by_rows(attitude).chain(PLANES.map(|plane| momentum[plane])))?;
        watch.observe(step, time, attitude, &momentum, stepper.energy(state), stepper.system().orbit_defect(attitude));
        end = *state;
        Ok(())
    })?;

    let Run { step_size, steps, .. } = flags.run;
    let duration = flags.run.duration();
    say(format_args!("free rigid body in five dimensions over {duration} s: {steps} steps of {step_size} s\n"));
    say(&watch.table);
    csv.finish()?;
    figure::draw(flags, &watch)?;

    let mut claims = Claims::new();
    watch.claim(&mut claims);
    claim_return(flags, &body, &end, &mut claims)?;
    claim_order(flags, &body, &mut claims)?;
    Ok(claims)
}

/// The start at any step size.
fn start(stepper: &Stepper<RigidBody5>, flags: &Flags) -> Result<State<RigidBody5>, clebsch::Error> {
    stepper.state(Matrix5::identity(), stepper.momentum_components(&invariants::skew(&flags.momentum)))
}

/// The columns of the CSV file.
fn columns() -> Vec<String> {
    let attitude = (1..=5).flat_map(|i| (1..=5).map(move |j| format!("R{i}{j}")));
    attitude.chain(PLANES.map(|(i, j)| format!("M{}{}", i + 1, j + 1))).collect()
}

/// Claims that steps of −h undo the run.
///
/// An error of the momentum turns the body with the wrong velocity from there on, so that rounding grows with the angle.
fn claim_return(flags: &Flags, body: &RigidBody5, end: &State<RigidBody5>, claims: &mut Claims) -> Result<(), Failure> {
    let back = body.stepper(-flags.run.step_size)?;
    let mut state = *end;
    for step in 1..=flags.run.steps {
        state = back.step(&state).map_err(|error| Failure::Step { step, error })?;
    }
    let m = invariants::skew(&flags.momentum);
    let distance = (state.configuration() - Matrix5::identity()).amax();
    let angle = euler::velocity(&m, &flags.j_d).norm() * flags.run.duration();
    let bound = round_off::worst_case(2 * flags.run.steps, 1.0 + angle);
    claims.at_most("steps of −h lead back to the start", distance, bound, "rounding, times the angle turned");
    Ok(())
}

/// Claims order 2 against the generalised Euler equations.
fn claim_order(flags: &Flags, body: &RigidBody5, claims: &mut Claims) -> Result<(), Failure> {
    let steps = flags.run.steps.min(COMPARED);
    let m = invariants::skew(&flags.momentum);
    let rate = euler::velocity(&m, &flags.j_d).norm();
    let start_of = euler::pack(&Matrix5::identity(), &m);
    let exact = reference::solve(euler::field(flags.j_d), start_of, flags.run.time(steps), rate);
    let errors = refined(body, &flags.run, steps, |stepper| start(stepper, flags))?.map(|end| {
        let reached = euler::pack(end.configuration(), &RigidBody5::momentum_matrix(&end.momentum()));
        (reached - exact.end).amax() / exact.end.amax()
    });
    let convergence = Convergence { errors, reference: exact.error / exact.end.amax(), steps };
    convergence.claim(Order::Second, "order 2 against the generalised Euler equations", claims);
    Ok(())
}
