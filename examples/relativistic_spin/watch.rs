//! The record of the motion while it runs, and the claims about it.

use crate::Flags;
use crate::closed_form::ClosedForm;
use crate::field::{Field, at_rest, metric, momentum};
use clebsch_examples::claims::Claims;
use clebsch_examples::conserved::Conserved;
use clebsch_examples::flags::Run;
use clebsch_examples::round_off;
use clebsch_examples::table::Table;
use nalgebra::{Matrix4, Vector3};

/// Points of the figure.
const POINTS: u64 = 3000;
/// Intervals of the table.
const ROWS: u64 = 10;

/// One state.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Proper time, ns.
    pub time: f64,
    /// Time of the laboratory, µs.
    pub laboratory: f64,
    /// The spin at rest along the momentum, across it, and along the other part of the magnetic field.
    pub spin: [f64; 3],
    /// The defect of the frame over |q|², and the change of the field of the laboratory over |q|² |𝓕|.
    pub defects: [f64; 2],
}

/// Points of the path, and the largest defects of all states.
pub struct Watch {
    /// The motion at a few times.
    pub table: Table<6>,
    /// Points of the figure.
    pub samples: Vec<Sample>,
    run: Run,
    exact: ClosedForm,
    spin: Vector3<f64>,
    start: Option<[f64; 9]>,
    /// Time of the laboratory, ns, and γ of the last state.
    laboratory: (f64, f64),
    /// |q|², the largest.
    stretch: f64,
    /// The sizes of the field in the laboratory and of that which is seen, T.
    size: f64,
    seen: f64,
    frame_defect: f64,
    orbit_defect: f64,
    laboratory_defect: f64,
    magnetic_defect: f64,
    difference: Conserved,
    product: Conserved,
    energy: Conserved,
}

impl Watch {
    /// Nothing observed yet.
    pub fn new(flags: &Flags, exact: ClosedForm, spin: Vector3<f64>) -> Self {
        let seen = exact.field.seen_from(&exact.start).tensor().norm();
        let energy = exact.charge_to_mass * (1.0 + exact.anomaly.abs()) * seen * seen;
        Self {
            table: Table::new(["ns of its time", "µs", "γ", "spin along p", "across p", "field, change / T"]),
            samples: Vec::new(),
            run: flags.run.clone(),
            exact,
            spin,
            start: None,
            laboratory: (0.0, exact.start[(0, 0)]),
            stretch: 0.0,
            size: exact.field.tensor().norm(),
            seen,
            frame_defect: 0.0,
            orbit_defect: 0.0,
            laboratory_defect: 0.0,
            magnetic_defect: 0.0,
            difference: Conserved::new("B² − E² in the frame is constant", seen * seen),
            product: Conserved::new("E·B in the frame is constant", seen * seen),
            energy: Conserved::new("the energy is constant", energy),
        }
    }

    /// Takes the next state: the frame, the field seen in it, and the nine momenta that the derive found.
    pub fn observe(
        &mut self,
        step: u64,
        q: &Matrix4<f64>,
        field: &Field,
        conserved: &[f64; 9],
        energy: f64,
        orbit_defect: f64,
    ) {
        self.stretch = self.stretch.max(q.norm_squared());
        let frame_defect = (q * metric() * q.transpose() - metric()).amax();
        self.frame_defect = self.frame_defect.max(frame_defect);
        self.orbit_defect = self.orbit_defect.max(orbit_defect);
        let start = *self.start.get_or_insert(*conserved);
        let moved: [f64; 9] = std::array::from_fn(|i| (conserved[i] - start[i]).abs());
        let magnetic = moved[..3].iter().fold(0.0, |largest: f64, &change| largest.max(change));
        let laboratory = moved[3..].iter().fold(0.0, |largest: f64, &change| largest.max(change));
        self.magnetic_defect = self.magnetic_defect.max(magnetic);
        self.laboratory_defect = self.laboratory_defect.max(laboratory);
        let [difference, product] = field.invariants();
        self.difference.observe(difference);
        self.product.observe(product);
        self.energy.observe(energy);
        let defects = [frame_defect / self.stretch, laboratory / (self.stretch * self.size).max(f64::MIN_POSITIVE)];
        self.keep(step, q, defects, laboratory);
    }

    /// Records the data of the table and the figure.
    fn keep(&mut self, step: u64, q: &Matrix4<f64>, defects: [f64; 2], field_change: f64) {
        let (time, gamma) = (self.run.time(step), q[(0, 0)]);
        if step > 0 {
            let (elapsed, last) = self.laboratory;
            self.laboratory = (elapsed + self.run.step_size * (last + gamma) / 2.0, gamma);
        }
        let laboratory = self.laboratory.0 * 1e-3;
        let spin = self.spin_by_momentum(q);
        if self.run.samples(step, POINTS) {
            self.samples.push(Sample { time, laboratory, spin, defects });
        }
        if self.run.samples(step, ROWS) {
            let [along, across, _] = spin.map(|part| format!("{part:+.6}"));
            let columns = [format!("{time:.2}"), six(laboratory), six(gamma), along, across];
            let [proper, laboratory, gamma, along, across] = columns;
            self.table.row([proper, laboratory, gamma, along, across, format!("{field_change:.1e}")]);
        }
    }

    /// The spin at rest in axes that go with the momentum: along it, then the other two with the magnetic field in the third.
    fn spin_by_momentum(&self, q: &Matrix4<f64>) -> [f64; 3] {
        let s = at_rest(q, &self.spin);
        let unit = |v: Vector3<f64>, otherwise: Vector3<f64>| v.try_normalize(0.0).unwrap_or(otherwise);
        let first = unit(momentum(q), Vector3::x());
        let field = self.exact.field.magnetic;
        let fallback = unit(Vector3::z() - first * first.z, Vector3::y());
        let third = unit(field - first * first.dot(&field), fallback);
        [s.dot(&first), s.dot(&third.cross(&first)), s.dot(&third)]
    }

    /// Claims the group, the conserved momenta and their consequences.
    pub fn claim(&self, claims: &mut Claims) {
        let (stretch, seen) = (self.stretch, self.seen);
        self.claim_frame("q η qᵀ = η: the frame stays a frame", self.frame_defect, stretch, 1.0, claims);
        let name = "qᵀ η q = η: the same by its axes, which are longer";
        self.claim_frame(name, self.orbit_defect, stretch * stretch, 1.0, claims);
        let name = "the spatial momentum, the field of the laboratory, is constant";
        self.claim_frame(name, self.laboratory_defect, stretch * seen, self.size, claims);
        let name = "the magnetic field in the frame is constant";
        claims.round_off(name, self.magnetic_defect, self.run.steps, seen);
        for quantity in [self.difference, self.product, self.energy] {
            quantity.claim(self.run.steps, claims);
        }
    }

    /// A claim about the laboratory, where rounding grows like γ², unless that is more than the quantity that is
    /// rounded.
    fn claim_frame(&self, name: &str, defect: f64, scale: f64, size: f64, claims: &mut Claims) {
        let steps = self.run.steps;
        if size > 0.0 && round_off::worst_case(steps, scale) > size {
            let reason = format!(
                "an electric field drives the frame off, to |q|² = {:.0e}: rounding grows with it",
                self.stretch
            );
            claims.skip(name, &reason);
        } else {
            claims.round_off(name, defect, steps, scale);
        }
    }
}

/// Six decimals, or six digits of large numbers.
fn six(number: f64) -> String {
    if number.abs() < 1e6 { format!("{number:.6}") } else { format!("{number:.6e}") }
}
