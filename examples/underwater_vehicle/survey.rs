//! Steady motions on both sides of the published thresholds, each tilted a little and followed.

use crate::UnderwaterVehicle;
use crate::kirchhoff::Kirchhoff;
use crate::steady::{Course, Oscillation, Steady};
use crate::vehicle::halves;
use clebsch::{Clebsch, Method, Stepper};
use clebsch_examples::claims::Claims;
use clebsch_examples::flags::{Order, Run};
use clebsch_examples::scene::Failure;
use clebsch_examples::table::Table;
use nalgebra::{Complex, ComplexField, Matrix4, Vector3, Vector6};
use std::f64::consts::TAU;

/// Offsets, or spins, over their threshold.
const RATIOS: [f64; 4] = [0.0, 0.9, 1.1, LARGEST_RATIO];
/// The last of them.
pub const LARGEST_RATIO: f64 = 2.0;
/// The tilt at the start, radians.
const TILT: f64 = 1e-8;
/// An unstable motion is followed until its tilt has grown by this factor.
const GROWTH: f64 = 1e4;
/// A stable one over this many beats of its oscillation.
const BEATS: f64 = 20.0;
/// A case takes at most this many steps.
const LONGEST: f64 = 1e5;
/// Steps are shortened until h times the fastest rate is no more than this.
const LARGEST_ANGLE: f64 = 0.05;

/// One family of steady motions that crosses its threshold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Family {
    /// Leonard: ballast holds a level course along the middle axis.
    CruiseWithBallast,
    /// Leonard and Marsden: ballast holds a rise along the long axis.
    RiseWithBallast,
    /// Leonard and Marsden: spin holds a rise without ballast.
    RiseWithSpin,
}

impl Family {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::CruiseWithBallast, Self::RiseWithBallast, Self::RiseWithSpin];

    /// The steady motion and its stabilisation.
    pub fn name(self) -> &'static str {
        match self {
            Self::CruiseWithBallast => "cruise, ballast",
            Self::RiseWithBallast => "rise, ballast",
            Self::RiseWithSpin => "rise, spin",
        }
    }

    /// The member with `ratio` times the ballast, or the spin, of the threshold; `base` gives vehicle and speed.
    pub fn member(self, base: &Steady, ratio: f64) -> Steady {
        let bare = Steady { vehicle: base.vehicle.with_offset(0.0), spin: 0.0, ..*base };
        match self {
            Self::RiseWithSpin => Steady { spin: ratio * bare.critical_spin(), ..bare },
            _ => Steady { vehicle: bare.vehicle.with_offset(ratio * bare.critical_offset()), ..bare },
        }
    }
}

/// One steady motion and the outcome of a tilt.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// Its family.
    pub family: Family,
    /// Over the threshold.
    pub ratio: f64,
    /// Of the linear theory.
    pub oscillation: Oscillation,
    /// How fast the growing part grew, 1/s; zero where the theory has none.
    pub growth: f64,
    /// The largest tilt over the first.
    pub largest: f64,
    /// h times the fastest rate.
    angle: f64,
    order: Order,
}

/// Follows all ratios of a family.
pub fn follow<M: Method<UnderwaterVehicle>>(family: Family, base: &Steady, run: &Run) -> Result<Vec<Case>, Failure> {
    let follow = |ratio: &f64| {
        let steady = family.member(base, *ratio);
        let kirchhoff = Kirchhoff::new(&steady.vehicle).ok_or_else(|| too_low(steady.vehicle.offset))?;
        let oscillation = steady.oscillation();
        let fastest = oscillation.size().max(steady.spin.abs());
        let stepper = UnderwaterVehicle::from(&steady.vehicle)
            .into_stepper_by::<M>(run.step_size.min(LARGEST_ANGLE / fastest))?;
        let [growth, largest] = tilts(&steady, &kirchhoff, &stepper)?;
        let angle = fastest * stepper.step_size();
        Ok(Case { family, ratio: *ratio, oscillation, growth, largest, angle, order: run.order })
    };
    RATIOS.iter().map(follow).collect()
}

/// The kinetic energy of such a vehicle is not positive.
pub fn too_low(offset: f64) -> Failure {
    Failure::Flags(format!(
        "a centre of mass {offset} m below the centre of buoyancy: no such body, its inertia is not positive"
    ))
}

