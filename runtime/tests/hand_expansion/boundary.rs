//! Fixed endpoints for a body and a top: attitudes are given, momenta are found.

use crate::{HeavyTop, assert_near, attitude, body, is_long, last, top};
use clebsch::{Boundary, Clebsch, Error, Extremal, Guess, Node, Variational};
use nalgebra::{Matrix3, Rotation3, Unit, UnitQuaternion, Vector3};

fn rotation(vector: Vector3<f64>) -> Matrix3<f64> {
    *Rotation3::from_scaled_axis(vector).matrix()
}

/// J = diag(1, 2, 3).
fn principal(weight: f64) -> HeavyTop {
    HeavyTop { mass_matrix: Matrix3::from_diagonal(&Vector3::new(2.0, 1.0, 0.0)), weight, center: Vector3::z() }
}

/// 2.5 (1, 2, 3)/√14.
fn far() -> Matrix3<f64> {
    rotation(Vector3::new(1.0, 2.0, 3.0).normalize() * 2.5)
}

/// The momentum that was found, stepped on, passes all configurations and momenta and arrives.
fn assert_shoots(
    extremal: &Extremal<'_, HeavyTop, 3>,
    boundary: &Boundary<'_, HeavyTop, 3>,
    tolerance: f64,
) -> Result<(), Error> {
    let stepper = boundary.stepper();
    let mut state = stepper.state(*extremal.nodes()[0].configuration(), *extremal.momentum())?;
    for found in extremal.states() {
        assert_near!(state.configuration(), found.configuration(), tolerance);
        assert_near!(state.momentum(), found.momentum(), tolerance);
        state = stepper.step(&state)?;
    }
    Ok(())
}

/// Least actions from an independent minimiser of high accuracy.
#[test]
fn the_least_action_of_a_far_turn() -> Result<(), Error> {
    for (weight, action) in [(0.0, 7.4705153239), (1.0, 6.8320311922)] {
        let stepper = principal(weight).stepper(0.02)?;
        let boundary = stepper.boundary();
        let start = Matrix3::identity();
        let mut path = [boundary.rest(&start); 50];
        let extremal = boundary.solve(&start, &far(), Guess::Geodesic, &mut path)?;
        assert!((extremal.action() - action).abs() < 1e-9, "{}", extremal.action());
        assert!(extremal.iterations() <= 6, "{}", extremal.iterations());
        assert!(extremal.gap() < 1e-13 && extremal.residual() < 1e-12, "{extremal:?}");
        assert_eq!(extremal.negative(), 0);
        assert_eq!(extremal.states().count(), 51);
        assert_shoots(&extremal, &boundary, 1e-11)?;
    }
    Ok(())
}

/// Against a solution in 60 digits.
#[test]
fn a_reference_in_many_digits() -> Result<(), Error> {
    let inertia = Vector3::new(1.0, 1.4, 0.9);
    let top = HeavyTop {
        mass_matrix: Matrix3::from_diagonal(&(Vector3::repeat(inertia.sum() / 2.0) - inertia)),
        weight: 0.8,
        center: Vector3::new(0.1, 0.2, 1.0),
    };
    let (h, steps) = (0.05, 20);
    #[rustfmt::skip]
    let start = Matrix3::new(
        0.975_290_308_953_045_7, 0.127_334_574_917_630_26, 0.180_540_076_694_397_73,
        -0.068_031_316_404_940_02, 0.950_580_617_906_091_5, -0.302_932_713_402_637_1,
        -0.210_191_705_950_742_82, 0.283_164_960_565_073_73, 0.935_754_803_277_918_9,
    );
    #[rustfmt::skip]
    let target = Matrix3::new(
        0.540_955_363_738_787_2, -0.839_042_467_473_993_6, -0.058_095_027_475_584_995,
        0.492_593_685_390_059_3, 0.372_061_582_472_869_25, -0.786_715_730_084_014_3,
        0.681_702_835_226_666_6, 0.396_960_850_239_588_27, 0.614_575_729_931_623_1,
    );
    let stepper = top.stepper(h)?;
    let boundary = stepper.boundary();
    let mut path = [boundary.rest(&start); 20];
    let extremal = boundary.solve(&start, &target, Guess::Geodesic, &mut path)?;
    // The reference kicks with all of the potential before each step: its momentum is after that kick.
    let half_kick =
        |r: &Matrix3<f64>| r.row(2).transpose().cross(&stepper.system().center) * (stepper.system().weight * h / 2.0);
    let kicked = extremal.momentum() + half_kick(&start);
    assert_near!(
        kicked,
        Vector3::new(0.490_985_774_334_678_6, -0.647_805_993_522_721_7, 0.982_684_444_641_447_8),
        1e-13
    );
    // Its action has −hV at the starts only.
    let ends = stepper.system().potential(0.0, &target) - stepper.system().potential(0.0, &start);
    assert!((extremal.action() + ends * h / 2.0 - 0.095_390_650_254_327_61).abs() < 1e-13, "{}", extremal.action());
    assert_eq!((extremal.negative(), extremal.nodes().len()), (0, steps));
    assert_shoots(&extremal, &boundary, 1e-12)
}

