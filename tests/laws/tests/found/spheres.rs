//! Section 2.2: spheres, acted on from the left, in closed form.

use clebsch::{Clebsch, Error};
use clebsch_tests::fixtures::neumann::Neumann;
use clebsch_tests::fixtures::paper_pendulum::PaperPendulum;
use clebsch_tests::fixtures::sphere_geodesic::SphereGeodesic;
use clebsch_tests::fixtures::spherical_pendulum::SphericalPendulum;
use clebsch_tests::fixtures::two_pendulums::TwoPendulums;
use clebsch_tests::oracle::near::assert_near;
use clebsch_tests::oracle::random::Random;
use clebsch_tests::oracle::rotation::{components, skew};
use clebsch_tests::stepping::Stepping;
use nalgebra::{Vector3, Vector4, Vector6};

use crate::{H, NEAR, assert_conserved, assert_reversible, assert_says, assert_says_nowhere};

#[test]
fn spherical_pendulums() {
    let random = &mut Random::new(211);
    let found =
        ["from the left", "closed form", "does not change in the drift", "Conserved: the momentum about e3, spatial."];
    assert_says::<PaperPendulum>(&found);
    assert_says::<SphericalPendulum>(&found);
    assert_eq!((PaperPendulum::ORDER, SphericalPendulum::ORDER), (1, 2));
    let pendulum = SphericalPendulum { mass: 0.7, length: 1.3, gravity: 9.81 };
    let scale = 0.7 * 1.3 * 1.3;
    let (q, mu) = (random.unit::<3>(), random.vector::<3>());
    let stepper = pendulum.stepper(H).expect("a pendulum");
    assert!(matches!(stepper.state(q, mu), Err(Error::OutsideMomentumSpace { .. })), "N·q = 0 is demanded");
    let mu = mu - q * q.dot(&mu);
    let kick = -q.cross(&Vector3::z()) * (0.7 * 9.81 * 1.3 * H / 2.0);
    assert_near(
        &pendulum.impulse(&pendulum.step_constants(H).expect("a pendulum"), 0.0, &q, &nalgebra::zero()),
        &kick,
        NEAR,
        "−h/2 q × ∇V",
    );
    let state = stepper.step(&stepper.state(q, mu).expect("a state")).expect("a step");
    let kicked = mu + kick;
    let a = kicked * (H / scale);
    let next = q * (1.0 - a.norm_squared()).sqrt() + a.cross(&q);
    assert_near(state.configuration(), &next, NEAR, "q⁺ = √(1−|a|²) q + a × q");
    let after = kicked - next.cross(&Vector3::z()) * (0.7 * 9.81 * 1.3 * H / 2.0);
    assert_near(&state.momentum(), &after, NEAR, "N⁺");
    assert_conserved(pendulum.clone(), q, mu, ["about e3, spatial"]);
    assert_reversible(&pendulum, q, mu);
    let mut state = state;
    for _ in 0..200 {
        state = stepper.step(&state).expect("a step");
        assert!(state.momentum().dot(state.configuration()).abs() < NEAR, "N·q stays 0");
    }
    // |a| ≥ 1: no rotation has this momentum
    let fast = stepper.state(q, mu.normalize() * (1.1 * scale / H + kick.norm())).expect("a state");
    assert!(matches!(stepper.step(&fast), Err(Error::Unsolvable { .. })), "{:?}", stepper.step(&fast));

    // the paper's: twice the Lagrangian, drift then kick
    let paper = PaperPendulum { gravity: 9.81 };
    let stepper = paper.stepper(H).expect("a pendulum");
    let state = stepper.step(&stepper.state(q, mu * 2.0).expect("a state")).expect("a step");
    let next = q * (1.0 - (mu * H).norm_squared()).sqrt() + (mu * H).cross(&q);
    assert_near(state.configuration(), &next, NEAR, "q⁺ = √(1−|hN|²) q + hN × q");
    assert_near(&state.momentum(), &(mu * 2.0 - next.cross(&Vector3::z()) * (2.0 * 9.81 * H)), NEAR, "2N");
    assert_conserved(paper, q, mu * 2.0, ["about e3, spatial"]);
}

