//! The record of one gait while it runs, next to the other integration, and the claims about it.

use crate::Snakeboard;
use crate::gait::{Gait, Reduced};
use clebsch_examples::claims::Claims;
use clebsch_examples::flags::Run;
use clebsch_examples::reference::{Solution, solve};
use nalgebra::Vector5;

/// Points of the figure.
const POINTS: u64 = 400;

/// One state.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Seconds.
    pub time: f64,
    /// Place of the middle of the board, metres.
    pub at: (f64, f64),
    /// Radians.
    pub heading: f64,
    /// Angles of the rotor and of the wheels, rad.
    pub shape: [f64; 2],
    /// ω (rad/s), v along and across the board (m/s), and the rates of rotor and wheels (rad/s).
    pub velocity: Vector5<f64>,
    /// p, kg·m²/s.
    pub momentum: f64,
}

/// One gait.
pub struct Watch {
    /// Which.
    pub gait: Gait,
    /// At a few times.
    pub samples: Vec<Sample>,
    /// After each cycle, with the other integration.
    pub cycles: Vec<(Sample, Reduced)>,
    board: Snakeboard,
    run: Run,
    cycle: f64,
    exact: Solution<5>,
    slip: f64,
    off_shape: f64,
    fastest: f64,
    turned: f64,
}

impl Watch {
    /// Nothing observed yet. A cycle takes `cycle` seconds.
    pub fn new(run: &Run, board: &Snakeboard, gait: Gait, cycle: f64) -> Self {
        Self {
            gait,
            samples: Vec::new(),
            cycles: Vec::new(),
            board: board.clone(),
            run: run.clone(),
            cycle,
            exact: Solution { end: Reduced::zeros(), error: 0.0 },
            slip: 0.0,
            off_shape: 0.0,
            fastest: 0.0,
            turned: 0.0,
        }
    }

    /// Takes the next state; its heading is that of one turn.
    pub fn observe(&mut self, step: u64, mut sample: Sample) {
        let board = &self.board;
        let [omega, along, across, rotor, wheels] = *sample.velocity.as_ref();
        let (sin, cos) = sample.shape[1].sin_cos();
        let slips = [1.0, -1.0].map(|end| (across + end * board.length * omega) * cos - end * along * sin);
        self.slip = self.slip.max(slips[0].abs()).max(slips[1].abs());
        let [expected, turning] = board.rates_at(sample.time);
        self.off_shape = self.off_shape.max((rotor - expected).abs()).max((wheels - turning).abs());
        self.fastest = self.fastest.max(along.abs() + board.length * (omega.abs() + rotor.abs() + wheels.abs()));
        self.turned += turn(self.turned, sample.heading);
        sample.heading = self.turned;
        if self.run.samples(step, POINTS) {
            self.samples.push(sample);
        }
        // the steps nearest to the ends of cycles, and the last
        let phase = sample.time / self.cycle;
        let is_cycle = (phase - phase.round()).abs() * self.cycle < 0.5 * self.run.step_size;
        if is_cycle || step == self.run.steps {
            let rate = 8.0 * self.board.rates.amax();
            let next = solve(|y| self.board.reduced(y), self.exact.end, sample.time - self.exact.end[4], rate);
            self.exact = Solution { end: next.end, error: self.exact.error + next.error };
            self.cycles.push((sample, self.exact.end));
        }
    }

    /// How far the end is from that of the other integration, in lengths of the board and radians.
    pub fn error(&self) -> f64 {
        self.cycles.last().map_or(f64::NAN, |(sample, _)| self.error_of(sample.at, sample.heading))
    }

    /// How far a place and a heading, up to turns, are from the end of the other integration.
    pub fn error_of(&self, (x, y): (f64, f64), heading: f64) -> f64 {
        let distance = |(_, exact): &(Sample, Reduced)| {
            let far = (x - exact[0]).hypot(y - exact[1]) / self.board.length;
            far.hypot(turn(exact[2], heading))
        };
        self.cycles.last().map_or(f64::NAN, distance)
    }

    /// The error of the other integration itself.
    pub fn reference(&self) -> f64 {
        self.exact.error / self.board.length.min(1.0)
    }

    /// Claims rolling, the shape and the effect of the gait.
    pub fn claim(&self, claims: &mut Claims) {
        let (name, steps) = (self.gait.name, self.run.steps);
        claims.round_off(&format!("{name}: the wheels do not slip"), self.slip, steps, self.fastest);
        claims.round_off(&format!("{name}: rotor and wheels follow"), self.off_shape, steps, self.board.rates.amax());
        let steps_of_a_cycle = self.cycle / self.run.step_size;
        let is_whole = (steps_of_a_cycle - steps_of_a_cycle.round()).abs() < 1e-9 * steps_of_a_cycle;
        let largest =
            |value: fn(&Sample) -> f64| self.cycles.iter().map(|(sample, _)| value(sample).abs()).fold(0.0, f64::max);
        let scale = self.board.rates.amax() * self.board.mass;
        let claimed = match name {
            "drive" => return,
            "rotate" => "no momentum is left after a cycle",
            _ => "it goes sideways alone",
        };
        let left = if name == "rotate" {
            largest(|sample| sample.momentum)
        } else {
            largest(|sample| sample.heading).max(largest(|sample| sample.at.0)).max(largest(|sample| sample.momentum))
        };
        let claimed = format!("{name}: {claimed}");
        if is_whole && self.run.steps.is_multiple_of(steps_of_a_cycle.round() as u64) {
            claims.round_off(&claimed, left, steps, scale);
        } else {
            claims.skip(&claimed, "the run has no whole cycles of steps");
        }
    }
}

/// From one heading to the next, by less than half a turn.
fn turn(from: f64, to: f64) -> f64 {
    (to - from).sin().atan2((to - from).cos())
}
