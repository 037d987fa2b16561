//! Step sizes, from such that hardly move anything to such that have no solution.

use crate::declarations::{bodies, pendulums, series, solves, tops};
use crate::map::{Map, SCALARS, outcome, size};
use crate::probe::{Cell, Dial};
use crate::random::Random;
use crate::setup::Setup;
use clebsch::Error;
use clebsch_examples::claims::Claims;
use clebsch_examples::figure::{self, BLUE, Curve, Decades, GREEN, INK, ORANGE, PURPLE, RED, RGBColor, TEAL};
use clebsch_examples::scene::{Failure, say};
use clebsch_examples::table::aligned;
use std::f64::consts::PI;
use std::path::Path;

const SECTION: &str = "step size";
/// h|ω|, through π and 2π.
const ANGLES: [f64; 24] = [
    1e-12,
    1e-9,
    1e-6,
    1e-4,
    1e-3,
    0.01,
    0.03,
    0.1,
    0.2,
    0.4,
    0.6,
    0.8,
    0.95,
    1.05,
    1.5,
    2.0,
    PI - 0.01,
    PI + 0.01,
    2.0 * PI - 0.01,
    2.0 * PI + 0.01,
    100.0,
    1e4,
    1e6,
    1e8,
];
const COLOURS: [RGBColor; 7] = [BLUE, GREEN, ORANGE, RED, PURPLE, TEAL, INK];

/// Tables of all scenes, bounds of the free body, and the figure.
pub fn explore(
    map: &mut Map<'_>,
    claims: &mut Claims,
    folder: Option<&Path>,
    (steps, bodies_count): (u64, u32),
) -> Result<(), Failure> {
    for (dials, is_drawn, couples) in [
        (bodies(), true, false),
        (solves(), false, false),
        (tops(), true, false),
        (pendulums(), true, false),
        (series(), false, true),
    ] {
        for scalar in 0..SCALARS.len() {
            let curves = table(map, claims, (&dials, scalar, couples), steps)?;
            if is_drawn && scalar == 0 {
                draw(&dials, curves, folder)?;
            }
        }
    }
    bounds(claims, bodies_count);
    branches(claims, bodies_count);
    Ok(())
}

/// The ordinary body of a scene, whose first step turns by `angle`.
fn at(angle: f64) -> Setup {
    let setup = Setup::ordinary();
    let h = angle / setup.velocity().norm();
    Setup { h, ..setup }
}

/// Prints the table of one scene, and gives the energy errors of each dial by h|ω|.
fn table(
    map: &mut Map<'_>,
    claims: &mut Claims,
    (dials, scalar, couples): (&[Dial], usize, bool),
    steps: u64,
) -> Result<Vec<Vec<(f64, f64)>>, Failure> {
    let scene = dials[0].scene;
    say(format_args!(
        "Step size: {scene}, {}, {steps} steps. Most iterations of a step, largest relative error of the energy; or why a step was refused. Below, the largest of all runs up to h|ω| = π that came to their end.\n",
        SCALARS[scalar]
    ));
    let mut rows = vec![heading("h|ω|", dials)];
    let mut curves: Vec<Vec<(f64, f64)>> = vec![Vec::new(); dials.len()];
    let mut worst = vec![Worst([f64::NAN; 4]); dials.len()];
    for angle in ANGLES {
        let mut row = vec![format!("{angle:.3e}")];
        for ((dial, curve), worst) in dials.iter().zip(&mut curves).zip(&mut worst) {
            let cell = dial.run(scalar, &at(angle), steps, angle > 1e-7);
            map.add(SECTION, dial, scalar, &format!("{angle:e}"), &cell)?;
            if cell.outcome.is_ok() {
                curve.push((angle, cell.energy.max(1e-17)));
            }
            if cell.outcome.is_ok() && angle < PI {
                // the Legendre transform of a cost that couples takes F − I, and F is a matrix that is rounded
                let seen = if couples { angle.min(1.0) } else { 1.0 };
                worst.add(&Cell { residual: seen * cell.residual, ..cell.clone() });
            }
            row.push(text(&cell));
        }
        rows.push(row);
    }
    for (quantity, name) in ["residual", "momenta", "constraint", "off 31 digits"].into_iter().enumerate() {
        rows.push(
            std::iter::once(format!("most: {name}")).chain(worst.iter().map(|worst| worst.text(quantity))).collect(),
        );
    }
    say(aligned(rows.iter()));
    let of = format!("step sizes, {scene}, {}", SCALARS[scalar]);
    let epsilon = [f64::EPSILON, f64::from(f32::EPSILON)][scalar];
    let exact = dials.iter().zip(&worst).filter(|(dial, _)| !dial.name.starts_with("tolerance"));
    // not measured is NaN, and does not count
    let most = |quantity: usize| exact.clone().map(|(_, worst)| worst.0[quantity]).fold(0.0, f64::max);
    let unit =
        if couples { "64 ε of the momenta over h|ω|, up to π" } else { "64 ε of the momenta, up to h|ω| = π" };
    claims.at_most(&format!("{of}: residual"), most(0), 64.0 * epsilon, unit);
    claims.at_most(&format!("{of}: momenta"), most(1), 4.0 * steps as f64 * epsilon, "4 ε a step");
    claims.at_most(&format!("{of}: constraint"), most(2), 64.0 * epsilon, "64 ε");
    Ok(curves)
}

