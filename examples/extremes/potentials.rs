//! Potentials that are singular, stiff, or move with the time.

use crate::map::{Map, refusal, size};
use crate::probe::Cell;
use clebsch::{Clebsch, Declared, Error, Method};
use clebsch_examples::claims::Claims;
use clebsch_examples::scene::{Failure, say};
use clebsch_examples::table::aligned;
use nalgebra::{Vector1, Vector3};
use std::f64::consts::{PI, TAU};

struct First;
struct Fourth;
struct Sixth;
struct Eighth;
struct Sixteenth;

/// A planet: unit mass, unit constant of gravitation.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |a: Translation<3>, x: Vector3| x + a,
    cost      = |h, a| a.norm_squared() / (2 * h),
    potential = |x| -self.attraction / x.norm(),
    method First     = (order = 1),
    method Fourth    = (order = 4),
    method Sixth     = (order = 6),
    method Eighth    = (order = 8),
    method Sixteenth = (order = 16),
)]
struct Planet {
    /// Constant of gravitation times both masses.
    pub attraction: f64,
}

/// A unit mass on a spring.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |a: Translation<1>, x: Vector1| x + a,
    cost      = |h, a| a.norm_squared() / (2 * h),
    potential = |x| self.stiffness * x.norm_squared() / 2,
    method First     = (order = 1),
    method Fourth    = (order = 4),
    method Sixth     = (order = 6),
    method Eighth    = (order = 8),
    method Sixteenth = (order = 16),
)]
struct Spring {
    /// The square of the angular frequency.
    pub stiffness: f64,
}

/// A unit mass on a spring that is driven.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |a: Translation<1>, x: Vector1| x + a,
    cost      = |h, a| a.norm_squared() / (2 * h),
    potential = |t, x| x.norm_squared() / 2 - x.x * (self.frequency * t).sin(),
)]
struct Driven {
    /// Angular frequency of the drive.
    pub frequency: f64,
}

/// A function of the method of each order, with its name.
macro_rules! each_order {
    ($function:ident) => {
        [
            ("order 1", $function::<First> as fn(_) -> _),
            ("order 2", $function::<Declared>),
            ("order 4", $function::<Fourth>),
            ("order 6", $function::<Sixth>),
            ("order 8", $function::<Eighth>),
            ("order 16", $function::<Sixteenth>),
        ]
    };
}

/// All three.
pub fn explore(map: &mut Map<'_>, claims: &mut Claims) -> Result<(), Failure> {
    near_collisions(map, claims)?;
    stiff(map, claims)?;
    driven(map, claims)
}

/// Two revolutions in 2000 steps on an ellipse that comes as near to the centre as `1 − e`. Returns the largest
/// relative errors of the energy and of the angular momentum.
fn revolve<M: Method<Planet>>(nearest: f64) -> Result<[f64; 2], Error> {
    let stepper = Planet { attraction: 1.0 }.into_stepper_by::<M>(TAU / 1000.0)?;
    let speed = (nearest / (2.0 - nearest)).sqrt();
    let mut state = stepper.state(Vector3::x() * (2.0 - nearest), Vector3::y() * speed)?;
    let spin = speed * (2.0 - nearest);
    let mut errors = [0.0_f64; 2];
    for _ in 0..2000 {
        state = stepper.step(&state)?;
        let now = state.configuration().cross(&state.momentum()).z;
        let found = [(2.0 * stepper.energy(&state) + 1.0).abs(), (now - spin).abs()];
        for (error, found) in errors.iter_mut().zip(found) {
            *error = if found <= *error { *error } else { found };
        }
    }
    Ok(errors)
}

fn near_collisions(map: &mut Map<'_>, claims: &mut Claims) -> Result<(), Failure> {
    say(
        "Potentials: 1/r. Ellipses of half axis 1 in a thousand steps a revolution, two of them: largest relative error of the energy by the nearest distance\n",
    );
    let orders = each_order!(revolve);
    let mut rows = vec![
        std::iter::once("nearest".to_owned())
            .chain(orders.iter().map(|(name, _)| (*name).to_owned()))
            .collect::<Vec<_>>(),
    ];
    let (mut spin, mut hidden) = (0.0_f64, 0);
    for nearest in [1.0, 0.3, 0.1, 0.03, 0.01, 1e-3, 1e-4, 1e-6, 1e-9, 1e-12, 0.0] {
        let mut row = vec![format!("{nearest:e}")];
        for (name, revolve) in orders {
            let found = revolve(nearest);
            let [energy, momentum] = found.unwrap_or([f64::NAN; 2]);
            let cell = Cell { energy, momentum, ..Cell::of(found.map(|_| ()), 2000) };
            map.add_run("potential 1/r", ("planet", name), "f64", &format!("{nearest:e}"), &cell)?;
            row.push(match found {
                Ok([energy, moved]) => {
                    hidden += u32::from(!(energy.is_finite() && moved.is_finite()));
                    spin = spin.max(if nearest >= 0.1 { moved } else { 0.0 });
                    size(energy)
                }
                Err(error) => refusal(error),
            });
        }
        rows.push(row);
    }
    say(aligned(rows.iter()));
    claims.at_most("potentials: numbers that are not finite", f64::from(hidden), 0.0, "each run ends or is refused");
    claims.at_most("potentials: angular momentum of ellipses", spin, 2000.0 * 16.0 * f64::EPSILON, "16 ε a step");
    Ok(())
}

