//! Units of mass, length and time from one end of the range of numbers to the other.
//!
//! Units of powers of two change no digit. As long as nothing overflows or leaves the normal numbers, rotations have
//! the same bits and momenta the same digits.

use crate::declarations::{bodies, pendulums, tops};
use crate::map::{Map, SCALARS, refusal};
use crate::probe::{Cell, Dial};
use crate::setup::Setup;
use clebsch_examples::claims::{Claims, largest};
use clebsch_examples::scene::{Failure, say};
use clebsch_examples::table::aligned;
use std::f64::consts::LOG10_2;

const SECTION: &str = "magnitude";

/// The unit that changes.
#[derive(Clone, Copy, PartialEq)]
enum Unit {
    Mass,
    Length,
    Time,
}

impl Unit {
    const ALL: [Self; 3] = [Self::Mass, Self::Length, Self::Time];

    /// The setup in a unit that is 2⁻ᵏ of the old one.
    fn scaled(self, k: i32) -> Setup {
        let by = |power: i32| 2.0_f64.powi(power * k);
        let Setup { moments, weight, arm, h, attitude, momentum } = Setup::ordinary();
        match self {
            Self::Mass => Setup {
                moments: moments.map(|j| j * by(1)),
                weight: weight * by(1),
                arm,
                h,
                attitude,
                momentum: momentum * by(1),
            },
            Self::Length => Setup {
                moments: moments.map(|j| j * by(2)),
                weight: weight * by(1),
                arm: arm * by(1),
                h,
                attitude,
                momentum: momentum * by(2),
            },
            Self::Time => {
                Setup { moments, weight: weight * by(-2), arm, h: h * by(1), attitude, momentum: momentum * by(-1) }
            }
        }
    }

    /// The factor by which the momentum grows.
    fn of_momentum(self, k: i32) -> f64 {
        2.0_f64.powi(
            k * match self {
                Self::Mass => 1,
                Self::Length => 2,
                Self::Time => -1,
            },
        )
    }
}

/// By how much a run differs from that in ordinary units, relative to attitude and momentum: 0 where all digits are the same.
fn difference(cell: &Cell, ordinary: &Cell, factor: f64) -> f64 {
    let place = ordinary.last.len().saturating_sub(3);
    let size = ordinary.last[place..].iter().fold(0.0_f64, |max, x| max.max(x.abs()));
    let entries = ordinary.last.iter().zip(&cell.last).enumerate();
    let differences = entries.map(|(i, (x, y))| if i < place { (x - y).abs() } else { (x - y / factor).abs() / size });
    largest(differences)
}

/// How far one unit goes in one direction.
struct Reach {
    /// The largest exponent of two up to which all digits are the same.
    same: i32,
    /// That up to which they are the same but for rounding.
    near: i32,
    /// The outcome at the next one.
    beyond: String,
}

impl Reach {
    /// In powers of ten; how far digits are the same in brackets, where that is less.
    fn text(&self, sign: &str) -> String {
        let power = |k: i32| format!("{sign}{:.0}", f64::from(k) * LOG10_2);
        let same = if self.same == self.near { String::new() } else { format!(" (bits: {})", power(self.same)) };
        format!("{}{same}{}{}", power(self.near), if self.beyond.is_empty() { "" } else { ", " }, self.beyond)
    }
}

fn reach(
    map: &mut Map<'_>,
    (dial, scalar): (&Dial, usize),
    steps: u64,
    unit: Unit,
    (sign, end): (i32, i32),
) -> Result<Reach, Failure> {
    let ordinary = dial.run(scalar, &Setup::ordinary(), steps, false);
    let rounding = 1e3 * [f64::EPSILON, f64::from(f32::EPSILON)][scalar];
    let (mut same, mut near) = (0, 0);
    for k in (4..=end).step_by(4) {
        let cell = dial.run(scalar, &unit.scaled(sign * k), steps, false);
        let value = format!("{} 2^{}", ["mass", "length", "time"][unit as usize], sign * k);
        map.add(SECTION, dial, scalar, &value, &cell)?;
        let difference = difference(&cell, &ordinary, unit.of_momentum(sign * k));
        let beyond = match cell.outcome {
            Err(error) => refusal(error),
            Ok(()) if difference <= rounding => {
                same = if difference == 0.0 && same == near { k } else { same };
                near = k;
                continue;
            }
            Ok(()) => "digits are lost".to_owned(),
        };
        return Ok(Reach { same, near, beyond });
    }
    Ok(Reach { same, near, beyond: String::new() })
}

/// The ranges of all dials.
pub fn explore(map: &mut Map<'_>, claims: &mut Claims, steps: u64) -> Result<(), Failure> {
    for (scalar, name) in SCALARS.into_iter().enumerate() {
        let end = [1000, 120][scalar];
        say(format_args!(
            "Magnitudes, {name}: the powers of ten of the unit over which {steps} steps are the same but for rounding, and what happens next, below and above; where all bits are the same over less, how far\n"
        ));
        let mut rows = vec![["", "mass", "length", "time"].map(str::to_owned).to_vec()];
        let mut narrowest = [i32::MAX; 3];
        for dial in [bodies(), tops(), pendulums()].concat() {
            let mut row = vec![format!("{}, {}", dial.scene, dial.name)];
            for unit in Unit::ALL {
                let below = reach(map, (&dial, scalar), steps, unit, (-1, end))?;
                let above = reach(map, (&dial, scalar), steps, unit, (1, end))?;
                narrowest[unit as usize] = narrowest[unit as usize].min(below.near).min(above.near);
                row.push(format!("{} … {}", below.text("-"), above.text("")));
            }
            rows.push(row);
        }
        say(aligned(rows.iter()));
        // 10^±150 and 10^±18 of mass and time; the square of a length is a moment of inertia, and so 10^±17 in `f32`
        let least = [[500, 500, 500], [60, 56, 60]][scalar];
        for (unit, (narrowest, least)) in ["mass", "length", "time"].into_iter().zip(narrowest.into_iter().zip(least)) {
            claims.holds(
                &format!("magnitudes, {name}: {unit}"),
                narrowest >= least,
                &format!("the same but for rounding over 2^±{narrowest}, at least 2^±{least}"),
            );
        }
    }
    Ok(())
}
