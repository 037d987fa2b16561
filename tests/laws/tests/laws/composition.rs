//! A cost that is not time-symmetric is composed with its derived adjoint: order 2 as declared, and it is said.

use clebsch::{Clebsch, Stepper};
use clebsch_tests::oracle::body;
use clebsch_tests::oracle::motion::{motion, order};
use clebsch_tests::oracle::near::{assert_near, distance};
use clebsch_tests::oracle::random::Random;
use clebsch_tests::oracle::rotation::hat;
use nalgebra::{Matrix3, SVector, Vector2, Vector3};

/// A particle in a plane with a cubic term that is odd in the displacement, and its potential in the cost: twice asymmetric.
macro_rules! particle {
    ($name:ident, $order:tt) => {
        #[derive(Clebsch, Clone, Debug)]
        #[clebsch(
                            action = |a: Translation<2>, x: Vector2| x + a,
                            cost   = |h, x, a| {
                                let kinetic = self.mass * a.norm_squared() / (2 * h) + self.skew * a.x.powi(3) / h;
                                kinetic - h * self.stiffness * x.norm_squared().powi(2) / 4
                            },
                            order  = $order,
                        )]
        pub struct $name {
            pub mass: f64,
            pub skew: f64,
            pub stiffness: f64,
        }
    };
}

particle!(Particle, 2);
particle!(FirstOrderParticle, 1);

/// A heavy top whose cost prefers one sense of rotation about the third axis, by a term of higher order in the angle.
macro_rules! top {
    ($name:ident, $order:tt) => {
        #[derive(Clebsch, Clone, Debug)]
        #[clebsch(
            action = |F: SO<3>, R: SO<3>| R * F,
            cost   = |h, R, F| {
                let kinetic = (self.mass_matrix * (F - I) * (F - I).transpose()).trace() / (2 * h);
                kinetic + self.skew * (F[(1, 0)] - F[(0, 1)]).powi(3) / h - h * self.weight * (R * self.center).z
            },
            order  = $order,
        )]
        pub struct $name {
            #[clebsch(symmetric)]
            pub mass_matrix: Matrix3<f64>,
            pub skew: f64,
            pub weight: f64,
            pub center: Vector3<f64>,
        }
    };
}

top!(SkewTop, 2);
top!(FirstOrderSkewTop, 1);

/// Only the place of the potential is asymmetric: all of it at the start of the step.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<3>, q: Unit<Vector3>| F * q,
    cost   = |h, q, F| (F - I).norm_squared() / (4 * h) - h * self.gravity * q.z,
)]
pub struct KickedPendulum {
    pub gravity: f64,
}

fn particle() -> Particle {
    Particle { mass: 1.2, skew: 0.4, stiffness: 1.5 }
}

fn top() -> SkewTop {
    let mass_matrix = Random::new(31).inertia();
    SkewTop { mass_matrix, skew: 0.1, weight: 1.3, center: Vector3::new(0.2, -0.1, 0.8) }
}

fn first_order(top: SkewTop) -> FirstOrderSkewTop {
    let SkewTop { mass_matrix, skew, weight, center } = top;
    FirstOrderSkewTop { mass_matrix, skew, weight, center }
}

#[test]
fn derivation_says_that_the_step_is_composed() {
    for text in [Particle::DERIVATION, SkewTop::DERIVATION, KickedPendulum::DERIVATION] {
        assert!(
            text.contains("not time-symmetric") && text.contains("composed with half a step of its adjoint"),
            "{text}"
        );
    }
    assert_eq!([Particle::ORDER, SkewTop::ORDER, KickedPendulum::ORDER], [2; 3]);
    for text in [FirstOrderParticle::DERIVATION, FirstOrderSkewTop::DERIVATION] {
        assert!(text.contains("First order") && !text.contains("its adjoint"), "{text}");
    }
    assert_eq!([FirstOrderParticle::ORDER, FirstOrderSkewTop::ORDER], [1; 2]);
}

/// Errors at t = 1 with 32, 64, … steps, against the motion that all these discretise.
fn errors<S: Clebsch<Scalar = f64> + Clone>(
    system: &S,
    start: (S::Configuration, S::Momentum),
    error: impl Fn(&S::Configuration, &S::Momentum) -> f64,
) -> Vec<f64> {
    let at = |steps: usize| {
        let stepper: Stepper<S> = system.stepper(1.0 / steps as f64).expect("a regular system");
        let mut state = stepper.state(start.0, start.1).expect("a state");
        for _ in 0..steps {
            state = stepper.step(&state).expect("a solvable step");
        }
        error(state.configuration(), &state.momentum())
    };
    [32, 64, 128, 256].map(at).to_vec()
}

fn assert_order(name: &str, errors: &[f64], expected: f64) {
    let measured = order(errors);
    let list: Vec<String> = errors.iter().map(|error| format!("{error:.1e}")).collect();
    println!("{name}: order {measured:.3}, errors {}", list.join(" "));
    assert!((measured - expected).abs() < 0.1, "{name}: order {measured:.3}, {expected} expected");
}

#[test]
fn measured_orders_of_the_particle() {
    let Particle { mass, skew, stiffness } = particle();
    let first = FirstOrderParticle { mass, skew, stiffness };
    let (x, p) = (Vector2::new(0.6, -0.3), Vector2::new(0.9, 1.1));
    let force = |y: &SVector<f64, 4>| {
        let x: Vector2<f64> = y.fixed_rows::<2>(0).into();
        let pull = -x * (stiffness * x.norm_squared());
        SVector::<f64, 4>::new(y[2] / mass, y[3] / mass, pull.x, pull.y)
    };
    let exact = motion(force, SVector::<f64, 4>::new(x.x, x.y, p.x, p.y), 1.0, 200);
    let error = |x: &Vector2<f64>, p: &Vector2<f64>| distance(&SVector::<f64, 4>::new(x.x, x.y, p.x, p.y), &exact);
    assert_order("composed particle", &errors(&particle(), (x, p), error), 2.0);
    assert_order("first-order particle", &errors(&first, (x, p), error), 1.0);
}

