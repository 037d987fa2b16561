//! The formulas that are derived from an action, a cost and a potential. They are the laws of group actions, momentum
//! maps and Legendre transforms, and their closed forms on rotations and motions.

use crate::arbitrary::{attitude, cases, matrix, rotation, unit, vector};
use crate::bodies::{H, inertia_of, pendulums, satellites, tops, vehicles};
use crate::runner::proptest;
use clebsch::{__private as private, Clebsch, Stepper};
use clebsch_tests::oracle::near::assert_near;
use clebsch_tests::oracle::rotation::hat;
use clebsch_tests::stepping::Stepping;
use nalgebra::{Matrix3, Matrix4, SVector, Vector3};
use proptest::prelude::*;

/// Sums of a few dozen products of numbers of order one.
const NEAR: f64 = 1e-13;

/// (R, x) as a motion.
fn motion(r: &Matrix3<f64>, x: &Vector3<f64>) -> Matrix4<f64> {
    let mut motion = Matrix4::identity();
    motion.fixed_view_mut::<3, 3>(0, 0).copy_from(r);
    motion.fixed_view_mut::<3, 1>(0, 3).copy_from(x);
    motion
}

/// The generator of the velocity (ω, v).
fn twist(xi: &SVector<f64, 6>) -> Matrix4<f64> {
    let mut twist = Matrix4::zeros();
    twist.fixed_view_mut::<3, 3>(0, 0).copy_from(&hat(&xi.fixed_rows::<3>(0).into_owned()));
    twist.fixed_view_mut::<3, 1>(0, 3).copy_from(&xi.fixed_rows::<3>(3));
    twist
}

/// (ω, v) of a generator.
fn velocity(twist: &Matrix4<f64>) -> SVector<f64, 6> {
    private::pair(
        &Vector3::new(twist[(2, 1)], twist[(0, 2)], twist[(1, 0)]),
        &Vector3::new(twist[(0, 3)], twist[(1, 3)], twist[(2, 3)]),
    )
}

/// A stepper computes the same as its system.
fn steppers_know_their_systems<S>(
    stepper: &Stepper<S>,
    q: &S::Configuration,
    p: &S::Configuration,
    f: &S::Element,
    mu: &S::Momentum,
) where
    S: Clebsch<Scalar = f64, Time = ()> + Clone,
{
    let system = stepper.system();
    let constants = system.step_constants(H).expect("regular");
    assert_eq!(system.clone().into_stepper(H).expect("regular").step_size(), stepper.step_size());
    assert_eq!(stepper.act(f, q), system.act(f, q));
    assert_eq!(stepper.momentum_map(q, p), system.momentum_map(q, p));
    assert_eq!(stepper.coadjoint(f, mu), system.coadjoint(f, mu));
    assert_eq!(stepper.momentum_matrix(mu), S::momentum_matrix(mu));
    assert_eq!(stepper.momentum_components(&S::momentum_matrix(mu)), S::momentum_components(&S::momentum_matrix(mu)));
    for t in [0.0, 0.7] {
        assert_eq!(stepper.potential_at(t, q), stepper.potential(q));
        assert_eq!(system.potential(t, q), stepper.potential(q));
        assert_eq!(stepper.legendre_at(t, q, f), stepper.legendre(q, f));
        assert_eq!(system.legendre(H, t, q, f), stepper.legendre(q, f));
        assert_eq!(stepper.legendre_next_at(t, q, f), stepper.legendre_next(q, f));
        assert_eq!(system.legendre_next(H, t, q, f), stepper.legendre_next(q, f));
        assert_eq!(stepper.inverse_legendre_at(t, q, mu), stepper.inverse_legendre(q, mu));
        assert_eq!(system.inverse_legendre(&constants, t, q, mu), stepper.inverse_legendre(q, mu));
    }
}

