//! The record of the motion while it runs, and the claims about it.

use crate::cycloid::Cycloid;
use crate::{Flags, GRAVITY, RADIUS};
use clebsch_examples::claims::Claims;
use clebsch_examples::conserved::Conserved;
use clebsch_examples::table::Table;
use nalgebra::{Rotation2, Vector2, Vector3};

/// Points of the figure.
const POINTS: u64 = 1000;
/// Intervals of the table.
const ROWS: u64 = 10;

/// One state.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Seconds.
    pub time: f64,
    /// Place of the contact, metres.
    pub x: Vector2<f64>,
    /// Velocity of the ball, m/s.
    pub v: Vector2<f64>,
    /// Its angular velocity, rad/s.
    pub w: Vector3<f64>,
}

/// Points of the path, and the largest defects of all states.
pub struct Watch {
    /// The motion at a few times.
    pub table: Table<6>,
    /// Points of the figure.
    pub samples: Vec<Sample>,
    /// The closed form.
    pub exact: Cycloid,
    flags: Flags,
    /// The angle about the centre so far.
    turned: f64,
    last: Option<Vector2<f64>>,
    spin: Conserved,
    widest: f64,
    fastest: f64,
    slip: f64,
    off_circle: f64,
    off_angle: f64,
    behind: f64,
}

impl Watch {
    /// Nothing observed yet.
    pub fn new(flags: &Flags) -> Self {
        let slope = GRAVITY * flags.tilt.to_radians().sin();
        let exact = Cycloid::new(flags.table, slope, flags.roundness(), flags.position.into(), flags.velocity.into());
        let spin = Conserved::new("the spin about the vertical is constant", flags.spin.abs().max(flags.table.abs()));
        Self {
            table: Table::new(["time / s", "x / m", "y / m", "turned / °", "off the circle / m", "slip / m/s"]),
            samples: Vec::new(),
            exact,
            flags: flags.clone(),
            turned: 0.0,
            last: None,
            spin,
            widest: 0.0,
            fastest: 0.0,
            slip: 0.0,
            off_circle: 0.0,
            off_angle: 0.0,
            behind: 0.0,
        }
    }

    /// Takes the next state.
    pub fn observe(&mut self, step: u64, sample: Sample) {
        let Sample { time, x, v, w } = sample;
        let from_centre = x - self.exact.centre(time);
        let off = (from_centre.norm() - self.exact.radius).abs();
        // of the ball at the contact, and of the table there
        let contact = Vector2::new(v.x - RADIUS * w.y, v.y + RADIUS * w.x);
        let slip = (contact - Vector2::new(-x.y, x.x) * self.flags.table).norm();
        if let Some(last) = self.last {
            self.turned += angle(last, from_centre);
            let expected = Rotation2::new(self.exact.angle_of_step(self.flags.run.step_size)) * last;
            self.off_angle = self.off_angle.max((from_centre - expected).norm());
        }
        self.last = Some(from_centre);
        self.spin.observe(w.z);
        self.widest = self.widest.max(x.norm()).max(from_centre.norm());
        self.fastest = self.fastest.max(v.norm() + RADIUS * w.norm());
        self.slip = self.slip.max(slip);
        self.off_circle = self.off_circle.max(off);
        self.behind = self.behind.max((x - self.exact.place(time)).norm());
        if self.flags.run.samples(step, POINTS) {
            self.samples.push(sample);
        }
        if self.flags.run.samples(step, ROWS) {
            let turned = format!("{:.2}", self.turned.to_degrees());
            let [x, y] = [x.x, x.y].map(|entry| format!("{entry:.5}"));
            self.table.row([format!("{time:.2}"), x, y, turned, format!("{off:.1e}"), format!("{slip:.1e}")]);
        }
    }

    /// Claims the circle, its drift and its rate.
    pub fn claim(&self, claims: &mut Claims) {
        let (run, exact) = (&self.flags.run, &self.exact);
        let steps = run.steps;
        claims.round_off("the ball does not slip", self.slip, steps, self.fastest);
        self.spin.claim(steps, claims);
        claims.round_off("the path is the circle, with the exact drift", self.off_circle, steps, self.widest);
        claims.round_off("each step turns by 2 arctan(hκ/2)", self.off_angle, 1, self.widest);
        // n (hκ − 2 arctan(hκ/2)) ≤ n (hκ)³/12
        let angle = (run.step_size * exact.rate).abs();
        let late = steps as f64 * angle.powi(3) / 12.0;
        let rounding = f64::EPSILON * steps as f64 * self.widest;
        let reason = "n (hκ)³/12 of the radius: steps turn a little less";
        claims.at_most("it is late on its circle", self.behind, late * exact.radius + rounding, reason);
        let (name, rounds) = if self.flags.hollow {
            ("circles in a turn of the table are 2/5", 0.4)
        } else {
            ("circles in a turn of the table are 2/7", 2.0 / 7.0)
        };
        if exact.radius > 0.0 {
            let measured = self.turned / (self.flags.table * run.duration());
            let least = rounds * (1.0 - angle * angle / 12.0);
            claims.within(name, measured, least - 1e-9..=rounds + 1e-9, 6, "published; (hκ)²/12 less by the steps");
        } else {
            claims.skip(name, "the ball stays at the centre");
        }
    }
}

/// From one vector to another, to the left.
fn angle(from: Vector2<f64>, to: Vector2<f64>) -> f64 {
    from.perp(&to).atan2(from.dot(&to))
}
