//! How errors of rounding grow over many steps.

use crate::declarations::long_runs;
use crate::map::{Map, SCALARS, size};
use crate::probe::{Cell, LongRun, Watch};
use crate::setup::Setup;
use clebsch::Error;
use clebsch_examples::claims::Claims;
use clebsch_examples::figure::{self, BLUE, Curve, Decades, GREEN, INK, ORANGE, PURPLE, RED, RGBColor, TEAL};
use clebsch_examples::scene::{Failure, say};
use clebsch_examples::table::aligned;
use rayon::prelude::*;
use std::path::Path;

const SECTION: &str = "long run";
const COLOURS: [RGBColor; 7] = [BLUE, GREEN, ORANGE, RED, PURPLE, TEAL, INK];

/// Observations between two marks.
const OBSERVATIONS: u64 = 100;

/// Root mean squares of relative errors up to a number of steps, from the mark before.
#[derive(Clone, Copy, Debug)]
struct Drift {
    /// The number of steps.
    steps: u64,
    /// Of the energy.
    energy: f64,
    /// Of conserved momenta.
    momentum: f64,
    /// The defect of the configuration.
    constraint: f64,
}

/// A long run in a type, with errors between marks.
///
/// # Errors
/// That of the step which was refused.
fn drift(run: &LongRun, scalar: usize, setup: &Setup, marks: &[u64]) -> Result<Vec<Drift>, Error> {
    let mut motion = (run.begin[scalar])(setup)?;
    let first = Watch::new(motion.as_ref());
    let (mut drifts, mut steps) = (Vec::new(), 0);
    for &mark in marks {
        let (mut sums, begin) = ([0.0; 3], steps);
        for part in 1..=OBSERVATIONS {
            let goal = begin + (mark - begin) * part / OBSERVATIONS;
            motion.advance((goal - steps) as usize)?;
            steps = goal;
            let mut watch = first.clone();
            watch.observe(motion.as_ref());
            let Cell { energy, momentum, constraint, .. } = watch.cell;
            for (sum, x) in sums.iter_mut().zip([energy, momentum, constraint]) {
                *sum += x * x;
            }
        }
        let [energy, momentum, constraint] = sums.map(|sum| (sum / OBSERVATIONS as f64).sqrt());
        drifts.push(Drift { steps: mark, energy, momentum, constraint });
    }
    Ok(drifts)
}

/// The exponent p of a quantity that grows like stepsᵖ, by least squares in logarithms over the last decades.
fn growth(drifts: &[Drift], of: fn(&Drift) -> f64) -> f64 {
    let points: Vec<(f64, f64)> = drifts
        .iter()
        .filter(|drift| drift.steps >= 10_000 && of(drift) > 0.0)
        .map(|drift| ((drift.steps as f64).ln(), of(drift).ln()))
        .collect();
    let count = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / count;
    let (x, y) = (mean(|point| point.0), mean(|point| point.1));
    let above: f64 = points.iter().map(|point| (point.0 - x) * (point.1 - y)).sum();
    above / points.iter().map(|point| (point.0 - x).powi(2)).sum::<f64>()
}

/// Runs all of them, to `steps` steps.
pub fn explore(map: &mut Map<'_>, claims: &mut Claims, steps: u64, folder: Option<&Path>) -> Result<(), Failure> {
    let decades = (3..).map(|power| 10_u64.pow(power)).take_while(|&count| count <= steps);
    let marks: Vec<u64> = decades.flat_map(|count| [count, 3 * count]).filter(|&count| count <= steps).collect();
    let dials = long_runs();
    for (scalar, name) in SCALARS.into_iter().enumerate() {
        let runs = dials.par_iter().map(|dial| drift(dial, scalar, &Setup::ordinary(), &marks));
        let runs: Vec<Vec<Drift>> = runs.collect::<Result<_, _>>()?;
        say(format_args!(
            "Long runs, {name}: root mean square between {:.0e} and {:.0e} steps of h = {}, relative, and the exponent p of steps^p\n",
            marks[marks.len().saturating_sub(2)] as f64,
            *marks.last().unwrap_or(&0) as f64,
            Setup::ordinary().h
        ));
        let mut rows = vec![["", "energy", "p", "momenta", "p", "constraint", "p"].map(str::to_owned).to_vec()];
        for (dial, drifts) in dials.iter().zip(&runs) {
            let mut row = vec![format!("{}, {}", dial.scene, dial.name)];
            let quantities: [fn(&Drift) -> f64; 3] =
                [|drift| drift.energy, |drift| drift.momentum, |drift| drift.constraint];
            for of in quantities {
                row.push(drifts.last().map_or(String::new(), |last| size(of(last))));
                row.push(format!("{:.1}", growth(drifts, of)));
            }
            for &Drift { steps, energy, momentum, constraint } in drifts {
                let cell = Cell { energy, momentum, constraint, ..Cell::of(Ok(()), steps) };
                map.add_run(SECTION, (dial.scene, dial.name), name, "root mean squares", &cell)?;
            }
            claim(claims, dial, name, scalar, drifts);
            rows.push(row);
        }
        say(aligned(rows.iter()));
        draw(&dials, &runs, name, folder)?;
    }
    Ok(())
}

/// Momenta go like random roundings, 2 ε √steps; constraints do not grow; energies are those of the scheme, or go as momenta do.
fn claim(claims: &mut Claims, dial: &LongRun, name: &str, scalar: usize, drifts: &[Drift]) {
    let Some(last) = drifts.last() else { return };
    let epsilon = [f64::EPSILON, f64::from(f32::EPSILON)][scalar];
    let of = format!("long runs, {name}, {}, {}", dial.scene, dial.name);
    let bound = 2.0 * epsilon * (last.steps as f64).sqrt();
    claims.at_most(&format!("{of}: momenta"), last.momentum, bound, "2 ε √steps");
    claims.at_most(&format!("{of}: constraint"), last.constraint, 16.0 * epsilon, "16 ε, after any number of steps");
    if last.steps >= LONG {
        let grows = growth(drifts, |drift| drift.energy);
        claims.at_most(&format!("{of}: exponent of the energy's error"), grows, 0.75, "√steps or less");
    }
}

/// Steps from which on exponents are those of growth, and not of where the runs began.
const LONG: u64 = 10_000_000;

fn draw(dials: &[LongRun], runs: &[Vec<Drift>], scalar: &str, folder: Option<&Path>) -> Result<(), Failure> {
    let name = format!("extremes_drift_{scalar}");
    let path = folder.map(|folder| folder.join(&name).with_extension("svg"));
    // as long as the margin is wide
    let word = |scene: &'static str| scene.split(' ').next_back().unwrap_or(scene);
    let labels: Vec<String> =
        dials.iter().map(|dial| format!("{}: {}", word(dial.scene), dial.name.replace(", order", ""))).collect();
    let curves: Vec<Curve<'_>> = labels
        .iter()
        .zip(runs)
        .zip(COLOURS.into_iter().cycle())
        .map(|((label, drifts), colour)| Curve {
            label,
            colour,
            width: 1.5,
            points: drifts.iter().map(|drift| (drift.steps as f64, drift.momentum)).collect(),
            ringed: Vec::new(),
        })
        .collect();
    let chart = Decades {
        title: &format!("Rounding of conserved momenta, {scalar}"),
        x_label: "steps",
        y_label: "root mean square over |π|",
        curves: &curves,
    };
    figure::draw_to(path.as_deref(), &name, (1000, 560), |area| chart.draw(area))
}
