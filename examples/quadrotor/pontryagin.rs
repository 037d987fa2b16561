//! The continuous problem by Pontryagin's conditions: nothing here is derived by the macro, and velocities are those in space.
//!
//! Ṙ = R ω̂, ẋ = v, v̇ = (Σu/m) R e₃ − g e₃, π̇ = π × ω + Σ uᵢτᵢ with ω = J⁻¹π. The costates a of x, b of v, c of R and
//! ν of π obey ȧ = 0, ḃ = −a and the following equations. ċ = c × ω − (Σu/m) e₃ × Rᵀb, ν̇ = ν × ω − J⁻¹(c + ν × π). The
//! Hamiltonian is least for uᵢ = u₀ − u₀² (b·R e₃/m + ν·τᵢ), cut off at the bounds. Here u₀ is the thrust at hover.
//! Units: SI, but the duration is 1.
//!
//! Errors grow a hundred thousandfold from one end to the other: shots are made from the middle to both ends.

use super::declaration::{Place, Stage, Thrusts};
use super::place::{attitude, position, spin, turned, velocity};
use super::plan::Plan;
use super::problem::Problem;
use super::vehicle::{GRAVITY, Vehicle};
use clebsch_examples::extremal::{self, Pontryagin, Shot};
use nalgebra::{Matrix3, Rotation3, SMatrix, SVector, Vector3, Vector4};

/// R, x, v, π, a, b, c, ν and the effort so far.
type Packed = SVector<f64, 31>;
/// Where an extremal is.
pub type Motion = extremal::Motion<31, 4>;
/// A turn of the attitude, x, v, π, a, b, c, ν in the middle.
type Middle = SVector<f64, 24>;

/// Extremals of a problem, from the middle.
#[derive(Clone, Copy, Debug)]
pub struct Extremals {
    vehicle: Vehicle,
    inverse_inertia: Matrix3<f64>,
    /// The torque of each rotor for a thrust, m.
    torques: SMatrix<f64, 3, 4>,
    start: Place,
    goal: Place,
    /// The attitude in the middle that turns are counted from.
    attitude: Matrix3<f64>,
    /// The step in the middle, and the number of steps.
    middle: u64,
    steps: u64,
    /// s; negative backwards.
    duration: f64,
}

fn part(y: &Packed, row: usize) -> Vector3<f64> {
    y.fixed_rows::<3>(row).into()
}

/// The difference between motion and place: angle, rad, distance, m, velocity, m/s, and angular momentum, N·m·s.
pub fn apart(motion: &Motion, place: &Place, mass: f64) -> [Vector3<f64>; 4] {
    let turned = turned(&attitude(place), &Matrix3::from_column_slice(&motion.y.as_slice()[..9]));
    let (x, v, pi) = (part(&motion.y, 9), part(&motion.y, 12), part(&motion.y, 15));
    [turned, x - position(place), v - velocity(place, mass), pi - spin(place)]
}

impl Extremals {
    /// Of a problem.
    pub fn new(problem: &Problem) -> Self {
        let Problem { vehicle, start, goal, duration, steps, .. } = *problem;
        let torques =
            SMatrix::from_columns(&std::array::from_fn::<_, 4, _>(|rotor| Vehicle::torque(&Thrusts::ith(rotor, 1.0))));
        let inverse_inertia = vehicle.inertia.try_inverse().unwrap_or_else(|| Matrix3::repeat(f64::NAN));
        let (attitude, middle) = (Matrix3::identity(), steps / 2);
        Self { vehicle, inverse_inertia, torques, start, goal, attitude, middle, steps, duration }
    }

    /// The extremal from hovering to hovering near a plan, at half steps, its effort, and its error bound. `None` where
    /// corrections do not end.
    pub fn aim(&self, near: &Plan) -> Option<(Vec<Motion>, f64, f64)> {
        let stage = near.stages.get(self.middle as usize)?;
        let ahead = Self { attitude: attitude(stage.place()), ..*self };
        let back = Self { duration: -self.duration, ..ahead };
        let guess = ahead.guess(stage);
        let units = Middle::from_fn(|row, _| if row < 3 { 1.0 } else { guess.fixed_rows::<3>(row / 3 * 3).norm() });
        let share = self.middle as f64 / self.steps as f64;
        let shot = Shot::aim(&guess, &units, |middle| {
            let from = ahead.begin(ahead.pack(middle));
            let (first, last) = (back.after(&from, share), ahead.after(&from, 1.0 - share));
            let parts = [apart(&first, &self.start, self.vehicle.mass), apart(&last, &self.goal, self.vehicle.mass)];
            let missed = parts.iter().flatten().flat_map(|part| part.iter().copied());
            (Middle::from_iterator(missed), first.error + last.error)
        })?;
        let from = ahead.begin(ahead.pack(&shot.costates));
        let mut path = back.path(Motion { switches: 0, ..from }, 2 * self.middle, share);
        path.reverse();
        path.extend(ahead.path(from, 2 * (self.steps - self.middle), 1.0 - share).drain(1..));
        let effort = path.last()?.y[30] - path.first()?.y[30];
        Some((path, effort, shot.error))
    }

