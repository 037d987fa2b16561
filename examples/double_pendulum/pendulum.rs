//! Two bodies that hang by ball joints, and Newton's laws for them in the angular velocities alone.

use crate::linkages::Pendulum;
use crate::watch::Law;
use clebsch::State;
use nalgebra::{Matrix3, Matrix4, SMatrix, SVector, Vector3};

/// R and ω of both bodies, column by column.
pub type Angular = SVector<f64, 24>;

/// A motion of both bodies by their attitudes and angular velocities in the body.
#[derive(Clone, Copy, Debug)]
pub struct Turning {
    /// Body to space.
    pub attitudes: [Matrix3<f64>; 2],
    /// Radians per second.
    pub omegas: [Vector3<f64>; 2],
}

impl Turning {
    /// All numbers in one vector.
    pub fn vector(&self) -> Angular {
        let [upper, lower] = self.attitudes;
        let numbers = upper.iter().chain(lower.iter()).chain(self.omegas.iter().flat_map(|omega| omega.iter()));
        Angular::from_iterator(numbers.copied())
    }

    fn of(y: &Angular) -> Self {
        let attitude = |at: usize| Matrix3::from_column_slice(&y.as_slice()[at..at + 9]);
        let omega = |at: usize| y.fixed_rows::<3>(at).into_owned();
        Self { attitudes: [attitude(0), attitude(9)], omegas: [omega(18), omega(21)] }
    }
}

impl Pendulum {
    /// A rod of 1 kg and one of 0.7 kg.
    pub fn new(gravity: f64) -> Self {
        let second_moment = |moments: Vector3<f64>| Matrix3::from_diagonal(&(-moments).add_scalar(moments.sum() / 2.0));
        Self {
            second_moments: [Vector3::new(0.09, 0.085, 0.01), Vector3::new(0.04, 0.038, 0.005)].map(second_moment),
            mass: [1.0, 0.7],
            gravity,
            near: [Vector3::z() * 0.5, Vector3::z() * 0.4],
            far: Vector3::z() * -0.5,
        }
    }

    fn inertia(&self, i: usize) -> Matrix3<f64> {
        Matrix3::identity() * self.second_moments[i].trace() - self.second_moments[i]
    }

    /// From the pivot to the lower joint, in the upper body.
    fn arm(&self) -> Vector3<f64> {
        self.far - self.near[0]
    }

    /// Places and velocities of both bodies.
    pub fn start(&self, turning: &Turning) -> ([Matrix4<f64>; 2], SVector<f64, 12>) {
        let ([upper, lower], [first, second]) = (turning.attitudes, turning.omegas);
        let centres = [-(upper * self.near[0]), upper * self.arm() - lower * self.near[1]];
        let joint = upper * first.cross(&self.arm());
        let velocities = [self.near[0].cross(&first), lower.transpose() * joint + self.near[1].cross(&second)];
        let placed = |i: usize| {
            let mut place = turning.attitudes[i].to_homogeneous();
            place.fixed_view_mut::<3, 1>(0, 3).copy_from(&centres[i]);
            place
        };
        let parts = [first, velocities[0], second, velocities[1]];
        ([placed(0), placed(1)], SVector::from_iterator(parts.iter().flat_map(|part| part.iter().copied())))
    }

    /// Attitudes and angular velocities of a state, by hand.
    pub fn turning(&self, state: &State<Self>) -> Turning {
        let (q, n) = (state.configuration(), state.momentum());
        let omega = |i: usize| self.inertia(i).try_inverse().unwrap_or_default() * n.fixed_rows::<3>(6 * i);
        Turning { attitudes: [0, 1].map(|i| q[i].fixed_view::<3, 3>(0, 0).into_owned()), omegas: [omega(0), omega(1)] }
    }

