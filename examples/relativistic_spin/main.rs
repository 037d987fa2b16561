//! A charge with a spin in constant fields: the frame that it carries through spacetime, by steps of the Lorentz group.
//!
//! The equation of Bargmann, Michel and Telegdi is that of a free rigid body whose rotations are those of spacetime.
//! Its body momentum is the electromagnetic field that the particle sees. Its spatial momentum is the field of the
//! laboratory, which is constant. Its inertia is 1/κ against boosts and 1/(κ(1 + a)) against rotations, with κ = e/m
//! and a = (g − 2)/2.
//!
//! Sources: Bargmann, Michel and Telegdi (1959); muon ring of Brookhaven: Bennett et al., Physical Review Letters 92, 161802 (2004).

mod closed_form;
mod field;
mod figure;
mod ring;
mod watch;

use clap::Parser;
use clebsch::{Clebsch, State, Stepper};
use clebsch_examples::claims::Claims;
use clebsch_examples::convergence::{Convergence, refined};
use clebsch_examples::csv::{Csv, by_rows};
use clebsch_examples::flags::{Order, Run, Scene, finite, finite_list, parse, positive};
use clebsch_examples::integrate::integrate;
use clebsch_examples::reference;
use clebsch_examples::scene::{Failure, conclude, say};
use closed_form::{ClosedForm, together};
use field::{Field, boost, carried, charge_to_mass};
use nalgebra::{Matrix4, Vector3};
use std::process::ExitCode;
use watch::Watch;

/// The frame of a charge with a spin, its group declared by an equation.
///
/// The Hessian of the cost is indefinite, −`boosting` three times and `turning` three times. So the energy does not
/// bound the frame, which an electric field drives off exponentially. Solutions between fixed ends are stationary and
/// no minima. The length of a step is bounded only for rotations (sin θ ≤ 1), not for boosts (sinh).
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    group Lorentz = |F: Matrix4| {
        let eta = Matrix4::from_diagonal(&vector![1, -1, -1, -1]);
        F.transpose() * eta * F == eta
    },
    action    = |F: Lorentz, q: Lorentz| q * F,
    cost      = |h, F| (self.turning * (4 - F.trace()) / 2 + (self.boosting - self.turning) * (1 - F[(0, 0)])) / h,
    signature = indefinite,
)]
pub struct SpinFrame {
    /// Inertia against boosts: 1/κ, T ns.
    pub boosting: f64,
    /// Inertia against rotations: 1/(κ (1 + a)), T ns.
    pub turning: f64,
}

const SCENE: Scene = Scene {
    name: "relativistic_spin",
    step_size: "0.01",
    time_unit: "nanoseconds of proper time",
    steps: "15000",
    order: "2",
    order_note: "it places the potential; this body has none, so 1 and 2 give the same step",
    columns_note: "frame q00..q33 (its first column is the four-velocity), field in the frame E1,E2,E3 (E/c), B1,B2,B3 (T)",
};

/// Steps of the comparisons with the closed form and with the equation of Bargmann, Michel and Telegdi, at most.
const COMPARED: u64 = 1000;

/// Largest |Λ(0)| |Λ(τ)| for a comparison with that equation.
const LONGEST: f64 = 1e6;

