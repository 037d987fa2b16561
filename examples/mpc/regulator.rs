//! The linear–quadratic regulator at hover: Riccati's recursion over the horizon. Its matrices are differences of steps,
//! and its prices are written by hand. Nothing is taken from a derivative of the macro.

use super::declaration::{Follower, Place, Steering, Thrusts};
use super::place::{attitude, hovering, pose, position, turned};
use super::task::Task;
use clebsch::{Controlled, Target};
use clebsch_examples::claims::Claims;
use clebsch_examples::scene::Failure;
use clebsch_examples::table::Table;
use nalgebra::{Matrix3, Rotation3, SMatrix, SVector, Vector3};

type Change = SVector<f64, 12>;
type Square = SMatrix<f64, 12, 12>;

/// The size of differences, in units of a radian, a metre, 10 rad/s, 1 m/s and the thrust at hover.
const DIFFERENCE: f64 = 1e-4;
/// How far a measured order may be from 2.
const SLOPE: f64 = 0.1;

/// u = u₀ − K δ at the start of a horizon.
#[derive(Clone, Debug)]
pub struct Regulator {
    gain: SMatrix<f64, 4, 12>,
    /// The distance from the place to hover at, root mean square, that gusts of 1 m/s in each step lead to, m.
    pub reach: f64,
    steering: Steering,
    hover: Place,
}

impl Regulator {
    /// Of the horizon of plans.
    ///
    /// # Errors
    /// Those of a step.
    pub fn new(task: &Task) -> Result<Self, Failure> {
        // without an upper bound of thrusts; none comes near the lower one
        let system = Follower { top: f64::INFINITY, ..task.system.clone() };
        let (mass, hover) = (system.mass, hovering(&Vector3::zeros(), 0.0));
        let inertia = inertia(&system);
        let steering = system.clone().control(task.h)?.with_end_reference((Vector3::zeros(), Vector3::zeros()))?;
        let step = |change: &Change, thrusts: &Change| -> Result<Change, Failure> {
            let thrusts = Thrusts::from_fn(|i, _| system.hover * (1.0 + thrusts[i]));
            Ok(seen(&hover, &steering.follow(&moved(&hover, change), &thrusts)?))
        };
        let units = Change::from_fn(|i, _| [1.0, 1.0, inertia[(i % 3, i % 3)] * 10.0, mass][i / 3]);
        let (mut a, mut b) = (Square::zeros(), SMatrix::<f64, 12, 4>::zeros());
        for i in 0..12 {
            let by = Change::ith(i, DIFFERENCE * units[i]);
            let difference = step(&by, &Change::zeros())? - step(&-by, &Change::zeros())?;
            a.set_column(i, &(difference / (2.0 * by[i])));
        }
        for i in 0..4 {
            let by = Change::ith(i, DIFFERENCE);
            let difference = step(&Change::zeros(), &by)? - step(&Change::zeros(), &-by)?;
            b.set_column(i, &(difference / (2.0 * DIFFERENCE * system.hover)));
        }
        let diagonal = |turn: Vector3<f64>, off: f64, moving: f64| {
            Square::from_diagonal(&Change::from_fn(|i, _| [turn[i % 3], off, 0.0, moving][i / 3]))
        };
        let off = system.length.powi(-2);
        // |R − I|² = 4 − 4 cos of a turn
        let price = diagonal(Vector3::repeat(system.turn.powi(-2)), off, 0.0) * task.h;
        let mut cost = diagonal(Vector3::zeros(), off, (mass * system.speed).powi(-2)) * system.end_time;
        let slower = inertia.try_inverse().unwrap_or_else(|| Matrix3::repeat(f64::NAN)) / system.spin;
        cost.fixed_view_mut::<3, 3>(6, 6).copy_from(&(slower * slower * system.end_time));
        let effort = SMatrix::<f64, 4, 4>::identity() * (task.h / system.hover.powi(2));
        let mut gain = SMatrix::<f64, 4, 12>::zeros();
        for _ in 0..task.horizon {
            let by_input = cost * b;
            let solved = (effort + b.transpose() * by_input)
                .cholesky()
                .map(|factors| factors.solve(&(by_input.transpose() * a)));
            gain = solved.unwrap_or_else(|| SMatrix::repeat(f64::NAN));
            cost = price + a.transpose() * cost * (a - b * gain);
        }
        // Lyapunov's sum Σ ΦⁱW(Φᵀ)ⁱ by doubling
        let mut closed = a - b * gain;
        let mut variance = diagonal(Vector3::zeros(), 0.0, mass * mass);
        for _ in 0..16 {
            variance += closed * variance * closed.transpose();
            closed *= closed;
        }
        let reach = variance.fixed_view::<3, 3>(3, 3).trace().sqrt();
        Ok(Self { gain, reach, steering, hover })
    }

