//! The record of the motion while it runs, and the claims about it.

use crate::Flags;
use clebsch_examples::claims::Claims;
use clebsch_examples::energy_band::{EnergyBand, Terms};
use clebsch_examples::flags::Run;
use clebsch_examples::table::Table;
use nalgebra::Vector3;

/// Points of the figure.
const POINTS: u64 = 5000;
/// Intervals of the table.
const ROWS: u64 = 10;

/// One state.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Seconds.
    pub time: f64,
    /// Position.
    pub q: Vector3<f64>,
    /// Angular momentum.
    pub n: Vector3<f64>,
    /// ½|N|² + g z.
    pub energy: f64,
    /// g z.
    pub potential: f64,
}

impl Sample {
    /// The paper's energy |N|² + 2 g z, twice the physical one.
    pub fn papers_energy(&self) -> f64 {
        2.0 * self.energy
    }
}

/// Points of the path, and the largest defects of all states.
pub struct Watch {
    /// The motion at a few times.
    pub table: Table<7>,
    /// Points of the figure.
    pub samples: Vec<Sample>,
    run: Run,
    gravity: f64,
    start: Vector3<f64>,
    band: EnergyBand,
    heights: (f64, f64),
    largest_momentum: f64,
    normal_defect: f64,
    vertical_defect: f64,
    orbit_defect: f64,
}

impl Watch {
    /// Nothing observed yet.
    pub fn new(flags: &Flags) -> Self {
        Self {
            table: Table::new(["time / s", "q1", "q2", "q3", "N·q", "N3", "|N|² + 2 g q3"]),
            samples: Vec::new(),
            run: flags.run.clone(),
            gravity: flags.gravity,
            start: flags.momentum.into(),
            band: EnergyBand::new(&flags.run),
            heights: (f64::INFINITY, f64::NEG_INFINITY),
            largest_momentum: 0.0,
            normal_defect: 0.0,
            vertical_defect: 0.0,
            orbit_defect: 0.0,
        }
    }

    /// Takes the next state.
    pub fn observe(&mut self, step: u64, sample: Sample, orbit_defect: f64) {
        let Sample { time, q, n, energy, potential } = sample;
        self.band.observe(energy, potential, terms(self.gravity, &q, &n));
        self.heights = (self.heights.0.min(q.z), self.heights.1.max(q.z));
        self.largest_momentum = self.largest_momentum.max(n.norm());
        self.normal_defect = self.normal_defect.max(n.dot(&q).abs());
        self.vertical_defect = self.vertical_defect.max((n.z - self.start.z).abs());
        self.orbit_defect = self.orbit_defect.max(orbit_defect);
        if self.run.samples(step, POINTS) {
            self.samples.push(sample);
        }
        if self.run.samples(step, ROWS) {
            let [x, y, z] = [q.x, q.y, q.z].map(|entry| format!("{entry:.4}"));
            let energy = format!("{:.4}", sample.papers_energy());
            self.table.row([
                format!("{time:.2}"),
                x,
                y,
                z,
                format!("{:.1e}", n.dot(&q)),
                format!("{:.6}", n.z),
                energy,
            ]);
        }
    }

    /// Claims the conserved quantities, the band of the energy and the paper's figures.
    pub fn claim(&self, flags: &Flags, claims: &mut Claims) {
        let steps = self.run.steps;
        claims.round_off("N·q stays zero", self.normal_defect, steps, self.largest_momentum);
        claims.round_off("the vertical momentum N3 is constant", self.vertical_defect, steps, self.largest_momentum);
        claims.round_off("q stays on the sphere", self.orbit_defect, steps, 1.0);
        self.band.claim(claims);
        let (lowest, highest) = self.band.range();
        // Computed with 60 digits, rounded to three; these ranges fit the axes of the paper's figures.
        for (name, value, published) in [
            ("the least height is the paper's", self.heights.0, -0.994),
            ("the greatest height is the paper's", self.heights.1, 0.056),
            ("the least energy is the paper's", 2.0 * lowest, 1.068),
            ("the greatest energy is the paper's", 2.0 * highest, 1.631),
        ] {
            if flags.is_the_papers() {
                let reason = "rounded to three digits";
                claims.within(name, value, published - 5e-4..=published + 5e-4, 4, reason);
            } else {
                claims.skip(name, "other flags than the paper's");
            }
        }
    }
}

/// The terms of the modified energy, with T = ½|N|² and V = g z.
///
/// Free motion is a great circle: V̇ = g (N×q)·e₃, V̈ = −|N|² g z. The force has |τ|² = g²(1 − z²). The chord drift turns by
/// arcsin(h|N|), which is the free motion of T̃ with T̃′ = arcsin(h|N|)/h, T̃ = T + h²|N|⁴/24 + ….
fn terms(gravity: f64, q: &Vector3<f64>, n: &Vector3<f64>) -> Terms {
    let square = n.norm_squared();
    Terms {
        drift: square.powi(2) / 24.0,
        power: gravity * n.cross(q).z,
        power_rate: -square * gravity * q.z,
        kick: gravity.powi(2) * (1.0 - q.z * q.z),
        rate: square.sqrt().max(gravity.abs().sqrt()),
    }
}
