//! Every accepted fixture, stepped by a function that C could call, in a library that has no allocator.
//!
//! Unsafe code is not forbidden here, because the attribute that exports a name counts as unsafe; there is no other.

#![no_std]
#![deny(unsafe_op_in_unsafe_fn)]
// the functions are there to be linked: what they take is the layout of Rust, and nobody calls them from C
#![allow(improper_ctypes_definitions)]

#[cfg(feature = "heap")]
extern crate alloc;

use clebsch::{Clebsch, Controlled, Error, Guess, Real, Stage, Stepper, Target, Variational};

mod fixtures;

/// What a panic would call. The linked program has to be without it.
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {}
}

/// Where a system starts, and where it arrives.
pub struct Motion<S: Clebsch> {
    step_size: S::Scalar,
    steps: usize,
    configuration: S::Configuration,
    momentum: S::Momentum,
    covector: S::Configuration,
    element: S::Element,
    matrix: S::MomentumMatrix,
    energy: S::Scalar,
}

/// Everything that a stepper can do.
fn integrate<S: Clebsch + Clone>(system: &S, motion: &mut Motion<S>) -> Result<(), Error> {
    #[cfg(feature = "heap")]
    let _ = alloc::vec::Vec::<u8>::with_capacity(motion.steps);
    let stepper = system.stepper(motion.step_size)?;
    euler_poincare(&stepper, motion)?;
    symmetric(&stepper, motion)?;
    formulas(&stepper, motion)
}

fn euler_poincare<S: Clebsch>(stepper: &Stepper<S>, motion: &mut Motion<S>) -> Result<(), Error> {
    let start = stepper.state(motion.configuration, motion.momentum)?;
    for state in stepper.trajectory(start).take(motion.steps) {
        let state = state?;
        motion.configuration = *state.configuration();
        motion.momentum = *state.momentum();
        motion.energy = stepper.energy(&state);
    }
    Ok(())
}

fn symmetric<S: Clebsch>(stepper: &Stepper<S>, motion: &mut Motion<S>) -> Result<(), Error> {
    let mut state = stepper.cotangent_state(motion.configuration, motion.covector)?;
    for _ in 0..motion.steps {
        state = stepper.step_symmetric(&state)?;
    }
    motion.configuration = *state.configuration();
    motion.covector = *state.covector();
    Ok(())
}

fn formulas<S: Clebsch>(stepper: &Stepper<S>, motion: &mut Motion<S>) -> Result<(), Error> {
    let t = motion.step_size;
    motion.element = stepper.inverse_legendre_at(t, &motion.configuration, &motion.momentum)?;
    motion.momentum = stepper.legendre_at(t, &motion.configuration, &motion.element);
    motion.momentum = stepper.legendre_next_at(t, &motion.configuration, &motion.element);
    motion.momentum = stepper.coadjoint(&motion.element, &motion.momentum);
    motion.matrix = stepper.momentum_matrix(&motion.momentum);
    motion.momentum = stepper.momentum_components(&motion.matrix);
    motion.configuration = stepper.act(&motion.element, &motion.configuration);
    motion.momentum = stepper.momentum_map(&motion.configuration, &motion.covector);
    Ok(())
}

/// The steps of a plan, and the edges of a path.
const STEPS: usize = 16;

/// A problem of optimal control.
pub struct Plan<S: Controlled<D, U, C, Scalar: Real>, const D: usize, const U: usize, const C: usize> {
    step_size: S::Scalar,
    start: S::Place,
    goal: S::Place,
    stages: [Stage<S, D, U, C>; STEPS],
    price: S::Scalar,
}

/// Everything that plans can do.
fn choose<S: Controlled<D, U, C, Scalar: Real> + Clone, const D: usize, const U: usize, const C: usize>(
    system: &S,
    plan: &mut Plan<S, D, U, C>,
) -> Result<(), Error> {
    let control = system.clone().control(plan.step_size)?;
    plan.stages = [control.stage(&plan.start); STEPS];
    let target = Target::Place(plan.goal);
    plan.price = control.solve(&plan.start, target, &mut plan.stages)?.price();
    plan.goal = control.follow(&plan.start, &control.feedback(&plan.stages[0], &plan.goal))?;
    Ok(())
}

/// A path between fixed endpoints.
fn connect<S, const M: usize>(system: &S, motion: &mut Motion<S>, target: &S::Configuration) -> Result<(), Error>
where
    S: Variational<M, Scalar: Real> + Clone,
{
    let stepper = system.stepper(motion.step_size)?;
    let boundary = stepper.boundary();
    let mut path = [boundary.rest(&motion.configuration); STEPS];
    let extremal = boundary.solve(&motion.configuration, target, Guess::Geodesic, &mut path)?;
    motion.energy = extremal.action();
    motion.configuration = *boundary.solve_free(target, Guess::Path, &mut path)?.end();
    Ok(())
}
