//! Agreement with a 60-digit reference computation, to every digit that it prints.

use clebsch_tests::oracle::precise::double_double::DoubleDouble;
use clebsch_tests::oracle::precise::equation::Equation;
use clebsch_tests::oracle::precise::group::so;
use clebsch_tests::oracle::precise::matrix::Matrix;
use clebsch_tests::oracle::precise::problem::Problem;
use clebsch_tests::oracle::precise::real::Real;
use clebsch_tests::oracle::precise::step::{State, trajectory};

use super::excerpts;
use super::systems::{FreeBody, HeavyTop, MidpointTop, PaperPendulum, Placement, WeightedSl2};

/// Half a unit of the last of 20 digits, relative to the number, and the rounding of ours.
const PRINTED: f64 = 5.1e-20;
const ROUNDING: f64 = 1e-25;

type Excerpt = &'static [(usize, &'static str, &'static str)];

fn numbers(text: &str) -> Vec<DoubleDouble> {
    text.split_whitespace().map(|number| number.parse().unwrap()).collect()
}

#[track_caller]
fn assert_printed(ours: &[DoubleDouble], printed: &[DoubleDouble], what: &str) {
    assert_eq!(ours.len(), printed.len(), "{what}");
    for (&a, &b) in ours.iter().zip(printed) {
        assert!((a - b).size() <= PRINTED * b.size() + ROUNDING, "{what}: {a:?} and {b:?}");
    }
}

/// A trajectory from `q` and `n` (decimals) with the step h, whose momentum prints as `printed(N)`.
#[track_caller]
fn assert_agrees<P: Problem>(
    problem: &P,
    h: &str,
    (q, n): (Matrix<DoubleDouble>, &[DoubleDouble]),
    printed: impl Fn(&[DoubleDouble]) -> Vec<DoubleDouble>,
    excerpt: Excerpt,
) {
    let start = State { q: vec![q], n: n.to_vec() };
    let last = excerpt.iter().map(|line| line.0).max().unwrap();
    let states = trajectory(problem, numbers(h)[0], &start, last).unwrap();
    for &(k, q, n) in excerpt {
        assert_printed(states[k].q[0].entries(), &numbers(q), &format!("q after {k} steps"));
        assert_printed(&printed(&states[k].n), &numbers(n), &format!("N after {k} steps"));
    }
}

/// M with ⟨M, E_i⟩ = m_i for SO(n), where ⟨E_i, E_j⟩ = 2δ_ij.
fn skew(n: usize, m: &[DoubleDouble]) -> Matrix<DoubleDouble> {
    so(n).combination(m) * DoubleDouble::of(0.5)
}

fn attitude() -> Matrix<DoubleDouble> {
    so(3).combination(&numbers("0.3 0.2 -0.1")).exponential()
}

/// The components of M = N^ are 2N.
#[test]
fn spherical_pendulum_of_the_paper() {
    let start = (Matrix::vector(&numbers("0 1 0")), &numbers("2 0 1")[..]);
    let halves = |n: &[DoubleDouble]| n.iter().map(|&n| n * 0.5).collect();
    assert_agrees(&PaperPendulum, "0.01", start, halves, excerpts::PAPER_PENDULUM);
}

/// M_23 = −0.5, M_13 = 0.2, M_12 = 0.3, so M = ½π^ with π = (1, 0.4, −0.6).
#[test]
fn free_body_on_so3() {
    let start = (Matrix::identity(3), &numbers("1 0.4 -0.6")[..]);
    assert_agrees(&FreeBody(&[60, 40, 25]), "0.1", start, |n| skew(3, n).entries().to_vec(), excerpts::FREE_BODY);
}

/// M_21, M_31, M_41, M_32, M_42, M_43 = 0.5, 0.2, 0.1, −0.3, 0.4, −0.25.
#[test]
fn free_body_on_so4() {
    let start = (Matrix::identity(4), &numbers("1 0.4 0.2 -0.6 0.8 -0.5")[..]);
    assert_agrees(&FreeBody(&[60, 40, 25, 80]), "0.1", start, |n| skew(4, n).entries().to_vec(), excerpts::FREE_BODY_4);
}

#[test]
fn heavy_top_drift_then_kick() {
    let start = (attitude(), &numbers("0.5 -0.3 0.8")[..]);
    assert_agrees(&HeavyTop(Placement::End), "0.05", start, <[_]>::to_vec, excerpts::HEAVY_TOP);
}

#[test]
fn heavy_top_half_kicks() {
    let start = (attitude(), &numbers("0.5 -0.3 0.8")[..]);
    assert_agrees(&HeavyTop(Placement::Both), "0.05", start, <[_]>::to_vec, excerpts::HEAVY_TOP_STRANG);
}

#[test]
fn coupled_cost() {
    let start = (attitude(), &numbers("0.5 -0.3 0.8")[..]);
    assert_agrees(&MidpointTop, "0.1", start, <[_]>::to_vec, excerpts::MIDPOINT_TOP);
}

#[test]
fn geodesic_of_sl2() {
    let start = (Matrix::identity(2), &numbers("0.4 0.7 -0.5")[..]);
    assert_agrees(&WeightedSl2(10), "0.01", start, <[_]>::to_vec, excerpts::SL2);
}

/// A flat body of inertia (1, 2, 3): h|J⁻¹π| = 1.05 is near the end of the branch that starts at F = I, 1.4 beyond it.
#[test]
fn near_and_beyond_the_last_solution() {
    let solve = |momentum: &str| {
        let problem = FreeBody(&[100, 50, 0]);
        let (factors, q) = (problem.factors(), [Matrix::identity(3)]);
        let (t, h) = (DoubleDouble::zero(), DoubleDouble::one());
        Equation { problem: &problem, factors: &factors, t, h, q: &q }.solve(&numbers(momentum))
    };
    let f = solve("0.84 0 -1.89").unwrap();
    let printed = "0.66891647771163653349 0.40332485613587032741 -0.62440356042293446249 \
                   -0.74333757193206483629 0.36294498263921420892 -0.56188984127777468813 0 0.84 0.54258639865002145113";
    assert_printed(f[0].entries(), &numbers(printed), "F");
    let reached = solve("1.12 0 -2.52").unwrap_err().reached;
    assert!((0.75..1.0).contains(&reached), "{reached}");
}
