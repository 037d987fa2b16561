//! One slew as the steps have it: the extremal between two attitudes, and its conserved quantities.

use super::declaration::FreeBody;
use super::problem::Problem;
use crate::attitude::turn;
use clebsch::{Differentiated, Guess, Node, Stepper};
use clebsch_examples::claims::Claims;
use clebsch_examples::round_off;
use clebsch_examples::scene::Failure;
use nalgebra::{Matrix3, Vector3};

/// Turns of a step, rad, above which two steps may have the same momentum, so that it does not say where a step leads.
const LONGEST: f64 = 1.2;

/// An extremal with its defects.
#[derive(Clone, Debug)]
pub struct Slew {
    /// (R, π) at all vertices.
    pub path: Vec<(Matrix3<f64>, Vector3<f64>)>,
    /// The angle that the spacecraft turns through, rad.
    pub angle: f64,
    /// The largest of a step, rad.
    longest: f64,
    /// J·s
    pub action: f64,
    /// Independent variations that make the action smaller.
    pub index: usize,
    /// Linearisations that were made.
    pub iterations: u32,
    /// |R_N − target|
    pub gap: f64,
    /// The largest |R_k π_k − R_0 π_0| over |π|.
    pub space_momentum: f64,
    /// The largest distance of the attitudes to which the momentum at the start leads the stepper.
    shot: f64,
    /// The largest |J(R_k, P_k) − π_k| over |π|, with the costates that [`Stepper::step_symmetric`] leads on from P_0.
    costates: f64,
}

impl Slew {
    /// The extremal near a guess, by [`clebsch::Boundary::solve`].
    ///
    /// # Errors
    /// The errors of the solver.
    pub fn solve<M: Differentiated<FreeBody, 3>>(
        problem: &Problem,
        stepper: &Stepper<FreeBody, M>,
        guess: Guess<f64, 3>,
        nodes: &mut [Node<FreeBody, 3>],
    ) -> Result<Self, Failure> {
        let extremal = stepper.boundary().solve(&problem.from, &problem.to, guess, nodes)?;
        let path: Vec<_> = extremal.states().map(|state| state.into_parts()).collect();
        let angles = path.windows(2).map(|pair| turn(&pair[0].0, &pair[1].0).norm());
        let mut slew = Self {
            angle: angles.clone().sum(),
            longest: angles.fold(0.0, f64::max),
            action: extremal.action(),
            index: extremal.negative(),
            iterations: extremal.iterations(),
            gap: extremal.gap(),
            space_momentum: 0.0,
            shot: 0.0,
            costates: 0.0,
            path,
        };
        slew.shoot(stepper)?;
        Ok(slew)
    }

    /// π at the start, kg·m²/s.
    pub fn momentum(&self) -> Vector3<f64> {
        self.path[0].1
    }

    /// Follows the stepper from (R_0, π_0), and from (R_0, P_0) with the costate P_0 = R_0 π̂_0/2 that has this momentum.
    fn shoot<M: Differentiated<FreeBody, 3>>(&mut self, stepper: &Stepper<FreeBody, M>) -> Result<(), Failure> {
        let (attitude, momentum) = self.path[0];
        let (size, in_space) = (momentum.norm(), attitude * momentum);
        let matrix: Matrix3<f64> = stepper.momentum_matrix(&momentum);
        let mut costate = stepper.cotangent_state(attitude, attitude * matrix)?;
        let mut state = stepper.state(attitude, momentum)?;
        for (step, (attitude, momentum)) in (1..).zip(&self.path[1..]) {
            self.space_momentum = self.space_momentum.max((attitude * momentum - in_space).norm() / size);
            if self.longest > LONGEST {
                continue;
            }
            let failure = |error| Failure::Step { step, error };
            costate = stepper.step_symmetric(&costate).map_err(failure)?;
            state = stepper.step(&state).map_err(failure)?;
            let mapped = stepper.momentum_map(costate.configuration(), costate.covector());
            self.costates = self.costates.max((mapped - momentum).norm() / size);
            self.shot = self.shot.max((state.configuration() - attitude).norm());
        }
        Ok(())
    }

    /// Claims the properties that hold to round-off; a momentum that is wrong by ε leads `growth` ε aside.
    pub fn claim(&self, name: &str, growth: f64, claims: &mut Claims) {
        let steps = self.path.len() as u64 - 1;
        // A momentum is known as well as the short turn of one step is. An attitude that is rounded by ε makes it wrong
        // by ε/turn.
        let amplified = 1.0 + steps as f64 / self.angle;
        let name_of = |what| format!("{name}: {what}");
        claims.round_off(&name_of("the spacecraft arrives"), self.gap, steps, 1.0);
        claims.round_off(&name_of("the momentum in space is constant"), self.space_momentum, steps, amplified);
        let bound = round_off::worst_case(steps, amplified * growth);
        for (what, measured) in
            [("steps from its momentum arrive", self.shot), ("costates have its momentum", self.costates)]
        {
            if self.longest > LONGEST {
                claims.skip(&name_of(what), &format!("a step turns by {:.2} rad: too long a step", self.longest));
            } else {
                claims.at_most(&name_of(what), measured, bound, "rounding, as the motion magnifies it");
            }
        }
    }
}
