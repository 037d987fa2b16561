//! The chain as it is declared, its start, and its numbers by hand.

use clebsch::{Clebsch, State};
use nalgebra::{Matrix3, Matrix4, Rotation3, Vector3, Vector6};

/// N links on ball joints. A hand moves the first joint away and back, `hand` at the time `moment`.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: [SE<3>; N], q: [SE<3>; N]| (0..N).map(|i| q[i] * F[i]),
    cost       = |h, F| (0..N).map(|i| {
        let turn = F[i].rotation() - I;
        ((turn * self.second_moments * turn.transpose()).trace() + self.mass * F[i].translation().norm_squared()) / (2 * h)
    }).sum(),
    potential  = |q| (0..N).map(|i| self.gravity * self.mass * q[i].translation().y).sum(),
    constraint = |t, q| [
        q[0].rotation() * self.near + q[0].translation() == self.hand * (-((t - self.moment) / self.width).powi(2)).exp(),
        (1..N).map(|i| q[i].rotation() * self.near + q[i].translation() == q[i - 1].rotation() * self.far + q[i - 1].translation()),
    ],
)]
pub struct Whip<const N: usize> {
    /// ½ tr(J) I − J of a link about its centre of mass, kg·m².
    #[clebsch(diagonal)]
    pub second_moments: Matrix3<f64>,
    /// Of a link, kilograms.
    pub mass: f64,
    /// g, m/s².
    pub gravity: f64,
    /// From the centre of a link to the joint with the link before, metres.
    pub near: Vector3<f64>,
    /// From the centre of a link to the joint with the link after.
    pub far: Vector3<f64>,
    /// How far the hand moves, metres.
    pub hand: Vector3<f64>,
    /// Seconds.
    pub moment: f64,
    /// Seconds.
    pub width: f64,
}

/// Of the chain, metres.
pub const LENGTH: f64 = 2.0;
/// Of the chain, kilograms.
pub const MASS: f64 = 1.0;
/// Of a link, metres.
const RADIUS: f64 = 0.01;
/// The hand starts so many widths before its moment, where exp(−36) of the way is left.
const WIDTHS: f64 = 6.0;

/// The numbers of a state.
#[derive(Clone, Debug)]
pub struct Look {
    /// The hand's end, and the far end of each link, metres.
    pub joints: Vec<Vector3<f64>>,
    /// Of the tip, m/s.
    pub speed: f64,
    /// Of the centre of mass, metres.
    pub height: f64,
    /// Of all links, kg·m/s.
    pub momentum: Vector3<f64>,
    /// By how much the joints are open (metres), and how fast they open (m/s).
    pub gaps: [f64; 2],
}

impl<const N: usize> Whip<N> {
    /// Uniform cylinders.
    pub fn new(gravity: f64, hand: [f64; 3], width: f64) -> Self {
        let (mass, length) = (MASS / N as f64, LENGTH / N as f64);
        let across = mass * (RADIUS * RADIUS / 4.0 + length * length / 12.0);
        let moments = Vector3::new(across, mass * RADIUS * RADIUS / 2.0, across);
        Self {
            second_moments: Matrix3::from_diagonal(&(-moments).add_scalar(moments.sum() / 2.0)),
            mass,
            gravity,
            near: Vector3::y() * (length / 2.0),
            far: Vector3::y() * (-length / 2.0),
            hand: hand.into(),
            moment: WIDTHS * width,
            width,
        }
    }

    /// The principal moments of a link.
    pub fn moments(&self) -> Vector3<f64> {
        (-self.second_moments.diagonal()).add_scalar(self.second_moments.trace())
    }

    /// Place, velocity and acceleration of the hand.
    pub fn hand(&self, t: f64) -> [Vector3<f64>; 3] {
        let u = (t - self.moment) / self.width;
        let place = self.hand * (-u * u).exp();
        [place, place * (-2.0 * u / self.width), place * ((4.0 * u * u - 2.0) / self.width.powi(2))]
    }

    /// The time from which on the hand is where it started, to rounding.
    pub fn still(&self) -> f64 {
        self.moment + 6.1 * self.width
    }

    /// A straight chain that leans to the side, with velocities (0, v) that are those of the hand.
    pub fn start(&self, lean: f64) -> ([Matrix4<f64>; N], [Vector6<f64>; N]) {
        let turn = *Rotation3::new(Vector3::x() * lean).matrix();
        let [hand, velocity, _] = self.hand(0.0);
        let moving = turn.transpose() * velocity;
        let places = std::array::from_fn(|i| {
            let centre = hand + turn * (self.far * (2 * i + 1) as f64);
            let mut place = turn.to_homogeneous();
            place.fixed_view_mut::<3, 1>(0, 3).copy_from(&centre);
            place
        });
        (places, [Vector6::new(0.0, 0.0, 0.0, moving.x, moving.y, moving.z); N])
    }

    /// The numbers of a state.
    pub fn look(&self, t: f64, state: &State<Self>) -> Look {
        let [hand, velocity, _] = self.hand(t);
        let (mut end, mut moving) = (hand, velocity);
        let mut look = Look { joints: vec![hand], speed: 0.0, height: 0.0, momentum: Vector3::zeros(), gaps: [0.0; 2] };
        for (q, n) in state.configuration().iter().zip(state.momentum()) {
            let (turn, centre) = (q.fixed_view::<3, 3>(0, 0), q.fixed_view::<3, 1>(0, 3).into_owned());
            let (spin, push) = (n.fixed_rows::<3>(0).component_div(&self.moments()), n.fixed_rows::<3>(3));
            let at = |a: &Vector3<f64>| (turn * a + centre, turn * (push / self.mass + spin.cross(a)));
            let near = at(&self.near);
            look.gaps = [look.gaps[0].max((near.0 - end).norm()), look.gaps[1].max((near.1 - moving).norm())];
            look.momentum += turn * push;
            look.height += centre.y / N as f64;
            (end, moving) = at(&self.far);
            look.joints.push(end);
        }
        look.speed = moving.norm();
        look
    }
}