#[test]
fn measured_orders_of_the_top() {
    let top = top();
    let (r, pi) = (Random::new(32).attitude::<3>(), Vector3::new(0.5, -0.7, 1.5));
    let inertia = body::inertia(&top.mass_matrix);
    let inverse = inertia.try_inverse().expect("a regular tensor");
    let velocity = |y: &SVector<f64, 12>| {
        let (r, pi) = (Matrix3::from_iterator(y.iter().copied()), Vector3::new(y[9], y[10], y[11]));
        let omega = inverse * pi;
        let torque = body::gravity_torque(top.weight, &top.center, &r) + pi.cross(&omega);
        stack(&(r * hat(&omega)), &torque)
    };
    let exact = motion(velocity, stack(&r, &pi), 1.0, 200);
    let error = |r: &Matrix3<f64>, pi: &Vector3<f64>| distance(&stack(r, pi), &exact);
    assert_order("composed top", &errors(&top, (r, pi), error), 2.0);
    assert_order("first-order top", &errors(&first_order(top.clone()), (r, pi), error), 1.0);
}

fn stack(r: &Matrix3<f64>, pi: &Vector3<f64>) -> SVector<f64, 12> {
    SVector::from_iterator(r.iter().chain(pi.iter()).copied())
}

/// The second half of the step is the adjoint of the first: the inverse of the step by −h/2.
#[test]
fn the_step_is_half_a_step_and_half_a_step_of_the_adjoint() {
    let h = 0.05;
    let whole = top().stepper(h).expect("a top");
    let (half, back) =
        (first_order(top()).stepper(h / 2.0).expect("a top"), first_order(top()).stepper(-h / 2.0).expect("a top"));
    let (r, pi) = (Random::new(33).attitude::<3>(), Vector3::new(0.5, -0.7, 1.5));
    let after = whole.step(&whole.state(r, pi).expect("a state")).expect("a step");
    let middle = half.step(&half.state(r, pi).expect("a state")).expect("a step");
    let (q, mu) = after.into_parts();
    let again = back.step(&back.state(q, mu).expect("a state")).expect("a step");
    // one solve and its inverse: some units in the last place, divided by h/2
    assert_near(again.configuration(), middle.configuration(), 1e-13, "R in the middle");
    assert_near(&again.momentum(), &middle.momentum(), 1e-13, "π in the middle");
}

/// Time symmetry: the step by −h undoes the step by h.
#[test]
fn composed_steps_are_undone_by_the_negative_step() {
    let (forward, backward) = (top().stepper(0.05).expect("a top"), top().stepper(-0.05).expect("a top"));
    let (r, pi) = (Random::new(34).attitude::<3>(), Vector3::new(0.5, -0.7, 1.5));
    let there = forward.step(&forward.state(r, pi).expect("a state")).expect("a step");
    let (q, mu) = there.into_parts();
    let back = backward.step(&backward.state(q, mu).expect("a state")).expect("a step");
    assert_near(back.configuration(), &r, 1e-13, "R");
    assert_near(&back.momentum(), &pi, 1e-13, "π");
}

/// Both theorems agree for composed steps too.
#[test]
fn composed_steps_on_the_cotangent_bundle() {
    let stepper = top().stepper(0.05).expect("a top");
    let random = &mut Random::new(35);
    let (q, p) = (random.attitude::<3>(), random.matrix::<3, 3>());
    let mut upstairs = stepper.cotangent_state(q, p).expect("a state on T*Q");
    let mut state = stepper.state(q, stepper.momentum_map(&q, &p)).expect("a state");
    for _ in 0..100 {
        upstairs = stepper.step_symmetric(&upstairs).expect("a step");
        state = stepper.step(&state).expect("a step");
        assert_near(upstairs.configuration(), state.configuration(), 1e-12, "R");
        let momentum = stepper.momentum_map(upstairs.configuration(), upstairs.covector());
        assert_near(&momentum, &state.momentum(), 1e-12, "π");
    }
}

/// `legendre` is that of the declared cost with the full step, and `inverse_legendre` its inverse.
#[test]
fn inverse_legendre_inverts_legendre_of_a_composed_step() {
    let stepper = top().stepper(0.05).expect("a top");
    let random = &mut Random::new(36);
    let (q, f) = (random.attitude::<3>(), random.rotation::<3>(0.2));
    let found = stepper.inverse_legendre(&q, &stepper.legendre(&q, &f)).expect("a solvable step");
    assert_near(&found, &f, 1e-13, "F from its momentum");
}

/// The potential at the wrong place alone costs an order; the composition is the symmetric step with half of h.
#[test]
fn kicked_pendulum_is_a_composition_of_kicks() {
    let h = 0.04;
    let stepper = KickedPendulum { gravity: 9.81 }.stepper(h).expect("a pendulum");
    let (q, n) = (Vector3::y(), Vector3::new(1.0, 0.0, 0.5));
    let found = stepper.step(&stepper.state(q, n).expect("a state")).expect("a step");
    let gradient = Vector3::z() * 9.81;
    use clebsch_tests::oracle::sphere::{drift, kick};
    let (q, w) = drift(h / 2.0, drift(h / 2.0, kick(h / 2.0, &gradient, (q, n.cross(&q)))));
    let (q, w) = kick(h / 2.0, &gradient, (q, w));
    assert_near(found.configuration(), &q, 1e-14, "q");
    assert_near(&found.momentum(), &q.cross(&w), 1e-14, "N");
}
