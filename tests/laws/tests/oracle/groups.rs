//! The bases of groups: dimension, closure under the bracket, and the equations that their elements satisfy.

use clebsch_tests::oracle::precise::double_double::DoubleDouble;
use clebsch_tests::oracle::precise::group::{
    Group, aff, gl, heisenberg, pseudo_so, se, sim, sl, so, sp, su, translation, u, unit_quaternions,
};
use clebsch_tests::oracle::precise::matrix::Matrix;
use clebsch_tests::oracle::precise::real::Real;
use clebsch_tests::oracle::random::Random;

/// The distance of A from the span of the basis, by least squares.
fn outside(group: &Group, a: &Matrix<f64>) -> f64 {
    let m = group.basis.len();
    let gram = Matrix::from_fn(m, m, |i, j| group.basis[i].dot(&group.basis[j]));
    let right = Matrix::from_fn(m, 1, |i, _| group.basis[i].dot(a));
    (group.combination(gram.solve(&right).entries()) - a).size()
}

#[test]
fn bases_are_independent_and_closed() {
    let groups = [
        (so(3), 3),
        (so(5), 10),
        (pseudo_so(1, 3), 6),
        (se(2), 3),
        (se(3), 6),
        (sim(3), 7),
        (translation(4), 4),
        (gl(3), 9),
        (aff(2), 6),
        (sl(3), 8),
        (sp(4), 10),
        (u(2), 4),
        (su(3), 8),
        (unit_quaternions(), 3),
        (heisenberg(2), 5),
    ];
    for (group, dimension) in groups {
        assert_eq!(group.basis.len(), dimension);
        for a in &group.basis {
            assert!(outside(&group, a) < 1e-14, "independent: {a:?}");
            for b in &group.basis {
                assert!(outside(&group, &(a * b - b * a)) < 1e-14, "closed: {a:?} {b:?}");
            }
        }
    }
}

/// FᵀηF = η for a random element.
#[track_caller]
fn assert_preserves(group: &Group, form: impl Fn(usize, usize) -> f64) {
    let mut random = Random::new(3);
    let x: Vec<_> = group.basis.iter().map(|_| DoubleDouble::of(random.number())).collect();
    let f = group.combination(&x).exponential();
    let form = Matrix::from_fn(group.size(), group.size(), form).lift();
    let defect = f.transpose() * &form * &f - &form;
    assert!(defect.size() < 1e-29, "{:e}", defect.size());
    assert!((&f - Matrix::identity(group.size())).size() > 0.1);
}

#[test]
fn elements_preserve_their_forms() {
    let delta = |i, j| if i == j { 1.0 } else { 0.0 };
    for group in [so(3), so(4), u(2), su(2), su(3), unit_quaternions()] {
        assert_preserves(&group, delta);
    }
    for n in [2, 3] {
        let complex_structure = move |i, j| {
            if i + n == j {
                1.0
            } else if j + n == i {
                -1.0
            } else {
                0.0
            }
        };
        for group in [sp(2 * n), u(n), su(n)] {
            assert_preserves(&group, complex_structure);
        }
    }
    assert_preserves(&pseudo_so(1, 3), |i, j| {
        if i != j {
            0.0
        } else if i == 0 {
            1.0
        } else {
            -1.0
        }
    });
}

/// [E_1, E_2] = E_3 and cyclic, as for SO(3): half units, and multiplication from the left keeps the order.
#[test]
fn unit_quaternions_have_the_brackets_of_so3() {
    for group in [so(3), unit_quaternions()] {
        let [a, b, c] = &group.basis[..] else { panic!("three") };
        for (x, y, z) in [(a, b, c), (b, c, a), (c, a, b)] {
            assert_eq!((x * y - y * x - z).size(), 0.0);
        }
    }
}
