//! The record of the motion while it runs, and the claims about it.

use crate::Flags;
use crate::invariants::{Invariants, PLANES, halves, skew};
use clebsch_examples::claims::Claims;
use clebsch_examples::conserved::Conserved;
use clebsch_examples::flags::Run;
use clebsch_examples::table::Table;
use nalgebra::Matrix4;

/// Points of the figure.
const POINTS: u64 = 6000;
/// Intervals of the table.
const ROWS: u64 = 10;

/// One state.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Seconds.
    pub time: f64,
    /// The self-dual and the anti-self-dual part of M, as unit vectors; zero where there is none.
    pub halves: [[f64; 3]; 2],
    /// Changes since the start over their scales: spatial momentum, energy, Manakov's two integrals.
    pub changes: [f64; 4],
}

/// Points of the path, and the largest defects of all states.
pub struct Watch {
    /// The motion at a few times.
    pub table: Table<6>,
    /// Points of the figure.
    pub samples: Vec<Sample>,
    run: Run,
    j_d: [f64; 4],
    momentum: Matrix4<f64>,
    last_attitude: Option<Matrix4<f64>>,
    momentum_defect: f64,
    orbit_defect: f64,
    energy: Conserved,
    square: Conserved,
    pfaffian: Conserved,
    manakov_sum: Conserved,
    manakov_product: Conserved,
    trace: Conserved,
}

impl Watch {
    /// Nothing observed yet.
    pub fn new(flags: &Flags) -> Self {
        let j_d = flags.j_d;
        let momentum = skew(&flags.momentum);
        // A quadratic form Σ w_ij m_ij² moves by up to 2 max|w| |M|² times the relative error of M.
        let largest =
            |weight: fn(f64, f64) -> f64| PLANES.map(|(i, j)| weight(j_d[i], j_d[j])).into_iter().fold(0.0, f64::max);
        let form = |weight: fn(f64, f64) -> f64| largest(weight) * momentum.norm_squared();
        Self {
            table: Table::new(["time / s", "M12", "M13", "M14", "energy / J", "spatial momentum, change"]),
            samples: Vec::new(),
            run: flags.run.clone(),
            j_d,
            momentum,
            last_attitude: None,
            momentum_defect: 0.0,
            orbit_defect: 0.0,
            energy: Conserved::new("the energy is constant", form(|a, b| 1.0 / (a + b))),
            square: Conserved::new("|M|² is constant", form(|_, _| 1.0)),
            pfaffian: Conserved::new("the Pfaffian of M is constant", form(|_, _| 1.0)),
            manakov_sum: Conserved::new("Σ m_ij² (d_k + d_l) is constant", form(|a, b| a * a + b * b)),
            manakov_product: Conserved::new("Σ m_ij² d_k d_l is constant", form(|a, b| a * a * b * b)),
            trace: Conserved::new("tr(F J_d) is constant", j_d.iter().map(|entry| entry.abs()).sum()),
        }
    }

    /// Takes the next state; `m` is the body momentum as a matrix.
    pub fn observe(
        &mut self,
        step: u64,
        time: f64,
        attitude: &Matrix4<f64>,
        m: &Matrix4<f64>,
        energy: f64,
        orbit_defect: f64,
    ) {
        let moved = (attitude * m * attitude.transpose() - self.momentum).amax();
        self.momentum_defect = self.momentum_defect.max(moved);
        self.orbit_defect = self.orbit_defect.max(orbit_defect);
        if let Some(last) = self.last_attitude.replace(*attitude) {
            // R⁺ = R F
            let f = last.transpose() * attitude;
            self.trace.observe((0..4).map(|i| f[(i, i)] * self.j_d[i]).sum());
        }
        let invariants = Invariants::new(m, &self.j_d);
        self.square.observe(invariants.square);
        self.pfaffian.observe(invariants.pfaffian);
        let changes = [
            if invariants.square > 0.0 { moved / self.momentum.norm() } else { 0.0 },
            self.energy.observe(energy),
            self.manakov_sum.observe(invariants.manakov_sum),
            self.manakov_product.observe(invariants.manakov_product),
        ];
        if self.run.samples(step, POINTS) {
            self.samples.push(Sample { time, halves: halves(m).map(unit), changes });
        }
        if self.run.samples(step, ROWS) {
            let [m12, m13, m14] = [(0, 1), (0, 2), (0, 3)].map(|plane| format!("{:.5}", m[plane]));
            self.table.row([format!("{time:.2}"), m12, m13, m14, format!("{energy:.12}"), format!("{moved:.1e}")]);
        }
    }

    /// Claims everything that the body conserves.
    pub fn claim(&self, claims: &mut Claims) {
        let steps = self.run.steps;
        let name = "the spatial momentum R M Rᵀ is constant";
        claims.round_off(name, self.momentum_defect, steps, 2.0 * self.momentum.norm());
        claims.round_off("the attitude stays a rotation", self.orbit_defect, steps, 1.0);
        for quantity in [self.energy, self.square, self.pfaffian, self.manakov_sum, self.manakov_product, self.trace] {
            quantity.claim(steps, claims);
        }
    }
}

fn unit(vector: [f64; 3]) -> [f64; 3] {
    let length = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
    if length > 0.0 { vector.map(|x| x / length) } else { vector }
}
