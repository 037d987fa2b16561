//! The extremal between two points for several numbers of steps: exactly inscribed in the great circle.

use crate::great_circle::GreatCircle;
use clebsch::{Clebsch, Extremal, Guess, Variational};
use clebsch_examples::claims::Claims;
use clebsch_examples::round_off;
use clebsch_examples::scene::{Failure, say};
use clebsch_examples::table::Table;
use nalgebra::{SMatrix, SVector};

/// Numbers of steps.
const STEPS: [usize; 5] = [1, 2, 10, 100, 1000];

/// Distances of an extremal from the polygon inscribed in an arc.
#[derive(Clone, Copy, Debug, Default)]
pub struct Defects {
    /// The largest |q_k − q(k/N)|, the end among them.
    pub points: f64,
    /// The largest |w_k − w(k/N)| of the velocities that the momenta stand for, in units of 1/h.
    pub velocities: f64,
    /// The largest |N_k − N_0|, in units of 1/h.
    pub momentum_moved: f64,
    /// Of the action, relative.
    pub action: f64,
}

impl Defects {
    /// Of an extremal from the polygon inscribed in `circle`.
    ///
    /// A point of unit mass at q with the velocity w has the momentum M = ½(w qᵀ − q wᵀ) of the trace pairing: w = 2Mq.
    pub fn of<S, const D: usize, const M: usize>(extremal: &Extremal<'_, S, M>, circle: &GreatCircle<D>, h: f64) -> Self
    where
        S: Variational<M> + Clebsch<Scalar = f64, Configuration = SVector<f64, D>>,
        S::MomentumMatrix: Into<SMatrix<f64, D, D>>,
    {
        let steps = extremal.nodes().len();
        let action = circle.action(steps, h);
        let mut defects = Self { action: (extremal.action() / action - 1.0).abs(), ..Self::default() };
        for (k, state) in extremal.states().enumerate() {
            let (s, q) = (k as f64 / steps as f64, state.configuration());
            let matrix: SMatrix<f64, D, D> = S::momentum_matrix(&state.momentum()).into();
            let closed = circle.tangent(s) * circle.speed(steps, h);
            let moved = (state.momentum() - extremal.momentum()).norm() * h;
            defects.points = defects.points.max((q - circle.point(s)).norm());
            defects.velocities = defects.velocities.max((matrix * q * 2.0 - closed).norm() * h);
            defects.momentum_moved = defects.momentum_moved.max(moved);
        }
        defects
    }

    /// The largest of all.
    pub fn largest(&self) -> f64 {
        self.points.max(self.velocities).max(self.momentum_moved).max(self.action)
    }

    /// The largest over the worst case of rounding in so many steps.
    pub fn over_rounding(&self, steps: usize) -> f64 {
        self.largest() / round_off::worst_case(steps as u64, 1.0)
    }
}

/// The reference of [`Defects::over_rounding`], in words.
pub const ROUNDING: &str = "of the worst case of rounding; points, velocities, momenta, action";

/// Solves between two points with 1, 2, 10, 100 and 1000 steps, prints and claims the closed form.
pub fn inscribe<S, const D: usize, const M: usize>(
    sphere: S,
    (start, target): (SVector<f64, D>, SVector<f64, D>),
    duration: f64,
    claims: &mut Claims,
) -> Result<(), Failure>
where
    S: Variational<M> + Clebsch<Scalar = f64, Configuration = SVector<f64, D>> + Clone,
    S::MomentumMatrix: Into<SMatrix<f64, D, D>>,
{
    let circle = GreatCircle::between(start, target);
    let mut table = Table::new([
        "steps",
        "action / J s",
        "its error",
        "from the circle",
        "momentum moved",
        "gap",
        "iterations",
        "index",
    ]);
    let (mut largest, mut index) = (0.0_f64, 0);
    for steps in STEPS {
        let h = duration / steps as f64;
        let stepper = sphere.clone().into_stepper(h)?;
        let boundary = stepper.boundary();
        let mut path = vec![boundary.rest(&start); steps];
        let extremal = boundary.solve(&start, &target, Guess::Geodesic, &mut path)?;
        let defects = Defects::of(&extremal, &circle, h);
        table.row([
            steps.to_string(),
            format!("{:.12}", extremal.action()),
            format!("{:.1e}", defects.action),
            format!("{:.1e}", defects.points),
            format!("{:.1e}", defects.momentum_moved),
            format!("{:.1e}", extremal.gap()),
            extremal.iterations().to_string(),
            extremal.negative().to_string(),
        ]);
        largest = largest.max(defects.over_rounding(steps));
        index = index.max(extremal.negative());
    }
    let sphere = D - 1;
    claims.at_most(&format!("S{sphere}: any number of steps gives the great circle"), largest, 1.0, ROUNDING);
    claims.holds(&format!("S{sphere}: it is a minimum"), index == 0, "the index is 0 for each number of steps");
    say(format_args!("a great circle of S{sphere}: {:.6} rad\n", circle.angle));
    say(table);
    Ok(())
}
