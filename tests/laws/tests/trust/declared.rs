//! Groups that are declared, by an equation or by a basis.

use clebsch::Clebsch;
use clebsch_tests::oracle::precise::group::{Group, group, pseudo_so};
use clebsch_tests::oracle::precise::matrix::Matrix;
use clebsch_tests::oracle::precise::on_itself::{Kind, Kinetic, OnItself};
use clebsch_tests::oracle::random::Random;
use nalgebra::SMatrix;

use crate::algebra::solutions;
use crate::checks;

/// FᵀGF = G: the matrices with ξᵀG + Gξ = 0.
fn form(g: &Matrix<f64>) -> Group {
    solutions(g.shape().0, |xi| xi.transpose() * g + g * xi)
}

fn matrix(n: usize, entries: &[f64]) -> Matrix<f64> {
    Matrix::of(n, n, entries)
}

/// One matrix with a one for each list of places.
fn units(n: usize, places: &[&[(usize, usize)]]) -> Group {
    let unit = |places: &&[(usize, usize)]| Matrix::from_fn(n, n, |i, j| f64::from(u8::from(places.contains(&(i, j)))));
    group(places.iter().map(unit).collect())
}

groups! {
    rotations: [Rotations], 3, 3, cayley, pseudo_so(3, 0),
        { group Rotations = |R: Matrix3| R.transpose() * R == I, };
    unimodular: [Unimodular], 2, 3, cayley, solutions(2, |xi| matrix(1, &[xi.trace()])),
        { group Unimodular = |F: Matrix2| F.determinant() == 1, };
    // F D Fᵀ = D with D = diag(1, 1, 0) leaves the last row (0 0 d), and the second summand makes d = 1
    motions: [Motions], 3, 3, cayley, solutions(3, |xi| {
        let d = matrix(3, &[1., 0., 0., 0., 1., 0., 0., 0., 0.]);
        let last = matrix(3, &[0., 0., 0., 0., 0., 0., 0., 0., xi[(2, 2)]]);
        xi * &d + &d * xi.transpose() + last
    }), {
        group Motions = |F: Matrix3| {
            let plane = Matrix3::from_diagonal(&vector![1, 1, 0]);
            let rest = Matrix3::from_diagonal(&vector![0, 0, 1]);
            F * plane * F.transpose() + F[(2, 2)] * rest == I
        },
    };
    circle: [Circle], 2, 1, cayley, pseudo_so(2, 0),
        { group Circle = |F: Matrix2| F.transpose() * F == I, };
    // scalings and rotations, the complex numbers but 0
    complex: [Complex], 2, 2, cayley, solutions(2, |xi| {
        let j = matrix(2, &[0., -1., 1., 0.]);
        xi * &j - &j * xi
    }), {
        group Complex = |F: Matrix2| {
            let unit = Matrix2::new(0, -1,  1, 0);
            F * unit == unit * F
        },
    };
    // a form that is not diagonal
    skew_form: [SkewForm], 3, 3, cayley, form(&matrix(3, &[0., 0., 1., 0., 1., 0., 1., 0., 0.])), {
        group SkewForm = |F: Matrix3| {
            let g = Matrix3::new(0, 0, 1,  0, 1, 0,  1, 0, 0);
            F.transpose() * g * F == g
        },
    };
    nil: [Nil], 3, 3, cayley, units(3, &[&[(0, 1)], &[(1, 2)], &[(0, 2)]]), {
        group Nil = basis([
            Matrix3::new(0, 1, 0,  0, 0, 0,  0, 0, 0),
            Matrix3::new(0, 0, 0,  0, 0, 1,  0, 0, 0),
            Matrix3::new(0, 0, 1,  0, 0, 0,  0, 0, 0),
        ]),
    };
    upper: [Upper], 2, 3, cayley, units(2, &[&[(0, 0)], &[(0, 1)], &[(1, 1)]]), {
        group Upper = basis([Matrix2::new(1, 0,  0, 0), Matrix2::new(0, 1,  0, 0), Matrix2::new(0, 0,  0, 1)]),
    };
    scale_and_shift: [ScaleAndShift], 3, 2, cayley, units(3, &[&[(0, 0)], &[(1, 2)]]), {
        group ScaleAndShift = basis([
            Matrix3::new(1, 0, 0,  0, 0, 0,  0, 0, 0),
            Matrix3::new(0, 0, 0,  0, 0, 1,  0, 0, 0),
        ]),
    };
    // the geometry Sol: no Cayley chart, and I + Z leaves it
    sol: [Sol], 3, 3, projection, group(vec![
        matrix(3, &[1., 0., 0., 0., -1., 0., 0., 0., 0.]),
        matrix(3, &[0., 0., 1., 0., 0., 0., 0., 0., 0.]),
        matrix(3, &[0., 0., 0., 0., 0., 1., 0., 0., 0.]),
    ]), {
        group Sol = basis([
            Matrix3::new(1, 0, 0,  0, -1, 0,  0, 0, 0),
            Matrix3::new(0, 0, 1,  0, 0, 0,  0, 0, 0),
            Matrix3::new(0, 0, 0,  0, 0, 1,  0, 0, 0),
        ]),
    };
}

// groups of 4x4 matrices
#[cfg(feature = "heavy")]
groups! {
    lorentz: [Lorentz], 4, 6, cayley, pseudo_so(1, 3), {
        group Lorentz = |F: Matrix4| {
            let eta = Matrix4::from_diagonal(&vector![1, -1, -1, -1]);
            F.transpose() * eta * F == eta
        },
    };
    symplectic: [Symplectic], 4, 10, cayley, form(&matrix(4, &[0., 0., 1., 0., 0., 0., 0., 1., -1., 0., 0., 0., 0., -1., 0., 0.])), {
        group Symplectic = |F: Matrix4| {
            let omega = Matrix4::new(0, 0, 1, 0,  0, 0, 0, 1,  -1, 0, 0, 0,  0, -1, 0, 0);
            F.transpose() * omega * F == omega
        },
    };
}