/// The action changes to second order only, and grows, where an interior vertex is moved.
#[test]
fn the_action_is_critical_and_least() -> Result<(), Error> {
    let (start, h) = (attitude(), 0.05);
    let stepper = top().stepper(h)?;
    let boundary = stepper.boundary();
    let mut path = [boundary.rest(&start); 10];
    let extremal =
        boundary.solve(&start, &(start * rotation(Vector3::new(0.9, -0.4, 0.6))), Guess::Geodesic, &mut path)?;
    let system = stepper.system();
    let constants = system.constants(h)?;
    let lagrangian = |q: &Matrix3<f64>, d: &Matrix3<f64>| {
        system.edge(&constants, 0, 0.0, (q, d, &system.advance(q, d), &())).lagrangian
    };
    for pair in extremal.nodes().windows(2) {
        let [first, second] = pair else { unreachable!("windows of two") };
        let action = |eta: &Vector3<f64>| {
            let after = system.compose(&system.retraction(&-eta), second.increment());
            lagrangian(first.configuration(), &system.compose(first.increment(), &system.retraction(eta)))
                + lagrangian(&system.advance(second.configuration(), &system.retraction(eta)), &after)
        };
        for j in 0..3 {
            let eta = Vector3::ith(j, 1e-3);
            let (up, here, down) = (action(&eta), action(&Vector3::zeros()), action(&-eta));
            // Third differences of a smooth action are 1e-9 here.
            assert!((up - down).abs() < 2e-8 * here.abs().max(1.0), "{:e}", up - down);
            assert!(up + down > 2.0 * here);
        }
    }
    Ok(())
}

/// A xorshift generator of numbers from −1 to 1.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self) -> Vector3<f64> {
        Vector3::from_fn(|_, _| self.next())
    }
}

#[test]
fn random_attitudes_are_reached() -> Result<(), Error> {
    let mut random = Random(0x5eed_1234_5678);
    for (system, limit) in [(body(), 0.98), (principal(0.0), 0.98), (top(), 0.98)] {
        let stepper = system.stepper(0.02)?;
        let boundary = stepper.boundary();
        let mut path = [boundary.rest(&Matrix3::identity()); 20];
        let mut worst = 0;
        for trial in 0..if cfg!(miri) {
            1
        } else if is_long() {
            1000
        } else {
            30
        } {
            let start = rotation(random.vector() * 2.0);
            let axis = Unit::new_normalize(random.vector() + Vector3::repeat(1e-9));
            let angle = random.next().abs() * limit * core::f64::consts::PI;
            let target = start * UnitQuaternion::from_axis_angle(&axis, angle).to_rotation_matrix().matrix();
            let extremal = boundary.solve(&start, &target, Guess::Geodesic, &mut path);
            let extremal = extremal.unwrap_or_else(|error| panic!("trial {trial}, angle {angle}: {error}"));
            assert!(extremal.gap() < 1e-12 && extremal.negative() == 0, "trial {trial}: {extremal:?}");
            assert!(extremal.residual() < 1e-11, "trial {trial}: {}", extremal.residual());
            worst = worst.max(extremal.iterations());
        }
        assert!(worst <= 40, "{worst}");
    }
    Ok(())
}

