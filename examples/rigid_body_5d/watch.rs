//! The record of the motion while it runs, and the claims about it.

use crate::Flags;
use crate::euler::velocity;
use crate::invariants::{NAMES, PLANES, integrals, scales, skew, traces};
use clebsch_examples::claims::Claims;
use clebsch_examples::conserved::Conserved;
use clebsch_examples::flags::Run;
use clebsch_examples::table::Table;
use nalgebra::Matrix5;

/// Points of the figure.
const POINTS: u64 = 4000;
/// Intervals of the table.
const ROWS: u64 = 10;
/// Seconds of the momentum in the figure: angles turned at the initial velocity, rad.
const SHOWN: f64 = 60.0;

/// One state.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Seconds.
    pub time: f64,
    /// Changes since the start over their scales: spatial momentum, energy, a quadratic and a quartic integral of Manakov's.
    pub changes: [f64; 4],
}

/// The motion, and the largest defects of all states.
pub struct Watch {
    /// The motion at a few times.
    pub table: Table<6>,
    /// Points of the figure.
    pub samples: Vec<Sample>,
    /// Seconds and the entries of M above the diagonal at the beginning, step by step.
    pub path: Vec<(f64, [f64; 10])>,
    run: Run,
    j_d: [f64; 5],
    momentum: Matrix5<f64>,
    shown: f64,
    last_attitude: Option<Matrix5<f64>>,
    momentum_defect: f64,
    orbit_defect: f64,
    energy: Conserved,
    integrals: [Conserved; 6],
    traces: [Conserved; 4],
}

impl Watch {
    /// Nothing observed yet.
    pub fn new(flags: &Flags) -> Self {
        let j_d = flags.j_d;
        let momentum = skew(&flags.momentum);
        let scales = scales(&momentum, &j_d);
        let weights = PLANES.map(|(i, j)| 1.0 / (j_d[i] + j_d[j]));
        let sizes = j_d.map(f64::abs);
        let (sum, largest) = (sizes.into_iter().sum::<f64>(), sizes.into_iter().fold(0.0, f64::max));
        // tr Aᵏ moves by k tr(Aᵏ⁻¹ δA), and A = F J_d turns no vector into one that is longer than `largest` times it
        let trace = |k: i32, name| Conserved::new(name, f64::from(k) * largest.powi(k - 1) * sum);
        Self {
            table: Table::new(["time / s", "M12", "M13", "M45", "energy / J", "spatial momentum, change"]),
            samples: Vec::new(),
            path: Vec::new(),
            run: flags.run.clone(),
            j_d,
            momentum,
            shown: SHOWN / velocity(&momentum, &j_d).norm(),
            last_attitude: None,
            momentum_defect: 0.0,
            orbit_defect: 0.0,
            energy: Conserved::new(
                "the energy is constant",
                weights.into_iter().fold(0.0, f64::max) * momentum.norm_squared(),
            ),
            integrals: std::array::from_fn(|i| Conserved::new(NAMES[i], scales[i])),
            traces: [
                trace(1, "tr(F J_d) is constant"),
                trace(2, "tr(F J_d)² is constant"),
                trace(3, "tr(F J_d)³ is constant"),
                trace(4, "tr(F J_d)⁴ is constant"),
            ],
        }
    }

    /// Takes the next state; `m` is the body momentum as a matrix.
    pub fn observe(
        &mut self,
        step: u64,
        time: f64,
        attitude: &Matrix5<f64>,
        m: &Matrix5<f64>,
        energy: f64,
        orbit_defect: f64,
    ) {
        let moved = (attitude * m * attitude.transpose() - self.momentum).amax();
        self.momentum_defect = self.momentum_defect.max(moved);
        self.orbit_defect = self.orbit_defect.max(orbit_defect);
        if let Some(last) = self.last_attitude.replace(*attitude) {
            // R⁺ = R F
            let values = traces(&(last.transpose() * attitude), &self.j_d);
            self.traces.iter_mut().zip(values).for_each(|(trace, value)| _ = trace.observe(value));
        }
        let values = integrals(m, &self.j_d);
        let changed: [f64; 6] = std::array::from_fn(|i| self.integrals[i].observe(values[i]));
        let relative = moved / self.momentum.norm().max(f64::MIN_POSITIVE);
        let changes = [relative, self.energy.observe(energy), changed[1], changed[5]];
        if self.run.samples(step, POINTS) {
            self.samples.push(Sample { time, changes });
        }
        if time <= self.shown && self.path.len() < POINTS as usize {
            self.path.push((time, PLANES.map(|plane| m[plane])));
        }
        if self.run.samples(step, ROWS) {
            let [m12, m13, m45] = [(0, 1), (0, 2), (3, 4)].map(|plane| format!("{:.5}", m[plane]));
            self.table.row([format!("{time:.2}"), m12, m13, m45, format!("{energy:.12}"), format!("{moved:.1e}")]);
        }
    }

    /// Claims everything that the body conserves.
    pub fn claim(&self, claims: &mut Claims) {
        let steps = self.run.steps;
        let name = "the spatial momentum R M Rᵀ is constant";
        claims.round_off(name, self.momentum_defect, steps, 2.0 * self.momentum.norm());
        claims.round_off("the attitude stays a rotation", self.orbit_defect, steps, 1.0);
        for quantity in [self.energy].iter().chain(&self.integrals).chain(&self.traces) {
            quantity.claim(steps, claims);
        }
    }
}
