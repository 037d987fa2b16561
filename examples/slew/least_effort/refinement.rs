//! Plans with h, h/2 and h/4 next to the continuous one.

use super::plan::Plan;
use super::pontryagin::{Extremals, Motion, attitude, effort, momentum};
use super::problem::Problem;
use clebsch_examples::claims::Claims;
use clebsch_examples::convergence::Convergence;
use clebsch_examples::extremal::Pontryagin;
use clebsch_examples::flags::Order;
use clebsch_examples::scene::Failure;
use clebsch_examples::table::Table;
use std::fmt::{self, Display, Formatter};

/// How far a slope may be from the order where bounds are reached on the way.
const SLOPE: f64 = 0.25;

/// Both, and how they agree.
#[derive(Clone, Debug)]
pub struct Refinement {
    /// N²·m²·s, by shooting.
    effort: f64,
    /// At half steps: where the continuous torques are at a bound.
    path: Vec<Motion>,
    steps: u64,
    rows: [(&'static str, Convergence); 4],
}

impl Refinement {
    /// Shoots from the costates of the plan, which are all that is taken from it, and refines.
    ///
    /// # Errors
    /// The errors of the solver, and shots that do not arrive.
    pub fn new(problem: &Problem, plan: &Plan) -> Result<Self, Failure> {
        let extremals = Extremals::new(problem);
        let near = plan.stages.first().map(|stage| *stage.costate()).unwrap_or_default();
        let shot = extremals.aim(&problem.to, &near);
        let shot = shot.ok_or_else(|| Failure::Flags("no continuous plan is near: take shorter steps".to_owned()))?;
        let path = extremals.path(extremals.start(&shot.costates), 2 * problem.steps, 1.0);
        let least = path.last().map_or(f64::NAN, effort) * extremals.effort_unit;
        let inverse_inertia = problem.body.inertia.try_inverse().unwrap_or_default();
        let mut errors = [[0.0; 3]; 4];
        for (part, finer) in [1, 2, 4].into_iter().enumerate() {
            let plan = if finer == 1 { plan.clone() } else { Plan::solve(problem, finer)? };
            let pairs = || path.iter().step_by(2).zip(plan.places().step_by(finer as usize));
            let largest = |size: &dyn Fn(&Motion) -> f64| path.iter().map(size).fold(0.0, f64::max);
            let unit = extremals.momentum_unit;
            let momenta = pairs().map(|(motion, place)| (momentum(motion) - place.1 / unit).norm()).fold(0.0, f64::max);
            let (off, energy) = plan.energy_book(&inverse_inertia);
            errors[0][part] = pairs().map(|(motion, place)| (attitude(motion) - place.0).norm()).fold(0.0, f64::max);
            errors[1][part] = momenta / largest(&|motion| momentum(motion).norm());
            errors[2][part] = (plan.effort / least - 1.0).abs();
            errors[3][part] = off / energy;
        }
        let names = ["attitudes, rad", "momenta, relative", "effort, relative", "work less kinetic energy, relative"];
        let converge = |errors| Convergence { errors, reference: shot.error, steps: problem.steps };
        let rows = std::array::from_fn(|i| (names[i], converge(errors[i])));
        Ok(Self { effort: least, path, steps: problem.steps, rows })
    }

    /// How many times the continuous torques reach or leave a bound.
    fn switches(&self) -> usize {
        self.path.last().map_or(0, |end| end.switches)
    }

    /// Torques that the plan holds back and the continuous one does not in the middle of the step, or the other way round.
    fn held_otherwise(&self, plan: &Plan) -> usize {
        let middles = self.path.iter().skip(1).step_by(2);
        let differ = |(motion, stage): (&Motion, &super::declaration::Stage)| {
            let active = stage.active();
            (0..3)
                .filter(|&axis| {
                    [active[2 * axis], active[2 * axis + 1]] != [motion.held[axis] < 0, motion.held[axis] > 0]
                })
                .count()
        };
        middles.zip(&plan.stages).map(differ).sum()
    }

    /// Claims second order, and that the same torques are at a bound.
    pub fn claim(&self, plan: &Plan, claims: &mut Claims) {
        let [places @ .., effort, work] = &self.rows;
        for (name, convergence) in [effort, work] {
            convergence.claim(Order::Second, &format!("the order: {name}"), claims);
        }
        for (name, Convergence { errors, .. }) in places {
            let reason = "mean slope from h to h/4; bounds are reached within steps, each time elsewhere";
            let slope = (errors[0] / errors[2]).log2() / 2.0;
            claims.within(&format!("the order: {name}"), slope, 2.0 - SLOPE..=2.0 + SLOPE, 3, reason);
        }
        let reason =
            format!("torques of {} held back otherwise than those by shooting, one for each switch", self.steps);
        let (otherwise, switches) = (self.held_otherwise(plan) as f64, self.switches() as f64);
        claims.at_most("the same torques are held back", otherwise, switches, &reason);
    }
}

impl Display for Refinement {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let switches = self.switches();
        writeln!(f, "by shooting: effort {:.9e} N² m² s, a bound reached or left {switches} times\n", self.effort)?;
        let mut table = Table::new(["off by", "with h", "h/2", "h/4", "order"]);
        for (name, Convergence { errors, .. }) in &self.rows {
            let [coarse, middle, fine] = errors.map(|error| format!("{error:.3e}"));
            table.row([(*name).to_owned(), coarse, middle, fine, format!("{:.3}", (errors[1] / errors[2]).log2())]);
        }
        table.fmt(f)
    }
}
