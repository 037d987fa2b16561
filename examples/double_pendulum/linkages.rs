//! Both linkages, as they are declared.

use clebsch::Clebsch;
use nalgebra::{Matrix3, Vector2, Vector3};

/// Two bodies that hang by ball joints, each in the coordinates of its centre of mass.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: [SE<3>; 2], q: [SE<3>; 2]| [q[0] * F[0], q[1] * F[1]],
    cost       = |h, F| (0..2).map(|i| {
        let turn = F[i].rotation() - I;
        ((turn * self.second_moments[i] * turn.transpose()).trace() + self.mass[i] * F[i].translation().norm_squared()) / (2 * h)
    }).sum(),
    potential  = |q| (0..2).map(|i| self.gravity * self.mass[i] * q[i].translation().z).sum(),
    constraint = |q| [
        q[0].rotation() * self.near[0] + q[0].translation() == Vector3::zeros(),
        q[1].rotation() * self.near[1] + q[1].translation() == q[0].rotation() * self.far + q[0].translation(),
    ],
)]
pub struct Pendulum {
    /// ½ tr(J) I − J about the centres of mass, kg·m².
    #[clebsch(symmetric)]
    pub second_moments: [Matrix3<f64>; 2],
    /// Kilograms.
    pub mass: [f64; 2],
    /// g, m/s².
    pub gravity: f64,
    /// The upper joint of each body, from its centre of mass, metres.
    pub near: [Vector3<f64>; 2],
    /// The joint of the upper body to the lower one.
    pub far: Vector3<f64>,
}

/// Crank, coupler and rocker; the pins of the crank and of the rocker are on the ground.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: [SE<2>; 3], q: [SE<2>; 3]| [q[0] * F[0], q[1] * F[1], q[2] * F[2]],
    cost       = |h, F| (0..3).map(|i| {
        (self.inertia[i] * (F[i].rotation() - I).norm_squared() / 2 + self.mass[i] * F[i].translation().norm_squared()) / (2 * h)
    }).sum(),
    potential  = |q| (0..3).map(|i| self.gravity * self.mass[i] * q[i].translation().y).sum(),
    constraint = |q| [
        q[0].translation() - q[0].rotation() * self.half[0] == Vector2::zeros(),
        q[0].translation() + q[0].rotation() * self.half[0] == q[1].translation() - q[1].rotation() * self.half[1],
        q[1].translation() + q[1].rotation() * self.half[1] == q[2].translation() + q[2].rotation() * self.half[2],
        q[2].translation() - q[2].rotation() * self.half[2] == self.ground,
    ],
)]
pub struct FourBar {
    /// Kilograms.
    pub mass: [f64; 3],
    /// About the centres of mass, kg·m².
    pub inertia: [f64; 3],
    /// From the centre of each bar to its far end, metres.
    pub half: [Vector2<f64>; 3],
    /// From the pin of the crank to that of the rocker.
    pub ground: Vector2<f64>,
    /// g, m/s².
    pub gravity: f64,
}