    /// By how much both joints are open (metres), and how fast they open (m/s).
    pub fn gaps(&self, state: &State<Self>) -> (f64, f64) {
        let (q, n, turning) = (state.configuration(), state.momentum(), self.turning(state));
        let at = |i: usize, point: &Vector3<f64>| {
            let velocity = n.fixed_rows::<3>(6 * i + 3) / self.mass[i] + turning.omegas[i].cross(point);
            (turning.attitudes[i] * point + q[i].fixed_view::<3, 1>(0, 3), turning.attitudes[i] * velocity)
        };
        let (pivot, joint, other) = (at(0, &self.near[0]), at(0, &self.far), at(1, &self.near[1]));
        (pivot.0.norm().max((joint.0 - other.0).norm()), pivot.1.norm().max((joint.1 - other.1).norm()))
    }

    /// The angular momentum about the vertical through the pivot.
    pub fn vertical(&self, state: &State<Self>) -> f64 {
        let (q, n) = (state.configuration(), state.momentum());
        let of = |i: usize| {
            let (attitude, at) = (q[i].fixed_view::<3, 3>(0, 0), q[i].fixed_view::<3, 1>(0, 3).into_owned());
            let linear = attitude * n.fixed_rows::<3>(6 * i + 3);
            (attitude * n.fixed_rows::<3>(6 * i) + at.cross(&linear)).z
        };
        of(0) + of(1)
    }
}

impl Law<24> for Pendulum {
    /// R′ and ω′. The force at the lower joint is that which the acceleration of the lower centre of mass takes.
    ///
    /// ```text
    /// (J₁ + m₁ c^ᵀc^) ω₁′ = … − d × R₁ᵀ f,    J₂ ω₂′ = … + a × R₂ᵀ f,    f = m₂ (x₂″ + g e₃)
    /// x₂ = R₁ d − R₂ a
    /// ```
    fn law(&self, y: &Angular) -> Angular {
        let Turning { attitudes: [upper, lower], omegas: [first, second] } = Turning::of(y);
        let (centre, d, a) = (-self.near[0], self.arm(), self.near[1]);
        let [m, n] = self.mass;
        let weight = |attitude: &Matrix3<f64>| attitude.transpose() * Vector3::z() * -self.gravity;
        let hat = |v: &Vector3<f64>| v.cross_matrix();
        // x₂″ = turned · (ω₁′, ω₂′) + spun
        let turned = [-upper * hat(&d), lower * hat(&a)];
        let spun = upper * first.cross(&first.cross(&d)) - lower * second.cross(&second.cross(&a));
        let force = (spun + Vector3::z() * self.gravity) * n;
        let about = self.inertia(0) + hat(&centre).transpose() * hat(&centre) * m;
        let levers = [-hat(&d) * upper.transpose(), hat(&a) * lower.transpose()];
        let torques = [
            centre.cross(&(weight(&upper) * m)) - first.cross(&(about * first)) + levers[0] * force,
            levers[1] * force - second.cross(&(self.inertia(1) * second)),
        ];
        let mut matrix = SMatrix::<f64, 6, 6>::zeros();
        let mut right = SVector::<f64, 6>::zeros();
        for (i, inertia) in [about, self.inertia(1)].into_iter().enumerate() {
            right.fixed_rows_mut::<3>(3 * i).copy_from(&torques[i]);
            for (j, turned) in turned.iter().enumerate() {
                let own = if i == j { inertia } else { Matrix3::zeros() };
                matrix.fixed_view_mut::<3, 3>(3 * i, 3 * j).copy_from(&(own - levers[i] * turned * n));
            }
        }
        let change = matrix.lu().solve(&right).unwrap_or(SVector::repeat(f64::NAN));
        let omegas = [change.fixed_rows::<3>(0).into_owned(), change.fixed_rows::<3>(3).into_owned()];
        Turning { attitudes: [upper * hat(&first), lower * hat(&second)], omegas }.vector()
    }

    /// Of the attitudes.
    fn distance(&self, one: &Angular, other: &Angular) -> f64 {
        // |R − S| is √2 times the angle, for small ones
        ((one - other).fixed_rows::<18>(0).norm_squared() / 2.0).sqrt()
    }
}