#[test]
fn one_and_two_steps() -> Result<(), Error> {
    let (start, target) = (attitude(), attitude() * rotation(Vector3::new(0.2, -0.1, 0.3)));
    for steps in [1, 2] {
        let stepper = top().stepper(0.1)?;
        let boundary = stepper.boundary();
        let mut path = std::vec![boundary.rest(&start); steps];
        let extremal = boundary.solve(&start, &target, Guess::Geodesic, &mut path)?;
        let arrived = last(&stepper, stepper.state(start, *extremal.momentum())?, steps)?;
        assert_near!(arrived.configuration(), target, 1e-13);
        assert_near!(arrived.momentum(), extremal.final_momentum(), 1e-13);
    }
    Ok(())
}

#[test]
fn staying_is_rest_without_a_potential() -> Result<(), Error> {
    let stepper = body().stepper(0.1)?;
    let boundary = stepper.boundary();
    let mut path = [boundary.rest(&attitude()); 7];
    let extremal = boundary.solve(&attitude(), &attitude(), Guess::Geodesic, &mut path)?;
    assert_eq!((extremal.action(), *extremal.momentum(), extremal.gap()), (0.0, Vector3::zeros(), 0.0));
    assert_eq!(extremal.iterations(), 1);
    // in gravity a body that is to be back must be thrown up
    let stepper = top().stepper(0.01)?;
    let boundary = stepper.boundary();
    let mut path = [boundary.rest(&attitude()); 30];
    let extremal = boundary.solve(&attitude(), &attitude(), Guess::Geodesic, &mut path)?;
    assert!(extremal.momentum().norm() > 0.1);
    assert_shoots(&extremal, &boundary, 1e-12)
}

/// The reversed problem with the reversed step has the negative action and the reversed path.
#[test]
fn negative_steps_run_back() -> Result<(), Error> {
    let (start, target) = (attitude(), attitude() * rotation(Vector3::new(0.2, -1.1, 0.3)));
    let (forward, backward) = (top().stepper(0.03)?, top().stepper(-0.03)?);
    let (forward, backward) = (forward.boundary(), backward.boundary());
    let (mut there, mut back) = ([forward.rest(&start); 12], [backward.rest(&start); 12]);
    let there = forward.solve(&start, &target, Guess::Geodesic, &mut there)?;
    let back = backward.solve(&target, &start, Guess::Geodesic, &mut back)?;
    assert!((there.action() + back.action()).abs() < 1e-12);
    assert_near!(there.momentum(), back.final_momentum(), 1e-12);
    assert_eq!((there.negative(), back.negative()), (0, 0));
    Ok(())
}

/// The gain of each node predicts the solution from a neighbouring start.
#[test]
fn gains_are_optimal_feedback() -> Result<(), Error> {
    let (start, target) = (attitude(), attitude() * rotation(Vector3::new(0.7, 0.1, -0.8)));
    let stepper = top().stepper(0.05)?;
    let boundary = stepper.boundary();
    let mut path = [boundary.rest(&start); 10];
    boundary.solve(&start, &target, Guess::Geodesic, &mut path)?;
    let eta = Vector3::new(1e-4, -2e-4, 3e-4);
    let mut moved = path;
    let extremal = boundary.solve(&(start * rotation(eta)), &target, Guess::Path, &mut moved)?;
    assert!(extremal.iterations() <= 4, "{}", extremal.iterations());
    let expected = path[1].configuration() * rotation(-(path[0].gain() * eta));
    assert_near!(moved[1].configuration(), expected, 1e-6);
    assert_eq!(*path[9].gain(), Matrix3::zeros());
    Ok(())
}

/// A solution is a good guess for a far target too, and for another body.
#[test]
fn solutions_are_guesses() -> Result<(), Error> {
    let start = attitude();
    let stepper = body().stepper(0.05)?;
    let boundary = stepper.boundary();
    let mut path = [boundary.rest(&start); 10];
    for angle in [0.1, 0.2, 1.5, 3.0] {
        let target = start * rotation(Vector3::new(0.6, 0.0, 0.8) * angle);
        let extremal = boundary.solve(&start, &target, Guess::Path, &mut path)?;
        assert_eq!(extremal.negative(), 0);
        assert_shoots(&extremal, &boundary, 1e-11)?;
    }
    let (other, target) = (top().stepper(0.05)?, start * rotation(Vector3::new(0.6, 0.0, 0.8) * 3.0));
    let other = other.boundary();
    let mut warm = path.map(|node| other.rest(node.configuration()));
    let extremal = other.solve(&start, &target, Guess::Path, &mut warm)?;
    assert_shoots(&extremal, &other, 1e-11)
}

