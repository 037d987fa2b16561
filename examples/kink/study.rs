//! Errors against the closed solutions, on three grids.

use crate::line::{Line, Mesh, Pendulums};
use crate::plain::{self, Form};
use crate::solitons::{Soliton, middle};
use clebsch_examples::claims::{Claims, largest};
use clebsch_examples::scene::Failure;

/// How far a measured order may be from 2: the next term of the series, and its share on the finest grid.
const SLOPE: f64 = 0.15;
/// Errors above this are not yet a power of the spacing.
const LARGEST: f64 = 0.15;
/// Time of the kink, s.
const TIME: f64 = 20.0;

/// A solution, from a time on.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// Its name in the table.
    pub name: &'static str,
    /// The solution.
    pub soliton: Soliton,
    /// When it starts.
    pub from: f64,
}

/// Errors of one declaration on grids with 2 dx, dx and dx/2.
#[derive(Clone, Debug)]
pub struct Errors {
    /// The declaration and the case.
    pub name: String,
    /// The coarsest grid first.
    pub values: [f64; 3],
}

impl Errors {
    fn of(name: String, error: impl Fn(f64) -> Result<f64, Failure>) -> Result<Self, Failure> {
        Ok(Self { name, values: [error(0.5)?, error(1.0)?, error(2.0)?] })
    }

    /// From the two finer grids.
    pub fn order(&self) -> f64 {
        (self.values[1] / self.values[2]).abs().log2()
    }

    /// Claims the order.
    pub fn claim(&self, claims: &mut Claims) {
        let name = format!("{}: order", self.name);
        if self.values[1].abs() > LARGEST {
            let reason = format!("the error {:.1e} with dx is not small: too coarse a grid", self.values[1]);
            return claims.skip(&name, &reason);
        }
        let reason = format!("slope from dx to dx/2; the error with dx is {:.1e}", self.values[1]);
        claims.within(&name, self.order(), 2.0 - SLOPE..=2.0 + SLOPE, 3, &reason);
    }
}

/// The speed of a kink less the exact one.
///
/// # Errors
/// Those of steps.
pub fn speeds<S: Pendulums>(system: &S, name: &str, mesh: &Mesh, v: f64) -> Result<Errors, Failure> {
    Errors::of(format!("{name}, speed of the kink"), |part| {
        let steps = (TIME / mesh.h).ceil() as u64;
        let mesh = Mesh { steps, ..*mesh }.refined(part);
        let mut line = Line::start(system, &mesh, &Soliton::Kink(v), -TIME / 2.0)?;
        let before = middle(&line.angles(), mesh.places());
        line.advance(mesh.steps)?;
        Ok((middle(&line.angles(), mesh.places()) - before) / mesh.time() - v)
    })
}

/// The largest error of u at the end.
///
/// # Errors
/// Those of steps.
pub fn ends<S: Pendulums>(system: &S, name: &str, mesh: &Mesh, case: &Case) -> Result<Errors, Failure> {
    Errors::of(format!("{name}, {}", case.name), |part| {
        let mesh = mesh.refined(part);
        let mut line = Line::start(system, &mesh, &case.soliton, case.from)?;
        line.advance(mesh.steps)?;
        let exact = mesh.places().map(|x| case.soliton.at(x, case.from + mesh.time())[0]);
        Ok(largest(line.angles().iter().zip(exact).map(|(u, exact)| (u - exact).abs())))
    })
}

/// The energy of a start less that of the solution, over it.
///
/// # Errors
/// Those of a start.
pub fn energies<S: Pendulums>(system: &S, name: &str, mesh: &Mesh, case: &Case) -> Result<Errors, Failure> {
    Errors::of(format!("{name}, energy"), |part| {
        let line = Line::start(system, &mesh.refined(part), &case.soliton, case.from)?;
        Ok(line.energy()? / case.soliton.energy() - 1.0)
    })
}

/// The largest difference to the same steps in plain angles.
///
/// # Errors
/// Those of steps.
pub fn to_plain<S: Pendulums>(system: &S, form: Form, mesh: &Mesh, case: &Case) -> Result<f64, Failure> {
    let mut line = Line::start(system, mesh, &case.soliton, case.from)?;
    line.advance(mesh.steps)?;
    let plain = plain::end(form, mesh, &case.soliton, case.from);
    Ok(largest(line.angles().iter().zip(plain).map(|(u, plain)| (u - plain).abs())))
}
