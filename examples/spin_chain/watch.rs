//! The record of the ring while it moves, and the claims about it.

use crate::{Flags, Ring, Spins};
use clebsch::SiteError;
use clebsch_examples::claims::{Claims, largest};
use clebsch_examples::flags::{Order, Run};
use clebsch_examples::round_off;
use clebsch_examples::table::Table;
use nalgebra::Vector3;

/// Times and sites of the picture.
const CELLS: (u64, usize) = (80, 64);
/// Points of the curve.
const POINTS: u64 = 800;
/// Intervals of the table.
const ROWS: u64 = 10;

/// Points of the figure, and the largest defects.
pub struct Watch {
    /// The ring at a few times.
    pub table: Table<5>,
    /// q₃ of some sites at some times.
    pub picture: Vec<(f64, Vec<f64>)>,
    /// Time and relative change of the energy.
    pub energies: Vec<(f64, f64)>,
    run: Run,
    /// The third component alone is conserved in a field.
    conserved: usize,
    start: Option<(Vector3<f64>, f64)>,
    momentum_defect: f64,
    length_defect: f64,
    energy_defects: [f64; 2],
    scale: f64,
}

impl Watch {
    /// Nothing observed yet.
    pub fn new(run: &Run, field: f64) -> Self {
        Self {
            table: Table::new(["time / s", "mean q3", "mean N3", "energy of a spin", "its change"]),
            picture: Vec::new(),
            energies: Vec::new(),
            run: run.clone(),
            conserved: if field == 0.0 { 0 } else { 2 },
            start: None,
            momentum_defect: 0.0,
            length_defect: 0.0,
            energy_defects: [0.0; 2],
            scale: 0.0,
        }
    }

    /// Whether this step is looked at.
    pub fn looks_at(&self, step: u64) -> bool {
        [POINTS, ROWS, CELLS.0].iter().any(|&count| self.run.samples(step, count))
    }

    /// Looks at the ring after a step, and at that of half the step size at the same time.
    ///
    /// # Errors
    /// None of a ring that has been made.
    pub fn observe<S: Spins<N>, const N: usize>(
        &mut self,
        step: u64,
        spins: &Ring<S, N>,
        halved: &Ring<S, N>,
    ) -> Result<[f64; 7], SiteError> {
        let (time, sites) = (self.run.time(step), N as f64);
        let (q, mu) = (spins.configuration(), spins.momentum());
        let total: Vector3<f64> = mu.iter().sum();
        let energy = spins.energy()?;
        let (total_at_start, energy_at_start) = *self.start.get_or_insert((total, energy));
        let moved = (total - total_at_start).rows_range(self.conserved..).amax();
        self.momentum_defect = self.momentum_defect.max(moved);
        self.scale = self.scale.max(mu.iter().map(Vector3::norm).sum());
        self.length_defect = largest(q.iter().map(|q| (q.norm() - 1.0).abs()).chain([self.length_defect]));
        let changes = [energy - energy_at_start, halved.energy()? - energy_at_start].map(f64::abs);
        for (defect, change) in self.energy_defects.iter_mut().zip(changes) {
            *defect = defect.max(change);
        }
        let mean = q.iter().sum::<Vector3<f64>>() / sites;
        let change = (energy - energy_at_start) / sites;
        if self.run.samples(step, POINTS) {
            self.energies.push((time, change));
        }
        if self.run.samples(step, CELLS.0) {
            let some = (0..N).step_by(N.div_ceil(CELLS.1)).map(|i| q[i].z).collect();
            self.picture.push((time, some));
        }
        if self.run.samples(step, ROWS) {
            let [height, momentum] = [mean.z, total.z / sites].map(|x| format!("{x:.6}"));
            self.table.row([
                format!("{time:.1}"),
                height,
                momentum,
                format!("{:.6}", energy / sites),
                format!("{change:.1e}"),
            ]);
        }
        let momentum = total / sites;
        Ok([mean.x, mean.y, mean.z, momentum.x, momentum.y, momentum.z, energy / sites])
    }

    /// Claims the common conserved quantities of all spins, and the band of the energy.
    pub fn claim(&self, flags: &Flags, sites: usize, claims: &mut Claims) {
        let steps = self.run.steps;
        let name = match self.conserved {
            0 => "the sum of the momenta is constant, as no field acts",
            _ => "the sum of the momenta along the field is constant",
        };
        claims.round_off(name, self.momentum_defect, steps, self.scale.max(sites as f64));
        claims.at_most(
            "all spins keep their length",
            self.length_defect,
            8.0 * f64::EPSILON,
            "rounding is taken off at once",
        );
        let [whole, half] = self.energy_defects;
        let rounding = round_off::worst_case(steps, sites as f64 * (1.0 + flags.exchange.abs() + flags.field.abs()));
        let (name, ratio) = match self.run.order {
            Order::First => ("halved steps keep the energy twice as near", 1.75..=2.25),
            Order::Second => ("halved steps keep the energy four times nearer", 3.5..=4.5),
        };
        if half > 10.0 * rounding {
            claims.within(name, whole / half, ratio, 3, "as the order says: the largest change over the run");
        } else {
            claims.at_most(name, whole, 4.5 * half + rounding, "too little motion for the order to show");
        }
    }
}
