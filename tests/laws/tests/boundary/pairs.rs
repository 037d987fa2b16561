//! Random endpoints, uniform on their space, each pair with its distance from the cut locus: how many are solved.

use super::systems::{Free, Top};
use clebsch::{Clebsch, Error, Guess, Node, Space, Stepper, Variational};
use clebsch_tests::oracle::random::Random;
use nalgebra::{Matrix3, Matrix4, SVector, Vector3, Vector4};
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// Steps of a path.
const STEPS: usize = 50;
/// The greatest angle of a turn that counts as away from the cut locus, at which the shortest way is not unique.
const AWAY: f64 = 0.98 * PI;

/// A bob on a massless rod of unit length.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, q: Unit<Vector3>| F * q,
    cost      = |h, F| (F - I).norm_squared() / (4 * h),
    potential = |q| self.gravity * q.z,
    emit      = [boundary],
)]
pub struct Bob {
    /// g, m/s².
    pub gravity: f64,
}

/// A free body in four dimensions.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<4>, R: SO<4>| R * F,
    cost   = |h, F| (Matrix4::from_diagonal(&self.mass) * (F - I) * (F - I).transpose()).trace() / (2 * h),
    emit   = [boundary],
)]
pub struct Body4 {
    /// Diagonal of the mass matrix, kg·m².
    pub mass: Vector4<f64>,
}

/// The outcome of the pairs of one system.
#[derive(Default)]
pub struct Line {
    pub system: &'static str,
    /// Pairs away from the cut locus.
    pub away: u64,
    /// Of these, solved: gap and residual below 1e-12 of configuration and momentum.
    pub solved: u64,
    /// Pairs near the cut locus.
    pub near: u64,
    /// Of these, solved.
    pub solved_near: u64,
    /// Solutions that are no minimum.
    pub no_minimum: u64,
    /// Linearisations of all solutions and of the longest.
    pub iterations: u64,
    pub most: u32,
    /// The errors of the others.
    pub errors: BTreeMap<String, u64>,
}

impl Line {
    /// The share that is solved away from the cut locus.
    pub fn share(&self) -> f64 {
        self.solved as f64 / self.away as f64
    }
}

/// All systems, `count` pairs each.
pub fn lines(count: u64) -> Vec<Line> {
    let (mass, h) = (Vector3::new(2.0, 1.0, 0.0), 1.0 / STEPS as f64);
    let free = Free { mass }.into_stepper(h).expect("a body");
    let top = Top { mass, weight: 1.0 }.into_stepper(h).expect("a top");
    let bob = Bob { gravity: 1.0 }.into_stepper(h).expect("a bob");
    let body = Body4 { mass: Vector4::new(1.0, 1.5, 2.0, 2.5) }.into_stepper(h).expect("a body");
    vec![
        line("SO(3), free", &free, count, turned),
        line("SO(3), heavy", &top, count, turned),
        line("sphere, heavy", &bob, count, points),
        line("SO(4), free", &body, count, turned_twice),
    ]
}

/// Two attitudes and the angle between them.
fn turned(random: &mut Random) -> (Matrix3<f64>, Matrix3<f64>, f64) {
    let (start, target): (Matrix3<f64>, Matrix3<f64>) = (random.attitude(), random.attitude());
    let cosine = ((start.transpose() * target).trace() - 1.0) / 2.0;
    (start, target, cosine.clamp(-1.0, 1.0).acos())
}

fn points(random: &mut Random) -> (Vector3<f64>, Vector3<f64>, f64) {
    let (start, target): (Vector3<f64>, Vector3<f64>) = (random.unit(), random.unit());
    (start, target, start.angle(&target))
}

/// Turns by two angles in two planes.
fn turned_twice(random: &mut Random) -> (Matrix4<f64>, Matrix4<f64>, f64) {
    let (start, frame): (Matrix4<f64>, Matrix4<f64>) = (random.attitude(), random.attitude());
    let [a, b] = [(); 2].map(|()| PI * random.number());
    #[rustfmt::skip]
    let turns = Matrix4::new(
        a.cos(), -a.sin(), 0.0, 0.0,
        a.sin(), a.cos(), 0.0, 0.0,
        0.0, 0.0, b.cos(), -b.sin(),
        0.0, 0.0, b.sin(), b.cos(),
    );
    (start, start * frame * turns * frame.transpose(), a.abs().max(b.abs()))
}

fn line<S, const M: usize>(
    system: &'static str,
    stepper: &Stepper<S>,
    count: u64,
    pair: impl Fn(&mut Random) -> (S::Configuration, S::Configuration, f64),
) -> Line
where
    S: Variational<M> + Clebsch<Scalar = f64, Momentum = SVector<f64, M>>,
{
    let boundary = stepper.boundary();
    let mut path: Option<Vec<Node<S, M>>> = None;
    let (mut line, random) = (Line { system, ..Line::default() }, &mut Random::new(2026));
    for _ in 0..count {
        let (start, target, angle) = pair(random);
        let path = path.get_or_insert_with(|| vec![boundary.rest(&start); STEPS]);
        let is_solved = match boundary.solve(&start, &target, Guess::Geodesic, path) {
            Ok(extremal) => {
                line.no_minimum += u64::from(extremal.negative() > 0);
                line.iterations += u64::from(extremal.iterations());
                line.most = line.most.max(extremal.iterations());
                let momentum = extremal.momentum().amax();
                extremal.gap() < 1e-12 * (1.0 + target.max_abs()) && extremal.residual() < 1e-12 * (1.0 + momentum)
            }
            Err(error) => {
                *line.errors.entry(kind(&error)).or_default() += 1;
                false
            }
        };
        let counts =
            if angle <= AWAY { [&mut line.away, &mut line.solved] } else { [&mut line.near, &mut line.solved_near] };
        let [all, solved] = counts;
        *all += 1;
        *solved += u64::from(is_solved);
    }
    line
}

/// The name of an error.
fn kind(error: &Error) -> String {
    let text = format!("{error:?}");
    text.split([' ', '(']).next().unwrap_or_default().to_string()
}