/// The largest residual, change of momenta, constraint and difference from 31 digits of runs that came to their end; NaN where none is measured.
#[derive(Clone, Copy)]
struct Worst([f64; 4]);

impl Worst {
    fn text(&self, quantity: usize) -> String {
        let most = self.0[quantity];
        if most.is_nan() { "-".to_owned() } else { size(most) }
    }

    fn add(&mut self, cell: &Cell) {
        for (most, x) in self.0.iter_mut().zip([cell.residual, cell.momentum, cell.constraint, cell.precise]) {
            *most = most.max(x);
        }
    }
}

/// The names of dials under a first word.
pub fn heading(first: &str, dials: &[Dial]) -> Vec<String> {
    std::iter::once(first.to_owned()).chain(dials.iter().map(|dial| dial.name.to_owned())).collect()
}

fn text(cell: &Cell) -> String {
    match cell.outcome {
        Ok(()) => format!("{} it, {}", cell.iterations, size(cell.energy)),
        Err(_) => outcome(cell),
    }
}

fn draw(dials: &[Dial], points: Vec<Vec<(f64, f64)>>, folder: Option<&Path>) -> Result<(), Failure> {
    let name = format!("extremes_steps_{}", dials[0].scene.replace(' ', "_"));
    let path = folder.map(|folder| folder.join(&name).with_extension("svg"));
    let curves: Vec<Curve<'_>> = dials
        .iter()
        .zip(points)
        .zip(COLOURS)
        .map(|((dial, points), colour)| Curve {
            label: dial.name,
            colour,
            width: 1.5,
            ringed: last_ringed(&points),
            points,
        })
        .collect();
    let chart = Decades {
        title: &format!("{}: curves end, ringed, where steps are refused", dials[0].scene),
        x_label: "h|ω| / rad",
        y_label: "largest relative error of the energy",
        curves: &curves,
    };
    figure::draw_to(path.as_deref(), &name, (1000, 560), |area| chart.draw(area))
}

/// A ring about the last point, unless the curve goes to the end of the axis.
fn last_ringed(points: &[(f64, f64)]) -> Vec<bool> {
    let ends = points.last().is_some_and(|last| last.0 < ANGLES[ANGLES.len() - 1]);
    (1..=points.len()).map(|i| ends && i == points.len()).collect()
}

