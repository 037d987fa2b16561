//! Starts where something is degenerate: separatrices, equilibria, zero momentum, poles, configurations off their space.

use crate::declarations::{bodies, pendulums, tops};
use crate::map::{Map, SCALARS, outcome, size};
use crate::probe::{Cell, Dial, Setup};
use crate::step_sizes::heading;
use clebsch_examples::claims::Claims;
use clebsch_examples::scene::{Failure, say};
use clebsch_examples::table::aligned;
use nalgebra::{Matrix3, Vector3};

const SECTION: &str = "start";
const STEPS: u64 = 20_000;

fn turned(angle: f64) -> Matrix3<f64> {
    let (sine, cosine) = angle.sin_cos();
    Matrix3::new(1.0, 0.0, 0.0, 0.0, cosine, -sine, 0.0, sine, cosine)
}

/// What a place is called, and the setup there.
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
pub fn explore(map: &mut Map<'_>, claims: &mut Claims) -> Result<(), Failure> {
    let offsets = [1e-16, 1e-14, 1e-12, 1e-10, 1e-8, 1e-6, 1e-3].map(off);
    let starts =
        [of_bodies(), of_tops(), of_tops()].map(|starts| starts.into_iter().chain(offsets.clone()).collect::<Vec<_>>());
    for (dials, starts) in [bodies(), tops(), pendulums()].into_iter().zip(starts) {
        for scalar in 0..SCALARS.len() {
            table(map, claims, &dials, &starts, scalar)?;
        }
    }
    Ok(())
}

fn table(
    map: &mut Map<'_>,
    claims: &mut Claims,
    dials: &[Dial],
    starts: &[(String, Setup)],
    scalar: usize,
) -> Result<(), Failure> {
    let name = SCALARS[scalar];
    say(format_args!(
        "Starts: {}, {name}, {STEPS} steps. Most iterations, the change of conserved momenta over |π|, and the largest defect of the configuration\n",
        dials[0].scene
    ));
    let mut rows = vec![heading("start", dials)];
    let mut unfinished = Vec::new();
    for (start, setup) in starts {
        let mut row = vec![start.clone()];
        for dial in dials {
            let cell = dial.run[scalar](setup, STEPS, false);
            map.add(SECTION, dial, scalar, start, &cell)?;
            row.push(match cell.outcome {
                Ok(()) => format!("{} it, {}, {}", cell.iterations, size(cell.momentum), size(cell.constraint)),
                Err(_) => outcome(&cell),
            });
            if cell.outcome.is_err() && !is_off(start, &cell) {
                unfinished.push(format!("{start}, {}", dial.name));
            }
        }
        rows.push(row);
    }
    say(aligned(rows.iter()));
    let all = format!("starts, {}, {name}", dials[0].scene);
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

/// Whether the start was refused, as it is off its space.
fn is_off(start: &str, cell: &Cell) -> bool {
    start.starts_with("off the space") && matches!(cell.outcome, Err(clebsch::Error::OffOrbit { .. }))
}
