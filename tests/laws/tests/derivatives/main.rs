//! Each derivative three ways: the symbolic formula evaluated, the code that came of it, and central differences of the
//! declared closure, written by hand.
//!
//! Differences of fourth order with a step of 1e-3 are good to 1e-11 for functions of order ten. Formula and code agree
//! to 1e-13 times their divisor (h = 0.1), relative to entries beyond a hundred.

mod by_hand;
mod jacobians;
#[path = "../random/kernels.rs"]
mod kernels;
mod program;

use by_hand::{ByHand, slope};
use clebsch::__private::Scheme;
use clebsch::Clebsch;
use clebsch_compiler::Graph;
use clebsch_tests::fixtures::heavy_top::HeavyTop;
use clebsch_tests::fixtures::neumann::Neumann;
use clebsch_tests::fixtures::spherical_pendulum::SphericalPendulum;
use clebsch_tests::fixtures::two_bodies::TwoBodies;
use clebsch_tests::oracle::random::Random;
use clebsch_tests::stepping::Stepping;
use nalgebra::{Matrix3, SMatrix, SVector, Vector3, Vector6};
use program::{Values, program};

const H: f64 = 0.1;
const SAMPLES: usize = 20;

macro_rules! fixture {
    ($name:literal) => {
        include_str!(concat!("../../../fixtures/accept/", $name, ".rs"))
    };
}

#[track_caller]
fn assert_three(formula: &[f64], code: &[f64], difference: &[f64], what: &str) {
    let far = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
    assert!(formula.len() == code.len() && code.len() == difference.len(), "{what}: {} components", formula.len());
    let size = formula.iter().fold(1.0, |max, x| f64::max(max, x.abs() / 100.0));
    let (exact, approximate) = (far(formula, code) / size, far(formula, difference) / size);
    assert!(exact <= 2e-13, "{what}: formula and code differ by {exact:.1e}");
    assert!(approximate <= 2e-10, "{what}: formula and differences differ by {approximate:.1e}");
}

fn rows<const R: usize, const C: usize>(a: &SMatrix<f64, R, C>) -> Vec<f64> {
    a.transpose().as_slice().to_vec()
}

