//! The record of the cloud while it tumbles, and the claims about it.

use crate::euler::Euler;
use crate::{Flags, Rock};
use clebsch::{Clebsch, Ensemble, F64x8};
use clebsch_examples::claims::{Claims, largest};
use clebsch_examples::flags::Run;
use clebsch_examples::round_off;
use clebsch_examples::scene::Failure;
use clebsch_examples::table::Table;
use nalgebra::Vector3;

/// Points of the figure.
const POINTS: u64 = 1500;
/// Intervals of the table.
const ROWS: u64 = 10;
/// Bodies whose curves are drawn: those that share one register.
pub const DRAWN: usize = 8;
/// The most bodies that are also stepped alone.
const ALONE: usize = 200;

/// The cloud at one time. Spins are π₂/|π|.
#[derive(Clone, Debug)]
pub struct Sample {
    /// Seconds.
    pub time: f64,
    /// The mean spin.
    pub mean: f64,
    /// The mean spin of the exact motion.
    pub exact: f64,
    /// The spins of the first bodies.
    pub drawn: Vec<f64>,
}

/// Points of the figure, and the largest defects of all bodies.
pub struct Watch {
    /// The cloud at a few times.
    pub table: Table<6>,
    /// Points of the figure.
    pub samples: Vec<Sample>,
    run: Run,
    moments: Vector3<f64>,
    spin: f64,
    starts: Vec<Vector3<f64>>,
    exact: Vec<Euler>,
    energies: Vec<f64>,
    energy_defect: f64,
    momentum_defect: f64,
}

impl Watch {
    /// Nothing observed yet.
    pub fn new(flags: &Flags, momenta: &[Vector3<f64>], rocks: &Ensemble<Rock<F64x8>>) -> Result<Self, Failure> {
        let moments = Vector3::from(flags.inertia);
        let exact: Option<Vec<_>> = momenta.iter().map(|start| Euler::new(&moments, start)).collect();
        let still =
            || Failure::Flags("a body turns steadily: its motion needs no elliptic functions, so tilt it".to_owned());
        Ok(Self {
            table: Table::new(["time / s", "mean", "exact mean", "least", "greatest", "turned over"]),
            samples: Vec::new(),
            run: flags.run.clone(),
            moments,
            spin: flags.spin,
            starts: momenta.to_vec(),
            exact: exact.ok_or_else(still)?,
            energies: (0..rocks.len()).filter_map(|body| rocks.energy(body)).collect(),
            energy_defect: 0.0,
            momentum_defect: 0.0,
        })
    }

    /// Whether this step is looked at.
    pub fn looks_at(&self, step: u64) -> bool {
        self.run.samples(step, POINTS) || self.run.samples(step, ROWS)
    }

    /// Looks at the cloud after a step: the mean, least and greatest spin, and the exact mean.
    pub fn observe(&mut self, step: u64, rocks: &Ensemble<Rock<F64x8>>) -> [f64; 4] {
        let time = self.run.time(step);
        let bodies: Vec<_> = rocks.bodies().collect();
        let spins: Vec<f64> = bodies.iter().map(|(_, pi)| pi.y / self.spin).collect();
        let mean = spins.iter().sum::<f64>() / spins.len() as f64;
        let exact = self.exact.iter().map(|body| body.momentum(time).y / self.spin);
        let exact = exact.sum::<f64>() / self.exact.len() as f64;
        let (least, greatest) =
            spins.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &x| (low.min(x), high.max(x)));
        let energies = (0..rocks.len()).filter_map(|body| rocks.energy(body));
        let changes = energies.zip(&self.energies).map(|(energy, start)| (energy - start).abs() / start);
        self.energy_defect = largest(changes.chain([self.energy_defect]));
        let turned = bodies.iter().zip(&self.starts).map(|((attitude, pi), start)| (attitude * pi - start).norm());
        self.momentum_defect = largest(turned.chain([self.momentum_defect]));
        if self.run.samples(step, POINTS) {
            self.samples.push(Sample { time, mean, exact, drawn: spins.iter().copied().take(DRAWN).collect() });
        }
        if self.run.samples(step, ROWS) {
            let over = spins.iter().filter(|&&spin| spin < 0.0).count();
            let [mean, exact, least, greatest] = [mean, exact, least, greatest].map(|x| format!("{x:.4}"));
            self.table.row([format!("{time:.1}"), mean, exact, least, greatest, over.to_string()]);
        }
        [mean, least, greatest, exact]
    }

    /// Claims the conserved quantities of each body, its end, and that it ends there alone too.
    pub fn claim(
        &self,
        rocks: &Ensemble<Rock<F64x8>>,
        halved: &Ensemble<Rock<F64x8>>,
        claims: &mut Claims,
    ) -> Result<(), Failure> {
        let steps = self.run.steps;
        claims.round_off("the energy of each body is constant, relative", self.energy_defect, steps, 1.0);
        claims.round_off("the spatial momentum of each body is constant", self.momentum_defect, steps, self.spin);
        let (whole, half) = (self.error(rocks), self.error(halved));
        let name = "halved steps are four times nearer to Jacobi's functions";
        // Rounding alone moves the fastest growing difference this far.
        let rounding = round_off::worst_case(2 * steps, self.spin);
        if half > 100.0 * rounding && whole < 0.1 * self.spin {
            let reason = "second order; the mean of the distances at the end";
            claims.within(name, whole / half, 3.9..=4.1, 3, reason);
        } else {
            claims.at_most(
                name,
                whole,
                (4.2 * half).max(rounding),
                "too short or too long a run for the order to show",
            );
        }
        let (apart, compared) = self.apart(rocks)?;
        let reason = format!("{compared} bodies were stepped alone: configurations and momenta are compared");
        claims.holds("each body has the bits that it has alone", apart == 0, &reason);
        Ok(())
    }

    /// The mean distance of the body momenta at the end from the exact ones.
    fn error(&self, rocks: &Ensemble<Rock<F64x8>>) -> f64 {
        let time = self.run.duration();
        let errors = rocks.bodies().zip(&self.exact).map(|((_, pi), exact)| (pi - exact.momentum(time)).norm());
        errors.sum::<f64>() / self.exact.len() as f64
    }

    /// How many of some bodies end elsewhere if they are stepped alone, and how many were.
    fn apart(&self, rocks: &Ensemble<Rock<F64x8>>) -> Result<(usize, usize), Failure> {
        let stepper = Rock { moments: self.moments }.into_stepper(self.run.step_size)?;
        let spacing = self.starts.len().div_ceil(ALONE);
        let (mut apart, mut compared) = (0, 0);
        for (body, start) in self.starts.iter().enumerate().step_by(spacing) {
            let mut state = stepper.state(nalgebra::Matrix3::identity(), *start)?;
            for step in 1..=self.run.steps {
                state = stepper.step(&state).map_err(|error| Failure::Step { step, error })?;
            }
            apart += usize::from(rocks.body(body) != Some(state.into_parts()));
            compared += 1;
        }
        Ok((apart, compared))
    }
}
