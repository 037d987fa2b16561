//! Kinks, antikinks and breathers on a line of pendulums: the sine-Gordon equation as a field of rotations of the plane.

mod figure;
mod line;
mod plain;
mod solitons;
mod study;
mod watch;

use clap::Parser;
use clebsch_examples::claims::Claims;
use clebsch_examples::csv::Csv;
use clebsch_examples::flags::{Run, Scene, parse, positive};
use clebsch_examples::scene::{Failure, conclude, say};
use clebsch_examples::table::Table;
use line::{Angle, Chord, Mesh, Pendulums};
use plain::Form;
use solitons::{Soliton, lorentz};
use std::f64::consts::PI;
use std::process::ExitCode;
use study::{Case, Errors};
use watch::Watch;

const SCENE: Scene = Scene {
    name: "kink",
    step_size: "0.05",
    time_unit: "seconds",
    steps: "480",
    order: "2",
    order_note: "steps of fields have order 2 or more",
    columns_note: "of the breather by angles: u in the middle by steps and by the closed form (rad), energy (J)",
};

/// Tails of solitons at the ends, e to the minus this.
const TAIL: f64 = 10.0;

/// The sine-Gordon equation on a line of pendulums: speed of a kink, a kink meets an antikink, a breather
#[derive(Parser, Clone, Debug)]
struct Flags {
    /// Length of the line, m
    #[arg(long, value_name = "L", value_parser = positive, allow_hyphen_values = true, default_value = "40")]
    length: f64,
    /// Spacing of the pendulums, m; errors are shown for twice and half of it, too
    #[arg(long, value_name = "DX", value_parser = positive, allow_hyphen_values = true, default_value = "0.1")]
    spacing: f64,
    /// Speed of the kinks, in that of light
    #[arg(long, value_name = "V", value_parser = part, allow_hyphen_values = true, default_value = "0.5")]
    speed: f64,
    /// Frequency of the breather, in that of one pendulum
    #[arg(long, value_name = "OMEGA", value_parser = part, allow_hyphen_values = true, default_value = "0.6")]
    frequency: f64,
    #[command(flatten)]
    run: Run,
}

/// A number between 0 and 1.
fn part(text: &str) -> Result<f64, String> {
    let number = positive(text)?;
    if number < 1.0 { Ok(number) } else { Err(format!("`{}` is not below 1", text.trim())) }
}

fn main() -> ExitCode {
    conclude(run(&parse(&SCENE)))
}

impl Flags {
    /// The line, if it is long and fine enough.
    fn mesh(&self) -> Result<Mesh, Failure> {
        let (v, time) = (self.speed, self.run.duration());
        let room = self.length / 2.0 - v * (time / 2.0).max(10.0);
        let depth = (room * lorentz(v)).min(self.length / 2.0 * (1.0 - self.frequency * self.frequency).sqrt());
        if depth < TAIL {
            return Err(Failure::Flags(format!(
                "--length: the tails of the solitons reach the ends, take more than {} m",
                self.length
            )));
        }
        // of the coarsest grid
        let limit = self.spacing / self.spacing.hypot(1.0);
        if self.run.step_size > limit {
            let text =
                format!("--step-size: {} s is longer than {limit:.4} s, the longest stable step", self.run.step_size);
            return Err(Failure::Flags(text));
        }
        Ok(Mesh { length: self.length, dx: self.spacing, h: self.run.step_size, steps: self.run.steps })
    }
}

fn run(flags: &Flags) -> Result<Claims, Failure> {
    flags.run.refuse_first_order(&SCENE)?;
    let mesh = flags.mesh()?;
    let pair = Case { name: "kinks meet", soliton: Soliton::Pair(flags.speed), from: -mesh.time() / 2.0 };
    let breather = Case { name: "breather", soliton: Soliton::Breather(flags.frequency), from: 0.0 };
    let mut csv = Csv::create(&flags.run, &["steps", "exact", "energy"])?;
    let meeting = Watch::of(&Angle, &flags.run, &mesh, &pair, |_, _, _| Ok(()))?;
    let breathing = Watch::of(&Angle, &flags.run, &mesh, &breather, |step, time, row| csv.row(step, time, row))?;
    say(format_args!("{} pendulums on {} m: {} steps of {} s\n", mesh.sites(), mesh.length, mesh.steps, mesh.h));
    let mut claims = Claims::new();
    let mut errors = of_form(&Chord, "chords", Form::Chord, flags, &[pair, breather], &mut claims)?;
    errors.extend(of_form(&Angle, "angles", Form::Angle, flags, &[pair, breather], &mut claims)?);
    say(table(flags, &errors));
    csv.finish()?;
    let shown: Vec<Errors> = errors.iter().filter(|errors| !errors.name.ends_with("energy")).cloned().collect();
    figure::draw(flags, &meeting, &breathing, &shown)?;
    let half = Mesh { h: mesh.h / 2.0, steps: mesh.steps * 2, ..mesh };
    let halved = Watch::of(&Angle, &flags.run.refined(2), &half, &pair, |_, _, _| Ok(()))?;
    let reason = format!("angles; the change with h is {:.1e} of the energy", meeting.energy);
    claims.within(
        "kinks meet, half the step: a quarter of the change of the energy",
        meeting.energy / halved.energy,
        3.5..=4.5,
        3,
        &reason,
    );
    Ok(claims)
}

/// Errors of one declaration, and the claims about it.
fn of_form<S: Pendulums>(
    system: &S,
    name: &str,
    form: Form,
    flags: &Flags,
    cases: &[Case; 2],
    claims: &mut Claims,
) -> Result<Vec<Errors>, Failure> {
    let mesh = flags.mesh()?;
    let mut errors = vec![study::speeds(system, name, &mesh, flags.speed)?];
    for case in cases {
        errors.push(study::ends(system, name, &mesh, case)?);
    }
    errors.push(study::energies(system, name, &mesh, &cases[0])?);
    for errors in &errors {
        errors.claim(claims);
    }
    let off = study::to_plain(system, form, &mesh, &cases[0])?;
    claims.round_off(&format!("{name}: the same steps by hand in plain angles, rad"), off, mesh.steps, PI);
    Ok(errors)
}

fn table(flags: &Flags, errors: &[Errors]) -> Table<5> {
    let headings = [2.0, 1.0, 0.5].map(|part| format!("dx = {}", part * flags.spacing));
    let mut table = Table::new(["error of", &headings[0], &headings[1], &headings[2], "order"]);
    for errors in errors {
        let [coarse, middle, fine] = errors.values.map(|error| format!("{error:.2e}"));
        table.row([errors.name.clone(), coarse, middle, fine, format!("{:.3}", errors.order())]);
    }
    table
}