/// The check of closures written by hand.
type Check<'a, const N: usize, const C: usize> = &'a dyn Fn(ByHand<'_, N, C>);

/// Holds the formulas of a fixture with one factor against its generated code and against its closures by hand.
fn one_factor<S, const N: usize, const C: usize, const M: usize>(
    text: &str,
    random: &mut Random,
    system: impl Fn(&Values) -> S,
    by_hand: impl Fn(&S, Check<'_, N, C>),
) where
    S: Clebsch<
            Scalar = f64,
            Configuration = SMatrix<f64, N, C>,
            Element = SMatrix<f64, N, N>,
            Momentum = SVector<f64, M>,
            Scheme: Scheme<S, Left = SVector<f64, M>>,
        >,
{
    let graph = Graph::new();
    let program = program(&graph, text).expect("mechanics");
    let formulas = &program.formulas;
    let (q_symbol, f_symbol) = (formulas.model.configurations[0].symbol, formulas.model.factors[0].symbol);
    for _ in 0..SAMPLES {
        let values = Values::random(&program, random);
        let system = system(&values);
        let q = SMatrix::<f64, N, C>::from_row_slice(values.get(q_symbol));
        let f = SMatrix::<f64, N, N>::from_row_slice(values.get(f_symbol));
        let p = SMatrix::<f64, N, C>::from_row_slice(values.get(formulas.symbols.covectors[0]));
        by_hand(&system, &|hand| {
            let evaluate = |expr| values.evaluate(expr).entries;
            let code = system.momentum_map(&q, &p);
            assert_three(&evaluate(formulas.momentum_map[0]), code.as_slice(), &hand.momentum_map::<M>(&q, &p), "J");
            let code = system.legendre(H, 0.0, &q, &f);
            assert_three(&evaluate(formulas.legendre[0]), code.as_slice(), &hand.legendre::<M>(&q, &f), "F⁻ℓd");
            let code = system.impulse(&system.step_constants(H).expect("a regular system"), 0.0, &q, &nalgebra::zero());
            let kick = formulas.substeps[0].start.as_ref().expect("a kick")[0];
            assert_three(&evaluate(kick), code.as_slice(), &hand.kick::<M>(&q), "kick");
            let (drift, kick) = (&formulas.legendre_next, &formulas.legendre_kick);
            let mut moved = Values::random(&program, &mut Random::new(0));
            moved.copy(&values);
            moved.set(q_symbol, &rows(&system.act(&f, &q)));
            let kick = moved.evaluate(kick.as_ref().expect("a kick")[0]).entries;
            let sum: Vec<f64> = evaluate(drift[0]).iter().zip(kick).map(|(a, b)| a + b).collect();
            let code = system.legendre_next(H, 0.0, &q, &f);
            assert_three(&sum, code.as_slice(), &hand.legendre_next::<M>(&q, &f), "F⁺ℓd");
        });
    }
}

#[test]
fn heavy_top() {
    one_factor(
        fixture!("heavy_top"),
        &mut Random::new(101),
        |values| HeavyTop {
            mass_matrix: Matrix3::from_row_slice(values.named("mass_matrix")),
            weight: values.named("weight")[0],
            center: Vector3::from_row_slice(values.named("center")),
        },
        |top: &HeavyTop, check| {
            let unit = Matrix3::identity();
            check(ByHand {
                right: true,
                act: &|f: &Matrix3<f64>, r: &Matrix3<f64>| r * f,
                cost: &|f| (top.mass_matrix * (f - unit) * (f - unit).transpose()).trace() / (2.0 * H),
                potential: &|r| top.weight * (r * top.center).z,
            });
        },
    );
}

#[test]
fn spherical_pendulum() {
    one_factor(
        fixture!("spherical_pendulum"),
        &mut Random::new(102),
        |values| SphericalPendulum {
            mass: values.named("mass")[0],
            length: values.named("length")[0],
            gravity: values.named("gravity")[0],
        },
        |pendulum: &SphericalPendulum, check| {
            let (mass, length) = (pendulum.mass, pendulum.length);
            check(ByHand {
                right: false,
                act: &|f: &Matrix3<f64>, q: &Vector3<f64>| f * q,
                cost: &|f| mass * length * length * (f - Matrix3::identity()).norm_squared() / (4.0 * H),
                potential: &|q| mass * pendulum.gravity * length * q.z,
            });
        },
    );
}

#[test]
fn neumann() {
    one_factor(
        fixture!("neumann"),
        &mut Random::new(103),
        |values| Neumann { stiffness: SMatrix::from_row_slice(values.named("stiffness")) },
        |problem: &Neumann, check| {
            check(ByHand {
                right: false,
                act: &|f: &SMatrix<f64, 4, 4>, q: &SVector<f64, 4>| f * q,
                cost: &|f| (f - SMatrix::<f64, 4, 4>::identity()).norm_squared() / (4.0 * H),
                potential: &|q| q.dot(&(problem.stiffness * q)) / 2.0,
            });
        },
    );
}

#[test]
fn two_bodies() {
    let graph = Graph::new();
    let program = program(&graph, fixture!("two_bodies")).expect("mechanics");
    let formulas = &program.formulas;
    let random = &mut Random::new(104);
    for _ in 0..SAMPLES {
        let mut values = Values::random(&program, random);
        // apart enough for differences
        let x = [random.vector::<3>(), random.vector::<3>() + Vector3::x() * 3.0];
        let bodies = TwoBodies {
            mass: [values.named("mass[0]")[0], values.named("mass[1]")[0]],
            gravitation: values.named("gravitation")[0],
        };
        for (leaf, x) in formulas.model.configurations.iter().zip(x) {
            values.set(leaf.symbol, x.as_slice());
        }
        let potential =
            |x: [Vector3<f64>; 2]| -bodies.gravitation * bodies.mass[0] * bodies.mass[1] / (x[1] - x[0]).norm();
        let kick = formulas.substeps[0].start.as_ref().expect("a kick");
        let formula: Vec<f64> = kick.iter().flat_map(|part| values.evaluate(*part).entries).collect();
        let code = bodies.impulse(&bodies.step_constants(H).expect("regular bodies"), 0.0, &x, &nalgebra::zero());
        let moved = |i: usize, e: f64| {
            let mut x = x;
            x[i / 3][i % 3] += e;
            x
        };
        let difference: Vec<f64> = (0..6).map(|i| slope(|e| -H / 2.0 * potential(moved(i, e)))).collect();
        assert_three(&formula, code.as_slice(), &difference, "kick");
        let a = [random.vector::<3>(), random.vector::<3>()];
        for (factor, a) in formulas.model.factors.iter().zip(a) {
            values.set(factor.symbol, a.as_slice());
        }
        let formula: Vec<f64> = formulas.legendre.iter().flat_map(|part| values.evaluate(*part).entries).collect();
        let cost = |i: usize, e: f64| {
            let mut a = a;
            a[i / 3][i % 3] += e;
            (bodies.mass[0] * a[0].norm_squared() + bodies.mass[1] * a[1].norm_squared()) / (2.0 * H)
        };
        let kicks = Vector6::from_column_slice(&difference);
        let difference: Vec<f64> = (0..6).map(|i| slope(|e| cost(i, e)) - kicks[i]).collect();
        assert_three(&formula, bodies.legendre(H, 0.0, &x, &a).as_slice(), &difference, "F⁻ℓd");
    }
}
