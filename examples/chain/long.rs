//! A long run: the chain turns about the vertical while the hand rests, and its laws are watched.

use crate::watch::ROUNDINGS;
use crate::whip::{LENGTH, MASS, Whip};
use clebsch::{Clebsch, State};
use clebsch_examples::claims::{Claims, largest};
use clebsch_examples::progress::Progress;
use clebsch_examples::scene::{Failure, say};
use clebsch_examples::table::Table;
use nalgebra::{Matrix3, Vector3, Vector6};

/// Of the chain about the vertical at the start, rad/s.
const RATE: f64 = 1.0;

/// How far a chain is from its laws.
#[derive(Clone, Copy, Default)]
struct Laws {
    /// By how much the joints are open (m), and how fast they open (m/s).
    gaps: [f64; 2],
    /// The largest entry of RᵀR − I.
    orthogonality: f64,
    /// Change of the angular momentum about the vertical, kg·m²/s.
    momentum: f64,
    /// Change of the energy, joules.
    energy: f64,
}

impl Laws {
    fn with(self, other: Laws) -> Laws {
        Laws {
            gaps: std::array::from_fn(|i| largest([self.gaps[i], other.gaps[i]])),
            orthogonality: largest([self.orthogonality, other.orthogonality]),
            momentum: largest([self.momentum, other.momentum]),
            energy: largest([self.energy, other.energy]),
        }
    }
}

/// The angular momentum about the vertical through the hand.
fn vertical<const N: usize>(state: &State<Whip<N>>) -> f64 {
    let of_link = |(q, n): (&nalgebra::Matrix4<f64>, Vector6<f64>)| {
        let (turn, centre) = (q.fixed_view::<3, 3>(0, 0), q.fixed_view::<3, 1>(0, 3).into_owned());
        let (spin, push) = (turn * n.fixed_rows::<3>(0), turn * n.fixed_rows::<3>(3));
        (spin + centre.cross(&push)).y
    };
    state.configuration().iter().zip(state.momentum()).map(of_link).sum()
}

/// Steps a chain of N links whose hand rests, prints its laws at the powers of ten, and claims them.
///
/// # Errors
/// Those of steps.
pub fn run<const N: usize>(
    whip: &Whip<N>,
    (lean, h, steps): (f64, f64, u64),
    claims: &mut Claims,
) -> Result<(), Failure> {
    let whip = Whip { hand: Vector3::zeros(), ..whip.clone() };
    let stepper = whip.stepper(h)?;
    let (places, _) = whip.start(lean);
    // all of it turns about the vertical like one body
    let velocities = places.map(|place| {
        let (turn, centre) = (place.fixed_view::<3, 3>(0, 0).transpose(), place.fixed_view::<3, 1>(0, 3).into_owned());
        let (spin, moving) = (turn * Vector3::y() * RATE, turn * (Vector3::y() * RATE).cross(&centre));
        Vector6::new(spin.x, spin.y, spin.z, moving.x, moving.y, moving.z)
    });
    let start = stepper.state_moving(places, velocities)?;
    let (momentum, energy) = (vertical(&start), stepper.energy(&start));
    let (mut state, mut worst, mut due) = (start, Laws::default(), 10);
    let mut speed = 0.0_f64;
    let mut table = Table::new([
        "steps",
        "joints open / m",
        "and open at / m/s",
        "RᵀR − I",
        "vertical momentum / kg m²/s",
        "energy / J",
    ]);
    let mut progress = Progress::new(steps);
    for step in 1..=steps {
        state = stepper.step(&state).map_err(|error| Failure::Step { step, error })?;
        let look = whip.look(h * step as f64, &state);
        let defect = |q: &nalgebra::Matrix4<f64>| {
            let turn = q.fixed_view::<3, 3>(0, 0);
            (turn.transpose() * turn - Matrix3::identity()).amax()
        };
        speed = speed.max(look.speed);
        worst = worst.with(Laws {
            gaps: look.gaps,
            orthogonality: largest(state.configuration().iter().map(defect)),
            momentum: (vertical(&state) - momentum).abs(),
            energy: (stepper.energy(&state) - energy).abs(),
        });
        if step == due || step == steps {
            let Laws { gaps: [gap, opening], orthogonality, momentum, energy } = worst;
            let [gap, opening, orthogonality, momentum, energy] =
                [gap, opening, orthogonality, momentum, energy].map(|number| format!("{number:.1e}"));
            table.row([step.to_string(), gap, opening, orthogonality, momentum, energy]);
            due = due.saturating_mul(10);
        }
        progress.reached(step);
    }
    say(format_args!("the hand rests, and {N} links turn about the vertical: the largest of each in so many steps\n"));
    say(table);
    let bound = ROUNDINGS * f64::EPSILON;
    claims.at_most("long run: joints are closed, m", worst.gaps[0], bound * (1.0 + LENGTH), "sweeps end at rounding");
    let name = "long run: joints do not open, m/s";
    claims.at_most(name, worst.gaps[1], bound * N as f64 * (1.0 + speed), "one solution of N joints");
    claims.round_off("long run: attitudes are rotations", worst.orthogonality, steps, 1.0);
    let name = "long run: angular momentum about the vertical, kg·m²/s";
    claims.round_off(name, worst.momentum, steps, MASS * LENGTH * (1.0 + speed));
    Ok(())
}
