//! Chaplygin's sleigh and Suslov's body: two constraints on the velocity, one closed form, and energies that stay.

mod closed_form;
mod figure;
mod watch;

use clap::Parser;
use clebsch::{Clebsch, State};
use clebsch_examples::claims::{Claims, largest};
use clebsch_examples::convergence::Convergence;
use clebsch_examples::csv::Csv;
use clebsch_examples::figure::{Arrow, GREEN};
use clebsch_examples::flags::{Order, Run, Scene, finite, finite_list, parse, positive};
use clebsch_examples::integrate::integrate;
use clebsch_examples::scene::{Failure, conclude, say};
use nalgebra::{Matrix3, Vector3};
use std::process::ExitCode;
use watch::{Moment, Watch};

/// A sleigh on a blade that does not slip sideways. Its velocity is (ω, v_x, v_y) in the frame of the blade.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SE<2>, q: SE<2>| q * F,
    lagrangian     = |xi| (self.inertia * xi.x.powi(2) + self.mass * (xi.y.powi(2) + (xi.z + self.offset * xi.x).powi(2))) / 2,
    discretization = moser_veselov,
    constraint     = |xi| [xi.z == 0],
)]
pub struct Sleigh {
    /// Kilograms.
    pub mass: f64,
    /// Moment of inertia about the centre of mass, kg·m².
    pub inertia: f64,
    /// Centre of mass ahead of the blade, metres.
    pub offset: f64,
}

/// Suslov's body: it cannot turn about its third axis.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<3>, R: SO<3>| R * F,
    lagrangian     = |omega| omega.dot(&(self.inertia * omega)) / 2,
    discretization = moser_veselov,
    constraint     = |omega| [omega.z == 0],
)]
pub struct Body {
    /// Inertia tensor, kg·m².
    #[clebsch(symmetric)]
    pub inertia: Matrix3<f64>,
}

/// c t + δ of the sleigh where its drawn path ends.
const STRAIGHT: f64 = 3.0;
/// Steps from one arrow to the next.
const ARROWS: u64 = 6;

const SCENE: Scene = Scene {
    name: "sleigh",
    step_size: "0.05",
    time_unit: "seconds",
    steps: "100000",
    order: "2",
    order_note: "steps with a constraint have order 2",
    columns_note: "place x,y (m), heading (rad), turning rate omega (rad/s) and speed v (m/s) of the sleigh, angular velocity omega1,omega2,omega3 of Suslov's body (body frame, rad/s)",
};

/// Chaplygin's sleigh and Suslov's body: tanh and sech, and energies at round-off
#[derive(Parser, Clone, Debug)]
struct Flags {
    /// The centre of mass of the sleigh ahead of its blade, m
    #[arg(long, value_name = "A", value_parser = positive, allow_hyphen_values = true, default_value = "0.6")]
    offset: f64,
    /// Turning rate of the sleigh at the start, rad/s
    #[arg(long, value_name = "RATE", value_parser = finite, allow_hyphen_values = true, default_value = "0.15")]
    turning: f64,
    /// Speed of the sleigh at the start, m/s; backwards below zero
    #[arg(long, value_name = "V", value_parser = finite, allow_hyphen_values = true, default_value = "-1")]
    speed: f64,
    /// Angular velocity of Suslov's body at the start about its first two axes, rad/s
    #[arg(long, value_name = "X,Y", value_parser = finite_list::<2>, allow_hyphen_values = true, default_value = "-0.6,-1")]
    omega: [f64; 2],
    #[command(flatten)]
    run: Run,
}

fn main() -> ExitCode {
    conclude(run(&parse(&SCENE)))
}

