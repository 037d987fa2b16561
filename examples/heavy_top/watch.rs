//! The record of the motion while it runs, and the claims about it.

use crate::Flags;
use clebsch_examples::claims::Claims;
use clebsch_examples::energy_band::{EnergyBand, Terms};
use clebsch_examples::flags::Run;
use clebsch_examples::table::Table;
use nalgebra::{Matrix3, Vector3};

/// Points of the figure.
const POINTS: u64 = 5000;
/// Intervals of the table.
const ROWS: u64 = 10;

/// One state.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Seconds.
    pub time: f64,
    /// The third body axis in space.
    pub axis: Vector3<f64>,
    /// The vertical component of the spatial momentum, kg·m²/s.
    pub vertical: f64,
    /// The component of the momentum along the third body axis, kg·m²/s.
    pub spin: f64,
    /// J
    pub energy: f64,
    /// J
    pub potential: f64,
}

impl Sample {
    /// From a state.
    pub fn new(time: f64, attitude: &Matrix3<f64>, momentum: &Vector3<f64>, energy: f64, potential: f64) -> Self {
        let vertical = (attitude * momentum).z;
        Self { time, axis: attitude.column(2).into(), vertical, spin: momentum.z, energy, potential }
    }

    /// The angle between the third body axis and the vertical, degrees.
    pub fn tilt(&self) -> f64 {
        self.axis.x.hypot(self.axis.y).atan2(self.axis.z).to_degrees()
    }
}

/// Points of the path, and the largest defects of all states.
pub struct Watch {
    /// The motion at a few times.
    pub table: Table<6>,
    /// Points of the figure, the first state first.
    pub samples: Vec<Sample>,
    run: Run,
    inertia: Vector3<f64>,
    /// Weight times the centre of mass, body frame.
    moment: Vector3<f64>,
    band: EnergyBand,
    start: Option<Sample>,
    largest_momentum: f64,
    vertical_defect: f64,
    spin_defect: f64,
    orbit_defect: f64,
}

impl Watch {
    /// Nothing observed yet.
    pub fn new(flags: &Flags) -> Self {
        Self {
            table: Table::new(["time / s", "tilt / °", "azimuth / °", "vertical momentum", "energy / J", "change / J"]),
            samples: Vec::new(),
            run: flags.run.clone(),
            inertia: flags.inertia.into(),
            moment: Vector3::from(flags.center) * flags.weight,
            band: EnergyBand::new(&flags.run),
            start: None,
            largest_momentum: 0.0,
            vertical_defect: 0.0,
            spin_defect: 0.0,
            orbit_defect: 0.0,
        }
    }

    /// Takes the next state.
    pub fn observe(
        &mut self,
        step: u64,
        attitude: &Matrix3<f64>,
        momentum: &Vector3<f64>,
        sample: Sample,
        orbit_defect: f64,
    ) {
        let start = *self.start.get_or_insert(sample);
        self.band.observe(sample.energy, sample.potential, terms(&self.inertia, &self.moment, attitude, momentum));
        self.largest_momentum = self.largest_momentum.max(momentum.norm());
        self.vertical_defect = self.vertical_defect.max((sample.vertical - start.vertical).abs());
        self.spin_defect = self.spin_defect.max((sample.spin - start.spin).abs());
        self.orbit_defect = self.orbit_defect.max(orbit_defect);
        if self.run.samples(step, POINTS) {
            self.samples.push(sample);
        }
        if self.run.samples(step, ROWS) {
            self.table.row([
                format!("{:.2}", sample.time),
                format!("{:.3}", sample.tilt()),
                format!("{:.2}", sample.axis.y.atan2(sample.axis.x).to_degrees()),
                format!("{:.6}", sample.vertical),
                format!("{:.6}", sample.energy),
                format!("{:.1e}", sample.energy - start.energy),
            ]);
        }
    }

    /// Claims the momenta on which gravity does not act, and the band of the energy.
    pub fn claim(&self, flags: &Flags, claims: &mut Claims) {
        let steps = self.run.steps;
        // The kick is horizontal in space only as far as R is a rotation: its defect, itself rounding, works through all kicks.
        let kicks = self.run.duration() * self.moment.norm();
        let scale = self.largest_momentum + kicks;
        claims.round_off("the vertical momentum (R π)·e₃ is constant", self.vertical_defect, steps, scale);
        let name = "the momentum about the body axis is constant";
        if flags.is_symmetric() {
            claims.round_off(name, self.spin_defect, steps, scale);
        } else {
            claims.skip(name, "inertia and centre of mass are not symmetric about the third axis");
        }
        claims.round_off("the attitude stays a rotation", self.orbit_defect, steps, 1.0);
        self.band.claim(claims);
    }
}

/// The terms of the modified energy, with T = ½ π·J⁻¹π and V = Γ·m, Γ = Rᵀe₃ and m the moment.
///
/// Free motion: Γ̇ = Γ×ω and J ω̇ = π×ω. The force is τ = Γ×m. The Moser–Veselov drift is the free motion of T + h² D,
/// D = (e₃C² − e₂CT + e₁T²)/6. Here C = ½|π|², and e_i are the elementary symmetric functions of the 1/J_j (Hairer and
/// Vilmart 2006).
fn terms(inertia: &Vector3<f64>, moment: &Vector3<f64>, attitude: &Matrix3<f64>, momentum: &Vector3<f64>) -> Terms {
    let x = inertia.map(f64::recip);
    let (e1, e2, e3) = (x.sum(), x.x * x.y + x.y * x.z + x.z * x.x, x.product());
    let omega = momentum.component_mul(&x);
    let (t, c) = (momentum.dot(&omega) / 2.0, momentum.norm_squared() / 2.0);
    let gamma: Vector3<f64> = attitude.row(2).transpose();
    let force = gamma.cross(moment);
    let turning = gamma.cross(&omega);
    let spin_rate = momentum.cross(&omega).component_mul(&x);
    Terms {
        drift: (e3 * c * c - e2 * c * t + e1 * t * t) / 6.0,
        power: turning.dot(moment),
        power_rate: (turning.cross(&omega) + gamma.cross(&spin_rate)).dot(moment),
        kick: force.dot(&force.component_mul(&x)),
        rate: omega.norm().max((moment.norm() * x.max()).sqrt()),
    }
}
