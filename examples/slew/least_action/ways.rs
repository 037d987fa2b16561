//! Ways round: guesses that lead to the target with several turns.

use super::declaration::FreeBody;
use super::extremal::Slew;
use super::problem::Problem;
use clebsch::{Clebsch, Differentiated, Error, Guess};
use clebsch_examples::scene::Failure;
use clebsch_examples::table::Table;

/// Guesses: names, and turns more than the shortest about the fixed axis.
pub const WAYS: [(&str, i32); 4] = [("short", 0), ("other", -1), ("short + turn", 1), ("other + turn", -2)];

/// A slew that was found from the turn about the fixed axis.
#[derive(Clone, Debug)]
pub struct Way {
    /// Its name.
    pub name: &'static str,
    /// The action of the turn about the fixed axis, J·s.
    pub steady: f64,
    /// The result.
    pub slew: Slew,
}

/// The slews near the turns about the fixed axis, less those beyond the first that are not found.
///
/// The first is looked for as a minimum, the others as whatever is near. Half a turn has two directions: there a velocity says which.
///
/// # Errors
/// The errors of the solver.
pub fn follow<M: Differentiated<FreeBody, 3>>(problem: &Problem) -> Result<Vec<Way>, Failure> {
    let stepper =
        FreeBody { inertia: problem.body.inertia }.into_stepper_by::<M>(problem.duration / problem.steps as f64)?;
    let mut nodes = vec![stepper.boundary().rest(&problem.from); problem.steps as usize];
    let mut ways = Vec::new();
    for (name, turns) in WAYS {
        let is_clear = turns == 0 && problem.turn.norm() < std::f64::consts::PI - 1e-3;
        let guess = if is_clear { Guess::Geodesic } else { Guess::Velocity(problem.steady(turns)) };
        match Slew::solve(problem, &stepper, guess, &mut nodes) {
            Err(Failure::Start(Error::NoExtremal { .. })) if turns != 0 => {}
            slew => ways.push(Way { name, steady: problem.steady_action(turns), slew: slew? }),
        }
    }
    Ok(ways)
}

/// The results of all guesses.
pub fn table(ways: &[Way]) -> Table<7> {
    let mut table = Table::new([
        "guess",
        "its action / J s",
        "found",
        "turn / °",
        "iterations",
        "arrives to",
        "space momentum moves",
    ]);
    for (name, _) in WAYS {
        let Some(Way { steady, slew, .. }) = ways.iter().find(|way| way.name == name) else {
            table.row([name, "", "none found", "", "", "", ""].map(str::to_owned));
            continue;
        };
        table.row([
            name.to_owned(),
            format!("{steady:.3}"),
            format!("{:.3}", slew.action),
            format!("{:.2}", slew.angle.to_degrees()),
            slew.iterations.to_string(),
            format!("{:.1e}", slew.gap),
            format!("{:.1e}", slew.space_momentum),
        ]);
    }
    table
}
