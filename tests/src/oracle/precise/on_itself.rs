//! A group that acts on itself, whatever the group. It is one problem, so that its steps are compiled once, here, where
//! they are optimised, and not by each test that uses it.

use super::double_double::DoubleDouble;
use super::equation::{Equation, NoSolution};
use super::group::Group;
use super::matrix::Matrix;
use super::problem::{Factor, Problem, right};
use super::real::Real;
use super::step::{State, composed_trajectory, trajectory};

/// The kind of an element in a declaration; here all are square matrices.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The matrix itself.
    Matrix,
    /// A vector a as (I a; 0 1).
    Vector,
    /// A unit quaternion as the matrix of multiplication by it from the left; it is the last column.
    Quaternion,
}

/// The numbers that a declaration sees of an element.
pub fn shown<R: Copy>(kind: Kind, matrix: &Matrix<R>) -> Matrix<R> {
    let n = matrix.shape().0;
    match kind {
        Kind::Matrix => matrix.clone(),
        Kind::Vector => matrix.translation(),
        Kind::Quaternion => matrix.block(0..n, n - 1..n),
    }
}

/// How the kinetic energy is made.
#[derive(Clone, Debug)]
pub enum Kinetic {
    /// tr(W (F − I)(F − I)ᵀ)/(2h), a·Wa/(2h), 2 v·Wv/h with the vector part v of a quaternion.
    Chord(Matrix<f64>),
    /// h/2 ξ·Jξ with the coordinates ξ of 2(F − I)(F + I)⁻¹/h, projected to the algebra.
    Cayley(Matrix<f64>),
    /// The same with those of (F − I)/h, projected.
    Projection(Matrix<f64>),
    /// The same with those of log F/h.
    Exponential(Matrix<f64>),
}

/// A group that acts on itself from the right, with V(q) = A·q + (B·q)³/3.
#[derive(Clone, Debug)]
pub struct OnItself {
    /// The group.
    pub group: Group,
    /// The kind of its elements.
    pub kind: Kind,
    /// Its kinetic energy.
    pub kinetic: Kinetic,
    /// A.
    pub linear: Matrix<f64>,
    /// B.
    pub cubic: Matrix<f64>,
}

impl Kinetic {
    /// The one with this name in a declaration.
    pub fn of(discretization: &str, inertia: Matrix<f64>) -> Kinetic {
        match discretization {
            "cayley" => Kinetic::Cayley(inertia),
            "projection" => Kinetic::Projection(inertia),
            other => panic!("no discretisation `{other}`"),
        }
    }
}

impl OnItself {
    /// exp of the algebra element with these components.
    pub fn element(&self, components: &[f64]) -> Matrix<f64> {
        self.group.combination(components).exponential()
    }

    /// F⁻ℓd and F⁺ℓd at the time 0.
    pub fn legendre(&self, h: f64, q: &Matrix<f64>, f: &Matrix<f64>) -> [Vec<f64>; 2] {
        let (q, f) = (std::slice::from_ref(q), std::slice::from_ref(f));
        let equation = Equation { problem: self, factors: &self.factors(), t: 0.0, h, q };
        [equation.residual(f), equation.next_momentum(f)]
    }

    /// The states of a motion to 30 digits, in steps of ℓd or of ℓd composed with its adjoint.
    pub fn trajectory(
        &self,
        composed: bool,
        h: f64,
        start: &State<f64>,
        steps: usize,
    ) -> Result<Vec<State<DoubleDouble>>, NoSolution> {
        let (h, start) = (DoubleDouble::of(h), start.lift());
        if composed { composed_trajectory(self, h, &start, steps) } else { trajectory(self, h, &start, steps) }
    }

    /// The coordinates of the projection of a matrix to the algebra: G⁻¹⟨A, E_i⟩.
    fn coordinates<R: Real>(&self, a: &Matrix<R>) -> Matrix<R> {
        let basis = &self.group.basis;
        let gram = Matrix::from_fn(basis.len(), basis.len(), |i, j| basis[i].dot(&basis[j]));
        let components: Vec<R> = basis.iter().map(|e| e.lift().dot(a)).collect();
        gram.lift().solve(&Matrix::vector(&components))
    }

    fn velocity<R: Real>(&self, h: R, f: &Matrix<R>) -> Matrix<R> {
        let one = Matrix::identity(self.group.size());
        let speed = match &self.kinetic {
            // as for rotations: tan(θ/2) is the vector part over the scalar part
            Kinetic::Cayley(_) if self.kind == Kind::Quaternion => {
                let q = shown(self.kind, f);
                return q.block(0..3, 0..1) * (R::of(2.0) / (h * q[(3, 0)]));
            }
            Kinetic::Cayley(_) if self.kind == Kind::Matrix => (f - &one) * (f + &one).inverse() * R::of(2.0),
            Kinetic::Exponential(_) => f.logarithm(),
            _ => f - &one,
        };
        self.coordinates(&speed) * (R::one() / h)
    }
}

impl Problem for OnItself {
    fn factors(&self) -> Vec<Factor> {
        vec![right(self.group.clone())]
    }
    fn act<R: Real>(&self, f: &[Matrix<R>], q: &[Matrix<R>]) -> Vec<Matrix<R>> {
        vec![&q[0] * &f[0]]
    }
    fn cost<R: Real>(&self, _t: R, h: R, _q: &[Matrix<R>], f: &[Matrix<R>]) -> R {
        match &self.kinetic {
            Kinetic::Chord(weight) => {
                let chord = shown(self.kind, &(&f[0] - Matrix::identity(self.group.size())));
                let (chord, scale) = match self.kind {
                    Kind::Quaternion => (chord.block(0..3, 0..1), 4.0),
                    _ => (chord, 1.0),
                };
                (weight.lift() * &chord * chord.transpose()).trace() * scale / (h * 2.0)
            }
            Kinetic::Cayley(inertia) | Kinetic::Projection(inertia) | Kinetic::Exponential(inertia) => {
                let xi = self.velocity(h, &f[0]);
                h * xi.dot(&(inertia.lift() * &xi)) * 0.5
            }
        }
    }
    fn potential<R: Real>(&self, _t: R, q: &[Matrix<R>]) -> R {
        let q = shown(self.kind, &q[0]);
        let cubic = q.dot(&self.cubic.lift());
        q.dot(&self.linear.lift()) + cubic * cubic * cubic / R::of(3.0)
    }
}
