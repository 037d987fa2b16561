//! A problem solved with steps of h, h/2 and h/4 next to the closed form.

use crate::conjugate;
use crate::declaration::Free;
use crate::geodesic::{Geodesic, Moment};
use crate::place::apart;
use crate::plan::{Plan, Problem};
use crate::shooting::aim;
use crate::steps::Steps;
use clebsch::{Error, Target};
use clebsch_examples::claims::{Claims, largest};
use clebsch_examples::convergence::Convergence;
use clebsch_examples::flags::Order;
use clebsch_examples::round_off::worst_case;
use clebsch_examples::table::Table;
use nalgebra::{Vector2, Vector3};

/// Plans, and the geodesic that they approach.
#[derive(Clone, Debug)]
pub struct Study {
    name: &'static str,
    problem: Problem,
    /// With h, h/2 and h/4.
    pub plans: [Plan; 3],
    /// `None` where there is none near: too long a step.
    pub geodesic: Option<Geodesic>,
    /// How far it may be off, relative.
    error: f64,
}

/// Largest distances of a plan from the closed form.
#[derive(Clone, Copy, Debug)]
struct Off {
    /// Of places, rad and m.
    place: f64,
    /// Of inputs in the middles of steps, relative.
    input: f64,
    /// Of costates, relative.
    costate: f64,
    /// Of the price, relative.
    price: f64,
}

impl Study {
    /// Solves the problem from the inputs `guess`(t), and aims the closed form at the same target from the costate that was found.
    ///
    /// # Errors
    /// The errors of the solver.
    pub fn new(
        name: &'static str,
        problem: Problem,
        steps: u64,
        guess: impl Fn(f64) -> Vector2<f64>,
    ) -> Result<Self, Error> {
        let plans = problem.refine::<Free, 0>(steps, guess)?;
        let turn_price = problem.car.turn_price;
        let defect = |costate: &Vector3<f64>| problem.lack(&Geodesic::new(turn_price, costate)?);
        let shot = aim(&plans[2].path[0].costate, defect);
        let geodesic = shot.and_then(|shot| Geodesic::new(turn_price, &shot.costate));
        let error = shot.map_or(f64::NAN, |shot| 64.0 * f64::EPSILON * shot.sensitivity / shot.costate.norm());
        Ok(Self { name, problem, plans, geodesic, error })
    }

    /// The price of the closed form, m²/s.
    pub fn price(&self) -> Option<f64> {
        let (geodesic, Problem { car, duration, target }) = (self.geodesic?, self.problem);
        let miss = match target {
            Target::Conditions | Target::Free => {
                (geodesic.at(duration).place.fixed_view::<2, 1>(0, 2) - car.goal).norm_squared()
            }
            _ => 0.0,
        };
        Some(geodesic.speed_squared() * duration / 2.0 + car.miss_price * miss / 2.0)
    }

    fn off(&self, plan: &Plan) -> Option<Off> {
        let (geodesic, price) = (self.geodesic?, self.price()?);
        let size = geodesic.costate.norm();
        let exact = |k: usize, part: f64| geodesic.at((k as f64 + part) * plan.h);
        let moments = || plan.path.iter().enumerate();
        let speed = geodesic.speed_squared().sqrt();
        let input = |(k, moment): (usize, &Moment)| (exact(k, 0.5).input - moment.input).norm() / speed;
        let off = Off {
            place: largest(moments().map(|(k, moment)| apart(&exact(k, 0.0).place, &moment.place).norm())),
            input: largest(moments().take(plan.steps()).map(input)),
            costate: largest(moments().map(|(k, moment)| (exact(k, 0.0).costate - moment.costate).norm() / size)),
            price: (plan.price / price - 1.0).abs(),
        };
        Some(off)
    }

    /// Rows of [`table`].
    pub fn rows(&self, table: &mut Table<9>) {
        for plan in &self.plans {
            let off = self.off(plan);
            let show =
                |value: fn(&Off) -> f64| off.as_ref().map_or("-".to_owned(), |off| format!("{:.2e}", value(off)));
            table.row([
                self.name.to_owned(),
                plan.steps().to_string(),
                format!("{:.9}", plan.price),
                show(|off| off.place),
                show(|off| off.input),
                show(|off| off.costate),
                show(|off| off.price),
                plan.iterations.to_string(),
                plan.index.to_string(),
            ]);
        }
    }

