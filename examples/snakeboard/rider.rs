//! The rider's torques: the reactions of the constraints that prescribe the shape. As inputs of a force they drive a board
//! whose constraint is the wheels alone.

use crate::gait::Gait;
use crate::{Flags, Pushed, Snakeboard};
use clebsch::{Clebsch, State};
use clebsch_examples::flags::Run;
use clebsch_examples::scene::Failure;
use nalgebra::{Matrix3, Vector1, Vector2, Vector5};

impl From<&Snakeboard> for Pushed {
    fn from(board: &Snakeboard) -> Self {
        let &Snakeboard { mass, length, inertia, rotor, wheels, .. } = board;
        Self { mass, length, inertia, rotor, wheels }
    }
}

/// The end of a gait by the torques of the prescribed one. The largest of these on rotor and wheels come with it, in N m.
pub fn pushed(flags: &Flags, run: &Run, gait: Gait) -> Result<(State<Pushed>, Vector2<f64>), Failure> {
    let board = flags.board(gait);
    let (prescribed, free) = (board.stepper(run.step_size)?, Pushed::from(&board).into_stepper(run.step_size)?);
    let place = (Matrix3::identity(), Vector1::zeros(), Vector1::zeros());
    let [rotor, wheels] = board.rates_at(0.0);
    let velocity = Vector5::new(0.0, 0.0, 0.0, rotor, wheels);
    let (mut known, mut state) = (prescribed.state_moving(place, velocity)?, free.state_moving(place, velocity)?);
    let mut largest = Vector2::zeros();
    for step in 0..run.steps {
        let failed = |error| Failure::Step { step, error };
        let (next, reactions) = prescribed.step_with_reactions(&known).map_err(failed)?;
        let torque = Vector2::new(reactions[2], reactions[3]);
        state = free.step_with(&state, &torque).map_err(failed)?;
        largest = largest.sup(&torque.abs());
        known = next;
    }
    Ok((state, largest))
}