/// The h|ω| from which on a body's step in a direction is refused; `None` where none is up to a thousand.
fn bound(dial: &Dial, setup: &Setup) -> Option<f64> {
    let refused = |angle: f64| {
        let h = angle / setup.velocity().norm();
        let step = dial.step(&Setup { h, ..setup.clone() });
        matches!(step, Err(Error::Unsolvable { .. } | Error::NotConverged { .. }))
    };
    let (mut low, mut high) = (1e-3, 1e3);
    if !refused(high) {
        return None;
    }
    for _ in 0..40 {
        let middle = f64::sqrt(low * high);
        if refused(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    Some(low)
}

/// A body that can exist, with moments of a ratio up to a hundred, and a direction of its velocity.
fn random_body(random: &mut Random) -> Setup {
    let masses = [0; 3].map(|_| 10.0_f64.powf(random.between(-2.0, 0.0)));
    let moments = [masses[1] + masses[2], masses[2] + masses[0], masses[0] + masses[1]];
    Setup { moments, attitude: random.attitude(), ..Setup::ordinary() }.with_velocity(random.direction())
}

fn bounds(claims: &mut Claims, count: u32) {
    say(format_args!(
        "Bounds of h|ω| on the free body: {count} random bodies (moments of a ratio up to 100, the triangle inequality holds) and directions, by bisection up to 1000\n"
    ));
    let mut rows = vec![["", "refused somewhere", "least", "median", "greatest"].map(str::to_owned).to_vec()];
    for dial in bodies() {
        let mut random = Random::new(61);
        let found: Vec<Option<f64>> = (0..count).map(|_| bound(&dial, &random_body(&mut random))).collect();
        let mut limits: Vec<f64> = found.into_iter().flatten().collect();
        limits.sort_by(f64::total_cmp);
        let share = format!("{:.0} %", 100.0 * limits.len() as f64 / f64::from(count));
        let at = |place: usize| limits.get(place).map_or("none".to_owned(), |limit| format!("{limit:.3}"));
        rows.push(vec![dial.name.to_owned(), share, at(0), at(limits.len() / 2), at(limits.len().saturating_sub(1))]);
        match dial.name {
            "cayley" => claims.at_most("bound of h|ω|: cayley", limits.len() as f64, 0.0, "steps refused; it has none"),
            "moser_veselov" if count < 300 => claims.holds(
                "bound of h|ω|: moser_veselov",
                limits[0] > 0.999,
                "1 about principal axes, more about others",
            ),
            "moser_veselov" => claims.within(
                "bound of h|ω|: moser_veselov",
                limits[0],
                0.999..=1.001,
                4,
                "1 about principal axes, more about others",
            ),
            "projection" => claims.holds(
                "bound of h|ω|: projection",
                limits.first().is_none_or(|least| *least > 0.2) && limits.last().is_some_and(|most| *most < 0.52),
                "½ about principal axes, 0.2 at least about others",
            ),
            "order = 16" => claims.holds(
                "bound of h|ω|: order = 16",
                limits.first().is_none_or(|least| *least > 0.8),
                "sweeps contract up to 0.8 at least",
            ),
            "exponential" | "exact" => claims.holds(
                &format!("bound of h|ω|: {}", dial.name),
                limits.first().is_none_or(|least| *least > std::f64::consts::PI),
                "no step that turns by less than half a turn is refused",
            ),
            _ => {}
        }
    }
    say(aligned(rows.iter()));
}

/// The solution for s times the momentum, s from 0 to 1, is one curve: no step changes its branch.
fn branches(claims: &mut Claims, count: u32) {
    for dial in
        bodies().iter().filter(|dial| matches!(dial.name, "moser_veselov" | "cayley" | "exponential" | "projection"))
    {
        let mut random = Random::new(62);
        let mut jumps = 0;
        for _ in 0..count {
            let setup = random_body(&mut random);
            let longest = bound(dial, &setup).map_or(LONGEST, |bound| (0.97 * bound).min(LONGEST));
            let h = longest / setup.velocity().norm();
            let place = |s: f64| dial.place(&Setup { h, momentum: setup.momentum * s, ..setup.clone() });
            const PARTS: u32 = 64;
            let ends = |part: u32| [part - 1, part].map(|part| f64::from(part) / f64::from(PARTS));
            jumps += (1..=PARTS).filter(|part| has_jump(&place, ends(*part), 20)).count();
        }
        claims.at_most(
            &format!("branch of the identity: {}", dial.name),
            jumps as f64,
            0.0,
            "jumps of the solution on the way from s = 0 to s = 1",
        );
    }
}

/// h|ω| up to which branches are followed.
const LONGEST: f64 = 5.0;

/// Whether the attitude after the step still jumps between two momenta when the interval is halved so often.
fn has_jump(place: &impl Fn(f64) -> Vec<f64>, [from, to]: [f64; 2], halvings: u32) -> bool {
    let (before, after) = (place(from), place(to));
    let moved = before.iter().zip(&after).take(9).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
    if before.len() == after.len() && moved <= 0.4 {
        return false;
    }
    let middle = (from + to) / 2.0;
    halvings == 0 || has_jump(place, [from, middle], halvings - 1) || has_jump(place, [middle, to], halvings - 1)
}
