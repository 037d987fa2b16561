//! The periods that a trajectory shows.

use nalgebra::{Matrix3, Vector3};
use std::f64::consts::{PI, TAU};

/// Something for each of the two periods.
#[derive(Clone, Copy, Debug)]
pub struct Periods<T> {
    /// Of the body momentum about a body axis: the rotation about the long axis, in a long-axis mode.
    pub rotation: T,
    /// Of the long axis about the spatial momentum, mean.
    pub precession: T,
}

/// One of the two.
#[derive(Clone, Copy, Debug)]
pub enum Period {
    /// [`Periods::rotation`]
    Rotation,
    /// [`Periods::precession`]
    Precession,
}

impl<T: Copy> Periods<T> {
    /// The one that is asked for.
    pub fn get(&self, period: Period) -> T {
        match period {
            Period::Rotation => self.rotation,
            Period::Precession => self.precession,
        }
    }
}

/// A moment of the motion: time and the two angles that only grow or only fall, unwrapped, radians.
#[derive(Clone, Copy, Debug)]
pub struct Phase {
    /// Time.
    pub time: f64,
    /// Of the body momentum about the axis that it circulates about.
    pub rotation: f64,
    /// Of the long axis about the spatial momentum.
    pub precession: f64,
}

/// Follows the two angles and notes when the first has made full turns.
#[derive(Clone, Debug)]
pub struct Turns {
    /// The two body axes across the one that the body momentum circulates about.
    across: [usize; 2],
    first: Option<Phase>,
    /// The last four phases, the latest at the end.
    recent: Vec<Phase>,
    /// Full turns so far and the phase at the last of them.
    whole: Option<(f64, Phase)>,
}

impl Turns {
    /// For a body with these principal moments, that starts with this body momentum.
    pub fn new(moments: &Vector3<f64>, momentum: &Vector3<f64>) -> Self {
        let mut order = [0, 1, 2];
        order.sort_by(|&i, &j| moments[i].total_cmp(&moments[j]));
        let [long, middle, short] = order;
        let double_energy = momentum.dot(&momentum.component_div(moments));
        let about_long_axis = momentum.norm_squared() < double_energy * moments[middle];
        let across = if about_long_axis { [middle, short] } else { [long, middle] };
        Self { across, first: None, recent: Vec::with_capacity(5), whole: None }
    }

    /// Takes the next moment: the body momentum, and the long axis in a frame whose third axis is the spatial momentum.
    pub fn observe(&mut self, time: f64, momentum: &Vector3<f64>, long_axis: &Vector3<f64>) {
        let [i, j] = self.across;
        let (rotation, precession) = (momentum[j].atan2(momentum[i]), long_axis.y.atan2(long_axis.x));
        let next = match self.recent.last() {
            Some(last) => Phase {
                time,
                rotation: unwrap(last.rotation, rotation),
                precession: unwrap(last.precession, precession),
            },
            None => Phase { time, rotation, precession },
        };
        let first = *self.first.get_or_insert(next);
        self.recent.push(next);
        if self.recent.len() > 4 {
            self.recent.remove(0);
        }
        let &[a, b, c, d] = self.recent.as_slice() else { return };
        let turns = |phase: Phase| ((phase.rotation - first.rotation).abs() / TAU).floor();
        if turns(c) > turns(b) {
            let target = first.rotation + TAU * turns(c) * (c.rotation - first.rotation).signum();
            let time = lagrange([a, b, c, d].map(|phase| (phase.rotation, phase.time)), target);
            let precession = lagrange([a, b, c, d].map(|phase| (phase.time, phase.precession)), time);
            self.whole = Some((turns(c), Phase { time, rotation: target, precession }));
        }
    }

    /// The phase reached last, as turns since the start: rotation and precession.
    pub fn since_start(&self) -> Periods<f64> {
        let (first, last) = (self.first, self.recent.last());
        let turns = |angle: fn(&Phase) -> f64| match (&first, last) {
            (Some(first), Some(last)) => (angle(last) - angle(first)) / TAU,
            _ => 0.0,
        };
        Periods { rotation: turns(|phase| phase.rotation), precession: turns(|phase| phase.precession) }
    }

    /// The periods over all full turns: the precession speeds up and slows down within a turn, so that its mean needs
    /// full ones.
    pub fn periods(&self) -> Option<Periods<f64>> {
        let (first, (turns, last)) = (self.first?, self.whole?);
        let time = last.time - first.time;
        Some(Periods { rotation: time / turns, precession: TAU * time / (last.precession - first.precession) })
    }
}

/// A frame whose third axis is along `momentum`; the rows are its axes.
pub fn frame_of(momentum: &Vector3<f64>) -> Matrix3<f64> {
    let third = momentum.try_normalize(0.0).unwrap_or(Vector3::z());
    let helper = Vector3::ith(third.iamin(), 1.0);
    let first = helper.cross(&third).normalize();
    Matrix3::from_rows(&[first.transpose(), third.cross(&first).transpose(), third.transpose()])
}

/// `angle` by full turns nearest to `last`.
fn unwrap(last: f64, angle: f64) -> f64 {
    last + (angle - last + PI).rem_euclid(TAU) - PI
}

/// The cubic through four points, at `x`.
fn lagrange(points: [(f64, f64); 4], x: f64) -> f64 {
    let weight = |i: usize| {
        let others = points.iter().enumerate().filter(move |&(j, _)| j != i);
        others.map(|(_, point)| (x - point.0) / (points[i].0 - point.0)).product::<f64>()
    };
    (0..4).map(|i| weight(i) * points[i].1).sum()
}
