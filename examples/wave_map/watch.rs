//! The record of the field while it moves, and the claims about it.

use crate::sheet::{Start, Steps};
use clebsch_examples::claims::{Claims, largest};
use clebsch_examples::flags::Run;
use clebsch_examples::integrate::{FieldOf, integrate_field};
use clebsch_examples::round_off;
use clebsch_examples::scene::Failure;
use clebsch_examples::table::Table;
use nalgebra::Vector3;

/// Points of the curves.
const POINTS: u64 = 200;
/// Intervals of the table.
const ROWS: u64 = 8;
/// Pictures of the field.
pub const PICTURES: u64 = 4;

/// One run.
pub struct Watch {
    /// The field at a few times.
    pub table: Table<5>,
    /// The field at its pictures.
    pub pictures: Vec<(f64, Vec<Vector3<f64>>)>,
    /// Time, change of the energy over the energy.
    pub energies: Vec<(f64, f64)>,
    run: Run,
    start: Option<(f64, Vector3<f64>)>,
    momentum_defect: f64,
    momentum_scale: f64,
    length_defect: f64,
    energy_defect: f64,
}

impl Watch {
    /// Steps a field to the end of the run. `record` gets energy, momentum and the sites of some states.
    ///
    /// # Errors
    /// Those of steps, and of `record`.
    pub fn of(
        run: &Run,
        stepper: &Steps,
        start: Start,
        mut record: impl FnMut(u64, f64, f64, Vector3<f64>, &[Vector3<f64>]) -> Result<(), Failure>,
    ) -> Result<Self, Failure> {
        let mut watch = Self {
            table: Table::new(["time / s", "energy", "its change / 1e-3", "momentum L3", "largest turn / °"]),
            pictures: Vec::new(),
            energies: Vec::new(),
            run: run.clone(),
            start: None,
            momentum_defect: 0.0,
            momentum_scale: 0.0,
            length_defect: 0.0,
            energy_defect: 0.0,
        };
        let mut state = stepper.state(start.0, start.1)?;
        let is_seen =
            |step: u64| run.writes(step) || [POINTS, ROWS, PICTURES - 1].iter().any(|&count| run.samples(step, count));
        integrate_field(run, stepper, &mut state, is_seen, |step, time, state| {
            let energy = stepper.energy(state).map_err(Failure::step(step))?;
            let momenta = stepper.conserved(state).map_err(Failure::step(step))?;
            let total = Vector3::new(momenta[0], momenta[1], momenta[2]);
            record(step, time, energy, total, state.configuration())?;
            watch.observe(step, time, energy, total, state);
            Ok(())
        })?;
        Ok(watch)
    }

    fn observe(
        &mut self,
        step: u64,
        time: f64,
        energy: f64,
        total: Vector3<f64>,
        state: &FieldOf<crate::sheet::WaveMap>,
    ) {
        let (q, mu) = (state.configuration(), state.momentum());
        let (first, total_at_start) = *self.start.get_or_insert((energy, total));
        let change = if first > 0.0 { energy / first - 1.0 } else { 0.0 };
        self.energy_defect = largest([self.energy_defect, change.abs()]);
        self.momentum_defect = largest([self.momentum_defect, (total - total_at_start).amax()]);
        self.momentum_scale = self.momentum_scale.max(mu.iter().map(Vector3::norm).sum());
        self.length_defect = largest(q.iter().map(|q| (q.norm() - 1.0).abs()).chain([self.length_defect]));
        if self.run.samples(step, POINTS) {
            self.energies.push((time, change));
        }
        if self.run.samples(step, PICTURES - 1) {
            self.pictures.push((time, q.clone()));
        }
        if self.run.samples(step, ROWS) {
            let turn = q.iter().map(|q| q.z.clamp(-1.0, 1.0).acos()).fold(0.0, f64::max).to_degrees();
            self.table.row([
                format!("{time:.2}"),
                format!("{energy:.4}"),
                format!("{:.4}", change * 1e3),
                format!("{:.6}", total.z),
                format!("{turn:.2}"),
            ]);
        }
    }

    /// Claims the local law: in a step each site gains the flow over its edges.
    ///
    /// # Errors
    /// Those of steps.
    pub fn claim_local(run: &Run, stepper: &Steps, start: Start, claims: &mut Claims) -> Result<(), Failure> {
        let spacing = stepper.lattice().spacings();
        let mut residuals = vec![[0.0; 3]; start.0.len()];
        let mut state = stepper.state(start.0, start.1)?;
        let (mut residual, mut momentum) = (0.0, 0.0_f64);
        for step in 1..=run.steps {
            stepper.step_with_residuals(&mut state, &mut residuals).map_err(Failure::step(step))?;
            residual = largest(residuals.iter().flatten().map(|residual| residual.abs()).chain([residual]));
            momentum = state.momentum().iter().map(|mu| mu.amax()).fold(momentum, f64::max);
        }
        // four edges push a site with forces up to 1/dx²
        let scale = momentum + 4.0 * run.step_size / spacing[0].powi(2);
        let reason = "rounding in one step";
        claims.at_most("local law of the momenta at every site", residual, round_off::worst_case(1, scale), reason);
        Ok(())
    }

    /// Claims about the run, and about one with half the step.
    pub fn claim(&self, halved: &Self, claims: &mut Claims) {
        let steps = self.run.steps;
        let name = "the total momentum stays, three numbers";
        claims.round_off(name, self.momentum_defect, steps, self.momentum_scale);
        let name = "vectors keep the length 1";
        claims.at_most(name, self.length_defect, 8.0 * f64::EPSILON, "rounding is taken off at once");
        let name = "half the step, a quarter of the change of the energy";
        let (one, half) = (self.energy_defect, halved.energy_defect);
        if half > 10.0 * round_off::worst_case(2 * steps, 1.0) {
            claims.within(name, one / half, 3.5..=4.5, 3, &format!("the change with h is {one:.1e} of the energy"));
        } else {
            claims.skip(name, "too little motion for the order to show");
        }
    }
}
