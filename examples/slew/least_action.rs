//! Nothing turns the spacecraft on its way, and ∫ ½ Ω·JΩ dt is least: only the start and the end of the slew have a
//! cost.
//!
//! Extremals are free motions, π̇ = π × J⁻¹π. The unknown is the momentum at the start, which is the costate there as
//! its momentum map sees it. There are many. On each of the two kinds of paths that cannot be deformed into one another
//! one is least.
//!
//! | file | its job |
//! |---|---|
//! | `declaration` | the body, as the macro is given it |
//! | `problem` | attitudes, body, duration |
//! | `extremal`, `ways`, `trace` | slews of the steps: solved, guessed, led along a given one |
//! | `euler`, `shooting`, `census` | slews of the continuous equations, by shooting |
//! | `row`, `order` | both side by side |
//! | `figure` | both drawn |

mod census;
mod declaration;
mod euler;
mod extremal;
mod figure;
mod order;
mod problem;
mod row;
mod shooting;
mod trace;
mod ways;

pub use declaration::Discretization;

use crate::Flags;
use crate::body::Body;
use clebsch::{Declared, Differentiated};
use clebsch_examples::claims::Claims;
use clebsch_examples::csv::{Csv, by_rows};
use clebsch_examples::scene::{Failure, say};
use declaration::{Cayley, Exponential, FreeBody};
use problem::Problem;
use row::Row;
use shooting::Shot;
use ways::Way;

/// The slews of the steps that guesses lead to, and all slews that shooting finds.
struct Slews {
    ways: Vec<Way>,
    /// The least action first.
    rows: Vec<Row>,
}

/// Solves, shoots, compares, claims, writes and draws.
///
/// # Errors
/// The errors of the solver, and files that cannot be written.
pub fn run(flags: &Flags, body: Body) -> Result<Claims, Failure> {
    let problem = Problem::new(flags, body)?;
    let mut claims = Claims::new();
    let slews = match flags.discretization {
        Discretization::MoserVeselov => find::<Declared>(&problem, &mut claims)?,
        Discretization::Cayley => find::<Cayley>(&problem, &mut claims)?,
        Discretization::Exponential => find::<Exponential>(&problem, &mut claims)?,
    };
    if let Some(least) = slews.rows.first() {
        order::compare(&problem, &least.shot, &mut claims)?;
    }
    let [x, y, z] = slews.least()?.slew.momentum().into();
    say(format_args!("the least starts with the momentum {x:.6e}, {y:.6e}, {z:.6e} N m s in the body frame\n"));
    slews.claim(&mut claims)?;
    slews.write(flags, &problem)?;
    figure::draw(flags, &problem, &slews.ways, slews.least()?)?;
    Ok(claims)
}

fn find<M: Differentiated<FreeBody, 3>>(problem: &Problem, claims: &mut Claims) -> Result<Slews, Failure> {
    let (degrees, Problem { steps, duration, euler, to, .. }) = (problem.turn.norm().to_degrees(), problem);
    say(format_args!("a turn by {degrees:.3}° at least action: {duration} s in {steps} steps\n"));
    let ways = ways::follow::<M>(problem)?;
    say(ways::table(&ways));
    let aim = |way: Way| {
        let shot = Shot::aim(euler, to, &problem.scaled(&way.slew.momentum()));
        (way, shot)
    };
    let ways: Vec<_> = ways.into_iter().map(aim).collect();
    let known = || ways.iter().filter_map(|way| way.1);
    let largest = known().map(|shot| shot.action).fold(0.0, f64::max);
    let (shots, made) = census::take(euler, to, known(), largest);
    let rows = shots.into_iter().map(|shot| Row::new::<M>(problem, shot, &ways)).collect::<Result<Vec<_>, _>>()?;
    say(format_args!("all slews up to {largest:.3} J s that {made} shots of the continuous body find\n"));
    say(row::table(&rows));
    for (way, shot) in &ways {
        match shot {
            Some(shot) => way.slew.claim(way.name, shot.growth(euler), claims),
            None => claims.skip(way.name, "no continuous slew is near: too long a step"),
        }
    }
    (1..).zip(&rows).for_each(|(number, row)| row.claim(number, claims));
    Ok(Slews { ways: ways.into_iter().map(|way| way.0).collect(), rows })
}

impl Slews {
    /// The least of those that guesses lead to.
    ///
    /// # Errors
    /// Where there is none.
    fn least(&self) -> Result<&Way, Failure> {
        let least = self.ways.iter().min_by(|a, b| a.slew.action.total_cmp(&b.slew.action));
        least.ok_or_else(|| Failure::Flags("no guess leads to a slew".to_owned()))
    }

    /// Claims the least action.
    fn claim(&self, claims: &mut Claims) -> Result<(), Failure> {
        let (least, slew) = (self.least()?, &self.least()?.slew);
        let name = "no slew costs less than the least from a guess";
        match self.rows.iter().find(|row| row.guesses.contains(&least.name)) {
            Some(row) => {
                let reason = format!("J s, the least of {} slews by shooting", self.rows.len());
                claims.at_most(name, row.shot.action, self.rows[0].shot.action * (1.0 + 1e-9), &reason);
            }
            None => claims.skip(name, "no continuous slew is near: too long a step"),
        }
        claims.holds("it is a minimum", slew.index == 0, &format!("index {}", slew.index));
        let steady = self.ways.iter().fold(f64::INFINITY, |least, way| way.steady.min(least));
        let reason = "J s, the least of a turn about the fixed axis";
        claims.at_most("no turn about the fixed axis costs less", slew.action, steady * (1.0 + 1e-9), reason);
        Ok(())
    }

    /// The least slew, as a file.
    fn write(&self, flags: &Flags, problem: &Problem) -> Result<(), Failure> {
        let columns = "R11 R12 R13 R21 R22 R23 R31 R32 R33 pi1 pi2 pi3 omega1 omega2 omega3";
        let mut csv = Csv::create(&flags.run, &columns.split(' ').collect::<Vec<_>>())?;
        for (step, (attitude, momentum)) in (0..).zip(&self.least()?.slew.path) {
            let omega = problem.body.spin(momentum);
            let state = by_rows(attitude).chain(by_rows(momentum)).chain(by_rows(&omega));
            csv.row(step, flags.run.time(step), state)?;
        }
        csv.finish()
    }
}
