//! Starts where something is degenerate: separatrices, equilibria, zero momentum, poles, configurations off their space.

use crate::declarations::{bodies, pendulums, tops};
use crate::map::{Map, SCALARS, outcome, size};
use crate::probe::{Cell, Dial};
use crate::setup::Setup;
use crate::step_sizes::heading;
use clebsch_examples::claims::Claims;
use clebsch_examples::scene::{Failure, say};
use clebsch_examples::table::aligned;
use nalgebra::{Matrix3, Vector3};

const SECTION: &str = "start";

fn turned(angle: f64) -> Matrix3<f64> {
    let (sine, cosine) = angle.sin_cos();
    Matrix3::new(1.0, 0.0, 0.0, 0.0, cosine, -sine, 0.0, sine, cosine)
}

/// The name of a place, and the setup there.
fn of_bodies() -> Vec<(String, Setup)> {
    let about = |axis: Vector3<f64>| Setup { attitude: Matrix3::identity(), ..Setup::ordinary() }.with_velocity(axis);
    let mut starts = vec![
        ("at rest".to_owned(), about(Vector3::zeros())),
        ("about the least axis".to_owned(), about(Vector3::x())),
        ("about the greatest axis".to_owned(), about(Vector3::z())),
        ("about the middle axis".to_owned(), about(Vector3::y())),
    ];
    for offset in [1e-300, 1e-16, 1e-12, 1e-8, 1e-4] {
        starts.push((format!("middle axis, off by {offset:e}"), about(Vector3::new(offset, 1.0, 0.0))));
    }
    // |π|² = 2 J₂ T: J₁(J₂ − J₁) ω₁² = J₃(J₃ − J₂) ω₃²
    starts.push(("on the separatrix".to_owned(), about(Vector3::new(2.0_f64.sqrt(), 1.0, 1.0))));
    starts
}

fn of_tops() -> Vec<(String, Setup)> {
    let at = |angle: f64, spin: f64| Setup {
        attitude: turned(angle),
        arm: Vector3::z() * 0.75,
        momentum: Vector3::z() * spin,
        ..Setup::ordinary()
    };
    let pi = std::f64::consts::PI;
    vec![
        ("at rest, hanging".to_owned(), at(pi, 0.0)),
        ("at rest, upright".to_owned(), at(0.0, 0.0)),
        ("at rest, 1e-12 off upright".to_owned(), at(1e-12, 0.0)),
        ("at rest, level".to_owned(), at(pi / 2.0, 0.0)),
        ("upright, slow spin".to_owned(), at(0.0, 1.0)),
        ("upright, fast spin".to_owned(), at(0.0, 8.0)),
        ("1e-8 off upright, slow spin".to_owned(), at(1e-8, 1.0)),
        ("nearly hanging, fast spin".to_owned(), at(pi - 1e-8, 8.0)),
    ]
}

/// How far off its space the attitude is, in one entry.
fn off(by: f64) -> (String, Setup) {
    let mut setup = Setup::ordinary();
    setup.attitude[(0, 2)] *= 1.0 + by;
    (format!("off the space by {by:e}"), setup)
}

/// Tables of the three scenes.
pub fn explore(map: &mut Map<'_>, claims: &mut Claims, steps: u64) -> Result<(), Failure> {
    let offsets = [1e-16, 1e-14, 1e-12, 1e-10, 1e-8, 1e-6, 1e-3].map(off);
    let starts =
        [of_bodies(), of_tops(), of_tops()].map(|starts| starts.into_iter().chain(offsets.clone()).collect::<Vec<_>>());
    for (dials, starts) in [bodies(), tops(), pendulums()].into_iter().zip(starts) {
        for scalar in 0..SCALARS.len() {
            table(map, claims, (&dials, &starts), scalar, steps)?;
        }
    }
    Ok(())
}

fn table(
    map: &mut Map<'_>,
    claims: &mut Claims,
    (dials, starts): (&[Dial], &[(String, Setup)]),
    scalar: usize,
    steps: u64,
) -> Result<(), Failure> {
    let name = SCALARS[scalar];
    say(format_args!(
        "Starts: {}, {name}, {steps} steps. Most iterations, the change of conserved momenta over |π|, and the largest defect of the configuration\n",
        dials[0].scene
    ));
    let mut rows = vec![heading("start", dials)];
    let (mut unfinished, mut moved) = (Vec::new(), 0.0_f64);
    for (start, setup) in starts {
        let mut row = vec![start.clone()];
        for dial in dials {
            let cell = dial.run(scalar, setup, steps, false);
            map.add(SECTION, dial, scalar, start, &cell)?;
            row.push(match cell.outcome {
                Ok(()) => format!("{} it, {}, {}", cell.iterations, size(cell.momentum), size(cell.constraint)),
                Err(_) => outcome(&cell),
            });
            if is_equilibrium(start) {
                moved = moved.max(momentum_moved(setup, &cell));
            }
            if cell.outcome.is_err() && !is_off(start, &cell) {
                unfinished.push(format!("{start}, {}", dial.name));
            }
        }
        rows.push(row);
    }
    say(aligned(rows.iter()));
    let all = format!("starts, {}, {name}", dials[0].scene);
    let epsilon = [f64::EPSILON, f64::from(f32::EPSILON)][scalar];
    claims.at_most(
        &format!("{all}: equilibria"),
        moved,
        epsilon,
        "change of the momentum; hanging is π but for its last place",
    );
    claims.holds(
        &all,
        unfinished.is_empty(),
        &if unfinished.is_empty() {
            "all runs come to their end, or start off their space".to_owned()
        } else {
            unfinished.join("; ")
        },
    );
    Ok(())
}

/// Whether the momentum in the body frame stays: at rest where nothing pulls, and about principal axes.
fn is_equilibrium(start: &str) -> bool {
    matches!(start, "at rest" | "at rest, hanging" | "at rest, upright") || start.starts_with("about the")
}

/// By how much the momentum has changed in the end.
fn momentum_moved(setup: &Setup, cell: &Cell) -> f64 {
    let end = cell.last.len().saturating_sub(3);
    let changes = cell.last[end..].iter().zip(&setup.momentum).map(|(x, y)| (x - y).abs());
    changes.fold(0.0, f64::max)
}

/// Whether the start was refused, as it is off its space.
fn is_off(start: &str, cell: &Cell) -> bool {
    start.starts_with("off the space") && matches!(cell.outcome, Err(clebsch::Error::OffOrbit { .. }))
}
