//! Residuals of measured attitudes and their exact derivatives, by the sensitivities of the steps.

use crate::Spacecraft;
use crate::measurement::Schedule;
use crate::rotation::{inverse_right_jacobian, logarithm};
use crate::unknowns::{COUNT, Chart, OF_INERTIA, Slopes, Unknowns, upper};
use clebsch::{Clebsch, Differentiated, Error, Sensitivity, State, Stepper, Tangent};
use clebsch_examples::progress::Progress;
use nalgebra::{Matrix3, SMatrix, Vector3};
use std::marker::PhantomData;

/// Standard deviation of the first guess of an entry of the inertia, over the trace.
///
/// It holds the first arcs, too short to determine the inertia, near bodies that exist. All data together say more by
/// orders of magnitude.
pub const PRIOR: f64 = 0.1;

/// A stepper of the spacecraft, and the state that it starts from.
pub type Begun<M> = (Stepper<Spacecraft, M>, State<Spacecraft, M>);

/// The map from unknowns to predicted attitudes.
#[derive(Clone, Copy, Debug)]
pub struct Estimator<M> {
    /// The meaning of the unknowns.
    pub chart: Chart,
    /// Mean motion of the orbit, rad/s; known.
    pub mean_motion: f64,
    /// Standard deviation of a measured angle, radians.
    pub sigma: f64,
    /// The knowledge before any measurement: the ratios of its inertia, with the standard deviation [`PRIOR`].
    guess: Unknowns,
    method: PhantomData<M>,
}

/// Attitudes with their derivatives with respect to the unknowns, as motions of the body.
pub struct Predicted {
    /// R
    pub attitudes: Vec<Matrix3<f64>>,
    /// ∂η, δR = R η̂.
    pub slopes: Vec<Slopes>,
    /// The effect of a change of scale on them.
    pub scaling: Vec<Scaling>,
}

/// The derivative of an attitude along (J, π) ↦ (1 + s)(J, π).
pub struct Scaling {
    /// ∂η
    pub moved: Vector3<f64>,
    /// The sum of the sizes of its parts, which cancel.
    pub parts: f64,
}

/// The tangent map of a run, and its sensitivity to all quantities of the declaration.
type Chained = (Tangent<f64, 3>, Sensitivity<f64, 3, 9>);

impl<M: Differentiated<Spacecraft, 3>> Estimator<M> {
    /// For measurements with this standard deviation, radians, and a first guess.
    pub fn new(chart: Chart, mean_motion: f64, sigma: f64, guess: Unknowns) -> Self {
        Self { chart, mean_motion, sigma, guess, method: PhantomData }
    }

    /// How far the inertia is from the first guess, in standard deviations.
    pub fn departure(&self, x: &Unknowns) -> [f64; OF_INERTIA] {
        std::array::from_fn(|entry| (x[entry] - self.guess[entry]) / PRIOR)
    }

    /// The stepper of the unknowns, and the first state.
    ///
    /// # Errors
    /// The refusals of the stepper and of the state.
    pub fn start(&self, x: &Unknowns, step_size: f64) -> Result<Begun<M>, Error> {
        let start = self.chart.start(x);
        let stepper =
            Spacecraft { inertia: start.inertia, mean_motion: self.mean_motion }.into_stepper_by::<M>(step_size)?;
        let state = stepper.state(start.attitude, start.inertia * start.spin)?;
        Ok((stepper, state))
    }

    /// The attitudes at the times of the schedule, without derivatives; `None` where a step is refused.
    pub fn attitudes(&self, x: &Unknowns, schedule: &Schedule) -> Option<Vec<Matrix3<f64>>> {
        let (stepper, mut state) = self.start(x, schedule.step_size).ok()?;
        let mut attitudes = vec![*state.configuration()];
        let mut progress = Progress::new(schedule.steps());
        for step in 1..=schedule.steps() {
            state = stepper.step(&state).ok()?;
            if step.is_multiple_of(schedule.every) {
                attitudes.push(*state.configuration());
            }
            progress.reached(step);
        }
        Some(attitudes)
    }

