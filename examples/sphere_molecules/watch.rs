//! The record of the molecules while they move, and the claims about them.

use crate::{Cloud, Many};
use clebsch::SiteError;
use clebsch_examples::claims::{Claims, largest};
use clebsch_examples::flags::{Order, Run};
use clebsch_examples::round_off;
use clebsch_examples::table::Table;
use nalgebra::Vector3;

/// Points of the figure.
const POINTS: u64 = 800;
/// Intervals of the table.
const ROWS: u64 = 10;
/// Molecules whose paths are drawn.
pub const DRAWN: usize = 5;

/// Points of the figure, and the largest defects.
pub struct Watch {
    /// The molecules at a few times.
    pub table: Table<5>,
    /// Paths of some molecules.
    pub paths: [Vec<[f64; 3]>; DRAWN],
    /// Time and kinetic energy of a molecule.
    pub kinetic: Vec<(f64, f64)>,
    /// Time and change of the energy of a molecule.
    pub changes: Vec<(f64, f64)>,
    run: Run,
    start: Option<(Vector3<f64>, f64)>,
    momentum_defect: f64,
    length_defect: f64,
    energy_defects: [f64; 2],
    /// Sums of the sizes of momenta and energies.
    scales: [f64; 2],
}

impl Watch {
    /// Nothing observed yet.
    pub fn new(run: &Run) -> Self {
        Self {
            table: Table::new(["time / s", "|L|", "kinetic energy", "energy", "its change"]),
            paths: Default::default(),
            kinetic: Vec::new(),
            changes: Vec::new(),
            run: run.clone(),
            start: None,
            momentum_defect: 0.0,
            length_defect: 0.0,
            energy_defects: [0.0; 2],
            scales: [0.0; 2],
        }
    }

    /// Whether this step is looked at.
    pub fn looks_at(&self, step: u64) -> bool {
        self.run.samples(step, POINTS) || self.run.samples(step, ROWS)
    }

    /// Looks at the molecules after a step, and at those of half the step size at the same time.
    ///
    /// # Errors
    /// None of a cloud that has been made.
    pub fn observe<S: Cloud<N>, const N: usize>(
        &mut self,
        step: u64,
        molecules: &Many<S, N>,
        halved: &Many<S, N>,
    ) -> Result<[f64; 5], SiteError> {
        let time = self.run.time(step);
        let (q, mu) = (molecules.configuration(), molecules.momentum());
        let conserved = molecules.conserved()?;
        let total = Vector3::new(conserved[0], conserved[1], conserved[2]);
        let energy = molecules.energy()?;
        let kinetic = mu.iter().map(Vector3::norm_squared).sum::<f64>() / 2.0;
        let (total_at_start, energy_at_start) = *self.start.get_or_insert((total, energy));
        self.momentum_defect = self.momentum_defect.max((total - total_at_start).amax());
        self.length_defect = largest(q.iter().map(|q| (q.norm() - 1.0).abs()).chain([self.length_defect]));
        // kicks of neighbours are as large as the potential between them is steep
        let sizes = [mu.iter().map(Vector3::norm).sum::<f64>(), kinetic + (energy - kinetic).abs()];
        for (scale, size) in self.scales.iter_mut().zip(sizes) {
            *scale = scale.max(size);
        }
        let changes = [energy, halved.energy()?].map(|energy| energy - energy_at_start);
        for (defect, change) in self.energy_defects.iter_mut().zip(changes) {
            *defect = defect.max(change.abs());
        }
        if self.run.samples(step, POINTS) {
            self.kinetic.push((time, kinetic / N as f64));
            self.changes.push((time, changes[0] / N as f64));
            for (path, number) in self.paths.iter_mut().zip(0..) {
                path.push(q[number * N / DRAWN].into());
            }
        }
        if self.run.samples(step, ROWS) {
            let [size, kinetic, energy] = [total.norm(), kinetic, energy].map(|x| format!("{x:.6}"));
            self.table.row([format!("{time:.1}"), size, kinetic, energy, format!("{:.1e}", changes[0])]);
        }
        Ok([total.x, total.y, total.z, kinetic, energy - kinetic])
    }

    /// Claims the common conserved quantities of all molecules, and the band of the energy.
    pub fn claim(&self, sites: usize, claims: &mut Claims) {
        let steps = self.run.steps;
        let scale = self.scales[0] + sites as f64 * self.scales[1] * self.run.step_size;
        claims.round_off("the angular momentum of all molecules is constant", self.momentum_defect, steps, scale);
        let reason = "rounding is taken off at once";
        claims.at_most("all molecules stay on the sphere", self.length_defect, 8.0 * f64::EPSILON, reason);
        let [whole, half] = self.energy_defects;
        let (name, ratio) = match self.run.order {
            Order::First => ("halved steps keep the energy twice as near", 1.75..=2.25),
            Order::Second => ("halved steps keep the energy four times nearer", 3.5..=4.5),
        };
        if half > 10.0 * round_off::worst_case(steps, self.scales[1]) {
            claims.within(name, whole / half, ratio, 3, "as the order says: the largest change over the run");
        } else {
            claims.at_most(name, whole, 1e-3 * self.scales[1], "too little motion for the order to show");
        }
    }
}