    /// A place of a plan with its costates as those of velocities in space.
    fn guess(&self, stage: &Stage) -> Middle {
        let (place, mass) = (stage.place(), self.vehicle.mass);
        let (attitude, momentum) = (attitude(place), place.1.fixed_rows::<3>(3).into_owned());
        let of = |row: usize| -> Vector3<f64> { stage.costate().fixed_rows::<3>(row).into() };
        let [turning, moving, spinning, driving] = [0, 3, 6, 9].map(of);
        let costates = [attitude * moving, attitude * driving * mass, turning + driving.cross(&momentum), spinning];
        let places = [Vector3::zeros(), position(place), velocity(place, mass), spin(place)];
        Middle::from_iterator(places.iter().chain(&costates).flat_map(|part| part.iter().copied()))
    }

    fn pack(&self, middle: &Middle) -> Packed {
        let turn = Rotation3::new(middle.fixed_rows::<3>(0).into_owned());
        let mut y = Packed::zeros();
        y.as_mut_slice()[..9].copy_from_slice((self.attitude * turn.matrix()).as_slice());
        y.fixed_rows_mut::<21>(9).copy_from(&middle.fixed_rows::<21>(3));
        y
    }

    /// Thrusts as they would be without bounds, N.
    fn unbounded(&self, y: &Packed) -> Vector4<f64> {
        let hover = self.vehicle.hover();
        let axis = Matrix3::from_column_slice(&y.as_slice()[..9]).column(2).into_owned();
        let lift = part(y, 21).dot(&axis) / self.vehicle.mass;
        (self.torques.tr_mul(&part(y, 27)).add_scalar(lift) * -(hover * hover)).add_scalar(hover)
    }
}

impl Pontryagin<31, 4> for Extremals {
    fn field(&self, y: &Packed, held: [i8; 4]) -> Packed {
        let (mass, hover, free) = (self.vehicle.mass, self.vehicle.hover(), self.unbounded(y));
        let thrusts = Vector4::from_fn(|rotor, _| match held[rotor] {
            0 => free[rotor],
            side => {
                if side > 0 {
                    self.vehicle.top
                } else {
                    0.0
                }
            }
        });
        let attitude = Matrix3::from_column_slice(&y.as_slice()[..9]);
        let (momentum, a, b, c, nu) = (part(y, 15), part(y, 18), part(y, 21), part(y, 24), part(y, 27));
        let (omega, lift) = (self.inverse_inertia * momentum, thrusts.sum() / mass);
        let mut rate = Packed::zeros();
        rate.as_mut_slice()[..9].copy_from_slice((attitude * omega.cross_matrix()).as_slice());
        let rates = [
            part(y, 12),
            attitude.column(2) * lift - Vector3::z() * GRAVITY,
            momentum.cross(&omega) + self.torques * thrusts,
            Vector3::zeros(),
            -a,
            c.cross(&omega) - Vector3::z().cross(&attitude.tr_mul(&b)) * lift,
            nu.cross(&omega) - self.inverse_inertia * (c + nu.cross(&momentum)),
        ];
        for (row, of) in (9..).step_by(3).zip(&rates) {
            rate.fixed_rows_mut::<3>(row).copy_from(of);
        }
        rate[30] = thrusts.map(|thrust| thrust / hover - 1.0).norm_squared() / 2.0;
        rate * self.duration
    }

    fn wanted(&self, y: &Packed) -> [i8; 4] {
        let free = self.unbounded(y);
        std::array::from_fn(|rotor| i8::from(free[rotor] > self.vehicle.top) - i8::from(free[rotor] < 0.0))
    }
}
