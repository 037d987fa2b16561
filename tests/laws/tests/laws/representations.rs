//! Both theorems of the theory give one motion: Theorem 1 on (q, p) and Theorem 2 on (q, N) with N = J(q, p).

use clebsch::{Clebsch, Stepper};
use clebsch_tests::fixtures::first_order_top::FirstOrderTop;
use clebsch_tests::fixtures::heavy_top::HeavyTop;
use clebsch_tests::fixtures::neumann::Neumann;
use clebsch_tests::fixtures::paper_pendulum::PaperPendulum;
use clebsch_tests::fixtures::rigid_body4::RigidBody4;
use clebsch_tests::fixtures::sided_pair::SidedPair;
use clebsch_tests::fixtures::spherical_pendulum::SphericalPendulum;
use clebsch_tests::fixtures::two_bodies::TwoBodies;
use clebsch_tests::oracle::near::assert_near;
use clebsch_tests::oracle::random::Random;
use nalgebra::{SMatrix, SVector, Vector3};

const H: f64 = 0.02;

/// Entries of order one, computed in different ways over 200 steps: round-off of 1e-16 a step, grown linearly.
const NEAR: f64 = 1e-12;

fn heavy_top(random: &mut Random) -> HeavyTop {
    HeavyTop { mass_matrix: random.inertia(), weight: 1.3, center: random.vector() }
}

/// Theorem 1 on (q, p) and Theorem 2 on (q, N): the same q, and N = J(q, p) all the way.
fn both_representations<
    S: Clebsch<Configuration = SMatrix<f64, R, C>, Momentum = SVector<f64, M>, Scalar = f64>,
    const R: usize,
    const C: usize,
    const M: usize,
>(
    stepper: Stepper<S>,
    q: SMatrix<f64, R, C>,
    p: SMatrix<f64, R, C>,
) {
    let name = S::NAME;
    let mut upstairs = stepper.cotangent_state(q, p).expect("a state on T*Q");
    let mut state = stepper.state(q, stepper.momentum_map(&q, &p)).expect("a momentum that motions can have");
    for _ in 0..200 {
        upstairs = stepper.step_symmetric(&upstairs).expect("a solvable step");
        state = stepper.step(&state).expect("a solvable step");
        assert_near(upstairs.configuration(), state.configuration(), NEAR, name);
        let momentum = stepper.momentum_map(upstairs.configuration(), upstairs.covector());
        assert_near(&momentum, &state.momentum(), NEAR, name);
    }
}

#[test]
fn both_theorems_give_the_same_motion() {
    let random = &mut Random::new(21);
    both_representations(heavy_top(random).stepper(H).expect("a top"), random.attitude(), random.matrix());
    let HeavyTop { mass_matrix, weight, center } = heavy_top(random);
    let first = FirstOrderTop { mass_matrix, weight, center };
    both_representations(first.stepper(H).expect("a top"), random.attitude(), random.matrix());
    both_representations(
        RigidBody4 { j_d: random.inertia() }.stepper(H).expect("a body"),
        random.attitude(),
        random.matrix(),
    );
    both_representations(
        PaperPendulum { gravity: 9.81 }.stepper(H).expect("a pendulum"),
        random.unit(),
        random.matrix(),
    );
    let pendulum = SphericalPendulum { mass: 0.7, length: 1.3, gravity: 9.81 };
    both_representations(pendulum.stepper(H).expect("a pendulum"), random.unit(), random.matrix());
    both_representations(
        Neumann { stiffness: random.inertia() }.stepper(H).expect("a sphere"),
        random.unit(),
        random.matrix(),
    );
}

#[test]
fn both_theorems_on_products() {
    let random = &mut Random::new(22);
    let stepper = TwoBodies { mass: [2.0, 1.0], gravitation: 1.0 }.stepper(H).expect("bodies");
    let (q, p) = ([random.vector(), random.vector::<3>() + Vector3::x() * 3.0], [random.vector(), random.vector()]);
    let mut upstairs = stepper.cotangent_state(q, p).expect("a state on T*Q");
    let mut state = stepper.state(q, stepper.momentum_map(&q, &p)).expect("a state");
    let sided = SidedPair.stepper(H).expect("a pair");
    let (at, covector) = ((random.attitude::<3>(), random.unit::<3>()), (random.matrix(), random.vector()));
    let mut sided_upstairs = sided.cotangent_state(at, covector).expect("a state on T*Q");
    let mut sided_state = sided.state(at, sided.momentum_map(&at, &covector)).expect("a state");
    for _ in 0..200 {
        upstairs = stepper.step_symmetric(&upstairs).expect("a step");
        state = stepper.step(&state).expect("a step");
        assert_near(&upstairs.configuration()[1], &state.configuration()[1], NEAR, "the second body");
        assert_near(&stepper.momentum_map(upstairs.configuration(), upstairs.covector()), &state.momentum(), NEAR, "p");
        sided_upstairs = sided.step_symmetric(&sided_upstairs).expect("a step");
        sided_state = sided.step(&sided_state).expect("a step");
        assert_near(&sided_upstairs.configuration().0, &sided_state.configuration().0, NEAR, "the right factor");
        assert_near(&sided_upstairs.configuration().1, &sided_state.configuration().1, NEAR, "the left factor");
        let momentum = sided.momentum_map(sided_upstairs.configuration(), sided_upstairs.covector());
        assert_near(&momentum, &sided_state.momentum(), NEAR, "both momenta");
    }
}
