//! A slew by shooting next to the same by steps.

use super::census::is_same;
use super::declaration::FreeBody;
use super::extremal::Slew;
use super::problem::Problem;
use super::shooting::Shot;
use super::trace::trace;
use super::ways::Way;
use clebsch::Differentiated;
use clebsch_examples::claims::Claims;
use clebsch_examples::convergence::Convergence;
use clebsch_examples::flags::Order;
use clebsch_examples::scene::Failure;
use clebsch_examples::table::Table;

/// Attitudes that are further apart, as the norm of their difference, are not of the same slew.
const FAR: f64 = 0.5;

/// Both, and how they agree.
#[derive(Clone, Debug)]
pub struct Row {
    /// By shooting.
    pub shot: Shot,
    /// The index that theory gives; `None` where conjugate points cannot be counted.
    conjugate: Option<usize>,
    /// By steps; `None` where it was lost.
    pub slew: Option<Slew>,
    /// Which guesses lead there.
    pub guesses: Vec<&'static str>,
    /// Distances of the attitudes with h, h/2 and h/4, rad.
    convergence: Option<Convergence>,
}

impl Row {
    /// Leads the steps along `shot`, with h, h/2 and h/4.
    ///
    /// # Errors
    /// The errors of the solver.
    pub fn new<M: Differentiated<FreeBody, 3>>(
        problem: &Problem,
        shot: Shot,
        ways: &[(Way, Option<Shot>)],
    ) -> Result<Self, Failure> {
        let slews = refine::<M>(problem, &shot)?;
        let convergence = converge(problem, &shot, &slews);
        let leads = |way: &&(Way, Option<Shot>)| way.1.is_some_and(|found| is_same(&found, &shot));
        let guesses = ways.iter().filter(leads).map(|way| way.0.name).collect();
        let [slew, ..] = slews;
        Ok(Self { conjugate: shot.conjugate_points(&problem.euler), shot, slew, guesses, convergence })
    }

    /// Claims that the steps are near the continuous slew, to second order, and have its index.
    pub fn claim(&self, number: usize, claims: &mut Claims) {
        let order = format!("slew {number}: the order, by shooting");
        let index = format!("slew {number}: the index counts its conjugate points");
        let (Some(slew), Some(convergence)) = (&self.slew, self.convergence) else {
            claims.skip(&order, "lost on the way to the target: too long a step");
            return;
        };
        convergence.claim(Order::Second, &order, claims);
        match self.conjugate {
            _ if convergence.errors[0] > FAR => claims.skip(&index, "the steps have gone another way: too long a step"),
            Some(points) => claims.holds(&index, points == slew.index, &format!("{points}")),
            None => claims.skip(&index, "two of them are too near one another to be counted, or one is at the end"),
        }
    }
}

/// The slews with h, h/2 and h/4 next to `shot`.
///
/// # Errors
/// The errors of the solver.
pub fn refine<M: Differentiated<FreeBody, 3>>(problem: &Problem, shot: &Shot) -> Result<[Option<Slew>; 3], Failure> {
    Ok([trace::<M>(problem, shot, 1)?, trace::<M>(problem, shot, 2)?, trace::<M>(problem, shot, 4)?])
}

/// How far the attitudes of slews with h, h/2 and h/4 are from the continuous ones, at most.
pub fn converge(problem: &Problem, shot: &Shot, slews: &[Option<Slew>; 3]) -> Option<Convergence> {
    let exact = shot.path(&problem.euler, problem.steps);
    let distance = |slew: &Slew, finer: usize| {
        let pairs = exact.iter().zip(slew.path.iter().step_by(finer));
        pairs.map(|(motion, (attitude, _))| (motion.attitude - attitude).norm()).fold(0.0, f64::max)
    };
    let [coarse, middle, fine] = slews.each_ref().map(Option::as_ref);
    let errors = [distance(coarse?, 1), distance(middle?, 2), distance(fine?, 4)];
    let reference = exact.last().map_or(f64::NAN, |end| end.error + end.by_momentum.norm() * shot.error);
    Some(Convergence { errors, reference, steps: problem.steps })
}

/// All slews, the least action first.
pub fn table(rows: &[Row]) -> Table<8> {
    let mut table = Table::new([
        "slew",
        "action / J s",
        "of the least",
        "steps, relative",
        "index",
        "conjugate",
        "off with h, h/2, h/4 / rad",
        "guess",
    ]);
    let least = rows.first().map_or(f64::NAN, |row| row.shot.action);
    for (number, row) in (1..).zip(rows) {
        let relative = |slew: &Slew| format!("{:.2e}", slew.action / row.shot.action - 1.0);
        let errors = |convergence: Convergence| convergence.errors.map(|error| format!("{error:.2e}")).join(" ");
        table.row([
            number.to_string(),
            format!("{:.6}", row.shot.action),
            format!("{:.4}", row.shot.action / least),
            row.slew.as_ref().map_or("lost".to_owned(), relative),
            row.slew.as_ref().map_or("-".to_owned(), |slew| slew.index.to_string()),
            row.conjugate.map_or("unclear".to_owned(), |points| points.to_string()),
            row.convergence.map_or("-".to_owned(), errors),
            if row.guesses.is_empty() { "none".to_owned() } else { row.guesses.join(", ") },
        ]);
    }
    table
}
