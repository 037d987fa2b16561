//! The free rigid body of Moser and Veselov on SO(4): integrable, and the step keeps every integral.
//!
//! Sources: Moser and Veselov, *Discrete versions of some classical integrable systems* (1991); Manakov (1976).

mod figure;
mod invariants;
mod watch;

use clap::Parser;
use clebsch::Clebsch;
use clebsch_examples::claims::Claims;
use clebsch_examples::csv::{Csv, by_rows};
use clebsch_examples::flags::{Run, Scene, finite_list, parse};
use clebsch_examples::integrate::integrate;
use clebsch_examples::scene::{Failure, conclude, say};
use invariants::PLANES;
use nalgebra::{Matrix4, Vector4};
use std::process::ExitCode;
use watch::Watch;

/// The generalised free rigid body in four dimensions.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<4>, R: SO<4>| R * F,
    cost   = |h, F| (self.j_d * (F - I) * (F - I).transpose()).trace() / h,
)]
pub struct RigidBody4 {
    /// J_d of Moser and Veselov: half of ∫ρρᵀdm, kg·m².
    #[clebsch(symmetric)]
    pub j_d: Matrix4<f64>,
}

const SCENE: Scene = Scene {
    name: "rigid_body_4d",
    step_size: "0.1",
    time_unit: "seconds",
    steps: "20000",
    order: "2",
    order_note: "it places the potential; a free body has none, so 1 and 2 give the same step",
    columns_note: "attitude R11..R44, momentum M12,M13,M14,M23,M24,M34 (entries of the matrix M = J_d W + W J_d, kg m2/s)",
};

/// A free rigid body in four dimensions: spatial momentum, energy and Manakov's integrals conserved by the step
#[derive(Parser, Debug)]
struct Flags {
    /// Diagonal of J_d (half the second moments of mass), kg m2; every two of them must have a sum above zero
    #[arg(long, value_name = "A,B,C,D", value_parser = second_moments, allow_hyphen_values = true)]
    #[arg(default_value = "1,1.5,2,2.5")]
    j_d: [f64; 4],
    /// Momentum at the start, body frame: entries above the diagonal of the matrix M, kg m2/s
    #[arg(long, value_name = "M12,M13,M14,M23,M24,M34", value_parser = finite_list::<6>, allow_hyphen_values = true)]
    #[arg(default_value = "0.3,-0.5,0.2,0.6,-0.1,0.5")]
    momentum: [f64; 6],
    #[command(flatten)]
    run: Run,
}

/// Four numbers with positive sums of every two: otherwise the kinetic energy is not positive.
fn second_moments(text: &str) -> Result<[f64; 4], String> {
    let moments = finite_list::<4>(text)?;
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
    let j_d = Matrix4::from_diagonal(&Vector4::from(flags.j_d));
    let stepper = RigidBody4 { j_d }.into_stepper(flags.run.step_size)?;
    let matrix = invariants::skew(&flags.momentum);
    let start = stepper.state(Matrix4::identity(), stepper.momentum_components(&matrix))?;

    let columns = "R11 R12 R13 R14 R21 R22 R23 R24 R31 R32 R33 R34 R41 R42 R43 R44 M12 M13 M14 M23 M24 M34";
    let mut csv = Csv::create(&flags.run, &columns.split(' ').collect::<Vec<_>>())?;
    let mut watch = Watch::new(flags);
    integrate(&flags.run, &stepper, start, |step, time, state| {
        let (attitude, momentum) = (state.configuration(), stepper.momentum_matrix(&state.momentum()));
        csv.row(step, time, by_rows(attitude).chain(PLANES.map(|plane| momentum[plane])))?;
        watch.observe(step, time, attitude, &momentum, stepper.energy(state), stepper.system().orbit_defect(attitude));
        Ok(())
    })?;

    let Run { step_size, steps, .. } = flags.run;
    let duration = flags.run.duration();
    say(format_args!("free rigid body in four dimensions over {duration} s: {steps} steps of {step_size} s\n"));
    say(&watch.table);
    csv.finish()?;
    figure::draw(flags, &watch)?;

    let mut claims = Claims::new();
    watch.claim(&mut claims);
    Ok(claims)
}