/// Half of the trace of a step of the spring, whose eigenvalues are on the unit circle as long as it is at most one.
fn half_trace<M: Method<Spring>>(angle: f64) -> Result<f64, Error> {
    let stepper = Spring { stiffness: 1.0 }.into_stepper_by::<M>(angle)?;
    let image = |x: f64, p: f64| -> Result<[f64; 2], Error> {
        let next = stepper.step(&stepper.state(Vector1::new(x), Vector1::new(p))?)?;
        Ok([next.configuration().x, next.momentum().x])
    };
    Ok((image(1.0, 0.0)?[0] + image(0.0, 1.0)?[1]) / 2.0)
}

/// The intervals of h·ω up to 30 that are stable, and why the next is not.
fn stable(half_trace: fn(f64) -> Result<f64, Error>) -> (f64, String) {
    const PARTS: u32 = 30_000;
    for part in 1..=PARTS {
        let angle = f64::from(part) * 30.0 / f64::from(PARTS);
        match half_trace(angle) {
            Ok(half) if half.abs() <= 1.0 + 1e-9 => {}
            Ok(half) => {
                return (angle, format!("grows by {:.2} a step at first", half.abs() + (half * half - 1.0).sqrt()));
            }
            Err(error) => return (angle, refusal(error)),
        }
    }
    (30.0, "stable".to_owned())
}

fn stiff(map: &mut Map<'_>, claims: &mut Claims) -> Result<(), Failure> {
    say(
        "Potentials: stiff ones. A unit mass on a spring of the angular frequency ω: the least h·ω at which steps grow, on a grid of 0.001\n",
    );
    let mut rows = vec![["", "least hω", "there"].map(str::to_owned).to_vec()];
    for (name, half_trace) in each_order!(half_trace) {
        let (bound, why) = stable(half_trace);
        rows.push(vec![name.to_owned(), format!("{bound:.3}"), why]);
        map.add_run("stiff potential", ("spring", name), "f64", &format!("{bound:.3}"), &Cell::of(Ok(()), 1))?;
        // half the trace is cos hω but for the error of the step. It leaves [−1, 1] first near hω = π, unless the step
        // is as Gauss's, stable for every h
        let (expected, why) = match name {
            "order 1" | "order 2" => (2.0..=2.002, "the bound of Störmer and Verlet is 2"),
            "order 16" => (PI + 0.1..=f64::INFINITY, "collocation at Gauss's nodes is stable beyond π; its sweeps end"),
            _ => (PI - 0.06..=PI + 0.001, "where cos hω touches −1, at π, or a little before"),
        };
        claims.within(&format!("stiff potentials, {name}"), bound, expected, 3, why);
    }
    say(aligned(rows.iter()));
    Ok(())
}

/// The time goes on where a step is below its last place.
fn driven(map: &mut Map<'_>, claims: &mut Claims) -> Result<(), Failure> {
    say(
        "Potentials: in time. A driven spring started late, a million steps of 0.01: by how much the time is off, in units of its last place\n",
    );
    let mut rows = vec![["start / s", "off by"].map(str::to_owned).to_vec()];
    let stepper = Driven { frequency: 0.5 }.into_stepper(0.01)?;
    let mut worst = 0.0_f64;
    for start in [0.0, 1e6, 1e12, 1e15, 1e17, 1e100] {
        let state = stepper.state_at(start, Vector1::zeros(), Vector1::zeros())?;
        let late: f64 = stepper.advance(&state, 1_000_000)?.time();
        let expected = start + 1e4;
        let off = (late - expected).abs() / (f64::EPSILON * expected);
        worst = worst.max(off);
        let cell = Cell { precise: (late - expected).abs() / expected, ..Cell::of(Ok(()), 1_000_000) };
        map.add_run("time", ("driven spring", "order 2"), "f64", &format!("{start:e}"), &cell)?;
        rows.push(vec![format!("{start:e}"), format!("{off:.2}")]);
    }
    say(aligned(rows.iter()));
    claims.at_most("time of a late start", worst, 1.0, "units in the last place");
    Ok(())
}
