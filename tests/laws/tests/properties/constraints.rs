//! Constraints: momenta that are brought to them, states from velocities, and the forces of a step.

use crate::arbitrary::{cases, definite, matrix, vector};
use crate::bodies::H;
use crate::runner::proptest;
use clebsch::__private::{
    At, ConstrainedLink, ConstrainedSubstep, Correction, Parts, Price, Scheme, Substep, VariedSubstep, Violation,
    check_constraint, check_place, constrained, independent, multipliers, pair, placed, placed_state, reactions,
    slopes_with_constraint, tangent_projector, violation, with_constraint,
};
use clebsch::{Clebsch, Constrained, Controlled, Declared, Error, Method, Reacting, Variational};
use clebsch_tests::oracle::near::assert_near;
use nalgebra::{Matrix1, Matrix1x3, Matrix2, Matrix2x3, Matrix3, Matrix3x2, SMatrix, Vector1, Vector2, Vector3};
use proptest::prelude::*;

const NEAR: f64 = 1e-12;

/// A particle with a row that turns with the place, and a value that grows with the time.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |a: Translation<3>, x: Vector3| x + a,
    lagrangian = |v| v.dot(&(self.mass * v)) / 2,
    potential  = |x| self.pull.dot(&x),
    constraint = |t, x, v| [v.z == x.y * v.x + self.rate * t],
    emit       = [tangent],
)]
pub struct Guided {
    #[clebsch(symmetric)]
    pub mass: Matrix3<f64>,
    pub pull: Vector3<f64>,
    pub rate: f64,
}

/// The same with a force as input.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |a: Translation<3>, x: Vector3| x + a,
    lagrangian = |v| v.dot(&(self.mass * v)) / 2,
    potential  = |x| self.pull.dot(&x),
    force      = |push: Vector3| push,
    constraint = |t, x, v| [v.z == x.y * v.x + self.rate * t],
)]
pub struct Driven {
    #[clebsch(symmetric)]
    pub mass: Matrix3<f64>,
    pub pull: Vector3<f64>,
    pub rate: f64,
}

/// A bead on a sphere.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |a: Translation<3>, x: Vector3| x + a,
    lagrangian = |v| v.norm_squared() / 2,
    constraint = |t, x| [x.norm_squared() == 1 + self.growth * t],
)]
pub struct Bead {
    pub growth: f64,
}

/// A mass on a sphere with a force as input, which plans choose.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |a: Translation<3>, x: Vector3| x + a,
    lagrangian = |v| self.mass * v.norm_squared() / 2,
    force      = |v, u: Vector2| vector![u.x, u.y, 0] - v.norm_squared() * v / 9,
    constraint = |t, x| [x.norm_squared() == 1 + self.growth * t],
    effort     = |h, u| h * u.norm_squared() / 2,
    emit       = [tangent],
)]
pub struct Pushed {
    pub mass: f64,
    pub growth: f64,
}