/// How fast the growing part of a tilt grew, 1/s, and the largest tilt over the first.
fn tilts<M: Method<UnderwaterVehicle>>(
    steady: &Steady,
    kirchhoff: &Kirchhoff,
    stepper: &Stepper<UnderwaterVehicle, M>,
) -> Result<[f64; 2], Failure> {
    let oscillation = steady.oscillation();
    let [first, second] = oscillation.roots();
    let duration = if first.re > 0.0 { GROWTH.ln() / first.re } else { BEATS * TAU / (first - second).modulus() };
    let steps = (duration / stepper.step_size()).ceil().clamp(1.0, LONGEST) as u64;

    let (pose, momentum) = steady.tilted(TILT);
    let mut state = stepper.state(pose, momentum)?;
    let (tilt, rate) = tilt(kirchhoff, state.configuration(), &state.momentum());
    let (start, mut largest) = (tilt.modulus(), tilt.modulus());
    let growing = oscillation.growing_part(tilt, rate);
    let mut grown = growing;
    for step in 1..=steps {
        state = stepper.step(&state).map_err(|error| Failure::Step { step, error })?;
        let (tilt, rate) = self::tilt(kirchhoff, state.configuration(), &state.momentum());
        largest = largest.max(tilt.modulus());
        grown = oscillation.growing_part(tilt, rate);
    }
    let time = steps as f64 * stepper.step_size();
    let growth = if first.re > 0.0 { (grown / growing).ln() / time } else { 0.0 };
    Ok([growth, largest / start])
}

/// γ = Γ₁ + iΓ₂ and Dγ = −ω₂ + iω₁.
fn tilt(kirchhoff: &Kirchhoff, pose: &Matrix4<f64>, momentum: &Vector6<f64>) -> (Complex<f64>, Complex<f64>) {
    let omega: Vector3<f64> = halves(&kirchhoff.velocity(momentum)).0;
    (Complex::new(pose[(2, 0)], pose[(2, 1)]), Complex::new(-omega.y, omega.x))
}

/// The cases as a table.
pub fn table(cases: &[Case]) -> Table<5> {
    let mut table = Table::new([
        "steady motion",
        "over threshold",
        "growth, theory / (1/s)",
        "growth, steps / (1/s)",
        "largest tilt / first",
    ]);
    for case in cases {
        table.row([
            case.family.name().to_owned(),
            format!("{:.1}", case.ratio),
            format!("{:.6}", case.oscillation.growth()),
            format!("{:.6}", case.growth),
            format!("{:.4}", case.largest),
        ]);
    }
    table
}

impl Case {
    /// Below the threshold the tilt grows at the rate of the linear theory, above it stays as small as there.
    ///
    /// Steps of order 1 are those of order 2 seen from other momenta, by half a kick. Both grow alike, and the growing
    /// part is measured wrongly by hΩ at start and end.
    pub fn claim(&self, claims: &mut Claims) {
        let name = format!("{} at {} of its threshold", self.family.name(), self.ratio);
        let (size, condition) = (self.oscillation.size(), self.oscillation.condition());
        let shift = self.angle * self.angle / 2.0 * size * condition;
        let half_kick = if self.order == Order::First { self.angle * condition } else { 0.0 };
        // At the end a tilt is TILT · GROWTH times a small number: the nonlinear part is less than this factor of
        // itself.
        let nonlinear = TILT * GROWTH;
        if self.ratio < 1.0 {
            let growth = self.oscillation.growth();
            let bound = shift / growth + 2.0 * half_kick / GROWTH.ln() + nonlinear;
            let error = (self.growth / growth - 1.0).abs();
            claims.at_most(
                &format!("{name} is unstable"),
                error,
                bound,
                "growth rate, relative error; (hΩ)² and condition",
            );
        } else {
            let splitting = 2.0 * size / condition;
            let bound = self.oscillation.largest() * (1.0 + 2.0 * shift / splitting + half_kick + nonlinear);
            let reason = "largest tilt over the first; linear theory and (hΩ)²";
            claims.at_most(&format!("{name} is stable"), self.largest, bound, reason);
        }
    }
}

/// The text for a vehicle without a threshold.
pub fn skip(family: Family, base: &Steady, claims: &mut Claims) {
    let reason = match base.course {
        Course::Cruise => {
            "a level course has a threshold where the first axis is shorter than the second, longer than the third, at a speed that ballast can hold"
        }
        Course::Rise => {
            "a rise has one where the third axis is the longest, and the others are equal, at a speed that ballast can hold"
        }
    };
    claims.skip(&format!("{} on both sides of its threshold", family.name()), reason);
}