    /// Plans from places near hover: their first thrusts next to those of the regulator.
    ///
    /// # Errors
    /// Those of a plan.
    pub fn compare(&self, task: &Task, claims: &mut Claims) -> Result<Table<3>, Failure> {
        let inertia = inertia(&task.system);
        let mass = task.system.mass;
        let hover = Thrusts::repeat(task.system.hover);
        let away = |size: f64| {
            let spin = inertia * Vector3::new(0.2, -0.3, 0.1);
            let parts = [
                Vector3::new(0.06, -0.04, 0.05),
                Vector3::new(0.004, 0.005, -0.003),
                spin,
                Vector3::new(-0.03, 0.05, 0.04) * mass,
            ];
            Change::from_fn(|i, _| size * parts[i / 3][i % 3])
        };
        let mut table =
            Table::new(["near hover, in units of 0.09 rad and 7 mm", "thrusts off hover", "off the regulator"]);
        let mut errors = [0.0; 3];
        for (error, size) in errors.iter_mut().zip([1.0, 0.5, 0.25]) {
            let change = away(size);
            let start = moved(&self.hover, &change);
            let mut plan = vec![self.steering.stage(&start).with_input(hover); task.horizon];
            self.steering.refer(&mut plan, |j, _| {
                let (_, _, thrust, obstacle, apart) = task.reference(j, 0.0, false);
                (Vector3::zeros(), Matrix3::identity(), thrust, obstacle, apart)
            });
            let optimum = self.steering.solve(&start, Target::Free, &mut plan)?;
            let by_plan = optimum.stages()[0].input() - hover;
            let by_regulator = -self.gain * change;
            *error = (by_plan - by_regulator).norm() / task.system.hover;
            let number = |value: f64| format!("{value:.3e}");
            table.row([size.to_string(), number(by_plan.norm() / task.system.hover), number(*error)]);
        }
        let order = (errors[1] / errors[2]).log2();
        let reason = "order in the distance from hover, by Riccati's recursion in plain matrices";
        claims.within("the plan is the regulator", order, 2.0 - SLOPE..=2.0 + SLOPE, 3, reason);
        Ok(table)
    }
}

/// About the centre of mass, kg·m²: from ½ tr(J) I − J.
fn inertia(system: &Follower) -> Matrix3<f64> {
    let second: Matrix3<f64> = system.mass_matrix.fixed_view::<3, 3>(0, 0).into();
    Matrix3::identity() * second.trace() - second
}

/// The place at a turn (body frame), a distance (space), and momenta from another.
pub fn moved(place: &Place, change: &Change) -> Place {
    let part = |i: usize| Vector3::from(change.fixed_rows::<3>(i));
    let attitude = attitude(place) * Rotation3::new(part(0)).matrix();
    (pose(&attitude, &(position(place) + part(3))), place.1 + change.fixed_rows::<6>(6))
}

/// The change from one place to another, to third order of the turn.
fn seen(from: &Place, to: &Place) -> Change {
    let mut change = Change::zeros();
    change.fixed_rows_mut::<3>(0).copy_from(&turned(&attitude(from), &attitude(to)));
    change.fixed_rows_mut::<3>(3).copy_from(&(position(to) - position(from)));
    change.fixed_rows_mut::<6>(6).copy_from(&(to.1 - from.1));
    change
}
