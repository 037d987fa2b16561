//! The record of the motion while it runs, and the claims about it.

use crate::manakov::{self, Integral};
use crate::start::{Start, planes};
use clebsch_examples::claims::{Claims, largest};
use clebsch_examples::conserved::Conserved;
use clebsch_examples::flags::Run;
use clebsch_examples::round_off;
use clebsch_examples::table::{Table, aligned};
use nalgebra::SMatrix;

/// States at which the integrals are computed, and points of the figure.
const SAMPLES: u64 = 1000;
/// Intervals of the table.
const ROWS: u64 = 10;
/// Radians that the body turns in the upper half of the figure, at the speed of the start, and points of it.
const SHOWN: f64 = 60.0;
const POINTS: f64 = 500.0;

/// One state.
#[derive(Clone, Debug)]
pub struct Sample {
    /// Seconds.
    pub time: f64,
    /// Changes since the start over their scales: spatial momentum, energy.
    pub changes: [f64; 2],
    /// The largest change of the integrals of degree 2, 4, … in M over their scales.
    pub integrals: Vec<f64>,
}

/// The motion, and the largest defects of all states.
pub struct Watch<const N: usize> {
    /// The conserved quantities, at a few times.
    pub table: Table<5>,
    /// Points of the figure.
    pub samples: Vec<Sample>,
    /// Seconds and M at the beginning.
    pub path: Vec<(f64, SMatrix<f64, N, N>)>,
    run: Run,
    d: SMatrix<f64, N, N>,
    momentum: SMatrix<f64, N, N>,
    /// Steps of the path, and how many of them lie between two of its points.
    shown: (u64, u64),
    momentum_defect: f64,
    orbit_defect: f64,
    energy: Conserved,
    integrals: Vec<Integral>,
    values: Vec<f64>,
    scales: Vec<f64>,
    independent: usize,
    /// The largest changes over their scales, of the integrals of degree 2, 4, ….
    integral_defects: Vec<f64>,
}

impl<const N: usize> Watch<N> {
    /// Nothing observed yet.
    pub fn new(run: &Run, start: &Start<N>) -> Self {
        let Start { j_d, momentum } = *start;
        let (d, integrals) = (manakov::squares(&j_d), manakov::all(N));
        let weights = planes(N).map(|(i, j)| 1.0 / (j_d[i] + j_d[j]));
        let steps = (SHOWN / start.rate() / run.step_size).ceil().clamp(1.0, run.steps as f64);
        Self {
            table: Table::new(["time / s", "spatial momentum", "energy", "Manakov's integrals", "|RᵀR − I|"]),
            samples: Vec::new(),
            path: Vec::new(),
            run: run.clone(),
            d,
            momentum,
            shown: (steps as u64, (steps / POINTS).ceil() as u64),
            momentum_defect: 0.0,
            orbit_defect: 0.0,
            energy: Conserved::new("the energy is constant", weights.fold(0.0, f64::max) * momentum.norm_squared()),
            values: manakov::values(&integrals, &momentum, &d),
            scales: manakov::scales(&integrals, &momentum, &d),
            independent: manakov::independent(&integrals, &momentum, &d),
            integrals,
            integral_defects: vec![0.0; N / 2],
        }
    }

    /// Takes the next state; `m` is the body momentum as a matrix.
    pub fn observe(
        &mut self,
        step: u64,
        time: f64,
        attitude: &SMatrix<f64, N, N>,
        m: &SMatrix<f64, N, N>,
        energy: f64,
        orbit_defect: f64,
    ) {
        let moved = (attitude * m * attitude.transpose() - self.momentum).amax();
        self.momentum_defect = largest([self.momentum_defect, moved]);
        self.orbit_defect = largest([self.orbit_defect, orbit_defect]);
        let changes = [relative(moved, self.momentum.norm()), self.energy.observe(energy)];
        let (shown, spacing) = self.shown;
        if step <= shown && step.is_multiple_of(spacing) {
            self.path.push((time, *m));
        }
        if !self.run.samples(step, SAMPLES) && !self.run.samples(step, ROWS) {
            return;
        }
        let integrals = self.changes(m);
        self.integral_defects.iter_mut().zip(&integrals).for_each(|(most, now)| *most = largest([*most, *now]));
        if self.run.samples(step, ROWS) {
            let [momentum, energy] = changes.map(|change| format!("{:.1e}", change.abs()));
            let integral = format!("{:.1e}", largest(integrals.iter().copied()));
            self.table.row([format!("{time:.2}"), momentum, energy, integral, format!("{orbit_defect:.1e}")]);
        }
        self.samples.push(Sample { time, changes, integrals });
    }

    /// The largest changes of the integrals of each degree over their scales.
    fn changes(&self, m: &SMatrix<f64, N, N>) -> Vec<f64> {
        let mut changes = vec![0.0; N / 2];
        let values = manakov::values(&self.integrals, m, &self.d);
        for (index, integral) in self.integrals.iter().enumerate() {
            let change = relative((values[index] - self.values[index]).abs(), self.scales[index]);
            let most = &mut changes[integral.degree / 2 - 1];
            *most = largest([*most, change]);
        }
        changes
    }

    /// How many integrals there are and how far each degree of them has moved, as a table.
    pub fn integrals(&self) -> String {
        let count = self.integrals.len();
        let heading = ["degree in M", "integrals", "largest change", "in units of ε √steps"].map(str::to_owned);
        let rows = self.integral_defects.iter().enumerate().map(|(index, &defect)| {
            let (degree, walks) = (2 * index + 2, round_off::in_random_walks(defect, self.run.steps, 1.0));
            [degree.to_string(), (N + 1 - degree).to_string(), format!("{defect:.1e}"), format!("{walks:.2}")]
        });
        let table = aligned(std::iter::once(heading).chain(rows));
        let (independent, casimirs) = (self.independent, N / 2);
        format!(
            "{count} integrals, {independent} of them independent at the start; {casimirs} are Casimirs, one of each degree\n\n{table}"
        )
    }

    /// Claims everything that the body conserves.
    pub fn claim(&self, claims: &mut Claims) {
        let steps = self.run.steps;
        let name = "the spatial momentum R M Rᵀ is constant";
        claims.round_off(name, self.momentum_defect, steps, 2.0 * self.momentum.norm());
        claims.round_off("the attitude stays a rotation", self.orbit_defect, steps, 1.0);
        self.energy.claim(steps, claims);
        for (index, &defect) in self.integral_defects.iter().enumerate() {
            let degree = 2 * index + 2;
            let name = match N + 1 - degree {
                1 => format!("the integral of degree {degree} in M is constant"),
                count => format!("the {count} integrals of degree {degree} in M are constant"),
            };
            claims.round_off(&name, defect, steps, 1.0);
        }
        let (name, count) = (format!("{} integrals are independent", self.integrals.len()), self.independent);
        if count == self.integrals.len() {
            claims.holds(&name, true, "the rank of their gradients at the start");
        } else {
            claims.skip(&name, &format!("{count} are: this body, or this motion, has symmetries"));
        }
    }
}

/// A change over its scale; 0 where there is nothing to change.
fn relative(change: f64, scale: f64) -> f64 {
    if scale > 0.0 { change / scale } else { change }
}
