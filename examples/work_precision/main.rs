//! The price of accuracy: every setting of seven scenes and two classical methods, from long steps to short ones.
//!
//! A setting is a discretization with an order. Times are those of one core; machines are noisy, so take their ratios.

mod checks;
mod classical;
mod dormand_prince;
mod exact;
mod figure;
mod measure;
mod motion;
mod report;
mod scenes;
mod setting;

use clap::{Parser, ValueEnum};
use clebsch_examples::claims::Claims;
use clebsch_examples::scene::{Failure, conclude, say};
use measure::Grid;
use motion::Scene;
use report::Csv;
use std::path::PathBuf;
use std::process::ExitCode;

/// Work and precision: error against time for all settings of seven scenes, next to RK4 and DOP853
#[derive(Parser, Debug)]
#[command(name = "work_precision")]
struct Flags {
    /// Finer dials, shorter steps, and tables of all points: some minutes
    #[arg(long)]
    full: bool,
    /// One scene alone
    #[arg(long, value_name = "NAME")]
    scene: Option<Choice>,
    /// Write all points to FILE: scene, method, order, h (s), tolerance, steps, error (relative), time (ns per simulated second), energy errors, momenta, constraint
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Draw the figures to FOLDER, as SVG [default: `figures` under cargo's target folder]
    #[arg(long, value_name = "FOLDER")]
    figures: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
#[value(rename_all = "snake_case")]
enum Choice {
    FreeBody,
    HeavyTop,
    Pendulum,
    #[value(name = "body4")]
    Body4,
    Satellite,
    Orbit,
    NarrowOrbit,
}

impl Flags {
    fn grid(&self) -> Grid {
        if self.full {
            Grid { finer: 2, most: 1_400_000, patience: 4.0 }
        } else {
            Grid { finer: 1, most: 170_000, patience: 0.25 }
        }
    }

    fn includes(&self, scene: Choice) -> bool {
        self.scene.is_none_or(|chosen| chosen == scene)
    }
}

fn main() -> ExitCode {
    conclude(run(&Flags::parse()))
}

fn run(flags: &Flags) -> Result<Claims, Failure> {
    let mut study = Study { flags, csv: None, claims: Claims::new(), advice: Vec::new() };
    study.csv = flags.csv.as_deref().map(Csv::create).transpose()?;
    if flags.includes(Choice::FreeBody) {
        study.scene(&scenes::free_body::scene())?;
    }
    if flags.includes(Choice::HeavyTop) {
        study.scene(&scenes::heavy_top::scene())?;
    }
    if flags.includes(Choice::Pendulum) {
        study.scene(&scenes::pendulum::scene())?;
    }
    if flags.includes(Choice::Body4) {
        study.scene(&scenes::body4::scene())?;
    }
    if flags.includes(Choice::Satellite) {
        study.scene(&scenes::satellite::scene())?;
    }
    if flags.includes(Choice::Orbit) {
        study.scene(&scenes::orbit::scene("orbit", "orbit of eccentricity 0.9", 0.9))?;
    }
    if flags.includes(Choice::NarrowOrbit) {
        study.scene(&scenes::orbit::scene("narrow_orbit", "orbit of eccentricity 0.99", 0.99))?;
    }
    say("advice: the cheapest declaration for an error, and what classical methods need");
    for line in &study.advice {
        say(format_args!("  {line}"));
    }
    if let Some(csv) = study.csv {
        csv.finish()?;
    }
    Ok(study.claims)
}

/// The results so far.
struct Study<'a> {
    flags: &'a Flags,
    csv: Option<Csv<'a>>,
    claims: Claims,
    advice: Vec<String>,
}

impl Study<'_> {
    fn scene<const N: usize>(&mut self, scene: &Scene<N>) -> Result<(), Failure> {
        let exact = exact::exact(scene);
        let points = measure::measure(scene, &exact, self.flags.grid());
        say(format_args!(
            "{} over {} s, against a reference that is known to {:.0e}\n",
            scene.title, scene.duration, exact.error
        ));
        say(report::settings(&points, scene.least_error));
        say(report::points(&points, self.flags.full));
        if let Some(csv) = &mut self.csv {
            csv.points(scene.name, &points)?;
        }
        figure::draw(self.flags.figures.as_deref(), scene.name, scene.title, &points)?;
        say("");
        self.advice.extend(report::advice(scene.title, scene.duration, &points));
        checks::claim(scene, &exact, &points, &mut self.claims);
        Ok(())
    }
}
