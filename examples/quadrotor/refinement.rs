//! Plans with h, h/2 and h/4 next to the continuous one.

use super::plan::Plan;
use super::pontryagin::{Extremals, Motion, apart};
use super::problem::Problem;
use clebsch_examples::claims::Claims;
use clebsch_examples::convergence::Convergence;
use clebsch_examples::flags::Order;
use clebsch_examples::scene::Failure;
use clebsch_examples::table::Table;
use std::fmt::{self, Display, Formatter};

/// The quantities that are compared: the unit of each is the largest on the way.
const NAMES: [&str; 5] = ["attitudes, rad", "positions", "velocities", "angular momenta", "effort"];

/// How far a slope may be from the order where bounds are reached on the way.
const SLOPE: f64 = 0.25;

/// Both, and how they agree.
#[derive(Clone, Debug)]
pub struct Refinement {
    /// s, by shooting.
    effort: f64,
    /// At half steps: where the continuous thrusts are at a bound.
    path: Vec<Motion>,
    rows: [(&'static str, Convergence); 5],
}

impl Refinement {
    /// Shoots from the place and the costates in the middle of the plan, which are all that is taken from it, and refines.
    ///
    /// # Errors
    /// The errors of the solver, and shots that do not arrive.
    pub fn new(problem: &Problem, plan: &Plan) -> Result<Self, Failure> {
        let (extremals, mass) = (Extremals::new(problem), problem.vehicle.mass);
        let plans = [plan.clone(), Plan::solve(problem, 2)?, Plan::solve(problem, 4)?];
        let aimed = extremals.aim(plan);
        let (path, effort, error) =
            aimed.ok_or_else(|| Failure::Flags("no continuous flight is near: take shorter steps".to_owned()))?;
        let sizes = path.iter().map(|motion| apart(motion, &problem.start, mass).map(|part| part.norm()));
        let largest = sizes.fold([1.0, 0.0, 0.0, 0.0], |max, size| std::array::from_fn(|i| f64::max(max[i], size[i])));
        let mut errors = [[0.0; 3]; 5];
        for (part, plan) in plans.iter().enumerate() {
            for (motion, place) in path.iter().step_by(2).zip(plan.places().step_by(1 << part)) {
                let apart = apart(motion, &place, mass);
                (0..4).for_each(|i| errors[i][part] = f64::max(errors[i][part], apart[i].norm() / largest[i]));
            }
            errors[4][part] = (plan.effort / effort - 1.0).abs();
        }
        let converge = |errors| Convergence { errors, reference: error, steps: problem.steps };
        Ok(Self { effort, path, rows: std::array::from_fn(|i| (NAMES[i], converge(errors[i]))) })
    }

    /// How many times the continuous thrusts reach or leave a bound.
    fn switches(&self) -> usize {
        self.path.last().map_or(0, |end| end.switches) + self.path.first().map_or(0, |start| start.switches)
    }

    /// Claims second order, and that the same thrusts are at a bound.
    pub fn claim(&self, plan: &Plan, claims: &mut Claims) {
        let [places @ .., (_, effort)] = &self.rows;
        effort.claim(Order::Second, "the order: effort", claims);
        for (name, Convergence { errors, .. }) in places {
            let reason = "mean slope from h to h/4; bounds are reached within steps, each time elsewhere";
            let slope = (errors[0] / errors[2]).log2() / 2.0;
            claims.within(&format!("the order: {name}"), slope, 2.0 - SLOPE..=2.0 + SLOPE, 3, reason);
        }
        let middles = self.path.iter().skip(1).step_by(2);
        let differ = |(motion, held): (&Motion, [i8; 4])| (0..4).filter(|&i| motion.held[i] != held[i]).count();
        let otherwise: usize = middles.zip(plan.held()).map(differ).sum();
        let reason = "thrusts held back otherwise than those by shooting, one for each switch";
        claims.at_most("the same thrusts are held back", otherwise as f64, self.switches() as f64, reason);
    }
}

impl Display for Refinement {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let switches = self.switches();
        writeln!(f, "by shooting: effort {:.9} s, a bound reached or left {switches} times\n", self.effort)?;
        let mut table = Table::new(["off by, relative", "with h", "h/2", "h/4", "order"]);
        for (name, Convergence { errors, .. }) in &self.rows {
            let [coarse, middle, fine] = errors.map(|error| format!("{error:.3e}"));
            table.row([(*name).to_owned(), coarse, middle, fine, format!("{:.3}", (errors[1] / errors[2]).log2())]);
        }
        table.fmt(f)
    }
}
