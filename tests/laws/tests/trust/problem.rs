//! The problem of the table once more, for the oracle.

use clebsch_tests::oracle::precise::group::Group;
use clebsch_tests::oracle::precise::matrix::Matrix;
use clebsch_tests::oracle::precise::problem::{Factor, Problem, right};
use clebsch_tests::oracle::precise::real::Real;

use crate::shapes::{Kind, shown};

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
pub struct Precise {
    pub group: Group,
    pub kind: Kind,
    pub kinetic: Kinetic,
    pub linear: Matrix<f64>,
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

impl Precise {
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

impl Problem for Precise {
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