proptest! {
    #![proptest_config(cases(48))]

    /// Φ_F(R) = RF: a right action, with Ad*_F μ = Fᵀμ and J(R, p)_i = tr(pᵀR E_i).
    #[test]
    fn rotations_act_from_the_right(
        top in tops(), (f, g, r) in (attitude(), attitude(), attitude()), (p, mu) in (matrix::<3, 3>(1.0), vector::<3>(1.0)),
    ) {
        let stepper = top.stepper(H)?;
        prop_assert_eq!(stepper.act(&Matrix3::identity(), &r), r);
        assert_near(&stepper.act(&f, &stepper.act(&g, &r)), &stepper.act(&(g * f), &r), NEAR, "Φ_FΦ_G = Φ_GF");
        assert_near(&stepper.act(&f, &r), &(r * f), NEAR, "RF");
        assert_near(&stepper.coadjoint(&f, &mu), &(f.transpose() * mu), NEAR, "Fᵀμ");
        let twice = stepper.coadjoint(&g, &stepper.coadjoint(&f, &mu));
        assert_near(&twice, &stepper.coadjoint(&(f * g), &mu), NEAR, "Ad*_G Ad*_F = Ad*_FG");
        let map = stepper.momentum_map(&r, &p);
        let paired = Vector3::from_fn(|i, _| (p.transpose() * r * hat(&Vector3::ith(i, 1.0))).trace());
        assert_near(&map, &paired, NEAR, "J");
        assert_near(&stepper.momentum_map(&(r * f), &(p * f)), &stepper.coadjoint(&f, &map), NEAR, "J is equivariant");
        // M with tr(MᵀE_i) = μ_i, in the span of the E_i
        let representing = stepper.momentum_matrix(&mu);
        assert_near(&stepper.momentum_components(&representing), &mu, NEAR, "there and back");
        assert_near(&representing, &(hat(&mu) / 2.0), NEAR, "Σ μ_i E_i/2");
        let step = rotation_below_a_right_angle(&f);
        steppers_know_their_systems(&stepper, &r, &p, &step, &mu);
    }

    /// Φ_F(q) = Fq: a left action, with Ad*_F μ = Fᵀμ too, and J(q, p) = q × p.
    #[test]
    fn rotations_act_on_the_sphere_from_the_left(
        pendulum in pendulums(), (f, g) in (attitude(), attitude()), q in unit(), (p, mu) in (vector::<3>(1.0), vector::<3>(1.0)),
    ) {
        let stepper = pendulum.stepper(H)?;
        assert_near(&stepper.act(&f, &stepper.act(&g, &q)), &stepper.act(&(f * g), &q), NEAR, "Φ_FΦ_G = Φ_FG");
        assert_near(&stepper.coadjoint(&f, &mu), &(f.transpose() * mu), NEAR, "Fᵀμ");
        let map = stepper.momentum_map(&q, &p);
        assert_near(&map, &q.cross(&p), NEAR, "q × p");
        assert_near(&stepper.momentum_map(&(f * q), &(f * p)), &stepper.coadjoint(&f.transpose(), &map), NEAR, "J is equivariant");
        // momenta along q are those of no motion
        let projected = stepper.project(q, mu)?.momentum();
        assert_near(&projected, &(mu - q * q.dot(&mu)), NEAR, "orthogonal to q");
        prop_assert_eq!(stepper.system().project_momentum(&q, &mu), projected);
        assert_near(&stepper.project(q, projected)?.momentum(), &projected, NEAR, "twice");
        prop_assert!((stepper.system().isotropy_defect(&q, &mu) - q.dot(&mu).abs()).abs() < NEAR);
        prop_assert!(stepper.system().isotropy_defect(&q, &projected) < NEAR && stepper.system().isotropy_defect(&q, &map) < NEAR);
        prop_assert_eq!(stepper.state(q, mu).is_err(), q.dot(&mu).abs() > f64::EPSILON.sqrt() * mu.amax());
        prop_assert!((stepper.system().orbit_defect(&(q * 1.1)) - 0.21).abs() < NEAR && stepper.system().orbit_defect(&q) < NEAR);
        steppers_know_their_systems(&stepper, &q, &p, &rotation_below_a_right_angle(&f), &projected);
    }

    /// Φ_F(q) = qF on SE(3), whose Ad* is the transposed of ξ ↦ F ξ F⁻¹.
    #[test]
    fn motions_act_from_the_right(
        vehicle in vehicles(), (f, g, q) in (attitude(), attitude(), attitude()), (x, y, z) in (vector::<3>(1.0), vector::<3>(1.0), vector::<3>(1.0)),
        (p, xi, mu) in (matrix::<4, 4>(1.0), vector::<6>(1.0), vector::<6>(1.0)),
    ) {
        let stepper = vehicle.stepper(H)?;
        let (f, g, q) = (motion(&f, &x), motion(&g, &y), motion(&q, &z));
        let inverse = f.try_inverse().expect("a motion");
        assert_near(&stepper.act(&f, &stepper.act(&g, &q)), &stepper.act(&(g * f), &q), NEAR, "Φ_FΦ_G = Φ_GF");
        let carried = stepper.coadjoint(&f, &mu);
        let paired = mu.dot(&velocity(&(f * twist(&xi) * inverse)));
        prop_assert!((carried.dot(&xi) - paired).abs() < NEAR, "⟨Ad*_F μ, ξ⟩ = ⟨μ, Ad_F ξ⟩");
        let map = stepper.momentum_map(&q, &p);
        prop_assert!((map.dot(&xi) - (p.transpose() * q * twist(&xi)).trace()).abs() < NEAR, "J·ξ = ⟨p, ξ_Q(q)⟩");
        let lifted = p * inverse.transpose();
        assert_near(&stepper.momentum_map(&(q * f), &lifted), &stepper.coadjoint(&f, &map), NEAR, "J is equivariant");
        let representing = stepper.momentum_matrix(&mu);
        assert_near(&stepper.momentum_components(&representing), &mu, NEAR, "there and back");
        prop_assert!(((representing.transpose() * twist(&xi)).trace() - mu.dot(&xi)).abs() < NEAR, "the pairing of matrices");
        let small = motion(&rotation_below_a_right_angle(&f.fixed_view::<3, 3>(0, 0).into_owned()), &x);
        steppers_know_their_systems(&stepper, &q, &p, &small, &(mu * 0.5));
    }

    /// F⁻ℓd(F) = μ and back. F⁺ℓd is Ad*_F of F⁻ℓd without its kick, with a kick of its own.
    #[test]
    fn legendre_transforms_are_inverse(top in tops(), r in attitude(), f in rotation(0.4), mu in vector::<3>(2.0)) {
        let stepper = top.stepper(H)?;
        // M/h is the size of the terms that cancel in F − I
        let near = NEAR / H;
        let found = stepper.inverse_legendre(&r, &mu)?;
        assert_near(&stepper.legendre(&r, &found), &mu, near, "F⁻ℓd(F) = μ");
        assert_near(&(found.transpose() * found), &Matrix3::identity(), NEAR, "F is a rotation");
        let momentum = stepper.legendre(&r, &f);
        assert_near(&stepper.inverse_legendre(&r, &momentum)?, &f, near, "F again");
        let kick = |r: &Matrix3<f64>| r.row(2).transpose().cross(&Vector3::z()) * (H * top.weight / 2.0);
        let next = r * f;
        let expected = stepper.coadjoint(&f, &(momentum + kick(&r))) + kick(&next);
        assert_near(&stepper.legendre_next(&r, &f), &expected, near, "F⁺ℓd");
    }

    /// ½ μ·J⁻¹μ and m g z.
    #[test]
    fn energies_are_kinetic_and_potential(top in tops(), r in attitude(), mu in vector::<3>(2.0)) {
        let stepper = top.stepper(H)?;
        let state = stepper.state(r, mu)?;
        let kinetic = mu.dot(&(inertia_of(&top).try_inverse().expect("regular") * mu)) / 2.0;
        prop_assert!((stepper.kinetic_energy(&state) - kinetic).abs() < NEAR);
        prop_assert!((stepper.potential(&r) - top.weight * r[(2, 2)]).abs() < NEAR);
        prop_assert!((stepper.energy(&state) - kinetic - top.weight * r[(2, 2)]).abs() < NEAR);
        let constants = top.step_constants(H)?;
        prop_assert_eq!(top.kinetic_energy(&constants, 0.0, &r, &mu), stepper.kinetic_energy(&state));
        prop_assert!(top.orbit_defect(&r) < NEAR && top.orbit_defect(&(r * 2.0)) > 2.9);
        prop_assert_eq!(top.orbit_defect(&-r), f64::INFINITY);
        prop_assert_eq!((top.isotropy_defect(&r, &mu), top.project_momentum(&r, &mu)), (0.0, mu));
    }

    /// Where the time matters, formulas take it: the satellite sees the Earth at its phase.
    #[test]
    fn potentials_depend_on_time(satellite in satellites(), r in attitude(), f in rotation(0.3), t in -5.0_f64..5.0) {
        let stepper = satellite.stepper(H)?;
        let rate = satellite.orbital_rate;
        let zenith = |t: f64, r: &Matrix3<f64>| r.transpose() * Vector3::new((rate * t).cos(), (rate * t).sin(), 0.0);
        let seen = zenith(t, &r);
        let value = 1.5 * rate * rate * seen.dot(&(satellite.inertia * seen));
        prop_assert!((stepper.potential_at(t, &r) - value).abs() < NEAR);
        let mu = stepper.legendre_at(t, &r, &f);
        assert_near(&stepper.inverse_legendre_at(t, &r, &mu)?, &f, NEAR / H, "F again");
        // −h/2 J(R, ∂V) = h/2 3n² ζ × Jζ of the zenith ζ
        let kick = |t: f64, r: &Matrix3<f64>| {
            let seen = zenith(t, r);
            seen.cross(&(satellite.inertia * seen)) * (1.5 * H * rate * rate)
        };
        let later = stepper.legendre_at(t + 1.0, &r, &f);
        assert_near(&(later - mu), &(kick(t, &r) - kick(t + 1.0, &r)), NEAR / H, "the kick before");
        let next = stepper.coadjoint(&f, &(mu + kick(t, &r))) + kick(t + H, &(r * f));
        assert_near(&stepper.legendre_next_at(t, &r, &f), &next, NEAR / H, "the kicks on both sides");
    }
}

/// A rotation by a sixth of the angle, so that steps can make it.
fn rotation_below_a_right_angle(f: &Matrix3<f64>) -> Matrix3<f64> {
    private::exponential(&(private::logarithm(f) / 6.0))
}
