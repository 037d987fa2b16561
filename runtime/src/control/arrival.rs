//! Arrival costs: the least price of all plans that end at a place, from the prior of their start on.
//!
//! The value W of a place goes forward through a step as that of later steps goes backward, with the step δ = A⁻¹(δ′ − Bδu).
//! ```text
//! W′(δ′) = min over δu of W(δ) + ½ (δ, δu)·∂²(ℓ + p·f)(δ, δu),    δ = A⁻¹δ′ − Eδu,    E = A⁻¹B
//! ```
//! On a plan of least price the slope of W is −p. There p is the slope of all that follows.
//!
//! Source: Rao, Rawlings and Mayne, *Constrained state estimation for nonlinear discrete-time systems* (2003).

use super::quadratic::{Policy, Value};
use super::start::{Prior, Start, inverse};
use super::sweep::{Problem, convex, positive};
use super::{Control, Stage, Target};
use crate::linear::{eliminate, matrix, rows};
use crate::newton::Curvature;
use crate::parameters::check_finite;
use crate::{Controlled, Error, Expansion, Real};
use nalgebra::{SMatrix, SVector};

impl<T: Real, S: Controlled<D, U, C, Scalar = T>, const D: usize, const U: usize, const C: usize>
    Control<S, D, U, C, Prior<S::Place, T, D>>
{
    /// The prior of the start.
    pub fn prior(&self) -> &Prior<S::Place, T, D> {
        &self.beginning
    }

    /// All that the first `steps` steps of a plan, and the prior of its start, say of the place after them. It is the prior for plans
    /// that start there.
    ///
    /// The plan is one that [`solve`](Self::solve) has found. The result is exact where steps are linear and prices quadratic. Otherwise it
    /// is the model to second order about the plan. Where that has no minimum, it goes without the curvature of steps. Bounds are left out
    /// of the information, and count for the slope.
    ///
    /// # Errors
    /// [`Error::PlanTooShort`] for more steps than the plan has, [`Error::SingularTangent`] for a step without an inverse, and those of a step.
    pub fn arrival_cost(&self, plan: &[Stage<S, D, U, C>], steps: usize) -> Result<Prior<S::Place, T, D>, Error> {
        let Some(first) = plan.first().filter(|_| steps <= plan.len()) else {
            return Err(Error::PlanTooShort { steps: plan.len(), wanted: steps });
        };
        let target = Target::Free;
        let mut problem = self.problem(&first.place, &target, plan.len());
        problem.find_lengths(first);
        let mut information = self.beginning.curvature(&self.system, &first.place);
        let mut slope = -first.costate;
        let mut last = first.place;
        for (index, stage) in plan.iter().enumerate().take(steps) {
            (information, last) = problem.carried(stage, index, &information)?;
            slope = -stage.next_costate;
        }
        Ok(Prior { place: last, slope, information })
    }

    /// The information matrix of the end x_N: of all steps, of the prior and of the price of the end. Where prices are −ln of densities,
    /// its inverse is the covariance of x_N.
    ///
    /// # Errors
    /// As [`arrival_cost`](Self::arrival_cost).
    pub fn end_information(&self, plan: &[Stage<S, D, U, C>]) -> Result<SMatrix<T, D, D>, Error> {
        let Prior { place, information, .. } = self.arrival_cost(plan, plan.len())?;
        let t = self.time + T::from_f64(plan.len() as f64) * self.step_size;
        let curvature = self.system.endpoint_expanded(&self.constants, t, &place).curvature;
        let all = information + curvature;
        Ok(if inverse(&all).is_some() {
            all
        } else {
            information + positive(&curvature, &SVector::from_element(T::one()))
        })
    }

    /// Moves the window of an estimate on by so many steps: the plan, its time and its prior. The steps that leave the plan
    /// stay known by their [`arrival_cost`](Self::arrival_cost). Stages that are new repeat the last one, and need references of their own.
    ///
    /// # Errors
    /// As [`arrival_cost`](Self::arrival_cost). The window is then where it was.
    pub fn slide(&mut self, plan: &mut [Stage<S, D, U, C>], steps: usize) -> Result<(), Error> {
        self.beginning = self.arrival_cost(plan, steps)?;
        self.time += T::from_f64(steps as f64) * self.step_size;
        self.shift(plan, steps);
        Ok(())
    }
}

impl<T: Real, S: Controlled<D, U, C, Scalar = T>, B: Start<S, D, U, C>, const D: usize, const U: usize, const C: usize>
    Problem<'_, S, B, D, U, C>
{
    /// The information at the end of a stage from that at its start, and the place there.
    fn carried(
        &self,
        stage: &Stage<S, D, U, C>,
        index: usize,
        information: &SMatrix<T, D, D>,
    ) -> Result<(SMatrix<T, D, D>, S::Place), Error> {
        let t = self.time_after(index);
        let exact = self.expand(stage, t, &stage.next_costate)?;
        let singular = || Error::SingularTangent { step_size: self.h.to_f64() };
        let straight = self.expand(stage, t, &SVector::zeros())?;
        let before = Value::of_hessian(information);
        let mut carried = *information;
        for step in [exact, straight, convex(&straight, &self.lengths)] {
            let backward = backward(&step).ok_or_else(singular)?;
            let (policy, after) = Policy::of(&backward, None, &before, Curvature::exact(T::zero()));
            carried = after.hessian;
            if policy.negative == 0 && after.is_convex(&self.lengths) {
                break;
            }
        }
        check_finite("the information of the prior", &carried)?;
        Ok((carried, exact.next))
    }
}

/// The step as a function of its end and its input: δ = A⁻¹δ′ − Eδu. `None` where A has no inverse.
fn backward<X: Copy, T: Real, const D: usize, const U: usize>(
    step: &Expansion<X, T, D, U>,
) -> Option<Expansion<X, T, D, U>> {
    let mut inverse = rows(&SMatrix::<T, D, D>::identity());
    eliminate(rows(&step.by_place), &mut inverse)?;
    let inverse: SMatrix<T, D, D> = matrix(inverse);
    let by_input = inverse * step.by_input;
    let place = step.place_curvature * inverse;
    let mixed: SMatrix<T, U, D> = step.mixed_curvature - by_input.tr_mul(&step.place_curvature);
    let across: SMatrix<T, U, U> = step.mixed_curvature * by_input;
    Some(Expansion {
        next: step.next,
        by_place: inverse,
        by_input: -by_input,
        price: T::zero(),
        price_by_place: SVector::from_element(T::zero()),
        price_by_input: SVector::from_element(T::zero()),
        place_curvature: inverse.tr_mul(&place),
        mixed_curvature: mixed * inverse,
        input_curvature: step.input_curvature - across - across.transpose()
            + by_input.tr_mul(&(step.place_curvature * by_input)),
    })
}