proptest! {
    #![proptest_config(cases(64))]

    /// A ξ = b afterwards, and the change of the momentum is a combination of the rows.
    #[test]
    fn momenta_come_to_constraints(mass in definite::<3>(), a in matrix::<2, 3>(1.0), mu in vector::<3>(1.0), b in vector::<2>(1.0)) {
        let (a, inverse) = (Matrix2x3::from(a), mass.try_inverse().expect("a regular matrix"));
        let metric = a * inverse * a.transpose();
        prop_assume!(metric.determinant() > 1e-3 * metric.trace().powi(2));
        let found = constrained(&mu, &a, &(inverse * mu), &b, &metric)?;
        assert_near(&(a * inverse * found), &b, NEAR, "the constraint");
        let normal = a.row(0).transpose().cross(&a.row(1).transpose());
        prop_assert!((found - mu).dot(&normal).abs() < NEAR);
        let left = violation(&found, &a, &(inverse * found), &b, &metric)?;
        prop_assert!(left.largest < NEAR && left.size >= 0.0);
        prop_assert_eq!(Violation::<f64>::none().largest, 0.0);
    }

    /// A state from a velocity has the momentum of it, at any time.
    #[test]
    fn velocities_obey_constraints(mass in definite::<3>(), pull in vector::<3>(1.0), x in vector::<3>(1.0), v in vector::<2>(1.0), t in -1.0_f64..1.0) {
        let system = Guided { mass, pull, rate: 0.7 };
        let (stepper, constants) = (system.stepper(H)?, system.constants(H)?);
        let velocity = Vector3::new(v.x, v.y, x.y * v.x);
        let start = stepper.state_moving(x, velocity)?;
        prop_assert_eq!(start.momentum(), system.momentum_of_velocity(0.0, &x, &velocity));
        assert_near(&start.momentum(), &(mass * velocity), NEAR, "the momentum");
        let beyond = stepper.state_moving(x, velocity + Vector3::z());
        let is_refused = matches!(beyond, Err(Error::ConstraintViolated { violation, .. }) if (violation - 1.0).abs() < NEAR);
        prop_assert!(is_refused);
        // at another time
        let mu = stepper.project_at(t, x, mass * velocity)?.momentum();
        let inverse = mass.try_inverse().expect("a regular matrix");
        let reached = inverse * mu;
        prop_assert!((reached.z - x.y * reached.x - 0.7 * t).abs() < NEAR);
        prop_assert_eq!(stepper.project(x, mu)?, stepper.project_at(0.0, x, mu)?);
        // the same by the system and by its method
        prop_assert_eq!(system.constrained(&constants, t, &x, &(mass * velocity))?, mu);
        prop_assert_eq!(<Declared as Method<Guided>>::constrained(&system, &constants, t, &x, &(mass * velocity))?, mu);
        prop_assert!(system.constraint_defect(&constants, t, &x, &mu)?.largest < NEAR);
        let defect = <Declared as Method<Guided>>::constraint_defect(&system, &constants, 0.0, &x, &mu)?;
        prop_assert!((defect.largest - (0.7 * t).abs()).abs() < NEAR);
    }

    /// The place of a state is on the constraint at its time, to the rounding of its size.
    #[test]
    fn places_obey_constraints(x in vector::<3>(1.0), t in 0.0_f64..1.0, off in 1e-6_f64..1.0) {
        prop_assume!(x.norm() > 0.1);
        let bead = Bead { growth: 0.5 };
        let place = x.normalize() * (1.0 + 0.5 * t).sqrt();
        prop_assert_eq!(bead.check_place(t, &place), Ok(()));
        let far = bead.check_place(t, &(place * (1.0 + off)));
        let beyond = (1.0 + 0.5 * t) * (off * (2.0 + off));
        let is_told = matches!(far, Err(Error::OffConstraint { violation, .. }) if (violation - beyond).abs() < NEAR);
        prop_assert!(is_told, "{:?}", far);
        // rows of one: the tolerance is √ε of 1 + |q|
        let rows = Matrix1x3::new(1.0, 0.0, 0.0);
        prop_assert_eq!(check_place(&Vector1::new(1e-9), &rows, &place), Ok(()));
        prop_assert!(check_place(&Vector1::new(f64::NAN), &rows, &place).is_err());
    }

    /// A place comes straight to the sphere, as motions of a point are shortest so.
    #[test]
    fn places_come_to_constraints(x in vector::<3>(1.0), t in 0.0_f64..1.0) {
        prop_assume!(x.norm() > 0.1);
        let bead = Bead { growth: 0.5 };
        let constants = bead.constants(H)?;
        let expected = x.normalize() * (1.0 + 0.5 * t).sqrt();
        let found = bead.placed(&constants, t, &x)?;
        assert_near(&found, &expected, NEAR, "the place");
        prop_assert_eq!(<Declared as Method<Bead>>::placed(&bead, &constants, t, &x)?, found);
        let near = |x: &Vector3<f64>| Correction {
            places: Vector1::new(x.norm_squared() - 1.0),
            rows: Matrix1x3::new(2.0 * x.x, 2.0 * x.y, 2.0 * x.z),
            metric: Matrix1::new(4.0 * x.norm_squared()),
            moved: x * 2.0,
        };
        assert_near(&placed(&bead, &x, near, |x| *x)?, &x.normalize(), NEAR, "the same place");
        let nowhere = |x: &Vector3<f64>| Correction { places: Vector1::new(x.norm_squared() + 1.0), ..near(x) };
        prop_assert!(placed(&bead, &x, nowhere, |x| *x).is_err());
    }

    /// A step: kick, solve, the force of the constraint along its rows, move, kick, projection. The velocity of the step obeys the
    /// constraint between both ends, and that of the momentum after it at the end.
    #[test]
    fn constraints_push_along_their_rows(mass in definite::<3>(), pull in vector::<3>(1.0), x in vector::<3>(1.0), v in vector::<2>(1.0)) {
        let system = Guided { mass, pull, rate: 0.7 };
        let (stepper, constants) = (system.stepper(H)?, system.constants(H)?);
        let start = stepper.state_moving(x, Vector3::new(v.x, v.y, x.y * v.x))?;
        let kicked = start.momentum() + Substep::<0>::start_kick(&system, &constants, 0.0, &x).expect("a kick");
        let moved = Substep::<0>::solve(&system, &constants, 0.0, &x, &kicked, &())?;
        let push = Substep::<0>::reaction(&system, &constants, 0.0, &x, &kicked, &moved, &()).expect("a force");
        let row = |x: &Vector3<f64>| Vector3::new(-x.y, 0.0, 1.0);
        prop_assert!(push.cross(&row(&x)).norm() < NEAR);
        assert_near(&(kicked + push), &(mass * moved / H), NEAR, "the momentum of the step");
        let mean = x + moved / 2.0;
        prop_assert!((row(&mean).dot(&moved) / H - 0.7 * H / 2.0).abs() < NEAR);
        let next = Parts::advance(&system, &x, &system.motion(&moved, || system.increment(&moved)));
        let reached = kicked + push + Substep::<0>::end_kick(&system, &constants, 0.0, &next).expect("a kick");
        let repair = Substep::<0>::projection(&system, &constants, 0.0, &next, &reached).expect("a projection");
        prop_assert!(repair.cross(&row(&next)).norm() < NEAR);
        let end = stepper.step(&start)?;
        assert_near(&(reached + repair), &end.momentum(), NEAR, "the step");
        let velocity = mass.try_inverse().expect("a regular matrix") * end.momentum();
        prop_assert!((row(end.configuration()).dot(&velocity) - 0.7 * H).abs() < NEAR);
        // the third component of a row is 1, so that of a push is its multiplier
        prop_assert!((system.multipliers(&constants, 0.0, &x, &push).x - push.z).abs() < NEAR);
        let mut pushes = Vec::new();
        let at = At::<_, Declared>::new(&system, &constants, 0.0);
        type Steps = <Guided as Clebsch>::Scheme;
        let left = <Steps as Scheme<Guided>>::left(at, &x, &start.momentum());
        let stepped = <Steps as Scheme<Guided>>::step_pushed(at, (&x, &start.momentum(), &left), &(), |push| {
            pushes.push((*push.place, *push.momentum, push.is_after));
        });
        prop_assert_eq!(stepped?.0, *end.configuration());
        prop_assert_eq!(pushes, vec![(x, push, false), (next, repair, true)]);
        let (same, reactions) = stepper.step_with_reactions(&start)?;
        prop_assert_eq!(same, end);
        prop_assert!((reactions.x - (push.z + repair.z) / H).abs() < NEAR / H);
    }

    /// With N′ = −∂V + f + Aᵀλ the acceleration obeys the derivative of the constraint.
    #[test]
    fn reactions_hold_motions_on_constraints(mass in definite::<3>(), pull in vector::<3>(1.0), x in vector::<3>(1.0), v in vector::<2>(1.0), u in vector::<3>(1.0)) {
        let system = Driven { mass, pull, rate: 0.7 };
        let (stepper, constants) = (system.stepper(H)?, system.constants(H)?);
        let velocity = Vector3::new(v.x, v.y, x.y * v.x);
        let start = stepper.state_moving(x, velocity)?;
        let lambda = stepper.reactions_under(&start, &u)?;
        let force = u - pull + Vector3::new(-x.y, 0.0, 1.0) * lambda.x;
        let change = mass.try_inverse().expect("a regular matrix") * force;
        // z″ = y′x′ + y x″ + rate
        prop_assert!((change.z - v.y * v.x - x.y * change.x - 0.7).abs() < NEAR);
        prop_assert_eq!(stepper.reactions(&start)?, stepper.reactions_under(&start, &Vector3::zeros())?);
        prop_assert_eq!(system.reactions_of_motion(&constants, 0.0, &x, &start.momentum(), &u)?, lambda);
        let (end, mean) = stepper.step_with_reactions_under(&start, &u)?;
        prop_assert_eq!(&end, &stepper.step_with(&start, &u)?);
        // those of a short step are near
        prop_assert!((mean - lambda).norm() < 1e3 * H);
        // S λ = −d/dt (A ξ − b)
        let metric = Matrix2::new(3.0, 1.0, 1.0, 2.0);
        let found = reactions(&metric, &(metric * v))?;
        assert_near(&found, &v, NEAR, "the multipliers");
        prop_assert_eq!(found, multipliers(&metric, &(metric * v)));
        let dependent = Matrix2::new(1.0, 1.0, 1.0, 1.0);
        prop_assert_eq!(reactions(&dependent, &v), Err(Error::DependentConstraints { rank: 1, rows: 2 }));
        prop_assert!(multipliers(&dependent, &v).x.is_nan());
    }

    /// A = (−y, 0, 1), ψ = A(x + d/2)·d/h − rate (t + h/2), A Σ⁻¹N − rate (t + h), and their derivatives. In the edge of a
    /// step, changes of N along A leave no trace. Those of N⁺ obey the constraint.
    #[test]
    fn edges_have_the_slopes_of_constraints(mass in definite::<3>(), pull in vector::<3>(1.0), x in vector::<3>(1.0), v in vector::<2>(1.0), kappa in -1.0_f64..1.0, t in -1.0_f64..1.0) {
        type Edge<'a> = (&'a Vector3<f64>, &'a Vector3<f64>, &'a Vector3<f64>, &'a ());
        let system = Guided { mass, pull, rate: 0.7 };
        let (constants, inverse) = (system.constants(H)?, mass.try_inverse().expect("a regular matrix"));
        let (d, kappa) = (Vector3::new(v.x, v.y, x.y * v.x) * H, Vector1::new(kappa));
        let (next, mu) = (x + d, mass * Vector3::new(v.y, v.x, 0.3));
        let ends: Edge<'_> = (&x, &d, &next, &());
        let row = |x: &Vector3<f64>| Matrix1x3::new(-x.y, 0.0, 1.0);
        let start = ConstrainedSubstep::<0, 3, 1, 12>::at_start(&system, &constants, t, ends, &kappa);
        assert_near(&start.rows, &row(&x), NEAR, "A");
        assert_near(&start.by_inertia, &(row(&x) * inverse), NEAR, "A Σ⁻¹");
        let turned = Matrix3::new(0.0, -kappa.x, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
        assert_near(&start.push, &turned, NEAR, "∂(Aᵀλ)");
        let along_y = |slope: f64| Matrix1x3::new(0.0, slope, 0.0);
        assert_near(&start.between, &along_y(-d.x / H), NEAR, "∂ψ/∂η");
        let by_end = row(&(x + d / 2.0)) / H + along_y(-d.x / (2.0 * H));
        assert_near(&start.between_by_end, &by_end, NEAR / H, "∂ψ/∂η′");
        let end = ConstrainedSubstep::<0, 3, 1, 12>::at_end(&system, &constants, t, &next, &mu, &kappa);
        assert_near(&end.rows, &row(&next), NEAR, "A⁺");
        assert_near(&end.by_inertia, &(row(&next) * inverse), NEAR, "A⁺Σ⁻¹");
        assert_near(&end.push, &turned, NEAR, "∂(Aᵀμ)");
        assert_near(&end.velocity, &along_y(-(inverse * mu).x), NEAR, "∂(A Σ⁻¹N⁺ − b)");
        prop_assert!((<Guided as ConstrainedSubstep<0, 3, 1, 12>>::end(&constants, t) - t - H).abs() < NEAR);
        // mass, pull, rate, h, t: in A itself there is none of them
        let (push, between) = ConstrainedSubstep::<0, 3, 1, 12>::slopes_at_start(&system, &constants, t, ends, &kappa);
        prop_assert_eq!(push.amax(), 0.0);
        prop_assert_eq!(between.columns(0, 9).amax(), 0.0);
        let middle = row(&(x + d / 2.0)).transpose();
        let expected = [-(t + H / 2.0), -middle.dot(&d) / (H * H) - 0.35, -0.7];
        (0..3).for_each(|k| assert!((between[9 + k] - expected[k]).abs() < NEAR / (H * H), "∂ψ/∂ quantity {k}"));
        let (push, velocity) =
            ConstrainedSubstep::<0, 3, 1, 12>::slopes_at_end(&system, &constants, t, &next, &mu, &kappa);
        prop_assert_eq!(push.amax(), 0.0);
        // Σ⁻¹ moves by −Σ⁻¹ δΣ Σ⁻¹: the first entry of Σ
        let slope = -(end.by_inertia[0] * (inverse * mu).x);
        prop_assert!((velocity[0] - slope).abs() < NEAR);
        let expected = [-(t + H), -0.7, -0.7];
        (0..3).for_each(|k| assert!((velocity[9 + k] - expected[k]).abs() < NEAR, "∂(A ξ − b)/∂ quantity {k}"));
        // the edge as a step passes it
        let carried = VariedSubstep::<0, 3>::carried(&system, &constants, t, ends);
        let passed = with_constraint::<_, Declared, 0, 3, 1, 12>(&system, (&constants, t), ends, &mu, &carried);
        let passed = passed.expect("independent rows");
        let balance = passed.balance.expect("a constraint");
        prop_assert!((balance * row(&x).transpose()).amax() < NEAR);
        prop_assert!((start.by_inertia * balance).amax() < NEAR);
        prop_assert!((end.by_inertia * passed.edge.momentum - Vector1::new(0.7 * (t + H))).amax() < NEAR);
        let slope = along_y(-(inverse * passed.edge.momentum).x);
        prop_assert!((end.by_inertia * passed.edge.after_by_end + slope).amax() < NEAR / H);
        let slopes = VariedSubstep::<0, 3>::slopes(&system, &constants, t, ends);
        let (_, after) =
            slopes_with_constraint::<_, Declared, 0, 3, 1, 12>(&system, (&constants, t), ends, &mu, slopes)
                .expect("independent rows");
        let by_time = (end.by_inertia * after.column(11))[0];
        prop_assert!((by_time - 0.7).abs() < NEAR / H);
    }

    /// The projectors of plans leave states on the constraint, to first order, and known. Places come to it, and only those on it pass.
    #[test]
    fn plans_move_on_constraints(
        mass in 0.5_f64..2.0, growth in -0.2_f64..0.2, t in 0.5_f64..1.0, x in vector::<3>(1.0), mu in vector::<3>(1.0),
        (eta, nu) in (vector::<3>(1.0), vector::<3>(1.0)), far in 0.1_f64..0.5,
    ) {
        prop_assume!(x.norm() > 0.2);
        let system = Pushed { mass, growth };
        let constants = system.prepare(H)?;
        let near = (x.normalize() * (1.0 + growth * t).sqrt() * 1.01, mu);
        let on = system.constrained_place(&constants, t, &near);
        prop_assert_eq!(placed_state(&system, &constants.0, t, &near), on);
        prop_assert_eq!(system.check_constraint(&constants, t, &on, true), Ok(()));
        prop_assert_eq!(check_constraint(&system, &constants.0, (t, H), &on, true), Ok(()));
        let off = (on.0 * (1.0 + far), on.1);
        let refused = system.check_constraint(&constants, t, &off, false);
        let is_off = matches!(refused, Err(Error::OffConstraint { .. }));
        prop_assert!(is_off, "{:?}", refused);
        let leaving = (on.0, on.1 + on.0 * far);
        prop_assert_eq!(system.check_constraint(&constants, t, &leaving, false), Ok(()));
        let refused = system.check_constraint(&constants, t, &leaving, true);
        let is_violated = matches!(refused, Err(Error::ConstraintViolated { .. }));
        prop_assert!(is_violated, "{:?}", refused);

        let projector = system.tangent_projector(&constants, t, &on).expect("independent rows");
        let direct = tangent_projector::<_, Declared, 3, 6, 1, 6, 1>(&system, &constants.0, t - H, &on);
        assert_near(&direct.expect("independent rows"), &projector, 1e-15, "P");
        assert_near(&(projector * projector), &projector, 1e-12, "PP");
        let delta = projector * pair::<f64, 3, 6>(&eta, &nu);
        for epsilon in [1e-3, 1e-4] {
            let moved = system.moved(&on, &(delta * epsilon));
            let placed = system.constrained_place(&constants, t, &moved);
            let apart = (placed.0 - moved.0).norm() + (placed.1 - moved.1).norm();
            prop_assert!(apart < 40.0 * epsilon * epsilon, "{} at {}", apart, epsilon);
        }
        let lengths = pair::<f64, 3, 6>(&Vector3::new(1.0, 2.0, 3.0), &Vector3::repeat(1.0));
        let known = system.independent(&constants, t, &on, &lengths).expect("independent rows");
        let direct = independent::<_, Declared, 3, 6, 1, 6, 1>(&system, &constants.0, t - H, &on, &lengths);
        assert_near(&direct.expect("independent rows"), &known, 1e-15, "the projector to what is known");
        assert_near(&known.transpose(), &known, 1e-13, "the transpose");
        assert_near(&(known * known), &known, 1e-12, "its square");
        // no change on the constraint is lost
        let seen = known * delta.component_mul(&lengths);
        prop_assert!(seen.norm() > 1e-3 * delta.norm(), "{} of {}", seen.norm(), delta.norm());
    }

    /// A linearised step of a plan is that of the stepper, and prices of an edge and bounds go through the same derivatives.
    #[test]
    fn plans_have_the_derivatives_of_constrained_steps(
        mass in 0.5_f64..2.0, growth in -0.2_f64..0.2, x in vector::<3>(1.0), mu in vector::<3>(1.0),
        u in vector::<2>(1.0), costate in matrix::<6, 1>(1.0), slope in matrix::<8, 1>(1.0),
    ) {
        prop_assume!(x.norm() > 0.2);
        let system = Pushed { mass, growth };
        let stepper = system.clone().into_stepper(H)?;
        let state = stepper.project(x.normalize(), mu)?;
        let (next, tangent) = stepper.step_tangent_with(&state, &u)?;
        let (q, mu, after) = (*state.configuration(), state.momentum(), *next.configuration());
        let constants = system.prepare(H)?;
        let step = system.expand(&constants, 0.0, &(q, mu), &u, &costate)?;
        let of_places = step.by_place.fixed_view::<3, 3>(3, 0).into_owned();
        assert_near(&of_places, &tangent.momentum_by_motion, NEAR, "∂ν′/∂η");

        let d = after - q;
        let ends = (&q, &d, &after, &u);
        let edge = Variational::carried(&system, &constants.0, 0, 0.0, ends);
        let push = Matrix3x2::identity() * H / 2.0;
        let (kick, price) = (-push, Vector3::zeros());
        let link = ConstrainedLink::<f64, 3, 6, 2, 1>::new::<_, Declared, 6>(
            &system, (&constants.0, 0.0), (ends, &mu), &edge, (&kick, &push), (&costate, &price),
        );
        let link = link.expect("a regular step").crossed(&SMatrix::<f64, 5, 6>::zeros());
        let none = Price {
            price: 0.0, by_motion: Vector3::zeros(), by_input: Vector2::zeros(),
            motions: Matrix3::zeros(), mixed: SMatrix::zeros(), inputs: SMatrix::zeros(),
        };
        let (flat, bracket) = (SMatrix::<f64, 8, 8>::zeros(), Matrix3::zeros());
        let plain = link.expansion((), &flat, &bracket, &none);
        assert_near(&plain.by_place, &step.by_place, NEAR, "A");
        assert_near(&plain.by_input, &step.by_input, NEAR, "B");
        let priced = link.expansion_of_edge((), &flat, &bracket, (1.0, &slope, &flat));
        let bounded = link.bounds(Vector1::new(2.0), &slope.transpose(), &flat);
        assert_near(&priced.price_by_place, &bounded.by_place.transpose(), NEAR, "the slope along places");
        assert_near(&priced.price_by_input, &bounded.by_input.transpose(), NEAR, "the slope along inputs");
        // along motions that leave F as it is, those of q⁺ alone, and inputs: ζ = η′ − η
        let zeta = step.by_place.fixed_view::<3, 6>(0, 0) - SMatrix::<f64, 3, 6>::identity();
        let expected = SMatrix::<f64, 3, 6>::identity().tr_mul(&slope.fixed_rows::<3>(0)) + zeta.tr_mul(&slope.fixed_rows::<3>(3));
        assert_near(&priced.price_by_place, &expected, NEAR, "the slope of an edge");
    }
}