    /// The same with derivatives, chained from step to step: ∂η = D ∂(η₀, π₀) + Σ ∂J, with the tangent map D since the start.
    pub fn predict(&self, x: &Unknowns, schedule: &Schedule) -> Option<Predicted> {
        let (stepper, mut state) = self.start(x, schedule.step_size).ok()?;
        let mut chained: Chained = (Tangent::identity(), Sensitivity::zero());
        let mut predicted = Predicted { attitudes: Vec::new(), slopes: Vec::new(), scaling: Vec::new() };
        self.note(x, &state, &chained, &mut predicted);
        let mut progress = Progress::new(schedule.steps());
        for step in 1..=schedule.steps() {
            let (next, tangent, of_step) = stepper.step_sensitivity(&state).ok()?;
            chained = (chained.0.then(&tangent), chained.1.after(&tangent, &of_step));
            state = next;
            if step.is_multiple_of(schedule.every) {
                self.note(x, &state, &chained, &mut predicted);
            }
            progress.reached(step);
        }
        Some(predicted)
    }

    fn note(&self, x: &Unknowns, state: &State<Spacecraft, M>, (whole, of_quantities): &Chained, to: &mut Predicted) {
        // the inertia is the first field of the declaration, so its six entries are the first quantities
        let of_inertia: SMatrix<f64, 3, 6> = of_quantities.motion.fixed_columns::<6>(0).into();
        let (start, first) = (self.chart.start(x), self.chart.start_slopes(x));
        to.attitudes.push(*state.configuration());
        to.slopes.push(
            whole.motion_by_motion * first.motion
                + whole.motion_by_momentum * first.momentum
                + of_inertia * self.chart.inertia_slopes(),
        );
        let (by_momentum, entries) = (whole.motion_by_momentum * (start.inertia * start.spin), upper(&start.inertia));
        let parts = by_momentum.norm() + (of_inertia.abs() * entries.abs()).norm();
        to.scaling.push(Scaling { moved: by_momentum + of_inertia * entries, parts });
    }

    /// log(R̃ᵀR)/σ: how far the body is predicted from where it was measured, in the body frame, in standard deviations.
    pub fn residual(&self, measured: &Matrix3<f64>, predicted: &Matrix3<f64>) -> Vector3<f64> {
        logarithm(&(measured.transpose() * predicted)) / self.sigma
    }

    /// All residuals, three by three.
    pub fn residuals(&self, measured: &[Matrix3<f64>], predicted: &[Matrix3<f64>]) -> Vec<f64> {
        let pairs = measured.iter().zip(predicted);
        pairs.flat_map(|(measured, predicted)| <[f64; 3]>::from(self.residual(measured, predicted))).collect()
    }

    /// ∂ log(R̃ᵀR)/σ = J(log)⁻¹ ∂η/σ, block by block.
    pub fn jacobian(&self, measured: &[Matrix3<f64>], predicted: &Predicted) -> Vec<Slopes> {
        let pairs = measured.iter().zip(&predicted.attitudes).zip(&predicted.slopes);
        let block = |((measured, attitude), slopes): ((&Matrix3<f64>, &Matrix3<f64>), &Slopes)| {
            let angle = logarithm(&(measured.transpose() * attitude));
            inverse_right_jacobian(&angle) * slopes / self.sigma
        };
        pairs.map(block).collect()
    }
}

/// JᵀJ, with the part of the first guess, and Jᵀr of the measurements.
pub fn normal_equations(jacobian: &[Slopes], residuals: &[f64]) -> (SMatrix<f64, COUNT, COUNT>, Unknowns) {
    let of_guess = Unknowns::from_fn(|place, _| if place < OF_INERTIA { PRIOR.powi(-2) } else { 0.0 });
    let mut sums = (SMatrix::from_diagonal(&of_guess), Unknowns::zeros());
    for (block, residual) in jacobian.iter().zip(residuals.chunks_exact(3)) {
        sums.0 += block.transpose() * block;
        sums.1 += block.transpose() * Vector3::from_column_slice(residual);
    }
    sums
}