/// A charge with a spin in constant fields: the precession of Bargmann, Michel and Telegdi; by default a muon in its storage ring
#[derive(Parser, Debug)]
struct Flags {
    /// Magnetic field, T; by default that of Brookhaven's muon ring in 2001, where free protons precess at 61 791 400 Hz
    #[arg(long, value_name = "X,Y,Z", value_parser = finite_list::<3>, allow_hyphen_values = true)]
    #[arg(default_value = "0,0,1.4512696")]
    magnetic: [f64; 3],
    /// Electric field, MV/m
    #[arg(long, value_name = "X,Y,Z", value_parser = finite_list::<3>, allow_hyphen_values = true)]
    #[arg(default_value = "0,0,0")]
    electric: [f64; 3],
    /// Momentum at the start, GeV/c
    #[arg(long, value_name = "X,Y,Z", value_parser = finite_list::<3>, allow_hyphen_values = true)]
    #[arg(default_value = "3.094,0,0")]
    momentum: [f64; 3],
    /// Direction of the spin at the start, in the frame of the particle at rest
    #[arg(long, value_name = "X,Y,Z", value_parser = finite_list::<3>, allow_hyphen_values = true)]
    #[arg(default_value = "1,0,0")]
    spin: [f64; 3],
    /// Anomaly a = (g - 2)/2; by default the muon's as measured at Fermilab (2023)
    #[arg(long, value_name = "A", value_parser = anomaly, allow_hyphen_values = true, default_value = "0.00116592055")]
    anomaly: f64,
    /// Rest energy of one elementary charge, MeV; by default the muon's
    #[arg(long, value_name = "M", value_parser = positive, allow_hyphen_values = true, default_value = "105.6583755")]
    mass: f64,
    #[command(flatten)]
    run: Run,
}

/// A finite number other than −1, where g is zero and no field turns the spin.
fn anomaly(text: &str) -> Result<f64, String> {
    let anomaly = finite(text)?;
    if anomaly == -1.0 { Err("g = 0: the inertia against rotations would be infinite".to_owned()) } else { Ok(anomaly) }
}

impl Flags {
    fn closed_form(&self) -> ClosedForm {
        ClosedForm {
            charge_to_mass: charge_to_mass(self.mass),
            anomaly: self.anomaly,
            field: Field::new(self.electric, self.magnetic),
            start: boost(&(Vector3::from(self.momentum) * (1e3 / self.mass))),
        }
    }

    fn spin(&self) -> Result<Vector3<f64>, Failure> {
        let unit = Vector3::from(self.spin).try_normalize(0.0);
        unit.ok_or_else(|| Failure::Flags("--spin: 0,0,0 has no direction".to_owned()))
    }
}

impl SpinFrame {
    fn of(charge_to_mass: f64, anomaly: f64) -> Self {
        Self { boosting: 1.0 / charge_to_mass, turning: 1.0 / (charge_to_mass * (1.0 + anomaly)) }
    }
}

/// The frame at the start of the closed form.
///
/// With the velocity κ(𝓕′ + a𝓑′) the inertias give the matrix −½𝓕′ᵀ: the momentum is the field.
fn start(stepper: &Stepper<SpinFrame>, exact: &ClosedForm) -> Result<State<SpinFrame>, clebsch::Error> {
    let seen = exact.field.seen_from(&exact.start).tensor();
    stepper.state(exact.start, stepper.momentum_components(&(seen.transpose() * -0.5)))
}

/// The field that the particle sees: its body momentum.
fn seen(state: &State<SpinFrame>) -> Field {
    Field::of(&(SpinFrame::momentum_matrix(&state.momentum()).transpose() * -2.0))
}

fn main() -> ExitCode {
    conclude(run(&parse(&SCENE)))
}

fn run(flags: &Flags) -> Result<Claims, Failure> {
    let (exact, spin) = (flags.closed_form(), flags.spin()?);
    let frame = SpinFrame::of(exact.charge_to_mass, exact.anomaly);
    let stepper = frame.stepper(flags.run.step_size)?;
    let start_state = start(&stepper, &exact)?;

    let mut csv = Csv::create(&flags.run, &columns().iter().map(String::as_str).collect::<Vec<_>>())?;
    let mut watch = Watch::new(flags, exact, spin);
    integrate(&flags.run, &stepper, start_state, |step, time, state| {
        let (q, field) = (state.configuration(), seen(state));
        csv.row(step, time, by_rows(q).chain(by_rows(&field.electric)).chain(by_rows(&field.magnetic)))?;
        let conserved = stepper.conserved(state);
        watch.observe(step, q, &field, conserved.values(), stepper.energy(state), stepper.system().orbit_defect(q));
        Ok(())
    })?;

    let Run { step_size, steps, .. } = flags.run;
    let duration = flags.run.duration();
    say(format_args!("a charge with a spin over {duration} ns of its time: {steps} steps of {step_size} ns\n"));
    say(&watch.table);
    let mut claims = Claims::new();
    watch.claim(&mut claims);
    claim_order(flags, &frame, &exact, &mut claims)?;
    claim_equation(flags, &exact, &spin, &mut claims);
    claim_leapfrog(flags, &exact, &mut claims)?;
    ring::claim(flags, &exact, &spin, &mut claims)?;
    csv.finish()?;
    figure::draw(flags, &watch)?;
    Ok(claims)
}

