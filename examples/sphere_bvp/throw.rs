//! How to throw the bob of a spherical pendulum so that it arrives: the two-point problem, checked by shooting.

use crate::arrival::{converge, launch};
use crate::great_circle::GreatCircle;
use crate::{Flags, SphericalPendulum};
use clebsch::{Clebsch, Differentiated, Guess, Node, Stepper};
use clebsch_examples::claims::Claims;
use clebsch_examples::convergence::Convergence;
use clebsch_examples::flags::Order;
use clebsch_examples::round_off;
use clebsch_examples::scene::Failure;
use clebsch_examples::table::Table;
use nalgebra::Vector3;

/// Paths of unit length that are less apart are the same.
const NOTICEABLE: f64 = 1e-3;
/// Parts in which gravity is switched on.
const PARTS: u32 = 8;

/// Which of the extremals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Way {
    /// From the guess of the great circle: a minimum is looked for.
    Short,
    /// From the great circle the other way round, while gravity is switched on part by part.
    Long,
}

/// One throw.
pub struct Throw {
    /// The way round.
    pub name: &'static str,
    /// Position and momentum at all vertices.
    pub path: Vec<(Vector3<f64>, Vector3<f64>)>,
    /// q̇ at the start, 1/s.
    velocity: Vector3<f64>,
    action: f64,
    index: usize,
    iterations: u32,
    gap: f64,
    residual: f64,
    /// The largest distance of the stepper's path with the momentum that was found.
    shot: f64,
    convergence: Convergence,
}

impl Way {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Short => "the short way",
            Self::Long => "the long way",
        }
    }

    /// Nodes and guess to start from.
    ///
    /// # Errors
    /// Of the problems with less gravity.
    pub fn guess<M: Differentiated<SphericalPendulum, 3>>(
        self,
        flags: &Flags,
        part: u64,
    ) -> Result<(Vec<Node<SphericalPendulum, 3>>, Guess<f64, 3>), Failure> {
        let (from, to) = flags.ends();
        let pendulum = |gravity| -> Result<Stepper<SphericalPendulum, M>, Failure> {
            Ok(SphericalPendulum { gravity }.into_stepper_by::<M>(flags.run.step_size / part as f64)?)
        };
        let mut path = vec![pendulum(0.0)?.boundary().rest(&from); (flags.run.steps * part) as usize];
        if self == Self::Short {
            return Ok((path, Guess::Geodesic));
        }
        let circle = GreatCircle::between(from, to).other_way();
        let velocity = from.cross(&circle.direction) * (circle.angle / flags.run.duration());
        let mut guess = Guess::Velocity(velocity);
        for gravity in (0..PARTS).map(|part| flags.gravity * f64::from(part) / f64::from(PARTS)) {
            pendulum(gravity)?.boundary().solve(&from, &to, guess, &mut path)?;
            guess = Guess::Path;
        }
        Ok((path, guess))
    }
}

impl Throw {
    /// Solves, shoots, and measures the order.
    pub fn find<M: Differentiated<SphericalPendulum, 3>>(way: Way, flags: &Flags) -> Result<Self, Failure> {
        let (run, (from, to)) = (&flags.run, flags.ends());
        let stepper = SphericalPendulum { gravity: flags.gravity }.into_stepper_by::<M>(run.step_size)?;
        let (mut path, guess) = way.guess::<M>(flags, 1)?;
        let extremal = stepper.boundary().solve(&from, &to, guess, &mut path)?;
        let mut shot = 0.0_f64;
        let start = stepper.state(from, *extremal.momentum())?;
        for ((step, state), found) in (0..).zip(stepper.trajectory(start)).zip(extremal.states()) {
            let state = state.map_err(|error| Failure::Step { step, error })?;
            shot = shot.max((state.configuration() - found.configuration()).norm());
        }
        Ok(Self {
            name: way.name(),
            path: extremal.states().map(|state| state.into_parts()).collect(),
            velocity: launch(extremal.momentum(), flags, run.step_size),
            action: extremal.action(),
            index: extremal.negative(),
            iterations: extremal.iterations(),
            gap: extremal.gap(),
            residual: extremal.residual(),
            shot,
            convergence: converge::<M>(way, flags)?,
        })
    }

    /// It arrives, by the steps and by the equations of motion.
    pub fn claim(&self, flags: &Flags, claims: &mut Claims) {
        let (name, run) = (self.name, &flags.run);
        let fastest = self.path.iter().fold(1.0, |fastest: f64, (_, n)| fastest.max(n.norm()));
        let vertical = self.path.iter().fold(0.0, |moved: f64, (_, n)| moved.max((n.z - self.path[0].1.z).abs()));
        claims.round_off(&format!("{name}: the bob arrives"), self.gap, run.steps, 1.0);
        claims.round_off(&format!("{name}: the vertical momentum N3 is constant"), vertical, run.steps, fastest);
        // Near the upper equilibrium distances grow like e^(t√g), elsewhere more slowly.
        let growth = (run.duration() * flags.gravity.abs().sqrt()).exp();
        let (shot, bound) = (self.shot, round_off::worst_case(run.steps, growth * fastest));
        claims.at_most(
            &format!("{name}: steps from its momentum give its path"),
            shot,
            bound,
            "rounding, as it may grow",
        );
        self.convergence.claim(Order::Second, &format!("{name}: the order, by the equations of motion"), claims);
    }

    /// A row of [`table`].
    fn row(&self) -> [String; 8] {
        let [x, y, z] = self.velocity.into();
        [
            self.name.to_owned(),
            format!("{x:.4},{y:.4},{z:.4}"),
            format!("{:.9}", self.action),
            self.index.to_string(),
            self.iterations.to_string(),
            format!("{:.1e}", self.residual),
            format!("{:.1e}", self.gap),
            self.convergence.errors.map(|error| format!("{error:.2e}")).join(" "),
        ]
    }
}

/// Throws side by side.
pub fn table<'a>(throws: impl Iterator<Item = &'a Throw>) -> Table<8> {
    let missed = "missed by, with h, h/2, h/4";
    let mut table =
        Table::new(["throw", "velocity / (1/s)", "action / J s", "index", "iterations", "residual", "gap", missed]);
    throws.for_each(|throw| table.row(throw.row()));
    table
}

/// The short throw is a minimum, the long one is another extremal.
pub fn compare(short: &Throw, long: Option<&Throw>, flags: &Flags, claims: &mut Claims) {
    let name = "the short throw is a minimum";
    if short.index == 0 {
        claims.holds(name, true, "index 0");
    } else {
        claims.skip(name, "a saddle by symmetry, from which no gradient leads away");
    }
    let name = "the long throw is another one, and no minimum";
    let apart = |long: &Throw| {
        let pairs = short.path.iter().zip(&long.path);
        pairs.fold(0.0, |apart: f64, (a, b)| apart.max((a.0 - b.0).norm()))
    };
    match long.map(|long| (long, apart(long))) {
        Some((long, apart)) if apart > NOTICEABLE => {
            long.claim(flags, claims);
            claims.holds(name, long.index >= 1, &format!("index {}; the paths are up to {apart:.2} apart", long.index));
        }
        _ => claims.skip(name, "as gravity grows the long way ends: too weak a throw for so long a time"),
    }
}