#[test]
fn the_number_of_steps_hardly_matters() -> Result<(), Error> {
    let lengths = [(10, 1e-13), (100, 1e-12), (1000, 1e-11), (10_000, 1e-10)];
    for (steps, tolerance) in lengths.into_iter().take(if cfg!(miri) {
        1
    } else if is_long() {
        4
    } else {
        3
    }) {
        let stepper = principal(1.0).stepper(1.0 / steps as f64)?;
        let boundary = stepper.boundary();
        let mut path: std::vec::Vec<Node<HeavyTop, 3>> = std::vec![boundary.rest(&Matrix3::identity()); steps];
        let extremal = boundary.solve(&Matrix3::identity(), &far(), Guess::Geodesic, &mut path)?;
        assert!(extremal.iterations() <= 7, "{steps}: {}", extremal.iterations());
        assert!(extremal.gap() < tolerance, "{steps}: {:e}", extremal.gap());
        assert_shoots(&extremal, &boundary, 1e3 * tolerance)?;
    }
    Ok(())
}

/// A long body is far from a free motion when it turns about a fixed axis once more than it has to. The action has to
/// go downhill.
#[test]
#[cfg_attr(miri, ignore = "too long to interpret: dozens of iterations over thousands of nodes")]
fn the_number_of_steps_hardly_matters_far_from_the_extremal() -> Result<(), Error> {
    let mass_matrix = Matrix3::from_diagonal(&Vector3::new(3.4, 0.2, 0.8));
    let axis = Vector3::new(0.48, 0.6, 0.64);
    for (turns, angle) in [(1.0, 2.4), (-2.0, 2.4), (1.0, 0.9)] {
        let angle: f64 = angle + turns * core::f64::consts::TAU;
        for steps in if is_long() { [100, 1000, 4000] } else { [30, 100, 300] } {
            let stepper =
                HeavyTop { mass_matrix, weight: 0.0, center: Vector3::z() }.stepper(1.0 / f64::from(steps))?;
            let boundary = stepper.boundary();
            let mut path = std::vec![boundary.rest(&Matrix3::identity()); steps as usize];
            let guess = Guess::Velocity(axis * angle);
            let extremal = boundary.solve(&Matrix3::identity(), &rotation(axis * angle), guess, &mut path)?;
            assert!(extremal.iterations() <= 40, "{turns}, {steps}: {}", extremal.iterations());
        }
    }
    Ok(())
}

#[test]
fn bad_input_is_told() -> Result<(), Error> {
    let stepper = body().stepper(0.1)?;
    let boundary = stepper.boundary();
    let start = attitude();
    let mut path = [boundary.rest(&start); 3];
    let mut solve =
        |start, target, guess| boundary.solve(&start, &target, guess, &mut path).map(|found| found.action());
    assert!(matches!(solve(start, start * 1.1, Guess::Geodesic), Err(Error::OffOrbit { .. })));
    assert!(matches!(solve(-start, start, Guess::Geodesic), Err(Error::OffOrbit { .. })));
    assert!(matches!(solve(start, start * f64::NAN, Guess::Geodesic), Err(Error::NotFinite { .. })));
    let velocity = Guess::Velocity(Vector3::new(f64::INFINITY, 0.0, 0.0));
    assert!(matches!(solve(start, start, velocity), Err(Error::NotFinite { .. })));
    let empty = boundary.solve(&start, &start, Guess::Geodesic, &mut []).map(|found| found.action());
    assert_eq!(empty, Err(Error::PathLength { nodes: 0, per_step: 1 }));
    // a half turn has two ways
    let half = start * rotation(Vector3::x() * core::f64::consts::PI);
    assert!(matches!(solve(start, half, Guess::Geodesic), Err(Error::UndeterminedDirection { .. })));
    Ok(())
}
