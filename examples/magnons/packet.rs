//! A packet of slow waves runs around a ring.

use crate::Flags;
use crate::cone::{Branch, Cone};
use crate::ring::Magnet;
use clebsch_examples::claims::{Claims, largest};
use clebsch_examples::flags::Run;
use clebsch_examples::integrate::integrate_field;
use clebsch_examples::round_off;
use clebsch_examples::scene::Failure;
use nalgebra::{Vector2, Vector3};
use std::f64::consts::TAU;

/// Times of the picture.
const PICTURES: u64 = 110;
/// Points of curves.
const POINTS: u64 = 200;
/// Width of the packet, in parts of the ring.
const WIDTH: f64 = 0.05;
/// Largest tilt, rad.
const TILT: f64 = 0.05;

/// One run.
pub struct Packet {
    /// Time, and q₁ of all spins over the largest.
    pub pictures: Vec<(f64, Vec<f64>)>,
    /// Time and place of the centre, in spacings.
    pub centres: Vec<(f64, f64)>,
    /// Sites.
    pub sites: usize,
    run: Run,
    start: Option<(f64, Vector3<f64>)>,
    energy_defect: f64,
    momentum_defect: f64,
    spin_defect: f64,
    momentum_scale: f64,
}

/// Where the waves of a ring are, as an angle around it.
fn centre(q: &[Vector3<f64>]) -> f64 {
    let place = |i: usize| TAU * i as f64 / q.len() as f64;
    let weights =
        q.iter().enumerate().map(|(i, q)| Vector2::new(place(i).cos(), place(i).sin()) * q.xy().norm_squared());
    let sum: Vector2<f64> = weights.sum();
    sum.y.atan2(sum.x)
}

/// q₁ + i q₂ of the start.
fn profile(sites: usize, k: f64) -> Vec<Vector2<f64>> {
    let width = WIDTH * sites as f64;
    let wave = |i: usize| {
        let x = i as f64 - sites as f64 / 2.0;
        Vector2::new((k * x).cos(), (k * x).sin()) * (TILT * (-(x / width).powi(2) / 2.0).exp())
    };
    (0..sites).map(wave).collect()
}

/// The mean of dω/dk over the waves of the start, spacings per second.
fn speed(cone: &Cone, profile: &[Vector2<f64>]) -> f64 {
    let sites = profile.len();
    let (mut weights, mut speeds) = (0.0, 0.0);
    for n in 0..sites {
        let k = TAU * n as f64 / sites as f64;
        let part = |(i, u): (usize, &Vector2<f64>)| nalgebra::Rotation2::new(-k * i as f64) * u;
        let weight = profile.iter().enumerate().map(part).sum::<Vector2<f64>>().norm_squared();
        // of ω² − sω − 2J(1 − cos k) = 0
        let omega = Cone { k, tilt: 0.0, ..*cone }.frequency(Branch::Slow);
        weights += weight;
        speeds += weight * 2.0 * cone.exchange * k.sin() / (2.0 * omega - cone.spin);
    }
    // waves of k and ω run to −ω/k
    -speeds / weights
}

impl Packet {
    /// Steps a ring to the end of the run. `record` gets the energy, the momentum and the centre.
    ///
    /// # Errors
    /// Those of steps, and of `record`.
    pub fn of(
        flags: &Flags,
        run: &Run,
        mut record: impl FnMut(u64, f64, f64, Vector3<f64>, f64) -> Result<(), Failure>,
    ) -> Result<Self, Failure> {
        let (sites, cone) = (flags.sites, flags.cone());
        let mut packet = Self {
            pictures: Vec::new(),
            centres: Vec::new(),
            sites,
            run: run.clone(),
            start: None,
            energy_defect: 0.0,
            momentum_defect: 0.0,
            spin_defect: 0.0,
            momentum_scale: 0.0,
        };
        let stepper = Magnet { exchange: flags.exchange }.ring(sites, run.step_size)?;
        let omega = Cone { tilt: 0.0, ..cone }.frequency(Branch::Slow);
        let q: Vec<Vector3<f64>> =
            profile(sites, cone.k).iter().map(|u| Vector3::new(u.x, u.y, (1.0 - u.norm_squared()).sqrt())).collect();
        // q turns at ω about e₃: N = s q + ω q × (e₃ × q)
        let mu = q.iter().map(|q| q * flags.spin + (Vector3::z() - q * q.z) * omega).collect();
        let mut state = stepper.state(q, mu)?;
        let is_seen = |step: u64| run.writes(step) || run.samples(step, PICTURES) || run.samples(step, POINTS);
        integrate_field(run, &stepper, &mut state, is_seen, |step, time, state| {
            let energy = stepper.energy(state).map_err(Failure::step(step))?;
            let (q, mu) = (state.configuration(), state.momentum());
            let total: Vector3<f64> = mu.iter().sum();
            let (first, total_at_start) = *packet.start.get_or_insert((energy, total));
            packet.energy_defect = largest([packet.energy_defect, (energy - first).abs()]);
            packet.momentum_defect = largest([packet.momentum_defect, (total - total_at_start).amax()]);
            packet.momentum_scale = packet.momentum_scale.max(mu.iter().map(Vector3::norm).sum());
            let spins = q.iter().zip(mu).map(|(q, mu)| (q.dot(mu) - flags.spin).abs());
            packet.spin_defect = largest(spins.chain([packet.spin_defect]));
            let last = packet.centres.last().map_or(sites as f64 / 2.0, |(_, place)| *place);
            let ring = sites as f64;
            let here = centre(q) / TAU * ring;
            let place = here + ring * ((last - here) / ring).round();
            packet.centres.push((time, place));
            record(step, time, energy, total, place)?;
            if run.samples(step, PICTURES) {
                packet.pictures.push((time, q.iter().map(|q| q.x / TILT).collect()));
            }
            Ok(())
        })?;
        Ok(packet)
    }

    /// Spacings per second.
    pub fn speed(&self) -> f64 {
        let (from, to) = (self.centres.first(), self.centres.last());
        from.zip(to).map_or(f64::NAN, |((from, x), (to, y))| (y - x) / (to - from))
    }

    /// That of waves in continuous time.
    pub fn expected(&self, flags: &Flags) -> f64 {
        speed(&flags.cone(), &profile(self.sites, flags.cone().k))
    }

    /// Claims about the run, and about one with half the step.
    pub fn claim(&self, halved: &Self, flags: &Flags, claims: &mut Claims) {
        let steps = self.run.steps;
        claims.round_off(
            "packet: the total momentum stays, three numbers",
            self.momentum_defect,
            steps,
            self.momentum_scale,
        );
        claims.round_off("packet: N·q of each spin is s", self.spin_defect, steps, flags.spin.abs());
        let expected = self.expected(flags);
        let off = (self.speed() / expected - 1.0).abs();
        let bound = TILT * TILT + (flags.run.step_size * flags.spin).powi(2) / 6.0;
        let reason = format!("relative; of {expected:.5} spacings a second, the mean of dω/dk");
        claims.at_most("packet: its speed", off, bound, &reason);
        let (one, half) = (self.energy_defect, halved.energy_defect);
        let rounding = round_off::worst_case(2 * steps, self.momentum_scale * flags.spin.abs());
        if half > rounding {
            let reason = format!("the change with h is {one:.1e}");
            claims.within(
                "packet: half the step, a quarter of the change of the energy",
                one / half,
                3.5..=4.5,
                3,
                &reason,
            );
        } else {
            claims.at_most(
                "packet: the energy stays",
                one,
                4.5 * half + rounding,
                "too little motion for the order to show",
            );
        }
    }
}