#[test]
fn sphere_geodesic() {
    let random = &mut Random::new(212);
    assert_says::<SphereGeodesic>(&["from the left", "closed form", "no potential", "does not change in the drift"]);
    let (q, w) = (random.unit::<4>(), random.vector::<4>());
    let w = w - q * q.dot(&w);
    // M = ½(w qᵀ − q wᵀ), so that w = 2Mq
    let matrix = (w * q.transpose() - q * w.transpose()) / 2.0;
    let mu: Vector6<f64> = components(&matrix);
    assert_near(&(SphereGeodesic::momentum_matrix(&mu) * q * 2.0), &w, NEAR, "w = 2Mq");
    let stepper = SphereGeodesic.stepper(H).expect("a sphere");
    let state = stepper.step(&stepper.state(q, mu).expect("a state")).expect("a step");
    let next = q * (1.0 - H * H * w.norm_squared()).sqrt() + w * H;
    assert_near(state.configuration(), &next, NEAR, "q⁺ = √(1−h²|w|²) q + h w");
    assert_near(&state.momentum(), &mu, 0.0, "N⁺ = N");
    let plane = |i: usize, j: usize| format!("in the plane of e{i} and e{j}, spatial");
    let names = [plane(1, 2), plane(1, 3), plane(1, 4), plane(2, 3), plane(2, 4), plane(3, 4)];
    assert_conserved(SphereGeodesic, q, mu, names.each_ref().map(String::as_str));
}

#[test]
fn neumann() {
    let random = &mut Random::new(213);
    assert_says::<Neumann>(&["from the left", "closed form", "Conserved: no momentum"]);
    let problem = Neumann { stiffness: random.inertia() };
    let (q, w) = (random.unit::<4>(), random.vector::<4>());
    let mu: Vector6<f64> = components(&((w * q.transpose() - q * w.transpose()) / 2.0));
    let gradient: Vector4<f64> = problem.stiffness * q;
    let kick = (gradient * q.transpose() - q * gradient.transpose()) * (-H / 2.0);
    let impulse = problem.impulse(&problem.step_constants(H).expect("a sphere"), 0.0, &q, &nalgebra::zero());
    // half of h, and M = ½ Σ m_i E_i
    assert_near(&skew::<4, 6>(&impulse), &kick, NEAR, "components −h/2 (x_i g_j − x_j g_i)");
    assert_reversible(&problem, q, mu);
}

#[test]
fn two_pendulums() {
    let random = &mut Random::new(214);
    assert_says::<TwoPendulums>(&[
        "F in SO<3> acts from the left",
        "G in SO<3> acts from the left",
        "The momentum equation for F is solved in closed form",
        "The momentum equation for G is solved in closed form",
        "uncouples: one small solve for each part",
        "Conserved: no momentum",
    ]);
    assert_says_nowhere::<TwoPendulums>(&["Newton"]);
    let system = TwoPendulums { mass: [1.0, 0.6], gravity: 5.0, coupling: Vector3::new(1.0, -2.0, 1.5) };
    let q = (random.unit::<3>(), random.unit::<3>());
    let [up, down] = [(q.0, q.1, 1.0), (q.1, q.0, 0.6)].map(|(q, other, mass)| {
        -q.cross(&(Vector3::z() * (5.0 * mass) + system.coupling.component_mul(&other))) * (H / 2.0)
    });
    let kick = system.impulse(&system.step_constants(H).expect("pendulums"), 0.0, &q, &nalgebra::zero());
    assert_near(&kick.fixed_rows::<3>(0).into_owned(), &up, NEAR, "−h/2 p × ∂V/∂p");
    assert_near(&kick.fixed_rows::<3>(3).into_owned(), &down, NEAR, "−h/2 q × ∂V/∂q");
    let momenta = [q.0.cross(&random.vector()), q.1.cross(&random.vector())];
    let mu = Vector6::from_iterator(momenta.iter().flat_map(|mu| mu.iter().copied()));
    assert_reversible(&system, q, mu);
}
