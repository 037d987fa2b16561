//! Motion across a magnetic field: the angle between spin and momentum, and its measured value.

use crate::closed_form::ClosedForm;
use crate::field::{at_rest, momentum};
use crate::{Flags, SpinFrame, start};
use clebsch::Clebsch;
use clebsch_examples::claims::Claims;
use clebsch_examples::scene::{Failure, say};
use nalgebra::{Matrix4, Vector3};
use std::f64::consts::TAU;

/// ω_a/2π of the negative muon in 2001, Hz, and its standard error of 0.7 parts per million.
///
/// Over 61 791 400 Hz, the precession of protons in the same field, it is R = 0.003 707 208 3. The ratio of the
/// magnetic moments of muon and proton is λ = 3.183 345 4. The published value is then a = R/(λ − R) = 0.001 165 921 4.
const MEASURED: (f64, f64) = (229_073.59, 0.16);

/// An angle that does not jump.
#[derive(Clone, Copy, Debug, Default)]
struct Phase {
    last: f64,
    total: f64,
}

impl Phase {
    fn observe(&mut self, angle: f64) {
        let change = angle - self.last;
        self.total += change - TAU * (change / TAU).round();
        self.last = angle;
    }
}

/// Claims the rate a e B/m at which the spin turns against the momentum, where the momentum is perpendicular to a magnetic field.
pub fn claim(flags: &Flags, exact: &ClosedForm, spin: &Vector3<f64>, claims: &mut Claims) -> Result<(), Failure> {
    let names =
        ["the spin turns against the momentum by a e B/m", "and as measured in the muon ring of Brookhaven, Hz"];
    if let Some(reason) = elsewhere(exact, spin) {
        names.into_iter().for_each(|name| claims.skip(name, reason));
        return Ok(());
    }
    let h = flags.run.step_size;
    let (coarse, fine) = (frequency(flags, exact, spin, 1)?, frequency(flags, exact, spin, 2)?);
    // of second order, so that the next term is of the fourth
    let limit = fine + (fine - coarse) / 3.0;
    let expected = exact.anomaly * exact.charge_to_mass * exact.field.magnetic.norm() / TAU * 1e9;
    let angle = h * exact.rate();
    say(format_args!(
        "ω_a/2π: {coarse:.3} Hz with h, {fine:.3} Hz with h/2, so {limit:.3} Hz in the limit; a e B/2πm = {expected:.3} Hz\n"
    ));
    let gamma = exact.start[(0, 0)];
    let rounding =
        f64::EPSILON * (4.0 * flags.run.steps as f64).sqrt() * gamma * gamma / flags.run.duration() / gamma * 1e9;
    let accuracy = 4.0 * angle * angle * (fine - coarse).abs() + rounding;
    claims.at_most(names[0], (limit - expected).abs(), accuracy, "Hz; what extrapolation from h and h/2 leaves out");
    let (value, error) = MEASURED;
    if !flags.is_the_ring() {
        claims.skip(names[1], "other flags than the ring's");
    } else if accuracy > error {
        claims.skip(names[1], &format!("known to {accuracy:.1e} Hz with steps of {h} ns"));
    } else {
        let interval = value - 2.0 * error..=value + 2.0 * error;
        claims.within(names[1], limit, interval, 2, "two standard errors; a from Fermilab, B from protons");
    }
    Ok(())
}

/// Why the rate is not a e B/m.
fn elsewhere(exact: &ClosedForm, spin: &Vector3<f64>) -> Option<&'static str> {
    let (u, b) = (momentum(&exact.start), exact.field.magnetic);
    if exact.field.electric.norm() > 0.0 {
        return Some("there is an electric field");
    }
    if u.dot(&b).abs() > 1e-12 * u.norm() * b.norm() || u.norm() == 0.0 || b.norm() == 0.0 {
        return Some("the momentum is not perpendicular to a magnetic field");
    }
    (spin.cross(&b).norm() < 1e-6 * b.norm()).then_some("the spin is along the field")
}

/// The rate of the angle from momentum to spin about −B, in which positive charges circle: Hz of the laboratory, with steps of h/`part`.
fn frequency(flags: &Flags, exact: &ClosedForm, spin: &Vector3<f64>, part: u64) -> Result<f64, Failure> {
    let frame = SpinFrame::of(exact.charge_to_mass, exact.anomaly);
    let stepper = frame.into_stepper(flags.run.step_size / part as f64)?;
    let mut phase = Phase::default();
    let mut first = None;
    for (step, state) in (0..=flags.run.steps * part).zip(stepper.trajectory(start(&stepper, exact)?)) {
        let state = state.map_err(|error| Failure::Step { step, error })?;
        phase.observe(angle(state.configuration(), spin, &exact.field.magnetic));
        first.get_or_insert(phase.total);
    }
    // the laboratory's time goes faster by the constant factor γ
    let time = flags.run.duration() * exact.start[(0, 0)];
    Ok((phase.total - first.unwrap_or(0.0)) / (TAU * time) * 1e9)
}

/// The angle from the momentum to the spin at rest, about −B.
fn angle(q: &Matrix4<f64>, spin: &Vector3<f64>, b: &Vector3<f64>) -> f64 {
    let (p, s) = (momentum(q), at_rest(q, spin));
    let across = p.cross(b) / b.norm();
    s.dot(&across).atan2(s.dot(&p))
}

impl Flags {
    /// Whether the measurement is of this motion.
    fn is_the_ring(&self) -> bool {
        let particle = (self.anomaly, self.mass) == (0.00116592055, 105.6583755);
        particle && self.magnetic == [0.0, 0.0, 1.4512696]
    }
}