/// The columns of the CSV file.
fn columns() -> Vec<String> {
    let frame = (0..4).flat_map(|i| (0..4).map(move |j| format!("q{i}{j}")));
    frame.chain(["E1", "E2", "E3", "B1", "B2", "B3"].map(str::to_owned)).collect()
}

/// Claims order 2 against the closed form.
fn claim_order(flags: &Flags, frame: &SpinFrame, exact: &ClosedForm, claims: &mut Claims) -> Result<(), Failure> {
    let steps = flags.run.steps.min(COMPARED);
    let time = flags.run.time(steps);
    let end = exact.frame(time);
    let errors = refined(frame, &flags.run, steps, |stepper| start(stepper, exact))?
        .map(|state| (state.configuration() - end).amax() / end.amax());
    // roundings of the exponentials, and of a frame whose axes are longer than one
    let reference = f64::EPSILON * (1.0 + exact.rate() * time) * exact.start.norm();
    Convergence { errors, reference, steps }.claim(Order::Second, "order 2 against the closed form", claims);
    Ok(())
}

/// Claims that the closed form solves the equation of Bargmann, Michel and Telegdi.
fn claim_equation(flags: &Flags, exact: &ClosedForm, spin: &Vector3<f64>, claims: &mut Claims) {
    let name = "velocity and spin by the equation of Bargmann, Michel and Telegdi";
    let time = flags.run.time(flags.run.steps.min(COMPARED));
    let (start, end) = (exact.start, exact.frame(time));
    // the factor by which an error of the reference grows
    let stretch = start.norm() * end.norm();
    if stretch.is_nan() || stretch > LONGEST {
        return claims.skip(name, &format!("frames that reach {stretch:.0e}: its s·𝓕u is lost to cancellation"));
    }
    let vectors = |q: &Matrix4<f64>| together(&q.column(0).into(), &carried(q, spin));
    let solution = reference::solve(exact.equation(), vectors(&start), time, exact.rate());
    let defect = (solution.end - vectors(&end)).amax();
    claims.at_most(name, defect, solution.error * stretch, "the error of the reference, magnified");
}

/// Claims that with g = 2 the frame makes leaps: F − F⁻¹ = 2hκ𝓕′ is the momentum equation, so that q_{k+1} − q_{k−1} = 2hκ 𝓕 q_k.
fn claim_leapfrog(flags: &Flags, exact: &ClosedForm, claims: &mut Claims) -> Result<(), Failure> {
    let stepper = SpinFrame::of(exact.charge_to_mass, 0.0).into_stepper(flags.run.step_size)?;
    let mut before = start(&stepper, exact)?;
    let mut here = stepper.step(&before).map_err(|error| Failure::Step { step: 1, error })?;
    let leap = exact.field.tensor() * (2.0 * flags.run.step_size * exact.charge_to_mass);
    let (mut defect, mut scale, steps) = (0.0_f64, 0.0_f64, flags.run.steps.min(COMPARED));
    for step in 2..=steps.max(2) {
        let next = stepper.step(&here).map_err(|error| Failure::Step { step, error })?;
        let q = here.configuration();
        defect = defect.max((next.configuration() - before.configuration() - leap * q).amax());
        scale = scale.max(q.norm_squared());
        (before, here) = (here, next);
    }
    claims.round_off("with g = 2 the step is the leapfrog rule of dq/dτ = κ𝓕q", defect, steps, scale);
    Ok(())
}