fn run(flags: &Flags) -> Result<Claims, Failure> {
    flags.run.refuse_first_order(&SCENE)?;
    let sleigh = Sleigh { mass: 1.5, inertia: 0.4, offset: flags.offset };
    let body = Body { inertia: Matrix3::new(1.0, 0.1, 0.3, 0.1, 1.4, -0.2, 0.3, -0.2, 0.9) };
    let inverse = body.inertia.try_inverse().unwrap_or_default();
    let velocities = (Vector3::new(flags.turning, flags.speed, 0.0), Vector3::new(flags.omega[0], flags.omega[1], 0.0));
    // N = Σ ξ, by hand
    let slide = |n: &Vector3<f64>| {
        let omega = (n.x - sleigh.offset * n.z) / sleigh.inertia;
        Vector3::new(omega, n.y / sleigh.mass, n.z / sleigh.mass - sleigh.offset * omega)
    };
    let places = |n: &Vector3<f64>, m: &Vector3<f64>| {
        let slid = slide(n);
        [sleigh.place(slid.x, slid.y), body.place(&(inverse * m))]
    };

    let (blade, turning) = (sleigh.stepper(flags.run.step_size)?, body.stepper(flags.run.step_size)?);
    let start = blade.state_moving(Matrix3::identity(), velocities.0)?;
    let mut other = turning.state_moving(Matrix3::identity(), velocities.1)?;
    let [first, second] = places(&start.momentum(), &other.momentum());
    if first.across == 0.0 || second.across == 0.0 {
        return Err(Failure::Flags("both need a velocity that is not steady: turn the sleigh and the body".to_owned()));
    }
    let exact = [sleigh.crossing(first), body.crossing(second)];
    let mut watch = Watch::new(&flags.run, exact, [blade.energy(&start), turning.energy(&other)]);
    let mut csv = Csv::create(&flags.run, &["x", "y", "heading", "omega", "v", "omega1", "omega2", "omega3"])?;
    let (mut path, mut arrows) = (Vec::new(), Vec::new());
    integrate(&flags.run, &blade, start, |step, time, state| {
        if step > 0 {
            other = turning.step(&other).map_err(|error| Failure::Step { step, error })?;
        }
        let (slid, spin) = (slide(&state.momentum()), inverse * other.momentum());
        let moment = Moment {
            time,
            places: places(&state.momentum(), &other.momentum()),
            energies: [blade.energy(state), turning.energy(&other)],
            violations: [slid.z / exact[0].size, spin.z * body.inertia[(2, 2)].sqrt() / exact[1].size],
        };
        let q = state.configuration();
        let (at, heading) = ((q[(0, 2)], q[(1, 2)]), q[(1, 0)].atan2(q[(0, 0)]));
        let phase = exact[0].rate * time + exact[0].delay;
        if step <= watch.window && phase < STRAIGHT {
            path.push(at);
            if step.is_multiple_of(ARROWS) {
                arrows.push(Arrow { at, heading, colour: GREEN });
            }
        }
        csv.row(step, time, [at.0, at.1, heading, slid.x, slid.y, spin.x, spin.y, spin.z])?;
        watch.observe(step, &moment);
        Ok(())
    })?;
    say(format_args!("sleigh and Suslov's body: {} steps of {} s\n", flags.run.steps, flags.run.step_size));
    say(&watch.table);
    csv.finish()?;
    figure::draw(flags, &watch, &path, &arrows)?;

    let mut claims = Claims::new();
    watch.claim(&mut claims);
    let mut order = |name: &str, errors: [f64; 3]| {
        Convergence { errors, reference: 0.0, steps: watch.window }.claim(Order::Second, name, &mut claims);
    };
    let (h, steps) = (flags.run.step_size, watch.window as usize);
    let far = |place: closed_form::Place, exact: &closed_form::Crossing, t: f64| place.distance(&exact.at(t));
    let turned = |state: &State<Sleigh>, t: f64| {
        let q = state.configuration();
        let angle = sleigh.turned(&exact[0], t);
        // sin(heading − angle)
        (q[(1, 0)] * angle.cos() - q[(0, 0)] * angle.sin()).abs()
    };
    let of_sleigh = |measure: &dyn Fn(&State<Sleigh>, f64) -> f64| refined(&sleigh, velocities.0, (h, steps), measure);
    order(
        "speed and turning against tanh and sech",
        of_sleigh(&|state, t| {
            let slid = slide(&state.momentum());
            far(sleigh.place(slid.x, slid.y), &exact[0], t)
        })?,
    );
    order("heading against β/a times gd(ct + δ)", of_sleigh(&turned)?);
    let of_body = |state: &State<Body>, t: f64| far(body.place(&(inverse * state.momentum())), &exact[1], t);
    order("Suslov's body against tanh and sech", refined(&body, velocities.1, (h, steps), &of_body)?);
    Ok(claims)
}

/// The largest errors of steps of h, h/2 and h/4.
fn refined<S>(
    system: &S,
    velocity: Vector3<f64>,
    (h, steps): (f64, usize),
    error: &dyn Fn(&State<S>, f64) -> f64,
) -> Result<[f64; 3], Failure>
where
    S: clebsch::Constrained<Scalar = f64, Configuration = Matrix3<f64>, Momentum = Vector3<f64>> + Clone,
{
    let mut errors = [0.0; 3];
    for (part, largest_error) in [1, 2, 4].into_iter().zip(&mut errors) {
        let h = h / part as f64;
        let stepper = system.stepper(h)?;
        let start = stepper.state_moving(Matrix3::identity(), velocity)?;
        let states = stepper.trajectory(start).take(steps * part + 1).collect::<Result<Vec<_>, _>>()?;
        *largest_error = largest(states.iter().enumerate().map(|(k, state)| error(state, k as f64 * h)));
    }
    Ok(errors)
}
