//! The record of the motion while it runs, and the claims about it.

use crate::{Flags, geodesic};
use clebsch::Conserved;
use clebsch_examples::claims::Claims;
use clebsch_examples::energy_band::{EnergyBand, Terms};
use clebsch_examples::flags::Run;
use clebsch_examples::table::Table;
use nalgebra::{Matrix3, SVector, Vector3};

/// Points of the figure.
const POINTS: u64 = 2000;
/// Intervals of the table.
const ROWS: u64 = 10;

/// One state.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Seconds.
    pub time: f64,
    /// Semi-axes, the longest first.
    pub semi_axes: Vector3<f64>,
    /// The direction of the longest.
    pub longest: Vector3<f64>,
    /// The largest change of angular momentum and of circulation, kg·m²/s.
    pub changes: [f64; 2],
}

/// Points of the path, and the largest defects of all states.
pub struct Watch {
    /// The motion at a few times.
    pub table: Table<6>,
    /// Points of the figure, the first state first.
    pub samples: Vec<Sample>,
    run: Run,
    mass: f64,
    /// Angular momentum and circulation of the start, by hand.
    expected: [f64; 6],
    names: [&'static str; 6],
    defects: [f64; 6],
    /// By how much a rounding of F or N, relative, moves each half of them.
    scales: [f64; 2],
    band: EnergyBand,
    energy: Option<f64>,
    rate: f64,
    volume_defect: f64,
    volume_scale: f64,
}

impl Watch {
    /// Nothing observed yet.
    pub fn new(flags: &Flags, q: &Matrix3<f64>, velocity: &Matrix3<f64>) -> Self {
        Self {
            table: Table::new(["time / s", "longest", "middle", "shortest", "det q − 1", "energy, change / J"]),
            samples: Vec::new(),
            run: flags.run.clone(),
            mass: flags.mass,
            expected: geodesic::momenta(flags.mass, q, velocity),
            names: [""; 6],
            defects: [0.0; 6],
            scales: [0.0; 2],
            band: EnergyBand::new(&flags.run),
            energy: None,
            rate: 0.0,
            volume_defect: 0.0,
            volume_scale: 0.0,
        }
    }

    /// Takes the next state.
    pub fn observe(
        &mut self,
        step: u64,
        time: f64,
        q: &Matrix3<f64>,
        momentum: &SVector<f64, 8>,
        energy: f64,
        conserved: &Conserved<f64, 6>,
    ) {
        let (volume, inverse) = (q.determinant() - 1.0, q.try_inverse().unwrap_or_else(|| Matrix3::repeat(f64::NAN)));
        let velocity = geodesic::velocity(self.mass, q, momentum);
        let rate = (inverse * velocity).norm();
        let acceleration = geodesic::acceleration(q, &velocity);
        // Chords of a geodesic of curvature κ: |Δq|² = d²(1 − κ²d²/12), so that the steps are the free motion of T + h² m|q̈|²/24.
        let drift = self.mass * acceleration.norm_squared() / 24.0;
        self.band.observe(energy, 0.0, Terms { drift, power: 0.0, power_rate: 0.0, kick: 0.0, rate });
        self.rate = self.rate.max(rate);
        self.names = *conserved.names();
        let mut changes = [0.0_f64; 6];
        for (index, change) in changes.iter_mut().enumerate() {
            *change = (conserved[index] - self.expected[index]).abs();
            self.defects[index] = self.defects[index].max(*change);
        }
        let condition = q.norm() * inverse.norm();
        let rounding = geodesic::rounding(self.mass, q, &velocity) / f64::EPSILON;
        self.scales[0] = self.scales[0].max(momentum.norm() + rounding);
        self.scales[1] = self.scales[1].max((momentum.norm() + rounding) * condition);
        self.band.rounds_like(rounding * (velocity * inverse).norm());
        self.volume_defect = self.volume_defect.max(volume.abs());
        self.volume_scale = self.volume_scale.max(condition);

        let start = *self.energy.get_or_insert(energy);
        if self.run.samples(step, POINTS) {
            let largest = |half: &[f64]| half.iter().fold(0.0, |largest: f64, change| largest.max(*change));
            let (semi_axes, longest) = shape(q);
            let changes = [largest(&changes[..3]), largest(&changes[3..])];
            self.samples.push(Sample { time, semi_axes, longest, changes });
        }
        if self.run.samples(step, ROWS) {
            let [a, b, c] = <[f64; 3]>::from(shape(q).0).map(|axis| format!("{axis:.5}"));
            self.table.row([format!("{time:.2}"), a, b, c, format!("{volume:.1e}"), format!("{:.1e}", energy - start)]);
        }
    }

    /// The fastest rate |q⁻¹q̇| of the motion, 1/s.
    pub fn rate(&self) -> f64 {
        self.rate
    }

    /// Claims that the macro's six momenta are angular momentum and circulation as written by hand, and stay.
    pub fn claim(&self, claims: &mut Claims) {
        let steps = self.run.steps;
        for (index, (name, defect)) in self.names.iter().zip(self.defects).enumerate() {
            let (what, scale) =
                if index < 3 { ("angular momentum", self.scales[0]) } else { ("circulation", self.scales[1]) };
            claims.round_off(&format!("the {what} {name}, stays that of the start"), defect, steps, scale);
        }
        claims.round_off("det q stays 1", self.volume_defect, steps, self.volume_scale);
        self.band.claim(claims);
    }
}

/// Semi-axes from long to short, and the direction of the longest: the eigenvalues of q qᵀ are their squares.
fn shape(q: &Matrix3<f64>) -> (Vector3<f64>, Vector3<f64>) {
    let eigen = (q * q.transpose()).symmetric_eigen();
    let mut order = [0, 1, 2];
    order.sort_by(|&i, &j| eigen.eigenvalues[j].total_cmp(&eigen.eigenvalues[i]));
    let semi_axes = Vector3::from(order.map(|index| eigen.eigenvalues[index].max(0.0).sqrt()));
    (semi_axes, eigen.eigenvectors.column(order[0]).into())
}