    /// Claims exact properties to round-off, and those of second order to that order.
    pub fn claim(&self, claims: &mut Claims) {
        let [plan, ..] = &self.plans;
        let name = |text: &str| format!("{}: {text}", self.name);
        let (moved, size) = plan.costate_moves();
        if let Target::Place(_) = self.problem.target {
            claims.round_off(&name("the plan arrives"), plan.gap, plan.steps() as u64, 1.0);
        }
        claims.round_off(&name("(λx, λy) is constant in space"), moved, plan.steps() as u64, size);
        self.claim_index(claims);
        self.claim_shooting(claims);
        let order = |part: &str, value: fn(&Off) -> f64, claims: &mut Claims| {
            let name = name(&format!("the order of {part}"));
            let errors = self.plans.each_ref().map(|plan| self.off(plan).as_ref().map_or(f64::NAN, value));
            if errors.iter().any(|error| error.is_nan()) {
                return claims.skip(&name, "no geodesic of the closed form is near: too long a step");
            }
            let steps = plan.steps() as u64;
            Convergence { errors, reference: self.error, steps }.claim(Order::Second, &name, claims);
        };
        order("places", |off| off.place, claims);
        order("inputs", |off| off.input, claims);
        order("costates", |off| off.costate, claims);
        order("the price", |off| off.price, claims);
    }

    /// The index is that of the closed form where both ends are given, and 0 where one is free.
    fn claim_index(&self, claims: &mut Claims) {
        let index = self.plans[2].index;
        if let Target::Free = self.problem.target {
            claims.holds(&format!("{}: it is a minimum", self.name), index == 0, &format!("index {index}"));
        } else {
            let Problem { car, duration, .. } = self.problem;
            let count = self.geodesic.and_then(|geodesic| conjugate::points(&geodesic, car.turn_price, duration));
            conjugate::claim(self.name, index, count, claims);
        }
    }

    /// The costate that the target was made with is found again, unless there is a better way.
    pub fn claim_costate(&self, given: &Geodesic, claims: &mut Claims) {
        let name = format!("{}: its costate is found again", self.name);
        let given_price = given.speed_squared() * self.problem.duration / 2.0;
        match self.geodesic.zip(self.price()) {
            None => claims.skip(&name, "no geodesic of the closed form is near: too long a step, or rest"),
            Some((_, price)) if price < given_price * (1.0 - 1e-6) => {
                claims.skip(&name, "a shorter one was found: this one is beyond its cut time");
            }
            Some((found, _)) => {
                let off = (found.costate - given.costate).norm() / given.costate.norm();
                claims.at_most(&name, off, 1e-9, "relative");
            }
        }
    }

    /// The equations of first order of the steps, solved forward from the costate at the start, give the plan.
    fn claim_shooting(&self, claims: &mut Claims) {
        let [plan, ..] = &self.plans;
        let name = format!("{}: shooting with the steps' equations gives the plan", self.name);
        let steps = Steps::without_bounds(plan.h, self.problem.car.turn_price);
        match steps.off(plan) {
            Some((off, growth)) => {
                let bound = worst_case(plan.steps() as u64, growth);
                claims.at_most(&name, off, bound, &format!("rounding; errors at the start grow {growth:.0} times"));
            }
            None => claims.skip(&name, "the inputs of a step are not found by sweeps: too long a step"),
        }
    }
}

impl Problem {
    /// The gap of a geodesic: the way to the target, or the condition λ = −∂φ/∂q at a free end.
    fn lack(&self, geodesic: &Geodesic) -> Option<Vector3<f64>> {
        let moment = geodesic.at(self.duration);
        match self.target {
            Target::Place(goal) | Target::Configuration(goal) => Some(apart(&goal, &moment.place)),
            Target::Conditions | Target::Free => {
                let rotation = moment.place.fixed_view::<2, 2>(0, 0);
                let miss = moment.place.fixed_view::<2, 1>(0, 2) - self.car.goal;
                let slope = rotation.transpose() * miss * self.car.miss_price;
                Some(moment.costate + Vector3::new(0.0, slope.x, slope.y))
            }
        }
    }
}

/// Plans side by side.
pub fn table() -> Table<9> {
    let off = ["places off", "inputs off", "costates off", "price off"];
    Table::new(["plan", "steps", "price / (m²/s)", off[0], off[1], off[2], off[3], "iterations", "index"])
}
